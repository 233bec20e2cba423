"""P1 figures 4.3 to 4.6 and 4.13: the time-optimal motion that takes an object while the base drives on."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._files import shipped
from .drawing import figure
from .entry import Context, Entry, Result
from .nearest_state import COMMON, OWN, solved_both_ways

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# P1 4.2. The convention of G's angles is not printed: roll, pitch, yaw, as 3.2.1 has it.
START = [0.0] * 10
GOAL = [10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5]
GRASPS = {"G2 (y = -2)": (5.5, -2.0, 0.5), "G1 (y = 2)": (5.5, 2.0, 0.5)}
ANGLES = (1.0, 1.0, 0.0)
WAYPOINTS = 35
LIFT = 0.2  # [m]; P1's robot has no lift among its joints, and prints no height
# P1 prints no limits: the base's are chosen but for the wheels', which are the robot's, accelerations of joints are four times their speeds.
BASE_LIMITS = {
    "linear_velocity": 0.6,
    "angular_velocity": 1.0,
    "linear_acceleration": 0.5,
    "angular_acceleration": 1.0,
    "wheel_velocity": 17.4 * 0.06,  # of its wheel joints [rad/s], radius [m]
    "wheel_separation": 0.37476,
}
BASE_SPEEDS = (0.4, 0.6, 0.8, 1.0, 1.2)  # of the base [m/s], beside the paper's unknown limit
SMALL = 10  # waypoints of figure 4.13 by the dense solver
PAPER_SECONDS, PAPER_STEPS = 20.13, (0.589, 0.595)


@functools.cache
def whole_body(base: str = "diff_drive", base_speed: float | None = None) -> tuple[_core.Robot, _core.JointGroup]:
    """The shipped Fetch-like robot: base and seven joints, the lift held; `base_speed` in place of the page's own, wheels as fast."""
    limits = dict(BASE_LIMITS)
    if base_speed is not None:
        limits.update(linear_velocity=base_speed, wheel_velocity=max(base_speed, limits["wheel_velocity"]))
    robot = _core.Robot.load(
        shipped("asset:robots/fetchlike/fetchlike.urdf"),
        srdf=shipped("asset:robots/fetchlike/fetchlike.srdf"),
        base=base,
        base_limits=limits,
    )
    group = robot.group("arm", tip="gripper_link", with_base=True)
    return robot, group.with_reference({"torso_lift_joint": LIFT})


def setup() -> dict[str, Any]:
    robot, group = whole_body()
    return {
        "robot": "fetchlike, diff-drive base and seven joints",
        "lift held at [m]": LIFT,
        "angles of G": "roll, pitch, yaw of gripper_link",
        "start": START,
        "goal": GOAL,
        **{f"base {key.replace('_', ' ')}": value for key, value in robot.base_limits.items() if key in BASE_LIMITS},
        "joint speeds [rad/s]": [float(v) for v in group.velocity_limits[3:]],
        "joint accelerations [rad/s^2]": [float(a) for a in group.acceleration_limits[3:]],
    }


def plan(
    place: tuple[float, float, float], waypoints: int = WAYPOINTS, base_speed: float | None = None, **options: Any
) -> _core.DriveByResult:
    robot, group = whole_body(base_speed=base_speed)
    task = _core.DriveByTask(_core.pose(place, ANGLES))
    return _core.plan_drive_by(
        robot, group, _core.World(), start=START, tasks=[task], goal=GOAL, waypoints=waypoints, **options
    )


def measure(waypoints: int, solver: str, time_limit: float) -> dict[str, Any]:
    """One point of figure 4.5."""
    found = plan(
        GRASPS["G2 (y = -2)"], waypoints, solver=solver, collisions=False, seeds=1, time_limit=time_limit,
        max_iterations=1000,
    )  # fmt: skip
    return {
        "outcome": found.outcome.name,
        "seconds": found.seconds,
        "iterations": found.iterations,
        "duration": found.duration,
    }


