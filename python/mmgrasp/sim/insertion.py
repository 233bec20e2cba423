"""One operation of an assembly in physics: take a part from its post, carry it, push it into place, let go.

The arm's joints are position servos (see `sim.model`); nothing measures force. On the way down the tool's lag behind its reference says that
something is met: the reference waits there and the tool goes round in a spiral until it can sink again.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._core import JointGroup, Outcome
from .control import Command, SceneState
from .gripper_arm import TOOL, GripperArm

Points = NDArray[np.float64]

STEP = 0.005  # of the tool between two inverse kinematics [m]
FAST, SLOW = 0.15, 0.03  # of the tool: carrying, and where it comes near [m/s]
CLEAR = 0.06  # the tool comes to a part and leaves it over this way [m]
CLOSING = 0.05  # of the opening [m/s]
SQUEEZE = 0.012  # the closed drive's reference is so far inside the part: it presses with all its force [m]
SETTLE = 0.3  # [s]
BLOCKED, FREED = 0.0015, 0.0008  # lag of the tool that stops its reference, and that lets it go on [m]
PITCH, ROUND, WIDEST = 0.0003, 0.012, 0.0025  # spiral: between turns [m], along it [m/s], radius [m]
PATIENCE = 25.0  # the insertion is given up after so long [s]


@dataclass(frozen=True)
class Errand:
    """Tool poses (4, 4) in the world, all as planned; where things really are the arm does not know."""

    pick: Points
    place: Points
    start: Points
    """Tool pose before the last straight motion into place."""
    opening: float
    """Width of the part where it is held [m]."""
    clearance: float
    """How far each finger opens to let go [m]."""
    height: float
    """Height of the tool while it carries the part over everything else, in the world [m]."""


def way_of(arm: JointGroup, poses: list[Points], seed: Points) -> list[Points]:
    """Configurations (k, n) along straight lines between tool poses of one orientation, from the first pose on.

    Raises RuntimeError where the arm cannot follow.
    """
    found = arm.ik(poses[0], seed=seed, rng_seed=1)
    if found.outcome != Outcome.solved:
        raise RuntimeError(f"the arm does not reach {np.round(poses[0][:3, 3], 3).tolist()}")
    q, out = np.asarray(found.q), []
    for a, b in itertools.pairwise(poses):
        steps = max(2, int(np.ceil(np.linalg.norm(b[:3, 3] - a[:3, 3]) / STEP)))
        rows = [q]
        for k in range(1, steps + 1):
            T = a.copy()
            T[:3, 3] += (b[:3, 3] - a[:3, 3]) * k / steps
            step = arm.ik(T, seed=rows[-1], restarts=0)
            if step.outcome != Outcome.solved or np.abs(np.asarray(step.q) - rows[-1]).max() > 0.5:
                raise RuntimeError(f"the arm cannot follow a straight line to {np.round(b[:3, 3], 3).tolist()}")
            rows.append(np.asarray(step.q))
        q = rows[-1]
        out.append(np.array(rows))
    return out


class Insertion:
    """The controller of one operation: stretches by the clock, the insertion by what the tool's lag says."""

    def __init__(self, tool: GripperArm, errand: Errand, seed: Points, period: float, stiffness: float):
        self.tool, self.errand, self.period, self.stiffness = tool, errand, period, stiffness
        up = np.eye(4)
        up[2, 3] = CLEAR
        over = up @ errand.pick
        height = max(over[2, 3], errand.start[2, 3], errand.height)
        lifted, before = over.copy(), errand.start.copy()
        lifted[2, 3] = before[2, 3] = height
        poses = [over, errand.pick, lifted, before, errand.start, errand.place, up @ errand.place]
        self.rows = way_of(tool.arm, poses, seed)
        self.joints = [*tool.arm.names, *(j.name for j in tool.hand.joints)]
        self.stage, self.since = 0, 0.0
        self.done = 0.0
        """Share of the insertion's way that its reference has gone."""
        self.spiral = 0.0
        self.blocked = False
        self.offset = np.zeros(2)
        self.searched, self.in_time = 0.0, True
        self.released = np.inf
        """When the fingers begin to open [s]."""
        self.before: Points | None = None

    def start_joints(self) -> dict[str, float]:
        """Where the arm stands before, gripper open."""
        first = self._command(self.rows[0][0], self._open())
        return dict(zip(self.joints, first, strict=True))

    def finished(self, time: float, scene: SceneState) -> bool:
        """Whether the part was let go and the tool has left it."""
        return self.stage >= 8

    def command(self, time: float, scene: SceneState) -> Command:
        """References of arm and fingers at this time; the insertion looks at where the tool really is."""
        spent = time - self.since
        stretch = {0: (0, FAST / 3), 2: (1, FAST), 3: (2, FAST), 4: (3, FAST), 7: (5, FAST / 3)}
        if self.stage in stretch:
            index, speed = stretch[self.stage]
            q, ended = self._along(self.rows[index], spent, speed)
            fingers = self._shut() if self.stage in (2, 3, 4) else self._open() if self.stage == 0 else self._released()
            if self.stage == 7:
                q = q + self._shift(self.rows[5][0])
            return self._next(time, q, fingers) if ended else self._lead(q, fingers)
        if self.stage == 1:
            wide = max(self._shut(), self._open() - CLOSING * spent)
            command = self._command(self.rows[0][-1], wide)
            ready = spent > (self._open() - self._shut()) / CLOSING + SETTLE
            return self._next(time, self.rows[0][-1], wide) if ready else Command(command)
        if self.stage == 5:
            return self._insert(time, spent, scene)
        q = self.rows[4][-1] + self._shift(self.rows[4][-1])
        if spent < SETTLE:
            return self._lead(q, self._shut())
        wide = min(self._released(), self._shut() + CLOSING * (spent - SETTLE))
        ended = spent > 2 * SETTLE + (self._released() - self._shut()) / CLOSING
        return self._next(time, q, wide) if ended else self._lead(q, wide)

    def _insert(self, time: float, spent: float, scene: SceneState) -> Command:
        way = self.errand.start[2, 3] - self.errand.place[2, 3]
        wanted = self.errand.start[2, 3] - self.done * way
        lag = float(scene.body_pose(f"link/{TOOL}")[2, 3]) - wanted
        self.blocked = lag > (FREED if self.blocked else BLOCKED)
        if self.blocked and self.done < 1:
            self.spiral += ROUND * self.period
            self.searched += self.period
            angle = np.sqrt(4 * np.pi * self.spiral / PITCH)
            radius = PITCH * angle / (2 * np.pi)
            if radius > WIDEST:
                self.spiral, radius = 0.0, 0.0
            self.offset = radius * np.array([np.cos(angle), np.sin(angle)])
        elif self.done < 1:
            self.done = min(1.0, self.done + SLOW * self.period / way)
        q = self._at(self.rows[4], self.done)
        q = q + self._shift(q)
        late = spent > PATIENCE
        if self.done >= 1 or late:
            self.in_time = not late
            self.released = time + SETTLE
            if late:  # back up before letting go would hide the failure: it lets go where it is
                self.rows[4] = np.array([self._at(self.rows[4], self.done)] * 2)
                self.rows[5] = np.concatenate([self.rows[4][-1:], self.rows[5]])
            return self._next(time, q, self._shut())
        return self._lead(q, self._shut())

    def _next(self, time: float, q: Points, fingers: float) -> Command:
        self.stage += 1
        self.since = time + self.period
        return self._lead(q, fingers)

    def _along(self, rows: Points, spent: float, speed: float) -> tuple[Points, bool]:
        length = STEP * (len(rows) - 1)
        share = min(1.0, spent / max(length / speed * 1.875, 0.1))
        return self._at(rows, share**3 * (10 - 15 * share + 6 * share**2)), share >= 1

    @staticmethod
    def _at(rows: Points, share: float) -> Points:
        at = share * (len(rows) - 1)
        k = min(int(at), len(rows) - 2)
        return np.asarray(rows[k] + (at - k) * (rows[k + 1] - rows[k]))

    def _shift(self, q: Points) -> Points:
        """What the search's offset sideways asks of the joints."""
        if not self.offset.any():
            return np.zeros(len(q))
        return np.asarray(np.linalg.pinv(self.tool.arm.jacobian(q)) @ [*self.offset, 0, 0, 0, 0])

    def _open(self) -> float:
        gripper = self.tool.gripper
        return (gripper.max_opening - gripper.min_opening) / 2

    def _released(self) -> float:
        held = (self.errand.opening - self.tool.gripper.min_opening) / 2
        return float(np.clip(held + self.errand.clearance, 0, self._open()))

    def _shut(self) -> float:
        return (self.errand.opening - self.tool.gripper.min_opening - SQUEEZE) / 2

    def _lead(self, q: Points, fingers: float) -> Command:
        """References with the lead that a critically damped servo needs to follow."""
        rate = np.zeros(len(q)) if self.before is None else (q - self.before) / self.period
        self.before = np.array(q)
        return Command(self._command(q + 2 / self.stiffness * rate, fingers))

    def _command(self, q: Points, fingers: float) -> Points:
        return np.append(q, np.full(self.tool.gripper.fingers, fingers))
