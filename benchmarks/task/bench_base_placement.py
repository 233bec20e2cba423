"""One base pose for many tool poses: mmgrasp (collisions checked) beside scikit-robot (they are not).

    python benchmarks/task/bench_base_placement.py [--baseline PYTHON] [--targets 20 100]

Both get the shipped Fetch-like robot (scikit-robot reads the same URDF), the arm's seven joints, and the same targets:
tool poses over a table, hands pointing down or forward with some turn. scikit-robot runs in PYTHON's process, as its
documentation recommends: with its inverse reachability map of default size (built beforehand, as ours has its database),
once from a working posture and once from four, and without the map from starts around the table. Its tolerances are its
defaults, 1 mm and 1 degree; ours are 0.01 mm and 0.0001 rad. Every answer, the baseline's too, is judged here: forward
kinematics within the baseline's tolerances and limits, then collisions with robot and table. One JSON line per case and
program.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

import mmgrasp as mg

HERE = Path(__file__).resolve().parent
ROBOT = HERE.parents[1] / "python/mmgrasp/assets/robots/fetchlike"
POSITION, ROTATION = 1e-3, np.deg2rad(1.0)  # what counts as reached: the baseline's defaults


def make_targets(count: int) -> np.ndarray:
    """Tool poses over the table."""
    rng = np.random.default_rng(11)
    targets = []
    for _ in range(count):
        xyz = [rng.uniform(1.2, 2.0), rng.uniform(-0.6, 0.6), rng.uniform(0.75, 1.1)]
        targets.append(mg.pose(xyz, rpy=[rng.uniform(-0.5, 0.5), rng.uniform(0.0, 1.6), rng.uniform(-1.2, 1.2)]))
    return np.array(targets)


def postures(database: mg.ReachDatabase, arm: mg.robot.JointGroup) -> list[list[float]]:
    """Working postures to start from: the hand forward, low, high and tilted down."""
    hands = [([0.85, 0, 0.9], 0.0), ([0.75, 0, 0.65], 0.5), ([0.75, 0, 1.15], 0.0), ([0.8, 0, 0.8], 1.0)]
    return [database.solve(arm, mg.pose(xyz, rpy=[0, pitch, 0]))[0].tolist() for xyz, pitch in hands]


def judge(robot, world, arm, targets, base, configurations) -> dict:
    """How many configurations reach their targets, and how many of those are free."""
    standing = arm.at(mg.pose([base[0], base[1], 0], rpy=[0, 0, base[2]]))
    checker = mg.CollisionChecker(robot, world, standing)
    reached = free = 0
    for target, q in zip(targets, configurations, strict=True):
        if q is None or np.any(q < arm.lower - 1e-6) or np.any(q > arm.upper + 1e-6):
            continue
        T = standing.fk(q)
        cosine = np.clip((np.trace(T[:3, :3].T @ target[:3, :3]) - 1) / 2, -1, 1)
        if np.linalg.norm(T[:3, 3] - target[:3, 3]) <= POSITION and np.arccos(cosine) <= ROTATION:
            reached += 1
            free += bool(checker.is_free(q))
    return {"reached": reached, "free": free}


def line(count: int, who: str, value: float, settings: str, **more) -> None:
    """What run.py reads."""
    row = {"row": "base placement", "on": f"{count} targets", "who": who, "value": value, "unit": "s"}
    print(json.dumps({**row, **more, "settings": settings}), flush=True)


def baselines(options, arm, targets: dict[int, np.ndarray], start_postures: list) -> list[dict]:
    """The answers of scikit-robot."""
    angles = np.linspace(-np.pi, np.pi, 4, endpoint=False)
    starts = [[1.6 + 0.9 * np.cos(a), 0.9 * np.sin(a), a + np.pi] for a in angles]
    starts += [[1.0, y, 0.0] for y in (-0.5, -0.25, 0, 0.25, 0.5)] + [[0.7, 0.0, 0.0]]
    task = {
        "urdf": str(ROBOT / "fetchlike.urdf"),
        "tip": "gripper_tcp",
        "joints": arm.names,
        "counts": options.targets,
        "targets": {str(count): array.tolist() for count, array in targets.items()},
        "starts": starts,
        "postures": start_postures,
        "rounds": options.baseline_rounds,
        "position_tolerance": POSITION,
        "rotation_tolerance": ROTATION,
    }
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "task.json"
        path.write_text(json.dumps(task))
        run = subprocess.run(
            [options.baseline, HERE / "base_placement_baseline.py", path], check=True, stdout=subprocess.PIPE, text=True
        )
    return [json.loads(text) for text in run.stdout.splitlines() if text.startswith("{")]


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--baseline", help="python with scikit-robot")
    parser.add_argument("--targets", type=int, nargs="+", default=[20, 100])
    parser.add_argument("--samples", type=int, default=2_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--baseline-rounds", type=int, default=1)
    options = parser.parse_args()

    robot = mg.Robot.load(ROBOT / "fetchlike.urdf", ROBOT / "fetchlike.srdf")
    arm = robot.group("arm", tip="gripper_tcp")
    begin = time.perf_counter()
    database = mg.ReachDatabase.build(arm, samples=options.samples)
    built = time.perf_counter() - begin
    world = mg.World()
    world.add_box("table", size=(0.8, 1.4, 0.04), pose=mg.pose([1.6, 0, 0.66]))
    checker = mg.CollisionChecker(robot, world, arm)
    targets = {count: make_targets(count) for count in options.targets}
    for count, poses in targets.items():
        for who, ours in (("mmgrasp", {"checker": checker}), ("mmgrasp, collisions ignored", {})):
            times, processor = [], []
            for _ in range(options.rounds):
                begin, used = time.perf_counter(), time.process_time()
                found = database.find_base_placement(arm, poses, **ours)
                times.append(time.perf_counter() - begin)
                processor.append(time.process_time() - used)
            verdict = judge(robot, world, arm, poses, found.base_pose, found.configurations)
            more = {"processor_s": min(processor), "claimed": found.reached, **verdict, "build_s": built}
            line(count, who, min(times), f"{options.samples} samples; tolerances 1e-5 m, 1e-4 rad", **more)
    if options.baseline:
        for answer in baselines(options, arm, targets, postures(database, arm)):
            count = answer["count"]
            configurations = [
                np.array(q) if ok else None for q, ok in zip(answer["angles"], answer["reached"], strict=True)
            ]
            verdict = judge(robot, world, arm, targets[count], answer["base"], configurations)
            more = {"processor_s": answer["processor"], "claimed": sum(answer["reached"]), **verdict}
            settings = f"{answer['samples']} samples; tolerances 1e-3 m, 1 degree; collisions not checked"
            line(
                count, f"scikit-robot, {answer['set_up']}", answer["seconds"], settings, **more, build_s=answer["map_s"]
            )


if __name__ == "__main__":
    main()
