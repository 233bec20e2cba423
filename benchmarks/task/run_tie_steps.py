"""What each step of the choice among equally few stops is worth: the same layouts with one step left out after the other.

    python benchmarks/task/run_tie_steps.py [--build FOLDER]

Compiles plan_stops_exact.cpp again with one step struck out, links it with the other objects of the build, and runs bench_tie_steps. A
step is worth what its absence costs: smallest and mean disc, length of the route, time.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from left_out import library_edited
from programs import BUILD, build_programs
from tables import ROOT, markdown

SOURCE = ROOT / "cpp/src/task/base_sequence/plan_stops_exact.cpp"
SMALLEST = {"      raise_smallest();\n": ""}
SUM = {"    take_if_better(stops_of(places, cover.chosen));\n": ""}
ROUTE = {"if (!options_.route_length ||": "if (true ||"}
LEVELS = {"low + level * step <= high;": "level == 0;"}
STEPS = {"smallest": SMALLEST, "sum": SUM, "route": ROUTE, "level": LEVELS, "sum and route": SUM | ROUTE}
KEYS = {"least_radius": "smallest disc", "mean_radius": "mean disc", "route": "route", "value": "time"}


def measured(build: Path, library: Path | None) -> list[dict]:
    environment = {**os.environ, **({"LD_PRELOAD": str(library)} if library else {})}
    out = subprocess.run([build / "benchmarks/bench_tie_steps"], check=True, env=environment, stdout=subprocess.PIPE)
    return [json.loads(line) for line in out.stdout.decode().splitlines() if line.startswith("{")]


def compared(lines: list[dict], whole: list[dict]) -> list[str]:
    """Mean and farthest relative difference of each number, and how many layouts it differs in."""
    cells = []
    for key in KEYS:
        changes = [100 * (line[key] / known[key] - 1) for line, known in zip(lines, whole, strict=True)]
        mean = sum(changes) / len(changes)
        differ = sum(abs(change) > 0.01 for change in changes)
        cells.append(f"{mean:+.1f} %" + (f" (to {max(changes, key=abs):+.1f} %, {differ})" if key != "value" else ""))
    return cells


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, help="a build with bench_tie_steps in it, instead of one made here")
    arguments = parser.parse_args()
    build = (arguments.build or BUILD).resolve()
    if arguments.build is None:
        build_programs([], ["bench_tie_steps"])
    whole = measured(build, None)
    rows = []
    for name, edits in STEPS.items():
        lines = measured(build, library_edited(f"ties-{name.replace(' ', '-')}", SOURCE, edits, build))
        rows.append([f"without: {name}", *compared(lines, whole)])
    print(markdown(["", *KEYS.values()], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
