"""The report of a carried pipe: one self-contained page."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path

from .. import _core
from ..pipes.output import grasp_to_dict
from ..pipes.planning import PipePlan
from .report import CSS, clock, plural, table

CAPTIONS = {
    "deformed.png": "The pipe where it sags most; displacements drawn to the scale in the picture's title",
    "sag.png": "Largest displacement and stress at each pose",
    "trade_off.png": "What the objectives cost each other",
    "motion.png": "Begin, middle and end of the motion",
}


def pipe_report_html(plan: PipePlan, pictures: Path | None) -> str:
    """The page as text; pictures in the folder are embedded."""
    name = escape(plan.problem.name)
    sections = [_headline(plan), _obstruction(plan), _grasp(plan), _pictures(pictures)]
    sections += [_compared(plan), _waypoints(plan), _facts(plan)]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{name} - mmgrasp pipe</title><style>{CSS}</style></head><body><main>"
        + "".join(sections)
        + "</main></body></html>\n"
    )


def _headline(plan: PipePlan) -> str:
    problem = plan.problem
    lead = (
        f"<p class='lead'>{plural(len(problem.pipe.sections), 'section')}, {1e3 * problem.frame.mass:.0f} g, "
        f"{plural(len(problem.T_world_pipe), 'pose')}, robot {escape(problem.robot.name)}; mmgrasp {_core.__version__}</p>"
    )
    if plan.trajectory is None or plan.path is None:
        return f"<h1>No grasp for {escape(problem.name)}: {plan.outcome.name.replace('_', ' ')}</h1>{lead}"
    worst = max(plan.sags, key=lambda row: row.sag)
    cards = [
        (f"{1e3 * worst.sag:.2f} mm", "largest sag at rest at a pose of the path"),
        (f"{plan.path.joint_motion:.2f} rad", "joint motion"),
        (clock(plan.trajectory.duration), "the arm's motion takes"),
    ]
    stress = max((row.stress for row in plan.sags if row.stress is not None), default=None)
    if stress is not None:
        cards.append((f"{1e-6 * stress:.1f} MPa", "largest stress"))
    cards.append((f"{plan.path.cost:.3f}", f"cost; {plan.proof}"))
    tiles = "".join(f'<div class="card"><b>{escape(a)}</b><span>{escape(b)}</span></div>' for a, b in cards)
    return f"<h1>{escape(problem.name)}: where to hold the pipe</h1>{lead}<div class='cards'>{tiles}</div>"


def _obstruction(plan: PipePlan) -> str:
    why = plan.obstruction
    return f'<h2>What stands in the way</h2><div class="bad">{escape(why)} ({plan.proof})</div>' if why else ""


def _grasp(plan: PipePlan) -> str:
    if plan.grasp is None:
        return ""
    place = grasp_to_dict(plan.grasp)
    rows = [
        ["section", str(place["section"])],
        ["length along it [m]", f"{place['length']:.4f}"],
        ["angle about it [rad]", f"{place['angle']:.4f}"],
        ["flipped", "yes" if place["flipped"] else "no"],
        ["grasps tried", f"{plan.optimum.evaluations}, of which {len(plan.optimum.feasible)} can follow the path"],
        ["on the Pareto front", str(len(plan.optimum.front))],
        [
            "the motion keeps to the pipe's path within",
            f"{1e3 * plan.path_error[0]:.2f} mm, {plan.path_error[1]:.4f} rad",
        ],
    ]
    return "<h2>The grasp</h2>" + table(["", ""], rows)


def _pictures(folder: Path | None) -> str:
    figures = []
    for name, caption in CAPTIONS.items():
        path = folder / name if folder is not None else None
        if path is not None and path.exists():
            data = base64.b64encode(path.read_bytes()).decode()
            figures.append(
                f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{data}">'
                f"<figcaption>{escape(caption)}</figcaption></figure>"
            )
    return "<h2>Pictures</h2>" + "<br>".join(figures) if figures else ""


def _compared(plan: PipePlan) -> str:
    if not plan.compared:
        return ""
    rows = []
    for grasp, found in zip(plan.problem.compare, plan.compared, strict=True):
        place = grasp_to_dict(grasp)
        where = f"section {place['section']} at {place['length']:.3f} m, {place['angle']:.2f} rad"
        if found.path is None:
            rows.append([where, escape(repr(found)), "", "", ""])
            continue
        costs = (found.cost, found.joint_motion, 1e3 * found.deflection, found.force_manipulability)
        rows.append([where, *(f"{value:.3f}" for value in costs)])
    best = plan.path
    if best is not None:
        costs = (best.cost, best.joint_motion, 1e3 * best.deflection, best.force_manipulability)
        rows.append(["<b>the best</b>", *(f"{value:.3f}" for value in costs)])
    head = ["grasp", "cost", "joint motion [rad]", "sum of the sags [mm]", "force manipulability"]
    return "<h2>Grasps to compare</h2>" + table(head, rows, {1, 2, 3, 4})


def _waypoints(plan: PipePlan) -> str:
    if not plan.sags:
        return ""
    rows = []
    for i, row in enumerate(plan.sags):
        where = f"section {row.section}, {row.distance:.3f} m"
        stress = "" if row.stress is None else f"{1e-6 * row.stress:.2f}"
        over = "" if row.over_limit is None else f"{100 * row.over_limit:.0f} %"
        rows.append([str(i), f"{row.time:.2f}", f"{1e3 * row.sag:.3f}", where, stress, over])
    head = ["pose", "time [s]", "sag [mm]", "where", "stress [MPa]", "of the limit"]
    return "<h2>Pose by pose</h2>" + table(head, rows, {0, 1, 2, 4, 5})


def _facts(plan: PipePlan) -> str:
    problem = plan.problem
    rows = [["weights", escape(problem.preferences.source)]]
    for key, value in problem.preferences.options.items():
        rows.append([escape(key.replace("_", " ")), f"{value:.4g}"])
    if problem.preferences.consistency_ratio is not None:
        rows.append(["consistency ratio (at most 10 %)", f"{100 * problem.preferences.consistency_ratio:.2f} %"])
    rows.append(["file", escape(problem.source)])
    return "<h2>What it was asked with</h2>" + table(["", ""], rows)
