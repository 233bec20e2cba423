"""Walls drawn on the floor, as lines of points, and what stands in other programs' files: obstacles of a scenario."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .._core import Box, Cylinder, Error, LinkShape, Robot, pose
from ..documents.moveit_scene import read_scene_bodies
from ..documents.reading import Node
from .named_files import find_file

MOST_WALLS = 20_000


def read_floor_plan(node: Node) -> list[LinkShape]:
    """Walls of the given `thickness` and `height` along lines of points (x, y), on z = 0; where a line bends they are joined roundly."""
    thickness, height = (
        node[key].number(least=1e-3, most=100) if key in node else node.lacks(key) for key in ("thickness", "height")
    )
    shapes: list[LinkShape] = []
    lines = node["floor_plan"].elements()
    for line in lines:
        points = np.array([point.numbers(2) for point in line.elements()])
        if len(points) < 2:
            line.fail("must be a line of at least two points [x, y]")
        ways = np.diff(points, axis=0)
        lengths = np.linalg.norm(ways, axis=1)
        if lengths.min() < 1e-6:
            line.fail(f"holds the point {points[int(lengths.argmin())].tolist()} twice in a row")
        for start, way, length in zip(points, ways, lengths, strict=False):
            middle = [*(start + way / 2), height / 2]
            shapes.append(
                LinkShape(Box([length, thickness, height]), pose(middle, rpy=[0, 0, np.arctan2(way[1], way[0])]))
            )
        closed = len(points) > 2 and np.allclose(points[0], points[-1], atol=1e-9)
        for corner in points[0 if closed else 1 : -1]:
            shapes.append(LinkShape(Cylinder(thickness / 2, height), pose([*corner, height / 2])))
    if not shapes:
        node["floor_plan"].fail("must hold at least one line of points [x, y]")
    if len(shapes) > MOST_WALLS:
        node["floor_plan"].fail(f"makes {len(shapes)} bodies, at most {MOST_WALLS} are taken")
    return shapes


def read_scene(node: Node) -> list[LinkShape]:
    """The objects of a planning scene of MoveIt, a .scene or .yaml file."""
    shapes = []
    with node["scene"].blamed():
        for own, T in read_scene_bodies(find_file(node["scene"])).values():
            shapes += [LinkShape(s.shape, s.pose if T is None else T @ s.pose) for s in own]
    if not shapes:
        node["scene"].fail("has no object")
    return shapes


def read_urdf(node: Node) -> list[LinkShape]:
    """The collision shapes of a URDF's links, its root at the obstacle's pose and its joints at 0 (or the end of their range next to it)."""
    file: Path = find_file(node["urdf"])
    packages = {name: str(find_file(folder)) for name, folder in node["packages"].items()} if "packages" in node else {}
    try:
        robot = Robot.load(file, None, packages, "fixed")
        poses = robot.link_poses()
    except Error as error:
        node["urdf"].fail(str(error))
    shapes = []
    for link in robot.links:
        for shape in robot.collisions(link):
            T = poses[link] @ shape.pose
            shapes.append(
                LinkShape.mesh(shape.mesh_path, shape.mesh_scale, T) if shape.mesh_path else LinkShape(shape.shape, T)
            )
    if not shapes:
        node["urdf"].fail("has no collision shapes")
    return shapes
