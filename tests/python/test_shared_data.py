"""Every model in the reference data goes through the readers once: it loads, or is refused by name, place and reason."""

from __future__ import annotations

import struct
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg

MESHES = (".stl", ".obj", ".ply", ".dae")

# What is wrong with each is true: no other file may be refused.
REFUSED = {
    # FCL's own format: counts and bare numbers.
    "planning/fcl_resources/env.obj": ["line 1", "'6540' is no OBJ statement"],
    "planning/fcl_resources/rob.obj": ["line 1", "'648' is no OBJ statement"],
    # The end of one document written over the beginning of another one.
    "robots/kuka_iiwa/kuka_lbr_iiwa_support/meshes/lbr_iiwa_14_r820/visual/base_link.dae": ["line 495", "NUL byte"],
    # <robot> has no name.
    "robots/ridgeback/ridgeback_description/urdf/empty.urdf": [":1: <robot>", "attribute name is missing"],
}

PAIRS = {  # SRDF -> the URDF it belongs to
    "panda/moveit_resources_panda_moveit_config/config/panda.srdf": "panda/expanded/panda.urdf",
    "panda_vamp/panda/panda.srdf": "panda_vamp/panda/panda.urdf",
    "ur5_vamp/ur5/ur5.srdf": "ur5_vamp/ur5/ur5.urdf",
    "ur/ur5e_moveit_config/config/ur5e.srdf": "ur/expanded/ur5e.urdf",
    "ur/ur10e_moveit_config/config/ur10e.srdf": "ur/expanded/ur10e.urdf",
    "pr2/example-robot-data/robots/pr2_description/srdf/pr2.srdf": "pr2/example-robot-data/robots/pr2_description/urdf/pr2.urdf",
    "pr2/example-robot-data/robots/pr2_description/srdf/pr2_manipulation.srdf": "pr2/example-robot-data/robots/pr2_description/urdf/pr2.urdf",
    "tiago/tiago_moveit_config/config/srdf/tiago_pal-gripper.srdf": "tiago/example-robot-data/robots/tiago_description/robots/tiago.urdf",
    "tiago/tiago_moveit_config/config/srdf/tiago_no-ee.srdf": "tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf",
    "tiago/tiago_moveit_config/config/srdf/tiago_pal-hey5.srdf": "tiago/example-robot-data/robots/tiago_description/robots/tiago.urdf",
}


def files(data: Path, *suffixes: str) -> list[Path]:
    found = sorted(p for p in data.rglob("*") if p.suffix.lower() in suffixes and p.is_file())
    assert found
    return found


def refusals(data: Path, paths: list[Path], load: Any) -> dict[str, str]:
    refused = {}
    for path in paths:
        try:
            load(path)
        except mg.Error as error:
            refused[path.relative_to(data).as_posix()] = str(error)
            assert str(path) in str(error), "the message names the file"
    return refused


def expect_known(refused: dict[str, str], suffixes: tuple[str, ...]) -> None:
    assert sorted(refused) == sorted(name for name in REFUSED if name.lower().endswith(suffixes))
    for name, message in refused.items():
        for piece in REFUSED[name]:
            assert piece in message


def test_meshes_load_or_are_refused_for_the_right_reason(data: Path) -> None:
    expect_known(refusals(data, files(data, *MESHES), mg.Mesh.load), MESHES)


def surface(corners: np.ndarray) -> float:
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return 0.5 * float(np.linalg.norm(normals, axis=1).sum())


def test_binary_stl_keeps_its_surface(data: Path) -> None:
    """But for triangles that are there twice, of which it may have one, and corners that single precision had parted."""
    checked = exact = 0
    for path in files(data, ".stl"):
        content = path.read_bytes()
        count = struct.unpack_from("<I", content, 80)[0] if len(content) >= 84 else -1
        if len(content) != 84 + 50 * count:
            continue  # text
        facets = np.frombuffer(content, np.dtype([("f", "<f4", (4, 3)), ("a", "<u2")]), count, 84)["f"][:, 1:]
        mesh = mg.Mesh.load(path)
        assert len(mesh.triangles) <= count
        corners = np.unique(np.sort(facets.view([("x", "<f4"), ("y", "<f4"), ("z", "<f4")])[..., 0], axis=1), axis=0)
        once = np.stack([corners[name] for name in "xyz"], axis=-1).astype(float)
        joined = len(mesh.vertices) < len(np.unique(once.reshape(-1, 3), axis=0))
        slack = 2.0**-22 if joined else 1e-9
        least, most = (1 - slack) * surface(once), (1 + slack) * surface(facets.astype(float))
        exact += not joined
        assert least <= surface(mesh.vertices[mesh.triangles]) <= most
        checked += 1
    assert checked > 100 and exact > 0.8 * checked


def test_robots_load_or_are_refused_for_the_right_reason(data: Path) -> None:
    def load(path: Any) -> None:
        robot = mg.Robot.load(path, allow_missing_meshes=True)
        tree = ElementTree.parse(path).getroot()
        assert {e.get("name") for e in tree.findall("link")} == set(robot.links)
        assert {e.get("name") for e in tree.findall("joint")} == {joint["name"] for joint in robot.joint_table}

    expect_known(refusals(data, files(data, ".urdf"), load), (".urdf",))


def test_srdfs_load_with_their_robots(data: Path) -> None:
    robots = data / "robots"
    assert {p.relative_to(robots).as_posix() for p in files(data, ".srdf")} == set(PAIRS)
    for srdf, urdf in PAIRS.items():
        robot = mg.Robot.load(robots / urdf, robots / srdf, allow_missing_meshes=True)
        groups = [e.get("name") for e in ElementTree.parse(robots / srdf).getroot().findall("group")]
        dropped = [name for name in groups if name not in robot.groups]
        for name in dropped:
            assert any(f'"{name}"' in w and "dropped" in w for w in robot.report["warnings"])


def test_octomaps_load(data: Path) -> None:
    assert refusals(data, files(data, ".bt"), lambda path: mg.World().add_octree("map", path)) == {}


@pytest.mark.parametrize(
    "name", ["robots/panda/expanded/panda.urdf", "robots/kuka_iiwa/kuka_lbr_iiwa_support/urdf/lbr_iiwa_14_r820.urdf"]
)
def test_every_truncation_of_a_urdf_is_refused(data: Path, name: str, tmp_path: Path) -> None:
    path, whole = tmp_path / "cut.urdf", (data / name).read_bytes().rstrip()
    for percent in range(100):
        path.write_bytes(whole[: len(whole) * percent // 100])
        with pytest.raises(mg.Error, match=r"cut\.urdf"):
            mg.Robot.load(path, load_meshes=False)


@pytest.mark.parametrize(
    "name",
    [
        "robots/panda/moveit_resources_panda_description/meshes/collision/link3.stl",
        "robots/tiago/example-robot-data/robots/tiago_description/meshes/arm/arm_1_collision.dae",
    ],
)
def test_every_truncation_of_a_mesh_is_refused(data: Path, name: str, tmp_path: Path) -> None:
    whole = (data / name).read_bytes().rstrip()
    path = tmp_path / f"cut{Path(name).suffix}"
    for percent in range(100):
        path.write_bytes(whole[: len(whole) * percent // 100])
        with pytest.raises(mg.IoError, match=r"cut\.(stl|dae).*(truncated|is empty|no valid DAE)"):
            mg.Mesh.load(path)
