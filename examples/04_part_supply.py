"""The main job: plan a whole round, look at the answer, and check it again without the planner."""

from pathlib import Path

import mmgrasp as mg

plan = mg.plan_part_supply(Path(mg.__file__).parent / "assets" / "scenarios" / "storeroom.yaml", seed=1)
print(plan)
for stop in plan.stops:
    print("stop at", stop.pose.round(3), "robust within", round(stop.radius, 3), "m")
for pick in plan.picks[:3]:
    print(pick, "takes", round(pick.duration, 1), "s")
plan.save("plan.json")

verdict = mg.verify_plan("plan.json", samples=100)
print("holds" if verdict.ok else verdict.faults)