# --- figures 4.3 and 4.4 ----------------------------------------------------------------------------------------------
def run_trajectory(context: Context) -> Result:
    found = plan(GRASPS["G2 (y = -2)"], seed=context.seed)
    result = Result(setup=setup())
    values = result.row({"waypoints": WAYPOINTS})
    solved = found.outcome == _core.Outcome.solved
    trajectory = found.trajectory
    steps = np.diff(trajectory.times)
    values["outcome"] = (None, found.outcome.name)
    values["duration [s]"] = (PAPER_SECONDS, found.duration)
    values["first time step [s]"] = (PAPER_STEPS[0], steps[0])
    values["second time step [s]"] = (PAPER_STEPS[1], steps[-1])
    values["joints"] = (10, len(trajectory.names))
    values["calculation time [s]"] = (None, found.seconds)
    values["base speed at the grasp [m/s]"] = (None, found.events[0]["base_speed"])
    values["tool speed at the grasp [m/s]"] = (None, found.events[0]["tool_speed"])
    for kind, violation in found.violations.items():
        values[f"{kind} violation"] = (None, violation["value"])
    result.exact("solved, and every constraint is kept on a roll-out ten times finer", solved)
    result.exact(
        "dynamics within 1e-8, nonholonomic constraint within 1e-6 on the roll-out",
        found.violations["dynamics"]["value"] <= 1e-8 and found.violations["nonholonomic"]["value"] <= 1e-6,
    )
    durations = []
    for speed in BASE_SPEEDS:
        other = plan(GRASPS["G2 (y = -2)"], base_speed=speed, seed=context.seed)
        values = result.row({"base speed [m/s]": speed})
        values["outcome"] = (None, other.outcome.name)
        values["duration [s]"] = (PAPER_SECONDS, other.duration)
        durations.append(other.duration if other.outcome == _core.Outcome.solved else np.nan)
    result.exact("solved at every speed of the base, faster with each", bool((np.diff(durations) < 0).all()))
    result.trend(
        f"the paper's {PAPER_SECONDS} s lie between what a base of {BASE_SPEEDS[0]} and one of {BASE_SPEEDS[-1]} m/s takes",
        durations[-1] < PAPER_SECONDS < durations[0],
    )
    result.trend("the base does not stop for the grasp", found.events[0]["base_speed"] > 0.1)
    result.notes.append(
        "The paper's limits on speed and acceleration are not printed; ours stand in the set-up. How long the motion takes is decided by the "
        "base's speed: the rows show from 0.4 to 1.2 m/s, and which of them the paper's robot had is not known. (4.1) is summed over all m + 1 segments: 17 x 0.589 + 17 x 0.595 = 20.13."
    )
    fine = trajectory.sampled(4)
    result.drawing = {
        "names": trajectory.names,
        "times": _numbers(fine.times),
        "positions": [_numbers(column) for column in fine.positions.T],
        "grasp": found.events[0]["time"],
    }
    return result


def draw_trajectory(result: dict[str, Any]) -> Figure:
    fig, axes = figure(11.0, 4.6, columns=5, rows=2)
    drawing = result["drawing"]
    for axis, name, line in zip(axes, drawing["names"], drawing["positions"], strict=True):
        axis.plot(drawing["times"], line, color="#1f6fb4")
        axis.axvline(drawing["grasp"], color="#b8405e", linewidth=1)
        axis.set(title=name.replace("_joint", ""), xlabel="t [s]")
    return fig


