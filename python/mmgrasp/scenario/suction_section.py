"""A `gripper` of suction cups: its key `suction`."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import Hand, InvalidInput, LinkShape, Robot, Suction, SuctionCup
from ..documents.reading import Node

MOST_CUPS = 100
PAST_RIM = 1e-5  # a body may reach so far past the rims' plane [m]


def read_cups(node: Node, robot: Robot, tool_link: str, approach: np.ndarray, payload: float) -> Hand:
    """The hand of the section `gripper`, whose links are known to the robot."""
    suction = node["suction"].mapping("cups", "max_gap vacuum friction safety")
    cups = suction["cups"].elements()
    if len(cups) > MOST_CUPS:
        suction["cups"].fail(f"must be at most {MOST_CUPS} cups")
    read = [_read_cup(cup, approach) for cup in cups]
    options: dict[str, Any] = {}
    for key in ("max_gap", "vacuum", "friction", "safety"):
        if key in suction:
            options[key] = suction[key].number(above=0)
            try:
                Suction(read, **{key: options[key]})
            except InvalidInput as error:
                suction[key].fail(str(error))
    with suction.blamed():
        own = Suction(read, **options)
    links = [link.raw for link in node["cup_links"].elements()]
    with node.blamed():
        hand = Hand.of_cups(tool_link, approach=approach, suction=own, cup_links=links, payload=payload)
    _check_rims_lead(node["cup_links"], robot, hand)
    return hand


def _read_cup(node: Node, approach: np.ndarray) -> SuctionCup:
    node.mapping("radius", "xyz")
    xyz = np.array(node["xyz"].numbers(3)) if "xyz" in node else np.zeros(3)
    if abs(xyz @ approach) > 1e-6:
        node["xyz"].fail(
            f"lies {xyz @ approach:g} m along approach from the tool frame: rims lie in the plane through its origin, across approach"
        )
    cup = SuctionCup(xyz, node["radius"].number(above=0))
    try:
        Suction([cup])
    except InvalidInput as error:
        node["radius"].fail(str(error))
    return cup


def _check_rims_lead(node: Node, robot: Robot, hand: Hand) -> None:
    """Nothing of the cups reaches past the rims: it would stand in the part."""
    to_z = np.eye(4)
    side = np.cross(hand.approach, hand.closing)
    to_z[:3, :3] = np.vstack((hand.closing, side, hand.approach))
    poses = robot.link_poses()
    for link in node.elements():
        T_tool_link = np.linalg.inv(poses[hand.tool_link]) @ poses[link.raw]
        for shape in robot.collisions(link.raw):
            past = LinkShape(shape.shape, to_z @ T_tool_link @ shape.pose).bounds[1][2]
            if past > PAST_RIM:
                link.fail(
                    f"reaches {1000 * past:.3g} mm past the plane of the rims, the one through the tool frame across approach: "
                    "the tool frame must lie where the cups end"
                )
