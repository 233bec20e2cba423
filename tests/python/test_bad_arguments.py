"""Every argument of the binary module that takes an array, found in the stubs, refuses what is no such array.

A function added later is covered by the names of its arguments (VALUES, OBJECTS, OTHERS); where these do not fit, a
test here fails and says so.
"""

from __future__ import annotations

import ast
import functools
import itertools
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp import _core

STUBS = Path(mg.__file__).parent / "_core"
CORPUS = REPOSITORY / "tests" / "fuzz" / "corpus"
# Optional arrays are annotated Any, since None stands for "left out".
OPTIONAL = {
    "pose",
    "T",
    "pick_point",
    "place_point",
    "T_world_root",
    "seed",
    "rpy",
    "quat_xyzw",
    "base_pose",
    "accelerations",
    "goal",
    "near",
    "tool_poses",
}

URDF = """<robot name="r"><link name="o"/>
<link name="a"><collision><geometry><box size="0.1 0.1 0.4"/></geometry></collision></link><link name="b"/><link name="tip"/>
<joint name="i" type="revolute"><parent link="o"/><child link="a"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1"/></joint>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="1"/></joint>
<joint name="k" type="prismatic"><parent link="b"/><child link="tip"/><origin xyz="0.2 0 0"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1"/></joint>
</robot>"""

ROBOT = mg.Robot.from_strings(URDF, base="omni")
ARM = ROBOT.group(base_link="o", tip="tip").with_acceleration_limits([1, 1, 1])
Q = np.array([0.25, 0.5, 0.5])
POSE = ARM.fk(Q)
WHOLE_BODY = ROBOT.group(base_link="o", tip="tip", with_base=True)
GRID = mg.BaseGrid([0.0, 0.0], 0.1, 4, 3)


def world() -> mg.World:
    world = mg.World()
    world.add_box("box", [0.1, 0.1, 0.1], mg.pose([3, 3, 3]))
    return world


def held() -> mg.World:
    held = world()
    held.attach("box", "tip")
    return held


def gripper() -> mg.Gripper:
    return mg.Gripper(
        "tip", approach=[1, 0, 0], closing=[0, 1, 0], max_opening=0.1, finger_depth=0.05, finger_width=0.02
    )


BOX = mg.LinkShape(mg.Box([0.05, 0.05, 0.05]))
PART = mg.Part("part", [BOX], POSE, [mg.Grasp(np.eye(4), 0.05)])
TRAY = mg.Tray("tray", np.eye(4), [0.3, 0.3, 0.1], [PART])
CARRY = mg.CarryPlace(np.eye(4), [0.3, 0.3])
X_Y_THETA = np.array([0.5, 0.25, 0.75])

