"""P1's Algorithm 4 beside exact inverse kinematics, told again one configuration at a time."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.base import inscribed_circle, make_base_grid
from mmgrasp.reproduce.setup import ChecksAtBase, Row, bars, robot_setup
from mmgrasp.reproduce.stored_regions import Density, measure

pytestmark = pytest.mark.slow

ROW = Row(objects=(1, 2))
DENSITY = Density("small", 200_000)


def by_definition(row: Row, *, exact: bool) -> np.ndarray:
    """The mask by loops: cell, object, grasp, configuration; exact ones by random restarts in place of branches."""
    reach = DENSITY.database(row)
    problem = row.problem()
    grid = make_base_grid(problem, reach)
    checks = ChecksAtBase(problem, row.torso)
    mask = np.zeros((grid.ny, grid.nx), dtype=bool)
    for iy, ix in itertools.product(range(grid.ny), range(grid.nx)):
        base = grid.centre(0, ix, iy)
        if np.hypot(*base[:2]) > 1.2 or not checks.at_home(base[None])[0]:
            continue
        served = []
        for part in problem.trays[0].parts:
            T = mg.pose([-base[0], -base[1], 0.0]) @ part.T_world_part @ part.grasps[0].T_object_hand
            found = reach.solve(problem.arm, T, count=64) if exact else reach.query(T)
            if exact:
                for q in found:
                    np.testing.assert_allclose(problem.arm.fk(q), T, atol=2e-4)
            served.append(any(checks.free(base[None], q[None])[0] for q in found))
        mask[iy, ix] = all(served)
    return mask


def test_cells_are_those_of_the_definition() -> None:
    mask = by_definition(ROW, exact=False)
    found = measure(ROW, DENSITY)
    assert found["cells"] == mask.sum() > 10
    grid = make_base_grid(ROW.problem(), DENSITY.database(ROW))
    assert found["radius"] == inscribed_circle(grid, mask[None])[1]
    assert found["false"] + (found["exact"] - found["missed"]) == found["cells"]


def test_what_is_called_false_has_no_exact_configuration() -> None:
    """Numerical solutions from what is stored near a pose are never found at a cell that is called false."""
    stored, solved = by_definition(ROW, exact=False), by_definition(ROW, exact=True)
    found = measure(ROW, DENSITY)
    assert 0 < found["false"] <= (stored & ~solved).sum()
    assert found["exact"] >= solved.sum()


def test_bars_are_held_below_the_rim() -> None:
    """Their grasps hold them between the pads, with the hand inside a tray of 10 cm."""
    row = Row(objects=(6, 8))
    parts = bars(row)
    assert len(parts) == 48
    places = np.array([part.T_world_part[:2, 3] for part in parts])
    assert len(np.unique(places.round(6), axis=0)) == 48
    for grasp in parts[0].grasps:
        assert 0 < grasp.T_object_hand[2, 3] < 0.06
        assert any(grasp.opening == pytest.approx(width) for width in (0.02, 0.05))
    assert robot_setup(row.torso).gripper.max_opening > 0.02
