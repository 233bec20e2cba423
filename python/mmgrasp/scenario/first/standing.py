"""How a robot stands while it drives: its arms folded over the base."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._core import CollisionChecker, Hand, JointGroup, LinkShape, Robot, World
from ..._progress import Progress
from .arm import Arm
from .tree import Tree, box_around

_DRAWS = 3000  # configurations drawn at random
_STEPS = 1500  # attempts to better the best of them
_UNKNOWN = 0.2  # half a side of a base without shapes [m]
_SUNK = 0.02  # a robot that reaches lower below its root frame stands on a ground below it [m]
_MARGIN = 0.01  # bodies that do not belong together keep so far apart [m]
_STATES = ("tuck", "home", "rest", "stow", "fold", "park", "travel")  # words in names of SRDF states
_LEAST_NAMED = 4  # joints of the arm that such a state names
_WORSE = 0.15  # a named state may stick out so much farther than what was found [m]


@dataclass(frozen=True)
class Outline:
    """The box around all that arms and heads do not move, in the root frame [m]; it stands on the ground."""

    low: np.ndarray
    high: np.ndarray

    def outside(self, points: np.ndarray) -> np.ndarray:
        """How far points (n, 2) lie outside of it, seen from above [m]."""
        return np.asarray(
            np.linalg.norm(np.maximum(np.maximum(self.low[:2] - points, points - self.high[:2]), 0), axis=1)
        )


@dataclass
class Home:
    """The arm's joints while driving, and those of what else moves on the robot."""

    arm: dict[str, float]
    others: dict[str, float]
    reason: str
    overhang: float  # how far it sticks out of the base's outline [m]


def outline_of(robot: Robot, wheels: list[str]) -> Outline:
    """The box around the links that no joint but a wheel's moves."""
    tree = Tree(robot)
    still = [link for link in robot.links if not set(tree.path(link)) - set(wheels)]
    low, high = box_around(robot, robot.link_poses(), still) or (np.full(3, -_UNKNOWN), np.full(3, _UNKNOWN))
    low[2] = low[2] if low[2] < -_SUNK else 0.0
    return Outline(low, high)


def _resting_joints(
    robot: Robot, arm: Arm, wheels: list[str], group: JointGroup, fingers: dict[str, float]
) -> dict[str, float]:
    """Joints of neither arm nor hand: at 0 or as near to it as their limits let, where that makes nothing touch; else in their middle, or at an end."""
    held: dict[str, float] = {}
    values: dict[str, list[float]] = {}
    for joint in robot.joint_table:
        name = joint["name"]
        if joint["type"] not in ("revolute", "prismatic", "continuous") or joint["mimic"] is not None:
            continue
        if name not in (*arm.joints, *arm.hand_joints, *wheels):
            low, high = (float(x) if np.isfinite(x) else 0.0 for x in (joint["lower"], joint["upper"]))
            held[name] = min(max(0.0, low), high)
            values[name] = [(low + high) / 2, high, low]
    middle = (group.sample_lower + group.sample_upper) / 2

    def contacts() -> int:
        return len(CollisionChecker(robot, World(), group.with_reference({**fingers, **held})).contacts(middle))

    least = contacts()
    for name, others in values.items():
        for value in others if least else []:
            before, held[name] = held[name], value
            if (now := contacts()) < least:
                least = now
            else:
                held[name] = before
    return held


def find_home(
    robot: Robot,
    arm: Arm,
    group: JointGroup,
    hand: Hand,
    wheels: list[str],
    outline: Outline,
    progress: Progress = None,
) -> Home:
    """An SRDF state that keeps the arm over the base, else the best configuration found; other arms are folded first.

    Deterministic: drawn with a fixed seed.
    """
    tree = Tree(robot)
    others = _resting_joints(robot, arm, wheels, group, hand.joint_values(0.0))
    for i, end in enumerate(arm.others):
        if progress is not None:
            progress("folding the arms", i / (1 + len(arm.others)))
        chain = [n for n in tree.path(end) if n in others and n not in arm.joints]
        if not chain:
            continue
        other = robot.group(base_link=tree.joints[chain[0]]["parent"], tip=end)
        fold = _Fold(robot, other.with_reference({**others, **hand.joint_values(0.0)}), outline)
        q = fold.best()
        if (named := fold.named(fold.overhang(q) + _WORSE)) is not None:
            q = named[1]
        others |= {name: value for name, value in _named(other, q).items() if name in chain}
    if progress is not None:
        progress("folding the arms", 1 - 1 / (1 + len(arm.others)))
    fold = _Fold(robot, group.with_reference({**others, **hand.joint_values(0.0)}), outline)
    q = fold.best()
    reason = "found by a search: folded as near to the base as it gets"
    if (named := fold.named(fold.overhang(q) + _WORSE)) is not None:
        q, reason = named[1], f'the state "{named[0]}" of its SRDF'
    if progress is not None:
        progress("folding the arms", 1.0)
    return Home(_named(group, q), others, reason, fold.overhang(q))


