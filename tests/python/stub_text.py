"""Makes the text that pybind11-stubgen writes precise: every option a typed keyword, numbers as float and int."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from types import ModuleType
from typing import Any

OPTION = re.compile(r"^\s+(?P<name>\w+): (?P<type>.+?) = (?P<default>.+?)  # ")

SIMPLER = (
    (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
    (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
    (r'typing\.Annotated\[(numpy\.typing\.NDArray\[[\w.]+\]), "[^"]*"\]', r"\1"),
    (r'typing\.Annotated\[(numpy\.typing\.ArrayLike), [\w.]+, "[^"]*"\]', r"\1"),
    (r"(-> |: )dict(?=:| =|,|\)|$| \|)", r"\1dict[str, typing.Any]"),
    (r"(-> |: )tuple(?=:|\))", r"\1tuple[typing.Any, ...]"),
)


def precise(stub: str, module: ModuleType) -> str:
    """The stub of `module` as editors and mypy like it; raises ValueError where a call's options are not known."""
    lines = with_members(stub.splitlines(), module)
    lines = [with_options(line, lines[i + 1 :]) for i, line in enumerate(lines)]
    return with_imports("\n".join(simpler(line) for line in lines) + "\n")


def simpler(line: str) -> str:
    if not re.match(r"^\s*(def |\w+: )", line):
        return line
    for pattern, replacement in SIMPLER:
        line = re.sub(pattern, replacement, line)
    return with_none(line)


def with_none(line: str) -> str:
    """A parameter whose default is None may be None."""
    signature = re.match(r"^(\s*def \w+\()(.*)(\) -> .*)$", line)
    if not signature:
        return line
    parameters = [may_be_none(parameter) for parameter in split_parameters(signature[2])]
    return signature[1] + ", ".join(parameters) + signature[3]


def may_be_none(parameter: str) -> str:
    annotation = parameter.removesuffix(" = None")
    if annotation == parameter or "None" in annotation.split(": ", 1)[1].split(" | "):
        return parameter
    return annotation + " | None = None"


def split_parameters(text: str) -> list[str]:
    """At the commas that are in no bracket."""
    parts, depth = [""], 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts if part]


def with_options(line: str, following: Iterable[str]) -> str:
    """A signature with the keywords that its docstring lists in place of **kwargs."""
    line = re.sub(r", \*\*kwargs: typing(_extensions)?\.Never\)", ")", line)
    if "**kwargs" not in line or not line.lstrip().startswith("def "):
        return line
    options = [
        f"{o['name']}: {o['type']} = {'...' if o['default'] in ('inf', '-inf') else o['default']}"
        for o in listed(following)
    ]
    if not options and line.startswith("def _"):
        return line.replace("**kwargs", "**kwargs: typing.Any")
    if not options:
        raise ValueError(f"no option is listed in the docstring of: {line.strip()}")
    keyword_only = "" if re.search(r"[(,] ?\*,", line) else "*, "
    return line.replace("**kwargs", keyword_only + ", ".join(options))


def listed(following: Iterable[str]) -> list[re.Match[str]]:
    """The options in the docstring that the lines begin with."""
    found, quotes = [], 0
    for line in following:
        quotes += line.count('"""')
        if quotes >= 2 or quotes == 0:
            break
        if option := OPTION.match(line):
            found.append(option)
    return found


def option_types(calls: Mapping[str, tuple[str, Any, Sequence[str]]]) -> str:
    """A module with a TypedDict of the options of each call: by type name, what it is called, the call, names left out."""
    lines = [
        '"""The options of calls as types, for functions that pass keywords on. Written by `./dev stubs`."""', "",
        "from typing import TypedDict",
    ]  # fmt: skip
    for name, (said, call, left_out) in calls.items():
        lines += ["", "", f"class {name}(TypedDict, total=False):", f'    """Keyword options of {said}: defaults and meaning are there."""', ""]  # fmt: skip
        options = [found for line in (call.__doc__ or "").splitlines() if (found := OPTION.match(line))]
        assert options, said
        kinds = {o["name"]: re.sub(r"numpy\.typing\.|collections\.abc\.", "", o["type"]) for o in options}
        lines += [f"    {option}: {kind}" for option, kind in kinds.items() if option not in left_out]
    if any("ArrayLike" in line for line in lines):
        lines[3:3] = ["", "from numpy.typing import ArrayLike"]
    if any("Mapping[" in line for line in lines):
        lines[2:2] = ["from collections.abc import Mapping"]
    return "\n".join(lines) + "\n"


def with_members(lines: list[str], module: ModuleType) -> list[str]:
    """Members of enumerations with their values instead of annotations, and no __new__ of theirs."""
    out: list[str] = []
    enumeration = ""
    for line in lines:
        if found := re.match(r"^class (\w+)", line):
            enumeration = found[1] if "enum.Enum" in line else ""
        member = re.match(r"^    (\w+): typing\.ClassVar\[", line)
        if enumeration and member:
            out.append(f"    {member[1]} = {getattr(module, enumeration)[member[1]].value}")
        elif enumeration and "def __new__(cls, value)" in line:
            out.pop()
        elif enumeration and line == "        ..." and not out[-1].lstrip().startswith("def "):
            continue
        else:
            out.append(line)
    return out


def with_imports(stub: str) -> str:
    """Every module that the annotations name, imported once."""
    wanted = {
        name
        for name in ("collections.abc", "mmgrasp.records", "os", "typing")
        if re.search(rf"\b{re.escape(name)}\.", stub)
    }
    missing = sorted(name for name in wanted if f"\nimport {name}\n" not in stub)
    return stub.replace(
        "from __future__ import annotations\n",
        "from __future__ import annotations\n" + "".join(f"import {name}\n" for name in missing),
        1,
    )
