"""How long every planner runs on after its cancel token was set, on problems that cannot be solved.

    python benchmarks/planners/run_stop.py [--runs N] [--latest SECONDS] [--write]

--write puts the table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, build_programs, lines_of
from tables import markdown, show


def table(lines: list[dict]) -> str:
    """One row for each planner; the goal holds for the slowest return."""
    rows = []
    for line in lines:
        met = line["stopped"] == line["runs"] and line["value"] <= line["goal"]
        stopped = f"{line['stopped']}/{line['runs']}"
        rows.append([line["who"], stopped, f"{line['median']:.1f}", f"{line['value']:.1f}", "yes" if met else "**no**"])
    return markdown(["planner", "ended by the token", "return after, median [ms]", "slowest", "within 100 ms"], rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=20, help="of each planner (default 20)")
    parser.add_argument("--latest", type=float, default=1.0, help="latest moment of a stop [s] (default 1)")
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    given = parser.parse_args()
    build_programs([], ["bench_stop"])
    lines = lines_of([BUILD / "benchmarks/bench_stop", str(given.runs), str(given.latest)])
    head = f"{os.cpu_count()} cores, {platform.machine()}; {lines[0]['settings']}."
    show("stop", f"{head}\n\n{table(lines)}", given.write)


if __name__ == "__main__":
    main()
