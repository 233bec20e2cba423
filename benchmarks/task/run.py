"""Reachability, base regions and base sequences against their goals, in one run.

    python benchmarks/task/run.py [--only regions ...] [--full] [--baselines FOLDER] [--write]

Builds the programs benchmarks/task/bench_*.cpp, runs them and the Python one one after another and holds what they print
against goals.py. --full takes the reference sizes: the database of 92 million poses (2 GB in a temporary folder), 20,000
poses against inverse kinematics, and the layouts whose proofs use up their time. Every program's last lines are kept below
build/bench, so that a table can be put together from several runs. --write puts it into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from goals import GOALS, Goal
from programs import BUILD, baselines_environment, build_programs, full_table, lines_of
from tables import ROOT, markdown, show

KEPT = BUILD / "task_lines.json"
CACHE = BUILD / "reach-cache"
MAPS = ("fetchlike arm", "fetchlike arm, table", "fetchlike arm and lift")


def commands(full: bool, folder: str, baseline: Path) -> dict[str, list[list]]:
    """What is run for each program."""
    programs = BUILD / "benchmarks"
    build, coverage = programs / "bench_reach_build", programs / "bench_reach_coverage"
    capability, sequence = programs / "bench_capability", programs / "bench_sequence"
    truth = "20000" if full else "1000"
    return {
        "reach_build": [[build, "fetchlike", samples, folder] for samples in ["4000000", *["119000000"] * full]],
        "reach_coverage": [[coverage, "fetchlike", *(["16384000", "10000"] if full else ["1024000", "2000"])]],
        "base_placement": [[sys.executable, HERE / "bench_base_placement.py", "--baseline", baseline]],
        "capability": [[capability, "--case", name, "--truth", truth] for name in MAPS],
        "regions": [[programs / "bench_regions", CACHE, "3", "500" if full else "100"]],
        "regions_truth": [[programs / "bench_regions_truth", CACHE, *(["2000", "200"] if full else ["100", "50"])]],
        "sequence": [[sequence], *[[sequence, "dense"]] * full],
        "set_cover": [[programs / "bench_set_cover"]],
    }


def newest(runs: dict[str, dict]) -> list[dict]:
    """The lines of the last quick and the last full run; of what both measured, the later ones."""
    out = {}
    for run in sorted(runs.values(), key=lambda run: run["when"]):
        out |= {tuple(line[key] for key in ("row", "on", "who", "settings")): line for line in run["lines"]}
    return list(out.values())


def compared(lines: list[dict]) -> list[dict]:
    """The lines with what follows from several of them or from the paper's figure."""
    rows = [line for line in lines if line["row"] == "base regions"]
    per_tray = {line["on"]: line["value"] / int(line["on"].split()[0]) for line in rows}
    out = []
    for line in lines:
        line = dict(line)
        if line["row"] == "base regions" and line["paper"] > 0:
            line["times_as_fast"] = line["paper"] / line["value"]
        if line["row"] == "base regions" and "22 trays of 9x12" in per_tray:
            line["linear"] = per_tray[line["on"]] / per_tray["22 trays of 9x12"]
        if line["row"] == "reach build" and "wall_s" in line:
            line["wall_of_92_million"] = line["wall_s"] * 92e6 / line["stored"]
        if line["row"] == "set cover":
            line["gap"] = line["cost"] - line["bound"]
        baselines = [other for other in lines if (other["row"], other["on"]) == (line["row"], line["on"])]
        baselines = [other for other in baselines if other["who"].startswith("scikit-robot")]
        if baselines and line["who"].startswith("mmgrasp"):
            counted = "reached" if "ignored" in line["who"] else "free"
            line["times_as_fast"] = min(other["value"] for other in baselines) / line["value"]
            line["more"] = line[counted] - max(other[counted] for other in baselines)
        out.append(line)
    return out


def wanted(goal: Goal, line: dict) -> bool:
    """Whether the goal is about this line."""
    same = (line["row"], line["who"]) == (goal.row, goal.who)
    return same and goal.field in line and line["on"].startswith(goal.on)


def goal_table(lines: list[dict]) -> str:
    """One row for each goal and case: the value, the goal, whether it is met."""
    rows = []
    for goal in GOALS:
        for line in (line for line in lines if wanted(goal, line)):
            value = line[goal.field]
            met = value <= goal.bound if goal.at_most else value >= goal.bound
            wall = (
                f"{line['value']:.3g}" if line["unit"] == "s" else f"{line['wall_s']:.3g}" if "wall_s" in line else ""
            )
            processor = f"{line['processor_s']:.3g}" if "processor_s" in line else ""
            bound = f"{'at most' if goal.at_most else 'at least'} {goal.bound:g}"
            rows.append([line["row"], line["on"], goal.what, f"{value:.3g}", bound, "yes" if met else "**no**"])
            rows[-1] += [wall, processor, line["settings"]]
    head = ["work", "on", "measured", "", "goal", "met", "wall [s]", "processor [s]", "settings"]
    return markdown(head, rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="programs to run: regions, sequence, ...; none: keep the last lines")
    parser.add_argument("--full", action="store_true", help="the reference sizes: tens of minutes, 2 GB of disk")
    parser.add_argument(
        "--baselines", type=Path, default=ROOT / "build/baselines_task", help="virtual environment of the baselines"
    )
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    baseline = baselines_environment(arguments.baselines.absolute(), HERE / "baselines.txt")
    build_programs([], [source.stem for source in sorted(HERE.glob("bench_*.cpp"))])
    kept = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    with tempfile.TemporaryDirectory() as folder:
        for name, runs in commands(arguments.full, folder, baseline).items():
            if arguments.only is not None and name not in arguments.only:
                continue
            lines = [line for run in runs for line in lines_of(run)]
            kept.setdefault(name, {})["full" if arguments.full else "quick"] = {"when": time.time(), "lines": lines}
            KEPT.write_text(json.dumps(kept))
    lines = compared([line for name in commands(False, "", baseline) for line in newest(kept.get(name, {}))])
    cores = f"{os.cpu_count()} cores, {platform.machine()}"
    text = f"{cores}.\n\n{goal_table(lines)}\n\nAll measurements:\n\n{full_table(lines)}"
    show("task", text, arguments.write)


if __name__ == "__main__":
    main()
