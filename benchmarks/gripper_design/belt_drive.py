"""The belt drive's shafts put together in MuJoCo by the grippers designed for them, and by grippers that (5.2) refuses.

    python benchmarks/gripper_design/belt_drive.py [--runs 20] [--each 5] [--noise 0.5] [--write]

Runs of the whole order with the designed grippers, and with those designed for fingers of at most --longest mm, which P1's rule refuses: it has one
shortest length for a segment (5.2.3, figure 5.13), the one with which fingers hold all of it, where ours has one for each depth (docs/methods/gripper_design.md).
Then runs of the whole order, and of each operation by itself, with fingers that are too short, that do not open wide enough, and that do not close far
enough. A run counts as a whole assembly where every operation succeeded and every part is in its place at the very end; an operation by itself where
the parts before it are there as well. Needs the shared data (see belt_drive.yaml) and MuJoCo. With --write the table goes to belt_drive.md and the
pictures to docs/images/belt_drive.png. The same seeds give the same runs on one machine.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np

from mmgrasp._core import Gripper, SegmentRequirement
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.planning import GripperPlan
from mmgrasp.reproduce.grasping_trials import wilson
from mmgrasp.sim.assembly_trial import AssemblyCell, AssemblyOutcome, Film, TrialChoice, chosen, other_gripper
from mmgrasp.sim.pictures import Painter
from mmgrasp.viz.png import write_png
from mmgrasp.viz.raster import Camera

HERE = Path(__file__).resolve().parent
JIG = ["jig", "housing", "motor", "pin"]
FIT = 0.052e-3  # NIST's 8 mm hole over its tight peg, in radius [m]
SHORT = 0.010  # fingers [m]
OFF = 0.001  # by which openings miss the part [m]
STROKE = 0.016


def requirements(plan: GripperPlan) -> list[SegmentRequirement]:
    """What each operation's segment asks of the gripper."""
    assert plan.result is not None
    return [plan.requirements[i] for i in plan.result.requirement_of_part]


def refused(plan: GripperPlan) -> dict[str, list[Gripper]]:
    """Grippers of the same drives, one per operation, that (5.2) refuses: L < L-, W > W+, W < W-."""
    grippers, _ = chosen(plan)
    asked = requirements(plan)
    short = [other_gripper(g, finger_length=SHORT) for g in grippers]
    narrow, wide = [], []
    for g, r in zip(grippers, asked, strict=True):
        top = r.opening - OFF
        narrow.append(other_gripper(g, max_opening=top, min_opening=max(0.0, top - STROKE)))
        wide.append(other_gripper(g, min_opening=r.opening + OFF, max_opening=r.opening + OFF + STROKE))
    return {
        f"fingers of {1e3 * SHORT:.0f} mm": short,
        "open 1 mm less than the part": narrow,
        "close to 1 mm more than the part": wide,
    }


def allowed(gripper: Gripper, asked: SegmentRequirement) -> bool:
    """P1 (5.2), with <=."""
    longest = np.inf if asked.max_finger_length is None else asked.max_finger_length
    fits = gripper.min_opening <= asked.opening <= gripper.max_opening
    return bool(fits and asked.min_finger_length <= gripper.finger_length <= longest)


def whole_segment(plan: GripperPlan, asked: SegmentRequirement) -> float:
    """P1's shortest finger of a segment [m]: that of the grasp which holds all of it, the deepest of ours."""
    same = [r for r in plan.requirements if (r.part, r.segment) == (asked.part, asked.segment)]
    return max(r.min_finger_length for r in same if abs(r.opening - asked.opening) < 1e-5)


def shorter(plan: GripperPlan, longest: float) -> GripperPlan:
    """The grippers of the same assembly with no finger longer than this [m]."""
    return plan_grippers(replace(plan.assembly, fingers=replace(plan.assembly.fingers, longest=longest)))


