"""The pads by which a scanned part's grasp is judged anew, from what a plan says of the hand."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .._core import InvalidInput, LinkShape, Robot
from ..documents.reading import Node
from ..scenario.scan_section import moved

_PAD_LENGTH = 0.6
"""Share of a fingertip's length that its pad takes, as docs/methods/grasp.md says."""
_STEP = 0.01
"""Share of the fingers' way by which they close to tell where a fingertip goes."""


@dataclass(frozen=True)
class Pad:
    """A flat pad in the tool frame."""

    middle: np.ndarray
    along: np.ndarray
    """Unit vector of `depth`."""
    push: np.ndarray
    """Unit vector to the part."""
    depth: float
    """[m]"""
    width: float
    """[m]"""

    def grid(self, n: int) -> np.ndarray:
        """Middles of n x n fields of the pad (n * n, 3)."""
        steps = (np.arange(n) + 0.5) / n - 0.5
        u, v = np.meshgrid(steps * self.depth, steps * self.width, indexing="ij")
        across = np.cross(self.along, self.push)
        return np.asarray(self.middle + u.reshape(-1, 1) * self.along + v.reshape(-1, 1) * across)


def two_pads(gripper: Node, opening: float) -> list[Pad]:
    """Pads of two fingers that face each other across the tool frame."""
    approach, closing = (np.array(gripper[key].numbers(3)) for key in ("approach", "closing"))
    depth, width = (gripper[key].number(least=0) for key in ("finger_depth", "finger_width"))
    return [Pad(side * opening / 2 * closing, approach, -side * closing, depth, width) for side in (1.0, -1.0)]


class Fingertips:
    """The finger links of a plan's robot, of which each has a pad: the inner face of its tip."""

    def __init__(self, scenario: Node) -> None:
        """Raises InvalidInput where the hand has no `openings` or a finger link that does not move."""
        stored, gripper = scenario["robot"], scenario["gripper"]
        self._robot = Robot.from_strings(stored["urdf"].string(), base=stored["base"].string())
        self._tool = gripper["tool_link"].string()
        if self._tool not in self._robot.links:
            gripper["tool_link"].fail("the robot has no such link")
        self._joints = {
            j["name"].string(): (j["closed"].number(), j["open"].number()) for j in gripper["joints"].elements()
        }
        self._openings = gripper["openings"].numbers()
        half, closer = self._poses(0.5), self._poses(0.5 - _STEP)
        self._pads: dict[str, Pad] = {}
        for node in gripper["finger_links"].elements():
            link = node.string()
            if link not in half:
                node.fail("the robot has no such link")
            if not self._robot.collisions(link) or np.allclose(half[link], closer[link], rtol=0, atol=1e-9):
                node.fail("must have a shape and move with the hand's joints: it has a pad on a scanned part")
            with node.blamed():
                self._pads[link] = self._inner_face(link, half[link], closer[link])

    def within(self, opening: float) -> float:
        """The opening that the hand can have next to this one [m]."""
        return float(np.clip(opening, self._openings[0], self._openings[-1]))

    def pads(self, opening: float) -> list[Pad]:
        """All pads with the hand open by so much [m], an opening that it can have."""
        share = float(np.interp(opening, self._openings, np.linspace(0, 1, len(self._openings))))
        poses = self._poses(share)
        out = []
        for link, pad in self._pads.items():
            R, place = poses[link][:3, :3], poses[link][:3, 3]
            out.append(Pad(R @ pad.middle + place, R @ pad.along, R @ pad.push, pad.depth, pad.width))
        return out

    def _poses(self, share: float) -> dict[str, np.ndarray]:
        """Links in the tool frame."""
        values = {name: closed + share * (opened - closed) for name, (closed, opened) in self._joints.items()}
        poses = self._robot.link_poses(values)
        to_tool = np.linalg.inv(poses[self._tool])
        return {link: to_tool @ pose for link, pose in poses.items()}

    def _inner_face(self, link: str, now: np.ndarray, then: np.ndarray) -> Pad:
        """The face in the link's frame on the side to which the tip goes, about the middle of its length."""
        shapes = self._robot.collisions(link)
        low, high = _bounds(shapes, np.eye(4))
        middle = (low + high) / 2
        length = float(np.linalg.norm(middle))
        along = middle / length if length > 1e-6 else np.array([0.0, 0.0, 1.0])
        push = now[:3, :3].T @ ((then - now) @ [*middle, 1.0])[:3]
        push = push - (push @ along) * along
        if np.linalg.norm(push) < 1e-9:
            raise InvalidInput(
                f"{link}: must move across its length as the hand closes: it has a pad on a scanned part"
            )
        push = push / np.linalg.norm(push)
        axes = np.eye(4)
        axes[:3, :3] = np.vstack((along, np.cross(push, along), push))
        low, high = _bounds(shapes, axes)
        face = middle + (high[2] - push @ middle) * push
        return Pad(face, along, push, _PAD_LENGTH * float(high[0] - low[0]), float(high[1] - low[1]))


def _bounds(shapes: list[LinkShape], T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    bounds = [moved(shape, T).bounds for shape in shapes]
    return np.min([low for low, _ in bounds], axis=0), np.max([high for _, high in bounds], axis=0)
