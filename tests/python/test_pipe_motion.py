"""The timed motion of a carried pipe against its path, and what is said of paths that no motion follows."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp._core import follow_object_path
from mmgrasp._files import ASSETS
from mmgrasp._turns import rotation_about, rotation_vector, rotation_vectors, rotations_about
from mmgrasp.pipes import load_pipe_problem, plan_pipe
from mmgrasp.pipes.path_section import arc_poses, line_poses
from mmgrasp.pipes.timed_motion import path_error

SCALES = (0.01, 0.05)


def pipe1(tmp_path: Path, **sections: Any) -> Path:
    content = yaml.safe_load((ASSETS / "pipes" / "pipe1.yaml").read_text()) | sections
    path = tmp_path / "problem.yaml"
    path.write_text(yaml.safe_dump(content))
    return path


def test_rows_of_rotations_are_those_of_one_at_a_time() -> None:
    rng = np.random.default_rng(3)
    vectors = rng.uniform(-1.7, 1.7, (50, 3))
    vectors[0], vectors[1] = 0, 1e-9
    R = rotations_about(vectors)
    assert np.allclose(R, [rotation_about(v) for v in vectors], atol=1e-14)
    assert np.allclose(rotation_vectors(R), [rotation_vector(r) for r in R], atol=1e-12)
    half = rotations_about(np.array([[np.pi, 0, 0]]))
    assert np.linalg.norm(rotation_vectors(half)) == pytest.approx(np.pi)


def there_and_back() -> np.ndarray:
    """Half a metre along x, back again a centimetre beside it, and a quarter turn at the end."""
    start = mg.pose([0, 0, 0])
    out = [start, *line_poses(start, mg.pose([0.5, 0, 0]), 10)]
    out += line_poses(out[-1], mg.pose([0.5, 0.01, 0]), 1)
    out += line_poses(out[-1], mg.pose([0, 0.01, 0]), 10)
    out += arc_poses(out[-1], out[-1][:3, 3], np.array([0.0, 0, 1]), np.pi / 2, 5)
    return np.array(out)


def dense(path: np.ndarray, pieces: int = 7) -> np.ndarray:
    rows = [path[:1]]
    for a, b in pairwise(path):
        rows.append(np.array(line_poses(a, b, pieces)))
    return np.concatenate(rows)


def test_a_motion_on_the_path_has_no_error_and_one_beside_it_its_distance() -> None:
    path = there_and_back()
    assert path_error(path, dense(path), SCALES) == pytest.approx((0, 0), abs=1e-9)
    beside = dense(path)
    beside[:, 2, 3] += 0.003
    beside[:, :3, :3] = beside[:, :3, :3] @ rotation_about(np.array([0.02, 0, 0]))
    error = path_error(path, beside, SCALES)  # where it only turns, a turn may stand for a way
    assert 0.003 * (1 - 1e-6) <= error[0] < 0.0035 and 0.015 < error[1] <= 0.02 * (1 + 1e-6)
    error = path_error(path[:11], beside[:71], SCALES)
    assert error == pytest.approx((0.003, 0.02), abs=1e-9)


def test_a_motion_that_cuts_off_a_part_of_the_path_is_off_by_it() -> None:
    path = there_and_back()
    short = np.concatenate([dense(path)[:29], dense(path)[-64:]])  # turns back after 0.2 m: near the path everywhere
    assert path_error(path, short, SCALES)[0] > 0.1
    backwards = dense(path)[::-1]
    assert path_error(path, backwards, SCALES)[1] > 1
    corner = np.delete(
        dense(path), np.arange(57, 92), axis=0
    )  # from 57 mm before the end of the way there to as far after it
    assert path_error(path, corner, SCALES)[0] == pytest.approx(0.1, abs=0.002)
    stops = dense(path)[:-10]  # before the last turns
    assert path_error(path, stops, SCALES)[1] > 0.2


@pytest.mark.parametrize("poses", [18, 300])
def test_however_many_poses_the_same_way_is_timed(poses: int, tmp_path: Path) -> None:
    arc = {"centre": [0, 0, 0.22], "axis": [0, 0, 1], "angle": 0.6, "poses": poses}
    path = pipe1(
        tmp_path, path={"segments": [{"arc": arc}]}, compare=[], options={"max_evaluations": 120, "algorithm": "bees"}
    )
    plan = plan_pipe(load_pipe_problem(path))
    assert plan.trajectory is not None and plan.untimed == 0
    assert plan.path_error[0] < 0.004 and plan.path_error[1] < 0.02
    assert len(plan.waypoint_times) == poses + 1 and np.all(np.diff(plan.waypoint_times) >= 0)
    carried = plan.problem.arm.fk_batch(plan.trajectory.positions) @ np.linalg.inv(plan.grasp.T_object_hand)  # type: ignore[union-attr]
    radius = np.linalg.norm(carried[:, :2, 3], axis=1)  # the pipe's frame goes on a circle
    assert np.abs(radius - np.hypot(0.42, 0.25)).max() < 0.005


def test_what_falls_only_between_the_poses_is_said(tmp_path: Path) -> None:
    path = pipe1(tmp_path, compare=[], options={"max_evaluations": 60, "algorithm": "bees", "max_joint_step": 0.001})
    plan = plan_pipe(load_pipe_problem(path))
    reached = plan.optimum.evaluations - max(plan.optimum.unreachable)
    assert plan.grasp is None and max(plan.optimum.jumping_after) > 0 and reached > 0
    pose = int(np.argmax(plan.optimum.jumping_after))
    assert f"from pose {pose} to the next every motion jumps to another arm posture" in plan.obstruction
    tight = pipe1(
        tmp_path, compare=[], options={"max_evaluations": 60, "algorithm": "bees", "position_tolerance": 1e-6}
    )
    optimum = plan_pipe(load_pipe_problem(tight)).optimum
    assert max(optimum.colliding_after) > 0 and len(optimum.colliding_after) == 34


def test_gaps_of_one_grasp_are_where_neighbours_are_not_joined() -> None:
    problem = load_pipe_problem("pipe1")
    grasp = plan_pipe(problem).grasp
    assert grasp is not None
    task = problem.object_path_problem()
    options = problem.all_path_options
    whole = follow_object_path(task, grasp, **options)
    assert whole.outcome == mg.Outcome.solved and list(whole.gaps) == []
    steps = np.abs(np.diff(whole.path, axis=0)).max(axis=1)
    narrow = follow_object_path(task, grasp, **(options | {"max_joint_step": float(np.sort(steps)[-3]) * 0.999}))
    if narrow.outcome != mg.Outcome.solved:
        assert len(narrow.gaps) == len(steps) and narrow.violation == max(1, np.count_nonzero(narrow.gaps))
        assert set(narrow.gaps) <= {0, 1, 2}
