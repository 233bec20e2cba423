"""A picture of a pipe carried through its cell: the pipe at moments of the way, the arm at one of them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..bodies import Body, SceneBodies
from . import png
from .raster import Camera, Scene, render

if TYPE_CHECKING:
    from .._core import Grasp
    from ..problems.pipe_cells import PipeCell

ARM, HAND, TABLE, FIXTURE, OBSTACLE = "#D9DBDE", "#55585C", "#EDE8DF", "#9AA0A8", "#B9C4CF"
START, GOAL = np.array([0x2A, 0x9D, 0x5C]), np.array([0xC1, 0x12, 0x1F])
HIDDEN = ("roof", "wall")
"""Bodies left out, by the beginnings of their names: they would hide what is behind."""


def along(path: ArrayLike, count: int) -> NDArray[np.float64]:
    """`count` configurations spread evenly over the path's length, both ends among them."""
    waypoints = np.asarray(path, dtype=float)
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(waypoints, axis=0), axis=1))])
    return np.stack([np.interp(np.linspace(0, at[-1], count), at, column) for column in waypoints.T], axis=1)


def transfer_scene(cell: PipeCell, grasp: Grasp, path: ArrayLike, *, pipes: int = 9, arm_at: float = 0.5) -> Scene:
    """The cell with the pipe at `pipes` moments from green to red; `arm_at` says where on the way the arm is, in [0, 1]."""
    scene = Scene()
    bodies = SceneBodies.of_world(cell.robot, cell.world)
    for body in bodies.obstacles:
        if not body.name.startswith(HIDDEN):
            colour = TABLE if body.name == "table" else FIXTURE if "post" in body.name else OBSTACLE
            scene.add(body.vertices_at(), body.faces, colour)
    pipe = Body("pipe", tuple(cell.pipe.shapes()), np.eye(4))
    arm, T_tool_object = cell.arm_holding(grasp), np.linalg.inv(grasp.T_object_hand)
    moments = along(path, pipes)
    for i, q in enumerate(moments):
        share = i / max(pipes - 1, 1)
        colour = "#" + "".join(f"{round(v):02X}" for v in (1 - share) * START + share * GOAL)
        scene.add(pipe.vertices_at(arm.fk(q) @ T_tool_object), pipe.faces, colour)
    poses = arm.link_poses(moments[round(arm_at * (pipes - 1))])
    for link in bodies.links:
        hand = "gripper" in link.name or "finger" in link.name
        scene.add(link.vertices_at(poses[link.name]), link.faces, HAND if hand else ARM)
    return scene


def write_transfer(
    cell: PipeCell, grasp: Grasp, path: ArrayLike, file: str | Path, *, width: int = 1100, height: int = 800
) -> Path:
    """Renders transfer_scene from in front of the arm, a little above it."""
    start, goal = cell.T_world_start[:3, 3], cell.T_world_goal[:3, 3]
    towards = (start + goal)[:2] / max(float(np.linalg.norm((start + goal)[:2])), 1e-6)
    camera = Camera(
        np.array([*(2.7 * towards), 2.0]), np.array([*(0.2 * towards), 0.22]), width=width, height=height, fov=36.0
    )
    return png.write_png(Path(file), render(transfer_scene(cell, grasp, path), camera, background="#F7F7F5"))
