"""MoveIt's planning scenes: as YAML (what MotionBenchMaker writes), and as the `.scene` text that RViz's MotionPlanning panel writes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from .._core import Box, Cylinder, InvalidInput, IoError, LinkShape, Sphere, pose
from .._files import read_text
from .reading import bad_yaml

LARGEST_SCENE = 100_000_000  # [bytes]
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

Bodies = dict[str, tuple[list[LinkShape], np.ndarray | None]]
"""Name to shapes and pose (None: the world's origin)."""


def read_scene_bodies(path: str | Path) -> Bodies:
    """The objects of a planning scene, a .yaml or a .scene file; errors name the file and the entry."""
    return _SceneText(Path(path)).bodies() if Path(path).suffix == ".scene" else scene_bodies(SceneFile(path))


class _SceneText:
    """A .scene file: a name, then objects, each begun by `*`, and `.` at the end.

    An object is its name, in newer files its pose (two lines), how many shapes, and for each its kind, sizes, place,
    quaternion (xyzw) and colour; newer files end an object with its subframes.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines = read_text(path, LARGEST_SCENE).splitlines()
        self.at = 1 if self.lines else 0  # the first is the scene's name

    def fail(self, rule: str) -> InvalidInput:
        return InvalidInput(f"{self.path}:{self.at}: {rule}")

    def line(self) -> str:
        while self.at < len(self.lines):
            self.at += 1
            if self.lines[self.at - 1].strip():
                return self.lines[self.at - 1].strip()
        raise self.fail("ends amid an object: the line '.' is missing")

    def numbers(self, count: int, above: float | None = None) -> list[float]:
        words = self.line().split()
        try:
            values = [float(word) for word in words]
        except ValueError:
            values = []
        if len(values) != count or not np.isfinite(values).all():
            raise self.fail(f"must hold {count} finite numbers")
        if above is not None and min(values) <= above:
            raise self.fail(f"must be > {above:g}")
        return values

    def count(self) -> int:
        word = self.line()
        if not word.isdecimal() or int(word) > 1_000_000:
            raise self.fail("must be a count")
        return int(word)

    def placed(self) -> np.ndarray:
        xyz, quat = self.numbers(3), self.numbers(4)
        try:
            return pose(xyz, quat_xyzw=quat)
        except InvalidInput as error:
            raise self.fail(str(error)) from None

    def bodies(self) -> Bodies:
        found: Bodies = {}
        while (begin := self.line()) != ".":
            if not begin.startswith("*"):
                raise self.fail("must be '* name of an object', or '.' at the end")
            name = begin[1:].strip()
            if name in found:
                raise self.fail(f"object {name!r} is there twice")
            newer = len(self.lines[self.at].split()) == 3 if self.at < len(self.lines) else False
            T = self.placed() if newer else None
            shapes = [self.shape() for _ in range(self.count())]
            if newer:
                for _ in range(self.count()):
                    self.line(), self.placed()
            found[name] = (shapes, T)
        return found

    def shape(self) -> LinkShape:
        kind = self.line()
        if kind == "box":
            shape: Any = Box(self.numbers(3, above=0))
        elif kind == "sphere":
            shape = Sphere(self.numbers(1, above=0)[0])
        elif kind == "cylinder":
            radius, length = self.numbers(2, above=0)
            shape = Cylinder(radius, length)
        elif kind == "mesh":
            raise self.fail(
                "a mesh within a scene is not read: save it as a mesh file, and give it an obstacle of its own"
            )
        else:
            raise self.fail(f"shape {kind!r} is none of box, sphere, cylinder")
        T = self.placed()
        self.numbers(4)  # colour
        return LinkShape(shape, T)


class SceneFile:
    """A YAML file whose entries are looked up by name."""

    def __init__(self, path: str | Path) -> None:
        self.path = path
        try:
            self.root = yaml.load(read_text(Path(path), LARGEST_SCENE), Loader=_LOADER)
        except yaml.YAMLError as error:
            raise bad_yaml(path, error) from None
        except (ValueError, KeyError, AttributeError, RecursionError) as error:  # of tags and dates
            if isinstance(error, IoError):
                raise
            raise InvalidInput(f"{path}: is no valid YAML: {error}") from None

    def of(self, value: Any, *keys: str) -> Any:
        """What lies below the keys; the one that is missing is named."""
        for key in keys:
            if not isinstance(value, dict) or key not in value:
                raise InvalidInput(f"{self.path}: {key} is missing")
            value = value[key]
        return value

    def items(self, key: str) -> list[Any]:
        """The list below a key of the file."""
        value = self.of(self.root, key)
        if not isinstance(value, list):
            raise InvalidInput(f"{self.path}: {key}: must be a list")
        return value

    def number(self, value: Any) -> float:
        """A finite number."""
        try:
            out = float(value)  # YAML 1.1 reads 1e-05 as a word
        except (TypeError, ValueError):
            out = np.nan
        if not np.isfinite(out):
            raise InvalidInput(f"{self.path}: {value!r}: must be a finite number")
        return out

    def pose(self, value: Any) -> np.ndarray:
        """A pose of `position` and `orientation` (4, 4)."""
        xyz = [self.number(x) for x in self.of(value, "position")]
        return pose(xyz=xyz, quat_xyzw=[self.number(x) for x in self.of(value, "orientation")])


def _shape(file: SceneFile, primitive: dict[str, Any]) -> Box | Cylinder | Sphere:
    kind = file.of(primitive, "type")
    sizes = [file.number(x) for x in file.of(primitive, "dimensions")]
    wanted = {"box": 3, "cylinder": 2, "sphere": 1}
    if kind not in wanted:
        raise InvalidInput(f"{file.path}: primitive type '{kind}': must be one of {', '.join(wanted)}")
    if len(sizes) != wanted[kind]:
        raise InvalidInput(f"{file.path}: {kind} dimensions {sizes}: must be {wanted[kind]} numbers")
    if kind == "box":
        return Box(sizes)
    return Cylinder(radius=sizes[1], length=sizes[0]) if kind == "cylinder" else Sphere(sizes[0])


def scene_bodies(file: SceneFile) -> dict[str, tuple[list[LinkShape], np.ndarray | None]]:
    """Name to shapes and pose (None: the world's origin) of each object of a planning scene."""
    bodies: dict[str, tuple[list[LinkShape], np.ndarray | None]] = {}
    for entry in file.of(file.root, "world", "collision_objects"):
        name = file.of(entry, "id")
        primitives, poses = file.of(entry, "primitives"), file.of(entry, "primitive_poses")
        if len(primitives) != len(poses):
            raise InvalidInput(f"{file.path}: object '{name}': {len(primitives)} primitives but {len(poses)} poses")
        shapes = [
            LinkShape(_shape(file, primitive), file.pose(at)) for primitive, at in zip(primitives, poses, strict=True)
        ]
        if name in bodies:
            raise InvalidInput(f"{file.path}: object '{name}': is there twice")
        bodies[name] = (shapes, file.pose(entry["pose"]) if "pose" in entry else None)
    return bodies
