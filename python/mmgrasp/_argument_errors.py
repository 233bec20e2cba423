"""Says which argument of a call is wrong: of bound calls from what pybind11 says, of others by their annotations."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import os
import re
import reprlib
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple, ParamSpec, TypeVar

import numpy as np

from . import _core
from ._progress import heard
from .documents.reading import near_miss

P = ParamSpec("P")
R = TypeVar("R")
_Misfit = tuple[str, Any, str]

_SHORT = reprlib.Repr()
_SHORT.maxstring = _SHORT.maxother = 60
_MODULES = re.compile(r"\b(mmgrasp\._core|collections\.abc|numpy\.typing|_core|np)\.")
_KINDS = {"str": str, "bool": (bool, np.bool_), "os.PathLike": os.PathLike}
_ARRAYS = ("np.ndarray", "NDArray", "ArrayLike")  # say themselves what is wrong with them
_BOUND = {"mmgrasp": sys.modules["mmgrasp"]}
_WORDS = {
    "str": "a text (str)",
    "float": "a number",
    "int": "a whole number",
    "bool": "True or False",
    "None": "None",
    "numpy.typing.ArrayLike": "an array",
    "ArrayLike": "an array",
    "Progress": "a function of a stage and a fraction, or None",
}


class _Parameter(NamedTuple):
    name: str
    annotation: str
    needed: bool
    by_name: bool
    """Given by its name alone."""


def explain(message: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> str:
    """One line in place of pybind11's message: function, argument, value and what it must be."""
    if message.startswith("an argument of "):  # whose kind fits, but that cannot be converted
        return _unconverted(message, args, kwargs)
    text = message.partition("\nInvoked with:")[0]
    for kind, name in (("Float", "float"), ("Int", "int")):
        text = text.replace(f"typing.Supports{kind} | typing.SupportsIndex", name)
    signatures = re.findall(r"^    \d+\. (.*)$", text, re.MULTILINE)
    name = message.partition("():")[0]
    if name == "__init__":
        args = args[1:]  # the object that is made
        name = signatures[0].partition("(")[0].rpartition(".")[2]
    ways = [_parameters(signature) for signature in signatures]
    faults = [_fault(way, args, kwargs) for way in ways]
    if len(faults) == 1:
        return f"{name}: {faults[0][1]}"
    known = [sum(p.name in kwargs for p in way) for way in ways]
    _, (_, best) = max(zip(known, faults, strict=True), key=lambda one: (one[0], one[1][0]))
    return f"{name}: {best} (the nearest of {len(faults)} ways to call it)"


def _unconverted(message: str, args: tuple[Any, ...], kwargs: dict[str, Any]) -> str:
    kind, _, rule = message.removeprefix("an argument of ").partition(": ")
    given = {f"argument {place}": value for place, value in enumerate(args)} | kwargs
    names = [f"{name} = {_short(value)}" for name, value in given.items() if kind in (str(type(value)), type(value).__name__)]  # fmt: skip
    return f"{' or '.join(names)}: {rule}" if names else message


def _pieces(text: str, separator: str) -> list[str]:
    """The text cut at separators outside of brackets and quotes."""
    pieces, depth, quote, piece = [], 0, "", ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "([{<":
            depth += 1
        elif letter in ")]}>":
            depth -= 1
        if letter == separator and depth == 0 and not quote:
            pieces.append(piece.strip())
            piece = ""
        else:
            piece += letter
    return [*pieces, piece.strip()] if piece.strip() else pieces


def _parameters(signature: str) -> list[_Parameter]:
    inner = signature[signature.index("(") + 1 : signature.rindex(")", 0, signature.rfind(" -> ") if " -> " in signature else None)]  # fmt: skip
    found, by_name = [], False
    for piece in _pieces(inner, ","):
        if piece in ("*", "/"):
            by_name = piece == "*"
        elif piece.startswith("*"):
            found.append(_Parameter(piece, "", False, piece.startswith("**")))
        else:
            name, _, rest = piece.partition(":")
            annotation, default, _ = rest.partition(" = ")
            found.append(_Parameter(name.strip(), annotation.strip(), not default, by_name))
    return found


