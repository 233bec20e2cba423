"""Little memory, little stack: the command works, or says so in one line."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from conftest import ASSETS, edited

ROBOT = str(ASSETS / "robots" / "omni6" / "omni6.urdf")
ENTRY = "import sys, mmgrasp_command; sys.exit(mmgrasp_command.main())"


# The C library and others end the process by themselves, with a line of their own, where they get no memory.
ENDED_BY_LIBRARY = ("OpenBLAS error", "libgcc_s.so.1 must be installed", "cannot allocate memory for thread-local data")


def command(kind: int, limit: int, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs the command in a process that has so much of something [bytes]."""

    def restrict() -> None:
        resource.setrlimit(kind, (limit, resource.getrlimit(kind)[1]))

    call = [sys.executable, "-c", ENTRY, *arguments]
    return subprocess.run(call, preexec_fn=restrict, capture_output=True, text=True, timeout=300)


@pytest.mark.parametrize("megabytes", [60, 100, 150, 200, 250, 300])
def test_little_memory_is_one_message(megabytes: int) -> None:
    done = command(resource.RLIMIT_AS, megabytes * 1_000_000, "check", ROBOT)
    assert "Traceback" not in done.stderr
    said = [line for line in done.stderr.splitlines() if line.strip()]
    assert len(said) == 1 and len(said[0]) < 400, done.stderr
    if not said[0].startswith(ENDED_BY_LIBRARY):
        assert said[0].startswith("mmgrasp: ")
        assert done.returncode == 2


@pytest.mark.slow
def test_little_memory_while_planning_is_one_message(
    small: dict[str, Any], write: Callable[..., Path], tmp_path: Path
) -> None:
    """The database needs 1.3 GB, far more than the libraries: what ends the process there is ours to say."""
    path = write(edited(small, "reach.samples", 60_000_000))
    for megabytes in (700, 900):
        done = command(resource.RLIMIT_AS, megabytes * 1_000_000, "plan", str(path), "-o", str(tmp_path / "plan"))
        assert "Traceback" not in done.stderr
        assert done.returncode == 2, done.stderr
        assert done.stderr.count("mmgrasp: ") == 1, done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("megabytes", [350, 400, 450, 500, 550])
def test_memory_that_just_suffices_is_one_message_too(megabytes: int, small_path: Path, tmp_path: Path) -> None:
    """Where it ends depends on what is cached and on the libraries; a plan, no plan or one message it is anyway."""
    done = command(resource.RLIMIT_AS, megabytes * 1_000_000, "plan", str(small_path), "-o", str(tmp_path))
    assert "Traceback" not in done.stderr, done.stderr
    if not any(line in done.stderr for line in ENDED_BY_LIBRARY):
        assert done.returncode in (0, 2, 4)
        assert done.stderr.count("mmgrasp: ") == (done.returncode == 2), done.stderr


@pytest.mark.slow
def test_threads_have_stacks_of_their_own(small_path: Path, tmp_path: Path) -> None:
    """A thread's stack is as large as the process's unless told otherwise: with 128 kB planning ended in a crash."""
    done = command(resource.RLIMIT_STACK, 128 * 1024, "plan", str(small_path), "-o", str(tmp_path), "--no-pictures")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "plan.json").is_file()
