"""Every public function written in Python refuses arguments of the wrong kind by name, before it does anything."""

from __future__ import annotations

import contextlib
import importlib
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from argument_objects import ROBOT, world
from mmgrasp.frames import FrameFolder
from mmgrasp.grippers import Assembly
from mmgrasp.part_supply import ScenarioPlan
from mmgrasp.pipes import PipeProblem
from mmgrasp.scan import Scan
from mmgrasp.scenario import Scenario

PACKAGES = ("", "part_supply", "frames", "scan", "scenario", "sim", "cluster", "reproduce", "grippers", "pipes")
TEXTS = [b"scenario.yaml", 3, 1.5, True, ["a"], object(), np.zeros(3)]
WHOLE = ["1", b"1", True, 1.5, [1], {}, object()]
NUMBERS = ["1", b"1", True, [1], {}, object()]
# What is wrong for each annotation, and what is right.
WRONG: dict[str, tuple[list[Any], Any]] = {
    "str | os.PathLike[str]": ([*TEXTS, None, {}], "nowhere.yaml"),
    "str | os.PathLike[str] | None": ([*TEXTS, {}], None),
    "dict[str, Any] | str | os.PathLike[str]": ([*TEXTS, None], "nowhere.json"),
    "str | os.PathLike[str] | dict[str, Any] | None": (TEXTS, None),
    "str | os.PathLike[str] | ProblemSource": ([], "nowhere.yaml"),  # whatever has a method problem()
    "Scenario | PartSupplyProblem | str | os.PathLike[str]": ([*TEXTS, None, Scenario.__new__(Scenario)], "nowhere.yaml"),
    "ScenarioPlan | str | os.PathLike[str]": ([*TEXTS, None, ScenarioPlan.__new__(ScenarioPlan)], "nowhere.json"),
    "ScenarioPlan": (["x", None, ScenarioPlan.__new__(ScenarioPlan)], None),
    "Path | str": ([*TEXTS, None], "nowhere"),
    "Path | str | None": (TEXTS, None),
    "Path": (["x", b"x", None, 3], Path("nowhere")),
    "str": ([*TEXTS, None], "x"),
    "str | None": (TEXTS, None),
    "int": ([*WHOLE, None], 1),
    "int | None": (WHOLE, None),
    "float": ([*NUMBERS, None], 0.1),
    "float | None": (NUMBERS, None),
    "bool": (["yes", 1, None, []], False),
    "Progress": ([3, "x", []], None),
    "Callable[..., Any]": ([3, "x", None], print),
    "Callable[[Scan], object] | None": ([3, "x"], None),
    "Callable[[], contextlib.AbstractContextManager[object]]": ([3, "x", None], contextlib.nullcontext),
    "Sequence[str | os.PathLike[str]]": (["a", b"a", 3, None, [3], [b"a"]], ["nowhere.json", "elsewhere.json"]),
    "Iterable[str]": (["a", b"a", 3, None, [3], [b"a"]], ["a"]),
    "Sequence[dict[str, Any]]": (["a", 3, None, [3]], [{}]),
    "Sequence[np.ndarray]": (["a", 3, None], [np.eye(4)]),
    "Sequence[float] | np.ndarray | None": ([], None),  # arrays say themselves what is wrong with them
    "dict[str, Any]": (["a", 3, None, {3: 3}], {}),
    "ReachDatabase | None": (["x", 3], None),
    "Robot": (["x", 3, None], ROBOT),
    "World": (["x", 3, None], world()),
    "Hand | None": (["x", 3], None),
    "Physics | None": (["x", 3], None),
    "Iterable[SimPart]": (["x", 3, None, ["x"]], ()),
    "SupportingSurface | None": (["x", 3], None),
    "FrameFolder": (["x", None, FrameFolder.__new__(FrameFolder)], FrameFolder(Path(), {}, {}, [])),
    "Scan": (["x", None, Scan.__new__(Scan)], None),
    "Assembly": (["x", None, Assembly.__new__(Assembly)], None),
    "PipeProblem": (["x", None, PipeProblem.__new__(PipeProblem)], None),
    "Engine": (["x", None], None),
    "ArrayLike": ([], [0.0, 0.0, 0.0]),
    "np.ndarray": ([], np.zeros((4, 4))),
    "np.ndarray | None": ([], None),
    "Sweep": ([], None),
    "Node": (["x", None], None),
}  # fmt: skip


def functions() -> dict[str, Callable[..., Any]]:
    found: dict[str, Callable[..., Any]] = {}
    for package in PACKAGES:
        module = importlib.import_module(f"mmgrasp.{package}".rstrip("."))
        for name in module.__all__ if hasattr(module, "__all__") else [n for n in vars(module) if n[0] != "_"]:
            value = getattr(module, name)
            if (
                inspect.isfunction(value)
                and value.__module__.startswith("mmgrasp")
                and "_argument_errors" not in value.__module__
            ):
                found[f"{value.__module__}.{name}"] = value
    return found


FUNCTIONS = functions()


def test_all_are_there() -> None:
    assert {"mmgrasp.scenario.scenario.load_scenario", "mmgrasp.cluster.engine.connect"} <= FUNCTIONS.keys()
    assert len(FUNCTIONS) >= 25


@pytest.mark.parametrize("name", FUNCTIONS)
def test_wrong_kinds_are_refused_by_name(name: str) -> None:
    function = FUNCTIONS[name]
    parameters = [p for p in inspect.signature(function).parameters.values() if p.kind != p.VAR_KEYWORD]
    good = {p.name: WRONG[str(p.annotation)][1] for p in parameters if p.default is p.empty}
    before: list[str] = []
    for parameter in parameters:
        for value in WRONG[str(parameter.annotation)][0]:
            with pytest.raises(mg.InvalidInput) as refused:
                function(**{**good, parameter.name: value})
            # an argument before it for which there is no good value here may be blamed as well
            assert str(refused.value).startswith(tuple(f"{n}" for n in (parameter.name, *before))), (parameter, value)
        if parameter.default is parameter.empty and good[parameter.name] is None:
            before.append(parameter.name)


def test_what_is_said() -> None:
    with pytest.raises(mg.InvalidInput, match=r"seed = '1': must be a whole number or None"):
        mg.plan_part_supply("nowhere.yaml", seed="1")  # type: ignore[call-overload]
    with pytest.raises(mg.InvalidInput, match=r"path = b'x': must be a path \(str or os.PathLike\)"):
        mg.load_scenario(b"x")  # type: ignore[arg-type]
