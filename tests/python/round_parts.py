"""Rods, bolts, balls and tilted boxes, as meshes, that lie in a low tray of the shipped storeroom."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any

from flat_parts import box, prism

Point = tuple[float, float, float]


def turned(outline: list[tuple[float, float]], sides: int) -> str:
    """ASCII STL of the solid that an outline of (x, radius) makes about the x axis; it begins and ends on the axis [m]."""

    def ring(x: float, radius: float) -> list[Point]:
        angles = [math.tau * i / sides for i in range(sides)]
        return [(x, radius * math.cos(a), radius * math.sin(a)) for a in angles]

    facets: list[tuple[Point, Point, Point]] = []
    for (x0, r0), (x1, r1) in pairwise(outline):
        low, high = ring(x0, r0), ring(x1, r1)
        for i in range(sides):
            j = (i + 1) % sides
            if r0 > 0:
                facets.append((low[i], low[j], high[j] if r1 > 0 else high[i]))
            if r1 > 0:
                facets.append((low[i], high[j], high[i]))
    lines = ["solid turned"]
    for corners in facets:
        points = "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in corners)
        lines.append(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet")
    return "\n".join([*lines, "endsolid turned", ""])


def rod(radius: float, length: float, sides: int) -> str:
    """A rod along x."""
    return turned([(-length / 2, 0), (-length / 2, radius), (length / 2, radius), (length / 2, 0)], sides)


def bolt(radius: float, length: float, head: float, sides: int) -> str:
    """A shaft along x, with a head as thick as the shaft's radius at its lower end (least x)."""
    x = [-length / 2, -length / 2 + radius, length / 2]
    return turned([(x[0], 0), (x[0], head), (x[1], head), (x[1], radius), (x[2], radius), (x[2], 0)], sides)


def bolt_pitch(radius: float, length: float, head: float) -> float:
    """How a bolt lies, on the rim of its head and on the end of its shaft [rad]."""
    return math.atan((head - radius) / (length - radius))


def ball(radius: float, sides: int) -> str:
    """A ball of rings about x."""
    angles = [math.pi * i / (sides // 2) for i in range(1, sides // 2)]
    rings = [(-radius * math.cos(a), radius * math.sin(a)) for a in angles]
    return turned([(-radius, 0), *rings, (radius, 0)], sides)


def _drawn_rod(draw: Random) -> tuple[str, list[float]]:
    mesh = rod(draw.uniform(0.004, 0.015), draw.uniform(0.05, 0.14), draw.randint(16, 64))
    return mesh, [draw.uniform(-math.pi, math.pi), 0.0]


def _drawn_bolt(draw: Random) -> tuple[str, list[float]]:
    radius, length = draw.uniform(0.003, 0.008), draw.uniform(0.04, 0.10)
    head = radius * draw.uniform(1.5, 2.0)
    mesh = bolt(radius, length, head, draw.randint(16, 64))
    return mesh, [draw.uniform(-math.pi, math.pi), bolt_pitch(radius, length, head)]


def _drawn_ball(draw: Random) -> tuple[str, list[float]]:
    mesh = ball(draw.uniform(0.008, 0.025), 2 * draw.randint(8, 20))
    return mesh, [draw.uniform(-math.pi, math.pi), draw.uniform(-math.pi / 2, math.pi / 2)]


def _drawn_box(draw: Random) -> tuple[str, list[float]]:
    size = [draw.uniform(0.03, 0.07), draw.uniform(0.02, 0.06), draw.uniform(0.01, 0.03)]
    tilt = math.copysign(math.radians(draw.uniform(5, 25)), draw.random() - 0.5)
    return prism(box(size), size[2]), [tilt, 0.0] if draw.random() < 0.5 else [0.0, tilt]


KINDS: dict[str, Callable[[Random], tuple[str, list[float]]]] = {
    "rod": _drawn_rod,
    "bolt": _drawn_bolt,
    "ball": _drawn_ball,
    "tilted box": _drawn_box,
}


def drawn_round_part(seed: int, folder: Path) -> tuple[str, dict[str, Any], dict[str, Any]]:
    """The kind of a part, its type, a mesh that is written into `folder`, and its place in the tray.

    Rods of 4 to 15 mm radius and 5 to 14 cm, bolts of 3 to 8 mm and 4 to 10 cm that lie on their heads' rims, balls of
    8 to 25 mm, and boxes of 30 to 70 by 20 to 60 by 10 to 30 mm that lean on something by 5 to 25 degrees about one of
    their sides; turned and shifted at random.
    """
    draw = Random(1000 + seed)
    kind = list(KINDS)[seed % len(KINDS)]
    mesh, roll_and_pitch = KINDS[kind](draw)
    (folder / f"round_{seed}.stl").write_text(mesh)
    where = {
        "xyz": [draw.uniform(-0.06, 0.06), draw.uniform(-0.10, 0.10)],
        "rpy": [*roll_and_pitch, draw.uniform(-math.pi, math.pi)],
    }
    return kind, {"mesh": f"round_{seed}.stl"}, where
