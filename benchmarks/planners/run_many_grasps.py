"""Carries with any of 500 grasps beside one planner and a list of grasps.

    python benchmarks/planners/run_many_grasps.py [--write] [--keep FILE] [options of many_grasps.py]

--write puts the tables into benchmarks/README.md. --keep adds the measured lines to a file of JSON lines and takes the
table from all that it holds: parts measured one by one, by cell or robot, make one table.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import platform
import statistics
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, build_programs, lines_of
from tables import markdown, show

OURS = ("ours, prm_star_mg", "ours, rrt_star_mg", "prm_star_mg alone", "rrt_star_mg alone")
TODAY = "today"  # the others have our collision checker
SOONER, CHEAPER = 5, 0.9  # goals
SAME = 1e-6  # relative, of costs that are equal

Runs = dict[tuple[str, int, int], dict]


def least(values) -> float:
    """Infinite when there is nothing."""
    return min((v for v in values if v is not None), default=math.inf)


def milliseconds(values) -> str:
    found = [1e3 * v for v in values if v is not None]
    return f"{statistics.median(found):.2f}" if found else ""


def ratio(programs: dict[str, Runs], name: str, others: list[str]) -> str:
    """Median over the problems of the soonest of the others over ours."""
    ratios = []
    for key, own in programs[name].items():
        first = least(programs[other][key]["first"] for other in others)
        if own["first"] is not None and first < math.inf:
            ratios.append(first / own["first"])
    return f"{statistics.median(ratios):.1f}" if ratios else ""


def counts(programs: dict[str, Runs], name: str, others: list[str]) -> tuple[int, int]:
    """Problems in which it ends with a cheaper path than all others, and with one as cheap as the cheapest of them."""
    won = equal = 0
    for key, own in programs[name].items():
        best = least(programs[other][key]["cost"] for other in others)
        if own["cost"] is None:
            continue
        won += own["cost"] < best * (1 - SAME)
        equal += math.isclose(own["cost"], best, rel_tol=SAME)
    return won, equal


def stages(runs: Runs, which: int) -> str:
    """How many first (0) or final (1) paths each stage found."""
    found = Counter(line["stages"][which] for line in runs.values() if line.get("stages"))
    return ", ".join(f"{stage} {count}" for stage, count in found.most_common())


def many_table(lines: list[dict]) -> str:
    programs: dict[str, Runs] = {}
    for line in lines:
        programs.setdefault(line["program"], {})[line["robot"], line["cell"], line["run"]] = line
    baselines = [name for name in programs if name not in OURS]
    ended = {name: runs for name, runs in programs.items() if name != TODAY}
    solved_by_all = set.intersection(
        *({key for key, line in runs.items() if line["cost"] is not None} for runs in ended.values())
    )
    rows = []
    for name, runs in programs.items():
        firsts = [line["first"] for line in runs.values()]
        costs = [runs[key]["cost"] for key in solved_by_all if name != TODAY]
        row = [
            name,
            f"{sum(f is not None for f in firsts)}/{len(runs)}",
            milliseconds(firsts),
            f"{1e3 * max((f for f in firsts if f is not None), default=math.nan):.1f}",
            f"{statistics.mean(costs):.3f}" if costs else "",
        ]
        if name in OURS and TODAY in programs:
            won, equal = counts(programs, name, baselines)
            sooner = ratio(programs, name, baselines)
            met = bool(sooner) and float(sooner) >= SOONER and won >= CHEAPER * len(runs)
            row += [
                ratio(programs, name, [TODAY]),
                sooner,
                f"{won}/{len(runs)}",
                f"{equal}",
                *(stages(runs, which) for which in (0, 1)),
                "yes" if met else "**no**",
            ]
        else:
            row += [""] * 7
        rows.append(row)
    head = ["program", "solved", "first path, median [ms]", "slowest", f"cost, mean over {len(solved_by_all)}"]
    return markdown(
        [
            *head,
            "sooner than today",
            "than the best of all ways",
            "cheaper than all",
            "equal",
            "first path by",
            "final path by",
            "goals",
        ],
        rows,
    )


def odds_table(lines: list[dict]) -> str:
    """Few or all of the grasps good."""
    rows = [
        [
            line["who"],
            line["on"],
            f"{line['first']:.1f}",
            f"{line['value']:.1f}",
            f"{line['slowest']:.1f}",
            f"{line['processor']:.1f}",
            f"{line['solved']}/{line['runs']}",
            "yes" if line["solved"] == line["runs"] and line["first"] <= 100 else "**no**",
        ]
        for line in lines
    ]
    return markdown(
        ["planner", "grasps", "first path, median [ms]", "whole call", "slowest", "processor", "solved", "goals"], rows
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    parser.add_argument("--keep", type=Path, help="file of JSON lines")
    given, rest = parser.parse_known_args()
    build_programs([], ["bench_many_grasps", "bench_transfer_fcl"])
    fcl = BUILD / "benchmarks/bench_transfer_fcl"
    settings, *lines = lines_of([sys.executable, HERE / "many_grasps.py", "--fcl", fcl, *rest])
    if given.keep:
        with given.keep.open("a") as file:
            file.writelines(json.dumps(line) + "\n" for line in lines)
        lines = [json.loads(line) for line in given.keep.read_text().splitlines()]
        for key, name in (("cell", "cells"), ("robot", "robots")):
            settings["settings"][name] = sorted({line[key] for line in lines})
    odds = []
    for planner in ("prm_star_mg", "rrt_star_mg"):
        odds += lines_of([BUILD / "benchmarks/bench_many_grasps", "0", planner])
    settings_text = ", ".join(
        f"{key} {value}" for key, value in settings["settings"].items() if key not in ("programs", "fcl")
    )
    head = f"{os.cpu_count()} cores, {platform.machine()}; {settings_text}."
    show("many_grasps", "\n\n".join([head, many_table(lines), odds_table(odds)]), given.write)


if __name__ == "__main__":
    main()