def shorter_lines(plan: GripperPlan, short: GripperPlan, cell: AssemblyCell, runs: int) -> list[str]:
    """How the fingers that P1's rule refuses fare, and which operations it refuses them in."""
    grippers, grasps = chosen(short)
    outcomes = whole(cell, short, grippers, runs)
    lines = [
        f"Fingers of at most {1e3 * short.assembly.fingers.longest:g} mm, whole assemblies: {complete(outcomes)}.",
        "",
        "| operation | fingers [mm] | shortest for all of the segment [mm] | shortest as held [mm] | held deep [mm] | P1's rule | in its place |",
        "|---|---|---|---|---|---|---|",
    ]
    for step, gripper, grasp, asked in zip(short.assembly.steps, grippers, grasps, requirements(short), strict=True):
        least = whole_segment(plan, asked)
        lines.append(
            f"| {step.name} | {1e3 * gripper.finger_length:.1f} | {1e3 * least:.1f} | {1e3 * asked.min_finger_length:.1f} | {1e3 * grasp.contact_length:.1f} "
            f"| {'allows' if least < gripper.finger_length else 'refuses'} | {placed(outcomes, step.name)} |"
        )
    return [*lines, "", *failures(outcomes)]


def rate(good: int, count: int) -> str:
    """A rate with its 95 % interval."""
    low, high = wilson(good, count)
    return f"{good} of {count} ({100 * low:.0f} to {100 * high:.0f} %)"


def whole(cell: AssemblyCell, plan: GripperPlan, grippers: list[Gripper], runs: int) -> list[AssemblyOutcome]:
    """Runs of the whole order."""
    return [cell.run(grippers, chosen(plan)[1], seed) for seed in range(runs)]


def complete(outcomes: list[AssemblyOutcome]) -> str:
    """The rate of whole assemblies."""
    return rate(sum(run.complete for run in outcomes), len(outcomes))


def placed(outcomes: list[AssemblyOutcome], operation: str) -> str:
    """The rate at which an operation succeeded where it was tried."""
    tried = [o for run in outcomes for o in run.operations if o.name == operation]
    return rate(sum(o.success for o in tried), len(tried))


def failures(outcomes: list[AssemblyOutcome]) -> list[str]:
    """A line for each run that is no whole assembly: what failed, and where every part that is not in its place was at the end."""
    lines = []
    for seed, run in enumerate(outcomes):
        if run.complete:
            continue
        failed = "; ".join(f"{o.name}, {o.why}" for o in run.operations if not o.success) or "no operation failed"
        ends = "; ".join(
            f"{p.name} {1e3 * p.deep:.1f} mm above its place, {1e3 * p.aside:.1f} mm aside, {np.degrees(p.tilted):.0f} degrees tilted"
            for p in run.places
            if not p.there
        )
        lines.append(f"- Seed {seed}: {failed}. At the end: {ends or 'every part in its place'}.")
    return lines or ["No run failed."]


def designed_table(plan: GripperPlan, outcomes: list[AssemblyOutcome]) -> list[str]:
    """Rows of the operations with the designed grippers."""
    lines = [
        "| operation | gripper | opening [mm] | least fingers [mm] | in its place | there at the end | went searching | search, median of those [s] |"
    ]
    lines.append("|---|---|---|---|---|---|---|---|")
    for step, gripper, asked in zip(plan.assembly.steps, chosen(plan)[0], requirements(plan), strict=True):
        searched = [o.searched for run in outcomes for o in run.operations if o.name == step.name and o.searched > 0]
        ends = [p.there for run in outcomes for p in run.places if p.name == step.active[0]]
        median = f"{np.median(searched):.1f}" if searched else "-"
        lines.append(
            f"| {step.name} | {gripper.name} | {1e3 * asked.opening:.1f} | {1e3 * asked.min_finger_length:.1f} "
            f"| {placed(outcomes, step.name)} | {sum(ends)} of {len(ends)} | {len(searched)} | {median} |"
        )
    return lines


