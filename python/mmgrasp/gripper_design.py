"""Grippers for an assembly: finger lengths that an operation allows, the least set that takes every part, and each gripper as URDF, SRDF and printable fingers."""

from ._core import (
    PlacedMesh as PlacedMesh,
    AssemblyOperation as AssemblyOperation,
    AssemblyGrasp as AssemblyGrasp,
    planar_facets as planar_facets,
    Facet as Facet,
    jaw_grasps as jaw_grasps,
    centric_grasps as centric_grasps,
    finger_length_range as finger_length_range,
    FingerLengthRange as FingerLengthRange,
    SegmentRequirement as SegmentRequirement,
    GripperActuator as GripperActuator,
    Gripper as Gripper,
    minimal_grippers as minimal_grippers,
    MinimalGrippersResult as MinimalGrippersResult,
)
