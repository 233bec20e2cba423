"""Grippers of assembly files: grasps that a rehearsal refuses, reasons that are said once, and what a file leaves out."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from mmgrasp.cli import main
from mmgrasp.gripper_design import Gripper
from mmgrasp.grippers import GripperPlan, load_assembly, plan_grippers
from mmgrasp.viz.gripper_report import gripper_report_html

HAIR = 0.005  # fingers pass the walls by this, but not once they are rehearsed, 0.02 mm off [mm]


@pytest.fixture
def file_of(tmp_path: Path) -> Callable[..., Path]:
    """An assembly file of a key of 30 x 12 x 20 mm on a plate, in mm, with some top-level keys given or changed."""

    def write(**changes: Any) -> Path:
        content = {
            "format": "mmgrasp-assembly",
            "version": 1,
            "name": "a key",
            "unit": "mm",
            "parts": [
                {"name": "plate", "box": [200, 200, 10], "pose": {"xyz": [0, 0, -5]}},
                {"name": "key", "box": [30, 12, 20], "pose": {"xyz": [0, 0, 10]}},
            ],
            "order": [{"part": "key", "onto": ["plate"], "from": {"xyz": [0, 0, 50]}}],
            "actuators": [{"name": "jaws", "fingers": 2, "stroke": 30}],
            **changes,
        }
        file = tmp_path / "key.yaml"
        file.write_text(yaml.safe_dump(content))
        return file

    return write


def between_walls(file_of: Callable[..., Path]) -> Path:
    """Beside the key's long faces, which pads touch most of, there is room for a finger and a hair."""
    content = yaml.safe_load(file_of().read_text())
    parts, off = content["parts"], 6 + 8 + HAIR + 5
    for name, y in (("left", -off), ("right", off)):
        parts.append({"name": name, "box": [16, 10, 30], "pose": {"xyz": [0, y, 15]}})
    order = [{**content["order"][0], "onto": ["plate", "left", "right"]}]
    return file_of(parts=parts, order=order, fingers={"clearance": 0})


