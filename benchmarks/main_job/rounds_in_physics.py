"""The storeroom's round in passing, carried out in physics at full speed: is every part still in the hand where it is let go?

    python benchmarks/main_job/rounds_in_physics.py [--rounds 100] [--workers 2] [--step 0.002] [--write]

Every motion of `mmgrasp plan --drive-by` is run by itself from its planned start, among obstacles and the parts of its tray that are still in
place. Where the base drives, its wheels have noise (1 mm after 1 m) and its localisation, too (1 mm, 1 mrad); where it stands, it stands off
by draws of the latter. A round is all motions, each with a seed of its own. A smaller --step [s] shows less of MuJoCo's creep (docs/methods/sim.md). Held: at the end the part touches both finger links and nothing else. --write puts the table into benchmarks/README.md.
"""

from __future__ import annotations

import argparse
import functools
import multiprocessing
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp import sim
from mmgrasp.part_supply import DriveByPlan, plan_drive_by_picks, plan_part_supply

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from tables import ROOT, markdown, show

SCENARIO = ROOT / "python/mmgrasp/assets/scenarios/storeroom.yaml"
MASS = 0.1  # of a part [kg]
TRAVEL_NOISE = 0.001  # [m] after 1 m
POSITION_NOISE = 0.001  # [m]
HEADING_NOISE = 0.001  # [rad]
PUSHED = 0.005  # a part that is not meant and moves farther was pushed [m]


@dataclass
class Trial:
    """What became of one motion in one round."""

    pick: int
    held: bool
    touched: str
    """Bodies that the part touches at the end."""
    slip: float
    """How far the part is from where the hand should have it [m]."""
    hand_off: float
    """How far the hand is from where it should be as the fingers begin to close [m]."""
    pushed: float
    """The farthest that another part was moved [m]."""
    base_error: float
    """[m]"""
    arm_error: float
    """[rad or m]"""


@functools.cache
def passing() -> DriveByPlan:
    """The planned round; made once in each process, the same in all."""
    return plan_drive_by_picks(plan_part_supply(mg.load_scenario(SCENARIO)))


def parts_in_place(pick: int) -> list[sim.SimPart]:
    """Those of the pick's tray that no pick before took."""
    made = passing()
    tray = made.plan.picks[pick].tray
    taken = {p.part for p in made.plan.picks[:pick] if p.tray == tray}
    return [
        sim.SimPart(part.name, part.shapes, part.T_world_part, mass=MASS)
        for i, part in enumerate(made.problem.trays[tray].parts)
        if i not in taken
    ]


@functools.lru_cache(maxsize=1)
def scene(pick: int, step: float) -> sim.Simulation:
    """Robot, obstacles and parts as that motion begins."""
    made = passing()
    setup = made.plan.scenario.setup
    return sim.Simulation(
        setup.robot,
        made.problem.world,
        parts_in_place(pick),
        gripper=setup.gripper,
        joints=setup.other_joints,
        physics=sim.Physics(time_step=step),
    )


def tool_pose(base: np.ndarray, arm: np.ndarray) -> np.ndarray:
    """T_world_tool of a base pose and the arm's joints."""
    return np.asarray(mg.pose([base[0], base[1], 0], rpy=[0, 0, base[2]]) @ passing().problem.arm.fk(arm))


