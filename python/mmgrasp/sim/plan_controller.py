"""The controller that plays a planned motion: references for arm, base and fingers on the physics' clock."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _core
from .._core import InvalidInput, JointGroup, JointTrajectory
from .control import Command, SceneState
from .execution import Execution
from .scene import SimScene

SETTLE = 0.4  # after the fingers should have met, before the lift [s]
LIFT_STEPS = 20
BASE_NAMES = ("x", "y", "theta")


class PlanController:
    """Plays a trajectory, closes the gripper, raises the tool; the base follows by a tracker with noisy wheels and eyes."""

    def __init__(self, sim: SimScene, plan: JointTrajectory, base: np.ndarray, arm: JointGroup | None, how: Execution):
        self.sim, self.plan, self.arm, self.how = sim, plan, arm, how
        self.h = sim.physics.time_step
        self._read_columns(base)
        self._set_times()
        self.ascent = self._plan_lift()
        self.rng = np.random.default_rng(how.seed)
        self.tracker = _core.BaseTracker(sim.robot, **how.tracking) if self.base_columns else None
        self._references()
        self.period = self.h
        self._base_every = self._base_steps()
        self._step = 0
        self._platform = np.zeros(3)

    @property
    def joints(self) -> Sequence[str]:
        """Every driven joint."""
        return list(self.reference)

    def command(self, time: float, scene: SceneState) -> Command:
        """The references' next row; the base's velocity anew every tracking period."""
        if self._step % self._base_every == 0:
            self._command_base(time)
        row = self.control[self._step]
        self._step += 1
        return Command(row, self._platform)

    def finished(self, time: float, scene: SceneState) -> bool:
        """After the last row."""
        return self._step >= len(self.times)

    def start(self) -> None:
        """Robot and parts to where the motion begins."""
        self.sim.reset(self.stand, {name: float(values[0]) for name, values in self.reference.items()})

    def _base_steps(self) -> int:
        period = self.tracker.period if self.tracker else 0.02
        every = max(1, round(period / self.h))
        if abs(every * self.h - period) > 1e-9:
            raise InvalidInput(f"tracking period = {period}: must be a multiple of the time step {self.h}")
        return every

    def _read_columns(self, base: np.ndarray) -> None:
        names = list(self.plan.names)
        self.base_columns = [names.index(n) for n in BASE_NAMES] if all(n in names for n in BASE_NAMES) else []
        if self.base_columns and not self.sim.moves:
            raise InvalidInput("trajectory: moves the base, which is fixed")
        if base.shape != (3,) or not np.isfinite(base).all():
            raise InvalidInput(f"base = {base.tolist()}: must be three numbers x, y, theta")
        self.columns = {n: i for i, n in enumerate(names) if not (self.base_columns and n in BASE_NAMES)}
        for name in self.columns:
            if name not in self.sim.actuator:
                raise InvalidInput(f"trajectory: column '{name}' is no driven joint of the robot")
        if self.arm is not None:
            if self.arm.has_base:
                raise InvalidInput("arm: must be a group without the base, which stands while the tool rises")
            for name in self.arm.names:
                if name not in self.columns:
                    raise InvalidInput(f"arm: its joint '{name}' is not in the trajectory")
        self.stand = base if not self.base_columns else np.asarray(self.plan.at(0.0))[self.base_columns]
        # A fixed base stands where the model has it.
        if not self.sim.moves and np.abs(base).max() > 0:
            raise InvalidInput("base: a fixed base stands at the origin")

    def _set_times(self) -> None:
        how, gripper = self.how, self.sim.gripper
        self.plan_end = self.plan.duration / how.speed
        wide = gripper.max_opening if gripper else 0.0
        self.opening = wide if how.opening is None else min(how.opening, wide)
        self.close_at = self.plan_end if how.close_at is None else how.close_at / how.speed
        closed = self.close_at + self.opening / how.closing_speed + SETTLE if gripper else 0.0
        self.lift_at = max(self.plan_end, closed)
        self.lifted = self.lift_at + (how.lift_time if self.arm is not None and how.lift > 0 else 0.0)
        self.end = self.lifted + how.hold

    def _plan_lift(self) -> np.ndarray | None:
        """Arm configurations (LIFT_STEPS + 1, n) along the tool's way up."""
        if self.arm is None or self.how.lift == 0:
            return None
        last = np.asarray(self.plan.at(self.plan.duration))
        q = np.array([last[self.columns[n]] for n in self.arm.names])
        T = self.arm.fk(q)
        way = [q]
        for i in range(1, LIFT_STEPS + 1):
            T_up = T.copy()
            T_up[2, 3] += self.how.lift * i / LIFT_STEPS
            solved = self.arm.ik(T_up, seed=way[-1], restarts=0, time_limit=1.0)
            if solved.outcome != _core.Outcome.solved:
                raise InvalidInput(
                    f"lift = {self.how.lift}: the arm cannot raise its tool that far after the trajectory"
                )
            way.append(np.asarray(solved.q))
        return np.array(way)

    def _references(self) -> None:
        """Driven joints (k, n) on the physics' clock, with the lead that a critically damped controller needs."""
        count = int(np.ceil(self.end / self.h)) + 1
        times = np.arange(count) * self.h
        limits = {j["name"]: (j["lower"], j["upper"]) for j in self.sim.robot.joint_table}
        start = {name: float(np.clip(0.0, *limits[name])) for name in self.sim.actuator} | self.sim.joints
        reference = {name: np.full(count, start[name]) for name in self.sim.actuator}
        moving = int(min(count, np.ceil(self.plan_end / self.h) + 1))
        samples = np.array([self.plan.at(t * self.how.speed) for t in times[:moving]])
        for name, column in self.columns.items():
            reference[name][:moving] = samples[:, column]
            reference[name][moving:] = samples[-1, column]
        if self.ascent is not None and self.arm is not None:
            share = np.clip((times - self.lift_at) / self.how.lift_time, 0.0, 1.0)
            share = share**3 * (10 - 15 * share + 6 * share**2)  # at rest at both ends
            for i, name in enumerate(self.arm.names):
                rising = np.interp(share * LIFT_STEPS, np.arange(LIFT_STEPS + 1), self.ascent[:, i])
                reference[name] = np.where(times >= self.lift_at, rising, reference[name])
        if self.sim.gripper:
            opening = np.clip(self.opening - self.how.closing_speed * np.maximum(times - self.close_at, 0), 0, None)
            hand = self.sim.gripper
            share = np.array([hand.share_open(value) for value in opening])
            for joint in hand.joints:
                own = np.full(count, hand.preshape[joint.group]) if joint.group in hand.preshape else share
                reference[joint.name] = joint.closed + own * (joint.open - joint.closed)
        self.times, self.reference = times, reference
        w = self.sim.physics.stiffness
        names = list(reference)
        wanted = np.stack([reference[n] for n in names], axis=1)
        rate = np.gradient(wanted, self.h, axis=0) if count > 1 else np.zeros_like(wanted)
        change = np.gradient(rate, self.h, axis=0) if count > 1 else np.zeros_like(wanted)
        lead = wanted + 2 / w * rate + np.clip(change, -20, 20) / w**2
        for i, name in enumerate(names):
            if name in self.sim.built.fingers:
                lead[:, i] = wanted[:, i]
        self.control = lead
        self.arm_address = [self.sim.address[n] for n in self.columns]
        self.arm_wanted = (
            np.stack([reference[n] for n in self.columns], axis=1) if self.columns else np.zeros((count, 0))
        )

    def planned_base(self, time: float) -> np.ndarray:
        """(x, y, theta) that the plan has at this time of the run."""
        return np.asarray(self.plan.at(time * self.how.speed))[self.base_columns]

    def _command_base(self, time: float) -> None:
        """What the wheels make of the tracker's command for the next period."""
        if self.tracker is None:
            return
        how, period = self.how, self.tracker.period
        noise = self.rng.normal(size=5)
        spread = np.array([how.position_noise, how.position_noise, how.heading_noise])
        measured = self.sim.base_pose() + spread * noise[:3]
        command = np.asarray(self.tracker.command(self.planned_base(time), self.planned_base(time + period), measured))
        width = self.sim.robot.base_limits["wheel_separation"]
        wheels = np.array([command[0] - command[2] * width / 2, command[0] + command[2] * width / 2])
        travel = (1 - np.array(how.slip)) * wheels * period
        travel += how.travel_noise * np.sqrt(np.abs(travel)) * noise[3:]
        left, right = travel / period
        sideways = (1 - np.mean(how.slip)) * command[1]
        self._platform = np.array([(left + right) / 2, sideways, (right - left) / width])
