"""Motions: joint paths, Cartesian paths, manipulation with many grasps, timing, and base and arm in one motion.

Every result has an `outcome`; rejected candidates are counted by cause (`Rejections`).
"""

# How a query ended
from ._core import (
    Outcome as Outcome,
    Rejection as Rejection,
    Rejections as Rejections,
)

# Joint paths
from ._core import (
    plan_motion as plan_motion,
    planner_names as planner_names,
    MotionResult as MotionResult,
    MotionStats as MotionStats,
    Roadmap as Roadmap,
    ToolRegion as ToolRegion,
    OrientationConstraint as OrientationConstraint,
)

# Cartesian paths
from ._core import (
    plan_cartesian as plan_cartesian,
    plan_straight_line as plan_straight_line,
    CartesianResult as CartesianResult,
    StraightLineResult as StraightLineResult,
)

# Timing
from ._core import (
    time_parameterize as time_parameterize,
    time_parameterize_free as time_parameterize_free,
    JointTrajectory as JointTrajectory,
)

# Manipulation: an object from pose to pose with the best of many grasps (P2)
from ._core import (
    ManipulationProblem as ManipulationProblem,
    plan_manipulation as plan_manipulation,
    manipulation_planner_names as manipulation_planner_names,
    ManipulationResult as ManipulationResult,
    ManipulationStats as ManipulationStats,
    GraspReport as GraspReport,
    Improvement as Improvement,
    SearchTree as SearchTree,
)

# Base and arm on one clock, grasping while driving (P1 chapter 4)
from ._core import (
    DriveByTask as DriveByTask,
    plan_drive_by as plan_drive_by,
    shorten_drive_by as shorten_drive_by,
    nlp_solver_names as nlp_solver_names,
    DriveByResult as DriveByResult,
    WholeBodyProgram as WholeBodyProgram,
    drive_by_program as drive_by_program,
    WholeBodyTrajectory as WholeBodyTrajectory,
)

# What a robot carries out: arm, base and gripper on one clock
from ._core import RobotMotion as RobotMotion
