"""How a robot drives, told from its wheels."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from ..._core import InvalidInput, Robot
from .tree import Tree, box_around

_ON_GROUND = 0.03  # a wheel's lowest point is at most so far above the robot's [m]
_LEVEL = 0.1  # sine of the largest tilt of an axle
_PARALLEL = 0.98  # cosine between axles, or joints, that count as parallel
_SAME_AXLE = 0.05  # wheels nearer than this along the way they roll share an axle [m]
_LIMITLESS = 1e3  # a wheel's joint that may turn faster has no limit in its file [rad/s]
_OMNI_WORDS = ("mecanum", "omni_wheel", "omniwheel", "omni_base", "swedish")


@dataclass(frozen=True)
class Drive:
    """How the base moves, and what told so."""

    base: str  # diff_drive or omni
    reason: str
    sure: bool
    wheels: list[str]  # joints
    separation: float | None  # of the two wheels of a diff_drive, of left and right Mecanum wheels [m]
    wheelbase: float | None = None  # of four Mecanum wheels [m]


def read_drive(robot: Robot, urdf_text: str, base: str | None) -> Drive:
    """The kind of base, by its wheels or as stated. InvalidInput where neither tells."""
    wheels = find_wheels(robot)
    mecanum = _mecanum(wheels) if base in (None, "omni") and "mecanum" in urdf_text.lower() else None
    if base is not None and mecanum is None:
        return Drive(base, "as asked for", True, list(wheels), _separation(wheels) if base == "diff_drive" else None)
    if not wheels:
        raise InvalidInput(
            f"{robot.name}: no joint turns a wheel, so that nothing tells how it drives: say --base diff_drive or --base omni, "
            "or put the arm on a base: init BASE.urdf --mount ARM.urdf=LINK"
        )
    word = next((word for word in _OMNI_WORDS if word in urdf_text.lower()), None)
    axes = np.array([wheel.axis for wheel in wheels.values()])
    parallel = (np.abs(axes @ axes[0]) > _PARALLEL).all()
    count = f"{len(wheels)} wheels"
    if mecanum is not None:
        reason = f'{count}, and its file says "mecanum"' if base is None else "as asked for"
        return Drive("omni", reason, True, list(wheels), *mecanum)
    if all(wheel.steered for wheel in wheels.values()):
        return Drive("omni", f"{count}, all of which are steered", True, list(wheels), None)
    if not parallel:
        return Drive("omni", f"{count} whose axles are not parallel", True, list(wheels), None)
    if word is not None:
        return Drive("omni", f'{count}, and its file says "{word}"', True, list(wheels), None)
    if _axles(wheels) == 1:
        return Drive("diff_drive", f"{count} on one axle", True, list(wheels), _separation(wheels))
    reason = f"{count} on parallel axles, which may be skid-steered or Mecanum wheels: both can drive so; --base omni if it is so"
    return Drive("diff_drive", reason, False, list(wheels), None)


@dataclass(frozen=True)
class _Wheel:
    axis: np.ndarray  # unit, in the root frame
    middle: np.ndarray  # of the wheel's frame, in the root frame
    steered: bool  # hangs on a joint that turns about the vertical


def find_wheels(robot: Robot) -> dict[str, _Wheel]:
    """Joints without an end whose level axles turn links that stand on the ground, as the robot stands when all its joints are 0; castors are left
    out where other wheels drive."""
    tree, poses = Tree(robot), robot.link_poses()
    boxes = {link: box_around(robot, poses, [link]) for link in robot.links}
    lowest = {link: float(box[0][2]) if box else np.inf for link, box in boxes.items()}
    ground = min(lowest.values())
    wheels = {}
    for joint in robot.joint_table:
        named = "wheel" in f"{joint['name']} {joint['child']}".lower()
        endless = joint["type"] == "continuous" or (
            named and joint["type"] == "revolute" and joint["upper"] - joint["lower"] > 2 * np.pi
        )
        if not endless or joint["mimic"] is not None:
            continue
        axis = tree.axis(joint["name"])
        if abs(axis[2]) < _LEVEL and (named or lowest[joint["child"]] < ground + _ON_GROUND):
            wheels[joint["name"]] = _Wheel(axis, poses[joint["child"]][:3, 3], _steered(tree, joint["parent"]))
    straight = {name: wheel for name, wheel in wheels.items() if not wheel.steered}
    return straight or wheels


def _steered(tree: Tree, link: str) -> bool:
    """Whether what carries a wheel hangs on a joint that turns about the vertical."""
    body = tree.body(link)
    if body not in tree.into or tree.joints[tree.into[body]]["type"] == "prismatic":
        return False
    return bool(abs(tree.axis(tree.into[body])[2]) > _PARALLEL)


def _axles(wheels: dict[str, _Wheel]) -> int:
    axis = next(iter(wheels.values())).axis
    roll = np.cross(axis, [0, 0, 1])
    along = sorted(float(roll @ wheel.middle) for wheel in wheels.values())
    return 1 + sum(b - a > _SAME_AXLE for a, b in itertools.pairwise(along))


def _separation(wheels: dict[str, _Wheel]) -> float | None:
    """Between the two wheels on one axle [m]."""
    if len(wheels) != 2 or _axles(wheels) != 1:
        return None
    first, second = wheels.values()
    return float(abs(first.axis @ (second.middle - first.middle)))


def _mecanum(wheels: dict[str, _Wheel]) -> tuple[float, float] | None:
    """Track and wheelbase [m] of four wheels at the corners of a rectangle, with parallel axles that nothing steers."""
    if len(wheels) != 4 or any(wheel.steered for wheel in wheels.values()):
        return None
    axis = next(iter(wheels.values())).axis
    if any(abs(wheel.axis @ axis) <= _PARALLEL for wheel in wheels.values()):
        return None
    roll = np.cross(axis, [0, 0, 1])
    corners = np.array([[axis @ wheel.middle, roll @ wheel.middle] for wheel in wheels.values()])
    offsets = corners - corners.mean(axis=0)
    sides = 2 * np.abs(offsets).mean(axis=0)
    if len(np.unique(offsets > 0, axis=0)) != 4 or np.abs(2 * np.abs(offsets) - sides).max() > _SAME_AXLE:
        return None
    return float(sides[0]), float(sides[1])


def wheel_speed(robot: Robot, wheels: list[str]) -> float | None:
    """How fast the slowest wheel's rim runs at its joint's limit [m/s]; None where a wheel has no shape or no limit."""
    poses, speeds = robot.link_poses(), []
    for joint in robot.joint_table:
        if joint["name"] not in wheels:
            continue
        box = box_around(robot, poses, [joint["child"]])
        if box is None or not 0 < joint["velocity"] < _LIMITLESS:
            return None
        speeds.append(float((box[1] - box[0])[2] / 2 * joint["velocity"]))
    return min(speeds) if speeds else None
