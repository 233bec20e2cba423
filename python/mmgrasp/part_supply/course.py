"""A plan as one robot carries it out, piece after piece: where all of its body is, and how far that moves. Schedules of several robots are made of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import CollisionChecker, InvalidInput, JointTrajectory, Robot, RobotMotion, World
from ..bodies import stored_pose, stored_shape
from .drives import unloading_after

Array = NDArray[np.float64]

STEP = 0.01  # between the times at which robots are measured [s]
EXPORT_STEP = 0.1  # between the points of exported drives [s]


@dataclass(frozen=True)
class Piece:
    """What a robot does from one standstill to the next: a straight section of a drive, a motion of the arm, or the fingers' alone."""

    name: str
    duration: float
    motion: RobotMotion | None
    """None: only the fingers move."""
    opening: tuple[float, float]
    """Openings of the hand before and after [m]."""
    held: str | None
    section: tuple[Sequence[float], Sequence[float]] | None = None
    """Base poses at the ends of a section of a drive."""
    command: tuple[str, str] | None = None
    """What the gripper is told before the motion (`open` or `close`), and about which part."""


class PieceWriter:
    """Writes the pieces of a plan (as plan.json has it) down in the order in which they are carried out."""

    def __init__(self, plan: dict[str, Any], robot: Robot) -> None:
        self._plan, self._robot = plan, robot
        self._joints = list(plan["scenario"]["arm"]["joints"])
        self._arm: Sequence[float] = plan["scenario"]["home"]
        self._opening: float | None = None
        self.pieces: list[Piece] = []

    def write(self) -> list[Piece]:
        """All pieces; motions in passing are left out, as a plan holds without them."""
        stops = self._plan["stops"]
        for leg, drive in enumerate(self._plan["route"]):
            self._drive(drive["poses"], f"stop {leg + 1}" if leg < len(stops) else "the goal")
            for i, pick in enumerate(self._plan["picks"]):
                if pick["stop"] == leg:
                    self._pick(pick, stops[leg]["pose"])
                    for where, unloading in unloading_after(self._plan, i):
                        self._drive(unloading["poses"], where)
        return self.pieces

    def _drive(self, poses: Sequence[Sequence[float]], where: str) -> None:
        opening = self._opening or 0.0
        section = 0
        for begin, end in pairwise(poses):
            motion = _core._drive_along([begin, end], self._robot, self._joints, self._arm, STEP)
            if motion.duration > 0:
                section += 1
                name = f"drive to {where}, section {section}"
                piece = Piece(name, motion.duration, motion, (opening, opening), None, (begin, end))
                self.pieces.append(piece)

    def _pick(self, pick: dict[str, Any], base: Sequence[float]) -> None:
        part = pick["part"]
        attached = False
        for motion in pick["motions"]:
            first = self._opening is None
            command = self._move_fingers(motion, part, attached)
            attached = motion["attached"]
            trajectory = JointTrajectory(
                self._joints, motion["times"], motion["positions"], motion["velocities"], motion["accelerations"]
            )
            robot_motion = RobotMotion(trajectory, base)
            opening = (motion["opening"], motion["opening"])
            held = part if attached else None
            name = f"{motion['kind']} {part}"
            told = command if first else None
            self.pieces.append(Piece(name, robot_motion.duration, robot_motion, opening, held, command=told))
            self._arm = motion["positions"][-1]

    def _move_fingers(self, motion: dict[str, Any], part: str, attached: bool) -> tuple[str, str]:
        """The fingers move to the opening of a motion; what they stand at when the round begins takes no time."""
        before, self._opening = self._opening, motion["opening"]
        closes = before is not None and motion["opening"] < before
        command = ("close" if closes else "open", "" if before is None else part)
        if before is not None and before != motion["opening"]:
            seconds = abs(motion["opening"] - before) / self._plan["scenario"]["gripper"]["closing_speed"]
            name = f"{'close on' if closes else 'open beside'} {part}"
            held = part if closes or attached else None
            self.pieces.append(Piece(name, seconds, None, (before, motion["opening"]), held, command=command))
        return command