def run(task: tuple[int, int, float]) -> Trial:
    """One motion in one round."""
    pick, a_round, step = task
    made = passing()
    done = made.picks[pick]
    motion = done.result.trajectory.sampled(between=9)
    seed = 1000 * a_round + pick
    off = np.random.default_rng(seed).normal(size=3) * (POSITION_NOISE, POSITION_NOISE, HEADING_NOISE)
    result = scene(pick, step).run(
        motion,
        base=done.base + off,
        close_at=done.close_at,
        opening=done.opening,
        hold=0.5,
        travel_noise=TRAVEL_NOISE,
        position_noise=POSITION_NOISE,
        heading_noise=HEADING_NOISE,
        seed=seed,
    )
    at_end = {
        e.b if e.a == done.part else e.a
        for e in result.contacts
        if done.part in (e.a, e.b) and e.end > result.duration - 0.05
    }
    planned = made.plan.picks[pick]
    grasp = made.problem.trays[planned.tray].parts[planned.part].grasps[planned.grasp]
    arm = motion.positions[-1][3:] if done.drives else motion.positions[-1]
    meant = (tool_pose(done.base, arm) @ np.linalg.inv(grasp.T_object_hand))[:3, 3]
    state = min(result.states, key=lambda s: abs(s["time"] - done.close_at))
    wanted = np.asarray(motion.at(state["time"]))
    planned_tool = tool_pose(wanted[:3], wanted[3:]) if done.drives else tool_pose(np.asarray(done.base), wanted)
    real = tool_pose(np.asarray(state["base"]), np.array([state["joints"][name] for name in made.problem.arm.names]))
    found = result.states[-1]["parts"][done.part][:3, 3]
    others = [p.displacement for name, p in result.parts.items() if name != done.part]
    return Trial(
        pick,
        at_end == set(made.plan.scenario.setup.gripper.finger_links),
        ", ".join(sorted(at_end)) or "nothing",
        float(np.linalg.norm(meant - found)),
        float(np.linalg.norm((real - planned_tool)[:3, 3])),
        max(others, default=0.0),
        result.base_error,
        result.arm_error,
    )


def table(trials: list[Trial], rounds: int) -> str:
    """Markdown: a row a motion, and what became of all rounds."""
    rows = []
    for pick in sorted({t.pick for t in trials}):
        of = [t for t in trials if t.pick == pick]
        done = passing().picks[pick]
        rows.append(
            [
                done.part,
                f"{done.result.duration:.1f}",
                "drives" if done.drives else "stands",
                f"{sum(t.held for t in of)} of {len(of)}",
                f"{1e3 * np.median([t.slip for t in of]):.0f}",
                f"{1e3 * max(t.slip for t in of):.0f}",
                f"{1e3 * np.median([t.hand_off for t in of]):.0f}",
                f"{sum(t.pushed > PUSHED for t in of)}",
                f"{1e3 * max(t.pushed for t in of):.0f}",
                f"{1e3 * max(t.base_error for t in of):.0f}",
                f"{1e3 * max(t.arm_error for t in of):.0f}",
            ]
        )
    whole = sum(all(t.held for t in trials[r * len(rows) : (r + 1) * len(rows)]) for r in range(rounds))
    head = ["part", "motion [s]", "base", "held at the end", "slip, median [mm]", "at most [mm]", "hand off as it closes, median [mm]", "others pushed by 5 mm",
            "farthest [mm]", "base off, at most [mm]", "joint off, at most [mrad, mm]"]  # fmt: skip
    lost = sorted({f"{passing().picks[t.pick].part}: touches {t.touched}" for t in trials if not t.held})
    text = f"{rounds} rounds: {sum(t.held for t in trials)} of {len(trials)} parts held to the end, all of them in {whole} rounds."
    return text + ("" if not lost else " " + "; ".join(lost) + ".") + "\n\n" + markdown(head, rows)


def main() -> None:
    """Runs, prints and stores."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=100, help="how many (default 100)")
    parser.add_argument("--workers", type=int, default=2, help="processes (default 2)")
    parser.add_argument("--step", type=float, default=0.002, help="of physics [s] (default 0.002)")
    parser.add_argument("--write", action="store_true", help="update benchmarks/README.md")
    given = parser.parse_args()
    used = [p.pick for p in passing().picks if p.used]
    # Motion by motion, so that a process builds few scenes.
    tasks = [(pick, r, given.step) for pick in used for r in range(given.rounds)]
    found: dict[tuple[int, int], Trial] = {}
    with multiprocessing.get_context("spawn").Pool(given.workers) as pool:
        for task, trial in zip(tasks, pool.imap(run, tasks, chunksize=max(1, given.rounds // 4)), strict=True):
            found[task[:2]] = trial
            if not trial.held:
                print(f"round {task[1]}, {passing().picks[trial.pick].part}: touches {trial.touched}", flush=True)
            if task[1] == given.rounds - 1:
                print(f"{passing().picks[task[0]].part}: done", flush=True)
    show(
        "rounds in physics",
        table([found[pick, r] for r in range(given.rounds) for pick in used], given.rounds),
        given.write,
    )


if __name__ == "__main__":
    main()
