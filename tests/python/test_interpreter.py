"""Objects without their constructors, Ctrl-C while the package loads, threads when the interpreter ends, several solvers at once."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import threading
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import REPOSITORY
from mmgrasp import _core


def classes(module: ModuleType) -> list[type]:
    made = [c for c in vars(module).values() if isinstance(c, type) and not issubclass(c, Exception)]
    return [c for c in made if type(c).__name__ == "pybind11_type"]


@pytest.mark.parametrize("kind", [*classes(_core), *classes(_core.verify)], ids=lambda c: c.__name__)
def test_objects_are_made_by_their_constructors(kind: type) -> None:
    with pytest.raises(TypeError):
        kind.__new__(kind)  # type: ignore[call-overload]
    with pytest.raises(TypeError):
        object.__new__(kind)


def test_their_common_base_has_no_objects() -> None:
    """pybind11 throws a C++ exception there, through C: the process would end. Old pickles and hand-made classes come by."""
    base: Any = mg.World.__mro__[-2]
    odd: Any = type("Odd", (base,), {})
    for call in (base, odd, lambda: base.__new__(base), lambda: odd.__new__(odd), lambda: base(3)):
        with pytest.raises(TypeError, match="no objects of its own"):
            call()
    for protocol in (0, 1):
        with pytest.raises(TypeError):
            pickle.dumps(mg.World(), protocol)


def test_subclasses_and_copies_still_work() -> None:
    class Named(mg.World):
        pass

    world = Named()
    world.add_box("table", (1, 1, 1))
    assert world.copy().objects == ["table"]
    assert repr(mg.Box([1, 2, 3]))


WHILE_LOADING = """
import os, signal, sys
class Interrupting:
    def find_spec(name, path, target=None):
        if name == "mmgrasp":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Interrupting)
import mmgrasp_command
mmgrasp_command.main()
"""


@pytest.mark.skipif(signal.getsignal(signal.SIGINT) != signal.default_int_handler, reason="SIGINT is ignored here")
def test_ctrl_c_while_the_package_loads_ends_the_command_without_a_word() -> None:
    done = subprocess.run([sys.executable, "-c", WHILE_LOADING], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (-signal.SIGINT, "", "")


def test_pickles_come_back_to_the_last_bit() -> None:
    grid = pickle.loads(pickle.dumps(mg.base.BaseGrid([0.1, -2], 0.05, 3, 2, [0.0, 0.3])))
    assert (grid.origin.tolist(), grid.resolution, grid.nx, grid.ny, grid.headings) == ([0.1, -2], 0.05, 3, 2, [0, 0.3])
    cells = np.arange(12).reshape(2, 2, 3) % 2
    region = pickle.loads(pickle.dumps(mg.base.BaseRegion("A", cells, grid)))
    assert region.tray == "A"
    np.testing.assert_array_equal(region.cells(grid), cells)


AT_EXIT = """
import random, sys, tempfile, threading, time
from pathlib import Path
import mmgrasp as mg, numpy as np
sys.path.insert(0, {tests!r})
from argument_objects import ARM, OBJECTS, Q, occupancy_map
folder = Path(tempfile.mkdtemp())
def work():
    while True:
        {work}
for _ in range({threads}):
    threading.Thread(target=work, daemon=True).start()
time.sleep(0.5)
print("leaving")
"""

LONG_CALLS = {
    "set cover": "mg.optim.solve_set_cover(300, [[i % 300] + [(7 * i * k) % 300 for k in range(11)] for i in range(900)], time_limit=1000)",
    "rows": "ARM.fk_batch(np.tile(Q, (2000, 1)))",
    "occupancy file": "occupancy_map().save(folder / 'a.bt')",
    "roadmap file": "OBJECTS['Roadmap']().save(folder / 'a')",
}


@pytest.mark.parametrize("work", LONG_CALLS.values(), ids=LONG_CALLS)
def test_a_daemon_thread_inside_a_call_does_not_crash_the_end(work: str) -> None:
    ends_silently(work, 1)


def test_threads_that_wait_for_the_interpreter_while_it_ends_do_not_crash() -> None:
    """Three that come back from a short call at any moment: the last one in the queue is the one that was killed."""
    ends_silently("ARM.fk_batch(Q[None])", 3)


def ends_silently(work: str, threads: int) -> None:
    script = AT_EXIT.format(tests=str(REPOSITORY / "tests" / "python"), work=work, threads=threads)
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout, done.stderr) == (0, "leaving\n", "")


@pytest.mark.parametrize("solver", ["crs2", "isres", "esch"])
def test_stochastic_solvers_run_side_by_side_and_repeat(solver: str) -> None:
    def valley(x: np.ndarray) -> float:
        return float(np.sum((x - [0.3, -0.2]) ** 2) + 0.1 * np.sin(20 * x[0]))

    def solve() -> Any:
        return mg.optim.minimize_derivative_free(
            valley, [0, 0], [-1, -1], [1, 1], solver=solver, seed=7, max_evaluations=300
        )

    alone = solve()
    found: list[Any] = []
    threads = [threading.Thread(target=lambda: found.append(solve())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [r.evaluations for r in found] == [alone.evaluations] * 4
    for result in found:
        np.testing.assert_array_equal(result.x, alone.x)
