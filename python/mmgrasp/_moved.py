"""Where names are that used to be in the root of the package."""

from __future__ import annotations

import dis
import sys

from . import base, collision, grasping, mapping, optim, part_supply, planning, robot, scenario, verify

ROOMS = (robot, collision, planning, grasping, base, mapping, optim, part_supply, scenario, verify)

RENAMED = {
    "CandidateGrasp": "mmgrasp.Grasp",
    "CarryPlace": "mmgrasp.base.PlaceRegion",
    "FingerJoint": "mmgrasp.grasping.HandJoint",
    "Gripper": "mmgrasp.Hand",
    "PipeGrasp": "mmgrasp.Grasp",
    "ScoredGrasp": "mmgrasp.Grasp",
    "PartSupplyPlan": "mmgrasp.part_supply.ScenarioPlan",
    "PartSupplyResult": "mmgrasp.base.PartSupplyPlan",
    "ToolCone": "mmgrasp.planning.OrientationConstraint",
    "least_stops": "mmgrasp.base.plan_stops_exact",
    "minimal_stops": "mmgrasp.base.cover_from_intersections",
    "line_grasp_probability": "mmgrasp.grasping.LineGrasp",
    "push_grasp_tasks": "mmgrasp.DriveByTask",
    "solve_part_supply": "mmgrasp.plan_part_supply",
    "drive_by": "mmgrasp.part_supply.drive_by",
    "plan_file": "mmgrasp.part_supply.plan_file",
    "verification": "mmgrasp.part_supply.verification",
}
PROBLEMS = {
    "random_trays": ("TrayScan", "parts_of_grasps", "scan_random_tray", "scan_tray", "union_of_grasps"),
    "storerooms": (),
    "pipe_cells": (),
    "motion_bench": (),
    "motion_bench_run": (),
}


def is_import() -> bool:
    """Whether the caller's caller asks by `from mmgrasp import ...`."""
    frame = sys._getframe(2)
    return dis.opname[frame.f_code.co_code[frame.f_lasti]] == "IMPORT_FROM"


def place_of(name: str) -> str | None:
    """The full new name of something that the root had, or that is in one of the rooms; None: unknown."""
    if name.startswith("_"):
        return None
    if name in RENAMED:
        return RENAMED[name]
    for module, names in PROBLEMS.items():
        if name == module:
            return f"mmgrasp.problems.{name}"
        if name in names:
            return f"mmgrasp.problems.{module}.{name}"
    return next((f"{room.__name__}.{name}" for room in ROOMS if hasattr(room, name)), None)
