"""What would help, applied as it is printed, helps: over drawn parts and drives; and where it is the least, slightly less of it does not."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.planning import GripperPlan

pytestmark = pytest.mark.slow

SLIGHTLY = 0.1  # [mm]
NUMBER = r"([\d.]+) mm"


def block(rng: np.random.Generator) -> dict[str, Any]:
    """Widths as they are drawn, or of whole tenths of a millimetre."""
    sizes = rng.uniform(5, 150, 3)
    return {"box": [float(s) for s in (sizes.round(1) if rng.random() < 0.5 else sizes)]}


def disc(rng: np.random.Generator) -> dict[str, Any]:
    radius, height = (float(v) for v in rng.uniform([3, 8], [60, 60]).round(2))
    return {"turned": [[0, 0], [radius, 0], [radius, height], [0, height]]}


def washer(rng: np.random.Generator) -> dict[str, Any]:
    radius, height = (float(v) for v in rng.uniform([6, 1.2], [20, 2.8]).round(2))
    return {"turned": [[radius / 2, 0], [radius, 0], [radius, height], [radius / 2, height]]}


def jaws(stroke: float, widest: float | None = None, name: str = "jaws", fingers: int = 2) -> dict[str, Any]:
    out = {"name": name, "fingers": fingers, "stroke": stroke}
    return out if widest is None else {**out, "max_opening": widest}


def narrow(rng: np.random.Generator) -> dict[str, Any]:
    """Drives that open for next to nothing, or of the other kind."""
    stroke = round(float(rng.uniform(2, 5)), 1)
    return {"actuators": [jaws(stroke, stroke), jaws(stroke, stroke, "chuck", 3)][int(rng.integers(2)) :]}


def short_stroke(rng: np.random.Generator) -> dict[str, Any]:
    """A stroke that the margins take up."""
    margin = round(float(rng.uniform(0.5, 3)), 2)
    stroke = round(2 * margin * float(rng.uniform(0.3, 0.9)), 2)
    drives = [jaws(stroke, 400), jaws(stroke, 400, "chuck", 3)]
    return {"actuators": drives, "fingers": {"opening_margin": margin}}


def short_fingers(rng: np.random.Generator) -> dict[str, Any]:
    """Fingers too short to reach down beside a pin that stands out of the part."""
    return {
        "actuators": [jaws(30), jaws(16, None, "chuck", 3)],
        "fingers": {"shortest": 2, "longest": round(float(rng.uniform(2, 6)), 2)},
    }


def any_drive(rng: np.random.Generator) -> dict[str, Any]:
    return {"actuators": [jaws(30), jaws(16, None, "chuck", 3)]}


def narrow_gap(rng: np.random.Generator) -> dict[str, Any]:
    """Walls about a block leave less than fingers and their way to open take."""
    half = rng.uniform(8, 30, 3).round(1)
    gap = round(float(rng.uniform(3.5, 9)), 2)
    walls = []
    for axis, side in ((0, 1), (0, -1), (1, 1), (1, -1)):
        size, place = 2 * (half + gap), np.zeros(3)
        size[axis], size[2] = 4, 2 * half[2] + 10
        place[axis] = side * (half[axis] + gap + 2)
        pose = {"xyz": [float(v) for v in place]}
        walls.append({"name": f"wall {axis} {side}", "box": [float(s) for s in size], "pose": pose})
    return {
        **any_drive(rng),
        "parts": [{"name": "part", "box": [float(2 * h) for h in half]}, *walls],
        "order": [{"part": "part", "onto": [w["name"] for w in walls], "from": {"xyz": [0, 0, 100]}}],
    }


@pytest.fixture
def planned(tmp_path: Path) -> Callable[[dict[str, Any]], GripperPlan]:
    """The plan of a file that says this of an assembly in mm whose one part comes from above."""

    def plan(content: dict[str, Any]) -> GripperPlan:
        file = tmp_path / "drawn.yaml"
        start = {"format": "mmgrasp-assembly", "version": 1, "name": "drawn", "unit": "mm"}
        file.write_text(yaml.safe_dump({**start, **content}))
        return plan_grippers(load_assembly(file))

    return plan


def with_fingers(content: dict[str, Any], key: str, value: float) -> dict[str, Any]:
    return {**content, "fingers": {**content.get("fingers", {}), key: value}}


def with_drive(content: dict[str, Any], drive: dict[str, Any]) -> dict[str, Any]:
    return {**content, "actuators": [*content["actuators"], drive]}


OPTIONS = (
    (f"fingers of {NUMBER}", "longest", -SLIGHTLY),
    (f"fingers as short as {NUMBER}", "shortest", SLIGHTLY),
    (f"fingers {NUMBER} thick", "thickness", SLIGHTLY),
    (f"fingers {NUMBER} wide", "width", SLIGHTLY),
    (f"a min_contact of {NUMBER}", "min_contact", 0.0),  # more may do where tips give up tip_clearance
    (f"opening_margin = {NUMBER}", "opening_margin", SLIGHTLY),
    (f"a clearance of {NUMBER}", "clearance", 0.0),  # a half, a quarter or an eighth of what was asked for
)
DRIVE = (
    rf"\w+: a drive with (\d) fingers, a stroke of {NUMBER} and an opening of up to {NUMBER} would do"
    rf"(, the least)?(: its fingers open by {NUMBER}, not by {NUMBER})?"
)


def with_stroke(content: dict[str, Any], name: str, stroke: float) -> dict[str, Any]:
    drives = [{**a, "stroke": stroke} if a["name"] == name else a for a in content["actuators"]]
    return {**content, "actuators": drives}


def applied(content: dict[str, Any], advice: str) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """The file with a piece of advice in it, and files in which it is followed to slightly less than the least."""
    for text, key, less in OPTIONS:
        if found := re.fullmatch(rf"\w+: {text} would do", advice):
            value = float(found[1])
            return with_fingers(content, key, value), [with_fingers(content, key, value + less)] if less else []
    if found := re.fullmatch(rf"\w+: a stroke of {NUMBER} for '([\w ]+)' would do", advice):
        stroke = float(found[1])
        return with_stroke(content, found[2], stroke), [with_stroke(content, found[2], stroke - SLIGHTLY)]
    drive = re.fullmatch(DRIVE, advice)
    assert drive, advice
    fingers, stroke, widest = int(drive[1]), float(drive[2]), float(drive[3])

    def offered(stroke: float, widest: float) -> dict[str, Any]:
        return with_drive(content, jaws(stroke, widest, "new", fingers))

    shorts = [offered(stroke, widest - SLIGHTLY)] if widest - SLIGHTLY >= stroke else []
    if drive[4] is not None:
        shorts.append(offered(stroke - SLIGHTLY, widest))
    return offered(stroke, widest), shorts


@pytest.mark.parametrize(
    ("part", "rest", "draws", "keys"),
    [
        (block, narrow, 2, ("drive",)),
        (disc, narrow, 2, ("drive", "the least")),
        (block, short_stroke, 1, ("stroke", "opening_margin")),
        (disc, short_stroke, 1, ("stroke", "opening_margin")),
        (block, short_fingers, 1, ("fingers of",)),
        (disc, short_fingers, 1, ("fingers of",)),
        (washer, any_drive, 1, ("min_contact",)),
        (block, narrow_gap, 2, ("thick",)),
    ],
)
def test_advice_helps_as_it_is_printed(
    planned: Callable[[dict[str, Any]], GripperPlan],
    part: Callable[[np.random.Generator], dict[str, Any]],
    rest: Callable[[np.random.Generator], dict[str, Any]],
    draws: int,
    keys: tuple[str, ...],
) -> None:
    rng = np.random.default_rng(1)
    given: list[str] = []
    for _ in range(draws):
        content = {
            "parts": [{"name": "part", **part(rng)}],
            "order": [{"part": "part", "from": {"xyz": [0, 0, 20]}}],
            **rest(rng),
        }
        plan = planned(content)
        given += plan.help
        for advice in plan.help:
            followed, shorts = applied(content, advice)
            assert planned(followed).solved, (content, advice)
            for short in shorts:
                assert not planned(short).solved, (content, advice)
    for key in keys:
        assert any(key in advice for advice in given), (key, given)


@pytest.mark.parametrize("part", [block, disc])
def test_a_long_drive_beside_a_short_one_costs_no_solution(
    planned: Callable[[dict[str, Any]], GripperPlan], part: Callable[[np.random.Generator], dict[str, Any]]
) -> None:
    """Only the drive of a short stroke opens wide enough, and by less than the long one would."""
    rng = np.random.default_rng(2)
    short, long = [jaws(4, 400), jaws(4, 400, "chuck", 3)], [jaws(30, 30, "long"), jaws(30, 30, "long chuck", 3)]
    for _ in range(2):
        content = {
            "parts": [{"name": "part", **part(rng)}],
            "order": [{"part": "part", "from": {"xyz": [0, 0, 20]}}],
            "fingers": {"opening_margin": 1},
        }
        assert planned({**content, "actuators": short}).solved
        assert planned({**content, "actuators": [*long, *short]}).solved, content
