"""`mmgrasp scan` with frames registered to the map, a gate for outliers and an octree: what the library does when called by hand."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from frame_folders import PINHOLE, Shot, contents, names, run, shots, write_npz, write_sensors
from mmgrasp.frames import open_frames

OFF, TURNED = 0.004, 0.006
SCALE = 1000.0


def displaced(taken: list[Shot]) -> list[Shot]:
    """The same images, all poses but the first off by some millimetres and milliradians."""
    rng = np.random.default_rng(3)
    out = taken[:1]
    for shot in taken[1:]:
        T = shot.T_world_camera.copy()
        T[:3, :3] = mg.pose([0, 0, 0], rpy=TURNED * rng.standard_normal(3))[:3, :3] @ T[:3, :3]
        T[:3, 3] += OFF * rng.standard_normal(3)
        out.append(Shot(shot.raw, T, shot.quat_xyzw))
    return out


def errors(poses: list[np.ndarray], taken: list[Shot]) -> np.ndarray:
    """How far the middle of what each frame sees, 0.45 m ahead, is from where it is [m]."""
    ahead = np.array([0, 0, 0.45, 1.0])
    return np.array([np.linalg.norm(((T - s.T_world_camera) @ ahead)[:3]) for T, s in zip(poses, taken, strict=True)])


def test_frames_are_moved_onto_the_map(tmp_path: Path) -> None:
    exact = shots(8, SCALE)
    write_npz(tmp_path / "frames", displaced(exact))
    write_sensors(tmp_path / "frames", f"pose_error: {{translation: {OFF}, rotation: {TURNED}}}")
    assert run(tmp_path / "frames", tmp_path / "map", "--register") == 0
    rows = json.loads((tmp_path / "map" / "progress.json").read_text())["frames"]
    poses = [np.array(row["T_world_camera"]) for row in rows]
    registered = [not row["warning"] for row in rows]
    assert registered[0] and sum(registered) >= 5
    before = errors([shot.T_world_camera for shot in displaced(exact)], exact)[registered]
    after = errors(poses, exact)[registered]
    assert np.mean(before**2) > 0.006**2 and np.mean(after**2) < 0.3 * np.mean(before**2)
    assert all(row["warning"].startswith("not registered: ") for row in rows if row["warning"])

    # The same by hand, bit for bit.
    folder = open_frames(tmp_path / "frames")
    sdf = mg.ProbabilisticSdf(voxel=0.004, truncation=0.02)
    for frame in folder.frames:
        loaded = folder.read(frame)
        image, covariance = loaded.image, loaded.pose_covariance
        assert covariance is not None
        if sdf.frames:
            found = mg.mapping.register_frame(sdf, image, loaded.camera, pose_covariance=covariance)
            image, covariance = mg.mapping.DepthImage(image.depth, PINHOLE, found.T_world_camera), found.covariance
        sdf.integrate(image, loaded.camera, pose_covariance=covariance)
    sdf.save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()


def test_two_runs_give_the_bytes_of_one(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Half of the frames first, then all of them."""
    exact = shots(6, SCALE)
    write_npz(tmp_path / "frames", displaced(exact))
    write_sensors(tmp_path / "frames", f"pose_error: {{translation: {OFF}, rotation: {TURNED}}}")
    later = tmp_path / "later"
    later.mkdir()
    for k in (3, 4, 5):
        (tmp_path / "frames" / f"camera_{k:03d}.npz").rename(later / f"camera_{k:03d}.npz")
    options = ("--register", "--outlier-gate", "5")
    assert run(tmp_path / "frames", tmp_path / "parts", *options) == 0
    for path in later.iterdir():
        path.rename(tmp_path / "frames" / path.name)
    capsys.readouterr()
    assert run(tmp_path / "frames", tmp_path / "parts", "--octree", "0.02") == 0  # the options are those of the map
    printed = " ".join(capsys.readouterr().out.split())
    assert "Frames were moved onto the map" in printed and "more than 5 standard deviations off" in printed
    assert run(tmp_path / "frames", tmp_path / "whole", "--octree", "0.02", *options) == 0
    for name in ("map.sdf", "progress.json", "occupancy.bt"):
        assert (tmp_path / "parts" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes(), name

    # The octree has its frames where they were registered.
    rows = json.loads((tmp_path / "whole" / "progress.json").read_text())["frames"]
    direct = mg.mapping.OccupancyMap(resolution=0.02)
    folder = open_frames(tmp_path / "frames")
    for frame, row in zip(folder.frames, rows, strict=True):
        loaded = folder.read(frame)
        direct.integrate(mg.mapping.DepthImage(loaded.image.depth, PINHOLE, row["T_world_camera"]), loaded.camera)
    direct.save(tmp_path / "direct.bt")
    assert (tmp_path / "whole" / "occupancy.bt").read_bytes() == (tmp_path / "direct.bt").read_bytes()


def test_slanted_surfaces_are_taken_where_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_npz(tmp_path / "frames", shots(4, SCALE))
    write_sensors(tmp_path / "frames")
    slanted, used = [], []
    for name, more in {"usual": (), "all": ("--max-incidence", "1.4")}.items():
        assert run(tmp_path / "frames", tmp_path / name, *more) == 0
        rows = json.loads((tmp_path / name / "progress.json").read_text())["frames"]
        slanted.append(sum(row["too_slanted"] for row in rows))
        used.append(sum(row["used"] for row in rows))
    assert 0 < 5 * slanted[1] < slanted[0] and used[1] - used[0] > 0.9 * (slanted[0] - slanted[1])
    sdf = mg.ProbabilisticSdf(voxel=0.004, truncation=0.02, max_incidence=1.4)
    folder = open_frames(tmp_path / "frames")
    for frame in folder.frames:
        loaded = folder.read(frame)
        sdf.integrate(loaded.image, loaded.camera)
    sdf.save(tmp_path / "direct.sdf")
    assert (tmp_path / "all" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()
    assert run(tmp_path / "frames", tmp_path / "all", "--max-incidence", "1.3") == 2
    assert "--max-incidence 1.3: the map in" in " ".join(capsys.readouterr().err.split())
    with pytest.raises(SystemExit):
        run(tmp_path / "frames", tmp_path / "other", "--max-incidence", "75")
    assert "must be a number from 0.1 to 1.5 rad" in " ".join(capsys.readouterr().err.split())


def test_a_sensor_without_a_pose_error_is_not_registered(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_npz(tmp_path / "frames", shots(3, SCALE))
    write_sensors(tmp_path / "frames")
    assert run(tmp_path / "frames", tmp_path / "map", "--register") == 2
    assert "has no pose_error: --register" in " ".join(capsys.readouterr().err.split())


def test_a_map_is_gone_on_with_as_it_was_begun(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_npz(tmp_path / "frames", shots(3, SCALE))
    write_sensors(tmp_path / "frames", f"pose_error: {{translation: {OFF}, rotation: {TURNED}}}")
    assert run(tmp_path / "frames", tmp_path / "map", "--outlier-gate", "4") == 0
    for more, said in {
        ("--register",): "--register: the map in",
        ("--outlier-gate", "5"): "--outlier-gate 5: the map in",
    }.items():
        assert run(tmp_path / "frames", tmp_path / "map", *more) == 2
        assert said in " ".join(capsys.readouterr().err.split())
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    (tmp_path / "map" / "progress.json").unlink()
    before = contents(tmp_path / "map")
    capsys.readouterr()
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    assert "there is no progress.json beside it" in " ".join(capsys.readouterr().err.split())
    assert contents(tmp_path / "map") == before
    for wrong in ("2", "nan", "-4"):
        with pytest.raises(SystemExit):
            run(tmp_path / "frames", tmp_path / "other", "--outlier-gate", wrong)
    assert "must be a number from 3 to 1000 standard deviations" in " ".join(capsys.readouterr().err.split())


def test_the_gate_keeps_speckles_out(tmp_path: Path) -> None:
    """One pixel in fifty 8 cm too near in every frame: without the gate all around them is as uncertain as at a rim."""
    rng = np.random.default_rng(5)
    taken = []
    for shot in shots(6, SCALE):
        raw = shot.raw.copy()
        wild = (rng.random(raw.shape) < 0.02) & (raw > 200)
        raw[wild] -= 80
        taken.append(Shot(raw, shot.T_world_camera, shot.quat_xyzw))
    write_npz(tmp_path / "frames", taken)
    write_sensors(tmp_path / "frames")
    measured = {}
    for name, more in {"without": (), "with": ("--outlier-gate", "4")}.items():
        assert run(tmp_path / "frames", tmp_path / name, *more) == 0
        sdf = mg.ProbabilisticSdf.load(tmp_path / name / "map.sdf")
        measured[name] = float(np.quantile(sdf.points()[2], 0.95))
        rows = json.loads((tmp_path / name / "progress.json").read_text())["frames"]
        assert all((row["outliers"] > 0.005 * row["measured"]) == bool(more) for row in rows)
    assert measured["with"] < 0.3 * measured["without"], measured


def test_the_octree_is_octomaps_own(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    taken = shots(4, SCALE)
    write_npz(tmp_path / "frames", taken)
    write_sensors(tmp_path / "frames")
    assert run(tmp_path / "frames", tmp_path / "map", "--octree", "0.02") == 0
    folder = open_frames(tmp_path / "frames")
    direct = mg.mapping.OccupancyMap(resolution=0.02)
    for frame in folder.frames:
        loaded = folder.read(frame)
        direct.integrate(loaded.image, loaded.camera)
    direct.save(tmp_path / "direct.bt")
    assert (tmp_path / "map" / "occupancy.bt").read_bytes() == (tmp_path / "direct.bt").read_bytes()
    # The air above the table is free, a box's top is occupied, what is below the table unknown.
    occupied, known = mg.mapping.OccupancyMap.load(tmp_path / "map" / "occupancy.bt").query(
        [[0.0, 0.0, 0.15], [-0.12, -0.05, 0.095], [0.0, 0.0, -0.1]]
    )
    assert known.tolist() == [True, True, False] and occupied.tolist()[:2] == [False, True]
    # What is refused leaves everything as it was; a later run without the option does not leave an old tree behind.
    before = contents(tmp_path / "map")
    assert run(tmp_path / "frames", tmp_path / "map", "--octree", "0.0002") == 2
    said = re.search(r"may have (\S+) cells with this frame, (\d+) MB", capsys.readouterr().err)
    assert said and contents(tmp_path / "map") == before
    # A frame sees a pyramid of 0.45 m and more over 0.89 x 0.67 of that.
    seen = 0.45**3 * (160 * 120) / (3 * 180**2) / 0.0002**3
    assert 0.7 * seen < float(said[1]) < 2 * seen
    (tmp_path / "frames" / "camera_001.npz").unlink()
    assert run(tmp_path / "frames", tmp_path / "map", "--octree", "0.02") == 2
    assert "camera_001.npz: is in the map, but no longer in the folder" in " ".join(capsys.readouterr().err.split())
    assert contents(tmp_path / "map") == before
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    assert "occupancy.bt" not in names(tmp_path / "map")
