"""Odd scenarios drawn at random, planned, and their plans checked: what `plan` calls solved its own `verify` never refuses.

As a script: `odd_scenarios.py [TRIES [SEED [FOLDER]]]` prints what each came to and keeps those that broke the rule. With `advice` as a last
word each asks for more room than there is, and then for just what it was told there is.
"""

from __future__ import annotations

import copy
import re
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

import yaml

import mmgrasp as mg

SCENARIOS = Path(mg.__file__).parent / "assets" / "scenarios"
FACTORS = [0.25, 0.5, 0.8, 0.95, 1.05, 1.25, 2.0, 4.0]
SHIFTS = [-0.3, -0.1, -0.02, 0.02, 0.1, 0.3]
# Numbers that odd values cannot make impossible at once: what they stand for decides how they are changed.
TOUCHED = ("gripper", "place_region", "positioning_uncertainty", "obstacles", "part_types", "trays", "start", "goal")


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
    places = [path for path in numbers(scenario) if path[0] in TOUCHED]
    for path in draw.sample(places, draw.randint(1, 4)):
        at(scenario, path[:-1])[path[-1]] = changed(at(scenario, path), draw)
    if draw.random() < 0.3:
        scenario["options"] = {**scenario.get("options", {}), "grid_resolution": draw.choice([0.02, 0.08, 0.1])}
    return scenario


def try_out(scenario: dict[str, Any], folder: Path) -> tuple[str, list[str]]:
    """What became of it ("refused" or the outcome), and the faults of a plan that is called solved."""
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump(scenario, sort_keys=False))
    try:
        plan = mg.plan_part_supply(path)
    except mg.Error as error:
        assert str(error), "an error without a word"
        return "refused", []
    if plan.outcome != mg.Outcome.solved:
        assert str(plan), "no plan without a word"
        return plan.outcome.name, []
    verdict = mg.verify_plan(plan.save(folder / "plan.json"), scenario=path)
    return "solved", [str(fault) for fault in verdict.faults]


ADVICE = re.compile(r"has a radius of ([0-9.]+) m, positioning_uncertainty is")


def follow_advice(scenario: dict[str, Any], folder: Path) -> tuple[str, list[str]]:
    """Asks for more room than there is, then for just what the answer says there is: what became of that."""
    path = folder / "scenario.yaml"
    path.write_text(yaml.safe_dump({**scenario, "positioning_uncertainty": 0.9}, sort_keys=False))
    try:
        plan = mg.plan_part_supply(path)
    except mg.Error:
        return "refused", []
    said = [float(found[1]) for o in plan.obstructions if (found := ADVICE.search(o.message))]
    if plan.outcome == mg.Outcome.solved or not said or len(said) < len(plan.obstructions):
        return "no advice", []
    outcome, faults = try_out({**scenario, "positioning_uncertainty": min(said)}, folder)
    if outcome == "solved":
        return outcome, faults
    plan = mg.plan_part_supply(path)
    again = [o.message for o in plan.obstructions if o.stage in ("region", "robustness")]
    return outcome, again


def main() -> int:
    words = [word for word in sys.argv[1:] if word != "advice"]
    tries = int(words[0]) if words else 100
    seed = int(words[1]) if len(words) > 1 else 1
    kept = Path(words[2]) if len(words) > 2 else Path(tempfile.mkdtemp())
    attempt = follow_advice if "advice" in sys.argv else try_out
    outcomes: Counter[str] = Counter()
    broken = 0
    for number in range(seed, seed + tries):
        scenario = odd_scenario(number)
        begun = time.monotonic()
        with tempfile.TemporaryDirectory() as folder:
            try:
                outcome, faults = attempt(scenario, Path(folder))
            except Exception as error:  # what the search is for
                outcome, faults = type(error).__name__, [str(error)]
        outcomes[outcome] += 1
        took = time.monotonic() - begun
        if faults or took > 60:
            print(f"{number}: {outcome} after {took:.0f} s; {len(faults)} faults: {faults[:3]}", flush=True)
        if faults:
            broken += 1
            (kept / f"odd_{number}.yaml").write_text(yaml.safe_dump(scenario, sort_keys=False))
    print(f"{tries} scenarios from seed {seed}: {dict(outcomes)}; {broken} broke the rule ({kept})")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
