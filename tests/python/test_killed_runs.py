"""Runs that are ended leave one plan, whole, or none, and it is told when they do not. (`killed_runs.py` by itself
ends the command.)"""

from __future__ import annotations

import hashlib
import json
import signal
import sys
from pathlib import Path

import pytest

import killed_runs
import mmgrasp as mg
from killed_runs import ACTS, MINE, NEW, OLD, Files, Run, ending_fault, folder_fault, runs, small_fills
from mmgrasp.cli.output_folder import LIST


def test_an_error_that_no_command_should_raise_is_told(tmp_path: Path) -> None:
    def broken(out: Path, files: Files) -> None:
        (out / "plan.json").rename(out / "other")

    found = dict(small_fills(tmp_path, "an error", broken))
    assert "neither an error of mmgrasp's nor Ctrl-C" in found[0]


@pytest.mark.parametrize("what", ACTS)
def test_a_fill_that_is_ended_at_any_step_leaves_one_plan_or_none(what: str, tmp_path: Path) -> None:
    found = dict(small_fills(tmp_path, what))
    assert len(found) > 20
    assert {step: why for step, why in found.items() if why} == {}


def in_place(out: Path, files: Files) -> None:
    """What no command should do: each file is moved over the old one, the plan first."""
    try:
        replace_each(out, files)
    except OSError as error:
        raise mg.IoError(str(error)) from None


def replace_each(out: Path, files: Files) -> None:
    known = json.loads((out / LIST).read_text())
    for name, text in files.items():
        digest = hashlib.sha256(text.encode()).hexdigest()
        known["files"][name] = sorted({*known["files"].get(name, []), digest})
        (out / LIST).write_text(json.dumps(known))
        (out.parent / "draft").write_text(text)
        (out / name).parent.mkdir(exist_ok=True)
        (out.parent / "draft").replace(out / name)
    for name in OLD.keys() - files.keys():
        (out / name).unlink()


@pytest.mark.parametrize("what", ACTS)
def test_files_that_are_replaced_one_by_one_are_complained_of(what: str, tmp_path: Path) -> None:
    found = [why for _, why in small_fills(tmp_path, what, in_place)]
    assert any("neither the old nor the new plan alone" in why for why in found)


KILLED = Run(2, (), signal.SIGKILL, 1.0)
STOPPED = Run(2, (), signal.SIGTERM, 1.0)
PLAN_FILES = {"plan.json", "trajectories/a.csv"}


def written(count: int, way: tuple[str, ...]) -> Files:
    return killed_runs.digests({name: WHOLE[name] for name in (PLAN_FILES if way else WHOLE)})


def folder(out: Path, files: Files, listed: dict[str, list[str]] | None = None) -> Path:
    """A folder with such files, and a list of them with their checksums and others."""
    known = {name: [hashlib.sha256(text.encode()).hexdigest()] for name, text in files.items()}
    for name, text in {**files, MINE: "mine"}.items():
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_text(text)
    for name, digests in (listed or {}).items():
        known[name] = known.get(name, []) + digests
    (out / LIST).write_text(json.dumps({"files": known}))
    return out


def plan(name: str) -> str:
    return json.dumps({"scenario": {"name": name}})


BEFORE = {"plan.json": plan("before"), "trajectories/a.csv": "old"}
WHOLE = {"plan.json": plan("now"), "trajectories/a.csv": "new", "topview.png": "new", "report.html": "new"}


def fault(out: Path, code: int | None, before: Files = BEFORE) -> str:
    return folder_fault(out, killed_runs.digests(before), KILLED, "now", code, written)


def test_the_old_plan_none_and_the_new_one_are_let_pass(tmp_path: Path) -> None:
    assert fault(folder(tmp_path / "old", BEFORE), 137) == ""
    assert fault(folder(tmp_path / "new", WHOLE), 0) == ""
    without_pictures = {name: text for name, text in WHOLE.items() if name in PLAN_FILES}
    assert fault(folder(tmp_path / "early", without_pictures), 137) == ""
    half = folder(tmp_path / "half" / "out", {"trajectories/a.csv": "new"})
    (half / ".writing.x" / "old").mkdir(parents=True)
    (half / ".writing.x" / "old" / "plan.json").write_text(BEFORE["plan.json"])
    assert fault(half, 137) == ""


