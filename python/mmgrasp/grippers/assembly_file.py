"""Assembly files: one YAML file that says which parts are joined in which order, and which drives are at hand (docs/assembly_format.md)."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._argument_errors import checked
from .._core import FingerGrip, GripperActuator, HoldingRequirement, InvalidInput, KeepOff, Mesh
from .._files import ASSETS, shipped
from ..documents.reading import Node, near_miss, read_yaml
from ..scenario.named_files import find_file
from .part_mesh import load_part_mesh
from .part_size import LARGEST_PART, UNITS, wrong_size
from .turned_parts import SIDES, block, meeting_edges, turned

Pose = NDArray[np.float64]

MOST_TRIANGLES = 1_000_000  # of a part: segments and grasps take minutes beyond
FINGER_DEFAULTS: dict[str, Any] = {name: value for name, (value, _) in _core._plan_grippers_option_table().items()}
LOAD_DEFAULTS = HoldingRequirement(FingerGrip())
SHORTEST_LINE = 5e-7  # that an insertion may end with [m]
SEGMENT_KINDS = ("cylinder", "box", "cone", "sphere")
SEGMENT_NAME = re.compile(rf"(?:{'|'.join(SEGMENT_KINDS)})_[1-9]\d{{0,5}}")
SET_OPTIONS = ("change_cost", "time_limit", "max_nodes", "max_overlap", "max_rehearsals")


@dataclass
class AssemblyPart:
    """A part where it is in the finished assembly."""

    name: str
    mesh: Mesh
    pose: Pose
    """T_assembly_mesh."""
    keep_off: list[KeepOff] = field(default_factory=list)
    """What of its surface no finger may touch."""
    source: str = ""
    mesh_notes: list[str] = field(default_factory=list)
    """What is wrong with its mesh as the file has it, and what was mended."""


@dataclass
class AssemblyStep:
    """One operation: parts that are brought to their places together."""

    name: str
    active: list[str]
    passive: list[str]
    path: list[Pose]
    """Poses of the active parts, from before the operation to their places: T_assembly_active where each place is the identity."""
    insertion_force: float = 0.0
    """With which the hole resists, against the last straight line of the path [N]."""
    hole: NDArray[np.float64] | None = None
    """A point on the hole's axis, in the assembly [m]; None: the centre of mass of the active parts."""


@dataclass
class HoldingChoice:
    """What fingers press with and are made of, for grasps that are to hold weight and insertion."""

    force: float = LOAD_DEFAULTS.grip.force
    """Each finger presses with this [N]."""
    friction: float = LOAD_DEFAULTS.grip.friction
    modulus: float = LOAD_DEFAULTS.grip.modulus
    """Plane strain modulus of pad and part together [Pa]."""
    pad_radius: float | None = None
    """Hollow pads of centric fingers have this radius [m]; None: flat."""
    density: float = LOAD_DEFAULTS.density
    """All parts have this density [kg/m3]."""
    least_safety: float = LOAD_DEFAULTS.least_safety
    """Grasps that hold less than this many times the load are refused."""


@dataclass
class FingerChoice:
    """Straight fingers that may be made [m]."""

    width: float = FINGER_DEFAULTS["finger_width"]
    thickness: float = FINGER_DEFAULTS["finger_thickness"]
    clearance: float = FINGER_DEFAULTS["clearance"]
    shortest: float = FINGER_DEFAULTS["shortest_finger"]
    longest: float = FINGER_DEFAULTS["longest_finger"]
    opening_margin: float = FINGER_DEFAULTS["opening_margin"]
    length_margin: float = FINGER_DEFAULTS["length_margin"]
    min_contact: float = FINGER_DEFAULTS["min_contact"]
    tip_clearance: float = FINGER_DEFAULTS["tip_clearance"]
    directions: int = FINGER_DEFAULTS["directions"]


@dataclass
class Assembly:
    """An assembly with everything resolved, in metres."""

    name: str
    source: str
    parts: dict[str, AssemblyPart]
    steps: list[AssemblyStep]
    actuators: list[GripperActuator]
    fingers: FingerChoice
    options: dict[str, Any] = field(default_factory=dict)
    """Further options of `mmgrasp.gripper_design.plan_grippers`."""
    unit: str = "m"
    holding: HoldingChoice | None = None
    """None: weight and insertion are not looked at."""

    def __repr__(self) -> str:
        return f"Assembly({self.name!r}, {len(self.parts)} parts, {len(self.steps)} operations)"


