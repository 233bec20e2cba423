"""Height accumulated features: values by hand, labels in closed form, and what the machine chooses on a block."""

from __future__ import annotations

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.reproduce import height_features as hf

HAND = mg.Hand(
    "tool", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.016, finger_width=0.022,
    body=mg.grasping.HandBody(finger_thickness=0.012, finger_length=0.07, palm_length=0.12, palm_width=0.06),
)  # fmt: skip


def block(width: float, length: float, height: float, turn: float = 0.0, aside: float = 0.0) -> np.ndarray:
    """Heights of a block over a window; its width lies along the columns, turned, its middle `aside` along them."""
    at = hf.FINE * (np.arange(70) - 34.5)
    v, u = np.meshgrid(at, at - aside, indexing="ij")
    across, along = np.cos(turn) * u + np.sin(turn) * v, np.cos(turn) * v - np.sin(turn) * u
    return np.where((np.abs(across) < width / 2) & (np.abs(along) < length / 2), height, 0.0)


def test_features_are_differences_of_means() -> None:
    rng = np.random.default_rng(3)
    grid = rng.uniform(0, 5, (17, 16))
    found = hf.features(grid)
    assert found.shape == (4, 3, len(hf.pairs()) + len(hf.bars())) and len(hf.pairs()) > 250
    window = grid[2:16, 1:15]

    def mean(region: hf.Region) -> float:
        (r0, r1), (c0, c1) = region
        return float(window[r0:r1, c0:c1].mean())

    for k, (outer, inner) in enumerate(hf.pairs()):
        assert outer[0][0] <= inner[0][0] and inner[1][1] <= outer[1][1] and outer != inner
        assert found[2, 1, k] == pytest.approx(mean(inner) - mean(outer))
    for k, (left, middle, right) in enumerate(hf.bars(), len(hf.pairs())):
        assert left[1][1] - left[1][0] == right[1][1] - right[1][0]
        rise = min(mean(middle) - mean(left), mean(middle) - mean(right))
        assert found[2, 1, k] == pytest.approx(rise if rise > 0 else -1.0)
    assert np.abs(hf.features(np.full((14, 14), 3.0))[0, 0, : len(hf.pairs())]).max() < 1e-12


def test_labels_are_what_a_hand_can_hold() -> None:
    assert hf.holds(block(0.04, 0.08, 0.05), HAND, 0.5)
    assert not hf.holds(block(0.11, 0.08, 0.05), HAND, 0.5)  # wider than the hand opens
    assert not hf.holds(block(0.04, 0.08, 0.05, aside=0.035), HAND, 0.5)  # under a finger
    assert not hf.holds(block(0.04, 0.012, 0.05), HAND, 0.5)  # shorter than the pads are wide
    assert not hf.holds(np.zeros((70, 70)), HAND, 0.5)
    # Faces askew by an angle lie within the cone of friction up to its tangent.
    for turn, good in ((0.3, True), (np.arctan(0.5) + 0.15, False)):
        assert hf.holds(block(0.03, 0.08, 0.05, turn), HAND, 0.5) == good
    assert hf.pad_height(0.06, HAND) == pytest.approx(0.03)
    assert hf.pad_height(0.01, HAND) == pytest.approx(0.003 + 0.008)  # the tips stay above the table


@pytest.fixture(scope="module")
def machine() -> hf.Machine:
    return hf.trained(HAND, 0.5)


@pytest.mark.slow
def test_the_machine_tells_windows_it_has_not_seen(machine: hf.Machine) -> None:
    found, good = hf.drawn_windows(1000, HAND, 0.5, seed=5)
    taken = machine.scores(found) > 0
    assert taken[good].mean() > 0.75 and taken[~good].mean() < 0.3
    assert 0.1 < good.mean() < 0.4


@pytest.mark.slow
@pytest.mark.parametrize("turn", [0.0, 0.5, 1.3])
def test_a_block_is_held_across_its_narrow_side(machine: hf.Machine, turn: float) -> None:
    ny, nx, cell = 130, 170, 0.002
    y, x = np.meshgrid(cell * (np.arange(ny) - 64.5), cell * (np.arange(nx) - 84.5), indexing="ij")
    across = np.cos(turn) * (x - 0.02) + np.sin(turn) * (y + 0.01)
    along = np.cos(turn) * (y + 0.01) - np.sin(turn) * (x - 0.02)
    heights = mg.mapping.HeightMap(np.where((abs(across) < 0.02) & (abs(along) < 0.06), 0.05, 0.0), cell)
    best = hf.choose(heights, HAND, machine)[0].T_object_hand
    np.testing.assert_allclose(best[:3, :3] @ HAND.approach, [0, 0, -1], atol=1e-12)
    closing = best[:3, :3] @ HAND.closing
    assert abs(closing @ [np.cos(turn), np.sin(turn), 0]) > np.cos(np.radians(20))
    off = best[:2, 3] - [0.02, -0.01]
    assert abs(off @ [np.cos(turn), np.sin(turn)]) < 0.012 and best[2, 3] == pytest.approx(0.025)
    assert hf.choose(mg.mapping.HeightMap(np.zeros((130, 170)), cell), HAND, machine) == []
