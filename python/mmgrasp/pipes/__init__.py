"""Pipes carried along a path: one YAML file says what is carried where (docs/pipe_format.md), `mmgrasp pipe` does the rest.

from mmgrasp.pipes import load_pipe_problem, plan_pipe

plan = plan_pipe(load_pipe_problem("asset:pipes/pipe1.yaml"))
plan.grasp, plan.trajectory, plan.sags
"""

from .path_section import arc_poses as arc_poses
from .path_section import line_poses as line_poses
from .planning import PipePlan as PipePlan
from .planning import WaypointSag as WaypointSag
from .planning import plan_pipe as plan_pipe
from .problem import PipeProblem as PipeProblem
from .problem import load_pipe_problem as load_pipe_problem