def shipped_assembly(path: str | os.PathLike[str]) -> Path:
    """The file of an assembly: `asset:...`, the name of a shipped one, or a path."""
    text = os.fspath(path)
    known = {p.stem: p for p in sorted((ASSETS / "assemblies").glob("*.yaml"))}
    if text in known and not Path(text).exists():
        return known[text]
    if "." not in text and os.sep not in text and not Path(text).exists():
        raise InvalidInput(f"assembly = {text!r}: no such file, nor a shipped assembly{near_miss(text, list(known))}")
    return shipped(path)


@checked
def load_assembly(path: str | os.PathLike[str]) -> Assembly:
    """Reads an assembly: a file, or the name of a shipped one ("pulley").

    Raises InvalidInput or IoError with one message that names file, line, key, value and rule.
    """
    file = shipped_assembly(path)
    root = read_yaml(file).root
    with root.blamed():
        return _read_assembly(root, str(file.resolve()))


def _read_assembly(root: Node, source: str) -> Assembly:
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.place}: is no assembly: the key format: mmgrasp-assembly is missing")
    root["format"].choice("mmgrasp-assembly")
    root.read_version(1)
    root.mapping("format version name unit parts order actuators", "fingers holding options")
    unit = root["unit"].choice(*UNITS)
    scale = UNITS[unit]
    parts: dict[str, AssemblyPart] = {}
    for node in _filled(root["parts"]):
        part = _read_part(node, scale, unit)
        if part.name in parts:
            node["name"].fail("is there twice: parts must have names of their own")
        parts[part.name] = part
    holding = _read_holding(root, scale)
    for node in root["parts"].elements() if holding is not None else []:
        if not parts[node["name"].raw].mesh.closed:
            node.fail("must be a closed mesh for its weight to be known (holding)")
    steps = _read_order(root["order"], parts, scale)
    return Assembly(
        root["name"].label(),
        source,
        parts,
        steps,
        _read_actuators(root["actuators"], scale),
        _read_fingers(root, scale, max(_size(parts[name].mesh) for step in steps for name in step.active)),
        _read_options(root, scale),
        unit,
        holding,
    )


def _filled(node: Node) -> list[Node]:
    elements = node.elements()
    if not elements:
        node.fail("must not be empty")
    return elements


def _pose(node: Node, scale: float) -> Pose:
    out = node.pose().copy()
    out[:3, 3] *= scale
    return out


def _read_part(node: Node, scale: float, unit: str) -> AssemblyPart:
    node.mapping("name", "mesh turned box pose keep_off")
    name = node["name"].label()
    kinds = [key for key in ("mesh", "turned", "box") if key in node]
    if len(kinds) != 1:
        node.fail("must have one of mesh, turned and box")
    source = ""
    notes: list[str] = []
    if kinds == ["mesh"]:
        source = str(find_file(node["mesh"]))
        with node["mesh"].blamed():
            mesh, notes = load_part_mesh(source, scale)
    elif kinds == ["turned"]:
        mesh = _turned(node["turned"], scale)
    else:
        sizes = node["box"].numbers(3, above=0)
        mesh = block(np.array(sizes) * scale)
    size = _size(mesh)
    if rule := wrong_size(size, unit):
        node[kinds[0]].fail(f"is {size:.4g} m from corner to corner with unit: {unit}; {rule}")
    if len(mesh.triangles) > MOST_TRIANGLES:
        node[kinds[0]].fail(
            f"has {len(mesh.triangles):,} triangles: parts of up to {MOST_TRIANGLES:,} can be planned for; "
            "export it coarser (0.01 mm off is nothing to a finger)"
        )
    keep_off = (
        [_read_keep_off(name, element, scale) for element in node["keep_off"].elements()] if "keep_off" in node else []
    )
    pose = _pose(node["pose"], scale) if "pose" in node else np.eye(4)
    return AssemblyPart(name, mesh, pose, keep_off, source, notes)


def _size(mesh: Mesh) -> float:
    """From corner to corner [m]."""
    vertices = np.asarray(mesh.vertices)
    return float(np.linalg.norm(vertices.max(axis=0) - vertices.min(axis=0)))


def _read_keep_off(part: str, node: Node, scale: float) -> KeepOff:
    """A segment by name or number, or a box. Which segments there are is known when the part has been cut."""
    source = f"{node.place}: {node.name}"
    if isinstance(node.raw, str):
        own = node.raw.removeprefix(f"{part}/")
        if not SEGMENT_NAME.fullmatch(own):
            like = [f"{kind}_1" for kind in SEGMENT_KINDS]
            node.fail(f"must be the name of a segment as `mmgrasp segment` gives it{near_miss(own, like)}")
        return KeepOff(part, names=[own], source=source)
    if not isinstance(node.raw, dict):
        return KeepOff(part, segments=[node.integer(least=0)], source=source)
    node.mapping("box", "pose")
    place = _pose(node["pose"], scale) if "pose" in node else np.eye(4)
    return KeepOff(part, boxes=[(place, np.array(node["box"].numbers(3, above=0)) * scale)], source=source)


