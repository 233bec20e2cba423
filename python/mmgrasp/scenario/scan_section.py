"""The key `scan` of a tray: what lies in it is what a map of depth frames shows (docs/scenario_format.md)."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import Box, Grasp, Hand, InvalidInput, IoError, LinkShape, Outcome, Part, ProbabilisticSdf
from .._files import printable, sha256_of
from .._progress import Progress, is_callers
from ..documents.reading import Node
from ..scan.map_folder import MAP, TrayObject, load_map, objects_in_tray
from ..scan.rendered import Tour, rendered_map
from .held_grasps import CLOSING_PLAY, ClosingHand
from .map_bodies import Footprint, cell_boxes, cells_around, edge_for, inside_boxes, large_pieces, object_boxes

SIGMAS = 2.0
SAMPLES, MOST_GRASPS = 800, 40
"""Options of synthesize_grasps for each part: base regions want more grasps to choose from than one arm at one place."""
_FROM_THE_SIDE, _ROUND, _MORE = {"max_tilt": 1.6}, {"plane_tolerance": 0.004}, {"samples": 3000}
_HELPS = (_FROM_THE_SIDE, _ROUND, _FROM_THE_SIDE | _ROUND, _FROM_THE_SIDE | _ROUND | _MORE)
"""Options that are tried for a part without a grasp, to say which help."""
_WIDTH_PLAY = 0.0025  # pads on the part's columns and on the map's mean may differ by so much [m]
_MOST_RENDERED = {"views": 500, "distance": 2.0, "noise": 0.02, "seed": 1_000_000}
_PAD = 0.0005  # half the side of these pads [m]
_ROOM = 0.01  # around an object's points, within which its surface is taken from the map [m]
_HIGHEST = 0.5  # objects reach at most so high above the floor [m]


@dataclass(frozen=True)
class TrayScan:
    """Where a tray's parts come from."""

    map_file: Path
    sigmas: float
    grasp_options: dict[str, Any]
    fingertips: bool = False
    """Whether grasps were rated with a pad on each fingertip of a hand of many joints, not with two in its middle."""

    def to_dict(self, tray: str) -> dict[str, Any]:
        """An entry of a plan's `scenario.scans`."""
        path = str(self.map_file)
        return {
            "tray": tray,
            "map": path,
            "sha256": sha256_of(path),
            "sigmas": self.sigmas,
            "grasp_options": self.grasp_options,
            **({"fingertips": True} if self.fingertips else {}),
        }


def tolerance(sdf: ProbabilisticSdf) -> float:
    """What the map has so near to a known surface is that surface [m]."""
    return max(0.004, 2 * sdf.voxel)


@dataclass
class _LoadedMap:
    folder: Path
    sdf: ProbabilisticSdf
    sigmas: float
    tray: str
    """The first one that named it."""
    bodies: list[tuple[list[LinkShape], np.ndarray]] = field(default_factory=list)


@dataclass(frozen=True)
class _SeenPart:
    """A part that a map shows."""

    made: _LoadedMap
    thing: TrayObject
    name: str
    shapes: list[LinkShape]
    T_world_part: np.ndarray


