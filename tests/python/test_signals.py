"""A signal, or a reader that is gone, ends a command with its own exit code, without a traceback, and leaves nothing half written."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from mmgrasp._files import write_file
from mmgrasp.cli.output_folder import OutputFolder
from mmgrasp.cli.signals import Ended, ended_by_signals, uninterrupted

MMGRASP = [sys.executable, "-m", "mmgrasp"]


@pytest.fixture(autouse=True)
def signals_end_programs() -> Iterator[None]:
    """Who runs the tests may ignore signals (nohup does), and programs inherit that."""
    before = {number: signal.signal(number, signal.SIG_DFL) for number in (signal.SIGTERM, signal.SIGHUP)}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_the_command_ends_on_a_signal(
    number: signal.Signals, code: int, small: dict[str, Any], write: Callable[..., Path], tmp_path: Path
) -> None:
    command = [*MMGRASP, "plan", str(write({**small, "reach": {"samples": 2_000_000_000}})), "-o", str(tmp_path / "o")]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    assert process.stderr is not None
    for line in process.stderr:  # wait until the long stage has begun
        if "reach" in line:
            break
    process.send_signal(number)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == code
    assert error.splitlines()[-1] == f"mmgrasp: ended by {number.name}"
    assert "Traceback" not in error
    assert not (tmp_path / "o").exists()
    assert not list((tmp_path / "cache").rglob("*.reach"))


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_signals_remove_a_draft_and_keep_what_was_there(number: signal.Signals, tmp_path: Path) -> None:
    with OutputFolder(tmp_path).filled() as draft:
        write_file(draft / "plan.json", "old")
    before = signal.getsignal(number)
    with pytest.raises(Ended) as caught, ended_by_signals(), OutputFolder(tmp_path).filled() as draft:
        write_file(draft / "plan.json", "new")
        signal.raise_signal(number)
    assert caught.value.number == number
    assert signal.getsignal(number) is before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["files.json", "plan.json"]
    assert (tmp_path / "plan.json").read_text() == "old"


def test_an_ignored_signal_stays_ignored() -> None:
    """A command under nohup outlives its terminal."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ended_by_signals():
            signal.raise_signal(signal.SIGHUP)
            with uninterrupted():
                signal.raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)


def test_signals_wait_until_files_are_in_their_places() -> None:
    done = []

    def work() -> None:
        with ended_by_signals(), uninterrupted():
            signal.raise_signal(signal.SIGTERM)
            done.append(True)

    with pytest.raises(Ended):
        work()
    assert done == [True]


@pytest.mark.parametrize("arguments", [["--help"], ["plan", "--help"], ["reproduce"], ["--version"]])
def test_output_that_nobody_reads(arguments: list[str]) -> None:
    """Neither 0, which says that all was told, nor 1, which says that a plan has faults."""
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run([*MMGRASP, *arguments], stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert (done.returncode, done.stderr) == (141, "")
    with open("/dev/full", "w") as full:
        done = subprocess.run([*MMGRASP, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    assert "No space left" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("streams", [["stdout"], ["stdout", "stderr"]])
def test_a_verdict_that_nobody_reads(streams: list[str], small_plan_dict: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "plan.json").write_text(json.dumps(small_plan_dict))
    reading, writing = os.pipe()
    os.close(reading)
    command = [*MMGRASP, "verify", str(tmp_path / "plan.json"), "--samples", "20"]
    errors = writing if "stderr" in streams else None
    done = subprocess.run(command, stdout=writing, stderr=errors, text=True)
    os.close(writing)
    assert done.returncode == 141


def test_a_draft_goes_where_no_more_files_can_be_opened(tmp_path: Path) -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    handles: list[int] = []

    def fill() -> None:
        with OutputFolder(tmp_path).filled() as draft:
            write_file(draft / "plan.json", "new")
            write_file(draft / "trajectories" / "a.csv", "new")
            handles.append(os.open(os.devnull, os.O_RDONLY))
            resource.setrlimit(resource.RLIMIT_NOFILE, (handles[0] + 5, hard))
            while True:
                handles.append(os.open(os.devnull, os.O_RDONLY))

    try:
        with pytest.raises(OSError, match="Too many open files"):
            fill()
        left = handles.pop()
        os.close(left)
        assert os.listdir(tmp_path) == []
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
        for handle in handles:
            os.close(handle)
