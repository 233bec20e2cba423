"""Pictures of a scan: the surface with its uncertainty, the objects on their plane, what each sensor contributed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._progress import Progress
from ..scan.integration import FrameRecord, Scan
from ..scan.objects import Segmentation, mean_up
from ..scan.ply import sigma_range
from .pictures import _pyplot, _save
from .scan_views import Seen, View, look, three_views
from .style import STOP, TRAY_COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SURFACE = np.array([0.93, 0.90, 0.85])
CAUSES = (
    ("used", "in the map", "#0072B2"),
    ("out_of_range", "out of range", "#B8B4AC"),
    ("too_noisy", "too noisy", "#E69F00"),
    ("too_slanted", "seen too slanted", "#CC79A7"),
    ("without_normal", "at rims, no normal", "#56B4E9"),
    ("outliers", "outliers", "#4D4A44"),
)
_EDGES = [(0, 1), (0, 2), (0, 4), (1, 3), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 6), (5, 7), (6, 7)]


def write_scan_pictures(
    scan: Scan, points: np.ndarray, sigmas: np.ndarray, found: Segmentation, out: Path, progress: Progress = None
) -> list[Path]:
    """Writes surface.png, objects.png where there is a plane, and sensors.png; returns their paths."""
    paths = []
    if len(points):
        views = three_views(points, _up(scan, found), _towards_cameras(scan, points))
        seen = []
        for i, view in enumerate(views):
            tell = (lambda share, i=i: progress("drawing", (i + share) / 4)) if progress else None
            seen.append(look(scan.sdf, view, tell))
        paths.append(write_surface(views, seen, sigmas, out / "surface.png"))
        if found.plane_normal is not None:
            paths.append(write_objects(views, seen, found, out / "objects.png"))
    if progress:
        progress("drawing", 0.9)
    paths.append(write_contributions(scan, out / "sensors.png"))
    if progress:
        progress("drawing", 1.0)
    return paths


def _up(scan: Scan, found: Segmentation) -> np.ndarray:
    guess = found.plane_normal
    if guess is None:
        guess = mean_up([np.array(record.T_world_camera) for record in scan.frames])
    return np.array([0.0, 0.0, 1.0]) if guess is None else np.asarray(guess)


def _towards_cameras(scan: Scan, points: np.ndarray) -> np.ndarray:
    eyes = np.array([np.array(record.T_world_camera)[:3, 3] for record in scan.frames])
    return np.asarray(eyes.mean(axis=0) - np.median(points, axis=0))


def write_surface(views: list[View], seen: list[Seen], sigmas: np.ndarray, path: Path) -> Path:
    """Three sides of the surface, and below each the standard deviation of what is seen."""
    low, high = (1e3 * x for x in sigma_range(sigmas))
    figure = _pyplot()(14.4, 7.1)
    axes = figure.subplots(2, 3)
    for k, (view, picture) in enumerate(zip(views, seen, strict=True)):
        axes[0, k].imshow(_shaded(view, picture), extent=view.extent, interpolation="antialiased")
        axes[0, k].set_title(view.title, fontsize=12)
        coloured = np.ma.masked_where(~picture.hit, 1e3 * picture.sigma)
        axes[1, k].imshow(coloured, extent=view.extent, cmap="viridis", vmin=low, vmax=high)
        for row in (0, 1):
            _frame(axes[row, k], view)
    figure.colorbar(
        axes[1, 0].images[0], ax=axes[1, :], label="sigma of the surface [mm]", fraction=0.025, pad=0.01, extend="both"
    )
    return _save(figure, path)


def _shaded(view: View, picture: Seen) -> np.ndarray:
    """With outlines where one thing stands before another: a lid and the table below it are as bright."""
    image = np.ones((*picture.hit.shape, 3))
    image[picture.hit] = picture.shade[picture.hit][:, None] * SURFACE
    image[picture.outlines(8 * view.pixel)] *= 0.6
    return image


def _frame(axes: Axes, view: View) -> None:
    """No axes, but a bar of a round length."""
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_color("#d8d5ce")
    axes.set_xlim(-view.half_width, view.half_width)
    axes.set_ylim(view.half_height, -view.half_height)
    rounds = [r * 10.0**k for k in range(-4, 5) for r in (1, 2, 5)]
    length = max([r for r in rounds if r <= 0.5 * view.half_width], default=rounds[0])
    x, y = -0.93 * view.half_width, 0.9 * view.half_height
    axes.plot([x, x + length], [y, y], color="#22262b", linewidth=3, solid_capstyle="butt")
    label = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm" if length >= 0.01 else f"{1000 * length:g} mm"
    axes.text(
        x, y - 0.035 * view.half_height, label, fontsize=9, va="bottom",
        bbox={"facecolor": "white", "alpha": 0.7, "edgecolor": "none", "pad": 1.5},
    )  # fmt: skip


def write_objects(views: list[View], seen: list[Seen], found: Segmentation, path: Path) -> Path:
    """The objects' boxes with their numbers, from one side and from above."""
    figure = _pyplot()(14.4, 5.9)
    axes = figure.subplots(1, 2)
    for ax, view, picture in zip(axes, (views[0], views[2]), (seen[0], seen[2]), strict=True):
        ax.imshow(0.35 + 0.65 * _shaded(view, picture), extent=view.extent, interpolation="antialiased")
        ax.set_title(view.title, fontsize=12)
        _frame(ax, view)
        for k, thing in enumerate(found.objects):
            colour = TRAY_COLOURS[k % len(TRAY_COLOURS)]
            corners = view.project(_corners(thing.T_world_box, thing.size))
            for a, b in _EDGES:
                ax.plot(corners[[a, b], 0], corners[[a, b], 1], color=colour, linewidth=1.6)
            x, y = view.project((thing.T_world_box @ [0, 0, thing.size[2] / 2, 1])[None, :3])[0]
            ax.text(
                x, y, str(k + 1), fontsize=8, weight="bold", color="white", ha="center", va="center", clip_on=True,
                bbox={"boxstyle": "circle,pad=0.2", "facecolor": colour, "edgecolor": "white"},
            )  # fmt: skip
    return _save(figure, path)


