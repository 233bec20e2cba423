"""Trays of parts that lie at random, seen by a camera: where they may be taken (P1 3.5.2 and 3.7.2).

The base region of such a tray is planned for the union of the grasps of several scans, which stand for all places where
a part may come to lie.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._core import (
    DepthImage,
    Grasp,
    Graspability,
    Hand,
    HeightMap,
    LinkShape,
    Part,
    PinholeCamera,
    RandomPlacement,
    Sphere,
)
from .._options import GraspabilityOptions

BORDER = 0.06  # seen around a tray, since fingers may stand beside it [m]
MARKER = 0.001  # radius of the body that stands for a grasp [m]


@dataclass(frozen=True)
class TrayScan:
    """One filling of a tray, its depth image and the grasps found in it; poses are in the tray's frame."""

    image: DepthImage
    height_map: HeightMap
    found: Graspability

    @property
    def grasps(self) -> list[Grasp]:
        """Grasps of all parts seen, in the world."""
        return self.found.grasps


@dataclass(frozen=True)
class RandomTrayScan(TrayScan):
    """A scan of a filling that was drawn at random."""

    placement: RandomPlacement


def scan_random_tray(
    part: Sequence[LinkShape],
    tray_size: ArrayLike,
    gripper: Hand,
    *,
    count: int = 12,
    fill: float = 1.0,
    wall: float = 0.005,
    stack: bool = True,
    seed: int = 1,
    camera: PinholeCamera | None = None,
    camera_height: float = 0.8,
    noise: float = 0.0005,
    resolution: float = 0.002,
    **options: Unpack[GraspabilityOptions],
) -> RandomTrayScan:
    """Fills a tray at random, renders it from above its middle and evaluates graspability.

    `fill` is the share of `count` parts that is left in the tray (P1: 1, 0.75, 0.5, 0.25); with
    `stack` a part without a place on the floor may lie on others. `camera_height` [m] is above
    the floor; `noise` [m] is the depth's at 1 m. Further keywords go to evaluate_graspability. Same seed, same scan.
    """
    size = np.asarray(tray_size, float)
    placement = _core.random_placement(_body(part), size, count=count, fill=fill, wall=wall, stack=stack, seed=seed)
    poses = [placed.T_tray_part for placed in placement.parts]
    seen = _core.look_down([0, 0, camera_height])
    scan = scan_tray(
        part,
        poses,
        size,
        gripper,
        wall=wall,
        seed=seed,
        camera=camera,
        T_tray_camera=seen,
        noise=noise,
        resolution=resolution,
        **options,
    )
    return RandomTrayScan(**vars(scan), placement=placement)


def scan_tray(
    part: Sequence[LinkShape],
    poses: Iterable[ArrayLike],
    tray_size: ArrayLike,
    gripper: Hand,
    *,
    wall: float = 0.005,
    seed: int = 1,
    camera: PinholeCamera | None = None,
    T_tray_camera: ArrayLike | None = None,
    noise: float = 0.0005,
    resolution: float = 0.002,
    **options: Unpack[GraspabilityOptions],
) -> TrayScan:
    """Renders a tray in which parts lie at `poses` (T_tray_part each) and evaluates graspability.

    Without `T_tray_camera` the camera looks down from 0.8 m above the middle of the floor. Else as scan_random_tray.
    """
    body = _body(part)
    size = np.asarray(tray_size, float)
    scene = _core.tray_shapes(size, wall)
    for pose in poses:
        scene += [LinkShape(shape.shape, np.asarray(pose, float) @ shape.pose) for shape in body]
    eye = _core.look_down([0, 0, 0.8]) if T_tray_camera is None else T_tray_camera
    image = _core.render_depth(scene, camera or PinholeCamera(), eye, noise=noise, seed=seed)
    around = size[:2] + 2 * BORDER
    height_map = _core.make_height_map(image, np.eye(4), around, resolution=resolution)
    found = _core.evaluate_graspability(height_map, gripper, image=image, **options)
    return TrayScan(image, height_map, found)


def _body(part: Sequence[LinkShape]) -> list[LinkShape]:
    if isinstance(part, Part) or not all(isinstance(shape, LinkShape) for shape in part):
        raise _core.InvalidInput("part: must be a list of LinkShape, its body; a Part is a body with a pose and grasps")
    return list(part)


def union_of_grasps(scans: Iterable[TrayScan]) -> list[Grasp]:
    """All grasps of several scans in the tray's frame, best first (P1 3.7.2: G = G1 + G2 + G3 + G4)."""
    return sorted((grasp for scan in scans for grasp in scan.grasps), key=lambda grasp: -grasp.quality)


def parts_of_grasps(
    name: str, grasps: Iterable[Grasp], gripper: Hand, T_world_tray: ArrayLike, *, wall: float = 0.005
) -> list[Part]:
    """One part for each grasp, so that a tray's base region holds the base poses that reach every one of them.

    A part may be taken with the hand either way round. Its body is a bead inside the tray's floor, where it hinders
    nothing: parts of different scans lie where others lay. For base regions; there is nothing to pick up.
    """
    tray = np.asarray(T_world_tray, float)
    a = np.asarray(gripper.approach, float)
    half_turn = np.eye(4)
    half_turn[:3, :3] = 2 * np.outer(a, a) - np.eye(3)
    below = _core.pose([0, 0, -wall / 2])
    parts = []
    for i, grasp in enumerate(grasps):
        pose = tray @ grasp.T_object_hand
        bead = LinkShape(Sphere(min(MARKER, wall / 4)), np.linalg.inv(grasp.T_object_hand) @ below)
        both = [Grasp(turn, grasp.opening, quality=grasp.quality) for turn in (np.eye(4), half_turn)]
        parts.append(Part(f"{name}/grasp {i + 1}", [bead], pose, both))
    return parts
