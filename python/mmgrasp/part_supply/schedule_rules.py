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
    picked: dict[str, str] = {}
    for plan, room, name in zip(plans, rooms, names, strict=True):
        found = differences(rooms[0], room, limit=1)
        if found:
            raise InvalidInput(
                f"{name}: scenario.obstacles{found[0][0]}: differs from that of {names[0]}: plans of one room have the same obstacles"
            )
        _check_trays(plans[0], plan, names[0], name)
        for part in dict.fromkeys(pick["part"] for pick in plan["picks"]):
            if part in picked:
                raise InvalidInput(f"{name}: picks {part!r}, which {picked[part]} picks, too")
            picked[part] = name


def _check_trays(first: dict[str, Any], plan: dict[str, Any], first_name: str, name: str) -> None:
    """A tray that both have stands at one place and holds the same parts there."""
    keys = ("name", "tray", "pose", "shapes")
    trays = [{tray["name"]: tray["pose"] for tray in one["scenario"]["trays"]} for one in (first, plan)]
    parts: list[dict[str, Any]] = [{}, {}]
    for own, one in zip(parts, (first, plan), strict=True):
        for part in one["scenario"]["parts"]:
            own.setdefault(part["tray"], {})[part["name"]] = {key: part[key] for key in keys}
    for tray in trays[0].keys() & trays[1].keys():
        found = differences(
            {"pose": trays[0][tray], "parts": parts[0].get(tray, {})},
            {"pose": trays[1][tray], "parts": parts[1].get(tray, {})},
            limit=1,
        )
        if found:
            raise InvalidInput(
                f"{name}: tray {tray}{found[0][0]}: differs from that of {first_name}: plans of one room have the same trays and parts"
            )
