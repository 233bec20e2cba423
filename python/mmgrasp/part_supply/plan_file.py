"""plan.json: everything resolved, so that a plan can be read, shown and checked without its scenario (docs/plan_format.md)."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from .._argument_errors import checked
from .._core import InvalidInput
from .._files import SCHEMAS
from ..documents.reading import RENAMED, Node, read_json
from ..scenario.schema import check_schema

VERSION = 4


@checked
def read_plan(path: str | os.PathLike[str]) -> dict[str, Any]:
    """The content of a plan.json; raises IoError or InvalidInput when it is not one, or not of its schema."""
    root = read_json(Path(path)).root
    check_form(root)
    content: dict[str, Any] = root.raw
    return content


def check_header(root: Node) -> None:
    """Raises InvalidInput unless format and version are those of a plan that this version reads."""
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.place}: is no plan: the key format: mmgrasp-plan is missing")
    root["format"].choice("mmgrasp-plan")
    root.read_version(VERSION, RENAMED)


def check_form(root: Node) -> None:
    """Raises InvalidInput unless every value has its place and form (plan.schema.json)."""
    check_header(root)
    check_schema(root, plan_schema())


def check_names(root: Node) -> None:
    """Raises InvalidInput when an index or a name in the answer leads nowhere: for those who draw a plan."""
    plan = root.raw
    parts = {part["name"]: part for part in plan["scenario"]["parts"]}
    trays = {tray["name"] for tray in plan["scenario"]["trays"]}
    for key in ("regions", "intersections", "too_small_intersections", "stops"):
        for node in root[key].elements():
            for tray in [node["tray"]] if key == "regions" else node["trays"].elements():
                if tray.raw not in trays:
                    tray.fail("no such tray")
    for stop in root["stops"].elements():
        if stop["intersection"].raw >= len(plan["intersections"]):
            stop["intersection"].fail("no such intersection")
    for pick in root["picks"].elements():
        if pick["part"].raw not in parts:
            pick["part"].fail("no such part")
        if pick["stop"].raw >= len(plan["stops"]):
            pick["stop"].fail("no such stop")
        if pick["grasp"].raw >= len(parts[pick["part"].raw]["grasps"]):
            pick["grasp"].fail("the part has no such grasp")
    for motion in root["drive_by"]["motions"].elements() if "drive_by" in root else []:
        if motion["pick"].raw >= len(plan["picks"]):
            motion["pick"].fail("no such pick")


def plan_schema() -> dict[str, Any]:
    """The JSON Schema of plan.json."""
    schema: dict[str, Any] = json.loads((SCHEMAS / "plan.schema.json").read_text())
    return schema
