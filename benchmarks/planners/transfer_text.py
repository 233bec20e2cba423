"""Carries by one grasp each as the plain text that bench_transfer_fcl.cpp reads: the pipe is a link of the robot."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from mbm_text import KINDS, numbers, sizes

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import FINGERS, PipeCell


def _robot_line(cell: PipeCell, grasp: mg.Grasp, folder: Path, number: int) -> str:
    """Writes the robot with the pipe in its hand."""
    robot = cell.robot.with_link("pipe", "gripper_tcp", np.linalg.inv(grasp.T_object_hand), cell.pipe.shapes())
    touching = [("pipe", finger, "user") for finger in sorted(FINGERS)]
    robot = robot.with_disabled_pairs([*cell.robot.disabled_pairs, *touching])
    urdf, srdf = folder / f"{number}.urdf", folder / f"{number}.srdf"
    urdf.write_text(robot.to_urdf())
    srdf.write_text(robot.to_srdf())
    return f"robot {urdf} {srdf}"


def _scene_lines(world: mg.World) -> list[str]:
    lines = []
    for name in world.objects:
        for shape in world.shapes_of(name):
            pose = world.pose_of(name) @ shape.pose
            kind = KINDS[type(shape.shape)]
            lines.append(f"shape {name.replace(' ', '_')} {kind} {sizes(shape.shape)} {numbers(pose[:3].ravel())}")
    return lines


def write_transfers(cell: PipeCell, transfers: list[tuple[mg.Grasp, np.ndarray, np.ndarray]], file: Path) -> None:
    """`carries`: a grasp, a start (6) and goals (k, 6) each."""
    lines, scene, names = [], _scene_lines(cell.world), cell.arm.names
    for number, (grasp, start, goals) in enumerate(transfers):
        lines += [_robot_line(cell, grasp, file.parent, number), f"problem transfer/{number} {cell.arm.name}"]
        still = cell.gripper.joint_values(grasp.opening)
        lines += [
            f"start {name} {numbers([value])}" for name, value in [*zip(names, start, strict=True), *still.items()]
        ]
        for k, goal in enumerate(goals):
            lines += ["another_goal"] if k else []
            lines += [f"goal {name} {numbers([value])}" for name, value in zip(names, goal, strict=True)]
        lines += scene
    file.write_text("\n".join(lines) + "\n")