# Good arrays by the argument's name, and by class or function where the name means something else there.
VALUES: dict[str, Any] = {
    "q": Q,
    "q0": Q,
    "q1": Q,
    "seed": Q,
    "Q": np.array([Q, Q / 2]),
    "path": np.array([Q, Q / 2]),
    "start": Q,
    "goal": Q,
    "home": Q,
    "limits": np.ones(3),
    "velocity_limits": np.ones(3),
    "acceleration_limits": np.ones(3),
    "size": np.array([0.1, 0.2, 0.3]),
    "points": np.array([[1.0, 2, 3], [4, 5, 6]]),
    "centres": np.array([[1.0, 2, 3], [4, 5, 6]]),
    "point": np.array([0.1, 0.2, 0.3]),
    "pick_point": np.array([0.1, 0.2, 0.3]),
    "place_point": np.array([0.1, 0.2, 0.3]),
    "direction": np.array([0.0, 0.0, 1.0]),
    "normal": np.array([0.0, 0.0, 1.0]),
    "approach": np.array([1.0, 0, 0]),
    "closing": np.array([0.0, 1, 0]),
    "xyz": np.array([1.0, 2, 3]),
    "rpy": np.array([0.1, 0.2, 0.3]),
    "quat_xyzw": np.array([0.0, 0, 0, 1]),
    "R": np.eye(3),
    "lengths": np.ones((3, 3)),
    "costs": np.ones((3, 3)),
    "drive_times": np.ones((4, 4)),
    "route_lengths.positions": np.array([X_Y_THETA, X_Y_THETA]),
    "cells": np.ones((1, 3, 4), np.uint8),
    "base_pose": X_Y_THETA,
    "positions": np.ones((2, 3)),
    "velocities": np.ones((2, 3)),
    "accelerations": np.ones((2, 3)),
    "centre": np.array([0.5, 0.5]),
    "origin": np.array([0.5, 0.5]),
    "pose": POSE,
    "T": POSE,
    "eye": np.array([0.1, 0.2, 0.3]),
    "nodes": np.array([[0.0, 0, 0], [0.3, 0, 0]]),
    "tray_size": np.array([0.3, 0.4, 0.1]),
    "make_height_map.size": np.array([0.1, 0.2]),
    "T_world_tips": np.array([POSE, POSE]),
    "tool_poses": np.array([POSE, POSE]),
    "near": Q,
    "tool_axis": np.array([0.0, 0, 1]),
    "world_axis": np.array([0.0, 0, 1]),
    "T_base_tips": np.array([POSE, POSE]),
    "CarryPlace.size": np.array([0.1, 0.2]),
    "PartSupplyProblem.start": X_Y_THETA,
    "PartSupplyProblem.goal": X_Y_THETA,
    "least_stops.start": np.array([0.5, 0.25]),
    "least_stops.goal": np.array([0.25, 0.5]),
    "plan_base_route.start": X_Y_THETA,
    "plan_base_route.goal": X_Y_THETA,
    "platform_velocity": X_Y_THETA,
    "drive_arc.pose": X_Y_THETA,
    "BaseTracker.command": X_Y_THETA,
    "desired": X_Y_THETA,
    "desired_next": X_Y_THETA,
    "measured": X_Y_THETA,
    "JointTrajectory.times": np.array([0.0, 1.0]),
    "joint_velocity": X_Y_THETA,
    "IkSeedDatabase.add.q": np.array([0.5, 0.25, 0.75, *Q]),
    "verify.CheckedStop.pose": X_Y_THETA,
    "verify.CheckedRegion.cells": np.ones(12, np.uint8),
}


@functools.cache
def capability_map() -> mg.CapabilityMap:
    return mg.CapabilityMap.build(ARM, upper=(1, 1, 2), voxel=1, poses=2, threads=1)


OBJECTS = {
    "Robot": lambda: ROBOT,
    "JointGroup": lambda: ARM,
    "World": world,
    "World.detach": held,
    "CollisionChecker": lambda: mg.CollisionChecker(ROBOT, world(), ARM),
    "ReachDatabase": lambda: mg.ReachDatabase.build(ARM, samples=1000, threads=1),
    "CapabilityMap": capability_map,
    "PinholeCamera": mg.PinholeCamera,
    "BaseTracker": lambda: mg.BaseTracker(ROBOT),
    "IkObjective": lambda: mg.joint_limit_objective(ARM),
    "IkSeedDatabase": lambda: mg.IkSeedDatabase(WHOLE_BODY),
    "Roadmap": lambda: mg.Roadmap.build(ARM, vertices=10),
    "JointTrajectory": lambda: mg.time_parameterize([Q, Q / 2], np.ones(3), np.ones(3), names=["i", "j", "k"]),
    "PartSupplyProblem": lambda: mg.PartSupplyProblem(
        ROBOT, ARM, gripper(), world(), [TRAY], Q, X_Y_THETA, X_Y_THETA, CARRY
    ),
}

