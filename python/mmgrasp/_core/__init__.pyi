"""
The C++ library behind mmgrasp. Import names from mmgrasp itself.
"""
from __future__ import annotations
import collections.abc
import enum
import numpy
import numpy.typing
import typing
from . import verify
__all__: list[str] = ['BaseGrid', 'BasePath', 'BasePlacement', 'BaseRegion', 'BaseTracker', 'BaseTrackingResult', 'Box', 'CapabilityMap', 'Capsule', 'CarryPlace', 'CartesianResult', 'ClosingOutcome', 'CollisionChecker', 'Contact', 'ContactPairProvenance', 'CuboidFit', 'Cylinder', 'DepthImage', 'DistanceResult', 'DriveByResult', 'DriveByTask', 'EdgeResult', 'Error', 'FittedCuboid', 'Grasp', 'GraspReport', 'Graspability', 'Hand', 'HandBody', 'HandJoint', 'HeightMap', 'HeightMapProvenance', 'IkBranches', 'IkObjective', 'IkResult', 'IkSeedDatabase', 'Improvement', 'Intersection', 'Intersections', 'InvalidInput', 'IoError', 'JointGroup', 'JointTrajectory', 'LinkShape', 'ManipulationProblem', 'ManipulationResult', 'Mesh', 'MotionResult', 'MotionStats', 'ObjectRegions', 'Obstruction', 'OptimisedOrder', 'Outcome', 'Part', 'PartExplanation', 'PartSupplyPlan', 'PartSupplyProblem', 'Pick', 'PickMotion', 'PinholeCamera', 'Pipe', 'PipeProvenance', 'PlacedPart', 'Plane', 'PlatformLocations', 'PointCloud', 'PolicyResult', 'PolicyRound', 'PushGrasp', 'RandomPlacement', 'ReachDatabase', 'Rejection', 'Rejections', 'RestingPose', 'Roadmap', 'Robot', 'SearchTree', 'SetCoverResult', 'SharedTours', 'Sphere', 'Stop', 'StopSet', 'StraightLineResult', 'ToolCone', 'ToolRegion', 'TourResult', 'Tray', 'Voxels', 'WholeBodyTrajectory', 'World', 'cache_folder', 'camera_view_objective', 'cheapest_assignment', 'closing_outcome', 'compute_base_regions', 'compute_disabled_pairs', 'drive_arc', 'evaluate_graspability', 'find_package', 'fit_cuboids', 'graspability_map', 'hand_masks', 'inscribed_circle', 'joint_limit_objective', 'joint_velocity', 'least_stops', 'look_down', 'make_base_grid', 'make_height_map', 'manipulation_planner_names', 'maximal_intersections', 'minimal_stops', 'nlp_solver_names', 'optimised_order', 'paired_order', 'plan_base_route', 'plan_cartesian', 'plan_drive_by', 'plan_manipulation', 'plan_motion', 'plan_part_supply', 'plan_pick', 'plan_platform_locations', 'plan_straight_line', 'planner_names', 'platform_velocity', 'pose', 'pose_to_xyz_quat', 'pose_to_xyz_rpy', 'push_grasp', 'push_speed_limit', 'quat_xyzw_from_rotation', 'random_placement', 'read_pcd', 'render_depth', 'resting_poses', 'robust_intersections', 'route_lengths', 'run_policy', 'sample_grasps', 'self_distance_objective', 'share_stops', 'shorten_drive_by', 'shortest_visiting_tour', 'simplify_mesh', 'singularity_objective', 'solve_set_cover', 'time_parameterize', 'time_parameterize_free', 'track_base', 'tray_shapes', 'verify', 'wheel_speeds', 'with_sampled_pairs']
class Error(Exception):
    """
    Base of all errors of mmgrasp.
    """
class InvalidInput(Error, ValueError):
    """
    An argument or a file breaks a rule. The message names the field, the value and the rule.
    """
class IoError(Error, OSError):
    """
    A file cannot be read or written. The message names it.
    """
