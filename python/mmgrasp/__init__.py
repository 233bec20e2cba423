"""Planning for mobile manipulators: where the base stops, what the gripper takes, how base and arm move.

Units are SI and radians; poses are float64 (4, 4) arrays named T_parent_child. Misuse raises Error (InvalidInput, also a
ValueError; IoError, also an OSError); "no solution" is a value: look at a result's `outcome`.

P1, P2 and P3 in docstrings are the theses that docs/bibliography.md names, with the source of every method.

Here are the names that nearly every program needs. Everything else is in a submodule: `mmgrasp.robot`, `.collision`,
`.planning`, `.grasping`, `.base`, `.mapping`, `.optim`, `.gripper_design`, `.verify`; `.part_supply` and `.scenario` for the main job. Types of the dicts in
results are in `mmgrasp.records`. Extras are imported by name: `mmgrasp.frames` (folders of depth images), `.scan` (maps made of them), `.sim` (physics), `.viz` (pictures), `.cluster` (many
processes), `.problems` (benchmarks' problems), `.reproduce`.
"""

import sys as _sys
import typing as _typing

from . import _interpreter as _interpreter  # first: refuses where the module would hang
from . import _core as _core
from . import base as base
from . import collision as collision
from . import grasping as grasping
from . import gripper_design as gripper_design
from . import mapping as mapping
from . import optim as optim
from . import part_supply as part_supply
from . import planning as planning
from . import robot as robot
from . import scenario as scenario
from . import verify as verify

# Conventions
from ._core import (
    Error as Error,
    InvalidInput as InvalidInput,
    IoError as IoError,
    Outcome as Outcome,
    __version__ as __version__,
    pose as pose,
)

# The robot and the world around it
from ._core import (
    Robot as Robot,
    World as World,
    CollisionChecker as CollisionChecker,
    Box as Box,
    Cylinder as Cylinder,
    Sphere as Sphere,
    Mesh as Mesh,
    LinkShape as LinkShape,
)

# Motions of an arm
from ._core import (
    plan_motion as plan_motion,
    plan_cartesian as plan_cartesian,
    time_parameterize as time_parameterize,
)

# What depth cameras saw
from ._core import ProbabilisticSdf as ProbabilisticSdf

# Grasps: an object carried, or taken while the base drives
from ._core import (
    Grasp as Grasp,
    Hand as Hand,
    synthesize_grasps as synthesize_grasps,
    ManipulationProblem as ManipulationProblem,
    plan_manipulation as plan_manipulation,
    DriveByTask as DriveByTask,
    plan_drive_by as plan_drive_by,
)

# Where the base stops: a whole storeroom, planned and checked
from ._core import ReachDatabase as ReachDatabase
from .part_supply import plan_part_supply as plan_part_supply, verify_plan as verify_plan
from .scenario import load_scenario as load_scenario

if not _typing.TYPE_CHECKING:  # type checkers know what is there; this is for what is not

    def __getattr__(name: str) -> _typing.NoReturn:
        from ._moved import is_import, place_of

        place = place_of(name)
        if place and is_import():  # the import statement would say only that there is no such name
            raise ImportError(f"mmgrasp.{name} moved: {place}", name="mmgrasp")
        message = f"mmgrasp.{name} moved: {place}" if place else f"module 'mmgrasp' has no attribute '{name}'"
        raise AttributeError(message, name=name, obj=_sys.modules[__name__])  # Python adds the nearest name
