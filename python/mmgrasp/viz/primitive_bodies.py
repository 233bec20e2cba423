"""Bodies to draw for the primitives that stand for a part's segments."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import ArrayLike

from .two_sides import Body

_SIDES = 48
_RINGS = 24


def primitive_body(kind: str, size: ArrayLike, T_mesh_primitive: ArrayLike, colour: str) -> Body:
    """Surface of a box, cylinder, cone or sphere, with kind, size [m] and pose as FittedPrimitive has them."""
    size = np.asarray(size, float)
    vertices, triangles = _box(size) if kind == "box" else _revolved(_profile(kind, size))
    T = np.asarray(T_mesh_primitive, float)
    return vertices @ T[:3, :3].T + T[:3, 3], triangles, colour


def _box(size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _profile(kind: str, size: np.ndarray) -> np.ndarray:
    """Radius and height [m] from foot to top, both ends on the axis."""
    if kind == "sphere":
        turn = np.linspace(-np.pi / 2, np.pi / 2, _RINGS)
        arc: np.ndarray = size[0] / 2 * np.column_stack([np.cos(turn), np.sin(turn)])
        return arc
    foot, top, half = size[0] / 2, size[1] / 2, size[2] / 2
    return np.array([[0, -half], [foot, -half], [top, half], [0, half]])


def _revolved(profile: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    turn = 2 * np.pi * np.arange(_SIDES) / _SIDES
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(_SIDES, z)]) for r, z in profile]
    here, following = np.arange(_SIDES), (np.arange(_SIDES) + 1) % _SIDES
    triangles = []
    for low in range(0, _SIDES * (len(profile) - 1), _SIDES):
        a, b, c, d = low + here, low + following, low + _SIDES + following, low + _SIDES + here
        triangles += [np.column_stack([a, b, c]), np.column_stack([a, c, d])]
    return np.concatenate(rings), np.concatenate(triangles)
