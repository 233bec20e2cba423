"""Grasps straight down on a part as it lies: few of those that are sampled from all around a part may be."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from .._core import Grasp, LinkShape
from .._progress import Progress
from .held_grasps import ClosingHand

MIN_STRAIGHT = 8  # grasps straight down; where there are fewer, more are drawn
MOST_ADDED = 24  # grasps at most that join those of the type
MOST_DRAWN = 8 * MOST_ADDED  # of which some have no room below the part
FLUSH = 1e-6  # tips of pads reach no farther beyond the part's far face [m]


def with_grasps_down(
    shapes: list[LinkShape],
    closing: ClosingHand,
    grasps: list[Grasp],
    down: np.ndarray,
    options: dict[str, Any],
    progress: Progress = None,
) -> list[Grasp]:
    """The grasps of a part and, where fewer than MIN_STRAIGHT of them can be taken straight `down` (a unit vector in the part's frame), others that can.

    `options` are those of the sampler; the worst grasps that are not straight down make room for what is drawn.
    """
    gripper = closing.hand
    far_face = _far_face(shapes, down)

    def is_usable(grasp: Grasp) -> bool:
        approach = grasp.T_object_hand[:3, :3] @ gripper.approach
        is_straight = (
            np.linalg.norm(np.cross(approach, down)) <= np.sin(_core._straight_approach()) and approach @ down > 0
        )
        tips = down @ grasp.T_object_hand[:3, 3] + gripper.finger_depth / 2
        return bool(is_straight and tips <= far_face + FLUSH)

    straight = [grasp for grasp in grasps if is_usable(grasp)]
    if len(straight) >= MIN_STRAIGHT:
        return grasps
    asked = {**options, "approach_direction": down, "max_grasps": MOST_DRAWN}
    drawn, _ = _core._sample_grasps(shapes, gripper, progress=progress, **asked)
    new = [grasp for grasp in drawn if is_usable(grasp) and not _is_among(straight, grasp)]
    new = closing.held(shapes, new)
    most = options.get("max_grasps", _core._grasp_option_table()["max_grasps"][0])
    new = new[: min(MOST_ADDED, most - len(straight))]
    if not new:
        return grasps
    others = [grasp for grasp in grasps if not is_usable(grasp)][: most - len(straight) - len(new)]
    return sorted(straight + new + others, key=lambda grasp: -grasp.quality)


def _far_face(shapes: list[LinkShape], down: np.ndarray) -> float:
    """The largest down . x over the shapes [m]."""
    T = np.eye(4)
    T[:3, :3] = np.vstack((down, _axes_across(down)))  # turns `down` into x
    return float(max(LinkShape(shape.shape, T @ shape.pose).bounds[1][0] for shape in shapes))


def _axes_across(direction: np.ndarray) -> np.ndarray:
    """Two unit vectors that make a right-handed frame with a unit vector before them (2, 3)."""
    flattest = np.eye(3)[np.argmin(np.abs(direction))]
    u = flattest - (flattest @ direction) * direction
    u /= np.linalg.norm(u)
    return np.vstack((u, np.cross(direction, u)))


def _is_among(grasps: list[Grasp], grasp: Grasp) -> bool:
    return any(np.allclose(other.T_object_hand, grasp.T_object_hand, rtol=0, atol=1e-6) for other in grasps)
