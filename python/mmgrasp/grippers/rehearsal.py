"""An operation gone through again with the gripper that was chosen for it, by the collision checker."""

from __future__ import annotations

import itertools
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import AssemblyGrasp, AssemblyOperation, CollisionChecker, Gripper, JointGroup, PlacedMesh, Robot, World
from .._turns import between, rotation_vector
from .assembly_file import Assembly

STEP, TURN = 0.0005, 0.01  # [m], [rad] between two looks
RETREAT = 0.1  # [m]
OFF = 2e-5  # Between pad and part while it is held [m].
AXES = (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))


def free_gripper(gripper: Gripper) -> tuple[Robot, JointGroup]:
    """The gripper's own files on six joints that carry it anywhere: x, y, z [m], then yaw, pitch, roll."""
    joints, parent = [], "assembly"
    kinds = [("prismatic", f"to_{n}", a) for n, a in AXES] + [("revolute", f"about_{n}", a) for n, a in reversed(AXES)]
    for kind, name, axis in kinds:
        child = "base" if name == "about_x" else f"after_{name}"
        reach = "10" if kind == "prismatic" else "6.3"
        link = "" if child == "base" else f'<link name="{child}"/>'
        joints.append(
            f'{link}<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
            f'<limit lower="-{reach}" upper="{reach}" effort="1" velocity="1"/></joint>'
        )
        parent = child
    with tempfile.TemporaryDirectory() as folder:
        gripper.to_urdf(folder)
        urdf, srdf = Path(folder, "gripper.urdf"), Path(folder, "gripper.srdf")
        carried = '<link name="assembly"/>' + "".join(joints) + "</robot>"
        urdf.write_text(urdf.read_text().replace("</robot>", carried))
        chain = '<group name="carried"><chain base_link="assembly" tip_link="base"/></group></robot>'
        srdf.write_text(srdf.read_text().replace("</robot>", chain))
        robot = Robot.load(str(urdf), srdf=str(srdf))
    return robot, robot.group("carried")


def rehearse(assembly: Assembly, gripper: Gripper, grasp: AssemblyGrasp, operation: AssemblyOperation) -> str:
    """What the gripper meets first: while it approaches the active parts, on the way, or while it lets go; '' when nothing."""
    robot, group = free_gripper(gripper)
    tips = _core.pose([0, 0, gripper.palm_height + gripper.finger_length])
    T_active_base = grasp.T_active_tool @ np.linalg.inv(tips)
    held = min((grasp.opening - gripper.min_opening) / 2 + OFF, (gripper.max_opening - gripper.min_opening) / 2)
    opened = min(held + grasp.clearance, (gripper.max_opening - gripper.min_opening) / 2)
    back = [_core.pose([0, 0, -d]) for d in np.arange(0, RETREAT, STEP)]
    moves = _between(list(operation.motion))
    end = moves[-1]
    stages = [
        ("the approach", operation.active, opened, [T_active_base @ b for b in back]),
        ("the grasp", operation.active, held, [T_active_base]),
        ("the motion", operation.passive, held, [m @ T_active_base for m in moves]),
        ("letting go", operation.passive, opened, [end @ T_active_base @ b for b in back]),
    ]
    for stage, parts, joint, poses in stages:
        if not parts:
            continue
        fingers = group.with_reference({"finger_1_joint": max(joint, 0.0)})
        checker = CollisionChecker(robot, _world(parts), fingers)
        for T in poses:
            q = _configuration(T)
            if checker.is_free(q):
                continue
            contact = checker.contacts(q)[0]
            return f"{contact.a} meets {contact.b} during {stage}"
    return ""


def _world(parts: list[PlacedMesh]) -> World:
    world = World()
    for part in parts:
        world.add(part.name, [_core.LinkShape(part.mesh)], part.pose)
    return world


def _configuration(T: NDArray[np.float64]) -> NDArray[np.float64]:
    xyz, rpy = _core.pose_to_xyz_rpy(T)
    return np.concatenate([xyz, np.asarray(rpy)[::-1]])


def _between(path: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """Poses along straight lines and even turns, no farther apart than STEP and TURN."""
    out = [path[0]]
    for a, b in itertools.pairwise(path):
        angle = float(np.linalg.norm(rotation_vector(a[:3, :3].T @ b[:3, :3])))
        looks = max(1, int(np.ceil(max(float(np.linalg.norm(b[:3, 3] - a[:3, 3])) / STEP, angle / TURN))))
        out += [between(a, b, k / looks) for k in range(1, looks + 1)]
    return out
