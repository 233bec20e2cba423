"""Meshes of parts that need no file: turned from a profile, or a box."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Mesh

SIDES = 64


Section = float | tuple[float, float]
"""A circle by its radius, or a rectangle by its two sides, about the z axis [m]."""


def turned(profile: ArrayLike, sides: int = SIDES) -> Mesh:
    """The solid that a closed profile of (radius, z) rows [m] sweeps about z; radii of 0 lie on the axis."""
    return lofted([(float(r), float(z)) for r, z in np.asarray(profile, dtype=float)], sides)


def meeting_edges(profile: ArrayLike) -> tuple[int, int] | None:
    """The first two edges of a closed profile of (radius, z) rows that meet where they are not joined, by the rows that they begin with; None: it is simple.

    Points on the axis may meet: no surface goes through them.
    """
    rows = np.asarray(profile, dtype=float)
    extent = float(np.ptp(rows, axis=0).max())
    steps = np.abs(np.roll(rows, -1, axis=0) - rows).max(axis=1)
    begin = np.flatnonzero(steps > 1e-12 * extent)  # points nearer than that are one
    a = rows[begin]
    b = np.roll(a, -1, axis=0)
    with_surface = (a[:, 0] > 0) | (b[:, 0] > 0)
    rounding = 1e-12 * extent**2
    for i in np.flatnonzero(with_surface):
        along, later = b[i] - a[i], np.arange(i + 1, len(a))
        # On which side of edge i the ends of the others lie, and the other way round; 0: on its line.
        sides = [np.where(np.abs(s) > rounding, np.sign(s), 0.0) for s in _sides(a[i], b[i], a[later], b[later])]
        meet = (sides[0] * sides[1] <= 0) & (sides[2] * sides[3] <= 0) & with_surface[later]
        for k in later[meet]:
            if _points_in_common(a[i], along, a[k], b[k], rounding, joined=k in (i + 1, (i - 1) % len(a))):
                return begin[i], begin[k]
    return None


def _sides(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64], d: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Twice the signed areas of the triangles (a, b, c), (a, b, d), (c, d, a), (c, d, b); c and d are (n, 2)."""

    def cross(u: NDArray[np.float64], v: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])

    return cross(b - a, c - a), cross(b - a, d - a), cross(d - c, a - c), cross(d - c, b - c)


def _points_in_common(
    a: NDArray[np.float64],
    along: NDArray[np.float64],
    c: NDArray[np.float64],
    d: NDArray[np.float64],
    rounding: float,
    joined: bool,
) -> bool:
    """Whether two edges that reach each other's lines have a point in common off the axis, or off their joint."""
    other = d - c
    cross = along[0] * other[1] - along[1] * other[0]
    if abs(cross) > rounding:
        share = ((c - a)[0] * other[1] - (c - a)[1] * other[0]) / cross
        return not joined and (a + share * along)[0] > 1e-9 * float(np.abs([a, a + along]).max())
    # On one line: edges that are joined and go on from each other have their joint in common, those that go back more.
    places = np.sort(np.array([c - a, d - a]) @ along / (along @ along))
    return bool(min(places[1], 1.0) - max(places[0], 0.0) > (1e-9 if joined else -1e-9))


def lofted(profile: Sequence[tuple[Section, float]], sides: int = SIDES) -> Mesh:
    """As `turned`, but a row of the closed profile may also be a rectangle: rings one after the other, joined by faces.

    Sections at one height must contain one another.
    """
    angles = {2 * np.pi * k / sides for k in range(sides)}
    for section, _ in profile:
        if isinstance(section, tuple):
            corner = float(np.arctan2(section[1], section[0]))
            angles |= {corner, np.pi - corner, np.pi + corner, 2 * np.pi - corner}
    turn = np.array(sorted(angles))
    turn = turn[np.diff(turn, append=turn[0] + 2 * np.pi) > 1e-9]
    count = len(turn)
    vertices: list[Sequence[float]] = []
    rings: list[list[int]] = []
    for section, z in profile:
        if isinstance(section, float) and section <= 0:
            rings.append([len(vertices)] * count)
            vertices.append((0.0, 0.0, z))
        else:
            rings.append(list(range(len(vertices), len(vertices) + count)))
            radii = np.full(count, section) if isinstance(section, float) else _to_edge(section, turn)
            vertices.extend((r * np.cos(a), r * np.sin(a), z) for r, a in zip(radii, turn, strict=True))
    faces = []
    for lower, upper in zip(rings, [*rings[1:], rings[0]], strict=True):
        for i in range(count):
            k = (i + 1) % count
            faces += [(lower[i], lower[k], upper[k]), (lower[i], upper[k], upper[i])]
    kept = [f for f in faces if len(set(f)) == 3]
    return Mesh.from_arrays(np.array(vertices), np.array(kept))


def _to_edge(sides: tuple[float, float], angles: np.ndarray) -> np.ndarray:
    """How far the edge of a rectangle is from its middle, in each direction."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(sides[0] / 2 / np.abs(np.cos(angles)), sides[1] / 2 / np.abs(np.sin(angles))))


def block(size: ArrayLike) -> Mesh:
    """A box about the origin."""
    x, y, z = np.asarray(size, dtype=float) / 2
    corners = np.array([(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return Mesh.from_arrays(corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]))
