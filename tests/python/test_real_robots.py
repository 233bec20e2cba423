"""The main job on robots we did not write: TIAGo and a UR10e on a Ridgeback, with their meshes and a mounted gripper."""

from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg

pytestmark = pytest.mark.slow

SCENARIOS = Path(__file__).parents[1] / "scenarios"
DATA = Path(__file__).parents[2].parent / "shared" / "data"


@pytest.mark.skipif(not DATA.exists(), reason="the robots' files (../shared/data) are not here")
@pytest.mark.parametrize(
    ("name", "trays", "most_stops"),
    [("tiago_2f85", 3, 2), ("ur10e_ridgeback", 3, 2), ("ur10e_sdhlike", 3, 2), ("ur10e_sdhlike_cans", 1, 1)],
)
def test_main_job_is_planned_and_holds(name: str, trays: Any, most_stops: Any, tmp_path: Path) -> None:
    plan = mg.plan_part_supply(SCENARIOS / f"{name}.yaml")
    assert plan.outcome == mg.Outcome.solved, plan
    targets = {part for tray in plan.scenario.trays for part in tray.targets}
    content = plan.to_dict()
    assert sorted(pick["part"] for pick in content["picks"]) == sorted(targets)
    assert len(content["regions"]) == trays and len(plan.stops) <= most_stops
    assert any(
        shape.mesh_path
        for link in plan.scenario.setup.robot.links
        for shape in plan.scenario.setup.robot.collisions(link)
    )
    verdict = mg.verify_plan(plan.save(tmp_path / "plan.json"), samples=300)
    assert verdict.ok, verdict.faults
    assert all(rate.good == rate.samples == 300 for rate in verdict.rates)
