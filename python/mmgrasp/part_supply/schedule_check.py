"""Checks a finished schedule again, without what made it: robots read, placed and measured by the C++ module `verify`, on the one clock of all."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .._argument_errors import checked
from .._core import Error, InvalidInput
from .._core import verify as checks
from .._files import read_head, sha256_of
from .._progress import Progress
from ..documents.reading import Document, Node, read_json
from .carried_out import check_carried_out
from .plan_file import check_form
from .plan_reader import plan_to_check
from .schedule_rules import FORMAT, LEAST_CLEARANCE, MOST_CLEARANCE, VERSION, check_same_room

_HEAD = 200  # bytes of a file in which its format is looked for
_SAME = 1e-6  # [s]; what sums of times lose


@dataclass
class ScheduleVerdict:
    """What the check of a schedule found. Without faults no two robots come closer to each other than the clearance, less 1 mm, at any moment."""

    faults: list[checks.Fault]
    robots: int = 0
    clearance: float = 0.0

    @property
    def ok(self) -> bool:
        """No fault was found."""
        return not self.faults

    def to_dict(self) -> dict[str, Any]:
        """Plain values, as `mmgrasp verify --json` prints them."""
        return {
            "ok": self.ok,
            "faults": [fault.to_dict() for fault in self.faults],
            "robots": self.robots,
            "clearance": self.clearance,
        }


def is_schedule(path: Path) -> bool:
    """Whether a file says that it is a schedule; whether it is a good one is told when it is read."""
    head = read_head(path, _HEAD)
    if b'"format"' in head:
        return f'"{FORMAT}"'.encode() in head
    return head.lstrip().startswith(b"{") and _says_so(path)


def _says_so(path: Path) -> bool:
    """The same of a file with its keys in another order."""
    try:
        root = read_json(path).root
    except Error:
        return False
    return isinstance(root.raw, dict) and root.raw.get("format") == FORMAT


@checked
def verify_schedule(schedule: dict[str, Any] | str | os.PathLike[str], *, progress: Progress = None) -> ScheduleVerdict:
    """Checks a schedule given as schedule.json or as its content: no two of its robots meet at any moment, waits and times agree, and no piece begins early.

    The plans are read from the files that the schedule names; whether each of them holds is said by verify_plan. Raises InvalidInput or IoError for a file
    that is no schedule, and where a plan has changed since.
    """
    document = Document("schedule", schedule, {}) if isinstance(schedule, dict) else read_json(Path(schedule))
    root = document.root
    _check_header(root)
    clearance = _number_within(root["clearance"], LEAST_CLEARANCE, MOST_CLEARANCE)
    outcome = root["outcome"].string()
    if outcome != "solved":
        message = f"the file holds no schedule: its outcome is {outcome}"
        return ScheduleVerdict([checks.Fault("no-schedule", "outcome", message)], clearance=clearance)
    nodes = root["robots"].elements()
    if len(nodes) < 2:
        root["robots"].fail("must be at least 2")
    plans = [_plan_of(node) for node in nodes]
    check_same_room([plan.raw for plan in plans], [plan.document.source for plan in plans])
    faults = [fault for node in nodes for fault in _check_times(node)]
    to_check = []
    for plan in plans:
        with plan["scenario"].blamed():
            to_check.append(plan_to_check(plan))
    rows = [node["pieces"].elements() for node in nodes]
    starts, durations = ([[row[key].number() for row in robot] for robot in rows] for key in ("start", "duration"))
    faults += checks.check_schedule(to_check, starts, durations, clearance, progress=progress)
    return ScheduleVerdict(faults, len(nodes), clearance)


def _check_header(root: Node) -> None:
    if not isinstance(root.raw, dict) or "format" not in root.raw:
        raise InvalidInput(f"{root.place}: is no schedule: the key format: {FORMAT} is missing")
    root["format"].choice(FORMAT)
    root.read_version(VERSION)
    root.mapping("format version mmgrasp outcome clearance robots areas obstruction")
    root["mmgrasp"].string()
    root["areas"].elements()


def _number_within(node: Node, least: float, most: float) -> float:
    value = node.number()
    node.within((least, most))
    return value


def _plan_of(node: Node) -> Node:
    """The plan of one robot; it must be the one that was scheduled."""
    node.mapping("plan sha256 end waited earliest_end pieces")
    node["earliest_end"].number(least=0)
    path = Path(node["plan"].string())
    if sha256_of(path) != node["sha256"].string():
        node["plan"].fail("the plan has changed since it was scheduled")
    root = read_json(path).root
    check_form(root)
    if root["outcome"].raw == "solved":
        check_carried_out(root)
    return root


def _check_times(node: Node) -> list[checks.Fault]:
    """Starts, waits and durations of a robot say the same."""
    faults = []
    ready = waited = 0.0
    for piece in node["pieces"].elements():
        piece.mapping("name wait start duration")
        piece["name"].string()
        wait, start, duration = (
            piece["wait"].number(least=0),
            piece["start"].number(least=0),
            piece["duration"].number(),
        )
        if abs(ready + wait - start) > _SAME:
            message = (
                f"begins at {start:g} s; after a wait of {wait:g} s from {ready:g} s on it would at {ready + wait:g} s"
            )
            faults.append(checks.Fault("wrong-values", piece.name, message))
        ready, waited = start + duration, waited + wait
    for key, value in (("end", ready), ("waited", waited)):
        if abs(node[key].number() - value) > _SAME * (1 + len(node["pieces"].raw)):
            faults.append(
                checks.Fault("wrong-values", node[key].name, f"is {node[key].raw:g} s, its pieces say {value:g} s")
            )
    return faults
