"""The step loop: closed loops against closed forms, what is refused, and that every run repeats."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import get_type_hints

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp.sim.control import body_to_world
from mmgrasp.sim.execution import ExecutionOptions
from sim_scenes import arm, box, gripper, robot, table

pytest.importorskip("mujoco", reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")


@dataclass
class DriveTo:
    """Turns towards a point, then drives there: looks at the base before every command."""

    goal: tuple[float, float]
    joints: Sequence[str] = ()
    period: float = 0.02
    asked: list[float] = field(default_factory=list)

    def error(self, scene: sim.SceneState) -> tuple[float, float]:
        """Distance [m] and heading [rad] still to go."""
        x, y, theta = scene.base_pose()
        d = np.array(self.goal) - (x, y)
        return float(np.hypot(*d)), float(np.remainder(np.arctan2(d[1], d[0]) - theta + np.pi, 2 * np.pi) - np.pi)

    def command(self, time: float, scene: sim.SceneState) -> sim.Command:
        self.asked.append(time)
        distance, heading = self.error(scene)
        return sim.Command(base=(min(0.4, distance) * (abs(heading) < 0.1), 0.0, 2 * heading))

    def finished(self, time: float, scene: sim.SceneState) -> bool:
        return self.error(scene)[0] < 0.02


@dataclass
class Still:
    """Holds joints at the values given."""

    joints: Sequence[str] = ()
    values: Sequence[float] = ()
    base: tuple[float, float, float] = (0.0, 0.0, 0.0)
    period: float = 0.01

    def command(self, time: float, scene: sim.SceneState) -> sim.Command:
        return sim.Command(self.values, self.base)

    def finished(self, time: float, scene: sim.SceneState) -> bool:
        return False


def scene() -> sim.SimScene:
    return sim.SimScene(robot(), table(), [box()], gripper=gripper())


def home() -> dict[str, float]:
    return dict(zip(arm().names, np.clip(np.zeros(len(arm().names)), arm().lower, arm().upper), strict=True))


def test_a_controller_that_looks_gets_where_it_wants() -> None:
    world, controller = scene(), DriveTo((-0.6, 0.5))
    world.reset(np.array([-1.5, 0.0, 0.0]), home())
    took = world.drive(controller, time_limit=20.0)
    assert took < 20.0
    assert np.hypot(*(world.base_pose()[:2] - controller.goal)) < 0.02
    assert controller.asked == pytest.approx(np.arange(len(controller.asked)) * controller.period, abs=1e-9)


def test_a_commanded_turn_is_driven() -> None:
    """0.5 rad/s for 2 s, less what the velocity controller needs to get up to speed (its time constant: 20 ms)."""
    world = scene()
    world.reset(np.array([-1.5, 0.0, 0.0]), home())
    assert world.drive(Still(base=(0.0, 0.0, 0.5)), time_limit=2.0) == pytest.approx(2.0)
    assert world.base_pose()[2] == pytest.approx(0.5 * (2.0 - 0.02), abs=0.005)


def test_the_base_drives_in_its_own_frame() -> None:
    world = scene()
    world.reset(np.array([-1.5, 0.0, np.pi / 2]), home())
    world.drive(Still(base=(0.3, 0.0, 0.0)), time_limit=1.0)
    x, y, _ = world.base_pose()
    mass = sum(float(world.model.body(f"link/{link}").mass[0]) for link in world.robot.links)
    rate, lag = (
        world.physics.base_force / mass,
        0.02,
    )  # full force until it is `rate * lag` too slow, then exponentially
    rising = 0.3 / rate - lag
    lost = (0.3 + rate * lag) / 2 * rising + rate * lag**2
    assert (x, y) == (pytest.approx(-1.5, abs=1e-3), pytest.approx(0.3 - lost, abs=0.002))


def test_velocities_turn_with_the_base() -> None:
    """A quarter turn to the left takes ahead to the left, and left to behind."""
    assert body_to_world(np.array([1.0, 0.0, 0.3]), np.pi / 2) == pytest.approx((0.0, 1.0, 0.3))
    assert body_to_world(np.array([0.0, 1.0, 0.3]), np.pi / 2) == pytest.approx((-1.0, 0.0, 0.3))
    assert body_to_world(np.array([0.3, 0.4, 0.0]), 0.0) == pytest.approx((0.3, 0.4, 0.0))


def test_joints_follow_and_the_others_stay() -> None:
    world, start = scene(), home()
    name = "wrist_flex_joint"
    world.reset(np.array([-1.5, 0.0, 0.0]), start)
    for joint, value in start.items():
        world.data.ctrl[world.actuator[joint]] = value
    world.drive(Still([name], [start[name] + 0.3]), time_limit=1.0)
    assert world.joint(name) == pytest.approx(start[name] + 0.3, abs=2e-3)
    for other in set(start) - {name}:
        assert world.joint(other) == pytest.approx(start[other], abs=5e-3), other


def test_runs_repeat_bit_for_bit() -> None:
    ends = []
    for _ in range(2):
        world, recorder = scene(), sim.Recorder(0.1)
        world.reset(np.array([-1.5, 0.0, 0.0]), home())
        world.drive(DriveTo((-0.9, 0.3)), [recorder], time_limit=3.0)
        ends.append([(s["time"], s["base"], s["joints"]) for s in recorder.states])
    assert ends[0] == ends[1]
    assert len(ends[0]) > 10


@pytest.mark.parametrize(
    ("controller", "message"),
    [
        (Still(period=0.003), "period = 0.003: must be a multiple of the time step"),
        (Still(period=float("nan")), "period = nan"),
        (Still(period=0.0), "period = 0.0: must be a multiple of the time step"),
        (Still(["no_such_joint"], [0.0]), "'no_such_joint' is no driven joint"),
        (Still(["wrist_flex_joint"], []), "must be 1 finite numbers"),
        (Still(base=(np.inf, 0, 0)), "command.base: must be three finite numbers"),
    ],
)
def test_wrong_controllers_are_refused(controller: Still, message: str) -> None:
    world = scene()
    world.reset(np.zeros(3), home())
    with pytest.raises(mg.InvalidInput, match=message):
        world.drive(controller, time_limit=0.1)


def test_physics_that_diverges_is_told() -> None:
    world = scene()
    world.reset(np.array([-1.5, 0.0, 0.0]), home())
    with pytest.raises(mg.Error, match="the physics diverged after"):
        world.drive(Still(base=(1e30, 0.0, 0.0)), time_limit=1.0)


@pytest.mark.parametrize(
    ("base", "joints", "message"),
    [
        ([0.0, 0.0], {}, "base = .*must be three finite numbers"),
        ([np.nan] * 3, {}, "base = .*must be three finite numbers"),
        ([0.0] * 3, {"q": 1.0}, r"joints\['q'\]"),
        ([0.0] * 3, {"wrist_flex_joint": np.inf}, r"joints\['wrist_flex_joint'\] = inf"),
    ],
)
def test_wrong_starts_are_refused(base: list[float], joints: dict[str, float], message: str) -> None:
    with pytest.raises(mg.InvalidInput, match=message):
        scene().reset(np.array(base), joints)


def test_the_type_of_keywords_has_the_fields_of_execution() -> None:
    kinds, fields = get_type_hints(ExecutionOptions), get_type_hints(sim.Execution)
    assert kinds == fields