# The arguments beside the array.
# Optional arguments that mean nothing without another one.
COMPANIONS: dict[str, dict[str, Any]] = {
    "plan_platform_locations.T_link_camera": {"camera_link": "tip"},
    "plan_motion.start": {"goal": Q},
    "least_stops.goal": {"start": np.array([0.5, 0.25])},
    "fit_cuboids.T_world_tray": {"tray_size": [0.3, 0.4, 0.1]},
    "JointTrajectory.accelerations": {"velocities": np.zeros((2, 3))},
}
OTHERS: dict[str, Any] = {
    "robot": lambda: ROBOT,
    "JointTrajectory.names": lambda: ["i", "j", "k"],
    "depth": lambda: np.ones((480, 640), np.float32),
    "height": lambda: np.ones((3, 4)),
    "group": lambda: ARM,
    "arm": lambda: ARM,
    "world": world,
    "scene": world,
    "checker": OBJECTS["CollisionChecker"],
    "plan_platform_locations.checker": lambda: mg.CollisionChecker(ROBOT, world(), WHOLE_BODY),
    "camera_link": lambda: "tip",
    "theta": lambda: 0.5,
    "database": OBJECTS["ReachDatabase"],
    "problem": OBJECTS["PartSupplyProblem"],
    "gripper": gripper,
    "grid": lambda: GRID,
    "carry": lambda: CARRY,
    "camera": mg.PinholeCamera,
    "render_depth.scene": lambda: [BOX],
    "random_placement.part": lambda: [BOX],
    "make_height_map.image": lambda: mg.render_depth([BOX], mg.PinholeCamera(width=8, height=6), POSE),
    "sections": lambda: [(0, 1)],
    "least_stops.regions": lambda: [mg.BaseRegion("tray", np.ones((1, 3, 4), np.uint8), GRID)],
    "_first_drive_by_guess.tasks": lambda: [mg.DriveByTask(POSE)],
    "diameters": lambda: 0.02,
    "shape": lambda: mg.Box([0.1, 0.1, 0.1]),
    "shapes": lambda: [BOX],
    "parts": lambda: [PART],
    "trays": lambda: [TRAY],
    "tasks": lambda: [],
    "remaining": lambda: [(0, 0)],
    "other": lambda: mg.Robot.from_strings('<robot name="s"><link name="a"/></robot>'),
    "parent_link": lambda: "tip",
    "tcp_link": lambda: "tip",
    "link": lambda: "tip",
    "headings": lambda: [0.0],
    "distances": lambda: [0.5, 1.0],
    "nx": lambda: 4,
    "ny": lambda: 3,
    "tray": lambda: 0,
    "BaseRegion.tray": lambda: "tray",
    "part": lambda: 0,
    "times": lambda: [0.0, 1.0],
    "stop_times": lambda: [1.0, 2.0],
    "robots": lambda: 1,
    "holding": lambda: False,
    "kind": lambda: "approach",
    "name": lambda: "fresh",
    "World.add_mesh.path": lambda: CORPUS / "stl" / "tetrahedron.stl",
    "LinkShape.mesh.path": lambda: CORPUS / "stl" / "tetrahedron.stl",
    "World.add_octree.path": lambda: CORPUS / "bt" / "one_leaf.bt",
    "World.move.name": lambda: "box",
    "World.attach.name": lambda: "box",
    "World.detach.name": lambda: "box",
    "ManipulationProblem.object": lambda: BOX,
    "ManipulationProblem.grasps": lambda: [mg.CandidateGrasp(np.eye(4))],
    "verify.check_path.joints": lambda: ["i", "j", "k"],
    "verify.check_path.bodies": lambda: [],
    "verify.CheckedStop.trays": lambda: ["tray"],
    "verify.CheckedIntersection.trays": lambda: ["tray"],
    "verify.CheckedRegion.tray": lambda: "tray",
}
NUMBERS = ("SupportsFloat", "SupportsInt")


class Argument(NamedTuple):
    function: str  # as in VALUES
    name: str
    optional: bool
    given: tuple[str, ...]  # the other arguments that a call needs


def looked_up(table: dict[str, Any], function: str, name: str) -> Any:
    for key in (f"{function}.{name}", f"{function.rpartition('.')[0]}.{name}", name):
        if key in table:
            return table[key]
    return None


def arguments_of(node: ast.FunctionDef, function: str, is_method: bool) -> list[Argument]:
    plain = node.args.args[1:] if is_method else node.args.args
    defaults = [None] * (len(plain) - len(node.args.defaults)) + list(node.args.defaults)
    pairs = list(zip(plain, defaults, strict=True)) + list(
        zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    )
    needed = [a.arg for a, default in pairs if default is None]
    found = []
    for argument, default in pairs:
        annotation = ast.unparse(argument.annotation) if argument.annotation else ""
        optional = annotation == "typing.Any" and (argument.arg in OPTIONAL or argument.arg.startswith("T_"))
        if "ArrayLike" in annotation or optional:
            rest = tuple(name for name in needed if name != argument.arg)
            found.append(Argument(function, argument.arg, default is not None, rest))
    return found


