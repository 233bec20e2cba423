"""How the calls find what they call: under all names it had or may get.

After a rename add the new name where find(), get() or KEYWORDS has the old one; old and new builds then run the same script.
"""

from __future__ import annotations

import importlib
import itertools
from collections.abc import Callable
from typing import Any

PATIENT = 3600.0  # a time limit that never decides [s]
FACADES = ("robot", "collision", "planning", "grasping", "base", "mapping", "optim", "problems")
PLACES = (
    "mmgrasp",
    *(
        f"mmgrasp.{name}"
        for name in (
            *FACADES,
            "pipe_cells",
            "problems.pipe_cells",
            "problems.random_trays",
            "part_supply",
            "part_supply.drive_by",
            "_core",
        )
    ),
)
KEYWORDS: dict[str, tuple[str, ...]] = {
    "neighbours": ("neighbors",),
    "tool_cone": ("orientation_constraint",),
    "attempt_time_limit": ("solve_time_limit",),
    "attempts": ("seeds",),
    "choices": ("grasp_assignments",),
    "stands": ("goal_configurations",),
    "held_only": ("attached_only",),
    "improved": ("on_solution",),
    "carry": ("place_region",),
}
SETTINGS = {"threads": 0}

Answer = tuple[dict[str, Any], dict[str, Any]]
CALLS: dict[str, Callable[[], Answer]] = {}


class Skipped(Exception):  # noqa: N818 - it is no error
    """What a call needs is not there."""


def call(function: Callable[[], Answer]) -> Callable[[], Answer]:
    """Puts a function on the list."""
    CALLS[function.__name__] = function
    return function


def find(*names: str) -> Any:
    """The first of these names that the package has: in its root, in its facades, in the binary module."""
    for name, place in itertools.product(names, PLACES):
        try:
            module = importlib.import_module(place)
        except ModuleNotFoundError as missing:
            if not missing.name or not place.startswith(missing.name):
                raise  # the place is there, something it imports is not
            continue
        if hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"mmgrasp has none of {', '.join(names)}")


def get(thing: Any, *names: str) -> Any:
    """The first of these attributes, or keys of a dict."""
    for name in names:
        if isinstance(thing, dict) and name in thing:
            return thing[name]
        if not isinstance(thing, dict) and hasattr(thing, name):
            return getattr(thing, name)
    raise AttributeError(f"{type(thing).__name__} has none of {', '.join(names)}")


def ask(function: Callable[..., Any], *values: Any, **keywords: Any) -> Any:
    """Calls it, where keywords are refused with their other names."""
    first = None
    for chosen in itertools.product(*((key, *KEYWORDS.get(key, ())) for key in keywords)):
        try:
            return function(*values, **dict(zip(chosen, keywords.values(), strict=True)))
        except (TypeError, ValueError) as refused:
            first = first or refused
    raise first


def threads() -> int:
    """For calls that take a number of threads."""
    return SETTINGS["threads"]
