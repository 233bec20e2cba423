"""A mapped surface as cameras at infinity see it: rays through a ProbabilisticSdf, shaded by normals or coloured by sigma."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._core import ProbabilisticSdf

_ROWS = 24  # of a picture at a time


@dataclass
class View:
    """A parallel projection: `right`, `down` and `forward` are unit vectors of the world; `centre` is in the middle."""

    title: str
    centre: np.ndarray
    right: np.ndarray
    down: np.ndarray
    forward: np.ndarray
    half_width: float  # [m]
    half_height: float
    columns: int
    rows: int

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (n, 3) to metres right of and below the middle, (n, 2)."""
        return np.asarray((points - self.centre) @ np.stack([self.right, self.down], axis=1))

    @property
    def pixel(self) -> float:
        """Edge of a pixel [m]."""
        return 2 * self.half_width / self.columns

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """As imshow wants it: left, right, bottom, top."""
        return -self.half_width, self.half_width, self.half_height, -self.half_height


@dataclass
class Seen:
    """What a view shows, (rows, columns) each."""

    hit: np.ndarray
    shade: np.ndarray  # in [0, 1]
    sigma: np.ndarray  # [m], NaN where nothing is
    distance: np.ndarray  # along the rays [m], NaN where nothing is

    def outlines(self, jump: float) -> np.ndarray:
        """Where the surface ends, or another begins more than `jump` [m] behind it: the nearer side of each such step."""
        far = np.where(self.hit, self.distance, np.inf)
        out = np.zeros(far.shape, dtype=bool)
        for axis in (0, 1):
            for shift in (1, -1):
                out |= np.roll(far, shift, axis) > far + jump
        return np.asarray(out & self.hit)


def three_views(
    points: np.ndarray, up: np.ndarray, towards: np.ndarray, width: int = 560, height: int = 420
) -> list[View]:
    """From two sides and from above, around the side on which the cameras were (`towards`: from the scene to them)."""
    level = towards - (towards @ up) * up
    if np.linalg.norm(level) < 0.1 * max(float(np.linalg.norm(towards)), 1e-9):
        level = np.cross(up, [0.0, 1.0, 0.0]) if abs(up[1]) < 0.9 else np.cross(up, [1.0, 0.0, 0.0])
    level = level / np.linalg.norm(level)
    side = np.cross(up, level)
    views = []
    for title, azimuth, elevation in (("from the left", -40, 30), ("from the right", 40, 30), ("from above", 0, 90)):
        a, e = np.radians(azimuth), np.radians(elevation)
        around = np.cos(a) * level + np.sin(a) * side
        forward = -(np.cos(e) * around + np.sin(e) * up)
        right = np.cross(up, around)
        views.append(_fitted(title, points, right, np.cross(forward, right), forward, width, height))
    return views


def _fitted(
    title: str, points: np.ndarray, right: np.ndarray, down: np.ndarray, forward: np.ndarray, width: int, height: int
) -> View:
    """Zoomed so that all but stray points are in the picture."""
    sample = points[:: max(1, len(points) // 200_000)]
    local = sample @ np.stack([right, down, forward], axis=1)
    low, high = np.quantile(local, [0.002, 0.998], axis=0)
    middle, half = (low + high) / 2, (high - low) / 2 * 1.06 + 1e-3
    pixel = max(half[0] / (width / 2), half[1] / (height / 2))
    half_width, half_height = pixel * width / 2, pixel * height / 2
    # Rays start in front of everything, stray points included.
    start = local[:, 2].min() - 0.1
    centre = middle[0] * right + middle[1] * down + start * forward
    return View(title, centre, right, down, forward, half_width, half_height, width, height)


def look(sdf: ProbabilisticSdf, view: View, progress: Callable[[float], object] | None = None) -> Seen:
    """One ray a pixel, some rows at a time, so that Ctrl-C is heard in between."""
    x = (np.arange(view.columns) + 0.5) * view.pixel - view.half_width
    y = (np.arange(view.rows) + 0.5) * view.pixel - view.half_height
    seen = Seen(*(np.zeros((view.rows, view.columns), dtype=kind) for kind in (bool, float, float, float)))
    for first in range(0, view.rows, _ROWS):
        rows = slice(first, min(first + _ROWS, view.rows))
        across = x[None, :, None] * view.right + y[rows, None, None] * view.down
        origins = (view.centre + across).reshape(-1, 3)
        hits = sdf.cast_rays(origins, np.broadcast_to(view.forward, origins.shape))
        shape = (-1, view.columns)
        seen.hit[rows] = hits.hit.reshape(shape)
        seen.shade[rows] = _shade(np.nan_to_num(hits.normal), view).reshape(shape)
        seen.sigma[rows] = hits.sigma.reshape(shape)
        seen.distance[rows] = hits.distance.reshape(shape)
        if progress:
            progress(rows.stop / view.rows)
    return seen


def _shade(normals: np.ndarray, view: View) -> np.ndarray:
    """A lamp at the camera and one above its right shoulder."""
    head = np.clip(-(normals @ view.forward), 0, 1)
    light = 0.5 * view.right - 0.6 * view.down - 0.62 * view.forward
    lit = np.clip(normals @ (light / np.linalg.norm(light)), 0, 1)
    return np.asarray(np.clip(0.25 + 0.35 * head + 0.42 * lit, 0, 1))
