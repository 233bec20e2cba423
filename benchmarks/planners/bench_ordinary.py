"""Ordinary planning beside what Python users have today: RoboPlan and sscbirrt on MotionBenchMaker's Panda problems.

    python benchmarks/planners/bench_ordinary.py --baseline PYTHON [--limit N] [--seeds N] [--data FOLDER]

Every program plans and shortens the same problems in its recommended set-up; each path is then looked at by FCL and KDL called
directly, at 0.01 rad and at 0.005 rad. Times are those of planning, the scene being loaded. One JSON line a program.
"""

from __future__ import annotations

import argparse
import itertools
import json
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import mmgrasp as mg
from mmgrasp.problems.motion_bench import MBM_SETS, MotionProblem, read_motion_problems
from mmgrasp.problems.motion_bench_run import verify_motion

HERE = Path(__file__).resolve().parent
STEPS = (0.01, 0.005)
TIME_LIMIT = 10.0


def scene_of(problem: MotionProblem) -> list[dict[str, Any]]:
    """The scene's primitives with their poses in the world."""
    kinds = {mg.Box: "box", mg.Cylinder: "cylinder", mg.Sphere: "sphere"}
    out = []
    for name, (shapes, at) in problem.bodies.items():
        for k, shape in enumerate(shapes):
            solid = shape.shape
            sizes = list(solid.size) if isinstance(solid, mg.Box) else [solid.radius]
            sizes += [solid.length] if isinstance(solid, mg.Cylinder) else []
            T = shape.pose if at is None else at @ shape.pose
            out.append({"name": f"{name}#{k}", "kind": kinds[type(solid)], "sizes": sizes, "pose": T.tolist()})
    return out


def ours(robot: mg.Robot, problems: list[MotionProblem], seeds: int) -> Iterator[tuple[float, np.ndarray | None]]:
    """Seconds and path of each problem with each seed."""
    for problem, seed in itertools.product(problems, range(1, seeds + 1)):
        of_problem, group = problem.setting(robot)
        checker = problem.checker(robot)
        checker.is_free(problem.start_of(group))  # the scene is loaded
        begin = time.process_time()
        found = mg.plan_motion(
            of_problem,
            group,
            problem.world_of(robot),
            start=problem.start_of(group),
            goal=problem.goal_of(group),
            seed=seed,
            workspace_step=0.005,
            time_limit=TIME_LIMIT,
        )
        yield time.process_time() - begin, found.path


def baseline(
    python: str, script: str, robot: dict, problems: list[MotionProblem], seeds: int
) -> list[tuple[float, np.ndarray | None]]:
    """The same from a program in the baselines' environment; it answers one line for each run."""
    query = {
        "robot": robot,
        "seeds": seeds,
        "time_limit": TIME_LIMIT,
        "problems": [
            {
                "name": problem.name,
                "group": problem.group,
                "start": problem.start,
                "goal": problem.goal,
                "allowed": [sorted(pair) for pair in problem.allowed],
                "scene": scene_of(problem),
            }
            for problem in problems
        ],
    }
    done = subprocess.run(
        [python, HERE / script], input=json.dumps(query), stdout=subprocess.PIPE, text=True, check=True
    )
    answers = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return [(a["seconds"], np.array(a["path"]) if a["path"] else None) for a in answers]


def row(who: str, settings: str, robot: mg.Robot, runs: list[tuple[MotionProblem, float, np.ndarray | None]]) -> str:
    """Times of all runs, solved or not, and how many paths hold at each step."""
    seconds = 1e3 * np.array([run[1] for run in runs])
    paths = [(problem, path) for problem, _, path in runs if path is not None]
    free = {f"free at {step} rad": sum(not verify_motion(p, robot, q, step) for p, q in paths) for step in STEPS}
    lengths = [float(np.linalg.norm(np.diff(q, axis=0), axis=1).sum()) for _, q in paths]
    return json.dumps(
        {
            "row": "ordinary",
            "on": "panda",
            "who": who,
            "value": float(np.median(seconds)),
            "unit": "ms",
            "p95": float(np.quantile(seconds, 0.95)),
            "runs": len(runs),
            "solved": len(paths),
            **free,
            "length": float(np.mean(lengths)) if lengths else float("nan"),
            "settings": settings,
        }
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--baseline", required=True, help="python of an environment with baselines.txt")
    parser.add_argument("--data", type=Path, default=HERE.parents[2] / "shared/data")
    parser.add_argument("--limit", type=int, default=10, help="problems of each set")
    parser.add_argument("--seeds", type=int, default=3)
    arguments = parser.parse_args()
    folder = arguments.data / "robots/panda_vamp/panda"
    robot = mg.Robot.load(folder / "panda.urdf", folder / "panda.srdf")
    problems = [
        problem
        for name in MBM_SETS
        for problem in itertools.islice(
            read_motion_problems(arguments.data / f"planning/vamp_panda/problems/{name}_panda"), arguments.limit
        )
    ]
    files = {"urdf": str(folder / "panda.urdf"), "srdf": str(folder / "panda.srdf")}
    query = [problem for problem in problems for _ in range(arguments.seeds)]
    programs = {
        ("mmgrasp", "RRT-Connect, edges at 5 mm of any link point, shortened, looked at again"): ours(
            robot, problems, arguments.seeds
        ),
        ("RoboPlan 0.7", "RRT-Connect, steps of 0.05 rad by bisection, shortcuts as by default"): baseline(
            arguments.baseline, "roboplan_baseline.py", files, problems, arguments.seeds
        ),
        ("sscbirrt 3.15", "CBiRRT, native MuJoCo scene, edge_resolution 0.05 rad, smoothed as by default"): baseline(
            arguments.baseline, "sscbirrt_baseline.py", files, problems, arguments.seeds
        ),
    }
    for (who, settings), runs in programs.items():
        print(row(who, settings, robot, [(p, *run) for p, run in zip(query, runs, strict=True)]), flush=True)


if __name__ == "__main__":
    main()
