"""Shards on a Dask cluster: the same results bit for bit, also when a worker is killed, and only what is missing is computed."""

from __future__ import annotations

import json
import logging
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.cluster.content import problem_digest
from mmgrasp.cluster.store import ShardStore
from mmgrasp.reproduce.setup import Row, database

pytest.importorskip("distributed", reason="the extra mmgrasp[cluster] is not installed")
from mmgrasp import cluster

ROW = Row(trays=6, objects=(2, 2), spacing=0.4, threads=1)
SAMPLES = {"samples": 200_000, "seed": 1}


def state(thing: Any) -> Any:
    """Everything that a region or grid holds."""
    _restored, (_kind, content) = thing.__reduce_ex__(4)
    assert len(content) in (5, 6)
    return content


def alike(function_seed: int, length: int, pause: float) -> dict[str, Any]:
    time.sleep(pause)
    return {"noise": np.random.default_rng(function_seed).normal(size=length), "seed": function_seed}


@pytest.fixture(scope="module")
def expected() -> list[Any]:
    problem, reach = ROW.problem(), database(ROW, SAMPLES["samples"])
    return [state(r) for r in mg.base.compute_base_regions(problem, reach, mg.base.make_base_grid(problem, reach))]


@pytest.fixture
def processes(tmp_path: Path) -> Iterator[str | None]:
    """A scheduler and three workers, each a process of its own, without a nanny that would start one again."""
    found = tmp_path / "scheduler.json"
    own = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}

    def start(*arguments: str) -> subprocess.Popen[bytes]:
        with (tmp_path / f"{len(running)}.log").open("w") as out:
            command = [sys.executable, "-m", "dask", *arguments, "--scheduler-file", str(found)]
            return subprocess.Popen(command, stdout=out, stderr=out, env=os.environ | own)

    running: list[subprocess.Popen[bytes]] = []
    running.append(start("scheduler", "--port", "0", "--no-dashboard"))
    workers = ["--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", str(tmp_path)]
    running += [start("worker", *workers, "--name", f"w{i}") for i in range(3)]
    until = time.monotonic() + 60
    while not found.is_file() or not found.read_text().strip():
        assert time.monotonic() < until and running[0].poll() is None, (tmp_path / "0.log").read_text()
        time.sleep(0.05)
    yield json.loads(found.read_text())["address"]
    for process in running:
        process.kill()
        process.wait()


