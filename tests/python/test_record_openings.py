"""Every class, record, enumeration and type alias of the public C++ headers opens with a sentence that says what it is."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from conftest import REPOSITORY

HEADERS = REPOSITORY / "cpp" / "include" / "mmgrasp"

_NOTHING = re.compile(r"""//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])'""")  # comments and literals
_DEFINITION = re.compile(
    r"(?:template\s*<[^{;]*>\s*)?(?:(?:struct|class|union|enum(?:\s+(?:class|struct))?)\s+(?:MMGRASP_EXPORT\s+)?(\w+)[^;{}()=]*\{"
    r"|using\s+(\w+)\s*=)"
)
_NAMESPACE = re.compile(r"(?:inline\s+)?namespace\s+([\w:]*)\s*\{")


def public_types(text: str) -> Iterator[tuple[str, int]]:
    """Name and line (from 0) of each type that a header defines at namespace scope, outside of namespaces called detail."""
    code = _NOTHING.sub(lambda found: " " * len(found.group()), text)
    scopes: list[str] = []  # one a brace that is open: the namespace's name, or "" for anything else
    at = 0
    while at < len(code):
        here = code[at]
        if here == "}":
            scopes.pop()
        elif (begins := at == 0 or not (code[at - 1].isalnum() or code[at - 1] == "_")) and (
            namespace := _NAMESPACE.match(code, at)
        ):
            scopes.append(namespace.group(1))
            at = namespace.end()
            continue
        elif begins and (defined := _DEFINITION.match(code, at)):
            if all(scopes) and "detail" not in scopes:
                yield defined.group(1) or defined.group(2), code.count("\n", 0, at)
            if defined.group(1):
                scopes.append("")
            at = defined.end()
            continue
        elif here == "{":
            scopes.append("")
        at += 1
    assert scopes == []


def opening(lines: list[str], line: int) -> str:
    """The comment in front of a line, as one text; empty where there is none."""
    first = line
    while first > 0 and lines[first - 1].startswith("///"):
        first -= 1
    return " ".join(text.removeprefix("///").strip() for text in lines[first:line])


def says_what_it_is(name: str, comment: str) -> bool:
    """A sentence of four words or more, not all of them taken from the name."""
    sentence = re.match(r"(.*?)(?:\.(?:\s|$)|:$)", comment)
    words = re.findall(r"\w+", sentence.group(1).lower() if sentence else "")
    return len(words) >= 4 and any(word not in name.lower() for word in words)


def missing(folder: Path) -> list[str]:
    """Where a public type lacks its opening: file, line and name."""
    lost: list[str] = []
    for path in sorted(folder.rglob("*.hpp")):
        if "detail" in path.relative_to(folder).parts:
            continue
        text = path.read_text()
        lines = text.splitlines()
        lost += [
            f"{path.relative_to(folder)}:{line + 1}: {name}"
            for name, line in public_types(text)
            if not says_what_it_is(name, opening(lines, line))
        ]
    return lost


def test_every_public_type_says_what_it_is() -> None:
    found = [name for path in HEADERS.rglob("*.hpp") for name, _ in public_types(path.read_text())]
    assert len(found) > 250
    assert missing(HEADERS) == []


def test_the_parser_finds_types_at_namespace_scope_alone(tmp_path: Path) -> None:
    (tmp_path / "detail").mkdir()
    (tmp_path / "detail" / "hidden.hpp").write_text("namespace mmgrasp {\nstruct Hidden {};\n}\n")
    (tmp_path / "some.hpp").write_text(
        """#pragma once
namespace mmgrasp {
class Declared;
struct Impl *pointer();
namespace detail {
struct Private {};
}
struct MMGRASP_EXPORT Bare {  // struct Comment {
  struct Nested {};
  const char* text = "struct Literal {";
};
/// A record that says what it is for.
template <typename T>
struct Documented {
  T value{};
};
/// Bare word.
enum class Thin { one };
using Alias = int;
/// The number of a part in its tray.
using Said = int;
}  // namespace mmgrasp
"""
    )
    assert missing(tmp_path) == ["some.hpp:8: Bare", "some.hpp:18: Thin", "some.hpp:19: Alias"]
    assert [name for name, _ in public_types((tmp_path / "some.hpp").read_text())] == [
        "Bare",
        "Documented",
        "Thin",
        "Alias",
        "Said",
    ]
