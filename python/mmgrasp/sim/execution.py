"""How a planned motion is carried out in physics: the options of a run."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypedDict

import numpy as np

from .._core import InvalidInput
from .._options import TrackingOptions


class ExecutionOptions(TypedDict, total=False):
    """Keywords of `Simulation.run`: the fields of Execution, where their meaning is."""

    speed: float
    close_at: float | None
    opening: float | None
    closing_speed: float
    lift: float
    lift_time: float
    hold: float
    tracking: TrackingOptions
    slip: tuple[float, float]
    travel_noise: float
    position_noise: float
    heading_noise: float
    frame_period: float
    seed: int


@dataclass
class Execution:
    """How a trajectory is run. Times are those of the plan; `speed` stretches them all."""

    speed: float = 1.0
    """Share of the planned speed, in (0, 1]."""
    close_at: float | None = None
    """Plan time at which the gripper begins to close [s]; None: at the plan's end."""
    opening: float | None = None
    """Opening of the gripper at first [m]; None: fully open."""
    closing_speed: float = 0.1
    """How fast the opening shrinks [m/s] (P1 4.4.1); not stretched by `speed`."""
    lift: float = 0.1
    """The tool then rises this far [m]; 0: no lift."""
    lift_time: float = 2.0
    """[s]"""
    hold: float = 2.0
    """And stands this long [s]."""
    tracking: TrackingOptions = field(default_factory=TrackingOptions)
    """Keyword options of BaseTracker: kp, feedback, ..."""
    slip: tuple[float, float] = (0.0, 0.0)
    """Share of the left and right wheel's speed that is lost; in [0, 1)."""
    travel_noise: float = 0.0
    """Deviation of a wheel's travel after 1 m [m]."""
    position_noise: float = 0.0
    """Deviation of the base's measured x and y [m]."""
    heading_noise: float = 0.0
    """Deviation of its measured heading [rad]."""
    frame_period: float = 0.04
    """Between two recorded states [s]."""
    seed: int = 1
    """Same seed, same run."""

    def check(self) -> None:
        """Raises InvalidInput naming field, value and rule."""

        def rule(name: str, holds: bool, text: str) -> None:
            if not holds:
                raise InvalidInput(f"{name} = {getattr(self, name)!r}: must {text}")

        rule("speed", 0 < self.speed <= 1, "lie in (0, 1]")
        for name in ("closing_speed", "lift_time", "frame_period"):
            rule(name, 0 < getattr(self, name) < np.inf, "be finite and positive")
        for name in ("lift", "hold", "travel_noise", "position_noise", "heading_noise"):
            rule(name, 0 <= getattr(self, name) < np.inf, "be finite and not negative")
        rule("slip", len(self.slip) == 2 and all(0 <= s < 1 for s in self.slip), "be two shares in [0, 1)")
        rule("close_at", self.close_at is None or 0 <= self.close_at < np.inf, "be a time of the plan")
        rule("opening", self.opening is None or 0 <= self.opening < np.inf, "be finite and not negative")
