"""Arguments that fit no signature of a bound call: one line that names the argument, at every call of the stubs."""

from __future__ import annotations

import re
from typing import Any

import pytest

import mmgrasp as mg
from argument_calls import CALLS, Call, callable_of, other_arguments
from mmgrasp._argument_errors import explain
from number_tables import QUICK

WORLD: Any = mg.World()
MG: Any = mg


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: WORLD.add_box(3, [1, 1, 1]), "add_box: name = 3: must be a text (str)"),
        (lambda: WORLD.add_box("\udcff", [1, 1, 1]), r"add_box: name = '\udcff': holds half a character"),
        (lambda: WORLD.add_box("a"), "add_box: size is missing: must be an array"),
        (lambda: WORLD.add_box("a", [1, 1, 1], size=2), "add_box: size is given twice"),
        (lambda: WORLD.add_box("a", [1, 1, 1], None, 3), "add_box: takes 3 arguments by place (name, size, pose), got 4"),
        (lambda: WORLD.add_box("a", [1, 1, 1], poses=3), "add_box: has no argument poses; did you mean pose?"),
        (lambda: MG.Box(), "Box: size is missing: must be an array"),
        (lambda: MG.base.Part("a", [MG.Box([1, 1, 1]), 3], MG.pose([0, 0, 0]), []), "Part: shapes[0] = Box"),
        (lambda: MG.optim.solve_set_cover(3, [[0, 1], [2, "x"]]), "solve_set_cover: sets[1][1] = 'x': must be a whole number"),
    ],
)  # fmt: skip
def test_messages(call: Any, message: str) -> None:
    with pytest.raises(TypeError) as raised:
        call()
    assert str(raised.value).startswith(message)


def test_of_several_ways_to_call_the_nearest_is_told() -> None:
    with pytest.raises(
        TypeError, match=r"^platform_velocity: joint_velocity is missing: .* \(the nearest of 2 ways to call it\)$"
    ):
        mg.base.platform_velocity(0.5)  # type: ignore[call-overload]


class Odd:
    """Fits nothing."""

    def __repr__(self) -> str:
        return "odd"


def refusal(call: Call, name: str) -> str | None:
    """What a call says of an odd object for one of its arguments; None: it took it."""
    needed = tuple(p.name for p in call.parameters if p.is_needed and p.name != name)
    keywords = {**other_arguments(call.function, name, needed), **QUICK.get(call.function, dict)(), name: Odd()}
    try:
        callable_of(call.function)(**keywords)
    except (mg.Error, TypeError) as error:
        return str(error)
    return None


ARGUMENTS = [
    (call, p.name) for call in CALLS if not call.is_setter for p in call.parameters if not p.name.startswith("*")
]


NOT_NAMED = {"run_policy(planned)": "'Odd' object is not callable"}


def test_every_call_names_an_argument_in_a_line() -> None:
    """The odd one, or one before it for which there is no good value here."""
    complaints, without_object = {}, 0
    for call, name in ARGUMENTS:
        if call.function.startswith("_"):
            continue
        said = refusal(call, name)
        if said is not None and said.endswith("self is missing: must be " + said.rpartition(" ")[2]):
            without_object += 1  # a method of a class of which there is no object here
            continue
        is_named = said is not None and any(re.search(rf"\b{p.name}\b", said) for p in call.parameters)
        if not is_named or "Invoked with" in str(said) or len(str(said)) > 500:
            complaints[f"{call.function}({name})"] = said
    assert complaints.keys() == NOT_NAMED.keys(), complaints
    assert len(ARGUMENTS) > 1300 and without_object < 100


def test_values_that_cannot_be_converted_are_named() -> None:
    with pytest.raises(mg.InvalidInput, match=r"^voxel = 1000.*: its value cannot be taken"):
        mg.ProbabilisticSdf(voxel=10**400)


def test_what_is_not_known_stays_short() -> None:
    text = "f(): incompatible function arguments. The following argument types are supported:\n    1. (self: X, a: strange[T], *, b: int = <E.one: 1>) -> None\n\nInvoked with: ..."
    assert explain(text, (None, "x" * 10**6), {"b": 3}).startswith("f: takes (a, b), got ('xxx")
    assert len(explain(text, (None, "x" * 10**6), {"b": 3})) < 200
    assert explain(text, (None, 1), {"b": "x"}) == "f: b = 'x': must be a whole number"
