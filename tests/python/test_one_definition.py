"""No two types of the library share a name in one namespace.

The linker takes one of two such types' functions for both, vectors of them mix up memory, and nothing warns: the planner
crashed when the grasp sampler got a GraspCandidate of its own.
"""

from __future__ import annotations

import collections
import re
from pathlib import Path

from conftest import REPOSITORY

OPENED = re.compile(r"namespace\s*([\w:]*)\s*\{(?!.*\})")
CLOSED = "}  // namespace"
DEFINED = re.compile(r"(?:struct|class)\s+(?:MMGRASP_EXPORT\s+)?(\w+)(?:\s+final)?(?:\s*:(?!:)[^;]*)?\s*\{")


def types_of(text: str) -> list[str]:
    """Full names of the types defined outside of anonymous namespaces and of other types."""
    found: list[str] = []
    inside: list[str] = []
    for line in text.splitlines():
        if opened := OPENED.match(line):
            inside.append(opened.group(1))
        elif line.startswith(CLOSED):
            inside.pop()
        elif (defined := DEFINED.match(line)) and "" not in inside:
            found.append("::".join([*inside, defined.group(1)]))
    return found


def test_types_are_found_with_their_namespaces() -> None:
    text = """
namespace mmgrasp {
namespace detail {
struct Angles {
};
}  // namespace detail
namespace {
class Hidden {
};
}  // namespace
class MMGRASP_EXPORT Grid final : public Field {
struct Grid::Impl {
}  // namespace mmgrasp
"""
    assert types_of(text) == ["mmgrasp::detail::Angles", "mmgrasp::Grid"]


def test_each_name_is_one_type() -> None:
    places: dict[str, list[Path]] = collections.defaultdict(list)
    for path in sorted((REPOSITORY / "cpp").rglob("*.[ch]pp")):
        for name in types_of(path.read_text()):
            places[name].append(path.relative_to(REPOSITORY))
    assert len(places) > 600
    assert {name: paths for name, paths in places.items() if len(paths) > 1} == {}
