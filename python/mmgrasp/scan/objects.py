"""What stands on what: the supporting plane of a mapped scene and the objects on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import quat_xyzw_from_rotation
from .plane import SupportingSurface, supporting_plane

FORMAT, VERSION = "mmgrasp-objects", 1
KNOWN_UP, GUESSED_UP = 0.35, 0.61
"""How far the supporting plane's normal may be from a direction that is known, and from one that mean_up guesses [rad]."""
_MOST_POINTS = 400_000
PLANE, LEFT_OUT = -1, -2  # labels


@dataclass(frozen=True)
class SegmentedObject:
    """One object on the plane, as a box around it that stands on the plane."""

    T_world_box: np.ndarray
    """(4, 4) of the box's centre, z along the plane's normal."""
    size: np.ndarray
    """(3,) full lengths [m]."""
    fill: float
    """Share of the rectangle over which points were seen: how box-like it is."""


@dataclass(frozen=True)
class Segmentation:
    """The supporting plane, normal . x = offset, and what stands on it; no plane: no objects."""

    plane_normal: np.ndarray | None
    plane_offset: float
    objects: list[SegmentedObject]
    labels: np.ndarray = field(repr=False)
    """(n,) of each point: its object, -1 the plane, -2 left out."""


@checked
def objects_on_plane(
    points: np.ndarray,
    normals: np.ndarray,
    *,
    up: Sequence[float] | np.ndarray | None,
    eye: np.ndarray,
    voxel: float,
    up_angle: float = KNOWN_UP,
    carrier: SupportingSurface | None = None,
) -> Segmentation:
    """The largest plane whose normal is within `up_angle` [rad] of `up` (None: any), or the known one `carrier`, and the objects on it, seen from `eye`.

    `points` and `normals` (n, 3): surface of a map whose voxels have the edge `voxel` [m]. Objects that touch are parted where the surface
    has creases.
    """
    assert len(points) == len(normals)
    nothing = Segmentation(None, 0.0, [], np.full(len(points), LEFT_OUT))
    if len(points) == 0:
        return nothing
    tolerance = max(0.008, 2 * voxel)
    if carrier is None:
        wanted = None if up is None else np.asarray(up)
        carrier = supporting_plane(points, normals, wanted, up_angle, tolerance, 3 * voxel)
    if carrier is None:
        return nothing
    leaf = max(0.004, 4 / 3 * voxel)  # above the spacing of the points
    while leaf**2 * _MOST_POINTS < _area(points, leaf):
        leaf *= 1.5
    patch = max(0.03, 7.5 * leaf)  # depth waves over some voxels; creases between larger patches are the surface's
    found = _core.segment_objects(
        points,
        normals,
        plane=_core.SupportingPlane(carrier.normal, carrier.offset),
        eye=eye,
        leaf=leaf,
        patch=patch,
        min_points=int((2 * patch / leaf) ** 2),  # a smaller piece of surface is no object
        plane_tolerance=tolerance,
    )
    labels = np.asarray(found.labels)
    kept = [k for k in range(len(found.objects)) if _is_above(points[labels == k], carrier)]
    renamed = np.full(len(found.objects) + 2, LEFT_OUT)
    renamed[kept] = np.arange(len(kept))
    renamed[PLANE] = PLANE
    labels = renamed[labels]
    objects = [_box_around(points[labels == k], carrier, 2 * leaf) for k in range(len(kept))]
    return Segmentation(carrier.normal, carrier.offset, objects, labels)


def _area(points: np.ndarray, leaf: float) -> float:
    """Area of the surface, roughly [m^2]: cells of edge `leaf` that hold points."""
    return leaf**2 * len(_unique_cells(points, leaf))


def _unique_cells(points: np.ndarray, edge: float) -> np.ndarray:
    cells = np.floor(points / edge).astype(np.int64)
    cells -= cells.min(axis=0)
    key = cells[:, 0]
    for k in range(1, cells.shape[1]):
        key = key * (cells[:, k].max() + 1) + cells[:, k]
    return np.unique(key)


def _is_above(points: np.ndarray, carrier: SupportingSurface) -> bool:
    """The middle of the object lies over the surface that was seen of the plane; walls and furniture beside it do not."""
    T = carrier.T_world_plane
    middle = (np.median(points, axis=0) - T[:3, 3]) @ T[:3, :2]
    return bool(np.all(np.abs(middle) <= np.asarray(carrier.size) / 2))


