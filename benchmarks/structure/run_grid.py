"""The exhaustive judge of branch and bound: every grasp on a grid of lengths and angles, both flips, on the problems of `mmgrasp reproduce p2-table-3.7`.

    python benchmarks/structure/run_grid.py [--length 1] [--angle 1] [--pipes Pipe1 Pipe2 Pipe3] [--write]

`--length` in mm, `--angle` in degrees. No grasp of the grid may cost less than branch and bound proves, and none may undercut
the grasp that it returns by more than the gap that it states. The script ends with 1 where one does.
"""

from __future__ import annotations

import argparse
import functools
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.grasping import ObjectPathEvaluator
from mmgrasp.problems.pipe_cells import pipe_robot, pipe_structures
from mmgrasp.reproduce.grasp_search_runs import PIPES, optimum, path_problem

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tables import markdown, show

BOXES = 1_000_000


@functools.cache
def evaluator_of(pipe: str) -> ObjectPathEvaluator:
    return ObjectPathEvaluator(path_problem(pipe), check_edges=False)


def line(task: tuple[str, int, float, float]) -> tuple[int, int, float, tuple[int, float, int, bool]]:
    """All angles, both flips, at one place of a section: grasps, feasible ones, the least cost and where it is."""
    pipe, section, at, step = task
    structure, gripper, evaluator = pipe_structures()[PIPES[pipe] - 1], pipe_robot("kr6like")[2], evaluator_of(pipe)
    feasible, least, where = 0, np.inf, (section, at, 0, False)
    turns = [(angle, flip) for angle in np.arange(-180, 180, step) for flip in (False, True)]
    for angle, flip in turns:
        result = evaluator.evaluate(structure.grasp(section, at, float(np.radians(angle)), flip, gripper=gripper))
        if result.outcome == mg.Outcome.solved:
            feasible += 1
            if result.cost < least:
                least, where = result.cost, (section, at, int(angle), flip)
    return len(turns), feasible, least, where


def places(pipe: str, step: float) -> list[tuple[int, float]]:
    """Sections and lengths along them [m], half a finger's width away from nodes."""
    structure, margin = pipe_structures()[PIPES[pipe] - 1], pipe_robot("kr6like")[2].finger_width / 2
    out: list[tuple[int, float]] = []
    for section, length in enumerate(structure.lengths):
        count = int((length - 2 * margin) / (step / 1000) + 1e-9)
        out += [(section, margin + k * step / 1000) for k in range(count + 1)] if length > 2 * margin else []
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--length", type=float, default=1.0)
    parser.add_argument("--angle", type=float, default=1.0)
    parser.add_argument("--pipes", nargs="*", default=list(PIPES))
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    rows, good = [], True
    cores = len(os.sched_getaffinity(0))
    for pipe in args.pipes:
        begun = time.perf_counter()
        tasks = [(pipe, *place, args.angle) for place in places(pipe, args.length)]
        with ProcessPoolExecutor(cores) as pool:
            counts, feasible, costs, where = zip(*pool.map(line, tasks, chunksize=8), strict=True)
        seconds = time.perf_counter() - begun
        known = optimum(pipe, seed=1, boxes=BOXES, evaluations=1, threads=1)
        best = int(np.argmin(costs))
        holds = known["lower bound"] <= costs[best] and known["cost"] <= costs[best] / (1 - 1e-3)
        good = good and holds
        section, at, angle, flip = where[best]
        rows.append(
            [pipe, f"{sum(counts):,}", f"{sum(feasible):,}", f"{seconds:.0f} s, {cores} cores", f"{costs[best]:.4f}"]
            + [f"section {section + 1}, {1000 * at:.0f} mm, {angle} deg{', flipped' if flip else ''}"]
            + [
                f"{known['lower bound']:.4f}",
                f"{known['cost']:.4f}",
                f"{known['seconds']:.1f} s",
                "yes" if holds else "**no**",
            ]
        )
        print(" | ".join(rows[-1]), flush=True)
    head = [
        "pipe",
        f"grasps, {args.length:g} mm x {args.angle:g} deg",
        "feasible",
        "time",
        "least cost of the grid",
        "there",
    ]
    head += ["proven by branch and bound: none below", "its grasp", "its time", "holds"]
    show("grasp_grid", markdown(head, rows), args.write)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
