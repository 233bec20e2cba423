"""Obstacles that are drawn or that other programs wrote: floor plans, MoveIt's scenes, URDFs, clouds as PLY."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.documents.moveit_scene import read_scene_bodies
from mmgrasp.documents.ply_points import read_ply_points
from mmgrasp.problems.planning_scene import write_planning_scene

Write = Callable[..., Path]
UP = {"xyz": [0, 0, 20]}  # out of everybody's way


def shapes_of(write: Write, small: dict[str, Any], entry: dict[str, Any], **files: str | bytes) -> list[mg.LinkShape]:
    path = write({**small, "obstacles": [*small["obstacles"], {"name": "drawn", **entry}]})
    for name, content in files.items():
        file = path.parent / name.replace("__", ".")
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
    return next(o.shapes for o in mg.load_scenario(path).obstacles if o.name == "drawn")


def inside(shapes: list[mg.LinkShape], points: np.ndarray) -> np.ndarray:
    """Which points (n, 3) lie in a box or an upright cylinder."""
    within = np.zeros(len(points), dtype=bool)
    for shape in shapes:
        local = (points - shape.pose[:3, 3]) @ shape.pose[:3, :3]
        solid = shape.shape
        if isinstance(solid, mg.Box):
            within |= (np.abs(local) <= solid.size / 2).all(axis=1)
        else:
            assert isinstance(solid, mg.Cylinder)
            within |= (np.hypot(local[:, 0], local[:, 1]) <= solid.radius) & (np.abs(local[:, 2]) <= solid.length / 2)
    return within


def test_walls_are_what_lies_near_their_lines(small: dict[str, Any], write: Write) -> None:
    """Against the distance to the lines themselves, but for the flat ends."""
    lines = [[[0, 0], [4, 0], [4, 3], [1, 5]], [[6, 0], [8, 0], [7, 2], [6, 0]]]
    shapes = shapes_of(write, small, {"floor_plan": lines, "thickness": 0.2, "height": 2.5, "pose": UP})
    assert len(shapes) == 3 + 2 + 3 + 3
    rng = np.random.default_rng(3)
    points = rng.uniform([-1, -1, -0.5], [9, 6, 3], (20_000, 3))
    nearest = np.full(len(points), np.inf)
    beyond_ends = np.zeros(len(points), dtype=bool)
    for line in np.array(lines[0], float), np.array(lines[1], float):
        for a, b in itertools.pairwise(line):
            share = np.clip((points[:, :2] - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
            nearest = np.minimum(nearest, np.linalg.norm(points[:, :2] - a - share[:, None] * (b - a), axis=1))
    for end, way in (([0, 0], [-1, 0]), ([1, 5], [-3, 2])):
        off = points[:, :2] - end
        beyond_ends |= (off @ way > 0) & (np.linalg.norm(off, axis=1) < 0.2)
    wanted = (nearest <= 0.1) & (points[:, 2] >= 0) & (points[:, 2] <= 2.5)
    assert wanted.sum() > 500
    assert (inside(shapes, points) == wanted)[~beyond_ends].all()


def test_a_plan_keeps_off_drawn_walls(small: dict[str, Any], write: Write) -> None:
    far = [[[-2.4, -4], [-2.4, 4]]]
    path = write(
        {**small, "obstacles": [*small["obstacles"], {"name": "w", "floor_plan": far, "thickness": 0.05, "height": 1}]}
    )
    loaded = mg.load_scenario(path)
    assert "w" in loaded.world.objects


def test_a_scene_that_we_write_is_read_again(
    small: dict[str, Any], write: Write, fetch: mg.Robot, tmp_path: Path
) -> None:
    world = mg.World()
    world.add_box("shelf", size=(1, 2, 0.5), pose=mg.pose([1, 2, 3], rpy=[0.1, 0.2, 0.3]))
    world.add("can", mg.Cylinder(0.04, 0.2), mg.pose([0, 0, 1]))
    text = write_planning_scene(tmp_path / "s.yaml", fetch, world).read_text()
    shapes = shapes_of(write, small, {"scene": "s.yaml", "pose": UP}, s__yaml=text)
    assert {s.kind for s in shapes} == {"box", "cylinder"}
    box = next(s for s in shapes if s.kind == "box")
    np.testing.assert_allclose(box.pose, mg.pose([1, 2, 3], rpy=[0.1, 0.2, 0.3]), atol=1e-9)


OLD = """(noname)+
* crate
1
box
0.4 0.6 0.2
1 2 0.1
0 0 0.70710678 0.70710678
0 0 0 0
* post
2
cylinder
0.05 1.2
0 0 0.6
0 0 0 1
0 0 0 0
sphere
0.1
0 0 1.3
0 0 0 1
0 0 0 0
.
"""
NEW = """scene
* crate
1 2 0
0 0 0 1
1
box
0.4 0.6 0.2
0 0 0.1
0 0 0.70710678 0.70710678
0 0 0 0
1
top
0 0 0.2
0 0 0 1
.
"""


def test_scene_texts_old_and_new(small: dict[str, Any], write: Write, tmp_path: Path) -> None:
    (tmp_path / "old.scene").write_text(OLD)
    (tmp_path / "new.scene").write_text(NEW)
    old, new = read_scene_bodies(tmp_path / "old.scene"), read_scene_bodies(tmp_path / "new.scene")
    assert list(old) == ["crate", "post"] and list(new) == ["crate"]
    post = old["post"][0]
    assert isinstance(post[0].shape, mg.Cylinder) and (post[0].shape.radius, post[0].shape.length) == (0.05, 1.2)
    T = new["crate"][1]
    assert T is not None
    np.testing.assert_allclose(T @ new["crate"][0][0].pose, old["crate"][0][0].pose)
    shapes = shapes_of(write, small, {"scene": "a.scene", "pose": UP}, a__scene=OLD)
    assert [s.kind for s in shapes] == ["box", "cylinder", "sphere"]


URDF = """<robot name="rack">
  <link name="foot"><collision><geometry><box size="0.5 0.5 0.1"/></geometry></collision></link>
  <link name="door"><collision><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
  <joint name="hinge" type="revolute"><parent link="foot"/><child link="door"/><origin xyz="0.2 0 0.05"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


