"""Odd scenarios drawn at random, planned, and their plans checked: what `plan` calls solved its own `verify` never
refuses.

A scenario that is refused is refused where it is read, at one of its lines; what is called infeasible is not solved
with another seed; and what takes long says how far it is.

As a script: `odd_scenarios.py [TRIES [SEED [FOLDER]]]` prints what each came to and keeps those that broke the rule.
With `advice` as a last word each asks for more room than there is, and then for just what it was told there is. With
`all` each uses many features at once (odd_features.py), and every third that is solved is taken in passing, too.
"""

from __future__ import annotations

import copy
import faulthandler
import os
import re
import shutil
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Collection, Iterator
from pathlib import Path
from random import Random
from typing import Any

import yaml

import mmgrasp as mg
from mmgrasp.scenario import Scenario
from odd_features import full_scenario

SCENARIOS = Path(mg.__file__).parent / "assets" / "scenarios"
FACTORS = [0.25, 0.5, 0.8, 0.95, 1.05, 1.25, 2.0, 4.0]
SHIFTS = [-0.3, -0.1, -0.02, 0.02, 0.1, 0.3]
# Numbers that odd values cannot make impossible at once: what they stand for decides how they are changed.
TOUCHED = ("gripper", "place_region", "positioning_uncertainty", "obstacles", "part_types", "trays", "start", "goal")

LONG, SILENT = 60.0, 2.0  # [s] of a work that should say how far it is, and between two words of it
STUCK = 60.0  # [s] without a word, however little the processor did
HANGS = 900.0  # [s]
OTHER_SEEDS = (1000, 2000)


def numbers(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where the numbers stand, booleans left out."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in pairs:
        yield from numbers(inner, (*path, key))
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path


def at(value: Any, path: tuple[Any, ...]) -> Any:
    for key in path:
        value = value[key]
    return value


def changed(number: float, draw: Random) -> float:
    if isinstance(number, int):
        return max(0, number + draw.choice([-1, 1, 2]))
    if number == 0 or draw.random() < 0.4:
        return round(number + draw.choice(SHIFTS), 9)
    return round(number * draw.choice(FACTORS), 9)


def _change_numbers(scenario: dict[str, Any], count: int, draw: Random) -> None:
    places = [path for path in numbers(scenario) if path[0] in TOUCHED]
    for path in draw.sample(places, count):
        at(scenario, path[:-1])[path[-1]] = changed(at(scenario, path), draw)


def odd_scenario(seed: int) -> dict[str, Any]:
    """A shipped scenario with one of its trays, two targets, and one to four numbers changed."""
    draw = Random(seed)
    scenario: dict[str, Any] = yaml.safe_load(
        (SCENARIOS / draw.choice(["storeroom.yaml", "omni_cell.yaml"])).read_text()
    )
    tray = copy.deepcopy(draw.choice(scenario["trays"]))
    if isinstance(tray.get("targets"), list):
        tray["targets"] = tray["targets"][:2]
    scenario.update(name=f"odd {seed}", trays=[tray], reach={"samples": 500_000})
    _change_numbers(scenario, draw.randint(1, 4), draw)
    if draw.random() < 0.3:
        scenario["options"] = {**scenario.get("options", {}), "grid_resolution": draw.choice([0.02, 0.08, 0.1])}
    return scenario


def odd_full_scenario(seed: int, folder: Path) -> dict[str, Any]:
    """Many features at once, and in one of three scenarios a number or two changed beside them."""
    scenario = copy.deepcopy(full_scenario(seed, folder))
    draw = Random(-seed - 1)
    if draw.random() < 1 / 3:
        _change_numbers(scenario, draw.randint(1, 2), draw)
    return scenario


class Watch:
    """Hears progress, and knows how long nothing was heard: by the wall clock, or by what the processor did for this
    process where that is less, since others keep the machine busy, too. A work that is stuck needs no processor: by the
    wall clock alone."""

    def __init__(self) -> None:
        self.wall, self.processor = time.monotonic(), time.process_time()
        self.took = self.longest = 0.0

    def __call__(self, stage: str, fraction: float) -> None:
        wall, processor = time.monotonic(), time.process_time()
        silent = wall - self.wall
        if silent <= STUCK:
            silent = min(silent, processor - self.processor)
        self.took += silent
        self.longest = max(self.longest, silent)
        self.wall, self.processor = wall, processor

    def faults(self) -> list[str]:
        """What somebody who waits would complain of: a long work that says nothing."""
        self("", 1.0)
        is_slow = self.took > LONG and self.longest > SILENT
        return [f"slow: {self.took:.0f} s, of which {self.longest:.0f} s without a word"] if is_slow else []


def line_faults(error: mg.Error, path: Path) -> list[str]:
    """A scenario is refused at one of its lines."""
    is_there = re.search(rf"{re.escape(path.name)}:\d+: ", str(error))
    return [] if is_there else [f"refused without the scenario's line: {error}"]


def try_out(scenario: dict[str, Any], folder: Path, in_passing: bool = False) -> tuple[str, list[str]]:
    """What became of it ("refused" or the outcome), and what is wrong about that: faults of a plan that is called
    solved, a message without the scenario's line, a work that is long and silent, a plan that is called impossible and
    found with another seed.

    `in_passing`: the plan whose first picks are taken in passing is checked instead.
    """
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(scenario, sort_keys=False))
    watch = Watch()
    try:
        loaded = mg.load_scenario(path, progress=watch)
    except mg.Error as error:
        return "refused", line_faults(error, path)
    try:
        outcome, faults = planned(loaded, path, in_passing, watch)
    except mg.Error as error:
        return "refused late", [f"read, and refused afterwards: {error}"]
    return outcome, faults + watch.faults()