class ScanReader:
    """Reads the key `scan` of one tray after another; `rest` is what the maps hold beside their parts."""

    def __init__(
        self, closing: ClosingHand, scene: list[LinkShape], find: Callable[[Node], Path], progress: Progress
    ) -> None:
        """`scene`: the typed obstacles in the world, which rendered frames show too; `find`: file that a node names."""
        self._closing, self._scene, self._find, self._progress = closing, scene, find, progress
        self._maps: dict[Path, _LoadedMap] = {}

    def read(
        self,
        node: Node,
        tray: str,
        T_world_tray: np.ndarray,
        size: list[float],
        wall: float,
        gap: float,
        typed: Callable[[Node], list[LinkShape]],
    ) -> tuple[list[Part], TrayScan, dict[str, Callable[[], str]]]:
        """The parts of a tray, none of them a target yet, and of those without a grasp what says why. `typed(node)` gives the
        shapes in the tray's frame that a rendered map shows."""
        options: dict[str, Any] = {}
        if isinstance(node.raw, dict):
            node.mapping("", "map rendered sigmas grasp_options")
            if ("map" in node) == ("rendered" in node):
                node.fail("must have either map or rendered")
            sigmas = node["sigmas"].number(least=0) if "sigmas" in node else SIGMAS
            options = synthesis_options(node["grasp_options"]) if "grasp_options" in node else {}
            if "map" in node:
                named, folder = node["map"], self._find(node["map"])
            else:
                named, folder = node["rendered"], self._rendered(node["rendered"], T_world_tray, size, wall, typed)
        else:
            sigmas, named, folder = SIGMAS, node, self._find(node)
        made = self._load(named, folder.resolve(), tray, sigmas)
        inner = np.array(size[:2]) - 2 * wall
        inside = objects_in_tray(made.sdf, T_world_tray, inner, _HIGHEST, tolerance(made.sdf))
        if not inside:
            named.fail(
                f"{printable(str(folder))} shows no object in tray {tray}: is it empty, or do its frames have poses in another world than the scenario's?"
            )
        footprints = [Footprint(thing.T_tray_box, thing.size) for thing in inside]
        parts: list[Part] = []
        reasons: dict[str, Callable[[], str]] = {}
        for k, thing in enumerate(inside):
            if self._progress:
                self._progress("grasps of what was scanned", k / len(inside))
            shapes = object_boxes(
                made.sdf, T_world_tray, inner, k, footprints, gap, max(tolerance(made.sdf), gap), sigmas
            )
            name = f"{tray}/object_{k + 1}"
            if not shapes:
                named.fail(f"object_{k + 1} of tray {tray} has no surface above the floor's play")
            T_tray_part = _core.pose([*footprints[k].T_tray_box[:2, 3], 0.0])
            shapes = [LinkShape(s.shape, np.linalg.inv(T_tray_part) @ s.pose) for s in shapes]
            try:
                seen = _SeenPart(made, thing, name, shapes, T_world_tray @ T_tray_part)
                part = self._with_grasps(seen, options, reasons)
            except InvalidInput as error:
                (node["grasp_options"] if options else named).fail(str(error))
            made.bodies.append((part.shapes, part.T_world_part))
            parts.append(part)
        return parts, TrayScan(made.folder / MAP, sigmas, options, self._closing.robot is not None), reasons

    def rest(self, known: list[tuple[list[LinkShape], np.ndarray]]) -> list[tuple[str, list[LinkShape]]]:
        """For each map a name and boxes in the world: cells around its surface, as far as `sigmas` standard deviations, where that
        is not that of a `known` body or of a part."""
        out = []
        for made in self._maps.values():
            mesh, sigma = made.sdf.mesh()
            left = np.ones(len(mesh.vertices), dtype=bool)
            for shapes, T in [*known, *(body for other in self._maps.values() for body in other.bodies)]:
                index = np.flatnonzero(left)
                left[index[inside_boxes(mesh.vertices[index], shapes, T, tolerance(made.sdf))]] = False
            left = large_pieces(mesh.triangles, left)
            if left.any():
                radii = np.minimum(made.sigmas * sigma[left], made.sdf.truncation)
                points = mesh.vertices[left]
                edge = edge_for(points, radii, made.sdf.voxel)
                out.append((f"scan {made.tray}", cell_boxes(cells_around(points, radii, edge), edge)))
        return out

    def _load(self, node: Node, folder: Path, tray: str, sigmas: float) -> _LoadedMap:
        if folder not in self._maps:
            if not folder.is_dir():
                node.fail("must be a folder that mmgrasp scan wrote: there is none")
            try:
                self._maps[folder] = _LoadedMap(folder, load_map(folder), sigmas, tray)
            except IoError as error:
                node.fail(str(error))
        made = self._maps[folder]
        if sigmas != made.sigmas:
            node.fail(f"sigmas = {sigmas:g}: tray {made.tray} reads the same map with {made.sigmas:g}")
        return made

    def _rendered(
        self,
        node: Node,
        T_world_tray: np.ndarray,
        size: list[float],
        wall: float,
        typed: Callable[[Node], list[LinkShape]],
    ) -> Path:
        node.mapping("parts", "views distance noise seed")
        defaults = Tour()
        tour = Tour(
            node["views"].integer(least=1) if "views" in node else defaults.views,
            node["distance"].number(above=0.2) if "distance" in node else defaults.distance,
            node["noise"].number(above=0) if "noise" in node else defaults.noise,
            node["seed"].integer(least=0) if "seed" in node else defaults.seed,
        )
        for key, highest in _MOST_RENDERED.items():
            if getattr(tour, key) > highest:
                node[key].fail(f"must be at most {highest:g}")
        shapes = [*_core.tray_shapes(size, wall), *typed(node["parts"])]
        scene = self._scene + [moved(s, T_world_tray) for s in shapes]
        content = hashlib.sha256(json.dumps([_core.__version__, vars(tour), *map(_description, scene)]).encode())
        target = T_world_tray @ _core.pose([0.0, 0.0, 0.03])
        folder = Path(_core.cache_folder()) / "scans" / content.hexdigest()[:16]
        try:
            return rendered_map(folder, scene, target, tour, self._progress)
        except (IoError, OSError) as error:
            if is_callers(error):
                raise
            node.fail(f"{error}: its frames are kept in the cache: set XDG_CACHE_HOME to a folder that can be written")

    def _with_grasps(self, seen: _SeenPart, options: dict[str, Any], reasons: dict[str, Callable[[], str]]) -> Part:
        found, rated, grasps = self._sought(seen, options)
        if not grasps:
            if not found.grasps:
                reason = found.summary()
            elif rated:
                reason = f"in none of {rated} grasps do fingers meet it from both sides, closing as far as they may ({CLOSING_PLAY})"
            else:
                reason = f"in all {len(found.grasps)} grasps the pads would meet an edge"
            reasons[seen.name] = lambda: reason + self._advice(seen, options)
        wide = found.counts["too_wide"]
        return Part(seen.name, seen.shapes, seen.T_world_part, grasps, target=False, grasps_too_wide=wide)

    def _sought(self, seen: _SeenPart, options: dict[str, Any]) -> tuple[_core.GraspSynthesis, int, list[Grasp]]:
        """What was found, how many of its openings are those of the part's boxes, and those of them at which fingers meet it."""
        given = {"samples": SAMPLES, "max_grasps": MOST_GRASPS} | options
        table, room = float(seen.T_world_part[2, 3]), seen.thing.bounds + [[-_ROOM], [_ROOM]]
        found = _core.synthesize_grasps(
            seen.made.sdf, self._closing.hand, table=table, object=room, robot=self._closing.robot, **given
        )
        if found.outcome == Outcome.stopped:
            raise KeyboardInterrupt
        grasps = []
        for grasp in found.grasps:
            T = np.linalg.inv(seen.T_world_part) @ grasp.T_object_hand
            between = width_between(seen.shapes, T, self._closing.hand)
            if between is not None and abs(between - grasp.opening) <= _WIDTH_PLAY:
                grasps.append(Grasp(T, grasp.opening, quality=grasp.quality))
        return found, len(grasps), self._closing.met(seen.shapes, grasps)

    def _advice(self, seen: _SeenPart, options: dict[str, Any]) -> str:
        """Which options would give the part grasps, tried."""
        usual = {key: default for key, (default, _) in _core._synthesis_option_table().items()}
        usual |= {"samples": SAMPLES, "max_grasps": MOST_GRASPS} | options
        tried = [{key: value for key, value in more.items() if value > usual[key]} for more in _HELPS]
        for more in [more for k, more in enumerate(tried) if more and more not in tried[:k]]:
            if grasps := self._sought(seen, options | more)[2]:
                said = ", ".join(f"{key}: {value:g}" for key, value in (options | more).items())
                return f"; with grasp_options: {{{said}}} it has {len(grasps)}"
        return ""


