"""Wall time of the main job by stage, for the shipped scenario and for TIAGo with its meshes.

    python benchmarks/main_job/run.py [--runs 3] [--write]

Every run is a whole process, `mmgrasp plan`, with the reachability database already cached (a first run that is not counted fills
the cache). Medians are printed as Markdown; --write puts them into benchmarks/README.md. Each plan is verified once.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tables import ROOT, markdown, show

SCENARIOS = {
    "shipped storeroom": (ROOT / "python/mmgrasp/assets/scenarios/storeroom.yaml", 10.0),
    "omni cell": (ROOT / "python/mmgrasp/assets/scenarios/omni_cell.yaml", None),
    "TIAGo + 2F-85, meshes": (ROOT / "tests/scenarios/tiago_2f85.yaml", 60.0),
    "UR10e on Ridgeback + 2F-85": (ROOT / "tests/scenarios/ur10e_ridgeback.yaml", None),
}


def command(*arguments: str) -> list[str]:
    """The mmgrasp command of this Python."""
    return [sys.executable, "-m", "mmgrasp", *arguments]


def measure(scenario: Path, runs: int) -> dict:
    """Medians over `runs` processes after one that fills the caches."""
    totals, stages, plan = [], {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for run in range(runs + 1):
            begin = time.perf_counter()
            subprocess.run(command("plan", str(scenario), "-o", folder), check=True, stdout=subprocess.DEVNULL)
            seconds = time.perf_counter() - begin
            if run == 0:
                continue
            totals.append(seconds)
            plan = json.loads((Path(folder) / "plan.json").read_text())
            for item in json.loads((Path(folder) / "timings.json").read_text()):
                stages.setdefault(item["stage"], []).append(item["seconds"])
        begin = time.perf_counter()
        verdict = subprocess.run(command("verify", str(Path(folder) / "plan.json")), stdout=subprocess.DEVNULL)
        verify_seconds = time.perf_counter() - begin
    return {
        "total": statistics.median(totals),
        "stages": {name: statistics.median(values) for name, values in stages.items()},
        "stops": len(plan["stops"]),
        "trays": len(plan["regions"]),
        "picks": len(plan["picks"]),
        "verified": verdict.returncode == 0,
        "verify": verify_seconds,
    }


def table(results: dict[str, dict]) -> str:
    """Markdown: one row a scenario, one column a stage."""
    names = list(dict.fromkeys(stage for r in results.values() for stage in r["stages"]))
    head = ["scenario", "trays", "stops", "picks", *names, "whole command [s]", "goal [s]", "verified", "verify [s]"]
    rows = []
    for name, r in results.items():
        goal = SCENARIOS[name][1]
        cells = [name, str(r["trays"]), str(r["stops"]), str(r["picks"])]
        cells += [f"{r['stages'].get(stage, 0):.2f}" for stage in names]
        cells += [f"{r['total']:.2f}", "" if goal is None else f"{goal:.0f}", "yes" if r["verified"] else "NO"]
        rows.append([*cells, f"{r['verify']:.1f}"])
    return markdown(head, rows)


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    arguments = parser.parse_args()
    results = {}
    for name, (scenario, _) in SCENARIOS.items():
        if "tests" in scenario.parts and not (ROOT.parent / "shared/data").exists():
            print(f"{name}: skipped, the robot's files are not here", file=sys.stderr)
            continue
        results[name] = measure(scenario, arguments.runs)
        print(f"{name}: {results[name]['total']:.2f} s", file=sys.stderr)
    machine = f"{os.cpu_count()} cores, {platform.machine()}, Python {platform.python_version()}"
    text = f"Median of {arguments.runs} runs, {machine}.\n\n{table(results)}"
    show("main_job", text, arguments.write)


if __name__ == "__main__":
    main()