def sideways_speeds(trajectory: _core.WholeBodyTrajectory) -> np.ndarray:
    """How fast the base would have to slip across its heading between waypoints (k - 1,) [m/s].

    From positions: every interval is rolled out by itself from the speed and turning rate at its ends, in 2000 straight steps, and
    what is missing to the next waypoint is taken along the wheels' axle.
    """
    q, drive, times = trajectory.positions, trajectory.drive, trajectory.times
    h = np.diff(times)
    s = (np.arange(2000) + 0.5) / 2000
    speed = drive[:-1, :1] + s * np.diff(drive[:, :1], axis=0)
    turned = h[:, None] * (drive[:-1, 1:2] * (s - s**2 / 2) + drive[1:, 1:2] * s**2 / 2)
    heading = q[:-1, 2:3] + turned
    way = h[:, None] * np.stack([(speed * np.cos(heading)).mean(1), (speed * np.sin(heading)).mean(1)], axis=1)
    missing = q[1:, :2] - q[:-1, :2] - way
    across = -np.sin(q[1:, 2]) * missing[:, 0] + np.cos(q[1:, 2]) * missing[:, 1]
    return np.asarray(np.abs(across) / h)


def run_nonholonomic(context: Context) -> Result:
    found = plan(GRASPS["G2 (y = -2)"], seed=context.seed)
    sideways = sideways_speeds(found.trajectory)
    apart = found.trajectory.rolled_out(200) - found.trajectory.positions
    result = Result(setup=setup())
    values = result.row({"waypoints": WAYPOINTS})
    values["largest violation [m/s]"] = (1e-5, float(sideways.max()))
    values["drift of the roll-out, whole way [m]"] = (None, float(np.linalg.norm(apart[:, :2], axis=1).max()))
    values["drift of the roll-out, whole way [rad]"] = (None, float(np.abs(apart[:, 2]).max()))
    result.exact("within 1e-6 m/s between all waypoints", float(sideways.max()) <= 1e-6)
    result.exact(
        "a unicycle that follows the wheel speeds alone stays within 1 mm and 1 mrad over the whole way",
        float(np.abs(apart[:, :3]).max()) <= 1e-3,
    )
    result.notes.append(
        "The base is described by its speed and turning rate. What is shown is how fast it would have to slip sideways to get from waypoint "
        "to waypoint, from positions rolled out in small steps; the paper constrains x' sin(phi) - y' cos(phi) at the waypoints, to its "
        "solver's tolerance."
    )
    result.drawing = {"times": _numbers(found.trajectory.times[1:]), "violation": [float(v) for v in sideways]}
    return result


def draw_nonholonomic(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.2)
    drawing = result["drawing"]
    axis.semilogy(drawing["times"], np.maximum(drawing["violation"], 1e-18), "o-", color="#1f6fb4", label="ours")
    axis.axhline(1e-5, color="#8a8f98", linestyle="--", label="paper: order of 1e-5")
    axis.set(xlabel="t [s]", ylabel="slip across the heading [m/s]")
    axis.legend(frameon=False)
    return fig


# --- figure 4.5 -------------------------------------------------------------------------------------------------------
def run_times(context: Context) -> Result:
    sizes = {"ipopt": [10, 20, 35] if context.quick else [10, 15, 20, 25, 35, 50, 100, 200, 300], "slsqp": [8]}
    if not context.quick:
        sizes["slsqp"] = [8, 10, 12, 15, 20, 25, WAYPOINTS]
    items = [
        {"waypoints": n, "solver": solver, "time_limit": 20.0 if context.quick else 3600.0}
        for solver, counts in sizes.items()
        for n in counts
    ]
    found = context.sweep(measure, items, "p1-figure-4.5")
    result = Result(setup=setup())
    for item, ours in zip(items, found, strict=True):
        values = result.row({"solver": item["solver"], "waypoints": item["waypoints"]})
        values["calculation time [s]"] = (None, ours["seconds"])
        values["iterations"] = (None, ours["iterations"])
        values["duration [s]"] = (None, ours["duration"])
        values["outcome"] = (None, ours["outcome"])
    for solver, name in (("ipopt", "Ipopt"), ("slsqp", "SLSQP")):
        outcomes = [o["outcome"] for i, o in zip(items, found, strict=True) if i["solver"] == solver]
        result.exact(f"{name} solves every size", all(outcome == "solved" for outcome in outcomes))
    fine = [ours["duration"] for n, ours in zip(sizes["ipopt"], found, strict=False) if n >= 50]  # Ipopt's come first
    if fine:
        result.trend("from 50 waypoints up durations agree within 2 %", max(fine) <= 1.02 * min(fine))
    result.notes.append(
        "The paper's figure has no numbers; its solver is NLopt's SLSQP on dense matrices. Ours is given exact first derivatives, sparse "
        "where the solver can use them, and Ipopt second ones too. No obstacles, no self-collisions."
    )
    return result