class Robot:
    """
    A robot as URDF and SRDF describe it. Immutable; joints and links by name.
    """
    @staticmethod
    def from_strings(urdf: str, srdf: str = '', package_dirs: typing.Any = None, base: str = 'fixed', *, base_limits: typing.Any = None, load_meshes: bool = True, allow_missing_meshes: bool = False, mesh_tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.0, origin: str = '<string>') -> Robot:
        """
        The same from the texts of URDF and SRDF; `origin` names the source in messages.
        """
    @staticmethod
    def load(urdf: typing.Any, srdf: typing.Any = None, package_dirs: typing.Any = None, base: str = 'fixed', *, base_limits: typing.Any = None, load_meshes: bool = True, allow_missing_meshes: bool = False, mesh_tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.0, xacro_args: typing.Any = None) -> Robot:
        """
        Reads a URDF and, if given, its SRDF. `base` is fixed, diff_drive or omni; `package_dirs` maps the names
        in package://NAME/... to folders. Files called .xacro are expanded first (needs the package xacro; macros
        are programs: expand only files you trust) with the arguments `xacro_args` (a dict). A box, hull, sphere or
        cylinder that contains a collision mesh and sticks out at most `mesh_tolerance` [m] replaces it; 0: only
        what is the same solid. Raises IoError or InvalidInput naming file, element, value and rule.
        """
    def __repr__(self) -> str:
        ...
    def collisions(self, link: str) -> list[LinkShape]:
        """
        Collision shapes of a link (list of LinkShape).
        """
    def group(self, name: typing.Any = None, tip: typing.Any = None, *, base_link: typing.Any = None, with_base: bool = False) -> JointGroup:
        """
        An SRDF group by name, its tip moved to any link its last joint carries; or the chain base_link to tip.
        `with_base` puts the virtual joints x, y, theta first.
        """
    def link_poses(self, joints: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, T_world_root: typing.Any = None) -> dict:
        """
        Pose (4, 4) of every link, other joints at their default values.
        """
    def mount(self, other: Robot, parent_link: str, T: typing.Any = None, prefix: str = '') -> Robot:
        """
        This robot with `other` put on one of its links; the names of `other` get the prefix, SRDFs are merged.
        """
    def to_srdf(self) -> str:
        """
        Groups, states, end effectors, passive and virtual joints and the disabled pairs with their reasons as one SRDF.
        For a robot without an SRDF: with_sampled_pairs(robot).to_srdf() writes the computed pairs.
        """
    def to_urdf(self) -> str:
        """
        The whole robot as one URDF, without visuals; mesh files by absolute path.
        """
    def values(self, joints: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Full value vector (for with_reference) with the named joints set.
        """
    def velocity_scale(self, platform_velocity: numpy.typing.ArrayLike) -> float:
        """
        Largest factor in [0, 1] that keeps a platform velocity (v_x, v_y, omega) inside the base's limits: speed,
        turning, wheels. 0 for what this base cannot do at all (sideways, or fixed).
        """
    def with_disabled_pairs(self, pairs: collections.abc.Sequence[tuple[str, str, str]]) -> Robot:
        ...
    def with_link(self, name: str, parent_link: str, T: typing.Any = None, shapes: collections.abc.Sequence[LinkShape] = []) -> Robot:
        """
        This robot with one more fixed link.
        """
    @property
    def base(self) -> str:
        """
        fixed, diff_drive or omni.
        """
    @property
    def base_limits(self) -> dict:
        ...
    @property
    def disabled_pairs(self) -> list:
        """
        Link pairs that need no collision check: (a, b, reason).
        """
    @property
    def end_effectors(self) -> list:
        ...
    @property
    def group_states(self) -> dict[str, dict[str, dict[str, float]]]:
        """
        SRDF states: group, state, joint to value. Joints with several values appear as joint/x, joint/y, ...
        """
    @property
    def groups(self) -> dict:
        """
        SRDF groups: name to joints, base_link, tip_link.
        """
    @property
    def has_srdf(self) -> bool:
        ...
    @property
    def hash(self) -> str:
        """
        Content hash: kinematics, shapes, limits, disabled pairs.
        """
    @property
    def joint_table(self) -> list:
        """
        Every joint as a dict.
        """
    @property
    def joints(self) -> list[str]:
        """
        Names of the movable joints that follow no other.
        """
    @property
    def links(self) -> list[str]:
        """
        Names, root first.
        """
    @property
    def name(self) -> str:
        ...
    @property
    def passive_joints(self) -> list[str]:
        """
        Joints that nothing drives (SRDF passive_joint): in no group.
        """
    @property
    def report(self) -> dict:
        """
        What loading found.
        """
class JointGroup:
    """
    Joints that are planned together, and a tip. Immutable.
    """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def at(self, T_world_root: numpy.typing.ArrayLike) -> JointGroup:
        """
        The same group with the robot's root standing elsewhere.
        """
    def fk(self, q: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_world_tip, (4, 4), of a configuration (n,).
        """
    def fk_batch(self, Q: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 4, 4) for configurations (m, n).
        """
    def force_manipulability(self, q: numpy.typing.ArrayLike, direction: numpy.typing.ArrayLike) -> float:
        """
        Length of the force ellipsoid along a direction (P2 equation 3.3), as for velocity_manipulability;
        infinite where no joint works against such a force.
        """
    def ik(self, T_world_tip: numpy.typing.ArrayLike, seed: typing.Any = None, world: World = None, **kwargs) -> IkResult:
        """
        Inverse kinematics from `seed` (default: middle of the limits), then random restarts. With a world the answer is
        free of collisions with it and of self-collision; without one, collisions are not looked at.
        
        Keyword options:
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            max_iterations = 60: per descent
            restarts = 30: random restarts after the seed
            time_limit = 1.0: wall-clock cap [s]
            rng_seed = 1: same seed, same answer
            joint_weights = []: how dear it is to move each joint, > 0; empty: all the same
            objectives = []: costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations = 50: steps along the solutions
        """
    def ik_all(self, T_world_tip: numpy.typing.ArrayLike, count: typing.SupportsInt | typing.SupportsIndex = 16, world: World = None, **kwargs) -> numpy.typing.NDArray[numpy.float64]:
        """
        Up to `count` solutions (k, n), the first ones farthest apart; ik_branches tells why others fell.
        
        Keyword options:
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            max_iterations = 60: per descent
            restarts = 30: random restarts after the seed
            time_limit = 1.0: wall-clock cap [s]
            rng_seed = 1: same seed, same answer
            joint_weights = []: how dear it is to move each joint, > 0; empty: all the same
            objectives = []: costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations = 50: steps along the solutions
        """
    def ik_branches(self, T_world_tip: numpy.typing.ArrayLike, world: World = None, redundant_values: typing.SupportsInt | typing.SupportsIndex = 0, **kwargs) -> IkBranches:
        """
        Every branch of an arm of six turning joints, and of one of seven for `redundant_values` values of its
        redundant joint (0: 24); random descents search where no closed form fits. With a world, free ones only.
        
        Keyword options:
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            max_iterations = 60: per descent
            restarts = 30: random restarts after the seed
            time_limit = 1.0: wall-clock cap [s]
            rng_seed = 1: same seed, same answer
            joint_weights = []: how dear it is to move each joint, > 0; empty: all the same
            objectives = []: costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations = 50: steps along the solutions
        """
    def jacobian(self, q: numpy.typing.ArrayLike, link: str | None = None, point: numpy.typing.ArrayLike | None = None) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (6, n), world-aligned: linear rows [m/rad, m/m], then angular. At the tip's origin, or at `point` [m] in the frame of
        `link` (default: the tip; point (0, 0, 0)), which moves with it. Columns of joints that do not move it are zero.
        """
    def jacobian_batch(self, Q: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 6, n) at the tip's origin, for configurations (m, n).
        """
    def link_poses(self, q: numpy.typing.ArrayLike) -> dict:
        """
        World pose (4, 4) of every link of the robot.
        """
    def manipulability(self, q: numpy.typing.ArrayLike) -> float:
        """
        sqrt(det(J J^T)) (Yoshikawa): 0 at singularities, and for groups of fewer than six joints.
        """
    def manipulability_batch(self, Q: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (m,) for configurations (m, n).
        """
    def velocity_manipulability(self, q: numpy.typing.ArrayLike, direction: numpy.typing.ArrayLike) -> float:
        """
        Length of the velocity ellipsoid along a direction (P2 equation 3.2): (3,) translation or (6,) twist, world-aligned.
        0 where the tool cannot move along it.
        """
    def with_acceleration_limits(self, limits: numpy.typing.ArrayLike) -> JointGroup:
        ...
    def with_reference(self, joints: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex]) -> JointGroup:
        """
        The same group with the named other joints held at these values, the rest at default.
        """
    def within_limits(self, q: numpy.typing.ArrayLike, slack: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> bool:
        ...
    @property
    def T_world_root(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def acceleration_limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        ...
    @property
    def has_base(self) -> bool:
        ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        [rad or m], -inf for continuous joints.
        """
    @property
    def name(self) -> str:
        ...
    @property
    def names(self) -> list[str]:
        """
        Names of the columns: joints, with x, y, theta first when the group has the base. A planar joint has three, "<joint>/x", "/y", "/theta"; a floating one six, "/x", "/y", "/z", "/rx", "/ry", "/rz" (a rotation vector).
        """
    @property
    def robot(self) -> Robot:
        ...
    @property
    def sample_lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Finite bounds to sample from.
        """
    @property
    def sample_upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        ...
    @property
    def size(self) -> int:
        ...
    @property
    def tip(self) -> str:
        ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        ...
    @property
    def velocity_limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        ...
class World:
    """
    Named rigid bodies around the robot, and what it holds. Poses are T_world_object, (4, 4).
    """
    def __contains__(self, arg0: str) -> bool:
        ...
    def __init__(self) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def add(self, name: str, shape: typing.Any, pose: typing.Any = None) -> None:
        """
        A shape, or a list of LinkShape as one body.
        """
    def add_box(self, name: str, size: numpy.typing.ArrayLike, pose: typing.Any = None) -> None:
        """
        Full lengths [m], centred.
        """
    def add_cylinder(self, name: str, radius: typing.SupportsFloat | typing.SupportsIndex, length: typing.SupportsFloat | typing.SupportsIndex, pose: typing.Any = None) -> None:
        """
        Along z, centred [m].
        """
    def add_mesh(self, name: str, path: typing.Any, pose: typing.Any = None, scale: typing.Any = 1.0) -> None:
        """
        STL, OBJ, DAE or PLY; closed meshes are solids, open ones surfaces.
        """
    def add_octree(self, name: str, path: typing.Any, pose: typing.Any = None) -> None:
        """
        Occupied leaves of an OctoMap file (.bt or .ot) as solid voxels.
        """
    def add_points(self, name: str, points: numpy.typing.ArrayLike, resolution: typing.SupportsFloat | typing.SupportsIndex, pose: typing.Any = None) -> None:
        """
        Points (m, 3) as the solid cells of edge `resolution` [m] that hold one.
        """
    def add_sphere(self, name: str, radius: typing.SupportsFloat | typing.SupportsIndex, pose: typing.Any = None) -> None:
        ...
    def attach(self, name: str, link: str, pose: typing.Any = None, touch_links: collections.abc.Set[str] = set()) -> None:
        """
        From the scene to a link, at T_link_object. Empty touch_links: the link, all below it, and its gripper's fingers.
        """
    def copy(self) -> World:
        ...
    def detach(self, name: str, pose: typing.Any = None) -> None:
        """
        Puts a held object back into the scene at T_world_object; without a pose it leaves the world.
        """
    def move(self, name: str, pose: numpy.typing.ArrayLike) -> None:
        ...
    def pose_of(self, name: str) -> numpy.typing.NDArray[numpy.float64]:
        ...
    def remove(self, name: str) -> None:
        """
        Takes an object, held or not, out of the world.
        """
    def shapes_of(self, name: str) -> list[LinkShape]:
        ...
    @property
    def attached(self) -> list[str]:
        """
        Names of the held objects.
        """
    @property
    def objects(self) -> list[str]:
        """
        Names of the scene's objects.
        """
class Outcome(enum.Enum):
    """
    How a query ended. "No solution" is a value, not an exception.
    """
    approximate: typing.ClassVar[Outcome]
    infeasible: typing.ClassVar[Outcome]
    invalid_goal: typing.ClassVar[Outcome]
    invalid_start: typing.ClassVar[Outcome]
    solved: typing.ClassVar[Outcome]
    stopped: typing.ClassVar[Outcome]
    timeout: typing.ClassVar[Outcome]
    @classmethod
    def __new__(cls, value):
        ...
class Rejection(enum.Enum):
    """
    Why one candidate was turned down.
    """
    grasp_filter: typing.ClassVar[Rejection]
    limits: typing.ClassVar[Rejection]
    none: typing.ClassVar[Rejection]
    reach: typing.ClassVar[Rejection]
    scene: typing.ClassVar[Rejection]
    self_collision: typing.ClassVar[Rejection]
    @classmethod
    def __new__(cls, value):
        ...
class Rejections:
    """
    How many candidates fell at which filter.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def grasp_filter(self) -> int:
        """
        Turned down before inverse kinematics.
        """
    @property
    def limits(self) -> int:
        """
        Reached only outside joint limits.
        """
    @property
    def reach(self) -> int:
        """
        No arm configuration reaches the pose.
        """
    @property
    def scene(self) -> int:
        """
        Reached, but robot (or what it holds) hits the scene.
        """
    @property
    def self_collision(self) -> int:
        """
        Reached, but robot hits robot or what it holds.
        """
    @property
    def total(self) -> int:
        ...
class Box:
    """
    A box, centred; full lengths [m].
    """
    def __init__(self, size: numpy.typing.ArrayLike) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def size(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
class Sphere:
    """
    A sphere [m].
    """
    def __init__(self, radius: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def radius(self) -> float:
        ...
class Cylinder:
    """
    A cylinder along z, centred [m].
    """
    def __init__(self, radius: typing.SupportsFloat | typing.SupportsIndex, length: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def length(self) -> float:
        ...
    @property
    def radius(self) -> float:
        ...
class Capsule:
    """
    A capsule along z, centred; `length` without the caps [m].
    """
    def __init__(self, radius: typing.SupportsFloat | typing.SupportsIndex, length: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def length(self) -> float:
        ...
    @property
    def radius(self) -> float:
        ...
class Plane:
    """
    A half space: solid where normal . x <= offset.
    """
    def __init__(self, normal: numpy.typing.ArrayLike, offset: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def offset(self) -> float:
        ...
class Voxels:
    """
    Axis-aligned solid voxels of one edge length [m].
    """
    def __init__(self, centres: numpy.typing.ArrayLike, resolution: typing.SupportsFloat | typing.SupportsIndex) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def resolution(self) -> float:
        ...
class Mesh:
    """
    A triangle mesh [m]; closed ones are solids, open ones surfaces.
    """
    @staticmethod
    def load(path: typing.Any, scale: typing.Any = 1.0) -> Mesh:
        """
        Reads STL, OBJ, DAE or PLY. `scale` is a number or one per axis. Raises IoError naming file and place.
        """
    def __repr__(self) -> str:
        ...
    @property
    def closed(self) -> bool:
        ...
    @property
    def convex(self) -> bool:
        ...
    @property
    def source(self) -> str:
        ...
    @property
    def triangles(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (m, 3) vertex indices.
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m]
        """
    @property
    def volume(self) -> float:
        """
        Signed volume [m^3]; meaningful for closed meshes.
        """
class LinkShape:
    """
    A shape and its pose in the body (robot link, part, obstacle) it belongs to.
    """
    @staticmethod
    def mesh(path: typing.Any, scale: typing.Any = 1.0, pose: typing.Any = None) -> LinkShape:
        """
        A mesh read from a file, which is remembered so that robots and plans can be written out.
        """
    def __init__(self, shape: Box | Sphere | Cylinder | Capsule | Plane | Mesh | Voxels, pose: typing.Any = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def surface(self, segments: typing.SupportsInt | typing.SupportsIndex = 24) -> Mesh:
        """
        Its surface as triangles in the shape's own frame, for pictures.
        """
    @property
    def bounds(self) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]]:
        """
        Lower and upper corner of its axis-aligned box in the body frame [m].
        """
    @property
    def kind(self) -> str:
        ...
    @property
    def mesh_path(self) -> str:
        ...
    @property
    def mesh_scale(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def pose(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def shape(self) -> Box | Sphere | Cylinder | Capsule | Plane | Mesh | Voxels:
        ...
class SetCoverResult:
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def chosen(self) -> list[int]:
        """
        Indices of the chosen sets, ascending.
        """
    @property
    def cost(self) -> float:
        ...
    @property
    def lower_bound(self) -> float:
        """
        Proven: no cover costs less.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved` only with a proof of optimality.
        """
    @property
    def uncoverable(self) -> list[int]:
        """
        Elements in no set.
        """
class TourResult:
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def length(self) -> float:
        ...
    @property
    def lower_bound(self) -> float:
        """
        Proven: no way is shorter.
        """
    @property
    def order(self) -> list[int]:
        """
        Visiting order of the stops.
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def proven(self) -> bool:
        """
        True when the length meets the bound; always up to 15 stops.
        """
class SharedTours:
    """
    Stops shared among several robots.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def durations(self) -> list[float]:
        ...
    @property
    def lower_bound(self) -> float:
        """
        Proven: no sharing ends earlier.
        """
    @property
    def makespan(self) -> float:
        """
        The longest duration.
        """
    @property
    def orders(self) -> list[list[int]]:
        """
        The stops of each robot in visiting order.
        """
    @property
    def outcome(self) -> Outcome:
        ...
class IkResult:
    """
    Answer of inverse kinematics.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def iterations(self) -> int:
        ...
    @property
    def objective(self) -> float:
        """
        Sum of the objectives' costs at q.
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def position_error(self) -> float:
        """
        [m] of q, or of the best attempt.
        """
    @property
    def q(self) -> typing.Any:
        """
        The configuration, inside limits and checked by forward kinematics; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        ...
    @property
    def rotation_error(self) -> float:
        """
        [rad]
        """
class IkBranches:
    """
    Every arm configuration found for a pose, and why others were turned down.
    """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def complete(self) -> bool:
        """
        True when every branch was computed, none searched.
        """
    @property
    def redundant_joint(self) -> int:
        """
        Joint that was sampled; -1 for none.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Branches turned down, by cause.
        """
    @property
    def solutions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n), inside limits and checked; the first ones as different from each other as can be.
        """
class JointTrajectory:
    """
    A path on a clock; cubic Hermite between samples.
    """
    def __init__(self, names: collections.abc.Sequence[str], times: numpy.typing.ArrayLike, positions: numpy.typing.ArrayLike, velocities: typing.Any = None, accelerations: typing.Any = None) -> None:
        """
        From samples: times (k,) from 0 and increasing [s], positions (k, n), and if given velocities and accelerations
        (k, n). Without velocities the samples are joined by straight lines.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def at(self, time: typing.SupportsFloat | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Configuration (n,) at a time [s], clamped at the ends.
        """
    def to_csv(self, base_pose: typing.Any = None) -> str:
        """
        Header time, names, name.velocity, ...; one line a sample. With base_pose (x, y, theta) of the standing base, its
        pose and twist follow the time.
        """
    def to_dict(self) -> dict:
        ...
    def to_joint_trajectory(self, base_pose: typing.Any = None) -> dict:
        """
        A dict shaped like a ROS trajectory_msgs/JointTrajectory, with base_pose and base_twist at every point.
        """
    @property
    def accelerations(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def names(self) -> list[str]:
        ...
    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n)
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) [s]
        """
    @property
    def velocities(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
class Contact:
    """
    Two bodies that touch.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def a(self) -> str:
        ...
    @property
    def b(self) -> str:
        ...
    @property
    def with_scene(self) -> bool:
        ...
class DistanceResult:
    """
    The smallest distance and where it is.
    """
    def __float__(self) -> float:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def a(self) -> str:
        ...
    @property
    def b(self) -> str:
        ...
    @property
    def gradient(self) -> typing.Any:
        """
        d value / d q, (n,); None unless it was asked for.
        """
    @property
    def point_a(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) in the world frame.
        """
    @property
    def point_b(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def value(self) -> float:
        """
        [m]; negative: depth, exact for convex bodies (see docs/methods/collision.md for others).
        """
    @property
    def with_scene(self) -> bool:
        """
        `b` is an object of the scene.
        """
class EdgeResult:
    """
    Whether a straight joint-space edge is free, and where it is refused if not.
    """
    def __bool__(self) -> bool:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def checks(self) -> int:
        """
        Configurations looked at.
        """
    @property
    def contact(self) -> Contact | None:
        """
        What touches there; None when limits refuse it or all is free.
        """
    @property
    def fraction(self) -> float:
        """
        Where along the edge the first refused check was, in [0, 1]; 1 when free.
        """
    @property
    def free(self) -> bool:
        ...
class CollisionChecker:
    """
    Collision questions about one group in a snapshot of the world: later changes of the world
    are not seen. Links pairs are sampled (and cached) when no SRDF says which never touch.
    """
    def __init__(self, robot: Robot, world: World, group: JointGroup, **kwargs) -> None:
        """
        Keyword options:
            padding = 0.0: robot shapes are grown by this against the scene [m]
            check_self = True: robot (and what it holds) against itself
            check_scene = True: robot (and what it holds) against the scene
            held_only = False: only what it holds, against the robot and the scene
        """
    def __repr__(self) -> str:
        ...
    def are_free(self, Q: numpy.typing.ArrayLike, threads: typing.SupportsInt | typing.SupportsIndex = 0) -> numpy.typing.NDArray[numpy.bool]:
        """
        is_free of each row of Q (m, n), as (m,) booleans; 0 threads: all.
        """
    def check_edge(self, q0: numpy.typing.ArrayLike, q1: numpy.typing.ArrayLike, **kwargs) -> EdgeResult:
        """
        The straight joint-space edge with what refuses it: in steps, or by conservative advancement.
        
        Keyword options:
            joint_step = 0.02: no joint moves more than this between two checks [rad or m]
            workspace_step = inf: no point moves more than this between two checks [m]
            continuous = False: conservative advancement instead of steps
            tolerance = 0.0001: continuous only: gaps below this count as contact [m]
        """
    def clone(self) -> CollisionChecker:
        """
        The same checker with scratch of its own, for another thread.
        """
    def contacts(self, q: numpy.typing.ArrayLike) -> list[Contact]:
        """
        Every touching pair; limits are not looked at.
        """
    def distance(self, q: numpy.typing.ArrayLike, gradient: bool = False) -> DistanceResult:
        """
        Smallest signed distance over all checked pairs, padding not subtracted; with `gradient` also d value / d q.
        Infinite when there is no pair.
        """
    def distances(self, q: numpy.typing.ArrayLike, within: typing.SupportsFloat | typing.SupportsIndex) -> list[DistanceResult]:
        """
        Every pair of bodies nearer than `within` [m], nearest first, each with its gradient.
        """
    def edge_is_free(self, q0: numpy.typing.ArrayLike, q1: numpy.typing.ArrayLike, step: typing.SupportsFloat | typing.SupportsIndex = 0.02) -> bool:
        """
        The straight joint-space edge, checked so finely that no joint moves more than `step` [rad or m].
        """
    def first_contact(self, q: numpy.typing.ArrayLike) -> Contact | None:
        """
        One touching pair, self before scene, or None; limits are not looked at.
        """
    def is_free(self, q: numpy.typing.ArrayLike) -> bool:
        """
        Inside limits and without any contact.
        """
    def rejection(self, q: numpy.typing.ArrayLike) -> Rejection:
        """
        The first cause found (limits, self_collision, scene), or Rejection.none.
        """
    @property
    def group(self) -> JointGroup:
        ...
    @property
    def motion_bounds(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) bounds on how far any point moves when a joint moves by one unit [m/rad or m/m].
        """
class IkObjective:
    """
    A cost of configurations that inverse kinematics lowers with the freedom that the pose leaves: pass a list as ik(..., objectives=[...]).
    """
    def __repr__(self) -> str:
        ...
    def evaluate(self, q: numpy.typing.ArrayLike) -> tuple[float, typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]]:
        """
        (cost, gradient (n,)).
        """
    @property
    def name(self) -> str:
        ...
class ReachDatabase:
    """
    Sampled arm configurations free of self-collision, in cells of the tool pose (P1 3.2.1).
    """
    @staticmethod
    def build(arm: JointGroup, *, progress: typing.Any = None, **kwargs) -> ReachDatabase:
        """
        Samples the arm. `progress` is called with (stage, fraction).
        
        Keyword options:
            samples = 2000000: arm configurations drawn
            position_cell = 0.1: edge of a position cell [m]
            rotation_cell = 0.55: approximate diameter of a rotation cell [rad]
            max_per_cell = 16: configurations kept in a cell
            min_manipulability = 0.02: least manipulability kept, as a fraction of the largest
            thinning = 0.0: below this fraction of the largest manipulability kept by chance; 0: all
            seed = 1: same seed, same database
            threads = 0: 0: all; does not change the answer
        """
    @staticmethod
    def build_parts(folder: typing.Any, arm: JointGroup, parts: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], *, progress: typing.Any = None, **kwargs) -> bool:
        """
        Draws single parts into a folder; in `path`.partial they are what build_to(path, ...) goes on from.
        """
    @staticmethod
    def build_to(path: typing.Any, arm: JointGroup, *, progress: typing.Any = None, **kwargs) -> ReachDatabase:
        """
        Builds through files into a folder; interrupted and called again, it goes on where it was.
        """
    @staticmethod
    def load(path: typing.Any, arm: JointGroup = None) -> ReachDatabase:
        """
        Raises IoError on a truncated, foreign or corrupt database, and on one built for another arm than `arm`.
        """
    @staticmethod
    def load_or_build(arm: JointGroup, cache_dir: typing.Any, *, progress: typing.Any = None, **kwargs) -> ReachDatabase:
        """
        The database of this arm and these options from the cache folder; built and stored when it is not there.
        """
    @staticmethod
    def part_count(arm: JointGroup, **kwargs) -> int:
        """
        Into how many parts build_to divides a build with these options.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def base_poses_for(self, arm: JointGroup, T_world_tip: numpy.typing.ArrayLike, *, count: typing.SupportsInt | typing.SupportsIndex = 32, checker: CollisionChecker = None, **kwargs) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Base poses (k, 3) on the floor from which the tool reaches a pose in the world, and the configurations (k, n) that do.
        
        Keyword options:
            step = 0.05: grid of base positions [m]
            headings = 24: of the base, evenly over the circle
            candidates = 64: best base poses of the grid looked at exactly
            seeds = 8: stored configurations tried for a target
            refinements = 4: rounds of smaller steps about the best
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            threads = 0: 0: all; does not change the answer
        """
    def difference(self, arm: JointGroup) -> str:
        """
        What of the arm has changed since the build, in words; empty when nothing.
        """
    def find_base_placement(self, arm: JointGroup, T_world_tips: numpy.typing.ArrayLike, *, checker: CollisionChecker = None, progress: typing.Any = None, **kwargs) -> BasePlacement:
        """
        One base pose from which as many tool poses (m, 4, 4) in the world as possible are reached.
        
        Keyword options:
            step = 0.05: grid of base positions [m]
            headings = 24: of the base, evenly over the circle
            candidates = 64: best base poses of the grid looked at exactly
            seeds = 8: stored configurations tried for a target
            refinements = 4: rounds of smaller steps about the best
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            threads = 0: 0: all; does not change the answer
        """
    def nearest(self, T_base_tip: numpy.typing.ArrayLike, count: typing.SupportsInt | typing.SupportsIndex = 8) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Up to `count` stored configurations (k, n) near the pose, nearest first.
        """
    def query(self, T_base_tip: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        Stored configurations (k, n) whose tool pose lies in the pose's cell; k may be 0.
        """
    def save(self, path: typing.Any) -> None:
        ...
    def solve(self, arm: JointGroup, T_base_tip: numpy.typing.ArrayLike, *, checker: CollisionChecker = None, **kwargs) -> numpy.typing.NDArray[numpy.float64]:
        """
        Exact configurations (k, n) for a pose relative to the root, from stored ones near it; the most different ones first, with a checker the free ones.
        
        Keyword options:
            count = 8: solutions at most
            candidates = 64: stored configurations tried
            distinct = 0.1: solutions differ by more than this in some joint [rad or m]
            position_tolerance = 1e-05: [m]
            rotation_tolerance = 0.0001: [rad]
            threads = 0: of batches; 0: all
        """
    def solve_batch(self, arm: JointGroup, T_base_tips: numpy.typing.ArrayLike, *, checker: CollisionChecker = None, **kwargs) -> list:
        """
        solve() for many poses (m, 4, 4) at a time: a list of arrays. The same keywords.
        """
    def to_dict(self) -> dict:
        ...
    def verify(self) -> None:
        """
        Compares every file with its checksums; raises IoError where they differ.
        """
    @property
    def arrays(self) -> dict:
        """
        Read-only views of the database's arrays, by file name.
        """
    @property
    def cell_count(self) -> int:
        """
        Non-empty cells.
        """
    @property
    def joint_count(self) -> int:
        ...
    @property
    def joint_lower(self) -> list[float]:
        ...
    @property
    def joint_step(self) -> list[float]:
        """
        q = joint_lower + joint_step * arrays['configurations'].
        """
    @property
    def key(self) -> str:
        ...
    @property
    def path(self) -> str:
        """
        The folder; empty for a database in memory only.
        """
    @property
    def reach(self) -> float:
        """
        Largest distance of a stored tool position from the root [m].
        """
