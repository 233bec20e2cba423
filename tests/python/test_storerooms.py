import math

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.problems import storerooms


def distances(points: np.ndarray) -> np.ndarray:
    d = np.linalg.norm(points[:, None, :2] - points[None, :, :2], axis=2)
    return np.asarray(d[np.triu_indices(len(points), 1)])


def test_regular_placements() -> None:
    row = storerooms.row(4, 0.5)
    assert row[:, 0].tolist() == [0, 0.5, 1.0, 1.5]
    assert np.all(row[:, 2] == math.pi / 2)
    aisle = storerooms.aisle(6, 0.5, 1.6)
    # A robot in the aisle's middle line stands in front of every tray.
    fronts = aisle[:, :2] - 0.8 * np.column_stack([np.cos(aisle[:, 2]), np.sin(aisle[:, 2])])
    assert np.allclose(fronts[:, 1], 0)
    block = storerooms.block(24, 0.5, 1.5, per_row=6)
    assert distances(block).min() == pytest.approx(0.4)
    fronts = block[:, :2] - 0.75 * np.column_stack([np.cos(block[:, 2]), np.sin(block[:, 2])])
    assert min(np.linalg.norm(f - t) for f in fronts for t in block[:, :2]) >= 0.7
    parts = storerooms.regular_parts(3, 4, (0.3, 0.4))
    assert len(parts) == 12
    assert distances(parts).min() == pytest.approx(0.1)
    assert parts[:, :2].mean(axis=0) == pytest.approx([0, 0])


def test_random_placements_repeat_and_keep_their_distances() -> None:
    trays = storerooms.scattered(60, seed=3)
    assert np.array_equal(trays, storerooms.scattered(60, seed=3))
    assert not np.array_equal(trays, storerooms.scattered(60, seed=4))
    assert distances(trays).min() >= 0.45
    fronts = trays[:, :2] - 0.68 * np.column_stack([np.cos(trays[:, 2]), np.sin(trays[:, 2])])
    apart = np.linalg.norm(fronts[:, None] - trays[None, :, :2], axis=2)
    assert apart[~np.eye(60, dtype=bool)].min() >= 0.58


@pytest.mark.slow
def test_what_does_not_fit_is_said() -> None:
    with pytest.raises(mg.Error, match="spacing"):
        storerooms.row(3, 0.0)
    with pytest.raises(mg.Error, match="area"):
        storerooms.scattered(40, seed=1, area=0.05)
    assert storerooms.scattered(0, seed=1).shape == (0, 3)
