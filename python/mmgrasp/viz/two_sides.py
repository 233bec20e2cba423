"""A few bodies seen from two sides, for pictures of parts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from .raster import Camera, Scene, render

Points = NDArray[np.float64]
Body = tuple[Points, NDArray[np.integer], str]
"""Vertices (n, 3), triangles (m, 3), colour."""

FROM_ABOVE_AND_BELOW = ([1.0, -1.2, 0.8], [-1.0, 1.2, -0.8])
FROM_ABOVE_AND_ASIDE = ([1.0, -1.2, 0.7], [-1.2, -1.0, 0.15])


def two_sides(
    bodies: list[Body], directions: Sequence[Sequence[float]] = FROM_ABOVE_AND_BELOW, side: int = 620
) -> NDArray[np.uint8]:
    """The bodies side by side from two directions, as large as fits: (side, 2 side, 3)."""
    every = np.concatenate([vertices for vertices, _, _ in bodies])
    low, high = every.min(axis=0), every.max(axis=0)
    scene = Scene()
    for vertices, triangles, colour in bodies:  # the renderer is made for rooms
        scene.add((vertices - (low + high) / 2) / np.linalg.norm(high - low), triangles, colour)
    views = []
    for direction in directions:
        eye = 1.65 * np.array(direction) / np.linalg.norm(direction)
        views.append(render(scene, Camera(eye, np.zeros(3), side, side)))
    return np.concatenate(views, axis=1)
