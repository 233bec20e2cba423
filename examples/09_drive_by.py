"""Take a bottle from a table without stopping: one motion of base and arm, tried in physics, and pictures of it.

Writes drive_by.png, or with --gif also drive_by.gif. Physics needs MuJoCo (pip install 'mmgrasp[sim]'); without it the pictures
show the plan.
"""

import importlib.util
import sys
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp.sim.pictures import Painter, planned_states, write_gif, write_strip
from mmgrasp.viz.raster import Camera

# Planned at 0.5 m/s, carried out by a base that can do 0.6: what is left corrects the way.
robots = Path(mg.__file__).parent / "assets" / "robots" / "fetchlike"
limits = {"wheel_separation": 0.37476, "linear_velocity": 0.5}
robot = mg.Robot.load(robots / "fetchlike.urdf", robots / "fetchlike.srdf", base="diff_drive", base_limits=limits)
real = mg.Robot.load(
    robots / "fetchlike.urdf",
    robots / "fetchlike.srdf",
    base="diff_drive",
    base_limits={**limits, "linear_velocity": 0.6},
)
fingers = ["left_gripper_finger", "right_gripper_finger"]
gripper = mg.Hand(
    "gripper_tcp", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.10, finger_depth=0.04, finger_width=0.022,
    joints=[mg.grasping.HandJoint(f"{name}_joint", 0.0, 0.05) for name in fingers],
    finger_links=[f"{name}_link" for name in fingers],
)  # fmt: skip

scene = mg.World()
scene.add_box("table", size=(1.2, 0.5, 0.7), pose=mg.pose([2.0, -0.9, 0.35]))
bottle = sim.SimPart("bottle", [mg.LinkShape(mg.Cylinder(0.028, 0.16))], mg.pose([2.0, -0.8, 0.78]))
world = scene.copy()
world.add("bottle", bottle.shapes, mg.pose([0, 0, 0.001]) @ bottle.pose)  # touching would count as a collision

opening = 0.08
at_rest = {"head_tilt_joint": 0.4, **gripper.joint_values(opening)}
body = robot.group("arm_with_torso", tip="gripper_tcp", with_base=True).with_reference(at_rest)
home = [0.05, 1.2, -1.2, -0.2, -1.3, 0.0, -1.6, 0.0]
start, goal = [0.0, 0.0, 0.0, *home], [4.0, 0.0, 0.0, *home]

# The hand comes straight from 12 cm before the bottle, and stands still in the room while the fingers close and the base drives
# on. A bottle may be taken from any side: the first that works is taken.
for yaw in (-0.6, -0.9, -1.2, -0.3):
    T_grasp = mg.pose([2.0, -0.8, 0.77], rpy=[0, 0, yaw])
    tasks = [
        mg.DriveByTask(T_grasp @ mg.pose([-0.12, 0, 0]), tolerance=[0.005] * 3 + [0.03] * 3),
        mg.DriveByTask(T_grasp, dwell=(opening - 0.056) / 0.1 + 0.15, object="bottle"),
    ]
    found = mg.plan_drive_by(robot, body, world, start=start, tasks=tasks, goal=goal, waypoints=45)
    if found.outcome == mg.Outcome.solved:
        break
print(found)
grasp = found.events[1]
trajectory = found.trajectory.sampled(between=9)
print(f"{found.duration:.2f} s for 4 m; the base passes at {grasp['base_speed']:.2f} m/s as the hand closes")
print(f"without the bottle the drive alone takes {4 / 0.5 + 0.5 / 0.5:.2f} s")

states, end = None, found.duration
if importlib.util.find_spec("mujoco") is None:
    print("no physics here: pip install 'mmgrasp[sim]'")
else:
    trial = sim.Simulation(real, scene, [bottle], gripper=gripper, joints={"head_tilt_joint": 0.4})
    run = trial.run(
        trajectory, close_at=grasp["time"], opening=opening, hold=2.0,
        position_noise=0.002, heading_noise=0.002, travel_noise=0.003,
    )  # fmt: skip
    print(run.parts["bottle"])
    print(f"the base was off its way by at most {1000 * run.base_error:.0f} mm")
    states = run.states

painter = Painter(real, gripper, scene, [bottle])
camera = Camera(np.array([2.0, -3.4, 2.0]), np.array([2.0, -0.3, 0.72]), 440, 250, fov=34)


def pictures(times: np.ndarray) -> list[np.ndarray]:
    if states is None:
        chosen = planned_states(
            real, trajectory, times, [bottle], joints=at_rest, attached=("bottle", grasp["time"], "gripper_tcp")
        )
    else:
        clock = np.array([state["time"] for state in states])
        chosen = [states[int(abs(clock - time).argmin())] for time in times]
    return [painter.picture(state, camera) for state in chosen]


shown = grasp["time"] + np.array([-1.6, -0.8, -0.3, 0.0, 0.3, 0.8, 1.4, 2.2])
print("written:", write_strip("drive_by.png", pictures(shown), columns=4))
if "--gif" in sys.argv:
    print("written:", write_gif("drive_by.gif", pictures(np.arange(0.6, end, 0.12)), 0.12))
