"""From an assembly's files to the grippers it needs: reading, grasps under assembly constraints, the least set, files."""

from .assembly_file import Assembly, AssemblyPart, AssemblyStep, FingerChoice, HoldingChoice, load_assembly
from .planning import GripperPlan, plan_grippers

__all__ = [
    "Assembly",
    "AssemblyPart",
    "AssemblyStep",
    "FingerChoice",
    "GripperPlan",
    "HoldingChoice",
    "load_assembly",
    "plan_grippers",
]
