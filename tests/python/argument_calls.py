"""Every public call of the binary module as the stubs write it, and arguments with which it can be called."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Any, NamedTuple

import mmgrasp as mg
from argument_objects import OBJECTS, POSE
from argument_values import COMPANIONS, OTHERS, VALUES
from mmgrasp import _core

STUBS = Path(mg.__file__).parent / "_core"


class Parameter(NamedTuple):
    name: str
    annotation: str
    is_needed: bool


class Call(NamedTuple):
    function: str  # as in argument_values.py: "World.add_box", a class for its constructor, "verify.check_plan"
    parameters: tuple[Parameter, ...]
    is_setter: bool = False


def looked_up(table: dict[str, Any], function: str, name: str) -> Any:
    for key in (f"{function}.{name}", f"{function.rpartition('.')[0]}.{name}", name):
        if key in table:
            return table[key]
    return None


def _parameters(node: ast.FunctionDef, is_method: bool) -> tuple[Parameter, ...]:
    plain = node.args.args[1:] if is_method else node.args.args
    defaults = [None] * (len(plain) - len(node.args.defaults)) + list(node.args.defaults)
    pairs = list(zip(plain, defaults, strict=True)) + list(
        zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    )
    return tuple(
        Parameter(a.arg, ast.unparse(a.annotation) if a.annotation else "", default is None) for a, default in pairs
    )


def _calls(body: list[ast.stmt], prefix: str = "") -> list[Call]:
    found: list[Call] = []
    for node in body:
        if isinstance(node, ast.ClassDef):
            found += _calls(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            decorators = [ast.unparse(d) for d in node.decorator_list]
            if "property" in decorators or (node.name.startswith("__") and node.name != "__init__"):
                continue
            in_class = prefix.removeprefix("verify.") != ""
            name = prefix.rstrip(".") if node.name == "__init__" else prefix + node.name
            is_setter = any(d.endswith(".setter") for d in decorators)
            found.append(Call(name, _parameters(node, in_class and "staticmethod" not in decorators), is_setter))
    return found


CALLS = _calls(ast.parse((STUBS / "__init__.pyi").read_text()).body) + _calls(
    ast.parse((STUBS / "verify.pyi").read_text()).body, "verify."
)


def callable_of(function: str) -> Any:
    target: Any = _core
    *path, last = function.split(".")
    for step in path:
        made = OBJECTS.get(function) or OBJECTS.get(step)
        target = made() if made else getattr(target, step)
    return getattr(target, last)


def other_arguments(function: str, given: str, needed: tuple[str, ...]) -> dict[str, Any]:
    """What a call needs beside its argument `given`."""
    keywords = dict(COMPANIONS.get(f"{function}.{given}", {}))
    for name in needed:
        other = looked_up(OTHERS, function, name)
        if other is not None:
            keywords[name] = other()
        else:
            array = looked_up(VALUES, function, name)
            keywords[name] = POSE if array is None and name.startswith("T_") else 0.05 if array is None else array
    return keywords
