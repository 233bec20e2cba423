"""Runs planned motions in MuJoCo: tracked base, driven arm, closing gripper; contact and friction only."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

from .._core import InvalidInput, JointGroup, JointTrajectory
from .control import RecordedState, Recorder, SceneState
from .execution import Execution, ExecutionOptions
from .finger_drives import finger_sides
from .plan_controller import PlanController
from .result import ContactLog, PartWatch, SimResult
from .scene import SimScene

WATCHED = 2  # contacts are checked every so many physics steps


class Simulation(SimScene):
    """A robot among obstacles and loose parts. Built once, run as often as wanted, each time from the start."""

    def run(
        self,
        trajectory: JointTrajectory,
        *,
        base: ArrayLike = (0.0, 0.0, 0.0),
        arm: JointGroup | None = None,
        **execution: Unpack[ExecutionOptions],
    ) -> SimResult:
        """Runs a trajectory: joints by its names, the base by its columns x, y, theta (else it stands at `base`).

        The gripper closes at `close_at`; with an `arm` (a group without base) the tool then rises by `lift`, and everything stands
        for `hold` seconds. Keywords are the fields of Execution. Other controllers: drive().
        """
        try:
            how = Execution(**execution)
        except TypeError as error:
            raise InvalidInput(f"run(): {error}") from None
        how.check()
        controller = PlanController(self, trajectory, np.asarray(base, float), arm, how)
        controller.start()
        recorder, watch = Recorder(how.frame_period), RunWatch(self, controller)
        self.drive(controller, [recorder, watch])
        recorder.record(controller.times[-1], self)
        return watch.result(recorder.states)


class RunWatch:
    """Contacts, parts and deviations of a run from its plan."""

    def __init__(self, scene: SimScene, controller: PlanController):
        self.scene, self.controller = scene, controller
        gripper = scene.gripper
        sides = finger_sides(scene.robot, gripper) if gripper and gripper.finger_links else []
        hand = set(gripper.finger_links if gripper else []) | {
            j["parent"] for j in scene.robot.joint_table if j["name"] in scene.built.fingers
        }
        self.tool = f"link/{gripper.tool_link}" if gripper else None
        self.parts = [PartWatch(name, scene.part_pose(name), sides, hand) for name in scene.parts]
        self.log = ContactLog()
        self.base_error = self.arm_error = 0.0

    def before(self, step: int, time: float, scene: SceneState) -> None:
        """Nothing: what counts is where a step leads."""

    def after(self, step: int, time: float, scene: SceneState) -> None:
        """Every WATCHED steps."""
        if step % WATCHED:
            return
        plan = self.controller
        forces = scene.contact_forces()
        self.log.step(float(time), forces)
        k = min(round(time / plan.h) + 1, len(plan.times) - 1)
        if plan.arm_address:
            error = np.abs(self.scene.data.qpos[plan.arm_address] - plan.arm_wanted[k])
            self.arm_error = max(self.arm_error, float(error.max()))
        if plan.tracker is not None:
            off = scene.base_pose()[:2] - plan.planned_base(time + plan.h)[:2]
            self.base_error = max(self.base_error, float(np.hypot(*off)))
        if self.tool is None:
            return
        T_world_tool = scene.body_pose(self.tool)
        for watch in self.parts:
            touching = {b if a == watch.name else a for a, b in forces if watch.name in (a, b)}
            watch.step(scene.part_pose(watch.name), T_world_tool, touching, bool(time >= plan.lifted))

    def result(self, states: list[RecordedState]) -> SimResult:
        """The verdict on every part, and what happened."""
        plan = self.controller
        lift = plan.how.lift if plan.ascent is not None else 0.0
        parts = {w.name: w.verdict(self.scene.part_pose(w.name), lift) for w in self.parts}
        return SimResult(parts, self.log.events(), float(plan.times[-1]), self.base_error, self.arm_error, states)
