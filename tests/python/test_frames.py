"""Folders of depth frames: what the readers give, and one clear message for everything that is wrong with them."""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mmgrasp as mg
from frame_folders import INTRINSICS, LAYOUTS, SCALES, problems, refused, save_png, write_frames
from mmgrasp.frames import open_frames, write_npz_frame
from mmgrasp.frames.depth_png import read_depth_png


@pytest.mark.parametrize("layout", LAYOUTS)
def test_depths_in_metres_and_poses_as_written(layout: str, tmp_path: Path) -> None:
    taken = write_frames(tmp_path, layout, 3)
    folder = open_frames(tmp_path)
    assert len(folder.frames) == 3 and problems(folder) == {}
    for frame, shot in zip(folder.frames, taken, strict=True):
        loaded = folder.read(frame)
        np.testing.assert_array_equal(loaded.image.depth, (shot.raw / SCALES[layout]).astype(np.float32))
        np.testing.assert_array_equal(loaded.image.T_world_camera, shot.T_world_camera)
        assert (loaded.camera.intrinsics.width, loaded.camera.intrinsics.fx) == (160, 180.0)
        assert loaded.camera.name == "camera"


# --- single images --------------------------------------------------------------------------------------------------------


def test_every_filter_of_a_png_is_undone() -> None:
    """Five rows, one of each filter, put together by hand."""
    rng = np.random.default_rng(1)
    pixels = rng.integers(0, 65536, (5, 7)).astype(np.uint16)
    rows = np.frombuffer(pixels.astype(">u2").tobytes(), np.uint8).astype(int).reshape(5, 14)
    data = b""
    for kind, row in enumerate(rows):
        left = np.concatenate([[0, 0], row[:-2]])
        up = rows[kind - 1] if kind else np.zeros(14, int)
        corner = np.concatenate([[0, 0], up[:-2]])
        guess = left + up - corner
        nearest = np.abs([guess - left, guess - up, guess - corner]).argmin(axis=0)
        paeth = np.where(nearest == 0, left, np.where(nearest == 1, up, corner))
        predicted = np.stack([np.zeros(14, int), left, up, (left + up) // 2, paeth])[kind]
        data += bytes([kind]) + np.asarray((row - predicted) % 256, dtype=np.uint8).tobytes()
    np.testing.assert_array_equal(read_depth_png(png(7, 5, 16, 0, data), "image"), pixels)


def png(width: int, height: int, bits: int, colour: int, rows: bytes) -> bytes:
    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, bits, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def spoil_truncated(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-40])


def spoil_flipped(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(bytes(data))


def into_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def into_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def interlace(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[28] = 1
    data[29:33] = struct.pack(">I", zlib.crc32(bytes(data[12:29])))
    path.write_bytes(bytes(data))


BAD_IMAGES: dict[str, tuple[Callable[[Path], object], str]] = {
    "truncated": (spoil_truncated, "is truncated: it ends after"),
    "damaged": (spoil_flipped, "is damaged: a checksum"),
    "empty": (lambda p: p.write_bytes(b""), "is no PNG file"),
    "no PNG": (lambda p: p.write_text("not an image"), "is no PNG file"),
    "8 bits": (lambda p: Image.new("L", (160, 120), 9).save(p), "is a PNG of 8 bits, greyscale"),
    "colour": (lambda p: Image.new("RGB", (160, 120)).save(p), "is a PNG of 8 bits, colour: depth images have 16 bits"),
    "too few rows": (lambda p: p.write_bytes(png(160, 120, 16, 0, b"\0" * 321)), "is damaged"),
    "too many rows": (lambda p: p.write_bytes(png(160, 120, 16, 0, b"\0" * 321 * 121)), "its rows have more bytes"),
    "no zlib": (lambda p: p.write_bytes(png(160, 120, 16, 0, b"").replace(b"x\x9c\x03", b"x\x9c\x04")), "is damaged"),
    "interlaced": (interlace, "is an interlaced PNG"),
    "other size": (lambda p: save_png(p, np.ones((60, 80), np.uint16)), "has 80 x 60 pixels, but the intrinsics"),
    "huge": (lambda p: p.write_bytes(png(2**31 - 1, 2**31 - 1, 16, 0, b"")), "pixels, must have 1 to"),
    "all zero": (lambda p: save_png(p, np.zeros((120, 160), np.uint16)), "no pixel is measured"),
    "all invalid": (lambda p: save_png(p, np.full((120, 160), 65535, np.uint16)), "no pixel is measured"),
    "a pipe": (into_pipe, "is no regular file"),
    "a folder": (into_folder, "cannot be read: "),
}


@pytest.mark.parametrize("what", BAD_IMAGES)
def test_a_bad_image_is_named_and_the_others_are_read(what: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "seven_scenes", 3)
    spoil, message = BAD_IMAGES[what]
    spoil(tmp_path / "frame-000000.depth.png")  # the first one, which must not decide for the others
    found = problems(open_frames(tmp_path))
    assert list(found) == ["frame-000000.depth.png"]
    assert message in found["frame-000000.depth.png"] and "frame-000000.depth.png" in found["frame-000000.depth.png"]


# --- poses ----------------------------------------------------------------------------------------------------------------

BAD_POSES = {
    "-inf -inf -inf -inf\n" * 4: "must be finite numbers (the tracking was lost there)",
    "-1.#IND 0 0 0\n" * 4: "must be finite numbers",
    "2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n": "is no rotation: largest entry of R^T R - 1 is 3",
    "1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n": "is a mirror image",
    "1 0 0 0\n0 1 0 0\n0 0 1 0\n1 2 3 1\n": "the last row must be 0 0 0 1, not 1 2 3 1",
    "1 0 0 0\n0 1 0 0\n0 0 1 0\n": "holds 12 numbers, must hold 4 x 4",
    "1 0 0 x\n": "'x' is no number",
    "1 0 0 1e300\n0 1 0 0\n0 0 1 0\n0 0 0 1\n": "within 1e6 m",
    "": "holds 0 numbers",
}


@pytest.mark.parametrize("text", BAD_POSES)
def test_a_bad_pose_is_named_and_the_others_are_read(text: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "seven_scenes", 2)
    (tmp_path / "frame-000001.pose.txt").write_text(text)
    found = problems(open_frames(tmp_path))
    assert list(found) == ["frame-000001.depth.png"]
    assert "frame-000001.pose.txt: " in found["frame-000001.depth.png"]
    assert BAD_POSES[text] in found["frame-000001.depth.png"]


def test_rounded_rotations_are_put_right(tmp_path: Path) -> None:
    taken = write_frames(tmp_path, "seven_scenes", 1)
    np.savetxt(tmp_path / "frame-000000.pose.txt", taken[0].T_world_camera, fmt="%.4f")
    folder = open_frames(tmp_path)
    T = folder.read(folder.frames[0]).image.T_world_camera
    np.testing.assert_allclose(T[:3, :3].T @ T[:3, :3], np.eye(3), atol=1e-12)
    np.testing.assert_allclose(T, taken[0].T_world_camera, atol=1e-4)


def test_half_frames_and_foreign_images_are_named(tmp_path: Path) -> None:
    taken = write_frames(tmp_path, "seven_scenes", 3)
    (tmp_path / "frame-000000.pose.txt").unlink()
    (tmp_path / "frame-000001.depth.png").unlink()
    save_png(tmp_path / "holiday.png", taken[0].raw)
    save_png(tmp_path / "frame-000002.color.png", taken[0].raw)
    assert problems(open_frames(tmp_path)) == {
        "frame-000000.depth.png": "frame-000000.depth.png: half a frame: frame-000000.pose.txt is not there",
        "frame-000001.depth.png": "frame-000001.depth.png: half a frame: there is a pose, but no depth image",
        "holiday.png": "holiday.png: foreign: depth images are called NAME.depth.png",
    }


# --- TUM ------------------------------------------------------------------------------------------------------------------


def test_tum_poses_between_two_timestamps(tmp_path: Path) -> None:
    """Half way of a turn of 0.4 rad about z and a metre along x; a third of another."""
    write_frames(tmp_path, "tum", 1)
    half = float(np.sin(0.2))
    truth = f"0.97 0 0 0 0 0 0 1\n1.03 1 0 0 0 0 {half!r} {float(np.cos(0.2))!r}\n"
    (tmp_path / "groundtruth.txt").write_text(truth)
    image = next((tmp_path / "depth").iterdir()).name
    (tmp_path / "depth.txt").write_text(f"1.0 depth/{image}\n")
    folder = open_frames(tmp_path)
    T = folder.read(folder.frames[0]).image.T_world_camera
    np.testing.assert_allclose(T, mg.pose([0.5, 0, 0], rpy=[0, 0, 0.2]), atol=1e-9)
    (tmp_path / "depth.txt").write_text(f"0.99 depth/{image}\n")
    folder = open_frames(tmp_path)
    T = folder.read(folder.frames[0]).image.T_world_camera
    np.testing.assert_allclose(T, mg.pose([1 / 3, 0, 0], rpy=[0, 0, 0.4 / 3]), atol=1e-9)


@pytest.mark.parametrize(
    ("truth", "message"),
    [
        ("", "groundtruth.txt: holds no pose"),
        ("# t\n1 0 0 0 0 0 0\n", "groundtruth.txt:2: has 7 columns, must have 8"),
        ("1 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n", "groundtruth.txt:2: timestamp 1 has another pose than in line 1"),
        ("1 0 0 0 0 0 0 0.5\n", "groundtruth.txt:1: the quaternion qx qy qz qw has norm 0.5"),
        ("1 nan 0 0 0 0 0 1\n", "groundtruth.txt:1: must be finite"),
        ("x 0 0 0 0 0 0 1\n", "groundtruth.txt:1: 'x' is no number"),
        ("-1 0 0 0 0 0 0 1\n", "groundtruth.txt:1: timestamp = '-1': must be a number of seconds"),
    ],
)
def test_bad_tum_poses(truth: str, message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "tum", 1)
    (tmp_path / "groundtruth.txt").write_text(truth)
    assert message in refused(tmp_path)


@pytest.mark.parametrize(
    ("listed", "message"),
    [
        ("1 depth/a.png\n1.0 depth/b.png\n", "depth.txt:2: timestamp 1.0 is that of line 1: must be given once"),
        ("1 depth/a.png x\n", "depth.txt:1: has 3 columns, must have 2"),
        ("1 ../a.png\n", "depth.txt:1: ../a.png: must lie below the folder"),
        ("1 /etc/passwd\n", "must lie below the folder"),
    ],
)
def test_bad_tum_lists(listed: str, message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "tum", 1)
    (tmp_path / "depth.txt").write_text(listed)
    assert message in refused(tmp_path)


def test_tum_images_far_from_any_pose_are_named(tmp_path: Path) -> None:
    write_frames(tmp_path, "tum", 2)
    listed = (tmp_path / "depth.txt").read_text().splitlines()
    late = listed[1].replace("1305031102.", "1305031109.").split()[0]
    (tmp_path / "depth.txt").write_text(f"{listed[1]}\n{late} {listed[2].split()[1]}\n2 depth/gone.png\n")
    found = problems(open_frames(tmp_path))
    assert len(found) == 2 and "half a frame" in found["depth/gone.png"]
    save_png(tmp_path / "depth" / "extra.png", np.ones((120, 160), np.uint16))
    assert "depth.txt does not name this image" in problems(open_frames(tmp_path))["depth/extra.png"]
    assert "groundtruth.txt has no pose within 0.05 s of its time" in found[listed[2].split()[1]]
    assert "s earlier)" in found[listed[2].split()[1]]


@pytest.mark.parametrize("name", ["associations.txt", "none"])
def test_tum_without_depth_txt(name: str, tmp_path: Path) -> None:
    """Times come from the pairs of rgb and depth, or from the images' own names."""
    write_frames(tmp_path, "tum", 3)
    rows = [line.split() for line in (tmp_path / "depth.txt").read_text().splitlines()[1:]]
    (tmp_path / "depth.txt").unlink()
    if name != "none":
        (tmp_path / name).write_text("".join(f"{t} rgb/{t}.png {t} {path}\n" for t, path in rows))
    folder = open_frames(tmp_path)
    assert [frame.name for frame in folder.frames] == [path for _, path in rows] and problems(folder) == {}
    save_png(tmp_path / "depth" / "extra.png", np.ones((120, 160), np.uint16))
    foreign = {"depth/extra.png": "depth/extra.png: foreign: its name is no timestamp"}
    assert problems(open_frames(tmp_path)) == (foreign if name == "none" else {})


# --- Redwood --------------------------------------------------------------------------------------------------------------


def test_redwood_frames_by_number(tmp_path: Path) -> None:
    """An image missing in the middle moves no pose to another image; without a certain number nothing is guessed."""
    taken = write_frames(tmp_path, "redwood", 4)
    (tmp_path / "depth" / "00002.png").unlink()
    folder = open_frames(tmp_path)
    assert [frame.name[-5] for frame in folder.frames] == ["0", "1", "3"]
    np.testing.assert_array_equal(folder.read(folder.frames[2]).image.T_world_camera, taken[3].T_world_camera)
    (tmp_path / "depth" / "00000.png").unlink()
    assert "has 4 poses for 2 numbered images in depth/: which belongs to which is not known" in refused(tmp_path)


def test_redwood_numbers_from_one_and_a_foreign_image(tmp_path: Path) -> None:
    taken = write_frames(tmp_path, "redwood", 3)
    for k in (2, 1, 0):
        (tmp_path / "depth" / f"{k:05d}.png").rename(tmp_path / "depth" / f"{k + 1:06d}-{k * 33333:012d}.png")
    save_png(tmp_path / "depth" / "cover.png", taken[0].raw)
    folder = open_frames(tmp_path)
    assert problems(folder) == {"depth/cover.png": "depth/cover.png: foreign: its name does not begin with a number"}
    for frame, shot in zip(folder.frames, taken, strict=False):
        np.testing.assert_array_equal(folder.read(frame).image.T_world_camera, shot.T_world_camera)


def test_a_redwood_pose_that_is_none_costs_its_frame_only(tmp_path: Path) -> None:
    write_frames(tmp_path, "redwood", 3)
    text = (tmp_path / "trajectory.log").read_text().splitlines()
    text[6:10] = ["nan nan nan nan"] * 4
    (tmp_path / "trajectory.log").write_text("\n".join(text))
    found = problems(open_frames(tmp_path))
    assert (
        list(found) == ["depth/00001.png"] and "trajectory.log:6: frame 1: must be finite" in found["depth/00001.png"]
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows[:-2], "trajectory.log:11: frame 2: is truncated"),
        (lambda rows: ["0 0"] + rows[1:], "trajectory.log:1: must hold three whole numbers"),
        (lambda rows: rows[:5] + rows[:5] + rows[10:], "trajectory.log:6: frame 0 has a pose already"),
        (lambda rows: rows[:1] + ["1 2 3"] + rows[2:], "trajectory.log:1: frame 0: holds 15 numbers"),
        (lambda rows: [], "trajectory.log: holds no pose"),
    ],
)
def test_bad_trajectories(change: Callable[[list[str]], list[str]], message: str, tmp_path: Path) -> None:
    write_frames(tmp_path, "redwood", 3)
    path = tmp_path / "trajectory.log"
    path.write_text("\n".join(change(path.read_text().splitlines())))
    assert message in refused(tmp_path)


def test_two_trajectories_are_not_chosen_from(tmp_path: Path) -> None:
    write_frames(tmp_path, "redwood", 1)
    (tmp_path / "trajectory.log").rename(tmp_path / "a.log")
    (tmp_path / "b.log").write_text((tmp_path / "a.log").read_text())
    assert "holds several trajectories (a.log, b.log): call the right one trajectory.log" in refused(tmp_path)


# --- npz ------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"depth": np.full((120, 160), np.nan)}, "no pixel is measured"),
        ({"depth": np.full((120, 160), -1.0)}, "depth = -1: must be 0 or more"),
        ({"depth": np.ones((120, 160, 3))}, "depth: must be numbers (height, width), is float64 (120, 160, 3)"),
        ({"depth": None}, "depth is missing"),
        ({"T_world_camera": np.eye(3)}, "T_world_camera: must be numbers (4, 4)"),
        ({"T_world_camera": np.full((4, 4), np.nan)}, "T_world_camera: must be finite"),
        ({"intrinsics": np.array([-180.0, 180, 79, 59])}, "intrinsics: fx = -180: must be positive"),
        ({"intrinsics": np.array([180.0, 180, 400, 59])}, "intrinsics: cx = 400: must lie in the image"),
        ({"intrinsics": None}, "intrinsics are missing"),
        ({"sigma": np.ones((2, 2))}, "sigma: must be numbers (120, 160)"),
        ({"T_world_cam": np.eye(4)}, "'T_world_cam': unknown key; did you mean T_world_camera?"),
        ({"depth": np.array([{}])}, "does not fit its"),
    ],
)
def test_bad_npz_frames(change: dict[str, np.ndarray | None], message: str, tmp_path: Path) -> None:
    at = np.array([180.0, 180, 79.5, 59.5])
    content: dict[str, np.ndarray | None] = {
        "depth": np.ones((120, 160)),
        "T_world_camera": np.eye(4),
        "intrinsics": at,
    }
    given = {key: value for key, value in (content | change).items() if value is not None}
    np.savez(tmp_path / "a.npz", **given)  # type: ignore[arg-type]
    (found,) = problems(open_frames(tmp_path)).values()
    assert found.startswith("a.npz: ") and message in found


