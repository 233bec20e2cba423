"""Fingers that touch each other when the hand is closed."""

from __future__ import annotations

import numpy as np

from .._core import CollisionChecker, Hand, Robot, World

_MEET = 1e-4  # fingers nearer than this meet [m]


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
