"""Pictures of grasps of unknown parts: the surface with its uncertainty, and where the pads of the best grasp touch it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .pictures import _pyplot, _save

PATCH, WAY_IN = "#b8405e", "#1f5f99"
_COLUMNS = 3
_MOST_POINTS = 4000


def write_grasp_picture(rows: list[dict[str, Any]], points: np.ndarray, sigmas: np.ndarray, path: Path) -> Path:
    """One panel an object: its points, light where they are uncertain, the contact patches of its best grasp as discs with their
    normals, and the way the hand comes in.

    `rows` are those of `mmgrasp grasp --json`, with `bounds`, least and largest corner, for each object; `points` (n, 3) and `sigmas` (n,)
    are the map's.
    """
    columns = min(_COLUMNS, len(rows))
    lines = -(-len(rows) // columns)
    fig = _pyplot()(4.6 * columns, 4.4 * lines)
    most = max(1e-6, float(np.quantile(sigmas, 0.95))) if len(sigmas) else 1.0
    for k, row in enumerate(rows):
        axis = fig.add_subplot(lines, columns, k + 1, projection="3d")
        lower, upper = np.array(row["bounds"])
        own = np.flatnonzero(((points >= lower - 0.01) & (points <= upper + 0.01)).all(axis=1))
        own = own[:: max(1, len(own) // _MOST_POINTS)]
        axis.scatter(
            *points[own].T, c=sigmas[own], cmap="Greys_r", vmin=0, vmax=1.3 * most, s=3, linewidths=0, alpha=0.45
        )
        title = f"{row['name']}: no grasp"
        if row["grasps"]:
            best = row["grasps"][0]
            kind = f", {best['type']}" if "type" in best else ""
            title = f"{row['name']}{kind}: probability {best['probability']:.2f}"
            _draw_grasp(axis, best, 0.3 * float(np.max(upper - lower)))
        axis.set_title(title, fontsize=10)
        half = max(0.03, 0.55 * float(np.max(upper - lower)))
        middle = (lower + upper) / 2
        axis.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
        axis.set(zlim=(lower[2], lower[2] + 2 * half), xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
        axis.set_box_aspect((1, 1, 1))
        axis.view_init(elev=28, azim=_azimuth(row))
        axis.locator_params(nbins=4)
        axis.tick_params(labelsize=7)
    fig.suptitle(
        "contact patches of the best grasp (red), the way in (blue); dark: certain surface, light: uncertain",
        fontsize=9,
    )
    return _save(fig, path)


def _azimuth(row: dict[str, Any]) -> float:
    """Looks at the patches from the side, so that both show [deg]."""
    if not row["grasps"] or len(row["grasps"][0]["patches"]) < 2:
        return -60.0
    first, second = (np.array(patch["point"]) for patch in row["grasps"][0]["patches"][:2])
    across = second - first
    return float(np.degrees(np.arctan2(across[1], across[0]))) + 55.0


def _draw_grasp(axis: Any, grasp: dict[str, Any], length: float) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # type: ignore[import-untyped]

    middles = []
    for patch in grasp["patches"]:
        point, normal = np.array(patch["point"]), np.array(patch["normal"])
        middles.append(point)
        side = np.cross(normal, [0.0, 0.0, 1.0] if abs(normal[2]) < 0.9 else [1.0, 0.0, 0.0])
        side /= np.linalg.norm(side)
        turns = np.linspace(0, 2 * np.pi, 32)[:, None]
        disc = point + 0.006 * (np.cos(turns) * side + np.sin(turns) * np.cross(normal, side))
        axis.add_collection3d(Poly3DCollection([disc], facecolor=PATCH, edgecolor="black", linewidths=0.6, alpha=0.9))
        axis.plot(*np.stack([point, point + 0.02 * normal]).T, color=PATCH, linewidth=1.5)
    middle = np.mean(middles, axis=0)
    approach = np.array(grasp["approach"])
    axis.plot(*np.stack([middle - length * approach, middle]).T, color=WAY_IN, linewidth=1.5)
