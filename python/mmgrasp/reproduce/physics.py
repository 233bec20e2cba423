"""P1 4.3 and figure 4.10 in physics: a box taken from a table in passing, push-grasp against plain closing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import Outcome
from .drawing import OUR_STYLE, PAPER_STYLE, figure
from .entry import Context, Entry, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARES = (0.2, 0.5, 1.0)
ERRORS = (0.0, 0.005, 0.010, 0.015, 0.020, 0.025, 0.030)
DIRECTIONS = 8
PICTURES = 8


def trial(share: float, push: bool, error: float, direction: float, seed: int) -> dict[str, Any]:
    """One run; the box stands `error` off the plan, in the direction given from the approach."""
    from ..sim.passing import Passing

    along, aside = error * np.cos(direction), error * np.sin(direction)
    passing = Passing(share, push, float(along), float(aside), seed=seed)
    run = passing.run(frame_period=10.0)
    (part,) = run.parts.values()
    return {
        "grasped": run.grasped,
        "promised": passing.promised(),
        "cause": part.cause,
        "displacement": part.displacement,
        "base": run.base_error,
    }


def trials(quick: bool, seed: int) -> list[dict[str, Any]]:
    """What is run: every error in directions spread evenly, turned by the seed."""
    errors = (0.0, 0.02) if quick else ERRORS
    directions = 4 if quick else DIRECTIONS
    rng = np.random.default_rng(seed)
    out = []
    for share in (1.0,) if quick else SHARES:
        for error in errors:
            turn = rng.uniform(0, 2 * np.pi / directions)
            for k in range(directions if error > 0 else 1):
                direction = float(turn + 2 * np.pi * k / directions)
                for push in (False, True):
                    out.append({"share": share, "push": push, "error": error, "direction": direction, "seed": seed + k})
    return out


def frames_of_one_run(seed: int, count: int) -> dict[str, Any]:
    """States of a push-grasp by one planned motion of base and arm, as plain values."""
    from ..sim.bottle import Bottle

    bottle = Bottle()
    found, close_at = bottle.plan()
    if found.outcome != Outcome.solved:
        return {"states": [], "grasped": False, "outcome": found.outcome.name}
    run = bottle.run(found, close_at, frame_period=0.02, seed=seed)
    clock = np.array([s["time"] for s in run.states])
    times = close_at + np.array([-1.2, -0.4, -0.1, 0.1, 0.25, 0.5, 1.0, 2.0])[:count]
    chosen = [run.states[int(np.abs(clock - t).argmin())] for t in times]
    states = [
        {
            "time": round(s["time"], 3),
            "base": [round(v, 5) for v in s["base"]],
            "joints": {n: round(v, 5) for n, v in s["joints"].items()},
            "bottle": [[round(float(v), 5) for v in row] for row in s["parts"]["bottle"]],
        }
        for s in chosen
    ]
    part = run.parts["bottle"]
    return {
        "states": states,
        "grasped": run.grasped,
        "displacement": part.displacement,
        "duration": found.duration,
        "base speed": found.events[-1]["base_speed"],
        "tool speed": found.events[-1]["tool_speed"],
    }


def run(context: Context) -> Result:
    from ..sim import Physics
    from ..sim.passing import FULL_SPEED, SIZE
    from ..sim.scene import mujoco_module

    mujoco = mujoco_module()
    items = trials(context.quick, context.seed)
    found = context.sweep(trial, items, "p1-figure-4.10")
    shown = frames_of_one_run(context.seed, PICTURES)
    physics = Physics()
    result = Result(
        setup={
            "full speed of base and hand [m/s]": FULL_SPEED,
            "closing speed [m/s]": 0.1,
            "box [m, kg]": [*SIZE, 0.2],
            "friction fingers, table": [physics.finger_friction, physics.scene_friction],
            "MuJoCo": mujoco.__version__,
            "trials": len(items),
        }
    )
    curves: dict[str, list[list[float]]] = {}
    for share in sorted({i["share"] for i in items}):
        for error in sorted({i["error"] for i in items}):
            values = result.row({"speed": share, "position error [mm]": round(1000 * error, 1)})
            for push, name in ((False, "plain closing"), (True, "push-grasp")):
                here = [
                    f for i, f in zip(items, found, strict=True)
                    if (i["share"], i["error"], i["push"]) == (share, error, push)
                ]  # fmt: skip
                grasped = float(np.mean([f["grasped"] for f in here]))
                values[f"{name}: grasped"] = (None, grasped)
                values[f"{name}: promised"] = (None, float(np.mean([f["promised"] for f in here])))
                values[f"{name}: pushed [m]"] = (None, float(np.mean([f["displacement"] for f in here])))
                curves.setdefault(f"{share:g} {name}", []).append([1000 * error, grasped])
    both = [(f["grasped"], f["promised"], i["push"]) for i, f in zip(items, found, strict=True)]
    result.trend(
        "without error every grasp holds",
        all(f["grasped"] for i, f in zip(items, found, strict=True) if i["error"] == 0),
    )
    result.trend(
        "push-grasp holds at least as often as plain closing at every speed",
        all(
            sum(g for i, (g, _, p) in zip(items, both, strict=True) if p and i["share"] == share)
            >= sum(g for i, (g, _, p) in zip(items, both, strict=True) if not p and i["share"] == share)
            for share in {i["share"] for i in items}
        ),
    )
    fast = [(g, p) for i, (g, _, p) in zip(items, both, strict=True) if i["share"] == 1.0]
    result.trend(
        "at full speed push-grasp holds more often", sum(g for g, p in fast if p) > sum(g for g, p in fast if not p)
    )
    result.trend(
        "what the closed form promises for the push-grasp, physics holds",
        all(g for g, promised, p in both if p and promised),
    )
    for name, unit in (("duration", "s"), ("base speed", "m/s"), ("tool speed", "m/s"), ("displacement", "m")):
        result.setup[f"frames: {name} [{unit}]"] = shown.get(name)
    result.trend("the motion of the frames was planned, and holds the bottle in physics", shown["grasped"])
    result.notes.append(
        "Frames: a push-grasp by one motion of base and arm from `plan_drive_by`; the base drives 4 m past the table at 0.5 m/s, the hand "
        "meets the bottle at 0.3 m/s, pushes it while the fingers close, and takes it along. Curves: plans made by hand, so that speed, "
        "error and moment of closing alone change. 'Promised' is the closed form of `push_grasp`: fingers pass without touching the box, "
        "which both can survive when a finger shoves the box aside instead."
    )
    result.drawing = {"curves": curves, "states": shown["states"]}
    return result


def draw(result: dict[str, Any]) -> Figure:
    """Figure 4.10 from the recorded states, and the success curves below."""
    from ..sim.bottle import Bottle
    from ..sim.control import RecordedState
    from ..sim.passing import robot_setup
    from ..sim.pictures import Painter
    from ..viz.raster import Camera

    bottle, setup = Bottle(), robot_setup()
    painter = Painter(setup.robot, setup.gripper, bottle.world(), [bottle.part()])
    states = result["drawing"]["states"]
    columns = len(states) // 2
    curves = result["drawing"]["curves"]
    shares = list(dict.fromkeys(name.split()[0] for name in curves))
    wide = columns * len(shares)
    fig, (whole,) = figure(10.5, 7.4)
    whole.remove()
    grid = fig.add_gridspec(3, wide)
    for i, state in enumerate(states):
        row, column = divmod(i, columns)
        axis = fig.add_subplot(grid[row, column * len(shares) : (column + 1) * len(shares)])
        camera = Camera(np.array([2.2, -2.9, 1.7]), np.array([2.0, -0.4, 0.65]), 340, 270, fov=46)
        recorded: RecordedState = {
            "time": state["time"],
            "base": state["base"],
            "joints": state["joints"],
            "parts": {"bottle": np.array(state["bottle"])},
        }
        axis.imshow(painter.picture(recorded, camera))
        axis.set_title(f"({i + 1}) {state['time']:.2f} s", fontsize=9)
        axis.axis("off")
    for k, share in enumerate(shares):
        axis = fig.add_subplot(grid[2, k * columns : (k + 1) * columns])
        axis.grid(True, color="#e4e6ea", linewidth=0.8)
        for name, style in (("plain closing", PAPER_STYLE), ("push-grasp", OUR_STYLE)):
            line = np.array(curves[f"{share} {name}"])
            axis.plot(
                line[:, 0],
                100 * line[:, 1],
                color=style["color"],
                marker=style["marker"],
                linestyle=style["linestyle"],
                label=name,
            )
        axis.set(xlabel="position error [mm]", ylabel="grasped [%]", ylim=(-5, 105), title=f"speed x {share}")
        axis.legend(frameon=False, fontsize=8)
    return fig


# --- figure 4.12 ------------------------------------------------------------------------------------------------------
def carried_out(x: float, y: float, push: bool, shares: list[float], seed: int) -> dict[str, Any]:
    """A bottle at a place: one plan, carried out at shares of its speed."""
    from ..sim.bottle import Bottle

    bottle = Bottle(x, y, push)
    found, close_at = bottle.plan()
    out: dict[str, Any] = {"solved": found.outcome == Outcome.solved, "seconds": found.seconds}
    if out["solved"]:
        runs = [bottle.run(found, close_at, speed=share, seed=seed, frame_period=10.0) for share in shares]
        out |= {
            "duration": found.duration,
            "base speed": found.events[-1]["base_speed"],
            "tool speed": found.events[-1]["tool_speed"],
            "grasped": [r.grasped for r in runs],
            "base error": [r.base_error for r in runs],
        }
    return out


def run_speeds(context: Context) -> Result:
    from ..sim.bottle import PLANNED_SPEED, WAY
    from ..sim.scene import mujoco_module

    mujoco = mujoco_module()
    rng = np.random.default_rng(context.seed)
    count = 2 if context.quick else 12
    shares = [1.0] if context.quick else [0.2, 0.5, 1.0]
    places = [(float(rng.uniform(1.6, 2.4)), float(rng.uniform(-0.85, -0.75))) for _ in range(count)]
    items = [
        {"x": x, "y": y, "push": push, "shares": shares, "seed": context.seed + i}
        for push in (True, False)
        for i, (x, y) in enumerate(places)
    ]
    found = context.sweep(carried_out, items, "p1-figure-4.12")
    alone = WAY / PLANNED_SPEED + PLANNED_SPEED / 0.5
    result = Result(
        setup={"places": count, "way [m]": WAY, "planned base speed [m/s]": PLANNED_SPEED, "MuJoCo": mujoco.__version__}
    )
    for push, name in ((True, "push-grasp"), (False, "hand still, base driving on")):
        solved = [f for i, f in zip(items, found, strict=True) if i["push"] == push and f["solved"]]
        for k, share in enumerate(shares):
            values = result.row({"strategy": name, "speed": share})
            values["planned"] = (None, f"{len(solved)} of {count}")
            values["grasped"] = (None, f"{sum(f['grasped'][k] for f in solved)} of {len(solved)}")
            for column, key in (
                ("duration [s]", "duration"),
                ("base speed at the grasp [m/s]", "base speed"),
                ("tool speed [m/s]", "tool speed"),
            ):
                scale = 1 / share if key == "duration" else share
                values[column] = (None, float(np.mean([f[key] for f in solved])) * scale if solved else None)
            values["drive alone [s]"] = (None, alone / share)
            values["base off its way [m]"] = (None, max((f["base error"][k] for f in solved), default=None))
        kept = [g for f in solved for g in f["grasped"]]
        result.trend(f"{name}: a motion is planned for at least nine places in ten", len(solved) >= 0.9 * count)
        result.trend(f"{name}: at least nine executions in ten hold the bottle", sum(kept) >= 0.9 * len(kept) > 0)
    result.trend(
        "the base drives at more than 0.1 m/s at every grasp, at full speed",
        all(f["base speed"] > 0.1 for f in found if f["solved"]),
    )
    result.notes.append(
        "The paper shows three trajectories at 1/5 of the planned speed on the robot, open loop. Here random places on the table, tracked, "
        "with noise of wheels and localisation, at 1/5, 1/2 and full speed; the bottle must be held to the end of the motion and 2 s more."
    )
    return result


ENTRIES = [
    Entry("p1-figure-4.10", "A bottle taken in passing, in physics; push-grasp against plain closing", run, draw),
    Entry("p1-figure-4.12", "Whole-body motions carried out at 1/5, 1/2 and full speed", run_speeds),
]
