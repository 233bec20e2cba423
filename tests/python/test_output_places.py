"""Places to write to: found out before the work, and never half written."""

from __future__ import annotations

import errno
import fcntl
import os
import shutil
import stat
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from mmgrasp._files import (
    PNG,
    check_file,
    check_folder,
    check_new_file,
    draft_folder,
    printable,
    read_text,
    remove_dead_drafts,
    write_file,
    write_result,
)
from mmgrasp.cli import main
from mmgrasp.cli.output_folder import LIST, OutputFolder


def names(folder: Path) -> set[str]:
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


def bad_folders(tmp: Path) -> dict[str, Path]:
    (tmp / "file").write_text("")
    (tmp / "loop").symlink_to(tmp / "loop")
    (tmp / "closed").mkdir()
    return {
        "a file": tmp / "file",
        "below a file": tmp / "file" / "x",
        "a link loop": tmp / "loop",
        "a device": Path("/dev/null"),
        "no room for files": Path("/proc/x"),
        "a name too long": tmp / ("x" * 5000),
        "a NUL": tmp / "a\0b",
    }


@pytest.mark.parametrize(
    "what", ["a file", "below a file", "a link loop", "a device", "no room for files", "a name too long", "a NUL"]
)
def test_places_that_cannot_be_written_are_found_at_once(tmp_path: Path, what: str) -> None:
    with pytest.raises(mg.IoError) as caught:
        check_folder(bad_folders(tmp_path)[what])
    assert "cannot be written" in str(caught.value)
    assert "\0" not in str(caught.value)


def test_a_result_whose_place_went_away_is_kept_elsewhere(tmp_path: Path) -> None:
    (tmp_path / "out.json").mkdir()
    with pytest.raises(mg.IoError, match=r"is a folder; what was to be written there is in ") as caught:
        write_result(tmp_path / "out.json", "found")
    kept = Path(str(caught.value).rpartition(" is in ")[2])
    assert kept.name == "out.json" and kept.read_text() == "found"
    shutil.rmtree(kept.parent)


def test_the_trial_leaves_nothing(tmp_path: Path) -> None:
    check_folder(tmp_path / "a" / "b")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("place", ["trajectories", "plan.json"])
def test_folders_in_the_place_of_files_and_files_in_that_of_folders(tmp_path: Path, place: str) -> None:
    if place == "trajectories":
        (tmp_path / place).write_text("mine")
    else:
        (tmp_path / place).mkdir()
    with pytest.raises(mg.IoError, match=place):
        OutputFolder(tmp_path)


def test_devices_are_never_replaced(tmp_path: Path) -> None:
    path = tmp_path / "null"  # one of our own: a test must not be able to break the machine's
    try:
        os.mknod(path, stat.S_IFCHR | 0o666, os.makedev(1, 3))
    except PermissionError:
        pytest.skip("only the superuser makes device nodes")
    with pytest.raises(mg.IoError, match="no regular file"):
        write_file(path, "x")
    with pytest.raises(mg.IoError, match="no regular file"):
        check_file(path, PNG)
    with pytest.raises(mg.IoError, match="already"):
        check_new_file(path)
    assert stat.S_ISCHR(os.stat(path).st_mode)


def test_pipes_are_never_replaced(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(mg.IoError, match="no regular file"):
        write_file(tmp_path / "pipe", "x")


def test_only_an_earlier_result_of_the_same_kind_is_replaced(tmp_path: Path) -> None:
    path = tmp_path / "place"
    check_file(path, PNG)
    for taken in (b"", PNG, PNG + b"more"):
        path.write_bytes(taken)
        check_file(path, PNG)
    for foreign in (PNG[:-1], b"mine", b"{}"):
        path.write_bytes(foreign)
        with pytest.raises(mg.IoError, match="already, not as an earlier result"):
            check_file(path, PNG)
        assert path.read_bytes() == foreign


@pytest.mark.parametrize("place", ["/dev", "/dev/new", "/proc/self", "/sys/new"])
def test_nothing_is_written_among_devices(place: str) -> None:
    with pytest.raises(mg.IoError, match="devices and processes are there"):
        OutputFolder(Path(place))


def test_a_full_standard_output_is_named(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("mmgrasp.cli.commands._run", full)
    assert main(["plan"]) == 2
    assert "standard output: cannot be written: No space left" in capsys.readouterr().err


def test_links_stay_links(tmp_path: Path) -> None:
    (tmp_path / "far").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "far" / "file")
    write_file(tmp_path / "link", "one")
    write_file(tmp_path / "link", "two")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "far" / "file").read_text() == "two"


@pytest.mark.parametrize("what", ["device", "pipe", "folder", "large", "latin", "none", "nul"])
def test_what_cannot_be_read_as_text(tmp_path: Path, what: str) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    (tmp_path / "large").write_text("x" * 11)
    (tmp_path / "latin").write_bytes(b"\xe4")
    path = {"device": Path("/dev/zero"), "nul": tmp_path / "a\0"}.get(what, tmp_path / what)
    with pytest.raises(mg.IoError):
        read_text(path, 10)


