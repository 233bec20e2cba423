"""Bodies of revolution as convex pieces, so that physics has holes: MuJoCo takes a mesh as its convex hull, which closes them.

A part is cut across its axis where its outline bends; each slice is a cylinder or the frustum of a cone, or, with a hole, a ring of wedges. The
wedges' inner faces touch the hole's circle from outside: what fits the hole fits the ring.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import Cylinder, InvalidInput, LinkShape, Mesh, pose

SECTORS = 12
LOOK = 1e-6  # beside a bend the outline is taken so far inside the slice [m]
SAME = 2e-5  # holes that differ by less are one slice [m]
ROUGH = 3e-4  # so does the outside [m]
POLYGON = 1.03  # corners of a hole are at most so much farther from the axis than its sides: fifteen corners or more


@dataclass(frozen=True)
class Slice:
    """A slice of a body of revolution about z, lengths in m; outlines are straight between its ends."""

    low: float
    high: float
    inner: tuple[float, float]
    """Radius of the hole at both ends; 0: none."""
    outer: tuple[float, float]


def revolution_slices(mesh: Mesh, T_axis_mesh: ArrayLike, widen: float = 0.0) -> list[Slice]:
    """Slices of a mesh about the z axis of a frame, from its lower end to its upper one.

    Radii are the least and the largest distance of the cut from the axis: flats and key ways are filled, a 24-sided circle counts as the circle
    of its corners. `widen` is added to the radius of holes [m]. Raises InvalidInput for a mesh that is nowhere about the axis.
    """
    T = np.asarray(T_axis_mesh, float)
    vertices = np.asarray(mesh.vertices) @ T[:3, :3].T + T[:3, 3]
    corners = vertices[np.asarray(mesh.triangles)]
    heights = np.unique(np.round(vertices[:, 2], 6))
    slices: list[Slice] = []
    for low, high in itertools.pairwise(heights):
        if high - low < 4 * LOOK:
            continue
        ends = [_radii(corners, z) for z in (low + LOOK, high - LOOK)]
        if ends[0] is None or ends[1] is None:
            continue
        inner = tuple(r[0] + widen if r[0] > 0 else 0.0 for r in ends if r is not None)
        outer = tuple(r[1] for r in ends if r is not None)
        slices.append(Slice(float(low), float(high), (inner[0], inner[1]), (outer[0], outer[1])))
    if not slices:
        raise InvalidInput("mesh: has no slice about the axis")
    return _joined(slices)


def convex_shapes(slices: list[Slice], sectors: int = SECTORS) -> list[LinkShape]:
    """The slices as convex shapes in the frame of their axis."""
    if sectors < 3:
        raise InvalidInput(f"sectors = {sectors}: must be at least 3")
    shapes: list[LinkShape] = []
    for part in slices:
        if max(part.inner) > 0:
            shapes += [LinkShape(_wedge(part, k, sectors)) for k in range(sectors)]
        elif abs(part.outer[0] - part.outer[1]) < SAME:
            middle = pose([0, 0, (part.low + part.high) / 2])
            shapes.append(LinkShape(Cylinder(max(part.outer), part.high - part.low), middle))
        else:
            shapes.append(LinkShape(_frustum(part, 3 * sectors)))
    return shapes


def _radii(corners: NDArray[np.float64], z: float) -> tuple[float, float] | None:
    """Least and largest distance from the axis of a cut at one height; 0 where the axis lies inside."""
    above = corners[:, :, 2] > z
    cut = corners[above.any(axis=1) & ~above.all(axis=1)]
    if not len(cut):
        return None
    ends = []
    for i, k in ((0, 1), (1, 2), (2, 0)):
        a, b = cut[:, i], cut[:, k]
        crosses = (a[:, 2] > z) != (b[:, 2] > z)
        share = (z - a[:, 2]) / np.where(crosses, b[:, 2] - a[:, 2], 1.0)
        ends.append(np.where(crosses[:, None], a[:, :2] + share[:, None] * (b[:, :2] - a[:, :2]), np.nan))
    points = np.stack(ends, axis=1)  # two of three are numbers
    segments = points[~np.isnan(points[:, :, 0])].reshape(-1, 2, 2)
    radii = np.linalg.norm(segments, axis=2)
    return (0.0 if _holds_axis(segments) else float(_inner(segments))), float(radii.max())


def _inner(segments: NDArray[np.float64]) -> float:
    """Radius of the hole: that of the corners near to what is nearest, so that a polygon counts as its circle."""
    along = segments[:, 1] - segments[:, 0]
    length = np.maximum((along**2).sum(axis=1), 1e-24)
    share = np.clip(-(segments[:, 0] * along).sum(axis=1) / length, 0, 1)
    nearest = np.linalg.norm(segments[:, 0] + share[:, None] * along, axis=1).min()
    radii = np.linalg.norm(segments, axis=2)
    return float(np.quantile(radii[radii < nearest * POLYGON], 0.75, method="lower"))  # cross holes leave a few beyond


def _holds_axis(segments: NDArray[np.float64]) -> bool:
    """Whether the axis lies inside the cut: a ray crosses its edge an odd number of times."""
    turn = np.array([[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]])  # past corners on the axes
    a, b = segments[:, 0] @ turn.T, segments[:, 1] @ turn.T
    crosses = (a[:, 1] > 0) != (b[:, 1] > 0)
    a, b = a[crosses], b[crosses]
    x = a[:, 0] - a[:, 1] * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
    return bool((x > 0).sum() % 2)


def _joined(slices: list[Slice]) -> list[Slice]:
    """Slices that lie one above the other as one, while their outlines stay within SAME (holes) and ROUGH (outside) of straight lines."""
    out, first = [], 0
    for last in range(1, len(slices) + 1):
        if last == len(slices) or not _straight(slices[first : last + 1]):
            a, b = slices[first], slices[last - 1]
            out.append(Slice(a.low, b.high, (a.inner[0], b.inner[1]), (a.outer[0], b.outer[1])))
            first = last
    return out


def _straight(run: list[Slice]) -> bool:
    if len({min(s.inner) > 0 for s in run}) > 1:
        return False
    heights = np.array([z for s in run for z in (s.low, s.high)])
    if (np.abs(heights[2::2] - heights[1:-1:2]) > SAME).any():
        return False
    for name, allowed in (("inner", SAME), ("outer", ROUGH)):
        radii = np.array([r for s in run for r in getattr(s, name)])
        line = np.interp(heights, heights[[0, -1]], radii[[0, -1]])
        if np.abs(radii - line).max() > allowed:
            return False
    return True


def _wedge(part: Slice, k: int, sectors: int) -> Mesh:
    """One of the ring's pieces: its inner face touches the hole in the middle of the sector."""
    half = np.pi / sectors
    angles = 2 * np.pi * k / sectors + np.array([-half, half])
    corners = [
        (r * np.cos(a), r * np.sin(a), z)
        for z, inner, outer in zip((part.low, part.high), part.inner, part.outer, strict=True)
        for r, a in zip((inner / np.cos(half), outer, outer, inner / np.cos(half)), angles[[0, 0, 1, 1]], strict=True)
    ]
    quads = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return _solid(corners, quads)


def _frustum(part: Slice, sides: int) -> Mesh:
    angles = 2 * np.pi * np.arange(sides) / sides
    corners = [
        (r * np.cos(a), r * np.sin(a), z)
        for z, r in zip((part.low, part.high), part.outer, strict=True)
        for a in angles
    ]
    k = np.arange(sides)
    n = (k + 1) % sides
    walls = np.concatenate([np.stack([k, n, n + sides], axis=1), np.stack([k, n + sides, k + sides], axis=1)])
    caps = np.concatenate([np.stack([0 * k, n, k], axis=1)[1:-1], np.stack([0 * k, k, n], axis=1)[1:-1] + sides])
    return Mesh.from_arrays(np.array(corners), np.concatenate([walls, caps]))


def _solid(corners: list[tuple[float, float, float]], quads: list[tuple[int, int, int, int]]) -> Mesh:
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return Mesh.from_arrays(np.array(corners), np.array(triangles))
