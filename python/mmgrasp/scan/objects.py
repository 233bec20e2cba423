"""What stands on what: the supporting plane of a mapped scene and the objects on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..mapping import FittedCuboid, fit_cuboids
from ..robot import quat_xyzw_from_rotation
from .plane import supporting_plane

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
    """Share of the top rectangle that was seen: how box-like it is."""


@dataclass(frozen=True)
class Segmentation:
    """The supporting plane, normal . x = offset, and what stands on it; no plane: no objects."""

    plane_normal: np.ndarray | None
    plane_offset: float
    objects: list[SegmentedObject]
    labels: np.ndarray = field(repr=False)
    """(n,) of each point: its object, -1 the plane, -2 left out."""


def segment_objects(
    points: np.ndarray,
    normals: np.ndarray,
    *,
    up: Sequence[float] | np.ndarray | None,
    eye: np.ndarray,
    voxel: float,
    up_angle: float = KNOWN_UP,
) -> Segmentation:
    """The largest plane whose normal is within `up_angle` [rad] of `up` (None: any), and the objects on it, seen from `eye`.

    `points` and `normals` (n, 3): surface of a map whose voxels have the edge `voxel` [m]. Objects that touch are one.
    """
    assert len(points) == len(normals)
    nothing = Segmentation(None, 0.0, [], np.full(len(points), LEFT_OUT))
    if len(points) == 0:
        return nothing
    tolerance = max(0.008, 2 * voxel)
    plane = supporting_plane(points, normals, None if up is None else np.asarray(up), up_angle, tolerance, 3 * voxel)
    if plane is None:
        return nothing
    leaf = max(0.003, voxel)
    chosen, cell_of = _thinned(points, leaf)
    fit = fit_cuboids(  # with the plane's rectangle as a tray without walls
        points[chosen],
        T_world_tray=plane.T_world_plane,
        tray_size=[*plane.size, 1.0],
        wall=0.0,
        wall_margin=0.0,
        eye=eye,
        plane_tolerance=tolerance,
        cluster_tolerance=max(0.010, 3 * leaf),
        leaf=leaf,
    )
    labels = np.asarray(fit.labels)[cell_of]
    objects = [_box_around(points[labels == k], cuboid) for k, cuboid in enumerate(fit.cuboids)]
    return Segmentation(plane.normal, plane.offset, objects, labels)


def _box_around(points: np.ndarray, cuboid: FittedCuboid) -> SegmentedObject:
    """Turned as the cuboid is, but as wide as the object's points, 2 % left out at either end: a map shows sides, too, which the
    cuboid of a single view does not count on, most objects are no boxes, and surfaces stick out at their rims.
    """
    T = np.array(cuboid.T_world_box)
    size = np.array(cuboid.size)
    if len(points):
        low, high = np.quantile((points - T[:3, 3]) @ T[:3, :2], [0.02, 0.98], axis=0)
        T[:3, 3] += T[:3, :2] @ ((low + high) / 2)
        size[:2] = high - low
    if size[1] > size[0]:  # the longer side is x
        size[:2] = size[1::-1]
        T[:3, :2] = np.stack([T[:3, 1], -T[:3, 0]], axis=1)
    return SegmentedObject(T, size, cuboid.fill)


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


def _thinned(points: np.ndarray, leaf: float) -> tuple[np.ndarray, np.ndarray]:
    """The first point of every cell, at most some hundred thousand, and the cell of each point."""
    while True:
        cells = np.floor(points / leaf).astype(np.int64)
        cells -= cells.min(axis=0)
        spans = cells.max(axis=0) + 1
        keys = (cells[:, 0] * spans[1] + cells[:, 1]) * spans[2] + cells[:, 2]
        _, chosen, cell_of = np.unique(keys, return_index=True, return_inverse=True)
        if len(chosen) <= _MOST_POINTS:
            return chosen, cell_of.reshape(-1)
        leaf *= 1.5


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
