"""The thirteen parts put together: where each one goes, and from above onto what.

P1 prints the finger lengths that parts 5, 8, 9, 10 and 13 ask for (figure 5.13), and why (5.3.3): part 5 by its own first segment and part 4, part 9 by its first
segment, part 10 by its teeth, parts 8 and 13 by the shaft, part 6. The heights made here give these lengths when pads overlap what they hold by `CONTACT`.
As in figure 5.16 parts 9 to 12 are put together on a support of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import GripperActuator
from .assembly_file import Assembly, AssemblyPart, AssemblyStep, FingerChoice
from .motor import PARTS
from .turned_parts import block

CONTACT = 3.0  # along the approach, at full size [mm]
TRAVEL = 180.0  # from above, at full size [mm]
SUPPORT = (-400.0, 0.0)  # where the second subassembly is put together [mm]


@dataclass(frozen=True)
class Place:
    """Where a part stands at full size [mm]."""

    z: float
    """Height of its lower end."""
    x: float = 0.0
    y: float = 0.0
    upside_down: bool = False
    on_support: bool = False


PLACES = {
    "1": Place(0),
    "2": Place(20),
    "3": Place(20),
    "4": Place(20),
    "5": Place(42, upside_down=True),
    "6": Place(65),
    "7": Place(0, x=150, on_support=True),
    "8": Place(94),
    "9": Place(0, upside_down=True, on_support=True),
    "10": Place(116, on_support=True),
    "11": Place(0, on_support=True),
    "12": Place(72, on_support=True),
    "13": Place(158),
}
ORDER = ("1", "2", "3", "4", "5", "6", "7", "8", "9", "11", "12", "10", "13")
"""P1's numbers in turn, but for part 10, which stands on 12."""


def pose_of(name: str, scale: float) -> NDArray[np.float64]:
    """T_assembly_mesh of a part [m]."""
    place, part = PLACES[name], PARTS[name]
    origin = np.array([place.x, place.y, place.z + (part.heights()[-1] if place.upside_down else 0.0)])
    if place.on_support:
        origin[:2] += SUPPORT
    return _core.pose(1e-3 * scale * origin, rpy=[np.pi if place.upside_down else 0.0, 0, 0])


def motor_product(scale: float, actuators: list[GripperActuator], fingers: FingerChoice) -> Assembly:
    """The product at a scale (1: full size), to be assembled from above; drives and fingers are real ones, not scaled."""
    parts = {name: AssemblyPart(name, PARTS[name].mesh(scale), pose_of(name, scale)) for name in ORDER}
    steps = []
    for i, name in enumerate(ORDER):
        base = "support" if PLACES[name].on_support else "table"
        stays = [other for other in ORDER[:i] if PLACES[other].on_support == PLACES[name].on_support]
        above = _core.pose([0, 0, 1e-3 * scale * TRAVEL])
        steps.append(AssemblyStep(name, [name], [base, *stays], [above, np.eye(4)]))
    for name, (x, y) in (("table", (0.0, 0.0)), ("support", SUPPORT)):
        size = 1e-3 * scale * np.array([400.0 if name == "support" else 300.0, 300.0, 10.0])
        middle = 1e-3 * scale * np.array([x, y, -5.0])
        parts[name] = AssemblyPart(name, block(size), _core.pose(middle))
    return Assembly("motor-like product", "", parts, steps, actuators, fingers, unit="mm")
