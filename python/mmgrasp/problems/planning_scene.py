"""Worlds written as MoveIt planning scenes (YAML, as read_motion_problem reads them)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from .. import _core
from .._core import Box, Cylinder, InvalidInput, LinkShape, Robot, Sphere, World
from .._files import write_file


def write_planning_scene(path: str | os.PathLike[str], robot: Robot, world: World) -> Path:
    """Writes the objects, the allowed collision matrix and the links' padding; returns the path.

    The matrix holds the robot's disabled pairs and the world's allowed ones, groups taken apart. Raises InvalidInput for
    what MoveIt's format or its primitives cannot say: attached objects, shapes other than boxes, cylinders and spheres,
    padding of objects.
    """
    if world.attached:
        raise InvalidInput(f"world: holds '{world.attached[0]}': attached objects are not written")
    if world.fields:
        raise InvalidInput(f"world: holds '{world.fields[0]}': MoveIt's scenes have no distance fields")
    names = sorted({*robot.links, *world.objects})
    pairs = {frozenset((a, b)) for a, b, _ in robot.disabled_pairs}
    pairs |= {frozenset(pair) for pair in _core._allowed_bodies(robot, world)}
    scene = {
        "name": "",
        "robot_model_name": robot.name,
        "allowed_collision_matrix": {
            "entry_names": names,
            "entry_values": [[frozenset((a, b)) in pairs for b in names] for a in names],
        },
        "link_padding": _link_padding(robot, world),
        "world": {"collision_objects": [_object(world, name) for name in world.objects]},
    }
    out = Path(path)
    write_file(out, yaml.safe_dump(scene, sort_keys=False, default_flow_style=None, width=1000))
    return out


def _link_padding(robot: Robot, world: World) -> list[dict[str, Any]]:
    padding = world.padding
    named: dict[str, float] = {}
    for group, links in robot.group_links.items():
        if group in padding["by_name"]:
            named |= {link: max(named.get(link, 0.0), padding["by_name"][group]) for link in links}
    named |= {name: value for name, value in padding["by_name"].items() if name in robot.links}
    grown = [name for name in world.objects if padding["by_name"].get(name, padding["objects"]) > 0]
    if grown:
        raise InvalidInput(f"padding of object '{grown[0]}': MoveIt pads links alone")
    values = {link: named.get(link, padding["links"]) for link in robot.links}
    return [{"link_name": link, "padding": value} for link, value in values.items() if value > 0]


def _object(world: World, name: str) -> dict[str, Any]:
    shapes = world.shapes_of(name)
    return {
        "id": name,
        "pose": _pose(world.pose_of(name)),
        "primitives": [_primitive(name, shape) for shape in shapes],
        "primitive_poses": [_pose(shape.pose) for shape in shapes],
    }


def _primitive(name: str, link_shape: LinkShape) -> dict[str, Any]:
    shape = link_shape.shape
    if isinstance(shape, Box):
        return {"type": "box", "dimensions": shape.size.tolist()}
    if isinstance(shape, Cylinder):
        return {"type": "cylinder", "dimensions": [shape.length, shape.radius]}
    if isinstance(shape, Sphere):
        return {"type": "sphere", "dimensions": [shape.radius]}
    raise InvalidInput(f"object '{name}': a {link_shape.kind} is not written: use boxes, cylinders and spheres")


def _pose(T: np.ndarray) -> dict[str, list[float]]:
    xyz, quat = _core.pose_to_xyz_quat(T)
    return {"position": xyz.tolist(), "orientation": quat.tolist()}
