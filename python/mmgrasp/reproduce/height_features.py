"""Height accumulated features (Fischinger, Weiss and Vincze, IJRR 2015), the baseline of P3 table 4.2.

A window of 14 x 14 cells of a centimetre holds the highest point of each cell. Features are differences between the
mean heights of a rectangle and of one around or beside it, and by how much a bar rises above two alike on either side of
it. The published machine that chooses by them was trained on windows labelled by hand and is not at hand. This one is
linear and is trained by a fixed rule: windows of drawn boxes and cylinders, labelled by whether a hand that closes there
would hold, as their exact heights say.
"""

from __future__ import annotations

import functools
import itertools
from dataclasses import dataclass

import numpy as np

from .._core import Grasp, Hand, HeightMap

CELL, SIDE = 0.01, 14  # of the window; rows lie along the pads' width, columns along the closing direction
FINE = 0.002  # cells of drawn heaps, for the labels [m]
ROLLS = 12  # over half a turn, every 15 degrees as published
WINDOWS, RIDGE = 6000, 0.01  # of the training; what is added to the features' covariance
LOWEST = 0.003  # of the fingertips above the table [m]
GROUND = 0.004  # heights below are the table [m]
Span = tuple[int, int]
Region = tuple[Span, Span]  # rows, columns


@functools.cache
def pairs() -> list[tuple[Region, Region]]:
    """An outer rectangle and one within it, both about the window's middle row."""
    wide = [(k, SIDE - k) for k in range(6)] + [(k, 9) for k in range(4)] + [(5, SIDE - k) for k in range(4)]
    out = []
    for half, span, inner, less in itertools.product((1, 2, 3, 5, 7), wide, ((4, 10), (5, 9), (6, 8)), (0, 1)):
        rows, within = (7 - half, 7 + half), (7 - half + less, 7 + half - less)
        if within[0] < within[1] and span[0] <= inner[0] and inner[1] <= span[1] and (rows, span) != (within, inner):
            out.append(((rows, span), (within, inner)))
    return out


@functools.cache
def bars() -> list[tuple[Region, Region, Region]]:
    """A bar across the closing direction in the window's middle, and one alike on either side."""
    out = []
    for half, middle, width, gap in itertools.product((2, 3, 5), ((5, 9), (6, 8)), (1, 2), (0, 1)):
        rows, (first, last) = (7 - half, 7 + half), middle
        out.append((
            (rows, (first - gap - width, first - gap)), (rows, middle), (rows, (last + gap, last + gap + width)),
        ))  # fmt: skip
    return out


def features(heights: np.ndarray) -> np.ndarray:
    """Features (ny - 13, nx - 13, count) of every window of a grid of heights (ny, nx) in cells' edges."""
    total = np.zeros((heights.shape[0] + 1, heights.shape[1] + 1))
    total[1:, 1:] = heights.cumsum(axis=0).cumsum(axis=1)
    ny, nx = heights.shape[0] - SIDE + 1, heights.shape[1] - SIDE + 1

    @functools.cache
    def mean(region: Region) -> np.ndarray:
        (r0, r1), (c0, c1) = region
        corner = [total[r : r + ny, c : c + nx] for r, c in ((r1, c1), (r0, c1), (r1, c0), (r0, c0))]
        return np.asarray((corner[0] - corner[1] - corner[2] + corner[3]) / ((r1 - r0) * (c1 - c0)))

    out = [mean(inner) - mean(outer) for outer, inner in pairs()]
    for left, middle, right in bars():
        rise = np.minimum(mean(middle) - mean(left), mean(middle) - mean(right))
        out.append(np.where(rise > 0, rise, -1.0))
    return np.stack(out, axis=-1)


# --- training ---------------------------------------------------------------------------------------------------------
def drawn_heap(rng: np.random.Generator) -> np.ndarray:
    """Heights of one to three boxes and cylinders over a window in fine cells [m]."""
    count = round(SIDE * CELL / FINE)
    at = FINE * (np.arange(count) - (count - 1) / 2)
    y, x = np.meshgrid(at, at, indexing="ij")
    out = np.zeros((count, count))
    for k in range(rng.integers(1, 4)):
        middle = rng.normal(0, 0.015, 2) if k == 0 else rng.uniform(-0.09, 0.09, 2)
        turn, height = rng.uniform(0, np.pi), rng.uniform(0.012, 0.10)
        u = np.cos(turn) * (x - middle[0]) + np.sin(turn) * (y - middle[1])
        v = np.cos(turn) * (y - middle[1]) - np.sin(turn) * (x - middle[0])
        if rng.uniform() < 0.7:
            covered = (np.abs(u) < rng.uniform(0.006, 0.045)) & (np.abs(v) < rng.uniform(0.015, 0.09))
        else:
            covered = np.hypot(u, v) < rng.uniform(0.01, 0.05)
        out[covered] = np.maximum(out[covered], height)
    return out


def holds(heap: np.ndarray, hand: Hand, friction: float) -> bool:
    """Whether a hand over the window's middle that closes along the columns goes down and holds what is there.

    The pads are as high as the middle of the heap's box (P3 4.8.4). Fingers go down freely; on every line between the
    pads there is something as high as their middle; on either side it lies askew by no more than friction takes.
    """
    count = len(heap)
    at = FINE * (np.arange(count) - (count - 1) / 2)
    middle = pad_height(float(heap.max()), hand)
    rows = np.abs(at) < hand.finger_width / 2
    finger = (np.abs(at) >= hand.max_opening / 2) & (np.abs(at) < hand.max_opening / 2 + hand.body.finger_thickness)
    if (heap[np.ix_(rows, finger)] > middle - hand.finger_depth / 2).any():
        return False
    solid = heap[np.ix_(rows, np.abs(at) < hand.max_opening / 2)] > middle
    if not solid.any(axis=1).all():
        return False
    sides = np.array([solid.argmax(axis=1), solid[:, ::-1].argmax(axis=1)]) * FINE
    return bool((np.ptp(sides, axis=1) <= friction * np.ptp(at[rows]) + FINE).all())


