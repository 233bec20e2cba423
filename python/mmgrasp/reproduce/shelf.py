"""P3 3.9.3, tables 3.1 and 3.2: reaching into a shelf with the arm alone, and with base and arm together.

P3 prints neither the shelf's measures nor the configurations; ours are stated here. The base stands so near that the
shoulder has half a metre to the boards: within reach, and hardly room to bring the elbow round. Goals are drawn with a
seed by a rule that asks no planner. Start and goals are the same for both tables: with the base, a goal is the same arm
configuration at the same base pose.
"""

from __future__ import annotations

import functools
import time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .._core import CollisionChecker, JointGroup, Outcome, Robot, World, plan_motion, pose
from .._files import shipped
from .drawing import figure
from .entry import Context, Entry, Result
from .pipe_runs import by_seed, seeds_of
from .statements import Pair

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRONT, DEPTH, WIDTH, THICK = 0.48, 0.40, 0.90, 0.02  # of the shelf, from the middle of the base [m]
BOARDS = (0.52, 0.84, 1.16, 1.48)  # heights of the boards' middles [m]
START = (0.0, -0.18, -2.8, -1.57, -1.57, 0.0)  # tucked
# Goals 1 to 4: distance of the arm from everything else [m], from and below.
CLEARANCES = ((0.02, np.inf), (0.01, 0.02), (0.005, 0.01), (0.0, 0.005))
SOON = 0.1  # beside the time limit, which hardly tells the planners apart today [s]
TILT = 0.5  # of the tool against the way into the shelf, at most, about either axis [rad]


class Planner(NamedTuple):
    """As it is: what of it is the library's, and what is ours."""

    name: str
    """Name that plan_motion takes."""
    paper: str
    """The planner of P3 that it stands for."""
    near_end_probability: float = 0.2


PLANNERS = {
    "RRT-Connect, ours: nine draws in ten around start and goal": Planner("rrt_connect", "RRT-Connect"),
    "RRTConnect, OMPL": Planner("ompl_rrt_connect", "RRT-Connect"),
    "PRM*, OMPL: one draw in five around an end": Planner("prm_star", "PRM*"),
    "PRM*, OMPL: its own draws": Planner("prm_star", "PRM*", near_end_probability=0.0),
    "EST, OMPL": Planner("est", "EST"),
}
OURS, STOCK_CONNECT, PRM, STOCK_PRM, EST = PLANNERS
# Success of the queries for goals 1 to 4 [%].
ARM_ONLY = {"RRT-Connect": (40, 100, 40, 10), "PRM*": (10, 60, 0, 10), "EST": (10, 40, 0, 0)}
ARM_AND_BASE = {"RRT-Connect": (100, 100, 90, 80), "PRM*": (100, 100, 90, 60), "EST": (60, 100, 60, 50)}


@functools.cache
def robot() -> Robot:
    return Robot.load(shipped("asset:robots/omni6/omni6.urdf"), shipped("asset:robots/omni6/omni6.srdf"), base="omni")


def boxes() -> dict[str, tuple[list[float], list[float]]]:
    """Size and middle of each board and wall [m]."""
    middle, height = FRONT + DEPTH / 2, BOARDS[-1] - BOARDS[0] + THICK
    z = (BOARDS[0] + BOARDS[-1]) / 2
    found = {f"board {i + 1}": ([DEPTH, WIDTH, THICK], [middle, 0.0, at]) for i, at in enumerate(BOARDS)}
    for name, y in (("right side", -WIDTH / 2), ("middle wall", 0.0), ("left side", WIDTH / 2)):
        found[name] = ([DEPTH, THICK, height], [middle, y, z])
    found["back"] = ([THICK, WIDTH + THICK, height], [FRONT + DEPTH + THICK / 2, 0.0, z])
    return found


def world() -> World:
    out = World()
    for name, (size, at) in boxes().items():
        out.add_box(name, size, pose(at))
    out.add_box("floor", [8, 8, 0.02], pose([0, 0, -0.02]))
    return out


