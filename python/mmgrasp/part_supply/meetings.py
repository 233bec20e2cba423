"""When two robots on their courses would be too close: for each piece of one and each of the other, the pairs of times that are not proven safe."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .course import Array, Course, Element

Cells = NDArray[np.float64]
"""(k, 5): from and to when of the first element's own clock, the same of the second's [s], and whether it is proven that they are too close (1) or only not
that they are not (0)."""

FINEST = 0.01  # a cell in which points move no farther is not halved [m]
_POLL = 200  # cells between two calls of the function that a caller may interrupt by


class Meetings:
    """Which pairs of times of two courses are unsafe. The answers are kept: each pair of elements is measured once."""

    def __init__(self, first: Course, second: Course, clearance: float, poll: Callable[[], None]) -> None:
        self._first, self._second, self._clearance, self._poll = first, second, clearance, poll
        self._known: dict[tuple[int, int], Cells] = {}
        self.far_apart = _far_apart(first, second, clearance)
        """Pairs of elements that cannot meet, by their indices."""
        self.measured = 0
        """How many times distances were computed."""

    def unsafe(self, i: int, j: int) -> Cells:
        """Cells of element `i` of the first course and element `j` of the second."""
        if self.far_apart[i, j]:
            return np.zeros((0, 5))
        if (i, j) not in self._known:
            self._known[i, j] = self._measure(self._first.elements[i], self._second.elements[j])
        return self._known[i, j]

    def known(self, i: int, j: int) -> Cells:
        """The same as far as it was asked for before."""
        return self._known.get((i, j), np.zeros((0, 5)))

    def _measure(self, a: Element, b: Element) -> Cells:
        """Halves the rectangle of both clocks until each cell is proven safe or unsafe, or little moves in it.

        From the middle of a cell no point of a body moves farther than its way in the cell: the distance there, less the ways of both, is what is left
        everywhere in it, and no more than the distance with the ways added. For the second, what the arms do not move is looked at first: it moves least.
        """
        out = []
        cells = [(0, len(a.times) - 1, 0, len(b.times) - 1)]
        trunks_stand = a.trunk_way[-1] == 0.0 and b.trunk_way[-1] == 0.0
        if trunks_stand and self._trunks_meet(a, b, *cells[0]):
            return np.array([(0.0, a.times[-1], 0.0, b.times[-1], 1.0)])
        while cells:
            i0, i1, j0, j1 = cell = cells.pop()
            i, j = (i0 + i1) // 2, (j0 + j1) // 2
            way_a, way_b = _way(a.way, i0, i, i1), _way(b.way, j0, j, j1)
            needed = self._clearance + way_a + way_b
            bases = float(np.hypot(*(a.base[i, :2] - b.base[j, :2])))
            if bases - a.radius - b.radius >= needed:
                continue
            self._count()
            distance = a.at(i).distance(b.at(j), needed)
            if distance >= needed:
                continue
            sure = distance + way_a + way_b < self._clearance
            sure = sure or (not trunks_stand and distance < self._clearance and self._trunks_meet(a, b, *cell))
            smallest = way_a + way_b <= FINEST or (i1 - i0 <= 1 and j1 - j0 <= 1)
            if sure or smallest:
                out.append((a.times[i0], a.times[i1], b.times[j0], b.times[j1], float(sure)))
            elif j1 - j0 <= 1 or (i1 - i0 > 1 and way_a >= way_b):
                cells += [(i0, i, j0, j1), (i, i1, j0, j1)]
            else:
                cells += [(i0, i1, j0, j), (i0, i1, j, j1)]
        return np.array(out).reshape(-1, 5)

    def _trunks_meet(self, a: Element, b: Element, i0: int, i1: int, j0: int, j1: int) -> bool:
        """Whether what the arms do not move is too close all over a cell."""
        i, j = (i0 + i1) // 2, (j0 + j1) // 2
        ways = _way(a.trunk_way, i0, i, i1) + _way(b.trunk_way, j0, j, j1)
        self._count()
        return a.trunk_at(i).distance(b.trunk_at(j), self._clearance) + ways < self._clearance

    def _count(self) -> None:
        self.measured += 1
        if self.measured % _POLL == 0:
            self._poll()


def _way(way: Array, first: int, middle: int, last: int) -> float:
    """How far points may be from where they are in the middle."""
    return float(max(way[last] - way[middle], way[middle] - way[first]))


def _far_apart(first: Course, second: Course, clearance: float) -> NDArray[np.bool_]:
    """The quick test: elements whose bodies stay in discs that are farther apart than the clearance, (elements, elements)."""
    a, b = _discs(first), _discs(second)
    between = np.hypot(a[:, None, 0] - b[None, :, 0], a[:, None, 1] - b[None, :, 1])
    out: NDArray[np.bool_] = between - a[:, None, 2] - b[None, :, 2] >= clearance
    return out


def _discs(course: Course) -> Array:
    """Middle of the base's way (x, y) and radius of a disc that holds the body all along, one row an element."""
    rows = []
    for element in course.elements:
        low, high = element.base[:, :2].min(axis=0), element.base[:, :2].max(axis=0)
        rows.append([*(0.5 * (low + high)), 0.5 * float(np.hypot(*(high - low))) + element.radius])
    return np.array(rows)