def planned(loaded: Scenario, path: Path, in_passing: bool, watch: Watch) -> tuple[str, list[str]]:
    plan = mg.plan_part_supply(loaded, progress=watch)
    if plan.outcome != mg.Outcome.solved:
        assert str(plan), "no plan without a word"
        return plan.outcome.name, found_after_all(loaded, watch) if plan.outcome == mg.Outcome.infeasible else []
    folder = path.parent
    if in_passing and not loaded.drive_clearance:
        mg.part_supply.plan_drive_by_picks(plan, progress=watch).save(folder)
    else:
        plan.save(folder / "plan.json")
    verdict = mg.verify_plan(folder / "plan.json", scenario=path, progress=watch)
    return "solved", [str(fault) for fault in verdict.faults]


def found_after_all(loaded: Scenario, watch: Watch) -> list[str]:
    """A plan that was called impossible must not be found with another seed."""
    seeds = [loaded.options.get("seed", 1) + more for more in OTHER_SEEDS]
    outcomes = {seed: mg.plan_part_supply(loaded, seed=seed, progress=watch).outcome for seed in seeds}
    return [f"infeasible, and solved with seed {s}" for s, outcome in outcomes.items() if outcome == mg.Outcome.solved]


ADVICE = re.compile(r"has a radius of ([0-9.]+) m, positioning_uncertainty is")


def follow_advice(scenario: dict[str, Any], folder: Path) -> tuple[str, list[str]]:
    """Asks for more room than there is, then for just what the answer says there is: what became of that."""
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump({**scenario, "positioning_uncertainty": 0.9}, sort_keys=False))
    try:
        loaded = mg.load_scenario(path)
    except mg.Error as error:
        return "refused", line_faults(error, path)
    plan = mg.plan_part_supply(loaded)
    said = [float(found[1]) for o in plan.obstructions if (found := ADVICE.search(o.message))]
    if plan.outcome == mg.Outcome.solved or not said or len(said) < len(plan.obstructions):
        return "no advice", []
    outcome, faults = try_out({**scenario, "positioning_uncertainty": min(said)}, folder)
    if outcome == "solved":
        return outcome, faults
    again = [o.message for o in mg.plan_part_supply(path).obstructions if o.stage in ("region", "robustness")]
    return outcome, faults + again


def one(number: int, folder: Path, words: Collection[str]) -> tuple[str, list[str]]:
    """What came of one odd scenario, with a mistake of the programs told as a fault."""
    try:
        if "all" in words:
            return try_out(odd_full_scenario(number, folder), folder, in_passing=number % 3 == 0)
        return (follow_advice if "advice" in words else try_out)(odd_scenario(number), folder)
    except Exception as error:  # what the search is for
        return type(error).__name__, [str(error)]


def give_up(made: int, number: int) -> None:
    """Ends a search that hangs, with what was tried until then."""
    print(f"{number}: no end after {HANGS:.0f} s\n{made} tries: the last one hangs", flush=True)
    faulthandler.dump_traceback()
    os._exit(1)


def main() -> int:
    words = [word for word in sys.argv[1:] if word not in ("advice", "all")]
    tries = int(words[0]) if words else 100
    seed = int(words[1]) if len(words) > 1 else 1
    kept = Path(words[2]) if len(words) > 2 else Path(tempfile.mkdtemp())
    kept.mkdir(exist_ok=True)
    outcomes: Counter[str] = Counter()
    broken = 0
    for number in range(seed, seed + tries):
        faulthandler.dump_traceback_later(HANGS + 60, exit=True)  # where Python itself stands
        hang = threading.Timer(HANGS, give_up, (number - seed + 1, number))
        hang.daemon = True
        hang.start()
        with tempfile.TemporaryDirectory() as name:
            outcome, faults = one(number, Path(name), sys.argv)
            outcomes[outcome] += 1
            if faults:
                print(f"{number}: {outcome}; {len(faults)} faults: {faults[:3]}", flush=True)
                broken += 1
                shutil.copytree(name, kept / f"odd_{number}", dirs_exist_ok=True)
        hang.cancel()
    faulthandler.cancel_dump_traceback_later()
    print(f"{tries} tries from seed {seed}: {dict(outcomes)}; {broken} broke the rule ({kept})")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
