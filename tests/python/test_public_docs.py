"""Everything public of the C++ library has a docstring."""

from __future__ import annotations

import enum
import inspect
from collections.abc import Iterator
from types import ModuleType

from mmgrasp import _core


def described(doc: str | None) -> bool:
    """Has text beyond the signatures that pybind11 writes."""
    text = [line.strip() for line in (doc or "").splitlines() if line.strip()]
    return any("->" not in line and not line.startswith("Overloaded function.") for line in text)


def members(name: str, kind: type) -> Iterator[tuple[str, str | None]]:
    for key, member in vars(kind).items():
        if key.startswith("_") and key != "__init__":
            continue
        if key == "__init__" and isinstance(member, type(object.__init__)):
            continue
        yield f"{name}.{key}", inspect.getdoc(member.__func__ if isinstance(member, staticmethod) else member)


def entries(module: ModuleType) -> Iterator[tuple[str, str | None]]:
    """Name and docstring of every public class, method, property, function and value of an enumeration."""
    for name, entry in vars(module).items():
        if name.startswith("_"):
            continue
        if isinstance(entry, ModuleType):
            yield from entries(entry)
        elif isinstance(entry, type) and issubclass(entry, enum.Enum):
            yield name, entry.__doc__
            yield from ((f"{name}.{value.name}", value.__dict__.get("__doc__")) for value in entry)
        elif isinstance(entry, type):
            yield name, entry.__doc__
            if not issubclass(entry, Exception):
                yield from members(name, entry)
        elif callable(entry):
            yield name, entry.__doc__


def test_everything_public_is_documented() -> None:
    found = list(entries(_core))
    assert len(found) > 700
    assert sorted(name for name, doc in found if not described(doc)) == []


def test_a_bare_signature_is_no_documentation() -> None:
    assert not described("size(self: mmgrasp._core.Box) -> float\n")
    assert not described(None)
    assert described("size(self: mmgrasp._core.Box) -> float\n\nFull lengths [m].")
