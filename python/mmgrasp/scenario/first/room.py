"""A first room: a counter with two trays of parts, before a wall or in a free place of a floor map, where the robot reaches them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._core import CollisionChecker, Hand, InvalidInput, JointGroup, LinkShape, Outcome, World, pose
from ..._progress import Progress
from .standing import Outline, looking_down

TRAY = np.array([0.30, 0.40, 0.06])
COUNTER = np.array([0.50, 1.60])  # depth, width [m]
_HEIGHTS = (0.72, 0.6, 0.85, 0.45, 0.95, 0.3, 0.15, 0.05)  # of the counter above the ground, the likeliest first [m]
_EDGE = 0.03  # a tray stands so far behind the counter's front [m]
_BETWEEN = 0.80  # from tray to tray [m]
_GAPS = (0.06, 0.12, 0.2, 0.3)  # between the base and the counter [m]
_ASIDE = (0.0, -0.25, 0.25, -0.45, 0.45)  # where the base stands beside the tray's middle [m]
_TURNS = 4
_ENOUGH = 0.7  # share of the tried grasps that one place of the base must reach
_ROOM = 0.10  # around the turning base that is kept free on a map [m]
_AHEAD = 1.2  # start and goal lie so far before the counter in an empty room [m]


@dataclass
class Part:
    """A box that the hand can hold."""

    size: np.ndarray


@dataclass
class Room:
    """Where everything stands. Poses of base and counter are x, y, heading; the counter's is that of the base in front of it."""

    height: float  # of the counter above the ground [m]
    reached: float  # share of the tried grasps that the best place of the base reaches
    counter: np.ndarray
    start: np.ndarray
    goal: np.ndarray
    doubts: list[str]


def fitting_part(hand: Hand) -> Part:
    """A box that the hand takes with room to spare: half of its opening wide, at most 5 cm."""
    free = hand.max_opening - 2 * hand.clearance
    if free < 0.004:
        raise InvalidInput(
            f"the hand opens {hand.max_opening * 1000:.1f} mm, less than its clearance of {hand.clearance * 1000:.0f} mm on either side and a part "
            "of 4 mm: state a smaller clearance, or another hand"
        )
    width = round(min(0.6 * free, 0.05), 3)
    return Part(np.array([width, round(1.4 * width, 3), max(0.06, round(1.2 * width, 3))]))


def counter_height(
    group: JointGroup, hand: Hand, home: np.ndarray, outline: Outline, part: Part, progress: Progress = None
) -> tuple[float, float]:
    """Height of the counter [m], and the share of grasps from above of a tray's corners and middle that the arm reaches there from the best place of the base.

    The first of the usual heights where that share is enough, else the best.
    """
    tries = []
    for i, height in enumerate(_HEIGHTS):
        if progress is not None:
            progress("looking for a height of the counter", i / len(_HEIGHTS))
        tries.append((_reached(group, hand, home, outline, part, height), height))
        if tries[-1][0] >= _ENOUGH:
            break
    reached, height = next((t for t in tries if t[0] >= _ENOUGH), max(tries))
    return height, reached


def _reached(group: JointGroup, hand: Hand, home: np.ndarray, outline: Outline, part: Part, height: float) -> float:
    ground = float(outline.low[2])
    best = 0.0
    for gap in _GAPS:
        world = World()
        front = outline.high[0] + gap
        middle = [front + COUNTER[0] / 2, 0.0, ground + height / 2]
        world.add_box("counter", [COUNTER[0], 3 * COUNTER[1], height], pose(middle))
        world.add_floor(group, ground)
        if not CollisionChecker(group.robot, world, group).is_free(home):
            continue
        for aside in _ASIDE:
            found = tried = 0
            for x in (-0.08, 0.08):
                for y in (-0.12, 0.0, 0.12):
                    point = np.array(
                        [front + _EDGE + TRAY[0] / 2 + x, aside + y, ground + height + 0.006 + part.size[2] * 0.75]
                    )
                    good = 0
                    for turn in range(_TURNS):
                        T = looking_down(hand, point, 2 * np.pi * turn / _TURNS)
                        good += group.ik(T, home, world, restarts=6).outcome == Outcome.solved
                    tried += 1
                    found += good > 0
            best = max(best, found / tried)
            if best >= _ENOUGH:
                return best
    return best


