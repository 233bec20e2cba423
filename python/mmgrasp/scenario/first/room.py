"""A first room: a counter with two trays of parts, before a wall or in a free place of a floor map, where the robot reaches them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..._core import CollisionChecker, Hand, InvalidInput, JointGroup, LinkShape, Outcome, Robot, World, pose
from ..._progress import Progress
from .bin import TURNS, looking_down
from .map_grid import MapGrid
from .standing import Outline
from .tree import box_around

TRAY = np.array([0.30, 0.40, 0.06])
COUNTER = np.array([0.50, 1.60])  # depth, width [m]
_HEIGHTS = (0.72, 0.6, 0.85, 0.45, 0.95, 0.3, 0.15, 0.05)  # of the counter above the ground, the likeliest first [m]
_EDGE = 0.03  # a tray stands so far behind the counter's front [m]
_BETWEEN = 0.80  # from tray to tray [m]
_GAPS = (0.06, 0.12, 0.2, 0.3)  # between the base and the counter [m]
_ASIDE = (0.0, -0.25, 0.25, -0.45, 0.45)  # where the base stands beside the tray's middle [m]
_PLACES = [np.array([x, y, 0.0]) for x in (-0.08, 0.08) for y in (-0.12, 0.0, 0.12)]  # of the tool frame in a tray [m]
_ABOVE = 0.006  # a tray's floor lies so far above the counter [m]: its thickness, and a gap
_HELD = 0.75  # of a part's height, where the hand holds it
_OVER_FLOOR = 0.008  # fingers end at least so far above what the part stands on [m]
_ENOUGH = 0.7  # share of these places that must be reached from one place of the base
_ROOM = 0.10  # around the turning base that is kept free on a map [m]
_BEHIND = 0.3  # a wall so far behind the counter is what it stands at [m]
_AHEAD = 1.2  # start and goal lie so far before the counter in an empty room [m]


@dataclass
class Layout:
    """Where counter and robot stand, each x, y, heading; the counter's is that of the base in front of it, its place the middle of its floor."""

    counter: np.ndarray
    start: np.ndarray
    goal: np.ndarray
    doubts: list[str] = field(default_factory=list)


def fitting_part(robot: Robot, hand: Hand) -> np.ndarray:
    """Sizes of a box that the hand takes with room to spare [m]: 0.6 of its free opening wide, at most 5 cm, and so high that fingers which
    curl around it do not reach what it stands on."""
    free = hand.max_opening - 2 * hand.clearance
    if free < 0.004:
        raise InvalidInput(
            f"the hand opens {hand.max_opening * 1000:.1f} mm, less than its clearance of {hand.clearance * 1000:.0f} mm on either side and a part "
            "of 4 mm: state a smaller clearance, or another hand"
        )
    width = round(min(0.6 * free, 0.05), 3)
    needed = (_past_tool_frame(robot, hand, width) + _OVER_FLOOR) / _HELD
    return np.array([width, round(1.4 * width, 3), round(max(0.06, 1.2 * width, needed), 3)])


def _past_tool_frame(robot: Robot, hand: Hand, width: float) -> float:
    """How far the fingers reach past the tool frame along the approach while they close on something so wide [m]."""
    deepest = 0.0
    for opening in np.linspace(width, hand.pregrasp_opening(1.4 * width), 5):
        poses = robot.link_poses(hand.joint_values(float(opening)))
        box = box_around(robot, poses, hand.finger_links, hand.tool_link)
        if box is not None:
            deepest = max(deepest, float(np.sum(np.maximum(box[0] * hand.approach, box[1] * hand.approach))))
    return deepest


def counter_height(
    group: JointGroup, hand: Hand, home: np.ndarray, outline: Outline, part: np.ndarray, progress: Progress = None
) -> tuple[float, float]:
    """Height of the counter [m], and the share of places in a tray that the hand reaches there from above, from the best place of the base.

    The first of the usual heights where that share is enough, else the best.
    """
    tries = []
    for i, height in enumerate(_HEIGHTS):
        if progress is not None:
            progress("looking for a height of the counter", i / len(_HEIGHTS))
        tries.append((_reached(group, hand, home, outline, part, height), height))
        if tries[-1][0] >= _ENOUGH:
            break
    reached, height = next((t for t in tries if t[0] >= _ENOUGH), max(tries))
    return height, reached


