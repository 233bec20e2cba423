"""Parts of the floor that two robots use within a short time, and when each of them is there."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .course import Array, Element
from .meetings import Cells, Meetings
from .safe_intervals import Interval, merged
from .scheduled_robot import ScheduledRobot, Span


@dataclass(frozen=True)
class SharedArea:
    """A part of the floor in which two robots would be too close if one of them were somewhat earlier or later."""

    robots: tuple[int, int]
    low: tuple[float, float]
    """Lower corner of a rectangle around their bases while they are there (x, y) [m]."""
    high: tuple[float, float]
    windows: tuple[list[Interval], list[Interval]]
    """When each of the two is there, in order; infinite where it stays [s]."""


def shared_areas(
    first: int, second: int, robots: tuple[ScheduledRobot, ScheduledRobot], meetings: Meetings
) -> list[SharedArea]:
    """The areas of two robots, given by their indices, as far as their meetings were asked for."""
    areas: list[SharedArea] = []
    for theirs in robots[0].spans():
        for ours in robots[1].spans():
            cells = meetings.known(theirs.element, ours.element)
            if len(cells):
                areas.append(_area((first, second), robots, (theirs, ours), cells))
    return _joined(areas)


def _area(
    indices: tuple[int, int], robots: tuple[ScheduledRobot, ScheduledRobot], spans: tuple[Span, Span], cells: Cells
) -> SharedArea:
    """The area of one piece of each."""
    places, windows = [], []
    for k, (robot, span) in enumerate(zip(robots, spans, strict=True)):
        low, high = float(cells[:, 2 * k].min()), float(cells[:, 2 * k + 1].max())
        places.append(_places(robot.course.elements[span.element], low, high))
        window = (span.begin, span.end) if span.stands else (span.begin + low, span.begin + high)
        windows.append([(max(0.0, window[0]), window[1])])
    bases = np.vstack(places)
    (x0, y0), (x1, y1) = bases.min(axis=0).tolist(), bases.max(axis=0).tolist()
    return SharedArea(indices, (x0, y0), (x1, y1), (windows[0], windows[1]))


def _places(element: Element, low: float, high: float) -> Array:
    """Where the base is between two times of the element's own clock."""
    inside = (element.times >= low) & (element.times <= high)
    places: Array = element.base[inside, :2]
    return places


def _joined(areas: list[SharedArea]) -> list[SharedArea]:
    """Areas that overlap are one."""
    out: list[SharedArea] = []
    for area in areas:
        while overlapping := [other for other in out if _overlap(area, other)]:
            for other in overlapping:
                out.remove(other)
                area = _union(area, other)
        out.append(area)
    return sorted(out, key=lambda area: area.windows[0][0])


def _overlap(a: SharedArea, b: SharedArea) -> bool:
    return all(a.low[k] <= b.high[k] and b.low[k] <= a.high[k] for k in (0, 1))


def _union(a: SharedArea, b: SharedArea) -> SharedArea:
    low = min(a.low[0], b.low[0]), min(a.low[1], b.low[1])
    high = max(a.high[0], b.high[0]), max(a.high[1], b.high[1])
    windows = merged(a.windows[0] + b.windows[0]), merged(a.windows[1] + b.windows[1])
    return SharedArea(a.robots, low, high, windows)


def area_to_dict(area: SharedArea) -> dict[str, object]:
    """As schedule.json has it."""
    windows = [[[begin, end if math.isfinite(end) else None] for begin, end in of_robot] for of_robot in area.windows]
    return {"robots": list(area.robots), "low": list(area.low), "high": list(area.high), "windows": windows}
