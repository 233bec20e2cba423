"""YAML texts as plain values: YAML 1.2's numbers, no tags, no key twice, limits on depth and on what aliases expand to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from .._core import InvalidInput
from .._files import printable

Key = str | int

DEEPEST = 50  # levels
MOST_NODES = 100_000  # values, those that aliases stand for included

_NULL = {"", "~", "null", "Null", "NULL"}
_TRUTH = {word: value for value in (True, False) for word in (str(value), str(value).lower(), str(value).upper())}
_INTEGER = re.compile(r"[-+]?[0-9]{1,300}")
_BASED = re.compile(r"0o[0-7]{1,100}|0x[0-9a-fA-F]{1,100}")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_SPECIAL = {
    sign + word: value * float(what)
    for what, words in (("inf", (".inf", ".Inf", ".INF")), ("nan", (".nan", ".NaN", ".NAN")))
    for word in words
    for sign, value in (("", 1.0), ("+", 1.0), ("-", -1.0))
}


def bad_yaml(path: str | Path, error: yaml.YAMLError) -> InvalidInput:
    """What the parser said, in one line with the file's."""
    mark = getattr(error, "problem_mark", None)
    where = f"{path}:{mark.line + 1}" if mark else str(path)
    problem = getattr(error, "problem", None) or str(error).splitlines()[0]
    return InvalidInput(f"{where}: is no valid YAML: {problem}")


def parse_yaml(text: str, source: str) -> tuple[Any, dict[tuple[Key, ...], int]]:
    """The values of a text, and the line of each by its path. Messages name `source` and the line."""
    try:
        tree = _Builder(source).build(yaml.parse(text, Loader=yaml.SafeLoader))
    except yaml.YAMLError as error:
        raise bad_yaml(source, error) from None
    except RecursionError:
        raise InvalidInput(f"{source}: is nested more than {DEEPEST} deep") from None
    except ValueError as error:
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{source}: is no valid YAML: {error}") from None
    lines: dict[tuple[Key, ...], int] = {}
    return ({} if tree is None else _plain(tree, (), lines, source, 0)), lines


@dataclass
class _Tree:
    """One value of a text; `count`: how many values it holds, itself included."""

    line: int
    value: Any = None
    keys: list[_Tree] | None = None  # of a mapping
    values: list[_Tree] | None = None  # of a mapping or a list
    count: int = 1
    open: bool = field(default=False, repr=False)


def _line(event: yaml.Event) -> int:
    return event.start_mark.line + 1 if event.start_mark else 0


class _Builder:
    """Makes trees from a parser's events, without recursion."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.anchors: dict[str, _Tree] = {}
        self.stack: list[_Tree] = []
        self.root: _Tree | None = None
        self.documents = 0

    def fail(self, event: yaml.Event, rule: str) -> InvalidInput:
        return InvalidInput(f"{self.source}:{_line(event)}: {rule}")

    def build(self, events: Iterator[yaml.Event]) -> _Tree | None:
        for event in events:
            if isinstance(event, yaml.DocumentStartEvent):
                self.documents += 1
                if self.documents > 1:
                    raise self.fail(event, "is no valid YAML: must hold one document")
            elif isinstance(event, yaml.AliasEvent):
                self.add(event, self.alias(event))
            elif isinstance(event, yaml.ScalarEvent):
                self.add(event, self.named(event, _Tree(_line(event), self.scalar(event))))
            elif isinstance(event, yaml.SequenceStartEvent | yaml.MappingStartEvent):
                self.begin(event)
            elif isinstance(event, yaml.SequenceEndEvent | yaml.MappingEndEvent):
                self.end(event)
        return self.root

    def begin(self, event: yaml.SequenceStartEvent | yaml.MappingStartEvent) -> None:
        if event.tag:
            raise self.fail(event, f"is no valid YAML: the tag {event.tag!r} is not read")
        if len(self.stack) >= DEEPEST:
            raise self.fail(event, f"nested more than {DEEPEST} deep")
        is_mapping = isinstance(event, yaml.MappingStartEvent)
        tree = _Tree(_line(event), keys=[] if is_mapping else None, values=[], open=True)
        self.stack.append(self.named(event, tree))

    def end(self, event: yaml.Event) -> None:
        tree = self.stack.pop()
        tree.open = False
        self.add(event, tree)

    def named(self, event: Any, tree: _Tree) -> _Tree:
        if event.anchor:
            if event.anchor in self.anchors:
                raise self.fail(event, f"is no valid YAML: the anchor {event.anchor!r} is given twice")
            self.anchors[event.anchor] = tree
        return tree

    def alias(self, event: yaml.AliasEvent) -> _Tree:
        tree = self.anchors.get(event.anchor or "")
        if tree is None or tree.open:
            raise self.fail(event, f"is no valid YAML: the alias {event.anchor!r} stands for nothing that is complete")
        return tree

    def add(self, event: yaml.Event, tree: _Tree) -> None:
        if not self.stack:
            self.root = tree
            return
        outer = self.stack[-1]
        outer.count += tree.count
        if outer.count > MOST_NODES:
            raise self.fail(event, f"holds more than {MOST_NODES} values, those that aliases stand for included")
        assert outer.values is not None
        if outer.keys is not None and len(outer.keys) == len(outer.values):
            outer.keys.append(tree)
        else:
            outer.values.append(tree)

    def scalar(self, event: yaml.ScalarEvent) -> Any:
        text: str = event.value
        if event.tag not in (None, "!", "tag:yaml.org,2002:str"):
            raise self.fail(event, f"is no valid YAML: the tag {event.tag!r} is not read")
        if event.tag or event.style:
            return text
        if text in _NULL:
            return None
        if text in _TRUTH:
            return _TRUTH[text]
        if _INTEGER.fullmatch(text):
            return int(text)
        if _BASED.fullmatch(text):
            return int(text, 0)
        if text in _SPECIAL or _FLOAT.fullmatch(text):
            return _SPECIAL[text] if text in _SPECIAL else float(text)
        return text


def _plain(tree: _Tree, path: tuple[Key, ...], lines: dict[tuple[Key, ...], int], source: str, depth: int) -> Any:
    if depth > DEEPEST:  # by aliases
        raise InvalidInput(f"{source}:{tree.line}: nested more than {DEEPEST} deep")
    lines.setdefault(path, tree.line)
    if tree.values is None:
        return tree.value
    if tree.keys is None:
        return [_plain(child, (*path, i), lines, source, depth + 1) for i, child in enumerate(tree.values)]
    out: dict[str, Any] = {}
    for key_tree, child in zip(tree.keys, tree.values, strict=True):
        key = key_tree.value
        if not isinstance(key, str):
            raise InvalidInput(f"{source}:{key_tree.line}: a key must be a name, not {key!r}")
        if key in out:
            raise InvalidInput(f"{source}:{key_tree.line}: {printable(key)}: is given twice")
        lines[(*path, key)] = key_tree.line
        out[key] = _plain(child, (*path, key), lines, source, depth + 1)
    return out
