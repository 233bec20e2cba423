"""The reachability database from Python: its files with numpy alone, its queries against forward kinematics."""

from __future__ import annotations

import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg


@pytest.fixture(scope="module")
def saved(arm: mg.robot.JointGroup, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("reach") / "arm.reach"
    mg.ReachDatabase.build(arm, samples=40_000, seed=3).save(folder)
    return folder


def chain_fk(meta: dict[str, Any], q: np.ndarray) -> np.ndarray:
    """Tool pose from the file alone, by the formula of docs/methods/reach.md."""

    def matrix(rows: Any) -> np.ndarray:
        T = np.eye(4)
        T[:3] = np.reshape(rows, (3, 4))
        return T

    T = matrix(meta["root"])
    for px, py, pz, cx, sx, m, o, s, t, column, _ in meta["chain"]:
        value = q[int(column)]
        c, n = np.cos(m * value + o), np.sin(m * value + o)
        step = np.array([[1, 0, 0, px], [0, cx, -sx, py], [0, sx, cx, pz], [0, 0, 0, 1]])
        turn = np.array([[c, -n, 0, 0], [n, c, 0, 0], [0, 0, 1, s * value + t], [0, 0, 0, 1]])
        T = T @ step @ turn
    return np.asarray(T @ matrix(meta["tip_pose"]))


def test_numpy_reads_the_files(arm: mg.robot.JointGroup, saved: Path) -> None:
    meta = json.loads((saved / "meta.json").read_text())
    files = {name: np.load(saved / name, mmap_mode="r") for name in meta["files"]}
    for name, entry in meta["files"].items():
        assert files[name].dtype == np.dtype(entry["dtype"])
        assert list(files[name].shape) == entry["shape"]
        data, chunk = (saved / name).read_bytes(), meta["chunk_bytes"]
        sums = [zlib.crc32(data[i : i + chunk]) for i in range(0, len(data), chunk)]
        assert sums == entry["crc32_of_chunks"]
    text = (saved / "meta.json").read_bytes()
    assert zlib.crc32(text[: text.rindex(b'"crc32"')]) == meta["crc32"]

    stored = files["configurations.npy"]
    q = np.array(meta["joint_lower"]) + np.array(meta["joint_step"]) * stored
    assert np.all(q >= arm.lower) and np.all(q <= arm.upper)
    cells, first = files["cell_first.npy"], files["position_first.npy"]
    assert cells[-1] == len(stored) == meta["size"]
    edge = meta["options"]["position_cell"]
    for i in np.random.default_rng(1).integers(len(stored), size=200):
        T = chain_fk(meta, q[i])
        np.testing.assert_allclose(T, arm.fk(q[i]), atol=1e-12)
        cell = np.searchsorted(cells, i, side="right") - 1
        position = np.searchsorted(first, cell, side="right") - 1
        np.testing.assert_array_equal(np.floor(T[:3, 3] / edge), files["positions.npy"][position])
    bytes_a_pose = sum(f.stat().st_size for f in saved.iterdir()) / len(stored)
    assert bytes_a_pose < 2 * arm.size + 12, "two bytes a joint, and tables that a small database does not spread"


def test_arrays_are_views_that_cannot_be_written(arm: mg.robot.JointGroup, saved: Path) -> None:
    db = mg.ReachDatabase.load(saved, arm)
    for name, array in db.arrays.items():
        np.testing.assert_array_equal(array, np.load(saved / f"{name}.npy"))
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
    kept = mg.ReachDatabase.load(saved).arrays["configurations"]
    assert kept.sum() > 0, "the array keeps its database"
    content = db.to_dict()
    assert content["size"] == len(db)
    assert content["options"]["samples"] == 40_000
    assert json.loads(json.dumps(content)) == json.loads(json.dumps(content))
    assert str(len(db)) in repr(db)


def test_another_robot_is_noticed(fetch: mg.Robot, arm: mg.robot.JointGroup, saved: Path) -> None:
    other = fetch.group("arm", tip="gripper_tcp")
    with pytest.raises(mg.IoError, match="list of joints"):
        mg.ReachDatabase.load(saved, other)
    assert mg.ReachDatabase.load(saved).difference(arm) == ""


def test_an_old_file_is_refused_with_a_hint(tmp_path: Path) -> None:
    (tmp_path / "old.reach").write_bytes(b"MMGREACH" + bytes(200))
    with pytest.raises(mg.IoError, match="build it again"):
        mg.ReachDatabase.load(tmp_path / "old.reach")


def test_solutions_are_exact_and_free(fetch: mg.Robot, arm: mg.robot.JointGroup, saved: Path) -> None:
    db = mg.ReachDatabase.load(saved, arm)
    checker = mg.CollisionChecker(fetch, mg.World(), arm)
    rng = np.random.default_rng(5)
    poses = np.array([arm.fk(rng.uniform(arm.sample_lower, arm.sample_upper)) for _ in range(50)])
    batch = db.solve_batch(arm, poses, checker=checker, count=4)
    solved = 0
    for T, found in zip(poses, batch, strict=True):
        np.testing.assert_array_equal(found, db.solve(arm, T, checker=checker, count=4))
        solved += len(found) > 0
        for q in found:
            np.testing.assert_allclose(arm.fk(q), T, atol=2e-4)
            assert checker.is_free(q)
    assert solved > 20


def test_base_poses_bring_the_tool_there(fetch: mg.Robot, arm: mg.robot.JointGroup, saved: Path) -> None:
    db = mg.ReachDatabase.load(saved, arm)
    world = mg.World()
    world.add_box("table", size=(0.6, 1.0, 0.5), pose=mg.pose([2.0, 1.0, 0.25]))
    checker = mg.CollisionChecker(fetch, world, arm)
    target = mg.pose([1.9, 1.0, 0.75], rpy=[0, np.pi / 2, 0])
    bases, configurations = db.base_poses_for(arm, target, count=10, checker=checker)
    assert 0 < len(bases) == len(configurations) <= 10
    targets = np.array([target, mg.pose([1.8, 0.8, 0.8], rpy=[0, np.pi / 2, 0.4])])
    placement = db.find_base_placement(arm, targets, checker=checker)
    assert placement.reached == 2
    assert "2 of 2" in repr(placement) and placement.to_dict()["reached"] == 2
    pairs = [(b, q, target) for b, q in zip(bases, configurations, strict=True)]
    pairs += [(placement.base_pose, q, T) for q, T in zip(placement.configurations, targets, strict=True)]
    for base, q, T in pairs:
        T_world_base = mg.pose([base[0], base[1], 0], rpy=[0, 0, base[2]])
        np.testing.assert_allclose(T_world_base @ arm.fk(q), T, atol=2e-4)
        standing = mg.World()
        standing.add_box("table", size=(0.6, 1.0, 0.5), pose=np.linalg.inv(T_world_base) @ mg.pose([2.0, 1.0, 0.25]))
        assert mg.CollisionChecker(fetch, standing, arm).is_free(q)
