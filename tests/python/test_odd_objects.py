"""Odd objects where calls expect plain ones: an answer as for the plain one, or one clear error, never a crash."""

from __future__ import annotations

import copy
import gc
import pickle
import re
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest

import mmgrasp as mg
from argument_calls import CALLS, callable_of, other_arguments
from argument_objects import ARM, BOX, OBJECTS, ROBOT, Q, cube, gripper, world
from number_tables import QUICK
from test_bad_arguments import ARGUMENTS, Argument, call, name_of, value_of

REFUSALS = (mg.Error, TypeError, ValueError)
SLOW = ("plan_pick", "plan_platform_locations", "plan_motion", "plan_object_pick", "plan_drive_by", "shorten_drive_by")


class Subclass(np.ndarray):
    pass


class WithArray:
    """What a table of another library looks like."""

    def __init__(self, array: np.ndarray) -> None:
        self.array = array

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return self.array if dtype is None else self.array.astype(dtype)


def strided(good: np.ndarray) -> np.ndarray:
    spread = np.zeros(tuple(3 * n for n in good.shape), good.dtype)
    places = tuple(slice(None, None, 3) for _ in good.shape)
    spread[places] = good
    return spread[places]


def frozen(good: np.ndarray) -> np.ndarray:
    out = good.copy()
    out.flags.writeable = False
    return out


SAME: dict[str, Callable[[np.ndarray], Any]] = {
    "strided": strided,
    "backwards": lambda good: good[::-1].copy()[::-1],
    "column-major": np.asfortranarray,
    "big-endian": lambda good: good.astype(good.dtype.newbyteorder(">")),
    "read-only": frozen,
    "a list": lambda good: good.tolist(),
    "tuples": lambda good: tuple(map(tuple, good)) if good.ndim == 2 else tuple(good.tolist()),
    "a subclass": lambda good: good.view(Subclass),
    "a table": WithArray,
    "extended precision": lambda good: good.astype(np.longdouble) if good.dtype == float else good.copy(),
    "unaligned": lambda good: np.frombuffer(b"\0" + good.tobytes(), good.dtype, offset=1).reshape(good.shape),
    "masked, nothing hidden": lambda good: np.ma.masked_array(good),
}
REFUSED: dict[str, Callable[[np.ndarray], Any]] = {
    "no rows": lambda good: np.zeros((0, 7, *good.shape)),
    "four dimensions": lambda good: np.zeros((1, 1, *good.shape, 1, 1)),
    "records": lambda good: np.zeros(good.shape, [("x", float)]),
    "bytes": lambda good: good.tobytes(),
    "a set": lambda good: set(good.ravel().tolist()),
    "a generator": lambda good: (x for x in good),
    "lists of words": lambda good: [["a"] * 3] * 3,
    "the class": lambda good: np.ndarray,
    "a robot": lambda good: ROBOT,
    "a function": lambda good: np.zeros,
}


def plain(answer: Any) -> Any:
    """Something to compare: arrays and numbers themselves, of objects their text without the address."""
    if isinstance(answer, tuple | list):
        return [plain(part) for part in answer]
    if isinstance(answer, dict):
        return {key: plain(part) for key, part in answer.items()}
    if isinstance(answer, np.ndarray | float | int | bool | str | None):
        return answer
    return re.sub(r" at 0x[0-9a-f]+", "", repr(answer))


@pytest.mark.parametrize("argument", [a for a in ARGUMENTS if a.function not in SLOW], ids=name_of)
def test_arrays_of_any_layout_are_arrays(argument: Argument) -> None:
    good = value_of(argument)
    expected = plain(call(argument, good))
    for what, make in SAME.items():
        np.testing.assert_equal(plain(call(argument, make(good))), expected, err_msg=what)


@pytest.mark.parametrize("argument", ARGUMENTS, ids=name_of)
def test_what_is_no_array_is_refused(argument: Argument) -> None:
    good = value_of(argument)
    for what, make in REFUSED.items():
        try:
            answer = call(argument, make(good))
        except REFUSALS:
            continue
        raise AssertionError(f"{what} was taken: {answer!r}")


class Stop(BaseException):
    pass


