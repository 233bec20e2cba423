"""Every field of a document changed in every way: what tests of checks feed on."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

Place = tuple[str | int, ...]
REMOVED = object()
ROUNDING = 1e-12


class Change(NamedTuple):
    """A field and what it becomes."""

    field: Place
    kind: str
    place: Place
    """Where the new value stands: the field, or the list or mapping it is in."""
    new: Any


def fields(value: Any, place: Place = ()) -> Iterator[Place]:
    """Places of all values, those that hold others first."""
    if place:
        yield place
    pairs: Iterable[tuple[Any, Any]] = ()
    if isinstance(value, dict):
        pairs = value.items()
    elif isinstance(value, list):
        pairs = enumerate(value)
    for key, inner in pairs:
        yield from fields(inner, (*place, key))


def pattern(place: Place) -> str:
    """A place without its indices: trays[].pose.xyz[]."""
    text = ""
    for key in place:
        text += "[]" if isinstance(key, int) else (f".{key}" if text else key)
    return text


def at(document: Any, place: Place) -> Any:
    for key in place:
        document = document[key]
    return document


def changed(document: dict[str, Any], place: Place, new: Any) -> dict[str, Any]:
    """A copy of the document that shares what is not on the way to the place."""
    out: dict[str, Any] = copy.copy(document)
    here: Any = out
    for key in place[:-1]:
        here[key] = copy.copy(here[key])
        here = here[key]
    if new is REMOVED:
        del here[place[-1]]
    else:
        here[place[-1]] = new
    return out


def same(a: Any, b: Any) -> bool:
    """Equal, but for how numbers are rounded: a motion whose velocities are the same backwards is not changed by turning them round."""
    if type(a) is not type(b):
        return False
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return bool(abs(a - b) <= ROUNDING) if isinstance(a, float) else bool(a == b)


def _of_number(value: float) -> Iterator[tuple[str, Any]]:
    if isinstance(value, int):
        yield "more", value + 1
        yield "less", value - 1
    else:  # beyond every tolerance, but not much
        yield "more", value + max(0.01, 0.02 * abs(value))
        yield "less", value - max(0.01, 0.02 * abs(value))
    yield "sign", -value
    yield "zero", 0 * value
    yield "doubled", 2 * value if value else type(value)(1)
    yield "far", value + max(0.05, 0.2 * abs(value))
    yield "type", str(value)
    yield "type", math.nan


def _of_text(value: str, others: list[Any]) -> Iterator[tuple[str, Any]]:
    yield "misspelt", value + "x"
    yield "emptied", ""
    yield "type", 3
    for other in others:
        if other != value:
            yield "other", other
            break


def _of_list(value: list[Any]) -> Iterator[tuple[str, Any]]:
    yield "dropped", value[:-1]
    yield "doubled", [*value, copy.deepcopy(value[-1])] if value else [0]
    yield "reordered", value[::-1]
    yield "emptied", []
    yield "type", 3


def _of_mapping(value: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    last = next(reversed(value), None)
    yield "key added", {**value, f"{last}x": copy.deepcopy(value[last]) if last is not None else 1}
    yield "emptied", {}
    yield "type", []
    if last is not None:
        yield "key misspelt", {f"{k}x" if k == last else k: v for k, v in value.items()}


def changes(document: dict[str, Any], place: Place, others: list[Any]) -> Iterator[Change]:
    """What a field may become; `others`: texts that stand at such places."""
    value = at(document, place)
    of_value: Iterable[tuple[str, Any]]
    if isinstance(value, bool):
        of_value = [("flipped", not value), ("type", "yes"), ("type", 2)]
    elif isinstance(value, int | float):
        of_value = _of_number(value)
    elif isinstance(value, str):
        of_value = _of_text(value, others)
    else:
        of_value = _of_list(value) if isinstance(value, list) else _of_mapping(value)
    for kind, new in [*of_value, ("type", None)]:
        if not same(new, value):
            yield Change(place, kind, place, new)
    if isinstance(place[-1], str):
        yield Change(place, "removed", place, REMOVED)
        return
    row = at(document, place[:-1])
    following = (place[-1] + 1) % len(row)
    if not same(row[following], value):
        swapped = list(row)
        swapped[place[-1]], swapped[following] = row[following], value
        yield Change(place, "swapped", place[:-1], swapped)
    yield Change(place, "removed", place[:-1], row[: place[-1]] + row[place[-1] + 1 :])


def all_changes(document: dict[str, Any], of_each: int) -> Iterator[Change]:
    """Changes of every field; of those that differ in indices alone `of_each`, spread over all of them."""
    by_pattern: dict[str, list[Place]] = {}
    texts: dict[str | int, dict[str, None]] = {}
    for place in fields(document):
        by_pattern.setdefault(pattern(place), []).append(place)
        if isinstance(value := at(document, place), str):
            texts.setdefault(_key(place), {})[value] = None
    for places in by_pattern.values():
        step = max(1, len(places) // of_each)
        for place in places[step // 2 :: step][:of_each]:
            yield from changes(document, place, list(texts.get(_key(place), {})))


def _key(place: Place) -> str | int:
    """The last name on the way to a place."""
    return next(key for key in reversed(place) if isinstance(key, str))


Harmless = dict[str, tuple[str, str]]
"""For each pattern the kinds of changes ("any" for all but those of type), and why they do no harm."""


class Result(NamedTuple):
    tried: int
    left: list[Change]
    """What was not refused."""


def try_out(
    document: dict[str, Any], refused: Callable[[dict[str, Any]], bool], of_each: int, every: int = 1
) -> Result:
    """Asks `refused` of each change; with `every` above 1 of one in so many."""
    tried, left = 0, []
    for number, change in enumerate(all_changes(document, of_each)):
        if number % every:
            continue
        tried += 1
        if not refused(changed(document, change.place, change.new)):
            left.append(change)
    return Result(tried, left)


def explained(change: Change, harmless: Harmless) -> bool:
    kinds, _ = harmless.get(pattern(change.field), ("", ""))
    return change.kind in kinds.split(", ") or (kinds == "any" and change.kind != "type")


def report(result: Result, harmless: Harmless) -> int:
    """Prints what was not refused, and entries of `harmless` that nothing needs; how many of both are wrong."""
    for change in result.left:
        _, reason = harmless.get(pattern(change.field), ("", ""))
        new = "removed" if change.new is REMOVED else repr(change.new)[:50]
        text = reason if explained(change, harmless) else "NOT EXPLAINED"
        print(f"{pattern(change.field)}: {change.kind}: {new}: {text}")
    wrong = sum(not explained(change, harmless) for change in result.left)
    unneeded = harmless.keys() - {pattern(change.field) for change in result.left}
    for name in sorted(unneeded):
        print(f"{name}: listed as harmless, every change was refused")
    share = 100 * (1 - len(result.left) / result.tried)
    print(
        f"{result.tried} changes, {len(result.left)} not refused ({share:.2f} % refused), {wrong} of these unexplained"
    )
    return wrong + len(unneeded)
