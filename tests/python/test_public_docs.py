"""Everything public of the C++ library has a docstring; comments and docstrings have a subject."""

from __future__ import annotations

import ast
import enum
import inspect
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import pytest

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


LOST = "(Of|By|In) "
"""What begins so leaves it to the reader to find out what is spoken of."""


def comments_without_a_subject(path: Path, mark: str) -> Iterator[str]:
    """First lines of comments alone: `mark` is what a comment begins with."""
    comment, fragment = re.compile(rf"\s*{mark}"), re.compile(rf"{mark}[/!]?<? *{LOST}")
    before = ""
    for line in path.read_text().splitlines():
        if fragment.search(line) and not (comment.match(line) and comment.match(before)):
            yield f"{path.relative_to(REPOSITORY)}: {line.strip()}"
        before = line


def strings_without_a_subject(path: Path) -> Iterator[str]:
    """Docstrings, those of attributes too."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            text = node.value.value
            if isinstance(text, str) and re.match(rf"\s*{LOST}", text):
                yield f"{path.relative_to(REPOSITORY)}:{node.lineno}: {text.strip().splitlines()[0]}"


def test_comments_have_a_subject() -> None:
    assert [
        lost
        for path in sorted((REPOSITORY / "cpp").rglob("*.[hci]*"))
        for lost in comments_without_a_subject(path, "//")
    ] == []


def test_docstrings_have_a_subject() -> None:
    """Those of bound classes, and all of the package, the tests, the examples and the benchmarks."""
    said = {name: re.sub(r"\A.* -> .*\n+", "", doc or "") for name, doc in entries(_core)}  # without the signature
    assert [name for name, doc in said.items() if re.match(LOST, doc)] == []
    paths = [
        path
        for folder in ("python", "tests", "examples", "benchmarks")
        for path in sorted((REPOSITORY / folder).rglob("*.py"))
    ]
    assert len(paths) > 300
    lost = [lost for path in paths for lost in strings_without_a_subject(path)]
    assert lost + [lost for path in paths for lost in comments_without_a_subject(path, "# ")] == []


def test_what_begins_without_a_subject_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("test_public_docs.REPOSITORY", tmp_path)
    path = tmp_path / "some.py"
    of, by, within = LOST.strip("() ").split("|")
    path.write_text(f'"""Some."""\nx = 1\n"""{of} x."""\n# {within} a line.\n# {by} the way.\ny = 2  # {of} y.\n')
    assert list(strings_without_a_subject(path)) == ["some.py:3: Of x."]
    assert list(comments_without_a_subject(path, "# ")) == [
        f"some.py: # {within} a line.",
        f"some.py: y = 2  # {of} y.",
    ]
