"""Meshes as PLY files, coloured by their uncertainty."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .._argument_errors import checked
from .._core import InvalidInput
from .._files import write_file

# Viridis at equal steps, from matplotlib: dark is certain, bright is not.
_STOPS = np.array(
    [
        [68, 1, 84],
        [71, 44, 122],
        [59, 81, 139],
        [44, 113, 142],
        [33, 144, 141],
        [39, 173, 129],
        [92, 200, 99],
        [170, 220, 50],
        [253, 231, 37],
    ],
    dtype=float,
)


def sigma_range(sigmas: np.ndarray) -> tuple[float, float]:
    """Where the colours begin and end: the 2 % and 90 % quantiles [m]; rims, which are far less certain, are brightest."""
    if len(sigmas) == 0:
        return 0.0, 1e-3
    low, high = (float(x) for x in np.quantile(sigmas, [0.02, 0.9]))
    return low, max(high, low + 1e-6)


def sigma_colours(sigmas: np.ndarray, low: float, high: float) -> np.ndarray:
    """(n, 3) uint8 of standard deviations [m]; dark at `low`, bright at `high`."""
    share = np.clip((np.nan_to_num(sigmas, nan=high) - low) / (high - low), 0, 1) * (len(_STOPS) - 1)
    i = np.minimum(share.astype(int), len(_STOPS) - 2)
    rest = (share - i)[:, None]
    return np.asarray(((1 - rest) * _STOPS[i] + rest * _STOPS[i + 1] + 0.5).astype(np.uint8))


@checked
def write_ply(path: Path, vertices: np.ndarray, triangles: np.ndarray, sigmas: np.ndarray) -> None:
    """Binary, little endian: vertices (n, 3) as floats [m], colours by `sigmas` (n,) [m], which are a property of their own,
    and triangles (m, 3). Raises IoError.
    """
    if len(vertices) != len(sigmas):
        raise InvalidInput(f"sigmas: {len(sigmas)} values, must be one for each of the {len(vertices)} vertices")
    low, high = sigma_range(sigmas)
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"comment sigma: standard deviation of the surface [m]; colours from {low:.6f} (dark) to {high:.6f} (bright)\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float sigma\n"
        f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    corners = np.zeros(len(vertices), dtype=[("xyz", "<f4", 3), ("rgb", "u1", 3), ("sigma", "<f4")])
    corners["xyz"], corners["rgb"], corners["sigma"] = vertices, sigma_colours(sigmas, low, high), sigmas
    faces = np.zeros(len(triangles), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    write_file(path, header.encode() + corners.tobytes() + faces.tobytes())
