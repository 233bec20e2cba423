"""The independent checker: a finished plan or path against the scenario, by urdfdom, KDL and FCL called directly, without any planner.

`mmgrasp.verify_plan` reads a plan.json and calls `check_plan`; `check_path` checks a joint path.
"""

from ._core.verify import (
    CheckedBody as CheckedBody,
    CheckedCup as CheckedCup,
    CheckedDriveBy as CheckedDriveBy,
    CheckedFinger as CheckedFinger,
    CheckedGrasp as CheckedGrasp,
    CheckedGrid as CheckedGrid,
    CheckedIntersection as CheckedIntersection,
    CheckedLegValues as CheckedLegValues,
    CheckedMotion as CheckedMotion,
    CheckedPart as CheckedPart,
    CheckedPick as CheckedPick,
    CheckedRegion as CheckedRegion,
    CheckedStop as CheckedStop,
    CheckedSuction as CheckedSuction,
    CheckedTray as CheckedTray,
    CheckedUnloading as CheckedUnloading,
    CheckedUnloadRegion as CheckedUnloadRegion,
    Fault as Fault,
    PathCheckResult as PathCheckResult,
    PlanCheckResult as PlanCheckResult,
    PlanToCheck as PlanToCheck,
    StopRate as StopRate,
    broken_seal as broken_seal,
    check_path as check_path,
    check_plan as check_plan,
    check_schedule as check_schedule,
    overlapping_bodies as overlapping_bodies,
    pads_unlike_grasp as pads_unlike_grasp,
)
