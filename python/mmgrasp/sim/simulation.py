"""Runs planned motions in MuJoCo: tracked base, driven arm, closing gripper; contact and friction only."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import InvalidInput, JointGroup, JointTrajectory
from .execution import Execution, Run
from .result import SimResult
from .scene import SimScene


class Simulation(SimScene):
    """A robot among obstacles and loose parts. Built once, run as often as wanted, each time from the start."""

    def run(
        self,
        trajectory: JointTrajectory,
        *,
        base: Any = (0.0, 0.0, 0.0),
        arm: JointGroup | None = None,
        **execution: Any,
    ) -> SimResult:
        """Runs a trajectory: joints by its names, the base by its columns x, y, theta (else it stands at `base`).

        The gripper closes at `close_at`; with an `arm` (a group without base) the tool then rises by `lift`, and everything stands
        for `hold` seconds. Keywords are the fields of Execution.
        """
        try:
            how = Execution(**execution)
        except TypeError as error:
            raise InvalidInput(f"run(): {error}") from None
        how.check()
        return Run(self, trajectory, np.asarray(base, float), arm, how).result()
