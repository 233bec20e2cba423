"""Scenarios: one YAML file that says which robot does what in which storeroom (docs/scenario_format.md)."""

from __future__ import annotations

import functools
import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._argument_errors import checked
from .._core import (
    Box,
    CollisionChecker,
    InvalidInput,
    LinkShape,
    PartSupplyProblem,
    Plane,
    ReachDatabase,
    UnloadRegion,
    World,
)
from .._core import verify as checks
from .._files import shipped
from .._progress import Progress
from .._reach_cache import cached_database
from ..documents.reading import RENAMED, Node, read_yaml
from . import cell_bodies, drawn_bodies, floor_map
from .clearance import warn_of_little_room
from .contact_rules import ContactRules, read_contact_rules
from .grid_size import check_grid_size
from .gripper_section import clearance_key
from .held_grasps import ClosingHand
from .named_files import find_file
from .part_type import PartType
from .robot_section import RobotSetup, choose_sections, read_setup
from .scan_section import ScanReader, moved
from .schema import with_article
from .shapes import read_shapes
from .tray_section import TraySetup, footprint, read_part_types, read_tray

TOP_KEYS = "format version name robot start goal positioning_uncertainty trays"
TOP_OPTIONAL = (
    "arrival_covariance drive_clearance part_types gripper place_region unload_region floor obstacles "
    "allowed_collisions padding options reach"
)
FLOOR = "floor"
MOST_TRAYS = 1000
MOST_OBSTACLES = 10_000
LARGEST_OBSTACLE = 1000.0  # a side of a box, and how far off [m]
LONGEST_ARM = 10.0  # [m]
LEAST_CLEARANCE, MOST_CLEARANCE = 0.001, 10.0  # of drives [m]
LEAST_SAMPLES = 10_000  # of the database of what the arm reaches
SHAPE_KEYS = "box cylinder sphere mesh shapes scale"
FILE_KEYS = {
    **{"map": "height unknown", "octree": "unknown within", "cloud": "cell within"},
    **{"floor_plan": "thickness height", "scene": "", "urdf": "packages"},
}
"""Obstacles that are no shape of their own: read from files, or drawn; and the keys that each has."""
OBSTACLE_KEYS = " ".join(dict.fromkeys(["pose", *FILE_KEYS, *" ".join(FILE_KEYS.values()).split(), SHAPE_KEYS]))


@dataclass
class Obstacle:
    """A body of the room, as the scenario's `obstacles` describe it."""

    name: str
    pose: np.ndarray
    shapes: list[LinkShape]


@dataclass
class Scenario:
    """A scenario with everything resolved: files read, robot composed, parts placed, grasps sampled."""

    name: str
    source: str
    setup: RobotSetup
    obstacles: list[Obstacle]
    trays: list[TraySetup]
    start: np.ndarray
    goal: np.ndarray
    positioning_uncertainty: float
    options: dict[str, Any] = field(default_factory=dict)
    reach: dict[str, Any] = field(default_factory=dict)
    floor: float | None = 0.0
    """Height of level ground [m]; None: there is none."""
    rules: ContactRules = field(default_factory=ContactRules)
    arrival_covariance: np.ndarray | None = None
    """Covariance of x, y [m^2] and theta [rad^2] about a stop (3, 3); None: discs are all that counts."""
    drive_clearance: float = 0.0
    """Kept by drives farther than 1 m from both their ends [m]."""
    unload_region: UnloadRegion | None = None
    """Where parts are let go at the goal that the hand brings there; None: they go into the bin."""

    @property
    def world(self) -> World:
        """Obstacles and trays, without the parts and what is said of these."""
        world = self._obstacles()
        self.rules.apply(world, without={part.name for tray in self.trays for part in tray.tray.parts})
        return world

    @property
    def world_with_parts(self) -> World:
        """The obstacles and every part where it lies."""
        world = self._obstacles()
        for tray in self.trays:
            for part in tray.tray.parts:
                world.add(part.name, part.shapes, part.T_world_part)
        self.rules.apply(world)
        return world

    def _obstacles(self) -> World:
        world = World()
        for obstacle in self.obstacles:
            world.add(obstacle.name, obstacle.shapes, obstacle.pose)
        if self.floor is not None:
            world.add_floor(self.setup.arm, self.floor)
        return world

    def problem(self) -> PartSupplyProblem:
        """The same as objects for the planner."""
        setup = self.setup
        world = self._obstacles()
        self.rules.apply(world)
        return PartSupplyProblem(
            setup.robot,
            setup.arm,
            setup.gripper,
            world,
            [t.tray for t in self.trays],
            setup.home,
            self.start,
            self.goal,
            setup.place_region,
            arrival_covariance=self.arrival_covariance,
            drive_clearance=self.drive_clearance,
            unload_region=self.unload_region,
            positioning_uncertainty=self.positioning_uncertainty,
            **self.options,
        )

    def reach_database(self, progress: Progress = None) -> ReachDatabase:
        """The arm's reachability database, from the cache or built now; without a usable cache it is built each time."""
        options = {"threads": self.options.get("threads", 0)} | self.reach
        return cached_database(self.setup.arm, progress, **options)

    def __repr__(self) -> str:
        parts = sum(len(t.targets) for t in self.trays)
        return (
            f"Scenario({self.name!r}, robot {self.setup.robot.name!r}, {len(self.trays)} trays, {parts} parts to pick)"
        )