def draw_times(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.6)
    for solver, colour, marker in (("ipopt", "#1f6fb4", "o"), ("slsqp", "#8a8f98", "s")):
        rows = [r for r in result["rows"] if r["key"]["solver"] == solver]
        axis.loglog(
            [r["key"]["waypoints"] for r in rows],
            [r["values"]["calculation time [s]"]["ours"] for r in rows],
            color=colour, marker=marker, label={"ipopt": "Ipopt", "slsqp": "SLSQP (dense)"}[solver],
        )  # fmt: skip
    axis.set(xlabel="waypoints", ylabel="calculation time [s]")
    axis.legend(frameon=False)
    return fig


# --- figure 4.6 -------------------------------------------------------------------------------------------------------
def run_two_grasps(context: Context) -> Result:
    result = Result(setup=setup())
    _, group = whole_body()
    for name, place in GRASPS.items():
        found = plan(place, seed=context.seed)
        values = result.row({"grasp": name})
        values["outcome"] = (None, found.outcome.name)
        values["duration [s]"] = (None, found.duration)
        values["base speed at the grasp [m/s]"] = (None, found.events[0]["base_speed"])
        event = found.trajectory.positions[found.events[0]["waypoint"]]
        error = float(np.linalg.norm(group.fk(event)[:3, 3] - place))
        values["distance of the tool from the grasp [m]"] = (None, error)
        result.exact(
            f"{name}: solved, the tool passes through the grasp", found.outcome.name == "solved" and error < 1e-5
        )
        fine = found.trajectory.sampled(4).positions
        result.drawing[name] = {
            "base": [_numbers(fine[:, i]) for i in (0, 1)],
            "tool": [_numbers(line) for line in group.fk_batch(fine)[:, :3, 3].T],
            "grasp": list(place),
        }
    return result


def draw_two_grasps(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 3.4, columns=2)
    for axis, (name, lines) in zip(axes, result["drawing"].items(), strict=True):
        axis.plot(*lines["base"], color="#8a8f98", label="base")
        axis.plot(*lines["tool"][:2], color="#1f6fb4", label="tool")
        axis.plot(*lines["grasp"][:2], "x", color="#b8405e", label="grasp")
        axis.set(xlabel="x [m]", ylabel="y [m]", title=name, aspect="equal")
        axis.legend(frameon=False, fontsize=8)
    return fig


# --- figure 4.13 ------------------------------------------------------------------------------------------------------
def solve_common(count: int, seed: int, knows_the_task: bool, solver: str) -> dict[str, Any]:
    """Random tasks on the way, each by both formulations."""
    rng = np.random.default_rng(seed)
    waypoints = WAYPOINTS if solver == "ipopt" else SMALL
    _, group = whole_body()
    found: list[dict[str, Any]] = []
    while len(found) < count:
        side = float(rng.choice([-1, 1]))
        place = (float(rng.uniform(3, 7)), side * float(rng.uniform(1, 2.5)), float(rng.uniform(0.4, 0.8)))
        T_target = _core.pose(place, ANGLES)
        tasks = [_core.DriveByTask(T_target)]
        program = _core.drive_by_program(group, start=START, tasks=tasks, goal=GOAL, waypoints=waypoints)
        if program is not None:
            found.append(solved_both_ways(program, group, T_target, solver, knows_the_task, iterations=300))
    return {"found": found}