def _named(group: JointGroup, q: np.ndarray) -> dict[str, float]:
    """Values by joint, to four digits where these lie within the limits."""
    rounded = np.round(q, 4) + 0.0
    q = np.where((rounded >= group.lower) & (rounded <= group.upper), rounded, q)
    return {name: float(value) for name, value in zip(group.names, q, strict=True)}


class _Fold:
    """Searches the configuration of one arm that sticks out of the outline least and touches nothing."""

    def __init__(self, robot: Robot, group: JointGroup, outline: Outline) -> None:
        self.group = group
        self.outline = outline
        self.checker = CollisionChecker(robot, World(), group)
        still, moved = group.link_poses(self._middle()), group.link_poses(self._middle() + 1e-3)
        self.balls = [
            (link, *_ball(shape))
            for link in robot.links
            if np.abs(still[link] - moved[link]).max() > 1e-9
            for shape in robot.collisions(link)
        ]

    def _middle(self) -> np.ndarray:
        return np.asarray((self.group.sample_lower + self.group.sample_upper) / 2)

    def overhang(self, q: np.ndarray) -> float:
        """How far the balls around its shapes stick out of the outline [m]."""
        return float(max((self._outside(q) + [r for *_, r in self.balls]).max(), 0)) if self.balls else 0.0

    def _outside(self, q: np.ndarray) -> np.ndarray:
        poses = self.group.link_poses(q)
        return self.outline.outside(np.array([(poses[link] @ c)[:2] for link, c, _ in self.balls]))

    def cost(self, q: np.ndarray) -> float:
        """The farthest, and a tenth of the mean, with a fine for each contact and for what comes too near."""
        if not self.balls:
            return 0.0
        out = self._outside(q)
        cost = float(out.max() + 0.1 * out.mean())
        contacts = len(self.checker.contacts(q))
        if contacts:
            return cost + 10.0 * contacts
        return cost + 10.0 * max(0.0, _MARGIN - self.checker.distance(q).value)

    def named(self, most: float) -> tuple[str, np.ndarray] | None:
        """The first SRDF state, by name, that says how this arm is folded, is free and sticks out at most so far [m]; a lift it does not mention stays low."""
        states = {name: state for of in self.group.robot.group_states.values() for name, state in of.items()}
        names = self.group.names
        for name, state in sorted(states.items()):
            if not any(word in name.lower() for word in _STATES) or len(set(names) & set(state)) < _LEAST_NAMED:
                continue
            rest = np.clip(np.zeros(len(names)), self.group.sample_lower, self.group.sample_upper)
            q = np.array([state.get(joint, value) for joint, value in zip(names, rest, strict=True)])
            if self.checker.is_free(q) and self.overhang(q) <= most:
                return name, q
        return None

    def best(self) -> np.ndarray:
        """The best of configurations drawn at random, bettered by steps that shrink."""
        random = np.random.default_rng(1)
        low, high = self.group.sample_lower, self.group.sample_upper
        drawn = [self._middle(), np.clip(np.zeros(len(low)), low, high), *random.uniform(low, high, (_DRAWS, len(low)))]
        free = self.checker.are_free(np.array(drawn))
        costs = [self.cost(q) for q, ok in zip(drawn, free, strict=True) if ok]
        kept = [q for q, ok in zip(drawn, free, strict=True) if ok]
        if not kept:
            kept = drawn[:300]
            costs = [self.cost(q) for q in kept]
        best = int(np.argmin(costs))
        q, cost = kept[best], costs[best]
        for i in range(_STEPS):
            scale = 0.3 * (1 - i / _STEPS) + 0.01
            trial = np.clip(q + random.normal(0, scale, len(q)) * np.minimum(high - low, 1.0), low, high)
            if (new := self.cost(trial)) < cost:
                q, cost = trial, new
        return np.asarray(q)


def _ball(shape: LinkShape) -> tuple[np.ndarray, float]:
    low, high = LinkShape(shape.shape, shape.pose).bounds
    return np.append((low + high) / 2, 1.0), float(np.linalg.norm(high - low) / 2)
