"""Random grasp poses taken in passing, nothing in the way: ours, and casadi + Ipopt on the same problem from the same guess.

"random grasps" is the whole call: search of configurations, first guess, solves, judging; "random grasps, omni" the same with a base that
drives sideways. "solve alone" is one solve from the first guess by either: ours with setting the problem up and without judging its roll-out,
which is "judging"; casadi's with a problem built beforehand, which is "set-up", once.

    python benchmarks/trajopt/bench_random_grasps.py [--count 200] [--seeds 1 2 3] [--waypoints 35] [--baseline FOLDER]

--baseline names the site-packages folder of casadi; its runs alternate with ours. Solved means for ours: judged on the roll-out.
"""

from __future__ import annotations

import statistics
import sys

from grasp_cases import GOAL, START, arguments, grasps, line, plan, timed, whole_body

import mmgrasp as mg


def main() -> None:
    parser = arguments(__doc__, count=100, waypoints=35)
    parser.add_argument("--baseline", help="site-packages folder with casadi")
    given = parser.parse_args()
    _, group = whole_body()
    baseline = None
    if given.baseline:
        sys.path.append(given.baseline)
        from casadi_baseline import Baseline

        baseline = Baseline(group)
    for seed in given.seeds:
        ours: list[tuple[float, mg.planning.DriveByResult]] = []
        omni: list[tuple[float, mg.planning.DriveByResult]] = []
        alone: list[tuple[float, tuple[bool, float]]] = []
        theirs: list[tuple[float, tuple[bool, float]]] = []
        judging: list[float] = []
        set_up: list[float] = []
        for pose in grasps(seed, given.count):
            tasks = [mg.DriveByTask(pose)]
            ours.append(timed(lambda: plan(tasks, waypoints=given.waypoints, collisions=False)))  # noqa: B023
            omni.append(timed(lambda: plan(tasks, base="omni", waypoints=given.waypoints, collisions=False)))  # noqa: B023
            guess = mg._core._first_drive_by_guess(
                group, start=START, tasks=tasks, goal=GOAL, waypoints=given.waypoints
            )
            if guess is None:
                continue
            seconds, (solved, duration, judged, _) = timed(guess["solve"])
            judging.append(judged)
            alone.append((seconds - 2 * judged, (solved, duration)))  # judged once by itself as well
            if baseline is None:
                continue
            if tuple(guess["intervals"]) not in baseline.solvers:
                set_up.append(timed(lambda: baseline.prepare(guess["intervals"]))[0])  # noqa: B023
            theirs.append(timed(lambda: baseline.solve(guess, pose)))  # noqa: B023
        on, settings = f"seed {seed}", f"{given.count} poses, {given.waypoints} waypoints"
        for row, plans in (("random grasps", ours), ("random grasps, omni", omni)):
            solved = [r for _, r in plans if r.outcome == mg.Outcome.solved]
            line(
                row, on, "mmgrasp", [t for t, _ in plans], settings,
                solved=len(solved) / len(plans),
                at_once=sum(r.solves == 1 for r in solved) / len(plans),
                base_above=sum(r.events[0]["base_speed"] > 0.1 for r in solved) / max(1, len(solved)),
                duration=statistics.median(r.duration for r in solved),
            )  # fmt: skip
        for who, solves in (("mmgrasp", alone), ("casadi + Ipopt", theirs)):
            if not solves:
                continue
            line(
                "solve alone", on, who, [t for t, _ in solves], settings,
                solved=sum(ok for _, (ok, _) in solves) / len(solves),
                duration=statistics.median(d for _, (ok, d) in solves if ok),
            )  # fmt: skip
        if judging:
            line("judging", on, "mmgrasp", judging, settings)
        if set_up:
            line("set-up", on, "casadi + Ipopt", set_up, f"{len(set_up)} problems")


if __name__ == "__main__":
    main()
