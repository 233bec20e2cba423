"""What plans must have in common to be scheduled together: one room, and no part that two of them pick."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .._core import InvalidInput
from .verification import differences

FORMAT, VERSION = "mmgrasp-schedule", 1
MOST_ROBOTS = 16
LEAST_CLEARANCE, MOST_CLEARANCE = 0.01, 10.0  # [m]


def check_same_room(plans: Sequence[dict[str, Any]], names: Sequence[str]) -> None:
    """Raises InvalidInput for a plan that is not solved or whose parts are carried in the hand, for one of another room than the first, and for a part that
    two plans pick."""
    for plan, name in zip(plans, names, strict=True):
        if plan["outcome"] != "solved":
            raise InvalidInput(f"{name}: outcome = {plan['outcome']!r}: must be solved to be scheduled")
        if "unload_region" in plan["scenario"]:
            raise InvalidInput(
                f"{name}: scenario.unload_region: robots that carry parts in the hand are not scheduled with others: give the robot a bin (place_region)"
            )
    rooms = [{body["name"]: body for body in plan["scenario"]["obstacles"]} for plan in plans]
    picked: dict[tuple[str, str], str] = {}
    for plan, room, name in zip(plans, rooms, names, strict=True):
        found = differences(rooms[0], room, limit=1)
        if found:
            raise InvalidInput(
                f"{name}: scenario.obstacles{found[0][0]}: differs from that of {names[0]}: plans of one room have the same obstacles"
            )
        poses = {part["name"]: str(part["pose"]) for part in plan["scenario"]["parts"]}
        for pick in plan["picks"]:
            key = (pick["part"], poses[pick["part"]])
            if key in picked:
                raise InvalidInput(f"{name}: picks {pick['part']!r}, which {picked[key]} picks, too")
            picked[key] = name
