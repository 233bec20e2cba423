"""Good values for the arguments of the binary module, by the argument's name (test_bad_arguments.py)."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp.grippers.turned_parts import block
from mmgrasp.problems.pipe_cells import pipe_robot

CORPUS = REPOSITORY / "tests" / "fuzz" / "corpus"
URDF = """<robot name="r"><link name="o"/>
<link name="a"><collision><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link><link name="b"/><link name="tip"/>
<joint name="i" type="revolute"><parent link="o"/><child link="a"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1"/></joint>
<joint name="k" type="prismatic"><parent link="b"/><child link="tip"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1"/></joint>
</robot>"""

SRDF = """<robot name="r"><group name="arm"><chain base_link="o" tip_link="tip"/></group>
<group_state name="ready" group="arm"><joint name="i" value="0.1"/><joint name="j" value="0.2"/><joint name="k" value="0.3"/></group_state>
</robot>"""
ROBOT = mg.Robot.from_strings(URDF, SRDF, base="omni")
ARM = ROBOT.group(base_link="o", tip="tip").with_acceleration_limits([1, 1, 1])
Q = np.array([0.25, 0.5, 0.5])
POSE = ARM.fk(Q)
WHOLE_BODY = ROBOT.group(base_link="o", tip="tip", with_base=True)
GRID = mg.base.BaseGrid([0.0, 0.0], 0.1, 4, 3)


def world() -> mg.World:
    world = mg.World()
    world.add_box("box", [0.1, 0.1, 0.1], mg.pose([3, 3, 3]))
    return world


def held() -> mg.World:
    held = world()
    held.attach("box", "tip")
    return held


def depth_camera() -> mg.mapping.DepthCamera:
    pinhole = mg.mapping.PinholeCamera(width=40, height=30, fx=60.0, fy=60.0, cx=19.5, cy=14.5)
    return mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise(constant=0.001))


def depth_frame() -> mg.mapping.DepthImage:
    """A wall 0.3 m in front of the camera."""
    return mg.mapping.DepthImage(np.full((30, 40), 0.3, np.float32), depth_camera().intrinsics)


def sdf_map() -> mg.ProbabilisticSdf:
    sdf = mg.ProbabilisticSdf()
    sdf.integrate(depth_frame(), depth_camera())
    return sdf


def occupancy_map() -> mg.mapping.OccupancyMap:
    occupancy = mg.mapping.OccupancyMap()
    occupancy.integrate(depth_frame(), depth_camera())
    return occupancy


def gripper() -> mg.Hand:
    return mg.Hand("tip", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.05, finger_width=0.02)


BOX = mg.LinkShape(mg.Box([0.05, 0.05, 0.05]))
PART = mg.base.Part("part", [BOX], POSE, [mg.Grasp(np.eye(4), 0.05)])
TRAY = mg.base.Tray("tray", np.eye(4), [0.3, 0.3, 0.1], [PART])
PLACE_REGION = mg.base.PlaceRegion(np.eye(4), [0.3, 0.3])
X_Y_THETA = np.array([0.5, 0.25, 0.75])

# Good arrays by the argument's name, and by class or function where the name means something else there.
VALUES: dict[str, Any] = {
    "GridDistanceField.origin": [0.0, 0.0, 0.0],
    "q": Q,
    "q0": Q,
    "q1": Q,
    "seed": Q,
    "Q": np.array([Q, Q / 2]),
    "path": np.array([Q, Q / 2]),
    "start": Q,
    "goal": Q,
    "base": Q,
    "via": np.array([Q, Q]),
    "home": Q,
    "limits": np.ones(3),
    "velocity_limits": np.ones(3),
    "acceleration_limits": np.ones(3),
    "size": np.array([0.1, 0.2, 0.3]),
    "labels": np.zeros(12),
    "Mesh.from_arrays.vertices": np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
    "Mesh.from_arrays.triangles": np.array([[0.0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
    "AssemblyOperation.motion": np.array([POSE, POSE]),
    "points": np.array([[1.0, 2, 3], [4, 5, 6]]),
    "centres": np.array([[1.0, 2, 3], [4, 5, 6]]),
    "point": np.array([0.1, 0.2, 0.3]),
    "pick_point": np.array([0.1, 0.2, 0.3]),
    "place_point": np.array([0.1, 0.2, 0.3]),
    "direction": np.array([0.0, 0.0, 1.0]),
    "grasp_holding.weight": np.array([0.0, 0.0, -2.0]),
    "grasp_holding.centre": np.array([0.01, 0.0, 0.0]),
    "grasp_holding.resistance": np.array([0.0, 0.0, 9.0]),
    "grasp_holding.hole": np.array([0.0, 0.01, 0.0]),
    "preferred_grippers.values": np.array([1.0]),
    "normal": np.array([0.0, 0.0, 1.0]),
    "up": np.array([0.0, 0.0, 1.0]),
    "tolerance": np.full(6, 0.25),
    "position": np.full(3, 0.25),
    "rotation": np.full(3, 0.25),
    "joint_weights": np.ones(3),
    "jerk_limits": np.ones(3),
    "origins": np.array([[0.0, 0.0, 1.0], [0.25, 0.0, 1.0]]),
    "directions": np.array([[0.0, 0.0, -1.0], [0.0, 0.5, -1.0]]),
    "pose_covariance": 1e-6 * np.eye(6),
    "bounds": np.array([[-0.1, -0.1, 0.2], [0.1, 0.1, 0.4]]),
    "ProbabilisticSdf.sigma": np.full((30, 40), 0.001),
    "synthesize_grasps.object": np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]]),
    "synthesize_grasps.arm_seed": Q,
    "eigengrasp_hand.open": np.radians([-90, 0, -25, 25, -25, 25, 90]),
    "eigengrasp_hand.closed": np.radians([-90, 0, 12, -12, 12, -12, 90]),
    "eigengrasp_hand.approach": np.array([0.0, 0, 1]),
    "lower": np.array([-1.0, -1.0, 0.0]),
    "plan_object_pick.places": POSE,
    "minimize_derivative_free.guess": np.array([0.5, 0.25]),
    "minimize_derivative_free.lower": np.array([0.0, -1.0]),
    "minimize_derivative_free.upper": np.array([1.0, 1.0]),
    "upper": np.array([1.0, 1.0, 2.0]),
    "drift": np.array([0.01, 0.01, 0.01]),
    "start_error": np.array([0.01, 0.01, 0.01]),
    "approach": np.array([1.0, 0, 0]),
    "closing": np.array([0.0, 1, 0]),
    "xyz": np.array([1.0, 2, 3]),
    "rpy": np.array([0.1, 0.2, 0.3]),
    "quat_xyzw": np.array([0.0, 0, 0, 1]),
    "R": np.eye(3),
    "lengths": np.ones((3, 3)),
    "costs": np.ones((3, 3)),
    "drive_times": np.ones((4, 4)),
    "route_lengths.positions": np.array([X_Y_THETA, X_Y_THETA]),
    "cells": np.ones((1, 3, 4), np.uint8),
    "base_pose": X_Y_THETA,
    "RobotMotion.of_drive.configuration": Q,
    "positions": np.ones((2, 3)),
    "velocities": np.ones((2, 3)),
    "accelerations": np.ones((2, 3)),
    "centre": np.array([0.5, 0.5]),
    "origin": np.array([0.5, 0.5]),
    "middle": np.array([0.5, 0.5]),
    "pose": POSE,
    "T": POSE,
    "eye": np.array([0.1, 0.2, 0.3]),
    "nodes": np.array([[0.0, 0, 0], [0.3, 0, 0]]),
    "tray_size": np.array([0.3, 0.4, 0.1]),
    "make_height_map.size": np.array([0.1, 0.2]),
    "T_world_tips": np.array([POSE, POSE]),
    "tool_poses": np.array([POSE, POSE]),
    "near": Q,
    "tool_axis": np.array([0.0, 0, 1]),
    "world_axis": np.array([0.0, 0, 1]),
    "T_base_tips": np.array([POSE, POSE]),
    "PlaceRegion.size": np.array([0.1, 0.2]),
    "PartSupplyProblem.start": X_Y_THETA,
    "PartSupplyProblem.goal": X_Y_THETA,
    "arrival_covariance": np.diag([0.01, 0.01, 0.001]),
    "_check_arrival_covariance.covariance": np.diag([0.01, 0.01, 0.001]),
    "plan_stops_exact.start": np.array([0.5, 0.25]),
    "plan_stops_exact.goal": np.array([0.25, 0.5]),
    "plan_base_route.start": X_Y_THETA,
    "plan_base_route.goal": X_Y_THETA,
    "platform_velocity": X_Y_THETA,
    "drive_arc.pose": X_Y_THETA,
    "BaseTracker.command": X_Y_THETA,
    "desired": X_Y_THETA,
    "desired_next": X_Y_THETA,
    "measured": X_Y_THETA,
    "JointTrajectory.times": np.array([0.0, 1.0]),
    "joint_velocity": X_Y_THETA,
    "IkSeedDatabase.add.q": np.array([0.5, 0.25, 0.75, *Q]),
    "verify.CheckedStop.pose": X_Y_THETA,
    "verify.CheckedRegion.cells": np.ones(12, np.uint8),
    "BeamMember.y_towards": np.array([0.0, 0, 1]),
    "gravity": np.array([0.0, 0, -9.81]),
    "force": np.array([0.0, 0, -1]),
    "moment": np.array([0.0, 0.5, 0]),
    "pairwise_weights.comparison": np.ones((3, 3)),
    "ObjectPathProblem.T_world_object": np.array([POSE, POSE]),
}


@functools.cache
def capability_map() -> mg.base.CapabilityMap:
    return mg.base.CapabilityMap.build(ARM, upper=(1, 1, 2), voxel=1, poses=2, threads=1)


def distance_field() -> mg.collision.GridDistanceField:
    return mg.collision.GridDistanceField(np.ones((3, 3, 3)), [0.0, 0.0, 0.0], 0.5)


def wall_map() -> mg.ProbabilisticSdf:
    sdf = mg.ProbabilisticSdf()
    sdf.integrate(depth_frame(), depth_camera())
    return sdf


def beam_member() -> mg.grasping.BeamMember:
    return mg.grasping.BeamMember(0, 1, mg.grasping.round_section(0.01), mg.grasping.copper())


def beam_frame() -> mg.grasping.BeamFrame:
    return mg.grasping.BeamFrame([[0.0, 0, 0], [0.3, 0, 0]], [beam_member()])


def tetrahedron() -> mg.Mesh:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    return mg.Mesh.from_arrays(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))


def cube() -> mg.Mesh:
    return block([0.1, 0.1, 0.1])


def seven_joint_hand() -> mg.Robot:
    return mg.Robot.load(Path(mg.__file__).parent / "assets" / "grippers" / "sdhlike" / "sdhlike.urdf")


FINGERS = [(f, [f"{f}_proximal", f"{f}_distal"]) for f in ("thumb", "finger_1", "finger_2")] + [("spread", ["spread"])]

OBJECTS: dict[str, Any] = {
    "Robot": lambda: ROBOT,
    "RobotSource": lambda: ROBOT.source,
    "JointGroup": lambda: ARM,
    "World": world,
    "DistanceField": distance_field,
    "World.detach": held,
    "CollisionChecker": lambda: mg.CollisionChecker(ROBOT, world(), ARM),
    "ReachDatabase": lambda: mg.ReachDatabase.build(ARM, samples=1000, threads=1),
    "CapabilityMap": capability_map,
    "PinholeCamera": mg.mapping.PinholeCamera,
    "ProbabilisticSdf": mg.ProbabilisticSdf,
    "OccupancyMap": mg.mapping.OccupancyMap,
    "BaseTracker": lambda: mg.base.BaseTracker(ROBOT),
    "IkObjective": lambda: mg.robot.joint_limit_objective(ARM),
    "IkSeedDatabase": lambda: mg.base.IkSeedDatabase(WHOLE_BODY),
    "Roadmap": lambda: mg.planning.Roadmap.build(ARM, vertices=10),
    "JointTrajectory": lambda: mg.time_parameterize([Q, Q / 2], np.ones(3), np.ones(3), names=["i", "j", "k"]),
    "BeamFrame": beam_frame,
    "SupportedFrame": lambda: mg.grasping.SupportedFrame(beam_frame(), mg.grasping.BeamSupport(0, 0.0)),
    "PartSupplyProblem": lambda: mg.base.PartSupplyProblem(
        ROBOT, ARM, gripper(), world(), [TRAY], Q, X_Y_THETA, X_Y_THETA, PLACE_REGION
    ),
}

# The arguments beside the array.
# Optional arguments that mean nothing without another one.
COMPANIONS: dict[str, dict[str, Any]] = {
    "plan_platform_locations.T_link_camera": {"camera_link": "tip"},
    **{f"plan_motion.{name}": {"group": ARM, "world": world()} for name in ("goal", "tool_poses")},
    **{f"plan_motion.{name}": {"group": ARM, "world": world(), "goal": Q} for name in ("start", "via")},
    "plan_stops_exact.goal": {"start": np.array([0.5, 0.25])},
    "plan_stops_exact.start": {"goal": np.array([0.25, 0.5])},
    "fit_cuboids.T_world_tray": {"tray_size": [0.3, 0.4, 0.1]},
    "synthesize_grasps.arm_seed": {"arm": ARM},
    "JointTrajectory.accelerations": {"velocities": np.zeros((2, 3))},
    "CapabilityMap.build.upper": {"voxel": 1, "poses": 2, "threads": 1},
    **{
        f"CapabilityMap.build.{name}": {"upper": (1, 1, 2), "voxel": 1, "poses": 2, "threads": 1}
        for name in ("lower", "approach")
    },
}
OTHERS: dict[str, Any] = {
    "mesh": tetrahedron,
    "PlacedMesh.mesh": tetrahedron,
    "fit_primitives.mesh": cube,
    "AssemblyOperation.active": lambda: [mg.gripper_design.PlacedMesh("part", tetrahedron())],
    "AssemblyOperation.passive": list,
    "centric_grasps.low": lambda: -0.05,
    "grasp_holding.grasp": lambda: mg.gripper_design.AssemblyGrasp(POSE, contact_length=0.01, contact_width=0.01),
    "grasp_holding.grip": mg.gripper_design.FingerGrip,
    "preferred_grippers.requirements": lambda: [mg.gripper_design.SegmentRequirement("a", 0.02)],
    "preferred_grippers.actuators": lambda: [mg.gripper_design.GripperActuator("jaws", 0.05)],
    "centric_grasps.high": lambda: 0.05,
    "ObjectPathProblem.object": lambda: [BOX],
    "BeamMember.first": lambda: 0,
    "BeamMember.second": lambda: 1,
    "BeamMember.section": lambda: mg.grasping.round_section(0.01),
    "BeamMember.material": mg.grasping.copper,
    "NodeLoad.node": lambda: 0,
    "BeamFrame.members": lambda: [beam_member()],
    "BeamFrame.deflection.grasp": lambda: mg.grasping.BeamSupport(0, 0.0),
    "member": lambda: 0,
    "robot": lambda: ROBOT,
    "urdf": lambda: URDF,
    "World.add_field.name": lambda: "field",
    "World.add_field.field": distance_field,
    "GridDistanceField.values": lambda: np.ones((3, 3, 3)),
    "JointGroup.q.values": lambda: {"i": 0.5},
    "JointGroup.state.name": lambda: "ready",
    "JointTrajectory.names": lambda: ["i", "j", "k"],
    "depth": lambda: np.ones((480, 640), np.float32),
    "height": lambda: np.ones((3, 4)),
    "group": lambda: ARM,
    "arm": lambda: ARM,
    "world": world,
    "scene": world,
    "checker": OBJECTS["CollisionChecker"],
    "plan_platform_locations.checker": lambda: mg.CollisionChecker(ROBOT, world(), WHOLE_BODY),
    "camera_link": lambda: "tip",
    "theta": lambda: 0.5,
    "database": OBJECTS["ReachDatabase"],
    "problem": OBJECTS["PartSupplyProblem"],
    "gripper": gripper,
    "grid": lambda: GRID,
    "place_region": lambda: PLACE_REGION,
    "camera": mg.mapping.PinholeCamera,
    "ProbabilisticSdf.integrate.camera": depth_camera,
    "ProbabilisticSdf.integrate.image": depth_frame,
    "OccupancyMap.integrate.camera": depth_camera,
    "OccupancyMap.integrate.image": depth_frame,
    "World.add_sdf.name": lambda: "sdf",
    "World.add_sdf.sdf": sdf_map,
    "World.add_occupancy.name": lambda: "occupancy",
    "World.add_occupancy.occupancy": occupancy_map,
    "render_depth.scene": lambda: [BOX],
    "random_placement.part": lambda: [BOX],
    "segment_depth_image.image": depth_frame,
    "make_height_map.image": lambda: mg.mapping.render_depth([BOX], mg.mapping.PinholeCamera(width=8, height=6), POSE),
    "RobotMotion.trajectory": OBJECTS["JointTrajectory"],
    "RobotMotion.of_drive.path": lambda: mg.base.plan_base_route(
        ARM, mg.World(), home=Q, start=[0, 0, 0], goal=[0.5, 0, 0]
    ),
    "trajectory": lambda: mg.planning.JointTrajectory(["x", "y", "theta"], [0.0, 1.0], np.zeros((2, 3))),
    "sections": lambda: [(0, 1)],
    "objective": lambda: lambda x: float(np.sum(x * x)),
    "plan_stops_exact.regions": lambda: [mg.base.BaseRegion("tray", np.ones((1, 3, 4), np.uint8), GRID)],
    "_first_drive_by_guess.tasks": lambda: [mg.DriveByTask(POSE)],
    "diameters": lambda: 0.02,
    "shape": lambda: mg.Box([0.1, 0.1, 0.1]),
    "shapes": lambda: [BOX],
    "parts": lambda: [PART],
    "trays": lambda: [TRAY],
    "plan_stop_picks.trays": lambda: [0],
    "tasks": lambda: [],
    "task_times": lambda: [],
    "remaining": lambda: [(0, 0)],
    "other": lambda: mg.Robot.from_strings('<robot name="s"><link name="a"/></robot>'),
    "parent_link": lambda: "tip",
    "tool_link": lambda: "tip",
    "synthesize_grasps.map": wall_map,
    "synthesize_grasps.hand": gripper,
    "eigengrasp_hand.robot": seven_joint_hand,
    "eigengrasp_hand.tool_link": lambda: "tcp",
    "eigengrasp_hand.groups": lambda: FINGERS,
    "Hand.kind": lambda: "parallel",
    "Hand.from_robot.robot": lambda: pipe_robot("tm14like")[0],
    "Hand.from_robot.tool_link": lambda: "gripper_tcp",
    "link": lambda: "tip",
    "headings": lambda: [0.0],
    "distances": lambda: [0.5, 1.0],
    "nx": lambda: 4,
    "ny": lambda: 3,
    "tray": lambda: 0,
    "BaseRegion.tray": lambda: "tray",
    "part": lambda: 0,
    "times": lambda: [0.0, 1.0],
    "stop_times": lambda: [1.0, 2.0],
    "robots": lambda: 1,
    "attached": lambda: False,
    "kind": lambda: "approach",
    "name": lambda: "fresh",
    "World.add_mesh.path": lambda: CORPUS / "stl" / "tetrahedron.stl",
    "LinkShape.mesh.path": lambda: CORPUS / "stl" / "tetrahedron.stl",
    "World.add_octree.path": lambda: CORPUS / "bt" / "one_leaf.bt",
    "World.move.name": lambda: "box",
    "World.attach.name": lambda: "box",
    "World.detach.name": lambda: "box",
    "ManipulationProblem.object": lambda: BOX,
    "ManipulationProblem.grasps": lambda: [mg.Grasp(np.eye(4))],
    "plan_object_pick.object": lambda: "box",
    "plan_object_pick.grasps": lambda: [],
    "verify.check_path.joints": lambda: ["i", "j", "k"],
    "verify.check_path.bodies": lambda: [],
    "verify.CheckedStop.trays": lambda: ["tray"],
    "verify.CheckedIntersection.trays": lambda: ["tray"],
    "verify.CheckedRegion.tray": lambda: "tray",
    "verify.CheckedTray.max_distance": lambda: 1.0,
}