def moved(shape: LinkShape, T: np.ndarray) -> LinkShape:
    """The shape of a body at T."""
    if shape.mesh_path:
        return LinkShape.mesh(shape.mesh_path, shape.mesh_scale, T @ shape.pose)
    return LinkShape(shape.shape, T @ shape.pose)


def width_between(shapes: list[LinkShape], T_part_hand: np.ndarray, gripper: Hand) -> float | None:
    """Between the outermost places where small pads at the tool's origin, moved along the closing axis, meet boxes within the
    opening [m]; None: they meet none."""
    R_hand, along = T_part_hand[:3, :3], T_part_hand[:3, :3] @ gripper.closing
    across = R_hand @ np.cross(gripper.approach, gripper.closing)
    steps = _PAD * np.array(list(itertools.product((-1, 0, 1), repeat=2)))
    origins = T_part_hand[:3, 3] + steps[:, :1] * (R_hand @ gripper.approach) + steps[:, 1:] * across
    reach = gripper.max_opening / 2 + 0.01
    low, high = np.inf, -np.inf
    for shape in shapes:
        assert isinstance(shape.shape, Box)
        R, half = shape.pose[:3, :3], np.asarray(shape.shape.size) / 2
        o, d = (origins - shape.pose[:3, 3]) @ R, R.T @ along
        d = np.where(np.abs(d) < 1e-12, 1e-12, d)
        a, b = (-half - o) / d, (half - o) / d
        enter, leave = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
        met = (enter < leave) & (leave > -reach) & (enter < reach)
        if met.any():
            low, high = min(low, enter[met].min()), max(high, leave[met].max())
    return float(high - low) if high > low else None


def synthesis_options(node: Node) -> dict[str, Any]:
    """The key `grasp_options` of a scanned tray, every value within its bounds."""
    table = {k: v for k, v in _core._synthesis_option_table().items() if k != "threads"}
    bounds = _core._synthesis_option_bounds()
    options: dict[str, Any] = {}
    for key, value in node.items():
        if key not in table:
            value.refuse_key(list(table))
        options[key] = value.integer() if isinstance(table[key][0], int) else value.number()
        value.within(bounds[key])
    return options


def _description(shape: LinkShape) -> list[Any]:
    """All that a rendered surface depends on."""
    if shape.mesh_path:
        return [shape.kind, sha256_of(shape.mesh_path), shape.mesh_scale.tolist(), shape.pose.tolist()]
    numbers = {
        key: np.asarray(value).tolist()
        for key in ("size", "radius", "length")
        if (value := getattr(shape.shape, key, None)) is not None
    }
    return [shape.kind, numbers, shape.pose.tolist()]
