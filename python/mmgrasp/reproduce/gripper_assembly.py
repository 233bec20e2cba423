"""P1 5.4 on the motor of thirteen parts: the grippers as they are built (figure 5.14), and the product put together with them (figure 5.16)."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._core import (
    CollisionChecker,
    Cylinder,
    Gripper,
    GripperActuator,
    LinkShape,
    World,
    assembly_grasps,
    finger_length_range,
    free_gripper,
    minimal_grippers,
)
from ..grippers.assembly_file import FingerChoice
from ..grippers.motor_product import CONTACT, ORDER, motor_product
from ..grippers.planning import FINGERS_OF, GripperPlan, operation_of, options_of, plan_grippers
from ..viz.gripper_pictures import gripper_bodies
from ..viz.style import OBSTACLE, PART
from ..viz.two_sides import FROM_ABOVE_AND_ASIDE, Body, two_sides
from .drawing import figure
from .entry import Context, Entry, Result
from .gripper_sets import PAPER, SCALE, SEGMENTS, requirements, taken_by_paper
from .statements import CONFIRMED, REVERSED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRIVES = [GripperActuator("SMC MHF2-12D2", 0.048), GripperActuator("SMC MHSL3-32D", 0.008, fingers=3)]
MARGIN = 0.0005  # of the opening: P1's grippers, too, are "slightly larger than the calculation results" [m]
FINGERS = FingerChoice(
    width=0.008, thickness=0.005, clearance=0.00025, opening_margin=MARGIN, min_contact=1e-3 * SCALE * CONTACT
)
LONG = {"5": (3, 40, 41), "8": (3, 40, 50), "9": (3, 40, 41), "10": (2, 17, 4.5), "13": (3, 37.5, 22.7)}
"""Segments of figure 5.13 that ask for long fingers: fingers, opening, least length [mm]."""


# --- figure 5.14 ------------------------------------------------------------------------------------------------------
def opening_of(gripper: Gripper, joint: float) -> float:
    """Diameter of the largest round bar between the pads at a position of the fingers, by the gripper's own files and the collision checker [m]."""
    group = free_gripper(gripper)
    checker_group = group.with_reference({"finger_1_joint": joint})
    middle = _core.pose([0, 0, gripper.palm_height + gripper.finger_length - 0.004])
    low, high = 0.0, 2 * gripper.max_opening
    while high - low > 1e-7:
        bar = (low + high) / 2
        world = World()
        world.add("bar", [LinkShape(Cylinder(bar / 2, 0.004))], middle)
        if CollisionChecker(group.robot, world, checker_group).is_free(np.zeros(6)):
            low = bar
        else:
            high = bar
    return low


def least_stroke(fingers: int, top: float, parts: list[str]) -> float:
    """Stroke with which a gripper that opens to `top` takes these parts, too [mm]."""
    return max(min(top - SCALE * w for f, w, _ in SEGMENTS[part] if f == fingers) for part in parts)


