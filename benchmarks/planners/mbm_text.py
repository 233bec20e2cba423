"""MotionBenchMaker's problems as the plain text that bench_mbm.cpp reads: C++ here reads no YAML.

python benchmarks/planners/mbm_text.py panda build/bench/mbm_panda.txt [--data FOLDER] [--limit N]
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import mmgrasp as mg
from mmgrasp.problems.motion_bench import MBM_SETS, MotionProblem, read_motion_problems

KINDS = {mg.Box: "box", mg.Cylinder: "cylinder", mg.Sphere: "sphere"}


def numbers(values) -> str:
    return " ".join(format(float(value), ".17g") for value in values)


def sizes(shape) -> str:
    if isinstance(shape, mg.Box):
        return numbers(shape.size)
    return numbers([shape.radius, shape.length] if isinstance(shape, mg.Cylinder) else [shape.radius])


def lines_of(problem: MotionProblem) -> list[str]:
    """One problem; every line begins with what it says."""
    out = [f"problem {problem.name} {problem.group}"]
    out += [f"start {name} {numbers([value])}" for name, value in problem.start.items()]
    out += [f"goal {name} {numbers([value])}" for name, value in problem.goal.items()]
    out += ["allow " + " ".join(sorted(pair)) for pair in sorted(problem.allowed, key=sorted)]
    for name, (shapes, at) in problem.bodies.items():
        for shape in shapes:
            pose = shape.pose if at is None else at @ shape.pose
            out.append(f"shape {name} {KINDS[type(shape.shape)]} {sizes(shape.shape)} {numbers(pose[:3].ravel())}")
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robot", choices=["panda", "ur5"])
    parser.add_argument("out", type=Path)
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[3] / "shared/data")
    parser.add_argument("--limit", type=int, default=50, help="problems of each set")
    arguments = parser.parse_args()
    folder = arguments.data / f"robots/{arguments.robot}_vamp/{arguments.robot}"
    lines = [f"robot {folder / arguments.robot}.urdf {folder / arguments.robot}.srdf"]
    for name in MBM_SETS:
        problems = read_motion_problems(
            arguments.data / f"planning/vamp_{arguments.robot}/problems/{name}_{arguments.robot}"
        )
        for problem in itertools.islice(problems, arguments.limit):
            lines += lines_of(problem)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