WITH_PROGRESS = sorted({c.function for c in CALLS if any(p.name == "progress" for p in c.parameters)})
RAISED = [
    ValueError("no"),
    KeyboardInterrupt(),
    SystemExit(3),
    StopIteration(),
    Stop(),
    mg.InvalidInput("no"),
    MemoryError(),
]


def with_progress(function: str, progress: Any) -> Any:
    shown = next(c for c in CALLS if c.function == function)
    needed = tuple(p.name for p in shown.parameters if p.is_needed)
    keywords = {**other_arguments(function, "progress", needed), **QUICK.get(function, dict)(), "progress": progress}
    return callable_of(function)(**keywords)


@pytest.mark.parametrize("function", WITH_PROGRESS)
def test_what_a_progress_callback_does(function: str) -> None:
    """It may raise anything, which comes out as it was; it may call the library; it may be no function."""
    for error in RAISED:
        calls = 0

        def fail(stage: str, fraction: float, error: BaseException = error) -> None:
            nonlocal calls
            calls += 1
            raise error

        try:
            with_progress(function, fail)
        except BaseException as raised:
            assert raised is error or (calls == 0 and isinstance(raised, REFUSALS)), repr(raised)
        else:
            assert calls == 0

    def call_again(stage: str, fraction: float) -> None:
        assert 0 <= fraction <= 1
        assert mg.CollisionChecker(ROBOT, world(), ARM).is_free(Q) in (True, False)
        mg.time_parameterize([Q, Q / 2], np.ones(3), np.ones(3))
        gc.collect()

    try:
        with_progress(function, call_again)
    except REFUSALS:
        pass
    no_functions: list[Any] = [3, "x", [], {}]
    for no_function in no_functions:
        with pytest.raises(REFUSALS):
            with_progress(function, no_function)
    for other in (lambda: None, lambda a, b, c: None, int):  # called with two arguments, if at all
        try:
            with_progress(function, other)
        except REFUSALS:
            pass


@pytest.mark.parametrize("name", [n for n in OBJECTS if "." not in n])
def test_copies_pickles_and_parts_that_outlive_their_owner(name: str) -> None:
    made = OBJECTS[name]()
    text = repr(made)
    for again in (copy.copy, copy.deepcopy, *(lambda x, p=p: pickle.loads(pickle.dumps(x, p)) for p in range(6))):
        try:
            other = again(made)
        except REFUSALS as error:
            assert str(error)
        else:
            assert plain(other) == plain(made)
    assert repr(made) == text
    kept = {}
    for attribute in dir(made):
        if attribute.startswith("_"):
            continue
        try:
            kept[attribute] = getattr(made, attribute)
        except REFUSALS:
            continue
    texts = {attribute: repr(part) for attribute, part in kept.items() if not callable(part)}
    del made
    gc.collect()
    for attribute, part in kept.items():
        assert callable(part) or repr(part) == texts[attribute], attribute
        assert callable(part) is False or repr(part)
    bare = type(OBJECTS[name]())
    try:
        unmade = cast(Any, bare).__new__(bare)
    except REFUSALS:
        return
    for use in (repr, str, copy.copy, copy.deepcopy, pickle.dumps, dir, hash):
        try:
            use(unmade)
        except REFUSALS:
            pass
    for attribute in dir(unmade):
        try:
            found = getattr(unmade, attribute)
            if callable(found) and not attribute.startswith("__"):
                found()
        except REFUSALS:
            pass


NAMES = [
    "",
    " ",
    "ä",
    "名前",
    "\u202ebox",
    "a\0b",
    "a\nb",
    "a" * 10**6,
    "../x",
    "%s%n",
    "<b>",
    "[red]",
    "\ud800",
    "nan",
    "box",
]


