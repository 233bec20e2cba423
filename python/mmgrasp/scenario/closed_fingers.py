"""Fingers that touch each other when the hand is closed."""

from __future__ import annotations

import numpy as np

from .._core import CollisionChecker, Hand, JointGroup, Robot, World

_MEET = 1e-4  # fingers nearer than this meet [m]
_FLUSH = 1e-6  # links at rest nearer than this, or deeper in each other by less, lie flush [m]


def fingers_may_meet(robot: Robot, hand: Hand) -> Robot:
    """The robot whose collision checks leave out pairs of links that the hand's joints move and that touch when it is closed: they are made to."""
    open_, closed = (robot.link_poses(hand.joint_values(o)) for o in (hand.max_opening, hand.min_opening))
    in_hand = [
        [np.linalg.inv(poses[hand.tool_link]) @ poses[link] for link in robot.links] for poses in (open_, closed)
    ]
    driven = {link for link, a, b in zip(robot.links, *in_hand, strict=True) if np.abs(a - b).max() > 1e-9}
    pairs = robot.disabled_pairs
    kept = [(a, b, reason) for a, b, reason in pairs if reason != "never" or not {a, b} <= driven]  # "never" is a guess
    bare = robot.with_disabled_pairs(kept)
    group = bare.group(base_link=robot.links[0], tip=hand.tool_link).with_reference(hand.joint_values(hand.min_opening))
    near = CollisionChecker(bare, World(), group).distances((group.sample_lower + group.sample_upper) / 2, _MEET)
    meeting = {(pair.a, pair.b) for pair in near if {pair.a, pair.b} <= driven}
    if not meeting:
        return robot
    others = [(a, b, reason) for a, b, reason in pairs if not {(a, b), (b, a)} & meeting]
    return robot.with_disabled_pairs([*others, *((a, b, "default") for a, b in sorted(meeting))])


def held_links_may_meet(robot: Robot, arm: JointGroup, hand: Hand, held: dict[str, float]) -> Robot:
    """The robot whose collision checks leave out pairs of links that lie flush and that neither arm nor hand moves against each other.

    The closed fingers of a second hand, say: rounding would decide at each pose anew whether they touch. `held`: values of the other joints.
    """
    closed, opened = (arm.with_reference(held | hand.joint_values(o)) for o in (hand.min_opening, hand.max_opening))
    middle = (arm.sample_lower + arm.sample_upper) / 2
    flush = [
        (pair.a, pair.b)
        for pair in CollisionChecker(robot, World(), closed).distances(middle, _FLUSH)
        if abs(float(pair)) <= _FLUSH and {pair.a, pair.b} <= set(robot.links)
    ]
    if not flush:
        return robot
    places = [closed.link_poses(middle), closed.link_poses((middle + arm.sample_lower) / 2), opened.link_poses(middle)]
    apart = {(a, b): [np.linalg.inv(poses[a]) @ poses[b] for poses in places] for a, b in flush}
    resting = {pair for pair, Ts in apart.items() if max(np.abs(T - Ts[0]).max() for T in Ts) < 1e-9}
    others = [(a, b, reason) for a, b, reason in robot.disabled_pairs if not {(a, b), (b, a)} & resting]
    return robot.with_disabled_pairs([*others, *((a, b, "default") for a, b in sorted(resting))])
