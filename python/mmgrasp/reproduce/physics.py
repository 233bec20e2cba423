"""P1 4.3 and figure 4.10 in physics: a box taken from a table in passing, push-grasp against plain closing."""

from __future__ import annotations

from typing import Any

import numpy as np

from .drawing import OUR_STYLE, PAPER_STYLE, figure
from .entry import Context, Entry, Result

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
    errors = (0.0, 0.015, 0.030) if quick else ERRORS
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
    """States of one push-grasp at full speed, as plain values, from before the contact to the end of the hold."""
    from ..sim.passing import Passing

    passing = Passing(1.0, True, 0.005, 0.008, seed=seed)
    _, close_at = passing.plan()
    run = passing.run(frame_period=0.02)
    early = np.linspace(close_at - 0.5, close_at + 1.0, count - 2)
    clock = np.array([s["time"] for s in run.states])
    chosen = [run.states[int(np.abs(clock - t).argmin())] for t in [*early, run.duration - 2.0, run.duration]]
    states = [
        {
            "time": round(s["time"], 3),
            "base": [round(v, 5) for v in s["base"]],
            "joints": {n: round(v, 5) for n, v in s["joints"].items()},
            "box": [[round(float(v), 5) for v in row] for row in s["parts"]["box"]],
        }
        for s in chosen
    ]
    return {"states": states, "grasped": run.grasped, "displacement": run.parts["box"].displacement}


def run(context: Context) -> Result:
    from ..sim import Physics
    from ..sim.passing import FULL_SPEED, SIZE
    from ..sim.simulation import mujoco_module

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
    curves: dict[str, list] = {}
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
    result.trend(
        "figure 4.10: the run shown pushes the box while closing and holds it",
        shown["grasped"] and shown["displacement"] > 0.02,
    )
    result.notes.append(
        "Frames of one push-grasp at full speed: the hand meets the box, pushes it along the table while the fingers close, lifts and "
        "holds it. 'Promised' is the closed form of `push_grasp`: fingers pass without touching the box, which plain closing can survive "
        "when a finger shoves the box aside instead. The plan is made by hand, so that speed, error and moment of closing alone change."
    )  # fmt: skip
    result.drawing = {"curves": curves, "states": shown["states"]}
    return result


def draw(result: dict[str, Any]):
    """Figure 4.10 from the recorded states, and the success curves below."""
    from ..sim.passing import Passing, robot_setup
    from ..sim.pictures import Camera, Painter

    passing, setup = Passing(), robot_setup()
    painter = Painter(setup.robot, setup.gripper, passing.scene(), [passing.part()])
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
        x = state["base"][0]
        camera = Camera(np.array([x + 1.9, -2.1, 1.35]), np.array([x + 0.4, -0.65, 0.72]), 340, 270)
        axis.imshow(painter.picture({**state, "parts": {"box": np.array(state["box"])}}, camera))
        axis.set_title(f"({i + 1}) {state['time']:.2f} s", fontsize=9)
        axis.axis("off")
    for k, share in enumerate(shares):
        axis = fig.add_subplot(grid[2, k * columns : (k + 1) * columns])
        axis.grid(True, color="#e4e6ea", linewidth=0.8)
        for name, style in (("plain closing", PAPER_STYLE), ("push-grasp", OUR_STYLE)):
            line = np.array(curves[f"{share} {name}"])
            axis.plot(line[:, 0], 100 * line[:, 1], **{**style, "label": name})
        axis.set(xlabel="position error [mm]", ylabel="grasped [%]", ylim=(-5, 105), title=f"speed x {share}")
        axis.legend(frameon=False, fontsize=8)
    return fig


ENTRIES = [Entry("p1-figure-4.10", "A box taken in passing, in physics; push-grasp against plain closing", run, draw)]
