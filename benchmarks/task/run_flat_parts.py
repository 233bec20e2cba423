"""Share of drawn flat or round parts that the default plan picks out of a low tray, and that verify accepts.

    python benchmarks/task/run_flat_parts.py [--parts 30] [--round [--without]]

Flat parts and their places are drawn by `tests/python/flat_parts.py`, one in each scenario; a first plan fills the caches.
`--round` draws rods, bolts, balls and tilted boxes as meshes (`tests/python/round_parts.py`) instead; `--without` plans
without the grasps straight down that are drawn for the pose in which a part lies.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "tests" / "python")]
from tables import markdown

import mmgrasp as mg
from flat_parts import drawn_part, low_tray
from mmgrasp.scenario.part_type import PartType
from round_parts import drawn_round_part

STOREROOM = yaml.safe_load((Path(mg.__file__).parent / "assets/scenarios/storeroom.yaml").read_text())


def planned(seed: int, folder: Path, is_round: bool) -> tuple[str, bool, bool, float]:
    """Kind of the part, whether it was picked, whether verify accepts that, and the planner's time [s]."""
    if is_round:
        kind, part, where = drawn_round_part(seed, folder)
    else:
        part, where = drawn_part(seed, folder)
        kind = next(iter(part))
    path = folder / f"flat_{seed}.yaml"
    path.write_text(yaml.safe_dump(low_tray(STOREROOM, part, where), sort_keys=False))
    begin = time.perf_counter()
    try:
        plan = mg.plan_part_supply(path)
    except mg.InvalidInput as error:  # refused: it has no grasp
        print(f"seed {seed}: {error}", file=sys.stderr)
        return kind, False, False, time.perf_counter() - begin
    seconds = time.perf_counter() - begin
    solved = plan.outcome == mg.Outcome.solved
    accepted = solved and not mg.verify_plan(plan.to_dict(), scenario=path, samples=100).faults
    if not accepted:
        print(f"seed {seed}: {plan.outcome.name}", file=sys.stderr)
    return kind, solved, accepted, seconds


def main() -> None:
    """Draws, plans and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", type=int, default=30)
    parser.add_argument("--round", action="store_true")
    parser.add_argument("--without", action="store_true")
    arguments = parser.parse_args()
    if arguments.without:
        PartType.grasps_on = lambda self, _: self.grasps  # type: ignore[method-assign]
    with tempfile.TemporaryDirectory() as folder:
        planned(0, Path(folder), arguments.round)
        results = [planned(seed, Path(folder), arguments.round) for seed in range(1, arguments.parts + 1)]
    rows = []
    for kind in sorted({result[0] for result in results}):
        own = [result for result in results if result[0] == kind]
        rows.append(
            [
                kind,
                str(len(own)),
                str(sum(result[1] for result in own)),
                str(sum(result[2] for result in own)),
                f"{statistics.median(result[3] for result in own):.2f}",
            ]
        )
    print(markdown(["part", "drawn", "picked", "accepted by verify", "plan, median [s]"], rows))


if __name__ == "__main__":
    main()
