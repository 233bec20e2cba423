"""An object carried by the best of many grasps."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from .lookup import PATIENT, Answer, ask, call, find, get, threads
from .results import manipulation
from .setups import body, group, pose


def pipe_problem(structure: int, count: int) -> Any:
    """A pipe before an arm, to be moved past a column; without drawing a cell, which takes long."""
    robot_, arm, gripper = find("pipe_robot")("tm14like")
    pipe, scene = find("pipe_structures")()[structure - 1], find("World")()
    scene.add_box("column", [0.1, 0.1, 0.7], pose(0.6, 0, 0.35))
    scene.add_box("table", [2, 2, 0.05], pose(0, 0, -0.05))
    found = ask(pipe.sample_grasps, count, gripper=gripper, seed=1)
    candidates = [
        find("CandidateGrasp", "Grasp")(
            get(g, "T_object_tool", "T_object_tcp", "T_object_hand"), opening=g.opening, cost=g.cost
        )
        for g in found
    ]
    fingers = sorted(link for link in robot_.links if "finger_link" in link)
    ends = [pose(0.5, side * 0.45, 0.35, rpy=[0, 0, side * 0.4]) for side in (1, -1)]
    return find("ManipulationProblem")(
        arm, scene, pipe.shapes(), *ends, candidates, gripper=gripper, touch_links=fingers
    )


@call
def prm_star_mg_pipe() -> Answer:
    options = {"vertices": 2000, "neighbours": 12, "seed": 1, "time_limit": PATIENT, "threads": threads()}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(1, 60), planner="prm_star_mg", **options))


@call
def rrt_star_mg_pipe() -> Answer:
    options = {"max_iterations": 600, "seed": 1, "time_limit": PATIENT, "threads": threads()}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(6, 60), planner="rrt_star_mg", **options))


@cache
def bar_problem() -> Any:
    """A flat arm of three joints turns a bar past a post, held at one of 20 places."""
    links, pairs = ['<link name="l0"/>'], []
    for i in range(1, 4):
        links.append(
            f'<link name="l{i}"><collision><origin xyz="0.2 0 0"/><geometry><box size="0.4 0.02 0.02"/></geometry></collision></link>'
            f'<joint name="j{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/><origin xyz="{0.4 if i > 1 else 0} 0 0"/>'
            '<axis xyz="0 0 1"/><limit effort="1" velocity="2" lower="-2.8" upper="2.8"/></joint>'
        )
        pairs += [f'<disable_collisions link1="l{k}" link2="l{i}" reason="User"/>' for k in range(i)]
    links.append(
        '<link name="tip"/><joint name="t" type="fixed"><parent link="l3"/><child link="tip"/><origin xyz="0.4 0 0"/></joint>'
    )
    urdf, srdf = (f'<robot name="planar">{"".join(rows)}</robot>' for rows in (links, pairs))
    arm = find("Robot").from_strings(urdf, srdf).group(base_link="l0", tip="tip")
    scene = find("World")()
    scene.add_box("post", [0.1, 0.1, 0.2], pose(0.85, 0, 0))
    scene.add_box("corner", [0.06, 0.06, 0.2], pose(0.35, -0.75, 0))
    places = [pose(-0.18 + 0.04 * i, 0, 0, rpy=[0, 0, turn * np.pi / 2]) for i in range(10) for turn in (1, -1)]
    candidates = [find("CandidateGrasp", "Grasp")(T) for T in places]
    ends = [pose(0.55, 0.45, 0, rpy=[0, 0, 1.2]), pose(0.6, -0.45, 0, rpy=[0, 0, 0.9])]
    return find("ManipulationProblem")(arm, scene, body(0.4, 0.02, 0.02), *ends, candidates, touch_links=["l3", "tip"])


@call
def prm_star_mg_growing() -> Answer:
    """No straight lines, and a roadmap that is doubled."""
    options = {"vertices": 500, "max_vertices": 4000, "straight": False, "time_limit": PATIENT, "threads": threads()}
    return manipulation(ask(find("plan_manipulation"), pipe_problem(3, 40), **options))


@call
def pipe_cell_carry() -> Answer:
    """The cell of example 10."""
    cell = find("pipe_cell")(5, seed=1)
    options = {"vertices": 5000, "seed": 1, "time_limit": PATIENT, "threads": threads()}
    parts, shown = manipulation(ask(find("plan_manipulation"), cell.problem(cell.grasps(200)), **options))
    return parts | {"cell": [cell.T_world_start, cell.T_world_goal]}, shown


@call
def prm_star_mg_bar() -> Answer:
    options = {"vertices": 800, "gamma": 5, "ik_solutions": 2, "time_limit": PATIENT, "threads": threads()}
    return manipulation(ask(find("plan_manipulation"), bar_problem(), **options))


@call
def rrt_star_mg_bar() -> Answer:
    options = {"max_iterations": 1000, "time_limit": PATIENT, "threads": threads(), "keep_trees": True}
    found = ask(find("plan_manipulation"), bar_problem(), planner="rrt_star_mg", **options)
    parts, shown = manipulation(found)
    trees = [[tree.vertices, list(tree.parents), list(tree.costs), tree.grasp, tree.from_goal] for tree in found.trees]
    return parts | {"trees": trees}, shown | {"trees": len(trees)}


@call
def roadmap() -> Answer:
    arm = bar_problem().group if hasattr(bar_problem(), "group") else group("kr6like")
    made = ask(find("Roadmap").build, arm, vertices=1000, neighbours=8, seed=3)
    return {"vertices": made.vertices, "edges": made.edges}, {"edges": len(made.edges)}
