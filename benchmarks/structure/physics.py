"""What a static promise is worth: a flexible pipe carried in MuJoCo with the best, the median and the worst grasp.

    python benchmarks/structure/physics.py [--problem pipe1] [--write]

The shipped problem is solved; three of the feasible grasps, by cost, carry the pipe along the path, each at three timings
(shares of the joints' limits of speed and acceleration). --write puts the table into docs/methods/structure.md.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from mmgrasp.grasping import SupportedFrame, follow_object_path
from mmgrasp.pipes import load_pipe_problem, plan_pipe
from mmgrasp.pipes.timed_motion import timed_motion
from mmgrasp.sim.flexible_pipe import FlexiblePipe

PAGE = Path(__file__).parents[2] / "docs/methods/structure.md"
BEGIN, END = "<!-- physics -->", "<!-- end of physics -->"
TIMINGS = ((1.0, 1.0), (0.5, 0.3), (0.25, 0.05))


def rows(name: str) -> list[str]:
    problem = load_pipe_problem(name, algorithm="bees")  # whose grasps are spread, not crowded around the best
    plan = plan_pipe(problem)
    feasible = plan.optimum.feasible
    chosen = {"best": 0, "median": len(feasible) // 2, "worst": len(feasible) - 1}
    out = [
        "| grasp | cost | largest sag at rest, frame [mm] | MuJoCo [mm] | slowest mode [Hz] | speed, acceleration | motion [s] | peak [mm] | vibration after [mm] |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    task = problem.object_path_problem()
    for word, index in chosen.items():
        grasp = feasible[index].grasp
        path = follow_object_path(task, grasp, **problem.all_path_options)
        if path.path is None:  # not allowed by the finer check
            out.append(f"| {word} | refused by the finer check | | | | | | | |")
            continue
        held = SupportedFrame(problem.frame, [grasp])
        sags = [held.largest_displacement(problem.gravity_in_pipe(T)).value for T in problem.T_world_pipe]
        worst = sags.index(max(sags))
        body = FlexiblePipe(problem.frame, grasp, problem.robot, problem.arm, problem.gripper.tool_link)
        at_rest = float((body.at_rest(path.path[worst]) ** 2).sum(axis=1).max() ** 0.5)
        body = FlexiblePipe(
            problem.frame, grasp, problem.robot, problem.arm, problem.gripper.tool_link, pieces=3, time_step=2e-4
        )
        for speed, acceleration in TIMINGS:
            timing = replace(problem, speed=speed, acceleration=acceleration)
            trajectory, _ = timed_motion(timing, grasp, path.path)
            run = body.carry(trajectory)
            out.append(
                f"| {word} | {feasible[index].grasp.cost:.2f} | {1e3 * max(sags):.3f} | {1e3 * at_rest:.3f} | {body.slowest / 6.283185307:.1f} "
                f"| {100 * speed:.0f} %, {100 * acceleration:.0f} % | {trajectory.duration:.2f} | {1e3 * run.peak:.2f} | {1e3 * run.vibration:.2f} |"
            )
            print(out[-1], flush=True)
    return out


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--problem", default="pipe1")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    table = "\n".join(rows(arguments.problem))
    print(table)
    if arguments.write:
        text = PAGE.read_text()
        before, rest = text.split(BEGIN)
        after = rest.split(END)[1]
        PAGE.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}")


if __name__ == "__main__":
    main()
