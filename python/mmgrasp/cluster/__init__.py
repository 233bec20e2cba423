"""The same computations on many processes or machines: shards on Dask distributed, found again by what went into them.

    from mmgrasp import cluster

    with cluster.connect(workers=4) as engine:                       # or scheduler="tcp://host:8786"
        grid, regions = cluster.compute_base_regions("storeroom.yaml", engine=engine)

Results are those of the single process, bit for bit. Needs the extra `cluster` (docs/methods/cluster.md).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from .._argument_errors import checked
from .._progress import Progress
from .database import build_database as build_database
from .engine import Engine as Engine
from .engine import ShardEvent as ShardEvent
from .engine import connect as connect
from .engine import shard_key as shard_key
from .regions import ProblemSource as ProblemSource
from .regions import compute_base_regions as compute_base_regions


@checked
def run_sweep(
    function: Callable[..., Any],
    items: Sequence[dict[str, Any]],
    *,
    engine: Engine,
    progress: Progress = None,
    stage: str = "sweep",
) -> list[Any]:
    """function(**item) for every item, each a shard, in the items' order.

    The function must be importable by name on the workers; items hold plain values, arrays and dataclasses of such. Seconds
    that a function measures are its worker's, and a shard found in the store tells those of the day it was computed.
    """
    return engine.run(function, items, progress=progress, stage=stage)
