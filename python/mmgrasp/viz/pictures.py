"""PNG pictures of a plan: the top view, one region a tray, the robot at each stop, a pick's joint curves."""

from __future__ import annotations

import io
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._files import write_file
from ..part_supply.drives import all_drives
from . import png
from .raster import Camera, render
from .scene import PlanScene
from .style import FLOOR, OBSTACLE, PART, ROUTE, STOP, TRAY_BODY, rgb, tray_colour
from .topview import arrival_ellipse, footprint, outline_edges, shared_cells, stop_intersections

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def write_pictures(plan: dict[str, Any], out_dir: str | Path) -> list[Path]:
    """Writes every picture that the plan allows and returns their paths, the top view first."""
    out_dir = Path(out_dir)
    out_dir.mkdir(parents=True, exist_ok=True)
    paths = [write_topview(plan, out_dir / "topview.png"), write_regions(plan, out_dir / "regions.png")]
    scene = PlanScene(plan)
    first_grasp: dict[int, float] = {}
    for stop, time in scene.timeline.grasp_times():
        first_grasp.setdefault(stop, time)
    for stop, time in sorted(first_grasp.items()):
        paths.append(write_stop(scene, stop, time, out_dir / f"stop_{stop + 1}.png"))
    if plan["picks"]:
        paths.append(write_pick_curves(plan, 0, out_dir / "pick_1_joints.png"))
    return paths


def _pyplot() -> Callable[[float, float], Figure]:
    os.environ.setdefault("MPLBACKEND", "Agg")
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    def figure(width: float, height: float) -> Figure:
        made = Figure(figsize=(width, height), dpi=130, layout="constrained")
        FigureCanvasAgg(made)
        return made

    return figure


def _save(figure: Figure, path: Path) -> Path:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    write_file(path, buffer.getvalue())
    return path


def region_mask(plan: dict[str, Any], region: dict[str, Any]) -> np.ndarray:
    """Cells of a region over all headings, (ny, nx) bool."""
    mask = np.zeros((plan["grid"]["ny"], plan["grid"]["nx"]), dtype=bool)
    for runs in region["cells"].values():
        for iy, start, end in runs:
            mask[iy, start:end] = True
    return mask


def _extent(grid: dict[str, Any]) -> tuple[float, float, float, float]:
    x, y = grid["origin"]
    h = grid["resolution"]
    return x, x + grid["nx"] * h, y, y + grid["ny"] * h


def _draw_mask(axes: Axes, plan: dict[str, Any], mask: np.ndarray, colour: str, alpha: float) -> None:
    image = np.zeros((*mask.shape, 4))
    image[..., :3] = rgb(colour)
    image[..., 3] = mask * alpha
    axes.imshow(image, origin="lower", extent=_extent(plan["grid"]), interpolation="nearest", zorder=1)


def _draw_bodies(axes: Axes, plan: dict[str, Any]) -> None:
    from matplotlib.patches import Polygon

    scenario = plan["scenario"]
    for obstacle in scenario["obstacles"]:
        colour = TRAY_BODY if obstacle["name"].startswith("tray ") else OBSTACLE
        for outline in footprint(obstacle["shapes"], obstacle["pose"]):
            axes.add_patch(Polygon(outline, facecolor=colour, edgecolor="#6b665f", linewidth=0.5, zorder=2))
    for part in scenario["parts"]:
        colour = PART if part["target"] else "#8F8A82"
        for outline in footprint(part["shapes"], part["pose"]):
            axes.add_patch(Polygon(outline, facecolor=colour, edgecolor="#7a3d08", linewidth=0.3, zorder=3))


def _label_tray(axes: Axes, tray: dict[str, Any], index: int) -> None:
    x, y = tray["pose"]["xyz"][:2]
    axes.text(
        x, y, tray["name"], ha="center", va="center", color="white", fontsize=9, weight="bold", zorder=8,
        bbox={"boxstyle": "circle,pad=0.3", "facecolor": tray_colour(index), "edgecolor": "white"},
    )  # fmt: skip