@pytest.mark.parametrize("name", NAMES, ids=lambda name: ascii(name)[:12])
def test_names_are_text(name: str) -> None:
    uses: list[Callable[[mg.World], Any]] = [
        lambda w: w.add_box(name, [1, 1, 1]),
        lambda w: w.remove(name),
        lambda w: w.move(name, np.eye(4)),
        lambda w: w.attach("box", name),
        lambda w: w.attach(name, "tip"),
        lambda w: w.attach("box", "tip", touch_links={name}),
        lambda w: w.detach(name),
        lambda w: w.allow(name, "box"),
        lambda w: w.disallow(name, "box"),
        lambda w: w.pose_of(name),
        lambda w: w.shapes_of(name),
        lambda w: setattr(w, "padding", {"by_name": {name: 0.1}}),
        lambda w: name in w,
        lambda w: ROBOT.group(name),
        lambda w: ROBOT.group(base_link=name, tip="tip"),
        lambda w: ROBOT.collisions(name),
        lambda w: ROBOT.link_poses({name: 0.5}),
        lambda w: ROBOT.mount(ROBOT, "tip", np.eye(4), prefix=name),
        lambda w: mg.Robot.from_strings(name),
        lambda w: mg.Robot.load(name),
        lambda w: mg.Mesh.load(name),
        lambda w: mg.Hand(
            name, approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.05, finger_width=0.02
        ),
        lambda w: mg.plan_motion(ROBOT, ARM, w, start=Q, goal=Q, planner=name),
        lambda w: mg.load_scenario(name),
    ]
    for k, use in enumerate(uses):
        scene = world()
        try:
            use(scene)
        except (*REFUSALS, KeyError) as error:
            assert str(error), k
            continue
        try:  # what was taken can be used
            mg.CollisionChecker(ROBOT, scene, ARM).is_free(Q)
        except REFUSALS as error:
            assert str(error), k


CUBE, FACES = cube().vertices, cube().triangles
TETRAHEDRON = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
RNG = np.random.default_rng(5)
SOLIDS = {  # closed by any sensible reading: their volume is known
    "plain": (CUBE, FACES, 0.001),
    "inside out": (CUBE, FACES[:, ::-1], 0.001),
    "some faces turned over": (CUBE, np.where(np.arange(len(FACES))[:, None] % 2, FACES[:, ::-1], FACES), 0.001),
    "corners doubled": (np.concatenate([CUBE, CUBE]), np.concatenate([FACES[:6], FACES[6:] + len(CUBE)]), 0.001),
    "corners nobody uses": (np.concatenate([CUBE, RNG.normal(size=(50, 3))]), FACES, 0.001),
    "with slivers": (CUBE, np.concatenate([FACES, [[0, 0, 1], [2, 2, 2]]]), 0.001),
    "far away": (CUBE + [9e5, -9e5, 9e5], FACES, 0.001),
    "tiny": (1e-6 * TETRAHEDRON, SIDES, 1e-18 / 6),
    "huge": (1e6 * TETRAHEDRON, SIDES, 1e18 / 6),
    "two apart": (np.concatenate([CUBE, CUBE + 1]), np.concatenate([FACES, FACES + len(CUBE)]), 0.002),
    "one in the other": (
        np.concatenate([CUBE, 0.5 * CUBE]),
        np.concatenate([FACES, FACES[:, ::-1] + len(CUBE)]),
        0.000875,
    ),
}
SHEETS = {  # surfaces, or refused
    "one triangle": (TETRAHEDRON, SIDES[:1]),
    "no triangle": (TETRAHEDRON, np.zeros((0, 3))),
    "no vertex": (np.zeros((0, 3)), np.zeros((0, 3))),
    "no area": (np.zeros((3, 3)), [[0, 1, 2]]),
    "on a line": (np.arange(4)[:, None] * [1.0, 1, 1], SIDES),
    "flat": (TETRAHEDRON * [1, 1, 0], SIDES),
    "every face twice": (TETRAHEDRON, np.concatenate([SIDES, SIDES])),
    "both sides": (TETRAHEDRON, np.concatenate([SIDES[:1], SIDES[:1, ::-1]])),
    "three on an edge": (RNG.normal(size=(5, 3)), [[0, 1, 2], [0, 1, 3], [0, 1, 4]]),
    "open": (CUBE, FACES[1:]),
    "a number too many": (TETRAHEDRON, [[0, 1, 4]]),
    "a huge number": (TETRAHEDRON, [[0, 1, 2**40]]),
    "negative": (TETRAHEDRON, [[0, 1, -1]]),
    "half": (TETRAHEDRON, [[0, 1, 0.5]]),
    "not a number": (np.where(TETRAHEDRON == 1, np.nan, 0), SIDES),
    "random": (RNG.normal(size=(60, 3)), RNG.integers(0, 60, (200, 3))),
    "a needle": ([[0, 0, 0], [1e5, 0, 0], [0, 1e-9, 0], [0, 0, 1e-9]], SIDES),
}
ARM_AT = ARM.fk(Q)
USES: dict[str, Callable[[mg.Mesh], Any]] = {
    "simplify_mesh": lambda m: mg.collision.simplify_mesh(m),
    "simplify_mesh, coarse": lambda m: mg.collision.simplify_mesh(m, tolerance=0.01),
    "LinkShape": lambda m: repr(mg.LinkShape(m).bounds),
    "resting_poses": lambda m: mg.mapping.resting_poses([mg.LinkShape(m)]),
    "sample_grasps": lambda m: mg.grasping.sample_grasps([mg.LinkShape(m)], gripper(), mesh_samples=20),
    "segment_mesh": lambda m: mg.grasping.segment_mesh(m, faces=500, threads=1),
    "shape_diameters": lambda m: mg.grasping.shape_diameters(m, threads=1),
    "MeshDistanceField": lambda m: mg.collision.MeshDistanceField(m).distances([[0.0, 0, 0]]),
    "render_depth": lambda m: mg.mapping.render_depth(
        [mg.LinkShape(m)], mg.mapping.PinholeCamera(width=8, height=6), np.eye(4)
    ),
    "with_link": lambda m: ROBOT.with_link("new", "tip", np.eye(4), [mg.LinkShape(m)]),
    "planar_facets": lambda m: mg.gripper_design.planar_facets(m),
    "jaw_grasps": lambda m: mg.gripper_design.jaw_grasps(m),
}