def test_a_urdf_is_its_collision_shapes(small: dict[str, Any], write: Write) -> None:
    shapes = shapes_of(write, small, {"urdf": "rack.urdf", "pose": UP}, rack__urdf=URDF)
    assert [s.kind for s in shapes] == ["box", "cylinder"]
    np.testing.assert_allclose(shapes[1].pose[:3, 3], [0.2, 0, 0.55], atol=1e-12)


def ply(points: np.ndarray, form: str) -> bytes:
    header = f"ply\nformat {form} 1.0\ncomment made here\nelement vertex {len(points)}\nproperty float x\nproperty uchar red\n"
    header += (
        "property double y\nproperty float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
    )
    order = {"ascii": "=", "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    table = np.zeros(len(points), [("x", order + "f4"), ("red", "u1"), ("y", order + "f8"), ("z", order + "f4")])
    table["x"], table["y"], table["z"] = points.T
    if form == "ascii":
        return header.encode() + b"".join(f"{x:.9g} 7 {y:.9g} {z:.9g}\n".encode() for x, y, z in points)
    return header.encode() + table.tobytes()


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_clouds_as_ply(small: dict[str, Any], write: Write, form: str) -> None:
    points = np.random.default_rng(1).uniform(-1, 1, (200, 3))
    shapes = shapes_of(write, small, {"cloud": "c.ply", "cell": 0.1, "pose": UP}, c__ply=ply(points, form))
    cells = np.unique(np.floor(points / 0.1), axis=0)
    assert sum(float(np.prod(s.shape.size)) for s in shapes if isinstance(s.shape, mg.Box)) == pytest.approx(
        len(cells) * 1e-3
    )
    assert inside(shapes, points).all()


def test_plys_of_the_shared_data(data: Path) -> None:
    """The vertices of a mesh, as the mesh reader has them."""
    files = sorted(data.glob("meshes/**/*.ply"))
    if not files:
        pytest.skip("no PLY among the shared data")
    for file in files[:3]:
        points = read_ply_points(file)
        mesh = mg.Mesh.load(file)
        np.testing.assert_allclose(points.min(axis=0), np.asarray(mesh.vertices).min(axis=0), atol=1e-6)
        np.testing.assert_allclose(points.max(axis=0), np.asarray(mesh.vertices).max(axis=0), atol=1e-6)


@pytest.mark.parametrize(
    ("entry", "files", "words"),
    [
        ({"floor_plan": [[[0, 0], [1, 0]]], "height": 1}, {}, "thickness is missing"),
        ({"floor_plan": [[[0, 0], [1, 0]]], "thickness": 0.1}, {}, "height is missing"),
        ({"floor_plan": [[[0, 0]]], "thickness": 0.1, "height": 1}, {}, "at least two points"),
        ({"floor_plan": [], "thickness": 0.1, "height": 1}, {}, "at least one line"),
        ({"floor_plan": [[[0, 0], [0, 0]]], "thickness": 0.1, "height": 1}, {}, "twice in a row"),
        ({"floor_plan": [[[0, 0, 0], [1, 0, 0]]], "thickness": 0.1, "height": 1}, {}, "2"),
        ({"floor_plan": [[[0, 0], [1, 0]]], "thickness": 0, "height": 1}, {}, "thickness"),
        ({"box": [1, 1, 1], "thickness": 0.1}, {}, "only a floor_plan has it"),
        ({"scene": "a.scene"}, {}, "no such file"),
        (
            {"scene": "a.scene"},
            {"a__scene": OLD.replace("0.05 1.2", "0.05")},
            r"a.scene:12: must hold 2 finite numbers",
        ),
        ({"scene": "a.scene"}, {"a__scene": OLD.replace("sphere", "cone")}, "shape 'cone' is none of"),
        ({"scene": "a.scene"}, {"a__scene": OLD.replace("\n.\n", "\n")}, "the line '.' is missing"),
        ({"scene": "a.scene"}, {"a__scene": "(noname)+\n.\n"}, "has no object"),
        ({"scene": "a.yaml"}, {"a__yaml": "world: {}\n"}, "collision_objects is missing"),
        ({"urdf": "rack.urdf"}, {"rack__urdf": "<robot/>"}, "urdf"),
        ({"urdf": "rack.urdf", "box": [1, 1, 1]}, {"rack__urdf": URDF}, "a urdf has no other shape"),
        ({"urdf": "r.urdf"}, {"r__urdf": '<robot name="a"><link name="b"/></robot>'}, "has no collision shapes"),
        ({"cloud": "c.ply", "cell": 0.1}, {"c__ply": "plx"}, "is no PLY file"),
        ({"cloud": "c.ply", "cell": 0.1}, {"c__ply": ply(np.ones((3, 3)), "ascii")[:-8]}, "c.ply"),
        (
            {"cloud": "c.ply", "cell": 0.1},
            {"c__ply": ply(np.ones((3, 3)), "binary_big_endian")[:-1]},
            "2 of 3 vertices",
        ),
        (
            {"cloud": "c.ply", "cell": 0.1},
            {"c__ply": ply(np.ones((1, 3)), "ascii").replace(b" z\n", b" w\n")},
            "x, y and z",
        ),
    ],
)
def test_bad_entries_are_refused_at_their_line(
    small: dict[str, Any], write: Write, entry: dict[str, Any], files: dict[str, Any], words: str
) -> None:
    with pytest.raises(mg.Error, match=words) as refused:
        shapes_of(write, small, entry, **files)
    assert "scenario.yaml" in str(refused.value) or "a.scene" in str(refused.value) or "a.yaml" in str(refused.value)
