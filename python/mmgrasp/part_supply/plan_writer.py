"""plan.json's content: the scenario as it was resolved, and the answer."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .. import _core
from .._core import Hand, PartSupplyPlan, Robot
from .._files import sha256_of
from ..records import AddedLinkRow, UrdfRow
from ..scenario import Scenario, TraySetup
from ..scenario.shapes import pose_to_dict, shape_to_dict
from .plan_file import VERSION
from .premises import premises


def plan_to_dict(scenario: Scenario, plan: PartSupplyPlan) -> dict[str, Any]:
    """The whole content of plan.json."""
    names = [scenario.trays[tray].tray.name for tray in plan.region_trays]
    content = {
        "format": "mmgrasp-plan",
        "version": VERSION,
        "mmgrasp": _core.__version__,
        "outcome": plan.outcome.name,
        "scenario": scenario_to_dict(scenario),
        "grid": _grid(plan),
        "regions": [_region(region, plan) for region in plan.regions],
        "intersections": [_intersection(i, names) for i in plan.intersections.robust],
        "too_small_intersections": [_intersection(i, names) for i in plan.intersections.too_small],
        "stops": [
            {
                "pose": s.pose.tolist(),
                "radius": s.radius,
                "trays": [names[t] for t in s.trays],
                "intersection": s.intersection,
                **({"arrivals": {"drawn": s.arrivals, "served": s.arrivals_served}} if s.arrivals else {}),
            }
            for s in plan.stops
        ],
        "lower_bound": plan.lower_bound,
        "proven_minimal": plan.proven_minimal,
        "route": [_leg(leg, scenario) for leg in plan.route],
        **({"unloadings": [_unloading(u, scenario) for u in plan.unloadings]} if plan.unloadings else {}),
        "picks": [pick_to_dict(pick, scenario) for pick in plan.picks],
        "robustness_rate": plan.robustness_rate,
        "obstructions": [o.to_dict() for o in plan.obstructions],
    }
    return content | {"premises": premises(content)}


def _place(scenario: Scenario) -> dict[str, Any]:
    """The bin, or where parts are let go at the goal."""
    region = scenario.unload_region
    if region is not None:
        row = {"pose": pose_to_dict(region.T_world_region), "size": region.size.tolist()}
        return {"unload_region": row | {"drop_height": region.drop_height}}
    place = scenario.setup.place_region
    assert place is not None  # load_scenario() refuses a scenario without both
    row = {"pose": pose_to_dict(place.T_base_bin), "size": place.size.tolist(), "drop_height": place.drop_height}
    return {"place_region": row | ({"capacity": place.capacity} if place.capacity else {})}


def _leg(leg: _core.BasePath, scenario: Scenario) -> dict[str, Any]:
    return {
        "poses": leg.poses.tolist(),
        "length": leg.length,
        "turning": leg.turning,
        "duration": leg.duration(scenario.setup.robot),
    }


def _unloading(unloading: _core.Unloading, scenario: Scenario) -> dict[str, Any]:
    back = {} if unloading.back is None else {"back": _leg(unloading.back, scenario)}
    return {"after_pick": unloading.after_pick, "to_goal": _leg(unloading.to_goal, scenario), **back}


def scenario_to_dict(scenario: Scenario) -> dict[str, Any]:
    """The part of the plan that the scenario alone decides."""
    setup = scenario.setup
    gripper, arm, robot = setup.gripper, setup.arm, setup.robot
    return {
        "name": scenario.name,
        "source": scenario.source,
        "robot": {
            "urdf": robot.to_urdf(),
            "srdf": robot.to_srdf(),
            "urdfs": [_urdf(u) for u in robot.source.urdfs],
            "links": [_link(link) for link in robot.source.added_links],
            "base": robot.base,
            "base_limits": {key: value for key, value in robot.base_limits.items() if 0 < value < math.inf},
            "meshes": [{"file": path, "sha256": sha256_of(path)} for path in _mesh_files(robot)],
        },
        "arm": {
            "joints": arm.names,
            "tip_link": arm.tip,
            "velocity_limits": arm.velocity_limits.tolist(),
            "acceleration_limits": arm.acceleration_limits.tolist(),
        },
        "gripper": {
            "tool_link": gripper.tool_link,
            "approach": gripper.approach.tolist(),
            "closing": gripper.closing.tolist(),
            "max_opening": gripper.max_opening,
            "finger_depth": gripper.finger_depth,
            "finger_width": gripper.finger_width,
            "clearance": gripper.clearance,
            "closing_speed": setup.closing_speed,
            "joints": _finger_ends(gripper),
            "finger_links": gripper.finger_links,
            **_openings(gripper),
            **_suction(gripper),
            **({"payload": gripper.payload} if math.isfinite(gripper.payload) else {}),
        },
        "other_joints": setup.other_joints,
        "home": setup.home.tolist(),
        "start": scenario.start.tolist(),
        "goal": scenario.goal.tolist(),
        "positioning_uncertainty": scenario.positioning_uncertainty,
        **({"arrival_covariance": known.tolist()} if (known := scenario.arrival_covariance) is not None else {}),
        **({"drive_clearance": scenario.drive_clearance} if scenario.drive_clearance else {}),
        **_place(scenario),
        "floor": scenario.floor,
        "obstacles": [
            {"name": o.name, "pose": pose_to_dict(o.pose), "shapes": [shape_to_dict(s) for s in o.shapes]}
            for o in scenario.obstacles
        ],
        "trays": [
            {
                "name": t.tray.name,
                "pose": pose_to_dict(t.tray.T_world_tray),
                **(t.body.to_dict() if t.body else {"size": t.tray.size.tolist(), "own_body": True}),
                "headings": _headings(t.tray),
                "shares_headings": not t.tray.headings,
                **({"wanted": wanted} if (wanted := _wanted(t)) else {}),
            }
            for t in scenario.trays
        ],
        "parts": [_part(part, t) for t in scenario.trays for part in t.tray.parts],
        **({"scans": scans} if (scans := [t.scan.to_dict(t.tray.name) for t in scenario.trays if t.scan]) else {}),
        "options": {key: value for key, value in scenario.problem().options.items() if key != "threads"},
        **scenario.rules.to_dict(),
        "reach": {key: scenario.reach.get(key, default) for key, (default, _) in _reach_options().items()},
    }


def _wanted(tray: TraySetup) -> dict[str, Any]:
    """How many parts of each type were asked for, and which there are to choose from."""
    return {kind: {"count": count, "of": tray.of_kind(kind)} for kind, count in sorted(tray.wanted.items())}


def _finger_ends(gripper: Hand) -> list[dict[str, Any]]:
    """Joint values with the fingers closed and open; joints that the opening does not move have the same twice."""
    ends = []
    for joint in gripper.joints:
        closed, opened = joint.closed, joint.open
        if joint.group in gripper.preshape:
            closed = opened = closed + gripper.preshape[joint.group] * (opened - closed)
        ends.append({"name": joint.name, "closed": closed, "open": opened})
    return ends


def _openings(gripper: Hand) -> dict[str, list[float]]:
    """Openings at equal steps of the joints; nothing where they are linear from 0."""
    if gripper.openings:
        return {"openings": list(gripper.openings)}
    return {"openings": [gripper.min_opening, gripper.max_opening]} if gripper.min_opening > 0 else {}


def _suction(gripper: Hand) -> dict[str, Any]:
    """What holds parts in place of fingers; nothing for a hand that has them."""
    own = gripper.suction
    if own is None:
        return {}
    cups = [{"xyz": cup.position.tolist(), "radius": cup.radius} for cup in own.cups]
    numbers = {key: getattr(own, key) for key in ("max_gap", "vacuum", "friction", "safety")}
    return {"suction": {"cups": cups, **numbers}}


def _reach_options() -> dict[str, tuple[Any, str]]:
    return {key: value for key, value in _core._reach_option_table().items() if key != "threads"}


def _headings(tray: _core.Tray) -> list[float]:
    """The base headings of a tray: those it lists, or the one that faces it."""
    front = tray.T_world_tray[:3, 0]
    return [float(h) for h in tray.headings] or [math.atan2(front[1], front[0])]


def _urdf(source: UrdfRow) -> dict[str, Any]:
    """A URDF as it was given; verify reads it instead of ours."""
    return {key: value for key, value in source.items() if key != "T"} | {"pose": pose_to_dict(source["T"])}


def _link(link: AddedLinkRow) -> dict[str, Any]:
    return {
        "name": link["name"],
        "parent_link": link["parent_link"],
        "pose": pose_to_dict(link["T"]),
        "shapes": [shape_to_dict(s) for s in link["shapes"]],
    }


def _mesh_files(robot: Robot) -> list[str]:
    """The robot's collision meshes, each once."""
    shapes = {s.mesh_path for link in robot.links for s in robot.collisions(link)}
    return sorted((shapes | {path for u in robot.source.urdfs for path in u["mesh_files"].values()}) - {""})