@checked
def load_scenario(
    path: str | os.PathLike[str],
    *,
    robot: str | None = None,
    seed: int | None = None,
    threads: int | None = None,
    progress: Progress = None,
) -> Scenario:
    """Reads a scenario (`asset:scenarios/...` for a shipped one); `robot` puts a robot profile (name or file) in place of the scenario's robot, gripper and bin.

    Raises InvalidInput or IoError with one message that names file, line, key, value and rule.
    """
    root = read_yaml(shipped(path)).root
    with root.blamed():
        return _read_scenario(root, str(Path(path).resolve()), robot, seed, threads, progress)


def _read_scenario(
    root: Node, source: str, robot: str | None, seed: int | None, threads: int | None, progress: Progress
) -> Scenario:
    _check_header(root)
    start, goal = np.array(root["start"].numbers(3)), np.array(root["goal"].numbers(3))
    uncertainty = root["positioning_uncertainty"].number(
        least=0, most=_core._supply_option_bounds()["positioning_uncertainty"][1]
    )
    covariance = _read_covariance(root["arrival_covariance"]) if "arrival_covariance" in root else None
    clearance = _read_clearance(root["drive_clearance"]) if "drive_clearance" in root else 0.0
    options = _read_options(root, "options", _core._supply_option_table(), {"positioning_uncertainty"})
    if covariance is not None and options.get("robustness_samples", 1) == 0:
        root["options"]["robustness_samples"].fail(
            "must be positive with an arrival_covariance: so many arrivals are drawn"
        )
    reach = _read_options(root, "reach", _core._reach_option_table(), set())
    if reach.get("samples", LEAST_SAMPLES) < LEAST_SAMPLES:
        root["reach"]["samples"].fail(
            f"must be at least {LEAST_SAMPLES}: fewer draws say nothing of what the arm reaches"
        )
    obstacles = _read_obstacles(root)
    setup = read_setup(choose_sections(root, robot), progress)
    if setup.robot.base == "fixed":
        root["robot"].fail("a part-supply round needs base: diff_drive or omni")
    unload_region = _read_unload_region(root["unload_region"], goal, setup) if "unload_region" in root else None
    _check_metres(root, obstacles, setup.robot.base_limits["workspace"])
    closing = ClosingHand(setup.arm, setup.gripper, setup.mesh_tolerance, setup.robot if setup.rates_all_pads else None)
    types = read_part_types(root["part_types"], closing, progress) if "part_types" in root else {}
    scans = ScanReader(closing, _in_world(obstacles), find_file, progress)
    trays = _read_trays(root, types, setup, scans)
    _warn_of_a_small_place(trays, types, setup, unload_region)
    warn_of_little_room(clearance_key(setup.sections.gripper), setup.gripper, trays)
    check_grid_size(root, trays, {key: value for key, (value, _) in _core._supply_option_table().items()} | options)
    for tray in trays:
        obstacles.append(Obstacle(f"tray {tray.tray.name}", tray.tray.T_world_tray, tray.walls))
    typed = [(p.shapes, p.T_world_part) for t in trays if t.scan is None for p in t.tray.parts]
    for name, shapes in scans.rest([*((o.shapes, o.pose) for o in obstacles), *typed]):
        obstacles.append(Obstacle(name, np.eye(4), shapes))
    floor = _read_floor(root, obstacles)
    _check_names(root, obstacles, trays)
    names = [o.name for o in obstacles] + ([FLOOR] if floor is not None else [])
    rules = read_contact_rules(root, setup.robot, names, [p.name for t in trays for p in t.tray.parts])
    if setup.gripper.suction is not None and any([*rules.padding.get("by_name", {}).values(), *_everywhere(rules)]):
        root["padding"].fail("must be left out: a hand of suction cups comes within 0.2 mm of its parts")
    _check_apart(root["trays"], trays, obstacles, floor, progress)
    if seed is not None:
        options["seed"] = seed
    if threads is not None:
        options["threads"] = threads
    scenario = Scenario(
        root["name"].label(),
        source,
        setup,
        obstacles,
        trays,
        start,
        goal,
        uncertainty,
        options,
        reach,
        floor,
        rules,
        covariance,
        clearance,
        unload_region,
    )
    for key in ("start", "goal"):
        _check_stands_free(root[key], scenario)
    return scenario


