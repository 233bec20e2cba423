"""Carry a pipe structure through a cell: of hundreds of grasps the planner takes the one with the shortest motion."""

import mmgrasp as mg
from mmgrasp.problems.pipe_cells import pipe_cell
from mmgrasp.viz.transfer import write_transfer

cell = pipe_cell(5, seed=1)
print(f"{cell.pipe} between a partition and a roof; cells rejected before this one: {cell.rejected or 'none'}")
grasps = cell.grasps(300)
problem = cell.problem(grasps)  # cell, pipe, both poses and all grasps; only the fingers may touch the pipe
found = mg.plan_manipulation(problem, planner="prm_star_mg", vertices=5000, time_limit=60.0, seed=1)
within_reach = sum(g.start_solutions > 0 and g.goal_solutions > 0 for g in found.grasps)
print(f"{within_reach} of {len(grasps)} grasps are within reach at both ends; rejected: {found.rejections}")
print(found)
if found.path is not None:
    grasp = grasps[found.grasp_index]
    print(f"taken: {grasp}; {found.stats.graph_searches} searches of the roadmap in {found.stats.search_seconds:.2f} s")
    print("picture:", write_transfer(cell, grasp, found.path, "carry_pipe.png"))
