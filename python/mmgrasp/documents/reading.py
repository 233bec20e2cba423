"""Strict reading of scenarios and plans: every message names file, line (YAML), key, value and rule."""

from __future__ import annotations

import contextlib
import difflib
import json
import logging
import math
import reprlib
import unicodedata
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from .._core import InvalidInput, IoError, pose
from .._files import printable, read_text
from .._progress import is_callers
from .yaml_text import Key as Key
from .yaml_text import bad_yaml as bad_yaml
from .yaml_text import parse_yaml

LARGEST = 1e6  # no length, angle or time in a file is larger [SI]
SMALLEST = 1e-6  # nor, where it must be positive, smaller
LARGEST_INTEGER = 2**31 - 1
LARGEST_RPY = 4 * math.pi  # [rad]
LONGEST_NAME = 200  # names become file names, and lines on a terminal
DEEPEST = 50  # levels of a file
LARGEST_SCENARIO = 4_000_000  # [bytes]
LARGEST_PLAN = 1_000_000_000  # [bytes]
MOST_VALUES = 50_000_000  # of a JSON text, so that reading it takes memory in proportion to its size

RENAMED = {
    "carry": "place_region",
    "tcp": "tool_link",
    "tcp_link": "tool_link",
    "drop_gap": "drop_height",
    "width": "opening",  # of a grasp
    "holding": "attached",
    "lost_intersections": "too_small_intersections",
}
"""Keys of earlier versions of scenarios, robot profiles and plans by what they are called now."""


def near_miss(wrong: str, known: list[str]) -> str:
    """ "; did you mean x?", or the list of what is known. A name behind the prefix that a mounted robot's names got is meant, too."""
    close = difflib.get_close_matches(wrong, known, 1, 0.5) or [name for name in known if name.endswith(f"_{wrong}")]
    return f"; did you mean {close[0]}?" if close else "; known are " + ", ".join(known)


def check_name(field: str, value: Any, known: Collection[str]) -> None:
    """Raises InvalidInput, with the one that was probably meant, unless the value is one of the known names."""
    if isinstance(value, str) and value in known:
        return
    close = difflib.get_close_matches(value, known, 1, 0.5) if isinstance(value, str) else []
    meant = f"; did you mean {close[0]}?" if close else ""
    raise InvalidInput(f"{field} = {value!r}: must be one of {', '.join(known)}{meant}")


_SHORT = reprlib.Repr()
_SHORT.maxlevel, _SHORT.maxstring, _SHORT.maxother, _SHORT.maxlong = 3, 80, 80, 80
_SHORT.maxlist, _SHORT.maxdict = 8, 8


class Document:
    """A parsed file: raw values, and the line of each key where the format has lines."""

    def __init__(self, source: str, raw: Any, lines: dict[tuple[Key, ...], int]) -> None:
        self.source = source
        self.raw = raw
        self.lines = lines

    @property
    def root(self) -> Node:
        """The whole of it."""
        return Node(self, self.raw, ())


