"""MotionBenchMaker's problems by plan_motion on true meshes beside VAMP on its spheres, set by set.

    python benchmarks/planners/run_vamp.py PYTHON [--limit N] [--seeds N] [--program BENCH_MBM] [--write]

PYTHON is one in which `import vamp` works (`pip install vamp-planner` compiles it for the machine at hand). Holds every set against
the goals: shortened paths in at most 3 times VAMP's median and 5 times its p95, every path solved and free by FCL. --write puts
the table into benchmarks/README.md.
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
from programs import BUILD, build_programs, lines_of
from tables import markdown, show

MEDIAN_GOAL, P95_GOAL = 3, 5


def table(lines: list[dict]) -> str:
    """One row for each set."""
    runs = {(line["on"], line["who"]): line for line in lines}
    rows = []
    for on in dict.fromkeys(line["on"] for line in lines):
        first, ours, theirs_first, theirs = (
            runs[on, who] for who in ("mmgrasp", "mmgrasp, shortened", "VAMP", "VAMP, shortened")
        )
        median, p95 = ours["value"] / theirs["value"], ours["p95"] / theirs["p95"]
        met = median <= MEDIAN_GOAL and p95 <= P95_GOAL and ours["verified"] == ours["runs"]
        rows.append(
            [
                on,
                f"{ours['verified']}/{ours['runs']}",
                *(f"{line['value']:.2f}" for line in (first, ours)),
                f"{ours['p95']:.1f}",
                f"{theirs['solved']}/{theirs['runs']}",
                *(f"{line['value']:.2f}" for line in (theirs_first, theirs)),
                f"{theirs['p95']:.1f}",
                f"{median:.1f}",
                f"{p95:.1f}",
                "yes" if met else "**no**",
            ]
        )
    ours_head = ["free by FCL", "first path [ms]", "shortened [ms]", "p95"]
    vamp_head = ["VAMP solved", "first path [ms]", "shortened [ms]", "p95"]
    return markdown(["set", *ours_head, *vamp_head, "ratio of medians", "of p95", "goals"], rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("python", type=Path, help="a Python that has vamp")
    parser.add_argument("--limit", type=int, default=50, help="problems of each set")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--program", type=Path, help="bench_mbm, instead of one built here")
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    if arguments.program is None:
        build_programs([], ["bench_mbm"])
    BUILD.mkdir(parents=True, exist_ok=True)
    program = (arguments.program or BUILD / "benchmarks/bench_mbm").absolute()
    lines = []
    for robot in ("panda", "ur5"):
        text = BUILD / f"mbm_{robot}.txt"
        subprocess.run([sys.executable, HERE / "mbm_text.py", robot, text, "--limit", str(arguments.limit)], check=True)
        lines += lines_of([program, text, str(arguments.seeds), "0"])
        # Not resolved: the link is what makes a virtual environment's Python.
        lines += lines_of([arguments.python.absolute(), HERE / "vamp_baseline.py", text, robot, str(arguments.seeds)])
    head = f"{os.cpu_count()} cores, {platform.machine()}; goals: at most {MEDIAN_GOAL} times the median, {P95_GOAL} times p95."
    show("vamp", f"{head}\n\n{table(lines)}", arguments.write)


if __name__ == "__main__":
    main()