def figure_5_14(context: Context) -> Result:
    found = minimal_grippers(
        requirements(), DRIVES, opening_margin=MARGIN, finger_width=FINGERS.width, finger_thickness=FINGERS.thickness
    )
    order = sorted(range(len(found.grippers)), key=lambda i: (found.grippers[i].fingers, found.grippers[i].max_opening))
    ours = [found.grippers[i] for i in order]
    result = Result(setup={"scale": SCALE, "strokes [mm]": [48, 8], "kept free at either end [mm]": 1e3 * MARGIN})
    result.drawing = {"grippers": [g.to_dict() for g in ours]}
    worst = 0.0
    taken = taken_by_paper(False)
    for k, (fingers, low, high, length) in enumerate(PAPER, 1):
        values = result.row({"whose": "paper", "gripper": k, "fingers": fingers})
        values["opening from [mm]"], values["to [mm]"] = (low, None), (high, None)
        values["finger length [mm]"] = (length, None)
        values["parts"] = (", ".join(part for part, gripper in taken.items() if gripper == str(k)), None)
    for k, gripper in enumerate(ours, 1):
        stroke = (gripper.max_opening - gripper.min_opening) / 2
        measured = [1e3 * opening_of(gripper, joint) for joint in (0.0, stroke)]
        worst = max(worst, abs(measured[0] - 1e3 * gripper.min_opening), abs(measured[1] - 1e3 * gripper.max_opening))
        held = [p for p, g in zip(found.parts, found.gripper_of_part, strict=True) if g == order[k - 1]]
        values = result.row({"whose": "ours", "gripper": k, "fingers": gripper.fingers})
        values["opening from [mm]"] = (None, round(1e3 * gripper.min_opening, 3))
        values["to [mm]"] = (None, round(1e3 * gripper.max_opening, 3))
        values["finger length [mm]"] = (None, round(1e3 * gripper.finger_length, 2))
        values["parts"] = (None, ", ".join(held))
        values["bar that fits closed [mm]"] = (None, round(measured[0], 3))
        values["bar that fits open [mm]"] = (None, round(measured[1], 3))
    result.exact("built from its files, each gripper opens and closes as designed, within 0.01 mm", worst < 0.01)
    result.exact("five grippers take all parts, proven least", found.lower_bound == len(ours) == 5)
    left = [part for part, gripper in taken.items() if gripper == "-"]
    result.answered(f"four grippers take all 13 parts: {13 - len(left)} of 13", REVERSED if left else CONFIRMED)
    result.notes.append(
        f"With one drive of three fingers for parts {', '.join(left)}, too, the paper's second gripper would have to close from 22 mm by "
        f"{least_stroke(3, 22.0, left):.3g} mm; its stroke is 8 mm."
    )
    return result


def draw_figure_5_14(result: dict[str, Any]) -> Figure:
    grippers = [Gripper(**values) for values in result["drawing"]["grippers"]]
    fig, axes = figure(11.0, 4.4, columns=3, rows=2)
    for axis in axes:
        axis.axis("off")
    assembly = motor_product(SCALE, DRIVES, FINGERS)
    axes[0].imshow(two_sides(_placed(assembly, ORDER, ()), FROM_ABOVE_AND_ASIDE, side=360))
    axes[0].set_title("the product and, beside it, parts 7 and 9 to 12", fontsize=9)
    for axis, gripper in zip(axes[1:], grippers, strict=False):
        bodies = gripper_bodies(gripper, gripper.max_opening, np.diag([1.0, -1.0, -1.0, 1.0]))
        axis.imshow(two_sides(bodies, side=360))
        axis.set_title(
            f"{gripper.fingers} fingers, {1e3 * gripper.min_opening:.1f} to {1e3 * gripper.max_opening:.1f} mm",
            fontsize=9,
        )
    return fig


# --- figure 5.16 ------------------------------------------------------------------------------------------------------
@lru_cache(maxsize=2)
def assembled(quick: bool) -> GripperPlan:
    """The product planned from its meshes; `quick` up to part 5."""
    assembly = motor_product(SCALE, DRIVES, FINGERS)
    return plan_grippers(replace(assembly, steps=assembly.steps[: 5 if quick else None]))


def least_length(plan: GripperPlan, part: str, fingers: int, opening: float) -> float | None:
    """Least finger length by which a segment is held from above, at full size [mm]."""
    step = next(step for step in plan.assembly.steps if step.name == part)
    operation = operation_of(plan.assembly, step)
    (placed,) = operation.active
    options = options_of(plan.assembly)
    least = None
    for segment, primitive in enumerate(plan.primitives[part]):
        if FINGERS_OF.get(primitive.kind) != fingers:
            continue
        body = plan.segmentations[part].segments[segment]
        for grasp in assembly_grasps(placed, body, primitive, plan.assembly.actuators, **options):
            if grasp.T_active_tool[2, 2] > -0.999 or abs(1e3 * grasp.opening / SCALE - opening) > 0.2:
                continue
            lengths = finger_length_range(grasp, operation)
            if lengths.free and (least is None or lengths.shortest < least):
                least = lengths.shortest
    return None if least is None else round(1e3 * least / SCALE, 3)


