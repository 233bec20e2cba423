"""Robots: the model, groups of joints, forward and inverse kinematics, and poses.

`Robot.load` reads URDF and SRDF; `robot.group(...)` is a `JointGroup`, which knows kinematics and inverse kinematics. Objectives
lower a cost with the freedom that a pose leaves. `compute_disabled_pairs` finds the pairs of links that never touch.
"""

# The model
from ._core import (
    Robot as Robot,
    RobotSource as RobotSource,
    JointGroup as JointGroup,
    find_package as find_package,
    compute_disabled_pairs as compute_disabled_pairs,
    with_sampled_pairs as with_sampled_pairs,
)

# Inverse kinematics: answers and objectives
from ._core import (
    IkResult as IkResult,
    IkBranches as IkBranches,
    IkObjective as IkObjective,
    camera_view_objective as camera_view_objective,
    joint_limit_objective as joint_limit_objective,
    self_distance_objective as self_distance_objective,
    singularity_objective as singularity_objective,
)

# Poses, (4, 4) arrays named T_parent_child
from ._core import (
    pose as pose,
    pose_to_xyz_quat as pose_to_xyz_quat,
    pose_to_xyz_rpy as pose_to_xyz_rpy,
    quat_xyzw_from_rotation as quat_xyzw_from_rotation,
)
