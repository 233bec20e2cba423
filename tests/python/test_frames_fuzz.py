"""Files of frames that are cut short or damaged are read or refused with a message, nothing else."""

from __future__ import annotations

import json
import random
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import mmgrasp as mg
from file_fuzz import SCRAPS
from frame_folders import WRITERS, Shot, shots, write_frames, write_sensors
from key_fuzz import changed, tries
from mmgrasp.frames import open_frames
from mmgrasp.scan import Scan, ScanOptions, integrate_frames, read_scan, scan_to_dict

pytestmark = pytest.mark.slow


def read_all(folder: Path) -> tuple[int, int]:
    """How many frames were read, and how many refused; anything else that is raised is raised here."""
    good = bad = 0
    try:
        frames = open_frames(folder)
    except mg.Error as error:
        assert str(error), "an error without a word"
        return 0, 1
    for frame in frames.frames:
        try:
            loaded = frames.read(frame)
            assert (loaded.image.depth >= 0).all()
            good += 1
        except mg.Error as error:
            assert str(error), "an error without a word"
            bad += 1
    return good, bad


def damaged(data: bytes, draw: random.Random) -> Iterator[bytes]:
    """Cut at every hundredth of the length, bytes flipped, scraps put in, parts doubled."""
    for k in range(100):
        yield data[: len(data) * k // 100]
    for _ in range(60):
        out = bytearray(data)
        for _ in range(draw.choice([1, 1, 4, 30])):
            out[draw.randrange(len(out))] = draw.randrange(256)
        yield bytes(out)
    for _ in range(60):
        a = draw.randrange(len(data) + 1)
        b = min(len(data), a + draw.choice([0, 1, 5, 40]))
        scrap = draw.choice(SCRAPS).encode("utf-8", "surrogatepass")
        yield data[:a] + draw.choice([scrap, data[a:b] * 2]) + data[b:]


def tiny(taken: list[Shot]) -> list[Shot]:
    """Every tenth pixel, so that thousands of files are read in seconds."""
    return [Shot(shot.raw[::10, ::10].copy(), shot.T_world_camera, shot.quat_xyzw) for shot in taken]


@pytest.mark.slow
@pytest.mark.parametrize("layout", WRITERS)
def test_damaged_files_of_every_layout(layout: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = {"width": 16, "height": 12, "fx": 18.0, "fy": 18.0, "cx": 7.5, "cy": 5.5}
    monkeypatch.setattr("frame_folders.INTRINSICS", small)
    WRITERS[layout](tmp_path, tiny(shots(2, 5000.0 if layout == "tum" else 1000.0)))
    if layout != "tum":
        text = (
            "systematic: 0.001\nnoise: {model: stereo, focal: 18, baseline: 0.1, disparity_sigma: 0.1}\nrange: [0.1, 3]"
        )
        write_sensors(tmp_path, text, intrinsics=False)
    assert read_all(tmp_path) == (2, 0)
    draw = random.Random(7)
    files = sorted(p for p in tmp_path.rglob("*") if p.is_file())
    kinds = {path.suffix + path.name[:3]: path for path in files}  # one of each kind
    assert len(kinds) >= 3 or layout == "npz"
    for path in kinds.values():
        whole = path.read_bytes()
        bad = 0
        for data in damaged(whole, draw):
            path.write_bytes(data)
            bad += read_all(tmp_path)[1]
        path.write_bytes(whole)
        assert bad > 20, f"{path.name}: hardly anything was refused"
    assert read_all(tmp_path) == (2, 0)


def fuzz(path: Path, read: Callable[[], object]) -> int:
    whole = path.read_bytes()
    refused = 0
    for data in damaged(whole, random.Random(3)):
        path.write_bytes(data)
        try:
            read()
        except mg.Error as error:
            assert str(error), "an error without a word"
            refused += 1
    path.write_bytes(whole)
    return refused


def test_damaged_progress(tmp_path: Path) -> None:
    """The list beside a map, read and gone on with."""
    write_frames(tmp_path / "frames", "npz", 2)
    scan = Scan.begin(ScanOptions(0.02, 0.1, 2e9))
    integrate_frames(open_frames(tmp_path / "frames"), scan)
    scan.sdf.save(tmp_path / "map.sdf")
    path = tmp_path / "progress.json"
    path.write_text(json.dumps(scan_to_dict(scan, "map.sdf"), indent=1))
    assert read_scan(path).frames == scan.frames

    def go_on() -> None:
        integrate_frames(open_frames(tmp_path / "frames"), read_scan(path))

    go_on()
    assert fuzz(path, go_on) > 100
    assert fuzz(tmp_path / "map.sdf", go_on) > 100


def test_wrong_values_in_progress(tmp_path: Path) -> None:
    """A value of the list that is wrong is told with the file and its key, whether reading it or comparing with the frames finds it out."""
    write_frames(tmp_path / "frames", "npz", 2)
    write_sensors(tmp_path / "frames")
    scan = Scan.begin(ScanOptions(0.02, 0.1, 2e9))
    integrate_frames(open_frames(tmp_path / "frames"), scan)
    scan.sdf.save(tmp_path / "map.sdf")
    document, path = scan_to_dict(scan, "map.sdf"), tmp_path / "progress.json"
    refused = 0
    for place, value in random.Random(1).sample(tries(document), 500):
        path.write_text(json.dumps(changed(document, place, value)))
        try:
            integrate_frames(open_frames(tmp_path / "frames"), read_scan(path))
        except mg.Error as error:
            names = [key for key in place if isinstance(key, str) and key != "camera"]
            assert "progress.json" in str(error) and names[-1] in str(error), (place, value, str(error))
            refused += 1
    assert refused > 300
