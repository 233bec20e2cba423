"""The goals that the task's table is read against."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Goal:
    """`field` of the lines of a row is at most, or at least, the bound."""

    row: str
    what: str
    field: str
    bound: float
    at_most: bool = True
    on: str = ""  # how the line's `on` begins; empty: every one
    who: str = "mmgrasp"


GOALS = [
    Goal("reach build", "million poses stored a second, wall", "value", 1.0, at_most=False, on="fetchlike"),
    Goal("reach build", "bytes a pose", "bytes_a_pose", 16.0, on="fetchlike"),
    Goal("reach build", "92 million poses: wall s", "wall_of_92_million", 120.0, on="fetchlike, 119"),
    Goal("reach build", "peak memory [GiB]", "peak_GiB", 4.0, on="fetchlike, 119"),
    Goal("reach build", "opening [s]", "value", 1.0, who="mmgrasp, open"),
    Goal("reach build", "finding a voxel, warm [us]", "value", 1.0, who="mmgrasp, voxel"),
    Goal("reach build", "a voxel's configurations, warm [us]", "value", 1.0, who="mmgrasp, voxel's configurations"),
    Goal("base placement", "times as fast as the quickest scikit-robot", "times_as_fast", 10.0, at_most=False),
    Goal("base placement", "reached and free, more than the best scikit-robot", "more", 0.0, at_most=False),
    Goal(
        "base placement",
        "reached, collisions ignored, more than the best scikit-robot",
        "more",
        0.0,
        at_most=False,
        who="mmgrasp, collisions ignored",
    ),
    Goal("capability map", "wall s", "value", 60.0),
    Goal("capability map", "wall s, stretch", "value", 20.0),
    Goal("capability map, truth", "% classed otherwise than by IK", "value", 0.5),
    Goal("base regions", "times as fast as the paper, wall", "times_as_fast", 10.0, at_most=False),
    Goal("base regions", "seconds a tray over those of 22 trays", "linear", 1.1, on="100 trays"),
    Goal("base regions", "seconds a tray over those of 22 trays", "linear", 1.1, on="500 trays"),
    Goal("region maps", "false cells", "false", 0.0),
    Goal("exact stops", "gap [stops], 60 s", "gap", 0.0, on="row"),
    Goal("exact stops", "gap [stops], 60 s", "gap", 0.0, on="aisle"),
    Goal("exact stops", "gap [stops], 60 s", "gap", 1.0, on="block"),
    Goal("exact stops", "gap [stops], 60 s", "gap", 1.0, on="random"),
    Goal("exact stops", "gap [stops], 60 s", "gap", 1.0, on="overhead"),
    Goal("set cover", "cost above the proven bound", "gap", 0.0),
]
