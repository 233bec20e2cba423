"""A grasp tried in physics: an arm closes the hand, lifts a loose part, turns it and puts it back (P3 4.8.3)."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .. import _core
from .._core import CollisionChecker, Grasp, LinkShape, Outcome, World
from .._files import shipped
from ..documents.reading import Document, read_yaml
from ..scenario.robot_section import RobotSetup, choose_sections, read_setup
from .control import Command, SceneState
from .model import Physics, SimPart
from .scene import SimScene

TABLE = 0.70  # height of the top [m]
PLACE = (0.75, 0.0)  # middle of the table in the base's frame [m]
PAD = 0.016  # length of a pad [m]
TIP = 0.012  # its middle lies so far before the middle of the whole finger's pad, which is 40 mm long [m]
BACK = 0.05  # the hand comes in along its approach over this way [m]
LIFT = 0.10  # [m]
TURN = np.radians(60)  # about the vertical through the tool
FAR, TURNED = 0.01, np.radians(30)  # a part that moved farther in the hand was not held precisely (P3 table 4.1)
SETTLE = 0.4  # after the fingers should have met [s]
CLOSING_SPEED = 0.1  # of the opening [m/s]
_STEP = 0.01  # of the tool between two inverse kinematics [m]


@functools.cache
def robot_setup() -> RobotSetup:
    """The shipped omnidirectional robot with its six joints, its hand used with the fingertips alone: pads of 16 x 22 mm at the ends."""
    path = shipped("asset:scenarios/omni_cell.yaml")
    raw = read_yaml(path).root.raw
    raw["robot"] |= {
        "frames": [{"name": "fingertips", "parent": raw["robot"]["tool_link"], "pose": {"xyz": [TIP, 0.0, 0.0]}}],
        "tool_link": "fingertips",
    }
    raw["gripper"]["finger_depth"] = PAD
    return read_setup(choose_sections(Document(str(path), raw, {}).root, None))


def table_world() -> World:
    """The table's top."""
    world = World()
    world.add_box("table", [0.4, 0.8, 0.03], _core.pose([PLACE[0], PLACE[1], TABLE - 0.015]))
    return world


@dataclass(frozen=True)
class ArmWay:
    """Configurations (k, n) of the stretches of a trial."""

    approach: np.ndarray
    lift: np.ndarray
    turn: np.ndarray


@dataclass(frozen=True)
class TrialOutcome:
    """What became of the part."""

    success: bool
    """Lifted and turned in the hand alone, and back on the table."""
    precise: bool
    """And moved less than FAR and TURNED in the hand from the moment the fingers began to close until they opened."""
    moved: float
    """[m]"""
    turned: float
    """[rad]"""


def arm_way(grasp: Grasp) -> ArmWay | None:
    """How the arm gets there and back, by inverse kinematics along straight lines; None: it cannot, or touches the table.

    `grasp.T_object_hand` is in the world. The hand may be turned by half a turn about its approach.
    """
    setup = robot_setup()
    half = np.eye(4)
    half[:3, :3] = 2 * np.outer(setup.gripper.approach, setup.gripper.approach) - np.eye(3)
    checker = CollisionChecker(setup.robot, table_world(), setup.arm)
    for turn in (np.eye(4), half):
        T = grasp.T_object_hand @ turn
        before = T.copy()
        before[:3, 3] -= BACK * T[:3, :3] @ setup.gripper.approach
        up = T.copy()
        up[2, 3] += LIFT
        for angle in (TURN, -TURN):
            about = _core.pose([0, 0, 0], rpy=[0, 0, angle])[:3, :3]
            turned = up.copy()
            turned[:3, :3] = about @ up[:3, :3]
            found = _line([before, T, up, turned])
            if found is None:
                continue
            approach, lift, rotation = found
            rows = np.concatenate(found)
            if all(checker.is_free(q) for q in rows):
                return ArmWay(approach, lift, rotation)
    return None


def _line(poses: Sequence[np.ndarray]) -> list[np.ndarray] | None:
    arm = robot_setup().arm
    first = arm.ik(poses[0], seed=robot_setup().home, world=table_world(), rng_seed=1)
    if first.outcome != Outcome.solved:
        return None
    q, out = np.asarray(first.q), []
    for a, b in itertools.pairwise(poses):
        rotation = a[:3, :3].T @ b[:3, :3]
        angle = float(np.arccos(np.clip((np.trace(rotation) - 1) / 2, -1, 1)))
        steps = max(2, int(np.ceil(max(float(np.linalg.norm(b[:3, 3] - a[:3, 3])) / _STEP, angle / 0.1))))
        rows = [q]
        for k in range(1, steps + 1):
            T = a.copy()
            T[:3, 3] += (b[:3, 3] - a[:3, 3]) * k / steps
            if angle > 1e-6:  # the turns here are about the vertical
                T[:3, :3] = _core.pose([0, 0, 0], rpy=[0, 0, _signed(a, b) * k / steps])[:3, :3] @ a[:3, :3]
            step = arm.ik(T, seed=rows[-1], restarts=0)
            if step.outcome != Outcome.solved or np.abs(np.asarray(step.q) - rows[-1]).max() > 0.5:
                return None
            rows.append(np.asarray(step.q))
        q = rows[-1]
        out.append(np.array(rows))
    return out


