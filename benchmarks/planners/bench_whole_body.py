"""Planning for whole bodies: arm with lift, arm with base, two arms at once (14 joints), beside OMPL's RRT-Connect on our checker.

    python benchmarks/planners/bench_whole_body.py [--problems N] [--seeds N] [--data FOLDER] [--robot NAME]

Each problem is drawn by a rule that no planner decides: boxes at random places that do not touch the robot in the middle of its
limits, around an arm or over the floor of a room of 6 x 6 m for one with a base; then a start and a goal uniform within the limits,
each drawn again until it is free. What no run of any planner solves is tried once more by OMPL's RRT-Connect with ten times the
time and budget; what is still open is reported as not known to be feasible. Paths are looked at by FCL and KDL called directly.
One JSON line a robot and planner: processor time [ms].
"""

from __future__ import annotations

import argparse
import itertools
import json
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import mmgrasp as mg

PLANNERS = ("rrt_connect", "ompl_rrt_connect")
TIME_LIMIT, LONG, ITERATIONS = 5.0, 50.0, 2_000_000  # the time decides: 20,000 states are a tenth of a second
ARM_BOXES, ROOM_BOXES, ROOM = 24, 40, 3.0


def tiago(data: Path) -> tuple[mg.Robot, mg.robot.JointGroup]:
    """Torso lift and seven-joint arm: eight joints."""
    folder = data / "robots/tiago/example-robot-data/robots"
    robot = mg.Robot.load(
        folder / "tiago_description/robots/tiago_no_hand.urdf",
        base="diff_drive",
        package_dirs={"tiago_description": folder / "tiago_description"},
    )
    robot = mg.robot.compute_disabled_pairs(robot)  # it comes without an SRDF that fits
    return robot, robot.group(base_link="base_footprint", tip="wrist_ft_tool_link")


def tiago_base(data: Path) -> tuple[mg.Robot, mg.robot.JointGroup]:
    """The same with its diff-drive base: eleven columns."""
    robot, _ = tiago(data)
    return robot, robot.group(base_link="base_footprint", tip="wrist_ft_tool_link", with_base=True)


def two_pandas(data: Path) -> tuple[mg.Robot, mg.robot.JointGroup]:
    """Two Pandas side by side, 0.7 m apart, planned at once: fourteen joints."""
    folder = data / "robots/panda"
    urdf, srdf = (next(folder.rglob(f"*{end}")) for end in ("panda.urdf", "panda.srdf"))
    one = mg.Robot.load(urdf, srdf, package_dirs={p.name: p for p in folder.iterdir() if p.is_dir()})
    both = one.mount(one, one.links[0], mg.pose((0, 0.7, 0)), "left_")
    groups = '<group name="both"><group name="panda_arm"/><group name="left_panda_arm"/></group></robot>'
    both = mg.Robot.from_strings(both.to_urdf(), both.to_srdf().replace("</robot>", groups))
    return both, both.group("both", tip="left_panda_link8")


def ridgeback_ur10e(data: Path) -> tuple[mg.Robot, mg.robot.JointGroup]:
    """A UR10e on a Ridgeback, omni base and arm: nine columns."""
    base = mg.Robot.load(
        data / "robots/ridgeback/expanded/ridgeback.urdf",
        base="omni",
        package_dirs={"ridgeback_description": data / "robots/ridgeback/ridgeback_description"},
    )
    arm = mg.Robot.load(
        data / "robots/ur/expanded/ur10e.urdf", package_dirs={"ur_description": data / "robots/ur/ur_description"}
    )
    robot = base.mount(arm, "mid_mount", np.eye(4), "ur_")
    return robot, robot.group(base_link="base_link", tip="ur_tool0", with_base=True)


def iiwa(data: Path) -> tuple[mg.Robot, mg.robot.JointGroup]:
    """KUKA LBR iiwa 14: seven joints."""
    folder = data / "robots/kuka_iiwa"
    robot = mg.Robot.load(
        folder / "kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf",
        package_dirs={
            "kuka_lbr_iiwa_support": folder / "kuka_lbr_iiwa_support",
            "kuka_resources": folder / "kuka_resources",
        },
    )
    return robot, robot.group(base_link="base_link", tip="tool0")


ROBOTS: dict[str, Callable[[Path], tuple[mg.Robot, mg.robot.JointGroup]]] = {
    "TIAGo, lift and arm (8)": tiago,
    "TIAGo, base, lift and arm (11)": tiago_base,
    "two Pandas at once (14)": two_pandas,
    "Ridgeback + UR10e (9)": ridgeback_ur10e,
    "KUKA iiwa 14 (7)": iiwa,
}