class Node:
    """One value of a document, with typed getters that refuse anything else."""

    def __init__(self, document: Document, raw: Any, path: tuple[Key, ...]) -> None:
        self.document = document
        self.raw = raw
        self.path = path

    @property
    def name(self) -> str:
        """Its keys from the top, e.g. trays[2].pose."""
        text = ""
        for key in self.path:
            text += f"[{key}]" if isinstance(key, int) else (f".{key}" if text else key)
        return text or "(top level)"

    @property
    def place(self) -> str:
        """Its file and line, as far as they are known."""
        path = self.path
        while path and path not in self.document.lines:
            path = path[:-1]
        line = self.document.lines.get(path)
        return f"{self.document.source}:{line}" if line else self.document.source

    def fail(self, rule: str) -> NoReturn:
        """Raises InvalidInput: place, name, value (of a mapping the reader has its place) and the rule that it breaks."""
        shown = "" if isinstance(self.raw, Mapping) else f" = {_SHORT.repr(self.raw)}"
        raise InvalidInput(printable(f"{self.place}: {self.name}{shown}: {rule}"))

    def warn(self, text: str) -> None:
        """Logs what is legal but may surprise, with the place and name of this value."""
        logging.getLogger("mmgrasp").warning("%s", printable(f"{self.place}: {self.name}: {text}"))

    @contextlib.contextmanager
    def blamed(self) -> Iterator[None]:
        """What is refused within the block by code that knows no files is told with place and name of this value."""
        try:
            yield
        except (InvalidInput, IoError) as error:
            if is_callers(error) or self.document.source in str(error):
                raise
            raise type(error)(printable(f"{self.place}: {self.name}: {error}")) from None

    # --- mappings -------------------------------------------------------------------------------------------------
    def mapping(self, required: str = "", optional: str = "") -> Node:
        """Checks the keys: `required` and `optional` are names separated by blanks."""
        if not isinstance(self.raw, Mapping):
            self.fail("must be a mapping")
        needed, known = required.split(), required.split() + optional.split()
        for key in self.raw:
            if key not in known:
                self.child(key).refuse_key(known)
        for key in needed:
            if key not in self.raw:
                self.lacks(key)
        return self

    def lacks(self, key: str) -> NoReturn:
        """Raises InvalidInput for a key that is missing."""
        raise InvalidInput(printable(f"{self.place}: {self.name}: {key} is missing"))

    def refuse_key(self, known: list[str]) -> NoReturn:
        """Raises InvalidInput for an unknown key, with its new name or the nearest known one."""
        key = str(self.path[-1])
        new = RENAMED.get(key)
        hint = f"; it is called {new} now" if new in known else near_miss(key, known)
        raise InvalidInput(printable(f"{self.place}: {self.name}: unknown key{hint}"))

    def read_version(self, current: int, renamed: Mapping[str, str] | None = None) -> None:
        """Checks a file's version: its key `version` must be the current one. Says what keys of older ones are called now."""
        if self["version"].integer() != current:
            used = _keys(self.raw)
            old = ", ".join(f"{old} is {new}" for old, new in (renamed or {}).items() if old in used)
            self["version"].fail(f"this version of mmgrasp reads version {current}" + (f": {old} now" if old else ""))

    def __contains__(self, key: str) -> bool:
        return isinstance(self.raw, Mapping) and key in self.raw

    def child(self, key: Key) -> Node:
        """What stands at a key or index; it must be there."""
        return Node(self.document, self.raw[key], (*self.path, key))

    def __getitem__(self, key: str) -> Node:
        if not isinstance(self.raw, Mapping):
            self.fail("must be a mapping")
        if key not in self.raw:
            self.lacks(key)
        return self.child(key)

    def items(self) -> Iterator[tuple[str, Node]]:
        """Keys and values of a mapping."""
        if not isinstance(self.raw, Mapping):
            self.fail("must be a mapping")
        for key in self.raw:
            if not isinstance(key, str):
                self.child(key).fail("keys must be names")
            yield key, self.child(key)

    # --- lists ----------------------------------------------------------------------------------------------------
    def elements(self) -> list[Node]:
        """The elements of a list."""
        if not isinstance(self.raw, list):
            self.fail("must be a list")
        return [self.child(i) for i in range(len(self.raw))]

    # --- scalars --------------------------------------------------------------------------------------------------
    def number(self, *, above: float | None = None, least: float | None = None, most: float = LARGEST) -> float:
        """A finite number within bounds."""
        value = self.raw
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail("must be a number")
        if isinstance(value, float) and not math.isfinite(value):
            self.fail("must be finite")
        if not -most <= value <= most:
            self.fail(f"must lie between -{most:g} and {most:g}")
        if above is not None and not value > above:
            self.fail(f"must be > {above:g}")
        if above == 0 and value < SMALLEST:
            self.fail(f"must be at least {SMALLEST:g}")
        if least is not None and not value >= least:
            self.fail(f"must be >= {least:g}")
        return float(value)

    def integer(self, *, least: int | None = None) -> int:
        """A whole number within bounds."""
        value = self.raw
        if isinstance(value, bool) or not isinstance(value, int):
            self.fail("must be a whole number")
        if abs(value) > LARGEST_INTEGER:
            self.fail(f"must lie between -{LARGEST_INTEGER} and {LARGEST_INTEGER}")
        if least is not None and value < least:
            self.fail(f"must be >= {least}")
        return value

    def within(self, bounds: tuple[float, float]) -> None:
        """Refuses a number outside of its bounds (those of an option table)."""
        least, most = bounds
        if not least <= self.raw <= most:
            self.fail(f"must be in [{least:g}, {most:g}]")

    def boolean(self) -> bool:
        """true or false."""
        if not isinstance(self.raw, bool):
            self.fail("must be true or false")
        return self.raw

    def string(self) -> str:
        """A text that is not empty."""
        if not isinstance(self.raw, str) or not self.raw:
            self.fail("must be a text that is not empty")
        return self.raw

    def label(self) -> str:
        """A name that people read and that files are called by."""
        value = self.string()
        if len(value) > LONGEST_NAME:
            self.fail(f"must have at most {LONGEST_NAME} characters")
        if any(unicodedata.category(c) in ("Cc", "Cs") for c in value):
            self.fail("must not hold control characters")
        return value

    def choice(self, *known: str) -> str:
        """One of the known words."""
        value = self.string()
        if value not in known:
            self.fail("must be one of " + ", ".join(known))
        return value

    def numbers(self, count: int | None = None, *, above: float | None = None) -> list[float]:
        """A list of numbers, of this length if one is given."""
        elements = self.elements()
        if count is not None and len(elements) != count:
            self.fail(f"must be a list of {count} numbers")
        return [element.number(above=above) for element in elements]

    def array(self, columns: int | None = None) -> np.ndarray:
        """Numbers or rows of numbers as an array, fast for long lists."""
        try:
            if not _all_numbers(self.raw):
                raise TypeError
            out = np.array(self.raw, dtype=float)
        except (TypeError, ValueError, OverflowError):
            self.fail("must be numbers in rows of equal length")
        is_good = np.abs(out) <= LARGEST  # nor is what is no number
        if not is_good.all():
            wrong = self
            for index in np.argwhere(~is_good)[0].tolist():
                wrong = wrong.child(index)
            wrong.fail(f"must be a finite number of at most {LARGEST:g}")
        if columns is not None and (out.ndim != 2 or out.shape[1] != columns):
            self.fail(f"must be rows of {columns} numbers")
        return out

    def pose(self) -> np.ndarray:
        """{xyz, rpy} or {xyz, quat_xyzw} as (4, 4)."""
        self.mapping("xyz", "rpy quat_xyzw")
        xyz = self["xyz"].numbers(3)
        if "rpy" in self and "quat_xyzw" in self:
            self.fail("give rpy or quat_xyzw, not both")
        if "quat_xyzw" in self:
            quat = self["quat_xyzw"].numbers(4)
            if abs(math.sqrt(sum(x * x for x in quat)) - 1) > 1e-3:
                self["quat_xyzw"].fail("must have norm 1")
            return pose(xyz, quat_xyzw=quat)
        rpy = self["rpy"].numbers(3) if "rpy" in self else [0.0, 0.0, 0.0]
        if max(map(abs, rpy)) > LARGEST_RPY:
            self["rpy"].fail("must be angles of at most two turns: they are in radians, not in degrees")
        return pose(xyz, rpy=rpy)


