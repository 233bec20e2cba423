"""Every argument of the binary module that takes an array, found in the stubs, refuses what is no such array.

A function added later is covered by the names of its arguments (argument_values.py); where these do not fit, a
test here fails and says so.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np
import pytest

import mmgrasp as mg
from argument_calls import CALLS, Parameter, callable_of, looked_up, other_arguments
from argument_objects import ARM, GRID, OBJECTS, POSE, X_Y_THETA, Q
from argument_values import VALUES
from number_tables import QUICK

# Images and points of scans may hold NaN; a scale may be a number.
OTHER_RULES = (
    "DepthImage.depth",
    "GridDistanceField.values",
    "HeightMap.height",
    "fit_cuboids.points",
    "segment_objects.points",
    "segment_objects.normals",
    "LinkShape.mesh.scale",
    "Mesh.load.scale",
    "World.add_mesh.scale",
)


# Lists whose length something else decides, or nothing.
LISTS = ("distances", "stop_times")


class Argument(NamedTuple):
    function: str  # as in VALUES
    name: str
    optional: bool
    given: tuple[str, ...]  # the other arguments that a call needs


def is_array(parameter: Parameter) -> bool:
    return parameter.annotation in ("numpy.typing.ArrayLike", "numpy.typing.ArrayLike | None")


ARGUMENTS = [
    Argument(
        call.function,
        parameter.name,
        parameter.annotation.endswith("None"),
        tuple(p.name for p in call.parameters if p.is_needed and p.name != parameter.name),
    )
    for call in CALLS
    if not call.is_setter
    for parameter in call.parameters
    if is_array(parameter) and f"{call.function}.{parameter.name}" not in OTHER_RULES
]


def value_of(argument: Argument) -> np.ndarray:
    value = looked_up(VALUES, argument.function, argument.name)
    if value is None and argument.name.startswith("T_"):
        value = POSE
    assert value is not None, f"{argument.function}: no good value known for {argument.name}, add one to VALUES"
    return np.asarray(value)


def call(argument: Argument, value: Any) -> Any:
    short = QUICK["next_view"]() if argument.function == "next_view" else {}
    others = other_arguments(argument.function, argument.name, argument.given)
    return callable_of(argument.function)(**{argument.name: value, **others, **short})


def is_any_number(argument: Argument) -> bool:
    """Costs, values, and what a solver is given are no lengths: they may be larger."""
    functions = ("minimize_derivative_free", "solve_nonlinear", "cheapest_assignment", "solve_set_cover")
    named = (
        "preferred_grippers.values",
        "pairwise_weights.comparison",
        "NodeLoad.force",
        "NodeLoad.moment",
        "share_stops.drive_times",
        "shortest_visiting_tour.lengths",
    )
    return (
        argument.function.startswith(("NonlinearProblem.", *functions))
        or f"{argument.function}.{argument.name}" in named
    )


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
            spoilt.flat[max(good.size - 2, 0)] = what  # the last one of `lengths` means nothing
            bad[f"{what}"] = spoilt
        hidden = np.zeros(good.shape, bool)
        hidden.flat[0] = True
        bad["masked"] = np.ma.masked_array(good, mask=hidden)
        beyond = good.copy()
        beyond.flat[max(good.size - 2, 0)] = 1.1e15 if is_any_number(argument) else 1.1e6
        bad["beyond the largest"] = beyond
    else:
        bad["a two"] = good * 2
        bad["minus one"] = -good.astype(int)
        bad["floats"] = good.astype(float)
    bad["one column more"] = np.concatenate([good, good[..., :1]], axis=-1)
    if argument.function in ("verify.CheckedMotion", "verify.CheckedRegion"):
        del bad["one column more"]  # parts of a plan that do not fit together are faults that the check reports
    if argument.name in ("headings", "distances", "posture"):
        del bad["one column more"]  # as many as one likes
    left_out = ("joint_weights", "jerk_limits", "posture", "Tray.headings", "solve_set_cover.costs")
    whole = f"{argument.function}.{argument.name}"
    if argument.name in left_out or whole in left_out or argument.function == "verify.CheckedRegion":
        bad.pop("no entries", None)  # the same as leaving it out
    if not argument.optional:
        bad["None"] = None
    if argument.function == "minimize_derivative_free":
        for infinite in {"lower": ["-inf"], "upper": ["inf"]}.get(argument.name, []):
            del bad[infinite]  # no bound
        bad.pop("beyond the largest" if argument.name in ("lower", "upper") else "", None)  # 1e20 is none, either
    if argument.name in ("lengths", "drive_times"):
        del bad["inf"]  # no way between two stops
    return bad


def name_of(argument: Argument) -> str:
    return f"{argument.function}({argument.name})"


def test_the_stubs_were_read() -> None:
    names = {name_of(a) for a in ARGUMENTS}
    assert len(names) >= 60
    assert {"JointGroup.fk(q)", "World.add_box(pose)", "Tray(T_world_tray)", "pose(rpy)"} <= names


@pytest.mark.parametrize("argument", ARGUMENTS, ids=name_of)
def test_bad_arrays_are_refused_by_name(argument: Argument) -> None:
    if argument.function not in ("plan_pick", "plan_platform_locations"):  # which would plan
        call(argument, value_of(argument))
    accepted = []
    for what, value in bad_values(argument).items():
        try:
            result = call(argument, value)
        except (mg.Error, ValueError, TypeError) as error:
            message = str(error)
            # What does not fit together is named by the name of one of the two.
            fits = {"one column more": ["velocity_limits", "drive_times"], "no entries": ["drive_times"]}.get(what, [])
            names = (argument.name, *fits)
            assert any(name in message for name in names), f"{what}: {message}"
            if isinstance(value, np.ndarray) and what in ("nan", "inf", "-inf"):
                assert what in message, f"{what}: {message}"
            if what in ("one column more", "two more dimensions", "no entries") and argument.name not in LISTS:
                assert "(" in message and str(value.shape[-1]) in message, f"{what}: {message}"
        else:
            accepted.append(f"{what} -> {result!r}"[:200])
    assert not accepted


def test_what_cannot_fit_is_refused_before_it_is_copied() -> None:
    """A view of a billion numbers takes eight bytes; a copy of it all the memory there is."""
    huge = np.broadcast_to(np.zeros(1), (10**12,))
    rows = np.broadcast_to(np.zeros(1), (10**6, 10**6))
    for call, name in ((lambda: ARM.fk(huge), "q"), (lambda: ARM.fk_batch(rows), "Q"), (lambda: mg.Box(huge), "size")):
        with pytest.raises(mg.InvalidInput, match=f"{name} has shape .10000"):
            call()
    with pytest.raises(mg.InvalidInput, match=r"has shape .1000000, 1000000.: must be .4, 4."):
        mg.World().add_box("b", [1, 1, 1], rows)


PURE = [
    "JointGroup.fk",
    "JointGroup.fk_batch",
    "JointGroup.jacobian",
    "CollisionChecker.is_free",
    "pose_to_xyz_rpy",
    "pose",
]


@pytest.mark.parametrize("argument", [a for a in ARGUMENTS if a.function in PURE], ids=name_of)
def test_layout_and_precision_do_not_matter(argument: Argument) -> None:
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


def test_whole_numbers_are_numbers() -> None:
    assert np.array_equal(ARM.fk([0, 1, 0]), ARM.fk([0.0, 1.0, 0.0]))
    assert np.array_equal(ARM.fk(np.array([0, 1, 0], np.int8)), ARM.fk([0.0, 1.0, 0.0]))
    assert np.array_equal(ARM.fk(np.array([0, 0.5, 0], np.float16)), ARM.fk([0.0, 0.5, 0.0]))


def test_deep_and_endless_sequences_do_not_crash() -> None:
    endless: list[Any] = []
    endless.append(endless)
    deep: Any = 1.0
    for _ in range(5000):
        deep = [deep]
    value: Any
    for value in (endless, deep, itertools.count(), (x for x in Q), {1.0, 2.0}, b"abc", memoryview(b"abcd")):
        with pytest.raises((mg.Error, ValueError, TypeError)):
            ARM.fk(value)


def test_an_array_that_lies_does_not_crash() -> None:
    """__array__ that fails, or returns something else, ends in an error and leaves no other one behind."""

    class Liar:
        def __init__(self, answer: Any) -> None:
            self.answer = answer

        def __array__(self, *args: Any, **kwargs: Any) -> Any:
            if isinstance(self.answer, Exception):
                raise self.answer
            return self.answer

    for answer in (ValueError("no"), "text", None, np.zeros((2, 2))):
        with pytest.raises((mg.Error, ValueError, TypeError)):
            ARM.fk(Liar(answer))
    assert np.array_equal(ARM.fk(Liar(Q)), ARM.fk(Q))


def test_indices_out_of_range_are_refused() -> None:
    problem, database = OBJECTS["PartSupplyProblem"](), OBJECTS["ReachDatabase"]()
    for tray, part, remaining in [(1, 0, [(0, 0)]), (-1, 0, [(0, 0)]), (0, 1, [(0, 0)]), (0, 0, [(0, 7)])]:
        with pytest.raises(mg.InvalidInput, match=r"(tray|part) = .*must be in \[0, 1\)"):
            mg.base.plan_pick(problem, database, X_Y_THETA, tray, part, remaining)
    for index in [(1, 0, 0), (0, 4, 0), (0, 0, -1)]:
        with pytest.raises(mg.InvalidInput, match="must be in"):
            GRID.centre(*index)
    for count in (-1, 0):
        with pytest.raises(mg.InvalidInput, match="count"):
            database.nearest(POSE, count)


@pytest.mark.parametrize("value", [10**400, np.array([0.5]), np.array([])])
def test_values_that_are_no_single_number_of_their_type_are_told(value: Any) -> None:
    """pybind11 takes their kind, then cannot convert them."""
    with pytest.raises(mg.InvalidInput, match="its value cannot be taken"):
        mg.ProbabilisticSdf(voxel=value)
