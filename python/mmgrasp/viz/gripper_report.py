"""The report of an assembly's grippers: one self-contained page."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path

from .. import _core
from .._core import HeldLoad
from ..grippers.planning import GripperPlan
from .gripper_pictures import picture_name
from .report import CSS, plural, table
from .segment_picker import picker_html


def gripper_report_html(plan: GripperPlan, pictures: Path | None) -> str:
    """The page as text; pictures in the folder are embedded."""
    name = escape(plan.assembly.name)
    sections = [
        _headline(plan),
        _obstacles(plan),
        _notes(plan),
        _grippers(plan),
        _operations(plan, pictures),
        _segments(plan, pictures),
        picker_html(plan),
    ]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{name} - mmgrasp grippers</title><style>{CSS}</style></head><body><main>"
        + "".join(sections)
        + "</main></body></html>\n"
    )


def _millimetres(length: float) -> str:
    return f"{1e3 * length:.1f}"


def proof(plan: GripperPlan) -> str:
    """What is proven of the number of grippers, and for which grasps, in a few words."""
    result = plan.result
    if result is None or not result.grippers:
        return "no set of grippers"
    if result.lower_bound >= result.cost * (1 - 1e-9):
        changes = "" if result.changes_bound < result.changes else ", nor fewer changes"
        left = "" if not plan.left_out else ", for the grasps that rehearsals did not refuse"
        return f"proven: no set of grippers costs less{changes}{left}"
    return f"not proven: a set might cost {result.lower_bound:g}"


def _headline(plan: GripperPlan) -> str:
    assembly, result = plan.assembly, plan.result
    lead = (
        f"<p class='lead'>{plural(len(assembly.parts), 'part')}, {plural(len(assembly.steps), 'operation')}, "
        f"{plural(len(assembly.actuators), 'drive')}; mmgrasp {_core.__version__}</p>"
    )
    if result is None or not plan.solved:
        return f"<h1>No grippers for {escape(assembly.name)}: {plan.outcome.name.replace('_', ' ')}</h1>{lead}"
    cards = [
        (str(len(result.grippers)), f"grippers; {proof(plan)}"),
        (str(result.changes), "changes of the gripper"),
        (str(sum(f.free for f in plan.fates)), "collision-free grasps"),
    ]
    tiles = "".join(f'<div class="card"><b>{escape(a)}</b><span>{escape(b)}</span></div>' for a, b in cards)
    return f"<h1>Grippers for {escape(assembly.name)}</h1>{lead}<div class='cards'>{tiles}</div>"


def _obstacles(plan: GripperPlan) -> str:
    if plan.solved:
        return ""
    faults = plan.faults + [f"Would help: {change}" for change in plan.help]
    if not faults:
        return ""
    return "<h2>What stands in the way</h2>" + "".join(f'<div class="bad">{escape(f)}</div>' for f in faults)


def _notes(plan: GripperPlan) -> str:
    notes = list(plan.notes)
    if plan.solved:
        notes += [f"left out, refused in rehearsal: {refused}" for refused in plan.refused_in_rehearsal]
    if not notes:
        return ""
    return "<h2>To look at</h2><ul>" + "".join(f"<li>{escape(note)}</li>" for note in notes) + "</ul>"


def _grippers(plan: GripperPlan) -> str:
    result = plan.result
    if result is None or not result.grippers:
        return ""
    rows = []
    for i, g in enumerate(result.grippers):
        takes = [part for part, which in zip(result.parts, result.gripper_of_part, strict=True) if which == i]
        rows.append(
            [
                escape(g.name),
                escape(g.actuator),
                str(g.fingers),
                f"{_millimetres(g.min_opening)} to {_millimetres(g.max_opening)}",
                _millimetres(g.finger_length),
                escape(", ".join(takes)),
            ]
        )
    head = ["Gripper", "Drive", "Fingers", "Opening [mm]", "Finger length [mm]", "Takes"]
    return "<h2>The grippers</h2>" + table(head, rows, {2, 4})


def _operations(plan: GripperPlan, pictures: Path | None) -> str:
    result = plan.result
    if result is None or not result.grippers:
        return ""
    out = "<h2>The operations</h2>"
    rows = []
    for i, part in enumerate(result.parts):
        r = plan.requirements[result.requirement_of_part[i]]
        least = f"at least {_millimetres(r.min_finger_length)}"
        most = "" if r.max_finger_length is None else f", at most {_millimetres(r.max_finger_length)}"
        gripper = result.grippers[result.gripper_of_part[i]].name
        row = [escape(part), escape(gripper), escape(r.segment), _millimetres(r.opening), least + most]
        rows.append(row + _held(plan.holdings[result.requirement_of_part[i]]))
    head = ["Operation", "Gripper", "Held by", "Opening [mm]", "Fingers [mm]"]
    if plan.assembly.holding is not None:
        head += ["Load may grow by", "Moment of the insertion [N m]", "Torque a pad holds [N m]", "A pad touches [mm²]"]
    out += table(head, rows, {3, 5, 6, 7, 8})
    return out + "".join(
        _figure(pictures, picture_name("operation", i, s.name), s.name) for i, s in enumerate(plan.assembly.steps)
    )


def _held(held: HeldLoad | None) -> list[str]:
    if held is None:
        return []
    numbers = (held.safety, held.insertion_moment, held.pad_torque, 1e6 * held.contact_area)
    return [f"{round(number, 6):.3g}" for number in numbers]


def _segments(plan: GripperPlan, pictures: Path | None) -> str:
    rows = [
        [
            escape(f.step),
            escape(f.part),
            escape(f.name),
            f.kind,
            str(f.fingers) if f.fingers else "-",
            f"{f.free} of {f.tried}",
            escape(f.refused) if f.refused else "can be held",
        ]
        for f in plan.fates
    ]
    head = ["Operation", "Part", "Segment", "Primitive", "Fingers", "Free grasps", "Verdict"]
    out = "<h2>The segments</h2>" + table(head, rows, {4})
    return out + "".join(
        _figure(pictures, picture_name("segments", i, n), f"Segments of {n}") for i, n in enumerate(plan.segmentations)
    )


def _figure(pictures: Path | None, file: str, caption: str) -> str:
    path = None if pictures is None else pictures / file
    if path is None or not path.exists():
        return ""
    data = base64.b64encode(path.read_bytes()).decode()
    text = escape(caption)
    return f'<figure><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>'
