"""Meshes of parts that need no file: turned from a profile, or a box."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from .._core import Mesh

SIDES = 64


def turned(profile: ArrayLike, sides: int = SIDES) -> Mesh:
    """The solid that a closed profile of (radius, z) rows [m] sweeps about z; radii of 0 lie on the axis."""
    rows = np.asarray(profile, dtype=float)
    angles = 2 * np.pi * np.arange(sides) / sides
    vertices: list[Sequence[float]] = []
    rings: list[list[int]] = []
    for r, z in rows:
        if r <= 0:
            rings.append([len(vertices)] * sides)
            vertices.append((0.0, 0.0, z))
        else:
            rings.append(list(range(len(vertices), len(vertices) + sides)))
            vertices.extend((r * np.cos(a), r * np.sin(a), z) for a in angles)
    faces = []
    for lower, upper in zip(rings, [*rings[1:], rings[0]], strict=True):
        for i in range(sides):
            k = (i + 1) % sides
            faces += [(lower[i], lower[k], upper[k]), (lower[i], upper[k], upper[i])]
    kept = [f for f in faces if len(set(f)) == 3]
    return Mesh(np.array(vertices), np.array(kept))


def block(size: ArrayLike) -> Mesh:
    """A box about the origin."""
    x, y, z = np.asarray(size, dtype=float) / 2
    corners = np.array([(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Mesh(corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))
