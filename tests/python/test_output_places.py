"""Places to write to: found out before the work, never half written, and a folder holds one plan."""

from __future__ import annotations

import errno
import fcntl
import json
import os
import shutil
import signal
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


def fill(folder: Path, **files: str) -> None:
    with OutputFolder(folder).filled() as draft:
        for name, text in files.items():
            write_file(draft / name.replace("__", "/").replace("_json", ".json").replace("_csv", ".csv"), text)


def names(folder: Path) -> set[str]:
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


def test_a_second_plan_leaves_nothing_of_the_first(tmp_path: Path) -> None:
    fill(tmp_path, plan_json="1", drive_by_json="1", trajectories__a_csv="1", trajectories__b_csv="1")
    (tmp_path / "notes.txt").write_text("mine")
    fill(tmp_path, plan_json="2", trajectories__b_csv="2")
    assert names(tmp_path) == {"plan.json", "trajectories/b.csv", LIST, "notes.txt"}
    assert (tmp_path / "plan.json").read_text() == "2"
    fill(tmp_path, plan_json="3")
    assert names(tmp_path) == {"plan.json", LIST, "notes.txt"}
    assert not (tmp_path / "trajectories").exists()


def test_what_is_added_replaces_only_its_own(tmp_path: Path) -> None:
    fill(tmp_path, plan_json="1", trajectories__a_csv="1")
    with OutputFolder(tmp_path).filled(added=True) as draft:
        write_file(draft / "plan.json", "2")
        write_file(draft / "drive_by.json", "2")
    assert names(tmp_path) == {"plan.json", "trajectories/a.csv", "drive_by.json", LIST}
    assert (tmp_path / "plan.json").read_text() == "2"
    fill(tmp_path, plan_json="3")
    assert names(tmp_path) == {"plan.json", LIST}


def test_a_checkpoint_replaces_the_one_before(tmp_path: Path) -> None:
    own = ("partial_*.sdf", "progress.json", "map.sdf", LIST)
    for count in (1, 2):
        with OutputFolder(tmp_path, own).filled(added=True, replacing="partial_*.sdf") as draft:
            write_file(draft / f"partial_{count}.sdf", "x")
            write_file(draft / "progress.json", str(count))
        assert names(tmp_path) == {f"partial_{count}.sdf", "progress.json", LIST}
    with OutputFolder(tmp_path, own).filled() as draft:
        write_file(draft / "map.sdf", "x")
    assert names(tmp_path) == {"map.sdf", LIST}
    with pytest.raises(mg.IoError, match=r"holds map.sdf, written by another command"):
        OutputFolder(tmp_path)