def test_what_a_rehearsal_refused_is_told_beside_the_proof(
    tmp_path: Path, file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    file = between_walls(file_of)
    assert main(["grippers", str(file), "-o", str(tmp_path / "out"), "--no-pictures"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "nor fewer changes, for the grasps that rehearsals did not refuse" in printed
    refused = "left out, refused in rehearsal: key: finger_1 meets left during the motion"
    assert f"- {refused}" in printed
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["outcome"] == "solved" and result["rehearsals"] == len(result["left_out"]) + 1 > 1
    for left in result["left_out"]:
        assert result["requirements"][left["requirement"]]["opening"] == pytest.approx(0.012)
    assert result["requirements"][result["operations"][0]["requirement"]]["opening"] == pytest.approx(0.03)
    assert refused in (tmp_path / "out" / "report.html").read_text()
    once = load_assembly(file)
    once.options["max_rehearsals"] = 1
    plan = plan_grippers(once)
    assert plan.outcome.name == "not_found" and not plan.solved
    assert plan.faults == ["key: finger_1 meets left during the motion"]
    assert gripper_report_html(plan, None).count(plan.faults[0]) == 1


def test_a_reason_is_said_once_and_with_help(
    tmp_path: Path, file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    file = file_of(actuators=[{"name": "jaws", "fingers": 2, "stroke": 1.5, "max_opening": 600}])
    assert main(["grippers", str(file), "-o", str(tmp_path / "out"), "--no-pictures"]) == 3
    printed = " ".join(capsys.readouterr().out.split())
    assert printed.count("too little of the stroke") == 1
    assert re.search(r"opening_margin = 1 mm leaves too little of the stroke \(\d+ times\)", printed)
    assert "would help: key: a stroke of 2 mm for 'jaws' would do" in printed
    assert "would help: key: opening_margin = 0.75 mm would do" in printed


def test_an_opening_as_wide_as_is_advised_is_taken(file_of: Callable[..., Path]) -> None:
    """100 mm and twice 2 mm are more than 104 mm by a rounding."""
    parts = [{"name": "key", "box": [100, 110, 120]}]
    order = [{"part": "key", "from": {"xyz": [0, 0, 50]}}]

    def planned(widest: float) -> GripperPlan:
        drive = {"name": "jaws", "fingers": 2, "stroke": 30, "max_opening": widest}
        return plan_grippers(load_assembly(file_of(parts=parts, order=order, actuators=[drive])))

    assert planned(104).solved and not planned(103.99).solved
    assert "opens as wide as it is, but not by what clearance and opening_margin ask" in planned(103.99).faults[0]
    assert "no pair of opposite faces that an actuator opens wide enough for" in planned(99).faults[0]


def test_tips_that_end_short_of_everything_are_refused_at_their_line(
    tmp_path: Path, file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    file = file_of(fingers={"tip_clearance": 500})
    assert main(["grippers", str(file), "-o", str(tmp_path / "out")]) == 2
    error = " ".join(capsys.readouterr().err.split())
    line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if "tip_clearance" in text)
    rule = "must be no longer than the largest part that is moved, 38 from corner to corner"
    assert f"key.yaml:{line}: fingers.tip_clearance = 500: {rule}" in error
    load_assembly(file_of(fingers={"tip_clearance": 37}))


def test_two_drives_of_one_name_are_refused_at_their_line(
    tmp_path: Path, file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    drives = [{"name": "jaws", "fingers": 2, "stroke": 30}, {"name": "jaws", "fingers": 3, "stroke": 16}]
    file = file_of(actuators=drives)
    assert main(["grippers", str(file), "-o", str(tmp_path / "out")]) == 2
    error = " ".join(capsys.readouterr().err.split())
    lines = [i for i, text in enumerate(file.read_text().splitlines(), 1) if "name: jaws" in text]
    assert f"key.yaml:{lines[1]}: actuators[1].name = 'jaws': is there twice: drives must have names" in error


def test_operations_without_a_way_past_other_parts_are_told(file_of: Callable[..., Path]) -> None:
    parts = [*yaml.safe_load(file_of().read_text())["parts"], {"name": "lid", "box": [30, 12, 5]}]
    parts[-1]["pose"] = {"xyz": [0, 0, 22.5]}
    plan = plan_grippers(load_assembly(file_of(parts=parts, order=[{"part": "key"}, {"part": "lid"}])))
    told = [note for note in plan.notes if "neither" in note]
    assert told == ["lid: has neither from nor path: how it comes to its place past key is not looked at"]


def test_the_palm_covers_the_open_fingers() -> None:
    gripper = Gripper(max_opening=0.05, finger_thickness=0.008, finger_width=0.015)
    assert gripper.palm_radius == pytest.approx(np.hypot(0.033, 0.0075))


@pytest.mark.parametrize(
    ("key", "changes"),
    [
        ("actuators[0].stroke", {"unit": "m", "actuators": [{"name": "jaws", "fingers": 2, "stroke": 10}]}),
        ("actuators[0].max_opening", {"actuators": [{"name": "a", "fingers": 2, "stroke": 9, "max_opening": 3001}]}),
        ("fingers.width", {"fingers": {"width": 3001}}),
    ],
)
def test_drives_and_fingers_of_metres_are_refused(
    file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str], key: str, changes: dict[str, Any]
) -> None:
    parts = [{"name": "key", "box": [0.03, 0.012, 0.02]}]
    more = {"parts": parts, "order": [{"part": "key"}]} if "unit" in changes else {}
    assert main(["grippers", str(file_of(**changes, **more)), "-o", "unused", "--no-pictures"]) == 2
    assert re.search(rf"key.yaml:\d+: {re.escape(key)} = \d+: must be at most \d+ \(3 m\)", capsys.readouterr().err)


def test_help_names_a_smaller_clearance_and_contact(
    tmp_path: Path, file_of: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    """Walls 4 mm off all sides: fingers of 3 mm pass them where they open by less than 1 mm."""
    parts = yaml.safe_load(file_of().read_text())["parts"]
    for name, size, at in (
        ("a", [60, 5, 30], [0, 12.5]), ("b", [60, 5, 30], [0, -12.5]), ("c", [5, 20, 30], [21.5, 0]), ("d", [5, 20, 30], [-21.5, 0])
    ):  # fmt: skip
        parts.append({"name": name, "box": size, "pose": {"xyz": [*at, 15]}})
    order = [{"part": "key", "onto": ["plate", *"abcd"], "from": {"xyz": [0, 0, 50]}}]
    file = file_of(parts=parts, order=order, fingers={"thickness": 3, "clearance": 8})
    assert main(["grippers", str(file), "-o", str(tmp_path / "out"), "--no-pictures"]) in (3, 4)
    printed = " ".join(capsys.readouterr().out.split())
    told = re.search(r"key: a clearance of ([0-9.]+) mm would do", printed)
    assert told, printed
    helped = file_of(parts=parts, order=order, fingers={"thickness": 3, "clearance": float(told[1])})
    assert main(["grippers", str(helped), "-o", str(tmp_path / "helped"), "--no-pictures"]) == 0
