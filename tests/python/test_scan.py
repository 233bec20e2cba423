"""`mmgrasp scan`: the map is the library's own, bit for bit, however often the run was interrupted."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import mmgrasp as mg
from camera_poses import look_at
from frame_folders import (
    INTRINSICS,
    LAYOUTS,
    OPTIONS,
    PINHOLE,
    SCALES,
    contents,
    direct_map,
    names,
    run,
    save_png,
    shots,
    write_frames,
    write_npz,
    write_sensors,
)
from mmgrasp.cli import main
from mmgrasp.cli import scan as scan_command
from mmgrasp.cli.output_folder import LIST
from mmgrasp.frames import write_npz_frame
from mmgrasp.frames.poses import rigid
from mmgrasp.scan.objects import objects_on_plane, vertex_normals
from mmgrasp.scan.plane import supporting_plane

ALL_FILES = {"map.sdf", "progress.json", "mesh.ply", "objects.json", "report.html", LIST}
PICTURES = {"surface.png", "objects.png", "sensors.png"}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_map_is_that_of_the_library_bit_for_bit(layout: str, tmp_path: Path) -> None:
    taken = write_frames(tmp_path / "frames", layout)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    direct_map(taken, SCALES[layout]).save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()
    assert names(tmp_path / "map") == ALL_FILES


@pytest.mark.slow
def test_everything_is_written_and_fits_the_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "npz", 6)
    assert run(tmp_path / "frames", tmp_path / "map", "--json", pictures=True) == 0
    summary = json.loads(capsys.readouterr().out)
    assert names(tmp_path / "map") == ALL_FILES | PICTURES
    sdf = mg.ProbabilisticSdf.load(tmp_path / "map" / "map.sdf")
    points, normals, sigmas = sdf.points()
    mesh, _ = sdf.mesh()
    np.testing.assert_allclose(vertex_normals(mesh.vertices, mesh.triangles), normals, atol=1e-9)
    assert summary["map"]["frames"] == summary["added"] == 6 and summary["map"]["vertices"] == len(points)
    (row,) = summary["sensors"]
    parts = ("used", "out_of_range", "too_noisy", "too_slanted", "without_normal")
    assert row["measured"] == sum(row[key] for key in parts) and row["used"] > 0.8 * row["measured"]
    assert row["agreement"]["least"] > 0.7
    check_mesh(tmp_path / "map" / "mesh.ply", sdf, sigmas)
    page = (tmp_path / "map" / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 3 and "assumed are the noise" in page


def check_mesh(path: Path, sdf: mg.ProbabilisticSdf, sigmas: np.ndarray) -> None:
    """Read twice: by the library's own reader, and by hand for what that does not know."""
    mesh, _ = sdf.mesh()
    assert abs(len(mg.Mesh.load(path).triangles) - len(mesh.triangles)) < 10, "the reader drops those without an area"
    content = path.read_bytes()
    header, body = content.split(b"end_header\n", 1)
    kind = np.dtype([("xyz", "<f4", 3), ("rgb", "u1", 3), ("sigma", "<f4")])
    corners = np.frombuffer(body[: kind.itemsize * len(sigmas)], dtype=kind)
    assert f"element vertex {len(sigmas)}".encode() in header
    np.testing.assert_allclose(corners["xyz"], mesh.vertices, atol=1e-7)
    np.testing.assert_allclose(corners["sigma"], sigmas, rtol=1e-6)
    faces = np.frombuffer(body[kind.itemsize * len(sigmas) :], dtype=[("count", "u1"), ("corners", "<i4", 3)])
    assert (faces["count"] == 3).all() and np.array_equal(faces["corners"], mesh.triangles)
    brightness = corners["rgb"].astype(int).sum(axis=1)
    assert brightness[np.argmin(sigmas)] < brightness[np.argmax(sigmas)]


