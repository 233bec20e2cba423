"""`./dev hostile` runs what is there: its parts name files and scripts that exist, each file once."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

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
