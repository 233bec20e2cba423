"""The grippers of an assembly: which segments can be held in which operation with which fingers, and the least set of grippers."""

from __future__ import annotations

import collections
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import (
    AssemblyGrasp,
    AssemblyOperation,
    FingerLengthRange,
    FittedPrimitive,
    MeshSegmentation,
    MinimalGrippersResult,
    Outcome,
    PlacedMesh,
    SegmentRequirement,
)
from .._progress import Progress
from .assembly_file import Assembly, AssemblyPart, AssemblyStep
from .holding import Held, OperationLoad, held_by, load_of, preference, rank
from .rehearsal import rehearse

PALM_MARGIN = 0.005  # [m]
FINGERS_OF = {"box": 2, "cylinder": 3}  # P1 5.2.1


SLIPS = "pads slip: the grasp does not hold weight and insertion"


@dataclass
class Found:
    """A grasp that meets nothing."""

    opening: float
    lengths: FingerLengthRange
    grasp: AssemblyGrasp
    held: Held | None


@dataclass
class SegmentFate:
    """What became of one segment of a part in one operation."""

    step: str
    part: str
    segment: int
    kind: str
    """Its primitive."""
    fingers: int
    """2, 3, or 0: no gripper suits its primitive."""
    tried: int = 0
    """Grasps of it."""
    free: int = 0
    """How many of those have some finger length."""
    refused: str = ""
    """Why it cannot be held, or what most of its grasps fell by."""
    requirements: list[int] = field(default_factory=list)
    """Numbers of the plan's requirements."""


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
    """Operations without any grasp, each with the reason."""
    result: MinimalGrippersResult | None
    rehearsed: dict[str, str] = field(default_factory=dict)
    """For each operation what the chosen gripper met when the operation was gone through again by the collision checker; '' nothing."""
    holdings: list[Held | None] = field(default_factory=list)
    """One per requirement; None where the assembly says nothing of weight and insertion."""
    loads: dict[str, OperationLoad | None] = field(default_factory=dict)
    """What each operation's grasps have to hold."""

    @property
    def outcome(self) -> Outcome:
        """infeasible: an operation without any grasp; not_found: a rehearsal met something; else the least set's."""
        if self.missing or self.result is None:
            return Outcome.infeasible
        if any(self.rehearsed.values()):
            return Outcome.not_found
        return self.result.outcome

    @property
    def solved(self) -> bool:
        """Every operation has a gripper that was rehearsed."""
        return (
            self.result is not None
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
        [placed(name) for name in step.active], [placed(name) for name in step.passive], np.array(step.path)
    )


def plan_grippers(assembly: Assembly, *, progress: Progress = None) -> GripperPlan:
    """The least set of grippers for an assembly (P1 chapter 5).

    Every part is cut into segments, each is given the primitive that fits best; boxes are for two jaws, cylinders for three centric fingers (5.2.1).
    A segment can be held in an operation when a grasp of it meets neither its own parts nor those that stay, with some finger length; the lengths are
    kept (5.3). Then the least set of grippers is chosen (5.3.4), and every operation is gone through again with the gripper
    itself, by the collision checker. With `assembly.holding` grasps that slip are refused, and of several segments that no
    more grippers could take the one is taken that bears the insertion most evenly, then most safely.
    """
    segmentations: dict[str, MeshSegmentation] = {}
    primitives: dict[str, list[FittedPrimitive]] = {}
    active = [name for step in assembly.steps for name in step.active]
    for i, name in enumerate(active):
        if progress is not None:
            progress("segments", i / len(active))
        part = assembly.parts[name]
        segmentations[name] = _core.segment_mesh(part.mesh)
        primitives[name] = _core.fit_primitives(part.mesh, segmentations[name].labels)
    plan = GripperPlan(assembly, segmentations, primitives, [], [], [], [], None)
    for i, step in enumerate(assembly.steps):
        if progress is not None:
            progress("grasps", i / len(assembly.steps))
        _add_requirements(plan, step)
    if plan.missing:
        return plan
    fingers = assembly.fingers
    options = {
        "shortest_finger": fingers.shortest,
        "longest_finger": fingers.longest,
        "opening_margin": fingers.opening_margin,
        "length_margin": fingers.length_margin,
        "finger_width": fingers.width,
        "finger_thickness": fingers.thickness,
        "progress": progress,
        **assembly.options,
    }
    if assembly.holding is None:
        plan.result = _core.minimal_grippers(plan.requirements, assembly.actuators, **options)
    else:
        values = preference(plan.requirements, plan.holdings)
        plan.result = _core.preferred_grippers(plan.requirements, values, assembly.actuators, **options)
    if plan.result.grippers:
        for i, step in enumerate(assembly.steps):
            if progress is not None:
                progress("rehearsal", i / len(assembly.steps))
            gripper = plan.result.grippers[plan.result.gripper_of_part[i]]
            grasp = plan.grasps[plan.result.requirement_of_part[i]]
            plan.rehearsed[step.name] = rehearse(assembly, gripper, grasp, operation_of(assembly, step))
    return plan


def _add_requirements(plan: GripperPlan, step: AssemblyStep) -> None:
    operation = operation_of(plan.assembly, step)
    plan.loads[step.name] = load_of(plan.assembly, step)
    before = len(plan.requirements)
    for name in step.active:
        part = plan.assembly.parts[name]
        for segment in range(len(plan.segmentations[name].segments)):
            fate = _judge(plan, step, operation, part, segment)
            plan.fates.append(fate)
    if len(plan.requirements) == before:
        reasons = [f"{f.part}, segment {f.segment}: {f.refused}" for f in plan.fates if f.step == step.name]
        plan.missing.append(f"{step.name}: no segment can be held; " + "; ".join(reasons))


