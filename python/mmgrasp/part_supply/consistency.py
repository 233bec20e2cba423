"""What a plan says twice, or can be counted again from it, without kinematics or collisions."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from .. import _core
from .._core import verify as checks
from ..scenario.robot_section import BIN_LINK
from ..scenario.shapes import shape_to_dict
from ..scenario.tray_body import TrayBody
from .drives import all_drives
from .premises import premises

Plan = dict[str, Any]
_IDENTITY = {"xyz": [0.0, 0.0, 0.0], "quat_xyzw": [0.0, 0.0, 0.0, 1.0]}
_CLOSE = 1e-6  # [m], [rad]
_RADIUS_SLACK = 1e-9  # [m]; smaller differences of discs are rounding, for planners and the check alike


def check_consistency(plan: Plan) -> list[checks.Fault]:
    """Faults of a solved plan whose form is that of the schema."""
    rules = (
        *(_hand, _robot, _options, _trays, _chosen, _grid, _regions, _intersections, _stops, _counts),
        *(_route, _in_passing, _answer, _premises),
    )
    return [checks.Fault("wrong-values", where, message) for rule in rules for where, message in rule(plan)]


Found = Iterator[tuple[str, str]]
_SETS = ("intersections", "too_small_intersections")


def _hand(plan: Plan) -> Found:
    tool, tip = plan["scenario"]["gripper"]["tool_link"], plan["scenario"]["arm"]["tip_link"]
    if tool != tip:
        yield "scenario.gripper.tool_link", f"is {tool}, the arm ends at {tip}"


def _robot(plan: Plan) -> Found:
    robot, region = plan["scenario"]["robot"], plan["scenario"].get("place_region")
    for k, urdf in enumerate(robot.get("urdfs", [])):
        if not urdf["parent_link"] and not _same(urdf["pose"], _IDENTITY):
            yield f"scenario.robot.urdfs[{k}].pose", "moves the robot's root, which stands where the base does"
    for k, link in enumerate(robot.get("links", [])):
        if region is None or link["name"] != BIN_LINK or not link["shapes"]:
            continue
        if not _same(link["shapes"][0].get("size", [])[:2], region["size"]):
            yield f"scenario.robot.links[{k}]", "is not of the size of place_region"


def _options(plan: Plan) -> Found:
    scenario, options = plan["scenario"], plan["scenario"]["options"]
    if not scenario["obstacles"] and not scenario["trays"]:
        return
    known = _core._supply_option_table().keys() - {"threads"}
    for key in known ^ options.keys():
        yield f"scenario.options.{key}", "is missing" if key in known else "is no option"
    pairs = (
        ("grid_resolution", plan["grid"]["resolution"]),
        ("positioning_uncertainty", scenario["positioning_uncertainty"]),
    )
    for key, value in pairs:
        if key in options and abs(options[key] - value) > _CLOSE:
            yield f"scenario.options.{key}", f"is {options[key]:g}, elsewhere the plan says {value:g}"


def _same(a: Any, b: Any) -> bool:
    if isinstance(a, dict):
        return isinstance(b, dict) and a.keys() == b.keys() and all(_same(a[k], b[k]) for k in a)
    if isinstance(a, list):
        return isinstance(b, list) and len(a) == len(b) and all(map(_same, a, b))
    return abs(a - b) <= _CLOSE if isinstance(a, int | float) and isinstance(b, int | float) else bool(a == b)


def _trays(plan: Plan) -> Found:
    scenario = plan["scenario"]
    obstacles = {o["name"]: o for o in scenario["obstacles"]}
    for i, tray in enumerate(scenario["trays"]):
        where = f"scenario.trays[{i}]"
        measures, body = TrayBody.from_dict(tray), obstacles.get(f"tray {tray['name']}")
        if rule := measures.fault():
            yield where, rule
            continue
        walls = [shape_to_dict(shape) for shape in measures.shapes()]
        if tray.get("own_body"):  # then what holds the parts may be any obstacles
            if body is not None and not _same(body["pose"], tray["pose"]):
                yield where, "stands elsewhere than the obstacle of its name"
        elif body is None or not _same([body["pose"], body["shapes"]], [tray["pose"], walls]):
            yield where, "has no obstacle with its walls, pose and size"


def _chosen(plan: Plan) -> Found:
    """As many parts are picked as were asked for by number."""
    parts = {part["name"]: part for part in plan["scenario"]["parts"]}
    for i, tray in enumerate(plan["scenario"]["trays"]):
        own = {name for name, part in parts.items() if part["tray"] == tray["name"]}
        wanted = tray.get("wanted", {})
        for kind, row in wanted.items():
            where = f"scenario.trays[{i}].wanted.{kind}"
            if len(set(row["of"])) != len(row["of"]) or not own.issuperset(row["of"]):
                yield where, "must name parts of the tray, each once"
                continue
            picked = sum(parts[name]["target"] for name in row["of"])
            if picked != row["count"]:
                yield where, f"{row['count']} parts are asked for, {picked} are to be picked"
        named = {name for row in wanted.values() for name in row["of"]}
        others = [name for name in own - named if parts[name]["target"]]
        if wanted and others:
            yield f"scenario.trays[{i}].wanted", f"{min(others)} is to be picked, which is not asked for"


def _grid(plan: Plan) -> Found:
    """The grid covers what lies within one distance of every tray that is picked from, to whole cells."""
    scenario, grid = plan["scenario"], plan["grid"]
    picked = {part["tray"] for part in scenario["parts"] if part["target"]}
    trays = [tray for tray in scenario["trays"] if tray["name"] in picked]
    if not trays:
        return
    cell, given = grid["resolution"], scenario["options"].get("grid_max_distance", 0.0)
    first = np.array(grid["origin"]) / cell
    if np.abs(first - np.round(first)).max() > _CLOSE:
        yield "grid.origin", f"must be whole cells of {cell:g} m from the world's origin"
        return
    last = np.round(first) + [grid["nx"], grid["ny"]]
    middles = np.array([tray["pose"]["xyz"][:2] for tray in trays])
    # Without a given distance it is the arm's, which the plan does not store, beyond half of a tray's diagonal.
    half = np.array([[0.0 if given > 0 else 0.5 * np.hypot(*tray["size"][:2])] for tray in trays])
    most = np.concatenate([(middles - half).min(0) - cell * np.round(first), cell * last - (middles + half).max(0)])
    least = most - cell
    low, high = (given, given) if given > 0 else (float(least.max()), float(most.min()))
    if max(low, float(least.max())) > min(high, float(most.min())) + _CLOSE:
        yield "grid", f"does not reach equally far, {most.min():g} m or so, beyond the trays on all sides"


def _regions(plan: Plan) -> Found:
    parts = plan["scenario"]["parts"]
    trays = [tray["name"] for tray in plan["scenario"]["trays"]]
    if [region["tray"] for region in plan["regions"]] != trays:
        yield "regions", "must be one a tray, in the order of the trays"
        return
    cells = masks(plan)
    for i, region in enumerate(plan["regions"]):
        served = int(cells[region["tray"]].sum())
        wanted = [part for part in parts if part["tray"] == region["tray"] and part["target"]]
        if [e["part"] for e in region["explanations"]] != [part["name"] for part in wanted]:
            yield f"regions[{i}].explanations", "must be one a target part of the tray, in their order"
            continue
        for j, (said, part) in enumerate(zip(region["explanations"], wanted, strict=True)):
            where = f"regions[{i}].explanations[{j}]"
            failed = said["base_poses_tried"] - said["base_poses_feasible"]
            if said["grasps"] != len(part["grasps"]):
                yield where, f"counts {said['grasps']} grasps, the part has {len(part['grasps'])}"
            elif failed < 0 or sum(said["rejections"].values()) != failed * said["grasps"]:
                yield where, "must name one cause for each grasp and base pose that failed"
            elif said["base_poses_feasible"] < served:  # each cell has a middle of its own
                yield where, f"counts {said['base_poses_feasible']} feasible base poses, the region has {served} cells"


def masks(plan: Plan) -> dict[str, np.ndarray]:
    """The cells of every region, (headings, ny, nx) bool, by tray."""
    grid = plan["grid"]
    found = {}
    for region in plan["regions"]:
        mask = np.zeros((len(grid["headings"]), grid["ny"], grid["nx"]), dtype=bool)
        for layer, runs in region["cells"].items():
            for iy, first, last in runs:
                mask[int(layer), iy, first:last] = True
        found[region["tray"]] = mask
    return found


def _intersections(plan: Plan) -> Found:
    headings = plan["grid"]["headings"]
    if any(_turn(a - b) for i, a in enumerate(headings) for b in headings[:i]):
        yield "grid.headings", "a heading is listed twice"
    named = [(said["heading"], *said["trays"]) for key in _SETS for said in plan[key]]
    if len(set(named)) < len(named):
        yield "intersections", "a set of trays is listed twice at one heading"
    cells = masks(plan)
    least = plan["scenario"]["positioning_uncertainty"]
    for key in _SETS:
        for i, said in enumerate(plan[key]):
            where = f"{key}[{i}]"
            if said["heading"] >= len(plan["grid"]["headings"]) or not set(said["trays"]) <= cells.keys():
                yield where, "names a heading or a tray that is not there"
                continue
            layers = [cells[tray][said["heading"]] for tray in said["trays"]]
            shared = int(np.logical_and.reduce(layers).sum()) if layers else 0
            if not layers or shared != said["cells"]:
                yield where, f"says {said['cells']} cells, its trays share {shared}"
            elif (said["radius"] < least - _RADIUS_SLACK) != (key == "too_small_intersections"):
                yield where, f"a disc of {said['radius']:g} m, the positioning uncertainty is {least:g} m"


def _stops(plan: Plan) -> Found:
    for i, stop in enumerate(plan["stops"]):
        index = stop["intersection"]
        if not 0 <= index < len(plan["intersections"]):
            yield f"stops[{i}].intersection", f"is {index}: there are {len(plan['intersections'])} intersections"
            continue
        said = plan["intersections"][index]
        same_heading = said["heading"] < len(plan["grid"]["headings"]) and _turn(
            plan["grid"]["headings"][said["heading"]] - stop["pose"][2]
        )
        if said["trays"] != stop["trays"] or not same_heading:
            yield f"stops[{i}].intersection", f"intersection {index} has other trays or another heading"


def _counts(plan: Plan) -> Found:
    """Shares are of so many base poses as the options say."""
    samples = plan["scenario"]["options"].get("robustness_samples", 0)
    shares_of = max(samples, 1)
    for i, stop in enumerate(plan["stops"]):
        if "arrivals" in stop and stop["arrivals"]["drawn"] != samples:
            yield f"stops[{i}].arrivals.drawn", f"is {stop['arrivals']['drawn']}, robustness_samples is {samples}"
    poses = plan["robustness_rate"] * shares_of
    if abs(poses - round(poses)) > _CLOSE:
        yield "robustness_rate", f"is {plan['robustness_rate']:g}: no share of {shares_of} base poses"


def _route(plan: Plan) -> Found:
    for i, leg in enumerate(all_drives(plan)):
        poses = leg["poses"]
        # exactly: planned routes turn by less than a micro-radian where two headings nearly agree
        if len(poses) > 2 and any(a == b for a, b in pairwise(poses)):
            yield f"route[{i}].poses", "the base stands still between two poses"


def _in_passing(plan: Plan) -> Found:
    motions = plan.get("drive_by", {}).get("motions", [])
    if any(a["pick"] >= b["pick"] for a, b in pairwise(motions)):
        yield "drive_by.motions", "must be in the order of their picks, each once"
    for i, motion in enumerate(motions):
        pick = plan["picks"][motion["pick"]] if motion["pick"] < len(plan["picks"]) else None
        if pick and pick["motions"] and abs(motion["opening"] - pick["motions"][0]["opening"]) > _CLOSE:
            yield f"drive_by.motions[{i}].opening", f"must be {pick['motions'][0]['opening']:g} m, as in the pick's own"


def _turn(angle: float) -> bool:
    """Whether an angle is a whole number of turns."""
    return abs((angle + np.pi) % (2 * np.pi) - np.pi) <= _CLOSE


def _answer(plan: Plan) -> Found:
    if plan["obstructions"]:
        yield "obstructions", "must be empty in a plan that is solved"
    if plan["proven_minimal"] != (plan["lower_bound"] == len(plan["stops"])):
        yield (
            "proven_minimal",
            f"is {plan['proven_minimal']} with {len(plan['stops'])} stops and a lower bound of {plan['lower_bound']}",
        )


def _premises(plan: Plan) -> Found:
    for key, value in premises(plan).items():
        if plan["premises"][key] != value:
            yield f"premises.{key}", f"is {plan['premises'][key]!r}, the plan was made with {value!r}"
