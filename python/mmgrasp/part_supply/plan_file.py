"""plan.json: everything resolved, so that a plan can be read, shown and checked without its scenario (docs/plan_format.md)."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import Hand, InvalidInput, PartSupplyPlan, Robot, RobotSource
from .._core import verify as checks
from .._files import SCHEMAS, sha256_of
from ..documents.reading import Node, read_json
from ..scenario import Scenario, TraySetup
from ..scenario.schema import check_schema
from ..scenario.shapes import pose_to_dict, shape_from_node, shape_to_dict
from .premises import premises

VERSION = 2


# --- writing ----------------------------------------------------------------------------------------------------------
def plan_to_dict(scenario: Scenario, plan: PartSupplyPlan, timings: list[tuple[str, float]]) -> dict[str, Any]:
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
        "lost_intersections": [_intersection(i, names) for i in plan.intersections.lost],
        "stops": [
            {
                "pose": s.pose.tolist(),
                "radius": s.radius,
                "trays": [names[t] for t in s.trays],
                "intersection": s.intersection,
            }
            for s in plan.stops
        ],
        "lower_bound": plan.lower_bound,
        "proven_minimal": plan.proven_minimal,
        "route": [
            {
                "poses": leg.poses.tolist(),
                "length": leg.length,
                "turning": leg.turning,
                "duration": leg.duration(scenario.setup.robot),
            }
            for leg in plan.route
        ],
        "picks": [_pick(pick, scenario) for pick in plan.picks],
        "robustness_rate": plan.robustness_rate,
        "obstructions": [o.to_dict() for o in plan.obstructions],
        "timings": [{"stage": stage, "seconds": seconds} for stage, seconds in timings],
    }
    return content | {"premises": premises(content)}


def scenario_to_dict(scenario: Scenario) -> dict[str, Any]:
    """The part of the plan that the scenario alone decides."""
    setup = scenario.setup
    gripper, arm, robot, place = setup.gripper, setup.arm, setup.robot, setup.place_region
    return {
        "name": scenario.name,
        "source": scenario.source,
        "robot": {
            "urdf": robot.to_urdf(),
            "srdf": robot.to_srdf(),
            "urdfs": [_urdf(u) for u in robot.source.urdfs],
            "links": [_link(link) for link in robot.source.added_links],
            "base": robot.base,
            "base_limits": {key: value for key, value in robot.base_limits.items() if math.isfinite(value)},
            "meshes": [{"file": path, "sha256": sha256_of(path)} for path in _mesh_files(robot)],
        },
        "arm": {
            "joints": arm.names,
            "tip_link": arm.tip,
            "velocity_limits": arm.velocity_limits.tolist(),
            "acceleration_limits": arm.acceleration_limits.tolist(),
        },
        "gripper": {
            "tcp_link": gripper.tool_link,
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
        },
        "other_joints": setup.other_joints,
        "home": setup.home.tolist(),
        "start": scenario.start.tolist(),
        "goal": scenario.goal.tolist(),
        "positioning_uncertainty": scenario.positioning_uncertainty,
        "place_region": {
            "pose": pose_to_dict(place.T_base_bin),
            "size": place.size.tolist(),
            "drop_gap": place.drop_gap,
        },
        "obstacles": [
            {"name": o.name, "pose": pose_to_dict(o.pose), "shapes": [shape_to_dict(s) for s in o.shapes]}
            for o in scenario.obstacles
        ],
        "trays": [
            {
                "name": t.tray.name,
                "pose": pose_to_dict(t.tray.T_world_tray),
                "size": t.tray.size.tolist(),
                "headings": _headings(t.tray),
            }
            for t in scenario.trays
        ],
        "parts": [_part(part, t) for t in scenario.trays for part in t.tray.parts],
        **({"scans": scans} if (scans := [t.scan.to_dict(t.tray.name) for t in scenario.trays if t.scan]) else {}),
        "options": dict(scenario.problem().options),
        **scenario.rules.to_dict(),
        "reach": {key: scenario.reach.get(key, default) for key, (default, _) in _reach_options().items()},
    }


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


def _reach_options() -> dict[str, tuple[Any, str]]:
    return {key: value for key, value in _core._reach_option_table().items() if key != "threads"}


def _headings(tray: _core.Tray) -> list[float]:
    """The base headings tried at a tray: those it lists, or the one that faces it."""
    front = tray.T_world_tray[:3, 0]
    return [float(h) for h in tray.headings] or [math.atan2(front[1], front[0])]


def _urdf(source: dict[str, Any]) -> dict[str, Any]:
    """A URDF as it was given; verify reads it instead of ours."""
    return {key: value for key, value in source.items() if key != "T"} | {"pose": pose_to_dict(source["T"])}


def _link(link: dict[str, Any]) -> dict[str, Any]:
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
            {"pose": pose_to_dict(g.T_object_hand), "width": g.opening, "quality": g.quality}
            | ({"probability": g.quality} if tray.scan else {})
            for g in part.grasps
        ]
        if part.target
        else [],
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
        "base_poses_in_collision": region.base_poses_in_collision,
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


def _pick(pick: _core.Pick, scenario: Scenario) -> dict[str, Any]:
    tray = scenario.trays[pick.tray].tray
    motions = []
    for motion in pick.motions:
        t = motion.trajectory
        motions.append(
            {
                "kind": motion.kind,
                "opening": motion.opening,
                "holding": motion.holding,
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


# --- reading ----------------------------------------------------------------------------------------------------------
def read_plan(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The content of a plan.json; raises IoError or InvalidInput when it is not one, or not of its schema."""
    root = read_json(Path(path)).root
    check_form(root)
    content: dict[str, Any] = root.raw
    return content