@pytest.mark.slow
def test_a_killed_worker_costs_only_its_shards(
    processes: str, expected: list[Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    killed: list[tuple[str, float]] = []
    with cluster.connect(scheduler=processes, folder=tmp_path / "shards") as engine:
        engine.client.wait_for_workers(3, timeout=60)
        pids = engine.client.run(os.getpid)

        def kill_one() -> None:
            """The worker that began last, once another shard is done: it has unfinished work then."""
            while not finished.is_set():
                events = list(engine.events)
                done = {e.shard for e in events if e.kind == "done"}
                open_ = [e for e in events if e.kind == "begun" and e.shard not in done]
                if done and open_:
                    os.kill(pids[open_[-1].worker], signal.SIGKILL)
                    killed.append((open_[-1].worker, time.time()))
                    return
                time.sleep(0.002)

        finished = threading.Event()
        hunter = threading.Thread(target=kill_one, daemon=True)
        hunter.start()
        with caplog.at_level(logging.INFO, logger="mmgrasp.cluster"):
            _, regions = cluster.compute_base_regions(ROW, engine=engine, database=SAMPLES)
        finished.set()
        hunter.join()
        events = list(engine.events)
    assert [state(r) for r in regions] == expected
    assert killed, "no worker could be killed while it held a shard"
    worker = killed[0][0]
    begun_there = {e.shard for e in events if e.kind == "begun" and e.worker == worker}
    again = [e for e in events if e.kind == "again"]
    assert again, "nothing was done again"
    assert all(e.shard in begun_there and e.worker != worker for e in again)
    assert sum("the worker that had it was lost" in line for line in caplog.messages) == len(again)
    assert {e.shard for e in events if e.kind == "done"} == {e.shard for e in events}
    assert len({e.shard for e in events}) == ROW.trays


@pytest.mark.slow
def test_only_missing_shards_are_computed(expected: list[Any], tmp_path: Path) -> None:
    """Local processes this time. A finished shard is read, one that is gone or damaged is computed again."""
    folder = tmp_path / "shards"

    def run(engine: Any) -> list[str]:
        before = len(engine.events)
        _, regions = cluster.compute_base_regions(ROW, engine=engine, database=SAMPLES)
        assert [state(r) for r in regions] == expected
        return sorted(e.kind for e in engine.events[before:] if e.kind in ("begun", "stored"))

    with cluster.connect(workers=2, folder=folder) as engine:
        assert run(engine) == ["begun"] * 6
        assert run(engine) == ["stored"] * 6
        files = sorted(folder.rglob("*.shard"))
        assert len(files) == 6
        files[0].unlink()
        data = bytearray(files[1].read_bytes())
        data[-5] ^= 1
        files[1].write_bytes(data)
        assert run(engine) == ["begun"] * 2 + ["stored"] * 4
        # Something else went in: nothing stored is taken for it.
        other = ROW.with_(shift=0.03)
        problem, reach = other.problem(), database(other, SAMPLES["samples"])
        alone = mg.base.compute_base_regions(problem, reach, mg.base.make_base_grid(problem, reach))
        _, regions = cluster.compute_base_regions(other, engine=engine, database=SAMPLES)
        assert [state(r) for r in regions] == [state(r) for r in alone]
        items: list[dict[str, Any]] = [{"function_seed": s, "length": 100, "pause": 0.0} for s in range(5)]
        for ours, item in zip(cluster.run_sweep(alike, items, engine=engine), items, strict=True):
            np.testing.assert_array_equal(ours["noise"], alike(**item)["noise"])


@pytest.mark.slow
def test_a_database_drawn_in_parts_is_the_same_file_for_file(tmp_path: Path) -> None:
    options: dict[str, Any] = {"samples": 120_000, "seed": 3, "max_per_cell": 4}
    alone = mg.ReachDatabase.build_to(tmp_path / "alone", ROW.problem().arm, **options)
    with cluster.connect(workers=2, folder=tmp_path / "shards") as engine:
        spread = cluster.build_database(ROW, tmp_path / "spread", engine=engine, **options)
        assert len({e.worker for e in engine.events if e.kind == "begun"}) == 2
    assert len(spread) == len(alone) > 0
    names = sorted(p.name for p in (tmp_path / "alone").iterdir())
    assert names == sorted(p.name for p in (tmp_path / "spread").iterdir())
    for name in names:
        assert (tmp_path / "alone" / name).read_bytes() == (tmp_path / "spread" / name).read_bytes(), name
    with pytest.raises(mg.InvalidInput, match="part = 1000000"):
        mg.ReachDatabase.build_parts(tmp_path / "parts", ROW.problem().arm, [1_000_000], **options)


def test_a_scenario_gives_what_one_process_gives(small_path: Path, tmp_path: Path) -> None:
    scenario = mg.load_scenario(small_path)
    problem, reach = scenario.problem(), scenario.reach_database()
    grid = mg.base.make_base_grid(problem, reach)
    alone = mg.base.compute_base_regions(problem, reach, grid)
    with cluster.connect(workers=1, folder=tmp_path) as engine:
        same, regions = cluster.compute_base_regions(small_path, engine=engine)
    assert state(same)[1:] == state(grid)[1:]
    np.testing.assert_array_equal(same.origin, grid.origin)
    assert [state(r) for r in regions] == [state(r) for r in alone]


@pytest.mark.slow
def test_the_command_spreads_its_work(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Everything but times is what one process computes."""
    arguments = ["reproduce", "p1-random-placement", "--quick", "--json"]
    assert main(arguments) == 0
    alone = json.loads(capfd.readouterr().out)
    assert main([*arguments, "--workers", "2", "--shards", str(tmp_path)]) == 0
    spread = json.loads(capfd.readouterr().out)
    assert spread["rows"] == alone["rows"]
    assert list(tmp_path.rglob("*.shard"))


def test_digest_tells_problems_apart() -> None:
    reach = database(ROW, SAMPLES["samples"])
    base = problem_digest(ROW.problem(), reach)
    assert base == problem_digest(ROW.with_(threads=2).problem(), reach)
    changed: list[dict[str, Any]] = [{"shift": 1e-9}, {"tool": 0.121}, {"targets": ((0,),) * 6}, {"ik_seeds": 9}]
    changed.append({"objects": (2, 3)})
    assert len({base, *(problem_digest(ROW.with_(**c).problem(), reach) for c in changed)}) == 6
    # The torso stands elsewhere: another problem even beside the same database.
    assert problem_digest(ROW.with_(torso=ROW.torso - 0.01).problem(), reach) != base


def test_what_has_no_content_is_refused() -> None:
    with pytest.raises(mg.InvalidInput, match=r"item\.x\[1\]: a object"):
        cluster.shard_key(alike, {"x": [1, object()]})
    assert cluster.shard_key(alike, {"x": 1}) != cluster.shard_key(alike, {"x": 1.0})
    assert cluster.shard_key(alike, {"x": np.zeros(3)}) != cluster.shard_key(alike, {"x": np.zeros((3, 1))})
    assert cluster.shard_key(alike, {"a": 1, "b": 2}) == cluster.shard_key(alike, {"b": 2, "a": 1})


def test_an_absent_scheduler_is_named(tmp_path: Path) -> None:
    with (
        pytest.raises(mg.InvalidInput, match=r"tcp://127\.0\.0\.1:9"),
        cluster.connect(scheduler="tcp://127.0.0.1:9", folder=tmp_path, timeout=0.5),
    ):
        pass


def test_what_is_no_address_is_refused() -> None:
    with pytest.raises(mg.InvalidInput, match="scheduler = 'nonsense'"), cluster.connect(scheduler="nonsense"):
        pass


def test_store_keeps_results(tmp_path: Path) -> None:
    store = ShardStore(tmp_path)
    store.put("ab12", {"x": 1.5})
    assert store.get("ab12") == (True, {"x": 1.5})
    assert store.get("ab13") == (False, None)
