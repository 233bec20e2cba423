"""The number of threads changes no bit of a plan; the seed is the only source of chance."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from argument_objects import ARM, OBJECTS, Q, depth_camera, depth_frame, occupancy_map
from conftest import ASSETS


@pytest.mark.slow
def test_same_plan_at_one_and_two_threads(small_path: Path) -> None:
    plans = [mg.plan_part_supply(small_path, seed=1, threads=threads) for threads in (1, 2)]
    assert plans[0].outcome == mg.Outcome.solved
    assert json.dumps(plans[0].to_dict()) == json.dumps(plans[1].to_dict())


def test_same_database_at_one_and_two_threads(small_path: Path, tmp_path: Path) -> None:
    arm = mg.load_scenario(small_path).setup.arm
    files = []
    for threads in (1, 2):
        files.append(tmp_path / f"{threads}.reach")
        mg.ReachDatabase.build(arm, samples=50_000, seed=1, threads=threads).save(files[-1])
    first, second = ({f.name: f.read_bytes() for f in folder.iterdir()} for folder in files)
    assert len(first) == 6
    assert first == second


def test_lines_of_several_threads_share_one_checker() -> None:
    """Each call has scratch of its own, so that they may run side by side and next to questions to the checker."""
    checker = OBJECTS["CollisionChecker"]()
    lines = [ARM.fk(Q + [0, 0, along]) for along in (0.1, 0.2, 0.4, 0.6)]  # the last one beyond a limit

    def follow(to: np.ndarray) -> tuple[Any, ...]:
        found = mg.planning.plan_straight_line(checker, Q, to, position_step=1e-4)
        return found.outcome, found.fraction, None if found.path is None else found.path.tobytes()

    alone = [follow(to) for to in lines]
    assert len(set(alone)) == len(lines)
    together: list[list[Any]] = [[] for _ in lines]
    workers = [
        threading.Thread(target=lambda k=k: together[k].extend(follow(lines[k]) for _ in range(5)))
        for k in range(len(lines))
    ]
    for worker in workers:
        worker.start()
    while any(worker.is_alive() for worker in workers):
        assert checker.is_free(Q)
    for k, answers in enumerate(together):
        assert answers == [alone[k]] * 5


def test_threads_share_one_seed_database() -> None:
    folder = ASSETS / "robots" / "fetchlike"
    robot = mg.Robot.load(folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive")
    whole = robot.group("arm_with_torso", tip="gripper_tcp", with_base=True)
    checker = mg.CollisionChecker(robot, mg.World(), group=whole)
    database = mg.base.IkSeedDatabase(whole, capacity=50)
    down = [0, np.pi / 2, 0]
    failures: list[str] = []

    def plan(number: int) -> None:
        own = checker.clone()
        for i in range(3):
            pick = mg.pose([0.8 + 0.05 * i, -0.2, 0.9], rpy=down)
            place = mg.pose([0.8, 0.2 + 0.05 * number, 0.9], rpy=down)
            found = mg.base.plan_platform_locations(own, pick, place, database=database, samples=5, seed=number + 1)
            if found.outcome != mg.Outcome.solved:
                failures.append(f"{number}/{i}: {found.outcome}")
            elif max(np.abs(whole.fk(found.q_pick) - pick).max(), np.abs(whole.fk(found.q_place) - place).max()) > 2e-4:
                failures.append(f"{number}/{i}: off the poses")

    workers = [threading.Thread(target=plan, args=(number,)) for number in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert failures == []
    assert 24 <= len(database) <= 50  # two solutions a call at least
    for seed in database.seeds(mg.pose([0.8, 0, 0.9], rpy=down), 50):
        assert np.isfinite(seed).all()


def test_a_subinterpreter_is_refused_at_once() -> None:
    """The module would wait in it for ever; a process of its own, since interpreters share what fails in them."""
    code = "import _xxsubinterpreters as s; s.run_string(s.create(), 'import mmgrasp')"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    assert run.returncode == 1 and "cannot be imported in a subinterpreter" in run.stderr


def test_an_octree_takes_frames_and_questions_side_by_side() -> None:
    octree, image, camera = occupancy_map(), depth_frame(), depth_camera()
    points = np.random.default_rng(1).uniform(-1, 1, (2000, 3))
    before = octree.frames
    work = (
        lambda: octree.integrate(image, camera),
        lambda: octree.query(points),
        lambda: octree.obstacle_cells(),
        lambda: octree.bounds,
    )

    def often(call: Any) -> None:
        for _ in range(20):
            call()

    threads = [threading.Thread(target=often, args=(call,)) for call in (*work, work[0])]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert octree.frames == before + 40