def test_motions_of_an_ended_run_that_the_new_one_writes_again_are_let_pass(tmp_path: Path) -> None:
    """A run that was ended left them without its plan; the next one was ended before the list forgot older ones."""
    out = folder(tmp_path / "out", WHOLE, {"trajectories/a.csv": ["0"]})
    assert fault(out, 137, {"trajectories/a.csv": WHOLE["trajectories/a.csv"]}) == ""
    assert fault(out, 137, {**BEFORE, "trajectories/a.csv": WHOLE["trajectories/a.csv"]}) == ""


@pytest.mark.parametrize(("files", "listed", "code", "why"), [
    (BEFORE, {}, 0, "exit code 0, and the old plan"),
    ({"trajectories/a.csv": "old"}, {}, 137, "neither the old nor the new plan is left"),
    ({**BEFORE, "trajectories/a.csv": "new"}, {}, 137, "the old plan beside files of another run"),
    ({"plan.json": BEFORE["plan.json"]}, {}, 137, "the old plan beside files of another run, or without its own"),
    ({"plan.json": plan("now")}, {}, 137, "the new plan without ['trajectories/a.csv']"),
    ({**WHOLE, "stop_9.png": "old"}, {}, 137, "beside the new plan: ['stop_9.png']"),
    ({**WHOLE, "trajectories/a.csv": "old"}, {"trajectories/a.csv": ["0"]}, 137, "old files beside the new plan"),
    ({name: WHOLE[name] for name in PLAN_FILES}, {}, 0, "the new plan without ['report.html', 'topview.png']"),
])  # fmt: skip
def test_all_else_is_complained_of(
    tmp_path: Path, files: Files, listed: dict[str, list[str]], code: int, why: str
) -> None:
    assert fault(folder(tmp_path / "out", files, listed), code).startswith(why)


def test_lists_and_files_of_others_are_looked_at(tmp_path: Path) -> None:
    out = folder(tmp_path / "out", BEFORE)
    (out / MINE).write_text("theirs")
    assert fault(out, 137) == "a file of somebody's was changed"
    (out / "stray.csv").write_text("x")
    assert fault(out, 137) == "not listed: ['stray.csv']"
    (out / "stray.csv").unlink()
    (out / "plan.json").write_text("x")
    assert fault(out, 137) == "not what the list says: ['plan.json']"
    (out / LIST).unlink()
    assert fault(out, 137).startswith("no list of files")


def test_exit_codes_are_those_of_the_signals() -> None:
    assert [ending_fault(STOPPED, code, "") for code in (0, 143)] == ["", ""]
    assert [ending_fault(KILLED, code, "") for code in (0, 137)] == ["", ""]
    assert "exit code 130" in ending_fault(STOPPED, 130, "")
    assert "exit code 1: no" in ending_fault(KILLED, 1, "no")
    assert "Traceback" in ending_fault(KILLED, 137, "Traceback (most recent call last)")


def test_a_run_that_hangs_is_ended_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(killed_runs, "TOO_LONG", 0.5)
    deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(600)"
    code, said = killed_runs.end(Run(2, (), signal.SIGTERM, 0.4), [sys.executable, "-c", deaf])
    assert ending_fault(STOPPED, code, said) == "did not end within 0 s"


def test_signals_are_told_as_a_shell_does() -> None:
    line = [sys.executable, "-c", "import signal, time; signal.signal(signal.SIGINT, signal.SIG_DFL); time.sleep(600)"]
    assert killed_runs.end(Run(2, (), signal.SIGINT, 0.4), line) == (130, "")
    assert killed_runs.end(Run(2, (), signal.SIGINT, 5.0), [sys.executable, "-c", "raise SystemExit(3)"]) == (3, "")


@pytest.mark.slow
def test_the_command_leaves_one_plan_or_none(tmp_path: Path) -> None:
    assert [why for why in runs(tmp_path, 6, seed=4) if why] == []


def test_old_and_new_files_differ() -> None:
    """Or else a mixture would not show."""
    assert not {OLD[name] for name in OLD} & {NEW[name] for name in NEW}
