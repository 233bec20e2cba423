"""Ask how near the arm is to what, follow the gradient away from it, and carry a part past an obstacle."""

from pathlib import Path

import mmgrasp as mg

robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf")
arm = robot.group("arm_with_torso", tip="gripper_tcp")

world = mg.World()
world.add_box("table", size=(0.6, 1.2, 0.04), pose=mg.pose([0.9, 0, 0.6]))
world.add_box("part", size=(0.04, 0.04, 0.2), pose=mg.pose([0.7, 0.2, 0.75]))
q = arm.ik(mg.pose([0.6, 0.2, 0.9]), world=world, rng_seed=1).q

checker = mg.CollisionChecker(robot, world, group=arm)
nearest = checker.distance(q, gradient=True)
print(nearest, "gradient", nearest.gradient.round(3))
for pair in checker.distances(q, within=0.1):
    print(f"  {pair.a} - {pair.b}: {pair.value:.4f} m")

step = q + 0.05 * nearest.gradient / max(abs(nearest.gradient))
print(f"a step along the gradient: {nearest.value:.4f} m -> {checker.distance(step).value:.4f} m")

# The gripper takes the part: it moves with the link, and its fingers may touch it. A checker sees the world as it was when
# it was made, so the change needs a new one.
world.attach("part", link="gripper_link", pose=mg.pose([0.15, 0, 0]))
carrying = mg.CollisionChecker(robot, world, group=arm)
print("carrying:", carrying.distance(q))
lower = arm.ik(mg.pose([0.7, 0.2, 0.68]), seed=q, world=mg.World(), rng_seed=1).q
print("down to the table:", carrying.check_edge(q, lower, continuous=True))

world.detach("part", mg.pose([0.7, 0.2, 0.72]))  # back into the scene, standing on the table
print(world, "part at", world.pose_of("part")[:3, 3])
