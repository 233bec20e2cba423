"""From an assembly's files to the grippers it needs: reading, grasps under assembly constraints, the least set, files."""

from .assembly_file import Assembly, AssemblyPart, AssemblyStep, FingerChoice, HoldingChoice, load_assembly
from .holding import Held
from .planning import GripperPlan, SegmentFate, plan_grippers

__all__ = [
    "Assembly",
    "AssemblyPart",
    "AssemblyStep",
    "FingerChoice",
    "GripperPlan",
    "Held",
    "HoldingChoice",
    "SegmentFate",
    "load_assembly",
    "plan_grippers",
]
