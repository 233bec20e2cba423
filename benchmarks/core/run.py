"""Kinematics, IK and collision beside the libraries people use, in one run.

    python benchmarks/core/run.py [--only free ...] [--peers FOLDER] [--write]

Builds the programs benchmarks/core/bench_*.cpp against this library and against the peers (an environment made from
peers.txt below build/, or the one named by --peers), runs them one after another, then the peers that are Python packages.
Ratios are the peer's value over ours for rates and ours over the peer's for times, as the goals are worded. --write puts the
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
from programs import build_programs, full_table, lines_of, packages_of, peers_environment
from tables import ROOT, markdown, show

SLOW = {"exactness", "stages"}  # 100,000 queries against FCL; the program of run_stages.py: run when asked for


def matching(goal: Goal, lines: list[dict]) -> list[tuple[dict, dict | None]]:
    """Pairs (ours, the best peer's) that a goal compares."""
    rows = [line for line in lines if line["row"].startswith(goal.row) and (not goal.on or line["on"] == goal.on)]
    pairs: list[tuple[dict, dict | None]] = []
    for mine in (line for line in rows if line["who"] == goal.ours and goal.field in line):
        if not goal.peer:
            pairs.append((mine, None))
            continue
        peers = [p for p in rows if (p["row"], p["on"]) == (mine["row"], mine["on"]) and p["who"].startswith(goal.peer)]
        if peers:
            pairs.append((mine, min(peers, key=lambda peer: peer[goal.field])))
    return pairs


def goal_table(lines: list[dict]) -> str:
    """One row for each goal and robot: ours, the peer's, the ratio, whether it is reached."""
    rows = []
    for goal in GOALS:
        for mine, peer in matching(goal, lines):
            a, b = mine[goal.field], peer[goal.field] if peer else 1.0
            ratio = a / b if goal.at_most or not peer else b / a
            reached = ratio <= goal.bound if goal.at_most else ratio >= goal.bound
            rows.append(
                [
                    f"{goal.row}{'' if goal.field == 'value' else ', ' + goal.field}",
                    mine["on"],
                    goal.ours,
                    f"{a:.3g} {mine['unit']}" if peer else f"{a:.4%}" if goal.field == "success" else f"{a:.3g}",
                    peer["who"] if peer else "",
                    f"{b:.3g} {peer['unit']}" if peer else "",
                    f"{ratio:.2f}" if peer else "",
                    f"{'at most' if goal.at_most else 'at least'} {goal.bound:g}",
                    "yes" if reached else "**no**",
                ]
            )
    return markdown(["work", "on", "ours", "", "peer", "", "ratio", "goal", "reached"], rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="programs to run: kinematics, ik, free, ...")
    parser.add_argument("--peers", type=Path, default=ROOT / "build/peers", help="virtual environment of the peers")
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    python = peers_environment(arguments.peers.absolute(), HERE / "peers.txt")
    lines = []
    names = [source.stem for source in sorted(HERE.glob("bench_*.cpp"))]
    for program in build_programs([f"-DMMGRASP_PEERS={packages_of(python)}"], names):
        if program.name not in names:
            continue
        name = program.name.removeprefix("bench_")
        if name not in arguments.only if arguments.only else name in SLOW:
            continue
        lines += lines_of([program])
        script = HERE / f"peers_{name}.py"
        if script.exists():
            lines += lines_of([python, script])
    cores = f"{os.cpu_count()} cores, {platform.machine()}"
    text = f"{cores}.\n\n{goal_table(lines)}\n\nAll measurements:\n\n{full_table(lines)}"
    show("core", text, arguments.write)


if __name__ == "__main__":
    main()
