"""Files with one value wrong are read or refused with a message that names the file. (`key_fuzz.py` by itself tries every value.)"""

from __future__ import annotations

from pathlib import Path

import pytest

from key_fuzz import DOORS, fuzz

SIZES = [(door, 40) for door in DOORS if door != "scanned"]  # where maps are read for each, there is no quick size
SLOW = [pytest.param(door, 30 if door == "scanned" else 120, marks=pytest.mark.slow) for door in DOORS]


@pytest.mark.parametrize(("door", "most"), [*SIZES, *SLOW])
def test_wrong_values(door: str, most: int, tmp_path: Path) -> None:
    taken, refused = fuzz(door, tmp_path, most, seed=most)
    assert taken > 0 or door == "scanned"
    assert refused > most // 8
