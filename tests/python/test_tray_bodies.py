"""Trays as storerooms have them: containers by name, walls of any size, flow racks, shelves with a roof, bodies of their own."""

from __future__ import annotations

import copy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.base import tray_shapes
from mmgrasp.scenario.tray_body import TrayBody

PARTS = {"type": "block", "grid": [2, 2], "spacing": [0.12, 0.14]}


def cell(trays: list[dict[str, Any]]) -> dict[str, Any]:
    """The shipped cell of the omnidirectional robot between its walls, with other trays."""
    raw: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "omni_cell.yaml").read_text())
    raw["obstacles"] = [o for o in raw["obstacles"] if o["name"].startswith("wall")]
    raw["part_types"] = {"block": {"box": [0.05, 0.04, 0.06]}}
    raw["trays"] = [{"parts": PARTS, **tray} for tray in trays]
    return raw


FLOW_RACK = {
    "name": "klt",
    "pose": {"xyz": [1.72, -0.55, 0.80], "rpy": [0, -0.14, 0]},  # 8 degrees down towards the robot
    "size": "R-KLT 4315",
    "walls": {"front": 0.04},
}
SHELF = {
    "name": "shelf",
    "pose": {"xyz": [1.68, 0.3, 0.80]},
    "size": [0.35, 0.45, 0.05],
    "wall": 0.02,
    "walls": {"front": 0.0},
    "roof": 0.45,
}


def solid(body: TrayBody, points: np.ndarray) -> np.ndarray:
    """Whether points in a tray's frame lie in floor, a wall or the roof, by its measures alone."""
    (x, y, z), (tx, ty, floor) = body.size, body.wall
    heights = body.heights or (z - floor,) * 4
    at = np.abs(points[:, :2])
    outside = (at > [x / 2, y / 2]).any(axis=1)
    px, py, pz = points.T
    # Front and back walls reach over the whole width, those at the sides stand between them.
    ends = at[:, 0] > x / 2 - tx
    height = np.where(ends, np.where(px < 0, heights[0], heights[1]), np.where(py > 0, heights[2], heights[3]))
    walled = (ends | (at[:, 1] > y / 2 - ty)) & (pz > 0) & (pz < height)
    covered = (pz > body.roof) & (pz < body.roof + floor) if body.roof is not None else np.zeros(len(points), bool)
    return np.asarray(~outside & (walled | ((pz < 0) & (pz > -floor)) | covered))


@pytest.mark.parametrize(
    "body",
    [
        TrayBody((0.3, 0.4, 0.1)),
        TrayBody((0.3, 0.4, 0.1), (0.02, 0.03, 0.01)),
        TrayBody((0.3, 0.4, 0.1), (0.02, 0.03, 0.01), (0.0, 0.09, 0.03, 0.05), 0.15),
    ],
)
def test_the_boxes_fill_what_the_measures_say(body: TrayBody) -> None:
    points = np.random.default_rng(1).uniform([-0.2, -0.25, -0.02], [0.2, 0.25, 0.2], (20000, 3))
    inside = np.zeros(len(points), bool)
    for shape in body.shapes():
        low, high = shape.bounds
        inside |= ((points > low) & (points < high)).all(axis=1)
    assert (inside == solid(body, points)).all()
    assert TrayBody.from_dict(body.to_dict()) == body


def test_usual_trays_are_as_before() -> None:
    usual, stated = TrayBody((0.3, 0.4, 0.1)), TrayBody((0.3, 0.4, 0.1), heights=(0.095,) * 4)
    assert usual.to_dict() == {"size": [0.3, 0.4, 0.1]}
    same = tray_shapes([0.3, 0.4, 0.1], 0.005)
    for own in (usual, stated):
        for mine, shape in zip(own.shapes(), same, strict=True):
            np.testing.assert_allclose(mine.bounds, shape.bounds, atol=1e-12)


def test_containers_by_name(write: Callable[..., Path]) -> None:
    """Outer lengths of VDA 4500; the inner ones of a 4322 are its maker's."""
    names = ["R-KLT 4322", "R-KLT 4322 lengthwise", "R-KLT 6429"]
    for name, inner, outer in zip(
        names,
        [(0.265, 0.346), (0.346, 0.265), (0.364, 0.544)],
        [(0.297, 0.396, 0.213), (0.396, 0.297, 0.213), (0.396, 0.594, 0.280)],
        strict=True,
    ):
        tray = mg.load_scenario(write(cell([FLOW_RACK | {"size": name, "walls": {}}]), "klt.yaml")).trays[0]
        assert tray.body is not None and tray.tray.size == pytest.approx(outer)
        assert tray.body.inner == pytest.approx(inner)
    low, high = np.min([s.bounds[0] for s in tray.walls], 0), np.max([s.bounds[1] for s in tray.walls], 0)
    assert high - low == pytest.approx(outer)


