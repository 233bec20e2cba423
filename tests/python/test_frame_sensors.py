"""Sensors' files and intrinsics: what they say, and one message for everything that is wrong with them."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from frame_folders import problems, refused, write_frames, write_sensors
from mmgrasp.frames import open_frames


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("depth_scal: 1000", "sensors.camera.depth_scal: unknown key; did you mean depth_scale?"),
        ("depth_scale: -5", "sensors.camera.depth_scale = -5: must be > 0"),
        ("depth_scale: .nan", "depth_scale = nan: must be finite"),
        ("range: [2, 1]", "must be [nearest, farthest] with farthest above nearest"),
        ("range: [1, 2, 3]", "must be a list of 2 numbers"),
        ("noise: {model: laser}", "must be one of structured_light, time_of_flight, stereo, polynomial"),
        ("noise: {model: structured_light, sigma: 1}", "noise.sigma: unknown key"),
        ("noise: {model: stereo, baseline: 0.05}", "noise: disparity_sigma is missing"),
        ("noise: {model: polynomial, constant: -1}", "standard deviation"),
        ("systematic: -0.1", "systematic = -0.1: must be >= 0"),
        ("poses: camera_to_map", "must be one of camera_to_world, world_to_camera"),
        ("pose_error: {translation: x}", "must be a number"),
        ("mounted_on: {link: a}", "mounted_on: pose is missing"),
        ("mounted_on: {link: a, pose: {xyz: [0, 0, 0], quat_xyzw: [0, 0, 0, 2]}}", "must have norm 1"),
        ("folder: ../other", "must be a folder below that of the frames"),
        ("intrinsics: {fx: 1}", "intrinsics: is given twice"),
        ("noise: [", "is no valid YAML"),
    ],
)
def test_bad_sensors_files(lines: str, message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "npz", 1)
    write_sensors(tmp_path, lines)
    error = refused(tmp_path)
    assert message in error and "sensors.yaml:" in error


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("sensors: {}", "version is missing"),
        ("version: 2\nsensors: {a: {}}", "this version of mmgrasp reads version 1"),
        ('version: 1\nsensors: {"a\\e[31m": {}}', "must have 1 to 200 printable characters"),
        ('version: 1\nsensors: {"": {}}', "must have 1 to 200 printable characters"),
        ("version: 1\nsensors: {}", "must name at least one sensor"),
        ("version: 1\nsensors: [a]", "must be a mapping"),
        ("just a text", "must be a mapping"),
        ("\x00", "is no valid YAML"),
        ("version: 1\nsensors: {a: {intrinsics: {fx: -1, fy: 1, cx: 0, cy: 0}}}", "fx = -1: must be positive"),
        ("version: 1\nsensors: {a: {intrinsics: {fx: 1, fy: 1, cx: 0, cy: 0, width: 2}}}", "give width and height"),
    ],
)
def test_texts_that_are_no_sensors_file(text: str, message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "npz", 1)
    (tmp_path / "sensors.yaml").write_text(text)
    assert message in refused(tmp_path)


def test_sensors_of_one_folder_and_unknown_ones(tmp_path: Path) -> None:
    write_frames(tmp_path, "npz", 1)
    write_sensors(tmp_path, name="kamera")
    (found,) = problems(open_frames(tmp_path)).values()
    assert found == "camera_000.npz: sensor = 'camera': unknown; did you mean kamera?"
    (tmp_path / "camera_000.npz").unlink()
    write_frames(tmp_path, "seven_scenes", 1)
    (tmp_path / "sensors.yaml").write_text("version: 1\nsensors: {a: {}, b: {}}\n")
    assert "folder = .: is that of several sensors (a, b)" in refused(tmp_path)


def test_sensors_in_folders_of_their_own(tmp_path: Path) -> None:
    write_frames(tmp_path / "left", "seven_scenes", 2)
    write_frames(tmp_path / "right", "tum", 1)
    (tmp_path / "right" / "sensors.yaml").unlink()
    at = "{width: 160, height: 120, fx: 180, fy: 180, cx: 79.5, cy: 59.5}"
    text = f"version: 1\nsensors:\n  a: {{folder: left}}\n  b: {{folder: right, intrinsics: {at}, depth_scale: 2500}}\n"
    (tmp_path / "sensors.yaml").write_text(text)
    folder = open_frames(tmp_path)
    assert [(f.sensor, f.name.split("/")[0]) for f in folder.frames] == [("a", "left"), ("a", "left"), ("b", "right")]
    near, far = (float(np.median(folder.read(folder.frames[k]).image.depth)) for k in (0, 2))
    assert far == pytest.approx(2 * near, rel=0.01) and problems(folder) == {}
    (tmp_path / "left").rename(tmp_path / "links")
    assert "left: cannot be read: is no folder" in refused(tmp_path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("camera-intrinsics.txt", "-180 0 79\n0 180 59\n0 0 1", "fx = -180: must be positive"),
        ("camera-intrinsics.txt", "180 1 79\n0 180 59\n0 0 1", "has a skew of 1"),
        ("camera-intrinsics.txt", "180 0 0\n0 180 0\n79 59 1", "must hold rows fx 0 cx, 0 fy cy, 0 0 1"),
        ("camera-intrinsics.txt", "180 0 320\n0 180 240\n0 0 1", "cx = 320: must lie in the image, between 0 and 159"),
        ("camera-intrinsics.txt", "180 0 79", "holds 3 numbers, must hold 3 x 3"),
        ("camera.json", "{", "is no valid JSON"),
        ("camera.json", '{"width": 160, "height": 120}', "intrinsic_matrix is missing"),
        (
            "camera.json",
            json.dumps({"width": 160, "height": 120, "intrinsic_matrix": [1] * 9}),
            "must hold the columns",
        ),
        (
            "camera.json",
            json.dumps({"width": 0, "height": 1, "intrinsic_matrix": [1, 0, 0, 0, 1, 0, 0, 0, 1]}),
            "width = 0",
        ),
    ],
)
def test_bad_intrinsics(name: str, text: str, message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "seven_scenes", 1)
    (tmp_path / "camera-intrinsics.txt").unlink()
    (tmp_path / name).write_text(text)
    error = refused(tmp_path)
    assert message in error and name in error


def test_intrinsics_that_are_missing_or_given_twice(tmp_path: Path) -> None:
    write_frames(tmp_path / "a", "seven_scenes", 1)
    (tmp_path / "a" / "camera.json").write_text("{}")
    assert "holds several files of intrinsics (camera.json, camera-intrinsics.txt)" in refused(tmp_path / "a")
    for path in (tmp_path / "a").glob("camera*"):
        path.unlink()
    error = refused(tmp_path / "a")
    assert "intrinsics of sensor 'camera' are missing; looked for camera-intrinsics.txt" in error
    example = "version" + error.split("\nversion")[1]
    (tmp_path / "a" / "sensors.yaml").write_text(example.replace("319.5", "79.5").replace("239.5", "59.5"))
    assert problems(open_frames(tmp_path / "a")) == {}, "the message's own example is read"
