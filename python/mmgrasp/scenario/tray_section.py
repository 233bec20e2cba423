"""The sections `part_types` and `trays` of a scenario: trays as walls in the scene, parts in them with their grasps."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .. import _core
from .._core import Box, Grasp, Hand, LinkShape, Part, Tray
from .._core import verify as checks
from .._files import printable
from .._progress import Progress
from ..documents.reading import Node, near_miss
from .cup_grasps import read_cup_grasps
from .held_grasps import CLOSING_PLAY, ClosingHand
from .named_files import find_file
from .part_type import PartType, read_grasp_options
from .scan_section import ScanReader, TrayScan, moved
from .shapes import read_shapes
from .tray_body import BODY_KEYS, STEEPEST, WALL, TrayBody, read_tray_body, tilt

MOST_PARTS = 1000  # in one tray
MOST_HEADINGS = 360  # of one tray
LARGEST_TRAY = 100.0  # [m]
GAP = 0.001  # parts rest this far above the floor, so that nothing touches at rest [m]


Placed = tuple[str, str, np.ndarray]
"""Name, type and T_tray_part of a typed part."""


@dataclass
class TraySetup:
    """One of `trays`: the tray with its parts, and what their types are."""

    tray: Tray
    walls: list[LinkShape]
    targets: list[str] = field(default_factory=list)
    scan: TrayScan | None = None
    """Where the parts come from, unless they were typed."""
    body: TrayBody | None = None
    """Its measures; None: it has a body of its own."""
    wanted: dict[str, int] = field(default_factory=dict)
    """How many parts of which type are picked, any of them; empty: `targets` are. Until they are chosen all parts of these types are targets."""
    kinds: dict[str, str] = field(default_factory=dict)
    """Type of each typed part, by its name."""

    def of_kind(self, kind: str) -> list[str]:
        """Names of the parts of a type."""
        return [name for name, own in self.kinds.items() if own == kind]


def read_part_types(node: Node, closing: ClosingHand, progress: Progress = None) -> dict[str, PartType]:
    """The section `part_types`, which takes long where parts are fine meshes; raises InvalidInput for grasps that hold nothing."""
    types: dict[str, PartType] = {}
    gripper = closing.hand
    entries = list(node.items())
    for name, entry in entries:
        tell = _telling_of(name, len(types) / len(entries), progress)
        if tell is not None:
            tell("", 0.0)
        entry.mapping("", "box cylinder sphere mesh shapes scale mass grasps grasp_options")
        shapes = read_shapes(entry, find_file)
        mass = entry["mass"].number(above=0, most=1e6) if "mass" in entry else 0.0
        if gripper.suction is not None:
            types[name] = read_cup_grasps(entry, name, shapes, gripper, mass)
            continue
        options = _grasp_options(entry)
        if "grasps" in entry:
            listed, too_wide = _listed_grasps(entry["grasps"], gripper)
            grasps = [grasp for _, grasp in listed]
            _check_they_hold(entry["grasps"], name, shapes, grasps, gripper)
            _check_openings(listed, name, shapes, gripper)
            _check_fingers_meet(listed, name, shapes, closing)
            types[name] = PartType(shapes, grasps, too_wide, entry, mass)
        else:
            types[name] = _sampled_type(shapes, entry, mass, closing, options, tell)
    return types


def _sampled_type(
    shapes: list[LinkShape],
    entry: Node,
    mass: float,
    closing: ClosingHand,
    options: dict[str, Any],
    progress: Progress,
) -> PartType:
    def draw(asked: dict[str, Any]) -> tuple[list[Grasp], list[Grasp], int]:
        drawn, too_wide = _core._sample_grasps(shapes, closing.hand, progress=progress, **asked)
        return drawn, closing.held(shapes, drawn), too_wide

    drawn, grasps, too_wide = draw(options)
    most = options.get("max_grasps", _core._grasp_option_table()["max_grasps"][0])
    if len(grasps) < len(drawn) == most:  # There may be others in their place.
        bound = int(_core._grasp_option_bounds()["max_grasps"][1])
        drawn, grasps, too_wide = draw({**options, "max_grasps": min(8 * most, bound)})
    return PartType(
        shapes,
        grasps[:most],
        too_wide,
        entry,
        mass,
        closing=closing,
        not_met=len(drawn) - len(grasps),
        grasp_options=options,
        progress=progress,
    )


def _telling_of(name: str, fraction: float, progress: Progress) -> Progress:
    """Tells, whatever it hears, that the grasps of a part type are sought."""
    if progress is None:
        return None
    return lambda *_: progress(f"grasps of {printable(name)}", fraction)


def _grasp_options(entry: Node) -> dict[str, Any]:
    options = read_grasp_options(entry, _core._grasp_option_table())
    if not options:
        return {}
    try:
        _core._sample_grasps([LinkShape(Box([0.01, 0.01, 0.01]))], _any_gripper(), **options)
    except _core.InvalidInput as error:
        entry["grasp_options"].fail(str(error))
    return options


def _any_gripper() -> Hand:
    return Hand("tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.03, finger_width=0.02)


Listed = list[tuple[Node, Grasp]]
"""Listed grasps that the gripper opens wide enough for, and where they stand."""


def _listed_grasps(node: Node, gripper: Hand) -> tuple[Listed, int]:
    listed, too_wide = [], 0
    for entry in node.elements():
        entry.mapping("pose opening", "quality")
        opening = entry["opening"].number(least=0)
        if opening > gripper.max_opening:
            too_wide += 1
            continue
        quality = entry["quality"].number(least=0) if "quality" in entry else 1.0
        listed.append((entry, Grasp(entry["pose"].pose(), opening, quality=quality)))
    return listed, too_wide


def _check_they_hold(node: Node, name: str, shapes: list[LinkShape], grasps: list[Grasp], gripper: Hand) -> None:
    """Refuses grasps at which fingers that close from their widest opening meet nothing of the part."""
    part = checks.CheckedBody(name, shapes, np.eye(4))
    across = np.cross(gripper.approach, gripper.closing)
    axes = np.eye(4)
    axes[:3, :3] = np.column_stack((gripper.approach, gripper.closing, across))
    pads = [max(gripper.finger_depth, 0.002), gripper.max_opening, max(gripper.finger_width, 0.002)]
    empty = []
    for grasp in grasps:
        between = checks.CheckedBody("between the pads", [LinkShape(Box(pads))], grasp.T_object_hand @ axes)
        if not checks.overlapping_bodies([part, between]):
            empty.append(grasp)
    if empty:
        x, y, z = empty[0].T_object_hand[:3, 3]
        node.fail(
            f"{len(empty)} of {len(grasps)} grasps hold nothing of part type {name}: no part of it is between the fingers, e.g. "
            f"with the tool frame at ({x:.4g}, {y:.4g}, {z:.4g}) m in the part's frame"
        )


def _check_openings(listed: Listed, name: str, shapes: list[LinkShape], gripper: Hand) -> None:
    """Refuses grasps whose pads meet the part otherwise than their opening says, by the rule of `verify`."""
    if not (gripper.finger_depth > 0 and gripper.finger_width > 0):
        return
    for entry, grasp in listed:
        checked = checks.CheckedGrasp(grasp.T_object_hand, grasp.opening)
        unlike = checks.pads_unlike_grasp(gripper, shapes, checked)
        if unlike:
            entry["opening"].fail(f"does not hold part type {name}: {unlike}")


def _check_fingers_meet(listed: Listed, name: str, shapes: list[LinkShape], closing: ClosingHand) -> None:
    """Refuses grasps at which the closing fingers do not meet the part, or stand in it, by the rules of `verify`."""
    grasps = [grasp for _, grasp in listed]
    meet, fit = closing.meets(shapes, grasps), closing.fits(shapes, grasps)
    for (entry, _), meets, fits in zip(listed, meet, fit, strict=True):
        if not fits:
            entry.fail(f"does not hold part type {name}: it is wider beside the pads, fingers would stand in it")
        if not meets:
            entry.fail(
                f"does not hold part type {name}: fingers do not meet it from both sides, closing from its "
                f"opening as far as they may ({CLOSING_PLAY})"
            )


def read_tray(node: Node, types: dict[str, PartType], gripper: Hand, scans: ScanReader) -> TraySetup:
    """One tray of the section `trays`."""
    node.mapping("name pose size", f"parts scan headings targets {BODY_KEYS}")
    name, T_world_tray = node["name"].label(), node["pose"].pose()
    body, shapes, own = read_tray_body(node, find_file)
    if max(body.size) > LARGEST_TRAY:
        node["size"].fail(f"a tray must be at most {LARGEST_TRAY:g} m long, wide and high: lengths are in metres")
    if tilt(T_world_tray) > STEEPEST:
        node["pose"].fail(f"a tray must not be tilted by more than {STEEPEST:g} degrees")
    if ("parts" in node) == ("scan" in node):
        node.fail("must have either parts or scan")
    headings = node["headings"].numbers() if "headings" in node else []
    scan, wanted, kinds = None, {}, {}
    if len(headings) > MOST_HEADINGS:
        node["headings"].fail(f"must be at most {MOST_HEADINGS} headings: each is a layer of the base grid")
    if "scan" in node:
        if gripper.suction is not None:
            node["scan"].fail("objects of a scan are held by fingers: the gripper has suction cups")
        _check_scannable(node, T_world_tray, body)
        parts, targets, scan = _scanned(node, types, name, T_world_tray, list(body.size), scans)
    else:
        placed = _placed(node["parts"], types)
        kinds = {f"{name}/{part}": kind for part, kind, _ in placed}
        wanted = _wanted(node, list(kinds.values()))
        parts, targets = _typed(node, types, name, T_world_tray, None if own else body, gripper, placed, wanted)
    tray = Tray(name, T_world_tray, body.size, parts, headings)
    return TraySetup(tray, shapes, targets, scan, None if own else body, wanted, kinds)


def _wanted(node: Node, kinds: list[str]) -> dict[str, int]:
    """Parts asked for by number: a mapping from type to number in `targets`."""
    if "targets" not in node or not isinstance(node["targets"].raw, dict):
        return {}
    wanted = {}
    for kind, entry in node["targets"].items():
        if kind not in kinds:
            entry.refuse_key(list(dict.fromkeys(kinds)))
        wanted[kind] = entry.integer(least=1)
        if wanted[kind] > kinds.count(kind):
            entry.fail(f"the tray holds no more than {kinds.count(kind)} of type {kind}")
    return wanted


def _check_scannable(node: Node, T_world_tray: np.ndarray, body: TrayBody) -> None:
    """A map's objects are parted by a level floor and walls of the usual thickness."""
    if T_world_tray[2, 2] < 1 - 1e-9:
        node["pose"].fail("a scanned tray must stand level (roll and pitch 0)")
    for key in BODY_KEYS.split():
        if key in node:
            node[key].fail("a scanned tray is an open box with the usual walls")
    if body != TrayBody(body.size):
        node["size"].fail("a scanned tray is an open box with the usual walls: give its outer size as numbers")


