"""A motor-like product of thirteen parts, composed to the openings of P1's figure 5.13 at full size.

P1 prints openings and no drawings: the bodies made here have just these openings; necks, bores, shoulders and lengths are ours.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .._core import Mesh
from .turned_parts import Section, lofted

_NECK = 4.0  # radius of what joins the blades of part 7, and of the boss on part 10 [mm]
_BLADES = (16.7, 19.1, 17.2, 15.9, 16.5, 15.8, 16.9, 18.5)  # [mm]


@dataclass(frozen=True)
class Composed:
    """Bodies one on the other: cross-section (radius, or the sides of a rectangle) and height each, all bored through [mm]."""

    bodies: tuple[tuple[Section, float], ...]
    bore: float = 0.0  # radius; 0: none

    def heights(self) -> np.ndarray:
        """Where bodies begin and end along z [mm]."""
        return np.cumsum([0.0, *(height for _, height in self.bodies)])

    def mesh(self, scale: float = 1.0) -> Mesh:
        """Its surface, closed [m]; `scale` 1 is the full size."""
        unit = 1e-3 * scale
        profile: list[tuple[Section, float]] = []
        for (section, _), (low, high) in zip(self.bodies, pairwise(self.heights()), strict=True):
            sides = tuple(unit * s for s in section) if isinstance(section, tuple) else unit * section
            profile += [(sides, unit * low), (sides, unit * high)]  # type: ignore[list-item]
        # The bore's wall ends where bodies do, so that each of its faces belongs to one of them.
        ends = self.heights() if self.bore > 0 else self.heights()[[0, -1]]
        bore: list[tuple[Section, float]] = [(unit * self.bore, unit * float(z)) for z in ends]
        return lofted([bore[0], *profile, *bore[:0:-1]])

    def body_of_faces(self, mesh: Mesh) -> np.ndarray:
        """The body that lies behind each face (m,)."""
        a, b, c = (mesh.vertices[mesh.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        behind = 1e3 * ((a + b + c) / 3 - 1e-6 * normals)[:, 2]
        return np.searchsorted(self.heights()[1:-1], behind)


PARTS = {
    "1": Composed(((113.5, 20),), bore=10),
    "2": Composed(((113.5, 14),), bore=60),
    "3": Composed(((55.0, 22),), bore=12.6),
    "4": Composed(((12.5, 45),)),
    "5": Composed(((16.0, 38), (20.0, 14)), bore=12.6),
    "6": Composed(((9.0, 140),)),
    "7": Composed(tuple(body for width in _BLADES for body in (((width, 34.0), 14), (_NECK, 9)))[:-1]),
    "8": Composed((((60.0, 90.0), 24), (20.0, 40)), bore=9.1),
    "9": Composed(((16.0, 38), (20.0, 24)), bore=10.1),
    "10": Composed((((17.0, 40.0), 26), (_NECK, 1.5))),
    "11": Composed(((10.0, 72),)),
    "12": Composed((((32.8, 52.0), 14), ((15.0, 28.0), 30))),
    "13": Composed(((18.75, 27.3),), bore=9.1),
}
"""Parts by P1's numbers, in the order of assembly."""
ROTOR = Composed(((8.0, 20), (14.0, 14), ((30.0, 46.0), 20), (14.0, 12), (10.0, 25), (6.0, 16)))
"""As the rotor of P1's figure 5.7 b: five round segments and one, the third, that is held by its flat sides."""
SLEEVE = Composed(((17.0, 30), (25.0, 12)), bore=11)
"""As the inner sleeve shaft of figure 5.7 a."""