class RobotBody:
    """All that a robot of a plan is, with the parts that it may hold, placed at any configuration."""

    def __init__(self, plan: dict[str, Any], robot: Robot, openings: set[float]) -> None:
        scenario = plan["scenario"]
        self._gripper, self._others = scenario["gripper"], scenario["other_joints"]
        self.joints = list(scenario["arm"]["joints"])
        self._tip = scenario["arm"]["tip_link"]
        self.robot = robot
        table = {joint["name"]: joint for joint in robot.joint_table}
        self._limits = np.array([[table[joint][end] for joint in self.joints] for end in ("lower", "upper")])
        self._links = [(link, shape) for link in robot.links for shape in robot.collisions(link)]
        self._trunk = _links_below_the_arm(robot, self.joints)
        picked = {pick["part"]: pick["grasp"] for pick in plan["picks"]}
        parts = {part["name"]: part for part in scenario["parts"] if part["name"] in picked}
        self._shapes = {name: [stored_shape(s) for s in part["shapes"]] for name, part in parts.items()}
        self._T_tip_part = {
            name: np.linalg.inv(stored_pose(part["grasps"][picked[name]]["pose"])) for name, part in parts.items()
        }
        self.rates = self._motion_bounds(openings)
        """How far any point moves while a joint of the arm moves by one unit [m/rad or m/m]."""
        self._finger_rate = self._finger_bound()

    def place(self, base: Array, arm: Array, opening: float, held: Sequence[str]) -> _core._PlacedBodies:
        """The body where it is."""
        shapes, poses = self._placed(base, arm, opening, held)
        return _core._PlacedBodies(shapes, poses)

    def place_trunk(self, base: Array, arm: Array) -> _core._PlacedBodies:
        """What the arm does not move."""
        shapes, poses = self._placed(base, arm, 0.0, [])
        kept = [i for i, (link, _) in enumerate(self._links) if link in self._trunk]
        return _core._PlacedBodies([shapes[i] for i in kept], poses[kept])

    def radius(self, arm: Array, opening: float, held: Sequence[str]) -> float:
        """No point of the body is farther than this from the base's vertical axis [m]."""
        shapes, poses = self._placed(np.zeros(3), arm, opening, held)
        farthest = 0.0
        for shape, T in zip(shapes, poses, strict=True):
            low, high = type(shape)(shape.shape, T @ shape.pose).bounds
            farthest = max(farthest, float(np.hypot(*np.maximum(np.abs(low), np.abs(high))[:2])))
        return farthest

    def _placed(
        self, base: Array, arm: Array, opening: float, held: Sequence[str]
    ) -> tuple[list[_core.LinkShape], Array]:
        x, y, theta = base
        links = self.robot.link_poses(self._values(arm, opening), _core.pose([x, y, 0.0], rpy=[0.0, 0.0, theta]))
        shapes = [shape for _, shape in self._links]
        poses = [links[link] for link, _ in self._links]
        for name in held:
            shapes += self._shapes[name]
            poses += [links[self._tip] @ self._T_tip_part[name]] * len(self._shapes[name])
        return shapes, np.array(poses).reshape(-1, 4, 4)

    def _values(self, arm: Sequence[float] | Array, opening: float) -> dict[str, float]:
        values = dict(self._others)
        openings = self._openings()
        share = float(np.interp(opening, openings, np.linspace(0, 1, len(openings)))) if openings[-1] > 0 else 0.0
        for finger in self._gripper["joints"]:
            values[finger["name"]] = finger["closed"] + share * (finger["open"] - finger["closed"])
        inside = np.clip(arm, *self._limits)  # between samples a motion may leave them by a rounding
        values.update(zip(self.joints, map(float, inside), strict=True))
        return values

    def _motion_bounds(self, openings: set[float]) -> Array:
        """Bounds for the arm's joints, whichever opening and part the hand has."""
        table = {joint["name"]: joint for joint in self.robot.joint_table}
        group = self.robot.group(base_link=table[self.joints[0]]["parent"], tip=self._tip)
        if group.names != self.joints:
            raise InvalidInput(
                f"scenario.arm.joints: must be all that move {self._tip}, in order: {', '.join(group.names)}"
            )
        world = World()
        for name, shapes in self._shapes.items():
            world.add(name, shapes)
            world.attach(name, self._tip, self._T_tip_part[name])
        bounds = np.zeros(len(self.joints))
        for opening in sorted(openings):
            values = self._values(np.zeros(len(self.joints)), opening)
            held = {name: value for name, value in values.items() if name not in self.joints}
            checker = CollisionChecker(self.robot, world, group.with_reference(held), check_self=False)
            bounds = np.maximum(bounds, checker.motion_bounds)
        return bounds

    def finger_way(self, before: float, after: float) -> float:
        """No point of the fingers moves farther while the hand opens or closes from one opening to the other [m]."""
        return self._finger_rate * abs(after - before)

    def _finger_bound(self) -> float:
        """How far points of the fingers move per metre of the opening, where it takes most of the joints."""
        table = {joint["name"]: joint for joint in self.robot.joint_table}
        way = 0.0
        for finger in self._gripper["joints"]:
            joint = table[finger["name"]]
            group = self.robot.group(base_link=joint["parent"], tip=joint["child"])
            rate = float(CollisionChecker(self.robot, World(), group, check_self=False).motion_bounds[0])
            way += rate * abs(finger["open"] - finger["closed"])
        steps = np.diff(self._openings())  # at equal steps of the joints
        return way / (float(steps.min()) * len(steps)) if way > 0 else 0.0

    def _openings(self) -> Sequence[float]:
        openings: Sequence[float] = self._gripper.get("openings", [0.0, self._gripper["max_opening"]])
        return openings


