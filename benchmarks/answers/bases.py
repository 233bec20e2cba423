"""Reach, stops and routes."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from .lookup import PATIENT, Answer, call, find, get, threads
from .results import rejections, shared_cells, stop, stops
from .setups import ROBOTS, drawn, group, pose, tucked, world


@cache
def reach_database() -> Any:
    return find("ReachDatabase").build(group("fetchlike", "diff_drive"), samples=100_000, seed=1, threads=threads())


@call
def reach() -> Answer:
    arm, database = group("fetchlike", "diff_drive"), reach_database()
    checker = find("CollisionChecker")(arm.robot, world(), arm)
    poses = arm.fk_batch(drawn(arm, 30, 7))
    bases = database.base_poses_for(arm, pose(2, 1, 0.75, rpy=[0, np.pi / 2, 0]), count=10, threads=threads())
    targets = np.array([pose(1.9, 1, 0.75, rpy=[0, np.pi / 2, 0]), pose(1.8, 0.8, 0.8, rpy=[0, np.pi / 2, 0.4])])
    placed = database.find_base_placement(arm, targets, threads=threads())
    parts = {
        "database": dict(database.arrays),
        "query": [[database.query(T), get(database, "nearest")(T)] for T in poses],
        "solve": list(database.solve_batch(arm, poses, checker=checker, count=4, threads=threads())),
        "base poses": list(bases),
        "placement": [placed.base_pose, placed.reached, list(placed.configurations)],
    }
    return parts, {"size": len(database), "solutions": sum(map(len, parts["solve"])), "base poses": len(bases[0])}


@call
def capability_map() -> Answer:
    table = find("World")()
    table.add_box("table", [0.8, 1.6, 0.05], pose(0.9, 0, 0.7))
    parts, reached = {}, {}
    for name, scene in (("fetchlike", None), ("kr6like", table)):
        arm = group(name)
        made = find("CapabilityMap").build(arm, scene, voxel=0.2, poses=10, approach=(1.0, 0.0, 0.0), threads=threads())
        parts[name] = [made.index, made.classes, made.configurations, made.tool_poses, rejections(made.rejections)]
        reached[name] = made.reached
    return parts, reached


@call
def platform_locations() -> Answer:
    arm = group("fetchlike", "diff_drive", with_base=True)
    checker = find("CollisionChecker")(arm.robot, find("World")(), arm)
    ends = [pose(0.8, y, 0.9, rpy=[0, np.pi / 2, 0]) for y in (-1.5, 1.5)]
    found = find("plan_platform_locations")(checker, *ends, samples=15, seed=1, time_limit=PATIENT)
    parts = {
        "outcome": found.outcome,
        "configurations": [found.q_pick, found.q_place],
        "cost": [found.cost, found.travel, found.turn],
    }
    return parts, {"outcome": found.outcome.name, "cost": found.cost}


def row_of_squares(count: int) -> tuple[Any, list[np.ndarray]]:
    grid = find("BaseGrid")([0.0, 0.0], 0.05, 8 * count + 12, 16)
    masks = []
    for i in range(count):
        mask = np.zeros((1, grid.ny, grid.nx), np.uint8)
        mask[0, 2:14, 2 + 8 * i : 14 + 8 * i] = 1
        masks.append(mask)
    return grid, masks


@call
def stops_of_a_row() -> Answer:
    grid, masks = row_of_squares(7)
    found = find("least_stops", "plan_stops_exact")(
        grid, masks, 0.1, start=[0, 0], goal=[3, 0], time_limit=PATIENT, tie_time_limit=PATIENT
    )
    cells = find("robust_intersections")(grid, masks, 0.1)
    cover = find("minimal_stops", "cover_from_intersections")(grid, cells.robust, len(masks))
    whole = find("maximal_intersections")(grid, masks, 0.1)
    parts = {f"exact, {key}": part for key, part in stops(found)[0].items()} | {
        f"cover, {key}": part for key, part in stops(cover)[0].items()
    }
    return parts | {"robust": shared_cells(cells), "maximal": shared_cells(whole)}, stops(found)[1]


@call
def policies_and_order() -> Answer:
    grid = find("BaseGrid")([-1.0, -1.5], 0.05, 80, 30)
    x, y = -1 + 0.05 * (np.arange(grid.nx) + 0.5), -1.5 + 0.05 * (np.arange(grid.ny) + 0.5)
    places = [np.array([[0.5 * tray + 0.1 * i, 0.0] for i in range(3)]) for tray in range(4)]
    cells = [[(np.hypot(x - p[0], y[:, None]) < 0.8).astype(np.uint8)[None] for p in at] for at in places]
    order, parts, shown = find("paired_order")(places), {}, {}
    for policy in ("all", "remaining", "targets"):
        found = find("run_policy")(grid, cells, order, policy, time_limit=PATIENT, tie_time_limit=PATIENT)
        figures = [found.mean_stops, found.mean_radius, found.smallest_radius]
        parts[policy] = [figures, [[stop(s) for s in r.stops] for r in found.rounds]]
        shown[policy] = found.mean_stops
    best = find("optimised_order", "optimized_order")(grid, cells, [[0, 1], [2, 3]], order)
    return parts | {"order": [order, best.order, best.mean_radius, best.proven]}, shown


@call
def set_cover_and_tours() -> Answer:
    rng = np.random.default_rng(1)
    sets = [sorted(set(rng.integers(0, 40, 6).tolist())) for _ in range(60)] + [[i] for i in range(40)]
    cover = find("solve_set_cover")(40, sets, rng.uniform(1, 2, len(sets)).tolist(), time_limit=PATIENT)
    points = rng.uniform(0, 10, (22, 2))
    lengths = np.linalg.norm(points[:, None] - points[None], axis=2)
    small, large = (find("shortest_visiting_tour")(lengths[:n, :n]) for n in (12, 22))
    shared = find("share_stops")(lengths[:9, :9], [1.0, 2, 3, 4, 5], 2)
    costs = rng.uniform(0, 1, (12, 12))
    parts = {
        "cover": [cover.outcome, cover.chosen, cover.cost, cover.lower_bound],
        "tours": [[tour.outcome, tour.order, tour.length, tour.lower_bound, tour.proven] for tour in (small, large)],
        "shared": [shared.outcome, shared.orders, shared.durations, shared.makespan, shared.lower_bound],
        "assignment": find("cheapest_assignment")(costs),
    }
    return parts, {"cover": cover.cost, "tour": large.length, "makespan": shared.makespan}


@call
def base_route() -> Answer:
    parts, shown = {}, {}
    for name, base in ROBOTS[:2]:
        arm, scene = group(name, base), find("World")()
        for i in range(3):
            scene.add_box(f"wall {i}", [0.1, 3.0, 1.0], pose(1.5 + 1.5 * i, 1.0 * (-1) ** i, 0.5))
        home = tucked(name, base)
        ends = {"start": [0, 0, 0], "goal": [6, 0.5, 1.0]}
        found = find("plan_base_route")(arm, scene, home=home, **ends)
        at = np.array([[0, 0, 0], [2.2, 0, 1], [6, 0.5, 1]])
        parts[name] = [
            found.outcome,
            found.poses,
            found.length,
            found.turning,
            find("route_lengths")(arm, scene, home=home, positions=at, threads=threads()),
        ]
        shown[name] = found.length
    return parts, shown
