"""Ctrl-C ends a long call and leaves nothing half written. (How fast is measured elsewhere; here it must only end.)"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from argument_objects import ARM, OBJECTS, POSE, Q, sdf_map
from costly_work import blind_motion


@pytest.fixture(autouse=True)
def interruptible() -> Iterator[None]:
    """A shell's background job is started with SIGINT ignored, and so would be what it starts."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt_soon(delay: float = 0.5) -> threading.Timer:
    timer = threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


def test_building_a_database_can_be_interrupted(small_path: Path, tmp_path: Path) -> None:
    arm = mg.load_scenario(small_path).setup.arm
    timer = interrupt_soon()
    begun = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        mg.ReachDatabase.load_or_build(arm, tmp_path, samples=2_000_000_000)
    timer.join()
    assert time.monotonic() - begun < 60, "the whole build would take an hour"
    assert [p.name for p in tmp_path.iterdir() if not p.name.endswith(".partial")] == [], "finished parts at most"


HARD_COVER = [[i % 300, *np.random.default_rng(i).integers(0, 300, 11).tolist()] for i in range(900)]
CHECKER = OBJECTS["CollisionChecker"]()
AHEAD = ARM.fk(Q + [0, 0, 0.2])
LONG_PATH = np.cumsum(np.random.default_rng(1).normal(size=(20_000, 3)) / 10, axis=0)
ENDLESS: dict[str, Callable[..., Any]] = {
    "solve_set_cover": lambda **k: mg.optim.solve_set_cover(300, HARD_COVER, time_limit=1000, **k),
    "plan_straight_line": lambda **k: mg.planning.plan_straight_line(CHECKER, Q, AHEAD, position_step=1e-12, **k),
    "plan_cartesian": lambda **k: mg.plan_cartesian(CHECKER, [POSE, AHEAD], near=Q, position_step=1e-12, **k),
    "time_parameterize": lambda **k: mg.time_parameterize(LONG_PATH, [1] * 3, [1] * 3, jerk_limits=[1] * 3, **k),
    "time_parameterize_free": lambda **k: mg.planning.time_parameterize_free(CHECKER, [Q, Q / 2], joint_step=1e-9, **k),
}


@pytest.mark.parametrize("name", ENDLESS)
def test_lines_and_timing_can_be_interrupted(name: str) -> None:
    """With the lock held, the timer could not even send the signal."""
    timer = interrupt_soon()
    with pytest.raises(KeyboardInterrupt):
        ENDLESS[name]()
    timer.join()


@pytest.mark.parametrize("delay", [0.05, 0.12, 0.2, 0.3])
def test_a_set_cover_is_interrupted_at_any_moment(delay: float) -> None:
    """CBC has a handler of its own in place while it prepares the problem."""
    timer = threading.Timer(delay, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        mg.optim.solve_set_cover(300, HARD_COVER, time_limit=20)
    timer.join()


MAP = sdf_map()
AT_THE_MAP = MAP.points()[0][0]


@pytest.mark.parametrize(
    ("batch", "row"),
    [
        (CHECKER.are_free, Q),
        (ARM.fk_batch, Q),
        (MAP.query, AT_THE_MAP),
        (lambda directions: MAP.cast_rays(np.zeros_like(directions), directions), AT_THE_MAP),
    ],
)
def test_batches_of_millions_of_rows_can_be_interrupted(batch: Callable[..., Any], row: np.ndarray) -> None:
    rows = np.tile(row, (3_000_000, 1))
    timer = interrupt_soon(0.05)
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):  # a fast machine may be done with the first
            batch(rows)
    timer.join()


def test_batches_are_the_same_in_any_pieces() -> None:
    """They are worked on in pieces of 256 rows and more; the last of a piece has no neighbours."""
    rows = np.random.default_rng(5).uniform(-2, 2, (2000, len(Q)))
    for batch in (CHECKER.are_free, ARM.fk_batch, ARM.jacobian_batch, ARM.manipulability_batch):
        whole = batch(rows)
        for first, last in ((0, 1), (255, 258), (700, 1999)):
            assert np.array_equal(batch(rows[first:last]), whole[first:last])
        assert len(batch(rows[:0])) == 0
    assert np.array_equal(CHECKER.are_free(rows), [CHECKER.is_free(q) for q in rows])


def test_lines_and_timing_tell_their_progress() -> None:
    calls: dict[str, Callable[..., Any]] = {
        "straight line": lambda **k: mg.planning.plan_straight_line(CHECKER, Q, AHEAD, **k),
        "cartesian path": lambda **k: mg.plan_cartesian(CHECKER, [POSE, AHEAD], near=Q, **k),
        "limit jerk": lambda **k: mg.time_parameterize([Q, Q / 2], [1] * 3, [1] * 3, jerk_limits=[1] * 3, **k),
        "check timed path": lambda **k: mg.planning.time_parameterize_free(CHECKER, [Q, Q / 2], **k),
    }
    for stage, call in calls.items():
        reported: list[tuple[str, float]] = []
        call(progress=lambda *now, reported=reported: reported.append(now))
        assert reported and {name for name, _ in reported} == {stage}
        assert all(0 <= fraction <= 1 for _, fraction in reported)


