"""Pictures of capability maps: cuts through the voxels and a view of the upper half from outside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .raster import Camera, Scene, render
from .style import FLOOR, OBSTACLE, ROBOT
from .topview import convex_outline

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = "viridis"


def map_values(capability: Any, robot: Any, joints: dict[str, float], boxes: list[dict[str, Any]]) -> dict[str, Any]:
    """What the pictures need of a map, as plain values. `boxes` are {"name", "centre", "size"} in the root frame [m]."""
    index = np.asarray(capability.index)
    filled = np.argwhere(index > 0)
    links = robot.link_poses(joints)
    bodies = []
    for link in robot.links:
        for shape in robot.collisions(link):
            mesh, T = shape.surface(), links[link] @ shape.pose
            vertices = mesh.vertices @ T[:3, :3].T + T[:3, 3]
            bodies.append({"vertices": np.round(vertices, 3).tolist(), "faces": mesh.triangles.tolist()})
    return {
        "lower": [float(v) for v in capability.lower],
        "voxel": float(capability.voxel),
        "shape": [int(n) for n in capability.shape],
        "voxels": [[*map(int, at), round(float(index[tuple(at)]), 3)] for at in filled],
        "bodies": bodies,
        "boxes": boxes,
    }


def grid_of(values: dict[str, Any]) -> np.ndarray:
    """The index of every voxel (nx, ny, nz)."""
    grid = np.zeros(values["shape"])
    for x, y, z, index in values["voxels"]:
        grid[x, y, z] = index
    return grid


def draw_cut(axes: Any, values: dict[str, Any], axis: str, at: float, largest: float) -> Any:
    """One cut across `axis` ("x", "y", "z") at a coordinate [m], with the outlines of robot and boxes; returns the image.

    Boxes that the cut goes through are filled, the robot is its shadow along the axis.
    """
    from matplotlib.patches import Polygon, Rectangle

    across = "xyz".index(axis)
    right, up = (i for i in range(3) if i != across)
    low, edge, shape = values["lower"], values["voxel"], values["shape"]
    cell = int(np.floor((at - low[across]) / edge))
    cut = np.take(grid_of(values), cell, axis=across)
    extent = (low[right], low[right] + edge * shape[right], low[up], low[up] + edge * shape[up])
    for body in values["bodies"]:
        outline = np.array(convex_outline(np.array(body["vertices"])[:, [right, up]]))
        axes.add_patch(Polygon(outline, closed=True, facecolor="#E3E7EB", edgecolor="#9AA3AC", linewidth=0.6, zorder=1))
    image = axes.imshow(
        np.ma.masked_equal(cut, 0).T * 100, origin="lower", extent=extent, cmap=COLOURS, vmin=0, vmax=100 * largest,
        alpha=0.85, zorder=2, interpolation="nearest",
    )  # fmt: skip
    for box in values["boxes"]:
        middle, half = np.array(box["centre"]), np.array(box["size"]) / 2
        through = abs(at - middle[across]) <= half[across]
        axes.add_patch(
            Rectangle(
                (middle[right] - half[right], middle[up] - half[up]), 2 * half[right], 2 * half[up], zorder=3,
                facecolor=OBSTACLE if through else "none", edgecolor="#5A554E", linewidth=0.8,
                linestyle="-" if through else ":",
            )
        )  # fmt: skip
    axes.set_xlim(*extent[:2])
    axes.set_ylim(*extent[2:])
    axes.set_xticks(np.arange(np.ceil(2 * extent[0]), 2 * extent[1] + 1e-9) / 2)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{'xyz'[right]} [m]")
    axes.set_ylabel(f"{'xyz'[up]} [m]")
    centre = low[across] + (cell + 0.5) * edge
    axes.set_title(
        f"cut at {axis} = {at:g} m" + ("" if abs(centre - at) < 1e-9 else f" (voxels around {centre:.2f} m)")
    )
    return image


def space_view(
    values: dict[str, Any], largest: float, eye: tuple[float, float, float] = (3.4, -3.6, 2.9)
) -> np.ndarray:
    """Voxels as octahedra, those in front of the plane y = 0 taken away; uint8 (height, width, 3)."""
    from matplotlib import colormaps
    from matplotlib.colors import to_hex

    scene = Scene()
    low, edge, shape = np.array(values["lower"]), values["voxel"], np.array(values["shape"])
    x0, y0, x1, y1 = low[0], low[1], low[0] + edge * shape[0], low[1] + edge * shape[1]
    steps = 8
    xs, ys = np.linspace(x0, x1, steps + 1), np.linspace(y0, y1, steps + 1)
    floor = np.array([[x, y, min(0.0, low[2])] for x in xs for y in ys])
    corner = np.array([[i * (steps + 1) + j for j in range(steps)] for i in range(steps)]).ravel()
    quads = np.stack([corner, corner + steps + 1, corner + steps + 2, corner + 1], axis=1)
    scene.add(floor, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]), FLOOR)
    for body in values["bodies"]:
        scene.add(np.array(body["vertices"]), np.array(body["faces"]), ROBOT)
    box = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / 2
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([[a, b, c] for a, b, c, _ in sides] + [[a, c, d] for a, _, c, d in sides])
    for item in values["boxes"]:
        scene.add(np.array(item["centre"]) + box * np.array(item["size"]), faces, OBSTACLE)
    tips = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]) * 0.5 * edge
    octahedron = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
    colour = colormaps[COLOURS]
    for level in np.linspace(0, 1, 11)[1:]:  # one body for each tenth of the scale
        chosen = [
            low + edge * (np.array(v[:3]) + 0.5)
            for v in values["voxels"]
            if level - 0.1 < v[3] / largest <= level + 1e-9 and low[1] + edge * (v[1] + 0.5) > 0
        ]
        if not chosen:
            continue
        vertices = np.concatenate([centre + tips for centre in chosen])
        triangles = np.concatenate([octahedron + 6 * i for i in range(len(chosen))])
        scene.add(vertices, triangles, to_hex(colour(level - 0.05)))
    middle = low + edge * shape / 2
    return render(scene, Camera(np.array(eye), middle * [1, 1, 0.9], 900, 900, 33.0))


def figure_of(width: float, height: float, columns: int) -> tuple[Figure, np.ndarray]:
    """A figure without a display, and its axes in a row."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=110, layout="constrained")
    FigureCanvasAgg(figure)
    return figure, figure.subplots(1, columns, squeeze=False).ravel()


def map_figure(values: dict[str, Any], height: float = 0.75, title: str = "") -> Figure:
    """A level cut, the upright cut through the robot's middle, and the half behind it from outside."""
    largest = max((v[3] for v in values["voxels"]), default=1.0)
    figure, axes = figure_of(15.5, 5.4, 3)
    draw_cut(axes[0], values, "z", height, largest)
    image = draw_cut(axes[1], values, "y", 0.0, largest)
    axes[2].imshow(space_view(values, largest))
    axes[2].set_axis_off()
    axes[2].set_title("the half with y > 0, from outside")
    figure.colorbar(image, ax=list(axes), label="reachability index: share of tool poses reached [%]", shrink=0.85)
    if title:
        figure.suptitle(title)
    return figure
