"""A pipe problem from a file: where to hold the pipe, the motion along its path, and the pipe carried from start to goal any way that is short."""

from pathlib import Path
from tempfile import TemporaryDirectory

import mmgrasp as mg
from mmgrasp.pipes import load_pipe_problem, plan_pipe
from mmgrasp.pipes.output import write_tables

problem = load_pipe_problem("pipe1")  # a shipped file; docs/pipe_format.md says how to write another
plan = plan_pipe(problem)
print(problem)
if plan.trajectory is None:
    raise SystemExit(plan.obstruction)
print(f"held at {plan.grasp.provenance if plan.grasp else None}: {plan.proof}")
worst = max(plan.sags, key=lambda row: row.sag)
print(
    f"it sags by up to {1000 * worst.sag:.2f} mm on section {worst.section}; the motion takes {plan.trajectory.duration:.2f} s"
)
with TemporaryDirectory() as folder:
    write_tables(plan, Path(folder))
    print("written:", ", ".join(sorted(path.name for path in Path(folder).iterdir())))

# The pipe may go any way now: of the grasps whose motion is at most 5 rad long, the one that sags least.
candidates = plan.optimum.sag_candidates()[:100]
task = problem.manipulation_problem(candidates)
found = mg.plan_manipulation(task, max_length=5.0)
if found.path is not None:
    sag = candidates[found.grasp_index].cost
    print(
        f"of {len(candidates)} grasps: {1000 * sag:.2f} mm on average along the path, motion {found.cost - sag:.2f} rad"
    )