@pytest.fixture(scope="module")
def rack_and_shelf(write: Callable[..., Path]) -> tuple[Path, mg.part_supply.ScenarioPlan]:
    path = write(cell([FLOW_RACK, SHELF]), "rack.yaml")
    return path, mg.plan_part_supply(path)


def test_a_flow_rack_and_a_shelf_are_planned_and_verified(
    rack_and_shelf: tuple[Path, mg.part_supply.ScenarioPlan],
) -> None:
    path, plan = rack_and_shelf
    assert plan.outcome == mg.Outcome.solved and len(plan.picks) == 8
    assert mg.verify_plan(plan.to_dict(), scenario=path, samples=100).faults == []
    part = plan.scenario.trays[0].tray.parts[0]  # lies on the tilted floor, a millimetre above it
    up = part.T_world_part[:3, 2]
    assert np.degrees(np.arccos(up[2])) == pytest.approx(np.degrees(0.14))
    above = (np.linalg.inv(plan.scenario.trays[0].tray.T_world_tray) @ part.T_world_part)[2, 3]
    assert above == pytest.approx(0.03 + 0.001)


@pytest.mark.parametrize(
    ("tray", "key", "value"),
    [
        (0, "wall", [0.016, 0.025, 0.03]),
        (0, "walls", {"front": 0.05, "back": 0.109, "left": 0.109, "right": 0.109}),
        (1, "roof", 0.46),
        (1, "size", [0.35, 0.46, 0.05]),
    ],
)
def test_verify_compares_a_trays_body_with_its_measures(
    rack_and_shelf: tuple[Path, mg.part_supply.ScenarioPlan], tray: int, key: str, value: Any
) -> None:
    path, plan = rack_and_shelf
    changed = copy.deepcopy(plan.to_dict())
    assert changed["scenario"]["trays"][tray][key] != value
    changed["scenario"]["trays"][tray][key] = value
    faults = mg.verify_plan(changed, samples=1).faults
    assert any(f.code == "wrong-values" and f.where == f"scenario.trays[{tray}]" for f in faults)
    changed["scenario"]["trays"][tray]["own_body"] = True  # another body than the file's
    faults = mg.verify_plan(changed, scenario=path, samples=1).faults
    assert any(f.code == "scenario-changed" for f in faults)


def test_a_low_roof_keeps_hands_out(write: Callable[..., Path]) -> None:
    """Under a roof 5 mm above the parts no hand holds any of them; the same shelf without it is served."""
    for roof, solved in ((0.066, False), (None, True)):
        tray = {k: v for k, v in SHELF.items() if k != "roof"} | ({"roof": roof} if roof is not None else {})
        plan = mg.plan_part_supply(write(cell([tray | {"wall": 0.005}]), "roof.yaml"))
        assert (plan.outcome == mg.Outcome.solved) == solved
        if not solved:
            assert plan.obstructions[0].tray == "shelf" and plan.obstructions[0].stage == "grasp"


def test_a_tray_with_a_body_of_its_own(write: Callable[..., Path]) -> None:
    """A board with a rim behind, as shapes: what holds parts need not be a box."""
    board = {"box": [0.35, 0.45, 0.02], "pose": {"xyz": [0, 0, -0.01]}}
    rim = {"cylinder": {"radius": 0.01, "length": 0.4}, "pose": {"xyz": [0.16, 0, 0.01], "rpy": [1.5707963, 0, 0]}}
    tray = {k: v for k, v in SHELF.items() if k not in ("wall", "walls", "roof")} | {"body": {"shapes": [board, rim]}}
    path = write(cell([tray]), "board.yaml")
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved
    written = plan.to_dict()
    assert written["scenario"]["trays"][0]["own_body"] is True
    assert mg.verify_plan(written, scenario=path, samples=100).faults == []


def test_scanned_trays_stay_as_they_were(write: Callable[..., Path]) -> None:
    raw = yaml.safe_load((ASSETS / "scenarios" / "scanned_tray.yaml").read_text())
    for key, value, told in (
        ("roof", 0.5, "roof"),
        ("size", "R-KLT 4315", "size"),
        ("pose", {"xyz": [2.78, 0, 0.71], "rpy": [0, 0.1, 0]}, "level"),
    ):
        changed = copy.deepcopy(raw)
        scanned = next(t for t in changed["trays"] if "scan" in t)
        scanned[key] = value
        with pytest.raises(mg.InvalidInput, match=rf"scenario.yaml:\d+: trays.*{told}"):
            mg.load_scenario(write(changed))