def _links_below_the_arm(robot: Robot, joints: Sequence[str]) -> set[str]:
    """Links that no joint of the arm moves."""
    moved: set[str] = set()
    for joint in robot.joint_table:  # parents come before children
        if joint["name"] in joints or joint["mimic"] in joints or joint["parent"] in moved:
            moved.add(joint["child"])
    return set(robot.links) - moved


class Element:
    """A piece of a course, or a standstill between two, at times no more than STEP apart."""

    def __init__(
        self, name: str, body: RobotBody, times: Array, base: Array, arm: Array, opening: Array, held: Sequence[str]
    ) -> None:
        self.name, self.times, self.base, self.arm, self.opening, self.held = name, times, base, arm, opening, held
        self._body = body
        self.way = np.zeros(len(times))
        """No point of the body has moved farther by these times [m]."""
        self.trunk_way = np.zeros(len(times))
        """The same of what the arm does not move [m]."""
        self.radius = body.radius(arm[0], float(opening[0]), held)
        """No point of the body is ever farther than this from the base's vertical axis [m]."""
        self._placed: dict[int, _core._PlacedBodies] = {}
        self._placed_trunk: dict[int, _core._PlacedBodies] = {}

    @property
    def duration(self) -> float:
        """[s]; 0 for a standstill, which lasts as long as one waits."""
        return float(self.times[-1])

    def at(self, knot: int) -> _core._PlacedBodies:
        """The body at one of the times."""
        if knot not in self._placed:
            row = self.base[knot], self.arm[knot], float(self.opening[knot]), self.held
            self._placed[knot] = self._body.place(*row)
        return self._placed[knot]

    def trunk_at(self, knot: int) -> _core._PlacedBodies:
        """What the arm does not move, at one of the times."""
        if self.trunk_way[-1] == 0.0:
            knot = 0
        if knot not in self._placed_trunk:
            self._placed_trunk[knot] = self._body.place_trunk(self.base[knot], self.arm[knot])
        return self._placed_trunk[knot]


class Course:
    """A plan's pieces and the standstills before, between and after them: elements 0, 2, 4, ... are standstills."""

    def __init__(self, plan: dict[str, Any], label: str) -> None:
        stored = plan["scenario"]["robot"]
        self.plan, self.label = plan, label
        robot = Robot.from_strings(
            stored["urdf"], stored["srdf"], base=stored["base"], base_limits=stored["base_limits"] or None
        )
        self.pieces = PieceWriter(plan, robot).write()
        self._body = RobotBody(plan, robot, {0.0} | {o for piece in self.pieces for o in piece.opening})

    @cached_property
    def elements(self) -> list[Element]:
        """Standstill, piece, standstill, ..., piece, standstill."""
        scenario = self.plan["scenario"]
        base, arm = np.asarray(scenario["start"], float), np.asarray(scenario["home"], float)
        out = [self._stand("its start", base, arm, 0.0, [])]
        for i, piece in enumerate(self.pieces):
            out.append(_element_of(piece, self._body, base, arm))
            base, arm = out[-1].base[-1], out[-1].arm[-1]
            after = self.pieces[i + 1].held if i + 1 < len(self.pieces) else None
            held = [name for name in dict.fromkeys((piece.held, after)) if name is not None]
            name = f"its stand after '{piece.name}'" if i + 1 < len(self.pieces) else "its stand at the goal"
            out.append(self._stand(name, base, arm, piece.opening[1], held))
        return out

    def _stand(self, name: str, base: Array, arm: Array, opening: float, held: Sequence[str]) -> Element:
        return Element(name, self._body, np.zeros(1), base[None], arm[None], np.array([opening]), held)

    def motion(self, starts: Sequence[float]) -> RobotMotion:
        """The whole round with its waits, as it is exported: the last start plus its piece's duration long."""
        scenario = self.plan["scenario"]
        rest = [[0.0] * len(self._body.joints)]
        home = JointTrajectory(self._body.joints, [0.0], [scenario["home"]], rest, rest)
        out = RobotMotion(home, scenario["start"])
        for start, piece in zip(starts, self.pieces, strict=True):
            if start > out.duration + 1e-9:
                out.wait(start - out.duration)
            if piece.command is not None:
                duration = 0.0 if piece.motion is not None else piece.duration
                command, part = piece.command
                out.command_gripper(command, opening=piece.opening[1], duration=duration, object=part)
            if piece.section is not None:
                arm = out.positions[-1]
                out.append(_core._drive_along(piece.section, self._body.robot, self._body.joints, arm, EXPORT_STEP))
            elif piece.motion is not None:
                out.append(piece.motion)
        return out


