"""Grasps at which closing fingers meet the part."""

from __future__ import annotations

from dataclasses import dataclass

from .. import _core
from .._core import Grasp, Hand, JointGroup, LinkShape, Robot

CLOSING_PLAY = "10 mm or a quarter of it, whichever is more"
"""How far below a part's width fingers may close to meet it: verify::narrowest_grip() in words."""


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
        """Those of met() at which no finger stands in the part."""
        met = self.met(shapes, grasps)
        return [grasp for grasp, fits in zip(met, self.fits(shapes, met), strict=True) if fits]
