"""One base pose for many tool poses: mmgrasp (collisions checked) beside scikit-robot (they are not).

    python benchmarks/task/bench_base_placement.py [--peer PYTHON] [--targets 20 100]

Both get the shipped Fetch-like robot (scikit-robot reads the same URDF), the arm's seven joints, and the same targets:
tool poses over a table, hands pointing down or forward with some turn. The peer runs in PYTHON's process, with its
inverse reachability map built beforehand, as ours has its database. One JSON line per case and program.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROBOT = Path(__file__).parents[2] / "python" / "mmgrasp" / "assets" / "robots" / "fetchlike"

PEER = r"""
import json, sys, time
import numpy as np
from skrobot.coordinates import Coordinates
from skrobot.kinematics import find_base_placement
import skrobot.kinematics.inverse_reachability_map as maps
from skrobot.models.urdf import RobotModelFromURDF

task = json.load(open(sys.argv[1]))
robot = RobotModelFromURDF(urdf_file=task["urdf"])
tip = getattr(robot, task["tip"])
links = [joint.child_link for joint in robot.joint_list if joint.name in task["joints"]]
targets = [Coordinates(pos=np.array(T)[:3, 3], rot=np.array(T)[:3, :3]) for T in task["targets"]]
bases = [Coordinates(pos=[x, y, 0]).rotate(yaw, "z") for x, y, yaw in task["starts"]]
best = None
for _ in range(task["rounds"]):
    start = time.perf_counter()
    result = find_base_placement(
        robot, targets, move_target=tip, link_list=links, initial_base_poses=bases, thre=1e-3, rthre=np.deg2rad(1.0))
    seconds = time.perf_counter() - start
    best = seconds if best is None else min(best, seconds)
print(json.dumps({"reached": int(np.sum(result.success)), "seconds": best}))
"""


def make_targets(mg, count: int) -> np.ndarray:
    rng = np.random.default_rng(11)
    targets = []
    for _ in range(count):
        xyz = [rng.uniform(1.2, 2.0), rng.uniform(-0.6, 0.6), rng.uniform(0.75, 1.1)]
        targets.append(mg.pose(xyz, rpy=[rng.uniform(-0.5, 0.5), rng.uniform(0.0, 1.6), rng.uniform(-1.2, 1.2)]))
    return np.array(targets)


def line(case: str, who: str, value: float, **more) -> None:
    row = {"row": "base placement", "on": case, "who": who, "value": value, "unit": "s", **more}
    print(json.dumps(row), flush=True)


def main() -> None:
    import mmgrasp as mg

    parser = argparse.ArgumentParser()
    parser.add_argument("--peer", help="python with scikit-robot")
    parser.add_argument("--targets", type=int, nargs="+", default=[20, 100])
    parser.add_argument("--samples", type=int, default=2_000_000)
    parser.add_argument("--rounds", type=int, default=3)
    options = parser.parse_args()

    robot = mg.Robot.load(ROBOT / "fetchlike.urdf", ROBOT / "fetchlike.srdf")
    arm = robot.group("arm", tip="gripper_tcp")
    database = mg.ReachDatabase.build(arm, samples=options.samples)
    world = mg.World()
    world.add_box("table", size=(0.8, 1.4, 0.04), pose=mg.pose([1.6, 0, 0.66]))
    checker = mg.CollisionChecker(robot, world, arm)
    for count in options.targets:
        targets = make_targets(mg, count)
        times = []
        for _ in range(options.rounds):
            start = time.perf_counter()
            found = database.find_base_placement(arm, targets, checker=checker)
            times.append(time.perf_counter() - start)
        free = database.find_base_placement(arm, targets)
        line(f"{count} targets", "mmgrasp", min(times), reached=found.reached, reached_without_table=free.reached)
        if not options.peer:
            continue
        angles = np.linspace(-np.pi, np.pi, 4, endpoint=False)
        starts = [[1.6 + 0.9 * np.cos(a), 0.9 * np.sin(a), a + np.pi] for a in angles]
        starts += [[1.6 - 0.6, y, 0.0] for y in (-0.5, -0.25, 0, 0.25, 0.5)] + [[0.7, 0.0, 0.0]]
        task = {
            "urdf": str(ROBOT / "fetchlike.urdf"),
            "tip": "gripper_tcp",
            "joints": arm.names,
            "targets": targets.tolist(),
            "starts": starts,
            "rounds": options.rounds,
        }
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "task.json").write_text(json.dumps(task))
            (Path(folder) / "peer.py").write_text(PEER)
            command = [options.peer, str(Path(folder) / "peer.py"), str(Path(folder) / "task.json")]
            run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            print(run.stderr, file=sys.stderr)
            raise SystemExit("the peer failed")
        answer = json.loads(run.stdout.splitlines()[-1])
        line(
            f"{count} targets",
            "scikit-robot",
            answer["seconds"],
            reached=answer["reached"],
            ratio=answer["seconds"] / min(times),
        )


if __name__ == "__main__":
    main()
