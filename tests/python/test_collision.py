"""Collision from Python: worlds, answers with names, distances with gradients, edges, batches, and what is refused."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS


@pytest.fixture(scope="module")
def robot() -> mg.Robot:
    folder = ASSETS / "robots" / "fetchlike"
    return mg.Robot.load(folder / "fetchlike.urdf", folder / "fetchlike.srdf")


@pytest.fixture(scope="module")
def arm(robot: mg.Robot) -> mg.robot.JointGroup:
    return robot.group("arm_with_torso", tip="gripper_tcp")


@pytest.fixture(scope="module")
def world() -> mg.World:
    world = mg.World()
    world.add_box("table", (0.6, 1.4, 0.05), mg.pose([0.9, 0, 0.7]))
    world.add_cylinder("post", 0.05, 1.6, mg.pose([0.5, 0.6, 0.8]))
    world.add_sphere("lamp", 0.1, mg.pose([0.7, -0.2, 1.5]))
    return world


@pytest.fixture
def checker(robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World) -> mg.CollisionChecker:
    return mg.CollisionChecker(robot, world, group=arm)


@pytest.fixture(scope="module")
def draws(arm: mg.robot.JointGroup) -> np.ndarray:
    lower, upper = np.maximum(arm.lower, -np.pi), np.minimum(arm.upper, np.pi)
    return np.random.default_rng(1).uniform(lower, upper, (300, len(arm.names)))


def test_answers_fit_together(checker: mg.CollisionChecker, draws: np.ndarray) -> None:
    scene = own = free = 0
    for q in draws:
        contacts, first, nearest = checker.contacts(q), checker.first_contact(q), checker.distance(q)
        assert checker.is_free(q) == (not contacts) == (first is None) == (nearest.value > 0)
        assert (nearest.gradient is None) and np.isfinite(nearest.value)
        if first is None:
            free += 1
            continue
        assert (first.a, first.b) in [(c.a, c.b) for c in contacts]
        assert checker.rejection(q) == (
            mg.planning.Rejection.self_collision if not first.with_scene else mg.planning.Rejection.scene
        )
        assert (first.b in checker_world_names(checker)) == first.with_scene
        assert first.a in repr(first) and first.b in repr(first)
        scene += first.with_scene
        own += not first.with_scene
    assert free > 50 and scene > 20 and own > 20


def checker_world_names(checker: mg.CollisionChecker) -> list[str]:
    return ["table", "post", "lamp"]


def test_gradient_is_the_difference(checker: mg.CollisionChecker, draws: np.ndarray) -> None:
    compared = 0
    for q in draws[:60]:
        nearest = checker.distance(q, gradient=True)
        assert nearest.gradient.shape == q.shape
        assert nearest.to_dict()["gradient"] == nearest.gradient.tolist()
        h = 1e-6
        steps = h * np.eye(len(q))
        ahead = np.array([checker.distance(q + s).value for s in steps])
        back = np.array([checker.distance(q - s).value for s in steps])
        if np.abs(ahead + back - 2 * nearest.value).max() > 1e-3 * h:
            continue  # the closest points jump
        np.testing.assert_allclose(nearest.gradient, (ahead - back) / (2 * h), atol=2e-3)
        compared += 1
    assert compared > 40


def test_near_pairs(checker: mg.CollisionChecker, draws: np.ndarray) -> None:
    for q in draws[:40]:
        pairs = checker.distances(q, within=0.3)
        values = [p.value for p in pairs]
        assert values == sorted(values) and all(v < 0.3 for v in values)
        assert len({(p.a, p.b) for p in pairs}) == len(pairs)
        nearest = checker.distance(q)
        if nearest.value < 0.3:
            assert values[0] == pytest.approx(nearest.value, abs=1e-12)
        assert {(p.a, p.b) for p in pairs if p.value <= 0} == {(c.a, c.b) for c in checker.contacts(q)}


def test_batch_is_the_loop(checker: mg.CollisionChecker, draws: np.ndarray) -> None:
    expected = [checker.is_free(q) for q in draws]
    for threads in (1, 2, 0):
        free = checker.are_free(draws, threads=threads)
        assert free.dtype == bool and free.tolist() == expected
    assert checker.are_free(np.empty((0, draws.shape[1]))).shape == (0,)


def test_edges_say_what_refuses_them(
    robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World, checker: mg.CollisionChecker, draws: np.ndarray
) -> None:
    free = refused = 0
    for q0, q1 in zip(draws[:150], draws[150:], strict=True):
        if not checker.is_free(q0):
            continue
        q1 = q0 + 0.1 * (q1 - q0)
        stepped, gliding = checker.check_edge(q0, q1, joint_step=0.01), checker.check_edge(q0, q1, continuous=True)
        assert bool(stepped) == stepped.free == checker.edge_is_free(q0, q1, 0.01)
        if gliding:  # nothing in between can touch
            assert stepped and gliding.fraction == 1 and gliding.contact is None and gliding.checks >= 1
            free += 1
            continue
        refused += 1
        assert 0 <= gliding.fraction <= 1 and gliding.contact is not None and gliding.contact.a in repr(gliding)
        assert checker.distance(q0 + gliding.fraction * (q1 - q0)).value <= 1e-4
        if not stepped:
            assert stepped.contact is not None and stepped.fraction >= gliding.fraction - 1e-9
            assert stepped.to_dict()["contact"]["a"] == stepped.contact.a
    assert free > 30 and refused > 5
    bounds = checker.motion_bounds
    assert bounds.shape == (len(arm.names),) and (bounds > 0).all()
    with pytest.raises(mg.InvalidInput, match="did you mean"):
        checker.check_edge(draws[0], draws[1], joint_stepp=0.1)  # type: ignore[call-arg]
    with pytest.raises(mg.InvalidInput, match=r"tolerance = 0.*must be positive and finite"):
        checker.check_edge(draws[0], draws[1], tolerance=0.0)


def test_padding_is_a_margin(robot: mg.Robot, arm: mg.robot.JointGroup, world: mg.World, draws: np.ndarray) -> None:
    padded = mg.CollisionChecker(robot, world, group=arm, padding=0.05, check_self=False)
    plain = mg.CollisionChecker(robot, world, group=arm, check_self=False)
    between = 0
    for q in draws:
        value = plain.distance(q).value
        assert padded.distance(q).value == pytest.approx(value, abs=1e-12), "distances do not subtract it"
        if value < 0.05:
            assert not padded.is_free(q)
            between += value > 0
        if value > 0.05 * np.sqrt(3):  # padding pushes a box's corners out by that
            assert padded.is_free(q)
    assert between > 5


def test_attach_detach_remove(robot: mg.Robot, arm: mg.robot.JointGroup) -> None:
    world = mg.World()
    world.add_box("part", (0.05, 0.05, 0.2), mg.pose([0.8, 0, 0.8]))
    world.attach("part", "gripper_link", mg.pose([0.1, 0, 0]))
    assert world.attached == ["part"] and world.objects == [] and "part" in world
    q = np.zeros(len(arm.names))
    held = mg.CollisionChecker(robot, world, group=arm)
    names = {p.a for p in held.distances(q, 2.0)} | {p.b for p in held.distances(q, 2.0)}
    assert "part" in names
    world.detach("part", mg.pose([0, 0, 3]))
    assert world.attached == [] and world.objects == ["part"]
    np.testing.assert_allclose(world.pose_of("part")[:3, 3], [0, 0, 3])
    far = mg.CollisionChecker(robot, world, group=arm, check_self=False).distance(q)
    assert far.b == "part" and far.with_scene
    world.remove("part")
    assert "part" not in world
    none = mg.CollisionChecker(robot, world, group=arm, check_self=False).distance(q, gradient=True)
    assert none.value == np.inf and not none.gradient.any()
    calls: list[Callable[[], Any]] = [
        lambda: world.remove("part"),
        lambda: world.detach("part"),
        lambda: world.attach("part", "x"),
    ]
    for call in calls:
        with pytest.raises(mg.InvalidInput, match="part"):
            call()
    world.add_box("part", (0.05, 0.05, 0.2))
    world.attach("part", "no_such_link")
    with pytest.raises(mg.InvalidInput, match="no_such_link"):
        mg.CollisionChecker(robot, world, group=arm)


def test_points_and_octrees(robot: mg.Robot, arm: mg.robot.JointGroup, data: Path) -> None:
    world = mg.World()
    grid = np.arange(-0.5, 0.5, 0.005)
    wall = np.array([[0.605, y, z] for y in grid for z in grid + 0.8])
    world.add_points("scan", wall, resolution=0.01)
    box = mg.World()  # the same wall as one box: cells of 10 mm whose outer face is at 0.60
    box.add_box("scan", (0.01, 1.0, 1.0), mg.pose([0.605, 0, 0.8]))
    cells = mg.CollisionChecker(robot, world, group=arm, check_self=False)
    plate = mg.CollisionChecker(robot, box, group=arm, check_self=False)
    rng = np.random.default_rng(2)
    hits = 0
    for _ in range(200):
        q = rng.uniform(np.maximum(arm.lower, -np.pi), np.minimum(arm.upper, np.pi))
        expected = plate.distance(q).value
        if abs(expected) > 1e-6:
            assert cells.is_free(q) == plate.is_free(q)
        if expected > 0:
            assert cells.distance(q).value == pytest.approx(expected, abs=1e-9)
        hits += expected < 0
    assert 10 < hits < 190
    world.add_octree("map", data / "clouds/octomap/geb079.bt", mg.pose([0, 0, -5]))
    assert set(world.objects) == {"scan", "map"}
    with pytest.raises(mg.IoError, match=r"nothing\.bt"):
        world.add_octree("other", "nothing.bt")
    with pytest.raises(mg.InvalidInput, match=r"points has shape \(5, 2\): must be \(m, 3\)"):
        world.add_points("flat", np.zeros((5, 2)), resolution=0.1)
    with pytest.raises(mg.InvalidInput, match="resolution"):
        world.add_points("flat", np.zeros((5, 3)), resolution=0.0)
    with pytest.raises(mg.InvalidInput, match=r"points holds 1e\+09 .*within 1e\+06"):
        world.add_points("flat", np.full((5, 3), 1e9), resolution=1e-9)


@pytest.mark.parametrize(
    "ask",
    ["is_free", "rejection", "contacts", "first_contact", "distance", "distances", "edge_is_free", "check_edge"],
)
def test_wrong_configurations_are_refused(checker: mg.CollisionChecker, draws: np.ndarray, ask: str) -> None:
    more = {"distances": (0.1,), "edge_is_free": (draws[1],), "check_edge": (draws[1],)}.get(ask, ())
    question = getattr(checker, ask)
    n = draws.shape[1]
    with pytest.raises(mg.InvalidInput, match=rf"shape \({n - 1},\).*\({n},\)"):
        question(draws[0][:-1], *more)
    for bad in (np.nan, np.inf):
        q = draws[0].copy()
        q[2] = bad
        with pytest.raises(mg.InvalidInput, match="entry 2"):
            question(q, *more)


def test_wrong_batches_are_refused(checker: mg.CollisionChecker, draws: np.ndarray) -> None:
    n = draws.shape[1]
    with pytest.raises(mg.InvalidInput, match=rf"Q has shape \(300, {n - 1}\): must be \(m, {n}\)"):
        checker.are_free(draws[:, :-1])
    bad = draws.copy()
    bad[7, 3] = np.nan
    with pytest.raises(mg.InvalidInput, match=r"Q holds nan at entry \(7, 3\)"):
        checker.are_free(bad)
    with pytest.raises(mg.InvalidInput, match="within"):
        checker.distances(draws[0], -1.0)
    for scan in (np.array([[0.0, np.nan, 0.0]]), np.array([[0.0, np.inf, 0.0]])):
        with pytest.raises(mg.InvalidInput, match=r"points holds (nan|inf) at entry \(0, 1\)"):
            mg.World().add_points("scan", scan, resolution=0.1)


def box_grid(half: tuple[float, float, float], spacing: float) -> mg.collision.GridDistanceField:
    """Signed distances from a box, at grid points within 0.5 m."""
    at = np.arange(-0.5, 0.5 + spacing / 2, spacing)
    points = np.stack(np.meshgrid(at, at, at, indexing="ij"), axis=-1)
    off = np.abs(points) - half
    values = np.linalg.norm(np.maximum(off, 0), axis=-1) + np.minimum(off.max(axis=-1), 0)
    return mg.collision.GridDistanceField(values, [-0.5] * 3, spacing)


def test_a_grid_of_distances_is_an_obstacle() -> None:
    half = (0.1, 0.2, 0.05)
    field = box_grid(half, 0.02)
    assert field.error == pytest.approx(0.02 * 3**0.5 / 2)
    np.testing.assert_allclose(field.domain, [[-0.5] * 3, [0.5] * 3])
    np.testing.assert_allclose(field.distances(np.array([[0.3, 0, 0], [0, 0, 0]])), [0.2, -0.05], atol=1e-9)
    distances, gradients = field.distances_and_gradients(np.array([[0.3, 0, 0], [2, 0, 0]]))
    np.testing.assert_allclose(gradients, [[1, 0, 0], [0, 0, 0]], atol=1e-9)
    assert np.isnan(distances[1])

    urdf = """<robot name="slide"><link name="base"/><link name="ball"><collision><geometry><sphere radius="0.05"/>
      </geometry></collision></link><joint name="x" type="prismatic"><parent link="base"/><child link="ball"/>
      <axis xyz="1 0 0"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint></robot>"""
    robot = mg.Robot.from_strings(urdf)
    world = mg.World()
    world.add_field("map", field, unknown_is_free=True)
    assert world.fields == ["map"] and "map" in world
    checker = mg.CollisionChecker(robot, world, group=robot.group(base_link="base", tip="ball"))
    assert not checker.is_free([0.0])
    assert not checker.is_free([0.149])
    assert checker.is_free([0.15 + 2 * field.error + 0.0011])
    found = checker.distance([0.4])
    assert found.b == "map"
    assert 0.25 - 2 * field.error - 0.002 <= found.value <= 0.25
    assert checker.is_free([1.5])
    world.remove("map")
    world.add_field("map", field)  # what the grid does not know is an obstacle
    assert not mg.CollisionChecker(robot, world, group=checker.group).is_free([1.5])
    with pytest.raises(mg.InvalidInput, match="values"):
        mg.collision.GridDistanceField(np.zeros((3, 3)), [0, 0, 0], 0.1)
    with pytest.raises(mg.InvalidInput, match="spacing"):
        mg.collision.GridDistanceField(np.zeros((3, 3, 3)), [0, 0, 0], -0.1)
