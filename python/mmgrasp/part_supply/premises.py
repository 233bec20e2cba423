"""What a proven least number of stops rests on: it is the least for these headings, cells, grasps and this search of the arm."""

from __future__ import annotations

import math
from typing import Any, NotRequired, TypedDict

from .. import _core


class Premises(TypedDict):
    """What a proven least number of stops holds for: the section `premises` of plan.json (docs/plan_format.md)."""

    headings: dict[str, list[float]]  # of the base, by tray [rad]
    shared_headings: bool  # trays that list none were also tried at other trays', where one of these can be served
    positioning_uncertainty: float  # radius of the discs [m]
    cell: float  # edge of the base grid's cells [m]
    max_distance: float  # of cells from the tray's middle [m]; 0: as far as the arm reaches
    grasps: int  # of all parts
    ik_seeds: int  # configurations of the database refined for each grasp and base pose: more than asked for where a part has few grasps
    database: dict[str, Any]  # options of the reachability database, as the scenario has them
    search_finished: bool  # the proof was
    chosen_parts: NotRequired[
        int
    ]  # so many were asked for by number and chosen before: other choices may do with fewer stops


def premises(plan: dict[str, Any]) -> Premises:
    """The section `premises` of a plan.json, from its sections `scenario`, `grid` and `proven_minimal`."""
    scenario = plan["scenario"]
    options, reach = scenario["options"], scenario["reach"]
    chosen = sum(row["count"] for tray in scenario["trays"] for row in tray.get("wanted", {}).values())
    known: Premises = {
        "headings": {tray["name"]: tray["headings"] for tray in scenario["trays"]},
        "shared_headings": any(tray["shares_headings"] for tray in scenario["trays"]),
        "positioning_uncertainty": scenario["positioning_uncertainty"],
        "cell": plan["grid"]["resolution"],
        "max_distance": options.get("grid_max_distance", 0.0),
        "grasps": sum(len(part["grasps"]) for part in scenario["parts"]),
        "ik_seeds": _core._ik_seeds_of_a_grasp(options["ik_seeds"], [len(part["grasps"]) for part in scenario["parts"]])
        if "ik_seeds" in options
        else 0,
        "database": dict(reach),
        "search_finished": plan["proven_minimal"],
    }
    return {**known, "chosen_parts": chosen} if chosen else known


def premises_text(said: Premises) -> str:
    """The premises as the end of a sentence, e.g. "for base headings of 0°, 90° (each tray at its own, and at another's where that one is served, too), ..."."""
    by_tray = [sorted({round(math.degrees(h)) % 360 for h in headings}) for headings in said["headings"].values()]
    angles = sorted({angle for headings in by_tray for angle in headings})
    elsewhere = ", and at another's where that one is served, too" if said["shared_headings"] else ""
    own = f" (each tray at its own{elsewhere})" if any(headings != angles for headings in by_tray) else ""
    known = [
        f"base headings of {', '.join(f'{angle}°' for angle in angles)}{own}",
        f"base cells of {100 * said['cell']:g} cm",
        f"discs of {said['positioning_uncertainty']:g} m",
        f"{said['grasps']} grasps",
    ]
    if "chosen_parts" in said:
        known.append(f"the {said['chosen_parts']} parts chosen of those asked for by number")
    if "samples" in said["database"]:
        known.append(f"arm postures sought from a database of {said['database']['samples']:,} draws")
    return "for " + ", ".join(known)