def check_header(root: Node) -> None:
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.document.source}: is no plan: the key format: mmgrasp-plan is missing")
    root["format"].choice("mmgrasp-plan")
    root.read_version(VERSION)


def check_form(root: Node) -> None:
    """Raises InvalidInput unless every value has its place and form (plan.schema.json)."""
    check_header(root)
    check_schema(root, plan_schema())


def check_names(root: Node) -> None:
    """Raises InvalidInput when an index or a name in the answer leads nowhere: for those who draw a plan."""
    plan = root.raw
    parts = {part["name"]: part for part in plan["scenario"]["parts"]}
    trays = {tray["name"] for tray in plan["scenario"]["trays"]}
    for key in ("regions", "intersections", "lost_intersections", "stops"):
        for node in root[key].elements():
            for tray in [node["tray"]] if key == "regions" else node["trays"].elements():
                if tray.raw not in trays:
                    tray.fail("no such tray")
    for stop in root["stops"].elements():
        if stop["intersection"].raw >= len(plan["intersections"]):
            stop["intersection"].fail("no such intersection")
    for pick in root["picks"].elements():
        if pick["part"].raw not in parts:
            pick["part"].fail("no such part")
        if pick["stop"].raw >= len(plan["stops"]):
            pick["stop"].fail("no such stop")
        if pick["grasp"].raw >= len(parts[pick["part"].raw]["grasps"]):
            pick["grasp"].fail("the part has no such grasp")
    for motion in root["drive_by"]["motions"].elements() if "drive_by" in root else []:
        if motion["pick"].raw >= len(plan["picks"]):
            motion["pick"].fail("no such pick")


def plan_schema() -> dict[str, Any]:
    """The JSON Schema of plan.json."""
    schema: dict[str, Any] = json.loads((SCHEMAS / "plan.schema.json").read_text())
    return schema


def plan_to_check(root: Node) -> checks.PlanToCheck:
    """The plan as the checker takes it; every value is read strictly."""
    scenario = root["scenario"]
    robot = scenario["robot"]
    limits = {key: node.number(above=0) for key, node in robot["base_limits"].items()}
    for mesh in robot["meshes"].elements():
        if sha256_of(mesh["file"].string()) != mesh["sha256"].string():
            mesh["file"].fail("the mesh file has changed since the plan was made")
    base = robot["base"].choice("diff_drive", "omni")
    planned = RobotSource(base, base_limits=limits, srdf=robot["srdf"].string())
    files = {mesh["file"].raw: mesh["file"].raw for mesh in robot["meshes"].elements()}
    planned.add_urdf(robot["urdf"].string(), origin=f"{root.document.source}: scenario.robot.urdf", mesh_files=files)
    if "urdfs" in robot:
        plan = checks.PlanToCheck(_read_source(robot, RobotSource(base, base_limits=limits, srdf=robot["srdf"].raw)))
        plan.planned_robot = planned
    else:  # a plan from before these were kept
        plan = checks.PlanToCheck(planned)
    _read_arm(plan, scenario)
    _read_scene(plan, scenario)
    _read_answer(plan, root)
    return plan