def _edge_text(rows: NDArray[np.float64], begin: int) -> str:
    """An edge of a closed profile by its ends, in the file's unit, and by their rows, from 0."""
    end = (begin + 1) % len(rows)
    first, last = (f"[{r:g}, {z:g}]" for r, z in rows[[begin, end]])
    return f"from {first} to {last} (rows {begin} and {end})"


def _turned(node: Node, scale: float) -> Mesh:
    rows = node.array(2)
    if len(rows) < 3:
        node.fail("must have at least three rows [radius, z]")
    if (rows[:, 0] < 0).any():
        node.fail("radii must be at least 0")
    if not rows[:, 0].any():
        node.fail("a radius must be above 0: all of the profile lies on the axis")
    if 2 * SIDES * len(rows) <= MOST_TRIANGLES and (meeting := meeting_edges(rows)) is not None:
        first, second = (_edge_text(rows, i) for i in meeting)
        node.fail(f"must not cross itself or touch itself off the axis: the edge {first} meets the edge {second}")
    mesh = turned(rows * scale)
    if not mesh.closed:
        node.fail("must be a closed profile of [radius, z] that does not cross itself")
    return mesh


def _name(node: Node, known: dict[str, AssemblyPart]) -> str:
    name = node.string()
    if name not in known:
        node.fail(f"is no part{near_miss(name, list(known))}")
    return name


def _names(node: Node, known: dict[str, AssemblyPart]) -> list[str]:
    out: list[str] = []
    for element in _filled(node):
        name = _name(element, known)
        if name in out:
            element.fail("is there twice")
        out.append(name)
    return out


def _read_order(node: Node, parts: dict[str, AssemblyPart], scale: float) -> list[AssemblyStep]:
    operations = _filled(node)
    moved = _moved_parts(operations, parts)
    place_of = {name: i for i, names in enumerate(moved) for name in names}
    onto = [_read_onto(element, i, parts, place_of) for i, element in enumerate(operations)]
    fixtures = _fixtures(parts, place_of, onto)
    steps: list[AssemblyStep] = []
    for i, element in enumerate(operations):
        stays = onto[i]
        if stays is None:
            stays = fixtures + [name for names in moved[:i] for name in names]
        path = _read_path(element, scale)
        name = element["name"].label() if "name" in element else " + ".join(moved[i])
        if name in [step.name for step in steps]:
            element.fail(f"an operation named {name} is there already: give it a name of its own")
        steps.append(AssemblyStep(name, moved[i], stays, path, *_read_insertion(element, path, scale)))
    return steps


def _moved_parts(operations: list[Node], parts: dict[str, AssemblyPart]) -> list[list[str]]:
    """For each operation the parts that it moves, each part once in the order."""
    moved: list[list[str]] = []
    for element in operations:
        element.mapping("", "part parts onto from path insertion name")
        if ("part" in element) == ("parts" in element):
            element.fail("must have one of part and parts")
        active = [_name(element["part"], parts)] if "part" in element else _names(element["parts"], parts)
        twice = [name for name in active if any(name in earlier for earlier in moved)]
        if twice:
            element.fail(f"{twice[0]} was brought to its place before: an order names a part once")
        moved.append(active)
    return moved


def _read_onto(
    operation: Node, index: int, parts: dict[str, AssemblyPart], place_of: dict[str, int]
) -> list[str] | None:
    """Parts that stay during an operation, all of them there by then; None: the file does not say."""
    if "onto" not in operation:
        return None
    names = _names(operation["onto"], parts)
    for name, element in zip(names, operation["onto"].elements(), strict=True):
        if place_of.get(name) == index:
            element.fail("cannot be moved and stay")
        if place_of.get(name, -1) > index:
            element.fail(f"is brought to its place only later, by order[{place_of[name]}]")
    return names


def _fixtures(parts: dict[str, AssemblyPart], place_of: dict[str, int], onto: list[list[str] | None]) -> list[str]:
    """Parts that no operation moves and some operation has things put onto: they are there all the time."""
    named = {name for names in onto for name in names or []}
    return [name for name in parts if name in named and name not in place_of]