def _reached(
    group: JointGroup, hand: Hand, home: np.ndarray, outline: Outline, part: np.ndarray, height: float
) -> float:
    """The share of places of a tray that the hand reaches in some turn, from the best place of the base."""
    ground = float(outline.low[2])
    best = 0.0
    for gap in _GAPS:
        world = World()
        front = outline.high[0] + gap
        middle = [front + COUNTER[0] / 2, 0.0, ground + height / 2]
        world.add_box("counter", [COUNTER[0], 3 * COUNTER[1], height], pose(middle))
        world.add_floor(group, ground)
        if not CollisionChecker(group.robot, world, group).is_free(home):
            continue
        for aside in _ASIDE:
            tray = np.array([front + _EDGE + TRAY[0] / 2, aside, ground + height + _ABOVE + _HELD * part[2]])
            found = [_in_some_turn(group, hand, home, world, tray + place) for place in _PLACES]
            best = max(best, sum(found) / len(found))
            if best >= _ENOUGH:
                return best
    return best


def _in_some_turn(group: JointGroup, hand: Hand, home: np.ndarray, world: World, point: np.ndarray) -> bool:
    """Whether the arm brings the hand there from above, in one of its turns about the vertical."""
    poses = (looking_down(hand, point, 2 * np.pi * turn / TURNS) for turn in range(TURNS))
    return any(group.ik(T, home, world, restarts=6).outcome == Outcome.solved for T in poses)


def place_room(outline: Outline, walls: list[LinkShape] | None) -> Layout:
    """Before the robot in an empty room, or where a map's walls leave room for it."""
    reach = float(np.linalg.norm(np.maximum(np.abs(outline.low[:2]), np.abs(outline.high[:2]))))
    if walls is None:
        front = outline.high[0] + _AHEAD
        counter = np.array([front + COUNTER[0] / 2, 0.0, 0.0])
        return Layout(counter, np.array([0.0, -COUNTER[1] / 2, 0.0]), np.array([0.0, COUNTER[1] / 2, 0.0]))
    return _place_on_map(reach, outline, walls)


def _place_on_map(reach: float, outline: Outline, walls: list[LinkShape]) -> Layout:
    grid = MapGrid(walls)
    free = grid.free(reach + _ROOM)
    if not free.any():
        raise InvalidInput(
            f"the map has no free place of {2 * (reach + _ROOM):.2f} m across, which the base needs: look at its resolution, or at `unknown`"
        )
    largest = grid.largest_piece(free)
    along = outline.high[0] + 0.15 + COUNTER[0] / 2  # from the base before it to the counter's middle
    cells, best = grid.middles(largest), None
    for heading in np.arange(8) * np.pi / 4:
        ahead = np.array([np.cos(heading), np.sin(heading)])
        middle = cells + along * ahead
        room = grid.rectangle_free(middle, heading, COUNTER)
        behind = grid.taken(middle + (COUNTER[0] / 2 + _BEHIND) * ahead)  # with its back to a wall it is out of the way
        for k in np.flatnonzero(room & behind)[:1].tolist() or np.flatnonzero(room)[:1].tolist():
            candidate = (not behind[k], heading, np.array([*middle[k], heading]), cells[k])
            if best is None or candidate[:2] < best[:2]:
                best = candidate
    if best is None:
        raise InvalidInput(
            f"the map has no free place for a counter of {COUNTER[0]:g} x {COUNTER[1]:g} m with the base before it"
        )
    _, heading, counter, before = best
    left = largest & ~grid.near_rectangle(counter, COUNTER + 2 * (reach + _ROOM))
    left = grid.piece_of(left, before) if left.any() else left
    if not left.any():
        only = np.array([*before, heading])
        return Layout(counter, only, only, ["start and goal are one: the map has no second free place"])
    cells = grid.middles(left)
    far = np.linalg.norm(cells - before, axis=1)
    start, goal = cells[np.argmin(np.abs(far - 2.0))], cells[np.argmin(np.abs(far - 3.0))]
    return Layout(counter, np.array([*start, heading]), np.array([*goal, heading]))


def tray_poses(counter: np.ndarray, top: float) -> list[np.ndarray]:
    """x, y, z, heading of the floors of two trays side by side at the front edge of a counter whose top is so high [m]."""
    c, s = np.cos(counter[2]), np.sin(counter[2])
    back = -COUNTER[0] / 2 + _EDGE + TRAY[0] / 2
    return [
        np.array([counter[0] + c * back - s * side, counter[1] + s * back + c * side, top + _ABOVE, counter[2]])
        for side in (-_BETWEEN / 2, _BETWEEN / 2)
    ]
