"""The grippers of an assembly as its file describes it: what the library's `plan_grippers` answers, by the names of the file."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import (
    AssemblyGrasp,
    AssemblyOperation,
    FingerGrip,
    FittedPrimitive,
    HeldLoad,
    HoldingRequirement,
    MeshSegmentation,
    MinimalGrippersResult,
    Outcome,
    PlacedMesh,
    RefusedGrasp,
    SegmentFate,
    SegmentRequirement,
)
from .._progress import Progress
from .assembly_file import Assembly, AssemblyStep

FINGERS_OF = {"box": 2, "cylinder": 3}  # P1 5.2.1: as SegmentFate.fingers, which the library fills by the same rule


@dataclass
class GripperPlan:
    """The grippers, and how it came to them."""

    assembly: Assembly
    segmentations: dict[str, MeshSegmentation]
    primitives: dict[str, list[FittedPrimitive]]
    fates: list[SegmentFate]
    requirements: list[SegmentRequirement]
    grasps: list[AssemblyGrasp]
    """One per requirement: T_active_tool is the tool frame in the assembly, tips in its plane, parts in their places."""
    missing: list[str]
    """Operations that cannot be done, each with the reasons."""
    result: MinimalGrippersResult | None
    outcome: Outcome = Outcome.infeasible
    """As `PlanGrippersResult.outcome`."""
    help: list[str] = field(default_factory=list)
    """Single changes each of which gives an operation its grasp."""
    rehearsed: dict[str, str] = field(default_factory=dict)
    """For each operation what the chosen gripper met when the operation was gone through again by the collision checker; '' nothing."""
    holdings: list[HeldLoad | None] = field(default_factory=list)
    """One per requirement; None where the assembly says nothing of weight and insertion."""
    left_out: list[RefusedGrasp] = field(default_factory=list)
    """Grasps that a rehearsal refused: the set is the least for the others."""
    rehearsals: int = 0
    """So many sets were rehearsed."""

    @property
    def segment_names(self) -> dict[str, list[str]]:
        """For each part that is moved the names of its segments: "cylinder_1", the largest cylinder."""
        return {name: _core.segment_names(primitives) for name, primitives in self.primitives.items()}

    @property
    def notes(self) -> list[str]:
        """What is wrong with the parts' meshes, what was mended, parts that are in nobody's way, and parts without a way."""
        out = []
        met = {name for step in self.assembly.steps for name in step.active + step.passive}
        for name, part in self.assembly.parts.items():
            if not part.mesh.closed:
                out.append(f"{name}: the mesh is open: it has no inside that others could be seen to stand in")
            out += [f"{name}: {note}" for note in part.mesh_notes]
            if name not in met:
                out.append(f"{name}: no operation moves it, and none has it in onto: it is in nobody's way")
        for step in self.assembly.steps:
            if len(step.path) == 1 and step.passive:
                stays = ", ".join(step.passive)
                out.append(
                    f"{step.name}: has neither from nor path: how it comes to its place past {stays} is not looked at"
                )
        return out

    @property
    def refused_in_rehearsal(self) -> list[str]:
        """What the grasps met that rehearsals refused, by operation, with how many met it."""
        counts = Counter((self.requirements[r.requirement].part, r.met) for r in self.left_out)
        return [f"{step}: {met}" + (f" ({n} times)" if n > 1 else "") for (step, met), n in counts.items()]

    @property
    def faults(self) -> list[str]:
        """Why there are no grippers, each reason once."""
        return self.missing + ([] if self.result is None else self.result.explanations) or self.refused_in_rehearsal

    @property
    def solved(self) -> bool:
        """Every operation has a gripper that was rehearsed."""
        return (
            self.outcome in (Outcome.solved, Outcome.approximate)
            and self.result is not None
            and not self.missing
            and not self.result.uncovered
            and not any(self.rehearsed.values())
        )


def operation_of(assembly: Assembly, step: AssemblyStep) -> AssemblyOperation:
    """An operation in the frame of the assembly."""

    def placed(name: str) -> PlacedMesh:
        part = assembly.parts[name]
        return PlacedMesh(name, part.mesh, part.pose)

    return AssemblyOperation(
        [placed(name) for name in step.active],
        [placed(name) for name in step.passive],
        np.array(step.path),
        name=step.name,
        insertion_force=step.insertion_force,
        hole=step.hole,
    )


def holding_of(assembly: Assembly) -> HoldingRequirement | None:
    """What the assembly's file asks of grasps; None: nothing."""
    choice = assembly.holding
    if choice is None:
        return None
    grip = FingerGrip(
        force=choice.force, friction=choice.friction, modulus=choice.modulus, pad_radius=choice.pad_radius
    )
    return HoldingRequirement(grip, density=choice.density, least_safety=choice.least_safety)


def options_of(assembly: Assembly) -> dict[str, Any]:
    """Fingers and options of the file as keywords of the library's call."""
    fingers = assembly.fingers
    return {
        "finger_width": fingers.width,
        "finger_thickness": fingers.thickness,
        "clearance": fingers.clearance,
        "shortest_finger": fingers.shortest,
        "longest_finger": fingers.longest,
        "opening_margin": fingers.opening_margin,
        "length_margin": fingers.length_margin,
        "min_contact": fingers.min_contact,
        "tip_clearance": fingers.tip_clearance,
        "directions": fingers.directions,
        **assembly.options,
    }


@checked
def plan_grippers(assembly: Assembly, *, progress: Progress = None) -> GripperPlan:
    """The least set of grippers for an assembly (P1 chapter 5): `mmgrasp.gripper_design.plan_grippers` for what a file says."""
    moved = [name for step in assembly.steps for name in step.active]
    found = _core.plan_grippers(
        [operation_of(assembly, step) for step in assembly.steps],
        assembly.actuators,
        keep_off=[k for name, part in assembly.parts.items() if name in moved for k in part.keep_off],
        holding=holding_of(assembly),
        progress=progress,
        **options_of(assembly),
    )
    names = [step.name for step in assembly.steps]
    return GripperPlan(
        assembly,
        {name: found.parts[name].segmentation for name in moved},
        {name: found.parts[name].primitives for name in moved},
        found.fates,
        found.requirements,
        found.grasps,
        found.missing,
        found.set,
        found.outcome,
        found.help,
        dict(zip(names, found.met, strict=True)) if found.met else {},
        list(found.holdings) or [None] * len(found.requirements),
        found.left_out,
        found.rehearsals,
    )
