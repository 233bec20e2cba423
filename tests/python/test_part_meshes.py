"""Parts of an assembly's file: turned profiles that cross themselves, and meshes with faults."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp.grippers import load_assembly
from mmgrasp.grippers.planning import plan_grippers
from mmgrasp.grippers.turned_parts import meeting_edges, turned
from test_segment_command import write_faulty_box


def assembly(folder: Path, part: dict[str, Any], unit: str = "mm") -> Path:
    content = {
        "format": "mmgrasp-assembly",
        "version": 1,
        "name": "one part",
        "unit": unit,
        "parts": [{"name": "part", **part}],
        "order": [{"part": "part"}],
        "actuators": [{"name": "jaws", "fingers": 2, "stroke": 0.048 if unit == "m" else 48}],
    }
    file = folder / "assembly.yaml"
    file.write_text(yaml.safe_dump(content))
    return file


CROSSING = {
    "bow tie": ([[0, 0], [8, 0], [0, 40], [8, 40]], (1, 3)),
    "loop": ([[2, 0], [8, 0], [8, 10], [5, -5], [2, 10]], (0, 2)),
    "corner on an edge": ([[1, 0], [5, 0], [5, 10], [4, 0], [1, 10]], (0, 2)),
    "pinched": ([[1, 0], [5, 0], [3, 5], [5, 10], [1, 10], [3, 5]], (1, 4)),
    "there and back": ([[1, 0], [5, 0], [5, 10], [5, 4], [1, 4]], (1, 2)),
}


@pytest.mark.parametrize("name", CROSSING)
def test_profiles_that_cross_themselves_are_refused(tmp_path: Path, name: str) -> None:
    profile, (first, second) = CROSSING[name]
    assert meeting_edges(profile) == (first, second)
    assert meeting_edges(1e-3 * np.array(profile)) == (first, second)
    assert meeting_edges(profile[::-1]) is not None
    with pytest.raises(mg.InvalidInput) as caught:
        load_assembly(assembly(tmp_path, {"turned": profile}))
    said = str(caught.value)
    assert re.search(r"assembly.yaml:\d+: parts\[0\].turned", said)
    for begin in (first, second):
        end = (begin + 1) % len(profile)
        ends = "from [{:g}, {:g}] to [{:g}, {:g}]".format(*profile[begin], *profile[end])
        assert f"{ends} (rows {begin} and {end})" in said


SIMPLE = [
    [[6.1, 6], [10, 6], [10, 16], [6.1, 16]],
    [[0, 0], [5, 0], [5, 10], [0, 10]],
    [[0, 0], [5, 0], [0, 5], [5, 10], [0, 10]],  # two cones, tip to tip on the axis
    [[1, 0], [5, 0], [5, 10], [5, 10], [1, 10]],  # a row twice
    [[1, 0], [3, 0], [5, 0], [5, 10], [1, 10]],  # a row on a straight line
]


@pytest.mark.parametrize("profile", SIMPLE)
def test_profiles_that_do_not_are_taken(tmp_path: Path, profile: list[list[float]]) -> None:
    assert meeting_edges(profile) is None and meeting_edges(profile[::-1]) is None
    (part,) = load_assembly(assembly(tmp_path, {"turned": profile})).parts.values()
    assert part.mesh.closed


def test_random_profiles_cross_where_their_edges_do() -> None:
    """Stars around a point are simple; two corners of one that change places make it cross, or it stays simple by a second look at all pairs."""
    rng = np.random.default_rng(5)
    for _ in range(60):
        count = int(rng.integers(4, 30))
        angle = np.sort(rng.uniform(0, 2 * np.pi, count))
        star = np.array([50.0, 0.0]) + rng.uniform(5, 40, count)[:, None] * np.column_stack(
            [np.cos(angle), np.sin(angle)]
        )
        if np.diff(angle, append=angle[0] + 2 * np.pi).max() < np.pi:
            assert meeting_edges(star) is None
            assert turned(1e-3 * star).closed
        mixed = rng.permutation(star)
        assert (meeting_edges(mixed) is not None) == any(
            proper_crossing(*mixed[[i, (i + 1) % count, k, (k + 1) % count]]) for i in range(count) for k in range(i)
        )


def proper_crossing(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> bool:
    """Solved as two equations: both edges at shares between 0 and 1."""
    shares = np.linalg.solve(np.column_stack([b - a, c - d]), c - a)
    return bool(((shares > 1e-9) & (shares < 1 - 1e-9)).all())


def test_faults_of_meshes_are_told_by_part(tmp_path: Path) -> None:
    """A box with half of its faces turned and every face twice gets the gripper that the clean one gets."""
    plans = []
    for turned_faces, twice in ((0, False), (6, True)):
        write_faulty_box(tmp_path / "box.stl", turned=turned_faces, twice=twice)
        plans.append(plan_grippers(load_assembly(assembly(tmp_path, {"mesh": "box.stl"}, unit="m"))))
    clean, faulty = plans
    assert clean.notes == []
    assert faulty.notes == [
        "part: the mesh has 12 faces twice: one of each was left out",
        "part: 6 faces of 12 looked another way than the rest of the mesh: they were turned",
    ]
    assert clean.result is not None and faulty.result is not None
    assert [g.to_dict() for g in faulty.result.grippers] == [g.to_dict() for g in clean.result.grippers]


def test_two_bodies_of_a_part_are_told(tmp_path: Path) -> None:
    write_faulty_box(tmp_path / "box.stl", beside=0.04)
    (part,) = load_assembly(assembly(tmp_path, {"mesh": "box.stl"}, unit="m")).parts.values()
    assert len(part.mesh_notes) == 1 and "2 bodies that do not touch" in part.mesh_notes[0]
