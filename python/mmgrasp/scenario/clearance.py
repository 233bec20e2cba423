"""The key `clearance` of the section `gripper`: free space on either side of a part, which an opening must leave."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from .._core import Hand
from ..documents.reading import Node

if TYPE_CHECKING:
    from .tray_section import TraySetup

_ROUNDING = 1e-9  # [m]


def check_clearance(key: Node | None, hands: Collection[Hand]) -> None:
    """Refuses a stated clearance that no part would get, however thin: none of the hands (types of one) opens so far."""
    if key is None:
        return
    most = max((hand.max_opening - hand.min_opening) / 2 for hand in hands)
    if 0 < most < key.number() - _ROUNDING:
        key.fail(
            f"must be at most {most:.4g} m, half of what the gripper opens by: no part would have it on both sides"
        )


def warn_of_little_room(key: Node | None, hand: Hand, trays: Collection[TraySetup]) -> None:
    """Tells of each type to be picked that the hand cannot open for by clearance on both sides, in none of its grasps: it comes with less.

    A clearance that nobody stated is a wish.
    """
    if key is None:
        return
    narrowest: dict[str, float] = {}
    for tray in trays:
        for part in tray.tray.parts:
            if part.name in tray.targets and part.grasps:
                kind = tray.kinds.get(part.name, part.name)
                width = min(grasp.opening for grasp in part.grasps)
                narrowest[kind] = min(width, narrowest.get(kind, width))
    for kind, width in narrowest.items():
        left = (hand.max_opening - width) / 2
        if left + _ROUNDING < hand.clearance:
            key.warn(
                f"{hand.clearance:.4g} m is more than {kind} gets, {width:.4g} m wide where it is narrowest: the gripper, which opens "
                f"{hand.max_opening:.4g} m, comes to it with {left:.4g} m on either side; must be at most that to be kept"
            )