def test_objects_stand_where_they_were_put(tmp_path: Path) -> None:
    """Boxes of 12 x 8 x 6 and 6 x 6 x 10 cm on the plane z = 0, seen all around."""
    write_frames(tmp_path / "frames", "npz", 18)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    found = json.loads((tmp_path / "map" / "objects.json").read_text())
    np.testing.assert_allclose(found["plane"]["normal"], [0, 0, 1], atol=0.01)
    assert abs(found["plane"]["offset"]) < 0.002
    assert len(found["objects"]) == 2
    wanted = {0.06: ([0.10, 0.02, 0.03], [0.12, 0.08, 0.06]), 0.10: ([-0.12, -0.05, 0.05], [0.06, 0.06, 0.10])}
    for row in found["objects"]:
        height = min(wanted, key=lambda h: abs(h - row["size"][2]))
        centre, size = wanted.pop(height)
        np.testing.assert_allclose(row["pose"]["xyz"], centre, atol=0.004)
        np.testing.assert_allclose(row["size"], size, atol=0.006)
        lower, upper = (np.array(row["bounds"][key]) for key in ("lower", "upper"))
        assert np.all(lower < centre) and np.all(upper > centre) and row["points"] > 100
    assert not wanted


@pytest.mark.parametrize("layout", ["seven_scenes", "npz"])
def test_two_runs_give_the_bytes_of_one(layout: str, tmp_path: Path) -> None:
    whole, first = tmp_path / "whole", tmp_path / "first"
    write_frames(whole, layout, 5)
    write_frames(first, layout, 2)
    assert run(whole, tmp_path / "a") == 0
    assert run(first, tmp_path / "b") == 0
    once = (tmp_path / "b" / "map.sdf").read_bytes()
    assert run(first, tmp_path / "b") == 0, "nothing new"
    assert (tmp_path / "b" / "map.sdf").read_bytes() == once
    shutil.copytree(whole, first, dirs_exist_ok=True)
    assert run(first, tmp_path / "b") == 0
    for name in ALL_FILES - {"report.html", LIST}:  # the report's title is the folder
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name
    listed = [json.loads((tmp_path / folder / LIST).read_text())["files"] for folder in "ab"]
    assert listed[0].keys() == listed[1].keys()
    assert {name for name in listed[0] if listed[0][name] != listed[1][name]} == {"report.html"}


def test_every_nth_frame_and_the_rest_later(tmp_path: Path) -> None:
    taken = write_frames(tmp_path / "frames", "redwood", 5)
    assert run(tmp_path / "frames", tmp_path / "map", "--every", "2") == 0
    direct_map(taken[::2], 1000.0).save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    direct_map(taken[::2] + taken[1::2], 1000.0).save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()


