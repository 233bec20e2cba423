"""A paper's comparison held against paired runs: confirmed, no difference, or reversed.

Runs of one work cell are no independent draws, so they are averaged first: the pairs are cells. A statement is confirmed
or reversed when the 95 % interval of the mean difference leaves zero out, whichever side; in between there is no
difference that these runs could tell.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Hashable, Iterable
from dataclasses import dataclass

import numpy as np

CONFIRMED, NO_DIFFERENCE, REVERSED = "confirmed", "no difference", "reversed"
ANSWERS = (CONFIRMED, NO_DIFFERENCE, REVERSED)
FEW = 8  # cells that are told one by one


@dataclass(frozen=True)
class Pair:
    """What one run gave both ways; None where a way gave nothing."""

    seed: int
    cell: Hashable
    larger: float | None
    """The value that the paper states to be larger."""
    smaller: float | None


@dataclass(frozen=True)
class Difference:
    """Difference of the larger (by the statement) less the smaller."""

    mean: float
    half: float
    """Half the width of the 95 % interval of the mean."""
    cells: int
    by_seed: dict[int, float]
    by_cell: dict[Hashable, float]

    @property
    def answer(self) -> str:
        if self.mean - self.half > 0:
            return CONFIRMED
        return REVERSED if self.mean + self.half < 0 else NO_DIFFERENCE

    def __str__(self) -> str:
        if len(self.by_seed) == 1 and self.cells <= FEW:
            parts = "; " + ", ".join(f"{cell} {value:+.3g}" for cell, value in self.by_cell.items())
        else:
            parts = "; by seed " + ", ".join(f"{value:+.3g}" for value in self.by_seed.values())
        return f"{self.mean:+.3g} +- {self.half:.2g} ({self.cells} cells{parts})"


def difference(pairs: Iterable[Pair]) -> Difference | None:
    """None with fewer than two cells where both ways gave something."""
    cells: dict[tuple[int, Hashable], list[float]] = defaultdict(list)
    for pair in pairs:
        if pair.larger is not None and pair.smaller is not None:
            cells[pair.seed, pair.cell].append(pair.larger - pair.smaller)
    if len(cells) < 2:
        return None
    means = {key: float(np.mean(found)) for key, found in cells.items()}
    deltas = np.array(list(means.values()))
    by_seed = {
        seed: float(np.mean([mean for (own, _), mean in means.items() if own == seed]))
        for seed in sorted({seed for seed, _ in means})
    }
    half = _student(len(deltas) - 1) * deltas.std(ddof=1) / math.sqrt(len(deltas))
    by_cell = {cell: mean for (_, cell), mean in means.items()} if len(by_seed) == 1 else {}
    return Difference(float(deltas.mean()), float(half), len(deltas), by_seed, by_cell)


def _student(freedom: int) -> float:
    """The two-sided 95 % point of Student's t: printed for few, to 0.3 % otherwise (Cornish-Fisher)."""
    printed = {1: 12.7062, 2: 4.30265, 3: 3.18245}
    if freedom in printed:
        return printed[freedom]
    z = 1.959964
    g1 = (z**3 + z) / 4
    g2 = (5 * z**5 + 16 * z**3 + 3 * z) / 96
    g3 = (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / 384
    return z + g1 / freedom + g2 / freedom**2 + g3 / freedom**3