def _element_of(piece: Piece, body: RobotBody, base: Array, arm: Array) -> Element:
    held = [piece.held] if piece.held is not None else []
    if piece.motion is None:
        return _of_fingers(piece, body, base, arm, held)
    return _moving(piece, piece.motion, body, held)


def _of_fingers(piece: Piece, body: RobotBody, base: Array, arm: Array, held: Sequence[str]) -> Element:
    """An element in which the hand opens or closes and all else stands."""
    count = max(1, int(np.ceil(piece.duration / STEP)))
    shares = np.linspace(0.0, 1.0, count + 1)
    opening = piece.opening[0] + shares * (piece.opening[1] - piece.opening[0])
    ones = np.ones((count + 1, 1))
    element = Element(f"'{piece.name}'", body, shares * piece.duration, ones * base, ones * arm, opening, held)
    element.way = shares * body.finger_way(*piece.opening)
    element.radius += float(element.way[-1])
    return element


def _moving(piece: Piece, motion: RobotMotion, body: RobotBody, held: Sequence[str]) -> Element:
    """An element of a motion, cut into steps; between its samples the arm moves along cubics and the base's twist is linear."""
    times, positions, velocities = motion.times, motion.positions, motion.velocities
    h = np.diff(times)
    cuts = np.maximum(1, np.ceil(h / STEP - 1e-9)).astype(int)
    interval = np.repeat(np.arange(len(h)), cuts)
    share = np.concatenate([np.arange(1, n + 1) / n for n in cuts])[:, None]
    p0, p1 = positions[interval], positions[interval + 1]
    m0, m1 = (h[:, None] * velocities[:-1])[interval], (h[:, None] * velocities[1:])[interval]
    s2, s3 = share**2, share**3
    arm = (2 * s3 - 3 * s2 + 1) * p0 + (s3 - 2 * s2 + share) * m0 + (3 * s2 - 2 * s3) * p1 + (s3 - s2) * m1
    base = motion.base_poses[interval] + share * (motion.base_poses[interval + 1] - motion.base_poses[interval])
    knots = np.concatenate([[0.0], times[interval] + share[:, 0] * h[interval]])
    opening = np.full(len(knots), piece.opening[1])
    element = Element(
        f"'{piece.name}'",
        body,
        knots,
        np.vstack([motion.base_poses[:1], base]),
        np.vstack([positions[:1], arm]),
        opening,
        held,
    )
    arm_rate = _fastest(positions, velocities, h) @ body.rates
    twists = np.abs(motion.base_twists)
    speed = np.hypot(twists[:, 0], twists[:, 1])
    faster = np.maximum(speed[:-1], speed[1:])
    element.radius += float(arm_rate @ h)
    turning = np.maximum(twists[:-1, 2], twists[1:, 2]) * element.radius
    for rate, way in ((faster + turning, element.trunk_way), (arm_rate + faster + turning, element.way)):
        way[1:] = np.cumsum((rate * h / cuts)[interval])
    return element


def _fastest(positions: Array, velocities: Array, h: Array) -> Array:
    """The highest speed of each joint on the cubic between each two samples (k - 1, n)."""
    step, h = np.diff(positions, axis=0), h[:, None]
    v0, v1 = velocities[:-1], velocities[1:]
    a, b = 3 * h * (v0 + v1) - 6 * step, 6 * step - 2 * h * (2 * v0 + v1)
    with np.errstate(divide="ignore", invalid="ignore"):
        where = -b / (2 * a)
        vertex = np.where((where > 0) & (where < 1), np.abs(v0 - b**2 / (4 * a * h)), 0.0)
    out: Array = np.maximum(np.maximum(np.abs(v0), np.abs(v1)), np.nan_to_num(vertex))
    return out
