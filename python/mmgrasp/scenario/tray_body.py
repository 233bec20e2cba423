"""What a tray is made of: floor, walls of any height and thickness, a roof, or a body of its own; containers by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._core import Box, LinkShape
from ..documents.reading import Node, near_miss
from .shapes import read_shapes

WALL = 0.005  # thickness of a tray's floor and walls unless stated [m]
SIDES = ("front", "back", "left", "right")  # as seen by a robot that looks along the tray's +x
BODY_KEYS = "wall walls roof body"
STEEPEST = 45.0  # degrees by which a tray may be tilted

# Outer sizes of VDA 4500's R-KLT [m], length x width x height.
_KLT_OUTER = {
    "R-KLT 4315": (0.396, 0.297, 0.147),
    "R-KLT 4322": (0.396, 0.297, 0.213),
    "R-KLT 4329": (0.396, 0.297, 0.280),
    "R-KLT 6415": (0.594, 0.396, 0.147),
    "R-KLT 6422": (0.594, 0.396, 0.213),
    "R-KLT 6429": (0.594, 0.396, 0.280),
}
# Thickness at the short sides, at the long ones, of the floor: a maker's R-KLT 4322 is 346 x 265 x 175 mm inside.
_KLT_WALL = (0.025, 0.016, 0.038)
_LENGTHWISE = " lengthwise"


@dataclass(frozen=True)
class TrayBody:
    """A tray's measures. Its frame is the middle of the upper face of its floor."""

    size: tuple[float, float, float]  # depth (x), width (y), height (z) from outside [m]
    wall: tuple[float, float, float] = (WALL, WALL, WALL)  # thickness of front and back, of the sides, of the floor
    heights: tuple[float, ...] | None = (
        None  # of the walls above the floor, in the order of SIDES; None: as high as the tray
    )
    roof: float | None = None  # clear height under a roof as thick as the floor; None: open

    @property
    def inner(self) -> np.ndarray:
        """Depth and width between the walls [m]."""
        return np.asarray(np.array(self.size[:2]) - 2 * np.array(self.wall[:2]))

    def shapes(self) -> list[LinkShape]:
        """Boxes in the tray's frame: those of base.tray_shapes, where nothing else is said."""
        if self == TrayBody(self.size):
            return _core.tray_shapes(self.size, WALL)
        (x, y, z), (tx, ty, floor) = self.size, self.wall
        front, back, left, right = self.heights or [z - floor] * 4
        made = [_box([x, y, floor], [0, 0, -floor / 2])]
        for sign, height in ((1, back), (-1, front)):
            if height > 0:
                made.append(_box([tx, y, height + floor], [sign * (x - tx) / 2, 0, (height - floor) / 2]))
        for sign, height in ((1, left), (-1, right)):
            if height > 0:
                made.append(_box([x - 2 * tx, ty, height + floor], [0, sign * (y - ty) / 2, (height - floor) / 2]))
        if self.roof is not None:
            made.append(_box([x, y, floor], [0, 0, self.roof + floor / 2]))
        return made

    def to_dict(self) -> dict[str, Any]:
        """The rows of a plan's tray beside name and pose; what is as usual is left out."""
        rows: dict[str, Any] = {"size": list(self.size)}
        if self.wall != (WALL, WALL, WALL):
            rows["wall"] = list(self.wall)
        if self.heights is not None:
            rows["walls"] = dict(zip(SIDES, self.heights, strict=True))
        if self.roof is not None:
            rows["roof"] = self.roof
        return rows

    @staticmethod
    def from_dict(rows: dict[str, Any]) -> TrayBody:
        """What to_dict wrote."""
        x, y, z = rows["size"]
        tx, ty, floor = rows.get("wall", (WALL, WALL, WALL))
        heights = tuple(rows["walls"][side] for side in SIDES) if "walls" in rows else None
        return TrayBody((x, y, z), (tx, ty, floor), heights, rows.get("roof"))

    def fault(self) -> str:
        """The rule that the measures break; empty: none."""
        if min(self.inner) <= 0:
            return f"must leave room between walls of {self.wall[0]:g} and {self.wall[1]:g} m"
        if self.size[2] <= self.wall[2]:
            return f"must be higher than the floor is thick, {self.wall[2]:g} m"
        return ""


def _box(size: list[float], at: list[float]) -> LinkShape:
    return LinkShape(Box(size), _core.pose(at))


def read_tray_body(node: Node, find_file: Callable[[Node], Any]) -> tuple[TrayBody, list[LinkShape], bool]:
    """Measures and shapes of one of `trays`, and whether the shapes are its own (the key `body`)."""
    size, wall = _size(node["size"])
    if "wall" in node:
        wall = _wall(node["wall"])
    own = "body" in node
    if own:
        for key in ("wall", "walls", "roof"):
            if key in node:
                node[key].fail("a tray with a body of its own has neither walls nor a roof")
        body = TrayBody(size)
        node["body"].mapping("", "box cylinder sphere mesh shapes scale")
        return body, read_shapes(node["body"], find_file), True
    heights = _heights(node["walls"], size[2] - wall[2]) if "walls" in node else None
    roof = node["roof"].number(above=0) if "roof" in node else None
    body = TrayBody(size, wall, heights, roof)
    if rule := body.fault():
        node["size"].fail(rule)
    if roof is not None and roof < max(heights or [size[2] - wall[2]]) - 1e-9:
        node["roof"].fail("must not be lower than the highest wall")
    return body, body.shapes(), False


def _size(node: Node) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Outer size and thickness of walls and floor: numbers, or a container's name, its long side across unless `lengthwise`."""
    if not isinstance(node.raw, str):
        x, y, z = node.numbers(3, above=0)
        return (x, y, z), (WALL, WALL, WALL)
    name = node.string()
    outer = _KLT_OUTER.get(name.removesuffix(_LENGTHWISE))
    if outer is None:
        node.fail(f"must be three lengths or the name of a container{near_miss(name, list(_KLT_OUTER))}")
    (length, width, height), (ends, sides, floor) = outer, _KLT_WALL
    if name.endswith(_LENGTHWISE):
        return (length, width, height), (ends, sides, floor)
    return (width, length, height), (sides, ends, floor)


def _wall(node: Node) -> tuple[float, float, float]:
    if isinstance(node.raw, list):
        x, y, floor = node.numbers(3, above=0)
        return x, y, floor
    thickness = node.number(above=0)
    return thickness, thickness, thickness


def _heights(node: Node, full: float) -> tuple[float, ...]:
    """Heights of the four walls; one that is not named is as high as the tray."""
    node.mapping("", " ".join(SIDES))
    heights = []
    for side in SIDES:
        height = node[side].number(least=0) if side in node else full
        if height > full + 1e-9:
            node[side].fail(f"must not be higher than the tray is above its floor, {full:g} m")
        heights.append(height)
    return tuple(heights)


def tilt(T_world_tray: np.ndarray) -> float:
    """The angle between a tray's floor and the ground [degrees]."""
    return float(np.degrees(np.arccos(np.clip(T_world_tray[2, 2], -1.0, 1.0))))
