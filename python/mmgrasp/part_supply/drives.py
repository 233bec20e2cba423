"""Every drive of a plan as plan.json has it: the legs of the route, and those to the goal and back with a full bin or a part in the hand."""

from __future__ import annotations

from typing import Any


def carried_in_hand(plan: dict[str, Any]) -> bool:
    """Whether the robot has no bin: each part rides to the goal in the hand, and is let go there."""
    return "unload_region" in plan["scenario"]


def unloading_after(plan: dict[str, Any], pick: int) -> list[tuple[str, dict[str, Any]]]:
    """The drives after a pick that filled the bin or the hand, each with where it leads; none for other picks."""
    for unloading in plan.get("unloadings", []):
        if unloading["after_pick"] == pick:
            back = [(f"stop {plan['picks'][pick]['stop'] + 1} again", unloading["back"])] if "back" in unloading else []
            return [("the goal to unload", unloading["to_goal"]), *back]
    return []


def all_drives(plan: dict[str, Any]) -> list[dict[str, Any]]:
    """All legs, those of the route first."""
    extra = [leg for pick in range(len(plan["picks"])) for _, leg in unloading_after(plan, pick)]
    return [*plan["route"], *extra]
