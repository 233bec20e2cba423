"""Where trays stand in a storeroom, regularly or at random by seed, and where parts lie regularly in a tray.

Poses are rows (x, y, yaw) in metres and radians. A tray's yaw is the direction in which a robot in front of it looks
(the tray's +x); parts are given in the tray's frame, whose origin is the middle of its floor.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .._core import Error, InvalidInput

Poses = NDArray[np.float64]


def _require(ok: bool, field: str, value: object, rule: str) -> None:
    if not ok:
        raise InvalidInput(f"{field} = {value}: {rule}")


def _check(count: int, **lengths: float) -> None:
    _require(count >= 0, "count", count, "must be 0 or more")
    for name, value in lengths.items():
        _require(math.isfinite(value) and value > 0, name, value, "must be finite and > 0")


def row(count: int, spacing: float) -> Poses:
    """Trays along x, robots in front of them look along +y (P1 figure 3.12)."""
    _check(count, spacing=spacing)
    return np.array([[spacing * i, 0.0, math.pi / 2] for i in range(count)]).reshape(-1, 3)


def aisle(count: int, spacing: float, width: float) -> Poses:
    """Two rows that face each other across an aisle, trays alternately left and right."""
    _check(count, spacing=spacing, width=width)
    sides = [(0.5 * width, math.pi / 2), (-0.5 * width, -math.pi / 2)]
    return np.array([[spacing * (i // 2), *sides[i % 2]] for i in range(count)]).reshape(-1, 3)


def block(count: int, spacing: float, width: float, depth: float = 0.4, per_row: int | None = None) -> Poses:
    """Shelves back to back, `depth` apart, with aisles of `width` between them."""
    _check(count, spacing=spacing, width=width, depth=depth)
    columns = per_row if per_row is not None else max(1, round(math.sqrt(2 * count)))
    _require(columns > 0, "per_row", columns, "must be > 0")
    poses = []
    for i in range(count):
        line, column = divmod(i, columns)
        shelf, back = divmod(line, 2)
        poses.append([spacing * column, shelf * (width + depth) + back * depth, -math.pi / 2 if back else math.pi / 2])
    return np.array(poses).reshape(-1, 3)


def scattered(
    count: int, seed: int, *, area: float = 1.2, apart: float = 0.45, stand: float = 0.68, room: float = 0.58
) -> Poses:
    """Trays anywhere in a square of `area` a tray [m^2], facing anywhere: middles at least `apart`, and no tray within
    `room` of the place `stand` in front of another one, so that a robot can get to each."""
    _check(count, area=area, apart=apart, stand=stand, room=room)
    rng = np.random.default_rng(seed)
    side = math.sqrt(area * max(count, 1))
    laid: list[tuple[Poses, Poses, float]] = []
    for _ in range(2000 * max(count, 1)):
        if len(laid) == count:
            break
        at = rng.uniform(0, side, 2)
        yaw = rng.uniform(-math.pi, math.pi)
        front = at - stand * np.array([math.cos(yaw), math.sin(yaw)])
        if all(
            np.linalg.norm(at - other) >= apart
            and np.linalg.norm(at - place) >= room
            and np.linalg.norm(other - front) >= room
            for other, place, _ in laid
        ):
            laid.append((at, front, yaw))
    if len(laid) < count:
        raise Error(f"count = {count}: only {len(laid)} trays found room; give them more area")
    return np.array([[*at, yaw] for at, _, yaw in laid]).reshape(-1, 3)


def regular_parts(rows: int, columns: int, size: tuple[float, float]) -> Poses:
    """Parts in the middles of equal rectangles: `columns` along the tray's width (y), `rows` along its depth (x)."""
    _require(rows > 0, "rows", rows, "must be > 0")
    _require(columns > 0, "columns", columns, "must be > 0")
    _check(rows * columns, depth=size[0], width=size[1])
    depth, width = size
    x = depth * ((np.arange(rows) + 0.5) / rows - 0.5)
    y = width * ((np.arange(columns) + 0.5) / columns - 0.5)
    return np.array([[a, b, 0.0] for a in x for b in y])
