"""The motor-like product that P1's figures of chapter 5 are made again with: solids of known volume, and the openings of figure 5.13."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from mmgrasp._core import fit_primitives, segment_mesh
from mmgrasp.grippers.motor import PARTS, ROTOR, SLEEVE, Composed
from mmgrasp.grippers.turned_parts import SIDES, lofted, turned
from mmgrasp.reproduce.gripper_sets import SEGMENTS
from mmgrasp.reproduce.segmentation import opening_found, taken_apart

EVERY = {**PARTS, "rotor": ROTOR, "sleeve": SLEEVE}


def volume(vertices: np.ndarray, triangles: np.ndarray) -> float:
    """Volume by the divergence theorem: positive when closed and turned outside."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def polygon(radius: float, corners: int = SIDES) -> float:
    return 0.5 * corners * radius * radius * math.sin(2 * math.pi / corners)


@pytest.mark.parametrize("name", EVERY)
def test_parts_are_closed_solids(name: str) -> None:
    """Each edge has two faces that run along it in opposite directions, and the volume is that of the bodies less the bore."""
    part = EVERY[name]
    mesh = part.mesh()
    edges = [(int(t[i]), int(t[(i + 1) % 3])) for t in mesh.triangles for i in range(3)]
    assert len(set(edges)) == len(edges)
    assert {(b, a) for a, b in edges} == set(edges)
    turned_only = not any(isinstance(section, tuple) for section, _ in part.bodies)
    expected = sum(
        ((section[0] * section[1] if isinstance(section, tuple) else polygon(section)) - polygon(part.bore)) * height
        for section, height in part.bodies
    )
    tolerance = 1e-9 if turned_only else 2e-3  # corners of rectangles add some to the circles' sides
    assert 1e9 * volume(np.asarray(mesh.vertices), np.asarray(mesh.triangles)) == pytest.approx(expected, rel=tolerance)


def test_a_loft_between_rectangles_is_a_box() -> None:
    mesh = lofted([(0.0, 0.0), ((0.02, 0.05), 0.0), ((0.02, 0.05), 0.03), (0.0, 0.03)], sides=4)
    vertices = np.asarray(mesh.vertices)
    assert vertices.min(axis=0) == pytest.approx([-0.01, -0.025, 0]) and vertices.max(axis=0) == pytest.approx(
        [0.01, 0.025, 0.03]
    )
    assert volume(vertices, np.asarray(mesh.triangles)) == pytest.approx(0.02 * 0.05 * 0.03)


def test_openings_are_those_of_the_figure() -> None:
    """The openings of each part are there, in any order; the radius of a neck is in none."""
    for name, part in PARTS.items():
        made = {(2, min(s)) if isinstance(s, tuple) else (3, 2 * s) for s, _ in part.bodies} - {(3, 8.0)}
        assert made == {(fingers, width) for fingers, width, _ in SEGMENTS[name]}, name


def test_faces_belong_to_the_body_behind_them() -> None:
    part = Composed(((10.0, 20), (6.0, 30)), bore=2)
    mesh = part.mesh()
    middles = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)].mean(axis=1)
    bodies = part.body_of_faces(mesh)
    for z, body in zip(1e3 * middles[:, 2], bodies, strict=True):
        if z < 20 - 1e-6:
            assert body == 0
        elif z > 20 + 1e-6:
            assert body == 1
    shoulder = np.abs(1e3 * middles[:, 2] - 20) < 1e-6
    assert shoulder.any() and set(bodies[shoulder]) == {0}
    assert [b - a for a, b in pairwise(part.heights())] == [20, 30]


def test_round_walls_are_for_three_fingers_and_flat_sides_for_two() -> None:
    seen = taken_apart(PARTS["8"])
    assert opening_found(40, 3, seen["offered"]) == pytest.approx(40, abs=0.1)
    assert opening_found(60, 2, seen["offered"]) == pytest.approx(60, abs=0.1)
    assert opening_found(60, 3, seen["offered"]) != pytest.approx(60, abs=0.1)
    assert opening_found(40, 2, seen["offered"]) != pytest.approx(40, abs=0.1)
    assert opening_found(40, 3, [{"kind": "box", "widths": [40.0]}]) is None


@pytest.mark.parametrize(("low", "high"), [((16, 38), (20, 14)), ((16, 38), (20, 24)), ((25, 12), (17, 30))])
def test_a_cylinder_is_as_long_as_its_wall_though_its_bore_runs_on(low: tuple[int, int], high: tuple[int, int]) -> None:
    """Radius and height of two bodies [mm]: the bore's faces run through both and belong to one of the segments; fingers hold outer walls only."""
    end = low[1] + high[1]
    profile = [(10, 0), (low[0], 0), (low[0], low[1]), (high[0], low[1]), (high[0], end), (10, end)]
    mesh = turned(1e-3 * np.array(profile))
    found = {round(1e3 * fit.size[0]): fit for fit in fit_primitives(mesh, segment_mesh(mesh).labels)}
    for radius, height, middle in ((*low, low[1] / 2), (*high, low[1] + high[1] / 2)):
        fit = found[2 * radius]
        assert 1e3 * fit.size[2] == pytest.approx(height, abs=0.1)
        assert 1e3 * fit.T_mesh_primitive[2, 3] == pytest.approx(middle, abs=0.1)
