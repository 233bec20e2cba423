"""Grasping while driving at scale: random grasps beside casadi, tables and walls, waypoints, several tasks.

    python benchmarks/trajopt/run.py [--only random_grasps ...] [--count N] [--seeds 1 2 3] [--baselines FOLDER] [--write]

Runs the programs benchmarks/trajopt/bench_*.py one after another and holds what they print against the goals. --count replaces
each program's number of poses. --write puts the tables into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, baselines_environment, full_table, lines_of, packages_of
from tables import ROOT, markdown, show

PROGRAMS = ("random_grasps", "obstacles", "at_grasp", "waypoints", "tasks")
# Row, what a line's `on` begins with, field, bound, whether it may be at most that.
GOALS = (
    ("random grasps", "seed", "solved", 0.99, False),
    ("random grasps", "seed", "value", 0.3, True),
    ("random grasps", "seed", "base_above", 0.9, False),
    ("tables and walls", "seed", "solved", 0.95, False),
    ("tables and walls", "seed", "value", 1.5, True),
    ("furniture at the grasp", "seed", "solved", 0.98, False),
    ("furniture at the grasp", "seed", "value", 0.5, True),
    ("furniture at the grasp", "seed", "p95", 2.0, True),
    ("waypoints", "300", "value", 0.2, True),
    ("waypoints", "", "slope", 1.1, True),
    ("waypoints", "", "spread", 0.02, True),
    ("several tasks", "m", "solved", 1.0, False),
    ("several tasks", "m", "largest_over_stop_and_go", 1.0, True),
    ("several tasks", "m", "base_above", 0.9, False),
)


def goal_table(lines: list[dict]) -> str:
    """One row for each goal and case; beside casadi ours may take 0.7 of its time and solve no less."""
    rows = []

    def row(line: dict, field: str, bound: float, at_most: bool, against: str) -> None:
        value = line[field]
        reached = value <= bound if at_most else value >= bound
        wanted = f"{'at most' if at_most else 'at least'} {bound:.3g}{against}"
        name = "median [s]" if field == "value" else field.replace("_", " ")
        rows.append([line["row"], line["on"], name, f"{value:.4g}", wanted, "yes" if reached else "**no**"])

    ours = [line for line in lines if line["who"] == "mmgrasp"]
    for name, on, field, bound, at_most in GOALS:
        for line in ours:
            if line["row"] == name and line["on"].startswith(on) and field in line:
                row(line, field, bound, at_most, "")
    for line in ours:
        for baseline in lines:
            if (
                (baseline["row"], baseline["on"]) == (line["row"], line["on"])
                and baseline is not line
                and baseline["who"] != "mmgrasp"
            ):
                row(line, "value", 0.7 * baseline["value"], True, f" (0.7 of {baseline['who']})")
                row(line, "solved", baseline["solved"], False, f" ({baseline['who']})")
    return markdown(["work", "on", "what", "ours", "goal", "reached"], rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", choices=PROGRAMS, default=PROGRAMS)
    parser.add_argument("--count", type=int, help="poses of each program")
    parser.add_argument("--seeds", nargs="+", help="seeds of each program")
    parser.add_argument("--no-baseline", action="store_true")
    parser.add_argument(
        "--baselines", type=Path, default=ROOT / "build/baselines_trajopt", help="virtual environment of casadi"
    )
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    given = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    lines = []
    for name in given.only:
        command = [sys.executable, HERE / f"bench_{name}.py"]
        if given.count:
            command += ["--count", str(given.count)]
        if given.seeds:
            command += ["--seeds", *given.seeds]
        if name == "random_grasps" and not given.no_baseline:
            command += [
                "--baseline",
                packages_of(baselines_environment(given.baselines.absolute(), HERE / "baselines.txt")),
            ]
        lines += lines_of(command)
    cores = f"{os.cpu_count()} cores, {platform.machine()}; processor time of one thread."
    show("trajopt", f"{cores}\n\n{goal_table(lines)}\n\nAll measurements:\n\n{full_table(lines)}", given.write)


if __name__ == "__main__":
    main()