def _corners(T_world_box: np.ndarray, size: np.ndarray) -> np.ndarray:
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    return np.asarray(signs * size @ T_world_box[:3, :3].T + T_world_box[:3, 3])


def write_contributions(scan: Scan, path: Path) -> Path:
    """What became of each sensor's pixels, and how far its frames agree with what others saw before."""
    names = list(dict.fromkeys(record.sensor for record in scan.frames))
    agree = any(record.agreement is not None for record in scan.frames)
    heights = [0.7 + 0.45 * len(names)] + ([2.6] if agree else [])
    figure = _pyplot()(11, 0.8 + 1.1 * sum(heights))
    panels = figure.subplots(len(heights), 1, gridspec_kw={"height_ratios": heights}, squeeze=False)[:, 0]
    for row, name in enumerate(names):
        _bar(panels[0], row, [record for record in scan.frames if record.sensor == name])
    panels[0].set_yticks(range(len(names)), names)
    panels[0].set_ylim(len(names) - 0.5, -0.5)
    panels[0].set_xlim(0, 100)
    panels[0].set_xlabel("share of the measured pixels [%]")
    for _, label, colour in CAUSES:
        panels[0].barh(0, 0, color=colour, label=label)
    panels[0].legend(ncols=len(CAUSES), loc="lower left", bbox_to_anchor=(0, 1.0), frameon=False, fontsize=9)
    if agree:
        _draw_agreements(panels[1], scan, names)
    for ax in panels:
        ax.spines[["top", "right"]].set_visible(False)
    return _save(figure, path)


def _draw_agreements(axes: Axes, scan: Scan, names: list[str]) -> None:
    from matplotlib.ticker import MaxNLocator

    for row, name in enumerate(names):
        at = [(i, 100 * r.agreement) for i, r in enumerate(scan.frames) if r.sensor == name and r.agreement is not None]
        colour = TRAY_COLOURS[row % len(TRAY_COLOURS)]
        axes.plot([i for i, _ in at], [a for _, a in at], ".", color=colour, markersize=7, label=name)
    doubtful = [(i, 100 * r.agreement) for i, r in enumerate(scan.frames) if r.warning and r.agreement is not None]
    if doubtful:
        axes.plot(*zip(*doubtful, strict=True), "x", color=STOP, markersize=9, label="doubtful pose")
    axes.set_ylim(-3, 103)
    axes.set_xlim(-0.5, max(len(scan.frames) - 0.5, 0.5))
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel("frame, in the order of integration")
    axes.set_ylabel("agreement [%]")
    axes.grid(axis="y", color="#e4e2dc")
    if len(names) > 1 or doubtful:
        axes.legend(loc="lower left", fontsize=9)


def _bar(axes: Axes, row: int, own: list[FrameRecord]) -> None:
    measured = sum(record.measured for record in own)
    left = 0.0
    for field, _, colour in CAUSES:
        share = 100 * sum(getattr(record, field) for record in own) / max(measured, 1)
        axes.barh(row, share, left=left, color=colour, height=0.6)
        if share > 4:
            dark = field in ("out_of_range", "too_noisy", "without_normal")
            axes.text(
                left + share / 2,
                row,
                f"{share:.0f} %",
                ha="center",
                va="center",
                fontsize=9,
                color="#22262b" if dark else "white",
            )
        left += share
