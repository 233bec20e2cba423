"""Arrive, measure, replan: the base comes to stand a little beside its stop, and the picks are planned again from there."""

from pathlib import Path

import numpy as np

import mmgrasp as mg

scenario = mg.load_scenario(Path(mg.__file__).parent / "assets" / "scenarios" / "storeroom.yaml")
scenario.reach = {"samples": 500_000}  # a smaller database than the scenario asks for
plan = mg.plan_part_supply(scenario)
rng = np.random.default_rng(1)
for index, stop in enumerate(plan.stops):
    measured = np.asarray(stop.pose) + [*rng.normal(0, 0.03, 2), rng.normal(0, 0.02)]  # what localisation would tell
    found = mg.part_supply.arrive(plan, index, measured)
    print(
        f"stop {index + 1}: {found.offset:.3f} m beside, {found.outcome.name}, {len(found.picks)} picks, {found.seconds:.2f} s"
    )