def refused_lines(plan: GripperPlan, cell: AssemblyCell, runs: int, each: int) -> list[str]:
    """Rows of the grippers that (5.2) refuses: whole assemblies, and each operation by itself."""
    names = [step.name for step in plan.assembly.steps]
    lines = [f"| grippers that (5.2) refuses | whole assemblies | ended at | {' | '.join(names)} |"]
    lines.append("|---" * (3 + len(names)) + "|")
    for name, grippers in refused(plan).items():
        outcomes = whole(cell, plan, grippers, runs)
        ends = Counter(run.operations[-1].name for run in outcomes if not run.operations[-1].success)
        cells = []
        for gripper, asked in zip(grippers, requirements(plan), strict=True):
            tried = [cell.run(grippers, chosen(plan)[1], seed, steps=[asked.part]) for seed in range(each)]
            reasons = Counter(run.why for run in tried if run.why)
            verdict = "allowed" if allowed(gripper, asked) else "refused"
            why = "".join(f"; {text}: {count}" for text, count in reasons.items())
            cells.append(f"{verdict}, {sum(run.complete for run in tried)} of {len(tried)}{why}")
        ended = ", ".join(f"{n}: {c}" for n, c in ends.items())
        lines.append(f"| {name} | {complete(outcomes)} | {ended} | {' | '.join(cells)} |")
    return lines


def picture(cell: AssemblyCell, plan: GripperPlan, file: Path) -> None:
    """Each operation just before its gripper lets go, side by side."""
    films: list[Film] = []
    recording = AssemblyCell(cell.assembly, replace(cell.choice, record=0.05))
    recording.run(*chosen(plan), 1, films)
    camera = Camera(np.array([1.05, -0.28, 0.52]), np.array([0.60, 0.08, 0.20]), 460, 460, 40.0)
    tiles = []
    for film in films:
        low = min(film.states, key=lambda s: abs(s["time"] - (film.released - 0.1)))
        tiles.append(Painter(film.tool.robot, film.tool.hand, film.world, film.parts).picture(low, camera))
    rows = [np.concatenate(tiles[i : i + 3], axis=1) for i in range(0, len(tiles), 3)]
    write_png(file, np.concatenate(rows, axis=0))


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20, help="of the whole order (default 20)")
    parser.add_argument("--each", type=int, default=5, help="of each operation with refused grippers (default 5)")
    parser.add_argument("--noise", type=float, default=0.5, help="standard deviation of x and y [mm] (default 0.5)")
    parser.add_argument("--longest", type=float, default=28, help="finger of the second set [mm], 0: none (default 28)")
    parser.add_argument("--write", action="store_true", help="store table and pictures")
    given = parser.parse_args()
    plan = plan_grippers(load_assembly(HERE / "belt_drive.yaml"))
    if not plan.solved or plan.result is None:
        sys.exit("no grippers for the belt drive")
    cell = AssemblyCell(plan.assembly, TrialChoice(JIG, 1e-3 * given.noise, {"end cap": FIT}))
    lines = [
        f"{len(plan.result.grippers)} grippers for {len(plan.assembly.steps)} operations, lower bound {plan.result.lower_bound:g}:",
        "",
    ]
    for g in plan.result.grippers:
        lines.append(
            f"- {g.name}: {g.fingers} fingers of {1e3 * g.finger_length:.1f} mm, opens from {1e3 * g.min_opening:.1f} to {1e3 * g.max_opening:.1f} mm"
        )
    outcomes = whole(cell, plan, chosen(plan)[0], given.runs)
    lines += [
        "",
        f"Whole assemblies, {given.noise:g} mm of noise: {complete(outcomes)}.",
        "",
        *designed_table(plan, outcomes),
    ]
    lines += ["", *failures(outcomes)]
    if given.longest > 0:
        lines += ["", *shorter_lines(plan, shorter(plan, 1e-3 * given.longest), cell, given.runs)]
    print("\n".join(lines), flush=True)
    told = len(lines)
    lines += ["", *refused_lines(plan, cell, given.runs, given.each)]
    print("\n".join(lines[told:]))
    if given.write:
        (HERE / "belt_drive.md").write_text("\n".join(lines) + "\n")
        picture(cell, plan, HERE.parents[1] / "docs" / "images" / "belt_drive.png")


if __name__ == "__main__":
    main()