def _scanned(
    node: Node, types: dict[str, PartType], name: str, T_world_tray: np.ndarray, size: list[float], scans: ScanReader
) -> tuple[list[Part], list[str], TrayScan]:
    def typed(parts: Node) -> list[LinkShape]:
        return [moved(s, T) for _, kind, T in _placed(parts, types) for s in types[kind].shapes]

    found, scan, reasons = scans.read(node["scan"], name, T_world_tray, size, WALL, GAP, typed)
    targets = _targets(node, [part.name for part in found], [part.name.removeprefix(f"{name}/") for part in found])
    for part in found:
        if part.name in targets and not part.grasps:
            where = (
                f"; targets may leave it out ({', '.join(p.name for p in found if p.grasps) or 'no part has a grasp'})"
            )
            node["scan"].fail(f"part {part.name} has no grasp: {reasons[part.name]()}{where}")
    parts = [
        Part(
            part.name,
            part.shapes,
            part.T_world_part,
            part.grasps,
            target=part.name in targets,
            grasps_too_wide=part.grasps_too_wide,
            grasps_sampled=True,
        )
        for part in found
    ]
    return parts, targets, scan


def _placed(node: Node, types: dict[str, PartType]) -> list[Placed]:
    placed = _grid(node, types) if isinstance(node.raw, dict) else _list(node, types)
    if not placed:
        node.fail("a tray must hold at least one part")
    return placed