def collide(mesh: mg.Mesh) -> tuple[bool, float]:
    scene = mg.World()
    scene.add("mesh", mesh, ARM_AT)
    checker = mg.CollisionChecker(ROBOT, scene, ARM)
    return checker.is_free(Q), checker.distance(Q).value


@pytest.mark.parametrize("what", SOLIDS)
def test_solids_however_they_are_written(what: str) -> None:
    vertices, triangles, volume = SOLIDS[what]
    mesh = mg.Mesh.from_arrays(vertices, triangles)
    assert mesh.closed
    assert mesh.volume == pytest.approx(volume, rel=1e-6)
    is_free, distance = collide(mesh)
    assert is_free == (distance > 0) and np.isfinite(distance)
    for use in USES.values():
        try:
            use(mesh)
        except REFUSALS as error:
            assert str(error)


@pytest.mark.parametrize("what", SHEETS)
def test_meshes_that_are_no_solids(what: str) -> None:
    try:
        mesh = mg.Mesh.from_arrays(*cast(Any, SHEETS[what]))
    except REFUSALS as error:
        assert str(error)
        return
    is_free, distance = collide(mesh)
    assert is_free == (distance > 0) and np.isfinite(distance)
    for use in USES.values():
        try:
            use(mesh)
        except REFUSALS as error:
            assert str(error)


CLOUDS = {
    "one point": np.array([[0.1, 0.2, 0.3]]),
    "the same point": np.full((1000, 3), 0.25),
    "nothing measured": np.full((100, 3), np.nan),
    "no point": np.zeros((0, 3)),
    "a line": np.linspace(0, 1, 500)[:, None] * [1.0, 0, 0],
    "a plane": np.concatenate([RNG.uniform(0, 1, (2000, 2)), np.zeros((2000, 1))], 1),
    "two far points": np.array([[-1e6, 0, 0], [1e6, 0, 0]]),
    "too far": np.array([[0.0, 0, 0], [1.1e6, 0, 0]]),
    "enormous": np.array([[0.0, 0, 0], [1e100, 0, 0], [1e308, 0, 0]]),
    "infinite": np.array([[0.0, 0, 0], [np.inf, 0, 0]]),
    "denormal": np.full((50, 3), 5e-324),
    "noise": RNG.normal(size=(500, 3)),
    "whole numbers": RNG.integers(0, 3, (500, 3)),
    "single precision": RNG.normal(size=(500, 3)).astype(np.float32),
    "rows and columns": RNG.normal(size=(20, 30, 3)),
}
LOOKS: dict[str, Callable[[np.ndarray], Any]] = {
    "add_points": lambda p: mg.World().add_points("scan", p, 0.01),
    "Voxels": lambda p: mg.collision.Voxels(p, 0.01),
    "segment_objects": lambda p: mg.mapping.segment_objects(p),
    "segment_objects, plane": lambda p: mg.mapping.segment_objects(p, plane=mg.mapping.SupportingPlane([0, 0, 1], 0.0)),
    "segment_objects, fine": lambda p: mg.mapping.segment_objects(p, leaf=1e-5),
    "fit_cuboids": lambda p: mg.mapping.fit_cuboids(p),
    "fit_cuboids, tray": lambda p: mg.mapping.fit_cuboids(p, T_world_tray=np.eye(4), tray_size=[1, 1, 0.1]),
    "is_free": lambda p: checker_of_points(p).is_free(Q),
    "sdf": lambda p: OBJECTS["ProbabilisticSdf"]().query(p),
    "occupancy": lambda p: OBJECTS["OccupancyMap"]().query(p),
    "field": lambda p: OBJECTS["DistanceField"]().distances(p),
}


