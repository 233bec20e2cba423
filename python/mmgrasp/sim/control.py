"""Who moves the robot in physics, and who watches: the protocols of the step loop (`SimScene.drive`).

A closed loop is a controller that looks at the scene before it commands:

    class TurnToPart:
        joints = ()
        period = 0.02

        def command(self, time, scene):
            x, y, theta = scene.base_pose()
            part = scene.part_pose("box")[:2, 3]
            error = np.arctan2(part[1] - y, part[0] - x) - theta
            return Command(base=(0.0, 0.0, error))

        def finished(self, time, scene):
            return time > 5.0

    scene.reset(base=np.zeros(3), joints={})
    scene.drive(TurnToPart())
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .model import SimPart


class RecordedState(TypedDict):
    """Where everything was at one time: what pictures and replays are made of."""

    time: float  # [s]
    base: list[float]  # x, y, theta
    joints: dict[str, float]  # driven ones [rad or m]
    parts: dict[str, NDArray[np.float64]]  # T_world_part (4, 4)


class SceneState(Protocol):
    """What a controller and an observer may look at: the state of physics now."""

    @property
    def address(self) -> Mapping[str, int]:
        """Driven joints by name."""

    @property
    def parts(self) -> Mapping[str, SimPart]:
        """Loose parts by name."""

    def base_pose(self) -> NDArray[np.float64]:
        """(x, y, theta)."""

    def joint(self, name: str) -> float:
        """Value of a driven joint [rad or m]."""

    def part_pose(self, name: str) -> NDArray[np.float64]:
        """T_world_part (4, 4)."""

    def body_pose(self, body: str) -> NDArray[np.float64]:
        """T_world_body (4, 4); bodies are called link/NAME and part/NAME."""

    def contact_forces(self) -> Mapping[tuple[str, str], float]:
        """Normal force [N] by pair of bodies that touch."""


@dataclass
class Command:
    """What the robot is to do until the next command."""

    joints: ArrayLike = ()
    """Reference of each of the controller's joints, in their order [rad or m]."""
    base: ArrayLike = (0.0, 0.0, 0.0)
    """Velocity (vx, vy, omega) in the base's own frame [m/s, m/s, rad/s]; a fixed base takes none."""


class Controller(Protocol):
    """Commands the robot; of the scene it sees SceneState."""

    @property
    def joints(self) -> Sequence[str]:
        """Driven joints that it commands; the others keep their last command."""

    @property
    def period(self) -> float:
        """Between two commands [s]; a multiple of the time step."""

    def command(self, time: float, scene: SceneState) -> Command:
        """Called at 0, period, 2 period, ..., before the physics step that begins at `time` [s]."""

    def finished(self, time: float, scene: SceneState) -> bool:
        """Asked before every physics step; true ends the run."""


class Observer(Protocol):
    """Watches a run without changing it."""

    def before(self, step: int, time: float, scene: SceneState) -> None:
        """Before the physics step that begins at `time`, the command known."""

    def after(self, step: int, time: float, scene: SceneState) -> None:
        """After that step."""


class Recorder:
    """Keeps a state every `period` [s]: what pictures and replays are made of."""

    def __init__(self, period: float):
        self.period = period
        self.states: list[RecordedState] = []
        self._next = 0.0

    def before(self, step: int, time: float, scene: SceneState) -> None:
        """A state, when it is time."""
        if time >= self._next - 1e-9:
            self.record(time, scene)
            self._next += self.period

    def after(self, step: int, time: float, scene: SceneState) -> None:
        """Nothing: states are taken before steps."""

    def record(self, time: float, scene: SceneState) -> None:
        """A state at this time [s]."""
        self.states.append(
            {
                "time": float(time),
                "base": scene.base_pose().tolist(),
                "joints": {name: scene.joint(name) for name in scene.address},
                "parts": {name: scene.part_pose(name) for name in scene.parts},
            }
        )


def body_to_world(velocity: np.ndarray, theta: float) -> tuple[float, float, float]:
    """(vx, vy, omega) of the base's frame in that of the world."""
    c, s = np.cos(theta), np.sin(theta)
    vx, vy, omega = velocity
    return c * vx - s * vy, s * vx + c * vy, omega
