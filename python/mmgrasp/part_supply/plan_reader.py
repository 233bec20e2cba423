"""plan.json as `verify` takes it: every value is read strictly, with its place in messages."""

from __future__ import annotations

import math

import numpy as np

from .._argument_errors import checked
from .._core import RobotSource
from .._core import verify as checks
from .._files import printable, sha256_of
from ..documents.reading import Node
from ..scenario.shapes import shape_from_node


@checked
def plan_to_check(root: Node) -> checks.PlanToCheck:
    """The plan as the checker takes it; every value is read strictly."""
    scenario = root["scenario"]
    robot = scenario["robot"]
    limits = {key: node.number(above=0) for key, node in robot["base_limits"].items()}
    for mesh in robot["meshes"].elements():
        if sha256_of(mesh["file"].string()) != mesh["sha256"].string():
            mesh["file"].fail("the mesh file has changed since the plan was made")
    base = robot["base"].choice("diff_drive", "omni")
    with robot["base_limits"].blamed():
        planned = RobotSource(base, base_limits=limits, srdf=robot["srdf"].string())
    files = {mesh["file"].raw: mesh["file"].raw for mesh in robot["meshes"].elements()}
    planned.add_urdf(
        robot["urdf"].string(), origin=f"{printable(root.document.source)}: scenario.robot.urdf", mesh_files=files
    )
    plan = checks.PlanToCheck(_read_source(robot, RobotSource(base, base_limits=limits, srdf=robot["srdf"].raw)))
    plan.planned_robot = planned
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
    plan.max_opening = gripper["max_opening"].number(least=0)
    plan.clearance = gripper["clearance"].number(least=0)
    plan.approach = np.array(gripper["approach"].numbers(3))
    plan.fingers = [
        checks.CheckedFinger(j["name"].string(), j["closed"].number(), j["open"].number())
        for j in gripper["joints"].elements()
    ]
    if "openings" in gripper:
        plan.openings = gripper["openings"].numbers()
    plan.closing = np.array(gripper["closing"].numbers(3))
    plan.finger_depth = gripper["finger_depth"].number(least=0)
    plan.finger_width = gripper["finger_width"].number(least=0)
    if "suction" in gripper:
        plan.suction = _read_suction(gripper["suction"])
    elif not plan.finger_depth * plan.finger_width > 0:
        gripper["finger_depth"].fail("must be positive, as finger_width must: the hand has fingers")
    if "payload" in gripper:
        plan.payload = gripper["payload"].number(above=0)
    plan.closing_speed = gripper["closing_speed"].number(above=0)
    options = scenario["options"]
    plan.approach_distance = options["approach_distance"].number(above=0)
    plan.lift_height = options["lift_height"].number(above=0)
    plan.finger_links = [link.string() for link in gripper["finger_links"].elements()]
    plan.home = np.array(scenario["home"].numbers(count))


def _read_suction(node: Node) -> checks.CheckedSuction:
    cups = [
        checks.CheckedCup(np.array(cup["xyz"].numbers(3)), cup["radius"].number(above=0))
        for cup in node["cups"].elements()
    ]
    return checks.CheckedSuction(
        cups, **{key: node[key].number(above=0) for key in ("max_gap", "vacuum", "friction", "safety")}
    )


def _read_body(node: Node) -> checks.CheckedBody:
    shapes = [shape_from_node(shape) for shape in node["shapes"].elements()]
    return checks.CheckedBody(node["name"].string(), shapes, node["pose"].pose())


def _read_scene(plan: checks.PlanToCheck, scenario: Node) -> None:
    plan.start, plan.goal = (np.array(scenario[key].numbers(3)) for key in ("start", "goal"))
    plan.positioning_uncertainty = scenario["positioning_uncertainty"].number(least=0)
    if "drive_clearance" in scenario:
        plan.drive_clearance = scenario["drive_clearance"].number(above=0, most=10)
    if "arrival_covariance" in scenario:
        rows = scenario["arrival_covariance"].elements()
        plan.arrival_covariance = np.array([row.numbers(3) for row in rows])
    _read_place(plan, scenario)
    plan.obstacles = [_read_body(node) for node in scenario["obstacles"].elements()]
    plan.floor = -math.inf if scenario["floor"].raw is None else scenario["floor"].number()
    plan.trays = [tray["name"].string() for tray in scenario["trays"].elements()]
    for tray in scenario["trays"].elements():
        if "size" in tray:
            tray["size"].numbers(3, above=0)
    farthest = scenario["options"]["grid_max_distance"].number(least=0) or math.inf
    plan.searched = {
        tray["name"].raw: checks.CheckedTray(
            tray["headings"].numbers(), tray["pose"].pose()[:2, 3], farthest, tray["shares_headings"].boolean()
        )
        for tray in scenario["trays"].elements()
    }
    scanned = {scan["tray"].raw for scan in scenario["scans"].elements()} if "scans" in scenario else set()
    parts = []
    for node in scenario["parts"].elements():
        grasps = [
            checks.CheckedGrasp(g["pose"].pose(), g["opening"].number(least=0)) for g in node["grasps"].elements()
        ]
        tray = node["tray"]
        if tray.string() not in plan.trays:
            tray.fail("no such tray")
        mass = node["mass"].number(above=0) if "mass" in node else 0.0
        target = node["target"].boolean()
        parts.append(checks.CheckedPart(_read_body(node), tray.raw, target, grasps, mass, tray.raw in scanned))
    plan.parts = parts
    plan.allowed_collisions = allowed_collisions(scenario)
    plan.padded = "padding" in scenario and _pads(scenario["padding"])


