"""A folder that a command fills: one run's files and nothing of another's, whatever ends it."""

from __future__ import annotations

import errno
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from mmgrasp._files import (
    write_file,
)
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


def test_an_interruption_among_the_pictures_says_what_is_there(tmp_path: Path) -> None:
    with (
        pytest.raises(KeyboardInterrupt, match=r"the results are in .*, without"),
        OutputFolder(tmp_path).illustrated(),
    ):
        raise KeyboardInterrupt