def place_room(outline: Outline, walls: list[LinkShape] | None) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[str]]:
    """Poses x, y, heading of the counter (the middle of its floor), of start and of goal; what is doubtful about them."""
    reach = float(np.linalg.norm(np.maximum(np.abs(outline.low[:2]), np.abs(outline.high[:2]))))
    if walls is None:
        front = outline.high[0] + _AHEAD
        counter = np.array([front + COUNTER[0] / 2, 0.0, 0.0])
        return counter, np.array([0.0, -COUNTER[1] / 2, 0.0]), np.array([0.0, COUNTER[1] / 2, 0.0]), []
    return _place_on_map(reach, outline, walls)


def _place_on_map(
    reach: float, outline: Outline, walls: list[LinkShape]
) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[str]]:
    grid = _Grid(walls)
    free = grid.free(reach + _ROOM)
    if not free.any():
        raise InvalidInput(
            f"the map has no free place of {2 * (reach + _ROOM):.2f} m across, which the base needs: look at its resolution, or at `unknown`"
        )
    largest = grid.largest_piece(free)
    along = outline.high[0] + 0.15 + COUNTER[0] / 2  # from the base before it to the counter's middle
    best = None
    for heading in np.arange(8) * np.pi / 4:
        ahead = np.array([np.cos(heading), np.sin(heading)])
        cells = grid.middles(largest)
        middle = cells + along * ahead
        room = grid.rectangle_free(middle, heading, COUNTER + 0.06)
        behind = grid.taken(middle + (COUNTER[0] / 2 + 0.3) * ahead)  # with its back to a wall it is out of the way
        for k in np.flatnonzero(room & behind)[:1].tolist() or np.flatnonzero(room)[:1].tolist():
            candidate = (not behind[k], heading, np.array([*middle[k], heading]), cells[k])
            if best is None or candidate[:2] < best[:2]:
                best = candidate
    if best is None:
        raise InvalidInput(
            f"the map has no free place for a counter of {COUNTER[0]:g} x {COUNTER[1]:g} m with the base before it"
        )
    _, heading, counter, before = best
    left = largest & ~grid.near_rectangle(counter, COUNTER + 2 * (reach + _ROOM))
    left = grid.piece_of(left, before) if left.any() else left
    if not left.any():
        return (
            counter,
            np.array([*before, heading]),
            np.array([*before, heading]),
            ["start and goal are one: the map has no second free place"],
        )
    cells = grid.middles(left)
    far = np.linalg.norm(cells - before, axis=1)
    start, goal = cells[np.argmin(np.abs(far - 2.0))], cells[np.argmin(np.abs(far - 3.0))]
    return counter, np.array([*start, heading]), np.array([*goal, heading]), []


def tray_poses(counter: np.ndarray, top: float) -> list[np.ndarray]:
    """x, y, z, heading of the floors of two trays side by side at the front edge of a counter whose top is so high [m]."""
    c, s = np.cos(counter[2]), np.sin(counter[2])
    back = -COUNTER[0] / 2 + _EDGE + TRAY[0] / 2
    return [
        np.array([counter[0] + c * back - s * side, counter[1] + s * back + c * side, top + 0.006, counter[2]])
        for side in (-_BETWEEN / 2, _BETWEEN / 2)
    ]


class _Grid:
    """A map's walls as cells that are taken."""

    def __init__(self, walls: list[LinkShape], edge: float = 0.05) -> None:
        bounds = [wall.bounds for wall in walls]
        self.low = np.min([b[0][:2] for b in bounds], axis=0)
        high = np.max([b[1][:2] for b in bounds], axis=0)
        self.edge = max(edge, float((high - self.low).max()) / 1000)
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
        k = np.floor((points - self.low) / self.edge).astype(int)
        inside = ((k >= 0) & (k < self.shape)).all(axis=1)
        k = np.clip(k, 0, self.shape - 1)
        return np.asarray(~inside | self.solid[k[:, 0], k[:, 1]])

    def rectangle_free(self, middles: np.ndarray, heading: float, size: np.ndarray) -> np.ndarray:
        """(n,) whether a rectangle there meets no taken cell: looked at on a grid of points at half a cell."""
        good = np.ones(len(middles), dtype=bool)
        x, y = (np.linspace(-s / 2, s / 2, int(np.ceil(2 * s / self.edge)) + 1) for s in size)
        c, s = np.cos(heading), np.sin(heading)
        for dx in x:
            for dy in y:
                k = np.flatnonzero(good)
                good[k] &= ~self.taken(middles[k] + [c * dx - s * dy, s * dx + c * dy])
        return good

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
            piece = _flood(left, np.argwhere(left)[0])
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