def _part(part: _core.Part, tray: TraySetup) -> dict[str, Any]:
    return {
        "name": part.name,
        "tray": tray.tray.name,
        "target": part.target,
        "pose": pose_to_dict(part.T_world_part),
        "shapes": [shape_to_dict(s) for s in part.shapes],
        "grasps": [
            {"pose": pose_to_dict(g.T_object_hand), "opening": g.opening, "quality": g.quality}
            | ({"probability": g.quality} if tray.scan else {})
            for g in part.grasps
        ]
        if part.target
        else [],
        **({"mass": part.mass} if part.mass > 0 else {}),
    }


def _grid(plan: PartSupplyPlan) -> dict[str, Any]:
    grid = plan.grid
    return {
        "origin": grid.origin.tolist(),
        "resolution": grid.resolution,
        "nx": grid.nx,
        "ny": grid.ny,
        "headings": list(grid.headings),
    }


def runs_of(layer: np.ndarray) -> list[list[int]]:
    """Cells of one layer (ny, nx) as [iy, first ix, one past the last ix]."""
    runs = []
    for iy, row in enumerate(layer):
        edges = np.flatnonzero(np.diff(np.concatenate(([0], row != 0, [0])).astype(np.int8)))
        runs += [[iy, int(a), int(b)] for a, b in edges.reshape(-1, 2)]
    return runs