def group(with_base: bool) -> JointGroup:
    return robot().group("arm", tip="gripper_tcp", with_base=with_base)


def configuration(arm: tuple[float, ...], with_base: bool) -> np.ndarray:
    return np.array([0.0, 0, 0, *arm]) if with_base else np.array(arm)


@functools.cache
def goals(seed: int) -> tuple[tuple[float, ...], ...]:
    """Four arm configurations that hold the tool in the shelf, one of each clearance.

    Tool poses are drawn evenly in the shelf, within TILT of pointing into it and turned anyhow; of the collision-free arm
    configurations that reach one, any is taken. Those are left out to which the straight joint line from the start is
    free. Whether there is a path is not asked.
    """
    rng, arm, room = np.random.default_rng([seed, 39]), group(False), world()
    checker = CollisionChecker(robot(), room, arm)
    found: dict[int, tuple[float, ...]] = {}
    while len(found) < len(CLEARANCES):
        at = rng.uniform([FRONT, -WIDTH / 2, BOARDS[0]], [FRONT + DEPTH, WIDTH / 2, BOARDS[-1]])
        tilt, turn = rng.uniform(-TILT, TILT, 2), rng.uniform(-np.pi, np.pi)
        reached = arm.ik_all(pose(at, rpy=[0, *tilt]) @ pose([0, 0, 0], rpy=[turn, 0, 0]), 8, world=room)
        if len(reached) == 0:
            continue
        q = reached[rng.integers(len(reached))]
        clearance = checker.distance(q).value
        band = next(i for i, (least, below) in enumerate(CLEARANCES) if least <= max(clearance, 0.0) < below)
        if band not in found and not checker.edge_is_free(START, q):
            found[band] = tuple(q)
    return tuple(found[i] for i in range(len(CLEARANCES)))


class _Enough(Exception):  # noqa: N818 - it is no error
    """Ends a call with its first path."""


def query(with_base: bool, seed: int, goal: int, planner: str, run: int, seconds: float) -> dict[str, Any]:
    """One query, until its first path; goals count from 0."""
    begun = time.perf_counter()
    chosen = PLANNERS[planner]

    def first(*_: Any) -> None:
        raise _Enough

    try:
        found = plan_motion(
            robot(),
            group(with_base),
            world(),
            start=configuration(START, with_base),
            goal=configuration(goals(seed)[goal], with_base),
            planner=chosen.name,
            time_limit=seconds,
            max_iterations=10_000_000,
            seed=run + 1,
            shorten=False,
            on_solution=first,
            near_end_probability=chosen.near_end_probability,
        )
        solved = found.outcome == Outcome.solved
    except _Enough:
        solved = True
    spent = time.perf_counter() - begun
    return {"solved": solved, "seconds": spent, "planner": planner, "goal": goal, "seed": seed}


