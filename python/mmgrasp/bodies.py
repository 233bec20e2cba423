"""The bodies of a scene: robot links, obstacles, loose parts. Report, viewer, pictures and physics are all built from these.

bodies = SceneBodies.of_world(robot, world, parts)      # or SceneBodies.of_plan(plan)
links = bodies.link_poses({"elbow": 0.3}, base=(1.0, 0.0, 0.5))
for link in bodies.links:
    link.vertices_at(links[link.name]), link.faces
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import Box, Capsule, Cylinder, LinkShape, Plane, Robot, Sphere, World, pose

Points = NDArray[np.float64]


class Placed(Protocol):
    """Anything with a name, shapes and a pose: `sim.SimPart`, parts of a problem."""

    name: str
    shapes: Sequence[LinkShape]
    pose: Any


@dataclass(frozen=True)
class Body:
    """One rigid body."""

    name: str
    shapes: tuple[LinkShape, ...]
    pose: Points
    """T_world_body (4, 4) at the start; of a link: the identity, forward kinematics places it."""

    @cached_property
    def _mesh(self) -> tuple[Points, NDArray[np.int64]]:
        vertices: list[Points] = [np.zeros((0, 3))]
        faces: list[NDArray[np.int64]] = [np.zeros((0, 3), int)]
        count = 0
        for shape in self.shapes:
            mesh = shape.surface()
            vertices.append(moved(shape.pose, mesh.vertices))
            faces.append(np.asarray(mesh.triangles, np.int64) + count)
            count += len(mesh.vertices)
        return np.concatenate(vertices), np.concatenate(faces)

    @property
    def vertices(self) -> Points:
        """(n, 3) of its surface in its own frame [m]."""
        return self._mesh[0]

    @property
    def faces(self) -> NDArray[np.int64]:
        """(m, 3) indices of vertices."""
        return self._mesh[1]

    def vertices_at(self, T_world_body: ArrayLike | None = None) -> Points:
        """Its vertices in the world, at a pose or where it is at the start."""
        return moved(self.pose if T_world_body is None else np.asarray(T_world_body, float), self.vertices)


def moved(T: Points, points: Points) -> Points:
    """Points (n, 3) moved by T (4, 4)."""
    return points @ T[:3, :3].T + T[:3, 3]


class SceneBodies:
    """Links of a robot, obstacles and parts; `floor` is the height of the ground [m].

    Where nothing is said of the ground, it lies at 0, or lower where parts do.
    """

    def __init__(self, robot: Robot, obstacles: Iterable[Body], parts: Iterable[Body], floor: float | None):
        self.robot = robot
        self.links = [Body(link, tuple(robot.collisions(link)), np.eye(4)) for link in robot.links]
        self.obstacles = list(obstacles)
        self.parts = {body.name: body for body in parts}
        lowest = [
            LinkShape(s.shape, part.pose @ s.pose).bounds[0][2] for part in self.parts.values() for s in part.shapes
        ]
        self.floor = float(min([0.0, *lowest])) if floor is None else floor

    @classmethod
    def of_world(cls, robot: Robot, world: World, parts: Iterable[Placed] = ()) -> SceneBodies:
        """A robot, the objects of a world and loose parts."""
        obstacles = [Body(name, tuple(world.shapes_of(name)), world.pose_of(name)) for name in world.objects]
        heights = {body.name: height for body in obstacles if (height := _ground_height(body)) is not None}
        return cls(
            robot,
            [body for body in obstacles if body.name not in heights],
            (Body(part.name, tuple(part.shapes), np.asarray(part.pose, float)) for part in parts),
            next(iter(heights.values()), None),
        )

    @classmethod
    def of_plan(cls, plan: Mapping[str, Any]) -> SceneBodies:
        """What the file of a plan holds."""
        scenario = plan["scenario"]
        stored = scenario["robot"]
        robot = Robot.from_strings(stored["urdf"], stored["srdf"], base=stored["base"])
        obstacles, parts = (map(_stored_body, scenario[key]) for key in ("obstacles", "parts"))
        return cls(robot, obstacles, parts, scenario["floor"])

    def link_poses(self, joints: Mapping[str, float], base: ArrayLike) -> dict[str, Points]:
        """T_world_link by link name; `base` is (x, y, theta)."""
        x, y, theta = np.asarray(base, float)
        T = np.eye(4)
        T[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
        T[:2, 3] = x, y
        return self.robot.link_poses(dict(joints), T)


def stored_pose(stored: Mapping[str, Any]) -> Points:
    """(4, 4) of a pose in a plan file: xyz with quat_xyzw, with rpy, or alone."""
    if "quat_xyzw" in stored:
        quaternion = np.asarray(stored["quat_xyzw"], float)
        return pose(stored["xyz"], quat_xyzw=quaternion / np.linalg.norm(quaternion))
    return pose(stored["xyz"], rpy=stored.get("rpy", (0.0, 0.0, 0.0)))


def stored_shape(stored: Mapping[str, Any]) -> LinkShape:
    """One shape of a plan file, in its body's frame."""
    T, kind = stored_pose(stored["pose"]), stored["type"]
    if kind == "mesh":
        return LinkShape.mesh(stored["file"], stored["scale"], T)
    if kind == "box":
        return LinkShape(Box(stored["size"]), T)
    if kind == "sphere":
        return LinkShape(Sphere(stored["radius"]), T)
    make = Cylinder if kind == "cylinder" else Capsule
    return LinkShape(make(stored["radius"], stored["length"]), T)


def _ground_height(body: Body) -> float | None:
    """Height of the ground that World.add_floor put into a world; None for other bodies."""
    ground = body.shapes[0].shape
    return ground.offset if body.name == "floor" and isinstance(ground, Plane) else None


def _stored_body(stored: Mapping[str, Any]) -> Body:
    return Body(stored["name"], tuple(map(stored_shape, stored["shapes"])), stored_pose(stored["pose"]))


def floor_tiles(
    low: ArrayLike, high: ArrayLike, height: float = 0.0, tile: float = 0.5
) -> tuple[Points, NDArray[np.int64]]:
    """Vertices and faces of a floor of square tiles over [low, high] (x, y), a hair below `height` [m]."""
    (x0, y0), (x1, y1) = np.asarray(low, float), np.asarray(high, float)
    xs, ys = np.arange(x0, x1 + tile, tile), np.arange(y0, y1 + tile, tile)
    vertices = np.array([[x, y, height - 0.002] for y in ys for x in xs])
    n = len(xs)
    corners = [j * n + i for j in range(len(ys) - 1) for i in range(n - 1)]
    return vertices, np.array([f for a in corners for f in ([a, a + 1, a + n + 1], [a, a + n + 1, a + n])])
