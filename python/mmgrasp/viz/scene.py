"""Turns a plan and a time into coloured triangles: robot, obstacles, trays and parts."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..bodies import SceneBodies, floor_tiles
from .raster import Scene
from .style import FLOOR, OBSTACLE, PART, ROBOT, ROBOT_ARM, TRAY_BODY
from .timeline import State, Timeline


def obstacle_colour(name: str) -> str:
    """Trays stand out among what is only in the way."""
    return TRAY_BODY if name.startswith("tray ") else OBSTACLE


class PlanScene:
    """The scene of a plan; `at(state)` gives triangles for the renderer, `robot_poses(state)` link poses for the viewer."""

    def __init__(self, plan: dict[str, Any]):
        self.plan = plan
        self.timeline = Timeline(plan)
        self.bodies = SceneBodies.of_plan(plan)
        self.arm_links = self._arm_links()

    def _arm_links(self) -> set[str]:
        """Links beyond the first turning joint of the arm: a lift below it counts as the body."""
        joints = self.bodies.robot.joint_table
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
        openings = gripper.get("openings", [0.0, gripper["max_opening"]])  # at equal steps of the joints
        share = float(np.interp(state.opening, openings, np.linspace(0, 1, len(openings))))
        for finger in gripper["joints"]:
            values[finger["name"]] = finger["closed"] + share * (finger["open"] - finger["closed"])
        values.update(zip(scenario["arm"]["joints"], map(float, state.arm), strict=True))
        return values

    def robot_poses(self, state: State) -> dict[str, np.ndarray]:
        """T_world_link by link name."""
        return self.bodies.link_poses(self.joint_values(state), state.base)

    def part_pose(self, name: str, state: State, links: dict[str, np.ndarray]) -> np.ndarray | None:
        """T_world_part, or None when the part lies in the bin."""
        if state.attached and state.attached[0] == name:
            return np.asarray(links[self.plan["scenario"]["gripper"]["tool_link"]] @ state.attached[1])
        return None if name in state.removed else self.bodies.parts[name].pose

    def at(self, state: State, floor: bool = True) -> Scene:
        """Coloured triangles of everything at this state."""
        scene = Scene()
        if floor:
            low, high = self.bounds()
            scene.add(*floor_tiles(low - 0.5, high + 0.5, self.bodies.floor), FLOOR)
        for body in self.bodies.obstacles:
            scene.add(body.vertices_at(), body.faces, obstacle_colour(body.name))
        links = self.robot_poses(state)
        for link in self.bodies.links:
            scene.add(link.vertices_at(links[link.name]), link.faces, self.link_colour(link.name))
        for part in self.bodies.parts.values():
            T = self.part_pose(part.name, state, links)
            if T is not None:
                scene.add(part.vertices_at(T), part.faces, PART)
        return scene

    def link_colour(self, link: str) -> str:
        """The arm stands out."""
        return ROBOT_ARM if link in self.arm_links else ROBOT

    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner (x, y) of what the plan shows."""
        points = [np.asarray(self.plan["scenario"][key], float)[:2] for key in ("start", "goal")]
        points += [np.asarray(stop["pose"][:2], float) for stop in self.plan["stops"]]
        for body in self.bodies.obstacles:
            world = body.vertices_at()[:, :2]
            points += [world.min(axis=0), world.max(axis=0)]
        stacked = np.array(points)
        return stacked.min(axis=0) - 0.4, stacked.max(axis=0) + 0.4