def _signed(a: np.ndarray, b: np.ndarray) -> float:
    about = b[:3, :3] @ a[:3, :3].T
    return float(np.arctan2(about[1, 0], about[0, 0]))


class _Pick:
    """The controller, and the observer of the part in the hand."""

    def __init__(self, scene: SimScene, way: ArmWay, opening: float):
        setup = robot_setup()
        hand = setup.gripper
        closing = opening / CLOSING_SPEED + SETTLE
        back, down = way.turn[::-1], way.lift[::-1]
        stretches = [
            (1.2, way.approach, opening, opening),
            (closing, way.approach[-1:], opening, 0.0),
            (1.2, way.lift, 0.0, 0.0),
            (1.2, way.turn, 0.0, 0.0),
            (0.3, way.turn[-1:], 0.0, 0.0),
            (1.2, back, 0.0, 0.0),
            (1.2, down, 0.0, 0.0),
            (0.6, down[-1:], 0.0, opening),
            (0.8, way.approach[::-1], opening, opening),
        ]
        h = scene.physics.time_step
        rows, opened, self.marks = [], [], [0.0]
        for seconds, q, first, last in stretches:
            count = round(seconds / h)
            share = (np.arange(count) + 1) / count
            share = share**3 * (10 - 15 * share + 6 * share**2)
            at = share * (len(q) - 1)
            rows.append(np.stack([np.interp(at, np.arange(len(q)), q[:, i]) for i in range(q.shape[1])], axis=1))
            if last < first:
                opened.append(np.maximum(0.0, first - CLOSING_SPEED * (np.arange(count) + 1) * h))
            else:
                opened.append(first + (last - first) * np.minimum(1.0, 2 * (np.arange(count) + 1) / count))
            self.marks.append(self.marks[-1] + count * h)
        arm = np.concatenate(rows)
        rate = np.gradient(arm, h, axis=0)
        w = scene.physics.stiffness
        lead = arm + 2 / w * rate + np.clip(np.gradient(rate, h, axis=0), -20, 20) / w**2
        width = np.concatenate(opened)
        fingers = np.array([hand.share_open(v) for v in width])[:, None] * [j.open - j.closed for j in hand.joints]
        fingers = fingers + [j.closed for j in hand.joints]
        self.rows = np.concatenate([lead, fingers], axis=1)
        self.joints = [*setup.arm.names, *(j.name for j in hand.joints)]
        self.period, self._step = h, 0
        self._part, self._tool = next(iter(scene.parts)), f"link/{hand.tool_link}"
        self._fingers = set(hand.finger_links)
        self._start: np.ndarray | None = None
        self.moved = self.turned = 0.0
        self.held = True

    def command(self, time: float, scene: SceneState) -> Command:
        row = self.rows[self._step]
        self._step += 1
        return Command(row)

    def finished(self, time: float, scene: SceneState) -> bool:
        return self._step >= len(self.rows)

    def before(self, step: int, time: float, scene: SceneState) -> None:
        """Nothing."""

    def after(self, step: int, time: float, scene: SceneState) -> None:
        if step % 5 or not self.marks[1] <= time < self.marks[7]:
            return
        T = np.linalg.inv(scene.body_pose(self._tool)) @ scene.part_pose(self._part)
        if self._start is None:
            self._start = T
        change = self._start[:3, :3].T @ T[:3, :3]
        self.moved = max(self.moved, float(np.linalg.norm(T[:3, 3] - self._start[:3, 3])))
        self.turned = max(self.turned, float(np.arccos(np.clip((np.trace(change) - 1) / 2, -1, 1))))
        if self.marks[3] <= time < self.marks[6] - 0.3 and step % 25 == 0:
            touching = {b if a == self._part else a for a, b in scene.contact_forces() if self._part in (a, b)}
            self.held &= bool(touching & self._fingers) and not touching - self._fingers - {self._tool[5:]}


def try_grasp(
    shapes: Sequence[LinkShape],
    T_world_part: np.ndarray,
    mass: float,
    way: ArmWay,
    opening: float,
    physics: Physics | None = None,
) -> TrialOutcome:
    """One trial: the hand, `opening` wide [m], comes in, closes, lifts by LIFT, turns by TURN and back, lowers and opens."""
    setup = robot_setup()
    part = SimPart("part", shapes, T_world_part, mass=mass)
    scene = SimScene(
        setup.robot, table_world(), [part], gripper=setup.gripper, physics=physics, joints=setup.other_joints
    )
    pick = _Pick(scene, way, opening)
    scene.reset(np.zeros(3), {**setup.other_joints, **dict(zip(pick.joints, pick.rows[0], strict=True))})
    scene.drive(pick, [pick])
    end = scene.part_pose("part")
    back = bool(end[2, 3] > TABLE - 0.02 and np.linalg.norm(end[:2, 3] - T_world_part[:2, 3]) < 0.25)
    success = pick.held and back
    precise = success and pick.moved < FAR and pick.turned < TURNED
    return TrialOutcome(success, bool(precise), pick.moved, pick.turned)