def figure_5_16(context: Context) -> Result:
    plan = assembled(context.quick)
    found = plan.result
    result = Result(setup={"scale": SCALE, "strokes [mm]": [48, 8], "overlap of pad and part [mm]": SCALE * CONTACT})
    result.drawing = {"operations": []}
    worst = 0.0
    if found is None or not found.grippers:
        result.exact("every operation has a gripper", False)
        return result
    for i, name in enumerate(found.parts):
        gripper, grasp = found.grippers[found.gripper_of_part[i]], plan.grasps[found.requirement_of_part[i]]
        values = result.row({"part": name})
        values["gripper"] = (None, found.gripper_of_part[i] + 1)
        values["opening [mm]"] = (None, round(1e3 * grasp.opening, 2))
        met = plan.rehearsed[name]
        values["met"] = ("nothing", met or "nothing")
        if name in LONG:
            fingers, opening, printed = LONG[name]
            ours = least_length(plan, name, fingers, opening)
            values["held at [mm]"] = (opening, opening if ours is not None else None)
            values["least finger length, full size [mm]"] = (printed, ours)
            worst = max(worst, np.inf if ours is None else abs(ours - printed))
        result.drawing["operations"].append(
            {
                "part": name,
                "gripper": gripper.to_dict(),
                "opening": grasp.opening,
                "T": np.asarray(grasp.T_active_tool).tolist(),
            }
        )
    met_by = [name for name, met in plan.rehearsed.items() if met]
    count = len(plan.assembly.steps)
    result.answered(
        f"no collision between gripper and subassemblies: {count - len(met_by)} of {count} operations",
        REVERSED if met_by else CONFIRMED,
    )
    result.exact("the lengths that figure 5.13 prints are found again within 0.1 mm", worst <= 0.1)
    result.exact("as few grippers as can be, proven", found.lower_bound == len(found.grippers))
    if not context.quick:
        result.exact("five grippers from the meshes, as from the openings of figure 5.13", len(found.grippers) == 5)
    result.notes.append(
        "The paper shows photographs; heights and places are ours, made so that the printed lengths follow (`mmgrasp.grippers.motor_product`): from mesh to segment, grasp and length they are "
        "found, not given. What the gripper meets is told by the collision checker, with the gripper's own files, on the approach, on the way and while it lets go."
    )
    return result


def _placed(assembly: Any, names: tuple[str, ...] | list[str], active: tuple[str, ...]) -> list[Body]:
    bodies: list[Body] = []
    for name in names:
        mesh, pose = assembly.parts[name].mesh, assembly.parts[name].pose
        vertices = np.asarray(mesh.vertices) @ pose[:3, :3].T + pose[:3, 3]
        bodies.append((vertices, np.asarray(mesh.triangles), PART if name in active else OBSTACLE))
    return bodies


def draw_figure_5_16(result: dict[str, Any]) -> Figure:
    seen = result["drawing"]["operations"]
    columns = 3
    fig, axes = figure(11.0, 1.95 * -(-len(seen) // columns), columns=columns, rows=-(-len(seen) // columns))
    for axis in axes:
        axis.axis("off")
    assembly = motor_product(SCALE, DRIVES, FINGERS)
    steps = {step.name: step for step in assembly.steps}
    for axis, operation in zip(axes, seen, strict=False):
        step = steps[operation["part"]]
        bodies = _placed(assembly, [*step.passive[1:], *step.active], tuple(step.active))
        gripper = Gripper(**operation["gripper"])
        bodies += gripper_bodies(gripper, operation["opening"], np.array(operation["T"]))
        axis.imshow(two_sides(bodies, FROM_ABOVE_AND_ASIDE, side=360))
        axis.set_title(f"part {step.name}", fontsize=9)
    return fig


ENTRIES = [
    Entry("p1-figure-5.14", "The grippers of thirteen parts as they are built", figure_5_14, draw_figure_5_14),
    Entry("p1-figure-5.16", "Thirteen parts put together by their grippers", figure_5_16, draw_figure_5_16),
]