class BasePlacement:
    """
    One base pose for many tool poses.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def base_pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        x, y, theta
        """
    @property
    def configurations(self) -> list:
        """
        One per target; None where it is not reached.
        """
    @property
    def reached(self) -> int:
        """
        How many of the targets.
        """
class CapabilityMap:
    """
    The share of tool poses around each point that an arm reaches, with its limits, self-collision and the scene
    (P3 3.9.2, equation 3.13). Everything is in the robot's root frame. Immutable.
    """
    @staticmethod
    def build(arm: JointGroup, world: World | None = None, *, progress: typing.Any = None, **kwargs) -> CapabilityMap:
        """
        Tries every tool pose of every voxel. `progress` is called with (stage, fraction).
        
        Keyword options:
            lower = (-1.0, -1.0, 0.0): corner of the grid in the robot's root frame [m]
            upper = (1.0, 1.0, 2.6): the opposite corner, a whole number of voxels away [m]
            voxel = 0.1: edge of a voxel and diameter of its sphere [m]
            poses = 200: tool poses in a voxel; a multiple of rolls
            rolls = 1: rolls about each approach direction
            approach = (0.0, 0.0, 1.0): where the tool points, in the tip's frame
            samples = 0: values tried of joints a pose leaves free; 0: 64 for one, 128 for two
            sweeps = 4: times that solutions spread from pose to neighbouring pose
            restarts = 0: further random descents for poses that border reached ones
            padding = 0.0: robot links are grown by this against the scene [m]
            seed = 1: same seed, same map
            threads = 0: 0: all; does not change the answer
        """
    @staticmethod
    def load(path: typing.Any) -> CapabilityMap:
        """
        Raises IoError on a truncated, foreign or corrupt folder.
        """
    def __repr__(self) -> str:
        ...
    def best_base_distance(self, T_world_tips: numpy.typing.ArrayLike, distances: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], heading: typing.SupportsFloat | typing.SupportsIndex = 0.0, cone: typing.SupportsFloat | typing.SupportsIndex = 4.0) -> tuple[float, float, list[float]]:
        """
        Which distance [m] to stand behind the poses' middle, facing along `heading` [rad]:
        (distance, score, scores of all).
        """
    def configuration(self, x: typing.SupportsInt | typing.SupportsIndex, y: typing.SupportsInt | typing.SupportsIndex, z: typing.SupportsInt | typing.SupportsIndex, pose: typing.SupportsInt | typing.SupportsIndex) -> typing.Any:
        """
        Configuration that reaches a pose of a voxel, or None.
        """
    def index_at(self, point: numpy.typing.ArrayLike) -> float:
        """
        Index of the voxel that holds a point of the root frame; 0 outside.
        """
    def restricted(self, arm: JointGroup, world: World, *, progress: typing.Any = None) -> CapabilityMap:
        """
        The map of the same arm in a world with more in it: only what is reached here is looked at again.
        """
    def save(self, path: typing.Any) -> None:
        """
        Writes a folder of .npy files and meta.json.
        """
    def score(self, T_world_tips: numpy.typing.ArrayLike, T_world_root: typing.Any = None, cone: typing.SupportsFloat | typing.SupportsIndex = 4.0) -> float:
        """
        Mean index over tool poses (m, 4, 4) with the root at a pose. With `cone` below pi [rad] only tool poses
        that approach within that angle of each pose count.
        """
    def slice(self, axis: str, at: typing.SupportsFloat | typing.SupportsIndex) -> numpy.ndarray[typing.Any, numpy.dtype[typing.Any]]:
        """
        Cut through the voxels at a coordinate [m]: `slice("z", 0.75)` is (nx, ny).
        """
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centres of the voxels (nx, ny, nz, 3) [m].
        """
    @property
    def classes(self) -> numpy.ndarray[typing.Any, numpy.dtype[typing.Any]]:
        """
        What became of each pose (nx, ny, nz, poses), uint8: 0 reached, 1 out of reach, 2 limits, 3 self-collision,
        4 scene.
        """
    @property
    def configurations(self) -> numpy.ndarray[typing.Any, numpy.dtype[typing.Any]]:
        """
        A configuration for each reached pose (reached, n), float32, in the order of `classes`.
        """
    @property
    def index(self) -> numpy.ndarray[typing.Any, numpy.dtype[typing.Any]]:
        """
        Reachability index of each voxel (nx, ny, nz), float32 in [0, 1].
        """
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def maximum(self) -> float:
        """
        The largest index.
        """
    @property
    def reached(self) -> int:
        """
        Poses reached.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Poses not reached, by cause.
        """
    @property
    def shape(self) -> tuple:
        ...
    @property
    def tool_poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Tool poses around a voxel's centre (poses, 4, 4).
        """
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def voxel(self) -> float:
        """
        Edge of a voxel [m].
        """
class ContactPairProvenance:
    """
    Of sample_grasps: two opposed contacts and a direction of approach.
    """
    def __repr__(self) -> str:
        ...
    @property
    def approach(self) -> int:
        """
        Index among the approach directions around the closing axis.
        """
    @property
    def flipped(self) -> bool:
        """
        The hand is turned by half a turn about the approach.
        """
    @property
    def pair(self) -> int:
        """
        Index among the object's contact pairs, those that are too wide included.
        """
class PipeProvenance:
    """
    Of Pipe.grasp and Pipe.sample_grasps: P2's four variables (P2 3.2.3.1).
    """
    def __repr__(self) -> str:
        ...
    @property
    def angle(self) -> float:
        """
        From the section's y axis to the approach about its x axis [rad].
        """
    @property
    def flipped(self) -> bool:
        """
        The hand is turned by half a turn about the approach.
        """
    @property
    def length(self) -> float:
        """
        From the section's first node to the tool frame [m].
        """
    @property
    def section(self) -> int:
        """
        Index of the pipe's section.
        """