def _text(node: Node) -> str:
    """A text that may be empty."""
    return node.raw if node.raw == "" else node.string()


def _read_source(robot: Node, source: RobotSource) -> RobotSource:
    hashed = {mesh["file"].raw for mesh in robot["meshes"].elements()} | {""}
    for node in robot["urdfs"].elements():
        node.mapping("urdf origin prefix parent_link pose mesh_files")
        files = {name: _text(file) for name, file in node["mesh_files"].items()}
        if not hashed.issuperset(files.values()):
            node["mesh_files"].fail("every file must be among the robot's meshes")
        texts = {key: _text(node[key]) for key in ("urdf", "origin", "prefix", "parent_link")}
        source.add_urdf(**texts, T=node["pose"].pose(), mesh_files=files)
    for node in robot["links"].elements():
        shapes = [shape_from_node(shape) for shape in node["shapes"].elements()]
        source.add_link(node["name"].string(), node["parent_link"].string(), node["pose"].pose(), shapes)
    return source


def _read_arm(plan: checks.PlanToCheck, scenario: Node) -> None:
    arm, gripper = scenario["arm"], scenario["gripper"]
    plan.arm_joints = [name.string() for name in arm["joints"].elements()]
    count = len(plan.arm_joints)
    plan.velocity_limits = arm["velocity_limits"].numbers(count, above=0)
    plan.acceleration_limits = arm["acceleration_limits"].numbers(count, above=0)
    plan.tip_link = arm["tip_link"].string()
    plan.other_joints = {name: value.number() for name, value in scenario["other_joints"].items()}
    plan.max_opening = gripper["max_opening"].number(above=0)
    plan.clearance = gripper["clearance"].number(least=0)
    plan.approach = np.array(gripper["approach"].numbers(3))
    plan.fingers = [
        checks.CheckedFinger(j["name"].string(), j["closed"].number(), j["open"].number())
        for j in gripper["joints"].elements()
    ]
    if "openings" in gripper:
        plan.openings = gripper["openings"].numbers()
    plan.closing = np.array(gripper["closing"].numbers(3))
    plan.finger_depth = gripper["finger_depth"].number(above=0)
    plan.finger_width = gripper["finger_width"].number(above=0)
    plan.closing_speed = gripper["closing_speed"].number(above=0)
    options = scenario["options"]
    plan.approach_distance = options["approach_distance"].number(above=0)
    plan.lift_height = options["lift_height"].number(above=0)
    plan.finger_links = [link.string() for link in gripper["finger_links"].elements()]
    plan.home = np.array(scenario["home"].numbers(count))


def _read_body(node: Node) -> checks.CheckedBody:
    shapes = [shape_from_node(shape) for shape in node["shapes"].elements()]
    return checks.CheckedBody(node["name"].string(), shapes, node["pose"].pose())


def _read_scene(plan: checks.PlanToCheck, scenario: Node) -> None:
    plan.start, plan.goal = (np.array(scenario[key].numbers(3)) for key in ("start", "goal"))
    plan.positioning_uncertainty = scenario["positioning_uncertainty"].number(least=0)
    place = scenario["place_region"]
    plan.T_base_bin = place["pose"].pose()
    plan.bin_size = np.array(place["size"].numbers(2, above=0))
    plan.drop_gap = place["drop_gap"].number(least=0)
    plan.obstacles = [_read_body(node) for node in scenario["obstacles"].elements()]
    plan.trays = [tray["name"].string() for tray in scenario["trays"].elements()]
    farthest = scenario["options"]["grid_max_distance"].number(least=0) or math.inf
    plan.searched = {
        tray["name"].raw: checks.CheckedTray(tray["headings"].numbers(), tray["pose"].pose()[:2, 3], farthest)
        for tray in scenario["trays"].elements()
    }
    parts = []
    for node in scenario["parts"].elements():
        grasps = [checks.CheckedGrasp(g["pose"].pose(), g["width"].number(least=0)) for g in node["grasps"].elements()]
        tray = node["tray"]
        if tray.string() not in plan.trays:
            tray.fail("no such tray")
        parts.append(checks.CheckedPart(_read_body(node), tray.raw, node["target"].boolean(), grasps))
    plan.parts = parts
    plan.allowed_collisions = allowed_collisions(scenario)
    plan.padded = "padding" in scenario


