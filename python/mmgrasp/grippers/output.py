"""What `mmgrasp grippers` writes beside pictures and report: result.json, and each gripper's files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import AssemblyGrasp, HeldLoad, SegmentRequirement
from .._files import write_file
from .planning import GripperPlan

GRIPPER_FOLDERS = "gripper_*"
GRIPPER_FILES = ("result.json", "report.html", "files.json", GRIPPER_FOLDERS, "operation_*.png", "segments_*.png")


def write_results(plan: GripperPlan, folder: Path) -> None:
    """result.json, and gripper_<number>/ with gripper.urdf, gripper.srdf and finger.stl for each gripper."""
    write_file(folder / "result.json", json.dumps(result_to_dict(plan), indent=1, allow_nan=False) + "\n")
    if plan.result is not None:
        for gripper in plan.result.grippers:
            gripper.to_urdf(folder / gripper.name)


def result_to_dict(plan: GripperPlan) -> dict[str, Any]:
    """The answer in plain values: SI units."""
    assembly, result = plan.assembly, plan.result
    out: dict[str, Any] = {
        "format": "mmgrasp-grippers-result",
        "mmgrasp": _core.__version__,
        "assembly": {"name": assembly.name, "source": assembly.source},
        "outcome": plan.outcome.name,
        "missing": plan.missing,
        "help": plan.help,
        "notes": plan.notes,
        "left_out": [{"requirement": r.requirement, "met": r.met} for r in plan.left_out],
        "rehearsals": plan.rehearsals,
        "grippers": [],
        "operations": [],
        "segments": [
            {
                "operation": f.step,
                "part": f.part,
                "segment": f.segment,
                "name": f.name,
                "primitive": f.kind,
                "fingers": f.fingers,
                "grasps": f.tried,
                "free": f.free,
                "refused": f.refused,
                "requirements": f.requirements,
            }
            for f in plan.fates
        ],
        "requirements": [
            _requirement(r, g) | ({} if h is None else {"held": _held(h)})
            for r, g, h in zip(plan.requirements, plan.grasps, plan.holdings, strict=True)
        ],
    }
    if result is None:
        return out
    out["lower_bound"] = result.lower_bound
    out["changes"] = result.changes
    out["changes_bound"] = result.changes_bound
    out["preference_finished"] = result.preference_finished
    out["uncovered"] = result.uncovered
    out["explanations"] = result.explanations
    out["grippers"] = [g.to_dict() for g in result.grippers]
    if result.grippers:
        out["operations"] = [
            {
                "operation": part,
                "gripper": result.grippers[result.gripper_of_part[i]].name,
                "requirement": result.requirement_of_part[i],
                "met": plan.rehearsed.get(part, ""),
            }
            for i, part in enumerate(result.parts)
        ]
    return out


def _requirement(requirement: SegmentRequirement, grasp: AssemblyGrasp) -> dict[str, Any]:
    return {
        "operation": requirement.part,
        "segment": requirement.segment,
        "fingers": requirement.fingers,
        "opening": requirement.opening,
        "min_finger_length": requirement.min_finger_length,
        "max_finger_length": requirement.max_finger_length,
        "clearance": requirement.clearance,
        "least_min_opening": requirement.least_min_opening,
        "max_stroke": requirement.max_stroke,
        "T_assembly_tips": np.asarray(grasp.T_active_tool).tolist(),
    }


def _held(held: HeldLoad) -> dict[str, Any]:
    return {
        "safety": held.safety if np.isfinite(held.safety) else None,
        "insertion_moment": held.insertion_moment,
        "pad_torque": held.pad_torque,
        "contact_area": held.contact_area,
    }
