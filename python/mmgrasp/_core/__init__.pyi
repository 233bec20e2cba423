"""
The C++ library behind mmgrasp. Import names from mmgrasp itself.
"""
from __future__ import annotations
import collections.abc
import enum
import mmgrasp.records
import numpy
import numpy.typing
import os
import typing
from . import verify
__all__: list[str] = ['AssemblyGrasp', 'AssemblyOperation', 'BaseGrid', 'BasePath', 'BasePlacement', 'BaseRegion', 'BaseTracker', 'BaseTrackingResult', 'BeamExtreme', 'BeamFrame', 'BeamMaterial', 'BeamMember', 'BeamSection', 'BeamState', 'BeamSupport', 'Box', 'CapabilityMap', 'Capsule', 'CartesianResult', 'ClosingOutcome', 'CollisionChecker', 'Contact', 'ContactArea', 'ContactPairProvenance', 'ContactPatch', 'CuboidFit', 'Cylinder', 'DepthCamera', 'DepthImage', 'DepthNoise', 'DerivativeFreeResult', 'DistanceField', 'DistanceResult', 'DrawnSuccess', 'DriveByResult', 'DriveByTask', 'EdgeResult', 'Error', 'Facet', 'FeasibleGrasp', 'FingerGrip', 'FingerLengthRange', 'FittedCuboid', 'FittedPrimitive', 'FrameRegistration', 'Grasp', 'GraspHolding', 'GraspOptimum', 'GraspRating', 'GraspReport', 'GraspSuccess', 'GraspSynthesis', 'GraspWidth', 'Graspability', 'GridDistanceField', 'Gripper', 'GripperActuator', 'Hand', 'HandBody', 'HandJoint', 'HeightMap', 'HeightMapProvenance', 'HeldLoad', 'HoldingRequirement', 'IkBranches', 'IkObjective', 'IkResult', 'IkSeedDatabase', 'Improvement', 'IntegrationReport', 'Intersection', 'Intersections', 'InvalidInput', 'IoError', 'JointGroup', 'JointTrajectory', 'KeepOff', 'LineGrasp', 'LinkShape', 'ManipulationProblem', 'ManipulationResult', 'ManipulationStats', 'Mesh', 'MeshDistanceField', 'MeshSegment', 'MeshSegmentation', 'MinimalGrippersResult', 'MotionResult', 'MotionStats', 'NextView', 'NlpResult', 'NodeLoad', 'NonlinearProblem', 'ObjectPathEvaluator', 'ObjectPathProblem', 'ObjectPathResult', 'ObjectRegions', 'ObjectSegmentation', 'Obstruction', 'OccupancyMap', 'OccupancyReport', 'OperationLoad', 'OperationOverlap', 'OptimisedOrder', 'OrientationConstraint', 'Outcome', 'PairwiseWeights', 'Part', 'PartExplanation', 'PartSupplyPlan', 'PartSupplyProblem', 'Pick', 'PickMotion', 'PinholeCamera', 'Pipe', 'PipeProvenance', 'PlaceRegion', 'PlacedMesh', 'PlacedPart', 'PlanGrippersResult', 'Plane', 'PlatformLocations', 'PointCloud', 'PolicyResult', 'PolicyRound', 'ProbabilisticSdf', 'PushGrasp', 'RandomPlacement', 'ReachDatabase', 'RefusedGrasp', 'Rejection', 'Rejections', 'RestingPose', 'Roadmap', 'Robot', 'RobotMotion', 'RobotSource', 'SampledSuctionGrasps', 'ScrewThread', 'SdfHits', 'SearchTree', 'SegmentFate', 'SegmentRequirement', 'SegmentedObject', 'SegmentedPart', 'SetCoverResult', 'SharedTours', 'Sphere', 'Stop', 'StopSet', 'StraightLineResult', 'Suction', 'SuctionCup', 'SupportedFrame', 'SupportingPlane', 'ToolRegion', 'TourResult', 'Tray', 'UnloadRegion', 'Unloading', 'ViewCandidate', 'Voxels', 'WholeBodyProgram', 'WholeBodyTrajectory', 'World', 'assembly_grasps', 'beam_frame', 'cache_folder', 'camera_view_objective', 'centric_grasps', 'cheapest_assignment', 'closing_outcome', 'compute_base_regions', 'compute_disabled_pairs', 'copper', 'cover_from_intersections', 'default_grasp_search', 'derivative_free_solver_names', 'drive_arc', 'drive_by_program', 'eigengrasp_hand', 'evaluate_graspability', 'find_package', 'finger_length_range', 'fingers_fit', 'fingers_meet', 'fit_cuboids', 'fit_primitives', 'flat_contact', 'follow_object_path', 'free_gripper', 'grasp_holding', 'grasp_search_names', 'graspability_map', 'hand_masks', 'held_load', 'inscribed_circle', 'jaw_grasps', 'joint_limit_objective', 'joint_velocity', 'line_contact', 'look_down', 'make_base_grid', 'make_height_map', 'manipulation_planner_names', 'maximal_intersections', 'minimal_grippers', 'minimize_derivative_free', 'next_view', 'nlp_solver_names', 'operation_load', 'operation_overlap', 'optimised_order', 'optimize_grasp', 'paired_order', 'pairwise_weights', 'plan_base_route', 'plan_cartesian', 'plan_drive_by', 'plan_grippers', 'plan_manipulation', 'plan_motion', 'plan_object_pick', 'plan_part_supply', 'plan_pick', 'plan_platform_locations', 'plan_stop_picks', 'plan_stops_exact', 'plan_straight_line', 'planar_facets', 'planner_names', 'platform_velocity', 'population_search_names', 'pose', 'pose_to_xyz_quat', 'pose_to_xyz_rpy', 'preferred_grippers', 'push_grasp', 'push_speed_limit', 'quat_xyzw_from_rotation', 'random_placement', 'read_pcd', 'rectangular_section', 'register_frame', 'rehearse_operation', 'render_depth', 'resting_poses', 'robust_intersections', 'round_section', 'route_lengths', 'run_policy', 'sample_grasps', 'sample_suction_grasps', 'seal_gap', 'segment_depth_image', 'segment_mesh', 'segment_names', 'segment_objects', 'self_distance_objective', 'shape_diameters', 'share_headings', 'share_stops', 'shorten_drive_by', 'shortest_visiting_tour', 'simplify_mesh', 'singularity_objective', 'soft_finger_torque', 'solve_nonlinear', 'solve_set_cover', 'suction_share', 'synthesize_grasps', 'time_parameterize', 'time_parameterize_free', 'track_base', 'tray_shapes', 'verify', 'wheel_speeds', 'with_sampled_pairs', 'write_plan']
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
    A robot as URDF and SRDF describe it: links, joints, collision shapes, groups, pairs that need no collision check.
    Immutable; joints and links by name.
    
        robot = mg.Robot.load("robot.urdf", "robot.srdf", base="diff_drive")
        arm = robot.group("arm", tip="gripper_tcp")
        robot.links, arm.names
    """
    @staticmethod
    def from_strings(urdf: str, srdf: str = '', package_dirs: collections.abc.Mapping[str, str | os.PathLike[str]] | None = None, base: str = 'fixed', *, base_limits: collections.abc.Mapping[str, float | None] | None = None, load_meshes: bool = True, allow_missing_meshes: bool = False, mesh_tolerance: float = 0.0, origin: str = '<string>') -> Robot:
        """
        The same from the texts of URDF and SRDF; `origin` names the source in messages.
        """
    @staticmethod
    def load(urdf: str | os.PathLike[str], srdf: str | os.PathLike[str] | None = None, package_dirs: collections.abc.Mapping[str, str | os.PathLike[str]] | None = None, base: str = 'fixed', *, base_limits: collections.abc.Mapping[str, float | None] | None = None, load_meshes: bool = True, allow_missing_meshes: bool = False, mesh_tolerance: float = 0.0, xacro_args: collections.abc.Mapping[str, typing.Any] | None = None) -> Robot:
        """
        Reads a URDF and, if given, its SRDF. `base` is fixed, diff_drive or omni; `package_dirs` maps the names
        in package://NAME/... to folders. Files called .xacro are expanded first (needs the package xacro; macros
        are programs: expand only files you trust) with the arguments `xacro_args` (a dict). A box, hull, sphere or
        cylinder that contains a collision mesh and sticks out at most `mesh_tolerance` [m] replaces it; 0: only
        what is the same solid. Raises IoError or InvalidInput naming file, element, value and rule.
        """
    def __copy__(self) -> Robot:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> Robot:
        ...
    def __repr__(self) -> str:
        ...
    def collisions(self, link: str) -> list[LinkShape]:
        """
        Collision shapes of a link (list of LinkShape).
        """
    def group(self, name: str | None = None, tip: str | None = None, *, base_link: str | None = None, with_base: bool = False) -> JointGroup:
        """
        An SRDF group by name, its tip moved to any link its last joint carries; or the chain base_link to tip.
        `with_base` puts the virtual joints x, y, theta first.
        """
    def link_poses(self, joints: collections.abc.Mapping[str, float] = {}, T_world_root: numpy.typing.ArrayLike | None = None) -> dict[str, numpy.typing.NDArray[numpy.float64]]:
        """
        Pose (4, 4) of every link, other joints at their default values.
        """
    def mount(self, other: Robot, parent_link: str, T: numpy.typing.ArrayLike | None = None, prefix: str = '') -> Robot:
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
    def values(self, joints: collections.abc.Mapping[str, float] = {}) -> numpy.typing.NDArray[numpy.float64]:
        """
        Full value vector (for with_reference) with the named joints set.
        """
    def velocity_scale(self, platform_velocity: numpy.typing.ArrayLike) -> float:
        """
        Largest factor in [0, 1] that keeps a platform velocity (v_x, v_y, omega) inside the base's limits: speed,
        turning, wheels. 0 for what this base cannot do at all (sideways, or fixed).
        """
    def with_disabled_pairs(self, pairs: collections.abc.Sequence[tuple[str, str, str]]) -> Robot:
        """
        This robot with these pairs (link, link, reason) left out of collision checks instead of its own; reason is adjacent,
        never, always, user or default. Raises InvalidInput on an unknown link or reason.
        """
    def with_link(self, name: str, parent_link: str, T: numpy.typing.ArrayLike | None = None, shapes: collections.abc.Sequence[LinkShape] = []) -> Robot:
        """
        This robot with one more fixed link.
        """
    @property
    def base(self) -> str:
        """
        fixed, diff_drive or omni.
        """
    @property
    def base_limits(self) -> dict[str, float]:
        """
        Speed and acceleration limits of the base, its workspace and its wheels, by keyword of `load`'s base_limits.
        """
    @property
    def disabled_pairs(self) -> list[tuple[str, str, str]]:
        """
        Link pairs that need no collision check: (a, b, reason).
        """
    @property
    def end_effectors(self) -> list[mmgrasp.records.EndEffectorRow]:
        """
        SRDF end effectors: name, group and parent_link.
        """
    @property
    def group_links(self) -> dict[str, list[str]]:
        """
        SRDF group to its links: those that its joints, fixed ones too, and the joints that mimic them carry.
        """
    @property
    def group_states(self) -> dict[str, dict[str, dict[str, float]]]:
        """
        SRDF states: group, state, joint to value. Joints with several values appear as joint/x, joint/y, ...
        """
    @property
    def groups(self) -> dict[str, mmgrasp.records.GroupRow]:
        """
        SRDF groups: name to joints, base_link, tip_link.
        """
    @property
    def has_srdf(self) -> bool:
        """
        An SRDF was given.
        """
    @property
    def hash(self) -> str:
        """
        Content hash: kinematics, shapes, limits, disabled pairs.
        """
    @property
    def joint_table(self) -> list[mmgrasp.records.JointRow]:
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
        """
        As the URDF says.
        """
    @property
    def passive_joints(self) -> list[str]:
        """
        Joints that nothing drives (SRDF passive_joint): in no group.
        """
    @property
    def report(self) -> mmgrasp.records.RobotReport:
        """
        What loading found.
        """
    @property
    def source(self) -> RobotSource:
        """
        The URDFs and links that it was made of.
        """
class JointGroup:
    """
    Joints that are planned together, and a tip: where configurations, limits and kinematics are. Immutable.
    
        q = arm.q({"elbow_joint": 1.2})
        T_world_tip = arm.fk(q)
        found = arm.ik(T_world_tip, seed=q)
        if found.outcome == mg.Outcome.solved:
            print(found.q, found.position_error)
    
    Configurations are arrays (n,): base joints x, y, theta first when the group has them (`with_base=True`), then the chain in
    order. All other joints stay at the group's reference values.
    """
    def __copy__(self) -> JointGroup:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> JointGroup:
        ...
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
    def ik(self, T_world_tip: numpy.typing.ArrayLike, seed: numpy.typing.ArrayLike | None = None, world: World | None = None, *, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, max_iterations: int = 60, restarts: int = 30, time_limit: float = 1.0, rng_seed: int = 1, joint_weights: numpy.typing.ArrayLike | None = [], objectives: collections.abc.Sequence[IkObjective] = [], objective_iterations: int = 50) -> IkResult:
        """
        Inverse kinematics from `seed` (default: middle of the limits), then random restarts. With a world the answer is
        free of collisions with it and of self-collision; without one, collisions are not checked.
        
        Keyword options:
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            max_iterations: int = 60  # per descent
            restarts: int = 30  # random restarts after the seed
            time_limit: float = 1.0  # wall-clock cap [s]
            rng_seed: int = 1  # same seed, same answer
            joint_weights: numpy.typing.ArrayLike | None = []  # cost of moving each joint, > 0; empty: all the same
            objectives: collections.abc.Sequence[IkObjective] = []  # costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations: int = 50  # steps along the solutions
        """
    def ik_all(self, T_world_tip: numpy.typing.ArrayLike, count: int = 16, world: World | None = None, all_turns: bool = False, *, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, max_iterations: int = 60, restarts: int = 30, time_limit: float = 1.0, rng_seed: int = 1, joint_weights: numpy.typing.ArrayLike | None = [], objectives: collections.abc.Sequence[IkObjective] = [], objective_iterations: int = 50) -> numpy.typing.NDArray[numpy.float64]:
        """
        Up to `count` solutions (k, n), the first ones farthest apart; ik_branches tells why others fell. They are
        arm postures, in one turn each; `all_turns` gives each of them in every whole turn within limits.
        
        Keyword options:
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            max_iterations: int = 60  # per descent
            restarts: int = 30  # random restarts after the seed
            time_limit: float = 1.0  # wall-clock cap [s]
            rng_seed: int = 1  # same seed, same answer
            joint_weights: numpy.typing.ArrayLike | None = []  # cost of moving each joint, > 0; empty: all the same
            objectives: collections.abc.Sequence[IkObjective] = []  # costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations: int = 50  # steps along the solutions
        """
    def ik_branches(self, T_world_tip: numpy.typing.ArrayLike, world: World | None = None, redundant_values: int = 0, all_turns: bool = False, *, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, max_iterations: int = 60, restarts: int = 30, time_limit: float = 1.0, rng_seed: int = 1, joint_weights: numpy.typing.ArrayLike | None = [], objectives: collections.abc.Sequence[IkObjective] = [], objective_iterations: int = 50) -> IkBranches:
        """
        Every branch of an arm of six turning joints, and of one of seven for `redundant_values` values of its
        redundant joint (0: 24); random descents search where no closed form fits. With a world, free ones only.
        A branch is an arm posture: joints whose limits leave more than one turn stand in the one nearest to the
        middle. `all_turns` lists every whole turn within limits, one branch after the other, of each the turns
        nearest to the middle first; up to 64 a branch where six joints have two turns.
        
        Keyword options:
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            max_iterations: int = 60  # per descent
            restarts: int = 30  # random restarts after the seed
            time_limit: float = 1.0  # wall-clock cap [s]
            rng_seed: int = 1  # same seed, same answer
            joint_weights: numpy.typing.ArrayLike | None = []  # cost of moving each joint, > 0; empty: all the same
            objectives: collections.abc.Sequence[IkObjective] = []  # costs (IkObjective) that the redundancy lowers once the pose is reached
            objective_iterations: int = 50  # steps along the solutions
        """
    def jacobian(self, q: numpy.typing.ArrayLike, link: str | None = None, point: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6, n), world-aligned: linear rows [m/rad, m/m], then angular. At the tip's origin, or at `point` [m] in the frame of
        `link` (default: the tip; point (0, 0, 0)), which moves with it. Columns of joints that do not move it are zero.
        """
    def jacobian_batch(self, Q: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 6, n) at the tip's origin, for configurations (m, n).
        """
    def link_poses(self, q: numpy.typing.ArrayLike) -> dict[str, numpy.typing.NDArray[numpy.float64]]:
        """
        World pose (4, 4) of every link of the robot.
        """
    def manipulability(self, q: numpy.typing.ArrayLike) -> float:
        """
        sqrt(det(J J^T)) (Yoshikawa): 0 at singularities, and for groups of fewer than six joints.
        """
    def manipulability_batch(self, Q: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m,) for configurations (m, n).
        """
    def q(self, values: collections.abc.Mapping[str, float], base: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        A configuration (n,) from values by joint name [rad or m]. What is not named is as in `base` (n,), or as the group
        holds its robot (0 for base joints). Raises InvalidInput for names it does not have, with the nearest.
        """
    def state(self, name: str, base: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]:
        """
        The SRDF's group state of this name as a configuration (n,); `base` as in q(). Raises InvalidInput, listing the
        states there are, for others.
        """
    def velocity_manipulability(self, q: numpy.typing.ArrayLike, direction: numpy.typing.ArrayLike) -> float:
        """
        Length of the velocity ellipsoid along a direction (P2 equation 3.2): (3,) translation or (6,) twist, world-aligned.
        0 where the tool cannot move along it.
        """
    def with_acceleration_limits(self, limits: numpy.typing.ArrayLike) -> JointGroup:
        """
        The same group with these limits (n,) [rad/s^2 or m/s^2], > 0.
        """
    def with_reference(self, joints: collections.abc.Mapping[str, float]) -> JointGroup:
        """
        The same group with the named other joints held at these values, the rest at default.
        """
    def within_limits(self, q: numpy.typing.ArrayLike, slack: float = 0.0) -> bool:
        """
        Whether a configuration (n,) lies inside the limits, each widened by `slack` [rad or m].
        """
    @property
    def T_world_root(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the robot's root (4, 4); with the base in the group its joints come on top.
        """
    @property
    def acceleration_limits(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [rad/s^2 or m/s^2]; URDF has none: 4 times the velocity limit per second unless set.
        """
    @property
    def has_base(self) -> bool:
        """
        x, y, theta come first.
        """
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [rad or m], -inf for continuous joints.
        """
    @property
    def name(self) -> str:
        """
        Name of the SRDF group, or of the chain.
        """
    @property
    def names(self) -> list[str]:
        """
        Names of the columns: joints, with x, y, theta first when the group has the base. A planar joint has three, "<joint>/x", "/y", "/theta"; a floating one six, "/x", "/y", "/z", "/rx", "/ry", "/rz" (a rotation vector).
        """
    @property
    def robot(self) -> Robot:
        """
        The robot it belongs to.
        """
    @property
    def sample_lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Finite bounds to sample from.
        """
    @property
    def sample_upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Upper end of the finite bounds to sample from (n,).
        """
    @property
    def size(self) -> int:
        """
        Number of columns of a configuration.
        """
    @property
    def tip(self) -> str:
        """
        Link whose pose fk() and ik() are about.
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [rad or m], inf for continuous joints.
        """
    @property
    def velocity_limits(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [rad/s or m/s].
        """
class World:
    """
    What stands around the robot and what it holds: named rigid bodies, and who may touch whom. Poses are
    T_world_object, (4, 4).
    
        world = mg.World()
        world.add_box("table", size=(1.2, 0.6, 0.04), pose=mg.pose([1.0, 0, 0.7]))
        world.add("cup", mg.Cylinder(0.04, 0.1), mg.pose([1.0, 0, 0.775]))
        world.allow("cup", "table")
        world.attach("cup", "gripper_link", mg.pose([0.1, 0, 0]))  # from now on it moves with the link
    
    A checker or planner keeps the world that it was given: later changes do not reach it.
    """
    def __contains__(self, arg0: str) -> bool:
        ...
    def __copy__(self) -> World:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> World:
        ...
    def __init__(self) -> None:
        """
        An empty world.
        """
    def __repr__(self) -> str:
        ...
    def add(self, name: str, shape: Box | Sphere | Cylinder | Capsule | Plane | Mesh | Voxels | collections.abc.Sequence[LinkShape], pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        A shape, or a list of LinkShape as one body.
        """
    def add_box(self, name: str, size: numpy.typing.ArrayLike, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Full lengths [m], centred.
        """
    def add_cylinder(self, name: str, radius: float, length: float, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Along z, centred [m].
        """
    def add_field(self, name: str, field: DistanceField, pose: numpy.typing.ArrayLike | None = None, *, resolution: float = 0.001, unknown_is_free: bool = False) -> None:
        """
        What a distance field holds, at T_world_field (4, 4): a mesh's or a grid's; maps of cameras by add_sdf. A body is
        free only where the field proves it, and is called so when it is farther away than twice the field's error and
        `resolution` [m].
        """
    def add_floor(self, group: JointGroup, height: float = 0.0) -> None:
        """
        Level ground, the object "floor": everything below z = `height` [m] is solid, without an end. What the joints of
        `group` move (but a base's x, y and theta) must keep off it, and so must what is attached; all other links may touch
        it: wheels stand on it, and no configuration brings these links nearer. Raises InvalidInput when the name is in use
        or `height` is not finite.
        """
    def add_mesh(self, name: str, path: str | os.PathLike[str], pose: numpy.typing.ArrayLike | None = None, scale: numpy.typing.ArrayLike = 1.0) -> None:
        """
        STL, OBJ, DAE or PLY; closed meshes are solids, open ones surfaces.
        """
    def add_occupancy(self, name: str, occupancy: OccupancyMap, unknown: typing.Literal['free', 'occupied'] = 'free', *, bounds: numpy.typing.ArrayLike | None = None, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        The occupied cells of an octree as solid voxels; with `unknown="occupied"` also those that no ray passed,
        within `bounds` (2, 3) (lower, upper corner [m]; default: those of what is known). Later frames do not
        change the object. Raises InvalidInput when there is no such cell.
        """
    def add_octree(self, name: str, path: str | os.PathLike[str], pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Occupied leaves of an OctoMap file (.bt or .ot) as solid voxels.
        """
    def add_points(self, name: str, points: numpy.typing.ArrayLike, resolution: float, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Points (m, 3) as the solid cells of edge `resolution` [m] that hold one.
        """
    def add_sdf(self, name: str, sdf: ProbabilisticSdf, sigmas: float = 2.0, unknown: typing.Literal['free', 'occupied'] = 'free', *, bounds: numpy.typing.ArrayLike | None = None, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        The surfaces of a map as solid cells of its voxels' lattice: wherever mean - sigmas * sigma may be zero or
        less, what is known behind, and what these enclose. Later frames do not change the object. With
        `unknown="occupied"` all of `bounds` (2, 3) (lower, upper corner [m]; default: the map's) that is not
        known to be in front of a surface, which a map knows only about two voxels deep: for what cameras looked
        through see add_occupancy(). Raises InvalidInput when nothing is occupied.
        """
    def add_sphere(self, name: str, radius: float, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Centred; `radius` [m].
        """
    def allow(self, a: str, b: str) -> None:
        """
        The two may touch: they are not checked against each other. Each is a link of the robot, an SRDF group (all its
        links) or an object, attached or not. The pair may come before its objects; a checker raises InvalidInput for names
        that robot and world lack. remove() takes the pairs of its object back.
        """
    def attach(self, name: str, link: str, pose: numpy.typing.ArrayLike | None = None, touch_links: collections.abc.Set[str] = set()) -> None:
        """
        From the scene to a link, at T_link_object. Empty touch_links: the link, all below it, and its gripper's fingers.
        """
    def copy(self) -> World:
        """
        A world of its own with the same bodies.
        """
    def detach(self, name: str, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Puts an attached object back into the scene at T_world_object; without a pose it leaves the world.
        """
    def disallow(self, a: str, b: str) -> None:
        """
        Takes a pair of allow() back. Raises InvalidInput unless it is there.
        """
    def forget(self, name: str) -> None:
        """
        Takes back what allow() and padding said about a name.
        """
    def move(self, name: str, pose: numpy.typing.ArrayLike) -> None:
        """
        Puts an object or a field of the scene at T_world_object (4, 4).
        """
    def pose_of(self, name: str) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_world_object (4, 4) of an object of the scene. Raises InvalidInput on any other name.
        """
    def remove(self, name: str) -> None:
        """
        Takes an object, attached or not, or a field out of the world.
        """
    def shapes_of(self, name: str) -> list[LinkShape]:
        """
        Shapes of an object, attached or not, in its own frame.
        """
    @property
    def allowed(self) -> list[tuple[str, str]]:
        """
        The pairs that may touch, as given to allow(), sorted.
        """
    @property
    def attached(self) -> list[str]:
        """
        Names of the attached objects.
        """
    @property
    def fields(self) -> list[str]:
        """
        Names of the distance fields.
        """
    @property
    def objects(self) -> list[str]:
        """
        Names of the scene's objects.
        """
    @property
    def padding(self) -> mmgrasp.records.WorldPadding:
        """
        How far bodies are grown where the robot (with what it holds) meets the scene [m]; never within the robot. A
        number is for all links; a dict has the keys `links`, `attached`, `objects` and `by_name` (link, object or
        SRDF group to its own padding, in place of the others).
        """
    @padding.setter
    def padding(self, arg1: float | mmgrasp.records.WorldPadding | collections.abc.Mapping[str, float | collections.abc.Mapping[str, float]]) -> None:
        ...
class Outcome(enum.Enum):
    """
    How a query ended. "No solution" is a value, not an exception.
    """
    approximate = 1
    infeasible = 2
    invalid_goal = 7
    invalid_start = 6
    not_found = 3
    solved = 0
    stopped = 5
    timeout = 4
class Rejection(enum.Enum):
    """
    Why one candidate was rejected.
    """
    grasp_filter = 5
    limits = 2
    none = 0
    scene = 4
    self_collision = 3
    unreachable = 1
class Rejections:
    """
    How many candidates fell at which filter.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def grasp_filter(self) -> int:
        """
        Rejected before inverse kinematics.
        """
    @property
    def limits(self) -> int:
        """
        Reached only outside joint limits.
        """
    @property
    def scene(self) -> int:
        """
        Reached, but the robot, or what is attached to it, hits the scene.
        """
    @property
    def self_collision(self) -> int:
        """
        Reached, but robot hits robot or what it holds.
        """
    @property
    def total(self) -> int:
        """
        Over all filters.
        """
    @property
    def unreachable(self) -> int:
        """
        No arm configuration reaches the pose.
        """
class Box:
    """
    A box, centred; full lengths [m].
    """
    def __init__(self, size: numpy.typing.ArrayLike) -> None:
        """
        `size` (3,): full lengths along x, y, z [m], > 0.
        """
    def __repr__(self) -> str:
        ...
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Full lengths (3,) [m].
        """
class Sphere:
    """
    A sphere [m].
    """
    def __init__(self, radius: float) -> None:
        """
        `radius` [m], > 0.
        """
    def __repr__(self) -> str:
        ...
    @property
    def radius(self) -> float:
        """
        [m]
        """
class Cylinder:
    """
    A cylinder along z, centred [m].
    """
    def __init__(self, radius: float, length: float) -> None:
        """
        `radius` and `length` along z [m], > 0.
        """
    def __repr__(self) -> str:
        ...
    @property
    def length(self) -> float:
        """
        Along z [m].
        """
    @property
    def radius(self) -> float:
        """
        [m]
        """
class Capsule:
    """
    A capsule along z, centred; `length` without the caps [m].
    """
    def __init__(self, radius: float, length: float) -> None:
        """
        `radius` and `length` (without the caps) [m], > 0.
        """
    def __repr__(self) -> str:
        ...
    @property
    def length(self) -> float:
        """
        Length without the caps [m].
        """
    @property
    def radius(self) -> float:
        """
        [m]
        """
class Plane:
    """
    A half space: solid where normal . x <= offset.
    """
    def __init__(self, normal: numpy.typing.ArrayLike, offset: float) -> None:
        """
        Solid where normal . x <= offset; `normal` (3,) is a unit vector, `offset` [m].
        """
    def __repr__(self) -> str:
        ...
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit normal (3,), out of the solid.
        """
    @property
    def offset(self) -> float:
        """
        normal . x = offset on the surface [m].
        """
class Voxels:
    """
    Axis-aligned solid voxels of one edge length [m].
    """
    def __init__(self, centres: numpy.typing.ArrayLike, resolution: float) -> None:
        """
        `centres` (m, 3) of cubes with edge `resolution` [m], > 0.
        """
    def __repr__(self) -> str:
        ...
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 3) [m].
        """
    @property
    def resolution(self) -> float:
        """
        Edge of a voxel [m].
        """
class Mesh:
    """
    A triangle mesh [m]; closed ones are solids, open ones surfaces.
    
        mesh = mg.Mesh.load("bracket.stl", scale=0.001)
        mesh.closed, len(mesh.triangles)
    """
    @staticmethod
    def from_arrays(vertices: numpy.typing.ArrayLike, triangles: numpy.typing.ArrayLike) -> Mesh:
        """
        From vertices (n, 3) [m] and their numbers (m, 3), cleaned as a file's: equal vertices merge, triangles without area go, closed meshes are turned outwards. Raises InvalidInput for numbers out of range.
        """
    @staticmethod
    def load(path: str | os.PathLike[str], scale: numpy.typing.ArrayLike = 1.0) -> Mesh:
        """
        Reads STL, OBJ, DAE or PLY. `scale` is a number or one per axis. Raises IoError naming file and place.
        """
    def __copy__(self) -> Mesh:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> Mesh:
        ...
    def __repr__(self) -> str:
        ...
    @property
    def closed(self) -> bool:
        """
        A solid; open meshes are surfaces.
        """
    @property
    def convex(self) -> bool:
        """
        Closed and convex.
        """
    @property
    def source(self) -> str:
        """
        File it was read from.
        """
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
    def mesh(path: str | os.PathLike[str], scale: numpy.typing.ArrayLike = 1.0, pose: numpy.typing.ArrayLike | None = None) -> LinkShape:
        """
        A mesh read from a file, which is remembered so that robots and plans can be written out.
        """
    def __init__(self, shape: Box | Sphere | Cylinder | Capsule | Plane | Mesh | Voxels, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        `shape` at `pose` (4, 4) in the body's frame, default: the identity.
        """
    def __repr__(self) -> str:
        ...
    def surface(self, segments: int = 24) -> Mesh:
        """
        Its surface as triangles in the shape's own frame, for pictures.
        """
    @property
    def bounds(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Lower and upper corner of its axis-aligned box in the body frame [m].
        """
    @property
    def kind(self) -> str:
        """
        box, sphere, cylinder, capsule, plane, mesh or voxels.
        """
    @property
    def mesh_path(self) -> str:
        """
        File of a mesh; empty for other shapes.
        """
    @property
    def mesh_scale(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Scale of the file along its axes (3,).
        """
    @property
    def pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the shape in the body's frame (4, 4).
        """
    @property
    def shape(self) -> Box | Sphere | Cylinder | Capsule | Plane | Mesh | Voxels:
        """
        The shape itself.
        """
class DistanceField:
    """
    Signed distance from the surface of a body, in the field's own frame: negative inside, NaN where unknown [m].
    """
    def distances(self, points: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        Signed distances (m,) of `points` (m, 3) [m].
        """
    def distances_and_gradients(self, points: numpy.typing.ArrayLike) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        The same with the unit directions (m, 3) along which they grow fastest; zero where unknown.
        """
    @property
    def domain(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Least and largest corner (2, 3) of the box in which it knows anything [m]; infinite: everywhere.
        """
    @property
    def error(self) -> float:
        """
        How far a distance may be off [m].
        """
    @property
    def truncation(self) -> float:
        """
        Distances are clipped to this [m].
        """
class MeshDistanceField(DistanceField):
    """
    The exact distance from a closed mesh, negative inside.
    
        field = mg.collision.MeshDistanceField(mesh)
        world.add_field("statue", field, mg.pose([2.0, 1.0, 0.0]))
    """
    def __init__(self, mesh: Mesh) -> None:
        """
        Raises InvalidInput for a mesh that is not closed.
        """
class GridDistanceField(DistanceField):
    """
    Signed distances at the points of a regular grid, interpolated linearly along each axis between them.
    
        x = np.linspace(-0.5, 0.5, 21)
        values = np.linalg.norm(np.stack(np.meshgrid(x, x, x, indexing="ij")), axis=0) - 0.3  # a sphere
        field = mg.collision.GridDistanceField(values, [-0.5, -0.5, -0.5], 0.05)
        field.distances([[0.0, 0.0, 0.4]])
    """
    def __init__(self, values: numpy.typing.ArrayLike, origin: numpy.typing.ArrayLike, spacing: float, *, error: float = 0.0, truncation: float = ...) -> None:
        """
        `values` (nx, ny, nz) [m], NaN where unknown: [i, j, k] is the distance at origin + spacing (i, j, k). `error`
        of the values [m]; the field's own error adds sqrt(3) / 2 of the spacing, the most by which what lies between can
        be off.
        """
class DerivativeFreeResult:
    """
    What a search by values alone found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name.
        """
    @property
    def evaluations(self) -> int:
        """
        Points at which the functions were called.
        """
    @property
    def message(self) -> str:
        """
        How the solver itself put it.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: converged, constraints kept; `timeout`: the budget or the time limit ended it.
        """
    @property
    def seconds(self) -> float:
        """
        Wall-clock time [s].
        """
    @property
    def value(self) -> float:
        """
        Objective at x.
        """
    @property
    def violation(self) -> float:
        """
        Largest c_i(x), or 0.
        """
    @property
    def x(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The best point seen: the least violated, then the cheapest; inside the bounds.
        """
class SetCoverResult:
    """
    What solve_set_cover found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def chosen(self) -> list[int]:
        """
        Indices of the chosen sets, ascending.
        """
    @property
    def cost(self) -> float:
        """
        Sum over the chosen sets.
        """
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
    """
    What shortest_visiting_tour found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def length(self) -> float:
        """
        Length of the tour from start over all stops to the goal.
        """
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
        """
        `solved` with a proof of the shortest, `approximate` without.
        """
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
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def durations(self) -> list[float]:
        """
        One a robot; 0 when it stays.
        """
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
        """
        `solved`: proven least; `approximate`: a good one with a bound.
        """
class PairwiseWeights:
    """
    Weights from pairwise comparisons (Saaty's AHP; P2 3.3.2).
    """
    def __repr__(self) -> str:
        ...
    @property
    def consistency_ratio(self) -> float:
        """
        Saaty's consistency ratio; 0: fully consistent.
        """
    @property
    def eigenvector(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The principal eigenvector, Saaty's own; it sums to 1.
        """
    @property
    def largest_eigenvalue(self) -> float:
        """
        m for a consistent matrix, else more.
        """
    @property
    def weights(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Averages over normalised columns, as P2 takes them; they sum to 1.
        """
class RobotSource:
    """
    What a robot was made of, unread: its URDFs as they were given, for those who read them by
    other means than Robot does (verify).
    """
    def __init__(self, base: str = 'fixed', *, base_limits: collections.abc.Mapping[str, float | None] | None = None, srdf: str = '') -> None:
        """
        Empty; add_urdf() adds what it was made of.
        """
    def add_link(self, name: str, parent_link: str, T: numpy.typing.ArrayLike | None = None, shapes: collections.abc.Sequence[LinkShape] = []) -> None:
        """
        A fixed link that comes from no URDF.
        """
    def add_urdf(self, urdf: str, *, origin: str = '<string>', prefix: str = '', parent_link: str = '', T: numpy.typing.ArrayLike | None = None, mesh_files: collections.abc.Mapping[str, str] = {}) -> None:
        """
        A URDF's text. Every name in it gets the prefix; its root link hangs at T on `parent_link` (empty: it is the
        robot's root). `mesh_files` maps the URDF's mesh filenames to files; an empty one leaves the mesh out.
        """
    @property
    def added_links(self) -> list[mmgrasp.records.AddedLinkRow]:
        """
        As dicts with the arguments of add_link.
        """
    @property
    def urdfs(self) -> list[mmgrasp.records.UrdfRow]:
        """
        As dicts with the arguments of add_urdf.
        """
class IkResult:
    """
    Answer of inverse kinematics.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def iterations(self) -> int:
        """
        Steps of all descents.
        """
    @property
    def objective(self) -> float:
        """
        Sum of the objectives' costs at q.
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def position_error(self) -> float:
        """
        [m] of q, or of the best attempt.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        The configuration, inside limits and checked by forward kinematics; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        """
        What the descents ended at: reach, limits or collisions.
        """
    @property
    def rotation_error(self) -> float:
        """
        [rad]
        """
class IkBranches:
    """
    Every arm configuration found for a pose, and why others were rejected.
    """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        Branches rejected, by cause.
        """
    @property
    def solutions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n), inside limits and checked; the first ones as different from each other as can be.
        """
class JointTrajectory:
    """
    A path on a clock; cubic Hermite between samples.
    
        motion = mg.time_parameterize(path, arm.velocity_limits, arm.acceleration_limits, names=arm.names)
        q = motion.at(motion.duration / 2)
        motion.to_csv()
    """
    def __init__(self, names: collections.abc.Sequence[str], times: numpy.typing.ArrayLike, positions: numpy.typing.ArrayLike, velocities: numpy.typing.ArrayLike | None = None, accelerations: numpy.typing.ArrayLike | None = None) -> None:
        """
        From samples: times (k,) from 0 and increasing [s], positions (k, n), and if given velocities and accelerations
        (k, n). Without velocities the samples are joined by straight lines.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Configuration (n,) at a time [s], clamped at the ends.
        """
    def to_csv(self, base_pose: numpy.typing.ArrayLike | None = None) -> str:
        """
        Header time, names, name.velocity, ...; one line a sample. With base_pose (x, y, theta) of the standing base, as
        RobotMotion writes it.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    def to_joint_trajectory(self, base_pose: numpy.typing.ArrayLike | None = None) -> mmgrasp.records.MotionMessage:
        """
        RobotMotion's message: columns x, y, theta in front are the base's; without them it stands at base_pose.
        """
    @property
    def accelerations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n) [rad/s^2 or m/s^2]; (0, 0) when not known.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def names(self) -> list[str]:
        """
        One a column.
        """
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
        """
        (k, n) [rad/s or m/s]; (0, 0) when not known.
        """
class Contact:
    """
    Two bodies that touch.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def a(self) -> str:
        """
        A robot link or an attached object.
        """
    @property
    def b(self) -> str:
        """
        A robot link, an attached object or an object of the scene.
        """
    @property
    def by_padding(self) -> bool:
        """
        The bodies stay apart: only their padding meets.
        """
    @property
    def with_scene(self) -> bool:
        """
        `b` is an object of the scene.
        """
class DistanceResult:
    """
    The smallest distance and where it is.
    """
    def __float__(self) -> float:
        ...
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def a(self) -> str:
        """
        One body of the closest pair: a robot link or an attached object.
        """
    @property
    def b(self) -> str:
        """
        The other body: a robot link, an attached object or an object of the scene.
        """
    @property
    def gradient(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        d value / d q, (n,); None unless it was asked for.
        """
    @property
    def point_a(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) in the world frame.
        """
    @property
    def point_b(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The closest point on `b` (3,) in the world frame [m].
        """
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
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def checks(self) -> int:
        """
        Configurations checked.
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
        """
        The whole edge is free.
        """
class CollisionChecker:
    """
    Collision questions about one group in a snapshot of the world: later changes of the world are not seen.
    
        checker = mg.CollisionChecker(robot, world, arm)
        if checker.is_free(q) and checker.edge_is_free(q, q_goal):
            print(checker.distance(q).value)
    
    Pairs of links are sampled (and cached) when no SRDF says which never touch.
    """
    def __init__(self, robot: Robot, world: World, group: JointGroup, *, padding: float = 0.0, check_self: bool = True, check_scene: bool = True, attached_only: bool = False) -> None:
        """
        For configurations of `group` of `robot` in `world` as it is now.
        
        Keyword options:
            padding: float = 0.0  # links are padded by at least this against the scene, whatever the world's padding [m]
            check_self: bool = True  # robot (and what it holds) against itself
            check_scene: bool = True  # robot (and what it holds) against the scene
            attached_only: bool = False  # only what it holds, against the robot and the scene
        """
    def __repr__(self) -> str:
        ...
    def are_free(self, Q: numpy.typing.ArrayLike, threads: int = 0) -> numpy.typing.NDArray[numpy.bool]:
        """
        is_free of each row of Q (m, n), as (m,) booleans; 0 threads: all.
        """
    def check_edge(self, q0: numpy.typing.ArrayLike, q1: numpy.typing.ArrayLike, *, joint_step: float = 0.02, workspace_step: float = ..., continuous: bool = False, tolerance: float = 0.0001) -> EdgeResult:
        """
        The straight joint-space edge with what refuses it: in steps, or by conservative advancement.
        
        Keyword options:
            joint_step: float = 0.02  # no joint moves more than this between two checks [rad or m]
            workspace_step: float = inf  # no point moves more than this between two checks [m]
            continuous: bool = False  # conservative advancement instead of steps
            tolerance: float = 0.0001  # continuous only: gaps below this count as contact [m]
        """
    def clone(self) -> CollisionChecker:
        """
        The same checker with scratch of its own, for another thread.
        """
    def contacts(self, q: numpy.typing.ArrayLike) -> list[Contact]:
        """
        Every touching pair; limits are not checked.
        """
    def distance(self, q: numpy.typing.ArrayLike, gradient: bool = False) -> DistanceResult:
        """
        Smallest signed distance over all checked pairs, padding not subtracted; with `gradient` also d value / d q.
        Infinite when there is no pair.
        """
    def distances(self, q: numpy.typing.ArrayLike, within: float) -> list[DistanceResult]:
        """
        Every pair of bodies nearer than `within` [m], nearest first, each with its gradient.
        """
    def edge_is_free(self, q0: numpy.typing.ArrayLike, q1: numpy.typing.ArrayLike, joint_step: float = 0.02) -> bool:
        """
        The straight joint-space edge, checked so finely that no joint moves more than `joint_step` [rad or m].
        """
    def first_contact(self, q: numpy.typing.ArrayLike) -> Contact | None:
        """
        One touching pair, self before scene, or None; limits are not checked.
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
        """
        The group whose configurations it checks.
        """
    @property
    def motion_bounds(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) bounds on how far any point moves when a joint moves by one unit [m/rad or m/m].
        """
class _PlacedBodies:
    """
    Shapes where they are at one time, one T_world_body (4, 4) a shape.
    """
    def __init__(self, shapes: collections.abc.Sequence[LinkShape], T_world_body: numpy.typing.ArrayLike) -> None:
        ...
    def distance(self, other: _PlacedBodies, within: float) -> float:
        ...
class IkObjective:
    """
    A cost of configurations that inverse kinematics lowers with the freedom that the pose leaves: pass a list as ik(..., objectives=[...]).
    """
    def __repr__(self) -> str:
        ...
    def evaluate(self, q: numpy.typing.ArrayLike) -> tuple[float, numpy.typing.NDArray[numpy.float64]]:
        """
        (cost, gradient (n,)).
        """
    @property
    def name(self) -> str:
        """
        Which objective it is.
        """
class ReachDatabase:
    """
    Sampled arm configurations free of self-collision, in cells of the tool pose (P1 3.2.1): good first guesses for
    inverse kinematics, and quick answers to "out of reach".
    
        database = mg.ReachDatabase.build(arm, samples=100_000)
        database.save("reach")
        guesses = database.query(T_base_tip)  # (m, n), m = 0: out of reach
    """
    @staticmethod
    def build(arm: JointGroup, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 2000000, position_cell: float = 0.1, rotation_cell: float = 0.55, max_per_cell: int = 16, min_manipulability: float = 0.02, thinning: float = 0.0, seed: int = 1, threads: int = 0) -> ReachDatabase:
        """
        Samples the arm. `progress` is called with (stage, fraction).
        
        Keyword options:
            samples: int = 2000000  # arm configurations drawn
            position_cell: float = 0.1  # edge of a position cell [m]
            rotation_cell: float = 0.55  # approximate diameter of a rotation cell [rad]
            max_per_cell: int = 16  # configurations kept in a cell
            min_manipulability: float = 0.02  # least manipulability kept, as a fraction of the largest
            thinning: float = 0.0  # below this fraction of the largest manipulability kept by chance; 0: all
            seed: int = 1  # same seed, same database
            threads: int = 0  # 0: all; does not change the answer
        """
    @staticmethod
    def build_parts(folder: str | os.PathLike[str], arm: JointGroup, parts: collections.abc.Sequence[int], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 2000000, position_cell: float = 0.1, rotation_cell: float = 0.55, max_per_cell: int = 16, min_manipulability: float = 0.02, thinning: float = 0.0, seed: int = 1, threads: int = 0) -> bool:
        """
        Draws single parts into a folder; in `path`.partial they are what build_to(path, ...) goes on from.
        
        Keyword options:
            samples: int = 2000000  # arm configurations drawn
            position_cell: float = 0.1  # edge of a position cell [m]
            rotation_cell: float = 0.55  # approximate diameter of a rotation cell [rad]
            max_per_cell: int = 16  # configurations kept in a cell
            min_manipulability: float = 0.02  # least manipulability kept, as a fraction of the largest
            thinning: float = 0.0  # below this fraction of the largest manipulability kept by chance; 0: all
            seed: int = 1  # same seed, same database
            threads: int = 0  # 0: all; does not change the answer
        """
    @staticmethod
    def build_to(path: str | os.PathLike[str], arm: JointGroup, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 2000000, position_cell: float = 0.1, rotation_cell: float = 0.55, max_per_cell: int = 16, min_manipulability: float = 0.02, thinning: float = 0.0, seed: int = 1, threads: int = 0) -> ReachDatabase:
        """
        Builds through files into a folder; interrupted and called again, it goes on where it was.
        
        Keyword options:
            samples: int = 2000000  # arm configurations drawn
            position_cell: float = 0.1  # edge of a position cell [m]
            rotation_cell: float = 0.55  # approximate diameter of a rotation cell [rad]
            max_per_cell: int = 16  # configurations kept in a cell
            min_manipulability: float = 0.02  # least manipulability kept, as a fraction of the largest
            thinning: float = 0.0  # below this fraction of the largest manipulability kept by chance; 0: all
            seed: int = 1  # same seed, same database
            threads: int = 0  # 0: all; does not change the answer
        """
    @staticmethod
    def load(path: str | os.PathLike[str], arm: JointGroup | None = None) -> ReachDatabase:
        """
        Raises IoError on a truncated, foreign or corrupt database, and on one built for another arm than `arm`.
        """
    @staticmethod
    def load_or_build(arm: JointGroup, cache_dir: str | os.PathLike[str], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 2000000, position_cell: float = 0.1, rotation_cell: float = 0.55, max_per_cell: int = 16, min_manipulability: float = 0.02, thinning: float = 0.0, seed: int = 1, threads: int = 0) -> ReachDatabase:
        """
        The database of this arm and these options from the cache folder; built and stored when it is not there. One that is damaged is built anew in its place, which `progress` hears as the stage 'replacing a damaged reachability database'.
        
        Keyword options:
            samples: int = 2000000  # arm configurations drawn
            position_cell: float = 0.1  # edge of a position cell [m]
            rotation_cell: float = 0.55  # approximate diameter of a rotation cell [rad]
            max_per_cell: int = 16  # configurations kept in a cell
            min_manipulability: float = 0.02  # least manipulability kept, as a fraction of the largest
            thinning: float = 0.0  # below this fraction of the largest manipulability kept by chance; 0: all
            seed: int = 1  # same seed, same database
            threads: int = 0  # 0: all; does not change the answer
        """
    @staticmethod
    def part_count(arm: JointGroup, *, samples: int = 2000000, position_cell: float = 0.1, rotation_cell: float = 0.55, max_per_cell: int = 16, min_manipulability: float = 0.02, thinning: float = 0.0, seed: int = 1, threads: int = 0) -> int:
        """
        Into how many parts build_to divides a build with these options.
        
        Keyword options:
            samples: int = 2000000  # arm configurations drawn
            position_cell: float = 0.1  # edge of a position cell [m]
            rotation_cell: float = 0.55  # approximate diameter of a rotation cell [rad]
            max_per_cell: int = 16  # configurations kept in a cell
            min_manipulability: float = 0.02  # least manipulability kept, as a fraction of the largest
            thinning: float = 0.0  # below this fraction of the largest manipulability kept by chance; 0: all
            seed: int = 1  # same seed, same database
            threads: int = 0  # 0: all; does not change the answer
        """
    def __copy__(self) -> ReachDatabase:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> ReachDatabase:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def base_poses_for(self, arm: JointGroup, T_world_tip: numpy.typing.ArrayLike, *, count: int = 32, checker: CollisionChecker | None = None, step: float = 0.05, headings: int = 24, candidates: int = 64, seeds: int = 8, refinements: int = 4, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, threads: int = 0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Base poses (k, 3) on the floor from which the tool reaches a pose in the world, and the configurations (k, n) that do.
        
        Keyword options:
            step: float = 0.05  # grid of base positions [m]
            headings: int = 24  # of the base, evenly over the circle
            candidates: int = 64  # best base poses of the grid checked exactly
            seeds: int = 8  # stored configurations tried for a target
            refinements: int = 4  # rounds of smaller steps about the best
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            threads: int = 0  # 0: all; does not change the answer
        """
    def difference(self, arm: JointGroup) -> str:
        """
        What of the arm has changed since the build, in words; empty when nothing.
        """
    def find_base_placement(self, arm: JointGroup, T_world_tips: numpy.typing.ArrayLike, *, checker: CollisionChecker | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, step: float = 0.05, headings: int = 24, candidates: int = 64, seeds: int = 8, refinements: int = 4, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, threads: int = 0) -> BasePlacement:
        """
        One base pose from which as many tool poses (m, 4, 4) in the world as possible are reached.
        
        Keyword options:
            step: float = 0.05  # grid of base positions [m]
            headings: int = 24  # of the base, evenly over the circle
            candidates: int = 64  # best base poses of the grid checked exactly
            seeds: int = 8  # stored configurations tried for a target
            refinements: int = 4  # rounds of smaller steps about the best
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            threads: int = 0  # 0: all; does not change the answer
        """
    def nearest(self, T_base_tip: numpy.typing.ArrayLike, count: int = 8) -> numpy.typing.NDArray[numpy.float64]:
        """
        Up to `count` stored configurations (k, n) near the pose, nearest first.
        """
    def query(self, T_base_tip: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        Stored configurations (k, n) whose tool pose lies in the pose's cell; k may be 0.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes a folder to a temporary name and renames it; raises IoError where something other than a database stands.
        """
    def solve(self, arm: JointGroup, T_base_tip: numpy.typing.ArrayLike, *, checker: CollisionChecker | None = None, count: int = 8, candidates: int = 64, distinct: float = 0.1, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, threads: int = 0) -> numpy.typing.NDArray[numpy.float64]:
        """
        Exact configurations (k, n) for a pose relative to the root, from stored ones near it; the most different ones first, with a checker the free ones.
        
        Keyword options:
            count: int = 8  # solutions at most
            candidates: int = 64  # stored configurations tried
            distinct: float = 0.1  # solutions differ by more than this in some joint [rad or m]
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            threads: int = 0  # of batches; 0: all
        """
    def solve_batch(self, arm: JointGroup, T_base_tips: numpy.typing.ArrayLike, *, checker: CollisionChecker | None = None, count: int = 8, candidates: int = 64, distinct: float = 0.1, position_tolerance: float = 1e-05, rotation_tolerance: float = 0.0001, threads: int = 0) -> list[numpy.typing.NDArray[numpy.float64]]:
        """
        solve() for many poses (m, 4, 4) at a time: a list of arrays (k, n).
        
        Keyword options:
            count: int = 8  # solutions at most
            candidates: int = 64  # stored configurations tried
            distinct: float = 0.1  # solutions differ by more than this in some joint [rad or m]
            position_tolerance: float = 1e-05  # [m]
            rotation_tolerance: float = 0.0001  # [rad]
            threads: int = 0  # of batches; 0: all
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    def verify(self) -> None:
        """
        Compares every file with its checksums; raises IoError where they differ.
        """
    @property
    def arrays(self) -> dict[str, numpy.typing.NDArray[typing.Any]]:
        """
        Read-only views of the database's arrays, by file name. Raises IoError where configurations differ from their checksums, which are compared the first time.
        """
    @property
    def cell_count(self) -> int:
        """
        Non-empty cells.
        """
    @property
    def joint_count(self) -> int:
        """
        Columns of a stored configuration.
        """
    @property
    def joint_lower(self) -> list[float]:
        """
        Least value of each joint [rad or m].
        """
    @property
    def joint_step(self) -> list[float]:
        """
        q = joint_lower + joint_step * arrays['configurations'].
        """
    @property
    def key(self) -> str:
        """
        Hash of robot, group and options: databases of one key are the same.
        """
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
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def base_pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        x, y, theta
        """
    @property
    def configurations(self) -> list[numpy.typing.NDArray[numpy.float64] | None]:
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
    
        reached = mg.base.CapabilityMap.build(arm, world, voxel=0.2, poses=50)
        reached.index_at([0.6, 0.0, 0.8])  # share of tool poses around this point, in [0, 1]
    """
    @staticmethod
    def build(arm: JointGroup, world: World | None = None, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, lower: numpy.typing.ArrayLike = (-1.0, -1.0, 0.0), upper: numpy.typing.ArrayLike = (1.0, 1.0, 2.6), voxel: float = 0.1, poses: int = 200, rolls: int = 1, approach: numpy.typing.ArrayLike = (0.0, 0.0, 1.0), samples: int = 0, sweeps: int = 4, restarts: int = 0, padding: float = 0.0, seed: int = 1, threads: int = 0) -> CapabilityMap:
        """
        Tries every tool pose of every voxel. `progress` is called with (stage, fraction).
        
        Keyword options:
            lower: numpy.typing.ArrayLike = (-1.0, -1.0, 0.0)  # corner of the grid in the robot's root frame [m]
            upper: numpy.typing.ArrayLike = (1.0, 1.0, 2.6)  # the opposite corner, a whole number of voxels away [m]
            voxel: float = 0.1  # edge of a voxel and diameter of its sphere [m]
            poses: int = 200  # tool poses in a voxel; a multiple of rolls
            rolls: int = 1  # rolls about each approach direction
            approach: numpy.typing.ArrayLike = (0.0, 0.0, 1.0)  # where the tool points, in the tip's frame
            samples: int = 0  # values tried of joints a pose leaves free; 0: 64 for one, 128 for two
            sweeps: int = 4  # times that solutions spread from pose to neighbouring pose
            restarts: int = 0  # further random descents for poses that border reached ones
            padding: float = 0.0  # robot links are grown by this against the scene [m]
            seed: int = 1  # same seed, same map
            threads: int = 0  # 0: all; does not change the answer
        """
    @staticmethod
    def load(path: str | os.PathLike[str]) -> CapabilityMap:
        """
        Raises IoError on a truncated, foreign or corrupt folder.
        """
    def __copy__(self) -> CapabilityMap:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> CapabilityMap:
        ...
    def __repr__(self) -> str:
        ...
    def best_base_distance(self, T_world_tips: numpy.typing.ArrayLike, distances: numpy.typing.ArrayLike, heading: float = 0.0, cone: float = 4.0) -> tuple[float, float, list[float]]:
        """
        Which distance [m] to stand behind the poses' middle, facing along `heading` [rad]:
        (distance, score, scores of all).
        """
    def configuration(self, x: int, y: int, z: int, pose: int) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Configuration that reaches a pose of a voxel, or None.
        """
    def index_at(self, point: numpy.typing.ArrayLike) -> float:
        """
        Index of the voxel that holds a point of the root frame; 0 outside.
        """
    def restricted(self, arm: JointGroup, world: World, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> CapabilityMap:
        """
        The map of the same arm in a world with more in it: only what is reached here is checked again.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes a folder of .npy files and meta.json.
        """
    def score(self, T_world_tips: numpy.typing.ArrayLike, T_world_root: numpy.typing.ArrayLike | None = None, cone: float = 4.0) -> float:
        """
        Mean index over tool poses (m, 4, 4) with the root at a pose. With `cone` below pi [rad] only tool poses
        that approach within that angle of each pose count.
        """
    def slice(self, axis: str, at: float) -> numpy.typing.NDArray[numpy.float32]:
        """
        Cut through the voxels at a coordinate [m]: `slice("z", 0.75)` is (nx, ny).
        """
    @property
    def centres(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centres of the voxels (nx, ny, nz, 3) [m].
        """
    @property
    def classes(self) -> numpy.typing.NDArray[numpy.uint8]:
        """
        What became of each pose (nx, ny, nz, poses), uint8: 0 reached, 1 out of reach, 2 limits, 3 self-collision,
        4 scene.
        """
    @property
    def configurations(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        A configuration for each reached pose (reached, n), float32, in the order of `classes`.
        """
    @property
    def index(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        Reachability index of each voxel (nx, ny, nz), float32 in [0, 1].
        """
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lower corner of the grid (3,) in the robot's root frame [m].
        """
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
    def shape(self) -> tuple[int, int, int]:
        """
        Voxels along x, y, z.
        """
    @property
    def tool_poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Tool poses around a voxel's centre (poses, 4, 4).
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Upper corner of the grid (3,) in the robot's root frame [m].
        """
    @property
    def voxel(self) -> float:
        """
        Edge of a voxel [m].
        """
class ContactPairProvenance:
    """
    Provenance of sample_grasps: two opposed contacts and a direction of approach.
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
    @property
    def tips_flush(self) -> bool:
        """
        The tips of the pads are flush with the object's far face: where it is thinner than they are long.
        """
class PipeProvenance:
    """
    Provenance of Pipe.grasp and Pipe.sample_grasps: P2's four variables (P2 3.2.3.1).
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
    Provenance of evaluate_graspability: a place of a height map and of a depth image.
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
    def pixel(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (u, v) in the depth image; (-1, -1) without one.
        """
class Grasp:
    """
    One way to hold an object: where the hand stands, how far it is open, what it costs and how good it is.
    
        grasp = mg.Grasp(mg.pose([0, 0, 0.05], rpy=[0, np.pi / 2, 0]), opening=0.04)
        T_world_hand = T_world_object @ grasp.T_object_hand
    """
    def __init__(self, T_object_hand: numpy.typing.ArrayLike, opening: float = 0.0, *, cost: float = 0.0, quality: float = 1.0, posture: numpy.typing.ArrayLike = ()) -> None:
        """
        Pose of the hand's tool frame in the object's frame (4, 4); distance between the fingers while holding [m]; cost that
        planners add to their path's length; quality in [0, 1]; for a hand with several joint groups how far each is open, in [0, 1].
        """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All of it as numbers, strings, lists and dicts; factors of the quality by their values.
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
    @property
    def quality_factors(self) -> dict[str, tuple[float, float]]:
        """
        What the quality is the product of, by name: (value, weight) of the factor 1 - weight + weight * value.
        """
class SuctionCup:
    """
    One suction cup of a hand: its rim is a circle in the plane through the tool frame's origin, across the approach.
    """
    def __init__(self, position: numpy.typing.ArrayLike, radius: float) -> None:
        """
        Middle of the rim in the tool frame (3,) and its radius [m].
        """
    def __repr__(self) -> str:
        ...
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the rim in the tool frame (3,) [m].
        """
    @property
    def radius(self) -> float:
        """
        Radius of the rim [m].
        """
class Suction:
    """
    Suction cups that hold a part together: how far their rims give way, and how hard they pull.
    """
    def __init__(self, cups: collections.abc.Sequence[SuctionCup], *, max_gap: float = 0.0015, vacuum: float = 60000.0, friction: float = 0.5, safety: float = 2.0) -> None:
        """
        See the properties of the same names.
        """
    def __repr__(self) -> str:
        ...
    @property
    def cups(self) -> list[SuctionCup]:
        """
        At least one.
        """
    @property
    def force(self) -> float:
        """
        What all cups pull with: vacuum times area [N].
        """
    @property
    def friction(self) -> float:
        """
        Coulomb coefficient of rim and part.
        """
    @property
    def max_gap(self) -> float:
        """
        A cup seals where the part's surface falls back from its rim's plane by no more than this [m].
        """
    @property
    def safety(self) -> float:
        """
        The force is so many times what holding needs.
        """
    @property
    def vacuum(self) -> float:
        """
        Below the pressure of the air [Pa].
        """
class HandJoint:
    """
    A driven joint of a hand: how far it goes between closed and open [rad] or [m]. Joints of one group move together.
    """
    def __init__(self, name: str, closed: float, open: float, group: str = 'fingers') -> None:
        """
        See the properties of the same names.
        """
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
    def __init__(self, *, finger_thickness: float = 0.012, finger_length: float = 0.12, palm_length: float = 0.13, palm_width: float = 0.065) -> None:
        """
        Sizes [m], > 0; see the properties of the same names.
        """
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
        Size of a finger along the closing axis.
        """
    @property
    def palm_length(self) -> float:
        """
        Size of the palm along the closing axis.
        """
    @property
    def palm_width(self) -> float:
        """
        Size of the palm across it.
        """
class Hand:
    """
    The hand at the end of an arm: tool frame, approach and closing axis, and how its joints follow from the opening.
    The tool frame's origin (tool centre point) lies midway between the pads' centres; a parallel gripper has one group
    of joints, linear in the opening.
    """
    @staticmethod
    def from_robot(robot: Robot, tool_link: str, *, group: str = '', approach: numpy.typing.ArrayLike | None = None, closing: numpy.typing.ArrayLike | None = None, clearance: float = 0.01, postures: int = 32) -> Hand:
        """
        A hand read from a robot that was loaded with its meshes: axes, ends of the joints, openings and body are measured
        by forward kinematics between the collision shapes of the finger tips. `group` is an SRDF end effector or group; ''
        takes every joint below the tool link's body.
        """
    @staticmethod
    def of_cups(tool_link: str, *, approach: numpy.typing.ArrayLike, suction: Suction, cup_links: collections.abc.Sequence[str] = [], payload: float = ...) -> Hand:
        """
        A hand of suction cups that face along `approach` (3,) of the tool frame; `cup_links` may touch the attached part.
        """
    def __init__(self, tool_link: str, *, approach: numpy.typing.ArrayLike, closing: numpy.typing.ArrayLike, max_opening: float, finger_depth: float, finger_width: float, clearance: float = 0.01, joints: collections.abc.Sequence[HandJoint] = [], finger_links: collections.abc.Sequence[str] = [], kind: str = 'parallel', min_opening: float = 0.0, openings: collections.abc.Sequence[float] = [], preshape: collections.abc.Mapping[str, float] = {}, body: HandBody | None = None, payload: float = ...) -> None:
        """
        A hand by its numbers, each described at the property of its name; `body` None: fingers of 12 cm before a palm of 13 x 6.5 cm.
        """
    def __repr__(self) -> str:
        ...
    @typing.overload
    def joint_values(self, opening: float) -> dict[str, float]:
        """
        Joint values at an opening [m].
        """
    @typing.overload
    def joint_values(self, grasp: Grasp) -> dict[str, float]:
        """
        Joint values while holding: those of the grasp's posture if it has one, else of its opening.
        """
    def opening_at(self, share_open: float) -> float:
        """
        The opening at which they are so far open [m].
        """
    def posture_values(self, posture: collections.abc.Sequence[float]) -> dict[str, float]:
        """
        Joint values of a posture: for each of `groups` how far it is open, in [0, 1].
        """
    def pregrasp_opening(self, width: float) -> float:
        """
        Opening while moving in on a part of this width: with clearance on both sides, at most max_opening [m].
        """
    def shapes(self, opening: float) -> list[LinkShape]:
        """
        Left and right finger and palm as boxes in the tool frame.
        """
    def share_open(self, opening: float) -> float:
        """
        How far open the fingers are at an opening, in [0, 1].
        """
    def with_finger_depth(self, finger_depth: float) -> Hand:
        """
        The same hand with pads of another length along the approach [m], > 0.
        """
    def with_payload(self, payload: float) -> Hand:
        """
        The same hand with another payload [kg], > 0; inf: none is stated.
        """
    @property
    def approach(self) -> numpy.typing.NDArray[numpy.float64]:
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
    def closing(self) -> numpy.typing.NDArray[numpy.float64]:
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
        Links that may touch the attached part.
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
    def payload(self) -> float:
        """
        Heaviest part that hand and arm may carry [kg].
        """
    @property
    def preshape(self) -> dict[str, float]:
        """
        Groups that the opening does not move, and how far open they stay.
        """
    @property
    def suction(self) -> Suction | None:
        """
        Cups in place of fingers; None: the hand has fingers.
        """
    @property
    def tool_link(self) -> str:
        """
        Link whose frame is the tool frame.
        """
class SampledSuctionGrasps:
    """
    What sample_suction_grasps found, and what it left out.
    """
    def __repr__(self) -> str:
        ...
    @property
    def grasps(self) -> list[Grasp]:
        """
        Best first.
        """
    @property
    def least_share(self) -> float:
        """
        Least share of the cups' force that holds the mass in every direction, where all seal; inf: nowhere.
        """
    @property
    def too_heavy(self) -> int:
        """
        Where all seal, but would not hold the mass in every direction.
        """
    @property
    def unsealed(self) -> int:
        """
        Places and turns at which some cup does not seal.
        """
class ToolRegion:
    """
    A box of tool poses around a pose.
    """
    def __init__(self, pose: numpy.typing.ArrayLike, position: numpy.typing.ArrayLike | None = None, rotation: numpy.typing.ArrayLike | None = None) -> None:
        """
        pose (4, 4) times a translation within +-position [m] times a rotation rpy within +-rotation [rad].
        """
    def __repr__(self) -> str:
        ...
class OrientationConstraint:
    """
    Path constraint: an axis of the tool stays near an axis of the world.
    """
    def __init__(self, tool_axis: numpy.typing.ArrayLike, world_axis: numpy.typing.ArrayLike, half_angle: float) -> None:
        """
        tool_axis in the tip's frame; half_angle: the largest angle between the two [rad].
        """
    def __repr__(self) -> str:
        ...
class MotionStats:
    """
    What a search of plan_motion took.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def collision_queries(self) -> int:
        """
        Configurations checked.
        """
    @property
    def length_before_shortening(self) -> float:
        """
        Length of the first path in joint space, weighted likewise.
        """
    @property
    def seconds(self) -> float:
        """
        Wall-clock time [s].
        """
class MotionResult:
    """
    What plan_motion found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        Length of the path in joint space, weighted by `joint_weights`.
        """
    @property
    def goal_index(self) -> int:
        """
        Which of the goals the path reaches; -1 unless solved.
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Waypoints (k, n), joined by straight lines; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Why the start, or goals, were rejected.
        """
    @property
    def stats(self) -> MotionStats:
        """
        What the search took.
        """
    @property
    def via_reached(self) -> int:
        """
        With `via`: how many of them a path was found to; all when solved.
        """
class StraightLineResult:
    """
    What plan_straight_line found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        """
        `solved` when the whole line is followed.
        """
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        (k, n) or None.
        """
class CartesianResult:
    """
    What plan_cartesian found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        """
        `solved` when every pose is reached in order.
        """
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        (k, n) or None.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Configurations of the first pose that were rejected, by cause.
        """
    @property
    def tried(self) -> int:
        """
        How many of these were followed.
        """
class Roadmap:
    """
    Configurations of a group drawn from its joint limits and joined when near, without any collision check: it serves
    every grasp, object and scene (P2 4.3.2.1). Immutable.
    
        roadmap = mg.planning.Roadmap.build(arm, vertices=2000)
        roadmap.statistics["largest_component"]
    """
    @staticmethod
    def build(group: JointGroup, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, vertices: int = 5000, gamma: float = 0.0, neighbours: int = 0, joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None, seed: int = 1) -> Roadmap:
        """
        Draws and joins; a larger roadmap of the same seed holds a smaller one's vertices.
        
        Keyword options:
            vertices: int = 5000  # configurations drawn
            gamma: float = 0.0  # > 0: vertices nearer than gamma (log n / n)^(1/d) are joined (P2: 4) [rad or m]; 0: the e (1 + 1/d) log n nearest ones
            neighbours: int = 0  # > 0: that many nearest ones are joined instead
            joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None  # what a motion of each joint costs in the length of a path, (n,) or by joint name (others: 1), each > 0; None: 1
            seed: int = 1  # same seed, same roadmap
        """
    @staticmethod
    def load(path: str | os.PathLike[str], group: JointGroup) -> Roadmap:
        """
        Raises IoError on a damaged file or one made for another robot, joints or limits.
        """
    def __copy__(self) -> Roadmap:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> Roadmap:
        ...
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def near(self, q: numpy.typing.ArrayLike) -> list[int]:
        """
        Vertices a new configuration would be joined with, ascending.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        To a temporary name first, then renamed.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def edges(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Pairs of vertices (m, 2), the smaller number first.
        """
    @property
    def statistics(self) -> mmgrasp.records.RoadmapStatistics:
        """
        Mean degree, connected parts, the largest one's vertices, nearest ones joined, connection radius, the volume of the joint limits, and the gamma that PRM* asks for.
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, joints)
        """
    @property
    def warning(self) -> str:
        """
        What to set when less than 99 % of the vertices hang together; empty otherwise.
        """
class ManipulationProblem:
    """
    Moves an object from one pose to another with any of many grasps (P2 4.2): the planner chooses the grasp.
    
        problem = mg.ManipulationProblem(arm, world, shapes, T_world_start, T_world_goal, grasps)
        result = mg.plan_manipulation(problem, time_limit=5.0)
        if result.outcome == mg.Outcome.solved:
            print(result.grasp_index, len(result.path))
    """
    def __init__(self, group: JointGroup, world: World, object: LinkShape | collections.abc.Sequence[LinkShape], T_world_start: numpy.typing.ArrayLike, T_world_goal: numpy.typing.ArrayLike, grasps: collections.abc.Sequence[Grasp] | numpy.typing.ArrayLike, *, gripper: Hand | None = None, touch_links: collections.abc.Sequence[str] = [], object_name: str = 'object') -> None:
        """
        `object` is a LinkShape or a list of them, in its own frame; `world` is without it. `grasps` are Grasp, or poses of the hand in the object's frame as (m, 4, 4). With `gripper` the fingers are set to each grasp's opening. Links in `touch_links` may touch the object; none given: those of the end effector. The group may be an arm or an arm on an omni base; a diff_drive base is refused, since it could not drive the paths.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_goal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the object at the end (4, 4).
        """
    @property
    def T_world_start(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the object at the beginning (4, 4).
        """
    @property
    def grasps(self) -> list[Grasp]:
        """
        The grasps to choose from.
        """
    @property
    def group(self) -> JointGroup:
        """
        Arm, or arm and omni base; its tip is the tool.
        """
    @property
    def object(self) -> list[LinkShape]:
        """
        Shapes of the object in its own frame.
        """
    @property
    def object_name(self) -> str:
        """
        Name under which it is attached.
        """
    @property
    def world(self) -> World:
        """
        The world without the object.
        """
class SearchTree:
    """
    One tree of RRT*-MG as it stood at the end: of one grasp, from its starts or its goals.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def costs(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Length of the way from the root, (n,).
        """
    @property
    def from_goal(self) -> bool:
        """
        It grew from the goals; otherwise from the starts.
        """
    @property
    def grasp(self) -> int:
        """
        Index of its grasp.
        """
    @property
    def parents(self) -> list[int]:
        """
        Parent of each vertex, or -1 for the grasp's arm configurations.
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, joints)
        """
class Improvement:
    """
    A better solution on the way, as planners report it to `on_solution`.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def cost(self) -> float:
        """
        Length of the path in joint space, plus the grasp's cost where there are grasps.
        """
    @property
    def grasp(self) -> int:
        """
        Index of its grasp; -1: the motion has none.
        """
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
    @property
    def stage(self) -> str:
        """
        What found it: search (plan_motion), first_grasps, straight_lines, roadmap, refinement, trees or shortening.
        """
class GraspReport:
    """
    What became of one grasp.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def goal(self) -> Rejections:
        """
        Likewise at the goal; not checked when none is left at the start.
        """
    @property
    def goal_solutions(self) -> int:
        """
        Arm configurations left at the goal.
        """
    @property
    def searched(self) -> bool:
        """
        Its paths were looked for over a roadmap.
        """
    @property
    def start(self) -> Rejections:
        """
        Arm configurations rejected at the start, by cause.
        """
    @property
    def start_solutions(self) -> int:
        """
        Arm configurations left at the start.
        """
class ManipulationStats:
    """
    What a search of plan_manipulation took.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def edges_checked_attached(self) -> int:
        """
        Edges checked for the attached object.
        """
    @property
    def edges_checked_robot(self) -> int:
        """
        Edges checked for the robot alone, shared by all grasps of an opening.
        """
    @property
    def graph_searches(self) -> int:
        """
        Searches of prm_star_mg's per-grasp graphs.
        """
    @property
    def grasps_searched(self) -> int:
        """
        Grasps for which prm_star_mg searched a roadmap; each counts once.
        """
    @property
    def ik_seconds(self) -> float:
        """
        Time for the arm configurations at start and goal [s].
        """
    @property
    def nodes_opened(self) -> int:
        """
        Nodes pushed to the open lists of graph searches (prm_star_mg without lazy_grasps).
        """
    @property
    def postures_bound(self) -> float:
        """
        No path between the arm postures that were found costs less.
        """
    @property
    def roadmap_bound(self) -> float:
        """
        No path over prm_star_mg's roadmap, or straight, costs less; infinite: there is none.
        """
    @property
    def roadmap_cost(self) -> float:
        """
        Cost of prm_star_mg's best path over the roadmap before shortening; 0: none is cheaper than the first path.
        """
    @property
    def roadmap_seconds(self) -> float:
        """
        Time for building a roadmap [s]; 0: it was given or not used.
        """
    @property
    def samples(self) -> int:
        """
        Samples that rrt_star_mg drew or reassigned.
        """
    @property
    def search_seconds(self) -> float:
        """
        Time for all the rest [s].
        """
    @property
    def stages(self) -> dict[str, mmgrasp.records.StageRow]:
        """
        What each stage contributed, by its name, in the order of their first improvement.
        """
    @property
    def vertices(self) -> int:
        """
        Vertices of rrt_star_mg's trees, removed ones included.
        """
class ManipulationResult:
    """
    What plan_manipulation found.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        Index into the problem's grasps; -1 unless solved.
        """
    @property
    def grasps(self) -> list[GraspReport]:
        """
        A GraspReport for each grasp.
        """
    @property
    def improvements(self) -> list[Improvement]:
        """
        Every better solution on the way, in order.
        """
    @property
    def lower_bound(self) -> float:
        """
        No path with any grasp costs less: the least straight line where every arm posture was listed, else also what the tool's way takes at the longest levers. Infinite: proven that there is none.
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Waypoints (k, n), joined by straight lines; None unless solved.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Sum over all grasps and both ends.
        """
    @property
    def stats(self) -> ManipulationStats:
        """
        What the search took: seconds, searches, edges checked; what each stage found and when.
        """
    @property
    def trees(self) -> list[SearchTree]:
        """
        With keep_trees: a SearchTree for each grasp still a candidate and each end.
        """
    @property
    def warnings(self) -> list[str]:
        """
        What may have kept paths from being found: a roadmap in pieces.
        """
class BaseTrackingResult:
    """
    A base driven along a plan, one row a period; poses are (x, y, theta).
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
    
        tracker = mg.base.BaseTracker(robot)
        velocity = tracker.command(planned_now, planned_after_period, measured)  # x, y, theta each
    """
    def __init__(self, robot: Robot, *, kp: float = 2.0, ki: float = 0.1, kd: float = 0.3, offset: float = 0.2, period: float = 0.02, feed_forward: bool = True, feedback: bool = True, settle: float = 0.0) -> None:
        """
        For a robot on a diff_drive or omni base.
        
        Keyword options:
            kp: float = 2.0  # proportional gain [1/s]
            ki: float = 0.1  # integral gain [1/s^2]
            kd: float = 0.3  # derivative gain
            offset: float = 0.2  # distance of the tracked point from the wheel axis [m]
            period: float = 0.02  # a command is held this long [s]
            feed_forward: bool = True  # adds the planned velocity
            feedback: bool = True  # False: open loop, the planned velocities only
            settle: float = 0.0  # goes on this long after the plan's end [s]
        """
    def command(self, desired: numpy.typing.ArrayLike, desired_next: numpy.typing.ArrayLike, measured: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
        """
        Platform velocity (v_x, v_y, omega) to hold until the plan is at desired_next, one period on; poses are (x, y, theta).
        """
    def reset(self) -> None:
        """
        Forgets the integral of the errors, to begin another plan.
        """
    @property
    def limited(self) -> bool:
        """
        The last command was scaled down to the limits.
        """
    @property
    def period(self) -> float:
        """
        Time for which a command is held [s].
        """
class ClosingOutcome:
    """
    What one moment to begin closing comes to. Engagement: how far the finger tips are beyond the object's near face.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def both_touch(self) -> float:
        """
        The same when both fingers touch, were the object not pushed [m].
        """
    @property
    def covered_sigmas(self) -> float:
        """
        Errors of so many standard deviations along and aside together are survived; infinite where these are 0, negative where nothing is held.
        """
    @property
    def farther_tolerance(self) -> float:
        """
        It may stand this much farther [m].
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
    def probability(self) -> float:
        """
        That the object is held as planned, its errors independent and normally distributed.
        """
    @property
    def pushed(self) -> float:
        """
        How far the object slides before the palm [m].
        """
    @property
    def side_clearance(self) -> float:
        """
        Free space on either side of a centred object as the tips pass it [m].
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
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        """
        There is a moment at which closing may begin.
        """
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
    def __init__(self, name: str, shapes: collections.abc.Sequence[LinkShape], T_world_part: numpy.typing.ArrayLike, grasps: collections.abc.Sequence[Grasp] = [], *, target: bool = True, grasps_too_wide: int = 0, mass: float = 0.0, grasps_sampled: bool = False) -> None:
        """
        `shapes` in the part's frame, `T_world_part` (4, 4), candidate `grasps` best first. A part that is no `target`
        stays where it is; `grasps_too_wide` says how many candidates were left out because the gripper does not open so far.
        `mass` [kg]; 0: not known. `grasps_sampled`: others may exist, so that nothing is proven of the part where these are impossible.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_part(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the part (4, 4).
        """
    @property
    def grasps(self) -> list[Grasp]:
        """
        Candidates, best first.
        """
    @property
    def grasps_sampled(self) -> bool:
        """
        Others may exist.
        """
    @property
    def grasps_too_wide(self) -> int:
        """
        Candidates left out because the gripper does not open so far.
        """
    @property
    def mass(self) -> float:
        """
        [kg]; 0: not known.
        """
    @property
    def name(self) -> str:
        """
        Unique over the problem.
        """
    @property
    def shapes(self) -> list[LinkShape]:
        """
        Its body, in the part's frame.
        """
    @property
    def target(self) -> bool:
        """
        To be picked; otherwise an obstacle that stays.
        """
class Tray:
    """
    A tray and the parts in it; its walls are scene objects.
    """
    def __init__(self, name: str, T_world_tray: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, parts: collections.abc.Sequence[Part], headings: numpy.typing.ArrayLike = ()) -> None:
        """
        `T_world_tray` (4, 4): middle of the tray's floor, a robot in front of it looks along its +x; `size` (3,): depth,
        width, height [m]; `headings` of the base that are tried [rad], none given: the one that faces the tray.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_tray(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the tray's floor (4, 4); a robot in front of it looks along its +x.
        """
    @property
    def headings(self) -> list[float]:
        """
        Headings of the base that are tried [rad]; empty: the one that faces the tray.
        """
    @property
    def name(self) -> str:
        """
        Unique over the problem.
        """
    @property
    def parts(self) -> list[Part]:
        """
        The parts in it.
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Depth, width, height [m].
        """
class PlaceRegion:
    """
    Where picked parts go: a bin fixed to the robot.
    """
    def __init__(self, T_base_bin: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, drop_height: float = 0.03, capacity: int = 0) -> None:
        """
        `T_base_bin` (4, 4): middle of the bin's top plane in the robot's root frame, z up; `size` (2,): inner x and y
        [m], > 0; `drop_height`: how far above the top plane a part is released [m], >= 0; `capacity`: so many parts fill the bin, 0: it takes all.
        """
    @property
    def T_base_bin(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the bin's top plane in the robot's root frame (4, 4), z up.
        """
    @property
    def capacity(self) -> int:
        """
        So many parts fill the bin; then the robot drives to the goal, where it is emptied. 0: it takes all.
        """
    @property
    def drop_height(self) -> float:
        """
        A part is released with its lowest point so far above the bin's top plane [m].
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Inner x and y (2,) [m].
        """
class UnloadRegion:
    """
    Where a robot without a bin lets go what it brought to the goal in its hand: a rectangle in the world.
    """
    def __init__(self, T_world_region: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, drop_height: float = 0.03) -> None:
        """
        `T_world_region` (4, 4): middle of the rectangle, z up; `size` (2,): x and y [m], > 0; `drop_height`: how far above it a
        part is released [m], >= 0. What stands there, a bin or a chute, is an object of the world.
        """
    @property
    def T_world_region(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the rectangle (4, 4), z up.
        """
    @property
    def drop_height(self) -> float:
        """
        A part is released with its lowest point so far above the rectangle [m].
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        x and y (2,) [m].
        """
class PartSupplyProblem:
    """
    Everything the part-supply planner needs: the robot and its hand, the room, the trays with their parts, and where parts
    go. `mmgrasp.load_scenario(path).problem()` makes one of a scenario file.
    
        problem = mg.load_scenario("storeroom.yaml").problem()
        database = mg.ReachDatabase.build(problem.arm)
        plan = mg.base.plan_part_supply(problem, database)
    """
    def __init__(self, robot: Robot, arm: JointGroup, gripper: Hand, world: World, trays: collections.abc.Sequence[Tray], home: numpy.typing.ArrayLike, start: numpy.typing.ArrayLike, goal: numpy.typing.ArrayLike, place_region: PlaceRegion | None, *, arrival_covariance: numpy.typing.ArrayLike | None = None, drive_clearance: float = 0.0, unload_region: UnloadRegion | None = None, grid_resolution: float = 0.05, grid_max_distance: float = 0.0, ik_seeds: int = 8, positioning_uncertainty: float = 0.1, approach_distance: float = 0.08, lift_height: float = 0.12, motion_time_limit: float = 5.0, route_resolution: float = 0.1, robustness_samples: int = 2000, seed: int = 1, threads: int = 0) -> None:
        """
        `world` is without the parts; `home` (n,) is the arm's configuration while driving; `start` and `goal` (3,) are base
        poses x, y, theta [m, m, rad]. `arrival_covariance` (3, 3) of x, y [m^2] and theta [rad^2] in the world's axes says how far
        from a stop the base comes to stand; stops then are where most arrivals serve all their parts. Drives keep
        `drive_clearance` [m] to all but the ground, but within 1 m of their ends. A robot without a bin
        (`place_region` None) brings each part to the goal in its hand and lets it go over the `unload_region` there. Raises InvalidInput naming the field that breaks its rule.
        
        Keyword options:
            grid_resolution: float = 0.05  # cell edge of the base grid [m]
            grid_max_distance: float = 0.0  # cells farther from the tray's middle are not tried [m]; 0: the arm's reach
            ik_seeds: int = 8  # database configurations refined for each grasp and base pose, more where a part has fewer than 128 / ik_seeds grasps; arms with closed-form IK take all branches
            positioning_uncertainty: float = 0.1  # radius of the disc in which the base may come to stand [m]
            approach_distance: float = 0.08  # straight move from pre-grasp to grasp [m]
            lift_height: float = 0.12  # straight upward move after closing [m]
            motion_time_limit: float = 5.0  # for each planned motion [s]
            route_resolution: float = 0.1  # smallest cell edge of the base route's search [m]; cells of 0.1 m are tried before smaller ones
            robustness_samples: int = 2000  # base poses drawn at each stop for the check before returning
            seed: int = 1  # same seed, same plan
            threads: int = 0  # 0: all; does not change the answer
        """
    @property
    def arm(self) -> JointGroup:
        """
        The arm, without base joints.
        """
    @property
    def arrival_covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Covariance of x, y [m^2] and theta [rad^2] about a stop (3, 3); zeros: not asked for.
        """
    @property
    def drive_clearance(self) -> float:
        """
        Kept by drives farther than 1 m from both their ends [m]; 0: not asked for.
        """
    @property
    def goal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Base pose at the end (3,): x, y, theta [m, m, rad].
        """
    @property
    def gripper(self) -> Hand:
        """
        The gripper of the arm.
        """
    @property
    def home(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Arm configuration while driving (n,), fingers closed.
        """
    @property
    def options(self) -> dict[str, bool | int | float | str]:
        """
        Every keyword option with its value.
        """
    @property
    def place_region(self) -> PlaceRegion | None:
        """
        The bin on the robot, where picked parts go; None: there is none.
        """
    @property
    def robot(self) -> Robot:
        """
        The robot.
        """
    @property
    def start(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Base pose at the beginning (3,): x, y, theta [m, m, rad].
        """
    @property
    def trays(self) -> list[Tray]:
        """
        The trays with their parts.
        """
    @property
    def unload_region(self) -> UnloadRegion | None:
        """
        Where parts are let go at the goal that the hand brings there; None: they go into the bin.
        """
    @property
    def world(self) -> World:
        """
        Obstacles, tables and trays, without the parts.
        """
class BaseGrid:
    """
    Square cells over the floor, one layer for each heading.
    """
    def __init__(self, origin: numpy.typing.ArrayLike, resolution: float, nx: int, ny: int, headings: numpy.typing.ArrayLike = (0.0,)) -> None:
        """
        `origin` (2,) is the lower corner of cell (0, 0) [m], `resolution` the edge of a cell [m], nx and ny the
        cells along x and y, `headings` one layer each [rad], distinct.
        """
    def __repr__(self) -> str:
        ...
    def centre(self, heading: int, ix: int, iy: int) -> numpy.typing.NDArray[numpy.float64]:
        """
        x, y, theta of a cell's middle.
        """
    @property
    def headings(self) -> list[float]:
        """
        Heading of each layer [rad].
        """
    @property
    def nx(self) -> int:
        """
        Cells along x.
        """
    @property
    def ny(self) -> int:
        """
        Cells along y.
        """
    @property
    def origin(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lower corner of cell (0, 0) [m].
        """
    @property
    def resolution(self) -> float:
        """
        Edge of a cell [m].
        """
class PartExplanation:
    """
    What became of the candidates for one part over all base poses tried.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def base_poses_feasible(self) -> int:
        """
        Base poses from which the part has a collision-free grasp.
        """
    @property
    def base_poses_tried(self) -> int:
        """
        Base poses tried, without those where the robot at home touches the scene.
        """
    @property
    def grasps(self) -> int:
        """
        Candidates.
        """
    @property
    def part(self) -> str:
        """
        Name of the part.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Pairs of grasp and base pose by the cause that turned them down.
        """
class BaseRegion:
    """
    Base poses from which every target part of a tray can be grasped.
    """
    def __init__(self, tray: str, cells: numpy.typing.ArrayLike, grid: BaseGrid) -> None:
        """
        A region known from elsewhere: (headings, ny, nx) zeros and ones, to be intersected with others.
        """
    def __repr__(self) -> str:
        ...
    def cells(self, grid: BaseGrid) -> numpy.typing.NDArray[numpy.uint8]:
        """
        (headings, ny, nx) array of 0 and 1.
        """
    def part_cells(self, grid: BaseGrid) -> list[numpy.typing.NDArray[numpy.uint8]]:
        """
        The same for each target part alone.
        """
    @property
    def base_poses_in_collision(self) -> int:
        """
        Base poses left out because the robot at home touches the scene there.
        """
    @property
    def count(self) -> int:
        """
        Number of cells.
        """
    @property
    def explanations(self) -> list[PartExplanation]:
        """
        One PartExplanation for each target part.
        """
    @property
    def tray(self) -> str:
        """
        Name of the tray.
        """
class ObjectRegions:
    """
    The region of every target part alone, kept and updated when parts leave: the region of any selection of a tray's
    parts is an intersection of ready bitmaps (P1 3.4.1, 3.5.1).
    
        grid = mg.base.make_base_grid(problem, database)
        regions = mg.base.ObjectRegions.compute(problem, database, grid)
        cells = regions.region(0, regions.parts(0))  # from where all target parts of the first tray can be grasped
    """
    @staticmethod
    def compute(problem: PartSupplyProblem, database: ReachDatabase, grid: BaseGrid, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> ObjectRegions:
        """
        The same as compute_base_regions, kept part by part.
        """
    def __copy__(self) -> ObjectRegions:
        ...
    def __deepcopy__(self, memo: dict[int, typing.Any]) -> ObjectRegions:
        ...
    def __repr__(self) -> str:
        ...
    def base_region(self, tray: int) -> BaseRegion:
        """
        The region of all target parts in place, with what became of the candidates.
        """
    def parts(self, tray: int) -> list[int]:
        """
        Indices of a tray's target parts that are in place, ascending.
        """
    def region(self, tray: int, parts: collections.abc.Sequence[int]) -> numpy.typing.NDArray[numpy.uint8]:
        """
        (headings, ny, nx) array of 0 and 1: cells from which every one of these parts can be grasped.
        """
    def remove(self, tray_and_part: collections.abc.Sequence[tuple[int, int]], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> bool:
        """
        Parts (tray, part) leave: they stand in nobody's way any more. False when stopped: nothing has changed.
        """
    @property
    def grid(self) -> BaseGrid:
        """
        The grid that all regions share.
        """
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
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def cells(self) -> int:
        """
        How many cells are shared.
        """
    @property
    def centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centre of the largest disc (2,) [m].
        """
    @property
    def heading(self) -> int:
        """
        Index of the heading's layer.
        """
    @property
    def radius(self) -> float:
        """
        Radius of the largest disc of shared cells [m].
        """
    @property
    def trays(self) -> list[int]:
        """
        Indices of the regions that share them, ascending.
        """
class Intersections:
    """
    Sets of regions whose shared cells hold a disc that is large enough (P1 3.4.2).
    """
    def __repr__(self) -> str:
        ...
    @property
    def complete(self) -> bool:
        """
        False when the search ended early.
        """
    @property
    def robust(self) -> list[Intersection]:
        """
        The sets whose disc is large enough.
        """
    @property
    def sets_too_small(self) -> int:
        """
        Sets that share cells, but with too small a disc.
        """
    @property
    def sets_tried(self) -> int:
        """
        Sets checked.
        """
    @property
    def too_small(self) -> list[Intersection]:
        """
        Shared cells whose disc is too small, largest first.
        """
class Stop:
    """
    Where the base stops and which trays it serves there.
    """
    def __repr__(self) -> str:
        ...
    @property
    def arrivals(self) -> int:
        """
        Arrivals drawn by the problem's arrival_covariance; 0: none.
        """
    @property
    def arrivals_served(self) -> int:
        """
        Those of them from which all parts of its trays can be grasped.
        """
    @property
    def intersection(self) -> int:
        """
        Index into the robust intersections.
        """
    @property
    def pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        x, y, theta.
        """
    @property
    def radius(self) -> float:
        """
        Radius of the disc in which every target part stays graspable [m].
        """
    @property
    def trays(self) -> list[int]:
        """
        Indices of the trays picked here; each tray has one stop.
        """
class StopSet:
    """
    Stops that serve all trays.
    """
    def __repr__(self) -> str:
        ...
    @property
    def candidates(self) -> Intersections:
        """
        What plan_stops_exact chose from.
        """
    @property
    def lower_bound(self) -> int:
        """
        Proven least number of stops.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: proven least; `approximate`: a cover that may have too many stops.
        """
    @property
    def stops(self) -> list[Stop]:
        """
        The stops, in no order yet.
        """
    @property
    def unreachable_trays(self) -> list[int]:
        """
        Indices of trays that no disc of the asked radius serves.
        """
class BasePath:
    """
    A drive of the base.
    """
    def __repr__(self) -> str:
        ...
    def duration(self, robot: Robot) -> float:
        """
        Time the robot's base takes for it within its speed and acceleration limits [s].
        """
    @property
    def length(self) -> float:
        """
        Driven distance [m].
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3): x, y, theta.
        """
    @property
    def turning(self) -> float:
        """
        Sum of absolute heading changes [rad].
        """
class OptimisedOrder:
    """
    A picking order, and how large the discs are in which the base may stop for its rounds.
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
        """
        Least radius over rounds and groups [m].
        """
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
        """
        Outcome of the choice of stops.
        """
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
        """
        The stops of the round; their trays are indices into the picking order.
        """
class PolicyResult:
    """
    A row of P1 table 3.4.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
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
        """
        Stops a round.
        """
    @property
    def online(self) -> bool:
        """
        Every round's seconds are within the limit.
        """
    @property
    def reliable(self) -> bool:
        """
        Every round is.
        """
    @property
    def rounds(self) -> list[PolicyRound]:
        """
        The rounds in order.
        """
    @property
    def smallest_radius(self) -> float:
        """
        Over all stops of all rounds [m].
        """
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
    def attached(self) -> bool:
        """
        The part is attached during the motion.
        """
    @property
    def kind(self) -> str:
        """
        transit, approach, lift, transfer or retreat; stow where the hand carries the part to the goal.
        """
    @property
    def opening(self) -> float:
        """
        Opening of the fingers during the motion [m].
        """
    @property
    def trajectory(self) -> JointTrajectory:
        """
        The arm on its clock, from 0.
        """
class Pick:
    """
    Home, pre-grasp, grasp, lift, transfer, home.
    """
    def __repr__(self) -> str:
        ...
    @property
    def duration(self) -> float:
        """
        Duration of all its motions [s].
        """
    @property
    def failed_at(self) -> str:
        """
        Without a solution: the stage at which most candidates fell.
        """
    @property
    def grasp(self) -> int:
        """
        Index into the part's grasps.
        """
    @property
    def motions(self) -> list[PickMotion]:
        """
        transit, approach, lift, transfer, retreat; stow after lift without a bin.
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def part(self) -> int:
        """
        Index into the tray's parts.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Grasps and their configurations rejected on the way, by cause.
        """
    @property
    def stop(self) -> int:
        """
        Index of the stop.
        """
    @property
    def tray(self) -> int:
        """
        Index of the tray.
        """
class Unloading:
    """
    A drive to the goal with a full bin, which is emptied there.
    """
    def __repr__(self) -> str:
        ...
    @property
    def after_pick(self) -> int:
        """
        Index of the plan's pick that filled the bin.
        """
    @property
    def back(self) -> BasePath | None:
        """
        To the same stop, where parts are left; None: the next leg of the route begins at the goal.
        """
    @property
    def to_goal(self) -> BasePath:
        """
        From the stop of that pick.
        """
class Obstruction:
    """
    Why there is no plan, and what would help.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def advised_move(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Translation of the tray in the world's x and y [m].
        """
    @property
    def largest_uncertainty(self) -> float:
        """
        Largest positioning uncertainty that still works [m]; < 0: none does.
        """
    @property
    def message(self) -> str:
        """
        One sentence that a person can act on.
        """
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
        """
        Name of the part that blocks; empty when the whole tray does.
        """
    @property
    def reach_deficit(self) -> float:
        """
        How far the nearest base pose falls short of the part [m]; 0: reach is not it. `advised_move` is what suffices.
        """
    @property
    def stage(self) -> str:
        """
        grasp, region, robustness, motion or route.
        """
    @property
    def tray(self) -> str:
        """
        Name of the tray.
        """
class PartSupplyPlan:
    """
    The planner's answer; a ScenarioPlan joins it with its scenario.
    """
    def __repr__(self) -> str:
        ...
    @property
    def grid(self) -> BaseGrid:
        """
        The grid that all regions share.
        """
    @property
    def intersections(self) -> Intersections:
        """
        What the stops were chosen from.
        """
    @property
    def lower_bound(self) -> int:
        """
        Proven least number of stops over the regions.
        """
    @property
    def obstructions(self) -> list[Obstruction]:
        """
        Why there is no plan, and what would help; empty with a plan.
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def picks(self) -> list[Pick]:
        """
        The picks in the order in which they are done.
        """
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
        """
        One a tray that has target parts.
        """
    @property
    def robustness_rate(self) -> float:
        """
        Least share over the stops of base poses drawn in the disc from which every part can be grasped.
        """
    @property
    def route(self) -> list[BasePath]:
        """
        Drives from start over the stops to the goal: one more than stops.
        """
    @property
    def stops(self) -> list[Stop]:
        """
        The stops in the order in which they are visited.
        """
    @property
    def timings(self) -> list[tuple[str, float]]:
        """
        Seconds of each stage, by name.
        """
    @property
    def unloadings(self) -> list[Unloading]:
        """
        Drives to the goal with a full bin, in order.
        """
class DriveByTask:
    """
    Something the tool does on the way: T_world_tip, (4, 4), or candidates (m, 4, 4) of which any will do.
    
        task = mg.DriveByTask(mg.pose([2.0, -0.8, 0.75]), dwell=0.5, free_axes=["yaw"])
    
    tolerance: (6,) along x, y, z [m] and about them [rad] of the pose's own frame; free_axes: names of axes along or
    about which any error is allowed, of x, y, z, roll, pitch, yaw; max_tool_speed [m/s] at the task; dwell [s] for which
    the tool's pose is kept, e.g. while a gripper closes; object: name of the world's object that is attached afterwards:
    an obstacle for the whole robot, the open hand included, until then; the fingers alone may touch it during the dwell.
    What rests on something counts as 1 mm higher once it is attached.
    
    push: a gripper that closes while the hand moves on (P1 4.3): dict of push_grasp's keywords, approach (3,), an axis of
    the tip's frame, free_length [m], the straight way before the finger tips reach the object, covariance (3, 3) [m^2]
    of the object's position in the world, of which `sigmas` standard deviations are covered, and closing_direction (3,)
    of the fingers in the tip's frame. T_world_tip is then
    the planned grasp; tolerance, free_axes, max_tool_speed and dwell are left out.
    """
    def __init__(self, T_world_tip: numpy.typing.ArrayLike, *, tolerance: numpy.typing.ArrayLike | None = None, free_axes: collections.abc.Sequence[str] = [], max_tool_speed: float | None = None, dwell: float = 0.0, object: str = '', push: dict[str, typing.Any] | None = None) -> None:
        """
        The class says what the arguments mean; raises InvalidInput naming one that breaks its rule.
        """
    def __repr__(self) -> str:
        ...
    @property
    def candidates(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 4, 4)
        """
    @property
    def dwell(self) -> float:
        """
        Time for which the tool's pose is kept [s].
        """
    @property
    def max_tool_speed(self) -> float:
        """
        Fastest tool at the task [m/s]; infinite: no limit.
        """
    @property
    def object(self) -> str:
        """
        Name of the world's object that is attached afterwards; empty: none.
        """
    @property
    def push(self) -> PushGrasp | typing.Any:
        """
        What push_grasp says: closing time, window, tolerance to the object's position; None without one.
        """
class WholeBodyTrajectory:
    """
    Base and arm on one clock. Between waypoints the drive velocities are linear in time; for a diff-drive base they are
    its speed v and turning rate omega, so that it never slips sideways.
    """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Configuration (n,) at a time [s], clamped at the ends.
        """
    def drive_at(self, time: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        Drive velocities (d,) at a time [s].
        """
    def rolled_out(self, steps: int = 64) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n): where the robot is at the waypoints when only the drive velocities are followed from the first one.
        """
    def sampled(self, between: int = 0) -> JointTrajectory:
        """
        A JointTrajectory of all waypoints and of `between` samples after each; x, y, theta first, with their velocities.
        """
    def to_csv(self, between: int = 0) -> str:
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
        """
        Columns of `drive`: v [m/s] and omega [rad/s] of a diff-drive base, x, y, theta of an omni base; then the joints.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def names(self) -> list[str]:
        """
        One a column of `positions`: x, y, theta first.
        """
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
    def to_csv(self, between: int = 0) -> str:
        """
        The trajectory's to_csv with two columns more: task, its index in the row of a task's waypoint, and attached, the object in the hand.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def events(self) -> list[mmgrasp.records.DriveByEventRow]:
        """
        One dict per task: waypoint, time and close_time [s], object (what is held then), attach_time [s] and T_tip_object, candidate, base_speed and
        tool_speed [m/s].
        """
    @property
    def grasp_assignments(self) -> int:
        """
        Choices of candidates planned.
        """
    @property
    def iterations(self) -> int:
        """
        Iterations of the optimiser, over all solves.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: every constraint is kept on a finer roll-out; `approximate`: the best iterate, with its violations.
        """
    @property
    def report(self) -> str:
        """
        What was tried, and what is broken where, by how much.
        """
    @property
    def seconds(self) -> float:
        """
        Wall-clock time of the call [s].
        """
    @property
    def solves(self) -> int:
        """
        Guesses from which the optimiser began.
        """
    @property
    def trajectory(self) -> WholeBodyTrajectory | typing.Any:
        """
        The answer or, when not solved, the best iterate; None when there was not even a guess.
        """
    @property
    def violations(self) -> dict[str, mmgrasp.records.ViolationRow]:
        """
        Each kind of constraint: value (0 when kept), tolerance, unit, time [s], waypoint, what, kept; measured on a roll-out ten times
        finer than the waypoints.
        """
class NonlinearProblem:
    """
    min f(x) for lower <= x <= upper and lower <= c(x) <= upper, twice differentiable, on sparse matrices. Derive from it and
    give its methods; with a `base`, e.g. the problem of a plan, those that are left out are the base's:
    
        class Rosenbrock(mg.optim.NonlinearProblem):
            def variable_bounds(self): return np.full(2, -np.inf), np.full(2, np.inf)
            def constraint_bounds(self): return np.zeros(0), np.zeros(0)
            def objective(self, x): return 100 * (x[1] - x[0] ** 2) ** 2 + (1 - x[0]) ** 2
            def gradient(self, x):
                return [400 * x[0] * (x[0] ** 2 - x[1]) - 2 * (1 - x[0]), 200 * (x[1] - x[0] ** 2)]
            def constraints(self, x): return []
            def jacobian_pattern(self): return [], []
            def jacobian(self, x): return []
            def hessian_pattern(self): return [0, 1, 1], [0, 0, 1]
            def hessian(self, x, factor, multipliers):
                return factor * np.array([1200 * x[0] ** 2 - 400 * x[1] + 2, -400 * x[0], 200])
        print(mg.optim.solve_nonlinear(Rosenbrock(), [-1.2, 1]).x)
    
    Not thread-safe: one solve at a time for each problem.
    """
    def __init__(self, base: NonlinearProblem | None = None) -> None:
        """
        A problem of one's own, on top of `base` or on none.
        """
    def constraint_bounds(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Lower and upper (m,); equal for an equation.
        """
    def constraint_name(self, index: int) -> str:
        """
        What messages call a constraint.
        """
    def constraints(self, x: numpy.typing.NDArray[numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        c(x), (m,)
        """
    def gradient(self, x: numpy.typing.NDArray[numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) of f
        """
    def hessian(self, x: numpy.typing.NDArray[numpy.float64], factor: float, multipliers: numpy.typing.NDArray[numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Values of the lower triangle of factor * f'' + sum_i multipliers[i] * c_i''.
        """
    def hessian_pattern(self) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
        """
        Rows and columns (row >= column) of the Hessian's entries, in the order of `hessian`; entries that repeat add up.
        """
    def jacobian(self, x: numpy.typing.NDArray[numpy.float64]) -> numpy.typing.NDArray[numpy.float64]:
        """
        Values of the Jacobian's entries.
        """
    def jacobian_pattern(self) -> tuple[numpy.typing.NDArray[numpy.int32], numpy.typing.NDArray[numpy.int32]]:
        """
        Rows (constraints) and columns (variables) of the Jacobian's entries, in the order of `jacobian`; entries that repeat add up.
        """
    def objective(self, x: numpy.typing.NDArray[numpy.float64]) -> float:
        """
        f(x)
        """
    def variable_bounds(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        Lower and upper (n,); infinite where there is none, equal where a value is prescribed.
        """
    def variable_name(self, index: int) -> str:
        """
        What messages call a variable.
        """
    @property
    def base(self) -> NonlinearProblem | None:
        """
        The problem beneath, or None.
        """
class NlpResult:
    """
    Where solve_nonlinear ended.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def iterations(self) -> int:
        """
        Iterations of Ipopt, or evaluations of SLSQP.
        """
    @property
    def message(self) -> str:
        """
        How the solver itself put it.
        """
    @property
    def objective(self) -> float:
        """
        f(x)
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: locally optimal, every constraint kept; `approximate`: constraints kept, optimality not shown;
        `not_found`: constraints are broken; `timeout`: iterations or clock.
        """
    @property
    def seconds(self) -> float:
        """
        Wall-clock time [s].
        """
    @property
    def violation(self) -> float:
        """
        How far the worst variable or constraint is outside its bounds; 0 where all hold.
        """
    @property
    def x(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The answer or, not solved, the best iterate: the least violated, then the cheapest.
        """
class WholeBodyProgram:
    """
    The nonlinear problem of a drive-by: fastest motion through the tasks, nothing in the way (P1 4.1 to 4.9). Variables are
    positions and drive velocities of the waypoints, drive accelerations between them and a time step for each segment.
    """
    def trajectory(self, x: numpy.typing.ArrayLike) -> WholeBodyTrajectory:
        """
        The motion that (n,) numbers stand for.
        """
    def violations(self, x: numpy.typing.ArrayLike) -> dict[str, mmgrasp.records.ViolationRow]:
        """
        As DriveByResult.violations: what that motion breaks on a roll-out ten times finer than the waypoints, but for constraints
        of one's own.
        """
    @property
    def accelerations(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (intervals, drives): which are drive accelerations.
        """
    @property
    def guess(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,): where plan_drive_by begins.
        """
    @property
    def positions(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (waypoints, columns): which variables are configurations.
        """
    @property
    def problem(self) -> NonlinearProblem:
        """
        To solve, or the base of a problem of one's own.
        """
    @property
    def steps(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (segments,): which are time steps.
        """
    @property
    def velocities(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (waypoints, drives): which are drive velocities.
        """
class RobotMotion:
    """
    What a robot carries out: arm, base and gripper on one clock. Made of a trajectory, a drive (`of_drive`) or a motion in
    passing (`of_drive_by`); `append` joins them. Between points the base's twist is linear in time, the arm a cubic.
    """
    @staticmethod
    def of_drive(path: BasePath, robot: Robot, arm: JointGroup, configuration: numpy.typing.ArrayLike, *, period: float = 0.1) -> RobotMotion:
        """
        The motion of a drive of the robot's base within its limits, `path.duration(robot)` long, with the arm at a configuration (n,);
        points at most `period` [s] apart.
        """
    @staticmethod
    def of_drive_by(result: DriveByResult, *, openings: collections.abc.Sequence[float] = [], period: float = 0.02) -> RobotMotion:
        """
        The motion that plan_drive_by found: points at most `period` [s] apart, and the gripper closing at every task that takes
        an object, to these openings [m], in order; none given: not known.
        """
    def __init__(self, trajectory: JointTrajectory, base_pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        The motion of a timed trajectory. Columns x, y, theta, where it begins with them, are the base's; otherwise the base stands at
        base_pose (x, y, theta), the origin by default.
        """
    def __len__(self) -> int:
        ...
    def __repr__(self) -> str:
        ...
    def append(self, next: RobotMotion) -> None:
        """
        Goes on with `next`, whose clock begins where this ends. Raises InvalidInput unless base and joints begin where they are.
        """
    def command_gripper(self, command: str, *, opening: float | None = None, duration: float = 0.0, object: str = '') -> None:
        """
        At the end, standing still: `open` or `close` to an opening [m], which takes `duration` [s]; object: what is taken or
        left.
        """
    def to_csv(self) -> str:
        """
        Header time, base.x, base.y, base.theta, base.v, base.vy, base.omega, joints, name.velocity, name.acceleration, and
        gripper, where it does anything (what it begins to do up to the row's time).
        """
    def to_joint_trajectory(self) -> mmgrasp.records.MotionMessage:
        """
        A dict shaped like a ROS trajectory_msgs/JointTrajectory, with base_pose and base_twist at every point, and `gripper`
        on the same clock.
        """
    def wait(self, duration: float) -> None:
        """
        Base and arm stand still for so long [s].
        """
    @property
    def accelerations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n) [rad/s^2 or m/s^2]
        """
    @property
    def base_poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3): x, y [m], theta [rad] in the world; theta is not wrapped.
        """
    @property
    def base_twists(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3): v_x, v_y [m/s], omega [rad/s] in the platform's own frame.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def gripper(self) -> list[mmgrasp.records.GripperEventRow]:
        """
        What the gripper does, in order: time and duration [s], command (open or close), opening [m] or None, object.
        """
    @property
    def joints(self) -> list[str]:
        """
        Joints of the arm, one a column.
        """
    @property
    def positions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n) [rad or m]
        """
    @property
    def times(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k,) [s], from 0
        """
    @property
    def velocities(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n) [rad/s or m/s]
        """
class PinholeCamera:
    """
    Pinhole camera without distortion: looks along +z, x to the right of the image, y down.
    """
    def __init__(self, width: int = 640, height: int = 480, fx: float = 525.0, fy: float = 525.0, cx: float = 319.5, cy: float = 239.5, nearest: float = 0.1, farthest: float = 5.0) -> None:
        """
        Sizes, focal lengths and principal point in pixels, depths seen in [nearest, farthest] [m].
        """
    def __repr__(self) -> str:
        ...
    def project(self, point: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Pixel (u, v) of a point in the camera's frame, or None when it is not seen.
        """
    @property
    def cx(self) -> float:
        """
        Principal point along x [pixels].
        """
    @property
    def cy(self) -> float:
        """
        Principal point along y [pixels].
        """
    @property
    def farthest(self) -> float:
        """
        What lies farther along the axis is not seen [m].
        """
    @property
    def fx(self) -> float:
        """
        Focal length along x [pixels].
        """
    @property
    def fy(self) -> float:
        """
        Focal length along y [pixels].
        """
    @property
    def height(self) -> int:
        """
        [pixels]
        """
    @property
    def nearest(self) -> float:
        """
        What lies closer along the axis is not seen [m].
        """
    @property
    def width(self) -> int:
        """
        [pixels]
        """
class PlatformLocations:
    """
    Two base + arm configurations for two tool poses.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def cost(self) -> float:
        """
        Travel [m] + turn_weight * turn [rad].
        """
    @property
    def outcome(self) -> Outcome:
        """
        How it ended; `solved` alone comes with an answer.
        """
    @property
    def pick(self) -> mmgrasp.records.SearchCounts:
        """
        Draws, what they fell at, and iterations of the first pose.
        """
    @property
    def place(self) -> mmgrasp.records.SearchCounts:
        """
        The same of the second pose.
        """
    @property
    def q_pick(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Base and arm at the first pose; None unless solved.
        """
    @property
    def q_place(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        Base and arm at the second pose; None unless solved.
        """
    @property
    def travel(self) -> float:
        """
        Travel of the base between the two [m].
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
    def load(path: str | os.PathLike[str], group: JointGroup, capacity: int = 10000) -> IkSeedDatabase:
        """
        Raises IoError on a damaged file or one made for another robot.
        """
    def __init__(self, group: JointGroup, capacity: int = 10000) -> None:
        """
        Empty, for configurations of `group`; beyond `capacity` the oldest are forgotten.
        """
    def __len__(self) -> int:
        ...
    def add(self, q: numpy.typing.ArrayLike) -> None:
        """
        Remembers a configuration (n,) with the base taken out: where the tool stood relative to the root, and the arm's joints.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes a text file. Raises IoError.
        """
    def seeds(self, T_world_tip: numpy.typing.ArrayLike, count: int = 8) -> numpy.typing.NDArray[numpy.float64]:
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
        """
        Pose of the sensor that the file gives (4, 4).
        """
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
        """
        Points in a row.
        """
class DepthImage:
    """
    What a depth camera saw: depth along the camera's axis [m], 0 where nothing was measured.
    """
    def __init__(self, depth: numpy.typing.ArrayLike, camera: PinholeCamera, T_world_camera: numpy.typing.ArrayLike | None = None) -> None:
        """
        `depth` (height, width) along the camera's axis [m], 0 where nothing was measured; `T_world_camera` (4, 4),
        default: the identity. Raises InvalidInput where the size is not the camera's.
        """
    def __repr__(self) -> str:
        ...
    def points(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3): every measured point in the world, row by row [m].
        """
    @property
    def T_world_camera(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the camera (4, 4); it looks along its +z.
        """
    @property
    def camera(self) -> PinholeCamera:
        """
        The camera that took it.
        """
    @property
    def depth(self) -> numpy.typing.NDArray[numpy.float32]:
        """
        (height, width) float32 [m]
        """
class HeightMap:
    """
    Heights over square cells, seen along -z of the map's frame [m].
    
        heights = mg.mapping.HeightMap(np.zeros((120, 160)), resolution=0.002)
    """
    def __init__(self, height: numpy.typing.ArrayLike, resolution: float, T_world_map: numpy.typing.ArrayLike | None = None) -> None:
        """
        From heights (ny, nx) [m], NaN where nothing is known; the frame lies in the middle of the rectangle.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_map(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Frame in the middle of the rectangle (4, 4), z up.
        """
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
        """
        Edge of a cell [m].
        """
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
        """
        Pose of its centre (4, 4): z along the plane's normal, x along the longer side.
        """
    @property
    def fill(self) -> float:
        """
        Share of the top rectangle that was seen: how box-like it is.
        """
    @property
    def points(self) -> int:
        """
        Number of points it was fitted to.
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
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
        """
        Those with most points first.
        """
    @property
    def labels(self) -> list[int]:
        """
        One a point: its cuboid, -1 the plane, -2 left out.
        """
    @property
    def plane_found(self) -> bool:
        """
        A supporting plane was found, or given.
        """
    @property
    def plane_normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit normal of the plane (3,), upwards, in the points' frame.
        """
    @property
    def plane_offset(self) -> float:
        """
        plane_normal . x = plane_offset [m]
        """
class DepthNoise:
    """
    Standard deviation of a depth along the camera's axis [m]:
    
        constant + linear z + quadratic z^2 + slant z^slant_power theta^2 / (pi/2 - theta)^2
    
    with z the depth [m] and theta the angle of incidence [rad].
    """
    @staticmethod
    def stereo(focal: float, baseline: float, disparity_sigma: float) -> DepthNoise:
        """
        z^2 disparity_sigma / (focal baseline): `focal` and `disparity_sigma` in pixels, `baseline` [m], as
        in Khoshelham and Elberink, Sensors 12(2), 2012.
        """
    @staticmethod
    def structured_light() -> DepthNoise:
        """
        The first Kinect: Nguyen, Izadi, Lovell, 3DIMPVT 2012.
        """
    @staticmethod
    def time_of_flight() -> DepthNoise:
        """
        The second Kinect: Fankhauser et al., ICAR 2015.
        """
    def __init__(self, constant: float = 0.001, linear: float = 0.0, quadratic: float = 0.0, slant: float = 0.0, slant_power: float = 0.0) -> None:
        """
        The coefficients. Raises InvalidInput unless they are finite, `slant` is not negative and the standard
        deviation is positive at some depth; a camera checks its own range.
        """
    def __repr__(self) -> str:
        ...
    def sigma(self, depth: float, incidence: float = 0.0) -> float:
        """
        Standard deviation [m] at a depth [m] and an angle of incidence in [0, pi/2) [rad].
        """
    @property
    def constant(self) -> float:
        """
        [m]
        """
    @property
    def linear(self) -> float:
        """
        Per metre of depth.
        """
    @property
    def quadratic(self) -> float:
        """
        [1/m]
        """
    @property
    def slant(self) -> float:
        """
        Part of the slant at a depth of 1 m [m].
        """
    @property
    def slant_power(self) -> float:
        """
        How the slant's part grows with the depth.
        """
class DepthCamera:
    """
    A depth camera: what it sees and how well it measures.
    """
    def __init__(self, intrinsics: PinholeCamera, noise: DepthNoise = ..., name: str = 'camera', systematic: float = 0.0, systematic_scale: float = 0.0) -> None:
        """
        Frames of one `name` share their systematic error: an offset of all depths whose standard deviation is
        `systematic` [m], with `systematic_scale` times the depth beside it; it never averages away. Raises
        InvalidInput on values out of range.
        """
    def __repr__(self) -> str:
        ...
    @property
    def intrinsics(self) -> PinholeCamera:
        """
        Image size, focal lengths, principal point, range.
        """
    @property
    def name(self) -> str:
        """
        Frames of one name share their systematic error.
        """
    @property
    def noise(self) -> DepthNoise:
        """
        Standard deviation of each pixel.
        """
    @property
    def systematic(self) -> float:
        """
        Standard deviation of the offset of all depths [m].
        """
    @property
    def systematic_scale(self) -> float:
        """
        The same in proportion to the depth.
        """
class IntegrationReport:
    """
    What became of a frame; counts are of pixels.
    """
    def __repr__(self) -> str:
        ...
    @property
    def agreement(self) -> float:
        """
        Share of pixels that confirm an earlier frame where both see the same place; NaN when they have too little in common.
        """
    @property
    def contradicted(self) -> int:
        """
        Voxels at which the outlier gate shut.
        """
    @property
    def invalid(self) -> int:
        """
        NaN, infinite or negative, hence not measured.
        """
    @property
    def measured(self) -> int:
        """
        Pixels with a depth.
        """
    @property
    def new_blocks(self) -> int:
        """
        Blocks of 8 x 8 x 8 voxels that the map got.
        """
    @property
    def out_of_range(self) -> int:
        """
        Nearer or farther than the camera sees.
        """
    @property
    def outliers(self) -> int:
        """
        Apart from what their neighbours measured by more than the gate.
        """
    @property
    def too_noisy(self) -> int:
        """
        Standard deviation above a third of the truncation.
        """
    @property
    def too_slanted(self) -> int:
        """
        Incidence above max_incidence.
        """
    @property
    def used(self) -> int:
        """
        Pixels whose surface went into the map.
        """
    @property
    def warning(self) -> str:
        """
        What looks wrong but was integrated, or empty.
        """
    @property
    def without_normal(self) -> int:
        """
        Too few neighbours on the same surface.
        """
class SdfHits:
    """
    Where rays meet the surface of a ProbabilisticSdf; NaN where they do not.
    """
    def __repr__(self) -> str:
        ...
    @property
    def distance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) along the ray, in multiples of the direction's length.
        """
    @property
    def hit(self) -> numpy.typing.NDArray[numpy.bool_]:
        """
        (n,) whether the ray meets a seen surface.
        """
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) unit normals, away from the solid.
        """
    @property
    def point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m]
        """
    @property
    def sigma(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) standard deviation of the surface along its normal [m].
        """
class ProbabilisticSdf:
    """
    A map of surfaces seen by depth cameras: the signed distance of every voxel near a surface as a normal
    distribution (P3 4.5.2, 4.5.3), positive in front. The order of frames does not matter beyond the rounding of
    floats; what lies deeper than the truncation behind a surface stays unknown.
    """
    @staticmethod
    def load(path: str | os.PathLike[str], threads: int = 0) -> ProbabilisticSdf:
        """
        Reads what save() wrote. Raises IoError when it is no map, of another version, truncated or damaged.
        """
    def __init__(self, *, voxel: float = 0.002, truncation: float = 0.01, distance: typing.Literal['to_plane', 'along_ray'] = 'to_plane', max_incidence: float = 1.05, outlier_gate: float = 0.0, persistence: int = 254, max_memory: float = 2000000000.0, threads: int = 0) -> None:
        """
        An empty map.
        
        Keyword options:
            voxel: float = 0.002  # distance of neighbouring voxels [m]
            truncation: float = 0.01  # voxels farther from a depth are not updated by it [m]; at least 3 voxels
            distance: typing.Literal['to_plane', 'along_ray'] = 'to_plane'  # to the plane through the measured point, or along the ray as in P3 (4.12)
            max_incidence: float = 1.05  # what is seen more slanted is not used [rad]
            outlier_gate: float = 0.0  # depths farther than this many standard deviations from what their neighbours, or three earlier frames, say are left out; 0: none are
            persistence: int = 254  # most frames by which a surface can be ahead of those that looked through it, or behind
            max_memory: float = 2000000000.0  # a frame that would need more is refused [bytes]
            threads: int = 0  # 0: all
        """
    def __repr__(self) -> str:
        ...
    def cast_rays(self, origins: numpy.typing.ArrayLike, directions: numpy.typing.ArrayLike, threads: int = 0) -> SdfHits:
        """
        The first surface from the front along each ray, (n, 3) both. Unknown space does not stop a ray.
        """
    def distances(self, points: numpy.typing.ArrayLike, sigmas: float = 2.0, unknown: typing.Literal['unknown', 'free', 'occupied'] = 'unknown') -> numpy.typing.NDArray[numpy.float64]:
        """
        mean - sigmas * sigma at `points` (n, 3), clipped to the truncation [m]. Where
        no camera saw: NaN, or free or occupied as deep as the truncation.
        """
    def integrate(self, image: DepthImage, camera: DepthCamera, *, pose_covariance: numpy.typing.ArrayLike | None = None, sigma: numpy.typing.ArrayLike | None = None) -> IntegrationReport:
        """
        Adds a frame. `pose_covariance` (6, 6): of the error of T_world_camera, displacement [m] first, then
        rotation vector about the camera's origin [rad], along the world's axes, independent from frame to frame.
        `sigma` (height, width): standard deviation of each depth [m] in place of the camera's noise.
        Raises InvalidInput, with the map as it was, for an image of another size or other intrinsics than the
        camera's, nothing measured, a wrong depth scale, poses that are no rigid motions or the wrong way round,
        another camera of a known name, depths all too noisy for the truncation, a map above max_memory.
        """
    def mesh(self) -> tuple[Mesh, numpy.typing.NDArray[numpy.float64]]:
        """
        (mesh, sigma): the zero level by marching cubes and the standard deviation at each vertex [m].
        """
    def obstacle_cells(self, sigmas: float = 2.0, *, unknown: typing.Literal['free', 'occupied'] = 'free', bounds: numpy.typing.ArrayLike | None = None) -> list[Voxels]:
        """
        What World.add_sdf() adds: one Voxels per edge length, finest first.
        """
    def points(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        (points, normals, sigma) of the surface: (n, 3), (n, 3), (n,).
        """
    def query(self, points: numpy.typing.ArrayLike, threads: int = 0) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.bool_]]:
        """
        (mean, sigma, known) at `points` (n, 3): signed distance and its standard deviation [m], NaN where unknown.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes a file of its own format. Raises IoError naming it.
        """
    @property
    def blocks(self) -> int:
        """
        Blocks of 8 x 8 x 8 voxels.
        """
    @property
    def frames(self) -> int:
        """
        Integrated so far.
        """
    @property
    def memory(self) -> int:
        """
        Size of the blocks and their index [bytes].
        """
    @property
    def truncation(self) -> float:
        """
        Voxels farther from a depth are not updated by it [m].
        """
    @property
    def voxel(self) -> float:
        """
        Distance of neighbouring voxels [m].
        """
class FrameRegistration:
    """
    Where a frame's camera stood, by what a map holds.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_camera(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @property
    def compared(self) -> int:
        """
        Pixels that were looked for in the map.
        """
    @property
    def correction(self) -> float:
        """
        From the given pose, in its standard deviations.
        """
    @property
    def covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6, 6) of the pose's error, as `pose_covariance` of ProbabilisticSdf.integrate().
        """
    @property
    def iterations(self) -> int:
        """
        Steps of Gauss-Newton.
        """
    @property
    def matched(self) -> int:
        """
        Compared pixels that met its surface and agree with it in the end.
        """
    @property
    def observed(self) -> int:
        """
        Directions of the six that the surface fixes.
        """
    @property
    def reason(self) -> str:
        """
        Why it was refused, or empty.
        """
    @property
    def registered(self) -> bool:
        """
        Else the pose is the given one, and `reason` says why.
        """
    @property
    def rms(self) -> float:
        """
        The same at the registered one [m].
        """
    @property
    def rms_before(self) -> float:
        """
        Distance of the matched pixels from the map at the given pose [m].
        """
class OccupancyReport:
    """
    What became of a frame; counts are of pixels.
    """
    def __repr__(self) -> str:
        ...
    @property
    def invalid(self) -> int:
        """
        NaN, infinite or negative, hence not measured.
        """
    @property
    def measured(self) -> int:
        """
        Pixels with a depth.
        """
    @property
    def out_of_range(self) -> int:
        """
        Nearer or farther than the camera sees.
        """
    @property
    def used(self) -> int:
        """
        Pixels whose ray went into the map.
        """
class OccupancyMap:
    """
    An octree of free, occupied and unknown cells, filled by OctoMap's ray insertion from the depth images that a
    ProbabilisticSdf takes: surfaces are coarser, and it knows also which space was looked through.
    """
    @staticmethod
    def load(path: str | os.PathLike[str], *, resolution: float = 0.02, hit: float = 0.7, miss: float = 0.4, max_range: float = ...) -> OccupancyMap:
        """
        Reads an OctoMap file, whose resolution replaces the one given. Raises IoError when it is missing, another
        kind of tree, truncated or damaged.
        
        Keyword options:
            resolution: float = 0.02  # edge of the smallest cell [m]
            hit: float = 0.7  # probability of being occupied that a cell gets from one depth in it; in (0.5, 1)
            miss: float = 0.4  # the same from a ray through it; in (0, 0.5)
            max_range: float = inf  # of a longer ray only the first part counts, as free [m]
        """
    def __init__(self, *, resolution: float = 0.02, hit: float = 0.7, miss: float = 0.4, max_range: float = ...) -> None:
        """
        An empty map.
        
        Keyword options:
            resolution: float = 0.02  # edge of the smallest cell [m]
            hit: float = 0.7  # probability of being occupied that a cell gets from one depth in it; in (0.5, 1)
            miss: float = 0.4  # the same from a ray through it; in (0, 0.5)
            max_range: float = inf  # of a longer ray only the first part counts, as free [m]
        """
    def __repr__(self) -> str:
        ...
    def integrate(self, image: DepthImage, camera: DepthCamera) -> OccupancyReport:
        """
        Casts a ray through every measured pixel in range; every cell changes at most once. Raises InvalidInput,
        with the map as it was, for an image of another size or other intrinsics than the camera's, nothing
        measured, a wrong depth scale, a pose that is no rigid motion, ends beyond 32767 cells from the origin.
        """
    def obstacle_cells(self, *, unknown: typing.Literal['free', 'occupied'] = 'free', bounds: numpy.typing.ArrayLike | None = None) -> list[Voxels]:
        """
        What World.add_occupancy() adds: one Voxels per edge length, finest first.
        """
    def query(self, points: numpy.typing.ArrayLike) -> tuple[numpy.typing.NDArray[numpy.bool_], numpy.typing.NDArray[numpy.bool_]]:
        """
        (occupied, known) at `points` (n, 3) [m]: free where known and not occupied.
        """
    def save(self, path: str | os.PathLike[str]) -> None:
        """
        Writes OctoMap's format: .bt (occupied or free) or .ot (with probabilities). Raises IoError naming the file.
        """
    @property
    def bounds(self) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
        """
        (lower, upper) corner of the known cells [m]. Raises InvalidInput while nothing is known.
        """
    @property
    def cells(self) -> int:
        """
        Leaves, free and occupied.
        """
    @property
    def frames(self) -> int:
        """
        Integrated since it was made or loaded.
        """
    @property
    def memory(self) -> int:
        """
        [bytes]
        """
    @property
    def resolution(self) -> float:
        """
        Edge of the smallest cell [m].
        """
class SupportingPlane:
    """
    A plane that objects stand on: normal . x = offset.
    """
    def __init__(self, normal: numpy.typing.ArrayLike, offset: float) -> None:
        """
        `normal` (3,) towards the objects, of any length; `offset` along it [m].
        """
    def __repr__(self) -> str:
        ...
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Unit normal (3,), towards the objects.
        """
    @property
    def offset(self) -> float:
        """
        normal . x = offset [m]
        """
class SegmentedObject:
    """
    An object that was found on a plane.
    """
    def __repr__(self) -> str:
        ...
    @property
    def indices(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Indices of its points (n,), ascending.
        """
    @property
    def lower(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Lower corner of its points' bounds (3,) [m].
        """
    @property
    def upper(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Upper corner of its points' bounds (3,) [m].
        """
class ObjectSegmentation:
    """
    The supporting plane, the objects on it, and which point belongs to what.
    """
    def __repr__(self) -> str:
        ...
    @property
    def labels(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (n,): the object of each point, -1 the plane, -2 left out or not measured. Images: row by row.
        """
    @property
    def objects(self) -> list[SegmentedObject]:
        """
        Those with most points first.
        """
    @property
    def plane(self) -> SupportingPlane | None:
        """
        Found or given; None where there is none, and then no objects.
        """
    @property
    def plane_inliers(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Indices (n,) of the points that belong to the plane, ascending.
        """
    @property
    def warning(self) -> str:
        """
        What makes the answer doubtful, or empty.
        """
class ScrewThread:
    """
    A screw thread that segment_mesh found.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_mesh_thread(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4): z along the axis, origin at the middle of the thread.
        """
    @property
    def crest_radius(self) -> float:
        """
        [m]; smaller than the root's in a nut.
        """
    @property
    def faces(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Faces of the mesh (n,), ascending.
        """
    @property
    def length(self) -> float:
        """
        Along the axis [m].
        """
    @property
    def pitch(self) -> float:
        """
        Along the axis in one turn [m]; positive: right-handed.
        """
    @property
    def root_radius(self) -> float:
        """
        [m]
        """
class MeshSegment:
    """
    One of the simple bodies that a part is composed of.
    """
    def __repr__(self) -> str:
        ...
    @property
    def area(self) -> float:
        """
        [m^2]
        """
    @property
    def diameter(self) -> float:
        """
        Median of its faces' shape diameters by area [m].
        """
    @property
    def faces(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Faces of the mesh (n,), ascending.
        """
    @property
    def threaded(self) -> bool:
        """
        More than a tenth of its area is screw thread, which must not be grasped.
        """
class GraspWidth:
    """
    A width at which fingers may close on a segment.
    """
    def __repr__(self) -> str:
        ...
    @property
    def axis(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Closing direction of a box, axis of a round wall (3,): a unit vector in the mesh's frame.
        """
    @property
    def covered(self) -> float:
        """
        Share of the box' shadow along the axis on which facets lie opposite each other, or of the turn around the wall that is surface.
        """
    @property
    def width(self) -> float:
        """
        [m]
        """
class FittedPrimitive:
    """
    The primitive that stands for a segment (P1, section 5.2.2).
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_mesh_primitive(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4): centre; z along the axis of a cylinder or cone, which narrows along z.
        """
    @property
    def deviation(self) -> float:
        """
        Mean distance of the segment's faces from the primitive's surface that they lie on [m].
        """
    @property
    def hull_volume(self) -> float:
        """
        Volume of the segment's convex hull [m^3].
        """
    @property
    def kind(self) -> str:
        """
        cylinder, box, cone or sphere.
        """
    @property
    def size(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) [m]: lengths of a box; diameter twice and length of a cylinder; diameters at foot and top and length of a cone; diameter of a sphere.
        """
    @property
    def volume(self) -> float:
        """
        Volume of the primitive [m^3].
        """
    @property
    def widths(self) -> list[GraspWidth]:
        """
        Most covered first; empty where there is no surface to hold.
        """
class MeshSegmentation:
    """
    The bodies that a part is composed of, and which face belongs to which.
    """
    def __repr__(self) -> str:
        ...
    @property
    def clusters(self) -> int:
        """
        Gaussians that the diameters called for.
        """
    @property
    def diameters(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Shape diameter of each face (m,) [m]; 0 where it is unknown.
        """
    @property
    def labels(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        Segment of each face (m,).
        """
    @property
    def outcome(self) -> Outcome:
        """
        Solved.
        """
    @property
    def segments(self) -> list[MeshSegment]:
        """
        Largest area first.
        """
    @property
    def threads(self) -> list[ScrewThread]:
        """
        Screw threads, largest first.
        """
    @property
    def turned(self) -> bool:
        """
        The mesh was inside out (open ones may be) and its faces were turned.
        """
class Graspability:
    """
    Grasps, best first, and what became of the other places checked.
    """
    def __repr__(self) -> str:
        ...
    @property
    def counts(self) -> mmgrasp.records.GraspabilityCounts:
        """
        Places checked (tried) and rejected: too_wide, poor, collision, near_better.
        """
    @property
    def grasps(self) -> list[Grasp]:
        """
        Best first.
        """
class RestingPose:
    """
    How a part may lie on a level floor.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_floor_part(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose (4, 4): centre of mass above the origin, lowest point at height 0.
        """
    @property
    def probability(self) -> float:
        """
        All of a part's sum to 1.
        """
class PlacedPart:
    """
    A part lying in a tray.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_tray_part(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Pose of the part in the tray's frame (4, 4).
        """
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
        """
        The parts in the order in which they were placed.
        """
class GraspSuccess:
    """
    Share of each criterion in a grasp's success (P3 4.5 to 4.9), in [0, 1].
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All of it by name.
        """
    @property
    def angle(self) -> float:
        """
        P_1: the pads face their patches.
        """
    @property
    def centring(self) -> float:
        """
        P_3: the contact line passes by the object's middle.
        """
    @property
    def certainty(self) -> float:
        """
        P_4: the surface is certain where it is touched.
        """
    @property
    def force_closure(self) -> bool:
        """
        The contact line lies in both friction cones.
        """
    @property
    def placement(self) -> float:
        """
        P_2: the pads are as far from the surface as wanted.
        """
    @property
    def probability(self) -> float:
        """
        `weighted`; 0 without force closure or where the angle or certainty is 0.
        """
    @property
    def weighted(self) -> float:
        """
        (4.9) as printed.
        """
class ContactPatch:
    """
    What a finger's pad meets if it moves on along its normal, in the world.
    """
    def __repr__(self) -> str:
        ...
    @property
    def distance(self) -> float:
        """
        From the pad, on average [m].
        """
    @property
    def hits(self) -> float:
        """
        Share of the pad's rays that meet the surface.
        """
    @property
    def inliers(self) -> float:
        """
        Share of the hits that lie in the plane.
        """
    @property
    def nearest(self) -> float:
        """
        From the pad to what it touches first [m].
        """
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Away from the object.
        """
    @property
    def pad_normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The way the pad pushes.
        """
    @property
    def point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the patch [m].
        """
    @property
    def sigma(self) -> float:
        """
        Standard deviation of the surface, on average [m].
        """
class DrawnSuccess:
    """
    The whole probability (4.1) by drawing surfaces from the map.
    """
    def __repr__(self) -> str:
        ...
    @property
    def holds(self) -> float:
        """
        Share of the surfaces on which the grasp has force closure.
        """
    @property
    def probability(self) -> float:
        """
        Mean success over the drawn surfaces.
        """
    @property
    def standard_error(self) -> float:
        """
        Standard error of that mean.
        """
class GraspRating:
    """
    How a grasp of synthesize_grasps was rated.
    """
    def __repr__(self) -> str:
        ...
    @property
    def drawn(self) -> DrawnSuccess | None:
        """
        The whole probability (4.1); None unless `surface_draws` was given.
        """
    @property
    def patches(self) -> list[ContactPatch]:
        """
        One a finger.
        """
    @property
    def pretouch_opening(self) -> float:
        """
        Between the pads before they close [m].
        """
    @property
    def pretouch_posture(self) -> list[float]:
        """
        The same of hands with several joint groups.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        The arm's configuration before closing; None without an arm.
        """
    @property
    def success(self) -> GraspSuccess:
        """
        Share of each criterion.
        """
class LineGrasp:
    """
    P3's grasp in one dimension (4.4.2, figures 4.5 and 4.6): a parallel gripper on a line, and an object whose place is uncertain.
    """
    def __init__(self, width: float = 0.2, max_opening: float = 0.4) -> None:
        """
        The object's width, and the gripper's largest opening [m].
        """
    def __repr__(self) -> str:
        ...
    def probability(self, opening: float, position: float, mean: float, sigma: float) -> float:
        """
        P(S) of (4.1) for an object at N(mean, sigma^2), in closed form.
        """
    def success(self, opening: float, position: float, object: float) -> float:
        """
        P(S | x, G) of (4.3) and (4.4) for an object at a known place [m].
        """
    @property
    def max_opening(self) -> float:
        """
        The gripper's largest opening [m].
        """
    @property
    def width(self) -> float:
        """
        The object's width [m].
        """
class GraspSynthesis:
    """
    Grasps of an unknown part, most probable first, and why others were left out.
    """
    def __repr__(self) -> str:
        ...
    def summary(self) -> str:
        """
        One sentence: how many grasps, or what most of those tried failed on.
        """
    @property
    def arm(self) -> Rejections:
        """
        Why the arm did not reach grasps.
        """
    @property
    def counts(self) -> mmgrasp.records.SynthesisCounts:
        """
        Surface points drawn and grasps evaluated, by what became of them.
        """
    @property
    def grasps(self) -> list[Grasp]:
        """
        Most probable first; T_object_hand is the pose in the world.
        """
    @property
    def median_too_wide(self) -> float:
        """
        Median distance of opposite walls that are farther apart than that [m]; 0: none.
        """
    @property
    def object_centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Middle of the box fitted to the map's points [m].
        """
    @property
    def object_longest(self) -> float:
        """
        Its longest side [m].
        """
    @property
    def opens(self) -> float:
        """
        Largest opening of the hand [m].
        """
    @property
    def outcome(self) -> Outcome:
        """
        solved, not_found or stopped.
        """
    @property
    def ratings(self) -> list[GraspRating]:
        """
        Ratings of the grasps, in the same order.
        """
class ViewCandidate:
    """
    A camera pose and what is expected of it.
    """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_camera(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @property
    def certain(self) -> float:
        """
        How much surface would be certain, in shares of the candidate with most.
        """
    @property
    def probability(self) -> float:
        """
        Best grasp's, once the frame is in the map.
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The arm's configuration; empty without an arm.
        """
    @property
    def unseen(self) -> float:
        """
        Share of the object's pixels that would show what the map does not know.
        """
class NextView:
    """
    Where to look next.
    """
    def __repr__(self) -> str:
        ...
    @property
    def arm(self) -> Rejections:
        """
        Why the arm did not reach others.
        """
    @property
    def candidates(self) -> list[ViewCandidate]:
        """
        Those within reach, the best first.
        """
    @property
    def outcome(self) -> Outcome:
        """
        solved, not_found (the arm reaches no pose) or stopped.
        """
    @property
    def probability_now(self) -> float:
        """
        Best grasp's in the map as it is; 0: there is none.
        """
class Pipe:
    """
    A pipe structure: straight round sections between nodes in the object's frame (P2 3.2.2).
    
        pipe = mg.grasping.Pipe([[0, 0, 0], [0.4, 0, 0], [0.4, 0.3, 0]], [[0, 1], [1, 2]], 0.028)
        grasps = pipe.sample_grasps(500)
    """
    def __init__(self, nodes: numpy.typing.ArrayLike, sections: collections.abc.Sequence[typing.Annotated[collections.abc.Sequence[int], "FixedSize(2)"]], diameters: float | collections.abc.Sequence[float]) -> None:
        """
        (n, 3) nodes [m], pairs of node indices from 0, and outer diameters [m]: one for all or one a section.
        """
    def __repr__(self) -> str:
        ...
    def grasp(self, section: int, length: float, angle: float, flipped: bool = False, *, gripper: Hand | None = None, max_opening: float = 0.1, end_margin: float = 0.02, length_spacing: float = 0.01, angle_spacing: float = 0.08726646259971647, cost_per_metre: float = 0.0, draws: int = 200, seed: int = 1) -> Grasp:
        """
        The grasp with these four variables (P2 3.2.3.1).
        
        Keyword options:
            max_opening: float = 0.1  # thicker sections get no grasps [m]
            end_margin: float = 0.02  # kept from either node of a section [m]
            length_spacing: float = 0.01  # grasps are this far apart along a section [m], or
            angle_spacing: float = 0.08726646259971647  # this far apart in angle [rad]
            cost_per_metre: float = 0.0  # cost for the distance from the centre of mass [1/m]
            draws: int = 200  # fruitless draws in a row that end the sampling
            seed: int = 1  # same seed, same grasps
        """
    def sample_grasps(self, count: int, *, gripper: Hand | None = None, max_opening: float = 0.1, end_margin: float = 0.02, length_spacing: float = 0.01, angle_spacing: float = 0.08726646259971647, cost_per_metre: float = 0.0, draws: int = 200, seed: int = 1) -> list[Grasp]:
        """
        Grasps drawn over the whole pipe, at most `count`, none nearer to another than the spacings. Axes are the gripper's,
        or approach x and closing y; so are opening and margin where no keyword gives them.
        
        Keyword options:
            max_opening: float = 0.1  # thicker sections get no grasps [m]
            end_margin: float = 0.02  # kept from either node of a section [m]
            length_spacing: float = 0.01  # grasps are this far apart along a section [m], or
            angle_spacing: float = 0.08726646259971647  # this far apart in angle [rad]
            cost_per_metre: float = 0.0  # cost for the distance from the centre of mass [1/m]
            draws: int = 200  # fruitless draws in a row that end the sampling
            seed: int = 1  # same seed, same grasps
        """
    def shapes(self, *, flat_ends: bool = False) -> list[LinkShape]:
        """
        LinkShapes in the object's frame: a capsule a section; with flat_ends cylinders and balls at the bends.
        """
    @property
    def centre_of_mass(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centre of mass of tubes with equal walls [m].
        """
    @property
    def diameters(self) -> list[float]:
        """
        Outer diameter of each section [m].
        """
    @property
    def lengths(self) -> list[float]:
        """
        Lengths of the sections [m].
        """
    @property
    def nodes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) in the object's frame [m].
        """
    @property
    def sections(self) -> list[tuple[int, int]]:
        """
        First and second node of each section, counted from 0.
        """
class BeamMaterial:
    """
    What a beam is made of.
    """
    def __init__(self, density: float, youngs_modulus: float, shear_modulus: float, stress_limit: float = 0.0) -> None:
        """
        [kg/m3], [Pa], [Pa], and the von Mises stress it may bear [Pa] (0: no limit is given).
        """
    @property
    def density(self) -> float:
        """
        [kg/m3]
        """
    @property
    def shear_modulus(self) -> float:
        """
        [Pa]
        """
    @property
    def stress_limit(self) -> float:
        """
        [Pa]; 0: none is given.
        """
    @property
    def youngs_modulus(self) -> float:
        """
        [Pa]
        """
class BeamSection:
    """
    Cross section of a beam along x: see round_section and rectangular_section.
    """
    def __init__(self, area: float, iy: float, iz: float, torsion: float) -> None:
        """
        Any section by its area [m2], second moments about y and z and torsion constant [m4]; no stress is known.
        """
    @property
    def area(self) -> float:
        """
        [m2]
        """
    @property
    def iy(self) -> float:
        """
        Second moment about y, for bending in z [m4].
        """
    @property
    def iz(self) -> float:
        """
        Second moment about z, for bending in y [m4].
        """
    @property
    def torsion(self) -> float:
        """
        Torsion constant J [m4].
        """
class BeamMember:
    """
    A straight beam welded to its two nodes.
    """
    def __init__(self, first: int, second: int, section: BeamSection, material: BeamMaterial, y_towards: numpy.typing.ArrayLike | None = None) -> None:
        """
        Nodes by index from 0; `y_towards`: the section's y is this direction turned across the member (None: the
        object's z, or its x for members along z).
        """
    @property
    def material(self) -> BeamMaterial:
        """
        What it is made of.
        """
    @property
    def nodes(self) -> tuple[int, int]:
        """
        First and second node.
        """
    @property
    def section(self) -> BeamSection:
        """
        Its cross section.
        """
class NodeLoad:
    """
    What hangs on a node: a mass (valve, flange), a force, a moment.
    """
    def __init__(self, node: int, mass: float = 0.0, force: numpy.typing.ArrayLike = (0.0, 0.0, 0.0), moment: numpy.typing.ArrayLike = (0.0, 0.0, 0.0)) -> None:
        """
        The mass's weight turns with gravity [kg]; force [N] and moment [N m] stay in the object's frame.
        """
    @property
    def force(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Force in the object's frame [N].
        """
    @property
    def mass(self) -> float:
        """
        [kg]
        """
    @property
    def moment(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Moment in the object's frame [N m].
        """
    @property
    def node(self) -> int:
        """
        Index of the node.
        """
class BeamSupport:
    """
    Where a frame is held: a hand, a fixture.
    """
    def __init__(self, member: int, distance: float, fixed: typing.Annotated[collections.abc.Sequence[bool], "FixedSize(6)"] = (True, True, True, True, True, True)) -> None:
        """
        Distance along the member [m]; which of displacement in x, y, z and rotation about them (object's frame)
        are hindered: all, a clamp.
        """
    @property
    def distance(self) -> float:
        """
        From the member's first node [m].
        """
    @property
    def fixed(self) -> list[bool]:
        """
        Displacement in x, y, z, rotation about x, y, z.
        """
    @property
    def member(self) -> int:
        """
        Index of the member.
        """
class BeamExtreme:
    """
    A place on a frame and a value there.
    """
    def __repr__(self) -> str:
        ...
    @property
    def distance(self) -> float:
        """
        From the member's first node [m].
        """
    @property
    def member(self) -> int:
        """
        Index of the member.
        """
    @property
    def value(self) -> float:
        """
        [m], [Pa] or a ratio.
        """
class BeamState:
    """
    How a held frame bends under one load; all in the object's frame.
    """
    @property
    def displacement(self) -> BeamExtreme:
        """
        The largest anywhere along the members [m].
        """
    @property
    def nodes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) displacement [m] and rotation [rad] of each node.
        """
    @property
    def over_limit(self) -> BeamExtreme | None:
        """
        Largest stress over its material's limit: above 1 it yields. None without a limit.
        """
    @property
    def reactions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (supports, 6) force [N] and moment [N m] of each support on the frame.
        """
    @property
    def stress(self) -> BeamExtreme | None:
        """
        Largest von Mises stress [Pa]; None where sections are not known.
        """
class BeamFrame:
    """
    Straight Euler-Bernoulli beams welded at nodes, in the object's frame (P2 3.2.3.3.2).
    
        pipe = mg.grasping.Pipe([[0, 0, 0], [0.4, 0, 0], [0.4, 0.3, 0]], [[0, 1], [1, 2]], 0.028)
        frame = mg.grasping.beam_frame(pipe, inner_diameter=0.026, material=mg.grasping.copper())
        state = frame.deflection(pipe.grasp(0, 0.2, 0.0), np.eye(4))
    """
    def __init__(self, nodes: numpy.typing.ArrayLike, members: collections.abc.Sequence[BeamMember], loads: collections.abc.Sequence[NodeLoad] = []) -> None:
        """
        (n, 3) nodes [m], BeamMembers, and NodeLoads. See beam_frame for a Pipe.
        """
    def __repr__(self) -> str:
        ...
    def deflection(self, grasp: Grasp | BeamSupport | collections.abc.Sequence[Grasp | BeamSupport], T_world_object: numpy.typing.ArrayLike, *, gravity: float = 9.81) -> BeamState:
        """
        How it bends when it is held there in this pose: by one grasp of a pipe, or by several, or by supports.
        """
    def split(self, member: int, distance: float) -> BeamFrame:
        """
        The same frame with one node more; it bends as before.
        """
    def stiffness(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6n, 6n) of the free frame, node by node, in the object's frame.
        """
    @property
    def centre_of_mass(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [m]
        """
    @property
    def loads(self) -> list[NodeLoad]:
        """
        What hangs on nodes.
        """
    @property
    def mass(self) -> float:
        """
        Mass of members and loads [kg].
        """
    @property
    def members(self) -> list[BeamMember]:
        """
        The beams.
        """
    @property
    def nodes(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) in the object's frame [m].
        """
class SupportedFrame:
    """
    A frame held at some places, factorised once for all orientations.
    """
    def __init__(self, frame: BeamFrame, supports: Grasp | BeamSupport | collections.abc.Sequence[Grasp | BeamSupport]) -> None:
        """
        Clamped by grasps of a pipe, or held as supports say.
        """
    def displacement(self, gravity: numpy.typing.ArrayLike, member: int, distance: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        (3,) of a point on a member, in the object's frame [m].
        """
    def largest_displacement(self, gravity: numpy.typing.ArrayLike) -> BeamExtreme:
        """
        The displacement of state() alone: quicker.
        """
    def section_forces(self, gravity: numpy.typing.ArrayLike, member: int, distance: float) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) N, Vy, Vz [N], torque, My, Mz [N m] in the member's frame at a cut.
        """
    def state(self, gravity: numpy.typing.ArrayLike) -> BeamState:
        """
        Under gravity given in the object's frame [m/s2].
        """
class ObjectPathResult:
    """
    What one grasp costs along a path of the object, and the arm's motion.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        Everything as plain values.
        """
    @property
    def configurations(self) -> int:
        """
        Arm configurations found over all poses.
        """
    @property
    def cost(self) -> float:
        """
        Weighted sum of the objectives over their scales; 0 unless solved.
        """
    @property
    def deflection(self) -> float:
        """
        O2: sum of the largest displacements after the first pose [m].
        """
    @property
    def force_manipulability(self) -> float:
        """
        O3: its sum along the tool's motion.
        """
    @property
    def gaps(self) -> list[int]:
        """
        When every pose is reached but there is no path: for each pose but the last how the next is missed.
        0 it is not, 1 every motion jumps to another posture, 2 those that do not collide or leave the path.
        """
    @property
    def joint_motion(self) -> float:
        """
        O1: sum of joint-space distances [rad or m].
        """
    @property
    def outcome(self) -> Outcome:
        """
        solved or not_found.
        """
    @property
    def overloaded(self) -> list[int]:
        """
        Poses at which it bends or bears more than it may.
        """
    @property
    def path(self) -> numpy.typing.NDArray[numpy.float64] | typing.Any:
        """
        (poses, n) configurations, or None.
        """
    @property
    def refused_edges(self) -> int:
        """
        Motions between poses that collide or leave the path.
        """
    @property
    def rejections(self) -> Rejections:
        """
        Configurations rejected, by cause.
        """
    @property
    def sag(self) -> list[float]:
        """
        Largest displacement at each pose [m].
        """
    @property
    def violation(self) -> int:
        """
        P2's Cost(C); 0 if and only if solved.
        """
    @property
    def violations(self) -> list[int]:
        """
        For each pose: 2 out of reach, 1 in collision, 0 neither.
        """
class ObjectPathProblem:
    """
    A robot that carries an object along given poses (P2 3.2.1).
    """
    def __init__(self, group: JointGroup, world: World, object: collections.abc.Sequence[LinkShape], T_world_object: numpy.typing.ArrayLike, *, gripper: Hand | None = None, touch_links: collections.abc.Sequence[str] = [], frame: BeamFrame | None = None, object_name: str = 'object') -> None:
        """
        `object`: LinkShapes in its own frame; `world` is without it. `T_world_object` (m, 4, 4): where it lies,
        then where it goes. With `gripper` the fingers open as the grasp says; `frame`: how the object bends.
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_world_object(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (m, 4, 4)
        """
    @property
    def group(self) -> JointGroup:
        """
        Its tip is the tool frame of grasps.
        """
    @property
    def world(self) -> World:
        """
        Without the object.
        """
class ObjectPathEvaluator:
    """
    Costs many grasps along one path: prepared once. Not for several threads at a time.
    """
    def __init__(self, problem: ObjectPathProblem, *, motion_weight: float = 0.587, deflection_weight: float = 0.089, manipulability_weight: float = 0.324, motion_scale: float = 1.0, deflection_scale: float = 0.001, manipulability_scale: float = 1.0, max_joint_step: float = 0.5, position_tolerance: float = 0.01, rotation_tolerance: float = 0.05, edge_step: float = 0.02, check_edges: bool = True, single_configuration: bool = False, all_turns: bool = True, redundant_values: int = 0, base_spacing: float = 0.2, base_headings: int = 4, gravity: float = 9.81, max_sag: float = 0.0) -> None:
        """
        Prepares robot, world and object.
        
        Keyword options:
            motion_weight: float = 0.587  # weight of O1, the joints' motion
            deflection_weight: float = 0.089  # weight of O2, the largest displacements
            manipulability_weight: float = 0.324  # weight of O3, the force manipulability
            motion_scale: float = 1.0  # O1 is divided by it [rad or m]
            deflection_scale: float = 0.001  # O2 is divided by it [m]
            manipulability_scale: float = 1.0  # O3 is divided by it
            max_joint_step: float = 0.5  # more from pose to pose is a jump, refused [rad or m]
            position_tolerance: float = 0.01  # of the object half way between poses [m]
            rotation_tolerance: float = 0.05  # of the object half way between poses [rad]
            edge_step: float = 0.02  # largest joint step between collision checks [rad or m]
            check_edges: bool = True  # check motions between poses for collisions
            single_configuration: bool = False  # one arm configuration a pose (P2's single IK)
            all_turns: bool = True  # joints that may turn more than once come in every turn
            redundant_values: int = 0  # samples of a seventh joint, evenly over its range; 0: 24
            base_spacing: float = 0.2  # grid of the places where a moving base may stand [m]
            base_headings: int = 4  # headings of the base at each place, evenly over a turn
            gravity: float = 9.81  # along the world's -z [m/s2]
            max_sag: float = 0.0  # largest displacement allowed at any pose [m]; 0: any
        """
    def evaluate(self, grasp: Grasp) -> ObjectPathResult:
        """
        The least cost over all arm configurations, or how far the grasp is from allowed.
        """
class FeasibleGrasp:
    """
    A grasp with which the whole path can be followed.
    """
    @property
    def deflection(self) -> float:
        """
        O2 [m]
        """
    @property
    def force_manipulability(self) -> float:
        """
        O3
        """
    @property
    def grasp(self) -> Grasp:
        """
        Its cost is that of the path.
        """
    @property
    def joint_motion(self) -> float:
        """
        O1 [rad or m]
        """
class GraspOptimum:
    """
    The best grasp that a search found, and all others that will do.
    """
    def __repr__(self) -> str:
        ...
    def sag_candidates(self) -> list[Grasp]:
        """
        Every feasible grasp with its mean sag [m] as its cost: candidates for plan_manipulation, whose `max_length`
        then takes the one that sags least among those whose motion is short enough.
        """
    @property
    def boxes(self) -> int:
        """
        Boxes of grasps that branch_and_bound bounded.
        """
    @property
    def colliding(self) -> list[int]:
        """
        For each pose at how many all arm configurations collide.
        """
    @property
    def colliding_after(self) -> list[int]:
        """
        The same where each motion that does not jump collides or leaves the path.
        """
    @property
    def evaluations(self) -> int:
        """
        Grasps tried.
        """
    @property
    def feasible(self) -> list[FeasibleGrasp]:
        """
        Every feasible grasp seen, the cheapest first.
        """
    @property
    def front(self) -> list[int]:
        """
        The Pareto front among them, ascending in O1.
        """
    @property
    def gap(self) -> float:
        """
        How much cheaper another could be at most, as a share of the cost; 1: unknown.
        """
    @property
    def grasp(self) -> Grasp | None:
        """
        The best grasp, or None.
        """
    @property
    def history(self) -> list[float]:
        """
        Best cost after each of them; infinite while none was feasible.
        """
    @property
    def jumping_after(self) -> list[int]:
        """
        For each pose but the last: with how many grasps that reach every pose all motions to the next one
        jump to another posture of the arm.
        """
    @property
    def lower_bound(self) -> float:
        """
        No grasp costs less; 0 where nothing was proven.
        """
    @property
    def outcome(self) -> Outcome:
        """
        solved: proven to the gap asked for, or it meets the target; approximate: the best seen;
        infeasible: proven that no grasp can follow the path.
        """
    @property
    def overloaded(self) -> list[int]:
        """
        For each pose with how many the pipe bends or bears more than it may.
        """
    @property
    def path(self) -> ObjectPathResult:
        """
        As follow_object_path gives it.
        """
    @property
    def unreachable(self) -> list[int]:
        """
        For each pose how many of the grasps tried do not reach it.
        """
class PlacedMesh:
    """
    A part where it is in its subassembly. Closed meshes are solids.
    """
    def __init__(self, name: str, mesh: Mesh, pose: numpy.typing.ArrayLike | None = None) -> None:
        """
        Name for messages, mesh, T_subassembly_mesh (4, 4).
        """
    def __repr__(self) -> str:
        ...
    @property
    def mesh(self) -> Mesh:
        """
        As given.
        """
    @property
    def name(self) -> str:
        """
        For messages.
        """
    @property
    def pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_subassembly_mesh, (4, 4).
        """
class AssemblyOperation:
    """
    One operation of an assembly (P1 5.3.1): a gripper brings the active subassembly to the passive one, lets go of it and moves back along its approach.
    
        AssemblyOperation([PlacedMesh("sleeve", sleeve)], [PlacedMesh("shaft", shaft)],
                          [mg.pose([0, 0, 0.1]), mg.pose([0, 0, 0])])
    """
    def __init__(self, active: collections.abc.Sequence[PlacedMesh], passive: collections.abc.Sequence[PlacedMesh], motion: numpy.typing.ArrayLike, *, name: str = '', insertion_force: float = 0.0, hole: numpy.typing.ArrayLike | None = None) -> None:
        """
        Parts held, parts that stay (fixture and table too), T_passive_active from before to the end, (m, 4, 4); name for messages, with what force the hole resists against the last straight line [N], a point on its axis in the frame of what is held (3,) [m] (None: the centre of mass).
        """
    def __repr__(self) -> str:
        ...
    @property
    def active(self) -> list[PlacedMesh]:
        """
        Held.
        """
    @property
    def hole(self) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        A point on the hole's axis (3,) [m]; None: the centre of mass.
        """
    @property
    def insertion_force(self) -> float:
        """
        With which the hole resists [N].
        """
    @property
    def motion(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        T_passive_active, (m, 4, 4); the last one where the gripper opens.
        """
    @property
    def name(self) -> str:
        """
        For messages and results.
        """
    @property
    def passive(self) -> list[PlacedMesh]:
        """
        Stays where it is.
        """
class AssemblyGrasp:
    """
    How a gripper with straight fingers takes the active subassembly. The tool frame lies in the plane of the finger tips with z along the approach; the first finger moves along x.
    
        AssemblyGrasp(T_active_tool, fingers=3, opening=0.04)
    """
    def __init__(self, T_active_tool: numpy.typing.ArrayLike, *, fingers: int = 2, opening: float = 0.02, width: float = 0.015, thickness: float = 0.008, clearance: float = 0.002, palm_radius: float = 0.03, contact_length: float = 0.0, contact_width: float = 0.0) -> None:
        """
        Tool frame (4, 4), 2 or 3 fingers, lengths [m].
        """
    def __repr__(self) -> str:
        ...
    @property
    def T_active_tool(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @property
    def clearance(self) -> float:
        """
        How far each finger opens to approach and to let go [m].
        """
    @property
    def contact_length(self) -> float:
        """
        How far a pad overlaps what it holds, along the approach from the tips [m]; 0: not known.
        """
    @property
    def contact_width(self) -> float:
        """
        The same across the approach [m].
        """
    @property
    def fingers(self) -> int:
        """
        2: parallel jaws; 3: centric fingers.
        """
    @property
    def opening(self) -> float:
        """
        Between the pads, or the diameter that three of them touch [m].
        """
    @property
    def palm_radius(self) -> float:
        """
        Radius of the palm and of all behind it [m].
        """
    @property
    def thickness(self) -> float:
        """
        Thickness of a finger, along the closing direction [m].
        """
    @property
    def width(self) -> float:
        """
        Width of a finger, across approach and closing direction [m].
        """
class FingerLengthRange:
    """
    Which finger lengths take a part through an operation: L- and L+ of P1.
    """
    def __repr__(self) -> str:
        ...
    @property
    def free(self) -> bool:
        """
        There is such a length.
        """
    @property
    def longest(self) -> float:
        """
        With which the fingers meet nothing [m]; infinite where nothing limits it.
        """
    @property
    def longest_by(self) -> str:
        """
        What sets longest or leaves no length at all, or ''.
        """
    @property
    def shortest(self) -> float:
        """
        With which the palm meets nothing [m].
        """
    @property
    def shortest_by(self) -> str:
        """
        What sets shortest: "<part> at <when>", or ''.
        """
class Facet:
    """
    A nearly plane piece of a surface (P1 5.3.3, planar clustering).
    """
    def __repr__(self) -> str:
        ...
    @property
    def area(self) -> float:
        """
        [m2]
        """
    @property
    def centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centre of its area [m], (3,).
        """
    @property
    def faces(self) -> list[int]:
        """
        Triangles of the mesh, ascending.
        """
    @property
    def normal(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Outwards, weighted by area, (3,).
        """
class SegmentRequirement:
    """
    What a gripper needs to hold one segment of a part in its operation: {F, W, L-, L+} of P1 5.3.4.
    
    A part with several graspable segments has several; a gripper that meets one of them takes the part.
    
        SegmentRequirement("sleeve", 0.0375, fingers=3, min_finger_length=0.0227)
    """
    def __init__(self, part: str, opening: float, *, segment: str = '', fingers: int = 2, min_finger_length: float = 0.0, max_finger_length: float | None = None, clearance: float = 0.0, least_min_opening: float = 0.0, max_stroke: float | None = None) -> None:
        """
        Part, opening [m], the segment's label, 2 or 3 fingers, limits of their length [m] (None: no upper one), how far each finger opens to let go [m], how far the gripper may close [m], the longest stroke of its drive [m] (None: any).
        """
    def __repr__(self) -> str:
        ...
    @property
    def clearance(self) -> float:
        """
        Each finger opens by this to let go: twice as much is kept free above the opening [m].
        """
    @property
    def fingers(self) -> int:
        """
        2: parallel jaws; 3: centric fingers.
        """
    @property
    def least_min_opening(self) -> float:
        """
        The gripper's smallest opening is no less [m]: centric fingers that close farther have pads too narrow to hold it.
        """
    @property
    def max_finger_length(self) -> float | None:
        """
        [m]; None: any.
        """
    @property
    def max_stroke(self) -> float | None:
        """
        The drive's stroke is no more [m]: a longer one has a wider palm, or opens farther to let go; None: any.
        """
    @property
    def min_finger_length(self) -> float:
        """
        [m]
        """
    @property
    def opening(self) -> float:
        """
        Diameter, or distance of the faces in touch [m].
        """
    @property
    def part(self) -> str:
        """
        Whose segment it is.
        """
    @property
    def segment(self) -> str:
        """
        Its label.
        """
class Gripper:
    """
    A gripper with straight fingers on a drive: two parallel jaws or three centric fingers (P1 5.2.1).
    
    The base frame lies on the mounting face with z towards the tips; the first finger moves along x. The tool frame lies on z, half a pad before the tips.
    
        gripper = Gripper(fingers=3, min_opening=0.014, max_opening=0.022, finger_length=0.03)
        gripper.to_urdf("grippers/centric_22")
    """
    def __init__(self, *, name: str = 'gripper', actuator: str = '', fingers: int = 2, min_opening: float = 0.0, max_opening: float = 0.05, finger_length: float = 0.03, finger_width: float = 0.015, finger_thickness: float = 0.008, palm_height: float = 0.04, max_force: float = 50.0, max_speed: float = 0.1) -> None:
        """
        Lengths in m, force of each finger in N, its speed in m/s.
        """
    def __repr__(self) -> str:
        ...
    def finger_mesh(self) -> Mesh:
        """
        One finger to print: closed, convex, on the palm at z = 0, its pad in the plane x = 0 [m].
        """
    def hand(self) -> Hand:
        """
        The Hand that it is, for planners and samplers: tool frame "tool", names as to_urdf() writes them. Of two fingers only (InvalidInput): a Hand has pads that stand opposite each other. Mounted under a prefix, read it by Hand.from_robot().
        """
    def holds(self, requirement: SegmentRequirement) -> bool:
        """
        Whether it holds a segment: (5.2) of P1 with <= in place of <, to 1e-9 m, and closes no farther than it allows.
        """
    def to_dict(self) -> dict[str, typing.Any]:
        """
        All fields by name.
        """
    def to_urdf(self, folder: str | os.PathLike[str]) -> None:
        """
        Writes gripper.urdf, gripper.srdf (group "fingers", states open and closed) and finger.stl (millimetres) into a folder, which is made where it is missing. IoError names the file that cannot be written.
        """
    @property
    def actuator(self) -> str:
        """
        Name of the drive, or ''.
        """
    @property
    def finger_length(self) -> float:
        """
        From the palm to the tips [m].
        """
    @property
    def finger_thickness(self) -> float:
        """
        Along the closing direction [m].
        """
    @property
    def finger_width(self) -> float:
        """
        Across approach and closing direction [m].
        """
    @property
    def fingers(self) -> int:
        """
        2 or 3.
        """
    @property
    def max_force(self) -> float:
        """
        Largest force of each finger's joint [N].
        """
    @property
    def max_opening(self) -> float:
        """
        [m]
        """
    @property
    def max_speed(self) -> float:
        """
        Largest speed of each finger's joint [m/s].
        """
    @property
    def min_opening(self) -> float:
        """
        Between the pads, or the diameter that three of them touch [m].
        """
    @property
    def name(self) -> str:
        """
        Name of its URDF.
        """
    @property
    def pad_length(self) -> float:
        """
        Length of the pad along the approach [m].
        """
    @property
    def pad_width(self) -> float:
        """
        Width of the pad across the approach: the finger's, or what three fingers that close leave of it [m].
        """
    @property
    def palm_height(self) -> float:
        """
        From the mounting face to the palm [m].
        """
    @property
    def palm_radius(self) -> float:
        """
        Radius of the palm, a cylinder that covers the fingers while they are open [m].
        """
class GripperActuator:
    """
    A drive that fingers can be mounted on, e.g. an air chuck. Its stroke is fixed, where the opening begins is free.
    
        GripperActuator("SMC MHSL3-32D", 0.008, fingers=3)
    """
    def __init__(self, name: str, stroke: float, *, fingers: int = 2, max_opening: float | None = None, cost: float = 1.0) -> None:
        """
        Name, stroke [m], 2 or 3 fingers, widest opening [m] (None: any), cost of a gripper.
        """
    def __repr__(self) -> str:
        ...
    @property
    def cost(self) -> float:
        """
        Cost of a gripper with this drive.
        """
    @property
    def fingers(self) -> int:
        """
        2 or 3.
        """
    @property
    def max_opening(self) -> float | None:
        """
        As wide as fingers can be mounted [m]; None: any.
        """
    @property
    def name(self) -> str:
        """
        As given.
        """
    @property
    def stroke(self) -> float:
        """
        Largest less smallest opening [m].
        """
class MinimalGrippersResult:
    """
    What minimal_grippers found: the set, and which gripper takes which part.
    """
    def __repr__(self) -> str:
        ...
    def to_dict(self) -> dict[str, typing.Any]:
        """
        As a dict of plain numbers, strings and lists, e.g. for JSON.
        """
    @property
    def candidates(self) -> int:
        """
        Grippers chosen among, none doing only what another does.
        """
    @property
    def changes(self) -> int:
        """
        How often the gripper changes from part to part.
        """
    @property
    def changes_bound(self) -> int:
        """
        Proven: no set of the same cost needs fewer.
        """
    @property
    def cost(self) -> float:
        """
        Cost of the grippers and of the changes.
        """
    @property
    def explanations(self) -> list[str]:
        """
        One per uncovered part.
        """
    @property
    def gripper_of_part(self) -> list[int]:
        """
        Index into grippers, one per part.
        """
    @property
    def grippers(self) -> list[Gripper]:
        """
        The grippers in the order of first use.
        """
    @property
    def lower_bound(self) -> float:
        """
        Proven: no set of grippers costs less.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: proven in cost and changes; `approximate`: the bounds say what is proven; `infeasible`: see explanations; `stopped`.
        """
    @property
    def parts(self) -> list[str]:
        """
        Names of the parts in the order of assembly.
        """
    @property
    def preference_finished(self) -> bool:
        """
        What preferred_grippers set out for: for every better segment of a part it is decided whether the set stays as good with it. False: max_nodes or the time limit ended first.
        """
    @property
    def requirement_of_part(self) -> list[int]:
        """
        Index into the requirements, one per part.
        """
    @property
    def uncovered(self) -> list[str]:
        """
        Parts that no gripper takes.
        """
class ContactArea:
    """
    Where a soft pad touches: a rectangle along and across the approach.
    """
    def __repr__(self) -> str:
        ...
    @property
    def area(self) -> float:
        """
        [m2]
        """
    @property
    def length(self) -> float:
        """
        Along the approach [m].
        """
    @property
    def torsion_radius(self) -> float:
        """
        Mean distance from the middle, weighted by pressure: the largest torque about the normal is friction times normal force times this [m].
        """
    @property
    def width(self) -> float:
        """
        Across it [m].
        """
class FingerGrip:
    """
    How fingers press and what their pads are made of.
    
        FingerGrip(force=40, friction=0.6, modulus=3e6)
    """
    def __init__(self, *, force: float = 50.0, friction: float = 0.5, modulus: float = 3000000.0, pad_radius: float | None = None) -> None:
        """
        Force of each finger [N], Coulomb's coefficient, plane strain modulus of pad and part together [Pa], radius of hollow pads [m] (None: flat).
        """
    def __repr__(self) -> str:
        ...
    @property
    def force(self) -> float:
        """
        Force of each finger [N].
        """
    @property
    def friction(self) -> float:
        """
        Coulomb's coefficient between pad and part.
        """
    @property
    def modulus(self) -> float:
        """
        Plane strain modulus of pad and part together [Pa].
        """
    @property
    def pad_radius(self) -> float | None:
        """
        Radius of hollow pads [m]; None: flat.
        """
class GraspHolding:
    """
    What a grasp does about the loads of its operation.
    """
    def __repr__(self) -> str:
        ...
    @property
    def contact(self) -> ContactArea:
        """
        One pad's.
        """
    @property
    def insertion_moment(self) -> float:
        """
        Moment of the insertion's resistance about the middle between the pads [N m]; 0: fingers stand evenly about the hole's axis.
        """
    @property
    def pad_torque(self) -> float:
        """
        Torque about its normal that a pad holds beside the forces it carries; least of all pads [N m].
        """
    @property
    def safety(self) -> float:
        """
        The loads may grow at least by this factor before a pad slips; infinite without loads.
        """
class HoldingRequirement:
    """
    Grasps are to hold the weight of their parts and the resistance of holes.
    
        HoldingRequirement(FingerGrip(force=40), density=2700, least_safety=1.5)
    """
    def __init__(self, grip: FingerGrip, *, density: float = 7850.0, least_safety: float = 1.0) -> None:
        """
        How fingers press, density of all parts [kg/m3], the least factor by which loads may grow.
        """
    def __repr__(self) -> str:
        ...
    @property
    def density(self) -> float:
        """
        All parts have this density [kg/m3].
        """
    @property
    def grip(self) -> FingerGrip:
        """
        How fingers press.
        """
    @property
    def least_safety(self) -> float:
        """
        Grasps that hold less than this many times the load are refused.
        """
class OperationLoad:
    """
    Weight and insertion of one operation, in the frame of its active subassembly.
    """
    def __repr__(self) -> str:
        ...
    @property
    def centre(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Centre of mass [m], (3,).
        """
    @property
    def grip(self) -> FingerGrip:
        """
        How fingers press.
        """
    @property
    def hole(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        A point on its axis [m], (3,).
        """
    @property
    def mass(self) -> float:
        """
        The active parts weigh this [kg].
        """
    @property
    def resistance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        The hole pushes with this, at the end [N], (3,).
        """
    @property
    def weights(self) -> list[numpy.typing.NDArray[numpy.float64]]:
        """
        One (3,) per pose of the motion: gravity turns with it [N].
        """
class HeldLoad:
    """
    What a grasp does about the load of its operation.
    """
    def __repr__(self) -> str:
        ...
    @property
    def contact_area(self) -> float:
        """
        One pad touches this much [m2].
        """
    @property
    def insertion_moment(self) -> float:
        """
        The resistance has this moment about the middle between the pads [N m].
        """
    @property
    def pad_torque(self) -> float:
        """
        About its normal, that a pad holds beside the forces it carries at the end [N m].
        """
    @property
    def safety(self) -> float:
        """
        The loads may grow at least by this factor before a pad slips, on the way and at its end.
        """
class OperationOverlap:
    """
    How deep the active and the passive parts of an operation stand in each other, where it is deepest.
    """
    def __repr__(self) -> str:
        ...
    @property
    def active(self) -> str:
        """
        The moved part; '' where depth is 0.
        """
    @property
    def before_end(self) -> float:
        """
        The way of the moved parts' middle that is left when it happens [m].
        """
    @property
    def depth(self) -> float:
        """
        A point of one part's surface lies this deep in the other [m]; 0: nowhere.
        """
    @property
    def passive(self) -> str:
        """
        The other one.
        """
class KeepOff:
    """
    The surface of a part that no finger may touch.
    
        KeepOff("pulley", segments=[2], boxes=[(mg.pose([0, 0, 0.02]), [0.07, 0.07, 0.004])])
    """
    def __init__(self, part: str, *, segments: collections.abc.Sequence[int] = [], boxes: collections.abc.Sequence[tuple[numpy.typing.ArrayLike, numpy.typing.ArrayLike]] = [], names: collections.abc.Sequence[str] = [], source: str = '') -> None:
        """
        Name of the part; numbers of segments that segment_mesh gives it by default, or their names by segment_names ("cylinder_1", "pulley/cylinder_1"); boxes in its mesh's frame: pairs of T_mesh_box (4, 4) of the middle, and size (3,) [m]; who asks for it, with which messages about it begin.
        """
    def __repr__(self) -> str:
        ...
    @property
    def boxes(self) -> list[tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]]:
        """
        Pairs of T_mesh_box (4, 4) and size (3,) [m].
        """
    @property
    def names(self) -> list[str]:
        """
        Names of segments.
        """
    @property
    def part(self) -> str:
        """
        The part's name.
        """
    @property
    def segments(self) -> list[int]:
        """
        Numbers of segments.
        """
    @property
    def source(self) -> str:
        """
        Who asks for it.
        """
class SegmentedPart:
    """
    A part cut into segments, each with the primitive that stands for it.
    """
    def __repr__(self) -> str:
        ...
    @property
    def primitives(self) -> list[FittedPrimitive]:
        """
        One per segment.
        """
    @property
    def segmentation(self) -> MeshSegmentation:
        """
        Its segments.
        """
class SegmentFate:
    """
    What became of one segment of a part in one operation.
    """
    def __repr__(self) -> str:
        ...
    @property
    def fingers(self) -> int:
        """
        2, 3, or 0: no gripper suits its primitive.
        """
    @property
    def free(self) -> int:
        """
        How many of those have some finger length.
        """
    @property
    def kind(self) -> str:
        """
        Its primitive: cylinder, box, cone or sphere.
        """
    @property
    def name(self) -> str:
        """
        Its name, as segment_names gives it: cylinder_1.
        """
    @property
    def part(self) -> str:
        """
        The part's name.
        """
    @property
    def refused(self) -> str:
        """
        Why it cannot be held, or what most of its grasps fell by; '' when held.
        """
    @property
    def requirements(self) -> list[int]:
        """
        Numbers of the plan's requirements.
        """
    @property
    def segment(self) -> int:
        """
        Its number.
        """
    @property
    def step(self) -> str:
        """
        The operation's name.
        """
    @property
    def tried(self) -> int:
        """
        Grasps of it.
        """
class RefusedGrasp:
    """
    A grasp that the rehearsal of its operation refused.
    """
    def __repr__(self) -> str:
        ...
    @property
    def met(self) -> str:
        """
        What it met with the gripper chosen for it then.
        """
    @property
    def requirement(self) -> int:
        """
        Its number in the plan.
        """
class PlanGrippersResult:
    """
    The grippers of an assembly, and how they were come by.
    """
    def __repr__(self) -> str:
        ...
    @property
    def fates(self) -> list[SegmentFate]:
        """
        Every segment of what is moved, in every operation.
        """
    @property
    def grasps(self) -> list[AssemblyGrasp]:
        """
        One per requirement, in the frame of the active subassembly.
        """
    @property
    def help(self) -> list[str]:
        """
        Single changes each of which gives an operation its grasp: tried.
        """
    @property
    def holdings(self) -> list[HeldLoad]:
        """
        One per requirement, of those chosen with their gripper's real pads; empty where nothing is asked of holding.
        """
    @property
    def left_out(self) -> list[RefusedGrasp]:
        """
        Grasps that a rehearsal refused, in that order. They were left out of the choice of the sets that followed, with whatever gripper: the last set is the least for the others.
        """
    @property
    def met(self) -> list[str]:
        """
        What each operation's rehearsal with the set met, '' nothing; empty without one.
        """
    @property
    def missing(self) -> list[str]:
        """
        Operations that cannot be done, each with the reasons.
        """
    @property
    def outcome(self) -> Outcome:
        """
        `solved`: each operation has a gripper that was rehearsed, and the set is proven to be the least for the grasps that were not left_out; `infeasible`: an operation has no grasp to try, or its parts stand in each other (missing), or no drive takes it (set); `not_found`: no grasp that was tried goes through an operation, or a rehearsal refuses all of them (pads that slip, too), or refused one of each of max_rehearsals sets; `stopped`; else as the set's.
        """
    @property
    def parts(self) -> dict[str, SegmentedPart]:
        """
        The parts that are moved, by name.
        """
    @property
    def rehearsals(self) -> int:
        """
        So many sets were rehearsed.
        """
    @property
    def requirements(self) -> list[SegmentRequirement]:
        """
        One per grasp kept; `part` is the operation's name.
        """
    @property
    def set(self) -> MinimalGrippersResult | None:
        """
        The least set; None when an operation has no grasp; the last one that was rehearsed where none goes through.
        """
def _allowed_bodies(robot: Robot, world: World) -> list[tuple[str, str]]:
    ...
def _assembly_grasp_option_table() -> dict[str, typing.Any]:
    ...
def _capability_option_table() -> dict[str, typing.Any]:
    ...
def _cartesian_option_table() -> dict[str, typing.Any]:
    ...
def _centre_of_mass(object: collections.abc.Sequence[LinkShape]) -> numpy.typing.NDArray[numpy.float64]:
    ...
def _check_arrival_covariance(covariance: numpy.typing.ArrayLike) -> None:
    """
    Raises InvalidInput when this is no covariance (3, 3) of x, y and theta.
    """
def _check_options(section: str, **kwargs: typing.Any) -> None:
    """
    Raises InvalidInput when an option of a scenario's section is out of range.
    """
def _checker_option_table() -> dict[str, typing.Any]:
    ...
def _closing_line(hand: Hand, robot: Robot, share: float) -> tuple[numpy.typing.NDArray[numpy.float64], float, float]:
    """
    Where the pads of a hand of many joints, open by `share` in [0, 1], would meet, in its tool frame (3,) [m], how far apart
    they are (negative: they have passed each other) [m], and the steepest angle of a pad's push to the line on which they close [rad].
    """
def _cuboid_option_table() -> dict[str, typing.Any]:
    ...
def _drive_along(poses: numpy.typing.ArrayLike, robot: Robot, joints: collections.abc.Sequence[str], configuration: numpy.typing.ArrayLike, period: float) -> RobotMotion:
    ...
def _drive_by_option_table() -> dict[str, typing.Any]:
    ...
def _edge_option_table() -> dict[str, typing.Any]:
    ...
def _first_drive_by_guess(group: JointGroup, *, start: numpy.typing.ArrayLike, tasks: collections.abc.Sequence[DriveByTask], goal: numpy.typing.ArrayLike, waypoints: int = 35) -> typing.Any:
    """
    The guess of the first seed, for benchmarks against other optimisers; None when a task is out of reach. solve() takes it from there, judging included: whether it is solved, the duration, processor seconds that judging once more took, and iterations.
    """
def _from_pickle(kind: type, state: typing.Any) -> typing.Any:
    ...
def _grasp_option_bounds() -> dict[str, typing.Any]:
    ...
def _grasp_option_table() -> dict[str, typing.Any]:
    ...
def _grasp_search_option_table() -> dict[str, typing.Any]:
    ...
def _graspability_option_table() -> dict[str, typing.Any]:
    ...
def _ik_option_table() -> dict[str, typing.Any]:
    ...
def _ik_seeds_of_a_grasp(asked: int, grasps_of_parts: collections.abc.Sequence[int]) -> int:
    ...
def _manipulation_option_table() -> dict[str, typing.Any]:
    ...
def _mesh_segmentation_option_table() -> dict[str, typing.Any]:
    ...
def _mesh_with_faults(path: str | os.PathLike[str], scale: float = 1.0) -> tuple[Mesh, bool, int, int, int, int]:
    ...
def _minimal_grippers_option_table() -> dict[str, typing.Any]:
    ...
def _motion_option_table() -> dict[str, typing.Any]:
    ...
def _object_path_option_bounds() -> dict[str, typing.Any]:
    ...
def _object_path_option_table() -> dict[str, typing.Any]:
    ...
def _occupancy_option_table() -> dict[str, typing.Any]:
    ...
def _pipe_grasp_option_table() -> dict[str, typing.Any]:
    ...
def _plan_grippers_option_table() -> dict[str, typing.Any]:
    ...
def _platform_option_table() -> dict[str, typing.Any]:
    ...
def _population_option_table() -> dict[str, typing.Any]:
    ...
def _push_option_table() -> dict[str, typing.Any]:
    ...
def _reach_option_bounds() -> dict[str, typing.Any]:
    ...
def _reach_option_table() -> dict[str, typing.Any]:
    ...
def _roadmap_option_table() -> dict[str, typing.Any]:
    ...
def _sample_grasps(object: collections.abc.Sequence[LinkShape], gripper: Hand, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, approaches: int = 8, positions: int = 3, mesh_samples: int = 400, max_grasps: int = 200, friction: float = 0.5, standoff: float = 0.0, approach_direction: numpy.typing.ArrayLike | None = None, seed: int = 1) -> tuple[list[Grasp], int]:
    """
    (grasps, too_wide): as sample_grasps, with the number dropped as too wide.
    
    Keyword options:
        approaches: int = 8  # approach directions around each closing axis
        positions: int = 3  # pad positions along each free direction
        mesh_samples: int = 400  # surface points tried on a mesh, eight times as many where few pairs fit the hand
        max_grasps: int = 200  # best kept, spread over approach directions
        friction: float = 0.5  # Coulomb coefficient
        standoff: float = 0.0  # how far the tool frame stays outside the object's middle [m]
        approach_direction: numpy.typing.ArrayLike | None = None  # of every grasp: a unit vector in the object's frame; None: from all around
        seed: int = 1  # same seed, same grasps
    """
def _sdf_option_table() -> dict[str, typing.Any]:
    ...
def _segmentation_option_table() -> dict[str, typing.Any]:
    ...
def _shape_diameter_option_table() -> dict[str, typing.Any]:
    ...
def _straight_approach() -> float:
    ...
def _suction_option_bounds() -> dict[str, typing.Any]:
    ...
def _suction_option_table() -> dict[str, typing.Any]:
    ...
def _suction_used() -> float:
    ...
def _supply_option_bounds() -> dict[str, typing.Any]:
    ...
def _supply_option_table() -> dict[str, typing.Any]:
    ...
def _synthesis_option_bounds() -> dict[str, typing.Any]:
    ...
def _synthesis_option_table() -> dict[str, typing.Any]:
    ...
def _timing_option_table() -> dict[str, typing.Any]:
    ...
def _tracking_option_table() -> dict[str, typing.Any]:
    ...
def assembly_grasps(part: PlacedMesh, segment: MeshSegment, primitive: FittedPrimitive, actuators: collections.abc.Sequence[GripperActuator], *, finger_width: float = 0.015, finger_thickness: float = 0.008, clearance: float = 0.002, shortest_finger: float = 0.01, longest_finger: float = 0.15, opening_margin: float = 0.001, length_margin: float = 0.001, min_contact: float = 0.003, tip_clearance: float = 0.0005, directions: int = 12, max_overlap: float = 0.0005, change_cost: float = 0.0, max_nodes: int = 20000, time_limit: float = 60.0, max_rehearsals: int = 200, threads: int = 0) -> list[AssemblyGrasp]:
    """
    The grasps that plan_grippers tries of a segment, in the frame of the active subassembly; the palm is as wide as that of the widest gripper that may take it.
    
    Keyword options:
        finger_width: float = 0.015  # across approach and closing direction [m]
        finger_thickness: float = 0.008  # along the closing direction [m]
        clearance: float = 0.002  # how far each finger opens to approach and to let go [m]
        shortest_finger: float = 0.01  # no finger is shorter [m]
        longest_finger: float = 0.15  # no finger is longer [m]
        opening_margin: float = 0.001  # stroke kept free beyond the part at either end [m]
        length_margin: float = 0.001  # kept from either limit of the finger length [m]
        min_contact: float = 0.003  # pads overlap a segment by at least this, along the approach [m]
        tip_clearance: float = 0.0005  # tips end this short of the far end of the segment [m]
        directions: int = 12  # approaches about the closing axis, or turns of centric fingers
        max_overlap: float = 0.0005  # parts may stand in each other by this [m]
        change_cost: float = 0.0  # of changing the gripper between two operations
        max_nodes: int = 20000  # of the search for fewest changes
        time_limit: float = 60.0  # the search for the least set ends after this, on the clock [s]
        max_rehearsals: int = 200  # most sets that are rehearsed, each without what met something
        threads: int = 0  # 0: all
    """
def beam_frame(pipe: Pipe, inner_diameter: float, material: BeamMaterial) -> BeamFrame:
    """
    A pipe as a frame: member i is section i, a tube [m].
    """
def cache_folder() -> str:
    """
    $XDG_CACHE_HOME/mmgrasp, or ~/.cache/mmgrasp.
    """
def camera_view_objective(group: JointGroup, camera_link: str, point: numpy.typing.ArrayLike, T_link_camera: numpy.typing.ArrayLike | None = None, weight: float = 1.0) -> IkObjective:
    """
    Weight times the squared distance [m] of a world point from the optical axis (+z) of a camera on a link, plus the
    squared depth by which it lies behind the camera.
    """
def centric_grasps(T_mesh_cylinder: numpy.typing.ArrayLike, diameter: float, low: float, high: float, *, facet_angle: float = 0.1, parallel_angle: float = 0.05, directions: int = 12, min_contact: float = 0.003, pad_length: float = 0.02, max_opening: float = 0.25, finger_width: float = 0.015, finger_thickness: float = 0.008, clearance: float = 0.002, tip_clearance: float = 0.0, palm_margin: float = 0.005) -> list[AssemblyGrasp]:
    """
    Grasps by three centric fingers along the z axis of a cylinder that ends at `low` and `high` on it [m], from either end, fingers turned in steps, at up to three depths (P1 5.2.3).
    
    Keyword options:
        facet_angle: float = 0.1  # faces of one facet bend no more from its largest [rad]
        parallel_angle: float = 0.05  # facets between jaws are off parallel by no more [rad]
        directions: int = 12  # approaches about the closing axis, or turns of centric fingers
        min_contact: float = 0.003  # pads overlap the segment by at least this, along the approach [m]
        pad_length: float = 0.02  # of a pad along the approach [m]
        max_opening: float = 0.25  # wider segments are left out [m]
        finger_width: float = 0.015  # across approach and closing direction [m]
        finger_thickness: float = 0.008  # along the closing direction [m]
        clearance: float = 0.002  # by which each finger opens to approach and to let go [m]
        tip_clearance: float = 0.0  # tips end this short of the far end of what they hold [m]
        palm_margin: float = 0.005  # the palm reaches beyond the open fingers by this [m]
    """
def cheapest_assignment(costs: numpy.typing.ArrayLike) -> list[int]:
    """
    A column of its own for each row of (n, n) so that the sum of costs is least.
    """
def closing_outcome(start: float, *, opening: float = 0.1, closing_speed: float = 0.1, tool_speed: float = 0.3, finger_length: float = 0.12, object_width: float = 0.05, grip_depth: float = 0.02, planned_depth: float = 0.06, clearance: float = 0.0, max_push: float = 0.1, along_error: float = 0.0, lateral_error: float = 0.0, along_deviation: float = 0.0, lateral_deviation: float = 0.0, sigmas: float = 3.0) -> ClosingOutcome:
    """
    What beginning to close at an engagement [m] comes to.
    
    Keyword options:
        opening: float = 0.1  # between the fingers before they close [m]
        closing_speed: float = 0.1  # how fast the opening shrinks [m/s]
        tool_speed: float = 0.3  # along the approach [m/s]
        finger_length: float = 0.12  # from the palm to the tips [m]
        object_width: float = 0.05  # along the closing direction [m]
        grip_depth: float = 0.02  # least engagement that holds [m]
        planned_depth: float = 0.06  # engagement at the planned grasp pose [m]
        clearance: float = 0.0  # kept on either side while the fingers pass the object [m]
        max_push: float = 0.1  # how far the object may slide before the palm [m]
        along_error: float = 0.0  # the object may stand this much nearer or farther [m]
        lateral_error: float = 0.0  # and this much to either side [m]
        along_deviation: float = 0.0  # standard deviation of the object's position along the approach [m]
        lateral_deviation: float = 0.0  # the same along the closing direction [m]
        sigmas: float = 3.0  # errors of this many deviations are covered
    """
def compute_base_regions(problem: PartSupplyProblem, database: ReachDatabase, grid: BaseGrid, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> list[BaseRegion]:
    """
    P1 Algorithm 2 with exact inverse kinematics: one region for each tray with target parts.
    """
def compute_disabled_pairs(robot: Robot, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 10000, always_fraction: float = 0.95, trust_samples: bool = False, seed: int = 1, threads: int = 0) -> Robot:
    """
    The robot with the link pairs that always or never touch found by sampling; those of an SRDF are kept.
    
    Keyword options:
        samples: int = 10000  # random configurations
        always_fraction: float = 0.95  # a pair in collision at least this often is called always
        trust_samples: bool = False  # call pairs that touch in no sample never, without a proof
        seed: int = 1  # same seed, same pairs
        threads: int = 0  # 0: all
    """
def copper() -> BeamMaterial:
    """
    The copper of P2 table 3.4, which gives no stress limit.
    """
def cover_from_intersections(grid: BaseGrid, intersections: collections.abc.Sequence[Intersection], trays: int) -> StopSet:
    """
    The least number of intersections that cover all trays (P1 equation 3.1), with proof. Raises InvalidInput where one
    names a tray twice, out of order or not there, or a heading that the grid lacks.
    """
def default_grasp_search(group: JointGroup) -> str:
    """
    branch_and_bound for arms that it takes, else bees.
    """
def derivative_free_solver_names() -> list[str]:
    """
    Names that minimize_derivative_free's `solver` takes.
    """
def drive_arc(pose: numpy.typing.ArrayLike, platform_velocity: numpy.typing.ArrayLike, time: float) -> numpy.typing.NDArray[numpy.float64]:
    """
    Base pose (x, y, theta) after `time` [s] at a constant platform velocity (v_x, v_y, omega): the exact arc.
    """
def drive_by_program(group: JointGroup, *, start: numpy.typing.ArrayLike, tasks: collections.abc.Sequence[DriveByTask], goal: numpy.typing.ArrayLike, waypoints: int = 35, smoothing: float = 0.01) -> WholeBodyProgram | None:
    """
    The nonlinear problem from which plan_drive_by begins, with its guess, obstacles left out; None when a task is out of reach.
    `smoothing` weighs the mean square of accelerations over their limits [s].
    """
def eigengrasp_hand(robot: Robot, tool_link: str, groups: collections.abc.Sequence[tuple[str, collections.abc.Sequence[str]]], *, open: numpy.typing.ArrayLike, closed: numpy.typing.ArrayLike, approach: numpy.typing.ArrayLike = (0, 0, 1), name: str = 'type', clearance: float = 0.01) -> Hand:
    """
    A robot hand set up for one type of grasp (P3 4.6.1, Algorithm 3): `groups` are (name, joints) pairs, `open` and `closed`
    the values of all their joints in that order. Groups whose values agree keep them. `clearance` is kept free on each side of a part while
    moving in [m]; the links of the pads are its finger links. Raises InvalidInput on unknown joints,
    values outside limits, and when no two fingertips close on each other.
    """
def evaluate_graspability(map: HeightMap, gripper: Hand, *, image: DepthImage | None = None, margin: float = 0.001, orientations: int = 16, openings: int = 2, layer_step: float = 0.01, lowest: float = 0.003, insertion: float = 0.01, smoothing: float = 0.01, min_contact: float = 0.4, min_distance: float = 0.015, max_grasps: int = 100, threads: int = 0) -> Graspability:
    """
    Fast graspability evaluation (P1 3.7.2): contact and collision masks of the hand convolved with a height map over
    closing directions, openings and heights; grasps at the local maxima, straight along -z of the map. With the
    `image` that the map was made of each grasp gets its pixel.
    
    Keyword options:
        margin: float = 0.001  # kept free around the hand [m]
        orientations: int = 16  # closing directions over half a turn
        openings: int = 2  # openings tried: max_opening and equal parts of it
        layer_step: float = 0.01  # between the heights at which fingertips are tried [m]
        lowest: float = 0.003  # height of the lowest fingertips above the map's frame [m]
        insertion: float = 0.01  # how far a part must rise above the fingertips to count as held [m]
        smoothing: float = 0.01  # radius over which graspability is averaged [m]
        min_contact: float = 0.4  # share of the pads' width that must meet the part
        min_distance: float = 0.015  # between returned grasps of about one direction [m]
        max_grasps: int = 100  # best kept
        threads: int = 0  # 0: all
    """
def find_package(name: str, folder: str | os.PathLike[str], package_dirs: collections.abc.Mapping[str, str | os.PathLike[str]] | None = None) -> str:
    """
    Folder of the ROS package that a file in `folder` means by package://NAME or $(find NAME); empty if none.
    """
def finger_length_range(grasp: AssemblyGrasp, operation: AssemblyOperation, *, step: float = 0.0005) -> FingerLengthRange:
    """
    The finger lengths with which neither fingers nor palm meet the subassemblies: on the approach, along the whole motion, and while the gripper opens and moves back (P1 5.3.2, 5.3.3). The palm and what carries it count as endless. Exact for motions along the approach; others are checked every `step` [m] with as much margin.
    """
def fingers_fit(arm: JointGroup, hand: Hand, part: collections.abc.Sequence[LinkShape], grasps: collections.abc.Sequence[Grasp], *, mesh_tolerance: float = 0.0) -> list[bool]:
    """
    Tells of each grasp of a part whether its finger links keep out of the part until they are as near as its
    opening says, or 1.5 mm or a twentieth of it on either side: where a part is wider beside the pads than between
    them, fingers would stand in it. Arguments and errors as fingers_meet.
    """
def fingers_meet(arm: JointGroup, hand: Hand, part: collections.abc.Sequence[LinkShape], grasps: collections.abc.Sequence[Grasp], *, mesh_tolerance: float = 0.0) -> list[bool]:
    """
    Tells of each grasp of a part whether finger links of both sides meet the part at once, closing from the
    grasp's opening by at most 10 mm or a quarter of it, whichever is more, wherever within 0.2 mm along the
    closing axis the hand stands: a plan's own check asks for that. Fingers that leave a gap when they are closed
    cannot hold what is thinner. `arm`, whose tip carries the hand, says how all other joints stand; its robot's
    meshes may stick out by `mesh_tolerance` [m] beyond those of the check. Cups have no
    fingers to close: all True. InvalidInput where its robot lacks a link or joint of the hand, or an opening is
    beyond the hand's.
    """
def fit_cuboids(points: numpy.typing.ArrayLike, *, T_world_tray: numpy.typing.ArrayLike | None = None, tray_size: numpy.typing.ArrayLike | None = None, wall: float = 0.005, up: numpy.typing.ArrayLike | None = None, eye: numpy.typing.ArrayLike | None = None, plane_tolerance: float = 0.008, wall_margin: float = 0.006, up_angle: float = 0.35, max_height: float = 0.5, cluster_tolerance: float = 0.01, leaf: float = 0.003, min_points: int = 60, plane_iterations: int = 1000) -> CuboidFit:
    """
    Box-shaped parts in a cloud (n, 3) (P1 3.7.1): the supporting plane and the tray are taken out, every cluster above
    gets an upright cuboid. With a tray (outer `tray_size`, frame at the middle of its floor) the floor carries the parts;
    without, the dominant plane does whose normal is near `up` (z; zeros: any plane, `eye` is above it).
    
    Keyword options:
        plane_tolerance: float = 0.008  # points no farther from the plane belong to it [m]
        wall_margin: float = 0.006  # points no farther from a tray's wall are left out [m]
        up_angle: float = 0.35  # the plane's normal lies within this of `up` [rad]
        max_height: float = 0.5  # points higher above the plane are left out [m]
        cluster_tolerance: float = 0.01  # points farther from each other are different parts [m]
        leaf: float = 0.003  # cell to which points are thinned for the search [m]
        min_points: int = 60  # smaller clusters are left out
        plane_iterations: int = 1000  # random planes tried
    """
def fit_primitives(mesh: Mesh, labels: numpy.typing.ArrayLike, *, threads: collections.abc.Sequence[ScrewThread] = [], min_contact: float = 0.003, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> list[FittedPrimitive]:
    """
    The cylinder, box, cone or sphere that stands for each segment of a mesh: the one whose volume is closest to that of
    the segment's convex hull, of those with surface on them (P1, section 5.2.2). `labels` (m,): the segment of each face, as
    MeshSegmentation.labels. Round inner walls are never offered for grasping; a box is held by the facets that `jaw_grasps` takes,
    which lie opposite each other over `min_contact` [m] or more. `threads`:
    those of MeshSegmentation, which count as the cylinder through their crests. Raises InvalidInput when there is not one label
    >= 0 a face, or for threads of other meshes.
    """
def flat_contact(length: float, width: float) -> ContactArea:
    """
    A flat pad on a flat face, pressed evenly; both sides are positive [m].
    """
def follow_object_path(problem: ObjectPathProblem, grasp: Grasp, *, motion_weight: float = 0.587, deflection_weight: float = 0.089, manipulability_weight: float = 0.324, motion_scale: float = 1.0, deflection_scale: float = 0.001, manipulability_scale: float = 1.0, max_joint_step: float = 0.5, position_tolerance: float = 0.01, rotation_tolerance: float = 0.05, edge_step: float = 0.02, check_edges: bool = True, single_configuration: bool = False, all_turns: bool = True, redundant_values: int = 0, base_spacing: float = 0.2, base_headings: int = 4, gravity: float = 9.81, max_sag: float = 0.0) -> ObjectPathResult:
    """
    The cheapest motion of the arm that carries the object through all poses with one grasp, over all arm
    configurations (P2 3.3.3, Algorithm 3.1), motions between poses checked finely.
    
    Keyword options:
        motion_weight: float = 0.587  # weight of O1, the joints' motion
        deflection_weight: float = 0.089  # weight of O2, the largest displacements
        manipulability_weight: float = 0.324  # weight of O3, the force manipulability
        motion_scale: float = 1.0  # O1 is divided by it [rad or m]
        deflection_scale: float = 0.001  # O2 is divided by it [m]
        manipulability_scale: float = 1.0  # O3 is divided by it
        max_joint_step: float = 0.5  # more from pose to pose is a jump, refused [rad or m]
        position_tolerance: float = 0.01  # of the object half way between poses [m]
        rotation_tolerance: float = 0.05  # of the object half way between poses [rad]
        edge_step: float = 0.02  # largest joint step between collision checks [rad or m]
        check_edges: bool = True  # check motions between poses for collisions
        single_configuration: bool = False  # one arm configuration a pose (P2's single IK)
        all_turns: bool = True  # joints that may turn more than once come in every turn
        redundant_values: int = 0  # samples of a seventh joint, evenly over its range; 0: 24
        base_spacing: float = 0.2  # grid of the places where a moving base may stand [m]
        base_headings: int = 4  # headings of the base at each place, evenly over a turn
        gravity: float = 9.81  # along the world's -z [m/s2]
        max_sag: float = 0.0  # largest displacement allowed at any pose [m]; 0: any
    """
def free_gripper(gripper: Gripper) -> JointGroup:
    """
    A gripper, read from its own files, on six joints that carry its base anywhere: x, y, z [m], then yaw, pitch, roll [rad]. The fingers' joint is "finger_1_joint".
    """
def grasp_holding(grasp: AssemblyGrasp, grip: FingerGrip, *, weight: numpy.typing.ArrayLike | None = None, centre: numpy.typing.ArrayLike | None = None, resistance: numpy.typing.ArrayLike | None = None, hole: numpy.typing.ArrayLike | None = None) -> GraspHolding:
    """
    Whether soft fingers hold a part against its weight, and against weight and insertion (P1 5.3.5). `weight` [N] acts at `centre` [m], `resistance` of the insertion [N], against the motion, at `hole` [m], a point on the hole's axis; (3,), in the frame of the grasp's pose, None: zero. The grasp must know its contact_length and contact_width. Loads are shared so that the sum of squares is least, which bounds what can be held from below; pads slip by the limit surface of soft_finger_torque.
    """
def grasp_search_names() -> list[str]:
    """
    Names that optimize_grasp's `algorithm` takes.
    """
def graspability_map(map: HeightMap, gripper: Hand, angle: float, opening: float, tip_height: float, *, margin: float = 0.001, orientations: int = 16, openings: int = 2, layer_step: float = 0.01, lowest: float = 0.003, insertion: float = 0.01, smoothing: float = 0.01, min_contact: float = 0.4, min_distance: float = 0.015, max_grasps: int = 100, threads: int = 0) -> numpy.typing.NDArray[numpy.float32]:
    """
    (ny, nx) smoothed graspability in [0, 1] of one closing direction, opening and height of the fingertips.
    
    Keyword options:
        margin: float = 0.001  # kept free around the hand [m]
        orientations: int = 16  # closing directions over half a turn
        openings: int = 2  # openings tried: max_opening and equal parts of it
        layer_step: float = 0.01  # between the heights at which fingertips are tried [m]
        lowest: float = 0.003  # height of the lowest fingertips above the map's frame [m]
        insertion: float = 0.01  # how far a part must rise above the fingertips to count as held [m]
        smoothing: float = 0.01  # radius over which graspability is averaged [m]
        min_contact: float = 0.4  # share of the pads' width that must meet the part
        min_distance: float = 0.015  # between returned grasps of about one direction [m]
        max_grasps: int = 100  # best kept
        threads: int = 0  # 0: all
    """
def hand_masks(gripper: Hand, opening: float, angle: float, resolution: float, *, margin: float = 0.001, orientations: int = 16, openings: int = 2, layer_step: float = 0.01, lowest: float = 0.003, insertion: float = 0.01, smoothing: float = 0.01, min_contact: float = 0.4, min_distance: float = 0.015, max_grasps: int = 100, threads: int = 0) -> dict[str, numpy.typing.NDArray[numpy.uint8]]:
    """
    The masks `contact`, `fingers` and `palm` as images of zeros and ones with the hand in the middle.
    
    Keyword options:
        margin: float = 0.001  # kept free around the hand [m]
        orientations: int = 16  # closing directions over half a turn
        openings: int = 2  # openings tried: max_opening and equal parts of it
        layer_step: float = 0.01  # between the heights at which fingertips are tried [m]
        lowest: float = 0.003  # height of the lowest fingertips above the map's frame [m]
        insertion: float = 0.01  # how far a part must rise above the fingertips to count as held [m]
        smoothing: float = 0.01  # radius over which graspability is averaged [m]
        min_contact: float = 0.4  # share of the pads' width that must meet the part
        min_distance: float = 0.015  # between returned grasps of about one direction [m]
        max_grasps: int = 100  # best kept
        threads: int = 0  # 0: all
    """
def held_load(grasp: AssemblyGrasp, load: OperationLoad) -> HeldLoad:
    """
    What a grasp, in the frame of the active subassembly, does about a load: the least safety over motion and end, the rest at the end (see grasp_holding).
    """
def inscribed_circle(grid: BaseGrid, cells: numpy.typing.ArrayLike, heading: int = 0) -> tuple[numpy.typing.NDArray[numpy.float64], float]:
    """
    Centre (2,) and radius [m] of the largest disc inside the union of cells of one layer.
    """
def jaw_grasps(mesh: Mesh, faces: collections.abc.Sequence[int] = [], *, facet_angle: float = 0.1, parallel_angle: float = 0.05, directions: int = 12, min_contact: float = 0.003, pad_length: float = 0.02, max_opening: float = 0.25, finger_width: float = 0.015, finger_thickness: float = 0.008, clearance: float = 0.002, tip_clearance: float = 0.0, palm_margin: float = 0.005) -> list[AssemblyGrasp]:
    """
    Grasps by two parallel jaws: opposite, nearly parallel facets of a segment (`faces`; none: the whole mesh) whose shadows overlap, approached from every direction across the closing axis, at up to three depths (P1 5.3.3).
    
    Keyword options:
        facet_angle: float = 0.1  # faces of one facet bend no more from its largest [rad]
        parallel_angle: float = 0.05  # facets between jaws are off parallel by no more [rad]
        directions: int = 12  # approaches about the closing axis, or turns of centric fingers
        min_contact: float = 0.003  # pads overlap the segment by at least this, along the approach [m]
        pad_length: float = 0.02  # of a pad along the approach [m]
        max_opening: float = 0.25  # wider segments are left out [m]
        finger_width: float = 0.015  # across approach and closing direction [m]
        finger_thickness: float = 0.008  # along the closing direction [m]
        clearance: float = 0.002  # by which each finger opens to approach and to let go [m]
        tip_clearance: float = 0.0  # tips end this short of the far end of what they hold [m]
        palm_margin: float = 0.005  # the palm reaches beyond the open fingers by this [m]
    """
def joint_limit_objective(group: JointGroup, soft_fraction: float = 0.1, weight: float = 1.0) -> IkObjective:
    """
    Weight times the squared depth inside the outer `soft_fraction` of each joint's range, at both ends.
    """
def joint_velocity(theta: float, platform_velocity: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """
    Velocities of the virtual joints x, y, theta for a platform velocity: the inverse of platform_velocity().
    """
def line_contact(force: float, wall_radius: float, length: float, *, pad_width: float, modulus: float, pad_radius: float | None = None) -> ContactArea:
    """
    A pad on a round wall along its axis: Hertz' line contact (Johnson 1985, 4.2), no wider than the pad. Force [N], lengths [m], the modulus of both surfaces together [Pa]; `pad_radius`: of a hollow pad, None: a flat one.
    """
def look_down(eye: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """
    T_world_camera of a camera at `eye` [m] that looks straight down, image x along the world's x.
    """
def make_base_grid(problem: PartSupplyProblem, database: ReachDatabase) -> BaseGrid:
    """
    The grid that covers all base poses from which any tray could be reached.
    """
def make_height_map(image: DepthImage, T_world_map: numpy.typing.ArrayLike, size: numpy.typing.ArrayLike, *, resolution: float = 0.002, hole_radius: int = 2, jump: float = 0.01) -> HeightMap:
    """
    Resamples a depth image over a rectangle of `size` (x, y) [m] around a frame whose z points up.
    
    Keyword options:
        resolution: float = 0.002  # edge of a cell [m]
        hole_radius: int = 2  # holes up to so many pixels from a measurement are filled
        jump: float = 0.01  # neighbouring pixels that differ by more show different surfaces [m]
    """
def manipulation_planner_names() -> list[str]:
    """
    Names that plan_manipulation's `planner` takes.
    """
def maximal_intersections(grid: BaseGrid, regions: collections.abc.Sequence[BaseRegion | numpy.typing.ArrayLike], min_radius: float, *, max_boxes: int = 50000000, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> Intersections:
    """
    Those of the robust sets that are part of no other one: enough to prove a least number of stops.
    """
def minimal_grippers(requirements: collections.abc.Sequence[SegmentRequirement], actuators: collections.abc.Sequence[GripperActuator], *, grid: tuple[int, int] | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, shortest_finger: float = 0.01, longest_finger: float = 0.5, opening_margin: float = 0.0, length_margin: float = 0.0, finger_width: float = 0.015, finger_thickness: float = 0.008, change_cost: float = 0.0, max_nodes: int = 20000, time_limit: float = 60.0) -> MinimalGrippersResult:
    """
    The least set of grippers that takes every part of an assembly, and which one takes which part by which segment (P1 5.3.4, (5.1) and (5.2) with <=). Parts are assembled in the order in which the requirements first name them; of all cheapest sets one with the fewest changes of the gripper is taken. Proven over all grippers; with `grid=(n, m)` only over P1's n openings and m finger lengths.
    
    Keyword options:
        shortest_finger: float = 0.01  # no finger is shorter [m]
        longest_finger: float = 0.5  # no finger is longer [m]
        opening_margin: float = 0.0  # stroke kept free beyond the part at either end [m]
        length_margin: float = 0.0  # kept from either limit of the finger length [m]
        finger_width: float = 0.015  # of the grippers returned [m]
        finger_thickness: float = 0.008  # of the grippers returned [m]
        change_cost: float = 0.0  # of changing the gripper between two parts
        max_nodes: int = 20000  # of the search for fewest changes
        time_limit: float = 60.0  # wall-clock cap [s]
    """
def minimize_derivative_free(objective: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], float], guess: numpy.typing.ArrayLike, lower: numpy.typing.ArrayLike, upper: numpy.typing.ArrayLike, *, solver: str = 'bobyqa', constraints: collections.abc.Callable[[numpy.typing.NDArray[numpy.float64]], numpy.typing.ArrayLike] | None = None, constraint_count: int = 0, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, tolerance: float = 1e-06, constraint_tolerance: float = 1e-08, max_evaluations: int = 10000, time_limit: float = 30.0, seed: int = 1) -> DerivativeFreeResult:
    """
    Least value of `objective(x)` for lower <= x <= upper, found by values alone. `x` is a (n,) array; bounds may be infinite for the local solvers (bobyqa, cobyla, nelder_mead, sbplx), not for the global ones (crs2, isres, direct_l, esch). `constraints(x)` gives `constraint_count` numbers that must be at most 0 (cobyla, isres). Values that are not finite are avoided. What a function raises ends the search and is raised here.
    
    Keyword options:
        tolerance: float = 1e-06  # converged when steps fall below this share of a variable's range
        constraint_tolerance: float = 1e-08  # largest c_i(x) that still counts as kept
        max_evaluations: int = 10000  # budget in points
        time_limit: float = 30.0  # wall-clock cap [s]
        seed: int = 1  # same seed, same answer
    """
def next_view(map: ProbabilisticSdf, hand: Hand, camera: DepthCamera, *, table: float | None = None, object: numpy.typing.ArrayLike | None = None, robot: Robot | None = None, arm: JointGroup | None = None, world: World | None = None, arm_seed: numpy.typing.ArrayLike | None = None, pose_covariance: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, candidates: int = 24, distance: float = 0.35, min_elevation: float = 0.35, max_elevation: float = 1.35, draws: int = 2, max_width: int = 160, threads: int = 0, seed: int = 1, samples: int = 200, max_tilt: float = 1.05, sigmas: float = 2.0, margin: float = 0.002) -> NextView:
    """
    The reachable camera pose after which the best grasp of a part is expected to be most probable.
    
    Poses lie on a sphere around the object. From each a frame is imagined (the map's surface, and behind it the hull of
    what was seen), integrated into a copy of the map, and grasps are searched for there. `camera` is the one that will
    look, `pose_covariance` (6, 6) that of its pose; `arm` is a group whose tip is the camera, other arguments are as in
    synthesize_grasps(). Raises InvalidInput for a map without a surface.
    
    Keyword options:
        candidates: int = 24  # camera poses on the sphere around the object
        distance: float = 0.35  # of the camera from the middle of the object [m]
        min_elevation: float = 0.35  # lowest camera above the horizontal through the middle [rad]
        max_elevation: float = 1.35  # highest [rad]
        draws: int = 2  # frames imagined of each pose, each with noise of its own
        max_width: int = 160  # imagined frames have no more columns [pixels]
        threads: int = 0  # 0: all
        seed: int = 1  # same seed, same view
        samples: int = 200  # grasps evaluated in each imagined map
        max_tilt: float = 1.05  # of the approach against straight down [rad]
        sigmas: float = 2.0  # standard deviations of the surface kept free around the hand
        margin: float = 0.002  # kept free beside them, and above the table [m]
    """
def nlp_solver_names() -> list[str]:
    """
    Names that plan_drive_by's `solver` takes.
    """
def operation_load(operation: AssemblyOperation, requirement: HoldingRequirement) -> OperationLoad:
    """
    The load of an operation; gravity acts along -z of the passive subassembly. InvalidInput for an active part whose mesh is not closed: it has no volume.
    """
def operation_overlap(operation: AssemblyOperation, *, allowed: float = 0.0, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> OperationOverlap:
    """
    The deepest overlap at the end of an operation or, if that is at most `allowed` [m], along its motion (every 2 mm and 0.05 rad, from the end back to the first look that is deeper). Judged at corners and points drawn over the surfaces, so that what it tells is there; what is thinner than their distance may be missed.
    """
def optimised_order(grid: BaseGrid, cells: collections.abc.Sequence[collections.abc.Sequence[numpy.typing.ArrayLike]], groups: collections.abc.Sequence[collections.abc.Sequence[int]], order: collections.abc.Sequence[collections.abc.Sequence[int]], *, smallest_first: bool = False, restarts: int = 20, rng_seed: int = 1) -> OptimisedOrder:
    """
    The order in which parts are best picked when the trays of each group share a stop, never worse than `order`. `cells` is [tray][part], bitmaps (headings, ny, nx).
    """
def optimize_grasp(problem: ObjectPathProblem, pipe: Pipe, *, gripper: Hand | None = None, algorithm: str = 'bees', neighbourhood_kind: str = 'connected_sections', progress: collections.abc.Callable[[str, float], typing.Any] | None = None, motion_weight: float = 0.587, deflection_weight: float = 0.089, manipulability_weight: float = 0.324, motion_scale: float = 1.0, deflection_scale: float = 0.001, manipulability_scale: float = 1.0, max_joint_step: float = 0.5, position_tolerance: float = 0.01, rotation_tolerance: float = 0.05, edge_step: float = 0.02, check_edges: bool = True, single_configuration: bool = False, all_turns: bool = True, redundant_values: int = 0, base_spacing: float = 0.2, base_headings: int = 4, gravity: float = 9.81, max_sag: float = 0.0, population: int = 34, max_evaluations: int = 1530, target: float = ..., seed: int = 1, elite_sites: int = 1, best_sites: int = 4, elite_recruits: int = 10, recruits: int = 3, stagnation_limit: int = 10, neighbourhood: float = 0.2, shrinking: float = 0.8, mutation_rate: float = 0.3, mutation_size: float = 0.25, connectivity: float = 0.5, inertia: float = 0.7, acceleration: float = 2.0, front_searches: int = 0, max_gap: float = 0.001, max_boxes: int = 1000000, time_limit: float = 600.0, threads: int = 0) -> GraspOptimum:
    """
    The grasp of a pipe with the least cost along the path, by a population search: bees, ga or pso (P2 3.4),
    or with its optimum proven: branch_and_bound.
    `gripper`: axes and opening, the problem's when left out. `neighbourhood_kind` of bees: independent (Str1),
    same_section (Str2), connected_sections (Str3).
    
    Keyword options:
        motion_weight: float = 0.587  # weight of O1, the joints' motion
        deflection_weight: float = 0.089  # weight of O2, the largest displacements
        manipulability_weight: float = 0.324  # weight of O3, the force manipulability
        motion_scale: float = 1.0  # O1 is divided by it [rad or m]
        deflection_scale: float = 0.001  # O2 is divided by it [m]
        manipulability_scale: float = 1.0  # O3 is divided by it
        max_joint_step: float = 0.5  # more from pose to pose is a jump, refused [rad or m]
        position_tolerance: float = 0.01  # of the object half way between poses [m]
        rotation_tolerance: float = 0.05  # of the object half way between poses [rad]
        edge_step: float = 0.02  # largest joint step between collision checks [rad or m]
        check_edges: bool = True  # check motions between poses for collisions
        single_configuration: bool = False  # one arm configuration a pose (P2's single IK)
        all_turns: bool = True  # joints that may turn more than once come in every turn
        redundant_values: int = 0  # samples of a seventh joint, evenly over its range; 0: 24
        base_spacing: float = 0.2  # grid of the places where a moving base may stand [m]
        base_headings: int = 4  # headings of the base at each place, evenly over a turn
        gravity: float = 9.81  # along the world's -z [m/s2]
        max_sag: float = 0.0  # largest displacement allowed at any pose [m]; 0: any
        population: int = 34  # points a round
        max_evaluations: int = 1530  # budget in grasps
        target: float = -inf  # ends as solved once a grasp costs no more
        seed: int = 1  # same seed, same answer
        elite_sites: int = 1  # bees: P2's ne
        best_sites: int = 4  # bees: P2's nb
        elite_recruits: int = 10  # bees: P2's nre
        recruits: int = 3  # bees: P2's nrb
        stagnation_limit: int = 10  # bees: rounds without progress until a site is abandoned
        neighbourhood: float = 0.2  # bees: its width as a share of each range at first
        shrinking: float = 0.8  # bees: its factor after a round without progress
        mutation_rate: float = 0.3  # ga: chance of each variable
        mutation_size: float = 0.25  # ga: half width as a share of the range
        connectivity: float = 0.5  # pso: share of the others each particle hears of
        inertia: float = 0.7  # pso: of velocity
        acceleration: float = 2.0  # pso: P2's c1 and c2
        front_searches: int = 0  # further searches, each for another mix of the objectives: the Pareto front is searched
        max_gap: float = 0.001  # branch_and_bound: ends once no grasp can be cheaper by this share
        max_boxes: int = 1000000  # branch_and_bound: budget in boxes of grasps
        time_limit: float = 600.0  # Wall-clock cap of all searches together [s]
        threads: int = 0  # branch_and_bound: 0: all; the answer does not depend on it
    """
def paired_order(places: collections.abc.Sequence[numpy.typing.ArrayLike]) -> list[list[int]]:
    """
    P1's heuristic (figure 3.11): parts of neighbouring trays at nearly constant distances go together. `places` is one (m, 2) array of positions a tray; the answer is [tray][round].
    """
def pairwise_weights(comparison: numpy.typing.ArrayLike, *, max_consistency_ratio: float = 0.1) -> PairwiseWeights:
    """
    Weights by Saaty's AHP: `comparison[i, j]` says how much i is preferred to j, and [j, i] is one over it. A ratio
    above 10 % is refused, as Saaty advises.
    """
def plan_base_route(arm: JointGroup, world: World, *, home: numpy.typing.ArrayLike, start: numpy.typing.ArrayLike, goal: numpy.typing.ArrayLike, resolution: float = 0.1, clearance: float = 0.0) -> BasePath:
    """
    A driveable, collision-free way of the whole robot with its arm at `home`; poses are x, y, theta. `clearance` [m]
    is kept to all but horizontal planes wherever the base is farther than 1 m from both ends.
    """
def plan_cartesian(checker: CollisionChecker, tool_poses: numpy.typing.ArrayLike, near: numpy.typing.ArrayLike | None = None, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, position_step: float = 0.005, rotation_step: float = 0.02, jump_threshold: float = 0.2, joint_step: float = 0.02, max_branches: int = 64) -> CartesianResult:
    """
    The tip follows straight lines from pose to pose, from the inverse kinematics branch of the first pose that completes
    them with the shortest way, counted from `near` (n,) when that is given. A group that moves a diff_drive base is
    refused: it could not follow such a path.
    
    Keyword options:
        position_step: float = 0.005  # largest tool translation between two waypoints [m]
        rotation_step: float = 0.02  # largest tool rotation between two waypoints [rad]
        jump_threshold: float = 0.2  # a larger joint motion between waypoints is a jump
        joint_step: float = 0.02  # largest joint motion between two checks [rad or m]
        max_branches: int = 64  # configurations of the first pose that are followed at most
    """
def plan_drive_by(robot: Robot | CollisionChecker, group: JointGroup | None = None, world: World | None = None, *, start: numpy.typing.ArrayLike, tasks: collections.abc.Sequence[DriveByTask], goal: numpy.typing.ArrayLike, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, waypoints: int = 35, seeds: int = 8, solutions: int = 1, grasp_assignments: int = 8, goal_configurations: int = 64, iterations: int = 1500, time_limit: float = 600.0, jerk_time: float = 0.0, collisions: bool = True, seed: int = 1, threads: int = 1, solver: str = 'ipopt', tolerance: float = 0.0001, max_iterations: int = 150, solve_time_limit: float = 600.0, smoothing: float = 0.01, margin: float = 0.005, constraint_distance: float = 0.15, refinements: int = 6) -> DriveByResult:
    """
    The fastest motion of base and arm from `start` (n,), at rest, through the tasks in order to `goal`, at rest, without
    stopping for them (P1 chapter 4). goal: a configuration (n,), or (2, n) with lower and upper bounds, infinite where it
    does not matter. The world's objects and the robot itself are obstacles. A prepared CollisionChecker may stand in place of robot, group and world.
    
    Keyword options:
        waypoints: int = 35  # waypoints of the whole motion
        seeds: int = 8  # guesses tried until one leads to a solution
        solutions: int = 1  # solutions compared for one grasp assignment
        grasp_assignments: int = 8  # assignments of a candidate to each task that are planned; the fastest motion is returned; 1: only the one that looks quickest
        goal_configurations: int = 64  # configurations sought per candidate
        iterations: int = 1500  # iterations of all solves together; once they are spent no other solve begins
        time_limit: float = 600.0  # wall-clock cap [s]
        jerk_time: float = 0.0  # accelerations may go from 0 to their limit in no less [s]; 0: no limit
        collisions: bool = True  # the robot keeps clear of the world and of itself
        seed: int = 1  # same seed, same answer
        threads: int = 1  # 0: all; does not change the answer
        solver: str = 'ipopt'  # a name of nlp_solver_names()
        tolerance: float = 0.0001  # relative optimality
        max_iterations: int = 150  # iterations of one solve; an optimisation takes at most 1 + refinements solves
        solve_time_limit: float = 600.0  # wall-clock cap of one optimisation, which has 1 + refinements solves at most [s]
        smoothing: float = 0.01  # weight of the mean square of accelerations over their limits [s]
        margin: float = 0.005  # distance to keep from obstacles and from oneself [m]
        constraint_distance: float = 0.15  # pairs of bodies nearer than this are constrained [m]
        refinements: int = 6  # times that collision constraints may be added
    """
def plan_grippers(operations: collections.abc.Sequence[AssemblyOperation], actuators: collections.abc.Sequence[GripperActuator], *, keep_off: collections.abc.Sequence[KeepOff] = [], holding: HoldingRequirement | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, finger_width: float = 0.015, finger_thickness: float = 0.008, clearance: float = 0.002, shortest_finger: float = 0.01, longest_finger: float = 0.15, opening_margin: float = 0.001, length_margin: float = 0.001, min_contact: float = 0.003, tip_clearance: float = 0.0005, directions: int = 12, max_overlap: float = 0.0005, change_cost: float = 0.0, max_nodes: int = 20000, time_limit: float = 60.0, max_rehearsals: int = 200, threads: int = 0) -> PlanGrippersResult:
    """
    The least set of grippers that puts an assembly together (P1 chapter 5), from meshes and an order: segments, primitives (boxes for two jaws, cylinders for three centric fingers), grasps that meet nothing over the whole operation with some finger length, the least set, and every operation gone through again with the gripper itself by the collision checker; where that meets something, the set is chosen again without the grasp. Of several segments and depths that no more grippers could take, the one is taken on which the insertion bears most evenly, then the one held most safely (both with `holding`), then the one touched on most surface.
    
    Keyword options:
        finger_width: float = 0.015  # across approach and closing direction [m]
        finger_thickness: float = 0.008  # along the closing direction [m]
        clearance: float = 0.002  # how far each finger opens to approach and to let go [m]
        shortest_finger: float = 0.01  # no finger is shorter [m]
        longest_finger: float = 0.15  # no finger is longer [m]
        opening_margin: float = 0.001  # stroke kept free beyond the part at either end [m]
        length_margin: float = 0.001  # kept from either limit of the finger length [m]
        min_contact: float = 0.003  # pads overlap a segment by at least this, along the approach [m]
        tip_clearance: float = 0.0005  # tips end this short of the far end of the segment [m]
        directions: int = 12  # approaches about the closing axis, or turns of centric fingers
        max_overlap: float = 0.0005  # parts may stand in each other by this [m]
        change_cost: float = 0.0  # of changing the gripper between two operations
        max_nodes: int = 20000  # of the search for fewest changes
        time_limit: float = 60.0  # the search for the least set ends after this, on the clock [s]
        max_rehearsals: int = 200  # most sets that are rehearsed, each without what met something
        threads: int = 0  # 0: all
    """
def plan_manipulation(problem: ManipulationProblem, *, roadmap: Roadmap | None = None, checker: CollisionChecker | None = None, padding: float | mmgrasp.records.WorldPadding | collections.abc.Mapping[str, float | collections.abc.Mapping[str, float]] | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, on_solution: collections.abc.Callable[[Improvement], typing.Any] | None = None, planner: str = 'prm_star_mg', ik_solutions: int = 8, first_grasps: int = 4, straight: bool = True, ik_restarts: int = 30, joint_step: float = 0.02, workspace_step: float = 0.005, joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None, max_length: float = 0.0, time_limit: float = 15.0, seed: int = 1, threads: int = 0, batch: int = 0, lazy_grasps: bool = True, max_vertices: int = 0, shorten: bool = True, refinements: int = 4, vertices: int = 5000, gamma: float = 0.0, neighbours: int = 0, roadmap_seed: int = 1, max_iterations: int = 1000, range: float = 1.5, rrt_gamma: float = 0.0, exploration: float = 0.5, bidirectional: bool = True, informed: bool = True, goal_cost: float = 0.0, keep_trees: bool = False) -> ManipulationResult:
    """
    Collision-free path of the group that carries the object from start to goal with the best of the grasps (P2 chapters 4 and 5). Every grasp is checked. `padding`: in place of that of the problem's world, see World.padding. `checker`: a prepared CollisionChecker of the problem's group and world. `on_solution` is called with every better solution (an Improvement); what it raises ends the call.
    
    Keyword options:
        planner: str = 'prm_star_mg'  # a name of manipulation_planner_names()
        ik_solutions: int = 8  # arm postures tried for each grasp at each end, in all whole turns
        first_grasps: int = 4  # grasps checked, one by one, before those without a first path are searched again, then twice as many; 0: all before any search
        straight: bool = True  # try straight joint lines from start to goal
        ik_restarts: int = 30  # random starts of arms without a closed form
        joint_step: float = 0.02  # no joint moves more between two checks of an edge [rad or m]
        workspace_step: float = 0.005  # no point of the robot or the object moves more between two checks [m]
        joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None  # what a motion of each joint costs in the length of a path, (n,) or by joint name (others: 1), each > 0; None: 1
        max_length: float = 0.0  # the least grasp cost among paths no longer than this; 0: their sum
        time_limit: float = 15.0  # wall-clock cap on IK and search, without the roadmap's building [s]
        seed: int = 1  # same seed, same path
        threads: int = 0  # 0: all; does not change the answer
        batch: int = 0  # prm_star_mg: grasps searched together before paths are checked; 1: naive, 0: all
        lazy_grasps: bool = True  # prm_star_mg: search a grasp only when its straight line could still win
        max_vertices: int = 0  # prm_star_mg: once the roadmap's best path is found, double its vertices up to this; 0: never
        shorten: bool = True  # prm_star_mg: shorten the roadmap's best path at the end
        refinements: int = 4  # prm_star_mg: then search so many small roadmaps drawn where a cheaper path can pass
        vertices: int = 5000  # prm_star_mg without a roadmap given: configurations drawn
        gamma: float = 0.0  # likewise: > 0: vertices nearer than gamma (log n / n)^(1/d) are joined (P2: 4) [rad or m]; 0: the e (1 + 1/d) log n nearest ones
        neighbours: int = 0  # likewise: > 0: that many nearest ones are joined instead
        roadmap_seed: int = 1  # likewise: same seed, same roadmap
        max_iterations: int = 1000  # rrt_star_mg: budget in samples
        range: float = 1.5  # rrt_star_mg: longest edge grown towards a sample [rad or m, times the weights' root mean square]
        rrt_gamma: float = 0.0  # rrt_star_mg: vertices nearer than gamma (log n / n)^(1/(d+1)) are joined; 0: about (d + 1) / 2 n^(1/(d+1)) log n of n
        exploration: float = 0.5  # rrt_star_mg: once solved, chance to grow the drawn grasp's own tree (P2's p_blt)
        bidirectional: bool = True  # rrt_star_mg: trees from both ends
        informed: bool = True  # rrt_star_mg: draw only where a better path can pass
        goal_cost: float = 0.0  # rrt_star_mg: ends with the first path that costs no more; inf: the first at all
        keep_trees: bool = False  # rrt_star_mg: hand over the trees with the result
    """
def plan_motion(robot: Robot | CollisionChecker, group: JointGroup | None = None, world: World | None = None, *, start: numpy.typing.ArrayLike, goal: numpy.typing.ArrayLike | None = None, tool_poses: numpy.typing.ArrayLike | None = None, regions: collections.abc.Sequence[ToolRegion] = [], via: numpy.typing.ArrayLike | None = None, orientation_constraint: OrientationConstraint | None = None, padding: float | mmgrasp.records.WorldPadding | collections.abc.Mapping[str, float | collections.abc.Mapping[str, float]] | None = None, on_solution: collections.abc.Callable[[Improvement], typing.Any] | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, planner: str = 'rrt_connect', time_limit: float = 5.0, max_iterations: int = 20000, joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None, range: float = 0.0, near_end_probability: float = 0.2, base_margin: float = 2.0, joint_step: float = 0.02, workspace_step: float = ..., shorten: bool = True, shorten_iterations: int = 200, ik_solutions: int = 8, region_samples: int = 16, seed: int = 1) -> MotionResult:
    """
    A collision-free path of the group from `start` (n,) to any of its goals: `goal` (n,) or several as (m, n),
    `tool_poses` of the tip, (4, 4) or (m, 4, 4), and `regions` of them, reached by inverse kinematics; by way of the
    configurations `via` (k, n), one after the other. A prepared CollisionChecker may stand in place of robot, group
    and world. `orientation_constraint` holds on the whole path. `padding`: in place of the world's own, see
    World.padding. `on_solution` is called with every better path (an Improvement); what it raises ends the call.
    A diff-drive base turns on the spot and drives straight.
    
    Keyword options:
        planner: str = 'rrt_connect'  # a name of planner_names()
        time_limit: float = 5.0  # wall-clock cap [s]
        max_iterations: int = 20000  # budget in states drawn
        joint_weights: numpy.typing.ArrayLike | collections.abc.Mapping[str, float] | None = None  # what a motion of each joint costs in the length of a path, (n,) or by joint name (others: 1), each > 0; None: 1
        range: float = 0.0  # longest tree edge [rad or m, times the weights' root mean square]; 0: a share of the joint limits' diagonal
        near_end_probability: float = 0.2  # roadmap planners: chance to draw around the start or a goal; 0: uniform draws alone
        base_margin: float = 2.0  # the base is drawn this far around start and goals [m]
        joint_step: float = 0.02  # largest joint motion between two checks [rad or m]
        workspace_step: float = inf  # largest motion of any robot point between two checks [m]
        shorten: bool = True  # shortcut the path
        shorten_iterations: int = 200  # tries of the shortening
        ik_solutions: int = 8  # arm postures looked for at each tool pose, each in all its whole turns
        region_samples: int = 16  # tool poses drawn in each region
        seed: int = 1  # same seed, same path
    """
def plan_object_pick(arm: JointGroup, gripper: Hand, world: World, object: str, grasps: collections.abc.Sequence[Grasp], *, database: ReachDatabase, home: numpy.typing.ArrayLike, base_pose: numpy.typing.ArrayLike, places: numpy.typing.ArrayLike | None = None, mass: float = 0.0, approach_distance: float = 0.08, lift_height: float = 0.12, motion_time_limit: float = 5.0, ik_seeds: int = 8, seed: int = 1) -> Pick:
    """
    Picks any object of a world: the first of the grasps with a collision-free configuration, straight approach and
    lift, and motions from `home` (m,) and to one of `places`, (k, 4, 4) world poses of the object; without places
    the object stays in the hand. The robot stands at `base_pose` (x, y, theta); hands of suction cups need the object's
    `mass` [kg].
    
    
    
    Keyword options:
        approach_distance: float = 0.08  # straight move from pre-grasp to grasp [m]
        lift_height: float = 0.12  # straight upward move after closing [m]
        motion_time_limit: float = 5.0  # for each planned motion [s]
        ik_seeds: int = 8  # database configurations refined for each grasp
        seed: int = 1  # same seed, same pick
    """
def plan_part_supply(problem: PartSupplyProblem, database: ReachDatabase, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> PartSupplyPlan:
    """
    The whole of P1's Algorithm 1 and the motions around it, for a problem given as objects.
    """
def plan_pick(problem: PartSupplyProblem, database: ReachDatabase, base_pose: numpy.typing.ArrayLike, tray: int, part: int, remaining: collections.abc.Sequence[tuple[int, int]]) -> Pick:
    """
    One pick from a base pose; `remaining` are the (tray, part) still in place, the picked one among them.
    """
def plan_platform_locations(checker: CollisionChecker, T_world_pick: numpy.typing.ArrayLike, T_world_place: numpy.typing.ArrayLike, *, pick_point: numpy.typing.ArrayLike | None = None, place_point: numpy.typing.ArrayLike | None = None, camera_link: str | None = None, T_link_camera: numpy.typing.ArrayLike | None = None, camera: PinholeCamera | None = None, database: IkSeedDatabase | None = None, samples: int = 100, max_draws: int = 2000, least_manipulability: float = 0.02, turn_weight: float = 0.3, seed: int = 1, time_limit: float = 10.0) -> PlatformLocations:
    """
    Two base + arm configurations for two tool poses with the least base travel (P3 3.6, Algorithm 2). The checker's group
    must have the base. With a `camera_link` the points (default: the tool positions) are in view of
    `camera` (default: PinholeCamera()), whose frame looks along +z. A database starts the searches and learns from them.
    
    Keyword options:
        samples: int = 100  # valid configurations drawn for each pose
        max_draws: int = 2000  # searches for each pose, valid or not
        least_manipulability: float = 0.02  # over the arm's joints
        turn_weight: float = 0.3  # what one radian of base turn counts as [m]
        seed: int = 1  # same seed, same answer
        time_limit: float = 10.0  # wall-clock cap [s]
    """
def plan_stop_picks(problem: PartSupplyProblem, database: ReachDatabase, base_pose: numpy.typing.ArrayLike, trays: collections.abc.Sequence[int], remaining: collections.abc.Sequence[tuple[int, int]], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> tuple[Outcome, list[Pick]]:
    """
    Every pick of a stop from where the base really stands: the target parts of these trays among `remaining`, the
    (tray, part) still in place. Returns how it ended and the picks in order; without a solution those that failed.
    InvalidInput when the robot at home is not free there.
    """
def plan_stops_exact(grid: BaseGrid, regions: collections.abc.Sequence[BaseRegion | numpy.typing.ArrayLike], min_radius: float = 0.1, *, time_limit: float = 60.0, tie_time_limit: float = 10.0, start: numpy.typing.ArrayLike | None = None, goal: numpy.typing.ArrayLike | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> StopSet:
    """
    The least number of stops over regions (or masks), with proof; among equally few the widest discs, then, with `start` and `goal` (x, y), the shortest route as the crow flies.
    """
def plan_straight_line(checker: CollisionChecker, start: numpy.typing.ArrayLike, T_world_to: numpy.typing.ArrayLike, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, position_step: float = 0.005, rotation_step: float = 0.02, jump_threshold: float = 0.2, joint_step: float = 0.02) -> StraightLineResult:
    """
    The tool moves on a straight line from the pose of `start` to T_world_to. A group that moves a diff_drive base is
    refused: it could not follow such a path.
    
    Keyword options:
        position_step: float = 0.005  # largest tool translation between two waypoints [m]
        rotation_step: float = 0.02  # largest tool rotation between two waypoints [rad]
        jump_threshold: float = 0.2  # a larger joint motion between two waypoints is a jump
        joint_step: float = 0.02  # largest joint motion between two checks [rad or m]
    """
def planar_facets(mesh: Mesh, faces: collections.abc.Sequence[int] = [], *, angle: float = 0.1) -> list[Facet]:
    """
    Nearly plane pieces of a mesh, or of some of its faces (none: all), largest first: each grows from the largest face left, as long as faces bend no more than `angle` [rad] from it.
    """
def planner_names() -> list[str]:
    """
    Names that plan_motion's `planner` takes.
    """
@typing.overload
def platform_velocity(theta: float, joint_velocity: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """
    Velocity command (v_x, v_y, omega) in the platform's own frame for velocities of the virtual joints x, y, theta
    standing at heading theta (P3 3.12) [m/s, rad/s].
    """
@typing.overload
def platform_velocity(*, left: float, right: float, wheel_separation: float) -> numpy.typing.NDArray[numpy.float64]:
    """
    The same of a diff-drive whose wheel rims move at `left` and `right` [m/s]: v = (left + right) / 2,
    omega = (right - left) / wheel_separation (P1 4.11).
    """
def population_search_names() -> list[str]:
    """
    The population searches among grasp_search_names().
    """
def pose(xyz: numpy.typing.ArrayLike, rpy: numpy.typing.ArrayLike | None = None, quat_xyzw: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]:
    """
    A (4, 4) pose from a position [m] and roll-pitch-yaw (URDF's convention) [rad] or a quaternion (x, y, z, w).
    """
def pose_to_xyz_quat(T: numpy.typing.ArrayLike) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Position (3,) and quaternion (x, y, z, w) of a (4, 4) pose.
    """
def pose_to_xyz_rpy(T: numpy.typing.ArrayLike) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]:
    """
    Position (3,) and roll-pitch-yaw (3,) of a (4, 4) pose.
    """
def preferred_grippers(requirements: collections.abc.Sequence[SegmentRequirement], values: numpy.typing.ArrayLike, actuators: collections.abc.Sequence[GripperActuator], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, shortest_finger: float = 0.01, longest_finger: float = 0.5, opening_margin: float = 0.0, length_margin: float = 0.0, finger_width: float = 0.015, finger_thickness: float = 0.008, change_cost: float = 0.0, max_nodes: int = 20000, time_limit: float = 60.0) -> MinimalGrippersResult:
    """
    A set of no higher cost and no more changes than minimal_grippers' that takes each part by its best segment, as far as one does: parts in the order of assembly, of each the requirements by `values` (one per requirement), highest first.
    
    Keyword options:
        shortest_finger: float = 0.01  # no finger is shorter [m]
        longest_finger: float = 0.5  # no finger is longer [m]
        opening_margin: float = 0.0  # stroke kept free beyond the part at either end [m]
        length_margin: float = 0.0  # kept from either limit of the finger length [m]
        finger_width: float = 0.015  # of the grippers returned [m]
        finger_thickness: float = 0.008  # of the grippers returned [m]
        change_cost: float = 0.0  # of changing the gripper between two parts
        max_nodes: int = 20000  # of the search for fewest changes
        time_limit: float = 60.0  # wall-clock cap [s]
    """
def push_grasp(*, hand: Hand | None = None, opening: float = 0.1, closing_speed: float = 0.1, tool_speed: float = 0.3, finger_length: float = 0.12, object_width: float = 0.05, grip_depth: float = 0.02, planned_depth: float = 0.06, clearance: float = 0.0, max_push: float = 0.1, along_error: float = 0.0, lateral_error: float = 0.0, along_deviation: float = 0.0, lateral_deviation: float = 0.0, sigmas: float = 3.0) -> PushGrasp:
    """
    When a hand that moves on may begin to close, and what error of the object's position it forgives (P1 4.3).
    Lengths are those of `hand` where no keyword gives them.
    
    Keyword options:
        opening: float = 0.1  # between the fingers before they close [m]
        closing_speed: float = 0.1  # how fast the opening shrinks [m/s]
        tool_speed: float = 0.3  # along the approach [m/s]
        finger_length: float = 0.12  # from the palm to the tips [m]
        object_width: float = 0.05  # along the closing direction [m]
        grip_depth: float = 0.02  # least engagement that holds [m]
        planned_depth: float = 0.06  # engagement at the planned grasp pose [m]
        clearance: float = 0.0  # kept on either side while the fingers pass the object [m]
        max_push: float = 0.1  # how far the object may slide before the palm [m]
        along_error: float = 0.0  # the object may stand this much nearer or farther [m]
        lateral_error: float = 0.0  # and this much to either side [m]
        along_deviation: float = 0.0  # standard deviation of the object's position along the approach [m]
        lateral_deviation: float = 0.0  # the same along the closing direction [m]
        sigmas: float = 3.0  # errors of this many deviations are covered
    """
def push_speed_limit(*, length: float, friction: float, restitution: float) -> float:
    """
    Fastest tool [m/s] before whose palm a hit object does not leap more than `length` [m].
    """
def quat_xyzw_from_rotation(R: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]:
    """
    Quaternion (x, y, z, w) of a (3, 3) rotation.
    """
def random_placement(part: collections.abc.Sequence[LinkShape], tray_size: numpy.typing.ArrayLike, *, count: int = 12, fill: float = 1.0, wall: float = 0.005, draws: int = 100, stack: bool = True, clearance: float = 0.0005, seed: int = 1) -> RandomPlacement:
    """
    Alike parts lying in a tray at random (P1 3.5.2), let down one after another without touching; `fill` is the share
    of `count` that is there. The tray's frame is the middle of its floor, `tray_size` are outer lengths.
    
    Keyword options:
        draws: int = 100  # random places tried for each part
        stack: bool = True  # a part without a place on the floor may lie on others
        clearance: float = 0.0005  # air left between bodies [m]
        seed: int = 1  # same seed, same places
    """
def read_pcd(path: str | os.PathLike[str]) -> PointCloud:
    """
    Reads a PCD file: ascii, binary or binary_compressed. Raises IoError naming file and rule.
    """
def rectangular_section(y_length: float, z_length: float, wall: float = 0.0) -> BeamSection:
    """
    Rectangle by its outer lengths and its wall [m]; without a wall a bar. Torsion of tubes by Bredt (thin walls).
    """
def register_frame(sdf: ProbabilisticSdf, image: DepthImage, camera: DepthCamera, *, pose_covariance: numpy.typing.ArrayLike, sigma: numpy.typing.ArrayLike | None = None, max_points: int = 4000, max_iterations: int = 30, max_distance: float = 0.05, min_overlap: float = 0.3, max_correction: float = 4.0, min_observability: float = 0.0015, threads: int = 0) -> FrameRegistration:
    """
    Moves a frame's pose so that its depths meet the map: point to plane on the map's field, Gauss-Newton, weighted by
    the variances of both. The given pose counts with `pose_covariance` (6, 6), which must be positive definite: it says
    how far the pose may be moved. What the surface does not fix (a plane slid in itself) is not moved. The map stays as
    it is; integrate the frame with the pose and the covariance that come back. What all frames of the map are wrong by
    together can not be told. Raises InvalidInput on frames that integrate() would refuse, an empty map and options out
    of range.
    
    Keyword options:
        max_points: int = 4000  # pixels that are compared, spread evenly; at least 100
        max_iterations: int = 30  # steps of Gauss-Newton
        max_distance: float = 0.05  # pixels farther from the map's surface are not compared [m]
        min_overlap: float = 0.3  # share of the compared pixels that must meet the map
        max_correction: float = 4.0  # farther from the given pose, in its standard deviations, is refused
        min_observability: float = 0.0015  # directions along which the surface moves by less than this share of the motion stay as given
        threads: int = 0  # 0: all
    """
def rehearse_operation(gripper: Gripper, grasp: AssemblyGrasp, operation: AssemblyOperation) -> str:
    """
    What a gripper meets first when it goes through an operation, told by the collision checker: while it approaches from 0.1 m away, grasps, moves, and lets go and moves back as far. '' when nothing.
    """
def render_depth(scene: collections.abc.Sequence[LinkShape], camera: PinholeCamera, T_world_camera: numpy.typing.ArrayLike, *, noise: float = 0.0, missing: float = 0.0, seed: int = 1, threads: int = 0) -> DepthImage:
    """
    The depth image of shapes whose poses are in the world: one ray a pixel, first surface in front of the camera.
    
    Keyword options:
        noise: float = 0.0  # standard deviation of the depth at 1 m; grows with the square of the distance [m]
        missing: float = 0.0  # share of pixels without a measurement, in [0, 1]
        seed: int = 1  # same seed, same image
        threads: int = 0  # 0: all
    """
def resting_poses(part: collections.abc.Sequence[LinkShape]) -> list[RestingPose]:
    """
    Faces of a part's convex hull on which it does not tip over, most probable first.
    """
def robust_intersections(grid: BaseGrid, regions: collections.abc.Sequence[BaseRegion | numpy.typing.ArrayLike], min_radius: float, max_sets: int = 200000) -> Intersections:
    """
    Every set of trays whose shared cells hold a disc of at least `min_radius` [m] (P1 3.4.2).
    """
def round_section(outer_diameter: float, inner_diameter: float = 0.0) -> BeamSection:
    """
    Tube by its diameters [m]; without an inner one a bar.
    """
def route_lengths(arm: JointGroup, world: World, *, home: numpy.typing.ArrayLike, positions: numpy.typing.ArrayLike, resolution: float = 0.1, threads: int = 0, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> numpy.typing.NDArray[numpy.float64]:
    """
    (m, m): how far it is to drive between base poses (m, 3), around what stands in the way; infinite: no way found.
    """
def run_policy(grid: BaseGrid, cells: collections.abc.Sequence[collections.abc.Sequence[numpy.typing.ArrayLike]], order: collections.abc.Sequence[collections.abc.Sequence[int]], policy: str = 'all', *, min_radius: float = 0.1, online_limit: float = 1.0, time_limit: float = 60.0, tie_time_limit: float = 10.0, planned: collections.abc.Callable[[int], collections.abc.Sequence[BaseRegion | numpy.typing.ArrayLike]] | None = None, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> PolicyResult:
    """
    Plans the stops of every round for all parts, the `remaining` or the `targets` and holds them against the parts' bitmaps `cells` [tray][part]. `planned(round)` gives other regions to plan with, one a tray: what they cost counts as time between the rounds.
    """
def sample_grasps(object: collections.abc.Sequence[LinkShape], gripper: Hand, *, approaches: int = 8, positions: int = 3, mesh_samples: int = 400, max_grasps: int = 200, friction: float = 0.5, standoff: float = 0.0, approach_direction: numpy.typing.ArrayLike | None = None, seed: int = 1) -> list[Grasp]:
    """
    Antipodal grasps of a body given as a list of LinkShape (P1 3.4.1), best first.
    
    Keyword options:
        approaches: int = 8  # approach directions around each closing axis
        positions: int = 3  # pad positions along each free direction
        mesh_samples: int = 400  # surface points tried on a mesh, eight times as many where few pairs fit the hand
        max_grasps: int = 200  # best kept, spread over approach directions
        friction: float = 0.5  # Coulomb coefficient
        standoff: float = 0.0  # how far the tool frame stays outside the object's middle [m]
        approach_direction: numpy.typing.ArrayLike | None = None  # of every grasp: a unit vector in the object's frame; None: from all around
        seed: int = 1  # same seed, same grasps
    """
def sample_suction_grasps(object: collections.abc.Sequence[LinkShape], hand: Hand, mass: float = 0.0, *, turns: int = 8, surface_samples: int = 300, max_grasps: int = 96, seed: int = 1) -> SampledSuctionGrasps:
    """
    Grasps of a body given as a list of LinkShape by a hand's suction cups: where every cup seals and, with a `mass` [kg] above 0,
    the part is held at rest however the hand is turned; best first.
    
    Keyword options:
        turns: int = 8  # turns of the hand about its approach at each place
        surface_samples: int = 300  # places drawn on the surface
        max_grasps: int = 96  # best kept, spread over approach directions and turns
        seed: int = 1  # same seed, same grasps
    """
def seal_gap(object: collections.abc.Sequence[LinkShape], T_object_hand: numpy.typing.ArrayLike, approach: numpy.typing.ArrayLike, suction: Suction) -> float:
    """
    How far [m] a body's surface falls back from the planes of the cups' rims at most, with the hand at T_object_hand (4, 4) and
    the cups facing along `approach` (3,); inf where a rim or what it encloses reaches beside the body or over a hole, negative
    where the body reaches through a rim's plane.
    """
def segment_depth_image(image: DepthImage, *, plane: SupportingPlane | None = None, up: numpy.typing.ArrayLike | None = None, leaf: float = 0.004, plane_tolerance: float = 0.007, up_angle: float = 0.35, min_plane_share: float = 0.15, max_height: float = 0.5, max_beside: float = 0.05, patch: float = 0.02, concavity: float = 0.45, min_points: int = 100, plane_iterations: int = 1000) -> ObjectSegmentation:
    """
    segment_objects for what one camera sees: labels are one a pixel, row by row, plane and bounds in the world.
    
    Keyword options:
        leaf: float = 0.004  # cell to which points are thinned [m]; above the points' spacing
        plane_tolerance: float = 0.007  # points no farther from the plane belong to it [m]
        up_angle: float = 0.35  # the plane's normal lies within this of `up` [rad]
        min_plane_share: float = 0.15  # planes with a smaller share of the thinned points support nothing
        max_height: float = 0.5  # points higher above the plane are left out [m]
        max_beside: float = 0.05  # objects farther than this beside a plane that was found are left out [m]
        patch: float = 0.02  # distance of the patches that convexity is judged between [m]; at least 2 leaf
        concavity: float = 0.45  # creases of up to this angle do not part objects [rad]
        min_points: int = 100  # smaller objects are left out
        plane_iterations: int = 1000  # random planes tried
    """
def segment_mesh(mesh: Mesh, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, rays: int = 30, cone: float = 2.0943951023931953, outlier: float = 1.0, ray_lengths: bool = False, max_clusters: int = 8, smoothing: float = 0.3, crease: float = 0.6, min_size: float = 0.02, convexity: float = 0.05, smooth_threads: bool = True, faces: int = 20000, seed: int = 1, threads: int = 0) -> MeshSegmentation:
    """
    Cuts the surface of a mechanical part into the simple bodies that it is composed of (P1, section 5.1): by shape diameter
    (Gaussian mixture, minimum cuts) and where the surface bends inwards; pieces whose hull is no more than the two are joined
    again, and inner walls go with the outer wall behind them. Raises InvalidInput for a mesh without area or with more than
    10 million triangles.
    
    Keyword options:
        rays: int = 30  # rays from the middle of each face
        cone: float = 2.0943951023931953  # full angle of their cone around the inward normal [rad]
        outlier: float = 1.0  # standard deviations from the median beyond which rays are left out
        ray_lengths: bool = False  # P1's mean length of the rays, not the width between the surfaces
        max_clusters: int = 8  # most Gaussians over the logarithms of the diameters
        smoothing: float = 0.3  # cost of a border between clusters beside faces in the wrong one
        crease: float = 0.6  # inward creases of more, sharp or rounded over min_size, part segments [rad]
        min_size: float = 0.02  # narrower segments join a neighbour, as a share of the mesh's diagonal
        convexity: float = 0.05  # segments join when their hull has at most this share of the smaller one's volume in neither
        smooth_threads: bool = True  # screw threads count as the cylinder through their crests
        faces: int = 20000  # larger faces are cut until there are about so many, for the work alone
        seed: int = 1  # same seed, same segments
        threads: int = 0  # 0: all
    """
def segment_names(primitives: collections.abc.Sequence[FittedPrimitive]) -> list[str]:
    """
    A name for each segment of a part by its primitive: the kind and the place among those of the kind, from 1, in the order of the segments, largest area first: cylinder_1, box_1, cylinder_2.
    """
def segment_objects(points: numpy.typing.ArrayLike, normals: numpy.typing.ArrayLike | None = None, *, plane: SupportingPlane | None = None, up: numpy.typing.ArrayLike | None = None, eye: numpy.typing.ArrayLike | None = None, leaf: float = 0.004, plane_tolerance: float = 0.007, up_angle: float = 0.35, min_plane_share: float = 0.15, max_height: float = 0.5, max_beside: float = 0.05, patch: float = 0.02, concavity: float = 0.45, min_points: int = 100, plane_iterations: int = 1000) -> ObjectSegmentation:
    """
    Objects that stand on a plane, also ones that touch: they are parted where the surface has creases (Stein et al.,
    CVPR 2014). `points` (n, 3) or (rows, columns, 3) [m], NaN: not measured; `normals` alike, unit, away from the solid,
    as ProbabilisticSdf.points() gives them; without, they are fitted to the points and turned to `eye` (default: the
    origin), which suits a scan from one side. The plane is the largest with most other points above it, its normal near
    `up` when that is given; or `plane`. The arms of an L are two objects, the inside of a bowl is one of its own. Raises
    InvalidInput on values out of range.
    
    Keyword options:
        leaf: float = 0.004  # cell to which points are thinned [m]; above the points' spacing
        plane_tolerance: float = 0.007  # points no farther from the plane belong to it [m]
        up_angle: float = 0.35  # the plane's normal lies within this of `up` [rad]
        min_plane_share: float = 0.15  # planes with a smaller share of the thinned points support nothing
        max_height: float = 0.5  # points higher above the plane are left out [m]
        max_beside: float = 0.05  # objects farther than this beside a plane that was found are left out [m]
        patch: float = 0.02  # distance of the patches that convexity is judged between [m]; at least 2 leaf
        concavity: float = 0.45  # creases of up to this angle do not part objects [rad]
        min_points: int = 100  # smaller objects are left out
        plane_iterations: int = 1000  # random planes tried
    """
def self_distance_objective(checker: CollisionChecker, margin: float = 0.05, weight: float = 1.0) -> IkObjective:
    """
    Weight times the sum of (1 - distance / margin)^2 over pairs of the robot's own links nearer than `margin` [m].
    """
def shape_diameters(mesh: Mesh, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, rays: int = 30, cone: float = 2.0943951023931953, outlier: float = 1.0, ray_lengths: bool = False, threads: int = 0) -> numpy.typing.NDArray[numpy.float64]:
    """
    Local thickness of a mesh at the middle of each face (m,) [m]; 0 where no ray leaves it. The mean over `rays` in a
    cone around the inward normal, weighted by the cosine of their angle to it, of the distance between the two ends along
    the mean of their normals: exact in balls, cylinders, plates and tubes (P1, section 5.1, takes the rays' lengths).
    
    Keyword options:
        rays: int = 30  # rays from the middle of each face
        cone: float = 2.0943951023931953  # full angle of their cone around the inward normal [rad]
        outlier: float = 1.0  # standard deviations from the median beyond which rays are left out
        ray_lengths: bool = False  # P1's mean length of the rays, not the width between the surfaces
        threads: int = 0  # 0: all
    """
def share_headings(problem: PartSupplyProblem, database: ReachDatabase, grid: BaseGrid, regions: collections.abc.Sequence[BaseRegion], *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> list[BaseRegion]:
    """
    The regions of compute_base_regions, and besides where trays that list no headings can be served at another tray's
    heading, in the cells where that one is served: trays that face each other get stops in common.
    """
def share_stops(drive_times: numpy.typing.ArrayLike, stop_times: numpy.typing.ArrayLike, robots: int) -> SharedTours:
    """
    Shares stops among robots so that the last is done as early as can be. `drive_times` is (n + 2 k, n + 2 k): stops, k starts, k goals; infinite: no way.
    """
def shorten_drive_by(group: JointGroup, world: World, *, tasks: collections.abc.Sequence[DriveByTask], times: collections.abc.Sequence[float], positions: numpy.typing.ArrayLike, task_times: collections.abc.Sequence[float], progress: collections.abc.Callable[[str, float], typing.Any] | None = None, waypoints: int = 35, seeds: int = 8, solutions: int = 1, grasp_assignments: int = 8, goal_configurations: int = 64, iterations: int = 1500, time_limit: float = 600.0, jerk_time: float = 0.0, collisions: bool = True, seed: int = 1, threads: int = 1, solver: str = 'ipopt', tolerance: float = 0.0001, max_iterations: int = 150, solve_time_limit: float = 600.0, smoothing: float = 0.01, margin: float = 0.005, constraint_distance: float = 0.15, refinements: int = 6) -> DriveByResult:
    """
    plan_drive_by from a motion that is known instead of guesses: positions (m, n) at times [s], straight between them, free of
    collisions, from rest to rest, at each task at its time; e.g. a drive and a pick one after the other. The answer is near that
    motion. Tasks have one pose and no push.
    
    Keyword options:
        waypoints: int = 35  # waypoints of the whole motion
        seeds: int = 8  # guesses tried until one leads to a solution
        solutions: int = 1  # solutions compared for one grasp assignment
        grasp_assignments: int = 8  # assignments of a candidate to each task that are planned; the fastest motion is returned; 1: only the one that looks quickest
        goal_configurations: int = 64  # configurations sought per candidate
        iterations: int = 1500  # iterations of all solves together; once they are spent no other solve begins
        time_limit: float = 600.0  # wall-clock cap [s]
        jerk_time: float = 0.0  # accelerations may go from 0 to their limit in no less [s]; 0: no limit
        collisions: bool = True  # the robot keeps clear of the world and of itself
        seed: int = 1  # same seed, same answer
        threads: int = 1  # 0: all; does not change the answer
        solver: str = 'ipopt'  # a name of nlp_solver_names()
        tolerance: float = 0.0001  # relative optimality
        max_iterations: int = 150  # iterations of one solve; an optimisation takes at most 1 + refinements solves
        solve_time_limit: float = 600.0  # wall-clock cap of one optimisation, which has 1 + refinements solves at most [s]
        smoothing: float = 0.01  # weight of the mean square of accelerations over their limits [s]
        margin: float = 0.005  # distance to keep from obstacles and from oneself [m]
        constraint_distance: float = 0.15  # pairs of bodies nearer than this are constrained [m]
        refinements: int = 6  # times that collision constraints may be added
    """
def shortest_visiting_tour(lengths: numpy.typing.ArrayLike) -> TourResult:
    """
    Shortest way from start over all n stops to goal. `lengths` is (n + 2, n + 2): stops, start, goal; infinite: no way.
    """
def simplify_mesh(mesh: Mesh, tolerance: float = 0.0) -> mmgrasp.records.MeshStandIn:
    """
    The simplest solid that contains a mesh and has no point farther than `tolerance` [m] from it, as a dict:
    `shape` (a LinkShape in the mesh's frame), `chosen` (mesh, hull, box, sphere or cylinder), `triangles_saved` and
    the proven `deviation` [m]. With 0 the solid stays the same.
    """
def singularity_objective(group: JointGroup, threshold: float, weight: float = 1.0) -> IkObjective:
    """
    Weight times max(0, 1 - M / threshold)^2, M the manipulability of the arm's joints (without the base).
    """
def soft_finger_torque(normal: float, friction: float, torsion_radius: float, tangential: float = 0.0) -> float:
    """
    The torque about its normal that a soft contact holds beside a tangential force [N m], by the ellipsoid that stands for the limit surface (Howe and Cutkosky 1996). Forces [N], torsion_radius [m].
    """
def solve_nonlinear(problem: NonlinearProblem, guess: numpy.typing.ArrayLike, *, solver: str = 'ipopt', progress: collections.abc.Callable[[str, float], typing.Any] | None = None, tolerance: float = 1e-07, constraint_tolerance: float = 1e-08, max_iterations: int = 500, time_limit: float = 30.0, barrier: float = 0.0, warm_start: float = 0.0) -> NlpResult:
    """
    A local optimum of a NonlinearProblem near `guess` (n,), which may lie outside the bounds. `solver`: a name of nlp_solver_names.
    What a method of the problem raises ends the solve and is raised here.
    
    Keyword options:
        tolerance: float = 1e-07  # relative optimality
        constraint_tolerance: float = 1e-08  # largest violation of a solved problem
        max_iterations: int = 500  # budget in iterations (ipopt) or evaluations (slsqp)
        time_limit: float = 30.0  # wall-clock cap [s]
        barrier: float = 0.0  # ipopt: the first barrier parameter, lowered steadily; 0: chosen in each step
        warm_start: float = 0.0  # ipopt: 0 starts afresh; else the guess is trusted and the barrier parameter begins with this
    """
def solve_set_cover(elements: int, sets: collections.abc.Sequence[collections.abc.Sequence[int]], costs: numpy.typing.ArrayLike = (), *, time_limit: float = 60.0, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> SetCoverResult:
    """
    Fewest (or cheapest) sets that cover all of 0..elements-1, with a proof (P1, equation 3.1).
    """
def suction_share(suction: Suction, approach: numpy.typing.ArrayLike, mass: float, centre_of_mass: numpy.typing.ArrayLike, pull: numpy.typing.ArrayLike | None = None) -> float:
    """
    Share of the cups' force that holding a part takes, safety included: above 1 it comes off. `mass` [kg], `centre_of_mass` (3,)
    and `approach` (3,) in the tool frame; `pull` (3,): gravity less acceleration there [m/s^2], None: at rest, however the hand is turned.
    """
def synthesize_grasps(map: ProbabilisticSdf, hand: Hand, *, table: float | None = None, object: numpy.typing.ArrayLike | None = None, robot: Robot | None = None, arm: JointGroup | None = None, world: World | None = None, arm_seed: numpy.typing.ArrayLike | None = None, surface_draws: int = 0, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, samples: int = 200, refined: int = 8, shift: float = 0.012, max_tilt: float = 1.05, table_tolerance: float = 0.004, sigmas: float = 2.0, margin: float = 0.002, approach_distance: float = 0.05, min_distance: float = 0.01, max_grasps: int = 20, threads: int = 0, seed: int = 1, friction: float = 0.5, angle_weight: float = 0.6, placement_weight: float = 0.1, centring_weight: float = 0.2, certainty_weight: float = 0.1, placement_scale: float = 0.01, max_sigma: float = 0.005, rays: int = 5, min_hits: float = 0.5, min_inliers: float = 0.8, plane_tolerance: float = 0.002, correlation_length: float = 0.02) -> GraspSynthesis:
    """
    Grasps of an unknown part in a ProbabilisticSdf, most probable by P3's model (4.9) first.
    
    `table` is the height of the level table that it stands on [m], `object` a box (2, 3) that holds it, least and largest
    corner [m]; without them all of the map is the part. `robot` has the joints and bodies of a hand of
    eigengrasp_hand, which needs it; without it the hand is two pads and its boxes. With `arm`, a group whose tip is the hand's tool link, grasps are
    left out that it does not reach, with `world` without collisions, by inverse kinematics from `arm_seed` (the middle
    of the limits). `surface_draws` > 0 rates what is returned by (4.1) too. Raises InvalidInput for a map without a surface and for a hand of several groups of joints without `robot`.
    
    Keyword options:
        samples: int = 200  # grasps evaluated, a third of them around the best of the others
        refined: int = 8  # grasps around which the second search goes on
        shift: float = 0.012  # farthest that the second search shifts a grasp [m]
        max_tilt: float = 1.05  # of the approach against straight down [rad]
        table_tolerance: float = 0.004  # what the map has up to this, or to `sigmas` of its own, above the table is the table [m]
        sigmas: float = 2.0  # standard deviations of the surface kept free around the hand
        margin: float = 0.002  # kept free beside them, and above the table [m]
        approach_distance: float = 0.05  # straight way in that must be free [m]
        min_distance: float = 0.01  # between returned grasps that close along about one axis [m]
        max_grasps: int = 20  # best kept
        threads: int = 0  # 0: all
        seed: int = 1  # same seed, same grasps
        friction: float = 0.5  # Coulomb coefficient; P3's theta is 2 atan(friction)
        angle_weight: float = 0.6  # w_1 of (4.9); the four sum to 1
        placement_weight: float = 0.1  # w_2: of the pads' distances from the surface
        centring_weight: float = 0.2  # w_3: of the contact line's distance from the object's middle
        certainty_weight: float = 0.1  # w_4: of the surface's standard deviation
        placement_scale: float = 0.01  # sigma_h^2 of (4.6) [m]
        max_sigma: float = 0.005  # surfaces less certain are not touched [m]
        rays: int = 5  # along each side of a pad
        min_hits: float = 0.5  # share of a pad's rays that must meet the surface
        min_inliers: float = 0.8  # share of the hits that must lie in one plane
        plane_tolerance: float = 0.002  # farthest that an inlier lies from the plane [m]
        correlation_length: float = 0.02  # over which the error of the surface changes, for `surface_draws` [m]
    """
def time_parameterize(path: numpy.typing.ArrayLike, velocity_limits: numpy.typing.ArrayLike, acceleration_limits: numpy.typing.ArrayLike, *, names: collections.abc.Sequence[str] = [], progress: collections.abc.Callable[[str, float], typing.Any] | None = None, max_deviation: float = 0.01, sample_period: float = 0.02, jerk_limits: numpy.typing.ArrayLike | None = None) -> JointTrajectory:
    """
    Near time-optimal timing of waypoints (k, n), at rest at both ends; corners are blended, which may leave the path
    by max_deviation.
    
    Keyword options:
        max_deviation: float = 0.01  # corners are blended within this joint distance [rad]
        sample_period: float = 0.02  # spacing of the samples [s]
        jerk_limits: numpy.typing.ArrayLike | None = None  # of each joint [rad/s^3]; None: no such limits
    """
def time_parameterize_free(checker: CollisionChecker, path: numpy.typing.ArrayLike, *, joint_step: float = 0.01, progress: collections.abc.Callable[[str, float], typing.Any] | None = None, max_deviation: float = 0.01, sample_period: float = 0.02, jerk_limits: numpy.typing.ArrayLike | None = None) -> JointTrajectory:
    """
    time_parameterize under the limits of the checker's group, the blended corners checked for collisions too, no joint moving
    more than joint_step between two checks [rad or m]. Without any times when the straight edges of the path are not free.
    
    Keyword options:
        max_deviation: float = 0.01  # corners are blended within this joint distance [rad]
        sample_period: float = 0.02  # spacing of the samples [s]
        jerk_limits: numpy.typing.ArrayLike | None = None  # of each joint [rad/s^3]; None: no such limits
    """
def track_base(robot: Robot, trajectory: JointTrajectory, *, kp: float = 2.0, ki: float = 0.1, kd: float = 0.3, offset: float = 0.2, period: float = 0.02, feed_forward: bool = True, feedback: bool = True, settle: float = 0.0, slip_left: float = 0.0, slip_right: float = 0.0, drift: numpy.typing.ArrayLike = (0.0, 0.0, 0.0), travel_noise: float = 0.0, position_noise: float = 0.0, heading_noise: float = 0.0, start_error: numpy.typing.ArrayLike = (0.0, 0.0, 0.0), seed: int = 1) -> BaseTrackingResult:
    """
    Drives the robot's base along the columns x, y, theta of a trajectory, with slip and noise (P1 4.4.2, figure 4.9).
    
    Keyword options:
        kp: float = 2.0  # proportional gain [1/s]
        ki: float = 0.1  # integral gain [1/s^2]
        kd: float = 0.3  # derivative gain
        offset: float = 0.2  # distance of the tracked point from the wheel axis [m]
        period: float = 0.02  # a command is held this long [s]
        feed_forward: bool = True  # adds the planned velocity
        feedback: bool = True  # False: open loop, the planned velocities only
        settle: float = 0.0  # goes on this long after the plan's end [s]
        slip_left: float = 0.0  # share of the left wheel's travel lost
        slip_right: float = 0.0  # the same of the right wheel
        drift: numpy.typing.ArrayLike = (0.0, 0.0, 0.0)  # platform velocity added [m/s, m/s, rad/s]
        travel_noise: float = 0.0  # deviation of a wheel's travel after 1 m [m], growing with the root of the travel
        position_noise: float = 0.0  # deviation of a measured x or y [m]
        heading_noise: float = 0.0  # deviation of a measured heading [rad]
        start_error: numpy.typing.ArrayLike = (0.0, 0.0, 0.0)  # where the base stands at first, less the plan
        seed: int = 1  # same seed, same run
    """
def tray_shapes(size: numpy.typing.ArrayLike, wall: float = 0.005) -> list[LinkShape]:
    """
    Floor and four walls of a tray (outer lengths) in its frame.
    """
def wheel_speeds(v: float, omega: float, wheel_separation: float) -> tuple[float, float]:
    """
    Rim speeds (left, right) of a diff-drive's wheels [m/s].
    """
def with_sampled_pairs(robot: Robot, *, progress: collections.abc.Callable[[str, float], typing.Any] | None = None) -> Robot:
    """
    compute_disabled_pairs with default options, its result cached on disk under the robot's hash.
    """
def write_plan(problem: PartSupplyProblem, database: ReachDatabase, plan: PartSupplyPlan, path: str | os.PathLike[str], *, name: str = 'round', source: str = 'a program', closing_speed: float = 0.1) -> None:
    """
    Writes plan.json for a problem given as objects and the plan made with this database, so that `mmgrasp verify` and
    `mmgrasp view` take it; `closing_speed` of the gripper [m/s]. InvalidInput for shapes that a plan cannot hold
    (planes but for the floor, voxels, meshes without a file) and a plan of another problem.
    """
__version__: str = '0.1.0'
