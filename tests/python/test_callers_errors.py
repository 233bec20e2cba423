"""What the caller's own function raises comes out of a call as it was: it is no fault of a file or of the cache."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import mmgrasp as mg
from argument_objects import ARM
from mmgrasp._reach_cache import cached_database

ERRORS = [mg.InvalidInput("mine"), mg.IoError("mine"), OSError("mine"), KeyError("mine"), KeyboardInterrupt()]


def raised_at(when: Callable[[str], bool], error: BaseException) -> Callable[[str, float], None]:
    """A progress function that raises the error at the first stage of which `when` holds."""

    def hear(stage: str, fraction: float) -> None:
        if when(stage):
            raise error

    return hear


@pytest.mark.parametrize("error", ERRORS, ids=lambda e: type(e).__name__)
@pytest.mark.parametrize("stage", ["", "base regions"])
def test_planning(small_path: Path, error: BaseException, stage: str) -> None:
    with pytest.raises(type(error)) as raised:
        mg.plan_part_supply(small_path, progress=raised_at(lambda now: stage in now, error))
    assert raised.value is error


@pytest.mark.parametrize("error", ERRORS, ids=lambda e: type(e).__name__)
def test_the_cache_is_not_blamed(error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with pytest.raises(type(error)) as raised:
        cached_database(ARM, progress=raised_at(lambda stage: True, error), samples=20_000)
    assert raised.value is error


@pytest.mark.parametrize(("stage", "error"), [
    *(("rendering frames", error) for error in ERRORS),
    *(pytest.param(late, ERRORS[0], marks=pytest.mark.slow) for late in ("integrating frames", "grasps of what was scanned")),
])  # fmt: skip
def test_the_file_of_a_rendered_scan_is_not_blamed(
    stage: str, error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    with pytest.raises(type(error)) as raised:
        mg.load_scenario("asset:scenarios/scanned_tray.yaml", progress=raised_at(lambda now: stage in now, error))
    assert raised.value is error
