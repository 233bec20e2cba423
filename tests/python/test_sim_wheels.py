"""A base that rolls on its wheels in physics, against closed forms of rolling and of friction."""

from __future__ import annotations

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.reproduce.tracking import base_plan
from mmgrasp.sim import Command, Physics, RollingBase, SceneState, Simulation, build
from sim_scenes import robot as fetch

pytest.importorskip("mujoco")
GRAVITY = 9.81


class Drive:
    """Speeds up within a second and goes on."""

    joints = ()
    period = 0.02

    def __init__(self, v: float, omega: float, seconds: float, ramp: float = 1.0):
        self.v, self.omega, self.seconds, self.ramp = v, omega, seconds, ramp

    def command(self, time: float, scene: SceneState) -> Command:
        share = min(1.0, time / self.ramp)
        return Command(base=(share * self.v, 0.0, share * self.omega))

    def finished(self, time: float, scene: SceneState) -> bool:
        return time >= self.seconds


def rolling(friction: float = 0.9) -> Simulation:
    robot = fetch()
    wheels = RollingBase.of_robot(robot)
    wheels.friction = friction
    return Simulation(robot, mg.World(), physics=Physics(rolling=wheels))


def turned(trial: Simulation) -> np.ndarray:
    """How far left and right wheel have turned [rad]."""
    wheels = trial.physics.rolling
    assert wheels is not None
    return np.array([trial.data.joint(name).qpos[0] for name in (wheels.left, wheels.right)])


def test_wheels_are_found() -> None:
    wheels = RollingBase.of_robot(fetch())
    assert (wheels.left, wheels.right) == ("left_wheel_joint", "right_wheel_joint")
    assert wheels.radius == pytest.approx(0.06)
    assert wheels.track == pytest.approx(2 * 0.18738)


class Odometry:
    """Where the base is by its wheels' turning alone."""

    def __init__(self, trial: Simulation) -> None:
        self.trial, self.pose, self.before_step = trial, np.zeros(3), turned(trial)

    def before(self, step: int, time: float, scene: SceneState) -> None:
        self.before_step = turned(self.trial)

    def after(self, step: int, time: float, scene: SceneState) -> None:
        left, right = (turned(self.trial) - self.before_step) * 0.06
        turn, way = (right - left) / (2 * 0.18738), (left + right) / 2
        middle = self.pose[2] + turn / 2
        self.pose += [way * np.cos(middle), way * np.sin(middle), turn]


@pytest.mark.parametrize(("v", "omega"), [(0.5, 0.0), (-0.4, 0.0), (0.0, 0.6), (0.5, 0.5)])
def test_it_rolls_without_slipping(v: float, omega: float) -> None:
    """The base goes as its wheels turn: v = (l + r) / 2, omega = (r - l) / track, integrated."""
    trial = rolling()
    trial.reset(np.zeros(3), {})
    odometry = Odometry(trial)
    trial.drive(Drive(v, omega, 4.0), [odometry])
    left, right = turned(trial) * 0.06
    assert (left + right) / 2 == pytest.approx(3.5 * v, abs=0.06)  # follows within a tenth of a second
    assert (right - left) / (2 * 0.18738) == pytest.approx(3.5 * omega, abs=0.06)
    off = trial.base_pose() - odometry.pose
    assert np.hypot(*off[:2]) < 0.01  # soft contacts creep a little in curves
    assert abs(off[2]) < 5e-3


def test_its_weight_is_on_wheels_and_casters() -> None:
    trial = rolling()
    trial.reset(np.zeros(3), {})
    trial.drive(Drive(0.0, 0.0, 1.0))
    forces = trial.contact_forces()
    assert {"left_wheel_link", "right_wheel_link"} < {name for pair in forces for name in pair}
    assert sum(forces.values()) == pytest.approx(trial.model.body_mass.sum() * GRAVITY, rel=1e-3)
    assert max(abs(trial.joint(name)) for name in trial.built.joints) < 1e-3  # the arm does not sink


class WheelLoad:
    """Sum over time of what the wheels press on the floor with [N s]."""

    def __init__(self) -> None:
        self.sum = 0.0

    def before(self, step: int, time: float, scene: SceneState) -> None: ...

    def after(self, step: int, time: float, scene: SceneState) -> None:
        forces = scene.contact_forces()
        self.sum += 0.002 * sum(f for pair, f in forces.items() if any("wheel" in name for name in pair))


def test_on_ice_it_speeds_up_by_friction_alone() -> None:
    """mu times the wheels' load is all that drives it, however fast the wheels spin: m v = mu sum of N dt."""
    friction, load, trial = 0.02, WheelLoad(), rolling(0.02)
    trial.reset(np.zeros(3), {})
    trial.drive(Drive(2.0, 0.0, 2.0, ramp=0.1), [load])
    speed = trial.data.joint("base/free").qvel[0]
    assert trial.model.body_mass.sum() * speed == pytest.approx(friction * load.sum, rel=0.05)
    assert turned(trial).min() * 0.06 > 5 * trial.base_pose()[0]


def test_a_plan_is_tracked_on_wheels_as_well() -> None:
    plan = base_plan()
    errors = {mu: rolling(mu).run(plan, hold=0.0, frame_period=1.0).base_error for mu in (0.9, 0.02)}
    pushed = Simulation(fetch(), mg.World()).run(plan, hold=0.0, frame_period=1.0).base_error
    assert errors[0.9] < pushed + 0.003 < 0.01
    assert errors[0.02] > 0.1


def test_what_cannot_roll_is_refused() -> None:
    robot = fetch()
    good = RollingBase.of_robot(robot)
    for field, value in (("radius", 0.0), ("track", -1.0), ("friction", np.nan), ("left", "no_joint"), ("casters", ())):
        with pytest.raises(mg.InvalidInput, match="rolling"):
            build(robot, mg.World(), physics=Physics(rolling=RollingBase(**{**vars(good), field: value})))
    fixed = mg.Robot.from_strings(robot.to_urdf(), base="fixed")
    with pytest.raises(mg.InvalidInput, match="two wheels"):
        RollingBase.of_robot(fixed)
    with pytest.raises(mg.InvalidInput, match="rolling"):
        build(fixed, mg.World(), physics=Physics(rolling=good))
