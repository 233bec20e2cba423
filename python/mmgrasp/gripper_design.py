"""Grippers for an assembly: the least set that takes every part, and each gripper as URDF, SRDF and printable fingers."""

from ._core import (
    SegmentRequirement as SegmentRequirement,
    GripperActuator as GripperActuator,
    Gripper as Gripper,
    minimal_grippers as minimal_grippers,
    MinimalGrippersResult as MinimalGrippersResult,
)
