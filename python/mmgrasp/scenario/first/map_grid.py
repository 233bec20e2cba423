"""The free cells of a floor map."""

from __future__ import annotations

import numpy as np

from ..._core import LinkShape

_EDGE = 0.05  # of a cell, unless the map is too large for it [m]
_MOST = 1000  # cells along a side


class MapGrid:
    """A map's walls as cells that are taken."""

    def __init__(self, walls: list[LinkShape], edge: float = _EDGE) -> None:
        bounds = [wall.bounds for wall in walls]
        self.low = np.min([b[0][:2] for b in bounds], axis=0)
        high = np.max([b[1][:2] for b in bounds], axis=0)
        self.edge = max(edge, float((high - self.low).max()) / _MOST)
        self.shape = np.maximum(np.ceil((high - self.low) / self.edge).astype(int), 1)
        self.solid = np.zeros(self.shape, dtype=bool)
        for low, up in bounds:
            a = np.floor((low[:2] - self.low) / self.edge + 1e-6).astype(int)
            b = np.ceil((up[:2] - self.low) / self.edge - 1e-6).astype(int)
            self.solid[a[0] : b[0], a[1] : b[1]] = True

    def free(self, radius: float) -> np.ndarray:
        """Cells around whose middle a disc of this radius [m] is free and inside of the map."""
        n = int(np.ceil(radius / self.edge))
        padded = np.pad(self.solid, n, constant_values=True).astype(np.int32)
        sums = np.pad(np.cumsum(padded, axis=1), ((0, 0), (1, 0)))
        hits = np.zeros(self.shape, dtype=np.int64)
        for dx in range(-n, n + 1):
            w = int(np.floor(np.sqrt(max(n * n - dx * dx, 0))))
            rows = sums[n + dx : n + dx + self.shape[0]]
            hits += rows[:, n + w + 1 : n + w + 1 + self.shape[1]] - rows[:, n - w : n - w + self.shape[1]]
        return np.asarray(hits == 0)

    def middles(self, cells: np.ndarray) -> np.ndarray:
        """Points (n, 2) in the middles of cells [m]."""
        return np.asarray(self.low + (np.argwhere(cells) + 0.5) * self.edge)

    def taken(self, points: np.ndarray) -> np.ndarray:
        """Whether points (n, 2) lie in cells that are taken, or outside."""
        return np.asarray(~self._at(~self.solid, points))

    def rectangle_free(self, middles: np.ndarray, heading: float, size: np.ndarray) -> np.ndarray:
        """(n,) whether a rectangle there meets no taken cell for sure: discs side by side that cover it are free, and what a cell may lie beside its middle."""
        count = int(np.ceil(size[1] / size[0] * 2))
        radius = float(np.linalg.norm([size[0] / 2, size[1] / count / 2])) + 1.5 * self.edge
        free = self.free(radius)
        aside = ((np.arange(count) + 0.5) / count - 0.5) * size[1]
        along = np.array([-np.sin(heading), np.cos(heading)])
        return np.asarray(np.all([self._at(free, middles + y * along) for y in aside], axis=0))

    def _at(self, cells: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Whether points (n, 2) lie in one of the cells; False outside of the map."""
        k = np.floor((points - self.low) / self.edge).astype(int)
        inside = ((k >= 0) & (k < self.shape)).all(axis=1)
        k = np.clip(k, 0, self.shape - 1)
        return np.asarray(inside & cells[k[:, 0], k[:, 1]])

    def near_rectangle(self, place: np.ndarray, size: np.ndarray) -> np.ndarray:
        """Cells whose middle lies in a rectangle at a place x, y, heading."""
        local = self.middles(np.ones(self.shape, dtype=bool)) - place[:2]
        c, s = np.cos(place[2]), np.sin(place[2])
        inside = (np.abs(local @ [c, s]) <= size[0] / 2) & (np.abs(local @ [-s, c]) <= size[1] / 2)
        return np.asarray(inside.reshape(self.shape))

    def piece_of(self, cells: np.ndarray, point: np.ndarray) -> np.ndarray:
        """The connected piece of cells that is nearest to a point."""
        where = np.argwhere(cells)
        nearest = where[np.argmin(np.linalg.norm(self.low + (where + 0.5) * self.edge - point, axis=1))]
        return _flood(cells, nearest)

    def largest_piece(self, cells: np.ndarray) -> np.ndarray:
        """The largest connected piece of cells."""
        left, best = cells.copy(), np.zeros_like(cells)
        while left.any():
            piece = _flood(left, np.array(np.unravel_index(left.argmax(), left.shape)))
            left &= ~piece
            if piece.sum() > best.sum():
                best = piece
        return best


def _flood(cells: np.ndarray, seed: np.ndarray) -> np.ndarray:
    """Cells that neighbours join to a seed."""
    piece = np.zeros_like(cells)
    piece[tuple(seed)] = True
    front = [tuple(int(k) for k in seed)]
    while front:
        x, y = front.pop()
        for a, b in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            if 0 <= a < cells.shape[0] and 0 <= b < cells.shape[1] and cells[a, b] and not piece[a, b]:
                piece[a, b] = True
                front.append((a, b))
    return piece