class Problem:
    """A world, a start and a goal; the bodies once more for the independent check."""

    def __init__(self, robot: mg.Robot, group: mg.robot.JointGroup, seed: int) -> None:
        draw = np.random.default_rng(seed)
        self.robot, self.group = robot, group
        lower, upper = group.sample_lower.copy(), group.sample_upper.copy()
        if group.has_base:
            lower[:2], upper[:2] = -ROOM, ROOM
        self.world = mg.World()
        self.bodies: list[tuple[str, list[mg.LinkShape], np.ndarray]] = []
        while len(self.bodies) < (ROOM_BOXES if group.has_base else ARM_BOXES):
            size = draw.uniform(0.08, 0.5, 3)
            if group.has_base:
                x, y = draw.uniform(-ROOM, ROOM, 2)
            else:
                radius, angle = draw.uniform(0.25, 1.2), draw.uniform(-np.pi, np.pi)
                x, y = radius * np.cos(angle), radius * np.sin(angle)
            T = mg.pose((x, y, draw.uniform(0.1, 1.5)), rpy=(0, 0, draw.uniform(-np.pi, np.pi)))
            alone = mg.World()
            alone.add_box("box", size, T)
            contacts = mg.CollisionChecker(robot, alone, group).contacts(0.5 * (lower + upper))
            if any("box" in (contact.a, contact.b) for contact in contacts):
                continue
            name = f"box {len(self.bodies)}"
            self.world.add_box(name, size, T)
            self.bodies.append((name, [mg.LinkShape(mg.Box(size))], T))
        self.checker = mg.CollisionChecker(robot, self.world, group)
        self.start, self.goal = (self._free(draw, lower, upper) for _ in range(2))

    def _free(self, draw: np.random.Generator, lower: np.ndarray, upper: np.ndarray) -> np.ndarray:
        while True:
            q = draw.uniform(lower, upper)
            if self.checker.is_free(q):
                return q

    def solve(
        self, planner: str, seed: int, time_limit: float = TIME_LIMIT, factor: int = 1
    ) -> tuple[float, mg.planning.MotionResult]:
        """Processor time [s] and answer."""
        begin = time.process_time()
        found = mg.plan_motion(
            self.robot,
            self.group,
            self.world,
            start=self.start,
            goal=self.goal,
            planner=planner,
            seed=seed,
            time_limit=time_limit,
            max_iterations=factor * ITERATIONS,
            workspace_step=0.005,
        )
        return time.process_time() - begin, found

    def _bodies(self, to_root: np.ndarray) -> list[mg.verify.CheckedBody]:
        return [mg.verify.CheckedBody(name, shapes, to_root @ T) for name, shapes, T in self.bodies]

    def fault(self, path: np.ndarray) -> str:
        """What FCL and KDL find on the path; those that move the base are looked at in the root's frame, state by state."""
        if not self.group.has_base:
            return mg.verify.check_path(self.robot, self.group.names, path, self._bodies(np.eye(4))).where
        driven = [path[:1]]
        for a, b in itertools.pairwise(path):
            steps = int(np.ceil(np.abs(b - a).max() / 0.02)) + 1
            driven.append(a + (b - a) * np.linspace(0, 1, steps)[1:, None])
        for q in np.vstack(driven):
            to_root = np.linalg.inv(mg.pose((q[0], q[1], 0), rpy=(0, 0, q[2])))
            bodies = self._bodies(to_root)
            where = mg.verify.check_path(self.robot, self.group.names[3:], np.vstack([q[3:], q[3:]]), bodies).where
            if where:
                return where
        return ""


def run(name: str, data: Path, count: int, seeds: int) -> list[dict]:
    """A row for each planner."""
    robot, group = ROBOTS[name](data)
    problems = [Problem(robot, group, seed) for seed in range(count)]
    feasible = set()
    runs: dict[str, list[tuple[int, float, bool, str]]] = {planner: [] for planner in PLANNERS}
    for i, problem in enumerate(problems):
        for planner in PLANNERS:
            for seed in range(1, seeds + 1):
                seconds, found = problem.solve(planner, seed)
                fault = problem.fault(found.path) if found.path is not None else ""
                runs[planner].append((i, seconds, found.path is not None, fault))
                if found.path is not None:
                    feasible.add(i)
        if i not in feasible and problem.solve("ompl_rrt_connect", 1, LONG, 100)[1].path is not None:
            feasible.add(i)
    rows = []
    for planner, all_runs in runs.items():
        of_feasible = [run for run in all_runs if run[0] in feasible]
        times = 1e3 * np.array([run[1] for run in of_feasible])
        rows.append(
            {
                "on": name,
                "who": planner,
                "problems": count,
                "feasible": len(feasible),
                "runs": len(of_feasible),
                "solved": sum(run[2] for run in of_feasible),
                "faults": sum(bool(run[3]) for run in of_feasible),
                "value": round(float(np.median(times)), 2),
                "p95": round(float(np.percentile(times, 95)), 1),
            }
        )
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--problems", type=int, default=20)
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--robot", choices=list(ROBOTS))
    parser.add_argument("--data", type=Path, default=Path(__file__).resolve().parents[3] / "shared/data")
    args = parser.parse_args()
    for name in [args.robot] if args.robot else ROBOTS:
        for row in run(name, args.data, args.problems, args.seeds):
            print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
