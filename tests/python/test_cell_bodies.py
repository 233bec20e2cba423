"""Octrees and clouds as obstacles of a scenario: their boxes cover the occupied cells, each once, and nothing else."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.mapping import OccupancyMap
from mmgrasp.scenario.scenario import load_scenario

CELL = 0.1


def write_cloud(path: Path, points: np.ndarray) -> None:
    lines = "\n".join(" ".join(f"{v:.9g}" for v in p) for p in points)
    path.write_text(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
        f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {len(points)}\nDATA ascii\n{lines}\n"
    )


def covering(shapes: list[Any], points: np.ndarray) -> np.ndarray:
    """How many boxes each point (n, 3) lies in."""
    count = np.zeros(len(points), dtype=int)
    for shape in shapes:
        count += (np.abs(points - shape.pose[:3, 3]) < shape.shape.size / 2).all(axis=1)
    return count


def with_obstacle(write: Any, small: dict[str, Any], entry: dict[str, Any], points: np.ndarray) -> Path:
    """A scenario with one more obstacle, and the cloud wall.pcd beside it."""
    path: Path = write({**small, "obstacles": [*small["obstacles"], {"name": "seen", **entry}]})
    write_cloud(path.parent / "wall.pcd", points)
    return path


def obstacle(write: Any, small: dict[str, Any], **entry: Any) -> list[Any]:
    path = with_obstacle(write, small, entry, wall_of_points())
    return next(o.shapes for o in load_scenario(path).obstacles if o.name == "seen")


def wall_of_points() -> np.ndarray:
    """A wall behind everything, with a hole, and lone points; coordinates off the cells' borders."""
    y, z = np.meshgrid(np.arange(-1.0, 1.0, 0.04) + 0.013, np.arange(0.1, 1.5, 0.04) + 0.017)
    hole = (np.abs(y) < 0.3) & (np.abs(z - 0.8) < 0.2)
    wall = np.column_stack([np.full((~hole).sum(), 4.533), y[~hole] + 4.0, z[~hole]])
    return np.vstack([wall, [[-2.51, 4.47, 0.33], [np.nan, 0, 0]]])


def test_a_cloud_is_the_cells_that_hold_a_point(small: dict[str, Any], write: Any) -> None:
    points = wall_of_points()
    shapes = obstacle(write, small, cloud="wall.pcd", cell=CELL)
    taken = {tuple(np.floor(p / CELL).astype(int)) for p in points[:-1]}
    assert len(shapes) < len(taken) / 4
    low, high = np.array(sorted(taken)).min(axis=0) - 2, np.array(sorted(taken)).max(axis=0) + 3
    cells = np.array(list(itertools.product(*(range(a, b) for a, b in zip(low, high, strict=True)))))
    inside = covering(shapes, (cells + 0.5) * CELL)
    assert inside.tolist() == [int(tuple(c) in taken) for c in cells.tolist()]
    volume = sum(float(np.prod(s.shape.size)) for s in shapes)
    assert volume == pytest.approx(len(taken) * CELL**3)


def test_within_cuts_and_keeps_cells_that_reach_in(small: dict[str, Any], write: Any) -> None:
    shapes = obstacle(write, small, cloud="wall.pcd", cell=CELL, within=[[4.0, 3.55, 0.0], [5.0, 4.0, 0.6]])
    bounds = np.array([s.bounds for s in shapes])
    np.testing.assert_allclose(bounds[:, 0].min(axis=0), [4.5, 3.5, 0.1])
    np.testing.assert_allclose(bounds[:, 1].max(axis=0), [4.6, 4.0, 0.6])


@pytest.mark.slow
def test_an_octree_is_its_occupied_leaves(small: dict[str, Any], write: Any, data: Path) -> None:
    """geb079, a hall: 20,000 points against OctoMap's own answer."""
    file = data / "clouds/octomap/geb079.bt"
    octree = OccupancyMap.load(file)
    middle = np.mean(octree.bounds, axis=0)
    within = np.array([middle - [4, 4, 1.0], middle + [4, 4, 1.5]]).round(3)
    shapes = obstacle(write, small, octree=str(file), within=within.tolist(), pose={"xyz": [0, 0, 20]})
    rng = np.random.default_rng(1)
    points = rng.uniform(within[0] + 0.2, within[1] - 0.2, (20_000, 3))
    occupied, known = octree.query(points)
    assert occupied.sum() > 200
    assert (covering(shapes, points) == (occupied & known)).all()
    unknown = obstacle(
        write, small, octree=str(file), within=within.tolist(), unknown="occupied", pose={"xyz": [0, 0, 20]}
    )
    assert ((covering(unknown, points) > 0) == (occupied | ~known)).all()


