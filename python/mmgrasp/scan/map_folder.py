"""A map in its folder, and what lies in a known tray of it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._core import IoError, ProbabilisticSdf
from .._files import printable
from .objects import objects_on_plane, vertex_normals
from .plane import SupportingSurface

MAP = "map.sdf"


@dataclass(frozen=True)
class TrayObject:
    """Something that lies in a tray."""

    T_tray_box: np.ndarray
    """(4, 4) of a box around it that stands on the floor."""
    size: np.ndarray
    """(3,) of that box [m]."""
    bounds: np.ndarray
    """(2, 3) least and largest corner of its points along the world's axes [m]."""


def load_map(folder: Path) -> ProbabilisticSdf:
    """The map of a folder that `mmgrasp scan` wrote. Raises IoError naming folder or file."""
    path = folder / MAP
    if not path.is_file():
        raise IoError(f"{printable(str(folder))}: holds no {MAP}: not a folder that mmgrasp scan wrote")
    return ProbabilisticSdf.load(str(path))


def objects_in_tray(
    sdf: ProbabilisticSdf, T_world_tray: np.ndarray, inner: np.ndarray, height: float, beside: float
) -> list[TrayObject]:
    """Objects on the floor of a tray, in order of x, then y of its frame.

    The frame lies in the middle of the floor, `inner` (2,) are the floor's sides and objects reach at most `height` above it [m]; what
    is nearer to a wall than `beside` [m] is the wall. The scene's largest plane may be another one: the table, the ground.
    """
    mesh, _ = sdf.mesh()
    points, normals = mesh.vertices, vertex_normals(mesh.vertices, mesh.triangles)
    local = (points - T_world_tray[:3, 3]) @ T_world_tray[:3, :3]
    inside = (
        (np.abs(local[:, :2]) <= inner / 2 - beside).all(axis=1) & (local[:, 2] >= -beside) & (local[:, 2] <= height)
    )
    points, normals = points[inside], normals[inside]
    if not len(points):
        return []
    up = T_world_tray[:3, 2]
    floor = SupportingSurface(up, float(up @ T_world_tray[:3, 3]), T_world_tray, inner)
    eye = T_world_tray[:3, 3] + 10 * up
    found = objects_on_plane(points, normals, up=up, eye=eye, voxel=sdf.voxel, carrier=floor)
    out = []
    for k, thing in enumerate(found.objects):
        own = points[found.labels == k]
        bounds = np.stack([own.min(axis=0), own.max(axis=0)])
        out.append(TrayObject(np.linalg.inv(T_world_tray) @ thing.T_world_box, thing.size, bounds))
    return sorted(out, key=lambda thing: (thing.T_tray_box[0, 3], thing.T_tray_box[1, 3]))
