"""Parts that lie flat in a low tray of the shipped storeroom: thinner than the pads of its gripper are long."""

from __future__ import annotations

import copy
import math
from itertools import pairwise
from pathlib import Path
from random import Random
from typing import Any

PAD = 0.04  # length of the storeroom's pads along the approach [m]
PLACE = {"name": "low", "pose": {"xyz": [2.78, -1.30, 0.706]}, "size": [0.30, 0.40, 0.04]}


def prism(outline: list[tuple[float, float]], height: float) -> str:
    """ASCII STL of an upright prism about z = 0 over a convex outline, counter-clockwise [m]."""
    low, high = -height / 2, height / 2
    facets = []
    for (ax, ay), (bx, by) in zip(outline, [*outline[1:], outline[0]], strict=True):
        facets += [((ax, ay, low), (bx, by, low), (bx, by, high)), ((ax, ay, low), (bx, by, high), (ax, ay, high))]
    first = outline[0]
    for b, c in pairwise(outline[1:]):
        facets += [((*first, high), (*b, high), (*c, high)), ((*first, low), (*c, low), (*b, low))]
    lines = ["solid prism"]
    for corners in facets:
        points = "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in corners)
        lines.append(f"facet normal 0 0 0\nouter loop\n{points}endloop\nendfacet")
    return "\n".join([*lines, "endsolid prism", ""])


def box(size: list[float]) -> list[tuple[float, float]]:
    """Outline of a box [m]."""
    x, y = size[0] / 2, size[1] / 2
    return [(-x, -y), (x, -y), (x, y), (-x, y)]


def disc(radius: float, sides: int = 48) -> list[tuple[float, float]]:
    """Outline of a disc [m]."""
    return [(radius * math.cos(math.tau * i / sides), radius * math.sin(math.tau * i / sides)) for i in range(sides)]


def low_tray(storeroom: dict[str, Any], part_type: dict[str, Any], where: dict[str, Any]) -> dict[str, Any]:
    """The storeroom with one low tray and one part that rests on its floor at `where`."""
    scenario = copy.deepcopy(storeroom)
    scenario.update(name="flat", part_types={"flat": part_type}, reach={"samples": 500_000})
    scenario["trays"] = [{**PLACE, "parts": [{"type": "flat", **where}]}]
    return scenario


def drawn_part(seed: int, folder: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """A part type and its place in the tray; every second one is a mesh, written into `folder`.

    Boxes of 30 to 90 mm by 20 to 80 mm and discs of 12 to 40 mm radius, 4 to 20 mm thick, turned and shifted at random.
    """
    draw = Random(seed)
    thickness = draw.uniform(0.004, 0.020)
    where = {
        "xyz": [draw.uniform(-0.06, 0.06), draw.uniform(-0.10, 0.10)],
        "rpy": [0.0, 0.0, draw.uniform(-math.pi, math.pi)],
    }
    part: dict[str, Any]
    if draw.random() < 0.5:
        size = [draw.uniform(0.03, 0.09), draw.uniform(0.02, 0.08), thickness]
        part, outline = {"box": size}, box(size)
    else:
        radius = draw.uniform(0.012, 0.040)
        part, outline = {"cylinder": {"radius": radius, "length": thickness}}, disc(radius)
    if seed % 2:
        (folder / f"flat_{seed}.stl").write_text(prism(outline, thickness))
        part = {"mesh": f"flat_{seed}.stl"}
    return part, where
