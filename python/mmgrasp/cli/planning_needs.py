"""What a robot's files lack for planning: for motions of its arm, and for a whole round of part supply."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .._core import InvalidInput, Robot
from ..scenario.first.arm import Arm, find_arm
from ..scenario.first.drive import find_wheels, read_drive
from ..scenario.first.tool import find_tool
from ..scenario.first.tree import Tree

_RANK_SAMPLES = 64  # configurations at which an arm's Jacobian is looked at
_RANK_TOLERANCE = 1e-4  # singular values below this share of the largest count as zero; lengths are in metres


@dataclass
class PlanningNeeds:
    """`found` is what was understood, `problems` keep anything from being planned, `missing` only a whole round. What a scenario cannot add (an arm)
    is a problem of a robot whose base drives."""

    found: list[str] = field(default_factory=list)
    problems: list[str] = field(default_factory=list)
    missing: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)


def base_by_wheels(robot: Robot) -> str | None:
    """The kind of base that the wheels tell: diff_drive or omni; None: there are none."""
    text = "".join(source["urdf"] for source in robot.source.urdfs)
    return read_drive(robot, text, None).base if find_wheels(robot) else None


def planning_needs(robot: Robot) -> PlanningNeeds:
    """Looks at base, arm, hand, tool frame and bodies of a robot whose kind of base is known."""
    needs = PlanningNeeds()
    wheels = list(find_wheels(robot))
    _base(robot, needs)
    if robot.joints and not set(robot.joints) - set(wheels):
        needs.problems.append(
            "no arm: all its joints turn wheels; put one on it: mmgrasp init BASE.urdf --mount ARM.urdf=LINK"
        )
        return needs
    _still_joints(robot, needs)
    try:
        arm = find_arm(robot, wheels, None, None)
        robot.group(base_link=arm.base_link, tip=arm.hand_link)
    except InvalidInput as error:
        _lasting(robot, needs).append(str(error))
        return needs
    if not robot.has_srdf:
        needs.doubts.append(
            "no SRDF: groups, home and the pairs of links that may touch are not known; pairs are computed, and the arm is "
            f"named by its links (group: {{base_link: {arm.base_link}}}); one can be written by --write-srdf"
        )
    _arm(robot, arm, needs)
    _hand(robot, arm, needs)
    return needs


def _lasting(robot: Robot, needs: PlanningNeeds) -> list[str]:
    """Where a lack belongs that a scenario cannot make up for: who has a base that drives wants rounds."""
    return needs.missing if robot.base == "fixed" else needs.problems


def _base(robot: Robot, needs: PlanningNeeds) -> None:
    if not find_wheels(robot):
        if robot.base == "fixed":
            needs.missing.append(
                "a base that drives: no joint turns a wheel; say --base diff_drive or omni, or put the arm on a base (mmgrasp init BASE.urdf --mount ARM.urdf=LINK)"
            )
        return
    drive = read_drive(robot, "".join(source["urdf"] for source in robot.source.urdfs), None)
    needs.found.append(f"wheels     {drive.base}: {drive.reason}")
    if robot.base == "fixed":
        needs.missing.append(f"a base that drives: it was said to be fixed, its wheels tell {drive.base}")
    elif robot.base != drive.base and drive.sure:
        needs.doubts.append(f"base {robot.base} was asked for, its wheels tell {drive.base} ({drive.reason})")
    elif robot.base != drive.base or not drive.sure:
        needs.doubts.append(f"base {robot.base}: {drive.reason}")


def _still_joints(robot: Robot, needs: PlanningNeeds) -> None:
    for joint in robot.joint_table:
        if (
            joint["type"] in ("revolute", "prismatic")
            and not joint["upper"] > joint["lower"]
            and joint["mimic"] is None
        ):
            needs.doubts.append(
                f"joint {joint['name']}: limits [{joint['lower']:g}, {joint['upper']:g}] leave no room: it stands still"
            )


def arm_rank(robot: Robot, arm: Arm) -> int:
    """How many independent directions, of 6, the arm's last link moves in: the most at 64 configurations."""
    joints = robot.group(base_link=arm.base_link, tip=arm.hand_link)
    lower, upper = np.maximum(joints.lower, -np.pi), np.minimum(joints.upper, np.pi)
    moves = upper > lower
    rank = 0
    for q in np.random.default_rng(1).uniform(lower, upper, (_RANK_SAMPLES, len(lower))):
        sizes = np.linalg.svd(joints.jacobian(q)[:, moves], compute_uv=False)
        rank = max(rank, int((sizes > _RANK_TOLERANCE * max(float(sizes[0]), 1e-12)).sum()) if sizes.size else 0)
    return rank


def _arm(robot: Robot, arm: Arm, needs: PlanningNeeds) -> None:
    known = f" (group {arm.group})" if arm.group is not None else ""
    needs.found.append(f"arm        {len(arm.joints)} joints from {arm.base_link} to {arm.hand_link}{known}")
    rank = arm_rank(robot, arm)
    if rank < 6:
        _lasting(robot, needs).append(
            f"the arm of {len(arm.joints)} joints to {arm.hand_link} moves its hand in {rank} of 6 directions everywhere: from where "
            "the base stands hardly any grasp can be reached exactly"
        )
    tree = Tree(robot)
    bodies = [tree.joints[name]["child"] for name in [*arm.joints, *arm.hand_joints]]
    bare = [body for body in dict.fromkeys(bodies) if not any(robot.collisions(m) for m in tree.members(body))]
    if bare:
        needs.doubts.append(
            f"{len(bare)} moving bodies have no collision shape and pass through everything: {', '.join(bare[:6])}"
            + (", ..." if len(bare) > 6 else "")
        )


def _hand(robot: Robot, arm: Arm, needs: PlanningNeeds) -> None:
    try:
        tool = find_tool(robot, arm, None)
    except InvalidInput as error:
        needs.missing.append(f"a hand: {error}")
        return
    if tool is None:
        needs.missing.append(
            f"a hand: no fingers were found at {arm.hand_link}; mmgrasp init puts the shipped parallel gripper there, a scenario your own (robot.mount)"
        )
        return
    frame = "to be made between the finger tips (frames), as mmgrasp init does" if tool.frame else tool.link
    opening = f"opens {tool.hand.min_opening * 1000:.0f} to {tool.hand.max_opening * 1000:.0f} mm"
    needs.found.append(f"hand       {opening}, tool frame {frame}")
