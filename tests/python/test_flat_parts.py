"""Parts thinner than the pads are long: grasped with the tips flush with their far face, with default options."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from flat_parts import PAD, box, disc, low_tray, prism

FLAT = [0.05, 0.04, 0.016]
CUBE = [0.026, 0.026, 0.026]
PARTS: dict[str, tuple[dict[str, Any], str]] = {
    "box": ({"box": FLAT}, ""),
    "box as a mesh": ({"mesh": "part.stl"}, prism(box(FLAT), FLAT[2])),
    "cube as a mesh": ({"mesh": "part.stl"}, prism(box(CUBE), CUBE[2])),
    "disc": ({"cylinder": {"radius": 0.03, "length": 0.01}}, ""),
    "disc as a mesh": ({"mesh": "part.stl"}, prism(disc(0.03), 0.01)),
    "box of two shapes": (
        {"shapes": [{"box": [0.025, 0.04, 0.016], "pose": {"xyz": [x, 0, 0]}} for x in (-0.0125, 0.0125)]},
        "",
    ),
}


def tips_flush(grasp: mg.Grasp) -> bool:
    """Where the sampler put the hand."""
    assert isinstance(grasp.provenance, mg.grasping.ContactPairProvenance)
    return grasp.provenance.tips_flush


@pytest.mark.parametrize("name", PARTS)
def test_parts_that_lie_flat_are_grasped_by_default(
    name: str, storeroom: dict[str, Any], write: Callable[..., Path]
) -> None:
    part, mesh = PARTS[name]
    path = write(low_tray(storeroom, part, {"xyz": [0.0, 0.0]}))
    if mesh:
        (path.parent / "part.stl").write_text(mesh)
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan
    assert mg.verify_plan(plan.to_dict(), scenario=path, samples=100).faults == []
    placed = plan.scenario.trays[0].tray.parts[0]
    grasp = placed.grasps[plan.picks[0].grasp]
    T = placed.T_world_part @ grasp.T_object_hand
    tips = T[:3, 3] + PAD / 2 * T[:3, 0]  # the storeroom's hand approaches along x
    floor = plan.scenario.trays[0].tray.T_world_tray[2, 3]
    assert tips[2] >= floor + 0.001 - 1e-9  # parts rest a millimetre above the floor
    assert name == "cube as a mesh" or tips_flush(grasp)


def test_tips_are_flush_by_closed_form() -> None:
    """The middle of the pads stands half a pad before the far face, whatever the part is made of."""
    hand = mg.Hand("tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=PAD, finger_width=0.022)
    grasps = mg.grasping.sample_grasps([mg.LinkShape(mg.Box(FLAT))], hand, max_grasps=10_000)
    flush = [g for g in grasps if tips_flush(g)]
    down = [g for g in flush if g.T_object_hand[2, 0] < -1 + 1e-9]
    heights = [g.T_object_hand[2, 3] for g in down]
    assert len(down) == 2 * 3 * 2  # two closing axes, three positions across, the hand either way
    assert heights == pytest.approx([PAD / 2 - FLAT[2] / 2] * len(down), abs=1e-12)
    assert np.all([g.to_dict()["provenance"]["tips_flush"] for g in flush])
