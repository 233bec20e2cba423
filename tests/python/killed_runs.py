"""`mmgrasp plan` ended at random moments while it plans into a folder that holds a plan: what is there is one plan, whole, and what is somebody's stays. As a script: `killed_runs.py [TRIES [SEED]]`."""

from __future__ import annotations

import copy
import json
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import yaml

import mmgrasp as mg
from mmgrasp._files import ASSETS

ENTRY = "import sys, mmgrasp_command; sys.exit(mmgrasp_command.main())"  # the command; -m loads the package first
LONGEST = 6.0  # [s]; a run takes about as long
SIGNALS = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
WAYS: tuple[list[str], ...] = ([], ["--no-pictures"], ["--drive-by"])


def scenarios(folder: Path) -> list[Path]:
    """Two scenarios of one tray, with two and with three parts to pick."""
    whole: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    paths = []
    for count in (2, 3):
        scenario = copy.deepcopy(whole)
        tray = {**scenario["trays"][0], "targets": scenario["trays"][0]["targets"][:count]}
        paths.append(folder / f"scenario_{count}.yaml")
        paths[-1].write_text(yaml.safe_dump({**scenario, "trays": [tray], "reach": {"samples": 500_000}}))
    return paths


def fault(out: Path, said: str) -> str:
    """What is wrong with the folder after a run was ended; nothing: ''."""
    if "Traceback" in said:
        return said[-500:]
    try:
        plan = json.loads((out / "plan.json").read_text())
        listed = json.loads((out / "files.json").read_text())["files"]
    except (OSError, ValueError) as error:
        return f"no whole plan: {error}"
    if (out / "mine.txt").read_text() != "mine":
        return "a file of somebody's was changed"
    there = {path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file()} - {"mine.txt"}
    stray = sorted(name for name in there if name not in listed and ".writing." not in name)
    if stray:
        return f"not listed: {stray}"
    picks = len([name for name in there if name.startswith("trajectories/") and name.endswith("_lift.csv")])
    return "" if picks <= len(plan["picks"]) else f"motions of {picks} picks beside a plan of {len(plan['picks'])}"


def run(scenario: Path, out: Path, *more: str) -> list[str]:
    return [sys.executable, "-c", ENTRY, "plan", str(scenario), "-o", str(out), *more]


def main() -> int:
    tries = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    draw = random.Random(int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    found = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths, out = scenarios(folder), folder / "out"
        subprocess.run(run(paths[0], out), check=True, capture_output=True)
        (out / "mine.txt").write_text("mine")
        for _ in range(tries):
            command = run(draw.choice(paths), out, *draw.choice(WAYS))
            with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
                moment, ending = draw.uniform(0.2, LONGEST), draw.choice(SIGNALS)
                time.sleep(moment)
                if running.poll() is None:
                    running.send_signal(ending)
                _, said = running.communicate(timeout=60)
            if why := fault(out, said):
                found += 1
                print(f"{ending.name} after {moment:.2f} s: {why}", flush=True)
        subprocess.run(run(paths[0], out), check=True, capture_output=True)
        verdict = mg.verify_plan(out / "plan.json", scenario=paths[0])
        left = [str(path) for path in out.rglob("*.writing.*")]
        if not verdict.ok or left:
            found += 1
            print(f"the run after all of them: {verdict.faults}, left over: {left}")
    print(f"{tries} tries: {found} complaints")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
