"""The plane that carries things: level, and made of surface that faces its way."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

_CANDIDATES = 300
_NORMAL_SPREAD = 0.45  # normals of a plane's surface lie within this of it [rad]: those of noisy maps vary
_LEAST_CELLS = 50


@dataclass(frozen=True)
class SupportingSurface:
    """normal . x = offset, with the normal upwards, and a frame on it: z along the normal, in the middle of what was seen."""

    normal: np.ndarray
    offset: float
    T_world_plane: np.ndarray
    size: np.ndarray
    """(2,) extents of its surface along the frame's x and y [m]."""


def supporting_plane(
    points: np.ndarray, normals: np.ndarray, up: np.ndarray | None, up_angle: float, tolerance: float, cell: float
) -> SupportingSurface | None:
    """The plane with the largest surface within `tolerance` [m] that faces along it, its normal within `up_angle` [rad] of `up`
    (None: any). `points` and `normals` (n, 3) are averaged over cells of edge `cell` [m], so that area counts. None: there is none.

    A plane without regard to normals could be a slice through a wall, which has many points near any plane that crosses it.
    """
    P, N = _cell_means(points, normals, cell)
    if up is not None:
        facing = N @ (up / np.linalg.norm(up)) >= np.cos(up_angle)
        P, N = P[facing], N[facing]
    if len(P) < _LEAST_CELLS:
        return None
    best, count = None, 0
    for k in range(0, len(P), max(1, len(P) // _CANDIDATES)):
        inliers = _inliers(P, N, N[k], float(N[k] @ P[k]), tolerance)
        found = int(inliers.sum())
        if found > count:
            best, count = inliers, found
    if best is None or count < _LEAST_CELLS:
        return None
    for _ in range(3):
        normal, offset = _fitted(P[best], N[best])
        best = _inliers(P, N, normal, offset, tolerance)
        if best.sum() < _LEAST_CELLS:
            return None
    return _with_frame(normal, offset, P[best])


def _cell_means(points: np.ndarray, normals: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray]:
    cells = np.floor(points / cell).astype(np.int64)
    cells -= cells.min(axis=0)
    spans = cells.max(axis=0) + 1
    _, of_cell, counts = np.unique(
        (cells[:, 0] * spans[1] + cells[:, 1]) * spans[2] + cells[:, 2], return_inverse=True, return_counts=True
    )
    of_cell = of_cell.reshape(-1)
    means = [np.stack([np.bincount(of_cell, x[:, k]) for k in range(3)], axis=1) for x in (points, normals)]
    lengths = np.linalg.norm(means[1], axis=1)
    clear = lengths > 0.5 * counts  # at edges and in noise they cancel
    return means[0][clear] / counts[clear, None], means[1][clear] / lengths[clear, None]


def _inliers(P: np.ndarray, N: np.ndarray, normal: np.ndarray, offset: float, tolerance: float) -> np.ndarray:
    return np.asarray((np.abs(P @ normal - offset) <= tolerance) & (N @ normal >= np.cos(_NORMAL_SPREAD)))


def _fitted(P: np.ndarray, N: np.ndarray) -> tuple[np.ndarray, float]:
    """Least squares; the side is that of the normals."""
    middle = P.mean(axis=0)
    normal = np.linalg.svd(P - middle, full_matrices=False)[2][2]
    normal = normal if normal @ N.mean(axis=0) > 0 else -normal
    return normal, float(normal @ middle)


def _with_frame(normal: np.ndarray, offset: float, P: np.ndarray) -> SupportingSurface:
    axis = np.zeros(3)
    axis[np.argmin(np.abs(normal))] = 1
    x = np.cross(axis, normal)
    x /= np.linalg.norm(x)
    R = np.stack([x, np.cross(normal, x), normal], axis=1)
    local = P @ R
    low, high = local[:, :2].min(axis=0), local[:, :2].max(axis=0)
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = R @ [*((low + high) / 2), offset]
    return SupportingSurface(normal, offset, T, high - low)
