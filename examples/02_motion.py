"""Plan an arm motion around a post, give it a clock, and write it as CSV."""

from pathlib import Path

import mmgrasp as mg

robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf")
arm = robot.group("arm_with_torso", tip="gripper_tcp")

world = mg.World()
world.add_box("post", size=(0.08, 0.08, 1.6), pose=mg.pose([0.75, 0, 0.8]))
start = arm.ik(mg.pose([0.6, 0.4, 0.9]), world=world).q
goal = arm.ik(mg.pose([0.6, -0.4, 0.9]), seed=start, world=world).q

result = mg.plan_motion(robot, arm, world, start=start, goal=goal, planner="rrt_connect", seed=1, time_limit=5.0)
print(result)
checker = mg.CollisionChecker(robot, world, group=arm)
trajectory = mg.planning.time_parameterize_free(checker, result.path)
print(trajectory)
Path("motion.csv").write_text(trajectory.to_csv())