def _read_place(plan: checks.PlanToCheck, scenario: Node) -> None:
    """The bin, or where parts are let go at the goal."""
    if "unload_region" in scenario:
        region = scenario["unload_region"]
        if "place_region" in scenario:
            region.fail("must not stand beside a place_region: parts go to one of both")
        size, height = np.array(region["size"].numbers(2, above=0)), region["drop_height"].number(least=0)
        plan.unload_region = checks.CheckedUnloadRegion(region["pose"].pose(), size, height)
        return
    place = scenario["place_region"]
    plan.T_base_bin = place["pose"].pose()
    plan.bin_size = np.array(place["size"].numbers(2, above=0))
    plan.drop_height = place["drop_height"].number(least=0)
    plan.capacity = place["capacity"].integer(least=1) if "capacity" in place else 0


def _pads(padding: Node) -> bool:
    """Whether some body is grown: not by zeros."""
    values = [*padding["by_name"].items()] if "by_name" in padding else []
    values += [(key, padding[key]) for key in ("links", "attached", "objects") if key in padding]
    return any(value.number(least=0) > 0 for _, value in values)


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
    plan.stops = [_read_stop(node) for node in root["stops"].elements()]
    plan.route = [list(leg["poses"].array(3)) for leg in root["route"].elements()]
    plan.picks = [_read_pick(node, len(plan.arm_joints)) for node in root["picks"].elements()]
    if "drive_by" in root.raw:
        plan.drive_by = [
            checks.CheckedDriveBy(
                node["pick"].integer(),
                node["close_at"].number(),
                node["closed_at"].number(),
                _read_motion(node, "drive-by", False, 3 + len(plan.arm_joints)),
                from_release="begins" in node and node["begins"].choice("home", "release") == "release",
                to_release="ends" in node and node["ends"].choice("lift", "release") == "release",
            )
            for node in root["drive_by"]["motions"].elements()
        ]
    plan.lower_bound = root["lower_bound"].integer(least=0)
    plan.leg_values = [_leg_values(leg) for leg in root["route"].elements()]
    plan.unloadings = [_read_unloading(node) for node in root["unloadings"].elements()] if "unloadings" in root else []
    plan.intersections = [
        _read_intersection(node, headings)
        for key in ("intersections", "too_small_intersections")
        for node in root[key].elements()
    ]
    plan.robustness_rate = root["robustness_rate"].number()


def _leg_values(leg: Node) -> checks.CheckedLegValues:
    return checks.CheckedLegValues(*(leg[key].number() for key in ("length", "turning", "duration")))


def _read_unloading(node: Node) -> checks.CheckedUnloading:
    to_goal = node["to_goal"]
    out = checks.CheckedUnloading
    if "back" not in node:
        return out(node["after_pick"].integer(), to_goal["poses"].array(3), _leg_values(to_goal))
    back = node["back"]
    values = _leg_values(to_goal), _leg_values(back)
    return out(node["after_pick"].integer(), to_goal["poses"].array(3), values[0], back["poses"].array(3), values[1])


def _read_stop(node: Node) -> checks.CheckedStop:
    trays = [tray.string() for tray in node["trays"].elements()]
    arrivals = {}
    if "arrivals" in node:
        seen = node["arrivals"]
        arrivals = {"arrivals": seen["drawn"].integer(least=1), "arrivals_served": seen["served"].integer(least=0)}
    return checks.CheckedStop(node["pose"].numbers(3), node["radius"].number(), trays, **arrivals)


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
        before = (-1, 0)
        for run in runs.elements():
            iy, a, b = (
                (value.integer(least=0) for value in run.elements())
                if len(run.raw) == 3
                else run.fail("needs 3 numbers")
            )
            if iy >= ny or not a < b <= nx:
                run.fail("must lie inside the grid")
            if (iy, a) <= before:
                run.fail("must come after the one before, with a cell between them that is left out")
            before = (iy, b)
            cells[int(key), iy, a:b] = 1
    return cells.reshape(-1)


def _read_motion(node: Node, kind: str, attached: bool, columns: int) -> checks.CheckedMotion:
    times = node["times"].numbers()
    if not times:
        node["times"].fail("must not be empty")
    rows = [node[key].array(columns) for key in ("positions", "velocities", "accelerations")]
    if any(len(values) != len(times) for values in rows):
        node["times"].fail("must be as many as positions, velocities and accelerations")
    return checks.CheckedMotion(kind, node["opening"].number(), attached, times, *rows)


def _read_pick(node: Node, joints: int) -> checks.CheckedPick:
    motions = [
        _read_motion(motion, motion["kind"].string(), motion["attached"].boolean(), joints)
        for motion in node["motions"].elements()
    ]
    return checks.CheckedPick(
        node["stop"].integer(), node["tray"].string(), node["part"].string(), node["grasp"].integer(), motions
    )
