"""One robot of a schedule: when it begins each piece of its plan, and what it does from when to when."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from .._core import RobotMotion
from .course import Course

_WAITS = 1e-6  # [s]; shorter ones are none


@dataclass(frozen=True)
class Span:
    """An element of a robot's course that lasts."""

    element: int
    begin: float
    end: float
    """Infinite at the goal [s]."""

    @property
    def stands(self) -> bool:
        """Whether it is a standstill."""
        return self.element % 2 == 0


@dataclass(frozen=True)
class ScheduledRobot:
    """When one robot begins each piece of its plan."""

    plan: Path
    sha256: str
    course: Course
    starts: list[float]
    earliest_end: float
    """It is proven that among the robots before it cannot be done before this [s]."""

    @property
    def end(self) -> float:
        """When it has reached its goal [s]."""
        return self.starts[-1] + self.course.pieces[-1].duration

    @property
    def waited(self) -> float:
        """All of its waits together [s]."""
        return self.end - sum(piece.duration for piece in self.course.pieces)

    def waits(self) -> list[float]:
        """How long it stands before each piece [s]."""
        ready, out = 0.0, []
        for start, piece in zip(self.starts, self.course.pieces, strict=True):
            out.append(start - ready if start - ready > _WAITS else 0.0)
            ready = start + piece.duration
        return out

    def motion(self) -> RobotMotion:
        """The round with its waits: drives, picks, waits and gripper on the clock that all robots share."""
        return self.course.motion(self.starts)

    def spans(self) -> list[Span]:
        """All elements that last, in order; it has stood at its start before and stands at its goal for good."""
        out, ready = [], -1.0
        for k, (start, piece) in enumerate(zip(self.starts, self.course.pieces, strict=True)):
            if start > ready:
                out.append(Span(2 * k, ready, start))
            out.append(Span(2 * k + 1, start, start + piece.duration))
            ready = start + piece.duration
        return [*out, Span(2 * len(self.starts), ready, math.inf)]
