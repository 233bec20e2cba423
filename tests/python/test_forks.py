"""Processes forked beside threads of the library: they compute what their parent would, and end by themselves."""

from __future__ import annotations

import subprocess
import sys

import pytest

# What a child does: databases in two threads, a cover, a motion, a stochastic solver; a few numbers to compare.
WORK = """
import multiprocessing, os, random, signal, sys, threading, time, warnings
import numpy as np
import mmgrasp as mg
from pathlib import Path
warnings.simplefilter("ignore")  # of Python 3.12: forks beside threads may hang, which is what is tried here
folder = Path(mg.__file__).parent / "assets" / "robots" / "kr6like"
ROBOT = mg.Robot.load(folder / "kr6like.urdf", folder / "kr6like.srdf")
ARM = ROBOT.group("arm", tip="gripper_tcp")
draw = random.Random(1)
HARD = [[i % 300] + [draw.randrange(300) for _ in range(11)] for i in range(900)]

def work(seed=1):
    database = mg.ReachDatabase.build(ARM, samples=20_000, seed=seed, threads=2)
    cover = mg.optim.solve_set_cover(4, [[0, 1], [2, 3], [0, 2]], time_limit=60)
    middle = (ARM.lower + ARM.upper) / 2
    path = mg.plan_motion(ROBOT, ARM, mg.World(), start=middle, goal=middle + 0.1, seed=seed)
    low = mg.optim.minimize_derivative_free(lambda x: float(np.sum(x**2)), [0.5, 0.5], [-1, -1], [1, 1], solver="crs2", seed=seed, max_evaluations=200)
    return repr(database), sorted(cover.chosen), path.outcome.name, low.x.tolist()

def forked():
    signal.alarm(120)
    answer = work()
    sys.stdout.write("as the parent\\n" if answer == EXPECTED else repr(answer))
"""

BESIDE_A_CALL = """
EXPECTED = work()
threading.Thread(target=mg.optim.solve_set_cover, args=(300, HARD), kwargs={"time_limit": 1000}, daemon=True).start()
threading.Thread(target=mg.ReachDatabase.build, args=(ARM,), kwargs={"samples": 2_000_000_000, "threads": 2}, daemon=True).start()
time.sleep(0.5)
for _ in range(3):
    child = os.fork()
    if child == 0:
        forked()
        sys.stdout.flush()
        begun = time.monotonic()
        import atexit
        atexit._run_exitfuncs()  # as an end by itself would: it must not wait for the parent's threads
        os._exit(7 if time.monotonic() - begun > 2.5 else 0)
    print("ended with", os.waitpid(child, 0)[1], flush=True)
os._exit(0)
"""

IN_A_POOL = """
EXPECTED = work()
with multiprocessing.get_context("fork").Pool(2) as pool:
    answers = pool.map(work, [1, 1, 1, 1])
print(all(answer == EXPECTED for answer in answers))
"""

BY_ITSELF = """
threading.Thread(target=mg.ReachDatabase.build, args=(ARM,), kwargs={"samples": 2_000_000_000}, daemon=True).start()
time.sleep(0.3)
child = os.fork()
if child == 0:
    signal.alarm(60)
    sys.exit(5)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


def run(code: str) -> tuple[int, str, str]:
    done = subprocess.run([sys.executable, "-c", WORK + code], capture_output=True, text=True, timeout=500)
    return done.returncode, done.stdout, done.stderr


@pytest.mark.slow
def test_a_fork_beside_long_calls_works_and_ends() -> None:
    assert run(BESIDE_A_CALL) == (0, "as the parent\nended with 0\n" * 3, "")


@pytest.mark.slow
def test_a_pool_of_forks_after_threads_were_used() -> None:
    assert run(IN_A_POOL) == (0, "True\n", "")


def test_a_fork_beside_a_daemon_thread_ends_with_its_own_code() -> None:
    assert run(BY_ITSELF) == (0, "5\n", "")
