"""Reachability databases with their parts drawn on the engine."""

from __future__ import annotations

import functools
import os
import tempfile
from pathlib import Path
from typing import Any, Unpack

from .._argument_errors import checked
from .._core import Error, InvalidInput, JointGroup, ReachDatabase
from .._files import write_file
from .._options import ReachOptions
from .._progress import Progress
from ..scenario import Scenario, load_scenario
from .content import arm_key
from .engine import Engine
from .regions import ProblemSource, named

PARTS_A_SHARD = 4


@checked
def build_database(
    source: str | os.PathLike[str] | ProblemSource,
    path: str | os.PathLike[str],
    *,
    engine: Engine,
    progress: Progress = None,
    **options: Unpack[ReachOptions],
) -> ReachDatabase:
    """What ReachDatabase.build_to gives at `path`, bit for bit, its parts drawn on the engine.

    `source` is a scenario's path or a ProblemSource: the arm is its. `options` are ReachDatabase's and go before those of a
    scenario's `reach` section. Parts come back to this machine, where they are put together. Raises InvalidInput, IoError,
    Error.
    """
    place = named(source)
    arm, given = _arm(place)
    keywords: dict[str, Any] = {**given, **options}
    keywords.pop("threads", None)
    key = arm_key(arm)
    count = ReachDatabase.part_count(arm, **keywords)
    numbers = [list(range(i, min(i + PARTS_A_SHARD, count))) for i in range(0, count, PARTS_A_SHARD)]
    items = [{"source": place, "key": key, "options": keywords, "parts": parts} for parts in numbers]
    partial = Path(f"{os.fspath(path)}.partial")
    partial.parent.mkdir(parents=True, exist_ok=True)
    for files in engine.run(draw_parts, items, progress=progress, stage="reachability database"):
        for name, content in files.items():
            write_file(partial / name, content)
    return ReachDatabase.build_to(os.fspath(path), arm, progress=progress, **keywords)


def draw_parts(source: Any, key: str, options: dict[str, Any], parts: list[int]) -> dict[str, bytes]:
    """The files of some parts by their names."""
    arm, _ = _arm(source)
    if arm_key(arm) != key:
        raise Error(f"{source}: a worker reads another robot than the client under this name")
    with tempfile.TemporaryDirectory() as folder:
        ReachDatabase.build_parts(folder, arm, parts, **options)
        return {file.name: file.read_bytes() for file in sorted(Path(folder).glob("*.part"))}


@functools.lru_cache(maxsize=2)
def _arm(source: Any) -> tuple[JointGroup, dict[str, Any]]:
    made = load_scenario(source) if isinstance(source, str) else source
    if isinstance(made, Scenario):
        return made.setup.arm, dict(made.reach)
    if not hasattr(made, "problem"):
        raise InvalidInput("source: must be a scenario's path or an object with a problem()")
    return made.problem().arm, {}
