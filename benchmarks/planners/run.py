"""MotionBenchMaker's problems beside OMPL's RRT-Connect with FCL, in one process, and beside RoboPlan and sscbirrt;
durations beside toppra and Ruckig.

    python benchmarks/planners/run.py [--limit N] [--seeds N] [--no-baseline] [--write]

Writes the problems as text, builds and runs bench_mbm for both robots, and holds every set against its goals: at most a tenth
of the baseline's median, all paths free, and below 5 ms on bookshelf_* and table_pick. --write puts the table into
benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, baselines_environment, build_programs, lines_of
from tables import ROOT, markdown, show

OURS, BASELINE = "mmgrasp, shortened", "OMPL RRTConnect + FCL"
QUICK = ("bookshelf", "table_pick")


def table(lines: list[dict]) -> str:
    """One row for each set: processor time of a plan, and what the goals say."""
    runs = {(line["on"], line["who"]): line for line in lines}
    rows = []
    for on in dict.fromkeys(line["on"] for line in lines):
        ours, first, baseline = (runs.get((on, who)) for who in (OURS, "mmgrasp", BASELINE))
        ratio = ours["value"] / baseline["value"] if baseline else None
        met = ours["verified"] >= 0.995 * ours["runs"] and ours["solved"] == ours["verified"]
        met = met and (ratio is None or ratio <= 0.1) and (not on.startswith(QUICK) or ours["value"] < 5)
        rows.append(
            [
                on,
                f"{ours['verified']}/{ours['runs']}",
                f"{first['value']:.2f}",
                f"{ours['value']:.2f}",
                f"{ours['p95']:.1f}",
                f"{baseline['value']:.1f}" if baseline else "",
                f"{baseline['p95']:.0f}" if baseline else "",
                f"{baseline['verified']}/{baseline['runs']}" if baseline else "",
                f"{ratio:.3f}" if baseline else "",
                "yes" if met else "**no**",
            ]
        )
    head = ["set", "free by FCL", "first path [ms]", "shortened [ms]", "p95", "OMPL + FCL [ms]", "p95", "free", "ratio"]
    return markdown([*head, "goals"], rows)


def timing_table(lines: list[dict]) -> str:
    """Our durations over the baselines'."""
    keys = ("value", "least", "greatest")
    rows = [[line["who"], line["on"], *(f"{line[k]:.4f}" for k in keys), f"{line['ms']:.1f}"] for line in lines]
    return markdown(["durations", "on", "median ratio", "least", "greatest", "ms a path"], rows)


def ordinary_table(lines: list[dict]) -> str:
    """Programs that plan and shorten the same problems; the goal is half the median of the fastest baseline, all paths free."""
    fastest = min(line["value"] for line in lines[1:])
    rows = []
    for line in lines:
        free = [f"{line[key]}/{line['runs']}" for key in ("solved", "free at 0.01 rad", "free at 0.005 rad")]
        row = [
            line["who"],
            line["settings"],
            f"{line['value']:.1f}",
            f"{line['p95']:.0f}",
            *free,
            f"{line['length']:.2f}",
        ]
        rows.append([*row, f"{line['value'] / fastest:.2f}"])
    head = ["program", "settings", "median [ms]", "p95", "solved", "free at 0.01 rad", "at 0.005 rad", "length [rad]"]
    return markdown([*head, "of the fastest baseline's median"], rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--limit", type=int, default=50, help="problems of each set")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--no-baseline", action="store_true")
    parser.add_argument("--baselines", type=Path, default=ROOT / "build/baselines_planners")
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    build_programs([], ["bench_mbm"])
    lines = []
    for robot in ("panda", "ur5"):
        text = BUILD / f"mbm_{robot}.txt"
        subprocess.run([sys.executable, HERE / "mbm_text.py", robot, text, "--limit", str(arguments.limit)], check=True)
        baseline = "0" if arguments.no_baseline else "1"
        lines += lines_of([BUILD / "benchmarks/bench_mbm", text, str(arguments.seeds), baseline])
    python = baselines_environment(arguments.baselines.absolute(), HERE / "baselines.txt")
    timing = lines_of([sys.executable, HERE / "bench_timing.py", "--baseline", python])
    ordinary = lines_of([sys.executable, HERE / "bench_ordinary.py", "--baseline", python])
    head = f"{os.cpu_count()} cores, {platform.machine()}; {lines[0]['settings']}."
    text = "\n\n".join([head, table(lines), ordinary_table(ordinary), timing_table(timing)])
    show("planners", text, arguments.write)


if __name__ == "__main__":
    main()
