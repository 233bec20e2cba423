"""Command lines put together at random are answered or refused. (`command_fuzz.py` by itself tries as many as one likes.)"""

from __future__ import annotations

from pathlib import Path

import pytest

from command_fuzz import fuzz


@pytest.mark.parametrize("tries", [8, pytest.param(60, marks=pytest.mark.slow)])
def test_command_lines(tries: int, tmp_path: Path) -> None:
    assert fuzz(tmp_path, tries, seed=tries) == []
