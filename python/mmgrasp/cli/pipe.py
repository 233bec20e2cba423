"""`mmgrasp pipe`: the best grasp of a pipe for a path, the arm's motion with it, how the pipe bends, and a report."""

from __future__ import annotations

import argparse

from rich.console import Console

from .._core import Outcome
from .._files import write_file
from ..pipes.output import PIPE_FILES, grasp_to_dict, result_to_dict, write_tables
from ..pipes.planning import PipePlan, plan_pipe
from ..pipes.problem import load_pipe_problem
from .console import Reporter, print_answer
from .exit_codes import DONE, exit_code
from .output_folder import OutputFolder


def run_pipe(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code."""
    folder = OutputFolder(arguments.out, PIPE_FILES)
    with Reporter(console) as report:
        report("reading", 0.0)
        problem = load_pipe_problem(
            arguments.problem,
            seed=arguments.seed,
            threads=arguments.threads,
            algorithm=arguments.algorithm,
            progress=report,
        )
        report("grasps", 0.0)
        plan = plan_pipe(problem, progress=report)
        report("writing", 0.0)
        folder.fill(lambda draft: write_tables(plan, draft))
        from ..viz.pipe_report import pipe_report_html

        with folder.illustrated() as draft:
            if not arguments.no_pictures:
                from ..viz.pipe_pictures import write_pipe_pictures

                write_pipe_pictures(plan, draft, report)
            write_file(draft / "report.html", pipe_report_html(plan, draft))
        report("writing", 1.0)
    print_answer(arguments, console, result_to_dict(plan), lambda: _print(plan, console))
    return DONE if plan.grasp is not None and plan.outcome != Outcome.stopped else exit_code(plan.outcome)


def _print(plan: PipePlan, console: Console) -> None:
    optimum = plan.optimum
    if plan.grasp is None or plan.path is None or plan.trajectory is None:
        console.print(f"no grasp: {plan.outcome.name.replace('_', ' ')}", style="bold red", markup=False)
        console.print(f"- {plan.obstruction}", markup=False, soft_wrap=True)
        console.print(f"- {plan.proof}", markup=False, soft_wrap=True)
        return
    place = grasp_to_dict(plan.grasp)
    flip = ", flipped" if place["flipped"] else ""
    worst = max(plan.sags, key=lambda row: row.sag)
    stress = max((row.stress for row in plan.sags if row.stress is not None), default=None)
    bears = "" if stress is None else f", bears up to {1e-6 * stress:.1f} MPa"
    lines = [
        f"hold section {place['section']} at {place['length']:.3f} m, {place['angle']:.2f} rad{flip}: cost {plan.path.cost:.3f}",
        f"- {plan.proof}",
        f"- {optimum.evaluations} grasps tried, {len(optimum.feasible)} can follow the path, {len(optimum.front)} on the Pareto front",
        f"- the pipe sags by up to {1e3 * worst.sag:.2f} mm{bears}",
        f"- joint motion {plan.path.joint_motion:.2f} rad in {plan.trajectory.duration:.2f} s, within {1e3 * plan.path_error[0]:.2f} mm of the path",
    ]
    for line in lines:
        console.print(line, markup=False, soft_wrap=True)
