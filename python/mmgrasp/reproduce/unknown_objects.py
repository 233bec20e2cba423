"""Ten unknown objects on a table before a robot, seen by two noisy cameras: one attempt of P3 table 4.1 for each of several ways to choose a grasp."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np

from .. import _core
from .._core import Box, Capsule, Cylinder, Grasp, LinkShape, Sphere
from . import height_features
from .grasp_success import looking_at

FRICTION = 0.5  # of fingers on objects, in physics and in the model
FORCE = 40.0  # of each finger [N]
ROUGH_FRICTION, ROUGH_FORCE = (0.15, 0.5), 15.0
ROUGH_HAND = (0.004, 0.05)  # error of the hand's place along x and y and about the vertical [m, rad]
NOISES = {"hand": (0.0005, 0.002), "mast": (0.001, 0.006)}  # sigma = constant + quadratic z^2 [m, 1/m]
POSE_ERROR = (0.001, 0.003)  # of each frame along and about each axis [m, rad]
# The side walls of low parts are seen under a slant alone from cameras that look down on a table; this noise does not grow with it.
MAX_INCIDENCE = 1.3
VIEWS = 10
BASELINES = ("mean only", "one view", "from above", "height features")
WAYS = ("ours", "at defaults", *BASELINES)
DRAWS = 200
SAMPLES = 600
DEFAULT_INCIDENCE = _core._sdf_option_table()["max_incidence"][0]
DEFAULT_SAMPLES = _core._synthesis_option_table()["samples"][0]
CAUTIOUS = (2.0, 1.0, 0.0)  # standard deviations of the surface kept free around the hand, tried in turn
_EXTRA = 2  # grasps of the list tried besides the best, for the calibration


def _at(shape: Any, x: float, y: float, z: float, *rpy: float) -> LinkShape:
    return LinkShape(shape, _core.pose([x, y, z], rpy=list(rpy) or [0, 0, 0]))


LYING = (0.0, np.pi / 2, 0.0)  # along x
OBJECTS: dict[str, tuple[float, list[LinkShape]]] = {
    "box": (0.25, [_at(Box([0.045, 0.07, 0.06]), 0, 0, 0.03)]),
    "can": (0.35, [_at(Cylinder(0.033, 0.10), 0, 0, 0.05)]),
    "ball": (0.06, [_at(Sphere(0.033), 0, 0, 0.033)]),
    "duck": (0.10, [_at(Capsule(0.028, 0.03), 0, 0, 0.028, *LYING), _at(Sphere(0.021), 0.028, 0, 0.063)]),
    "stapler": (0.20, [_at(Box([0.13, 0.035, 0.012]), 0, 0, 0.006), _at(Box([0.12, 0.025, 0.03]), 0.005, 0, 0.027)]),
    "toy car": (0.15, [_at(Box([0.10, 0.045, 0.025]), 0, 0, 0.0125), _at(Box([0.05, 0.04, 0.025]), -0.01, 0, 0.0375)]),
    "screwdriver": (
        0.10,
        [_at(Capsule(0.014, 0.07), -0.05, 0, 0.014, *LYING), _at(Cylinder(0.005, 0.09), 0.045, 0, 0.014, *LYING)],
    ),
    "bottle": (0.30, [_at(Cylinder(0.028, 0.10), 0, 0, 0.05), _at(Cylinder(0.013, 0.04), 0, 0, 0.12)]),
    "mallet": (
        0.35,
        [_at(Box([0.15, 0.022, 0.022]), 0.02, 0, 0.011), _at(Box([0.035, 0.07, 0.045]), -0.07, 0, 0.0225)],
    ),
    "joystick": (
        0.20,
        [
            _at(Box([0.07, 0.06, 0.03]), 0, 0, 0.02),
            _at(Capsule(0.018, 0.06), -0.01, 0.055, 0.018, *LYING),
            _at(Capsule(0.018, 0.06), -0.01, -0.055, 0.018, *LYING),
        ],
    ),
}


def attempt(name: str, number: int, seed: int, rough: bool = False) -> dict[str, Any]:
    """One object at a drawn place: frames, map, a grasp for each way, and what physics made of it; `rough`: with friction, gripping
    force and the hand's place otherwise than the model has them, for all grasps of the attempt alike.
    """
    from ..sim.pick_trial import PLACE, TABLE

    rng = np.random.default_rng([seed, list(OBJECTS).index(name), number])
    mass, shapes = OBJECTS[name]
    place = [PLACE[0] + rng.uniform(-0.05, 0.05), PLACE[1] + rng.uniform(-0.08, 0.08), TABLE + 0.0005]
    T = _core.pose(place, rpy=[0, 0, rng.uniform(-np.pi, np.pi)])
    scene = [LinkShape(_core.Plane([0, 0, 1], TABLE)), *(LinkShape(s.shape, T @ s.pose) for s in shapes)]
    frames = [_frame(scene, np.array(place), k, rng) for k in range(VIEWS)]
    full, single, usual = _map(frames), _map(frames[:1]), _map(frames, max_incidence=DEFAULT_INCIDENCE)
    hand = _hand()
    search = functools.partial(
        _core.synthesize_grasps,
        hand=hand,
        table=TABLE,
        friction=FRICTION,
        samples=SAMPLES,
        max_grasps=40,
        seed=number + 1,
        threads=1,
    )
    rated, sigmas = _most_cautious(functools.partial(search, full, surface_draws=DRAWS))
    mean_only = search(
        full,
        sigmas=0.0,
        max_sigma=1.0,
        certainty_weight=0.0,
        angle_weight=1 - 1 / 9 - 2 / 9,
        placement_weight=1 / 9,
        centring_weight=2 / 9,
    )
    above = _above(scene, np.array(place), rng)
    lists = {
        "ours": list(zip(rated.grasps, (r.pretouch_opening for r in rated.ratings), strict=True)),
        "at defaults": _found(_most_cautious(functools.partial(search, usual, samples=DEFAULT_SAMPLES))[0]),
        "mean only": _found(mean_only),
        "one view": _found(search(single)),
        "from above": _from_above(*above, hand),
        "height features": _by_height_features(above[1], hand),
    }
    from ..sim.model import Physics

    physics, T_true = Physics(finger_friction=FRICTION, grip_force=FORCE), T
    if rough:
        own = np.random.default_rng([seed, list(OBJECTS).index(name), number, 1])
        physics = Physics(finger_friction=float(own.uniform(*ROUGH_FRICTION)), grip_force=ROUGH_FORCE)
        aside = ROUGH_HAND[0] * own.standard_normal(
            2
        )  # of the hand against the part: the part stands so much elsewhere
        T_true = (
            _core.pose([*aside, 0.0]) @ T @ _core.pose([0, 0, 0], rpy=[0, 0, ROUGH_HAND[1] * own.standard_normal()])
        )
    out: dict[str, Any] = {"object": name, "sigmas": sigmas, "ways": {}, "calibration": []}
    for way, grasps in lists.items():
        tried = _try_first(grasps, shapes, T_true, mass, physics)
        out["ways"][way] = tried or {"success": False, "precise": False, "moved": None, "turned": None, "index": None}
    chosen = out["ways"]["ours"]["index"]
    rest = [k for k in range(len(rated.grasps)) if k != chosen]
    wanted = [(chosen, out["ways"]["ours"])] if chosen is not None else []
    for k in rng.permutation(rest)[:_EXTRA] if rest else []:
        again = _try_first([lists["ours"][k]], shapes, T_true, mass, physics)
        if again:
            wanted.append((int(k), again))
    for k, result in wanted:
        drawn = rated.ratings[k].drawn
        assert drawn is not None
        out["calibration"].append(
            {
                "weighted": rated.ratings[k].success.probability,
                "drawn": drawn.probability,
                "holds": drawn.holds,
                "success": result["success"],
                "precise": result["precise"],
            }
        )
    return out


def _hand() -> _core.Hand:
    from ..sim.pick_trial import robot_setup

    return robot_setup().gripper


def _frame(scene: list[LinkShape], target: np.ndarray, k: int, rng: np.random.Generator) -> dict[str, Any]:
    """A frame of one of the two cameras in turn, from around."""
    turn, up = 2.4 * k + rng.uniform(-0.4, 0.4), np.radians(rng.uniform(30, 65))
    eye = target + [0, 0, 0.03] + 0.42 * np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
    return _seen(scene, looking_at(eye, target + [0, 0, 0.03]), list(NOISES)[k % 2], rng)


def _seen(scene: list[LinkShape], T: np.ndarray, camera: str, rng: np.random.Generator) -> dict[str, Any]:
    """Noise in every depth, and an error of the pose that nobody knows."""
    constant, quadratic = NOISES[camera]
    intrinsics = _core.PinholeCamera(width=240, height=180, fx=260.0, fy=260.0, cx=119.5, cy=89.5)
    depth = np.array(_core.render_depth(scene, intrinsics, T).depth, dtype=float)
    seen = depth > 0
    depth[seen] += (constant + quadratic * depth[seen] ** 2) * rng.standard_normal(int(seen.sum()))
    error = _core.pose(POSE_ERROR[0] * rng.standard_normal(3), rpy=POSE_ERROR[1] * rng.standard_normal(3))
    noise = _core.DepthNoise(constant=constant, quadratic=quadratic)
    image = _core.DepthImage(np.maximum(depth, 0), intrinsics, T @ error)
    return {"image": image, "camera": _core.DepthCamera(intrinsics, noise, camera)}


def _most_cautious(search: Callable[..., _core.GraspSynthesis]) -> tuple[_core.GraspSynthesis, float]:
    """The first search that leaves a grasp, or the last; as `mmgrasp grasp` does."""
    for sigmas in CAUTIOUS:
        found = search(sigmas=sigmas)
        if found.grasps:
            break
    return found, sigmas


def _map(frames: list[dict[str, Any]], max_incidence: float = MAX_INCIDENCE) -> _core.ProbabilisticSdf:
    sdf = _core.ProbabilisticSdf(voxel=0.0025, truncation=0.0125, max_incidence=max_incidence, threads=1)
    covariance = np.diag([POSE_ERROR[0] ** 2] * 3 + [POSE_ERROR[1] ** 2] * 3)
    for frame in frames:
        sdf.integrate(frame["image"], frame["camera"], pose_covariance=covariance)
    return sdf


def _found(found: _core.GraspSynthesis) -> list[tuple[Grasp, float]]:
    return list(zip(found.grasps, (r.pretouch_opening for r in found.ratings), strict=True))


def _above(
    scene: list[LinkShape], target: np.ndarray, rng: np.random.Generator
) -> tuple[_core.DepthImage, _core.HeightMap]:
    """One frame of the better camera from above, and its heights over the table."""
    image = _seen(scene, _core.look_down(target + [0, 0, 0.45]), "hand", rng)["image"]
    at = _core.pose([target[0], target[1], target[2]])
    return image, _core.make_height_map(image, at, [0.34, 0.26], resolution=0.002)


def _from_above(image: _core.DepthImage, heights: _core.HeightMap, hand: _core.Hand) -> list[tuple[Grasp, float]]:
    """P1 3.7.2's graspability."""
    found = _core.evaluate_graspability(heights, hand, image=image, threads=1)
    return [(grasp, hand.pregrasp_opening(grasp.opening)) for grasp in found.grasps]


@functools.cache
def _machine() -> height_features.Machine:
    return height_features.trained(_hand(), FRICTION)


def _by_height_features(heights: _core.HeightMap, hand: _core.Hand) -> list[tuple[Grasp, float]]:
    """P3's baseline, with a machine of our own; the hand comes wide open."""
    grasps = height_features.choose(heights, hand, _machine())
    T = np.array(heights.T_world_map)
    return [(Grasp(T @ g.T_object_hand, g.opening, quality=g.quality), hand.max_opening) for g in grasps]


def _try_first(
    grasps: list[tuple[Grasp, float]], shapes: list[LinkShape], T: np.ndarray, mass: float, physics: Any
) -> dict[str, Any] | None:
    """The first that the arm can carry out, in physics; None: it can none."""
    from ..sim.pick_trial import arm_way, try_grasp

    for index, (grasp, opening) in enumerate(grasps):
        way = arm_way(grasp)
        if way is None:
            continue
        found = try_grasp(shapes, T, mass, way, opening, physics)
        return {**vars(found), "index": index}
    return None
