"""How objects of the C++ module come back from a pickle, and what is said of those that do not go into one."""

from __future__ import annotations

from typing import Any

from . import _core

_INSTEAD = {
    "World": "use its copy(), or build it in each process",
    "ReachDatabase": "save() it, and load() it in each process",
    "CapabilityMap": "save() it, and load() it in each process",
    "Roadmap": "save() it, and load() it in each process",
    "ProbabilisticSdf": "save() it, and load() it in each process",
    "OccupancyMap": "save() it, and load() it in each process",
    "IkSeedDatabase": "save() it, and load() it in each process",
}
_OTHERWISE = "make it in each process from what it was made of"


def restored(kind: type, state: tuple[Any, ...]) -> Any:
    """An object of this class with the state that went into the pickle."""
    return _core._from_pickle(kind, state)


def refuse(thing: object) -> None:
    """Raises TypeError for an object of a class of the C++ module, or of one that derives from it and has no __reduce__."""
    if type(thing).__reduce__ is not object.__reduce__:
        return
    for kind in type(thing).__mro__:
        if kind.__module__.startswith("mmgrasp."):
            of = kind.__name__ if kind is type(thing) else f"{type(thing).__name__}, derived from {kind.__name__},"
            raise TypeError(f"{of}: cannot be pickled or copied: {_INSTEAD.get(kind.__name__, _OTHERWISE)}")