def _region(region: _core.BaseRegion, plan: PartSupplyPlan) -> dict[str, Any]:
    layers = region.cells(plan.grid)
    return {
        "tray": region.tray,
        "cells": {str(k): runs for k, layer in enumerate(layers) if (runs := runs_of(layer))},
        "explanations": [e.to_dict() for e in region.explanations],
    }


def _intersection(intersection: _core.Intersection, names: list[str]) -> dict[str, Any]:
    return {
        "trays": [names[t] for t in intersection.trays],
        "heading": intersection.heading,
        "centre": intersection.centre.tolist(),
        "radius": intersection.radius,
        "cells": intersection.cells,
    }


def pick_to_dict(pick: _core.Pick, scenario: Scenario) -> dict[str, Any]:
    """A pick as plan.json has it."""
    tray = scenario.trays[pick.tray].tray
    motions = []
    for motion in pick.motions:
        t = motion.trajectory
        motions.append(
            {
                "kind": motion.kind,
                "opening": motion.opening,
                "attached": motion.attached,
                "times": t.times.tolist(),
                "positions": t.positions.tolist(),
                "velocities": t.velocities.tolist(),
                "accelerations": t.accelerations.tolist(),
            }
        )
    return {
        "stop": pick.stop,
        "tray": tray.name,
        "part": tray.parts[pick.part].name,
        "grasp": pick.grasp,
        "motions": motions,
    }