def _all_numbers(raw: Any) -> bool:
    """Without truth values and texts, which numpy would turn into numbers."""
    return all(_all_numbers(value) if isinstance(value, list) else type(value) in (int, float) for value in raw)


def _keys(raw: Any) -> set[str]:
    """The keys of all mappings in a document."""
    if isinstance(raw, Mapping):
        return {str(key) for key in raw}.union(*map(_keys, raw.values()))
    return set().union(*map(_keys, raw)) if isinstance(raw, list) else set()


def read_yaml(path: Path) -> Document:
    """Parses a YAML file; syntax errors name the line."""
    raw, lines = parse_yaml(read_text(path, LARGEST_SCENARIO), printable(str(path)))
    return Document(str(path), raw, lines)


def read_json(path: Path) -> Document:
    """Parses a JSON file; syntax errors name the line. Keys given twice, NaN and infinity are refused."""
    text, shown = read_text(path, LARGEST_PLAN), printable(str(path))
    if (values := sum(map(text.count, ",[{"))) > MOST_VALUES:
        raise InvalidInput(f"{shown}: holds about {values:,} values, more than {MOST_VALUES:,}")

    def once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        out = dict(pairs)
        if len(out) < len(pairs):
            twice = next(key for key, count in Counter(key for key, _ in pairs).items() if count > 1)
            raise InvalidInput(f"{shown}: the key {twice!r} is given twice")
        return out

    wrong: list[_NoNumber] = []

    def no_number(rule: str) -> _NoNumber:
        wrong.append(_NoNumber(rule))  # where it stands is known when all is read
        return wrong[-1]

    def integer(digits: str) -> int | _NoNumber:
        return int(digits) if len(digits) <= 300 else no_number(f"a number has {len(digits)} digits")

    try:
        raw = json.loads(
            text,
            object_pairs_hook=once,
            parse_constant=lambda word: no_number(f"{word} is no number in JSON"),
            parse_int=integer,
        )
    except json.JSONDecodeError as error:
        raise InvalidInput(f"{shown}:{error.lineno}: is no valid JSON: {error.msg}") from None
    except RecursionError:
        raise InvalidInput(f"{shown}: is nested too deeply") from None
    check_depth(raw, str(path))
    document = Document(str(path), raw, {})
    if wrong:
        _refuse_no_numbers(document.root)
    return document


class _NoNumber:
    """What stands for a number in a JSON text and is none."""

    def __init__(self, rule: str) -> None:
        self.rule = rule


def _refuse_no_numbers(node: Node) -> None:
    """Raises InvalidInput with the place of the first of them."""
    if isinstance(node.raw, _NoNumber):
        raise InvalidInput(printable(f"{node.place}: {node.name}: {node.raw.rule}"))
    keys: Iterable[Key] = (
        node.raw if isinstance(node.raw, dict) else range(len(node.raw)) if isinstance(node.raw, list) else ()
    )
    for key in keys:
        _refuse_no_numbers(node.child(key))


def check_depth(raw: Any, source: str) -> None:
    """Raises InvalidInput for values that are nested more than DEEPEST deep."""
    level = [raw]
    for _ in range(DEEPEST):
        level = [
            value
            for outer in level
            if isinstance(outer, list | dict)
            for value in (outer.values() if isinstance(outer, dict) else outer)
            if isinstance(value, list | dict)
        ]
        if not level:
            return
    raise InvalidInput(f"{printable(source)}: is nested more than {DEEPEST} deep")