def checker_of_points(points: np.ndarray) -> mg.CollisionChecker:
    scene = mg.World()
    scene.add_points("scan", points, 0.01, ARM_AT)
    return mg.CollisionChecker(ROBOT, scene, ARM)


@pytest.mark.parametrize("what", CLOUDS)
def test_clouds(what: str) -> None:
    for look in LOOKS.values():
        try:
            look(CLOUDS[what])
        except REFUSALS as error:
            assert str(error)
    if what in ("too far", "enormous", "infinite"):
        for name in ("add_points", "Voxels", "is_free"):
            with pytest.raises(mg.InvalidInput):
                LOOKS[name](CLOUDS[what])


CAMERA = mg.mapping.PinholeCamera(width=8, height=6, fx=8.0, fy=8.0, cx=3.5, cy=2.5)
FLAT = np.full((6, 8), 0.5)
IMAGES: dict[str, Any] = {
    **{str(kind): FLAT.astype(kind) for kind in ("f2", "f4", ">f4", "f8", ">f8", "g", "i1", "i4", ">i8", "u2", "?")},
    **{str(kind): FLAT.astype(kind) for kind in ("c8", "S4", "U4", "O", "M8[s]")},
    "column-major": np.asfortranarray(FLAT),
    "turned": FLAT.T,
    "colour": np.zeros((6, 8, 3)),
    "flat": FLAT.ravel(),
    "empty": np.zeros((0, 0)),
    "nan": np.full((6, 8), np.nan),
    "inf": np.full((6, 8), np.inf),
    "negative": -FLAT,
    "enormous": np.full((6, 8), 1e30),
    "denormal": np.full((6, 8), 1e-42),
    "four dimensions": np.zeros((1, 6, 8, 1)),
    "None": None,
    "text": "x",
}


@pytest.mark.parametrize("what", IMAGES)
def test_images(what: str) -> None:
    try:
        image = mg.mapping.DepthImage(IMAGES[what], CAMERA)
    except REFUSALS as error:
        assert str(error)
        return
    assert image.depth.shape == (6, 8)
    uses: list[Callable[[], Any]] = [
        lambda: image.points(),
        lambda: mg.mapping.make_height_map(image, np.eye(4), [0.2, 0.2]),
        lambda: mg.mapping.make_height_map(image, np.eye(4), [0.2, 0.2], hole_radius=2**31 - 1),
        lambda: mg.mapping.segment_depth_image(image),
        lambda: mg.ProbabilisticSdf().integrate(image, mg.mapping.DepthCamera(CAMERA)),
        lambda: mg.mapping.OccupancyMap().integrate(image, mg.mapping.DepthCamera(CAMERA)),
    ]
    for use in uses:
        try:
            use()
        except REFUSALS as error:
            assert str(error)


def test_shapes_are_one_body_however_they_are_given() -> None:
    for given in ([BOX], [BOX, BOX], (BOX,), iter([BOX]), {0: BOX}, BOX, [BOX, 3], [], None, "x", [[BOX]]):
        scene = mg.World()
        try:
            scene.add("body", given)  # type: ignore[arg-type]
        except REFUSALS as error:
            assert str(error)
            assert "body" not in scene
