"""What a scenario's `part_types` come to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .._core import Grasp, LinkShape
from ..documents.reading import Node


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

    @property
    def sampled(self) -> bool:
        """The grasps were drawn, not listed."""
        return "grasps" not in self.node


def read_grasp_options(entry: Node, known: dict[str, tuple[Any, str]]) -> dict[str, Any]:
    """The key `grasp_options`; numbers out of range are left to the sampler."""
    options: dict[str, Any] = {}
    for key, value in entry["grasp_options"].items() if "grasp_options" in entry else []:
        if key not in known:
            value.refuse_key(list(known))
        options[key] = value.integer() if isinstance(known[key][0], int) else value.number()
    return options
