"""What a scenario's `part_types` come to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._core import Grasp, LinkShape
from .._progress import Progress
from ..documents.reading import Node
from .held_grasps import ClosingHand
from .straight_down import with_grasps_down


@dataclass
class PartType:
    """One of `part_types`: shapes, and its grasps, given or sampled."""

    shapes: list[LinkShape]
    grasps: list[Grasp]
    too_wide: int
    node: Node
    mass: float = 0.0
    """[kg]; 0: not said."""
    why_none: str = ""
    """Why suction cups found no grasp."""
    closing: ClosingHand | None = None
    """Whose pads the grasps were sampled for; None: they are listed, or a hand's of suction cups."""
    not_met: int = 0
    """Sampled grasps that are left out because the fingers do not meet the part."""
    grasp_options: dict[str, Any] = field(default_factory=dict)
    progress: Progress = None
    """Hears that its grasps are sought."""
    _by_direction: dict[tuple[float, ...], list[Grasp]] = field(default_factory=dict)

    @property
    def sampled(self) -> bool:
        """The grasps were drawn, not listed."""
        return "grasps" not in self.node

    def grasps_on(self, T_tray_part: np.ndarray) -> list[Grasp]:
        """The grasps of a part that lies so in its tray (4, 4): the type's, and others straight down where few of these are."""
        if self.closing is None or "approach_direction" in self.grasp_options:
            return self.grasps
        down = np.round(-T_tray_part[2, :3], 9)  # in the part's frame, alike for parts that are turned about it
        known = tuple(down.tolist())
        if known not in self._by_direction:
            down /= np.linalg.norm(down)
            self._by_direction[known] = with_grasps_down(
                self.shapes, self.closing, self.grasps, down, self.grasp_options, self.progress
            )
        return self._by_direction[known]


def read_grasp_options(entry: Node, known: dict[str, tuple[Any, str]]) -> dict[str, Any]:
    """The key `grasp_options`; numbers out of range are left to the sampler."""
    options: dict[str, Any] = {}
    if "grasp_options" in entry and "grasps" in entry:
        entry["grasp_options"].fail("must be left out where grasps are listed: none are sampled")
    for key, value in entry["grasp_options"].items() if "grasp_options" in entry else []:
        if key not in known:
            value.refuse_key(list(known))
        if key == "approach_direction":
            options[key] = value.numbers(3)
        else:
            options[key] = value.integer() if isinstance(known[key][0], int) else value.number()
    return options
