"""The earliest way along a fixed course among what moves: safe-interval path planning with time as the only freedom.

A course is a row of standstills with pieces between them. A standstill may last as long as it is safe; a piece lasts as long as it does and may begin only
when it meets nobody. Of all ways to reach a standstill within one safe interval the earliest is the best, for whoever is there earlier can wait: so one
arrival is kept for each, and the schedule that is found ends as early as any can.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

Interval = tuple[float, float]


def merged(intervals: Sequence[Interval]) -> list[Interval]:
    """The union of intervals, in order; those that touch are one."""
    out: list[Interval] = []
    for low, high in sorted(intervals):
        if out and low <= out[-1][1]:
            out[-1] = (out[-1][0], max(out[-1][1], high))
        else:
            out.append((low, high))
    return out


def free_of(blocked: Sequence[Interval], begin: float = 0.0) -> list[Interval]:
    """What blocked intervals (open, in order, as `merged` gives them) leave from `begin` on."""
    out = []
    for low, high in blocked:
        if low >= begin:
            out.append((begin, low))
        begin = max(begin, high)
    return [*out, (begin, math.inf)] if begin < math.inf else out


@dataclass(frozen=True)
class _Arrival:
    time: float
    interval: int
    before: _Arrival | None
    departure: float


@dataclass(frozen=True)
class EarliestCourse:
    """When each piece begins, or how far one gets."""

    starts: list[float] | None
    """One a piece [s]; None: there is no way."""
    reached: int
    """Index of the last standstill that can be reached."""
    arrival: float
    """When it is reached first [s]."""
    until: float
    """How long one can stay there at most: the end of the last safe interval that can be reached [s]."""


Blocked = Callable[[int, float], Sequence[Interval]]
"""When an element (2 k: standstill k, 2 k + 1: the piece after it) may not begin or be: open intervals as `merged` gives them. What lies before a time is not
asked for."""


def earliest_course(durations: Sequence[float], blocked: Blocked) -> EarliestCourse:
    """Begins at time 0 and ends in the last standstill, for good."""
    here = free_of(blocked(0, 0.0))
    arrivals = [_Arrival(0.0, j, None, 0.0) for j, (low, _) in enumerate(here[:1]) if low <= 0.0]
    if not arrivals:
        return EarliestCourse(None, -1, 0.0, 0.0)
    for k, duration in enumerate(durations):
        since = min(arrival.time for arrival in arrivals)
        there = free_of(blocked(2 * k + 2, since + duration))
        following = _go_on(arrivals, here, there, free_of(blocked(2 * k + 1, since)), duration)
        if not following:
            return _stuck(k, arrivals, here)
        arrivals, here = following, there
    last = [a for a in arrivals if here[a.interval][1] == math.inf]
    if not last:
        return _stuck(len(durations), arrivals, here)
    return EarliestCourse(_departures(last[0]), len(durations), float(last[0].time), math.inf)


def _stuck(stand: int, arrivals: Sequence[_Arrival], safe: Sequence[Interval]) -> EarliestCourse:
    return EarliestCourse(None, stand, min(a.time for a in arrivals), max(safe[a.interval][1] for a in arrivals))


def _go_on(
    arrivals: Sequence[_Arrival],
    here: Sequence[Interval],
    there: Sequence[Interval],
    departures: Sequence[Interval],
    duration: float,
) -> list[_Arrival]:
    """The earliest arrival in each safe interval of the next standstill."""
    best: dict[int, _Arrival] = {}
    for arrival in arrivals:
        for low, high in departures:
            for j, (begin, end) in enumerate(there):
                departure = max(arrival.time, low, begin - duration)
                if departure > min(high, here[arrival.interval][1], end - duration):
                    continue
                if j not in best or departure + duration < best[j].time:
                    best[j] = _Arrival(departure + duration, j, arrival, departure)
    return [best[j] for j in sorted(best)]


def _departures(arrival: _Arrival) -> list[float]:
    out = []
    while arrival.before is not None:
        out.append(float(arrival.departure))
        arrival = arrival.before
    return out[::-1]


def blocked_by(cells: np.ndarray, begin: float, end: float, stands: bool) -> list[Interval]:
    """When an element may not begin that meets another one in these cells (`Meetings.unsafe`, the other one first), where the other one begins and ends
    then. One that stands does in all of that time what it does at once."""
    out = []
    for u0, u1, s0, s1, _ in cells:
        low, high = (begin, end) if stands else (begin + u0, begin + u1)
        if high > low or not stands:
            out.append((low - s1, high - s0))
    return out
