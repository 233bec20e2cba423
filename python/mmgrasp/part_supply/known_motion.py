"""A pick as it was planned, piece after piece, as the motion that one without stops is found from (`shorten_drive_by`).

The pieces are those from where the part before is let go (or from home) to where this one is let go: retreat, drive, reach, approach,
closing, lift and transfer. Where the pick is at the stop at which the base stands already, they are motions of the arm alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from .._core import DriveByTask, JointGroup, JointTrajectory, Pick, World
from .planning import ScenarioPlan

SETTLING = 0.1  # fingers press before the part is lifted [s]
APPROACH_SPEED = (
    0.25  # of the tool as it comes to the part [m/s]; arms that brake from more in so short a way overshoot
)
PLANNED_SHARE = 5 / 6  # of the base's speed; what is left corrects its way
WITHIN = 1e-7  # of the goal [rad]
MERGED = ("transit", "approach", "lift", "transfer")  # motions of a pick that are one with the way to it


@dataclass(frozen=True)
class KnownPick:
    """One pick with the way to it, as planned."""

    plan: ScenarioPlan
    problem: _core.PartSupplyProblem
    index: int
    """Index of the pick in the plan."""

    @property
    def pick(self) -> Pick:
        """As planned."""
        return self.plan.picks[self.index]

    @property
    def before(self) -> Pick | None:
        """The pick before, from whose release the motion begins; None: it begins at home."""
        return self.plan.picks[self.index - 1] if self.index > 0 else None

    @property
    def drives(self) -> bool:
        """Whether the base drives to the stop in it."""
        return self.before is None or self.before.stop != self.pick.stop

    @property
    def part(self) -> _core.Part:
        """What is taken."""
        return self.problem.trays[self.pick.tray].parts[self.pick.part]

    @property
    def opening(self) -> float:
        """Opening of the hand as it comes [m]."""
        return self.pick.motions[0].opening

    @property
    def width(self) -> float:
        """Opening of the hand around the part [m]."""
        return self.part.grasps[self.pick.grasp].opening

    @property
    def closing(self) -> float:
        """What the fingers need from one to the other [s]."""
        return (self.opening - self.width) / self.plan.scenario.setup.closing_speed

    @property
    def dwell(self) -> float:
        """The fingers close and press this long [s]."""
        return self.closing + SETTLING

    @property
    def duration(self) -> float:
        """All of it, one after the other [s]."""
        seconds = sum(trajectory.duration for _, trajectory in self.pieces()) + self.closing
        return seconds + (self.plan.route[self.pick.stop].duration(self.problem.robot) if self.drives else 0.0)

    def pieces(self) -> list[tuple[str, JointTrajectory]]:
        """The arm's motions, by kind."""
        merged = [(m.kind, m.trajectory) for m in self.pick.motions if m.kind in MERGED]
        return [("retreat", self.before.motions[-1].trajectory), *merged] if self.before else merged

    def tasks(self) -> list[DriveByTask]:
        """The place before the part, and the grasp while the fingers close."""
        T_grasp = self.part.T_world_part @ self.part.grasps[self.pick.grasp].T_object_hand
        T_before = T_grasp.copy()
        way = float(self.problem.options["approach_distance"])
        T_before[:3, 3] -= way * T_grasp[:3, :3] @ np.asarray(self.problem.gripper.approach)
        return [
            DriveByTask(T_before, tolerance=[0.003] * 3 + [0.02] * 3, max_tool_speed=APPROACH_SPEED),
            DriveByTask(T_grasp, dwell=self.dwell, object=self.part.name),
        ]

    def group(self) -> JointGroup:
        """What moves: base and arm, or the arm of a base that stands at the stop; the hand is open."""
        joints = {**self.plan.scenario.setup.other_joints, **self.problem.gripper.joint_values(self.opening)}
        arm_of = self.plan.scenario.setup.group
        if self.drives:
            return _slower(self.problem.robot).group(**arm_of, with_base=True).with_reference(joints)
        x, y, theta = self.plan.stops[self.pick.stop].pose
        arm = self.problem.robot.group(**arm_of).with_reference(joints)
        return arm.at(_core.pose([x, y, 0.0], rpy=[0.0, 0.0, theta]))

    def world(self) -> World:
        """Scene and the parts still in place."""
        taken = {(pick.tray, pick.part) for pick in self.plan.picks[: self.index]}
        world = self.problem.world.copy()
        for t, tray in enumerate(self.problem.trays):
            for p, part in enumerate(tray.parts):
                if (t, p) in taken:
                    world.forget(part.name)
                else:
                    world.add(part.name, part.shapes, part.T_world_part)
        return world

    def motion(self) -> dict[str, Any]:
        """`times`, `positions` and `task_times` of shorten_drive_by. The arm's numbers are those of the pieces: continuous joints may be
        whole turns from home."""
        leg = self.plan.route[self.pick.stop] if self.drives else None
        poses = np.asarray(leg.poses if leg else [self.plan.stops[self.pick.stop].pose], float)
        pieces = self.pieces()
        times, rows, reached = [0.0], [np.concatenate([poses[0], pieces[0][1].positions[0]])], []
        for kind, trajectory in pieces:
            if kind == "transit" and leg is not None:
                _drive(times, rows, poses, leg.duration(self.problem.robot))
            begin, base = times[-1], rows[-1][:3]
            times += [begin + t for t in trajectory.times[1:]]
            rows += [np.concatenate([base, q]) for q in trajectory.positions[1:]]
            if kind in ("transit", "approach"):
                reached.append(times[-1])
            if kind == "approach":
                times.append(times[-1] + self.dwell)
                rows.append(rows[-1])
        positions = np.array(rows)
        return {"times": times, "positions": positions if leg else positions[:, 3:], "task_times": reached}

    def goal(self, last: np.ndarray) -> np.ndarray:
        """The last row as a box (2, n): what is one number may be reached up to full turns, but the next motion begins at the arm's numbers."""
        box = np.array([last, last], float)
        box[:, 3 if self.drives else 0 :] += np.array([[-WITHIN], [WITHIN]])
        return box


def _drive(times: list[float], rows: list[np.ndarray], poses: np.ndarray, duration: float) -> None:
    """Goes on along poses of the base, the arm as it stands."""
    steps = np.abs(np.diff(poses, axis=0))
    shares = np.concatenate([[0.0], np.cumsum(np.hypot(steps[:, 0], steps[:, 1]) + 0.5 * steps[:, 2])])
    begin, arm = times[-1], rows[-1][3:]
    for share, pose in zip(shares[1:][np.diff(shares) > 0], poses[1:][np.diff(shares) > 0], strict=True):
        times.append(begin + duration * float(share / shares[-1]))
        rows.append(np.concatenate([pose, arm]))


def _slower(robot: _core.Robot) -> _core.Robot:
    """The robot whose base is planned slower than it can drive: a tracker that has nothing in hand stays behind for ever."""
    limits = {key: value for key, value in robot.base_limits.items() if np.isfinite(value)}
    for key in ("linear_velocity", "angular_velocity", "wheel_velocity"):
        if key in limits:
            limits[key] *= PLANNED_SHARE
    return _core.Robot.from_strings(robot.to_urdf(), robot.to_srdf(), base=robot.base, base_limits=limits)
