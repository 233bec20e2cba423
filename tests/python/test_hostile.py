"""`./dev hostile` runs what is there: its parts name files and scripts that exist, each file once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import hostile
from hostile import HERE, PARTS, files


def test_parts_name_what_is_there() -> None:
    named = [file for part in PARTS.values() for file in files(part)]
    assert len(named) == len(set(named)) > 25
    assert [file for file in named if not Path(file).exists()] == []
    scripts = [words.split()[0] for part in PARTS.values() for words in part.night if not words.startswith("./")]
    assert [script for script in scripts if not (HERE / script).exists()] == []


def test_every_table_of_bad_inputs_is_in_a_part() -> None:
    """Those are meant whose names say that they fuzz, break or refuse."""
    words = ("fuzz", "bad_", "odd_", "arguments", "mutations", "limits", "interrupt", "_doors", "refusals", "places")
    found = {str(f) for f in HERE.glob("test_*.py") if any(word in f.name for word in words)}
    assert found - {file for part in PARTS.values() for file in files(part)} == set()


def test_unknown_parts_are_told() -> None:
    done = subprocess.run([sys.executable, str(HERE / "hostile.py"), "nothing"], capture_output=True, text=True)
    assert done.returncode == 2 and "no part nothing; there are texts, " in done.stderr


def test_tries_of_a_search_are_counted_and_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "hostile.md"
    page.write_text(f"before\n{hostile.BEGIN}\nold\n{hostile.END}\nafter\n")
    search = tmp_path / "search.py"
    search.write_text("print('1200 tries: 3 read'); print('no tries here')")
    monkeypatch.setattr(hostile, "KEPT", tmp_path)
    monkeypatch.setattr(hostile, "PAGE", page)
    monkeypatch.setattr(hostile, "PARTS", {"texts": hostile.Part("Texts", "yaml_text", (str(search),))})
    good, _, tries = hostile.run_search(str(search))
    hostile.keep("texts", "tests", 34, True)
    hostile.keep("texts", str(search), tries, good)
    hostile.write()
    text = page.read_text()
    assert "1,200 | nothing" in text and "1,234 tries in all." in text and "old" not in text
    assert text.startswith("before\n") and text.endswith("after\n")