def _draw_arrow(axes: Axes, pose: Sequence[float], colour: str, length: float = 0.28) -> None:
    dx, dy = length * np.cos(pose[2]), length * np.sin(pose[2])
    axes.annotate(
        "", (pose[0] + dx, pose[1] + dy), (pose[0], pose[1]), zorder=7,
        arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 2, "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip


def _room_limits(axes: Axes, plan: dict[str, Any]) -> None:
    points = [np.asarray(plan["scenario"][key][:2], float) for key in ("start", "goal")]
    for obstacle in plan["scenario"]["obstacles"]:
        for outline in footprint(obstacle["shapes"], obstacle["pose"]):
            points += [outline.min(axis=0), outline.max(axis=0)]
    stacked = np.array(points)
    low, high = stacked.min(axis=0) - 0.3, stacked.max(axis=0) + 0.3
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal")


def write_topview(plan: dict[str, Any], path: Path) -> Path:
    """Room, base regions, stops with their discs, and the route, seen from above."""
    from matplotlib.lines import Line2D
    from matplotlib.patches import Circle, Ellipse, Patch

    covariance = plan["scenario"].get("arrival_covariance")
    figure = _pyplot()(10, 7.2)
    axes = figure.add_subplot()
    axes.set_facecolor(FLOOR)
    names = [tray["name"] for tray in plan["scenario"]["trays"]]
    legend: list[Artist] = []
    for region in plan["regions"]:
        index = names.index(region["tray"])
        _draw_mask(axes, plan, region_mask(plan, region), tray_colour(index), 0.32)
        legend.append(Patch(color=tray_colour(index), alpha=0.45, label=f"base region of tray {region['tray']}"))
    for item in stop_intersections(plan):
        for edge in outline_edges(shared_cells(plan, item)):
            corners = np.array(edge).reshape(2, 2) * plan["grid"]["resolution"] + plan["grid"]["origin"]
            axes.plot(corners[:, 0], corners[:, 1], color=ROUTE, linewidth=1.0, zorder=4)
    _draw_bodies(axes, plan)
    for leg in all_drives(plan):
        poses = np.asarray(leg["poses"], float).reshape(-1, 3)
        axes.plot(poses[:, 0], poses[:, 1], "--", color=ROUTE, linewidth=1.8, zorder=5)
    for number, stop in enumerate(plan["stops"], start=1):
        x, y, _ = stop["pose"]
        axes.add_patch(Circle((x, y), stop["radius"], facecolor=STOP, alpha=0.2, edgecolor=STOP, zorder=5))
        uncertainty = plan["scenario"]["positioning_uncertainty"]
        axes.add_patch(Circle((x, y), uncertainty, fill=False, edgecolor=STOP, linestyle=":", linewidth=1.5, zorder=6))
        if covariance is not None:
            along, across, turn = arrival_ellipse(covariance)
            axes.add_patch(Ellipse((x, y), 2 * along, 2 * across, angle=turn, fill=False, edgecolor=STOP, zorder=6))
        _draw_arrow(axes, stop["pose"], STOP)
        axes.text(
            x, y, str(number), ha="center", va="center", color="white", fontsize=10, weight="bold", zorder=9,
            bbox={"boxstyle": "circle,pad=0.25", "facecolor": STOP, "edgecolor": "white"},
        )  # fmt: skip
    for index, tray in enumerate(plan["scenario"]["trays"]):
        _label_tray(axes, tray, index)
    for word in ("start", "goal"):
        pose = plan["scenario"][word]
        axes.plot(pose[0], pose[1], "o", color="white", markeredgecolor=ROUTE, markeredgewidth=2.2, zorder=7)
        _draw_arrow(axes, pose, ROUTE)
        axes.annotate(word, pose[:2], xytext=(8, -14), textcoords="offset points", fontsize=10, weight="bold", zorder=8)
    if stop_intersections(plan):
        legend.append(Line2D([], [], color=ROUTE, linewidth=1.0, label="cells that a stop's trays share"))
    legend.append(Line2D([], [], color=ROUTE, linestyle="--", label="route of the base"))
    legend.append(Line2D([], [], color=STOP, linestyle=":", label="positioning uncertainty"))
    if covariance is not None:
        legend.append(Line2D([], [], color=STOP, label="95 of 100 arrivals"))
    legend.append(Patch(facecolor=STOP, alpha=0.25, edgecolor=STOP, label="disc that stays inside the region"))
    _room_limits(axes, plan)
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    count = len(plan["stops"])
    axes.set_title(
        f"{plan['scenario'].get('name', 'plan')}: {count} stop{'s' if count != 1 else ''} "
        f"for {len(plan['regions'])} trays, {len(plan['picks'])} picks",
        loc="left",
        fontsize=13,
    )
    figure.legend(handles=legend, loc="outside right upper", frameon=False, fontsize=9)
    return _save(figure, path)


def write_regions(plan: dict[str, Any], path: Path) -> Path:
    """Small multiples: the base region of each tray by itself."""
    count = max(1, len(plan["regions"]))
    columns = min(3, count)
    rows = -(-count // columns)
    figure = _pyplot()(4.2 * columns, 3.4 * rows)
    names = [tray["name"] for tray in plan["scenario"]["trays"]]
    for number, region in enumerate(plan["regions"], start=1):
        axes = figure.add_subplot(rows, columns, number)
        axes.set_facecolor(FLOOR)
        index = names.index(region["tray"])
        mask = region_mask(plan, region)
        _draw_mask(axes, plan, mask, tray_colour(index), 0.7)
        _draw_bodies(axes, plan)
        _label_tray(axes, plan["scenario"]["trays"][index], index)
        _room_limits(axes, plan)
        area = int(mask.sum()) * plan["grid"]["resolution"] ** 2
        axes.set_title(f"tray {region['tray']}: {int(mask.sum())} cells, {area:.2f} m²", fontsize=10, loc="left")
        axes.tick_params(labelsize=7)
    return _save(figure, path)


def stop_camera(scene: PlanScene, base: np.ndarray, width: int = 960, height: int = 700) -> Camera:
    """Looks over the robot's shoulder from the side that is open."""
    forward = np.array([np.cos(base[2]), np.sin(base[2]), 0.0])
    side = np.array([-forward[1], forward[0], 0.0])
    focus = np.array([base[0], base[1], 0.75]) + 0.35 * forward
    low, high = scene.bounds()
    best = max(
        (focus - 1.3 * forward * s1 + side * s2 * 2.3 + np.array([0, 0, 1.25]) for s1 in (0.6, 1.0) for s2 in (-1, 1)),
        key=lambda eye: min(*(eye[:2] - low), *(high - eye[:2]), 0.5),
    )
    return Camera(best, focus, width, height)


def write_stop(scene: PlanScene, stop: int, time: float, path: Path) -> Path:
    """The robot at a stop as it grasps, rendered."""
    state = scene.timeline.state_at(time)
    return png.write_png(path, render(scene.at(state), stop_camera(scene, state.base), background="#F7F7F5"))


def write_scene(plan: dict[str, Any], path: str | Path, time: float | None = None) -> Path:
    """One rendered picture of the plan at a time [s]; by default when the first part is reached."""
    scene = PlanScene(plan)
    if time is None:
        grasps = scene.timeline.grasp_times()
        time = grasps[0][1] if grasps else 0.0
    state = scene.timeline.state_at(time)
    return png.write_png(path, render(scene.at(state), stop_camera(scene, state.base), background="#F7F7F5"))


def write_pick_curves(plan: dict[str, Any], index: int, path: Path) -> Path:
    """Joint positions of one pick over time, its motions marked."""
    pick = plan["picks"][index]
    figure = _pyplot()(9, 4.6)
    axes = figure.add_subplot()
    clock = 0.0
    lines = None
    for motion in pick["motions"]:
        times = clock + np.asarray(motion["times"], float)
        positions = np.asarray(motion["positions"], float)
        axes.set_prop_cycle(None)
        lines = axes.plot(times, positions, linewidth=1.6)
        axes.axvline(times[-1], color="#bbbbbb", linewidth=0.8)
        axes.text((times[0] + times[-1]) / 2, 1.02, motion["kind"], transform=axes.get_xaxis_transform(), ha="center",
                  fontsize=8)  # fmt: skip
        clock = times[-1]
    axes.set_xlabel("time [s]")
    axes.set_ylabel("joint position [rad or m]")
    axes.set_title(f"pick 1: {pick['part']}", loc="left", fontsize=11, pad=18)
    if lines:
        figure.legend(lines, plan["scenario"]["arm"]["joints"], loc="outside right upper", frameon=False, fontsize=8)
    return _save(figure, path)
