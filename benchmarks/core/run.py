"""Kinematics, IK and collision beside the libraries people use, in one run.

    python benchmarks/core/run.py [--only free ...] [--baselines FOLDER] [--write]

Builds the programs benchmarks/core/bench_*.cpp against this library and against the baselines (an environment made from
baselines.txt below build/, or the one named by --baselines), runs them one after another, then the baselines that are Python packages.
Ratios are the baseline's value over ours for rates and ours over the baseline's for times, as the goals are worded. --write puts the
table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from goals import GOALS, Goal
from programs import baselines_environment, build_programs, full_table, lines_of, packages_of
from tables import ROOT, markdown, show

SLOW = {"exactness", "stages"}  # 100,000 queries against FCL; the program of run_stages.py: run when asked for


def matching(goal: Goal, lines: list[dict]) -> list[tuple[dict, dict | None]]:
    """Pairs (ours, the best baseline's) that a goal compares."""
    rows = [line for line in lines if line["row"].startswith(goal.row) and (not goal.on or line["on"] == goal.on)]
    pairs: list[tuple[dict, dict | None]] = []
    for mine in (line for line in rows if line["who"] == goal.ours and goal.field in line):
        if not goal.baseline:
            pairs.append((mine, None))
            continue
        baselines = [
            p for p in rows if (p["row"], p["on"]) == (mine["row"], mine["on"]) and p["who"].startswith(goal.baseline)
        ]
        if baselines:
            pairs.append((mine, min(baselines, key=lambda baseline: baseline[goal.field])))
    return pairs


def goal_table(lines: list[dict]) -> str:
    """One row for each goal and robot: ours, the baseline's, the ratio, whether it is reached."""
    rows = []
    for goal in GOALS:
        for mine, baseline in matching(goal, lines):
            a, b = mine[goal.field], baseline[goal.field] if baseline else 1.0
            ratio = a / b if goal.at_most or not baseline else b / a
            reached = ratio <= goal.bound if goal.at_most else ratio >= goal.bound
            rows.append(
                [
                    f"{goal.row}{'' if goal.field == 'value' else ', ' + goal.field}",
                    mine["on"],
                    goal.ours,
                    f"{a:.3g} {mine['unit']}" if baseline else f"{a:.4%}" if goal.field == "success" else f"{a:.3g}",
                    baseline["who"] if baseline else "",
                    f"{b:.3g} {baseline['unit']}" if baseline else "",
                    f"{ratio:.2f}" if baseline else "",
                    f"{'at most' if goal.at_most else 'at least'} {goal.bound:g}",
                    "yes" if reached else "**no**",
                ]
            )
    return markdown(["work", "on", "ours", "", "baseline", "", "ratio", "goal", "reached"], rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="programs to run: kinematics, ik, free, ...")
    parser.add_argument(
        "--baselines", type=Path, default=ROOT / "build/baselines", help="virtual environment of the baselines"
    )
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    python = baselines_environment(arguments.baselines.absolute(), HERE / "baselines.txt")
    lines = []
    names = [source.stem for source in sorted(HERE.glob("bench_*.cpp"))]
    for program in build_programs([f"-DMMGRASP_BASELINES={packages_of(python)}"], names):
        if program.name not in names:
            continue
        name = program.name.removeprefix("bench_")
        if name not in arguments.only if arguments.only else name in SLOW:
            continue
        lines += lines_of([program])
        script = HERE / f"baselines_{name}.py"
        if script.exists():
            lines += lines_of([python, script])
    cores = f"{os.cpu_count()} cores, {platform.machine()}"
    text = f"{cores}.\n\n{goal_table(lines)}\n\nAll measurements:\n\n{full_table(lines)}"
    show("core", text, arguments.write)


if __name__ == "__main__":
    main()
