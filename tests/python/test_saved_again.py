"""Folders that are saved again while others load them: every load gives the old or the new one, whole."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from argument_objects import ARM

SECONDS = 2.0  # of loading
PAUSE = 0.003  # between saves [s]


def databases() -> list[Any]:
    return [mg.ReachDatabase.build(ARM, samples=samples, threads=1) for samples in (10_000, 20_000)]


def capability_maps() -> list[Any]:
    lower, upper = [-0.5, -0.5, 0.2], [0.5, 0.5, 0.7]
    return [
        mg.base.CapabilityMap.build(ARM, lower=lower, upper=upper, voxel=v, poses=4, threads=1) for v in (0.5, 0.25)
    ]


def loaded_database(path: str) -> int:
    database = mg.ReachDatabase.load(path)
    database.verify()
    return len(database)


def loaded_map(path: str) -> int:
    return int(mg.base.CapabilityMap.load(path).classes.size)


KINDS: dict[str, tuple[Callable[[], list[Any]], Callable[[str], int]]] = {
    "database": (databases, loaded_database),
    "capability map": (capability_maps, loaded_map),
}


def save_again(kind: str, place: str, number: int, is_over: Any) -> None:
    made = KINDS[kind][0]()
    while not is_over.is_set():
        for one in made[number:] + made[:number]:
            one.save(place)
            time.sleep(PAUSE)


def load_again(kind: str, place: str, told: Any) -> None:
    sizes, wrong, loads = set(), "", 0
    until = time.monotonic() + SECONDS
    while time.monotonic() < until and not wrong:
        try:
            sizes.add(KINDS[kind][1](place))
            loads += 1
        except mg.Error as error:
            wrong = str(error)
    told.put((loads, sizes, wrong))


@pytest.mark.parametrize("kind", KINDS)
def test_loads_while_others_save(kind: str, tmp_path: Path) -> None:
    make, load = KINDS[kind]
    place = str(tmp_path / "saved")
    expected = set()
    for one in make():
        one.save(place)
        expected.add(load(place))
    assert len(expected) == 2
    processes = multiprocessing.get_context("spawn")
    told, is_over = processes.SimpleQueue(), processes.Event()
    workers = [processes.Process(target=save_again, args=(kind, place, i, is_over)) for i in range(2)]
    workers += [processes.Process(target=load_again, args=(kind, place, told)) for _ in range(2)]
    for worker in workers:
        worker.start()
    answers = [told.get() for _ in range(2)]
    is_over.set()
    for worker in workers:
        worker.join()
    for loads, sizes, wrong in answers:
        assert wrong == "" and loads > 5 and sizes <= expected
    assert [worker.exitcode for worker in workers] == [0] * 4
    assert [path.name for path in tmp_path.iterdir()] == ["saved"]


def test_what_is_missing_or_damaged_is_told_at_once(tmp_path: Path) -> None:
    begun = time.process_time()
    with pytest.raises(mg.IoError, match="no such file or folder"):
        mg.ReachDatabase.load(tmp_path / "nothing")
    databases()[0].save(tmp_path / "saved")
    (tmp_path / "saved" / "configurations.npy").unlink()
    with pytest.raises(mg.IoError, match="configurations"):
        mg.ReachDatabase.load(tmp_path / "saved")
    assert time.process_time() - begun < 5


def test_who_may_read_it_stays_as_it_was(tmp_path: Path) -> None:
    one, other = databases()
    one.save(tmp_path / "database")
    (tmp_path / "database").chmod(0o700)
    other.save(tmp_path / "database")
    assert (tmp_path / "database").stat().st_mode & 0o777 == 0o700
    assert loaded_database(str(tmp_path / "database")) == len(other)