def test_ctrl_c_while_files_come_to_their_places_counts_afterwards(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace = os.replace

    def interrupted(source: Path, target: Path) -> None:
        if ".writing." in str(source) and ".writing." not in str(target):
            signal.raise_signal(signal.SIGINT)
        replace(source, target)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    monkeypatch.setattr(os, "replace", interrupted)
    try:
        with pytest.raises(KeyboardInterrupt):
            fill(tmp_path, plan_json="1", trajectories__a_csv="1")
    finally:
        signal.signal(signal.SIGINT, before)
    assert names(tmp_path) == {"plan.json", "trajectories/a.csv", LIST}


@pytest.mark.parametrize("name", ["plan.json", "trajectories/pick_00.csv", "stop_3.png", "report.html", LIST])
def test_files_of_somebody_else_are_not_taken_for_ours(tmp_path: Path, name: str) -> None:
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_text("mine")
    with pytest.raises(mg.IoError, match="does not list"):
        OutputFolder(tmp_path)
    assert (tmp_path / name).read_text() == "mine"


@pytest.mark.parametrize("name", ["plan.json", "trajectories/a.csv"])
def test_files_that_were_edited_since_are_not_replaced(tmp_path: Path, name: str) -> None:
    fill(tmp_path, plan_json="1", trajectories__a_csv="1")
    (tmp_path / name).write_text("by hand")
    with pytest.raises(mg.IoError, match=rf"holds {name}, changed since mmgrasp wrote it"):
        OutputFolder(tmp_path)
    assert (tmp_path / name).read_text() == "by hand"
    (tmp_path / name).unlink()
    fill(tmp_path, plan_json="2")
    assert names(tmp_path) == {"plan.json", LIST}


@pytest.mark.parametrize("done", range(6))
def test_where_one_file_cannot_be_moved_all_stay_as_they_were(
    done: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fill(tmp_path, plan_json="1", trajectories__a_csv="1", trajectories__old_csv="1")
    before = {path: path.read_text() for path in tmp_path.rglob("*") if path.is_file() and path.name != LIST}
    replace, moved = os.replace, []

    def broken(source: Path, target: Path) -> None:
        if ".writing." in f"{source}{target}" and Path(target).name != LIST:
            moved.append(target)
            if len(moved) == done + 1:
                raise OSError(errno.EIO, "broken here")
        replace(source, target)

    monkeypatch.setattr(os, "replace", broken)
    with pytest.raises(mg.IoError, match="broken here"):
        fill(tmp_path, plan_json="2", trajectories__a_csv="2", trajectories__b_csv="2")
    monkeypatch.setattr(os, "replace", replace)
    assert {path: path.read_text() for path in tmp_path.rglob("*") if path.is_file() and path.name != LIST} == before
    fill(tmp_path, plan_json="3")
    assert names(tmp_path) == {"plan.json", LIST}


KILLED = """
import os, sys
from pathlib import Path
from mmgrasp.cli.output_folder import OutputFolder
left, replace = int(sys.argv[2]), os.replace
def killed(source, target):
    global left
    left -= 1
    if left < 0:
        os._exit(9)
    replace(source, target)
with OutputFolder(Path(sys.argv[1])).filled() as draft:
    (draft / "trajectories").mkdir()
    for name in ("plan.json", "trajectories/a.csv", "trajectories/b.csv"):
        (draft / name).write_text("2")
    os.replace = killed
"""


def test_a_run_that_is_killed_leaves_no_plan_beside_files_of_another(tmp_path: Path) -> None:
    seen: set[str] = set()
    for moves in range(12):
        folder = tmp_path / str(moves)
        fill(folder, plan_json="1", trajectories__a_csv="1", trajectories__old_csv="1")
        code = subprocess.run([sys.executable, "-c", KILLED, folder, str(moves)]).returncode
        files = {name: (folder / name).read_text() for name in names(folder) - {LIST} if ".writing." not in name}
        plan = files.pop("plan.json", "none")
        seen.add(plan)
        assert plan == "none" or set(files.values()) == {plan}
        assert plan != "2" or set(files) == {"trajectories/a.csv", "trajectories/b.csv"}
        fill(folder, plan_json="3")
        assert names(folder) == {"plan.json", LIST}
        if code == 0:
            break
    assert code == 0
    assert seen == {"1", "none", "2"}


def test_lists_of_earlier_versions_are_read(tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text("old")
    (tmp_path / LIST).write_text(json.dumps({"format": "mmgrasp-files", "files": [LIST, "plan.json"]}))
    fill(tmp_path, plan_json="2")
    assert (tmp_path / "plan.json").read_text() == "2"


@pytest.mark.parametrize("listed", ["../outside", "/etc/hosts", "a/b/c", 3, None, {"a": 1}])
def test_a_list_that_leads_elsewhere_removes_nothing(tmp_path: Path, listed: object) -> None:
    outside, folder = tmp_path / "outside", tmp_path / "folder"
    outside.write_text("mine")
    folder.mkdir()
    (folder / LIST).write_text(json.dumps({"format": "mmgrasp-files", "files": [LIST, listed]}))
    try:
        fill(folder, plan_json="1")
    except mg.IoError as error:
        assert "does not list" in str(error)
    assert outside.read_text() == "mine"
    assert Path("/etc/hosts").exists()


def test_a_run_that_fails_leaves_the_old_plan(tmp_path: Path) -> None:
    fill(tmp_path, plan_json="1")

    def broken() -> None:
        with OutputFolder(tmp_path).filled() as draft:
            write_file(draft / "plan.json", "2")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        broken()
    assert names(tmp_path) == {"plan.json", LIST}
    assert (tmp_path / "plan.json").read_text() == "1"


def fill_late(folder: OutputFolder) -> str:
    """Writes a plan after something happened to the folder; the message, and what it says of where the plan is holds."""
    with pytest.raises(mg.IoError) as caught:
        folder.fill(lambda draft: write_file(draft / "plan.json", "ours"))
    message = str(caught.value)
    kept = Path(message.rsplit(" is in ", 1)[1])
    assert (kept / "plan.json").read_text() == "ours"
    assert names(kept) == {"plan.json", LIST}
    shutil.rmtree(kept)
    return message


@pytest.mark.parametrize("name", ["plan.json", "report.html", "stop_7.png", "trajectories/a.csv", LIST])
@pytest.mark.parametrize("before", [False, True])
def test_what_somebody_writes_in_the_meantime_is_not_replaced(tmp_path: Path, name: str, before: bool) -> None:
    out = tmp_path / "out"
    if before:
        fill(out, plan_json="1", trajectories__a_csv="1")
    folder = OutputFolder(out)
    (out / name).parent.mkdir(parents=True, exist_ok=True)
    (out / name).write_text("theirs")
    others = {n: (out / n).read_text() for n in names(out)}
    message = fill_late(folder)
    assert name in message and "somebody else in the meantime" in message
    assert {n: (out / n).read_text() for n in names(out)} == others
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_two_runs_into_one_folder_lose_neither_plan(tmp_path: Path) -> None:
    first, second = OutputFolder(tmp_path / "out"), OutputFolder(tmp_path / "out")
    second.fill(lambda draft: write_file(draft / "plan.json", "theirs"))
    assert "plan.json" in fill_late(first)
    assert (tmp_path / "out" / "plan.json").read_text() == "theirs"
    second.fill(lambda draft: write_file(draft / "plan.json", "again"))
    assert (tmp_path / "out" / "plan.json").read_text() == "again"


def test_a_run_leaves_the_draft_of_another_and_removes_that_of_a_killed_one(tmp_path: Path) -> None:
    out = tmp_path / "out"
    filling = "import sys, pathlib; from mmgrasp.cli.output_folder import OutputFolder"
    filling += (
        "\nwith OutputFolder(pathlib.Path(sys.argv[1])).filled() as draft: print(draft, flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", filling, str(out)]
    with (
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as killed,
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as living,
    ):
        drafts = [Path(str(run.stdout and run.stdout.readline().strip())) for run in (killed, living)]
        killed.kill()
        killed.wait()
        assert [draft.is_dir() for draft in drafts] == [True, True]
        OutputFolder(out).fill(lambda draft: write_file(draft / "plan.json", "ours"))
        assert [draft.is_dir() for draft in drafts] == [False, True]
        living.communicate()
    assert names(out) == {LIST, "plan.json"}


@pytest.mark.parametrize("what", ["a file", "below a file", "a link loop"])
def test_a_place_that_can_no_longer_be_written_does_not_lose_the_plan(tmp_path: Path, what: str) -> None:
    out = tmp_path / "some" / "out"
    folder = OutputFolder(out)
    if what == "a file":
        out.parent.mkdir()
        out.write_text("theirs")
    elif what == "below a file":
        out.parent.write_text("theirs")
    else:
        out.parent.symlink_to(out.parent)
    assert "cannot be written" in fill_late(folder)


def test_a_result_whose_place_went_away_is_kept_elsewhere(tmp_path: Path) -> None:
    (tmp_path / "out.json").mkdir()
    with pytest.raises(mg.IoError, match=r"is a folder; what was to be written there is in ") as caught:
        write_result(tmp_path / "out.json", "found")
    kept = Path(str(caught.value).rpartition(" is in ")[2])
    assert kept.name == "out.json" and kept.read_text() == "found"
    shutil.rmtree(kept.parent)


def test_a_disk_that_is_full_does_not_lose_the_plan(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: Any = tempfile.mkstemp

    def full(*arguments: Any, dir: Any = None, **more: Any) -> Any:
        if str(dir).startswith(str(tmp_path)) and not str(dir).startswith(str(tmp_path / "elsewhere")):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return made(*arguments, dir=dir, **more)

    (tmp_path / "elsewhere").mkdir()
    folder = OutputFolder(tmp_path / "out")
    monkeypatch.setattr(tempfile, "mkstemp", full)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "elsewhere"))
    assert "No space left" in fill_late(folder)


def test_pictures_that_fail_do_not_lose_the_plan(tmp_path: Path) -> None:
    folder = OutputFolder(tmp_path)
    folder.fill(lambda draft: write_file(draft / "plan.json", "ours"))
    for error in (MemoryError(), ImportError("no such library"), OSError(errno.ENOSPC, "No space left")):
        with pytest.raises(mg.IoError, match=r"the results are in .*, without"), folder.illustrated() as draft:
            write_file(draft / "stop_1.png", "half")
            raise error
        assert names(tmp_path) == {"plan.json", LIST}
    with folder.illustrated() as draft:
        write_file(draft / "stop_1.png", "whole")
    assert names(tmp_path) == {"plan.json", "stop_1.png", LIST}


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


def test_an_interruption_among_the_pictures_says_what_is_there(tmp_path: Path) -> None:
    with (
        pytest.raises(KeyboardInterrupt, match=r"the results are in .*, without"),
        OutputFolder(tmp_path).illustrated(),
    ):
        raise KeyboardInterrupt


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