class HeightMapProvenance:
    """
    Of evaluate_graspability: a place of a height map and of a depth image.
    """
    def __repr__(self) -> str:
        ...
    @property
    def angle(self) -> float:
        """
        Direction of the closing axis in the map's frame, in [0, pi) [rad].
        """
    @property
    def cell(self) -> tuple[int, int]:
        """
        (ix, iy) of the height map.
        """
    @property
    def height(self) -> float:
        """
        Height of the finger tips above the map's frame [m].
        """
    @property
    def pixel(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        (u, v) in the depth image; (-1, -1) without one.
        """
class Grasp:
    """
    One way to hold an object: where the hand stands, how far it is open, what it costs and how good it is.
    """
    def __init__(self, T_object_hand: numpy.typing.ArrayLike, opening: typing.SupportsFloat | typing.SupportsIndex = 0.0, *, cost: typing.SupportsFloat | typing.SupportsIndex = 0.0, quality: typing.SupportsFloat | typing.SupportsIndex = 1.0, posture: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = []) -> None:
        """
        Pose of the hand's tool frame in the object's frame (4, 4); distance between the fingers while holding [m]; cost that
        planners add to their path's length; quality in [0, 1]; for a hand with several joint groups how far each is open, in [0, 1].
        """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        """
        All of it as numbers, strings, lists and dicts; parts by their values.
        """
    @property
    def T_object_hand(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the hand's tool frame in the object's frame; in the world where no object is known.
        """
    @property
    def cost(self) -> float:
        """
        Added by planners to their path's length.
        """
    @property
    def opening(self) -> float:
        """
        Distance between the fingers while holding [m].
        """
    @property
    def parts(self) -> dict[str, tuple[float, float]]:
        """
        Parts of the quality by name: (value, weight); each is a factor 1 - weight + weight * value.
        """
    @property
    def posture(self) -> list[float]:
        """
        How far each joint group of the hand is open; []: as `opening` says.
        """
    @property
    def provenance(self) -> None | ContactPairProvenance | PipeProvenance | HeightMapProvenance:
        """
        Which sampler it came from, with which numbers; None: it was given.
        """
    @property
    def quality(self) -> float:
        """
        Larger is better, in [0, 1].
        """
class HandJoint:
    """
    A driven joint of a hand: how far it goes between closed and open [rad] or [m]. Joints of one group move together.
    """
    def __init__(self, name: str, closed: typing.SupportsFloat | typing.SupportsIndex, open: typing.SupportsFloat | typing.SupportsIndex, group: str = 'fingers') -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def closed(self) -> float:
        """
        Value while the fingers are closed.
        """
    @property
    def group(self) -> str:
        """
        Joints of one group move together.
        """
    @property
    def name(self) -> str:
        """
        The robot's joint.
        """
    @property
    def open(self) -> float:
        """
        Value while they are open.
        """
class HandBody:
    """
    Boxes around the fingers and the palm of a hand [m].
    """
    def __init__(self, *, finger_thickness: typing.SupportsFloat | typing.SupportsIndex = 0.012, finger_length: typing.SupportsFloat | typing.SupportsIndex = 0.12, palm_length: typing.SupportsFloat | typing.SupportsIndex = 0.13, palm_width: typing.SupportsFloat | typing.SupportsIndex = 0.065) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def finger_length(self) -> float:
        """
        From the finger tips back to the palm.
        """
    @property
    def finger_thickness(self) -> float:
        """
        Of a finger along the closing axis.
        """
    @property
    def palm_length(self) -> float:
        """
        Of the palm along the closing axis.
        """
    @property
    def palm_width(self) -> float:
        """
        Of the palm across it.
        """
class Hand:
    """
    The hand at the end of an arm: tool frame, approach and closing axis, and how its joints follow from the opening.
    The tool frame's origin (tool centre point) lies midway between the pads' centres; a parallel gripper has one group
    of joints, linear in the opening.
    """
    @staticmethod
    def from_robot(robot: Robot, tool_link: str, *, group: str = '', approach: numpy.typing.ArrayLike | None = None, closing: numpy.typing.ArrayLike | None = None, clearance: typing.SupportsFloat | typing.SupportsIndex = 0.01, postures: typing.SupportsInt | typing.SupportsIndex = 32) -> Hand:
        """
        A hand read from a robot that was loaded with its meshes: axes, ends of the joints, openings and body are measured
        by forward kinematics between the collision shapes of the finger tips. `group` is an SRDF end effector or group; ''
        takes every joint below the tool link's body.
        """
    def __init__(self, tool_link: str, *, approach: numpy.typing.ArrayLike, closing: numpy.typing.ArrayLike, max_opening: typing.SupportsFloat | typing.SupportsIndex, finger_depth: typing.SupportsFloat | typing.SupportsIndex, finger_width: typing.SupportsFloat | typing.SupportsIndex, clearance: typing.SupportsFloat | typing.SupportsIndex = 0.01, joints: collections.abc.Sequence[HandJoint] = [], finger_links: collections.abc.Sequence[str] = [], kind: str = 'parallel', min_opening: typing.SupportsFloat | typing.SupportsIndex = 0.0, openings: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [], preshape: collections.abc.Mapping[str, typing.SupportsFloat | typing.SupportsIndex] = {}, body: HandBody | None = None) -> None:
        """
        A hand by its numbers, each described at the property of its name; `body` None: fingers of 12 cm before a palm of 13 x 6.5 cm.
        """
    def __repr__(self) -> str:
        ...
    @typing.overload
    def joint_values(self, opening: typing.SupportsFloat | typing.SupportsIndex) -> dict[str, float]:
        """
        Joint values at an opening [m].
        """
    @typing.overload
    def joint_values(self, grasp: Grasp) -> dict[str, float]:
        """
        Joint values while holding: those of the grasp's posture if it has one, else of its opening.
        """
    def opening_at(self, share_open: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        The opening at which they are so far open [m].
        """
    def posture_values(self, posture: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]) -> dict[str, float]:
        """
        Joint values of a posture: for each of `groups` how far it is open, in [0, 1].
        """
    def pregrasp_opening(self, width: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Opening while moving in on a part of this width: with clearance on both sides, at most max_opening [m].
        """
    def shapes(self, opening: typing.SupportsFloat | typing.SupportsIndex) -> list[LinkShape]:
        """
        Left and right finger and palm as boxes in the tool frame.
        """
    def share_open(self, opening: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        How far open the fingers are at an opening, in [0, 1].
        """
    @property
    def approach(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Unit axis of the tool frame along which the hand moves in.
        """
    @property
    def body(self) -> HandBody:
        """
        Boxes around fingers and palm.
        """
    @property
    def clearance(self) -> float:
        """
        Kept free on each side of the part while moving in [m].
        """
    @property
    def closing(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Unit axis of the tool frame along which the pads close.
        """
    @property
    def finger_depth(self) -> float:
        """
        Pad length along the approach axis [m].
        """
    @property
    def finger_links(self) -> list[str]:
        """
        Links that may touch the held part.
        """
    @property
    def finger_width(self) -> float:
        """
        Pad size across approach and closing [m].
        """
    @property
    def groups(self) -> list[str]:
        """
        Names of the joint groups.
        """
    @property
    def joints(self) -> list[HandJoint]:
        """
        The driven joints with their values closed and open.
        """
    @property
    def kind(self) -> str:
        """
        'parallel', 'angular' or 'adaptive'.
        """
    @property
    def max_opening(self) -> float:
        """
        Widest part that fits [m].
        """
    @property
    def min_opening(self) -> float:
        """
        Thinnest part that is held [m].
        """
    @property
    def openings(self) -> list[float]:
        """
        Openings at equal steps of the joints [m]; empty: linear in them.
        """
    @property
    def preshape(self) -> dict[str, float]:
        """
        Groups that the opening does not move, and how far open they stay.
        """
    @property
    def tool_link(self) -> str:
        """
        Link whose frame is the tool frame.
        """
class ToolRegion:
    """
    A box of tool poses around a pose.
    """
    def __init__(self, pose: numpy.typing.ArrayLike, position: typing.Any = None, rotation: typing.Any = None) -> None:
        """
        pose (4, 4) times a translation within +-position [m] times a rotation rpy within +-rotation [rad].
        """
    def __repr__(self) -> str:
        ...
class ToolCone:
    """
    Path constraint: an axis of the tool stays near an axis of the world.
    """
    def __init__(self, tool_axis: numpy.typing.ArrayLike, world_axis: numpy.typing.ArrayLike, half_angle: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        tool_axis in the tip's frame; half_angle: the largest angle between the two [rad].
        """
    def __repr__(self) -> str:
        ...
class MotionStats:
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def collision_queries(self) -> int:
        ...
    @property
    def length_before_shortening(self) -> float:
        ...
    @property
    def seconds(self) -> float:
        ...
class MotionResult:
    """
    What plan_motion found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def beyond_limits(self) -> str:
        """
        With invalid_start or invalid_goal: which joint is outside of its limits, its value and these.
        """
    @property
    def contacts(self) -> list[Contact]:
        """
        With invalid_start or invalid_goal: what touches.
        """
    @property
    def cost(self) -> float:
        """
        Length of the path in joint space.
        """
    @property
    def goal_index(self) -> int:
        ...
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def path(self) -> typing.Any:
        """
        Waypoints (k, n), joined by straight lines; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Of the start, or of goals, turned down.
        """
    @property
    def stats(self) -> MotionStats:
        ...
class StraightLineResult:
    """
    What plan_straight_line found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def beyond_limits(self) -> str:
        """
        With invalid_start: which joint is outside of its limits, its value and these.
        """
    @property
    def cause(self) -> Rejection:
        """
        Why it ended there.
        """
    @property
    def contact(self) -> Contact | None:
        """
        What touches there, when something does, or None.
        """
    @property
    def fraction(self) -> float:
        """
        How far along the line it came, in [0, 1].
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def path(self) -> typing.Any:
        """
        (k, n) or None.
        """
class CartesianResult:
    """
    What plan_cartesian found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def beyond_limits(self) -> str:
        """
        With invalid_start: which joint of `near` is outside of its limits, its value and these.
        """
    @property
    def branches(self) -> int:
        """
        Allowed configurations of the first pose.
        """
    @property
    def cause(self) -> Rejection:
        """
        Why it ended there.
        """
    @property
    def contact(self) -> Contact | None:
        """
        What touches there, when something does, or None.
        """
    @property
    def corners(self) -> list[int]:
        """
        Waypoint at which each pose is reached.
        """
    @property
    def fraction(self) -> float:
        """
        How far the best branch came, in [0, 1].
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def path(self) -> typing.Any:
        """
        (k, n) or None.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Of the first pose's configurations, by cause.
        """
    @property
    def tried(self) -> int:
        """
        Of these: followed.
        """
class Roadmap:
    """
    Configurations of a group drawn from its joint box and joined when near, without any collision check: it serves every grasp, object and scene (P2 4.3.2.1). Immutable.
    """
    @staticmethod
    def build(group: JointGroup, *, progress: typing.Any = None, **kwargs) -> Roadmap:
        """
        Draws and joins; a larger roadmap of the same seed holds a smaller one's vertices.
        
        Keyword options:
            vertices = 5000: configurations drawn
            gamma = 4.0: vertices nearer than gamma (log n / n)^(1/d) are joined [rad or m]
            neighbours = 0: > 0: join that many nearest ones instead
            seed = 1: same seed, same roadmap
        """
    @staticmethod
    def load(path: typing.Any, group: JointGroup) -> Roadmap:
        """
        Raises IoError on a damaged file or one made for another robot, joints or limits.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def near(self, q: numpy.typing.ArrayLike) -> list[int]:
        """
        Vertices a new configuration would be joined with, ascending.
        """
    def save(self, path: typing.Any) -> None:
        """
        To a temporary name first, then renamed.
        """
    def to_dict(self) -> dict:
        ...
    @property
    def edges(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Pairs of vertices (m, 2), the smaller number first.
        """
    @property
    def figures(self) -> dict:
        """
        Mean degree, connected parts, the largest one's vertices, connection radius, the joint box's volume, and the gamma that PRM* asks for.
        """
    @property
    def vertices(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, joints)
        """
class ManipulationProblem:
    """
    TransferPath an object from one pose to another with any of many grasps (P2 4.2).
    """
    def __init__(self, group: JointGroup, world: World, object: typing.Any, T_world_start: numpy.typing.ArrayLike, T_world_goal: numpy.typing.ArrayLike, grasps: typing.Any, *, gripper: Hand | None = None, touch_links: collections.abc.Sequence[str] = [], object_name: str = 'object', **kwargs) -> None:
        """
        `object` is a LinkShape or a list of them, in its own frame; `world` is without it. `grasps` are Grasp, or poses of the hand in the object's frame as (m, 4, 4). With `gripper` the fingers are set to each grasp's opening. Links in `touch_links` may touch the object; none given: those of the end effector. The group may be an arm or an arm on an omni base; a diff_drive base is refused, since it could not drive the paths.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_goal(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def T_world_start(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def grasps(self) -> list[Grasp]:
        ...
    @property
    def group(self) -> JointGroup:
        ...
    @property
    def object(self) -> list[LinkShape]:
        ...
    @property
    def object_name(self) -> str:
        ...
    @property
    def world(self) -> World:
        ...
class SearchTree:
    """
    One tree of RRT*-MG as it stood at the end: of one grasp, from its starts or its goals.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def costs(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Length of the way from the root, (n,).
        """
    @property
    def from_goal(self) -> bool:
        ...
    @property
    def grasp(self) -> int:
        ...
    @property
    def parents(self) -> list[int]:
        """
        Of each vertex: another one, or -1 for the grasp's arm configurations.
        """
    @property
    def vertices(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, joints)
        """
class Improvement:
    """
    A better solution on the way.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def cost(self) -> float:
        ...
    @property
    def grasp(self) -> int:
        ...
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Waypoints (k, n).
        """
    @property
    def seconds(self) -> float:
        """
        Since the call began, the first roadmap's building left out.
        """
class GraspReport:
    """
    What became of one grasp.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def goal(self) -> Rejections:
        """
        Likewise at the goal; not looked at when none is left at the start.
        """
    @property
    def goal_solutions(self) -> int:
        ...
    @property
    def searched(self) -> bool:
        """
        Its paths were looked for over a roadmap.
        """
    @property
    def start(self) -> Rejections:
        """
        Arm configurations turned down at the start, by cause.
        """
    @property
    def start_solutions(self) -> int:
        ...
class ManipulationResult:
    """
    What plan_manipulation found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def contacts(self) -> list[Contact]:
        """
        With invalid_start or invalid_goal: what touches there with the first grasp in collision.
        """
    @property
    def cost(self) -> float:
        """
        Length of the path in joint space plus the grasp's cost.
        """
    @property
    def grasp_index(self) -> int:
        """
        Of the problem's grasps; -1 unless solved.
        """
    @property
    def grasps(self) -> list[GraspReport]:
        """
        A GraspReport for each grasp.
        """
    @property
    def improvements(self) -> list[Improvement]:
        ...
    @property
    def lower_bound(self) -> float:
        """
        No path costs less: with prm_star_mg none over this roadmap and these arm configurations.
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def path(self) -> typing.Any:
        """
        Waypoints (k, n), joined by straight lines; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Sum over all grasps and both ends.
        """
    @property
    def stats(self) -> dict:
        ...
    @property
    def trees(self) -> list[SearchTree]:
        """
        With keep_trees: a SearchTree for each grasp still in the race and each end.
        """
class BaseTrackingResult:
    """
    A base driven along a plan, one row a period; poses are (x, y, theta).
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def actual(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3)
        """
    @property
    def commands(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k - 1, 3) platform velocities (v_x, v_y, omega)
        """
    @property
    def desired(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3)
        """
    @property
    def final_error(self) -> float:
        """
        [m]
        """
    @property
    def heading_errors(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) desired less actual [rad]
        """
    @property
    def limited(self) -> int:
        """
        Commands that were scaled down to the base's limits.
        """
    @property
    def max_error(self) -> float:
        """
        [m]
        """
    @property
    def mean_error(self) -> float:
        """
        [m]
        """
    @property
    def position_errors(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) [m]
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) [s]
        """
class BaseTracker:
    """
    The feedback law that keeps a base on its plan (P1 4.12 to 4.15), one command a period.
    """
    def __init__(self, robot: Robot, **kwargs) -> None:
        """
        Keyword options:
            kp = 2.0: proportional gain [1/s]
            ki = 0.1: integral gain [1/s^2]
            kd = 0.3: derivative gain
            offset = 0.2: distance of the tracked point from the wheel axis [m]
            period = 0.02: a command is held this long [s]
            feed_forward = True: adds the planned velocity
            feedback = True: False: open loop, the planned velocities only
            settle = 0.0: goes on this long after the plan's end [s]
        """
    def command(self, desired: numpy.typing.ArrayLike, desired_next: numpy.typing.ArrayLike, measured: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Platform velocity (v_x, v_y, omega) to hold until the plan is at desired_next, one period on; poses are (x, y, theta).
        """
    def reset(self) -> None:
        ...
    @property
    def limited(self) -> bool:
        """
        The last command was scaled down to the limits.
        """
    @property
    def period(self) -> float:
        ...
class ClosingOutcome:
    """
    What one moment to begin closing comes to. Engagement: how far the finger tips are beyond the object's near face.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def both_touch(self) -> float:
        """
        The same when both fingers touch, were the object not pushed [m].
        """
    @property
    def farther_tolerance(self) -> float:
        """
        It may stand this much farther [m].
        """
    @property
    def gap(self) -> float:
        """
        Free space on either side of a centred object as the tips pass it [m].
        """
    @property
    def holds(self) -> bool:
        """
        An object standing where planned is held.
        """
    @property
    def lateral_tolerance(self) -> float:
        """
        It may stand this far to a side [m]; < 0: none.
        """
    @property
    def nearer_tolerance(self) -> float:
        """
        It may stand this much nearer [m].
        """
    @property
    def pushed(self) -> float:
        """
        How far the object slides before the palm [m].
        """
    @property
    def start(self) -> float:
        """
        Engagement at which closing begins [m].
        """
    @property
    def swept(self) -> float:
        """
        How far the tool goes beyond the planned grasp pose [m].
        """
class PushGrasp:
    """
    Closing windows of a grasp in passing, and both strategies of P1's figure 4.7.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def closing_time(self) -> float:
        """
        [s]
        """
    @property
    def earliest(self) -> float:
        """
        First engagement at which closing may begin [m].
        """
    @property
    def feasible(self) -> bool:
        ...
    @property
    def latest(self) -> float:
        """
        Last engagement at which closing may begin [m].
        """
    @property
    def max_tool_speed(self) -> float:
        """
        Fastest tool with a window [m/s].
        """
    @property
    def plain(self) -> ClosingOutcome:
        """
        Closing while moving, so that both fingers touch at the planned pose.
        """
    @property
    def push(self) -> ClosingOutcome:
        """
        Push-grasp: closing begins when the object is between the fingers.
        """
    @property
    def window(self) -> float:
        """
        From the first to the last [s].
        """
class Part:
    """
    One part in a tray.
    """
    def __init__(self, name: str, shapes: collections.abc.Sequence[LinkShape], T_world_part: numpy.typing.ArrayLike, grasps: collections.abc.Sequence[Grasp] = [], *, target: bool = True, grasps_too_wide: typing.SupportsInt | typing.SupportsIndex = 0) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def T_world_part(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def grasps(self) -> list[Grasp]:
        ...
    @property
    def grasps_too_wide(self) -> int:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def shapes(self) -> list[LinkShape]:
        ...
    @property
    def target(self) -> bool:
        ...
class Tray:
    """
    A tray and the parts in it; its walls are scene objects.
    """
    def __init__(self, name: str, T_world_tray: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, parts: collections.abc.Sequence[Part], headings: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = []) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def T_world_tray(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def headings(self) -> list[float]:
        ...
    @property
    def name(self) -> str:
        ...
    @property
    def parts(self) -> list[Part]:
        ...
    @property
    def size(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Depth, width, height [m].
        """
class CarryPlace:
    """
    Where picked parts go: a bin fixed to the robot.
    """
    def __init__(self, T_base_bin: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, drop_gap: typing.SupportsFloat | typing.SupportsIndex = 0.03) -> None:
        ...
    @property
    def T_base_bin(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def drop_gap(self) -> float:
        ...
    @property
    def size(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        ...
class PartSupplyProblem:
    """
    Everything the part-supply planner needs.
    """
    def __init__(self, robot: Robot, arm: JointGroup, gripper: Hand, scene: World, trays: collections.abc.Sequence[Tray], home: numpy.typing.ArrayLike, start: numpy.typing.ArrayLike, goal: numpy.typing.ArrayLike, carry: CarryPlace, **kwargs) -> None:
        """
        Keyword options:
            grid_resolution = 0.05: cell edge of the base grid [m]
            grid_max_distance = 0.0: cells farther from the tray's middle are not tried [m]; 0: the arm's reach
            ik_seeds = 8: database configurations refined for each grasp and base pose; arms with closed-form IK take all branches
            positioning_uncertainty = 0.1: radius of the disc in which the base may come to stand [m]
            approach_distance = 0.08: straight move from pre-grasp to grasp [m]
            lift_height = 0.12: straight upward move after closing [m]
            motion_time_limit = 5.0: for each planned motion [s]
            route_resolution = 0.1: cell edge of the base route's search [m]
            robustness_samples = 2000: base poses drawn at each stop for the check before returning
            seed = 1: same seed, same plan
            threads = 0: 0: all; does not change the answer
        """
    @property
    def arm(self) -> JointGroup:
        ...
    @property
    def carry(self) -> CarryPlace:
        ...
    @property
    def goal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def gripper(self) -> Hand:
        ...
    @property
    def home(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        ...
    @property
    def options(self) -> dict:
        ...
    @property
    def robot(self) -> Robot:
        ...
    @property
    def scene(self) -> World:
        ...
    @property
    def start(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def trays(self) -> list[Tray]:
        ...
class BaseGrid:
    """
    Square cells over the floor, one layer for each heading.
    """
    def __getstate__(self) -> tuple:
        ...
    def __init__(self, origin: numpy.typing.ArrayLike, resolution: typing.SupportsFloat | typing.SupportsIndex, nx: typing.SupportsInt | typing.SupportsIndex, ny: typing.SupportsInt | typing.SupportsIndex, headings: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [0.0]) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def centre(self, heading: typing.SupportsInt | typing.SupportsIndex, ix: typing.SupportsInt | typing.SupportsIndex, iy: typing.SupportsInt | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        x, y, theta of a cell's middle.
        """
    @property
    def headings(self) -> list[float]:
        ...
    @property
    def nx(self) -> int:
        ...
    @property
    def ny(self) -> int:
        ...
    @property
    def origin(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        Lower corner of cell (0, 0) [m].
        """
    @property
    def resolution(self) -> float:
        ...
class PartExplanation:
    """
    What became of the candidates for one part over all base poses tried.
    """
    def __getstate__(self) -> tuple:
        ...
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def base_poses_feasible(self) -> int:
        ...
    @property
    def base_poses_tried(self) -> int:
        ...
    @property
    def grasps(self) -> int:
        ...
    @property
    def part(self) -> str:
        ...
    @property
    def rejections(self) -> Rejections:
        ...
class BaseRegion:
    """
    Base poses from which every target part of a tray can be grasped.
    """
    def __getstate__(self) -> tuple:
        ...
    def __init__(self, tray: str, cells: numpy.typing.ArrayLike, grid: BaseGrid) -> None:
        """
        A region known from elsewhere: (headings, ny, nx) zeros and ones, to be intersected with others.
        """
    def __repr__(self) -> str:
        ...
    def __setstate__(self, arg0: tuple) -> None:
        ...
    def cells(self, grid: BaseGrid) -> numpy.typing.NDArray[numpy.uint8]:
        """
        (headings, ny, nx) array of 0 and 1.
        """
    def part_cells(self, grid: BaseGrid) -> list:
        """
        The same for each target part alone.
        """
    @property
    def base_poses_in_collision(self) -> int:
        ...
    @property
    def count(self) -> int:
        """
        Number of cells.
        """
    @property
    def explanations(self) -> list[PartExplanation]:
        ...
    @property
    def tray(self) -> str:
        ...
class ObjectRegions:
    """
    The region of every target part alone, kept and updated when parts leave.
    """
    @staticmethod
    def compute(problem: PartSupplyProblem, database: ReachDatabase, grid: BaseGrid, *, progress: typing.Any = None) -> ObjectRegions:
        """
        The same as compute_base_regions, kept part by part.
        """
    def __repr__(self) -> str:
        ...
    def base_region(self, tray: typing.SupportsInt | typing.SupportsIndex) -> BaseRegion:
        """
        The region of all target parts in place, with what became of the candidates.
        """
    def parts(self, tray: typing.SupportsInt | typing.SupportsIndex) -> list[int]:
        """
        Indices of a tray's target parts that are in place, ascending.
        """
    def region(self, tray: typing.SupportsInt | typing.SupportsIndex, parts: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]) -> numpy.typing.NDArray[numpy.uint8]:
        """
        (headings, ny, nx) array of 0 and 1: cells from which every one of these parts can be grasped.
        """
    def remove(self, tray_and_part: collections.abc.Sequence[tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex]], *, progress: typing.Any = None) -> bool:
        """
        Parts (tray, part) leave: they stand in nobody's way any more. False when stopped: nothing has changed.
        """
    @property
    def grid(self) -> BaseGrid:
        ...
    @property
    def trays(self) -> int:
        """
        How many.
        """
class Intersection:
    """
    Cells that several regions share, with their largest disc.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def cells(self) -> int:
        ...
    @property
    def centre(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        ...
    @property
    def heading(self) -> int:
        ...
    @property
    def radius(self) -> float:
        ...
    @property
    def trays(self) -> list[int]:
        ...
class Intersections:
    def __repr__(self) -> str:
        ...
    @property
    def complete(self) -> bool:
        """
        False when the search ended early.
        """
    @property
    def lost(self) -> list[Intersection]:
        """
        Shared cells whose disc is too small, largest first.
        """
    @property
    def robust(self) -> list[Intersection]:
        ...
    @property
    def sets_too_small(self) -> int:
        ...
    @property
    def sets_tried(self) -> int:
        ...
class Stop:
    """
    Where the base stops and which trays it serves there.
    """
    def __repr__(self) -> str:
        ...
    @property
    def intersection(self) -> int:
        ...
    @property
    def pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        x, y, theta.
        """
    @property
    def radius(self) -> float:
        """
        Of the disc in which every target part stays graspable [m].
        """
    @property
    def trays(self) -> list[int]:
        ...
class StopSet:
    def __repr__(self) -> str:
        ...
    @property
    def candidates(self) -> Intersections:
        """
        What least_stops chose from.
        """
    @property
    def lower_bound(self) -> int:
        """
        Proven least number of stops.
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def stops(self) -> list[Stop]:
        ...
    @property
    def unreachable_trays(self) -> list[int]:
        ...
class BasePath:
    """
    A drive of the base.
    """
    def __repr__(self) -> str:
        ...
    def duration(self, robot: Robot) -> float:
        ...
    @property
    def length(self) -> float:
        ...
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3): x, y, theta.
        """
    @property
    def turning(self) -> float:
        ...
class OptimisedOrder:
    """
    In which order parts are best picked.
    """
    def __repr__(self) -> str:
        ...
    @property
    def mean_radius(self) -> float:
        """
        Over rounds and groups [m].
        """
    @property
    def order(self) -> list[list[int]]:
        """
        [tray][round]: index of the part.
        """
    @property
    def proven(self) -> bool:
        """
        No other order is better for these groups.
        """
    @property
    def smallest_radius(self) -> float:
        ...
class PolicyRound:
    """
    One round of pick and place.
    """
    def __repr__(self) -> str:
        ...
    @property
    def mean_radius(self) -> float:
        """
        Over the stops [m].
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def reliable(self) -> bool:
        """
        The parts picked can be grasped from everywhere in the discs of their stops.
        """
    @property
    def seconds(self) -> float:
        """
        Spent on regions and stops between the rounds.
        """
    @property
    def stops(self) -> list[Stop]:
        ...
class PolicyResult:
    """
    A row of P1 table 3.4.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def feasible(self) -> bool:
        """
        Solved, reliable and online.
        """
    @property
    def mean_radius(self) -> float:
        """
        P1 equation 3.2 [m].
        """
    @property
    def mean_stops(self) -> float:
        ...
    @property
    def online(self) -> bool:
        """
        Every round's seconds are within the limit.
        """
    @property
    def reliable(self) -> bool:
        ...
    @property
    def rounds(self) -> list[PolicyRound]:
        ...
    @property
    def smallest_radius(self) -> float:
        ...
    @property
    def solved(self) -> bool:
        """
        Every round has stops.
        """
class PickMotion:
    """
    One timed arm motion at a stop.
    """
    def __repr__(self) -> str:
        ...
    @property
    def holding(self) -> bool:
        ...
    @property
    def kind(self) -> str:
        ...
    @property
    def opening(self) -> float:
        ...
    @property
    def trajectory(self) -> JointTrajectory:
        ...
class Pick:
    """
    Home, pre-grasp, grasp, lift, carry, home.
    """
    def __repr__(self) -> str:
        ...
    @property
    def duration(self) -> float:
        ...
    @property
    def failed_at(self) -> str:
        ...
    @property
    def grasp(self) -> int:
        ...
    @property
    def motions(self) -> list[PickMotion]:
        ...
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def part(self) -> int:
        ...
    @property
    def rejections(self) -> Rejections:
        ...
    @property
    def stop(self) -> int:
        ...
    @property
    def tray(self) -> int:
        ...
class Obstruction:
    """
    Why there is no plan, and what would help.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def advised_move(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        Translation of the tray in the world's x and y [m].
        """
    @property
    def largest_uncertainty(self) -> float:
        ...
    @property
    def message(self) -> str:
        ...
    @property
    def missing_reach(self) -> float:
        ...
    @property
    def move_objects(self) -> list[str]:
        """
        Objects of the scene that move with them.
        """
    @property
    def move_trays(self) -> list[str]:
        """
        Trays that move together by advised_move.
        """
    @property
    def needed_opening(self) -> float:
        """
        Gripper opening that would do [m]; 0: not it.
        """
    @property
    def part(self) -> str:
        ...
    @property
    def stage(self) -> str:
        ...
    @property
    def tray(self) -> str:
        ...
class PartSupplyPlan:
    """
    The planner's answer; a ScenarioPlan joins it with its scenario.
    """
    def __repr__(self) -> str:
        ...
    @property
    def grid(self) -> BaseGrid:
        ...
    @property
    def intersections(self) -> Intersections:
        ...
    @property
    def lower_bound(self) -> int:
        ...
    @property
    def obstructions(self) -> list[Obstruction]:
        ...
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def picks(self) -> list[Pick]:
        ...
    @property
    def proven_minimal(self) -> bool:
        """
        No fewer stops can serve the regions.
        """
    @property
    def region_trays(self) -> list[int]:
        """
        Tray index of each region.
        """
    @property
    def regions(self) -> list[BaseRegion]:
        ...
    @property
    def robustness_rate(self) -> float:
        ...
    @property
    def route(self) -> list[BasePath]:
        ...
    @property
    def stops(self) -> list[Stop]:
        ...
    @property
    def timings(self) -> list[tuple[str, float]]:
        ...
class DriveByTask:
    """
    Something the tool does on the way: T_world_tip, (4, 4), or candidates (m, 4, 4) of which any will do.
    
    tolerance: (6,) along x, y, z [m] and about them [rad] of the pose's own frame; free: names of axes that do not
    matter, of x, y, z, roll, pitch, yaw; max_tool_speed [m/s] at the task; dwell [s] for which the tool's pose is
    kept, e.g. while a gripper closes; object: name of the world's object that is held afterwards; the hand may touch it,
    and it what it stands on, for `touching` intervals before and after. 0: never before the task, nothing after it.
    
    push: a gripper that closes while the hand moves on (P1 4.3): dict of push_grasp's keywords, approach (3,), an axis of
    the tip's frame, and free_length [m], the straight way before the finger tips reach the object. T_world_tip is then
    the planned grasp; tolerance, free, max_tool_speed and dwell are left out.
    """
    def __init__(self, T_world_tip: numpy.typing.ArrayLike, *, tolerance: typing.Any = None, free: collections.abc.Sequence[str] = [], max_tool_speed: typing.Any = None, dwell: typing.SupportsFloat | typing.SupportsIndex = 0.0, object: str = '', push: dict | None = None, touching: typing.SupportsInt | typing.SupportsIndex = 2) -> None:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def candidates(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 4, 4)
        """
    @property
    def dwell(self) -> float:
        ...
    @property
    def max_tool_speed(self) -> float:
        ...
    @property
    def object(self) -> str:
        ...
    @property
    def push(self) -> typing.Any:
        """
        What push_grasp says: closing time, window, tolerance to the object's position; None without one.
        """
    @property
    def touching(self) -> int:
        ...
class WholeBodyTrajectory:
    """
    Base and arm on one clock. Between waypoints the drive velocities are linear in time; for a diff-drive base they are
    its speed v and turning rate omega, so that it never slips sideways.
    """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def at(self, time: typing.SupportsFloat | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Configuration (n,) at a time [s], clamped at the ends.
        """
    def drive_at(self, time: typing.SupportsFloat | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Drive velocities (d,) at a time [s].
        """
    def rolled_out(self, steps: typing.SupportsInt | typing.SupportsIndex = 64) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n): where the robot is at the waypoints when only the drive velocities are followed from the first one.
        """
    def sampled(self, between: typing.SupportsInt | typing.SupportsIndex = 0) -> JointTrajectory:
        """
        A JointTrajectory of all waypoints and of `between` samples after each; x, y, theta first, with their velocities.
        """
    def to_csv(self, between: typing.SupportsInt | typing.SupportsIndex = 0) -> str:
        """
        Header time, names, name.velocity, name.acceleration, base.v, base.vy, base.omega, wheel.left, wheel.right.
        """
    @property
    def drive(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, d), columns as drive_names
        """
    @property
    def drive_names(self) -> list[str]:
        ...
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def names(self) -> list[str]:
        ...
    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n)
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) [s], of the waypoints
        """
class DriveByResult:
    """
    What plan_drive_by found.
    """
    def __repr__(self) -> str:
        ...
    def to_csv(self, between: typing.SupportsInt | typing.SupportsIndex = 0) -> str:
        """
        The trajectory's to_csv with two columns more: task, its index in the row of a task's waypoint, and held, the object in the hand.
        """
    def to_dict(self) -> dict:
        ...
    @property
    def attempts(self) -> int:
        ...
    @property
    def choices(self) -> int:
        """
        Choices of candidates planned.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def events(self) -> list:
        """
        One dict per task: waypoint, time and close_time [s], object (what is held then), held_time [s] and T_tip_object, candidate, base_speed and
        tool_speed [m/s].
        """
    @property
    def iterations(self) -> int:
        ...
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def report(self) -> str:
        """
        What was tried, and what is broken where, by how much.
        """
    @property
    def seconds(self) -> float:
        ...
    @property
    def trajectory(self) -> WholeBodyTrajectory:
        """
        The answer or, when not solved, the best iterate; None when there was not even a guess.
        """
    @property
    def violations(self) -> dict:
        """
        By kind of constraint: value (0 when kept), tolerance, unit, time [s], waypoint, what, kept; measured on a roll-out ten times
        finer than the waypoints.
        """
class PinholeCamera:
    """
    Pinhole camera without distortion: looks along +z, x to the right of the image, y down.
    """
    def __init__(self, width: typing.SupportsInt | typing.SupportsIndex = 640, height: typing.SupportsInt | typing.SupportsIndex = 480, fx: typing.SupportsFloat | typing.SupportsIndex = 525.0, fy: typing.SupportsFloat | typing.SupportsIndex = 525.0, cx: typing.SupportsFloat | typing.SupportsIndex = 319.5, cy: typing.SupportsFloat | typing.SupportsIndex = 239.5, nearest: typing.SupportsFloat | typing.SupportsIndex = 0.1, farthest: typing.SupportsFloat | typing.SupportsIndex = 5.0) -> None:
        """
        Sizes, focal lengths and principal point in pixels, depths seen in [nearest, farthest] [m].
        """
    def __repr__(self) -> str:
        ...
    def project(self, point: numpy.typing.ArrayLike) -> typing.Any:
        """
        Pixel (u, v) of a point in the camera's frame, or None when it is not seen.
        """
    @property
    def cx(self) -> float:
        ...
    @property
    def cy(self) -> float:
        ...
    @property
    def farthest(self) -> float:
        ...
    @property
    def fx(self) -> float:
        ...
    @property
    def fy(self) -> float:
        ...
    @property
    def height(self) -> int:
        ...
    @property
    def nearest(self) -> float:
        ...
    @property
    def width(self) -> int:
        ...
class PlatformLocations:
    """
    Two base + arm configurations for two tool poses.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict:
        ...
    @property
    def cost(self) -> float:
        """
        Travel [m] + turn_weight * turn [rad].
        """
    @property
    def outcome(self) -> Outcome:
        ...
    @property
    def pick(self) -> dict:
        """
        Draws, what they fell at, and iterations of the first pose.
        """
    @property
    def place(self) -> dict:
        ...
    @property
    def q_pick(self) -> typing.Any:
        """
        Base and arm at the first pose; None unless solved.
        """
    @property
    def q_place(self) -> typing.Any:
        ...
    @property
    def travel(self) -> float:
        """
        Of the base between the two [m].
        """
    @property
    def turn(self) -> float:
        """
        [rad]
        """
class IkSeedDatabase:
    """
    Past solutions that start the next searches; grows with use.
    """
    @staticmethod
    def load(path: typing.Any, group: JointGroup, capacity: typing.SupportsInt | typing.SupportsIndex = 10000) -> IkSeedDatabase:
        """
        Raises IoError on a damaged file or one made for another robot.
        """
    def __init__(self, group: JointGroup, capacity: typing.SupportsInt | typing.SupportsIndex = 10000) -> None:
        ...
    def __len__(self) -> int:
        ...
    def add(self, q: numpy.typing.ArrayLike) -> None:
        ...
    def save(self, path: typing.Any) -> None:
        ...
    def seeds(self, T_world_tip: numpy.typing.ArrayLike, count: typing.SupportsInt | typing.SupportsIndex = 8) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n): remembered arm postures with the base put where they reach the pose, best match first.
        """
class PointCloud:
    """
    Points of a scan [m]; an organised cloud keeps the image's rows.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_sensor(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def height(self) -> int:
        """
        1 when the points are in no order.
        """
    @property
    def labels(self) -> list[int]:
        """
        One a point where the file has them, else empty.
        """
    @property
    def points(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3); NaN: not measured.
        """
    @property
    def warning(self) -> str:
        """
        What the reader put up with, or empty.
        """
    @property
    def width(self) -> int:
        ...
class DepthImage:
    """
    What a depth camera saw: depth along the camera's axis [m], 0 where nothing was measured.
    """
    def __init__(self, depth: typing.Any, camera: PinholeCamera, T_world_camera: typing.Any = None) -> None:
        ...
    def __repr__(self) -> str:
        ...
    def points(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3): every measured point in the world, row by row [m].
        """
    @property
    def T_world_camera(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def camera(self) -> PinholeCamera:
        ...
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        (height, width) float32 [m]
        """
class HeightMap:
    """
    Heights over square cells, seen along -z of the map's frame [m].
    """
    def __init__(self, height: typing.Any, resolution: typing.SupportsFloat | typing.SupportsIndex, T_world_map: typing.Any = None) -> None:
        """
        From heights (ny, nx) [m], NaN where nothing is known; the frame lies in the middle of the rectangle.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_map(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def height(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        (ny, nx) best estimate; NaN: not seen.
        """
    @property
    def pixel(self) -> float:
        """
        What a pixel of the image covers [m]; 0 without an image.
        """
    @property
    def resolution(self) -> float:
        ...
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        (ny, nx) no surface is higher; NaN: nothing known.
        """
class FittedCuboid:
    """
    A box-shaped part on its supporting plane.
    """
    def __repr__(self) -> str:
        ...
    def shape(self) -> Box:
        """
        The cuboid as a shape.
        """
    @property
    def T_world_box(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def fill(self) -> float:
        """
        Share of the top rectangle that was seen: how box-like it is.
        """
    @property
    def points(self) -> int:
        ...
    @property
    def size(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Full lengths, the longer side of the top first [m].
        """
class CuboidFit:
    """
    The supporting plane, the cuboids on it, and which point belongs to what.
    """
    def __repr__(self) -> str:
        ...
    @property
    def cuboids(self) -> list[FittedCuboid]:
        ...
    @property
    def labels(self) -> list[int]:
        """
        One a point: its cuboid, -1 the plane, -2 left out.
        """
    @property
    def plane_found(self) -> bool:
        ...
    @property
    def plane_normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        ...
    @property
    def plane_offset(self) -> float:
        """
        plane_normal . x = plane_offset [m]
        """
class Graspability:
    """
    Grasps, best first, and what became of the other places looked at.
    """
    def __repr__(self) -> str:
        ...
    @property
    def counts(self) -> dict:
        ...
    @property
    def grasps(self) -> list[Grasp]:
        ...
class RestingPose:
    """
    How a part may lie on a level floor.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_floor_part(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def probability(self) -> float:
        ...
class PlacedPart:
    """
    A part lying in a tray.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_tray_part(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def on_floor(self) -> bool:
        """
        False: it lies on others.
        """
    @property
    def resting_pose(self) -> int:
        """
        Index into resting_poses(part).
        """
class RandomPlacement:
    """
    Parts lying in a tray at random.
    """
    def __repr__(self) -> str:
        ...
    @property
    def not_placed(self) -> int:
        """
        Parts for which no place was found.
        """
    @property
    def parts(self) -> list[PlacedPart]:
        ...
class Pipe:
    """
    A pipe structure: straight round sections between nodes in the object's frame (P2 3.2.2).
    """
    def __init__(self, nodes: numpy.typing.ArrayLike, sections: collections.abc.Sequence[typing.Annotated[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(2)"]], diameters: typing.SupportsFloat | typing.SupportsIndex | collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]) -> None:
        """
        (n, 3) nodes [m], pairs of node indices from 0, and outer diameters [m]: one for all or one a section.
        """
    def __repr__(self) -> str:
        ...
    def grasp(self, section: typing.SupportsInt | typing.SupportsIndex, length: typing.SupportsFloat | typing.SupportsIndex, angle: typing.SupportsFloat | typing.SupportsIndex, flipped: bool = False, *, gripper: Hand | None = None, **kwargs) -> Grasp:
        """
        The grasp with these four variables (P2 3.2.3.1).
        """
    def sample_grasps(self, count: typing.SupportsInt | typing.SupportsIndex, *, gripper: Hand | None = None, **kwargs) -> list[Grasp]:
        """
        Grasps drawn over the whole pipe, at most `count`, none nearer to another than the spacings. Axes are the gripper's,
        or approach x and closing y; so are opening and margin where no keyword gives them.
        
        Keyword options:
            max_opening = 0.1: thicker sections get no grasps [m]
            end_margin = 0.02: kept from either node of a section [m]
            length_spacing = 0.01: grasps are this far apart along a section [m], or
            angle_spacing = 0.08726646259971647: this far apart in angle [rad]
            cost_per_metre = 0.0: cost for the distance from the centre of mass [1/m]
            draws = 200: fruitless draws in a row that end the sampling
            seed = 1: same seed, same grasps
        """
    def shapes(self, *, flat_ends: bool = False) -> list[LinkShape]:
        """
        LinkShapes in the object's frame: a capsule a section; with flat_ends cylinders and balls at the bends.
        """
    @property
    def centre_of_mass(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        Of tubes with equal walls [m].
        """
    @property
    def diameters(self) -> list[float]:
        ...
    @property
    def lengths(self) -> list[float]:
        """
        Of the sections [m].
        """
    @property
    def nodes(self) -> numpy.typing.NDArray[numpy.float64]:
        ...
    @property
    def sections(self) -> list:
        ...
def _capability_option_table() -> dict:
    ...
def _cartesian_option_table() -> dict:
    ...
def _check_options(section: str, **kwargs) -> None:
    """
    Raises InvalidInput when an option of a scenario's section is out of range.
    """
def _checker_option_table() -> dict:
    ...
def _cuboid_option_table() -> dict:
    ...
def _drive_by_option_table() -> dict:
    ...
def _edge_option_table() -> dict:
    ...
def _first_drive_by_guess(group: JointGroup, *, start: numpy.typing.ArrayLike, tasks: collections.abc.Sequence[DriveByTask], goal: numpy.typing.ArrayLike, waypoints: typing.SupportsInt | typing.SupportsIndex = 35) -> typing.Any:
    """
    Where the first attempt begins, for benchmarks against other optimisers; None when a task is out of reach. solve() takes it from there, judging included: whether it is solved, and the duration.
    """
def _grasp_option_table() -> dict:
    ...
def _graspability_option_table() -> dict:
    ...
def _ik_option_table() -> dict:
    ...
def _manipulation_option_table() -> dict:
    ...
def _motion_option_table() -> dict:
    ...
def _pipe_grasp_option_table() -> dict:
    ...
def _platform_option_table() -> dict:
    ...
def _push_option_table() -> dict:
    ...
def _reach_option_table() -> dict:
    ...
def _roadmap_option_table() -> dict:
    ...
def _sample_grasps(object: collections.abc.Sequence[LinkShape], gripper: Hand, **kwargs) -> tuple[list[Grasp], int]:
    """
    (grasps, too_wide): as sample_grasps, with the number dropped as too wide.
    """
def _supply_option_table() -> dict:
    ...
def _timing_option_table() -> dict:
    ...
def _tracking_option_table() -> dict:
    ...
def cache_folder() -> str:
    """
    $XDG_CACHE_HOME/mmgrasp, or ~/.cache/mmgrasp.
    """
def camera_view_objective(group: JointGroup, camera_link: str, point: numpy.typing.ArrayLike, T_link_camera: typing.Any = None, weight: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> IkObjective:
    """
    Weight times the squared distance [m] of a world point from the optical axis (+z) of a camera on a link, plus the
    squared depth by which it lies behind the camera.
    """
def cheapest_assignment(costs: numpy.typing.ArrayLike) -> list[int]:
    """
    A column of its own for each row of (n, n) so that the sum of costs is least.
    """
def closing_outcome(start: typing.SupportsFloat | typing.SupportsIndex, **kwargs) -> ClosingOutcome:
    """
    What beginning to close at an engagement [m] comes to; keywords as of push_grasp.
    """
def compute_base_regions(problem: PartSupplyProblem, database: ReachDatabase, grid: BaseGrid, *, progress: typing.Any = None) -> list[BaseRegion]:
    """
    P1 Algorithm 2 with exact inverse kinematics: one region for each tray with target parts.
    """
def compute_disabled_pairs(robot: Robot, *, progress: typing.Any = None, **kwargs) -> Robot:
    """
    The robot with the link pairs that always or never touch found by sampling; those of an SRDF are kept.
    
    Keyword options:
        samples = 10000: random configurations
        always_fraction = 0.95: a pair in collision at least this often is called always
        seed = 1: same seed, same pairs
        threads = 0: 0: all
    """
def drive_arc(pose: numpy.typing.ArrayLike, platform_velocity: numpy.typing.ArrayLike, time: typing.SupportsFloat | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Base pose (x, y, theta) after `time` [s] at a constant platform velocity (v_x, v_y, omega): the exact arc.
    """
def evaluate_graspability(map: HeightMap, gripper: Hand, *, image: DepthImage | None = None, **kwargs) -> Graspability:
    """
    Fast graspability evaluation (P1 3.7.2): contact and collision masks of the hand convolved with a height map over
    closing directions, openings and heights; grasps at the local maxima, straight along -z of the map. With the
    `image` that the map was made of each grasp gets its pixel.
    
    Keyword options:
        margin = 0.001: kept free around the hand [m]
        orientations = 16: closing directions over half a turn
        openings = 2: openings tried: max_opening and equal parts of it
        layer_step = 0.01: between the heights at which fingertips are tried [m]
        lowest = 0.003: height of the lowest fingertips above the map's frame [m]
        insertion = 0.01: how far a part must rise above the fingertips to count as held [m]
        smoothing = 0.01: radius over which graspability is averaged [m]
        min_contact = 0.4: share of the pads' width that must meet the part
        min_distance = 0.015: between returned grasps of about one direction [m]
        max_grasps = 100: best kept
        threads = 0: 0: all
    """
def find_package(name: str, folder: typing.Any, package_dirs: typing.Any = None) -> str:
    """
    Folder of the ROS package that a file in `folder` means by package://NAME or $(find NAME); empty if none.
    """
def fit_cuboids(points: typing.Any, *, T_world_tray: typing.Any = None, tray_size: typing.Any = None, wall: typing.SupportsFloat | typing.SupportsIndex = 0.005, up: typing.Any = None, eye: typing.Any = None, **kwargs) -> CuboidFit:
    """
    Box-shaped parts in a cloud (n, 3) (P1 3.7.1): the supporting plane and the tray are taken out, every cluster above
    gets an upright cuboid. With a tray (outer `tray_size`, frame at the middle of its floor) the floor carries the parts;
    without, the dominant plane does whose normal is near `up` (z; zeros: any plane, `eye` is above it).
    
    Keyword options:
        plane_tolerance = 0.008: points no farther from the plane belong to it [m]
        wall_margin = 0.006: points no farther from a tray's wall are left out [m]
        up_angle = 0.35: the plane's normal lies within this of `up` [rad]
        max_height = 0.5: points higher above the plane are left out [m]
        cluster_tolerance = 0.01: points farther from each other are different parts [m]
        leaf = 0.003: cell to which points are thinned for the search [m]
        min_points = 60: smaller clusters are left out
        plane_iterations = 1000: random planes tried
    """
def graspability_map(map: HeightMap, gripper: Hand, angle: typing.SupportsFloat | typing.SupportsIndex, opening: typing.SupportsFloat | typing.SupportsIndex, tip_height: typing.SupportsFloat | typing.SupportsIndex, **kwargs) -> numpy.typing.NDArray[numpy.float32]:
    """
    (ny, nx) smoothed graspability in [0, 1] of one closing direction, opening and height of the fingertips.
    """
def hand_masks(gripper: Hand, opening: typing.SupportsFloat | typing.SupportsIndex, angle: typing.SupportsFloat | typing.SupportsIndex, resolution: typing.SupportsFloat | typing.SupportsIndex, **kwargs) -> dict:
    """
    The masks `contact`, `fingers` and `palm` as images of zeros and ones with the hand in the middle.
    """
def inscribed_circle(grid: BaseGrid, cells: numpy.typing.ArrayLike, heading: typing.SupportsInt | typing.SupportsIndex = 0) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"], float]:
    """
    Centre (2,) and radius [m] of the largest disc inside the union of cells of one layer.
    """
def joint_limit_objective(group: JointGroup, soft_fraction: typing.SupportsFloat | typing.SupportsIndex = 0.1, weight: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> IkObjective:
    """
    Weight times the squared depth inside the outer `soft_fraction` of each joint's range, at both ends.
    """
def joint_velocity(theta: typing.SupportsFloat | typing.SupportsIndex, platform_velocity: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Velocities of the virtual joints x, y, theta for a platform velocity: the inverse of platform_velocity().
    """
def least_stops(grid: BaseGrid, regions: collections.abc.Sequence, min_radius: typing.SupportsFloat | typing.SupportsIndex = 0.1, *, time_limit: typing.SupportsFloat | typing.SupportsIndex = 60.0, tie_time_limit: typing.SupportsFloat | typing.SupportsIndex = 10.0, start: typing.Any = None, goal: typing.Any = None, progress: typing.Any = None) -> StopSet:
    """
    The least number of stops over regions (or masks), with proof; among equally few the widest discs, then, with `start` and `goal` (x, y), the shortest route as the crow flies.
    """
def look_down(eye: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """
    T_world_camera of a camera at `eye` [m] that looks straight down, image x along the world's x.
    """
def make_base_grid(problem: PartSupplyProblem, database: ReachDatabase) -> BaseGrid:
    """
    The grid that covers all base poses from which any tray could be reached.
    """
def make_height_map(image: DepthImage, T_world_map: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, **kwargs) -> HeightMap:
    """
    Resamples a depth image over a rectangle of `size` (x, y) [m] around a frame whose z points up.
    
    Keyword options:
        resolution = 0.002: edge of a cell [m]
        hole_radius = 2: holes up to so many pixels from a measurement are filled
        jump = 0.01: neighbouring pixels that differ by more show different surfaces [m]
    """
def manipulation_planner_names() -> list[str]:
    """
    Names that plan_manipulation's `planner` takes.
    """
def maximal_intersections(grid: BaseGrid, regions: collections.abc.Sequence, min_radius: typing.SupportsFloat | typing.SupportsIndex, *, max_boxes: typing.SupportsInt | typing.SupportsIndex = 50000000, progress: typing.Any = None) -> Intersections:
    """
    Those of the robust sets that are part of no other one: enough to prove a least number of stops.
    """
def minimal_stops(grid: BaseGrid, intersections: collections.abc.Sequence[Intersection], trays: typing.SupportsInt | typing.SupportsIndex) -> StopSet:
    """
    The least number of intersections that cover all trays (P1 equation 3.1), with proof.
    """
def nlp_solver_names() -> list[str]:
    """
    Names that plan_drive_by's `solver` takes.
    """
def optimised_order(grid: BaseGrid, cells: collections.abc.Sequence, groups: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]], order: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]], *, smallest_first: bool = False, restarts: typing.SupportsInt | typing.SupportsIndex = 20, rng_seed: typing.SupportsInt | typing.SupportsIndex = 1) -> OptimisedOrder:
    """
    The order in which parts are best picked when the trays of each group share a stop, never worse than `order`. `cells` is [tray][part], bitmaps (headings, ny, nx).
    """
def paired_order(places: collections.abc.Sequence) -> list[list[int]]:
    """
    P1's heuristic (figure 3.11): parts of neighbouring trays at nearly constant distances go together. `places` is one (m, 2) array of positions a tray; the answer is [tray][round].
    """
def plan_base_route(arm: JointGroup, world: World, *, home: numpy.typing.ArrayLike, start: numpy.typing.ArrayLike, goal: numpy.typing.ArrayLike, resolution: typing.SupportsFloat | typing.SupportsIndex = 0.1) -> BasePath:
    """
    A driveable, collision-free way of the whole robot with its arm at `home`; poses are x, y, theta.
    """
def plan_cartesian(checker: CollisionChecker, tool_poses: numpy.typing.ArrayLike, near: typing.Any = None, *, progress: typing.Any = None, **kwargs) -> CartesianResult:
    """
    The tip follows straight lines from pose to pose, from the inverse kinematics branch of the first pose that completes
    them with the shortest way, counted from `near` (n,) when that is given. A group that moves a diff_drive base is
    refused: it could not follow such a path.
    
    Keyword options:
        position_step = 0.005: largest tool translation between two waypoints [m]
        rotation_step = 0.02: largest tool rotation between two waypoints [rad]
        max_joint_step = 0.2: a larger joint motion between waypoints is a jump
        edge_step = 0.02: largest joint motion between two checks [rad or m]
        max_branches = 64: configurations of the first pose that are followed at most
    """
def plan_drive_by(robot: Robot, group: JointGroup, world: World, *, start: numpy.typing.ArrayLike, tasks: collections.abc.Sequence[DriveByTask], goal: numpy.typing.ArrayLike, progress: typing.Any = None, **kwargs) -> DriveByResult:
    """
    The fastest motion of base and arm from `start` (n,), at rest, through the tasks in order to `goal`, at rest, without
    stopping for them (P1 chapter 4). goal: a configuration (n,), or (2, n) with lower and upper bounds, infinite where it
    does not matter. The world's objects and the robot itself are obstacles.
    
    Keyword options:
        waypoints = 35: waypoints of the whole motion
        attempts = 8: guesses tried until one leads to a solution
        solutions = 1: solutions compared of one choice of candidates
        choices = 8: choices of candidates planned; the fastest motion is returned; 1: the choice that looks quickest
        stands = 64: configurations sought per candidate
        iterations = 1500: of all attempts; after so many no other begins
        time_limit = 600.0: wall-clock cap [s]
        jerk_time = 0.0: accelerations may go from 0 to their limit in no less [s]; 0: no limit
        collisions = True: the robot keeps clear of the world and of itself
        seed = 1: same seed, same answer
        threads = 1: 0: all; does not change the answer
        solver = 'ipopt': a name of nlp_solver_names()
        tolerance = 0.0001: relative optimality
        max_iterations = 150: of one solve; an attempt has at most 1 + refinements
        attempt_time_limit = 600.0: wall-clock cap of one attempt [s]
        smoothing = 0.01: weight of the mean square of accelerations over their limits [s]
        margin = 0.005: distance to keep from obstacles and from oneself [m]
        look_out = 0.15: pairs of bodies nearer than this are constrained [m]
        refinements = 6: times that collision constraints may be added
    """
def plan_manipulation(problem: ManipulationProblem, *, roadmap: Roadmap | None = None, progress: typing.Any = None, improved: typing.Any = None, **kwargs) -> ManipulationResult:
    """
    Collision-free path of the group that carries the object from start to goal with the best of the grasps (P2 chapters 4 and 5). Every grasp is looked at. `improved` is called with every better solution (an Improvement); what it raises ends the call.
    
    Keyword options:
        planner = 'prm_star_mg': a name of manipulation_planner_names()
        ik_solutions = 4: arm configurations tried for each grasp at each end
        first_grasps = 4: grasps looked at, one by one, before those without a first path are searched again, then twice as many; 0: all before any search
        straight = True: try straight joint lines from start to goal
        ik_restarts = 30: random starts of arms without a closed form
        joint_step = 0.02: no joint moves more between two checks of an edge [rad or m]
        workspace_step = 0.005: no point of the robot or the object moves more between two checks [m]
        time_limit = 15.0: wall-clock cap on IK and search, without the roadmap's building [s]
        seed = 1: same seed, same path
        threads = 0: 0: all; does not change the answer
        batch = 0: prm_star_mg: grasps searched together before paths are checked; 1: naive, 0: all
        lazy_grasps = True: prm_star_mg: search a grasp only when its straight line could still win
        max_vertices = 0: prm_star_mg: once the roadmap's best path is found, double its vertices up to this; 0: never
        shorten = True: prm_star_mg: shorten the roadmap's best path at the end
        refinements = 4: prm_star_mg: then search so many small roadmaps drawn where a cheaper path can pass
        vertices = 5000: prm_star_mg without a roadmap given: configurations drawn
        gamma = 4.0: likewise: vertices nearer than gamma (log n / n)^(1/d) are joined [rad or m]
        neighbours = 0: likewise: > 0: join that many nearest ones instead
        roadmap_seed = 1: likewise: same seed, same roadmap
        max_samples = 1000: rrt_star_mg: budget in samples
        step = 1.5: rrt_star_mg: longest edge grown towards a sample [rad or m]
        rrt_gamma = 0.0: rrt_star_mg: vertices nearer than gamma (log n / n)^(1/(d+1)) are joined; 0: about 4 (1 + 1/d) n^(1/(d+1)) log n of n
        exploration = 0.5: rrt_star_mg: once solved, chance to grow the drawn grasp's own tree (P2's p_blt)
        bidirectional = True: rrt_star_mg: trees from both ends
        informed = True: rrt_star_mg: draw only where a better path can pass
        goal_cost = 0.0: rrt_star_mg: ends with the first path that costs no more; inf: the first at all
        keep_trees = False: rrt_star_mg: hand over the trees with the result
    """
def plan_motion(robot: Robot, group: JointGroup, world: World, *, start: numpy.typing.ArrayLike, goal: typing.Any = None, tool_poses: typing.Any = None, regions: collections.abc.Sequence[ToolRegion] = [], tool_cone: ToolCone | None = None, on_solution: typing.Any = None, progress: typing.Any = None, **kwargs) -> MotionResult:
    """
    A collision-free path of the group from `start` (n,) to any of its goals: `goal` (n,) or several as (m, n),
    `tool_poses` of the tip, (4, 4) or (m, 4, 4), and `regions` of them, reached by inverse kinematics. `tool_cone`
    holds on the whole path. on_solution(path, cost) is called with each better path. A diff-drive base turns on
    the spot and drives straight.
    
    Keyword options:
        planner = 'rrt_connect': a name of planner_names()
        time_limit = 5.0: wall-clock cap [s]
        max_iterations = 20000: budget in states drawn
        range = 0.0: longest tree edge [rad]; 0: a share of the joint box's diagonal
        base_margin = 2.0: the base is drawn this far around start and goals [m]
        edge_step = 0.02: largest joint motion between two checks [rad or m]
        workspace_step = inf: largest motion of any robot point between two checks [m]
        shorten = True: shortcut the path
        shorten_iterations = 200: tries of the shortening
        ik_solutions = 8: IK solutions looked for at each tool pose
        region_samples = 16: tool poses drawn in each region
        seed = 1: same seed, same path
    """
def plan_part_supply(problem: PartSupplyProblem, database: ReachDatabase, *, progress: typing.Any = None) -> PartSupplyPlan:
    """
    The whole of P1's Algorithm 1 and the motions around it, for a problem given as objects.
    """
def plan_pick(problem: PartSupplyProblem, database: ReachDatabase, base_pose: numpy.typing.ArrayLike, tray: typing.SupportsInt | typing.SupportsIndex, part: typing.SupportsInt | typing.SupportsIndex, remaining: collections.abc.Sequence[tuple[typing.SupportsInt | typing.SupportsIndex, typing.SupportsInt | typing.SupportsIndex]]) -> Pick:
    """
    One pick from a base pose; `remaining` are the (tray, part) still in place, the picked one among them.
    """
def plan_platform_locations(checker: CollisionChecker, T_world_pick: numpy.typing.ArrayLike, T_world_place: numpy.typing.ArrayLike, *, pick_point: typing.Any = None, place_point: typing.Any = None, camera_link: typing.Any = None, T_link_camera: typing.Any = None, camera: PinholeCamera = None, database: IkSeedDatabase = None, **kwargs) -> PlatformLocations:
    """
    Two base + arm configurations for two tool poses with the least base travel (P3 3.6, Algorithm 2). The checker's group
    must have the base. With a `camera_link` the points (default: the tool positions) are in view of
    `camera` (default: PinholeCamera()), whose frame looks along +z. A database starts the searches and learns from them.
    
    Keyword options:
        samples = 100: valid configurations drawn for each pose
        max_draws = 2000: searches for each pose, valid or not
        least_manipulability = 0.02: over the arm's joints
        turn_weight = 0.3: what one radian of base turn counts as [m]
        seed = 1: same seed, same answer
        time_limit = 10.0: wall-clock cap [s]
    """
def plan_straight_line(checker: CollisionChecker, start: numpy.typing.ArrayLike, T_world_to: numpy.typing.ArrayLike, *, progress: typing.Any = None, **kwargs) -> StraightLineResult:
    """
    The tool moves on a straight line from the pose of `start` to T_world_to. A group that moves a diff_drive base is
    refused: it could not follow such a path.
    
    Keyword options:
        position_step = 0.005: largest tool translation between two waypoints [m]
        rotation_step = 0.02: largest tool rotation between two waypoints [rad]
        max_joint_step = 0.2: a larger joint motion between two waypoints is a jump
        edge_step = 0.02: largest joint motion between two checks [rad or m]
    """
def planner_names() -> list[str]:
    """
    Names that plan_motion's `planner` takes.
    """
@typing.overload
def platform_velocity(theta: typing.SupportsFloat | typing.SupportsIndex, joint_velocity: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    Velocity command (v_x, v_y, omega) in the platform's own frame for velocities of the virtual joints x, y, theta
    standing at heading theta (P3 3.12) [m/s, rad/s].
    """
@typing.overload
def platform_velocity(*, left: typing.SupportsFloat | typing.SupportsIndex, right: typing.SupportsFloat | typing.SupportsIndex, wheel_separation: typing.SupportsFloat | typing.SupportsIndex) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    The same of a diff-drive whose wheel rims move at `left` and `right` [m/s]: v = (left + right) / 2,
    omega = (right - left) / wheel_separation (P1 4.11).
    """
def pose(xyz: numpy.typing.ArrayLike, rpy: typing.Any = None, quat_xyzw: typing.Any = None) -> numpy.typing.NDArray[numpy.float64]:
    """
    A (4, 4) pose from a position [m] and roll-pitch-yaw (URDF's convention) [rad] or a quaternion (x, y, z, w).
    """
def pose_to_xyz_quat(T: numpy.typing.ArrayLike) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]]:
    """
    Position (3,) and quaternion (x, y, z, w) of a (4, 4) pose.
    """
def pose_to_xyz_rpy(T: numpy.typing.ArrayLike) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"], typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]]:
    """
    Position (3,) and roll-pitch-yaw (3,) of a (4, 4) pose.
    """
def push_grasp(*, hand: Hand | None = None, **kwargs) -> PushGrasp:
    """
    When a hand that moves on may begin to close, and what error of the object's position it forgives (P1 4.3).
    Lengths are those of `hand` where no keyword gives them.
    
    Keyword options:
        opening = 0.1: between the fingers before they close [m]
        closing_speed = 0.1: how fast the opening shrinks [m/s]
        tool_speed = 0.3: along the approach [m/s]
        finger_length = 0.12: from the palm to the tips [m]
        object_width = 0.05: along the closing direction [m]
        grip_depth = 0.02: least engagement that holds [m]
        planned_depth = 0.06: engagement at the planned grasp pose [m]
        clearance = 0.0: kept on either side while the fingers pass the object [m]
        max_push = 0.1: how far the object may slide before the palm [m]
        along_error = 0.0: the object may stand this much nearer or farther [m]
        lateral_error = 0.0: and this much to either side [m]
    """
def push_speed_limit(*, length: typing.SupportsFloat | typing.SupportsIndex, friction: typing.SupportsFloat | typing.SupportsIndex, restitution: typing.SupportsFloat | typing.SupportsIndex) -> float:
    """
    Fastest tool [m/s] before whose palm a hit object does not leap more than `length` [m].
    """
def quat_xyzw_from_rotation(R: numpy.typing.ArrayLike) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
    """
    Quaternion (x, y, z, w) of a (3, 3) rotation.
    """
def random_placement(part: collections.abc.Sequence[LinkShape], tray_size: numpy.typing.ArrayLike, *, count: typing.SupportsInt | typing.SupportsIndex = 12, fill: typing.SupportsFloat | typing.SupportsIndex = 1.0, wall: typing.SupportsFloat | typing.SupportsIndex = 0.005, **kwargs) -> RandomPlacement:
    """
    Alike parts lying in a tray at random (P1 3.5.2), let down one after another without touching; `fill` is the share
    of `count` that is there. The tray's frame is the middle of its floor, `tray_size` are outer lengths.
    
    Keyword options:
        attempts = 100: random places tried for each part
        stack = True: a part without a place on the floor may lie on others
        gap = 0.0005: air left between bodies [m]
        seed = 1: same seed, same places
    """
def read_pcd(path: typing.Any) -> PointCloud:
    """
    Reads a PCD file: ascii, binary or binary_compressed. Raises IoError naming file and rule.
    """
def render_depth(scene: collections.abc.Sequence[LinkShape], camera: PinholeCamera, T_world_camera: numpy.typing.ArrayLike, **kwargs) -> DepthImage:
    """
    The depth image of shapes whose poses are in the world: one ray a pixel, first surface in front of the camera.
    
    Keyword options:
        noise = 0.0: standard deviation of the depth at 1 m; grows with the square of the distance [m]
        missing = 0.0: share of pixels without a measurement, in [0, 1]
        seed = 1: same seed, same image
        threads = 0: 0: all
    """
def resting_poses(part: collections.abc.Sequence[LinkShape]) -> list[RestingPose]:
    """
    Faces of a part's convex hull on which it does not tip over, most probable first.
    """
def robust_intersections(grid: BaseGrid, regions: collections.abc.Sequence, min_radius: typing.SupportsFloat | typing.SupportsIndex, max_sets: typing.SupportsInt | typing.SupportsIndex = 200000) -> Intersections:
    """
    Every set of trays whose shared cells hold a disc of at least `min_radius` [m] (P1 3.4.2).
    """
def route_lengths(arm: JointGroup, world: World, *, home: numpy.typing.ArrayLike, positions: numpy.typing.ArrayLike, resolution: typing.SupportsFloat | typing.SupportsIndex = 0.1, threads: typing.SupportsInt | typing.SupportsIndex = 0, progress: typing.Any = None) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
    """
    (m, m): how far it is to drive between base poses (m, 3), around what stands in the way; infinite: no way found.
    """
def run_policy(grid: BaseGrid, cells: collections.abc.Sequence, order: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]], policy: str = 'all', *, min_radius: typing.SupportsFloat | typing.SupportsIndex = 0.1, online_limit: typing.SupportsFloat | typing.SupportsIndex = 1.0, time_limit: typing.SupportsFloat | typing.SupportsIndex = 60.0, tie_time_limit: typing.SupportsFloat | typing.SupportsIndex = 10.0, planned: typing.Any = None, progress: typing.Any = None) -> PolicyResult:
    """
    Plans the stops of every round for all parts, the `remaining` or the `targets` and holds them against the parts' bitmaps `cells` [tray][part]. `planned(round)` gives other regions to plan with, one a tray: what they cost counts as time between the rounds.
    """
def sample_grasps(object: collections.abc.Sequence[LinkShape], gripper: Hand, **kwargs) -> list[Grasp]:
    """
    Antipodal grasps of a body given as a list of LinkShape (P1 3.4.1), best first.
    
    Keyword options:
        approaches = 8: approach directions around each closing axis
        positions = 3: pad positions along each free direction
        mesh_samples = 400: surface points tried on a mesh
        max_grasps = 200: best kept, spread over approach directions
        friction = 0.5: Coulomb coefficient
        standoff = 0.0: how far the tool frame stays outside the object's middle [m]
        seed = 1: same seed, same grasps
    """
def self_distance_objective(checker: CollisionChecker, margin: typing.SupportsFloat | typing.SupportsIndex = 0.05, weight: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> IkObjective:
    """
    Weight times the sum of (1 - distance / margin)^2 over pairs of the robot's own links nearer than `margin` [m].
    """
def share_stops(drive_times: numpy.typing.ArrayLike, stop_times: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], robots: typing.SupportsInt | typing.SupportsIndex) -> SharedTours:
    """
    Shares stops among robots so that the last is done as early as can be. `drive_times` is (n + 2 k, n + 2 k): stops, k starts, k goals; infinite: no way.
    """
def shorten_drive_by(group: JointGroup, world: World, *, tasks: collections.abc.Sequence[DriveByTask], times: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], positions: numpy.typing.ArrayLike, task_times: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], progress: typing.Any = None, **kwargs) -> DriveByResult:
    """
    plan_drive_by from a motion that is known instead of guesses: positions (m, n) at times [s], straight between them, free of
    collisions, from rest to rest, at each task at its time; e.g. a drive and a pick one after the other. The answer is near that
    motion. Tasks have one pose and no push. Keywords are those of plan_drive_by.
    """
def shortest_visiting_tour(lengths: numpy.typing.ArrayLike) -> TourResult:
    """
    Shortest way from start over all n stops to goal. `lengths` is (n + 2, n + 2): stops, start, goal; infinite: no way.
    """
def simplify_mesh(mesh: Mesh, tolerance: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> dict:
    """
    The simplest solid that contains a mesh and has no point farther than `tolerance` [m] from it, as a dict:
    `shape` (a LinkShape in the mesh's frame), `chosen` (mesh, hull, box, sphere or cylinder), `triangles_saved` and
    the proven `deviation` [m]. With 0 the solid stays the same.
    """
def singularity_objective(group: JointGroup, threshold: typing.SupportsFloat | typing.SupportsIndex, weight: typing.SupportsFloat | typing.SupportsIndex = 1.0) -> IkObjective:
    """
    Weight times max(0, 1 - M / threshold)^2, M the manipulability of the arm's joints (without the base).
    """
def solve_set_cover(elements: typing.SupportsInt | typing.SupportsIndex, sets: collections.abc.Sequence[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex]], costs: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex] = [], *, time_limit: typing.SupportsFloat | typing.SupportsIndex = 60.0, progress: typing.Any = None) -> SetCoverResult:
    """
    Fewest (or cheapest) sets that cover all of 0..elements-1, with a proof (P1, equation 3.1).
    """
def time_parameterize(path: numpy.typing.ArrayLike, velocity_limits: numpy.typing.ArrayLike, acceleration_limits: numpy.typing.ArrayLike, *, names: collections.abc.Sequence[str] = [], progress: typing.Any = None, **kwargs) -> JointTrajectory:
    """
    Near time-optimal timing of waypoints (k, n), at rest at both ends; corners are blended, which may leave the path
    by max_deviation.
    
    Keyword options:
        max_deviation = 0.01: corners are blended within this joint distance [rad]
        sample_period = 0.02: spacing of the samples [s]
        jerk_limits = None: of each joint [rad/s^3]; None: no such limits
    """
def time_parameterize_free(checker: CollisionChecker, path: numpy.typing.ArrayLike, *, edge_step: typing.SupportsFloat | typing.SupportsIndex = 0.01, progress: typing.Any = None, **kwargs) -> JointTrajectory:
    """
    time_parameterize under the limits of the checker's group, the blended corners checked for collisions too, no joint moving
    more than edge_step between two checks [rad or m]. Without any times when the straight edges of the path are not free.
    
    Keyword options:
        max_deviation = 0.01: corners are blended within this joint distance [rad]
        sample_period = 0.02: spacing of the samples [s]
        jerk_limits = None: of each joint [rad/s^3]; None: no such limits
    """
def track_base(robot: Robot, trajectory: JointTrajectory, **kwargs) -> BaseTrackingResult:
    """
    Drives the robot's base along the columns x, y, theta of a trajectory, with slip and noise (P1 4.4.2, figure 4.9).
    
    Keyword options:
        kp = 2.0: proportional gain [1/s]
        ki = 0.1: integral gain [1/s^2]
        kd = 0.3: derivative gain
        offset = 0.2: distance of the tracked point from the wheel axis [m]
        period = 0.02: a command is held this long [s]
        feed_forward = True: adds the planned velocity
        feedback = True: False: open loop, the planned velocities only
        settle = 0.0: goes on this long after the plan's end [s]
        slip_left = 0.0: share of the left wheel's travel lost
        slip_right = 0.0: the same of the right wheel
        drift = (0.0, 0.0, 0.0): platform velocity added [m/s, m/s, rad/s]
        travel_noise = 0.0: deviation of a wheel's travel after 1 m [m], growing with the root of the travel
        position_noise = 0.0: deviation of a measured x or y [m]
        heading_noise = 0.0: deviation of a measured heading [rad]
        start_error = (0.0, 0.0, 0.0): where the base stands at first, less the plan
        seed = 1: same seed, same run
    """
def tray_shapes(size: numpy.typing.ArrayLike, wall: typing.SupportsFloat | typing.SupportsIndex = 0.005) -> list[LinkShape]:
    """
    Floor and four walls of a tray (outer lengths) in its frame.
    """
def wheel_speeds(v: typing.SupportsFloat | typing.SupportsIndex, omega: typing.SupportsFloat | typing.SupportsIndex, wheel_separation: typing.SupportsFloat | typing.SupportsIndex) -> tuple[float, float]:
    """
    Rim speeds (left, right) of a diff-drive's wheels [m/s].
    """
def with_sampled_pairs(robot: Robot, *, progress: typing.Any = None) -> Robot:
    """
    compute_disabled_pairs with default options, its result cached on disk under the robot's hash.
    """
__version__: str = '0.1.0'
