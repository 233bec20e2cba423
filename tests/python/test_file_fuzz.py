"""Scenarios and plans changed at random are read or refused with a message.

(`file_fuzz.py` by itself tries as many as one likes.)
"""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest
import yaml

import file_fuzz
import mmgrasp as mg
from file_fuzz import fuzz, read_plan_whole, read_scenario, with_short_motions

SIZES = [100, pytest.param(400, marks=pytest.mark.slow)]


@pytest.mark.parametrize("tries", SIZES)
def test_scenarios(small: dict[str, Any], tmp_path: Path, tries: int) -> None:
    result = fuzz(yaml.safe_dump(small, sort_keys=False), read_scenario, tmp_path, tries, seed=tries)
    assert result.complaints == []
    assert result.taken > 0
    assert result.refused > tries // 5


@pytest.mark.parametrize("tries", SIZES)
def test_plans(small_plan_dict: dict[str, Any], tmp_path: Path, tries: int) -> None:
    plan = json.dumps(with_short_motions(json.loads(json.dumps(small_plan_dict))), indent=1)
    result = fuzz(plan, read_plan_whole, tmp_path, tries, seed=tries)
    assert result.complaints == []
    assert result.taken > 0
    assert result.refused > tries // 5


def read_badly(path: Path) -> None:
    """Breaks at every third text, and refuses every other of the rest without a word."""
    kind = len(path.read_bytes()) % 3
    if kind == 0:
        raise KeyError("broken")
    if kind == 1:
        raise mg.InvalidInput("")


def test_what_is_found_is_counted_and_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(file_fuzz, "source", lambda word: ("some text", read_badly))
    monkeypatch.setattr(tempfile, "mkdtemp", lambda: str(tmp_path))
    monkeypatch.setattr(sys, "argv", ["file_fuzz.py", "any", "30"])
    assert file_fuzz.main() == 1
    said = capsys.readouterr().out
    kept = list(tmp_path.glob("fuzzed_1_*.file"))
    assert "KeyError: 'broken'" in said and "an error without a word" in said
    assert 0 < len(kept) < 30
    assert f"30 tries: {30 - len(kept)} read, 0 refused, {len(kept)} complaints" in said
