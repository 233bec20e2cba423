"""Robots, worlds and configurations for the calls."""

from __future__ import annotations

import importlib
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from .lookup import find


def asset(name: str) -> Path:
    return Path(importlib.import_module("mmgrasp").__file__).parent / "assets" / name


@cache
def robot(name: str, base: str = "fixed") -> Any:
    folder = asset("robots") / name
    return find("Robot").load(folder / f"{name}.urdf", folder / f"{name}.srdf", base=base)


@cache
def group(name: str, base: str = "fixed", with_base: bool = False) -> Any:
    fetch = name == "fetchlike"
    return robot(name, base).group(
        "arm_with_torso" if fetch else "arm", tip="gripper_tcp" if fetch else None, with_base=with_base
    )


ROBOTS = [("fetchlike", "diff_drive"), ("omni6", "omni"), ("tm14like", "fixed"), ("kr6like", "fixed")]


def pose(*xyz: float, rpy: Any = None) -> np.ndarray:
    return find("pose")(xyz, rpy=rpy)


def world(seed: int = 1) -> Any:
    """Boxes, cylinders and balls around a robot in the middle."""
    rng = np.random.default_rng(seed)
    scene = find("World")()
    for i in range(12):
        angle, away, height = rng.uniform([-np.pi, 0.6, 0.2], [np.pi, 1.0, 1.4])
        at = pose(away * np.cos(angle), away * np.sin(angle), height, rpy=rng.uniform(-1, 1, 3))
        if i % 3 == 0:
            scene.add_cylinder(f"obstacle {i}", 0.05, 0.4, at)
        elif i % 3 == 1:
            scene.add_sphere(f"obstacle {i}", 0.08, at)
        else:
            scene.add_box(f"obstacle {i}", [0.1, 0.2, 0.3], at)
    return scene


def drawn(arm: Any, count: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).uniform(arm.sample_lower, arm.sample_upper, (count, len(arm.names)))


def free_ends(arm: Any, scene: Any, seed: int) -> np.ndarray:
    """Two free configurations that no straight line joins."""
    checker = find("CollisionChecker")(arm.robot, scene, arm)
    first, *others = (q for q in drawn(arm, 1000, seed) if checker.is_free(q))
    return np.array([first, next(q for q in others if not checker.edge_is_free(first, q))])


def tucked(name: str, base: str) -> list[float]:
    """The arm's state of that name."""
    arm = group(name, base)
    state = arm.robot.group_states["arm_with_torso" if name == "fetchlike" else "arm"]["tucked"]
    return [state[joint] for joint in arm.names]


def hand() -> Any:
    return find("Hand", "Gripper")(
        "gripper_tcp", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.04, finger_width=0.022
    )


def shape(of: str, *measures: Any) -> Any:
    return find("LinkShape")(find(of)(*measures))


def body(*size: float) -> list[Any]:
    return [shape("Box", size)]