def _fault(parameters: list[_Parameter], args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[int, str]:
    """How many arguments come before the first wrong one, and what is wrong with it."""
    names = [p.name for p in parameters if not p.name.startswith("*")]
    by_place = [p for p in parameters if not p.by_name]
    shown = [name for name in names if name != "self"]
    takes_more = any(p.name.startswith("*") and not p.by_name for p in parameters)
    given = dict(zip([p.name for p in by_place], args, strict=False)) | kwargs
    for place, parameter in enumerate(parameters):
        if parameter.name in given:
            if isinstance(given[parameter.name], str) and not _is_text(given[parameter.name]):
                return (
                    place,
                    f"{parameter.name} = {_short(given[parameter.name])}: holds half a character, which no text has (a lone surrogate)",
                )
            at = _misfit(parameter.annotation, given[parameter.name], _BOUND)
            if at is not None:
                where, value, annotation = at
                return place, f"{parameter.name}{where} = {_short(value)}: must be {_wanted(annotation)}"
        elif parameter.needed and not parameter.name.startswith("*"):
            return place, f"{parameter.name} is missing: must be {_wanted(parameter.annotation)}"
    if len(args) > len(by_place) and not takes_more:
        count = len(by_place) - ("self" in names)
        return len(by_place), f"takes {count} arguments by place ({', '.join(shown)}), got {len(args) - ('self' in names)}"  # fmt: skip
    if not any(p.name.startswith("**") for p in parameters):
        for name in kwargs:
            if name not in names:
                return len(by_place), f"has no argument {name}{near_miss(name, shown)}"
            if name in [p.name for p in by_place][: len(args)]:
                return len(by_place), f"{name} is given twice"
    values = ", ".join([*map(_short, args["self" in names :]), *(f"{k}={_short(v)}" for k, v in kwargs.items())])
    return -1, f"takes ({', '.join(shown)}), got ({values})"


def _is_text(value: str) -> bool:
    try:
        value.encode()
    except UnicodeEncodeError:
        return False
    return True


def checked(function: Callable[P, R]) -> Callable[P, R]:
    """A function of the package's own that raises InvalidInput for arguments that are not what its annotations say."""
    signature = inspect.signature(function)
    space = getattr(inspect.unwrap(function), "__globals__", {})

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            bound = signature.bind(*args, **kwargs)
        except TypeError:
            return function(*args, **kwargs)  # which says what is missing or unknown
        for name, value in bound.arguments.items():
            parameter = signature.parameters[name]
            if parameter.kind not in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL) and parameter.annotation:
                _require(name, str(parameter.annotation), value, space)
            if parameter.annotation == "Progress":
                bound.arguments[name] = heard(value)
        return function(*bound.args, **bound.kwargs)

    return call


def _require(name: str, annotation: str, value: Any, space: dict[str, Any]) -> None:
    at = _misfit(annotation, value, space)
    if at is not None:
        where, piece, wanted = at
        raise _core.InvalidInput(f"{name}{where} = {_short(piece)}: must be {_wanted(wanted)}")
    fields = [f.name for f in dataclasses.fields(value)] if dataclasses.is_dataclass(value) else []
    unmade = any(not hasattr(value, field) for field in fields)
    if unmade or (type(value).__module__.startswith("mmgrasp.") and getattr(value, "__dict__", None) == {}):
        raise _core.InvalidInput(f"{name} = a {type(value).__name__} without its values: must be made by its constructor")  # fmt: skip


def _short(value: Any) -> str:
    try:
        return _SHORT.repr(value)
    except Exception:
        return f"a {type(value).__name__}"


def _wanted(annotation: str) -> str:
    parts = _pieces(annotation, "|")
    if {"str", "os.PathLike[str]"} <= set(parts):
        parts = ["a path (str or os.PathLike)", *(part for part in parts if part not in ("str", "os.PathLike[str]"))]
    return " or ".join(_WORDS.get(part, _MODULES.sub("", part)) for part in parts)


def _misfit(annotation: str, value: Any, space: dict[str, Any]) -> _Misfit | None:
    """What of a value does not fit: where in it, that piece, and the annotation that it breaks.

    `space`: where the names of classes are looked up.
    """
    misfits = [_misfit_one(part, value, space) for part in _pieces(annotation, "|")]
    if not misfits or None in misfits:
        return None
    inner = [misfit for misfit in misfits if misfit is not None and misfit[0]]
    return inner[0] if len(inner) == 1 else ("", value, annotation)


def _misfit_one(annotation: str, value: Any, space: dict[str, Any]) -> _Misfit | None:
    whole = ("", value, annotation)
    outer, _, rest = annotation.removeprefix("collections.abc.").partition("[")
    inner = _pieces(rest[:-1], ",")
    if outer in ("Sequence", "Iterable", "list", "tuple"):
        if isinstance(value, (str, bytes)) or not isinstance(value, Iterable):
            return whole
        if not isinstance(value, Sequence) or not inner:
            return None
        kinds = inner if outer == "tuple" and "..." not in inner else inner[:1] * len(value)
        if len(kinds) != len(value):
            return whole
        entries: Iterable[tuple[Any, Any, str]] = zip(range(len(value)), value, kinds, strict=True)
    elif outer in ("Mapping", "dict"):
        if not isinstance(value, Mapping):
            return whole
        if not inner:
            return None
        for key in value:
            if _misfit(inner[0], key, space) is not None:
                return ", key", key, inner[0]
        entries = ((key, entry, inner[1]) for key, entry in value.items())
    else:
        return None if _fits(outer, value, space) else whole
    for key, entry, kind in entries:
        if (at := _misfit(kind, entry, space)) is not None:
            return f"[{_short(key)}]{at[0]}", at[1], at[2]
    return None


def _fits(kind: str, value: Any, space: dict[str, Any]) -> bool:
    """Whether a value is of a plain kind; kinds that are not known here fit."""
    is_bound = space is _BOUND  # pybind11 takes booleans for numbers
    if kind in ("float", "int"):
        methods = ("__index__",) if kind == "int" else ("__float__", "__index__")
        return any(hasattr(value, method) for method in methods) and (is_bound or not isinstance(value, bool))
    if kind in ("Callable", "Progress"):
        return callable(value) or (value is None and kind == "Progress")
    if kind == "None":
        return value is None
    found: Any = _KINDS.get(kind)
    if found is None and kind not in _ARRAYS:
        first, *path = kind.split(".")
        found = space.get(first)
        for name in path:
            found = getattr(found, name, None)
    try:
        return not isinstance(found, type | tuple) or isinstance(value, found)
    except TypeError:  # a protocol that cannot be asked
        return True