def _box_around(points: np.ndarray, carrier: SupportingSurface, cell: float) -> SegmentedObject:
    """The narrowest upright box, standing on the plane; 2 % of the points are left out at either end of its sides, and above:
    surfaces stick out at their rims.
    """
    frame = carrier.T_world_plane
    local = (points - frame[:3, 3]) @ frame[:3, :3]
    angles = np.radians(np.arange(0, 90, 1.0))
    sides = np.stack([np.cos(angles), np.sin(angles)])  # (2, k)
    across = np.stack([-sides[1], sides[0]])
    spans = [np.quantile(local[:, :2] @ axes, [0.02, 0.98], axis=0) for axes in (sides, across)]
    best = int(np.argmin((spans[0][1] - spans[0][0]) * (spans[1][1] - spans[1][0])))
    low, high = (np.array([spans[0][end][best], spans[1][end][best]]) for end in (0, 1))
    x, y = sides[:, best], across[:, best]
    if high[1] - low[1] > high[0] - low[0]:  # the longer side is x
        x, y, low, high = y, -x, np.array([low[1], -high[0]]), np.array([high[1], -low[0]])
    height = float(np.quantile(local[:, 2], 0.98))
    middle = (low + high) / 2
    T = np.eye(4)
    T[:3, :3] = frame[:3, :3] @ np.array([[x[0], y[0], 0], [x[1], y[1], 0], [0, 0, 1]])
    T[:3, 3] = frame[:3, 3] + frame[:3, :3] @ [*(middle[0] * x + middle[1] * y), height / 2]
    seen = len(_unique_cells(local[:, :2], cell)) * cell**2 / float(np.prod(np.maximum(high - low, cell)))
    return SegmentedObject(T, np.array([*(high - low), height]), min(1.0, seen))


@checked
def mean_up(T_world_cameras: Sequence[np.ndarray]) -> np.ndarray | None:
    """Where up is, guessed from how cameras are held: between the image's up and the way back from the scene.

    Exact for a camera that looks 45 degrees down, 35 degrees off for one that looks 10 or 80 degrees down; the walls it faces
    are farther off. None where the poses say nothing.
    """
    if not T_world_cameras:
        return None
    T = np.asarray(T_world_cameras, dtype=float)
    guess = np.asarray(-(T[:, :3, 1] + T[:, :3, 2]).mean(axis=0))
    length = float(np.linalg.norm(guess))
    return guess / length if length > 0.5 else None


def vertex_normals(vertices: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(n, 3) unit normals, those of the triangles around weighted by their areas; zero where there are none."""
    corners = vertices[triangles]
    of_triangle = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    owner = triangles.reshape(-1)
    sums = [np.bincount(owner, np.repeat(of_triangle[:, k], 3), len(vertices)) for k in range(3)]
    normals = np.stack(sums, axis=1)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(normals / np.where(lengths > 0, lengths, 1))


def objects_to_dict(
    found: Segmentation, points: np.ndarray, sigmas: np.ndarray, up: np.ndarray | None, how: str
) -> dict[str, Any]:
    """The content of objects.json. `how`: where `up` comes from."""
    rows = []
    for k, thing in enumerate(found.objects):
        own = found.labels == k
        row: dict[str, Any] = {
            "name": f"object_{k + 1}",
            "pose": pose_to_dict(thing.T_world_box),
            "size": thing.size.tolist(),
            "fill": thing.fill,
            "points": int(own.sum()),
        }
        if own.any():
            row["bounds"] = {"lower": points[own].min(axis=0).tolist(), "upper": points[own].max(axis=0).tolist()}
            row["sigma"] = float(np.median(sigmas[own]))
        rows.append(row)
    plane = None
    if found.plane_normal is not None:
        on = int((found.labels == PLANE).sum())
        plane = {"normal": found.plane_normal.tolist(), "offset": found.plane_offset, "points": on}
    return {
        "format": FORMAT,
        "version": VERSION,
        "up": {"direction": None if up is None else up.tolist(), "from": how},
        "plane": plane,
        "objects": rows,
    }


def pose_to_dict(T: np.ndarray) -> dict[str, list[float]]:
    """{xyz, quat_xyzw} of (4, 4)."""
    return {"xyz": T[:3, 3].tolist(), "quat_xyzw": np.asarray(quat_xyzw_from_rotation(T[:3, :3])).tolist()}
