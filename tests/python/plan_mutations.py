"""Every field of a plan changed in five ways: what `verify` does not refuse. As a script: `plan_mutations.py PLAN SCENARIO`, all of them."""

from __future__ import annotations

import copy
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mmgrasp as mg
from mmgrasp._core import verify as checks
from mmgrasp.documents.reading import Document, read_json
from mmgrasp.part_supply.figures import check_figures
from mmgrasp.part_supply.plan_file import check_form
from mmgrasp.part_supply.plan_reader import plan_to_check
from mmgrasp.part_supply.plan_writer import scenario_to_dict
from mmgrasp.part_supply.verification import differences

Path_ = tuple[str | int, ...]
REMOVED = object()

HARMLESS = {
    "mmgrasp": "the version that wrote the plan: reported, not used",
    "scenario.name": "a title",
    "scenario.source": "where the scenario was read from: reported, not used",
    "scenario.options.threads": "plans do not depend on it",
    "scenario.options.seed": "another seed is another search, and any answer is checked",
    "timings[].stage": "reported only",
    "timings[].seconds": "reported only",
    "timings": "reported only",
    "timings[]": "reported only",
    "regions[].base_poses_in_collision": "counts what was tried: reported only",
    "lost_intersections[].radius": "smaller than the uncertainty either way: reported only",
    "lost_intersections[].centre": "reported only",
    "lost_intersections[].centre[]": "reported only",
    "lost_intersections": "reported only",
    "lost_intersections[]": "reported only",
    "intersections[].radius": "a smaller disc lies there as well: reported only",
    "intersections[].centre[]": "the disc still lies in the regions there: reported only",
    "route[].duration": "must only not be too short: bases may drive slower than they can",
    "stops[].radius": "a smaller disc holds as well",
    "grid.nx": "a column of empty cells more or less at the border",
    "grid.ny": "a row of empty cells more or less at the border",
    "regions[].cells.0": "a row of cells fewer at the border: regions are checked by samples",
    "route[].poses": "the last pose twice: the base stands there",
    "picks[].motions[].accelerations[][]": "within the limits at one of the places where accelerations may jump",
    "scenario.robot.meshes": "the files are named again at the shapes, with their checksums",
}
"""Patterns of fields that may change unnoticed, and why that does no harm."""


def fields(value: Any, path: Path_ = ()) -> Iterator[Path_]:
    """Paths of all values, those that hold others first."""
    if path:
        yield path
    if isinstance(value, dict):
        for key in value:
            yield from fields(value[key], (*path, key))
    elif isinstance(value, list):
        for i in range(len(value)):
            yield from fields(value[i], (*path, i))


def pattern(path: Path_) -> str:
    """A path without its indices and names of maps: trays[].pose.xyz[]."""
    text = ""
    for key in path:
        text += "[]" if isinstance(key, int) else (f".{key}" if text else key)
    return text


def at(plan: Any, path: Path_) -> Any:
    for key in path:
        plan = plan[key]
    return plan


def changes(value: Any) -> list[Any]:
    """Five other values."""
    if isinstance(value, bool):
        return [REMOVED, None, "yes", 2, not value]
    if isinstance(value, int):
        return [REMOVED, None, str(value), value + 1, value - 1 if value > 0 else value + 7]
    if isinstance(value, float):
        step = max(0.05, 0.2 * abs(value))
        return [REMOVED, None, str(value), value + step, value - step]
    if isinstance(value, str):
        return [REMOVED, None, 3, value + "x", ""]
    if isinstance(value, list):
        return [REMOVED, None, 3, [*value, copy.deepcopy(value[-1]) if value else 0], value[:-1] if value else [0, 0]]
    return [REMOVED, None, 3, [], {**value, "extra": 1}]


def changed(plan: dict[str, Any], path: Path_, new: Any) -> dict[str, Any]:
    """A copy of the plan that shares what is not on the way to the field."""
    out: dict[str, Any] = copy.copy(plan)
    here: Any = out
    for key in path[:-1]:
        here[key] = copy.copy(here[key])
        here = here[key]
    if new is REMOVED:
        del here[path[-1]]
    else:
        here[path[-1]] = new
    return out


def refuses(expected: dict[str, Any] | None, samples: int = 60) -> Callable[[dict[str, Any]], bool]:
    """Verify's answer, the quick rules first."""

    def refused(plan: dict[str, Any]) -> bool:
        try:
            root = Document("plan", plan, {}).root
            check_form(root)
            if plan["outcome"] != "solved":
                return True
            if expected is not None and differences(plan["scenario"], expected):
                return True
            to_check = plan_to_check(root)
            if check_figures(plan):
                return True
        except mg.Error:
            return True
        return bool(checks.check_plan(to_check, samples=samples, region_samples=5, threads=1).faults)

    return refused


def survivors(
    plan: dict[str, Any], expected: dict[str, Any] | None, of_each: int, samples: int = 60
) -> tuple[int, list[tuple[str, str]]]:
    """How many changes were tried, and those that were not refused: (pattern of the field, what it became).

    `of_each`: how many fields of one pattern are changed, spread over all of them.
    """
    by_pattern: dict[str, list[Path_]] = {}
    for path in fields(plan):
        by_pattern.setdefault(pattern(path), []).append(path)
    tried, left = 0, []
    refused = refuses(expected, samples)
    for name, paths in by_pattern.items():
        step = max(1, len(paths) // of_each)
        for path in paths[step // 2 :: step][:of_each]:
            old = at(plan, path)
            for new in changes(old):
                if new is not REMOVED and new == old and type(new) is type(old):
                    continue
                if new is REMOVED and isinstance(path[-1], int):
                    new = None  # lists are shortened at the list
                tried += 1
                if not refused(changed(plan, path, new)):
                    left.append((name, "removed" if new is REMOVED else repr(new)[:40]))
    return tried, left


def main() -> int:
    plan = read_json(Path(sys.argv[1])).root.raw
    expected = scenario_to_dict(mg.load_scenario(sys.argv[2])) if len(sys.argv) > 2 else None
    tried, left = survivors(plan, expected, of_each=3, samples=200)
    for name, new in left:
        print(f"{name} = {new}: {HARMLESS.get(name, 'NOT EXPLAINED')}")
    harmful = [name for name, _ in left if name not in HARMLESS]
    print(f"{tried} changes, {len(left)} not refused, {len(harmful)} of them unexplained")
    return 1 if harmful else 0


if __name__ == "__main__":
    sys.exit(main())
