"""One run: references for arm, base and fingers on the physics' clock, and the watching of parts and contacts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from .._core import InvalidInput, JointGroup, JointTrajectory
from .result import ContactLog, PartWatch, SimResult
from .scene import SimScene

SETTLE = 0.4  # after the fingers should have met, before the lift [s]
LIFT_STEPS = 20
BASE_NAMES = ("x", "y", "theta")
WATCHED = 2  # contacts are looked at every so many physics steps


@dataclass
class Execution:
    """How a trajectory is run. Times are those of the plan; `speed` stretches them all."""

    speed: float = 1.0
    """Share of the planned speed, in (0, 1]."""
    close_at: float | None = None
    """Plan time at which the gripper begins to close [s]; None: at the plan's end."""
    opening: float | None = None
    """Of the gripper at first [m]; None: fully open."""
    closing_speed: float = 0.1
    """How fast the opening shrinks [m/s] (P1 4.4.1); not stretched by `speed`."""
    lift: float = 0.1
    """The tool then rises this far [m]; 0: no lift."""
    lift_time: float = 2.0
    """[s]"""
    hold: float = 2.0
    """And stands this long [s]."""
    tracking: dict[str, Any] = field(default_factory=dict)
    """Keywords of BaseTracker; kp, feedback, ..."""
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


class Run:
    """All of one execution, computed by the constructor."""

    def __init__(self, sim: SimScene, plan: JointTrajectory, base: np.ndarray, arm: JointGroup | None, how: Execution):
        self.sim, self.plan, self.arm, self.how = sim, plan, arm, how
        self.h = sim.physics.time_step
        self._read_columns(base)
        self._set_times()
        self.ascent = self._plan_lift()
        self.rng = np.random.default_rng(how.seed)
        self.tracker = _core.BaseTracker(sim.robot, **how.tracking) if self.base_columns else None
        self._references()
        self.log = ContactLog()
        self.states: list[dict[str, Any]] = []
        self.base_error = self.arm_error = 0.0
        self.platform = np.zeros(3)
        self._execute()

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
        if self.ascent is not None:
            share = np.clip((times - self.lift_at) / self.how.lift_time, 0.0, 1.0)
            share = share**3 * (10 - 15 * share + 6 * share**2)  # at rest at both ends
            for i, name in enumerate(self.arm.names):
                rising = np.interp(share * LIFT_STEPS, np.arange(LIFT_STEPS + 1), self.ascent[:, i])
                reference[name] = np.where(times >= self.lift_at, rising, reference[name])
        if self.sim.gripper:
            opening = np.clip(self.opening - self.how.closing_speed * np.maximum(times - self.close_at, 0), 0, None)
            for joint in self.sim.gripper.joints:
                share = opening / self.sim.gripper.max_opening
                reference[joint.name] = joint.closed + share * (joint.open - joint.closed)
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
        self.control, self.control_of = lead, [self.sim.actuator[n] for n in names]
        self.arm_address = [self.sim.address[n] for n in self.columns]
        self.arm_wanted = (
            np.stack([reference[n] for n in self.columns], axis=1) if self.columns else np.zeros((count, 0))
        )

    def _planned_base(self, time: float) -> np.ndarray:
        return np.asarray(self.plan.at(time * self.how.speed))[self.base_columns]

    def _command_base(self, time: float) -> None:
        """What the wheels make of the tracker's command for the next period."""
        if self.tracker is None:
            return
        how, period = self.how, self.tracker.period
        noise = self.rng.normal(size=5)
        spread = np.array([how.position_noise, how.position_noise, how.heading_noise])
        measured = self.sim.base_pose() + spread * noise[:3]
        command = np.asarray(
            self.tracker.command(self._planned_base(time), self._planned_base(time + period), measured)
        )
        width = self.sim.robot.base_limits["wheel_separation"]
        wheels = np.array([command[0] - command[2] * width / 2, command[0] + command[2] * width / 2])
        travel = (1 - np.array(how.slip)) * wheels * period
        travel += how.travel_noise * np.sqrt(np.abs(travel)) * noise[3:]
        left, right = travel / period
        sideways = (1 - np.mean(how.slip)) * command[1]
        self.platform = np.array([(left + right) / 2, sideways, (right - left) / width])

    def _execute(self) -> None:
        sim, data, model = self.sim, self.sim.data, self.sim.model
        sim.reset(self.stand, {name: float(values[0]) for name, values in self.reference.items()})
        fingers = set(sim.gripper.finger_links) if sim.gripper else set()
        hand = fingers | {j["parent"] for j in sim.robot.joint_table if j["name"] in sim.built.fingers}
        tool = f"link/{sim.gripper.tcp_link}" if sim.gripper else None
        self.watches = [PartWatch(n, sim.part_pose(n), fingers, hand) for n in sim.parts]
        period = self.tracker.period if self.tracker else 0.02
        every = max(1, round(period / self.h))
        if abs(every * self.h - period) > 1e-9:
            raise InvalidInput(f"tracking period = {period}: must be a multiple of the time step {self.h}")
        frame = 0.0
        for k, time in enumerate(self.times):
            if k % every == 0:
                self._command_base(time)
            if time >= frame - 1e-9:
                self._record(time)
                frame += self.how.frame_period
            data.ctrl[self.control_of] = self.control[k]
            if sim.moves:
                theta = data.qpos[sim.base_address[2]]
                c, s = np.cos(theta), np.sin(theta)
                vx, vy, omega = self.platform
                data.ctrl[sim.base_actuator] = (c * vx - s * vy, s * vx + c * vy, omega)
            sim.mujoco.mj_step(model, data)
            if k % WATCHED == 0:
                self._watch(time, tool)
        self._record(self.times[-1])

    def _watch(self, time: float, tool: str | None) -> None:
        sim = self.sim
        forces = sim.contact_forces()
        self.log.step(float(time), forces)
        k = min(round(time / self.h) + 1, len(self.times) - 1)
        if self.arm_address:
            error = np.abs(sim.data.qpos[self.arm_address] - self.arm_wanted[k])
            self.arm_error = max(self.arm_error, float(error.max()))
        if self.tracker is not None:
            off = sim.base_pose()[:2] - self._planned_base(time + self.h)[:2]
            self.base_error = max(self.base_error, float(np.hypot(*off)))
        if tool is None:
            return
        T_world_tool = sim.body_pose(tool)
        for watch in self.watches:
            touching = {b if a == watch.name else a for a, b in forces if watch.name in (a, b)}
            watch.step(sim.part_pose(watch.name), T_world_tool, touching, time >= self.lifted)

    def _record(self, time: float) -> None:
        sim = self.sim
        self.states.append(
            {
                "time": float(time),
                "base": sim.base_pose().tolist(),
                "joints": {n: float(sim.data.qpos[a]) for n, a in sim.address.items()},
                "parts": {n: sim.part_pose(n) for n in sim.parts},
            }
        )

    def result(self) -> SimResult:
        sim = self.sim
        lift = self.how.lift if self.ascent is not None else 0.0
        parts = {w.name: w.verdict(sim.part_pose(w.name), lift) for w in self.watches}
        end = float(self.times[-1])
        return SimResult(parts, self.log.events(), end, self.base_error, self.arm_error, self.states)
