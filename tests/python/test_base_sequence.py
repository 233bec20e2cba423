"""Stops, orders and policies through the Python door, on regions drawn as bitmaps."""

import itertools
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg

RESOLUTION = 0.05


def squares(count: int, width: int = 12, step: int = 8) -> tuple[mg.base.BaseGrid, list[np.ndarray]]:
    """Square regions in a row; neighbours share `width - step` columns."""
    grid = mg.base.BaseGrid([0.0, 0.0], RESOLUTION, step * count + width, width + 4)
    masks = []
    for i in range(count):
        mask = np.zeros((1, grid.ny, grid.nx), np.uint8)
        mask[0, 2 : 2 + width, 2 + step * i : 2 + step * i + width] = 1
        masks.append(mask)
    return grid, masks


def test_least_stops_of_a_row() -> None:
    grid, masks = squares(7)
    found = mg.base.plan_stops_exact(grid, masks, 0.1, start=[0, 0], goal=[3, 0])
    assert found.outcome == mg.Outcome.solved
    assert len(found.stops) == found.lower_bound == 4  # two to a stop: neighbours share 0.2 m
    assert sorted(tray for stop in found.stops for tray in stop.trays) == list(range(7))
    lone = [stop for stop in found.stops if len(stop.trays) == 1]
    assert [stop.radius for stop in lone] == pytest.approx([0.3], abs=1e-6)
    assert sorted(len(c.trays) for c in found.candidates.robust) == [2] * 6
    assert sorted(map(tuple, (c.trays for c in mg.base.maximal_intersections(grid, masks, 0.1).robust))) == [
        (i, i + 1) for i in range(6)
    ]
    with pytest.raises(mg.Error, match="both or neither"):
        mg.base.plan_stops_exact(grid, masks, 0.1, start=[0, 0])
    with pytest.raises(mg.Error, match="cells"):
        mg.base.plan_stops_exact(grid, [masks[0][:, 1:]], 0.1)


def reduced(thing: object) -> Any:
    return thing.__reduce_ex__(4)


def test_an_intersection_names_each_tray_once() -> None:
    """Intersections come from the search, or from a pickle of any origin."""
    grid, masks = squares(2)
    pair = next(one for one in mg.base.robust_intersections(grid, masks, 0.1).robust if len(one.trays) == 2)
    assert mg.base.cover_from_intersections(grid, [pair], 2).outcome == mg.Outcome.solved
    restore, (kind, state) = reduced(pair)
    for trays, rule in (
        ([0, 1, 1], r"intersections\.trays = 1: must not be named twice in an intersection"),
        ([1, 0], r"intersections\.trays = 0: must be ascending"),
        ([0, 2], r"intersections\.trays = 2: must be at least 0 and below the number of trays, 2"),
    ):
        with pytest.raises(mg.InvalidInput, match=rule):
            mg.base.cover_from_intersections(grid, [restore(kind, (trays, *state[1:]))], 2)


def test_share_stops_among_robots() -> None:
    rng = np.random.default_rng(3)
    points = rng.uniform(0, 10, (4 + 4, 2))
    drive = np.linalg.norm(points[:, None] - points[None], axis=2)
    work = [1.0, 2.0, 3.0, 4.0]

    def duration(robot: int, order: tuple[int, ...]) -> float:
        if not order:
            return 0.0
        way = [4 + robot, *order, 6 + robot]
        return float(sum(drive[a, b] for a, b in itertools.pairwise(way)) + sum(work[i] for i in order))

    best = min(
        max(duration(0, order[:k]), duration(1, order[k:]))
        for order in itertools.permutations(range(4))
        for k in range(5)
    )
    shared = mg.optim.share_stops(drive, work, 2)
    assert shared.outcome == mg.Outcome.solved
    assert shared.makespan == pytest.approx(best)
    assert [duration(r, tuple(o)) for r, o in enumerate(shared.orders)] == pytest.approx(shared.durations)
    assert shared.to_dict()["lower_bound"] == pytest.approx(best)


def test_assignment_and_bound() -> None:
    costs = np.array([[4.0, 1, 3], [2, 0, 5], [3, 2, 2]])
    best = min(sum(costs[i, p[i]] for i in range(3)) for p in itertools.permutations(range(3)))
    assert sum(costs[i, c] for i, c in enumerate(mg.optim.cheapest_assignment(costs))) == best
    points = np.random.default_rng(1).uniform(0, 1, (42, 2))
    tour = mg.optim.shortest_visiting_tour(np.linalg.norm(points[:, None] - points[None], axis=2))
    assert 0.95 * tour.length < tour.lower_bound <= tour.length


def parts_in_front(trays: int, parts: int) -> tuple[mg.base.BaseGrid, list[list[np.ndarray]], list[np.ndarray]]:
    grid = mg.base.BaseGrid([-1.0, -1.5], RESOLUTION, 40 + 10 * trays, 30)
    x = -1.0 + RESOLUTION * (np.arange(grid.nx) + 0.5)
    y = -1.5 + RESOLUTION * (np.arange(grid.ny) + 0.5)
    cells, places = [], []
    for tray in range(trays):
        at = np.array([[0.5 * tray + 0.1 * i, 0.0] for i in range(parts)])
        places.append(at)
        cells.append([(np.hypot(x[None] - p[0], y[:, None]) < 0.8).astype(np.uint8)[None] for p in at])
    return grid, cells, places


def test_policies() -> None:
    grid, cells, places = parts_in_front(4, 3)
    order = mg.base.paired_order(places)
    assert order == [[0, 1, 2]] * 4
    results = {name: mg.base.run_policy(grid, cells, order, name) for name in ("all", "remaining", "targets")}
    for result in results.values():
        assert result.solved
        assert result.reliable
        assert len(result.rounds) == 3
        assert result.mean_radius == pytest.approx(np.mean([r.mean_radius for r in result.rounds]))
    assert results["targets"].mean_stops <= results["all"].mean_stops
    best = mg.base.optimised_order(grid, cells, [[0, 1], [2, 3]], order)
    assert best.proven
    assert [sorted(tray) for tray in best.order] == [[0, 1, 2]] * 4
    asked = []

    def planned(round_: int) -> list[np.ndarray]:
        asked.append(round_)
        return [np.roll(tray[0], 14, axis=2) for tray in cells]

    wrong = mg.base.run_policy(grid, cells, order, planned=planned)
    assert asked == [0, 1, 2]
    assert not wrong.reliable
    assert not wrong.feasible
    with pytest.raises(mg.Error, match="policy"):
        mg.base.run_policy(grid, cells, order, "updateR")
