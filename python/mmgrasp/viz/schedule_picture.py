"""A schedule of several robots as a picture: what each does when, and the floor with their ways and the areas that they share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..part_supply.schedule import Schedule
from .pictures import _pyplot, _save
from .style import OBSTACLE, tray_colour
from .topview import footprint

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_WAIT = "#FFFFFF"
_HEIGHT = 0.36  # half of a bar


def write_schedule_picture(schedule: Schedule, path: Path) -> Path:
    """Above, one row a robot on the clock of all: drives dark, picks light, waits hatched, and in grey when it is in an area that it shares. Below, the room
    from above with each robot's way and the areas, numbered as above."""
    count = len(schedule.robots)
    fig = _pyplot()(9.0, 6.2 + 0.7 * count)
    clock, floor = fig.subplots(2, 1, gridspec_kw={"height_ratios": [0.8 + 0.7 * count, 5.0]})
    _draw_clock(schedule, clock)
    _draw_floor(schedule, floor)
    return _save(fig, path)


def _draw_clock(schedule: Schedule, axis: Axes) -> None:
    last = max(robot.end for robot in schedule.robots)
    for i, robot in enumerate(schedule.robots):
        for wait, start, piece in zip(robot.waits(), robot.starts, robot.course.pieces, strict=True):
            if wait > 0:
                axis.barh(i, wait, 2 * _HEIGHT, left=start - wait, color=_WAIT, edgecolor=tray_colour(i), hatch="///")
            alpha = 1.0 if piece.name.startswith("drive") else 0.45
            axis.barh(i, piece.duration, 2 * _HEIGHT, left=start, color=tray_colour(i), alpha=alpha, linewidth=0)
    for k, area in enumerate(schedule.areas):
        for i, windows in zip(area.robots, area.windows, strict=True):
            for begin, end in windows:
                axis.plot([begin, min(end, last)], [i - _HEIGHT - 0.05] * 2, color="#555555", linewidth=2.5)
            middle = 0.5 * (windows[0][0] + min(windows[-1][1], last))
            axis.text(middle, i - _HEIGHT - 0.07, str(k + 1), fontsize=7, ha="center", va="bottom")
    axis.set(xlim=(0, last), yticks=range(len(schedule.robots)), xlabel="time [s]")
    axis.set_yticklabels([f"robot {i + 1}" for i in range(len(schedule.robots))])
    axis.set_ylim(len(schedule.robots) - 0.4, -0.75)
    axis.set_title("drives dark, picks light, waits hatched; lines: in the shared area of that number", fontsize=9)


def _draw_floor(schedule: Schedule, axis: Axes) -> None:
    scenario = schedule.robots[0].course.plan["scenario"]
    for body in scenario["obstacles"]:
        for outline in footprint(body["shapes"], body["pose"]):
            axis.fill(*outline.T, color=OBSTACLE, linewidth=0)
    for i, robot in enumerate(schedule.robots):
        way = np.vstack([element.base[:, :2] for element in robot.course.elements])
        axis.plot(*way.T, color=tray_colour(i), linewidth=1.8, label=f"robot {i + 1}")
        axis.plot(*way[0], marker="o", color=tray_colour(i), markersize=6)
        axis.plot(*way[-1], marker="s", color=tray_colour(i), markersize=6)
    for k, area in enumerate(schedule.areas):
        (x0, y0), (x1, y1) = area.low, area.high
        corners = np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]])
        axis.plot(*corners.T, color="#555555", linewidth=1.0, linestyle="--")
        axis.annotate(str(k + 1), (x0, y1), fontsize=9, ha="left", va="bottom")
    axis.set(xlabel="x [m]", ylabel="y [m]")
    axis.set_aspect("equal")
    axis.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.02, 1.0))
    axis.set_title(
        f"ways of the bases, from circle to square; at least {schedule.clearance:g} m between the robots", fontsize=9
    )
