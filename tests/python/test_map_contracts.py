"""Contracts of models of depth sensors, and of maps as obstacles: each must keep the same, whichever it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at

CAMERA = mg.mapping.PinholeCamera(width=160, height=120, fx=150.0, fy=150.0, cx=79.5, cy=59.5, farthest=3.0)
NOISES: dict[str, mg.mapping.DepthNoise] = {
    "constant": mg.mapping.DepthNoise(constant=0.002),
    "linear": mg.mapping.DepthNoise(constant=0.0005, linear=0.001),
    "quadratic": mg.mapping.DepthNoise(constant=0.0005, quadratic=0.002),
    "slanted": mg.mapping.DepthNoise(constant=0.001, slant=0.0001, slant_power=1.5),
    "stereo": mg.mapping.DepthNoise.stereo(600.0, 0.1, 0.1),
    "structured light": mg.mapping.DepthNoise.structured_light(),
    "time of flight": mg.mapping.DepthNoise.time_of_flight(),
}
WALL = 0.8  # in front of the camera [m]
FRAMES = 4
VOXEL = 0.008  # [m]; the wall is a whole number of them away


def frame(shapes: list[mg.LinkShape], eye: np.ndarray, target: np.ndarray) -> mg.mapping.DepthImage:
    return mg.mapping.render_depth(shapes, CAMERA, look_at(eye, target))


def sigma_of_a_wall(noise: mg.mapping.DepthNoise, image_of_sigmas: bool) -> np.ndarray:
    """What a map of four frames says of a wall that is seen straight on, in front of the camera [m]."""
    wall = mg.LinkShape(mg.Box([0.1, 2.0, 2.0]), mg.pose([WALL + 0.05, 0, 0]))
    seen = frame([wall], np.zeros(3), np.array([1.0, 0, 0]))
    sdf = mg.ProbabilisticSdf(voxel=VOXEL, truncation=5 * VOXEL)
    for _ in range(FRAMES):
        if image_of_sigmas:
            depths = np.asarray(seen.depth, float)
            sigmas = np.array([noise.sigma(float(z)) if z > 0 else 1.0 for z in depths.ravel()]).reshape(depths.shape)
            sdf.integrate(seen, mg.mapping.DepthCamera(CAMERA, mg.mapping.DepthNoise(constant=1.0)), sigma=sigmas)
        else:
            sdf.integrate(seen, mg.mapping.DepthCamera(CAMERA, noise))
    steps = VOXEL * np.arange(-4, 5)  # at voxels: in between errors that are the pixels' own partly cancel
    places = np.array([[WALL, y, z] for y in steps for z in steps])
    mean, sigma, known = sdf.query(places)
    assert known.all()
    assert np.abs(mean).max() < 1e-4
    return np.asarray(sigma)


@pytest.mark.parametrize("image_of_sigmas", [False, True], ids=["model", "image of sigmas"])
@pytest.mark.parametrize("name", NOISES)
def test_frames_of_a_wall_are_worth_the_root_of_their_number(name: str, image_of_sigmas: bool) -> None:
    """Independent frames: sigma(z) / 2 after four, for the model and for an image of what it says."""
    expected = NOISES[name].sigma(WALL) / np.sqrt(FRAMES)
    assert sigma_of_a_wall(NOISES[name], image_of_sigmas) == pytest.approx(expected, rel=0.05)


@pytest.mark.parametrize("name", NOISES)
def test_no_model_is_surer_of_what_is_slanted(name: str) -> None:
    for depth in np.linspace(0.3, 3.0, 28):
        sigmas = [NOISES[name].sigma(float(depth), float(angle)) for angle in np.linspace(0, 1.5, 31)]
        assert min(sigmas) > 0
        assert np.isfinite(sigmas).all()
        assert (np.diff(sigmas) >= 0).all()


# --- maps as obstacles ------------------------------------------------------------------------------------------------
SIDE = 0.2  # of the box, around the origin [m]
CELL = 0.01
BALL = 0.02
XYZ = (
    "<robot name='ball'><link name='base'/>"
    + "".join(
        f"<link name='{link}'/><joint name='{axis}' type='prismatic'><parent link='{parent}'/><child link='{link}'/><axis xyz='{direction}'/>"
        "<limit lower='-2' upper='2' velocity='1' effort='1'/></joint>"
        for axis, parent, link, direction in (("x", "base", "a", "1 0 0"), ("y", "a", "b", "0 1 0"))
    )
    + f"<link name='ball'><collision><geometry><sphere radius='{BALL}'/></geometry></collision></link>"
    "<joint name='z' type='prismatic'><parent link='b'/><child link='ball'/><axis xyz='0 0 1'/><limit lower='-2' upper='2' velocity='1' effort='1'/>"
    "</joint></robot>"
)


def frames_around() -> list[mg.mapping.DepthImage]:
    """A box from all around, from above and from below."""
    box = [mg.LinkShape(mg.Box([SIDE] * 3))]
    turns = [(turn, up) for up in (-0.7, 0.0, 0.7) for turn in np.arange(0, 2 * np.pi, np.pi / 6)]
    eyes = [0.6 * np.array([np.cos(t) * np.cos(u), np.sin(t) * np.cos(u), np.sin(u)]) for t, u in turns]
    return [frame(box, eye, np.zeros(3)) for eye in eyes]


def ball_in(world: mg.World) -> mg.CollisionChecker:
    """Its configuration is the ball's place."""
    robot = mg.Robot.from_strings(XYZ)
    return mg.CollisionChecker(robot, world, robot.group(base_link="base", tip="ball"))