def _judge(
    plan: GripperPlan, step: AssemblyStep, operation: AssemblyOperation, part: AssemblyPart, segment: int
) -> SegmentFate:
    primitive = plan.primitives[part.name][segment]
    fingers = FINGERS_OF.get(primitive.kind, 0)
    fate = SegmentFate(step.name, part.name, segment, primitive.kind, fingers)
    if segment in part.keep_off:
        fate.refused = "not to be touched"
    elif plan.segmentations[part.name].segments[segment].threaded:
        fate.refused = "a screw thread"
    elif not fingers:
        fate.refused = f"a {primitive.kind}: neither parallel jaws nor centric fingers suit it"
    elif not primitive.widths:
        fate.refused = "no surface to hold"
    elif fingers not in {a.fingers for a in plan.assembly.actuators}:
        fate.refused = f"no actuator has {fingers} fingers"
    else:
        _try_grasps(plan, fate, operation, part)
    return fate


def _try_grasps(plan: GripperPlan, fate: SegmentFate, operation: AssemblyOperation, part: AssemblyPart) -> None:
    found: list[Found] = []
    causes: collections.Counter[str] = collections.Counter()
    least_safety = 0.0 if plan.assembly.holding is None else plan.assembly.holding.least_safety
    for grasp in segment_grasps(plan, part.name, fate.segment):
        fate.tried += 1
        lengths = _core.finger_length_range(grasp, operation)
        fingers = plan.assembly.fingers
        shortest = max(lengths.shortest, fingers.shortest)
        longest = min(lengths.longest, fingers.longest)
        if not lengths.free:
            causes[f"fingers meet {lengths.longest_by}"] += 1
        elif shortest > longest:
            limit = "longest" if lengths.shortest > fingers.longest else "shortest"
            causes[
                f"fingers of {1e3 * lengths.shortest:.4g} mm or more are asked by {lengths.shortest_by}, {limit} is "
                f"{1e3 * getattr(fingers, limit):.4g} mm"
            ] += 1
        else:
            held = held_by(grasp, plan.loads[fate.step])
            if held is not None and held.safety < least_safety:
                causes[SLIPS] += 1
            else:
                fate.free += 1
                found.append(Found(round(grasp.opening, 6), lengths, grasp, held))
    if not fate.tried:
        fate.refused = "no pair of opposite faces" if fate.fingers == 2 else "wider than any actuator opens"
    elif not found:
        cause, count = causes.most_common(1)[0]
        fate.refused = f"{cause} ({count} of {fate.tried} grasps)"
    for chosen in _undominated(found):
        lengths = chosen.lengths
        fate.requirements.append(len(plan.requirements))
        upper = lengths.longest if np.isfinite(lengths.longest) else None
        plan.holdings.append(chosen.held)
        plan.requirements.append(
            SegmentRequirement(
                fate.step,
                chosen.opening,
                segment=f"{fate.part}, segment {fate.segment}",
                fingers=fate.fingers,
                min_finger_length=lengths.shortest,
                max_finger_length=upper,
            )
        )
        plan.grasps.append(chosen.grasp)


def _undominated(found: list[Found]) -> list[Found]:
    """For each opening the grasps whose lengths no other one's hold, unless they hold better; the first of equals."""
    kept: list[Found] = []
    for f in sorted(found, key=lambda f: (f.opening, f.lengths.shortest, -f.lengths.longest, rank(f.held))):
        if not any(
            k.opening == f.opening
            and k.lengths.shortest <= f.lengths.shortest
            and k.lengths.longest >= f.lengths.longest
            and rank(k.held) <= rank(f.held)
            for k in kept
        ):
            kept.append(f)
    return kept


def segment_grasps(plan: GripperPlan, name: str, segment: int) -> list[AssemblyGrasp]:
    """Grasps of a part's box or cylinder in the assembly's frame, with the palm of the widest gripper that may take it."""
    part, primitive, choice = plan.assembly.parts[name], plan.primitives[name][segment], plan.assembly.fingers
    fingers = FINGERS_OF[primitive.kind]
    drives = [a for a in plan.assembly.actuators if a.fingers == fingers]
    widest = [a.max_opening for a in drives]
    options: dict[str, Any] = {
        "directions": choice.directions,
        "min_contact": choice.min_contact,
        "pad_length": max(0.02, choice.min_contact),
        "finger_width": choice.width,
        "finger_thickness": choice.thickness,
        "clearance": choice.clearance,
        "max_opening": 2.0 if None in widest else max(w for w in widest if w is not None),
    }
    if fingers == 2:
        faces = [int(f) for f in plan.segmentations[name].segments[segment].faces]
        grasps = _core.jaw_grasps(part.mesh, faces, **options)
    else:
        length = float(primitive.size[2])
        grasps = _core.centric_grasps(
            primitive.T_mesh_primitive, float(primitive.size[0]), -length / 2, length / 2, **options
        )
    stroke = max(a.stroke for a in drives)
    return [_placed(grasp, part.pose, stroke) for grasp in grasps]


def _placed(grasp: AssemblyGrasp, T_assembly_mesh: NDArray[np.float64], stroke: float) -> AssemblyGrasp:
    reach = (grasp.opening + stroke) / 2 + grasp.thickness
    return AssemblyGrasp(
        T_assembly_mesh @ grasp.T_active_tool,
        fingers=grasp.fingers,
        opening=grasp.opening,
        width=grasp.width,
        thickness=grasp.thickness,
        clearance=min(grasp.clearance, stroke / 2),
        palm_radius=float(np.hypot(reach, grasp.width / 2)) + PALM_MARGIN,
        contact_length=grasp.contact_length,
        contact_width=grasp.contact_width,
    )
