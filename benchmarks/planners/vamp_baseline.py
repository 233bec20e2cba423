"""VAMP's RRT-Connect and simplification on the problems of mbm_text.py; run_vamp.py runs it, in a Python that has vamp.

    python vamp_baseline.py <problems.txt> <panda|ur5> [seeds]

Settings are VAMP's own: ranges, Halton draws (skipped ahead for each seed), simplification; cylinders are capsules, and boxes in
the box set, as in its evaluate_mbm.py. Times are by VAMP's own clock, which starts once its buffers are there; the least of three
runs with the same draws counts, since that clock runs on while others have the processor. Prints the lines that bench_mbm prints.
"""

from __future__ import annotations

import json
import math
import statistics
import sys

import vamp

SKIPPED = 1000  # draws between seeds
ROUNDS = 3


def problems_of(file: str) -> list[dict]:
    """Name, start and goal by joint, shapes."""
    problems: list[dict] = []
    with open(file) as text:
        for line in text:
            what, *words = line.split()
            if what == "problem":
                problems.append({"name": words[0], "start": {}, "goal": {}, "shapes": []})
            elif what in ("start", "goal"):
                problems[-1][what][words[0]] = float(words[1])
            elif what == "shape":
                problems[-1]["shapes"].append((words[1], [float(word) for word in words[2:]]))
    return problems


def environment_of(problem: dict, in_boxes: bool) -> vamp.Environment:
    """The scene as VAMP has it."""
    environment = vamp.Environment()
    for kind, numbers in problem["shapes"]:
        sizes, pose = numbers[:-12], numbers[-12:]
        centre = [pose[3], pose[7], pose[11]]
        euler = [math.atan2(pose[9], pose[10]), -math.asin(max(-1, min(1, pose[8]))), math.atan2(pose[4], pose[0])]
        if kind == "box":
            environment.add_cuboid(vamp.Cuboid(centre, euler, [0.5 * size for size in sizes]))
        elif kind == "sphere":
            environment.add_sphere(vamp.Sphere(centre, sizes[0]))
        elif in_boxes:
            environment.add_cuboid(vamp.Cuboid(centre, euler, [sizes[0], sizes[0], 0.5 * sizes[1]]))
        else:
            environment.add_capsule(vamp.Cylinder(centre, euler, sizes[0], sizes[1]))
    return environment


def main() -> None:
    file, robot = sys.argv[1:3]
    seeds = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    module, plan, settings, simplification = vamp.configure_robot_and_planner_with_kwargs(robot, "rrtc")
    runs: dict[tuple[str, str], list[float]] = {}
    solved: dict[str, int] = {}
    for problem in problems_of(file):
        in_set = problem["name"].partition("/")[0]
        start, goal = ([problem[end][joint] for joint in problem["goal"]] for end in ("start", "goal"))
        environment = environment_of(problem, in_set.startswith("box"))
        for seed in range(seeds):
            first, whole, found = math.inf, math.inf, False
            for _ in range(ROUNDS):
                sampler = module.halton()
                sampler.skip(SKIPPED * seed)
                result = plan(start, [goal], environment, settings, sampler)
                found = bool(result.solved)
                shortening = (
                    module.simplify(result.path, environment, simplification, sampler).nanoseconds if found else 0
                )
                first, whole = min(first, result.nanoseconds), min(whole, result.nanoseconds + shortening)
            solved[in_set] = solved.get(in_set, 0) + found
            runs.setdefault((in_set, "VAMP"), []).append(1e-6 * first)
            runs.setdefault((in_set, "VAMP, shortened"), []).append(1e-6 * whole)
    for (in_set, who), times in runs.items():
        p95 = sorted(times)[min(len(times) - 1, int(0.95 * len(times)))]
        line = {"row": "mbm", "on": in_set, "who": who, "unit": "ms", "value": statistics.median(times), "p95": p95}
        print(json.dumps({**line, "solved": solved[in_set], "runs": len(times), "settings": "VAMP's own"}))


if __name__ == "__main__":
    main()
