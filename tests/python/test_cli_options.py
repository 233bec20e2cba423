"""Every option of every command with wrong values: the tables follow from the parser, so that none is left out."""

from __future__ import annotations

import argparse
import math
import re
from pathlib import Path
from typing import Any

import pytest

from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.cli.arguments import build_parser

NO_NUMBERS = [
    "",
    "x",
    "nan",
    "-nan",
    "inf",
    "1e999",
    "1_0",
    "\u0663",
    " 1",
    "1 ",
    "0x10",
    "1,5",
    "1e7,1e7,1e7",
    "9" * 400,
    "-1e300",
]
NO_PATHS = ["", "a\0b"]
NO_CHOICES = ["", "x", "\u202e", "a" * 5000]
NO_NAMES = ["", "a\0b", "\x1b[31m", "\u202e", "\ud800", "a\nb", "a" * 5000]
NO_ADDRESSES = [*NO_NAMES, "nonsense", "tcp://", "tcp://host", "tcp://:1", "tcp://host:port", "tcp://host:0", "tcp://host:65536", "host:1",
                "tcp://host:1/x", "tcp://host:1 ", "tcp://h\u0660:\u0661"]  # fmt: skip
FETCH = str(ASSETS / "robots" / "fetchlike" / "fetchlike.urdf")


def options() -> list[tuple[str, argparse.Action]]:
    """Options of all commands, those that take a value: all but switches."""
    commands = next(a for a in build_parser()._actions if isinstance(a, argparse._SubParsersAction))
    every = [(name, action) for name, parser in commands.choices.items() for action in parser._actions]
    return [(n, a) for n, a in every if a.nargs != 0]


def wrong(action: argparse.Action) -> list[str]:
    kind = getattr(action.type, "__name__", "")
    if action.choices:
        return NO_CHOICES
    if kind in ("name", "address"):
        return NO_NAMES if kind == "name" else NO_ADDRESSES
    if kind in ("path", "plan", "source"):
        return NO_PATHS
    return (
        ["", "x", "=", "=x", "a=/no/such"]
        if kind == "package"
        else ["", "x", "="]
        if kind in ("xacro_argument", "mount")
        else NO_NUMBERS
    )


def test_the_parser_was_read() -> None:
    names = {(name, *action.option_strings) for name, action in options()}
    assert len(names) > 50
    assert {("plan", "--seed"), ("arrive", "--pose"), ("scan", "--up"), ("check", "--package")} <= names
    assert {("arrive", "--picked"), ("reproduce", "--scheduler"), ("grasp", "--object")} <= names
    assert not [(name, action.dest) for name, action in options() if action.type is None and not action.choices]


NO_NUMBER = {
    "path",
    "plan",
    "source",
    "name",
    "address",
    "package",
    "xacro_argument",
    "mount",
    "direction",
    "base",
}


@pytest.mark.parametrize(("command", "action"), options(), ids=lambda v: v if isinstance(v, str) else v.dest)
def test_numbers_have_bounds_and_keep_them(command: str, action: argparse.Action) -> None:
    """The bounds that the parser states are taken, and what is next to them is not."""
    if action.choices or getattr(action.type, "__name__", "") in NO_NUMBER:
        return
    number: Any = action.type
    assert math.isfinite(number.least) and math.isfinite(number.most), "an option without both bounds"
    for bound, beyond in ((number.least, -1), (number.most, 1)):
        text = str(int(bound)) if number.is_whole else repr(float(bound))
        assert number(text) == bound * number.scale
        further = str(int(bound) + beyond) if number.is_whole else repr(math.nextafter(bound, beyond * math.inf))
        with pytest.raises(argparse.ArgumentTypeError, match=re.escape(number.unit or "must be")):
            number(further)


def test_every_negative_number_is_a_value(capsys: pytest.CaptureFixture[str]) -> None:
    given = build_parser().parse_args(["arrive", "plan.json", "--stop", "1", "--pose", "-1e-3", "-2.E+1", "-.5"])
    assert given.pose == [-0.001, -20.0, -0.5]
    for text in ("-inf", "-NaN", "-1e999"):
        with pytest.raises(SystemExit):
            build_parser().parse_args(["arrive", "plan.json", "--stop", "1", "--pose", "0", text, "0"])
        assert f"--pose: {text}" in capsys.readouterr().err.replace("'", ""), text


@pytest.mark.parametrize(("command", "action"), options(), ids=lambda v: v if isinstance(v, str) else v.dest)
def test_wrong_values_are_refused(command: str, action: argparse.Action, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser(prog=command)
    parser._add_action(action)
    for text in wrong(action):
        given = [text] * (action.nargs if isinstance(action.nargs, int) else 1)
        if action.option_strings:
            given[0] = f"{action.option_strings[-1]}={given[0]}"
        with pytest.raises(SystemExit) as caught:
            parser.parse_args(given)
        assert caught.value.code == 2
        assert action.dest in capsys.readouterr().err.replace("-", "_"), text[:30]


NAMES = [
    (["plan", "{s}", "-o", "{o}", "--robot", "tiag"], "did you mean tiago?"),
    (["verify", "{p}", "--robot", "tiago"], "needs scenario"),
    (["grasp", "{o}", "--gripper", "tiag"], "did you mean tiago?"),
    (["grasp", "{o}", "--gripper", "asset:none.yaml"], "none.yaml"),
    (["pipe", "pipe99", "-o", "{o}"], "pipe99"),
    (["grippers", "puley", "-o", "{o}"], "pulley"),
    (["reproduce", "p1-tabel-3.3"], "p1-table-3.3"),
    (["bench", "mbm", "--data", "{o}", "--robot", "pr3"], "pr3"),
    (["bench", "mbm", "--data", "{o}", "--set", "boxes"], "boxes"),
    (["bench", "mbm", "--data", "{o}", "--planner", "rrt_konnect"], "did you mean rrt_connect?"),
    (["check", FETCH, "--srdf", "{o}/none.srdf"], "none.srdf"),
    (["check", FETCH, "--xacro-arg", "a=1"], "xacro"),
    pytest.param(  # which waits for an answer
        ["reproduce", "p1-table-3.1", "--quick", "--out", "{o}", "--scheduler", "tcp://127.0.0.1:9"],
        "cannot be reached",
        marks=pytest.mark.slow,
    ),
]


@pytest.mark.parametrize(("arguments", "piece"), NAMES, ids=lambda v: " ".join(v)[:50] if isinstance(v, list) else "")
def test_names_that_are_none(
    arguments: list[str], piece: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "plan.json").write_text("{}")
    places = {"s": ASSETS / "scenarios" / "storeroom.yaml", "o": tmp_path / "out", "p": tmp_path / "plan.json"}
    try:
        code = main([a.format(**places) for a in arguments])
    except SystemExit as stop:  # the parser's
        code = int(str(stop.code))
    error = capfd.readouterr().err
    assert code == 2
    assert piece in error and "Traceback" not in error
    assert not (tmp_path / "out").exists()
