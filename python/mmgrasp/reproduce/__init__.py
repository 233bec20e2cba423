"""`mmgrasp reproduce`: a paper's tables and figures computed again and shown beside the paper's numbers."""

from __future__ import annotations

import datetime
import os
import platform
import time
from typing import Any

from .._argument_errors import checked
from .._core import InvalidInput, __version__
from .._progress import Progress
from ..documents.reading import near_miss
from . import (
    base_regions,
    capability,
    drive_by,
    experiments,
    grasp_search,
    grasp_success,
    grasping_trials,
    gripper_assembly,
    gripper_sets,
    ik_query,
    physics,
    policies,
    prm_mg,
    random_placement,
    robust_sets,
    rows,
    rrt_mg,
    segmentation,
    shelf,
    solver_regions,
    three_ways,
    tracking,
    uncertain_surfaces,
)
from .entry import Context, Entry, Result, Sweep, sweep_here

__all__ = ["ENTRIES", "Context", "Entry", "Result", "entry", "reproduce"]

TOPICS = (
    base_regions,
    ik_query,
    solver_regions,
    robust_sets,
    rows,
    policies,
    experiments,
    random_placement,
    grasp_search,
    prm_mg,
    rrt_mg,
    capability,
    shelf,
    grasp_success,
    uncertain_surfaces,
    grasping_trials,
    drive_by,
    tracking,
    physics,
    three_ways,
    segmentation,
    gripper_sets,
    gripper_assembly,
)
ENTRIES: dict[str, Entry] = {e.name: e for topic in TOPICS for e in topic.ENTRIES}
ALSO = {
    "p1-figure-3.13": "p1-table-3.1",
    "p1-figure-3.15": "p1-table-3.1",
    "p1-figure-3.4": "p1-figure-3.5",
    "p2-table-3.6": "p2-figure-3.11",
    "p2-figure-4.5": "p2-table-4.2",
    "p2-figure-5.6": "p2-figure-5.5",
    "p3-figure-3.32": "p3-figure-3.31",
    "p3-figure-4.14": "p3-figure-4.15",
    "p3-figure-4.17": "p3-figure-4.18",
    "p3-figure-4.20": "p3-figure-4.21",
}


@checked
def entry(name: str) -> Entry:
    """An entry by its name, or by that of a figure it draws."""
    wanted = str(name).lower()
    wanted = ALSO.get(wanted, wanted)
    if wanted not in ENTRIES:
        raise InvalidInput(f"name = {name!r}: no such table or figure{near_miss(wanted, [*ENTRIES, *ALSO])}")
    return ENTRIES[wanted]


@checked
def reproduce(
    name: str, *, quick: bool = False, seed: int = 1, progress: Progress = None, sweep: Sweep = sweep_here
) -> dict[str, Any]:
    """Computes one entry anew; `quick` takes smaller set-ups that show the same in seconds.

    Returns plain values: name, rows (key and, by column, paper's value and ours), setup, checks (kind "E": the paper's exact
    value, "T": its trend), notes, and where, when and with what it was computed. Raises InvalidInput on an unknown name.
    """
    chosen = entry(name)
    begun = time.perf_counter()
    result = chosen.run(Context(quick=quick, seed=seed, progress=progress, run_sweep=sweep))
    return {
        "name": chosen.name,
        "title": chosen.title,
        "quick": quick,
        "seed": seed,
        **result.to_dict(),
        "seconds": round(time.perf_counter() - begun, 2),
        "date": datetime.date.today().isoformat(),
        "machine": machine(),
    }


def machine() -> dict[str, Any]:
    """Where numbers come from, without names of hosts or people."""
    return {
        "processor": _processor(),
        "cores": len(os.sched_getaffinity(0)),
        "system": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "mmgrasp": __version__,
    }


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            for line in file:
                if line.startswith("model name"):
                    return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or "unknown"
