"""Maps of surfaces whose files were changed behind a right checksum: each is refused by name, or read and usable."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at
from mmgrasp import mapping

HEADER = len(b"mmgrasp probabilistic sdf\n") + 4 + 8  # magic, version, length of the content


@pytest.fixture(scope="module")
def content(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, bytes]:
    """Header and content of a small map of two cameras, one with a systematic error."""
    pinhole = mapping.PinholeCamera(40, 30, 35, 35, 19.5, 14.5, 0.1, 3.0)
    noise = mapping.DepthNoise(constant=0.001)
    cameras = [
        mapping.DepthCamera(pinhole, noise, name="a"),
        mapping.DepthCamera(pinhole, noise, name="b", systematic=0.001),
    ]
    sdf = mg.ProbabilisticSdf(voxel=0.01, truncation=0.04)
    for k, camera in enumerate(cameras):
        image = mapping.render_depth(
            [mg.LinkShape(mg.Sphere(0.1))], pinhole, look_at(np.array([0.4, 0.1 * k, 0.1]), np.zeros(3))
        )
        sdf.integrate(image, camera)
    path = tmp_path_factory.mktemp("map") / "whole.sdf"
    sdf.save(path)
    data = path.read_bytes()
    assert zlib.crc32(data[HEADER:-4]) == struct.unpack("<I", data[-4:])[0]
    return data[:HEADER], data[HEADER:-4]


def changed(content: bytes, rng: np.random.Generator) -> bytes:
    """A few bytes replaced, cut out, doubled, or eight of them a number that breaks things; mostly near the beginning."""
    out = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        at = int(len(out) * rng.uniform() ** rng.choice([1, 6]))
        kind = rng.integers(4)
        if kind == 0:
            out[at : at + 1] = bytes([rng.integers(256)])
        elif kind == 1:
            del out[at : at + int(rng.integers(1, 200))]
        elif kind == 2:
            out[at:at] = out[at : at + int(rng.integers(1, 200))]
        else:
            number = rng.choice([np.nan, np.inf, -1.0, 0.0, 1e300, 5e-324])
            whole = int(rng.choice([-1, 2**31 - 1, 2**62, 0]))
            out[at : at + 8] = struct.pack("<d", number) if rng.uniform() < 0.5 else struct.pack("<q", whole)
    return bytes(out)


@pytest.mark.parametrize("seed", range(4))
def test_changed_maps_are_refused_or_usable(content: tuple[bytes, bytes], tmp_path: Path, seed: int) -> None:
    header, whole = content
    rng = np.random.default_rng(seed)
    path, again = tmp_path / "changed.sdf", tmp_path / "again.sdf"
    read = refused = 0
    for _ in range(400):
        text = changed(whole, rng)
        path.write_bytes(header[:-8] + struct.pack("<Q", len(text)) + text + struct.pack("<I", zlib.crc32(text)))
        try:
            sdf = mg.ProbabilisticSdf.load(path)
        except mg.IoError as refusal:
            assert "changed.sdf" in str(refusal)
            refused += 1
            continue
        read += 1
        assert sdf.frames >= 0
        mean, sigma, known = sdf.query(rng.uniform(-0.2, 0.2, (200, 3)))
        assert np.isfinite(mean[known]).all() and (sigma[known] >= 0).all()
        sdf.cast_rays(np.tile([0.4, 0.0, 0.1], (50, 1)), rng.uniform(-1, -0.1, (50, 3)))
        assert np.isfinite(sdf.points()[0]).all()
        sdf.save(path)
        mg.ProbabilisticSdf.load(path).save(again)
        assert again.read_bytes() == path.read_bytes()
    assert read > 20
    assert refused > 100
