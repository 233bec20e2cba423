"""Octrees of OctoMap and clouds of points as obstacles: their occupied cells, put together to few boxes."""

from __future__ import annotations

import numpy as np

from .._core import Box, Error, LinkShape, OccupancyMap, pose, read_pcd
from ..documents.ply_points import read_ply_points
from ..documents.reading import Node
from .map_bodies import merged
from .named_files import find_file

MOST_BOXES = 20_000
_TOLERANCE = 1e-6  # of an edge, by which a cell may stick out of `within`


def read_octree(node: Node) -> list[LinkShape]:
    """Boxes on the occupied leaves of a .bt or .ot file; with `unknown: occupied` on those of `within` that nobody saw, too."""
    within = _within(node)
    unknown = node["unknown"].choice("occupied", "free") if "unknown" in node else "free"
    if unknown == "occupied" and within is None:
        node["unknown"].fail("needs `within`: without bounds all the world around the octree is unknown")
    file = find_file(node["octree"])
    try:
        octree = OccupancyMap.load(file)
        if within is None:
            groups = octree.obstacle_cells(unknown="free")
        else:
            groups = octree.obstacle_cells(unknown="occupied" if unknown == "occupied" else "free", bounds=within)
    except Error as error:
        node["octree"].fail(str(error))
    return _boxes(node["octree"], [(cells.centres, cells.resolution) for cells in groups], within)


def read_cloud(node: Node) -> list[LinkShape]:
    """Boxes on the cells of edge `cell` [m] that hold a point of a PCD file, or a vertex of a PLY file."""
    cell = node["cell"].number(least=1e-3, most=1) if "cell" in node else node.lacks("cell")
    file = find_file(node["cloud"])
    try:
        points = read_ply_points(file) if file.suffix.lower() == ".ply" else read_pcd(file).points
    except Error as error:
        node["cloud"].fail(str(error))
    points = points[np.isfinite(points).all(axis=1)]
    cells = np.unique(np.floor(points / cell), axis=0)
    return _boxes(node["cloud"], [((cells + 0.5) * cell, cell)], _within(node))


def _within(node: Node) -> np.ndarray | None:
    """(2, 3) lower and upper corner, in the file's own frame."""
    if "within" not in node:
        return None
    corners = node["within"].elements()
    if len(corners) != 2:
        node["within"].fail("must be two corners, lower and upper: [[x, y, z], [x, y, z]]")
    bounds = np.array([corner.numbers(3) for corner in corners])
    if not (bounds[0] < bounds[1]).all():
        node["within"].fail("the lower corner must be below the upper one along every axis")
    return bounds


def _boxes(node: Node, groups: list[tuple[np.ndarray, float]], within: np.ndarray | None) -> list[LinkShape]:
    """Boxes that cover cells, given by their centres (n, 3) and edge [m], each cell once; those that reach into `within`."""
    shapes: list[LinkShape] = []
    for centres, edge in groups:
        if within is not None:
            reach = (0.5 - _TOLERANCE) * edge
            centres = centres[((centres > within[0] - reach) & (centres < within[1] + reach)).all(axis=1)]
        for low, high in merged(np.floor(centres / edge).astype(np.int64)):
            shapes.append(LinkShape(Box(edge * (high - low)), pose(edge * (low + high) / 2)))
    if not shapes:
        node.fail("has no occupied cell" + ("" if within is None else " within these bounds"))
    if len(shapes) > MOST_BOXES:
        node.fail(
            f"makes {len(shapes)} boxes, at most {MOST_BOXES} are taken: cut it by `within`, or give it larger cells"
        )
    return shapes
