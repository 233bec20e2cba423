"""What a map of surfaces holds, as boxes: one body for each object to be picked, and one for all the rest.

Boxes go into a plan as they are, so that the plan needs the map only to be checked against it.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from .._core import Box, LinkShape, ProbabilisticSdf, pose

COLUMN = 0.001  # side of an object's columns [m]
STEP = 0.002  # their heights are rounded up to steps of this [m]
AROUND = 0.006  # around an object's rectangle, within which the surface is its own [m]
ABOVE = 0.02  # above an object's box, up to which it is looked for [m]
_LONGEST = 300  # columns along a side; of larger objects they are wider
LEAST_PIECE = 50  # vertices; smaller pieces of surface are noise that hangs in the air
_MOST_CELLS = 5_000_000  # looked at around the points of a surface, where they overlap several times
_MOST_BOXES = 3000  # of the rest; its cells are made larger until there are no more


@dataclass(frozen=True)
class Footprint:
    """Where an object stands: its box in the tray's frame."""

    T_tray_box: np.ndarray
    size: np.ndarray

    def outside(self, xy: np.ndarray) -> np.ndarray:
        """How far points (n, 2) are outside of the rectangle [m]; 0 inside."""
        R = self.T_tray_box[:2, :2]
        local = np.abs((xy - self.T_tray_box[:2, 3]) @ R) - self.size[:2] / 2
        return np.asarray(np.linalg.norm(np.maximum(local, 0), axis=1))


def object_boxes(
    sdf: ProbabilisticSdf,
    T_world_tray: np.ndarray,
    inner: np.ndarray,
    index: int,
    footprints: list[Footprint],
    bottom: float,
    tolerance: float,
    sigmas: float,
) -> list[LinkShape]:
    """Columns from `bottom` [m] above the tray's floor up to the highest place where mean - sigmas * sigma is zero or less,
    over what belongs to one footprint: it lies around it, and no other is nearer. In the tray's frame.

    `inner` (2,): sides of the tray's floor [m]. What the map has up to `tolerance` above the floor is the floor [m]. What an
    object hides below itself counts as part of it; faces of columns lie where the surface does up to half a column.
    """
    own = footprints[index]
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=2))) * own.size[:2]
    corners = corners @ own.T_tray_box[:2, :2].T + own.T_tray_box[:2, 3]
    edge = inner / 2 - COLUMN
    low = np.clip(corners.min(axis=0) - AROUND, -edge, edge)
    high = np.clip(corners.max(axis=0) + AROUND, -edge, edge)
    column = max(COLUMN, float((high - low).max()) / _LONGEST)
    first = np.floor(low / column).astype(int)
    counts = np.maximum(np.ceil(high / column).astype(int) - first, 1)
    x, y = (column * (first[k] + np.arange(counts[k]) + 0.5) for k in (0, 1))
    grid = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    distances = np.stack([f.outside(grid) for f in footprints])
    mine = np.flatnonzero((distances[index] <= AROUND) & (distances.argmin(axis=0) == index))
    heights = np.zeros(len(grid))
    top = own.T_tray_box[2, 3] + own.size[2] / 2 + ABOVE
    for z in np.arange(tolerance + COLUMN / 2, top, COLUMN):  # upwards: the highest one stays
        points = np.column_stack([grid[mine], np.full(len(mine), z)])
        near = sdf.distances(points @ T_world_tray[:3, :3].T + T_world_tray[:3, 3], sigmas)
        with np.errstate(invalid="ignore"):
            heights[mine[near <= 0]] = z + COLUMN / 2
    levels = np.ceil(heights / STEP - 1e-9).astype(int).reshape(counts)
    boxes = []
    for (x0, y0), (x1, y1), level in rectangles(levels):
        lower = np.array([column * (first[0] + x0), column * (first[1] + y0), bottom])
        upper = np.array([column * (first[0] + x1), column * (first[1] + y1), STEP * level])
        boxes.append(LinkShape(Box(upper - lower), pose((lower + upper) / 2)))
    return boxes


def rectangles(levels: np.ndarray) -> list[tuple[tuple[int, int], tuple[int, int], int]]:
    """Rectangles [first, one past the last) of equal positive values that cover an array (nx, ny), each cell once."""
    left = levels.copy()
    out = []
    for x, y in np.argwhere(levels > 0):
        level = left[x, y]
        if level <= 0:
            continue
        y1 = y + 1
        while y1 < left.shape[1] and left[x, y1] == level:
            y1 += 1
        x1 = x + 1
        while x1 < left.shape[0] and (left[x1, y:y1] == level).all():
            x1 += 1
        left[x:x1, y:y1] = 0
        out.append(((int(x), int(y)), (int(x1), int(y1)), int(level)))
    return out


