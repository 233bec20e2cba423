"""The examples with which the docstrings of classes open run as they stand, with a robot, a room and a part in the names they use."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import _core
from mmgrasp._files import shipped

MAIN = {
    *("Robot", "JointGroup", "World", "CollisionChecker", "ReachDatabase", "CapabilityMap", "Roadmap", "Mesh", "Grasp"),
    *("MeshDistanceField", "GridDistanceField", "BaseTracker", "ManipulationProblem", "DriveByTask", "JointTrajectory"),
    *("HeightMap", "Pipe", "BeamFrame", "ObjectRegions", "PartSupplyProblem"),
}
"""Classes that nearly everybody meets: theirs have an example."""
ELSEWHERE = {"PartSupplyProblem", "ObjectRegions"}  # whole rounds, which test_part_supply.py runs


def code(doc: str) -> str:
    """The first block of a docstring that is indented by four."""
    block: list[str] = []
    for line in doc.splitlines():
        if line.startswith("    ") or (block and not line):
            block.append(line)
        elif block:
            break
    return textwrap.dedent("\n".join(block)).strip()


def examples() -> Iterator[tuple[str, str]]:
    for name, entry in vars(_core).items():
        if isinstance(entry, type) and name in MAIN:
            yield name, code(entry.__doc__ or "")


@pytest.fixture
def names(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.chdir(tmp_path)
    folder = shipped("asset:robots/omni6")
    robot = mg.Robot.load(folder / "omni6.urdf", folder / "omni6.srdf", base="omni")
    (tmp_path / "robot.urdf").write_text(robot.to_urdf())
    (tmp_path / "robot.srdf").write_text(robot.to_srdf())
    box = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "bracket.obj").write_text(box)
    arm = robot.group("arm", tip="gripper_tcp")
    q = np.zeros(len(arm.names))
    T = arm.fk(q)
    return {
        "mg": mg,
        "np": np,
        "robot": robot,
        "arm": arm,
        "world": mg.World(),
        "mesh": mg.Mesh.load(tmp_path / "bracket.obj"),
        "q": q,
        "q_goal": q + 0.01,
        "path": [q, q + 0.1],
        "T_base_tip": T,
        "T_world_object": np.eye(4),
        "T_world_start": T,
        "T_world_goal": T @ mg.pose([0.01, 0, 0]),
        "shapes": [mg.LinkShape(mg.Box([0.02, 0.02, 0.02]))],
        "grasps": [mg.Grasp(np.eye(4), 0.02)],
        "planned_now": [0.0, 0, 0],
        "planned_after_period": [0.01, 0, 0],
        "measured": [0.0, 0.001, 0],
    }


def test_classes_that_everybody_meets_have_one() -> None:
    found = dict(examples())
    assert MAIN == found.keys()
    assert [name for name, text in found.items() if not text] == []


@pytest.mark.parametrize(("name", "text"), [(n, t) for n, t in examples() if n not in ELSEWHERE])
def test_an_example_runs(name: str, text: str, names: dict[str, Any]) -> None:
    exec(compile(text.replace('"bracket.stl"', '"bracket.obj"'), f"<{name}>", "exec"), names)
