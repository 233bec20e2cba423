"""The goals that the benchmark's table is read against."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """Ours over the peer's `at_most` the bound, or the peer's over ours at least the bound (times, so: how often as fast)."""

    row: str
    ours: str
    peer: str
    bound: float
    at_most: bool = True
    field: str = "value"


GOALS = [
    Goal("FK + Jacobian", "mmgrasp", "pinocchio", 1.0),
    Goal("FK + Jacobian", "mmgrasp batch", "pinocchio", 0.5),
    Goal("FK + Jacobian", "mmgrasp", "KDL", 1.0),
]
