"""Dask distributed as the engine: local worker processes, or a cluster that is there already."""

from __future__ import annotations

import contextlib
import logging
import os
import threading
import time
import uuid
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .. import _core
from .._argument_errors import checked
from .._core import Error, InvalidInput
from .._progress import Progress
from .content import Hasher, code_digest
from .store import ShardStore

log = logging.getLogger("mmgrasp.cluster")
TOPIC = "mmgrasp-shards"
LOG_WAIT = 2.0  # for the last lines of the log [s]
FAILURES = 10  # workers that a shard may outlive before it is held for the cause


@dataclass(frozen=True)
class ShardEvent:
    """One line of the log of a run."""

    kind: str
    """"stored" (was there before), "begun", "again" (begun after its worker was lost) or "done"."""
    shard: str
    worker: str
    time: float
    run: str = ""
    """Which call of Engine.run."""


@dataclass
class Engine:
    """Runs shards on the workers of one scheduler and keeps their results."""

    client: Any
    store: ShardStore
    events: list[ShardEvent] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def run(
        self,
        function: Callable[..., Any],
        items: Sequence[dict[str, Any]],
        *,
        progress: Progress = None,
        stage: str = "",
    ) -> list[Any]:
        """function(**item) for every item, in their order. The function must be importable by name on the workers."""
        from dask.distributed import as_completed

        keys = [shard_key(function, item) for item in items]
        results: dict[str, Any] = {}
        missing: dict[str, dict[str, Any]] = {}
        for key, item in zip(keys, items, strict=True):
            found, result = self.store.get(key)
            if found:
                results[key] = result
                self._note(ShardEvent("stored", key, "", time.time()))
            else:
                missing[key] = item
        done, total = len(results), len(set(keys))
        run = uuid.uuid4().hex[:8]
        futures = {
            key: self.client.submit(
                run_shard, key, code_digest(), run, function, item, key=f"{TOPIC}-{key}-{run}", pure=False
            )
            for key, item in missing.items()
        }
        of_future = {future.key: key for key, future in futures.items()}
        try:
            for future in as_completed(futures.values()):  # type: ignore[no-untyped-call]
                key = of_future[future.key]
                results[key] = future.result()
                self.store.put(key, results[key])
                done += 1
                if progress is not None:
                    progress(stage or "shards", done / total)
        except BaseException:
            self.client.cancel(list(futures.values()))
            raise
        self._await_log(run, set(missing))
        return [results[key] for key in keys]

    def _await_log(self, run: str, shards: set[str]) -> None:
        """Results may overtake what workers say about them; what is lost with a worker never arrives."""
        until = time.monotonic() + LOG_WAIT
        while time.monotonic() < until:
            with self._lock:
                shards -= {e.shard for e in self.events if e.kind == "done" and e.run == run}
            if not shards:
                return
            time.sleep(0.01)

    def heard(self, event: tuple[float, dict[str, Any]]) -> None:
        """Called with what workers report."""
        record = event[1]
        with self._lock:
            known = [e.kind for e in self.events if e.shard == record["shard"] and e.run == record["run"]]
        kind = "again" if record["kind"] == "begun" and "begun" in known else record["kind"]
        self._note(ShardEvent(kind, record["shard"], record["worker"], record["time"], record["run"]))

    def _note(self, event: ShardEvent) -> None:
        with self._lock:
            self.events.append(event)
        where = f" on {event.worker}" if event.worker else ""
        words = {"again": f"begun again{where}: the worker that had it was lost"}.get(event.kind, event.kind + where)
        log.info("shard %s %s", event.shard[:12], words)


@checked
def shard_key(function: Callable[..., Any], item: dict[str, Any]) -> str:
    """Names a shard by the code, the function and the values it is called with."""
    return Hasher().add(code_digest()).add(f"{function.__module__}.{function.__qualname__}").add(item, "item").hex()


def run_shard(key: str, code: str, run: str, function: Callable[..., Any], item: dict[str, Any]) -> Any:
    """What a worker does."""
    from dask.distributed import get_worker

    if code_digest() != code:
        raise Error("a worker runs other code than the client: install the same mmgrasp on both")
    worker = get_worker()

    def tell(kind: str) -> None:
        record = {"kind": kind, "shard": key, "worker": worker.address, "time": time.time(), "run": run}
        worker.log_event(TOPIC, record)

    tell("begun")
    result = function(**item)
    tell("done")
    return result


def default_folder() -> Path:
    """Where shards are kept unless a folder is given."""
    return Path(_core.cache_folder()) / "shards"


@checked
@contextlib.contextmanager
def connect(
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    folder: str | os.PathLike[str] | None = None,
    timeout: float = 15.0,
) -> Iterator[Engine]:
    """An engine on `scheduler` (tcp://host:port), or on `workers` local processes (default: one a core) that end with it.

    `folder` keeps finished shards from run to run (default: the cache folder's `shards`). Raises InvalidInput when Dask is
    not installed or the scheduler does not answer within `timeout` [s].
    """
    try:
        from dask.distributed import Client, LocalCluster
    except ImportError:
        raise InvalidInput("a cluster needs Dask: pip install 'mmgrasp[cluster]'") from None
    import dask

    store = ShardStore(Path(folder) if folder is not None else default_folder())
    with contextlib.ExitStack() as stack:
        stack.enter_context(dask.config.set({"distributed.scheduler.allowed-failures": FAILURES}))
        if scheduler is not None:
            address: Any = scheduler
        else:
            count = workers or len(os.sched_getaffinity(0))
            address = stack.enter_context(
                LocalCluster(  # type: ignore[no-untyped-call]
                    n_workers=count,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    silence_logs=logging.ERROR,
                )
            )
        try:
            client = stack.enter_context(Client(address, timeout=timeout))  # type: ignore[no-untyped-call]
        except (OSError, TimeoutError, ValueError) as error:  # ValueError: no address at all
            raise InvalidInput(f"scheduler = {scheduler!r}: cannot be reached: {error}") from None
        engine = Engine(client, store)
        client.subscribe_topic(TOPIC, engine.heard)
        stack.callback(client.unsubscribe_topic, TOPIC)
        yield engine
