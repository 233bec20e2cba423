"""Inverse kinematics: one solution, every branch, what the redundancy is used for, and where a base should stand."""

from pathlib import Path

import mmgrasp as mg

robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf", base="diff_drive")
arm = robot.group("arm_with_torso", tip="gripper_tcp")
T_world_tip = mg.pose([0.7, 0.2, 0.9], rpy=[0, 0, 0])

# One solution, and the same with the joints kept away from their limits.
plain = arm.ik(T_world_tip, rng_seed=1)
limits = mg.robot.joint_limit_objective(arm, soft_fraction=0.3)
better = arm.ik(T_world_tip, rng_seed=1, objectives=[limits])
print(f"joint limit cost {limits.evaluate(plain.q)[0]:.4f} -> {better.objective:.4f}")

# A diverse set of collision-free solutions, and why others fell.
world = mg.World()
world.add_box("table", size=(0.6, 1.2, 0.04), pose=mg.pose([0.9, 0, 0.7]))
solutions = arm.ik_all(T_world_tip, count=8, world=world)
print(len(solutions), "free solutions; the first two differ by", abs(solutions[0] - solutions[1]).max().round(2), "rad")
print(arm.ik_branches(T_world_tip, world=world))

# Base and arm as one chain; then two poses, a table's length apart, with the least driving between them.
whole = robot.group("arm_with_torso", tip="gripper_tcp", with_base=True)
print(whole.ik(mg.pose([4, 3, 0.9], rpy=[0, 0, 1.5]), rng_seed=1))
checker = mg.CollisionChecker(robot, world, group=whole)
database = mg.base.IkSeedDatabase(whole)
down = [0, 1.5708, 0]
for place in (0.3, 0.5):
    found = mg.base.plan_platform_locations(
        checker,
        mg.pose([0.8, -place, 0.9], rpy=down),
        mg.pose([0.8, place, 0.9], rpy=down),
        database=database,
        samples=20,
    )
    print(found, "after", found.pick["iterations"] + found.place["iterations"], "iterations")
