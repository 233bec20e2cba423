"""The dicts that results of the C++ library hold, as types: what keys there are, and what they mean.

from mmgrasp.records import RobotReport

def print_meshes(report: RobotReport) -> None:
    for mesh in report["meshes"]:
        print(mesh["path"], mesh["triangles"])
"""

from __future__ import annotations

from typing import TypedDict

from numpy import float64
from numpy.typing import NDArray

from . import _core


class MeshRow(TypedDict):
    """What reading one collision mesh found, in `RobotReport.meshes`."""

    path: str
    vertices_read: int
    vertices_merged: int
    degenerate_triangles: int
    triangles: int
    closed: bool
    convex: bool
    chosen: str  # the shape that stands in for the mesh
    triangles_saved: int
    deviation: float  # how far that shape sticks out [m]


class RobotReport(TypedDict):
    """What loading a robot found: `Robot.report`."""

    warnings: list[str]
    meshes: list[MeshRow]
    missing: list[str]  # mesh files that were not there


class JointRow(TypedDict):
    """One joint of `Robot.joint_table`."""

    name: str
    type: str
    parent: str  # link
    child: str  # link
    lower: float  # [rad or m]
    upper: float
    velocity: float  # [rad/s or m/s]
    mimic: str | None  # the joint it follows


class GroupRow(TypedDict):
    """One SRDF group of `Robot.groups`."""

    joints: list[str]
    base_link: str
    tip_link: str


class EndEffectorRow(TypedDict):
    """One SRDF end effector of `Robot.end_effectors`."""

    name: str
    group: str
    parent_link: str


class UrdfRow(TypedDict):
    """One URDF of `RobotSource.urdfs`: the arguments of add_urdf."""

    urdf: str  # its text
    origin: str  # the file it came from, for messages
    prefix: str  # of every name in it
    parent_link: str  # empty: its root is the robot's
    T: NDArray[float64]  # T_parent_root (4, 4)
    mesh_files: dict[str, str]  # files by the URDF's mesh filenames; an empty one leaves the mesh out


class AddedLinkRow(TypedDict):
    """One link of `RobotSource.added_links`: the arguments of add_link."""

    name: str
    parent_link: str
    T: NDArray[float64]  # T_parent_link (4, 4)
    shapes: list[_core.LinkShape]


class WorldPadding(TypedDict):
    """How far bodies are grown where the robot meets the scene [m]: `World.padding`."""

    links: float  # the robot's
    attached: float  # what it holds
    objects: float  # the scene's
    by_name: dict[str, float]  # of a link, an object or an SRDF group, in place of the others


class MeshStandIn(TypedDict):
    """A simpler shape for a mesh: `simplify_mesh`."""

    shape: _core.LinkShape
    chosen: str
    triangles_saved: int
    deviation: float  # how far it sticks out of the mesh [m]


class RoadmapStatistics(TypedDict):
    """What a roadmap looks like: `Roadmap.statistics`."""

    mean_degree: float
    components: int  # connected parts
    largest_component: int  # its vertices
    neighbours: int  # nearest vertices that each is joined with; 0: all within the radius
    radius: float  # of connection, with nearest vertices the longest edge [rad or m]
    volume: float  # of the joint limits
    gamma_star: float  # the gamma that PRM* asks for


class StageRow(TypedDict):
    """What one stage of a planner over many grasps contributed, in `ManipulationStats.stages`."""

    improvements: int
    first_seconds: float  # of its first better path, since the call began
    last_seconds: float
    cost: float  # of its last one


class ClosingOutcomeRow(TypedDict):
    """What beginning to close at one moment leads to: `ClosingOutcome.to_dict()`."""

    start: float  # engagement at which closing begins [m]
    both_touch: float  # [m]
    pushed: float  # [m]
    swept: float  # [m]
    side_clearance: float  # [m]
    holds: bool
    lateral_tolerance: float  # [m]
    nearer_tolerance: float  # [m]
    farther_tolerance: float  # [m]
    covered_sigmas: float | None  # None: the object's position is certain
    probability: float


class DriveByEventRow(TypedDict):
    """When and how one task of a drive-by is done: `DriveByResult.events`."""

    waypoint: int
    time: float  # [s]
    close_time: float  # [s]
    object: str  # what is held then; empty: nothing
    attach_time: float  # [s]
    T_tip_object: list[list[float]] | None  # (4, 4) of what is held
    candidate: int
    base_speed: float  # [m/s]
    tool_speed: float  # [m/s]
    push: ClosingOutcomeRow | None  # what a push-grasp survives


class ViolationRow(TypedDict):
    """How far one kind of constraint is broken: `DriveByResult.violations`."""

    value: float  # 0 when kept
    tolerance: float
    unit: str
    time: float  # where it is worst [s]
    waypoint: int
    what: str
    kept: bool


class SearchCounts(TypedDict):
    """What one pose's search of `plan_platform_locations` took."""

    draws: int
    rejections: dict[str, int]
    view: int  # rejected because the camera does not see the point
    singular: int  # rejected for their manipulability
    iterations: int


class GripperEventRow(TypedDict):
    """What the gripper does at one time: `RobotMotion.gripper`."""

    time: float  # when it begins [s]
    duration: float  # [s]
    command: str  # open or close
    opening: float | None  # at the end [m]; None: not known
    object: str  # what is held afterwards, or no longer; may be empty


class GraspabilityCounts(TypedDict):
    """Places of the fingertips that were checked, and those rejected by cause: `Graspability.counts`."""

    tried: int  # local maxima of graspability
    too_wide: int  # no room for the fingers once the hand is centred on the part
    poor: int  # the pads would meet too little of it, or two parts at once
    collision: int  # the hand, centred and opened for the part, would touch something
    near_better: int  # a better one lies beside it, or max_grasps better ones exist


class SynthesisCounts(TypedDict):
    """What became of the surface points drawn and the grasps evaluated: `GraspSynthesis.counts`."""

    drawn: int  # surface points, of which one grasp each was to be made
    no_opposite: int  # no surface on the other side
    too_wide: int  # wider there than the hand opens
    too_thin: int  # thinner than the hand closes
    tilted: int  # an approach beyond max_tilt
    evaluated: int  # grasps, those of the second search included
    missed: int  # a pad meets too little of the surface, or the hand does not fit around it
    uneven: int  # a pad meets no plane
    slipping: int  # outside the friction cones
    uncertain: int  # surface less certain than max_sigma
    collision: int  # the hand touches the map, open, on its way in or while it closes
    table: int  # the hand touches the table
    arm: int  # not reached by the arm; `GraspSynthesis.arm` says why
    near_better: int  # a better one lies beside it, or max_grasps better ones exist


class TimeFromStart(TypedDict):
    """A ROS builtin_interfaces/Duration."""

    sec: int
    nanosec: int


class MotionPoint(TypedDict):
    """A ROS trajectory_msgs/JointTrajectoryPoint, and the base."""

    positions: list[float]
    velocities: list[float]
    accelerations: list[float]
    effort: list[float]
    time_from_start: TimeFromStart
    base_pose: list[float]  # x, y, theta in the world
    base_twist: list[float]  # v_x, v_y, omega in the platform's frame


class MotionMessage(TypedDict):
    """`RobotMotion.to_joint_trajectory`: a ROS trajectory_msgs/JointTrajectory with base and gripper."""

    header: dict[str, str]
    joint_names: list[str]
    points: list[MotionPoint]
    gripper: list[GripperEventRow]