def test_an_interrupted_run_goes_on_from_its_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C within the third frame: two are saved, and are not integrated again."""
    write_frames(tmp_path / "frames", "seven_scenes", 5)
    assert run(tmp_path / "frames", tmp_path / "whole") == 0
    monkeypatch.setattr(scan_command, "CHECKPOINT_SECONDS", 0.0)
    integrate, calls = mg.ProbabilisticSdf.integrate, []

    def interrupted(self: mg.ProbabilisticSdf, *arguments: Any, **keywords: Any) -> Any:
        calls.append(1)
        if len(calls) == 3:
            raise KeyboardInterrupt
        time.sleep(0.05)
        return integrate(self, *arguments, **keywords)

    monkeypatch.setattr(mg.ProbabilisticSdf, "integrate", interrupted)
    monkeypatch.setattr(scan_command._Checkpoints, "__call__", lambda self, scan: save_each(self, scan))
    assert run(tmp_path / "frames", tmp_path / "map") == 130
    assert names(tmp_path / "map") == {"partial_000002.sdf", "progress.json", LIST}
    monkeypatch.setattr(mg.ProbabilisticSdf, "integrate", integrate)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    assert contents(tmp_path / "map") == contents(tmp_path / "whole")


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_is_ended_in_its_first_seconds_saves_what_is_done(
    number: signal.Signals, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """The signal comes while the third frame goes into the map, which is finished first."""
    write_frames(tmp_path / "frames", "seven_scenes", 5)
    assert run(tmp_path / "frames", tmp_path / "whole") == 0
    integrate, calls = mg.ProbabilisticSdf.integrate, []

    def ended(self: mg.ProbabilisticSdf, *arguments: Any, **keywords: Any) -> Any:
        calls.append(1)
        report = integrate(self, *arguments, **keywords)
        if len(calls) == 3:
            os.kill(os.getpid(), number)
        return report

    monkeypatch.setattr(mg.ProbabilisticSdf, "integrate", ended)
    capfd.readouterr()
    assert run(tmp_path / "frames", tmp_path / "map") == 128 + number
    assert f": the map of 3 frames is in {tmp_path / 'map'}; the same command goes on\n" in capfd.readouterr().err
    assert names(tmp_path / "map") == {"partial_000003.sdf", "progress.json", LIST}
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    assert len(calls) == 5
    assert contents(tmp_path / "map") == contents(tmp_path / "whole")
    calls.clear()
    assert run(tmp_path / "frames", tmp_path / "map", "--start-over") == 128 + number
    assert contents(tmp_path / "map") == contents(tmp_path / "whole"), "begun anew, and thought better of at once"


def save_each(checkpoints: Any, scan: Any) -> None:
    """A checkpoint after every frame, whatever the clock says."""
    name = f"partial_{len(scan.frames):06d}.sdf"
    with checkpoints._folder.filled(added=True, replacing=scan_command.PARTIAL) as draft:
        scan_command._save(scan, draft, name)


@pytest.mark.slow
def test_ctrl_c_in_a_process_and_on(tmp_path: Path) -> None:
    write_frames(tmp_path / "frames", "seven_scenes", 60)
    out = tmp_path / "map"
    program = (
        "import os, signal, sys, mmgrasp.cli.scan as scan\nfrom mmgrasp.cli import main\n"
        "scan.CHECKPOINT_SECONDS, check = 0.0, scan._Checkpoints.__call__\n"
        "def interrupted(checkpoints, frames):\n"
        "    check(checkpoints, frames)\n"
        f"    if os.path.exists({str(out / 'progress.json')!r}): os.kill(os.getpid(), signal.SIGINT)\n"
        "scan._Checkpoints.__call__ = interrupted\nsys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", program, "scan", str(tmp_path / "frames"), "-o", str(out), *OPTIONS]
    process = subprocess.run([*command, "--no-pictures"], stderr=subprocess.PIPE, text=True, timeout=120)
    error = process.stderr
    assert process.returncode == 130 and "Traceback" not in error
    (partial,) = out.glob("partial_*.sdf")
    done = json.loads((out / "progress.json").read_text())
    assert done["map"] == partial.name and 0 < len(done["frames"]) < 60
    assert names(out) == {partial.name, "progress.json", LIST}
    assert run(tmp_path / "frames", out) == 0
    assert run(tmp_path / "frames", tmp_path / "whole") == 0
    assert contents(out) == contents(tmp_path / "whole")


def test_two_sensors_with_their_own_noise_and_mounting(tmp_path: Path) -> None:
    """Poses of the second are those of a link; the map is that of the same calls by hand."""
    taken = shots(4, 1000.0)
    mount = mg.pose([0.02, -0.03, 0.05], rpy=[0.1, -0.2, 0.3])
    frames = tmp_path / "frames"
    write_npz(frames, taken[:2], "fine")
    at = np.array([INTRINSICS[key] for key in ("fx", "fy", "cx", "cy")])
    links = [shot.T_world_camera @ np.linalg.inv(mount) for shot in taken[2:]]
    for k, (shot, T) in enumerate(zip(taken[2:], links, strict=True)):
        write_npz_frame(frames / f"wrist_{k}.npz", shot.raw / 1000.0, T, at, "wrist")
    (frames / "sensors.yaml").write_text(
        "version: 1\nsensors:\n"
        "  fine: {noise: {model: polynomial, constant: 0.0005}, systematic: 0.0003, pose_error: {translation: 0.001}}\n"
        "  wrist:\n    noise: {model: stereo, focal: 180, baseline: 0.05, disparity_sigma: 0.1}\n    range: [0.2, 1.5]\n"
        "    mounted_on: {link: wrist_link, pose: {xyz: [0.02, -0.03, 0.05], rpy: [0.1, -0.2, 0.3]}}\n"
    )
    assert run(frames, tmp_path / "map") == 0
    fine = mg.mapping.DepthCamera(PINHOLE, mg.mapping.DepthNoise(constant=0.0005), "fine", 0.0003)
    near = mg.mapping.PinholeCamera(160, 120, 180.0, 180.0, 79.5, 59.5, 0.2, 1.5)
    wrist = mg.mapping.DepthCamera(near, mg.mapping.DepthNoise.stereo(180, 0.05, 0.1), "wrist")
    sdf = mg.ProbabilisticSdf(voxel=0.004, truncation=0.02)
    image = mg.mapping.DepthImage
    for shot in taken[:2]:
        covariance = np.diag([1e-6] * 3 + [0.0] * 3)
        sdf.integrate(image(shot.raw / 1000.0, PINHOLE, shot.T_world_camera), fine, pose_covariance=covariance)
    for shot, T in zip(taken[2:], links, strict=True):
        sdf.integrate(image(shot.raw / 1000.0, near, T @ mount), wrist)
    sdf.save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()


def test_inverted_poses_are_said_and_can_be_told(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    taken = write_frames(tmp_path / "frames", "seven_scenes", 5)
    for k, shot in enumerate(taken):
        T = np.linalg.inv(shot.T_world_camera)
        np.savetxt(tmp_path / "frames" / f"frame-{k:06d}.pose.txt", T, fmt="%.17g")
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    error = capfd.readouterr().err
    assert "when the poses are inverted" in error and "poses of sensor 'camera' is camera_to_world" in error
    assert not (tmp_path / "map" / "map.sdf").exists()
    write_sensors(tmp_path / "frames", "poses: world_to_camera")
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    direct = direct_map(taken, 1000.0).points()[0]
    again = mg.ProbabilisticSdf.load(tmp_path / "map" / "map.sdf").points()[0]
    assert abs(len(again) - len(direct)) < 0.001 * len(direct)
    np.testing.assert_allclose(again.mean(axis=0), direct.mean(axis=0), atol=1e-5)


@pytest.mark.parametrize("wrong", [1, 2, 3, 4])
def test_one_inverted_pose_is_named(wrong: int, tmp_path: Path) -> None:
    """Left out where it contradicts what an earlier frame saw, else called doubtful; no other frame is."""
    taken = write_frames(tmp_path / "frames", "seven_scenes", 5)
    name = f"frame-{wrong:06d}"
    T = np.linalg.inv(taken[wrong].T_world_camera)
    np.savetxt(tmp_path / "frames" / f"{name}.pose.txt", T, fmt="%.17g")
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    content = json.loads((tmp_path / "map" / "progress.json").read_text())
    said = {row["name"]: row["reason"] for row in content["skipped"]}
    said |= {row["name"]: row["warning"] for row in content["frames"] if row["warning"]}
    ((named, reason),) = said.items()
    assert name in named and "when its own pose is inverted" in reason


def test_things_too_thin_for_the_voxels_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A standing plate of 5 mm, seen from both sides, comes out thicker than it is, and is told; one of 25 mm is not."""
    pinhole = mg.mapping.PinholeCamera(160, 120, 150.0, 150.0, 79.5, 59.5)
    for width, told in ((0.005, True), (0.025, False)):
        folder = tmp_path / f"{width}"
        folder.mkdir()
        plate = mg.LinkShape(mg.Box([width, 0.2, 0.16]), mg.pose([0, 0, 0.08]))
        scene = [mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)), plate]
        for k in range(12):
            eye = np.array([0.45 * np.cos(0.53 * k), 0.45 * np.sin(0.53 * k), 0.3])
            T = look_at(eye, np.array([0, 0, 0.06]))
            image = mg.mapping.render_depth(scene, pinhole, T, noise=0.001, seed=k + 1)
            write_npz_frame(folder / f"camera_{k:03d}.npz", image.depth, T)
        intrinsics = "{width: 160, height: 120, fx: 150, fy: 150, cx: 79.5, cy: 59.5}"
        noise = "{model: polynomial, constant: 0.001}"
        (folder / "sensors.yaml").write_text(
            f"version: 1\nsensors:\n  camera:\n    intrinsics: {intrinsics}\n    noise: {noise}\n"
        )
        assert run(folder, folder / "map", "--voxel", "0.004", "--truncation", "0.02") == 0
        printed = " ".join(capsys.readouterr().out.split())
        assert ("another one less than 16 mm behind it" in printed) == told, printed
        sdf = mg.ProbabilisticSdf.load(folder / "map" / "map.sdf")
        rays = np.array([[1.0, 0, 0.1], [-1.0, 0, 0.1]])
        hits = sdf.cast_rays(rays, -rays * [1, 0, 0])
        thick = hits.point[0, 0] - hits.point[1, 0]
        assert (thick > width + 0.003) == told, thick


