"""Writes PNG files with the standard library."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

from .._files import write_file


def png_bytes(image: np.ndarray) -> bytes:
    """A uint8 picture (height, width, 3) as the bytes of a PNG file."""
    height, width, channels = image.shape
    if image.dtype != np.uint8 or channels != 3:
        raise ValueError(f"image: expected uint8 (h, w, 3), got {image.dtype} {image.shape}")
    rows = np.concatenate([np.zeros((height, 1), np.uint8), image.reshape(height, width * 3)], axis=1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
        + chunk(b"IEND", b"")
    )


def write_png(path: str | Path, image: np.ndarray) -> Path:
    """Writes the picture under a temporary name and renames it."""
    path = Path(path)
    write_file(path, png_bytes(image))
    return path
