"""Motions of arms and bases, tool lines, timing."""

from __future__ import annotations

from typing import Any

import numpy as np

from .lookup import CALLS, PATIENT, Answer, ask, call, find
from .results import line, motion, timed
from .setups import drawn, free_ends, group, pose, tucked, world


def planned(planner: str, name: str, base: str, iterations: int = 20000, seed: int = 1) -> Answer:
    """A base is moved among three walls, an arm alone among obstacles."""
    if base == "fixed":
        arm, scene = group(name), world()
        start, goal = free_ends(arm, scene, 5)
    else:
        arm, scene = group(name, base, with_base=True), find("World")()
        for i in range(3):
            scene.add_box(f"wall {i}", [0.1, 2.0, 1.6], pose(1.5 + 1.5 * i, 0.6 * (-1) ** i, 0.8))
        home = tucked(name, base)
        start, goal = [0, 0, 0, *home], [6.0, 0.3, 1.0, *home]
    options = {"planner": planner, "seed": seed, "max_iterations": iterations, "time_limit": PATIENT}
    return motion(find("plan_motion")(arm.robot, arm, scene, start=start, goal=goal, **options))


# Name of the call: planner, robot, base, budget in iterations.
MOTIONS: dict[str, tuple[Any, ...]] = {
    "rrt_connect_fetch": ("rrt_connect", "fetchlike", "fixed"),
    "rrt_connect_tm14": ("rrt_connect", "tm14like", "fixed"),
    "rrt_connect_diff_drive": ("rrt_connect", "fetchlike", "diff_drive"),
    "rrt_connect_omni": ("rrt_connect", "omni6", "omni"),
    "ompl_rrt_connect_kr6": ("ompl_rrt_connect", "kr6like", "fixed"),
    "ompl_rrt_connect_diff_drive": ("ompl_rrt_connect", "fetchlike", "diff_drive"),
    "ompl_rrt_connect_omni": ("ompl_rrt_connect", "omni6", "omni"),
    **{
        f"{planner}_kr6": (planner, "kr6like", "fixed", 1500)
        for planner in ("rrt", "est", "bi_est", "kpiece", "bkpiece", "prm", "prm_star", "lazy_prm_star")
    },
    **{
        f"{planner}_tm14": (planner, "tm14like", "fixed", 1500)
        for planner in ("rrt_star", "informed_rrt_star", "bit_star", "abit_star", "ait_star")
    },
}
for key, given in MOTIONS.items():
    CALLS[key] = lambda given=given: planned(*given)


@call
def goals_by_pose() -> Answer:
    """Goals as tool poses and regions, a cone held on the way."""
    arm, scene = group("tm14like"), find("World")()
    scene.add_box("wall", [0.5, 0.1, 0.6], pose(0.6, 0, 0.3))
    start = arm.ik(pose(0.5, 0.4, 0.4, rpy=[0, np.pi / 2, 0]), world=scene, rng_seed=1, time_limit=PATIENT).q
    wanted = pose(0.5, -0.4, 0.4, rpy=[0, np.pi / 2, 0])
    region = find("ToolRegion")(wanted, position=[0.1, 0.1, 0], rotation=[0, 0, 0.3])
    cone = find("ToolCone", "OrientationConstraint")([1, 0, 0], [0, 0, -1], 0.6)
    options = {"planner": "rrt_connect", "seed": 1, "time_limit": PATIENT, "start": start}
    by_pose = find("plan_motion")(arm.robot, arm, scene, tool_poses=wanted, **options)
    by_region = find("plan_motion")(arm.robot, arm, scene, regions=[region], **options)
    upright = ask(find("plan_motion"), arm.robot, arm, scene, tool_poses=wanted, tool_cone=cone, **options)
    answers = [motion(found) for found in (by_pose, by_region, upright)]
    parts = {
        f"{what}, {key}": part
        for what, answer in zip(("pose", "region", "cone"), answers, strict=True)
        for key, part in answer[0].items()
    }
    return parts, {"costs": [round(found.cost, 9) for found in (by_pose, by_region, upright)]}


@call
def straight_line() -> Answer:
    arm = group("tm14like")
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    q = arm.ik(pose(0.5, 0.3, 0.4, rpy=[0, np.pi / 2, 0]), rng_seed=1, time_limit=PATIENT).q
    return line(find("plan_straight_line")(checker, q, pose(0.5, -0.2, 0.5, rpy=[0, np.pi / 2, 0.5])))


@call
def cartesian() -> Answer:
    arm = group("kr6like")
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    corners = [pose(x, y, 0.35, rpy=[0, np.pi / 2, 0]) for x, y in ((0.4, 0.2), (0.4, -0.2), (0.5, -0.2), (0.5, 0.2))]
    found = find("plan_cartesian")(checker, np.array(corners))
    parts, shown = line(found)
    return parts | {"corners": found.corners, "branches": [found.branches, found.tried]}, shown | {
        "branches": found.branches
    }


@call
def timing() -> Answer:
    arm = group("kr6like")
    path = np.cumsum(0.3 * drawn(arm, 8, 6) / abs(drawn(arm, 8, 6)).max(), axis=0)
    limits = [arm.velocity_limits, np.full(len(arm.names), 6.0)]
    plain = find("time_parameterize")(path, *limits)
    jerk = find("time_parameterize")(path, *limits, jerk_limits=np.full(len(arm.names), 60.0))
    arm = arm.with_acceleration_limits(limits[1])
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    free = find("time_parameterize_free")(checker, path)
    parts = {"plain": timed(plain), "jerk": timed(jerk), "free": timed(free)}
    return parts, {"seconds": plain.duration, "with jerk limits": jerk.duration, "samples": len(plain)}