def _read_path(operation: Node, scale: float) -> list[Pose]:
    if "from" in operation and "path" in operation:
        operation.fail("give from or path, not both")
    if "from" in operation:
        return [_pose(operation["from"], scale), np.eye(4)]
    if "path" in operation:
        return [_pose(pose, scale) for pose in _filled(operation["path"])] + [np.eye(4)]
    return [np.eye(4)]


def _read_insertion(operation: Node, path: list[Pose], scale: float) -> tuple[float, NDArray[np.float64] | None]:
    """Force of the hole's resistance [N] and a point on its axis."""
    if "insertion" not in operation:
        return 0.0, None
    node = operation["insertion"].mapping("force", "hole")
    if len(path) < 2 or np.linalg.norm(path[-1][:3, 3] - path[-2][:3, 3]) < SHORTEST_LINE:
        node.fail("needs a way that ends with a straight line: give from or path")
    hole = np.array(node["hole"].numbers(3)) * scale if "hole" in node else None
    return node["force"].number(least=0), hole


def _read_holding(root: Node, scale: float) -> HoldingChoice | None:
    if "holding" not in root:
        inserted = any("insertion" in operation for operation in root["order"].elements())
        return HoldingChoice() if inserted else None
    choice = HoldingChoice()
    node = root["holding"].mapping("", "force friction modulus pad_radius density least_safety")
    for key, value in node.items():
        if key == "least_safety":
            choice.least_safety = value.number(least=0)
        elif key == "modulus":
            choice.modulus = 1e6 * value.number(above=0)
        else:
            setattr(choice, key, value.number(above=0) * (scale if key == "pad_radius" else 1.0))
    return choice


def _read_length(node: Node, scale: float, *, may_be_zero: bool = False) -> float:
    """A length of a drive or a finger [m]."""
    length = (node.number(least=0) if may_be_zero else node.number(above=0)) * scale
    if length > LARGEST_PART:
        node.fail(f"must be at most {LARGEST_PART / scale:g} ({LARGEST_PART:g} m), as parts for a gripper are")
    return length


def _read_actuators(node: Node, scale: float) -> list[GripperActuator]:
    drives: list[GripperActuator] = []
    for entry in _filled(node):
        drive = _read_actuator(entry, scale)
        if any(drive.name == other.name for other in drives):
            entry["name"].fail("is there twice: drives must have names of their own")
        drives.append(drive)
    return drives


def _read_actuator(node: Node, scale: float) -> GripperActuator:
    node.mapping("name fingers stroke", "max_opening cost")
    fingers = node["fingers"].integer()
    if fingers not in (2, 3):
        node["fingers"].fail("must be 2 or 3")
    stroke = _read_length(node["stroke"], scale)
    widest = _read_length(node["max_opening"], scale) if "max_opening" in node else None
    if widest is not None and widest < stroke:
        node["max_opening"].fail("must be at least the stroke")
    cost = node["cost"].number(above=0) if "cost" in node else 1.0
    return GripperActuator(node["name"].label(), stroke, fingers=fingers, max_opening=widest, cost=cost)


def _read_fingers(root: Node, scale: float, largest_part: float) -> FingerChoice:
    """Fingers for moved parts of up to this size [m]."""
    choice = FingerChoice()
    if "fingers" not in root:
        return choice
    node = root["fingers"]
    lengths = "width thickness clearance shortest longest opening_margin length_margin min_contact tip_clearance"
    node.mapping("", lengths + " directions")
    for key, value in node.items():
        if key == "directions":
            choice.directions = value.integer(least=1)
            if choice.directions > 360:
                value.fail("must be at most 360")
        elif key in ("clearance", "opening_margin", "length_margin", "tip_clearance"):
            setattr(choice, key, _read_length(value, scale, may_be_zero=True))
        else:
            setattr(choice, key, _read_length(value, scale))
    if choice.tip_clearance > largest_part:
        rule = "must be no longer than the largest part that is moved"
        node["tip_clearance"].fail(f"{rule}, {largest_part / scale:.4g} from corner to corner")
    if choice.longest < choice.shortest:
        node.fail(f"longest = {choice.longest / scale:g} must be at least shortest = {choice.shortest / scale:g}")
    return choice


def _read_options(root: Node, scale: float) -> dict[str, Any]:
    if "options" not in root:
        return {}
    node = root["options"].mapping("", " ".join(SET_OPTIONS))
    out: dict[str, Any] = {}
    for key, value in node.items():
        if key in ("max_nodes", "max_rehearsals"):
            out[key] = value.integer(least=1)
        else:
            out[key] = value.number(least=0) * (scale if key == "max_overlap" else 1.0)
    return out