def pad_height(highest: float, hand: Hand) -> float:
    """Height of the pads' middle over the table [m]: half the object's, but not so low that the tips meet the table."""
    return max(highest / 2, LOWEST + hand.finger_depth / 2)


@dataclass(frozen=True)
class Machine:
    """A linear machine on standardised features."""

    mean: np.ndarray
    scale: np.ndarray
    weights: np.ndarray
    bias: float

    def scores(self, found: np.ndarray) -> np.ndarray:
        """Scores of features (..., count); above 0: would hold."""
        return np.asarray(((found - self.mean) / self.scale) @ self.weights + self.bias)


def drawn_windows(count: int, hand: Hand, friction: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Features (count, ...) and labels of windows of drawn heaps."""
    rng = np.random.default_rng(seed)
    found, good = [], []
    for _ in range(count):
        heap = drawn_heap(rng)
        cells = heap.reshape(SIDE, len(heap) // SIDE, SIDE, len(heap) // SIDE).max(axis=(1, 3))
        found.append(features(cells / CELL)[0, 0])
        good.append(holds(heap, hand, friction))
    return np.array(found), np.array(good)


def trained(hand: Hand, friction: float) -> Machine:
    """Least squares to 1 and -1 with a ridge, classes of one weight (linear least squares SVM, Suykens 1999)."""
    found, good = drawn_windows(WINDOWS, hand, friction, seed=1)
    share = np.where(good, 0.5 / good.sum(), 0.5 / (~good).sum())
    mean = share @ found
    scale = np.sqrt(share @ (found - mean) ** 2) + 1e-9
    standard, wanted = (found - mean) / scale, np.where(good, 1.0, -1.0)
    covariance = standard.T @ (share[:, None] * standard) + RIDGE * np.eye(standard.shape[1])
    return Machine(mean, scale, np.linalg.solve(covariance, standard.T @ (share * wanted)), float(share @ wanted))


# --- choosing ---------------------------------------------------------------------------------------------------------
def turned_grid(heights: HeightMap, roll: float) -> tuple[np.ndarray, np.ndarray]:
    """The highest point of each cell of a centimetre, columns along `roll`, in cells' edges; its first corner [m]."""
    rise = np.nan_to_num(np.asarray(heights.height, dtype=float))
    ny, nx = rise.shape
    x = heights.resolution * (np.arange(nx) - (nx - 1) / 2)
    y = heights.resolution * (np.arange(ny) - (ny - 1) / 2)
    on = rise > GROUND
    px, py = np.broadcast_to(x, rise.shape)[on], np.broadcast_to(y[:, None], rise.shape)[on]
    u, v = np.cos(roll) * px + np.sin(roll) * py, np.cos(roll) * py - np.sin(roll) * px
    first = np.array([v.min(), u.min()]) - SIDE // 2 * CELL  # windows' middles reach from end to end of what is there
    row, column = (np.floor((w - f) / CELL).astype(int) for w, f in ((v, first[0]), (u, first[1])))
    grid = np.zeros((row.max() + SIDE // 2 + 1, column.max() + SIDE // 2 + 1))
    np.maximum.at(grid, (row, column), rise[on])
    return grid / CELL, first


def choose(heights: HeightMap, hand: Hand, machine: Machine, most: int = 40) -> list[Grasp]:
    """Grasps straight from above by descending score, in the frame of the map.

    Places of each roll count with their eight neighbours, since a hand is hardly ever where it should be.
    """
    rise = np.nan_to_num(np.asarray(heights.height, dtype=float))
    if not (rise > GROUND).any():
        return []
    height = pad_height(float(rise.max()), hand)
    found = []
    for k in range(ROLLS):
        roll = np.pi * k / ROLLS
        grid, first = turned_grid(heights, roll)
        score = machine.scores(features(grid))
        ny, nx = score.shape
        around = np.pad(score, 1, mode="edge")
        score = np.mean([around[i : i + ny, j : j + nx] for i in range(3) for j in range(3)], axis=0)
        for at in np.argsort(-score, axis=None)[:most]:
            row, column = np.unravel_index(at, score.shape)
            v, u = first + CELL * (np.array([row, column]) + SIDE / 2)
            found.append((float(score[row, column]), roll, float(u), float(v)))
    found.sort(key=lambda each: -each[0])
    return [_grasp(hand, height, *each) for each in found[:most]]


def _grasp(hand: Hand, height: float, score: float, roll: float, u: float, v: float) -> Grasp:
    down, across = np.array([0.0, 0, -1]), np.array([np.cos(roll), np.sin(roll), 0.0])
    T = np.eye(4)
    own = np.column_stack([hand.approach, hand.closing, np.cross(hand.approach, hand.closing)])
    T[:3, :3] = np.column_stack([down, across, np.cross(down, across)]) @ own.T
    T[:3, 3] = [np.cos(roll) * u - np.sin(roll) * v, np.sin(roll) * u + np.cos(roll) * v, height]
    return Grasp(T, hand.min_opening, quality=float(np.clip(0.5 + 0.5 * score, 0, 1)))
