"""Pipes at the Python door, and the two shipped six-joint arms against the lengths their makers publish."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp._files import shipped
from mmgrasp.cli import main

H = math.pi / 2
# Rows (theta offset, d, a, alpha); the KR6's first axis points down, and its flange looks along the last frame's z.
DH = {
    "tm14like": [
        (0, 0.1652, 0, -H),
        (-H, 0, 0.5361, 0),
        (0, 0, 0.4579, 0),
        (H, -0.1563, 0, H),
        (0, 0.106, 0, H),
        (0, 0.11315, 0, 0),
    ],
    "kr6like": [
        (0, -0.400, 0.025, H),
        (0, 0, 0.455, 0),
        (-H, 0, 0.035, H),
        (0, -0.420, 0, -H),
        (0, 0, 0, H),
        (math.pi, -0.080, 0, math.pi),
    ],
}
BASE = {"tm14like": np.eye(4), "kr6like": np.diag([1.0, -1, -1, 1])}
FLANGE = {"tm14like": "wrist_3_link", "kr6like": "link_6"}
# Turn of the flange's frame in the last Denavit-Hartenberg frame: for the KR6 its x is the tool's direction.
TURN = {"tm14like": np.eye(4), "kr6like": np.array([[0.0, 0, -1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1]])}
DEGREES = {
    "tm14like": [(-270, 270), (-180, 180), (-163, 163), (-180, 180), (-180, 180), (-270, 270)],
    "kr6like": [(-170, 170), (-190, 45), (-120, 156), (-185, 185), (-120, 120), (-350, 350)],
}


def load(name: str) -> mg.Robot:
    return mg.Robot.load(shipped(f"asset:robots/{name}/{name}.urdf"), shipped(f"asset:robots/{name}/{name}.srdf"))


def denavit_hartenberg(rows: Any, q: Any) -> np.ndarray:
    T = np.eye(4)
    for (offset, d, a, alpha), value in zip(rows, q, strict=True):
        c, s = math.cos(offset + value), math.sin(offset + value)
        ca, sa = math.cos(alpha), math.sin(alpha)
        T = T @ np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s], [0, sa, ca, d], [0, 0, 0, 1]])
    return T


@pytest.mark.parametrize("name", DH)
def test_flange_stands_where_the_published_lengths_put_it(name: str) -> None:
    flange = load(name).group(base_link="base_link", tip=FLANGE[name])
    np.testing.assert_allclose(np.degrees(flange.lower), [low for low, _ in DEGREES[name]], atol=1e-3)
    np.testing.assert_allclose(np.degrees(flange.upper), [high for _, high in DEGREES[name]], atol=1e-3)
    for q in np.random.default_rng(1).uniform(flange.lower, flange.upper, (50, 6)):
        expected = BASE[name] @ denavit_hartenberg(DH[name], q) @ TURN[name]
        np.testing.assert_allclose(flange.fk(q), expected, atol=1e-8)


@pytest.mark.parametrize(
    ("name", "reach", "links"), [("tm14like", 1.1, ("wrist_1_link", 0.106)), ("kr6like", 0.9, ("link_5", 0.0))]
)
def test_reach_is_the_published_one(name: str, reach: Any, links: Any) -> None:
    """TM14: 1100 mm with the arm stretched, over the fifth joint's offset. KR6 R900: 901.5 mm to the wrist's centre."""
    tip, more = links
    chain = load(name).group(base_link="base_link", tip=tip)
    rng = np.random.default_rng(2)
    axis = np.array([0, 0, 0.1652]) if name == "tm14like" else np.array([0, 0, 0.4])
    far = max(
        np.linalg.norm((chain.fk(q)[:3, 3] - axis)[:2] if name == "kr6like" else chain.fk(q)[:3, 3] - axis)
        for q in rng.uniform(chain.lower, chain.upper, (20000, len(chain)))
    )
    if name == "tm14like":
        stretched = math.hypot(0.5361 + 0.4579, 0.1563)
        assert far <= stretched + 1e-6
        assert 0.5361 + 0.4579 + more == pytest.approx(reach, abs=1e-3)
    else:
        stretched = 0.025 + 0.455 + math.hypot(0.420, 0.035)
        assert stretched == pytest.approx(0.9015, abs=1e-4)
        assert far <= stretched + 1e-6
    assert far > 0.97 * stretched


@pytest.mark.parametrize("name", DH)
def test_every_branch_is_found_in_closed_form_and_home_is_free(name: str) -> None:
    robot = load(name)
    arm = robot.group("arm")
    assert arm.tip == "gripper_tcp"
    for q in np.random.default_rng(3).uniform(arm.lower, arm.upper, (50, 6)):
        found = arm.ik_branches(arm.fk(q))
        assert found.complete
        turns = np.angle(np.exp(1j * (found.solutions - q)))
        assert np.abs(turns).max(axis=1).min() < 1e-3
    checker = mg.CollisionChecker(robot, mg.World(), arm)
    for state in robot.group_states["arm"].values():
        assert checker.is_free([state[joint] for joint in arm.names])


@pytest.mark.parametrize("name", DH)
def test_check_finds_nothing_to_complain_about(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    folder = ASSETS / "robots" / name
    assert main(["check", str(folder / f"{name}.urdf"), "--srdf", str(folder / f"{name}.srdf")]) == 0
    out = capsys.readouterr().out
    assert "can be planned for" in out
    assert "warning" not in out


@pytest.mark.parametrize("name", DH)
def test_pairs_left_out_never_touch(name: str) -> None:
    """With all pairs but adjacent ones checked, the same configurations are free."""
    robot = load(name)
    adjacent = [pair for pair in robot.disabled_pairs if "adjacent" in str(pair[2]).lower()]
    everything = robot.with_disabled_pairs(adjacent)
    assert len(adjacent) < len(robot.disabled_pairs)
    arm = robot.group("arm")
    Q = np.random.default_rng(4).uniform(arm.lower, arm.upper, (5000, 6))
    kept = mg.CollisionChecker(robot, mg.World(), arm).are_free(Q)
    full = mg.CollisionChecker(everything, mg.World(), everything.group("arm")).are_free(Q)
    assert 0.5 < kept.mean() < 0.95
    np.testing.assert_array_equal(kept, full)


def test_pipe_and_grasps_in_python() -> None:
    pipe = mg.grasping.Pipe([[0.0, 0, 0], [0.3, 0, 0], [0.3, 0.2, 0]], [(0, 1), (1, 2)], 0.02)
    assert pipe.lengths == pytest.approx([0.3, 0.2])
    assert pipe.sections == [(0, 1), (1, 2)]
    np.testing.assert_allclose(pipe.centre_of_mass, [(0.3 * 0.15 + 0.2 * 0.3) / 0.5, 0.2 * 0.1 / 0.5, 0])
    assert [s.kind for s in pipe.shapes()] == ["capsule", "capsule"]
    assert [s.kind for s in pipe.shapes(flat_ends=True)] == ["cylinder", "cylinder", "sphere"]
    grasps = pipe.sample_grasps(100, seed=7)
    assert len(grasps) == 100
    again = pipe.sample_grasps(100, seed=7)
    assert all(np.array_equal(a.T_object_hand, b.T_object_hand) for a, b in zip(grasps, again, strict=True))
    one = grasps[0]
    at = one.provenance
    assert isinstance(at, mg.grasping.PipeProvenance)
    same = pipe.grasp(at.section, at.length, at.angle, at.flipped)
    np.testing.assert_array_equal(one.T_object_hand, same.T_object_hand)
    assert set(one.to_dict()["provenance"]) == {"sampler", "section", "length", "angle", "flipped"}
    hand = mg.Hand(
        "tool", approach=[0, 0, 1], closing=[1, 0, 0], max_opening=0.015, finger_depth=0.03, finger_width=0.02
    )
    assert pipe.sample_grasps(10, gripper=hand) == []
    assert len(pipe.sample_grasps(10, gripper=hand, max_opening=0.03)) == 10
    down = pipe.grasp(0, 0.1, math.pi, gripper=hand)
    np.testing.assert_allclose(down.T_object_hand[:3, 2], [0, 0, -1], atol=1e-12)


@pytest.mark.parametrize(
    ("nodes", "sections", "diameters", "message"),
    [
        ([[0, 0, 0], [1, 0, 0]], [(0, 2)], 0.02, r"sections\[0\] = \(0, 2\)"),
        ([[0, 0, 0], [1, 0, 0]], [(0, 1)], [0.02, 0.02], "diameters = 2 values"),
        ([[0, 0, 0], [1, 0, 0]], [(0, 1)], -0.02, r"diameters\[0\] = -0.02"),
        ([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [(0, 1)], 0.02, r"nodes\[2\]"),
        ([[0, 0, 0], [1, 0, np.nan]], [(0, 1)], 0.02, "nodes"),
        ([[0, 0], [1, 0]], [(0, 1)], 0.02, "nodes"),
        ([[0, 0, 0], [1, 0, 0]], [0, 1], 0.02, r"sections = \[0, 1\]: must be a list of pairs of whole numbers"),
        ([[0, 0, 0], [1, 0, 0]], [(0, 1)], "thick", "diameters = 'thick': must be a number or a list of numbers"),
    ],
)
def test_bad_pipes_are_refused(nodes: Any, sections: Any, diameters: Any, message: str) -> None:
    with pytest.raises(mg.InvalidInput, match=message):
        mg.grasping.Pipe(nodes, sections, diameters)


def test_bad_grasp_arguments_are_refused() -> None:
    pipe = mg.grasping.Pipe([[0.0, 0, 0], [0.3, 0, 0]], [(0, 1)], 0.02)
    with pytest.raises(mg.InvalidInput, match="count = -1"):
        pipe.sample_grasps(-1)
    with pytest.raises(mg.InvalidInput, match=r"count = 2\.5: must be a whole number"):
        pipe.sample_grasps(2.5)  # type: ignore[arg-type]
    hand: Any = "hand"
    with pytest.raises(mg.InvalidInput, match="gripper = 'hand': must be a Hand"):
        pipe.sample_grasps(1, gripper=hand)
    with pytest.raises(mg.InvalidInput, match="gripper = 'hand': must be a Hand"):
        pipe.grasp(0, 0.1, 0.0, gripper=hand)
    with pytest.raises(mg.InvalidInput, match=r"lenght_spacing.*length_spacing"):
        pipe.sample_grasps(1, lenght_spacing=0.02)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match="section = 1"):
        pipe.grasp(1, 0.1, 0.0)
    with pytest.raises(mg.InvalidInput, match=r"length = 0\.4"):
        pipe.grasp(0, 0.4, 0.0)
