"""Base tracking through the Python door: what the closed forms say, trajectories made by hand, wrong input."""

from __future__ import annotations

import numpy as np
import pytest

import mmgrasp as mg

URDF = '<robot name="r"><link name="base"/></robot>'
LIMITS = {"linear_velocity": 2.0, "angular_velocity": 3.0, "wheel_separation": 0.4}
ROBOT = mg.Robot.from_strings(URDF, base="diff_drive", base_limits=LIMITS)


def straight(v: float = 0.5, duration: float = 4.0) -> mg.planning.JointTrajectory:
    times = np.arange(0.0, duration + 0.01, 0.02)
    return mg.planning.JointTrajectory(
        ["x", "y", "theta"],
        times,
        np.outer(times, [v, 0, 0]),
        np.tile([v, 0.0, 0.0], (len(times), 1)),
    )


def test_arcs_are_exact() -> None:
    assert mg.base.drive_arc([0, 0, 0], [1.0, 0, np.pi], 0.5) == pytest.approx(
        [1 / np.pi, 1 / np.pi, np.pi / 2], abs=1e-15
    )


def test_slip_open_and_closed_loop() -> None:
    run = mg.base.track_base(ROBOT, straight(), feedback=False, slip_left=0.1, slip_right=0.1)
    assert run.position_errors == pytest.approx(0.1 * 0.5 * run.times, abs=1e-12)
    closed = mg.base.track_base(ROBOT, straight(), slip_left=0.1, slip_right=0.1)
    assert closed.final_error < 0.1 * run.final_error * 1.5
    assert closed.max_error == closed.position_errors.max()
    assert closed.desired[-1] == pytest.approx([2.0, 0, 0])
    assert len(closed.commands) + 1 == len(closed.actual) == len(closed.times)


def test_the_tracker_alone_gives_the_same_commands() -> None:
    run = mg.base.track_base(ROBOT, straight(), start_error=[0.1, -0.05, 0.2])
    tracker = mg.base.BaseTracker(ROBOT)
    assert tracker.period == 0.02
    for k, expected in enumerate(run.commands):
        given = tracker.command(run.desired[k], run.desired[k + 1], run.actual[k])
        assert given == pytest.approx(expected, abs=1e-12)


def test_trajectories_made_by_hand() -> None:
    made = straight()
    assert made.at(1.0) == pytest.approx([0.5, 0, 0])
    assert made.duration == pytest.approx(4.0)
    corner = mg.planning.JointTrajectory(["a", "b"], [0, 1, 3], [[0, 0], [1, 0], [1, 4]])
    assert corner.at(2.0) == pytest.approx([1, 2])
    for times, positions in (([0, 1], [[1, 2]]), ([0, 0], [[1, 2], [1, 2]]), ([1, 2], [[1, 2], [1, 2]])):
        with pytest.raises(mg.InvalidInput, match="times"):
            mg.planning.JointTrajectory(["a", "b"], times, positions)
    with pytest.raises(mg.InvalidInput, match="velocities"):
        mg.planning.JointTrajectory(["a", "b"], [0, 1], [[1, 2], [3, 4]], [[0, 0]])


def test_wrong_input_is_refused() -> None:
    with pytest.raises(mg.InvalidInput, match=r"did you mean slip_left"):
        mg.base.track_base(ROBOT, straight(), slip_lef=0.1)  # type: ignore[call-arg]
    for bad in ({"slip_left": 1.0}, {"kp": -1}, {"offset": 0}, {"drift": [0, 0]}, {"start_error": [0, np.nan, 0]}):
        with pytest.raises(mg.InvalidInput, match=next(iter(bad))):
            mg.base.track_base(ROBOT, straight(), **bad)
    arm = mg.planning.JointTrajectory(["a", "b", "c"], [0, 1], np.zeros((2, 3)))
    with pytest.raises(mg.InvalidInput, match="column 'x'"):
        mg.base.track_base(ROBOT, arm)
    with pytest.raises(mg.InvalidInput, match="kind"):
        mg.base.BaseTracker(mg.Robot.from_strings(URDF))
