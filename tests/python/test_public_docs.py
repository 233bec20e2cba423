"""Everything public of the C++ library has a docstring; comments in C++ have a subject."""

from __future__ import annotations

import enum
import inspect
import re
from collections.abc import Iterator
from types import ModuleType

from conftest import REPOSITORY
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


def test_comments_have_a_subject() -> None:
    """One that begins with Of, By or In leaves it to the reader to find out what is spoken of."""
    comment, fragment = re.compile(r"\s*//"), re.compile(r"//[/!]?<? *(Of|By|In) ")
    lost: list[str] = []
    for path in sorted((REPOSITORY / "cpp").rglob("*.[hci]*")):
        before = ""
        for line in path.read_text().splitlines():
            continues = comment.match(line) and comment.match(before)
            if fragment.search(line) and not continues:
                lost.append(f"{path.relative_to(REPOSITORY)}: {line.strip()}")
            before = line
    assert lost == []
