"""What an arm must keep off while its hand takes one object of a map: the table, and all that the map holds beside the object."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .._core import ProbabilisticSdf, Voxels, World, pose

NEAR = 0.03  # around an object, where the hand is checked against the map's surface and cells would shut it out [m]
THICKNESS = 0.02  # of the table's top [m]


class Surroundings:
    """The obstacles of a map, and a world of them for each of its objects."""

    def __init__(self, sdf: ProbabilisticSdf, sigmas: float) -> None:
        """`sigmas`: standard deviations of the surface that the arm keeps free."""
        self._cells = sdf.obstacle_cells(sigmas)
        self._points = sdf.points()[0]
        self._level = max(0.004, 2 * sdf.voxel)  # what the map has so near to the table is the table [m]

    def around(self, bounds: np.ndarray, table: float) -> World:
        """Without what lies within NEAR of `bounds` (2, 3); the table is what the map shows at the height `table` [m]."""
        world = World()
        top = self._points[np.abs(self._points[:, 2] - table) <= self._level]
        if len(top):
            low, high = top.min(axis=0), top.max(axis=0)
            size, middle = high - low, (high + low) / 2
            size[2], middle[2] = THICKNESS, table - THICKNESS / 2
            world.add_box("table", size, pose(middle))
        for k, cells in enumerate(self._kept(bounds, table)):
            world.add(f"map_{k}", cells)
        return world

    def _kept(self, bounds: np.ndarray, table: float) -> Sequence[Voxels]:
        out = []
        for cells in self._cells:
            centres, edge = cells.centres, cells.resolution
            reach = NEAR + edge / 2
            own = ((centres > bounds[0] - reach) & (centres < bounds[1] + reach)).all(axis=1)
            at_table = np.abs(centres[:, 2] - table) <= self._level + edge
            kept = centres[~own & ~at_table]
            if len(kept):
                out.append(Voxels(kept, edge))
        return out
