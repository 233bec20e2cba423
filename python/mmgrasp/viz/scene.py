"""Turns a plan and a time into coloured triangles: robot, obstacles, trays and parts."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import Box, Capsule, Cylinder, LinkShape, Robot, Sphere
from .raster import Scene
from .style import FLOOR, OBSTACLE, PART, ROBOT, ROBOT_ARM, TRAY_BODY
from .timeline import State, Timeline, pose_matrix


def transformed(T: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Points (n, 3) moved by T (4, 4)."""
    return vertices @ T[:3, :3].T + T[:3, 3]


def shape_mesh(shape: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 3) and faces (m, 3) of one shape of the plan file, in the body's frame."""
    T = pose_matrix(shape["pose"])
    kind = shape["type"]
    if kind == "mesh":
        placed = LinkShape.mesh(shape["file"], shape["scale"], T)
    elif kind == "box":
        placed = LinkShape(Box(shape["size"]), T)
    elif kind == "sphere":
        placed = LinkShape(Sphere(shape["radius"]), T)
    else:
        make = Cylinder if kind == "cylinder" else Capsule
        placed = LinkShape(make(shape["radius"], shape["length"]), T)
    return placed_triangles(placed)


def placed_triangles(shape: LinkShape) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a shape in the frame of the body it belongs to."""
    mesh = shape.surface()
    return transformed(shape.pose, mesh.vertices), mesh.triangles


def body_mesh(shapes: list[dict[str, Any]]) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and faces of a body of the plan file, in the body's frame."""
    vertices, faces, count = [], [], 0
    for shape in shapes:
        V, F = shape_mesh(shape)
        vertices.append(V)
        faces.append(F + count)
        count += len(V)
    return np.concatenate(vertices), np.concatenate(faces)


class PlanScene:
    """The scene of a plan; `at(state)` gives triangles for the renderer, `robot_poses(state)` link poses for the viewer."""

    def __init__(self, plan: dict[str, Any]):
        self.plan = plan
        self.timeline = Timeline(plan)
        scenario = plan["scenario"]
        self.robot = Robot.from_strings(
            scenario["robot"]["urdf"], scenario["robot"]["srdf"], base=scenario["robot"]["base"]
        )
        self.link_meshes = [
            (link, *placed_triangles(shape)) for link in self.robot.links for shape in self.robot.collisions(link)
        ]
        self.arm_links = self._arm_links()
        self.obstacles = [(o["name"], pose_matrix(o["pose"]), body_mesh(o["shapes"])) for o in scenario["obstacles"]]
        self.parts = {p["name"]: (pose_matrix(p["pose"]), body_mesh(p["shapes"])) for p in scenario["parts"]}

    def _arm_links(self) -> set[str]:
        """Links beyond the first turning joint of the arm: a lift below it counts as the body."""
        joints = self.robot.joint_table
        arm = set(self.plan["scenario"]["arm"]["joints"])
        moved: set[str] = set()
        for joint in joints:  # parents come before children
            turning = joint["name"] in arm and joint["type"] != "prismatic"
            if turning or joint["parent"] in moved:
                moved.add(joint["child"])
        return moved

    def home_state(self) -> State:
        """The robot at the origin in its home configuration."""
        return State(np.zeros(3), self.timeline.home, 0.0)

    def joint_values(self, state: State) -> dict[str, float]:
        """Every movable joint by name."""
        scenario = self.plan["scenario"]
        values = dict(scenario["other_joints"])
        gripper = scenario["gripper"]
        for finger in gripper["joints"]:
            share = state.opening / gripper["max_opening"]
            values[finger["name"]] = finger["closed"] + share * (finger["open"] - finger["closed"])
        values.update(zip(scenario["arm"]["joints"], map(float, state.arm), strict=True))
        return values

    def robot_poses(self, state: State) -> dict[str, np.ndarray]:
        """T_world_link by link name."""
        x, y, theta = state.base
        T = np.eye(4)
        T[:2, :2] = [[np.cos(theta), -np.sin(theta)], [np.sin(theta), np.cos(theta)]]
        T[:2, 3] = x, y
        return self.robot.link_poses(self.joint_values(state), T)

    def part_pose(self, name: str, state: State, links: dict[str, np.ndarray]) -> np.ndarray | None:
        """T_world_part, or None when the part lies in the bin."""
        if state.held and state.held[0] == name:
            return links[self.plan["scenario"]["gripper"]["tcp_link"]] @ state.held[1]
        return None if name in state.gone else self.parts[name][0]

    def at(self, state: State, floor: bool = True) -> Scene:
        """Coloured triangles of everything at this state."""
        scene = Scene()
        if floor:
            scene.add(*self._floor(), FLOOR)
        for name, T, (V, F) in self.obstacles:
            scene.add(transformed(T, V), F, TRAY_BODY if name.startswith("tray ") else OBSTACLE)
        links = self.robot_poses(state)
        for name, V, F in self.link_meshes:
            scene.add(transformed(links[name], V), F, ROBOT_ARM if name in self.arm_links else ROBOT)
        for name, (_, (V, F)) in self.parts.items():
            T = self.part_pose(name, state, links)
            if T is not None:
                scene.add(transformed(T, V), F, PART)
        return scene

    def _floor(self) -> tuple[np.ndarray, np.ndarray]:
        (x0, y0), (x1, y1) = self.bounds()
        step = 0.5
        xs = np.arange(x0 - 0.5, x1 + 0.5 + step, step)
        ys = np.arange(y0 - 0.5, y1 + 0.5 + step, step)
        vertices = np.array([[x, y, -0.002] for y in ys for x in xs])
        n = len(xs)
        faces = []
        for j in range(len(ys) - 1):
            for i in range(n - 1):
                a = j * n + i
                faces += [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]
        return vertices, np.array(faces)

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (x, y) of what the plan shows."""
        points = [np.asarray(self.plan["scenario"][key], float)[:2] for key in ("start", "goal")]
        points += [np.asarray(stop["pose"][:2], float) for stop in self.plan["stops"]]
        for _, T, (V, _) in self.obstacles:
            world = transformed(T, V)[:, :2]
            points += [world.min(axis=0), world.max(axis=0)]
        stacked = np.array(points)
        return stacked.min(axis=0) - 0.4, stacked.max(axis=0) + 0.4
