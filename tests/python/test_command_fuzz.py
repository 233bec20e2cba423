"""Command lines put together at random are answered or refused.

(`command_fuzz.py` by itself tries as many as one likes.)
"""

from __future__ import annotations

import os
import random
from collections.abc import Callable
from pathlib import Path

import pytest

from command_fuzz import OUTPUTS, Line, Place, command_line, complaint, fuzz, touched
from mmgrasp.cli.arguments import build_parser


@pytest.mark.parametrize("tries", [8, pytest.param(60, marks=pytest.mark.slow)])
def test_command_lines(tries: int, tmp_path: Path) -> None:
    assert fuzz(tmp_path, tries, seed=tries) == []


def changes(
    place: Place, outputs: list[str], change: Callable[[], object], own: set[str], *, is_refused: bool = False
) -> str:
    before = place.files()
    change()
    return touched(outputs, place, before, place.files(), own, is_refused=is_refused)


@pytest.fixture
def place(tmp_path: Path) -> Place:
    made = Place(Path(os.path.realpath(tmp_path)))
    made.make()
    return made


def test_nothing_but_the_output_may_be_touched(place: Place) -> None:
    work = place.work
    shipped = next(place.root.joinpath("assets").rglob("*.urdf"))

    def told(change: Callable[[], object]) -> str:
        return changes(place, ["out"], change, set())

    assert told(lambda: None) == ""
    assert told((work / "out").mkdir) == ""
    assert told(lambda: (work / "out" / "plan.json").write_text("x")) == ""
    assert told(lambda: (work / "bytes").write_bytes(bytes(256 * 20))) == (
        "replaced work/bytes, which is not where it was told to write"
    )
    assert told(shipped.unlink).startswith("removed assets/")
    assert told(lambda: (work / "stray").write_text("x")).startswith("made work/stray")
    assert told(lambda: (place.root / "tmp" / "left").write_text("x")).startswith("made tmp/left")
    assert told((work / "link").unlink).startswith("removed work/link")


def test_what_is_there_is_replaced_only_as_an_earlier_result(place: Place) -> None:
    work = place.work
    somebodys = work / "folder" / "plan.json"
    assert changes(place, ["folder"], lambda: somebodys.write_text("x"), set()) == (
        "replaced work/folder/plan.json, which is somebody's"
    )
    assert changes(place, ["picture.png"], lambda: (work / "picture.png").write_text("x"), set()) == ""
    assert changes(place, ["empty"], lambda: (work / "empty").write_text("x"), set()) == ""
    own: set[str] = set()
    assert changes(place, ["new"], lambda: (work / "new").write_text("x"), own) == ""
    assert changes(place, ["new"], lambda: (work / "new").write_text("y"), own) == ""
    assert changes(place, ["new"], lambda: (work / "new").write_text("z"), set()).endswith("which is somebody's")


def test_who_is_refused_leaves_nothing(place: Place) -> None:
    told = changes(place, ["out"], (place.work / "out").mkdir, set(), is_refused=True)
    assert told == "was refused, and made work/out"


def test_occupied_places_are_tried(place: Place, tmp_path: Path) -> None:
    assert complaint(Line(["init", "nowhere", "-o", "bytes"], ["bytes"]), place, set()) == ""
    parsers = build_parser()._actions[-1].choices
    assert isinstance(parsers, dict)
    draw = random.Random(1)
    lines = [command_line("plan", parsers["plan"], draw, ["bytes", "/"]) for _ in range(50)]
    written = {output for line in lines for output in line.outputs}
    assert "bytes" in written and "/" not in written and len(written) > 10


def test_every_option_that_names_a_place_is_known() -> None:
    """Those are meant whose help says that something is written."""
    parsers = build_parser()._actions[-1].choices
    assert isinstance(parsers, dict)
    options = [action for name in parsers if name not in ("reproduce", "bench") for action in parsers[name]._actions]
    paths = [action for action in options if getattr(action.type, "__name__", "") == "path"]
    writing = {a.dest for a in paths if any(word in (a.help or "") for word in ("writ", "draw", "folder for"))}
    assert writing == set(OUTPUTS)
