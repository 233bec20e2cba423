"""Every call of the module that reads or writes a file, at places that hold none: devices, pipes, folders, links, other people's files."""

from __future__ import annotations

import os
import stat
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from argument_objects import ARM, OBJECTS, WHOLE_BODY, occupancy_map, sdf_map
from conftest import ASSETS

SEEDS = mg.base.IkSeedDatabase(WHOLE_BODY)

READERS: dict[str, Callable[[str], Any]] = {
    "URDF": mg.Robot.load,
    "SRDF": lambda path: mg.Robot.load(ASSETS / "robots" / "fetchlike" / "fetchlike.urdf", path),
    "mesh": mg.Mesh.load,
    "mesh of a world": lambda path: mg.World().add_mesh("m", path),
    "octree": lambda path: mg.World().add_octree("m", path),
    "point cloud": mg.mapping.read_pcd,
    "map": mg.ProbabilisticSdf.load,
    "occupancy": mg.mapping.OccupancyMap.load,
    "database": mg.ReachDatabase.load,
    "capability": mg.base.CapabilityMap.load,
    "roadmap": lambda path: mg.planning.Roadmap.load(path, ARM),
    "seeds": lambda path: mg.base.IkSeedDatabase.load(path, WHOLE_BODY),
}
WRITERS: dict[str, tuple[Callable[[], Any], Callable[[str], Any]]] = {
    "map": (sdf_map, mg.ProbabilisticSdf.load),
    "occupancy": (occupancy_map, mg.mapping.OccupancyMap.load),
    "database": (OBJECTS["ReachDatabase"], mg.ReachDatabase.load),
    "capability": (OBJECTS["CapabilityMap"], mg.base.CapabilityMap.load),
    "roadmap": (OBJECTS["Roadmap"], READERS["roadmap"]),
    "seeds": (lambda: SEEDS, READERS["seeds"]),
}


def bad_place(folder: Path, what: str) -> Path:
    place = folder / "place.bt"
    if what == "pipe":
        os.mkfifo(place)
    elif what == "folder":
        place.mkdir()
        (place / "mine.txt").write_text("mine")
    elif what == "loop":
        place.symlink_to(place)
    elif what == "below a file":
        (folder / "file").write_text("")
        place = folder / "file" / "place.bt"
    elif what == "larger than memory":
        place.touch()
        os.truncate(place, 5 * 10**12)
    elif what == "device":
        place = Path("/dev/zero")
    return place


@pytest.mark.parametrize("what", ["device", "pipe", "folder", "loop", "missing", "below a file", "larger than memory"])
@pytest.mark.parametrize("door", READERS)
def test_what_is_no_file_is_not_read(door: str, what: str, tmp_path: Path) -> None:
    place = bad_place(tmp_path, what)
    with pytest.raises(mg.Error, match=r"place|/dev/zero"):
        READERS[door](str(place))


@pytest.mark.parametrize("what", ["device", "pipe", "folder", "loop", "below a file"])
@pytest.mark.parametrize("door", WRITERS)
def test_what_is_no_file_is_not_replaced(door: str, what: str, tmp_path: Path) -> None:
    place = bad_place(tmp_path, what)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(mg.IoError, match=r"place|/dev/zero"):
        WRITERS[door][0]().save(place)
    assert sorted(tmp_path.rglob("*")) == before
    if what == "device":
        assert stat.S_ISCHR(os.stat(place).st_mode)
    if what == "pipe":
        assert stat.S_ISFIFO(os.stat(place).st_mode)


@pytest.mark.parametrize("door", WRITERS)
def test_links_stay_and_what_they_lead_to_is_replaced(door: str, tmp_path: Path) -> None:
    make, load = WRITERS[door]
    (tmp_path / "far").mkdir()
    made = make()
    made.save(tmp_path / "far" / "one.bt")
    (tmp_path / "link.bt").symlink_to(Path("far") / "one.bt")
    made.save(tmp_path / "link.bt")
    assert (tmp_path / "link.bt").is_symlink()
    assert [p.name for p in (tmp_path / "far").iterdir()] == ["one.bt"]
    load(str(tmp_path / "link.bt"))


@pytest.mark.parametrize("door", READERS)
def test_paths_that_are_no_utf_8_are_told(door: str, tmp_path: Path) -> None:
    with pytest.raises(mg.Error, match=r"a\\(xff|udcff)b"):
        READERS[door](f"{tmp_path}/a\udcffb.bt")


def test_a_cache_whose_name_is_no_utf_8(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", f"{tmp_path}/a\udcffb")
    assert mg.base.cache_folder() == f"{tmp_path}/a\udcffb/mmgrasp"
    mg.ReachDatabase.load_or_build(ARM, mg.base.cache_folder(), samples=20_000)
    assert [p.name for p in (Path(mg.base.cache_folder())).iterdir()]
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.delenv("HOME")
    monkeypatch.setenv("TMPDIR", "/nonexistent")
    assert mg.base.cache_folder().endswith("/mmgrasp-cache")  # planning goes on without it


def test_a_database_does_not_replace_a_folder_with_more_in_it(tmp_path: Path) -> None:
    database = OBJECTS["ReachDatabase"]()
    database.save(tmp_path / "db")
    database.save(tmp_path / "db")
    (tmp_path / "db" / "notes.txt").write_text("mine")
    with pytest.raises(mg.IoError, match="something else stands there"):
        database.save(tmp_path / "db")
    assert (tmp_path / "db" / "notes.txt").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 1


def test_many_may_write_one_file_at_once(tmp_path: Path) -> None:
    """Each whole, in a file of its own until it is done."""
    small, large = mg.ProbabilisticSdf(), sdf_map()
    sizes = []
    for one in (small, large):
        one.save(tmp_path / "m.sdf")
        sizes.append((tmp_path / "m.sdf").stat().st_size)
    assert sizes[0] != sizes[1]

    def write(one: mg.ProbabilisticSdf) -> None:
        for _ in range(50):
            one.save(tmp_path / "m.sdf")

    threads = [threading.Thread(target=write, args=(one,)) for one in (small, large, small, large)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        mg.ProbabilisticSdf.load(tmp_path / "m.sdf")
    for thread in threads:
        thread.join()
    assert [p.name for p in tmp_path.iterdir()] == ["m.sdf"]


def test_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    sdf_map().save(tmp_path / "m.sdf")
    (tmp_path / "x").touch()
    assert (tmp_path / "m.sdf").stat().st_mode == (tmp_path / "x").stat().st_mode