def test_npz_frames_of_one_sensor_have_one_camera(tmp_path: Path) -> None:
    at = np.array([180.0, 180, 79.5, 59.5])
    write_npz_frame(tmp_path / "a.npz", np.ones((120, 160)), np.eye(4), at)
    write_npz_frame(tmp_path / "b.npz", np.ones((120, 160)), np.eye(4), at + [1, 0, 0, 0])
    write_npz_frame(tmp_path / "c.npz", np.ones((120, 160)), np.eye(4))
    write_npz_frame(tmp_path / "d.npz", np.ones((60, 80)), np.eye(4))
    found = problems(open_frames(tmp_path))
    assert list(found) == ["b.npz", "d.npz"] and "its intrinsics are not those of sensor 'camera'" in found["b.npz"]
    with pytest.raises(mg.InvalidInput, match="depth = -1: must be 0 or more"):
        write_npz_frame(tmp_path / "e.npz", np.full((2, 2), -1.0), np.eye(4), at)
    assert not (tmp_path / "e.npz").exists()


# --- folders --------------------------------------------------------------------------------------------------------------


def test_folders_that_hold_no_frames(tmp_path: Path) -> None:
    assert "is empty; looked for TUM RGB-D: groundtruth.txt" in refused(tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    error = refused(tmp_path)
    assert "has no layout that is known" in error
    for piece in ("Redwood / Open3D: depth/", "7-Scenes: *.depth.png", "npz: *.npz"):
        assert piece in error
    write_frames(tmp_path / "sequence", "redwood", 1)
    assert refused(tmp_path).endswith(f"; try {tmp_path / 'sequence'}")
    assert "is not there" in refused(tmp_path / "none")
    assert "is no folder" in refused(tmp_path / "notes.txt")
    write_frames(tmp_path, "seven_scenes", 1)
    write_frames(tmp_path, "npz", 1)
    assert "has the layouts of several kinds of data" in refused(tmp_path)


def test_the_format_page_shows_every_key() -> None:
    """docs/frames_format.md and the readers name the same keys."""
    from conftest import REPOSITORY
    from mmgrasp.frames.npz import KEYS
    from mmgrasp.frames.sensors import NOISES

    page = (REPOSITORY / "docs" / "frames_format.md").read_text()
    wanted = "folder intrinsics range depth_scale noise systematic systematic_scale mounted_on poses pose_error".split()
    for key in (*wanted, *KEYS, *NOISES, *INTRINSICS):
        assert f"`{key}`" in page, key
