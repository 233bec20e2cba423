"""Load a robot, compute where its tool is, and find a configuration for a pose."""

from pathlib import Path

import mmgrasp as mg

robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf")
arm = robot.group("arm_with_torso", tip="gripper_tcp")
print(arm)

T_world_tip = mg.pose([0.7, 0.2, 0.9], rpy=[0, 0, 0])
found = arm.ik(T_world_tip, world=mg.World(), rng_seed=1)  # an empty world: no self-collision either
print(found)
print("tool at", arm.fk(found.q)[:3, 3].round(6))
print("Jacobian", arm.jacobian(found.q).shape)