def functions(body: list[ast.stmt], prefix: str = "") -> list[Argument]:
    found: list[Argument] = []
    for node in body:
        if isinstance(node, ast.ClassDef):
            found += functions(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            decorators = [ast.unparse(d) for d in node.decorator_list]
            if any(d == "property" or d.endswith(".setter") for d in decorators):
                continue
            in_class = prefix.removeprefix("verify.") != ""
            name = prefix.rstrip(".") if node.name == "__init__" else prefix + node.name
            found += arguments_of(node, name, in_class and "staticmethod" not in decorators)
    return found


ARGUMENTS = functions(ast.parse((STUBS / "__init__.pyi").read_text()).body) + functions(
    ast.parse((STUBS / "verify.pyi").read_text()).body, "verify."
)


def callable_of(function: str) -> Any:
    target: Any = _core
    *path, last = function.split(".")
    for step in path:
        made = OBJECTS.get(function) or OBJECTS.get(step)
        target = made() if made else getattr(target, step)
    return getattr(target, last)


def value_of(argument: Argument) -> np.ndarray:
    value = looked_up(VALUES, argument.function, argument.name)
    if value is None and argument.name.startswith("T_"):
        value = POSE
    assert value is not None, f"{argument.function}: no good value known for {argument.name}, add one to VALUES"
    return value


def call(argument: Argument, value: Any) -> Any:
    keywords = {argument.name: value, **COMPANIONS.get(f"{argument.function}.{argument.name}", {})}
    for name in argument.given:
        other = looked_up(OTHERS, argument.function, name)
        if other is not None:
            keywords[name] = other()
        else:
            array = looked_up(VALUES, argument.function, name)
            keywords[name] = POSE if array is None and name.startswith("T_") else 0.05 if array is None else array
    return callable_of(argument.function)(**keywords)


def bad_values(argument: Argument) -> dict[str, Any]:
    good = value_of(argument)
    bad = {
        "a word": "abc",
        "an object": object(),
        "a dict": {"x": 1},
        "ragged": [[1.0, 2.0], [1.0]],
        "a number": 1.5,
        "strings": good.astype(str),
        "complex": good.astype(complex),
        "objects": good.astype(object),
        "dates": good.astype("datetime64[s]"),
        "huge integers": [10**400] * good.size,
        "no entries": np.zeros(0, good.dtype),
        "two more dimensions": good[None, None],
    }
    if good.dtype == float:
        for what in (np.nan, np.inf, -np.inf):
            spoilt = good.copy()
            spoilt.flat[good.size - 2] = what  # the last one of `lengths` means nothing
            bad[f"{what}"] = spoilt
    else:
        bad["a two"] = good * 2
        bad["minus one"] = -good.astype(int)
        bad["floats"] = good.astype(float)
    bad["one column more"] = np.concatenate([good, good[..., :1]], axis=-1)
    if argument.function in ("verify.CheckedMotion", "verify.CheckedRegion"):
        del bad["one column more"]  # parts of a plan that do not fit together are faults that the check reports
    if argument.function == "verify.CheckedRegion":
        del bad["no entries"]
    if not argument.optional:
        bad["None"] = None
    if argument.name in ("lengths", "drive_times"):
        del bad["inf"]  # no way between two stops
    return bad


def name_of(argument: Argument) -> str:
    return f"{argument.function}({argument.name})"


def test_the_stubs_were_read():
    names = {name_of(a) for a in ARGUMENTS}
    assert len(names) >= 60
    assert {"JointGroup.fk(q)", "World.add_box(pose)", "Tray(T_world_tray)", "pose(rpy)"} <= names


@pytest.mark.parametrize("argument", ARGUMENTS, ids=name_of)
def test_bad_arrays_are_refused_by_name(argument):
    if argument.function not in ("plan_pick", "plan_platform_locations"):  # which would plan
        call(argument, value_of(argument))
    accepted = []
    for what, value in bad_values(argument).items():
        try:
            result = call(argument, value)
        except (mg.Error, ValueError, TypeError) as error:
            message = str(error)
            # What does not fit together is told by the name of one of the two.
            names = (argument.name, "velocity_limits") if what == "one column more" else (argument.name,)
            assert any(name in message for name in names), f"{what}: {message}"
            if isinstance(value, np.ndarray) and what in ("nan", "inf", "-inf"):
                assert what in message, f"{what}: {message}"
            if what in ("one column more", "two more dimensions", "no entries"):
                assert "(" in message and str(value.shape[-1]) in message, f"{what}: {message}"
        else:
            accepted.append(f"{what} -> {result!r}"[:200])
    assert not accepted


PURE = [
    "JointGroup.fk",
    "JointGroup.fk_batch",
    "JointGroup.jacobian",
    "CollisionChecker.is_free",
    "pose_to_xyz_rpy",
    "pose",
]


@pytest.mark.parametrize("argument", [a for a in ARGUMENTS if a.function in PURE], ids=name_of)
def test_layout_and_precision_do_not_matter(argument):
    good = value_of(argument)
    expected = call(argument, good)
    spread = np.zeros(tuple(2 * n for n in good.shape))
    spread[tuple(slice(None, None, 2) for _ in good.shape)] = good
    views = {
        "strided": spread[tuple(slice(None, None, 2) for _ in good.shape)],
        "reversed": good[::-1].copy()[::-1],
        "column-major": np.asfortranarray(good),
        "a list": good.tolist(),
        "big-endian": good.astype(">f8"),
        "read-only": np.frombuffer(good.tobytes()).reshape(good.shape),
    }
    for what, value in views.items():
        for a, b in zip(np.atleast_1d(expected), np.atleast_1d(call(argument, value)), strict=True):
            assert np.array_equal(a, b), what


def test_whole_numbers_are_numbers():
    assert np.array_equal(ARM.fk([0, 1, 0]), ARM.fk([0.0, 1.0, 0.0]))
    assert np.array_equal(ARM.fk(np.array([0, 1, 0], np.int8)), ARM.fk([0.0, 1.0, 0.0]))
    assert np.array_equal(ARM.fk(np.array([0, 0.5, 0], np.float16)), ARM.fk([0.0, 0.5, 0.0]))


@pytest.mark.parametrize("number", [float("nan"), float("inf"), "x", None, 1j])
def test_numbers_that_are_none(number):
    world = mg.World()
    calls = [
        lambda: world.add_sphere("a", number),
        lambda: world.add_cylinder("a", 0.1, number),
        lambda: world.add_points("a", [[1.0, 2, 3]], number),
        lambda: mg.Sphere(number),
        lambda: mg.Capsule(number, 1.0),
        lambda: mg.Plane([0, 0, 1], number),
        lambda: mg.Voxels([[1.0, 2, 3]], number),
        lambda: mg.BaseGrid([0, 0], number, 4, 3),
        lambda: mg.BaseGrid([0, 0], 0.1, 4, 3, [number]),
        lambda: mg.CarryPlace(np.eye(4), [0.3, 0.3], number),
        lambda: mg.Grasp(np.eye(4), number),
        lambda: mg.CollisionChecker(ROBOT, world, ARM, padding=number),
        lambda: OBJECTS["CollisionChecker"]().edge_is_free(Q, Q, number),
        lambda: ROBOT.link_poses({"i": number}),
        lambda: ROBOT.values({"i": number}),
        lambda: ARM.within_limits(Q, number),
        lambda: mg.solve_set_cover(1, [[0]], [number]),
    ]
    for k, bad in enumerate(calls):
        with pytest.raises((mg.Error, ValueError, TypeError)):
            print(k, bad())


def test_deep_and_endless_sequences_do_not_crash():
    endless: list[Any] = []
    endless.append(endless)
    deep: Any = 1.0
    for _ in range(5000):
        deep = [deep]
    for value in (endless, deep, itertools.count(), (x for x in Q), {1.0, 2.0}, b"abc", memoryview(b"abcd")):
        with pytest.raises((mg.Error, ValueError, TypeError)):
            ARM.fk(value)


def test_an_array_that_lies_does_not_crash():
    """__array__ that fails, or returns something else, ends in an error and leaves no other one behind."""

    class Liar:
        def __init__(self, answer):
            self.answer = answer

        def __array__(self, *args, **kwargs):
            if isinstance(self.answer, Exception):
                raise self.answer
            return self.answer

    for answer in (ValueError("no"), "text", None, np.zeros((2, 2))):
        with pytest.raises((mg.Error, ValueError, TypeError)):
            ARM.fk(Liar(answer))
    assert np.array_equal(ARM.fk(Liar(Q)), ARM.fk(Q))


def test_indices_out_of_range_are_refused():
    problem, database = OBJECTS["PartSupplyProblem"](), OBJECTS["ReachDatabase"]()
    for tray, part, remaining in [(1, 0, [(0, 0)]), (-1, 0, [(0, 0)]), (0, 1, [(0, 0)]), (0, 0, [(0, 7)])]:
        with pytest.raises(mg.InvalidInput, match=r"(tray|part) = .*must be in \[0, 1\)"):
            mg.plan_pick(problem, database, X_Y_THETA, tray, part, remaining)
    for index in [(1, 0, 0), (0, 4, 0), (0, 0, -1)]:
        with pytest.raises(mg.InvalidInput, match="must be in"):
            GRID.centre(*index)
    for count in (-1, 0):
        with pytest.raises(mg.InvalidInput, match="count"):
            database.nearest(POSE, count)
