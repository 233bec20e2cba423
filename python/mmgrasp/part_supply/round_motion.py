"""A whole round as a robot carries it out: drives, picks and motions in passing on one clock."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from .. import _core
from .._core import InvalidInput, Outcome, PartSupplyPlan, RobotMotion
from ..scenario import Scenario

AT_GOAL = frozenset({"transfer", "retreat"})
"""Kinds of motions that a pick does at the goal where the hand brings the part there."""


@dataclass(frozen=True)
class InPassing:
    """A motion that takes the place of a pick's motions up to where the part is let go, and of the drive to it where it is the first of its stop."""

    result: _core.DriveByResult
    from_release: bool
    """And of the retreat of the pick before."""


class RoundMotion:
    """Joins the pieces of a round; the gripper moves at the scenario's closing speed while everything else stands."""

    def __init__(self, scenario: Scenario, plan: PartSupplyPlan) -> None:
        if plan.outcome != Outcome.solved:
            raise InvalidInput(f"plan: is not solved ({plan.outcome.name})")
        self.plan, self.scenario, self.setup = plan, scenario, scenario.setup
        self.motion: RobotMotion | None = None
        self.opening: float | None = None
        self.held: str | None = None  # what a motion in passing brought to the bin
        self.carried: _core.Pick | None = None  # whose part rides to the goal in the hand

    def make(self, in_passing: Mapping[int, InPassing]) -> RobotMotion:
        """The round; `in_passing`: what is done so, by the pick's index."""
        plan = self.plan
        for leg, drive in enumerate(plan.route):
            picks = [i for i, pick in enumerate(plan.picks) if pick.stop == leg]
            if not (picks and picks[0] in in_passing):
                self._drive(drive)
            for i in picks:
                left_out = {"retreat"} if i + 1 in in_passing and in_passing[i + 1].from_release else set()
                if i in in_passing:
                    self._pass(plan.picks[i], in_passing[i].result)
                    left_out |= {"transit", "approach", "lift", "transfer"}
                self._pick(plan.picks[i], left_out)
                self._unload(i)
        assert self.motion is not None
        return self.motion

    def _add(self, motion: RobotMotion) -> None:
        if self.motion is None:
            self.motion = motion
        else:
            self.motion.append(motion)

    def _unload(self, pick: int) -> None:
        """To the goal with a full bin or a part in the hand, and back where parts are left."""
        for unloading in self.plan.unloadings:
            for drive in (unloading.to_goal, unloading.back) if unloading.after_pick == pick else ():
                if drive is not None:
                    self._drive(drive)

    def _drive(self, drive: _core.BasePath) -> None:
        """A drive with the arm where it is; a part that the hand brings is let go at its end, the goal."""
        arm = self.motion.positions[-1] if self.motion is not None else self.setup.home
        self._add(RobotMotion.of_drive(drive, self.setup.robot, self.setup.arm, arm))
        if self.carried is not None:
            pick, self.carried = self.carried, None
            self._move(pick, AT_GOAL, self.scenario.goal)

    def _part(self, pick: _core.Pick) -> str:
        return str(self.scenario.trays[pick.tray].tray.parts[pick.part].name)

    def _pass(self, pick: _core.Pick, result: _core.DriveByResult) -> None:
        self._open_to(pick.motions[0].opening, self._part(pick))
        self.opening, self.held = next(m.opening for m in pick.motions if m.attached), self._part(pick)
        self._add(RobotMotion.of_drive_by(result, openings=[self.opening]))

    def _pick(self, pick: _core.Pick, left_out: Collection[str]) -> None:
        kinds = {motion.kind for motion in pick.motions} - set(left_out)
        if self.scenario.unload_region is not None:
            self.carried = pick
            kinds -= AT_GOAL
        self._move(pick, kinds, self.plan.stops[pick.stop].pose)

    def _move(self, pick: _core.Pick, kinds: Collection[str], base: np.ndarray) -> None:
        for motion in pick.motions:
            if motion.kind in kinds:
                self._open_to(motion.opening, self._part(pick))
                self._add(RobotMotion(motion.trajectory, base))

    def _open_to(self, opening: float, part: str) -> None:
        """Where the hand stands otherwise; what it stands at when the round begins is listed as well, and takes no time."""
        before, self.opening = self.opening, opening
        part, self.held = self.held or part, None
        if self.motion is None or before == opening:
            return
        moved = 0.0 if before is None else opening - before
        self.motion.command_gripper(
            "close" if moved < 0 else "open",
            opening=opening,
            duration=abs(moved) / self.setup.closing_speed,
            object="" if before is None else part,
        )
