"""P1 figures 4.3 to 4.6 and 4.13: the time-optimal motion that takes an object while the base drives on."""

from __future__ import annotations

import functools
import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from .._files import shipped
from .drawing import figure
from .entry import Context, Entry, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# P1 4.2. The convention of G's angles is not printed: roll, pitch, yaw, as 3.2.1 has it.
START = [0.0] * 10
GOAL = [10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5]
GRASPS = {"G2 (y = -2)": (5.5, -2.0, 0.5), "G1 (y = 2)": (5.5, 2.0, 0.5)}
ANGLES = (1.0, 1.0, 0.0)
WAYPOINTS = 35
LIFT = 0.2  # [m]; P1's robot has no lift among its joints, and prints no height
# P1 prints no limits: the base's are chosen (its wheels could turn at 1.04 m/s), accelerations of joints are four times their speeds.
BASE_LIMITS = {
    "linear_velocity": 0.6,
    "angular_velocity": 1.0,
    "linear_acceleration": 0.5,
    "angular_acceleration": 1.0,
    "wheel_velocity": 0.8,
    "wheel_separation": 0.37476,
}
BASE_SPEEDS = (0.4, 0.6, 0.8, 1.0, 1.2)  # of the base [m/s], beside the paper's unknown limit
OVERSHOOT = 1.2  # [m], of figure 4.13's iterate
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
        sizes["slsqp"] = [8, 10, 12, 15, 20]
    items = [
        {"waypoints": n, "solver": solver, "time_limit": 20.0 if context.quick else 300.0}
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
def run_discontinuity(context: Context) -> Result:
    """Slides a trajectory along and looks at how the task constraint weighs the waypoints, in both formulations."""
    found = plan(GRASPS["G2 (y = -2)"], 12, seed=context.seed, collisions=False)
    _, group = whole_body()
    target = np.array(GRASPS["G2 (y = -2)"])
    q = np.array(found.trajectory.positions)
    own = found.events[0]["waypoint"]
    q[own, 1] -= OVERSHOOT  # an iterate that passes the grasp twice, on its way out and on its way back
    shares = np.linspace(0, 1, 21)

    def weights(shift: float) -> np.ndarray:
        """d constraint / d position of each waypoint, as the nearest state on the way has it."""
        moved = q + shift * np.eye(q.shape[1])[0]
        states = [(1 - s) * moved[i] + s * moved[i + 1] for i in range(len(q) - 1) for s in shares]
        distances = np.linalg.norm(group.fk_batch(np.array(states))[:, :3, 3] - target, axis=1)
        i, k = divmod(int(distances.argmin()), len(shares))
        row = np.zeros(len(q))
        row[i], row[i + 1] = 1 - shares[k], shares[k]
        return row

    shifts = np.linspace(-1.2, 1.2, 41 if context.quick else 241)
    rows = [weights(t) for t in shifts]
    steps = [float(np.abs(b - a).max()) for a, b in itertools.pairwise(rows)]
    intervals = [int(np.flatnonzero(row)[0]) for row in rows]
    jumps = sum(a != b for a, b in itertools.pairwise(intervals))
    result = Result(setup=setup())
    for name, count, largest in (("common: the nearest state", jumps, max(steps)), ("a waypoint of its own", 0, 0.0)):
        values = result.row({"formulation": name})
        values["changes of interval"] = (None, count)
        values["largest jump of a waypoint's weight"] = (None, largest)
    result.trend(
        "the common formulation jumps: a waypoint gains or loses half of its weight at once", max(steps) >= 0.5
    )
    result.notes.append(
        f"An iterate whose waypoint of the grasp is {OVERSHOOT} m too far out slides by {shifts[0]:g} to {shifts[-1]:g} m in {len(shifts)} steps. With a waypoint of its own the task weighs that "
        "one with 1 and all others with 0, wherever the way is: by construction, not by measurement."
    )
    result.drawing = {"shifts": _numbers(shifts), "intervals": intervals, "waypoint": own}
    return result


def draw_discontinuity(result: dict[str, Any]) -> Figure:
    from matplotlib.ticker import MaxNLocator

    fig, (axis,) = figure(6.0, 3.2)
    drawing = result["drawing"]
    axis.step(drawing["shifts"], drawing["intervals"], color="#8a8f98", label="common: nearest interval")
    axis.axhline(drawing["waypoint"], color="#1f6fb4", label="a waypoint of its own")
    axis.yaxis.set_major_locator(MaxNLocator(integer=True))
    axis.set(xlabel="shift of the whole way [m]", ylabel="waypoint the task depends on")
    axis.legend(frameon=False)
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
