"""Pictures of a map as a camera sees it: shaded by its normals, coloured by how uncertain it is."""

from __future__ import annotations

import base64
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WIDTH, _HEIGHT, _FOCAL = 176, 132, 260.0  # [pixels]
_UNSEEN = 255
_LEAST, _MOST = 1e-5, 0.03  # [m]
_LIGHT = np.array([0.35, -0.5, 0.8]) / np.linalg.norm([0.35, -0.5, 0.8])


def seen_surface(sdf: _core.ProbabilisticSdf, T_world_camera: np.ndarray, points: list[list[float]]) -> dict[str, Any]:
    """One ray a pixel: sigma in logarithmic steps from _LEAST to _MOST, brightness, and where `points` [m] lie in the picture [pixels]."""
    u, v = np.meshgrid(np.arange(_WIDTH), np.arange(_HEIGHT))
    middle = np.array([(_WIDTH - 1) / 2, (_HEIGHT - 1) / 2])
    rays = np.stack([(u - middle[0]) / _FOCAL, (v - middle[1]) / _FOCAL, np.ones(u.shape)], axis=-1).reshape(-1, 3)
    directions = rays @ T_world_camera[:3, :3].T
    hits = sdf.cast_rays(np.broadcast_to(T_world_camera[:3, 3], directions.shape), directions)
    hit = np.asarray(hits.hit, dtype=bool)
    sigma = np.full(len(hit), _UNSEEN, dtype=np.uint8)
    share = np.log(np.asarray(hits.sigma)[hit] / _LEAST) / np.log(_MOST / _LEAST)
    sigma[hit] = np.round(254 * np.clip(share, 0, 1))
    bright = np.zeros(len(hit), dtype=np.uint8)
    bright[hit] = 255 * (0.35 + 0.65 * np.clip(np.asarray(hits.normal)[hit] @ _LIGHT, 0, 1))
    local = (np.array(points).reshape(-1, 3) - T_world_camera[:3, 3]) @ T_world_camera[:3, :3]
    pixels = local[:, :2] / local[:, 2:] * _FOCAL + middle
    return {
        "sigma": _packed(sigma),
        "bright": _packed(bright),
        "points": np.round(pixels, 1).tolist(),
    }


def draw_surface(axis: Axes, view: dict[str, Any], limits: tuple[float, float], title: str) -> Any:
    """The surface, coloured by sigma between `limits` [mm]; its points joined by a line that nothing hides, as the two pads of a
    grasp. Returns what a colour bar is made of."""
    import matplotlib as mpl
    from matplotlib.colors import LogNorm

    sigma, bright = (_unpacked(view[name]) for name in ("sigma", "bright"))
    scale = mpl.cm.ScalarMappable(LogNorm(*limits), "viridis")
    image = scale.to_rgba(1000 * _LEAST * (_MOST / _LEAST) ** (sigma / 254.0))
    image[..., :3] *= bright[..., None] / 255
    image[sigma == _UNSEEN] = 1.0
    axis.imshow(image)
    axis.set(xticks=[], yticks=[])
    axis.grid(False)
    axis.spines[:].set_visible(False)
    axis.set_title(title, fontsize=9)
    if view["points"]:
        x, y = zip(*view["points"], strict=True)
        axis.plot(x, y, color="#d8365d", marker="o", markersize=5, linewidth=1.5)
    return scale


def _packed(values: np.ndarray) -> str:
    return base64.b64encode(zlib.compress(values.tobytes(), 9)).decode()


def _unpacked(text: str) -> np.ndarray:
    return np.frombuffer(zlib.decompress(base64.b64decode(text)), dtype=np.uint8).reshape(_HEIGHT, _WIDTH)