def _typed(
    node: Node,
    types: dict[str, PartType],
    name: str,
    T_world_tray: np.ndarray,
    body: TrayBody | None,
    gripper: Hand,
    placed: list[Placed],
    wanted: dict[str, int],
) -> tuple[list[Part], list[str]]:
    names = [f"{name}/{own}" for own, _, _ in placed]
    targets = (
        [full for full, (_, kind, _) in zip(names, placed, strict=True) if kind in wanted]
        if wanted
        else _targets(node, names, [own for own, _, _ in placed])
    )
    parts = []
    for full, (_, kind, T_tray_part) in zip(names, placed, strict=True):
        if body is not None:
            _check_inside(node, full, types[kind], T_tray_part, body)
        grasps = types[kind].grasps
        if full in targets:
            grasps = types[kind].grasps_on(T_tray_part)
            _check_graspable(full, types[kind], grasps, gripper)
        parts.append(
            Part(
                full,
                types[kind].shapes,
                T_world_tray @ T_tray_part,
                grasps,
                target=full in targets,
                grasps_too_wide=types[kind].too_wide,
                mass=types[kind].mass,
                grasps_sampled=types[kind].sampled,
            )
        )
    return parts, targets


def _kind(node: Node, types: dict[str, PartType]) -> str:
    kind = node.string()
    if kind not in types:
        node.fail(f"no such part type{near_miss(kind, list(types))}")
    return kind


