"""Shapes in files: one of box, cylinder, sphere, mesh, or a list of them under `shapes`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from .._core import Box, Capsule, Cylinder, InvalidInput, LinkShape, Mesh, Sphere
from .._files import sha256_of
from ..documents.reading import Node

KINDS = ("box", "cylinder", "sphere", "mesh")


def read_shapes(node: Node, find_file: Callable[[Node], Path], required: bool = True) -> list[LinkShape]:
    """The shapes a mapping describes. Its other keys have been checked by the caller."""
    given = [key for key in (*KINDS, "shapes") if key in node]
    if len(given) > 1 or (required and not given):
        node.fail("must have exactly one of " + ", ".join((*KINDS, "shapes")))
    if given == ["shapes"]:
        elements = node["shapes"].elements()
        if not elements:
            node["shapes"].fail("must not be empty")
        return [
            _one(element.mapping("", "box cylinder sphere mesh scale pose"), find_file, placed=True)
            for element in elements
        ]
    return [_one(node, find_file, placed=False)] if given else []


def _one(node: Node, find_file: Callable[[Node], Path], placed: bool) -> LinkShape:
    kinds = [key for key in KINDS if key in node]
    if len(kinds) != 1:
        node.fail("must have exactly one of " + ", ".join(KINDS))
    pose = node["pose"].pose() if placed and "pose" in node else np.eye(4)
    value = node[kinds[0]]
    if "scale" in node and kinds[0] != "mesh":
        node["scale"].fail("only a mesh has a scale")
    if kinds[0] == "box":
        return LinkShape(Box(value.numbers(3, above=0)), pose)
    if kinds[0] == "cylinder":
        value.mapping("radius length")
        return LinkShape(Cylinder(value["radius"].number(above=0), value["length"].number(above=0)), pose)
    if kinds[0] == "sphere":
        radius = value.mapping("radius")["radius"] if isinstance(value.raw, dict) else value
        return LinkShape(Sphere(radius.number(above=0)), pose)
    scale: Any = 1.0
    if "scale" in node:
        scale = (
            node["scale"].numbers(3, above=0) if isinstance(node["scale"].raw, list) else node["scale"].number(above=0)
        )
    path = find_file(value).resolve()
    try:
        found = LinkShape.mesh(path, scale, pose)
    except _core.Error as error:
        value.fail(str(error))
    if isinstance(found.shape, Mesh) and not found.shape.closed:
        value.warn("its surface is not closed: it is no solid, and a body wholly behind it does not touch it")
    return found


def pose_to_dict(T: np.ndarray) -> dict[str, list[float]]:
    """xyz and quat_xyzw of a pose (4, 4)."""
    xyz, quat = _core.pose_to_xyz_quat(T)
    return {"xyz": xyz.tolist(), "quat_xyzw": quat.tolist()}


def shape_to_dict(link_shape: LinkShape) -> dict[str, Any]:
    """The plan file's form of a shape."""
    shape = link_shape.shape
    out: dict[str, Any] = {"type": link_shape.kind, "pose": pose_to_dict(link_shape.pose)}
    if isinstance(shape, Box):
        out["size"] = shape.size.tolist()
    elif isinstance(shape, Sphere):
        out["radius"] = shape.radius
    elif isinstance(shape, Cylinder | Capsule):
        out |= {"radius": shape.radius, "length": shape.length}
    elif link_shape.mesh_path:
        path = link_shape.mesh_path
        out |= {"file": path, "scale": link_shape.mesh_scale.tolist(), "sha256": sha256_of(path)}
    else:
        raise InvalidInput(
            f"a {link_shape.kind} cannot be written to a plan: use boxes, cylinders, spheres or mesh files"
        )
    return out


def shape_from_node(node: Node) -> LinkShape:
    """A shape of the plan file; a mesh whose file has changed is refused."""
    kind = node["type"].choice("box", "sphere", "cylinder", "capsule", "mesh")
    if kind == "mesh":
        node.mapping("type pose file scale sha256")
        path = node["file"].string()
        if sha256_of(path) != node["sha256"].string():
            node["file"].fail("the mesh file has changed since the plan was made")
        return LinkShape.mesh(path, node["scale"].numbers(3, above=0), node["pose"].pose())
    node.mapping({"box": "type pose size", "sphere": "type pose radius"}.get(kind, "type pose radius length"))
    if kind == "box":
        return LinkShape(Box(node["size"].numbers(3, above=0)), node["pose"].pose())
    if kind == "sphere":
        return LinkShape(Sphere(node["radius"].number(above=0)), node["pose"].pose())
    make = Cylinder if kind == "cylinder" else Capsule
    return LinkShape(make(node["radius"].number(above=0), node["length"].number(above=0)), node["pose"].pose())