def as_sdf(world: mg.World, name: str, folder: Path, pose: np.ndarray | None) -> None:
    sdf = mg.ProbabilisticSdf(voxel=CELL, truncation=0.04)
    for image in frames_around():
        sdf.integrate(image, mg.mapping.DepthCamera(CAMERA, mg.mapping.DepthNoise(constant=0.001)))
    world.add_sdf(name, sdf, pose=pose)


def occupancy() -> mg.mapping.OccupancyMap:
    found = mg.mapping.OccupancyMap(resolution=CELL)
    for image in frames_around():
        found.integrate(image, mg.mapping.DepthCamera(CAMERA, mg.mapping.DepthNoise(constant=0.001)))
    return found


def as_occupancy(world: mg.World, name: str, folder: Path, pose: np.ndarray | None) -> None:
    world.add_occupancy(name, occupancy(), pose=pose)


def as_octree(world: mg.World, name: str, folder: Path, pose: np.ndarray | None) -> None:
    occupancy().save(folder / "map.bt")
    world.add_octree(name, folder / "map.bt", pose)


def as_points(world: mg.World, name: str, folder: Path, pose: np.ndarray | None) -> None:
    world.add_points(name, np.concatenate([image.points() for image in frames_around()]), CELL, pose)


SOURCES: dict[str, Callable[[mg.World, str, Path, np.ndarray | None], None]] = {
    "sdf": as_sdf,
    "occupancy": as_occupancy,
    "octree file": as_octree,
    "points": as_points,
}


def to_surface(points: np.ndarray) -> np.ndarray:
    """Signed distance of the box [m]."""
    q = np.abs(points) - SIDE / 2
    return np.asarray(np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0))


@pytest.mark.parametrize("name", SOURCES)
@pytest.mark.parametrize("shift", [0.0, 0.7])
def test_maps_stand_where_the_body_does(name: str, shift: float, tmp_path: Path) -> None:
    """No ball through the surface is free, every ball farther than a few cells from it is; distances agree by as much."""
    world = mg.World()
    moved = np.array([shift, -shift / 2, 0.0])
    SOURCES[name](world, "map", tmp_path, mg.pose(moved) if shift else None)
    checker = ball_in(world)
    rng = np.random.default_rng(1)
    points = rng.uniform(-0.3, 0.3, (2000, 3))
    distance = to_surface(points)
    free = np.array([checker.is_free(q) for q in points + moved])
    crossing = np.abs(distance) < 0.7 * BALL
    away = distance > BALL + 3 * CELL
    assert crossing.sum() > 50
    assert away.sum() > 500
    assert not free[crossing].any()
    assert free[away].all()
    for q, true in list(zip(points + moved, distance, strict=True))[:200]:
        if true > BALL + 3 * CELL:
            assert abs(checker.distance(q).value - (true - BALL)) < 3 * CELL


@pytest.mark.parametrize("name", SOURCES)
def test_maps_have_names_of_their_own_and_can_be_taken_away(name: str, tmp_path: Path) -> None:
    world = mg.World()
    SOURCES[name](world, "map", tmp_path, None)
    assert not ball_in(world).is_free([SIDE / 2, 0, 0])
    with pytest.raises(mg.InvalidInput, match="map"):
        SOURCES[name](world, "map", tmp_path, None)
    world.remove("map")
    assert ball_in(world).is_free([SIDE / 2, 0, 0])
