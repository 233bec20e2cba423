"""The number of threads changes no bit of a plan; the seed is the only source of chance."""

from __future__ import annotations

import json

import mmgrasp as mg


def without_times(plan: mg.PartSupplyPlan) -> str:
    content = plan.to_dict()
    del content["timings"]
    content["scenario"]["options"].pop("threads")
    return json.dumps(content, sort_keys=True)


def test_same_plan_at_one_and_two_threads(small_path):
    plans = [mg.plan_part_supply(small_path, seed=1, threads=threads) for threads in (1, 2)]
    assert plans[0].outcome == mg.Outcome.solved
    assert without_times(plans[0]) == without_times(plans[1])


def test_same_database_at_one_and_two_threads(small_path, tmp_path):
    arm = mg.load_scenario(small_path).setup.arm
    files = []
    for threads in (1, 2):
        files.append(tmp_path / f"{threads}.reach")
        mg.ReachDatabase.build(arm, samples=50_000, seed=1, threads=threads).save(files[-1])
    assert files[0].read_bytes() == files[1].read_bytes()
