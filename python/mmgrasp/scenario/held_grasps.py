"""Grasps at which closing fingers meet the part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import _core
from .._core import Grasp, Hand, JointGroup, LinkShape, Robot
from .._core import verify as checks

CLOSING_PLAY = "10 mm or a quarter of it, whichever is more"
"""How far below a part's width fingers may close to meet it: verify::narrowest_grip() in words."""

_FARTHEST = 0.016
"""A hand is shifted by at most half of this along its closing axis [m]."""
_HALVINGS = 8
_PLAY, _SHARE = 0.0015, 0.05
"""So far, or this share of the opening, are pads off the part where fits() looks: verify::grip_play()."""
_LEAST = 2e-4
"""Shifts below this are not worth another pose [m]."""
_SHARES = (1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3)
"""So much of a shift is tried in turn, until `verify` agrees."""


@dataclass(frozen=True)
class ClosingHand:
    """A hand at its arm, asked which grasps hold."""

    arm: JointGroup
    hand: Hand
    mesh_tolerance: float = 0.0
    """Its meshes may stick out so far beyond those by which `verify` judges [m]."""
    robot: Robot | None = None
    """Whose links are the pads and bodies of a hand of many joints; None: two pads."""

    def meets(self, shapes: list[LinkShape], grasps: list[Grasp]) -> list[bool]:
        """Says of each grasp whether the closing fingers meet the part, as `verify` asks."""
        return _core.fingers_meet(self.arm, self.hand, shapes, grasps, mesh_tolerance=self.mesh_tolerance)

    def fits(self, shapes: list[LinkShape], grasps: list[Grasp]) -> list[bool]:
        """Says of each grasp whether the fingers keep out of the part until the pads meet it, as `verify` asks."""
        return _core.fingers_fit(self.arm, self.hand, shapes, grasps, mesh_tolerance=self.mesh_tolerance)

    def met(self, shapes: list[LinkShape], grasps: list[Grasp]) -> list[Grasp]:
        """Those of the grasps at which the closing fingers meet the part."""
        return [grasp for grasp, meets in zip(grasps, self.meets(shapes, grasps), strict=True) if meets]

    def held(self, shapes: list[LinkShape], grasps: list[Grasp]) -> list[Grasp]:
        """Those of the grasps at which the closing fingers meet the part and no finger stands in it.

        A thumb and two fingers beside its middle meet a round part one after the other, and push it: such a hand is shifted along its
        closing axis until they meet it at once, or as far as `verify`, which sees pads in the hand's middle, lets it.
        """
        fitting = [grasp for grasp, fits in zip(grasps, self.fits(shapes, grasps), strict=True) if fits]
        if self.robot is None or len(self.hand.finger_links) < 3 or not fitting:
            return self.met(shapes, fitting)
        meeting = self.meets(shapes, fitting)
        shifts = self._shifts(shapes, fitting)
        out = []
        for grasp, meets, shift in zip(fitting, meeting, shifts, strict=True):
            shifted = self._shifted_as_far_as_may_be(shapes, grasp, shift) if shift else None
            if shifted is not None or meets:
                out.append(shifted or grasp)
        return out

    def _shifts(self, shapes: list[LinkShape], grasps: list[Grasp]) -> np.ndarray:
        """How far along the closing axis the middle is of where the open fingers have room; 0 where that is next to nothing, or they meet the part from one side alone [m]."""
        out = np.zeros(len(grasps))
        # As far as pads in the middle have room, and a little: most parts stop the fingers there, too.
        plays = [max(_PLAY, _SHARE * grasp.opening) + _LEAST for grasp in grasps]
        passing = [
            self.fits(shapes, [self._shifted(grasp, side * play) for grasp, play in zip(grasps, plays, strict=True)])
            for side in (-1.0, 1.0)
        ]
        unlike = np.flatnonzero(np.any(passing, axis=0))
        if len(unlike):
            some = [grasps[k] for k in unlike]
            below, above = (self._room(shapes, some, side) for side in (-1.0, 1.0))
            out[unlike] = np.where(np.maximum(below, above) < _FARTHEST, (above - below) / 2, 0.0)
        return np.where(np.abs(out) < _LEAST, 0.0, out)

    def _shifted_as_far_as_may_be(self, shapes: list[LinkShape], grasp: Grasp, shift: float) -> Grasp | None:
        for share in _SHARES:
            shifted = self._shifted(grasp, share * shift)
            said = checks.CheckedGrasp(shifted.T_object_hand, shifted.opening)
            if checks.pads_unlike_grasp(self.hand, shapes, said):
                continue
            if all(self.fits(shapes, [shifted])) and all(self.meets(shapes, [shifted])):
                return shifted
        return None

    def _room(self, shapes: list[LinkShape], grasps: list[Grasp], side: float) -> np.ndarray:
        """How far the open fingers may shift along their closing axis, or against it, until one meets the part; _FARTHEST: farther [m]."""
        low, high = np.zeros(len(grasps)), np.full(len(grasps), _FARTHEST)
        far = np.array(self.fits(shapes, [self._shifted(grasp, side * _FARTHEST) for grasp in grasps]))
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            asked = [self._shifted(grasp, side * by) for grasp, by in zip(grasps, middle, strict=True)]
            fits = np.array(self.fits(shapes, asked))
            low, high = np.where(fits, middle, low), np.where(fits, high, middle)
        return np.where(far, _FARTHEST, low)

    def _shifted(self, grasp: Grasp, by: float) -> Grasp:
        T = grasp.T_object_hand.copy()
        T[:3, 3] += by * T[:3, :3] @ self.hand.closing
        return Grasp(T, grasp.opening, quality=grasp.quality)
