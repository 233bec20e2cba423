"""The earliest schedule of one robot among those that are scheduled before it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from .course import Course
from .meetings import Meetings
from .safe_intervals import EarliestCourse, Interval, blocked_by, earliest_course, merged
from .scheduled_robot import ScheduledRobot, Span

_SLACKS = (10.0, 60.0, math.inf)  # by which a schedule may be later than without waits, tried one after the other [s]

Because = tuple[Interval, int, Span]
"""When an element may not begin, by which of the other robots, and by what it does."""


class ScheduleSearch:
    """Finds when a robot may begin each piece of its course; `tell` hears how much of a pass over them is done."""

    def __init__(
        self, course: Course, others: Sequence[ScheduledRobot], clearance: float, tell: Callable[[float], None]
    ) -> None:
        self._course, self._others, self._tell = course, others, tell
        self._share = 0.0
        self.meetings = [Meetings(other.course, course, clearance, lambda: tell(self._share)) for other in others]
        self._durations = [piece.duration for piece in course.pieces]
        self._spans = [(i, span) for i, other in enumerate(others) for span in other.spans()]

    def find(self, only_sure: bool = False) -> EarliestCourse:
        """The earliest schedule; `only_sure`: where only that counts which is proven to be too close, so that none is earlier.

        What the others do long before or after is not looked at. Without it more is possible, so that no way then is none at all; a way that ends in time
        has nothing to do with it.
        """
        for slack in _SLACKS:
            end = sum(self._durations) + slack
            found = self._find(end, only_sure)
            if found.starts is None or found.arrival <= end:
                return found
        raise AssertionError("the last slack has no end")

    def obstruction(self) -> str:
        """Who is in whose way, with the two pieces, where there is no schedule."""
        found = self._find(math.inf)
        own, elements = self._course.label, self._course.elements
        if found.reached < 0:
            way = next(row for row in self._blocked(0, 0.0, math.inf) if row[0][0] <= 0 <= row[0][1])
            return f"{own} is in the way of {self._said(way)} while it stands at its start: they are too close at once"
        stands = ""
        if math.isfinite(found.until):
            rows = self._blocked(2 * found.reached, found.arrival, math.inf)
            way = next(row for row in rows if row[0][0] <= found.until < row[0][1])
            place = elements[2 * found.reached].name
            stands = f"{place} is in the way of {self._said(way)} at {found.until:.2f} s"
        if found.reached == len(self._course.pieces):
            return f"{own} finds no way: {stands}"
        piece = elements[2 * found.reached + 1].name
        rows = self._blocked(2 * found.reached + 1, found.arrival, math.inf)
        met = [row for row in rows if row[0][0] <= found.until and row[0][1] >= found.arrival]
        if not met:
            return f"{own} finds no way: {piece} ends where it cannot stand" + (f", and {stands}" if stands else "")
        last = max(met, key=lambda row: row[0][1])
        return f"{own} finds no way: {piece} meets {self._said(last)}" + (f", and {stands}" if stands else "")

    def _find(self, end: float, only_sure: bool = False) -> EarliestCourse:
        def blocked(element: int, since: float) -> list[Interval]:
            self._share = element / (2 * len(self._durations) + 1)
            self._tell(self._share)
            rest = sum(self._durations[(element + 1) // 2 :])
            until = end - rest if element < 2 * len(self._durations) else math.inf
            return merged([interval for interval, _, _ in self._blocked(element, since, until, only_sure)])

        return earliest_course(self._durations, blocked)

    def _blocked(self, element: int, since: float, until: float, only_sure: bool = False) -> list[Because]:
        """When an element may not begin (a standstill: not be) because of what others do between two times."""
        out: list[Because] = []
        for robot, span in self._spans:
            meetings = self.meetings[robot]
            if span.end < since or span.begin > until or meetings.far_apart[span.element, element]:
                continue
            cells = meetings.unsafe(span.element, element)
            if only_sure:
                cells = cells[cells[:, 4] > 0]
            out += [(interval, robot, span) for interval in blocked_by(cells, span.begin, span.end, span.stands)]
        return out

    def _said(self, because: Because) -> str:
        _, robot, span = because
        other = self._others[robot].course
        return f"{other.elements[span.element].name} of {other.label}"
