"""The goals that the benchmark's table is read against."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """Ours over the baseline's at most the bound, or the baseline's over ours at least the bound (times, so: how often as fast).

    Of several baselines whose names begin with `baseline` the best counts. Without a baseline, our own `field` is held against the bound.
    """

    row: str
    ours: str
    baseline: str
    bound: float
    at_most: bool = True
    field: str = "value"
    on: str = ""  # empty: every robot and scene of the row


GOALS = [
    Goal("FK + Jacobian", "mmgrasp", "pinocchio", 1.0),
    Goal("FK + Jacobian", "mmgrasp batch", "pinocchio", 0.5),
    Goal("ik", "mmgrasp", "roboticstoolbox ik_LM", 1.0),
    Goal("ik", "mmgrasp", "TRAC-IK", 0.5, field="p99"),
    Goal("ik", "mmgrasp", "", 0.9995, at_most=False, field="success", on="panda"),
    Goal("ik", "mmgrasp", "", 1.0, at_most=False, field="success", on="ur5"),
    Goal("free or not", "mmgrasp", "FCL", 4.0, at_most=False),
    Goal("free or not", "mmgrasp", "coal", 4.0, at_most=False),
    Goal("edge of 0.5 rad", "mmgrasp", "FCL", 5.0, at_most=False),
    Goal("signed distance", "mmgrasp with gradient", "FCL", 5.0, at_most=False),
    Goal("rays", "mmgrasp", "", 5.0, at_most=False, field="million rays per s", on="mustard bottle, from outside"),
    Goal("rays", "mmgrasp", "", 5.0, at_most=False, field="million rays per s", on="mustard bottle, from its middle"),
    Goal("point cloud", "mmgrasp", "FCL and OctoMap", 3.0, at_most=False),
]