def inside_boxes(points: np.ndarray, shapes: list[LinkShape], T: np.ndarray, grown: float) -> np.ndarray:
    """(n,) whether points lie within one of a body's boxes, or the box around another shape, grown by so much on every side [m]."""
    found = np.zeros(len(points), dtype=bool)
    for shape in shapes:
        T_world_shape = T @ shape.pose
        low, high = LinkShape(shape.shape, T_world_shape).bounds
        open_ = np.flatnonzero(~found)
        near = open_[((points[open_] >= low - 2 * grown) & (points[open_] <= high + 2 * grown)).all(axis=1)]
        if not len(near):
            continue
        low, high = LinkShape(shape.shape).bounds
        local = (points[near] - T_world_shape[:3, 3]) @ T_world_shape[:3, :3]
        found[near] = ((local >= low - grown) & (local <= high + grown)).all(axis=1)
    return found


def large_pieces(triangles: np.ndarray, kept: np.ndarray) -> np.ndarray:
    """(n,) which of the `kept` vertices of a mesh (n,) lie in pieces of at least LEAST_PIECE kept ones that triangles join."""
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    edges = edges[kept[edges].all(axis=1)]
    label = np.arange(len(kept))
    while True:
        low = label.copy()
        for a, b in ((0, 1), (1, 0)):
            np.minimum.at(low, edges[:, a], label[edges[:, b]])
        low = low[low]
        if (low == label).all():
            break
        label = low
    sizes = np.bincount(label[kept], minlength=len(kept))
    return np.asarray(kept & (sizes[label] >= LEAST_PIECE))


def cells_around(points: np.ndarray, radii: np.ndarray, edge: float) -> np.ndarray:
    """(n, 3) indices of the cells of an edge [m] whose middle is within the radius (m,) and a cell of a point (m, 3), each once."""
    homes, reach = _homes(points, radii, edge)
    parts = [np.zeros((0, 3), dtype=np.int64)]
    for k in np.unique(reach):
        span = range(-int(k), int(k) + 1)
        sphere = np.array(
            [o for o in itertools.product(span, repeat=3) if sum(x * x for x in o) <= k * k], dtype=np.int64
        )
        own = np.unique(homes[reach == k], axis=0)
        parts.append(np.unique((own[:, None] + sphere[None]).reshape(-1, 3), axis=0))
    return np.unique(np.concatenate(parts), axis=0)


def edge_for(points: np.ndarray, radii: np.ndarray, edge: float) -> float:
    """The edge, or twice, four times, ... the edge [m], with which cells_around() looks at no more than _MOST_CELLS."""
    while _looked_at(points, radii, edge) > _MOST_CELLS:
        edge *= 2
    return edge


def _looked_at(points: np.ndarray, radii: np.ndarray, edge: float) -> int:
    homes, reach = _homes(points, radii, edge)
    cells = np.unique(np.column_stack([homes, reach]), axis=0)
    return int(((2 * cells[:, 3] + 1) ** 3).sum())


def _homes(points: np.ndarray, radii: np.ndarray, edge: float) -> tuple[np.ndarray, np.ndarray]:
    """The cells of points (m, 3) of an edge [m], and how many cells away from each others are within its radius (m,)."""
    return np.floor(points / edge).astype(np.int64), np.ceil(radii / edge).astype(np.int64)


def cell_boxes(cells: np.ndarray, edge: float) -> list[LinkShape]:
    """Boxes that cover cells (n, 3) of an edge [m]; of larger cells where these would be too many."""
    while True:
        boxes = merged(cells)
        if len(boxes) <= _MOST_BOXES:
            break
        cells, edge = np.unique(cells // 2, axis=0), 2 * edge
    return [LinkShape(Box(edge * (high - low)), pose(edge * (low + high) / 2)) for low, high in boxes]


def merged(cells: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Boxes [first, one past the last) of cells (n, 3): runs along x, then equal runs along y, then along z."""
    boxes = {(*map(int, c), *(int(v) + 1 for v in c)) for c in cells}
    for axis in range(3):
        others = [k for k in range(3) if k != axis]
        rows: dict[tuple[int, ...], list[tuple[int, int]]] = {}
        for box in boxes:
            key = tuple(box[k] for k in (*others, *(k + 3 for k in others)))
            rows.setdefault(key, []).append((box[axis], box[axis + 3]))
        boxes = set()
        for key, spans in rows.items():
            spans.sort()
            begin, end = spans[0]
            for a, b in [*spans[1:], (1 << 40, 1 << 40)]:
                if a == end:
                    end = b
                    continue
                sides = [0] * 6
                for place, value in zip((*others, *(k + 3 for k in others)), key, strict=True):
                    sides[place] = value
                sides[axis], sides[axis + 3] = begin, end
                boxes.add(tuple(sides))
                begin, end = a, b
    return [(np.array(box[:3]), np.array(box[3:])) for box in sorted(boxes)]