def test_reading_takes_the_memory_of_the_file_not_that_of_its_limit(tmp_path: Path) -> None:
    (tmp_path / "small").write_text("12")
    code = """
import resource, sys
from pathlib import Path
from mmgrasp._files import read_bytes
now = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (now + 50_000_000,) * 2)
print(read_bytes(Path(sys.argv[1]), 1_000_000_000))
"""
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path / "small")], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("b'12'\n", "")


def test_what_would_move_a_terminal_is_written_as_escapes() -> None:
    assert printable("a\x1b[31mb\ud800\n") == "a\\x1b[31mb\\ud800\n"
    assert printable("Käfig") == "Käfig"


def test_a_plan_is_drawn_where_nothing_but_its_folder_can_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Drawing needs a temporary folder: without one, a plan made in minutes would be lost."""

    def nowhere() -> str:
        raise FileNotFoundError("No usable temporary directory found")

    monkeypatch.setattr(tempfile, "gettempdir", nowhere)
    with OutputFolder(tmp_path).filled() as draft:
        write_file(draft / "plan.json", "1")
        made = Path(tempfile.mkdtemp(dir=tempfile.tempdir))
        assert tmp_path in made.parents and draft not in made.parents
    assert tempfile.tempdir is None
    assert names(tmp_path) == {"plan.json", LIST}


@pytest.mark.slow
def test_the_cache_is_optional(
    small_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    scenario = mg.load_scenario(small_path)
    scenario.reach = {"samples": 20_000}
    assert isinstance(scenario.reach_database(), mg.ReachDatabase)
    assert "set XDG_CACHE_HOME" in caplog.text
    assert names(tmp_path) == {"file"}


@pytest.mark.slow
def test_a_damaged_cache_is_built_anew_with_a_hint(
    small_path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    scenario = mg.load_scenario(small_path)
    scenario.reach = {"samples": 20_000}
    sound = scenario.reach_database().arrays["configurations"].copy()
    file = next(tmp_path.rglob("configurations.npy"))
    good = file.read_bytes()
    stages: list[str] = []

    def hear(stage: str, fraction: float) -> None:
        stages.append(stage)

    for at in (200, len(good) // 2, len(good) - 1):
        bad = bytearray(good)
        bad[at] ^= 16
        file.write_bytes(bad)
        damaged = mg.ReachDatabase.load(file.parent)
        with pytest.raises(mg.IoError, match=r"configurations\.npy: corrupt: bytes"):
            damaged.arrays["configurations"]
        caplog.clear()
        found = scenario.reach_database(hear)
        assert "is damaged: it is built anew" in caplog.text
        assert "replacing a damaged reachability database" in stages
        stages.clear()
        assert (found.arrays["configurations"] == sound).all()
        assert file.read_bytes() == good
    caplog.clear()
    scenario.reach_database()
    assert not caplog.text


def test_a_cache_folder_that_is_not_absolute_is_ignored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")
    monkeypatch.setenv("HOME", str(tmp_path))
    assert mg.base.cache_folder() == str(tmp_path / ".cache" / "mmgrasp")


@pytest.mark.parametrize("moment", ["before it is opened", "before it is locked"])
def test_a_draft_that_is_not_locked_yet_may_be_taken_for_a_dead_one(
    moment: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another run that begins in that moment removes it: the next is taken, and that one stays."""
    removed = []

    def other_run_begins() -> None:
        monkeypatch.undo()
        remove_dead_drafts(tmp_path)
        removed.append(not list(tmp_path.iterdir()))

    made, locked = tempfile.mkdtemp, fcntl.flock

    def make(**where: Any) -> str:
        folder: str = made(**where)
        other_run_begins()
        return folder

    def lock(handle: int, how: int) -> None:
        other_run_begins()
        locked(handle, how)

    if moment == "before it is opened":
        monkeypatch.setattr(tempfile, "mkdtemp", make)
    else:
        monkeypatch.setattr(fcntl, "flock", lock)
    with draft_folder(tmp_path) as draft:
        assert removed == [True]
        remove_dead_drafts(tmp_path)
        assert draft.is_dir()
        (draft / "plan.json").write_text("ours")
    assert not list(tmp_path.iterdir())


def test_a_saved_plan_replaces_plans_only(small_plan: Any, small_path: Path, tmp_path: Path) -> None:
    scenario = tmp_path / "scenario.yaml"
    scenario.write_text(small_path.read_text())
    with pytest.raises(mg.IoError, match="not as an earlier result"):
        small_plan.save(scenario)
    assert scenario.read_text() == small_path.read_text()
    once = small_plan.save(tmp_path / "plan.json").read_text()
    assert small_plan.save(tmp_path / "plan.json").read_text() == once