def _bounds(kind: PartType, T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    boxes = [LinkShape(shape.shape, T @ shape.pose).bounds for shape in kind.shapes]
    return np.min([low for low, _ in boxes], axis=0), np.max([high for _, high in boxes], axis=0)


def footprint(kind: PartType, T: np.ndarray) -> np.ndarray:
    """Length and width of a part that lies as in T, along the horizontal direction of its own x axis and across [m]."""
    level = _core.pose([0, 0, 0], rpy=[0, 0, -np.arctan2(T[1, 0], T[0, 0])]) @ T
    low, high = _bounds(kind, level)
    return np.asarray((high - low)[:2])


def _resting(kind: PartType, x: float, y: float, rpy: list[float]) -> np.ndarray:
    T = _core.pose([x, y, 0], rpy=rpy)
    T[2, 3] = GAP - _bounds(kind, T)[0][2]
    return T


def _grid(node: Node, types: dict[str, PartType]) -> list[Placed]:
    node.mapping("type grid spacing", "yaw")
    kind = _kind(node["type"], types)
    counts = [entry.integer(least=1) for entry in node["grid"].elements()]
    if len(counts) != 2:
        node["grid"].fail("must be two numbers: how many along x and along y")
    if counts[0] * counts[1] > MOST_PARTS:
        node["grid"].fail(f"must not place more than {MOST_PARTS} parts in one tray")
    spacing = node["spacing"].numbers(2, above=0)
    yaw = node["yaw"].number() if "yaw" in node else 0.0
    placed: list[Placed] = []
    for i in range(counts[0]):
        for j in range(counts[1]):
            x, y = (i - (counts[0] - 1) / 2) * spacing[0], (j - (counts[1] - 1) / 2) * spacing[1]
            placed.append((f"{kind}_{len(placed):02d}", kind, _resting(types[kind], x, y, [0, 0, yaw])))
    return placed


def _list(node: Node, types: dict[str, PartType]) -> list[Placed]:
    placed: list[Placed] = []
    if len(node.elements()) > MOST_PARTS:
        node.fail(f"must not list more than {MOST_PARTS} parts in one tray")
    for entry in node.elements():
        entry.mapping("type xyz", "name rpy")
        kind = _kind(entry["type"], types)
        name = entry["name"].label() if "name" in entry else f"{kind}_{len(placed):02d}"
        if name in [other for other, _, _ in placed]:
            entry.fail(f"the name {name} is used twice in this tray")
        rpy = entry["rpy"].numbers(3) if "rpy" in entry else [0.0, 0.0, 0.0]
        xyz = entry["xyz"].numbers()
        if len(xyz) not in (2, 3):
            entry["xyz"].fail("must be x, y (the part rests on the floor) or x, y, z in the tray's frame")
        T = _resting(types[kind], xyz[0], xyz[1], rpy) if len(xyz) == 2 else _core.pose(xyz, rpy=rpy)
        placed.append((name, kind, T))
    return placed


def _targets(node: Node, names: list[str], own: list[str]) -> list[str]:
    if "targets" not in node or node["targets"].raw == "all":
        return list(names)
    if isinstance(node["targets"].raw, dict):
        node["targets"].fail(
            "must be all or a list of parts: objects of a scan have no types" if "scan" in node else "must name a type"
        )
    chosen: list[str] = []
    for entry in node["targets"].elements():
        if isinstance(entry.raw, str):
            if entry.raw not in own and entry.raw not in names:
                entry.fail(f"no such part in this tray{near_miss(entry.raw, own)}")
            name = names[own.index(entry.raw)] if entry.raw in own else entry.raw
        else:
            index = entry.integer(least=0)
            if index >= len(names):
                entry.fail(f"must be below the number of parts, {len(names)}")
            name = names[index]
        if name in chosen:
            entry.fail(f"part {name} is listed twice")
        chosen.append(name)
    return chosen


def _check_inside(node: Node, name: str, kind: PartType, T: np.ndarray, body: TrayBody) -> None:
    low, high = _bounds(kind, T)
    inner = body.inner / 2
    if (low[:2] < -inner).any() or (high[:2] > inner).any():
        node["parts"].fail(
            f"part {name} reaches through the tray's wall (inner size {2 * inner[0]:g} x {2 * inner[1]:g} m)"
        )
    if low[2] <= 0:
        node["parts"].fail(f"part {name} reaches {-low[2]:.4g} m through the tray's floor")
    if body.roof is not None and high[2] >= body.roof:
        node["parts"].fail(f"part {name} reaches {high[2] - body.roof:.4g} m through the tray's roof")


def _check_graspable(name: str, kind: PartType, grasps: list[Grasp], gripper: Hand) -> None:
    if gripper.suction is not None and kind.mass == 0:
        kind.node.fail(f"part {name} has no mass [kg], which a hand of suction cups must know: cups hold by force")
    if kind.mass > gripper.payload:
        kind.node["mass"].fail(f"part {name} weighs more than the gripper's payload, {gripper.payload:g} kg")
    if grasps:
        return
    if kind.why_none:
        kind.node.fail(f"part {name} has no grasp: {kind.why_none}")
    _refuse_at_option(name, kind)
    if kind.not_met:
        kind.node.fail(
            f"part {name} has no grasp: in none of {kind.not_met} do fingers meet it from both sides, closing from its "
            f"width as far as they may ({CLOSING_PLAY}): it is thinner than the gap that they leave, their "
            "faces stand too far back, or it is wider beside the pads, where fingers would stand in it"
        )
    if kind.too_wide:
        kind.node.fail(
            f"part {name} is larger than the gripper: none of {kind.too_wide} grasps fits its opening of "
            f"{gripper.max_opening:g} m"
        )
    if not kind.sampled:
        kind.node["grasps"].fail(f"part {name} has no grasp: none is listed")
    kind.node.fail(f"part {name} has no grasp: no two opposite surfaces were found for the gripper")


def _refuse_at_option(name: str, kind: PartType) -> None:
    """Fails at the first option of the sampler without which the part would have grasps, or at all of them together."""

    closing = kind.closing
    if closing is None:
        return

    def count_with(options: dict[str, Any]) -> int:
        drawn, _ = _core._sample_grasps(kind.shapes, closing.hand, progress=kind.progress, **options)
        return len(closing.held(kind.shapes, drawn))

    for key in kind.grasp_options:
        count = count_with({other: value for other, value in kind.grasp_options.items() if other != key})
        if count:
            kind.node["grasp_options"][key].fail(f"leaves part {name} no grasp: without it there are {count}")
    if len(kind.grasp_options) > 1 and (count := count_with({})):
        kind.node["grasp_options"].fail(f"leaves part {name} no grasp: without these options there are {count}")