def _everywhere(rules: ContactRules) -> list[float]:
    return [rules.padding.get(key, 0.0) for key in ("links", "attached", "objects")]


def _check_header(root: Node) -> None:
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.place}: is no scenario: the key format: mmgrasp-scenario is missing")
    root["format"].choice("mmgrasp-scenario")
    root.read_version(3, RENAMED)
    root.mapping(TOP_KEYS, TOP_OPTIONAL)


def _read_options(root: Node, section: str, table: dict[str, tuple[Any, str]], elsewhere: set[str]) -> dict[str, Any]:
    options: dict[str, Any] = {}
    if section not in root:
        return options
    known = [key for key in table if key not in elsewhere]
    for key, node in root[section].items():
        if key not in known:
            node.refuse_key(known)
        options[key] = node.integer() if isinstance(table[key][0], int) else node.number()
    for key in options:  # one by one: the message then has the line of the option
        try:
            _core._check_options(section, **{key: options[key]})
        except InvalidInput as error:
            root[section][key].fail(re.sub(r"^[\w.]+ = \S+: ", "", str(error)))  # told with its name in the file
    return options


def _read_clearance(node: Node) -> float:
    clearance = node.number()
    if clearance != 0 and not LEAST_CLEARANCE <= clearance <= MOST_CLEARANCE:
        node.fail(f"must be 0, or lie between {LEAST_CLEARANCE:g} and {MOST_CLEARANCE:g}")
    return clearance


def _read_unload_region(node: Node, goal: np.ndarray, setup: RobotSetup) -> UnloadRegion:
    """A rectangle in the world, within the arm's reach of the goal."""
    node.mapping("pose size", "drop_height")
    if setup.gripper.suction is not None:
        node.fail("a hand of suction cups carries nothing on drives: what the base's acceleration pulls is not known")
    pose = node["pose"].pose()
    if pose[2, 2] < 1 - 1e-9:
        node["pose"].fail("must be level: parts are let go over it")
    away = float(np.hypot(*(pose[:2, 3] - goal[:2])))
    if away > LONGEST_ARM:
        node["pose"].fail(f"lies {away:g} m from the goal, where the parts are let go: xyz is in the world, in metres")
    options = {"drop_height": node["drop_height"].number(least=0)} if "drop_height" in node else {}
    with node.blamed():
        return UnloadRegion(pose, node["size"].numbers(2, above=0), **options)


def _read_covariance(node: Node) -> np.ndarray:
    """How far from a stop the base comes to stand: (3, 3), x, y [m^2] and theta [rad^2]."""
    covariance = np.array([row.numbers(3) for row in node.elements()])
    try:
        _core._check_arrival_covariance(covariance)
    except InvalidInput as error:
        node.fail(str(error))
    if not covariance.any():
        node.fail("is zero: leave it out where the base stops exactly, or say how far off it comes to stand")
    return covariance


def _read_obstacles(root: Node) -> list[Obstacle]:
    out = []
    nodes = root["obstacles"].elements() if "obstacles" in root else []
    if len(nodes) > MOST_OBSTACLES:
        root["obstacles"].fail(f"must be at most {MOST_OBSTACLES} obstacles: join some, in a mesh, an octree or a map")
    for node in nodes:
        node.mapping("name", OBSTACLE_KEYS)
        pose = node["pose"].pose() if "pose" in node else np.eye(4)
        out.append(Obstacle(node["name"].label(), pose, _read_obstacle_shapes(node)))
    return out