def run_discontinuity(context: Context) -> Result:
    """Random tasks solved by both formulations, from the same guesses, by the same solver with exact derivatives."""
    counts = {"ipopt": 4 if context.quick else 100, "slsqp": 1 if context.quick else 20}
    items = [
        {"count": counts[solver], "seed": context.seed, "knows_the_task": knows, "solver": solver}
        for solver in counts
        for knows in (True, False)
    ]
    runs = [run["found"] for run in context.sweep(solve_common, items, "p1-figure-4.13")]
    result = Result(setup=setup())
    result.setup["waypoints by Ipopt, by SLSQP"] = [WAYPOINTS, SMALL]
    share = {COMMON: 0, OWN: 0}
    iterations: dict[str, list[int]] = {COMMON: [], OWN: []}
    changed = []
    for item, found in zip(items, runs, strict=True):
        for name in (COMMON, OWN):
            ours = [both[name] for both in found]
            solved = [o for o in ours if o["solved"]]
            values = result.row(
                {
                    "solver": item["solver"],
                    "guess": "through the task" if item["knows_the_task"] else "straight to the goal",
                    "formulation": name,
                }
            )
            values["solved"] = (None, f"{len(solved)} of {len(ours)}")
            values["iterations, median"] = (None, float(np.median([o["iterations"] for o in ours])))
            values["iterations, most"] = (None, max(o["iterations"] for o in ours))
            values["duration, median [s]"] = (
                None,
                float(np.median([o["duration"] for o in solved])) if solved else None,
            )
            jumps = [int(np.count_nonzero(np.diff(o["intervals"]))) for o in ours]
            values["solves in which the interval changes"] = (
                None,
                sum(j > 0 for j in jumps) if name == COMMON else None,
            )
            share[name] += len(solved)
            iterations[name] += [o["iterations"] for o in ours]
            changed += [(j, o["intervals"]) for j, o in zip(jumps, ours, strict=True) if name == COMMON]
    most = max(changed, key=lambda c: c[0])
    result.exact("a waypoint of its own: every task is solved", share[OWN] == sum(counts.values()) * 2)
    result.trend("common: the task changes from interval to interval within a solve", most[0] > 0)
    result.trend(
        "common: fewer tasks are solved, or half as many iterations more are needed",
        share[COMMON] < share[OWN] or float(np.mean(iterations[COMMON])) > 1.5 * float(np.mean(iterations[OWN])),
    )
    result.notes.append(
        "P1 says of the common formulation, where the task is kept by the nearest state between two waypoints, that jumps between intervals may lead to "
        "slow convergence or none; it solves none. Here both are solved with exact first and second derivatives, the nearest state's with its place in the interval held. The figure "
        "shows the solve with most changes."
    )
    result.drawing = {"intervals": most[1]}
    return result


def draw_discontinuity(result: dict[str, Any]) -> Figure:
    from matplotlib.ticker import MaxNLocator

    fig, (axis,) = figure(6.0, 3.2)
    intervals = result["drawing"]["intervals"]
    axis.step(range(len(intervals)), intervals, where="mid", color="#1f6fb4")
    axis.yaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set(xlabel="iteration", ylabel="interval that the task is in")
    return fig


def _numbers(values: Any) -> list[float]:
    return [round(float(v), 5) for v in values]


ENTRIES = [
    Entry("p1-figure-4.3", "The time-optimal motion of all ten joints", run_trajectory, draw_trajectory),
    Entry("p1-figure-4.4", "How well the nonholonomic constraint is kept", run_nonholonomic, draw_nonholonomic),
    Entry("p1-figure-4.5", "Calculation time against the number of waypoints", run_times, draw_times),
    Entry("p1-figure-4.6", "Two grasps: ways of tool and base", run_two_grasps, draw_two_grasps),
    Entry("p1-figure-4.13", "The jump of the common formulation", run_discontinuity, draw_discontinuity),
]