def test_a_silent_stage_is_told_again_once_a_second() -> None:
    """No motion leads to the goal, and the search has nothing to say before it has one."""
    heard: list[tuple[str, float]] = []
    moments: list[float] = []

    def progress(stage: str, fraction: float) -> None:
        heard.append((stage, fraction))
        moments.append(time.monotonic())
        if len(heard) == 4:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        blind_motion(progress)()
    assert heard == [("plan motion", 0.0)] * 4
    assert moments[-1] - moments[0] >= 2.0, "three times, a second apart, not at each look"


def test_no_stage_of_a_plan_begins_anew(small: dict[str, Any], write: Callable[..., Path]) -> None:
    """Drives between seven stops are estimated, chosen and planned one after the other, and picks are planned stop after stop."""
    tray = {**small["trays"][0], "parts": [{"type": "bracket", "xyz": [0.0, 0.0]}], "targets": [0]}
    trays = [{**tray, "name": f"T{k}", "pose": {"xyz": [2.0, 3.2 * k - 10, 0.706]}} for k in range(7)]
    room = {"trays": trays, "obstacles": [], "start": [0, 0, 0], "goal": [-1, 0, 0]}
    options = {"options": {"grid_resolution": 0.1, "robustness_samples": 0, "seed": 1}, "reach": {"samples": 100_000}}
    told: dict[str, list[float]] = {}
    plan = mg.plan_part_supply(
        write({**small, **room, **options}), progress=lambda stage, share: told.setdefault(stage, []).append(share)
    )
    assert plan.outcome == mg.Outcome.solved and len(plan.stops) == 7
    for stage, shares in told.items():
        assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] == 1, (stage, shares)
    assert len(set(told["route"])) > 5
    assert any(0.5 < share < 1 for share in told["route"]), "its passes go on from the ones before"


def test_an_error_in_the_progress_callback_ends_the_call(small_path: Path) -> None:
    arm = mg.load_scenario(small_path).setup.arm

    def fail(stage: str, fraction: float) -> None:
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        mg.ReachDatabase.build(arm, samples=2_000_000_000, progress=fail)


def test_the_command_ends_on_ctrl_c(small: dict[str, Any], write: Callable[..., Path], tmp_path: Path) -> None:
    scenario = {**small, "reach": {"samples": 2_000_000_000}}
    command = [sys.executable, "-m", "mmgrasp", "plan", str(write(scenario)), "-o", str(tmp_path / "out")]
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path / "cache")}
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, env=environment)
    assert process.stderr is not None
    for line in process.stderr:  # wait until the long stage has begun
        if "reach" in line:
            break
    process.send_signal(signal.SIGINT)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert "Traceback" not in error
    assert not (tmp_path / "out").exists()
    assert not list((tmp_path / "cache").rglob("*.reach"))


@pytest.mark.slow
def test_a_plan_survives_when_motions_in_passing_are_interrupted(small_path: Path, tmp_path: Path) -> None:
    """What is found first is a plan of its own: Ctrl-C later ends the command at once and leaves that whole."""
    command = [sys.executable, "-m", "mmgrasp", "plan", str(small_path), "-o", str(tmp_path), "--drive-by"]
    process = subprocess.Popen([*command, "--no-pictures"], stderr=subprocess.PIPE, text=True)
    assert process.stderr is not None
    for line in process.stderr:
        if "drive-by 1 of " in line:
            break
    process.send_signal(signal.SIGINT)
    error = process.communicate(timeout=60)[1]
    assert process.returncode == 130
    assert "Traceback" not in error
    assert not (tmp_path / "drive_by.json").exists()
    assert "drive_by" not in json.loads((tmp_path / "plan.json").read_text())
    assert mg.verify_plan(tmp_path / "plan.json", samples=20).ok


@pytest.mark.parametrize("delay", [0.1, 0.4, 1.0])
def test_a_check_of_a_plan_can_be_interrupted(delay: float, small_plan_dict: dict[str, Any]) -> None:
    timer = interrupt_soon(delay)
    with pytest.raises(KeyboardInterrupt):
        mg.verify_plan(small_plan_dict, samples=1_000_000, required_rate=1e-6, region_samples=100_000)
    timer.join()


def test_a_long_set_cover_tells_that_it_goes_on() -> None:
    heard: list[float] = []

    def progress(stage: str, fraction: float) -> None:
        assert stage == "set cover"
        heard.append(fraction)
        if len(heard) == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        mg.optim.solve_set_cover(300, HARD_COVER, time_limit=1000, progress=progress)
    assert heard == sorted(heard)