def _check_metres(root: Node, obstacles: list[Obstacle], workspace: float) -> None:
    """An obstacle of a kilometre, or a kilometre off, is one whose lengths were given in millimetres."""
    most = max(LARGEST_OBSTACLE, workspace + LONGEST_ARM)
    for node, obstacle in zip(root["obstacles"].elements() if "obstacles" in root else [], obstacles, strict=False):
        farthest = float(np.abs(obstacle.pose[:3, 3]).max())
        if farthest > most:
            node["pose"].fail(f"stands {farthest:g} m off, farther than {most:g} m: lengths are in metres")
        sides = [float(np.max(shape.shape.size)) for shape in obstacle.shapes if isinstance(shape.shape, Box)]
        if max(sides, default=0.0) > LARGEST_OBSTACLE:
            node.fail(
                f"has a box of {max(sides):g} m, longer than {LARGEST_OBSTACLE:g} m: lengths are in metres; use floor for the ground"
            )


def _read_obstacle_shapes(node: Node) -> list[LinkShape]:
    """What a file or a drawing holds, or the shapes of a body."""
    given = [name for name in FILE_KEYS if name in node]
    if len(given) > 1:
        node[given[1]].fail(f"{with_article(given[0])} has no {given[1]} beside it: give each an obstacle of its own")
    own = FILE_KEYS[given[0]].split() if given else SHAPE_KEYS.split()
    for key in dict.fromkeys(" ".join([*FILE_KEYS.values(), SHAPE_KEYS]).split()):
        if key in node and key not in own and key not in given:
            owners = " or ".join(with_article(name) for name, keys in FILE_KEYS.items() if key in keys.split())
            node[key].fail(f"only {owners} has it" if owners else f"{with_article(given[0])} has no other shape")
    readers = {
        **{"map": floor_map.read_floor_map, "octree": cell_bodies.read_octree, "cloud": cell_bodies.read_cloud},
        **{
            "floor_plan": drawn_bodies.read_floor_plan,
            "scene": drawn_bodies.read_scene,
            "urdf": drawn_bodies.read_urdf,
        },
    }
    return readers[given[0]](node) if given else read_shapes(node, find_file)


def _read_floor(root: Node, obstacles: list[Obstacle]) -> float | None:
    """Height of the ground; None where the scenario says `none`."""
    if "floor" in root and root["floor"].raw == "none":
        return None
    height = root["floor"].number() if "floor" in root else 0.0
    for node, obstacle in zip(root["obstacles"].elements() if "obstacles" in root else [], obstacles, strict=False):
        if obstacle.name == FLOOR:
            node["name"].fail(
                f"the name {FLOOR!r} is that of the ground; give the obstacle another one, or say floor: none"
            )
    return height


def _in_world(obstacles: list[Obstacle]) -> list[LinkShape]:
    return [moved(s, o.pose) for o in obstacles for s in o.shapes]


def _read_trays(root: Node, types: dict[str, PartType], setup: RobotSetup, scans: ScanReader) -> list[TraySetup]:
    if len(root["trays"].elements()) > MOST_TRAYS:
        root["trays"].fail(f"must be at most {MOST_TRAYS} trays: plan for some of them at a time")
    workspace = setup.robot.base_limits["workspace"]
    trays = []
    for node in root["trays"].elements():
        tray = read_tray(node, types, setup.gripper, scans)
        farthest = float(np.abs(tray.tray.T_world_tray[:2, 3]).max())
        if farthest > workspace + LONGEST_ARM:
            node["pose"].fail(
                f"stands {farthest:g} m off, where no base within base_limits.workspace, {workspace:g} m, reaches it: lengths are in metres"
            )
        trays.append(tray)
    if not any(tray.targets for tray in trays):
        root["trays"].fail("at least one part of one tray must be a target")
    return trays


