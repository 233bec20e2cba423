"""Two robots share the trays of a storeroom: a scenario and a plan for each, and times at which they never meet."""

from __future__ import annotations

from pathlib import Path

import yaml

import mmgrasp as mg
from mmgrasp.part_supply import schedule_plans, verify_schedule

shipped = Path(mg.__file__).parent / "assets" / "scenarios" / "storeroom.yaml"
room = yaml.safe_load(shipped.read_text())
picked: dict[str, dict[str, list[int]]] = {"east": {"A": [0], "B": [0]}, "north": {"B": [5], "D": [4]}}
starts = {"east": [-1.6, -1.6, 0.0], "north": [-1.6, -0.4, 0.0]}
goals = {"east": [-1.6, 1.2, 3.14159265], "north": [-1.6, 0.0, 3.14159265]}

plans = []
for name, targets in picked.items():
    # the same room for both; what the other one picks is an obstacle
    trays = [{**tray, "targets": targets.get(tray["name"], [])} for tray in room["trays"]]
    scenario = {**room, "start": starts[name], "goal": goals[name], "trays": trays, "reach": {"samples": 500_000}}
    Path(f"{name}.yaml").write_text(yaml.safe_dump(scenario, sort_keys=False))
    plan = mg.plan_part_supply(f"{name}.yaml")
    print(f"{name}: {plan}")
    plans.append(plan.save(f"{name}.json"))

schedule = schedule_plans(plans, clearance=0.1)  # the first goes as planned, the second around it
for name, robot in zip(picked, schedule.robots, strict=True):
    print(
        f"{name}: done at {robot.end:.1f} s, {robot.waited:.1f} s of them waiting (not before {robot.earliest_end:.1f} s)"
    )
    for piece, wait in zip(robot.course.pieces, robot.waits(), strict=True):
        if wait > 0:
            print(f"  waits {wait:.2f} s before '{piece.name}'")

schedule.save("schedule.json")
schedule.save_trajectories("trajectories")
print("the schedule holds" if verify_schedule("schedule.json").ok else "the schedule does not hold")
