"""Files with one value wrong are read or refused with a message that names the file. (`key_fuzz.py` by itself tries every value.)"""

from __future__ import annotations

from pathlib import Path

import pytest

from key_fuzz import DOORS, fuzz


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS)
def test_wrong_values(door: str, tmp_path: Path) -> None:
    few = door == "scanned"  # maps are read for each
    taken, refused = fuzz(door, tmp_path, 30 if few else 120)
    assert taken > 0 or few
    assert refused > 15