def _warn_of_a_small_place(
    trays: list[TraySetup], types: dict[str, PartType], setup: RobotSetup, unload_region: UnloadRegion | None
) -> None:
    """Parts are let go level, with their origin over the bin or the region: what is wider does not fall into it."""
    place = setup.place_region if unload_region is None else unload_region
    assert place is not None  # choose_sections() refuses a scenario without both
    key, size = "place_region" if unload_region is None else "unload_region", place.size
    seen: set[str] = set()
    for tray in trays:
        targets = [p for p in tray.tray.parts if p.name in tray.targets and tray.kinds.get(p.name, "") in types]
        for part in targets:
            kind = tray.kinds[part.name]
            if kind in seen:
                continue
            seen.add(kind)
            sides = np.sort(footprint(types[kind], part.T_world_part))
            if np.any(sides > np.sort(size) + 1e-6):
                types[kind].node.warn(
                    f"is {1e3 * sides[0]:.0f} x {1e3 * sides[1]:.0f} mm, larger than {key}.size, {1e3 * size[0]:.0f} x {1e3 * size[1]:.0f} mm"
                )


def _check_names(root: Node, obstacles: list[Obstacle], trays: list[TraySetup]) -> None:
    own = [node["name"] for node in root["obstacles"].elements()] if "obstacles" in root else []
    named = [(node.raw, node) for node in own]
    for node, tray in zip(root["trays"].elements(), trays, strict=True):
        named += [(name, node["name"]) for name in (f"tray {tray.tray.name}", *(p.name for p in tray.tray.parts))]
    scanned = [(o.name, root["trays"]) for o in obstacles[len(own) + len(trays) :]]
    seen: set[str] = set()
    for name, node in named + scanned:
        if name in seen:
            node.fail(f"the name {name!r} is used twice (obstacles, trays and parts share names)")
        seen.add(name)


def _check_apart(
    node: Node, trays: list[TraySetup], obstacles: list[Obstacle], floor: float | None, progress: Progress
) -> None:
    """No two trays in one place, no two parts, no part in an obstacle or a wall of a tray, neither in the ground."""
    ground = [] if floor is None else [Obstacle(FLOOR, np.eye(4), [LinkShape(Plane([0, 0, 1], floor))])]
    walls = [checks.CheckedBody(f"tray {t.tray.name}", t.walls, t.tray.T_world_tray) for t in trays]
    overlapping = functools.partial(checks.overlapping_bodies, progress=progress)
    for i, j in overlapping(walls):
        node.elements()[j].fail(f"overlaps tray {trays[i].tray.name}")
    for _, j in overlapping(_checked(ground) + walls) if ground else []:
        node.elements()[j - 1].fail(
            f"tray {trays[j - 1].tray.name} reaches under the floor, z = {floor:g} m (the key floor)"
        )
    owners = [k for k, t in enumerate(trays) for _ in t.tray.parts]
    parts = [part for t in trays for part in t.tray.parts]
    for i, j in overlapping([checks.CheckedBody(p.name, p.shapes, p.T_world_part) for p in parts]):
        node.elements()[owners[j]]["parts"].fail(f"part {parts[j].name} overlaps part {parts[i].name}")
    room = _checked(obstacles + ground)
    typed = [(k, part) for k, t in enumerate(trays) if t.scan is None for part in t.tray.parts]
    bodies = [checks.CheckedBody(part.name, part.shapes, part.T_world_part) for _, part in typed]
    for i, j in overlapping(room + bodies) if bodies else []:
        if i < len(room) <= j:
            k, part = typed[j - len(room)]
            node.elements()[k]["parts"].fail(
                f"part {part.name} overlaps {(obstacles + ground)[i].name} by more than 0.1 mm"
            )


def _checked(bodies: list[Obstacle]) -> list[checks.CheckedBody]:
    return [checks.CheckedBody(o.name, o.shapes, o.pose) for o in bodies]


def _check_stands_free(node: Node, scenario: Scenario) -> None:
    x, y, theta = node.numbers(3)
    setup = scenario.setup
    workspace = setup.robot.base_limits["workspace"]
    if max(abs(x), abs(y)) > workspace:
        node.fail(f"must lie within base_limits.workspace, {workspace:g} m along x and y")
    arm = setup.arm.at(_core.pose([x, y, 0], rpy=[0, 0, theta]))
    contacts = CollisionChecker(setup.robot, scenario.world_with_parts, arm).contacts(setup.home)
    if contacts:
        pairs = ", ".join(
            f"{c.a} comes closer to {c.b} than their padding" if c.by_padding else f"{c.a} touches {c.b}"
            for c in contacts[:3]
        )
        more = f" and {len(contacts) - 3} more" if len(contacts) > 3 else ""
        node.fail(f"the robot at home is in collision there: {pairs}{more}")
