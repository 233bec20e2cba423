"""Maps of a floor as ROS's map_server and SLAM programs write them (a YAML file and a PGM image), as boxes that stand on the floor."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .._core import Box, Error, LinkShape, pose
from .._files import read_bytes
from ..documents.reading import Node, read_yaml
from .named_files import find_file

LARGEST_IMAGE = 100_000_000  # [bytes]
MOST_CELLS = 25_000_000
MOST_BOXES = 20_000
_HEADER = re.compile(rb"(P[25])" + 3 * rb"(?:\s|#[^\n]*\n)+(\d{1,9})" + rb"\s")


def read_floor_map(node: Node) -> list[LinkShape]:
    """Boxes of the given `height` on the cells of a map that are occupied; those that nobody saw are, too, unless `unknown: free`."""
    height = node["height"].number(above=0, most=100) if "height" in node else node.lacks("height")
    unknown_too = "unknown" not in node or node["unknown"].choice("occupied", "free") == "occupied"
    root = read_yaml(find_file(node["map"])).root
    root.mapping("image resolution origin negate occupied_thresh free_thresh", "mode")
    resolution = root["resolution"].number(least=1e-3, most=10)
    T_world_map = pose([*(origin := root["origin"].numbers(3))[:2], 0.0], rpy=[0.0, 0.0, origin[2]])
    solid = _solid_cells(root, unknown_too)
    rectangles = min(_rectangles(solid), _transposed(_rectangles(solid.T)), key=len)
    if len(rectangles) > MOST_BOXES:
        node["map"].fail(
            f"makes {len(rectangles)} boxes, at most {MOST_BOXES} are taken: clear speckles from the image, or make its cells larger"
        )
    if not rectangles:
        node["map"].fail("has no occupied cell: look at negate, occupied_thresh and the image")
    shapes = []
    for x0, x1, y0, y1 in rectangles:
        middle = [0.5 * (x0 + x1) * resolution, 0.5 * (y0 + y1) * resolution, 0.5 * height]
        box = Box([(x1 - x0) * resolution, (y1 - y0) * resolution, height])
        shapes.append(LinkShape(box, T_world_map @ pose(middle)))
    return shapes


def _solid_cells(root: Node, unknown_too: bool) -> np.ndarray:
    """Which cells are taken, (rows upwards, columns)."""
    occupied, free = (root[key].number(least=0, most=1) for key in ("occupied_thresh", "free_thresh"))
    if not free < occupied:
        root["free_thresh"].fail(f"must be below occupied_thresh, {occupied:g}")
    if "mode" in root and root["mode"].choice("trinary", "scale", "raw") == "raw":
        root["mode"].fail("values without thresholds are not read: save the map as trinary or scale")
    negate = root["negate"].raw
    if negate not in (0, 1):  # true and false, too
        root["negate"].fail("must be 0 or 1")
    shares, brightest = _read_pgm(root["image"], find_file(root["image"]))
    dark = shares / brightest
    taken = dark if negate else 1 - dark
    return np.flipud(taken >= free if unknown_too else taken > occupied)


def _read_pgm(node: Node, path: Path) -> tuple[np.ndarray, int]:
    """Values of a PGM image, (rows downwards, columns), and the value of white."""
    try:
        data = read_bytes(path, LARGEST_IMAGE)
    except Error as error:
        node.fail(str(error))
    header = _HEADER.match(data)
    if header is None:
        node.fail("must be a PGM image (P2 or P5)")
    width, height, white = (int(number) for number in header.groups()[1:])
    if not (0 < white < 65536 and 0 < width * height <= MOST_CELLS):
        node.fail(f"has {width} x {height} cells and white at {white}: at most {MOST_CELLS} cells, white in [1, 65535]")
    body = data[header.end() :]
    if header.group(1) == b"P2":
        values = _plain_values(node, body)
    else:
        kind = np.dtype(np.uint8 if white < 256 else ">u2")
        values = np.frombuffer(body[: len(body) // kind.itemsize * kind.itemsize], kind)
    if len(values) < width * height:
        node.fail(f"is truncated: {len(values)} of {width * height} cells")
    values = values[: width * height].astype(float).reshape(height, width)
    if values.max() > white:
        node.fail(f"holds a value above its white, {white}")
    return values, white


def _plain_values(node: Node, body: bytes) -> np.ndarray:
    words = body.split()
    if not all(word.isdigit() and len(word) < 6 for word in words):
        node.fail("must hold whole numbers only")
    return np.array([int(word) for word in words])


def _rectangles(solid: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Rectangles that cover the cells, each once: columns [x0, x1), rows [y0, y1). Runs of a row that recur in the next are one."""
    out: list[tuple[int, int, int, int]] = []
    growing: dict[tuple[int, int], int] = {}  # run -> first row
    for y, row in enumerate([*solid, np.zeros(solid.shape[1], dtype=bool)]):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], row, [0]))))
        runs = {(int(a), int(b)) for a, b in edges.reshape(-1, 2)}
        out += [(a, b, first, y) for (a, b), first in growing.items() if (a, b) not in runs]
        growing = {run: growing.get(run, y) for run in sorted(runs)}
    return out


def _transposed(rectangles: list[tuple[int, int, int, int]]) -> list[tuple[int, int, int, int]]:
    return [(y0, y1, x0, x1) for x0, x1, y0, y1 in rectangles]