def _run(context: Context, with_base: bool) -> Result:
    runs, seconds = (1, 0.5) if context.quick else (3, 1.0)
    paper = ARM_AND_BASE if with_base else ARM_ONLY
    items = [
        {"with_base": with_base, "seed": seed, "goal": goal, "planner": name, "run": run, "seconds": seconds}
        for name in PLANNERS
        for seed in seeds_of(context)
        for goal in range(len(CLEARANCES))
        for run in range(runs)
    ]
    name = "p3-table-3.2" if with_base else "p3-table-3.1"
    done = context.sweep(query, items, name)
    result = Result()
    rates = {}
    for planner, (_, theirs, _) in PLANNERS.items():
        values = result.row({"planner": planner})
        mine = [d for d in done if d["planner"] == planner]
        for g in range(len(CLEARANCES)):
            solved = [d["solved"] for d in mine if d["goal"] == g]
            values[f"goal {g + 1} [%]"] = (paper[theirs][g], 100 * float(np.mean(solved)))
        rates[planner] = 100 * float(np.mean([d["solved"] for d in mine]))
        values["average [%]"] = (sum(paper[theirs]) / len(CLEARANCES), rates[planner])
        values["of each seed [%]"] = (None, by_seed(mine, [100.0 * d["solved"] for d in mine]))
        values[f"solved within {SOON:g} s [%]"] = (None, 100 * float(np.mean([_soon(d) for d in mine])))
        times = [d["seconds"] for d in mine if d["solved"]]
        values["median time when solved [s]"] = (None, float(np.median(times)) if times else None)
    checker = CollisionChecker(robot(), world(), group(False))
    result.exact(
        "start and goals are free configurations of the arm at the start's base pose",
        all(checker.is_free(q) for seed in seeds_of(context) for q in (START, *goals(seed))),
    )
    for more, less in ((OURS, PRM), (STOCK_CONNECT, STOCK_PRM), (STOCK_PRM, EST)):
        result.statement(
            f"queries solved within {SOON:g} s [%], {more} less {less}", _pairs(done, more, less), clock=True
        )
    if with_base:
        result.trend("base and arm: every query of RRT-Connect is solved in time", rates[OURS] == 100, clock=True)
    result.setup = {
        "robot": "omni6 (six joints on an omnidirectional base; P3: seven)",
        "shelf [m]": f"front {FRONT} before the middle of the base, {DEPTH} deep, {WIDTH} wide, boards at {BOARDS}",
        "goals": "drawn, no planner asked: tool anywhere in the shelf, any free arm configuration, its straight joint line from"
        " the start blocked; goals 1 to 4 of a seed have clearances of at least 20 mm, 10 to 20, 5 to 10 and below 5 mm",
        "seeds of the goals": ", ".join(map(str, seeds_of(context))),
        "queries a goal": runs,
        "time limit [s]": seconds,
        "goal": "one arm configuration each, the base where it started",
    }
    result.notes.append(
        "P3's table 3.2 prints 70 % for EST and 83 % over all; its own rows give 67.5 % and 82.5 %. Its goals are not known: ours have"
        " an order of their own. A query ends with its first path."
    )
    result.notes.append(
        "The planners as they are: `plan_motion` tries the straight edge before any of them and looks at every path again at an eighth"
        " of the steps. OMPL's have our collision checker; PRM*, which goes on after its first path, checks at a 64th of the steps (an eighth for planners that keep improving)"
        " from the start."
    )
    result.drawing = {"with_base": with_base, "rates": rates}
    return result


def _soon(done: dict[str, Any]) -> bool:
    return bool(done["solved"] and done["seconds"] <= SOON)


def _pairs(done: list[dict[str, Any]], more: str, less: str) -> list[Pair]:
    """Runs of the one planner and of the other for the same goal, in their order."""
    of = {name: [d for d in done if d["planner"] == name] for name in (more, less)}
    return [
        Pair(a["seed"], a["goal"], 100.0 * _soon(a), 100.0 * _soon(b)) for a, b in zip(of[more], of[less], strict=True)
    ]


def _draw(stored: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(8.0, 3.6)
    rows = stored["rows"]
    y = np.arange(len(rows))[::-1]
    for side, shift, colour in (("paper", 0.18, "#8a8f98"), ("ours", -0.18, "#1f6fb4")):
        axis.barh(y + shift, [row["values"]["average [%]"][side] for row in rows], 0.34, color=colour, label=side)
    axis.set_yticks(y, [row["key"]["planner"].replace(": ", ":\n") for row in rows])
    axis.set(xlabel="queries solved [%]", xlim=(0, 105), title=stored["title"])
    axis.legend(frameon=False, loc="lower right")
    return fig


ENTRIES = (
    Entry("p3-table-3.1", "Reaching into a shelf: the arm alone", lambda c: _run(c, False), _draw),
    Entry("p3-table-3.2", "Reaching into a shelf: base and arm together", lambda c: _run(c, True), _draw),
)