def allowed_collisions(scenario: Node) -> list[tuple[str, str]]:
    """The pairs that may touch, as the section `scenario` of a plan says."""
    pairs = []
    for node in scenario["allowed_collisions"].elements() if "allowed_collisions" in scenario else []:
        names = [name.string() for name in node.elements()]
        if len(names) != 2:
            node.fail("must be a pair of names")
        pairs.append((names[0], names[1]))
    return pairs


def _read_answer(plan: checks.PlanToCheck, root: Node) -> None:
    grid = root["grid"]
    nx, ny, headings = grid["nx"].integer(least=1), grid["ny"].integer(least=1), grid["headings"].numbers()
    plan.grid = checks.CheckedGrid(grid["origin"].numbers(2), grid["resolution"].number(above=0), nx, ny, headings)
    plan.regions = [
        checks.CheckedRegion(region["tray"].string(), _cells(region["cells"], len(headings), ny, nx))
        for region in root["regions"].elements()
    ]
    plan.stops = [
        checks.CheckedStop(s["pose"].numbers(3), s["radius"].number(), [t.string() for t in s["trays"].elements()])
        for s in root["stops"].elements()
    ]
    plan.route = [list(leg["poses"].array(3)) for leg in root["route"].elements()]
    plan.picks = [_read_pick(node, len(plan.arm_joints)) for node in root["picks"].elements()]
    if "drive_by" in root.raw:
        plan.drive_by = [
            checks.CheckedDriveBy(
                node["pick"].integer(),
                node["close_at"].number(),
                node["closed_at"].number(),
                _read_motion(node, "drive-by", False, 3 + len(plan.arm_joints)),
            )
            for node in root["drive_by"]["motions"].elements()
        ]
    plan.lower_bound = root["lower_bound"].integer(least=0)
    plan.route_figures = [
        checks.CheckedLegFigures(*(leg[key].number() for key in ("length", "turning", "duration")))
        for leg in root["route"].elements()
    ]
    plan.intersections = [_read_intersection(node, headings) for node in root["intersections"].elements()]
    plan.robustness_rate = root["robustness_rate"].number()


def _read_intersection(node: Node, headings: list[float]) -> checks.CheckedIntersection:
    index = node["heading"].integer(least=0)
    if index >= len(headings):
        node["heading"].fail("must be the index of a heading of the grid")
    trays = [tray.string() for tray in node["trays"].elements()]
    return checks.CheckedIntersection(trays, headings[index], node["centre"].numbers(2), node["radius"].number())


def _cells(node: Node, layers: int, ny: int, nx: int) -> np.ndarray:
    if layers * ny * nx > 100_000_000:
        node.fail("the grid has more than 100 million cells")
    cells = np.zeros((layers, ny, nx), dtype=np.uint8)
    for key, runs in node.items():
        if not (key.isascii() and key.isdigit() and len(key) < 6) or int(key) >= layers:
            runs.fail("must belong to a heading of the grid")
        for run in runs.elements():
            iy, a, b = (
                (value.integer(least=0) for value in run.elements())
                if len(run.raw) == 3
                else run.fail("needs 3 numbers")
            )
            if iy >= ny or not a < b <= nx:
                run.fail("must lie inside the grid")
            cells[int(key), iy, a:b] = 1
    return cells.reshape(-1)


def _read_motion(node: Node, kind: str, holding: bool, columns: int) -> checks.CheckedMotion:
    times = node["times"].numbers()
    if not times:
        node["times"].fail("must not be empty")
    rows = [node[key].array(columns) for key in ("positions", "velocities", "accelerations")]
    if any(len(values) != len(times) for values in rows):
        node["times"].fail("must be as many as positions, velocities and accelerations")
    return checks.CheckedMotion(kind, node["opening"].number(), holding, times, *rows)


def _read_pick(node: Node, joints: int) -> checks.CheckedPick:
    motions = [
        _read_motion(motion, motion["kind"].string(), motion["holding"].boolean(), joints)
        for motion in node["motions"].elements()
    ]
    return checks.CheckedPick(
        node["stop"].integer(), node["tray"].string(), node["part"].string(), node["grasp"].integer(), motions
    )