@pytest.mark.slow
def test_fifty_real_frames(data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A kitchen, seen by a Kinect from about 1.8 m: options are chosen, all frames used, and the map is the library's."""
    frames = data / "clouds" / "tsdf_fusion" / "rgbd-frames"
    assert main(["scan", str(frames), "-o", str(tmp_path), "--json", "--every", "2"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["map"]["frames"] == 25 and summary["skipped"] == summary["doubtful"] == []
    assert summary["map"]["voxel"] == 0.004 and 0.02 <= summary["map"]["truncation"] <= 0.05
    (row,) = summary["sensors"]
    assert row["agreement"]["least"] > 0.7 and row["used"] > 0.7 * row["measured"]
    pinhole = mg.mapping.PinholeCamera(640, 480, 585.0, 585.0, 320.0, 240.0)
    camera = mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise.structured_light())
    sdf = mg.ProbabilisticSdf(voxel=0.004, truncation=summary["map"]["truncation"])
    for path in sorted(frames.glob("*.depth.png"))[::2]:
        pose = rigid(np.loadtxt(str(path).replace("depth.png", "pose.txt")), path.name)
        with Image.open(path) as image:
            depth = np.array(image) / 1000.0
        sdf.integrate(mg.mapping.DepthImage(depth, pinhole, pose), camera)
    sdf.save(tmp_path / "direct.sdf")
    assert (tmp_path / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()


@pytest.mark.slow
def test_open3d_frames_as_they_come(data: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Five frames with trajectory.log beside another log, intrinsics one folder up."""
    frames = data / "clouds" / "open3d" / "RGBD"
    assert main(["scan", str(frames), "-o", str(tmp_path), "--json", "--no-pictures"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["map"]["frames"] == 5 and summary["skipped"] == []
    assert summary["sensors"][0]["described_as"]["intrinsics"]["fx"] == 525.0
    assert summary["sensors"][0]["agreement"]["least"] > 0.8


def test_a_scan_does_not_write_into_a_plans_folder(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "npz", 1)
    (tmp_path / "map").mkdir()
    (tmp_path / "map" / "plan.json").write_text("{}")
    (tmp_path / "map" / LIST).write_text(json.dumps({"format": "mmgrasp-files", "files": [LIST, "plan.json"]}))
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    assert "written by another command" in capfd.readouterr().err
    assert names(tmp_path / "map") == {"plan.json", LIST}


def test_a_frame_more_is_added_and_one_that_is_gone_is_said(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    frames = tmp_path / "frames"
    write_frames(frames, "npz", 3)
    assert run(frames, tmp_path / "map") == 0
    (frames / "camera_000.npz").unlink()
    capfd.readouterr()
    assert run(frames, tmp_path / "map") == 0
    assert "no longer in the folder: camera_000.npz" in " ".join(capfd.readouterr().out.split())
    assert mg.ProbabilisticSdf.load(tmp_path / "map" / "map.sdf").frames == 3


def test_what_was_integrated_must_not_change(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    frames = tmp_path / "frames"
    taken = write_frames(frames, "seven_scenes", 3)
    assert run(frames, tmp_path / "map") == 0
    before = contents(tmp_path / "map")
    save_png(frames / "frame-000001.depth.png", taken[0].raw)
    assert run(frames, tmp_path / "map") == 2
    assert "frame-000001.depth.png: is in the map, but its image or pose has changed" in capfd.readouterr().err
    assert contents(tmp_path / "map") == before
    assert run(frames, tmp_path / "map", "--start-over") == 0
    assert contents(tmp_path / "map") != before


def test_a_slice_through_a_wall_is_no_supporting_plane() -> None:
    """A table of 40 x 30 cm before a wall of 2 x 2 m, noise of 3 mm: the best plane by points alone within 35 degrees cuts the wall."""
    rng = np.random.default_rng(5)
    table = np.column_stack([rng.uniform(-0.2, 0.2, 6000), rng.uniform(0.1, 0.4, 6000), np.zeros(6000)])
    wall = np.column_stack([rng.uniform(-1, 1, 200_000), np.zeros(200_000), rng.uniform(-1, 1, 200_000)])
    points = np.vstack([table, wall]) + rng.normal(0, 0.003, (206_000, 3))
    normals = np.repeat([[0.0, 0, 1], [0, 1, 0]], [6000, 200_000], axis=0) + rng.normal(0, 0.3, (206_000, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    guess = np.array([0.0, 0.5, 0.8])
    plane = supporting_plane(points, normals, guess, 0.61, 0.008, 0.012)
    assert plane is not None
    np.testing.assert_allclose(plane.normal, [0, 0, 1], atol=0.01)
    assert abs(plane.offset) < 0.002
    np.testing.assert_allclose(plane.size, [0.4, 0.3], atol=0.03)
    np.testing.assert_allclose(plane.T_world_plane[:3, 3], [0, 0.25, 0], atol=0.02)
    by_points = mg.mapping.fit_cuboids(points, up=guess, up_angle=0.61)
    assert abs(by_points.plane_normal[2]) < 0.95, "what this is for"
    assert supporting_plane(points, normals, -guess, 0.61, 0.008, 0.012) is None
    anyhow = supporting_plane(points, normals, None, 0.61, 0.008, 0.012)
    assert anyhow is not None
    np.testing.assert_allclose(anyhow.normal, [0, 1, 0], atol=0.01)


def test_boxes_that_touch_are_two_objects() -> None:
    """Side by side, of two heights: one cluster, but there is a crease where they meet."""
    low, high = ([0.10, 0.08, 0.04], [-0.05, 0.0]), ([0.10, 0.08, 0.10], [0.05, 0.0])
    scene = [mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0))]
    scene += [mg.LinkShape(mg.Box(size), mg.pose([*at, size[2] / 2])) for size, at in (low, high)]
    sdf = mg.ProbabilisticSdf(voxel=0.003, truncation=0.015)
    camera = mg.mapping.DepthCamera(PINHOLE, mg.mapping.DepthNoise(constant=0.0005))
    for k in range(14):
        eye = np.array([0.35 * np.cos(0.45 * k), 0.35 * np.sin(0.45 * k), 0.36])
        sdf.integrate(mg.mapping.render_depth(scene, PINHOLE, look_at(eye, np.array([0.0, 0.0, 0.03]))), camera)
    mesh, _ = sdf.mesh()
    normals = vertex_normals(mesh.vertices, mesh.triangles)
    found = objects_on_plane(mesh.vertices, normals, up=[0, 0, 1], eye=np.array([0, 0, 1.0]), voxel=0.003)
    assert len(found.objects) == 2
    for size, at in (low, high):
        thing = min(found.objects, key=lambda o: float(np.linalg.norm(o.T_world_box[:2, 3] - at)))
        np.testing.assert_allclose(thing.T_world_box[:2, 3], at, atol=0.006)
        np.testing.assert_allclose(thing.size, size, atol=0.008)
