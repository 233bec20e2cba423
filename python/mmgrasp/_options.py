"""The options of calls as types, for functions that pass keywords on. Written by `./dev stubs`."""

from collections.abc import Mapping
from typing import TypedDict

from numpy.typing import ArrayLike


class CheckOptions(TypedDict, total=False):
    """Keyword options of verify.check_plan: defaults and meaning are there."""

    joint_step: float
    base_step: float
    position_tolerance: float
    rotation_tolerance: float
    samples: int
    required_rate: float
    region_samples: int
    seed: int
    threads: int


class CheckerOptions(TypedDict, total=False):
    """Keyword options of CollisionChecker: defaults and meaning are there."""

    padding: float
    check_self: bool
    check_scene: bool
    attached_only: bool


class DriveByOptions(TypedDict, total=False):
    """Keyword options of plan_drive_by: defaults and meaning are there."""

    waypoints: int
    seeds: int
    solutions: int
    grasp_assignments: int
    goal_configurations: int
    iterations: int
    time_limit: float
    jerk_time: float
    collisions: bool
    seed: int
    threads: int
    solver: str
    tolerance: float
    max_iterations: int
    solve_time_limit: float
    smoothing: float
    margin: float
    constraint_distance: float
    refinements: int


class GraspabilityOptions(TypedDict, total=False):
    """Keyword options of evaluate_graspability: defaults and meaning are there."""

    margin: float
    orientations: int
    openings: int
    layer_step: float
    lowest: float
    insertion: float
    smoothing: float
    min_contact: float
    min_distance: float
    max_grasps: int
    threads: int


class MotionOptions(TypedDict, total=False):
    """Keyword options of plan_motion: defaults and meaning are there."""

    planner: str
    time_limit: float
    max_iterations: int
    joint_weights: ArrayLike | Mapping[str, float] | None
    range: float
    near_end_probability: float
    base_margin: float
    joint_step: float
    workspace_step: float
    shorten: bool
    shorten_iterations: int
    ik_solutions: int
    region_samples: int


class ReachOptions(TypedDict, total=False):
    """Keyword options of ReachDatabase.build: defaults and meaning are there."""

    samples: int
    position_cell: float
    rotation_cell: float
    max_per_cell: int
    min_manipulability: float
    thinning: float
    seed: int
    threads: int


class TrackingOptions(TypedDict, total=False):
    """Keyword options of BaseTracker: defaults and meaning are there."""

    kp: float
    ki: float
    kd: float
    offset: float
    period: float
    feed_forward: bool
    feedback: bool
    settle: float
