"""Small objects of the module's classes, made once for tests that call everything (argument_values.py)."""

from __future__ import annotations

import functools
from pathlib import Path
from typing import Any

import numpy as np

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp.grippers.turned_parts import block
from mmgrasp.reproduce.drive_by import GOAL, START, whole_body

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
PASSED = mg.pose([5.5, -2, 0.5], [1, 1, 0])


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


def pinching_hand() -> mg.Hand:
    groups = [("fingers", [f"finger_{k}_{j}" for k in (1, 2) for j in ("proximal", "distal")]), ("spread", ["spread"])]
    bent = np.array([-0.4, 0.4, -0.4, 0.4, 0.0])
    return mg.grasping.eigengrasp_hand(
        seven_joint_hand(), "tcp_pinch", groups, open=bent + [0, 0, 0, 0, 1.57], closed=[0.2, -0.2, 0.2, -0.2, 1.57]
    )


def drive_by_program() -> mg.planning.WholeBodyProgram:
    made = mg.planning.drive_by_program(ARM, start=Q, tasks=[], goal=Q / 2, waypoints=5)
    assert made is not None
    return made


class Bowl(mg.optim.NonlinearProblem):
    """Least squares of two numbers."""

    def variable_bounds(self) -> Any:
        return np.full(2, -np.inf), np.full(2, np.inf)

    def constraint_bounds(self) -> Any:
        return [], []

    def objective(self, x: np.ndarray) -> float:
        return float(x @ x)

    def gradient(self, x: np.ndarray) -> Any:
        return 2 * x

    def constraints(self, x: np.ndarray) -> Any:
        return []

    def jacobian_pattern(self) -> Any:
        return [], []

    def jacobian(self, x: np.ndarray) -> Any:
        return []

    def hessian_pattern(self) -> Any:
        return [0, 1], [0, 1]

    def hessian(self, x: np.ndarray, factor: float, multipliers: np.ndarray) -> Any:
        return [2 * factor, 2 * factor]


FINGERS = [(f, [f"{f}_proximal", f"{f}_distal"]) for f in ("thumb", "finger_1", "finger_2")] + [("spread", ["spread"])]


def pipe() -> mg.grasping.Pipe:
    return mg.grasping.Pipe([[0.0, 0, 0], [0.3, 0, 0]], [(0, 1)], 0.02)


def object_path_problem() -> mg.grasping.ObjectPathProblem:
    return mg.grasping.ObjectPathProblem(ARM, world(), [BOX], [POSE, POSE])


@functools.cache
def drive_by() -> mg.planning.DriveByResult:
    """A platform that passes a point, without anything around."""
    robot, group = whole_body()
    return mg.plan_drive_by(
        robot, group, mg.World(), start=START, tasks=[mg.DriveByTask(PASSED)], goal=GOAL, waypoints=12, collisions=False
    )


@functools.cache
def database() -> mg.ReachDatabase:
    return mg.ReachDatabase.build(ARM, samples=1000, threads=1)


def part_supply_problem() -> mg.base.PartSupplyProblem:
    return mg.base.PartSupplyProblem(
        ROBOT, ARM, gripper(), world(), [TRAY], Q, X_Y_THETA, X_Y_THETA, PLACE_REGION, grid_max_distance=1.0
    )


@functools.cache
def object_regions() -> mg.base.ObjectRegions:
    return mg.base.ObjectRegions.compute(part_supply_problem(), database(), GRID)


def manipulation_problem() -> mg.ManipulationProblem:
    """A box that goes 5 cm aside, held in its middle."""
    return mg.ManipulationProblem(ARM, world(), BOX, POSE, mg.pose([0, 0.05, 0]) @ POSE, [mg.Grasp(np.eye(4))])


def seen_box() -> mg.mapping.DepthImage:
    return mg.mapping.render_depth([BOX], mg.mapping.PinholeCamera(width=8, height=6), POSE)


@functools.cache
def height_map() -> mg.mapping.HeightMap:
    return mg.mapping.make_height_map(seen_box(), np.eye(4), [0.2, 0.2], resolution=0.02)


def assembly_operation() -> mg.gripper_design.AssemblyOperation:
    return mg.gripper_design.AssemblyOperation(
        [mg.gripper_design.PlacedMesh("part", cube())], [], [np.eye(4), mg.pose([0, 0, 0.1])]
    )


def assembly_grasp() -> mg.gripper_design.AssemblyGrasp:
    return mg.gripper_design.AssemblyGrasp(np.eye(4), contact_length=0.01, contact_width=0.01)


def placed_bodies() -> mg._core._PlacedBodies:
    return mg._core._PlacedBodies([BOX], [POSE])


OBJECTS: dict[str, Any] = {
    "WholeBodyProgram": drive_by_program,
    "Robot": lambda: ROBOT,
    "RobotSource": lambda: ROBOT.source,
    "JointGroup": lambda: ARM,
    "World": world,
    "DistanceField": distance_field,
    "World.detach": held,
    "CollisionChecker": lambda: mg.CollisionChecker(ROBOT, world(), ARM),
    "ReachDatabase": database,
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
    "PartSupplyProblem": part_supply_problem,
    "LinkShape": lambda: BOX,
    "Pipe": pipe,
    "LineGrasp": mg.grasping.LineGrasp,
    "DepthNoise": mg.mapping.DepthNoise,
    "Hand": gripper,
    "DriveByResult": drive_by,
    "WholeBodyTrajectory": lambda: drive_by().trajectory,
    "ObjectRegions": object_regions,
    "RobotMotion": lambda: mg.planning.RobotMotion(OBJECTS["JointTrajectory"]()),
    "BaseGrid": lambda: GRID,
    "_PlacedBodies": placed_bodies,
    "PlanToCheck": lambda: mg.verify.PlanToCheck(ROBOT.source),
}
