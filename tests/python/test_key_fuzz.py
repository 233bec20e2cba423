"""Files with one value wrong are refused with a message that names the file. (`key_fuzz.py` by itself tries every
value.)"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

import key_fuzz
import mmgrasp as mg
from key_fuzz import DOORS, Door, fuzz, is_sound, listed, message_fault
from key_fuzz_tables import PLANS, WRONG

# Where maps are read for each, or a plan is made first, there is no quick size.
QUICK = [(door, 80) for door in DOORS if door not in ("scanned", "plan")]
SLOW = [pytest.param(door, 30 if door == "scanned" else 120, marks=pytest.mark.slow) for door in DOORS]


@pytest.mark.parametrize(("door", "most"), [*QUICK, *SLOW])
def test_wrong_values(door: str, most: int, tmp_path: Path) -> None:
    result = fuzz(door, tmp_path, most, seed=most)
    assert result.complaints == []
    assert result.taken > 0 or door == "scanned"
    assert result.refused > most // 2


DOCUMENT: dict[str, Any] = {
    "name": "a",
    "length": 0.3,
    "seed": 3,
    "on": True,
    "pose": {"xyz": [1.0, 0, 0]},
    "trays": [{"size": 2}],
}
NUMBERS = {"-1", "0", "0.5", "-1e-9", "1e-300"}


@pytest.mark.parametrize(("place", "kinds"), [
    (("name",), set()),
    (("length",), {"0.5"}),
    (("seed",), set()),
    (("on",), {"true"}),
    (("pose", "xyz", 0), NUMBERS),
    (("pose", "xyz", 1), NUMBERS),
    (("pose", "xyz"), set()),
    (("pose",), set()),
    (("trays", 0), set()),
    (("trays", 0, "size"), {"0.5"}),
])  # fmt: skip
def test_the_rules_say_what_is_sound(place: tuple[str | int, ...], kinds: set[str]) -> None:
    """Never NaN, another type, no text, an unknown word, too large a number, or a negative one that is an amount."""
    assert {kind for kind in WRONG if is_sound(DOCUMENT, place, kind)} == kinds


def test_lists_may_tell_the_entries_of_a_row_apart() -> None:
    sound = {"turned[][0]": ("0", "on the axis"), "turned[][]": ("nan", "x")}
    assert listed(("turned", 3, 0), sound) == [("nan", "turned[][]"), ("0", "turned[][0]")]
    assert listed(("turned", 3, 1), sound) == [("nan", "turned[][]")]


def test_every_kind_on_a_list_is_one_and_has_a_reason() -> None:
    for door in DOORS.values():
        for kinds, reason in door.sound.values():
            assert set(kinds.split(", ")) <= set(WRONG) and reason


@pytest.fixture
def door(monkeypatch: pytest.MonkeyPatch) -> Door:
    """A reader that takes everything."""
    door = Door(DOCUMENT, lambda path: None, {"name": ("a word", "any name"), "seed": ("0", "any seed")})
    monkeypatch.setitem(DOORS, "any", door)
    return door


def test_what_is_read_without_a_reason_is_complained_of(door: Door, tmp_path: Path) -> None:
    result = fuzz("any", tmp_path)
    assert result.refused == 0 and len(result.complaints) > 100
    assert "any: length 'length': nan: was read" in result.complaints
    assert "any: trays[].size 'size': -1: was read" in result.complaints
    assert "any: name 'name': no text: was read" in result.complaints
    assert "any: pose 'pose': misspelt: was read" in result.complaints
    assert not [text for text in result.complaints if "'name': a word" in text or "'seed': 0:" in text]
    assert result.needed == {("a word", "name"), ("0", "seed")}


def test_reasons_that_nothing_needs_are_told(door: Door) -> None:
    door.sound["length"] = ("0", "none")
    assert key_fuzz.unneeded("any", {("a word", "name"), ("0", "seed")}) == [
        "any: length: 0: listed as sound, but refused"
    ]


def refuses(message: str) -> Any:
    calls: list[Path] = []

    def load(path: Path) -> None:
        calls.append(path)
        if len(calls) > 1:  # the first one is sound
            raise mg.InvalidInput(message)

    return load


def test_complaints_are_counted_and_told(
    door: Door, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["key_fuzz.py", "any", "20", "3"])
    assert key_fuzz.main() == 1
    assert "20 tries: 20 read, 0 refused, " in capsys.readouterr().out
    monkeypatch.setitem(DOORS, "any", door._replace(load=refuses("changed.yaml:3: length = nan: must be finite")))
    assert key_fuzz.main() == 0
    assert "20 tries: 0 read, 20 refused, 0 complaints" in capsys.readouterr().out
    monkeypatch.setitem(DOORS, "any", door._replace(load=refuses("length = nan: must be finite")))
    assert key_fuzz.main() == 1
    assert "20 tries: 0 read, 20 refused, 20 complaints" in capsys.readouterr().out


def test_messages_name_the_file() -> None:
    yaml, json = Path("changed.yaml"), Path("changed.json")
    assert message_fault(mg.InvalidInput("folder/changed.yaml:3: x"), yaml) == ""
    assert message_fault(mg.InvalidInput("folder/changed.json: x"), json) == ""
    assert "without file and line" in message_fault(mg.InvalidInput("folder/changed.yaml: x"), yaml)
    assert "an escape" in message_fault(mg.InvalidInput("changed.yaml:3: \x1b[31m"), yaml)


def test_the_plan_has_a_list() -> None:
    assert DOORS["plan"].sound is PLANS