def octree_text(resolution: str) -> bytes:
    """An OctoMap file whose one leaf is an eighth of its tree."""
    return f"# Octomap OcTree binary file\nid OcTree\nsize 2\nres {resolution}\ndata\n".encode() + b"\x02\x00"


@pytest.mark.parametrize(("resolution", "rule"), [
    ("1600000", r'res = "1600000\.000000": must be above 1e-9 and below 1e6 m'),
    ("1600", r"an edge of 5\.24288e\+07 m at res = 1600 m: must be at most 1e6 m"),
])  # fmt: skip
def test_leaves_beyond_all_lengths_are_refused_with_their_file(
    resolution: str, rule: str, small: dict[str, Any], write: Any
) -> None:
    path: Path = write({**small, "obstacles": [{"name": "seen", "octree": "huge.bt"}]})
    file = path.parent / "huge.bt"
    file.write_bytes(octree_text(resolution))
    readers: list[Callable[[], Any]] = [
        lambda: mg.World().add_octree("map", file),
        lambda: OccupancyMap.load(file),
        lambda: load_scenario(path),
    ]
    for read in readers:
        with pytest.raises(mg.Error, match=rf"huge\.bt.*{rule}"):
            read()


def test_a_plan_among_cells_holds_without_the_file(small: dict[str, Any], write: Any) -> None:
    path = with_obstacle(write, small, {"cloud": "wall.pcd", "cell": CELL}, wall_of_points())
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved
    assert mg.verify_plan(plan.to_dict(), scenario=path, samples=100).ok
    write_cloud(path.parent / "wall.pcd", wall_of_points()[300:])
    assert mg.verify_plan(plan.to_dict(), samples=100).ok
    changed = mg.verify_plan(plan.to_dict(), scenario=path, samples=100)
    assert "scenario-changed" in {fault.code for fault in changed.faults}


@pytest.mark.parametrize(
    "entry, words",
    [
        ({"cloud": "wall.pcd"}, "cell is missing"),
        ({"cloud": "wall.pcd", "cell": 0}, "cell = 0"),
        ({"cloud": "wall.pcd", "cell": 0.1, "unknown": "free"}, "only a map or an octree has it"),
        ({"cloud": "wall.pcd", "cell": 0.1, "box": [1, 1, 1]}, "a cloud has no other shape"),
        ({"cloud": "wall.pcd", "octree": "x.bt", "cell": 0.1}, "give each an obstacle of its own"),
        ({"cloud": "nowhere.pcd", "cell": 0.1}, "no such file"),
        ({"cloud": "empty.pcd", "cell": 0.1}, "empty.pcd|has no occupied cell"),
        ({"cloud": "wall.pcd", "cell": 0.1, "within": [[9, 9, 9], [10, 10, 10]]}, "no occupied cell within"),
        ({"cloud": "wall.pcd", "cell": 0.1, "within": [[1, 1, 1], [1, 2, 2]]}, "below the upper one"),
        ({"cloud": "wall.pcd", "cell": 0.1, "within": [1, 2]}, "within"),
        ({"octree": "wall.pcd"}, "wall.pcd"),
        ({"octree": "wall.pcd", "cell": 0.1}, "only a cloud has it"),
        ({"octree": "wall.pcd", "unknown": "occupied"}, "needs `within`"),
        ({"box": [1, 1, 1], "within": [[0, 0, 0], [1, 1, 1]]}, "only an octree or a cloud has it"),
    ],
)
def test_bad_entries_are_refused(small: dict[str, Any], write: Any, entry: dict[str, Any], words: str) -> None:
    path = with_obstacle(write, small, entry, wall_of_points())
    write_cloud(path.parent / "empty.pcd", np.full((2, 3), np.nan))
    with pytest.raises(mg.InvalidInput, match=words) as refused:
        load_scenario(path)
    assert path.name in str(refused.value)
