"""What a shard's result depends on, as one hash: values, problems, and the code that computes."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import InvalidInput, JointGroup, PartSupplyProblem, ReachDatabase


class Hasher:
    """SHA-256 over plain values; equal values of different types are kept apart."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()

    def add(self, value: Any, where: str = "value") -> Hasher:
        """Takes a value in, containers and files by their contents; raises InvalidInput for what has none."""
        if value is None or isinstance(value, (bool, int, str)):
            self._put(type(value).__name__, repr(value).encode())
        elif isinstance(value, float):
            self._put("float", value.hex().encode())
        elif isinstance(value, bytes):
            self._put("bytes", value)
        elif isinstance(value, np.ndarray):
            self._put(f"array {value.dtype.str} {value.shape}", np.ascontiguousarray(value).tobytes())
        elif isinstance(value, np.generic):
            self.add(value.item(), where)
        elif dataclasses.is_dataclass(value) and not isinstance(value, type):
            self._put("dataclass", type(value).__qualname__.encode())
            self.add({f.name: getattr(value, f.name) for f in dataclasses.fields(value)}, where)
        elif isinstance(value, dict):
            self._put("dict", str(len(value)).encode())
            for key in sorted(value, key=str):
                self.add(str(key)).add(value[key], f"{where}.{key}")
        elif isinstance(value, (list, tuple)):
            self._put(type(value).__name__, str(len(value)).encode())
            for i, entry in enumerate(value):
                self.add(entry, f"{where}[{i}]")
        elif isinstance(value, Path):
            self._put("path", str(value).encode())
        else:
            raise InvalidInput(f"{where}: a {type(value).__name__} has no content that could name a shard")
        return self

    def _put(self, kind: str, data: bytes) -> None:
        self._hash.update(f"{kind} {len(data)} ".encode())
        self._hash.update(data)

    def hex(self) -> str:
        """Over all that was taken in, 32 digits."""
        return self._hash.hexdigest()[:32]


@functools.cache
def code_digest() -> str:
    """Hash of the package's own files, compiled ones too: a result computed by other code is another result."""
    hasher = Hasher()
    package = Path(__file__).resolve().parents[1]
    compiled = Path(_core.__file__).resolve().parent
    files = {p for folder in (package, compiled) for p in folder.rglob("*") if p.suffix == ".py" or ".so" in p.name}
    for path in sorted(files, key=lambda p: (p.name, str(p))):
        hasher.add(path.name).add(path.read_bytes())
    return hasher.hex()


def arm_key(arm: JointGroup) -> str:
    """Key of the robot, and of where its other joints are held, by the poses they give its links."""
    lowest = arm.link_poses(arm.sample_lower)
    return Hasher().add([arm.robot.hash, arm.names, arm.tip]).add({n: lowest[n] for n in sorted(lowest)}).hex()


def problem_digest(problem: PartSupplyProblem, database: ReachDatabase) -> str:
    """Hash of all that base regions depend on: robot, arm, gripper, scene, trays, parts, grasps, options, database."""
    arm, gripper = problem.arm, problem.gripper
    hasher = Hasher().add(arm_key(arm)).add(database.key)
    hasher.add([np.array(problem.home), arm.T_world_root])
    hasher.add([gripper.tool_link, np.array(gripper.approach), np.array(gripper.closing), list(gripper.finger_links)])
    hasher.add([gripper.max_opening, gripper.finger_depth, gripper.finger_width, gripper.clearance])
    hasher.add([[j.name, j.closed, j.open, j.group] for j in gripper.joints])
    hasher.add([gripper.min_opening, list(gripper.openings)]).add(dict(gripper.preshape))
    if gripper.suction is not None:
        own = gripper.suction
        hasher.add([[cup.position, cup.radius] for cup in own.cups])
        hasher.add([own.max_gap, own.vacuum, own.friction, own.safety])
    hasher.add({key: value for key, value in problem.options.items() if key != "threads"})
    for name in sorted(problem.world.objects):
        hasher.add(name).add(problem.world.pose_of(name))
        _add_shapes(hasher, problem.world.shapes_of(name))
    for tray in problem.trays:
        hasher.add([tray.name, tray.T_world_tray, np.array(tray.size), list(tray.headings)])
        for part in tray.parts:
            hasher.add([part.name, part.T_world_part, part.target, part.grasps_too_wide])
            _add_shapes(hasher, part.shapes)
            for grasp in part.grasps:
                hasher.add([grasp.T_object_hand, grasp.opening])
    return hasher.hex()


def _add_shapes(hasher: Hasher, shapes: list[_core.LinkShape]) -> None:
    for shape in shapes:
        hasher.add(shape.kind).add(shape.pose)
        solid = shape.shape
        if isinstance(solid, _core.Mesh):
            hasher.add([np.array(solid.vertices), np.array(solid.triangles)])
        elif isinstance(solid, _core.Voxels):
            hasher.add([solid.centres, solid.resolution])
        else:
            hasher.add(repr(solid))
            for name in ("size", "radius", "length", "normal", "offset"):
                if hasattr(solid, name):
                    hasher.add([name, np.array(getattr(solid, name), dtype=float)])
