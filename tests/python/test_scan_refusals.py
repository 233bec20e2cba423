"""`mmgrasp scan` of what is wrong: one message that names file, key, value and rule, and nothing lost."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from frame_folders import contents, direct_map, run, save_png, shots, write_frames, write_sensors
from mmgrasp.cli import main


@pytest.mark.parametrize(("scale", "piece"), [(1, "divided by 1000"), (1_000_000, "multiplied by 1000")])
def test_a_wrong_depth_scale_is_said_with_its_key(
    scale: int, piece: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_frames(tmp_path / "frames", "seven_scenes", 2)
    write_sensors(tmp_path / "frames", f"depth_scale: {scale}")
    assert run(tmp_path / "frames", tmp_path / "map") == 3
    out = " ".join(capfd.readouterr().out.split())
    assert "no frame could be used, 2 examined" in out and piece in out
    assert f"depth_scale of sensor 'camera' ({tmp_path / 'frames' / 'sensors.yaml'}:3) is {scale:g}" in out
    assert not (tmp_path / "map").exists()


def test_names_that_are_no_text(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """File names are bytes: one that is no UTF-8 is integrated, listed, found again, and harms no page or terminal."""
    frames = tmp_path / "frames"
    write_frames(frames, "npz", 2)
    odd = Path(os.fsdecode(os.fsencode(frames) + b"/\xff\x1b[31m<b>.npz"))
    (frames / "camera_000.npz").rename(odd)
    (frames / os.fsdecode(b"bad\xfe.npz")).write_bytes(b"")
    assert run(frames, tmp_path / "map") == 0
    assert run(frames, tmp_path / "map") == 0
    printed = capfd.readouterr()
    assert "(0 new)" in printed.out and "\x1b" not in printed.out + printed.err
    page = (tmp_path / "map" / "report.html").read_text()
    assert "bad\\udcfe.npz" in page and "<b>.npz" not in page


def test_nothing_usable_keeps_what_an_earlier_run_wrote(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "npz", 2)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    before = contents(tmp_path / "map")
    for path in (tmp_path / "frames").iterdir():
        path.write_bytes(b"")
    assert run(tmp_path / "frames", tmp_path / "map", "--start-over", "--json") == 3
    reported = json.loads(capfd.readouterr().out.split("report:")[-1].split("\n", 1)[-1])
    assert reported["map"] is None and len(reported["skipped"]) == 2
    assert contents(tmp_path / "map") == before


def test_frames_that_cannot_be_used_are_left_out_whole(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The map is that of the good ones, and each of the others is named with its reason."""
    frames = tmp_path / "frames"
    taken = write_frames(frames, "seven_scenes", 6)
    data = (frames / "frame-000001.depth.png").read_bytes()
    (frames / "frame-000001.depth.png").write_bytes(data[: len(data) // 2])
    (frames / "frame-000003.pose.txt").unlink()
    save_png(frames / "frame-000004.depth.png", np.zeros((120, 160), np.uint16))
    assert run(frames, tmp_path / "map") == 0
    out = " ".join(capfd.readouterr().out.split())
    for piece in (
        "3 frames in the map (3 new)",
        "skipped: frame-000001.depth.png: is truncated",
        "skipped: frame-000003.depth.png: half a frame: frame-000003.pose.txt is not there",
        "skipped: frame-000004.depth.png: no pixel is measured",
    ):
        assert piece in out
    direct_map([taken[0], taken[2], taken[5]], 1000.0).save(tmp_path / "direct.sdf")
    assert (tmp_path / "map" / "map.sdf").read_bytes() == (tmp_path / "direct.sdf").read_bytes()
    assert "is truncated" in (tmp_path / "map" / "report.html").read_text()


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (["--voxel", "0.005"], "--voxel 0.005: the map in"),
        (["--truncation", "0.03"], "--truncation 0.03: the map in"),
        (["--max-memory", "100"], "--max-memory 100: the map in"),
    ],
)
def test_other_options_do_not_go_on_with_a_map(
    more: list[str], message: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_frames(tmp_path / "frames", "npz", 1)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    before = contents(tmp_path / "map")
    capfd.readouterr()
    assert main(["scan", str(tmp_path / "frames"), "-o", str(tmp_path / "map"), *more]) == 2
    error = capfd.readouterr().err
    assert message in error and "--start-over" in error
    assert contents(tmp_path / "map") == before
    assert main(["scan", str(tmp_path / "frames"), "-o", str(tmp_path / "map"), "--no-pictures"]) == 0
    assert contents(tmp_path / "map") == before, "without options those of the map hold"


def test_other_sensors_do_not_go_on_with_a_map(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "seven_scenes", 2)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    write_sensors(tmp_path / "frames", "systematic: 0.001")
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    error = capfd.readouterr().err
    assert "systematic = 0.001: the map was made with 0.0" in error and "sensors.yaml:3" in error
    write_sensors(tmp_path / "frames", name="kinect")
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    error = capfd.readouterr().err
    assert "was integrated as a frame of sensor 'camera', and the sensors are kinect now" in error
    assert run(tmp_path / "frames", tmp_path / "frames") == 2
    assert "must be another folder than that of the frames" in capfd.readouterr().err


def spoil_version(out: Path) -> None:
    data = bytearray((out / "map.sdf").read_bytes())
    data[len(b"mmgrasp probabilistic sdf\n")] = 9
    (out / "map.sdf").write_bytes(bytes(data))


def spoil_progress(out: Path, **changes: Any) -> None:
    content = json.loads((out / "progress.json").read_text())
    (out / "progress.json").write_text(json.dumps(content | changes))


def spoil_sensor(out: Path) -> None:
    (frame,) = json.loads((out / "progress.json").read_text())["frames"]
    spoil_progress(out, frames=[frame | {"sensor": "other"}])


def other_map(out: Path) -> None:
    direct_map(shots(2, 1000.0), 1000.0).save(out / "map.sdf")


def coarser_map(out: Path) -> None:
    direct_map(shots(1, 1000.0), 1000.0, voxel=0.005).save(out / "map.sdf")


SPOILED = {
    "another version of the map": (spoil_version, "has version 9 of the format"),
    "a truncated map": (lambda out: (out / "map.sdf").write_bytes((out / "map.sdf").read_bytes()[:-9]), "truncated"),
    "no map": (lambda out: (out / "map.sdf").unlink(), "map.sdf"),
    "a map of more frames": (other_map, "holds 2 frames, progress.json names 1"),
    "a coarser map": (coarser_map, "has voxel = 0.005, progress.json says 0.004"),
    "another version of the list": (
        lambda out: spoil_progress(out, version=2),
        "this version of mmgrasp reads version 1",
    ),
    "something else": (lambda out: spoil_progress(out, format="x"), "is no progress of mmgrasp scan"),
    "frames that are none": (lambda out: spoil_progress(out, frames=[{"name": "a"}]), "frames[0]"),
    "a frame of another sensor": (spoil_sensor, "frames[0].sensor = 'other': is none of its sensors (camera)"),
    "a map elsewhere": (lambda out: spoil_progress(out, map="../map.sdf"), "must be a file in the same folder"),
    "no JSON": (lambda out: (out / "progress.json").write_text("{"), "is no valid JSON"),
}


@pytest.mark.parametrize("what", SPOILED)
def test_a_spoiled_map_is_said_and_can_be_made_anew(
    what: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_frames(tmp_path / "frames", "npz", 1)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    good = contents(tmp_path / "map")
    spoil, message = SPOILED[what]
    spoil(tmp_path / "map")
    assert run(tmp_path / "frames", tmp_path / "map") == 2
    error = capfd.readouterr().err
    assert message in error and error.endswith("make the map anew with --start-over, or choose another folder\n")
    assert run(tmp_path / "frames", tmp_path / "map", "--start-over") == 0
    assert contents(tmp_path / "map") == good


def test_a_map_too_large_for_its_memory(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "npz", 2)
    assert run(tmp_path / "frames", tmp_path / "map", "--max-memory", "1") == 2
    error = capfd.readouterr().err
    assert "camera_000.npz: max_memory = 1 MB: the map has" in error and "see --voxel and --max-memory" in error
    assert not (tmp_path / "map").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        *(["--voxel", "0"], ["--voxel", "-1"], ["--voxel", "nan"], ["--truncation", "1e9"], ["--every", "0"]),
        *(["--up", "0,0,0"], ["--up", "1,2"], ["--up", "up"], ["--max-memory", "0"], ["--every", "two"]),
    ],
)
def test_options_out_of_range(arguments: list[str], tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(["scan", str(tmp_path), "-o", str(tmp_path / "map"), *arguments])
    assert caught.value.code == 2 and arguments[0] in capfd.readouterr().err


def test_a_truncation_that_does_not_fit_its_voxel(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    write_frames(tmp_path / "frames", "npz", 1)
    command = ["scan", str(tmp_path / "frames"), "-o", str(tmp_path / "map"), "--voxel", "0.004"]
    assert main([*command, "--truncation", "0.01"]) == 2
    assert "truncation = 0.01" in capfd.readouterr().err
    assert main(["scan", str(tmp_path / "none"), "-o", str(tmp_path / "map")]) == 2
    assert main(["scan", str(tmp_path / "frames"), "-o", str(tmp_path / "map"), "--sensors", "/none.yaml"]) == 2
    assert "/none.yaml: cannot be read" in capfd.readouterr().err


def test_up_as_given(tmp_path: Path) -> None:
    """Given, or guessed where the world of the poses lies anyhow: the table is found both ways."""
    write_frames(tmp_path / "frames", "seven_scenes", 6)
    assert run(tmp_path / "frames", tmp_path / "map", "--up", "0,0,2") == 0
    found = json.loads((tmp_path / "map" / "objects.json").read_text())
    assert found["up"] == {"direction": [0, 0, 1], "from": "given"} and len(found["objects"]) == 2
    np.testing.assert_allclose(found["plane"]["normal"], [0, 0, 1], atol=0.01)
    assert run(tmp_path / "frames", tmp_path / "map") == 0
    guessed = json.loads((tmp_path / "map" / "objects.json").read_text())
    assert guessed["up"]["from"].startswith("it was guessed") and len(guessed["objects"]) == 2
    np.testing.assert_allclose(guessed["plane"]["normal"], [0, 0, 1], atol=0.01)
