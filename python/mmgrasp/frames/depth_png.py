"""Depth images as PNG files of 16 bits: nothing else is taken for one, and damage is found by the checksums."""

from __future__ import annotations

import io
import struct
import zlib
from dataclasses import dataclass

import numpy as np

from .._core import InvalidInput

SIGNATURE = b"\x89PNG\r\n\x1a\n"
KINDS = {0: "greyscale", 2: "colour", 3: "palette", 4: "greyscale with transparency", 6: "colour with transparency"}
MOST_PIXELS = 50_000_000


@dataclass(frozen=True)
class PngHeader:
    """What the first chunk of a PNG file says."""

    width: int
    height: int
    bits: int
    colour: int
    interlaced: bool

    def check_depth(self, what: str) -> None:
        """Raises InvalidInput unless it can be a depth image."""
        if self.bits != 16 or self.colour != 0:
            kind = KINDS.get(self.colour, f"colour type {self.colour}")
            raise InvalidInput(f"{what}: is a PNG of {self.bits} bits, {kind}: depth images have 16 bits, greyscale")
        if self.interlaced:
            raise InvalidInput(f"{what}: is an interlaced PNG: depth images are written row by row")
        if not 0 < self.width * self.height <= MOST_PIXELS:
            raise InvalidInput(f"{what}: has {self.width} x {self.height} pixels, must have 1 to {MOST_PIXELS}")


def png_header(data: bytes, what: str) -> PngHeader:
    """Reads the header at the beginning of a file (33 bytes at least). Raises InvalidInput naming `what`."""
    if data[:8] != SIGNATURE:
        raise InvalidInput(f"{what}: is no PNG file")
    if len(data) < 33:
        raise InvalidInput(f"{what}: is truncated: {len(data)} bytes hold no PNG header")
    length, kind = struct.unpack_from(">I4s", data, 8)
    if kind != b"IHDR" or length != 13 or zlib.crc32(data[12:29]) != struct.unpack_from(">I", data, 29)[0]:
        raise InvalidInput(f"{what}: is damaged: its PNG header does not fit its checksum")
    width, height, bits, colour = struct.unpack_from(">IIBB", data, 16)
    return PngHeader(width, height, bits, colour, data[28] != 0)


def read_depth_png(data: bytes, what: str) -> np.ndarray:
    """(height, width) uint16 of a whole file. Raises InvalidInput naming `what`."""
    header = png_header(data, what)
    header.check_depth(what)
    _check_rows(_checked_chunks(data, what), header, what)
    from PIL import Image

    try:
        with Image.open(io.BytesIO(data), formats=["PNG"]) as image:
            pixels = np.array(image)
    except Exception as error:  # a foreign decoder: whatever it raises means that the file is damaged
        raise InvalidInput(f"{what}: is damaged: {error}") from None
    if pixels.shape != (header.height, header.width) or pixels.dtype.kind not in "iu":
        raise InvalidInput(f"{what}: is damaged: its pixels are not those of its header")
    return pixels.astype(np.uint16)


def _checked_chunks(data: bytes, what: str) -> list[bytes]:
    """The compressed rows; every chunk is whole and fits its checksum, and the last one ends the image."""
    rows: list[bytes] = []
    place = 8
    while place + 12 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, place)
        end = place + 12 + length
        if end > len(data):
            break
        if zlib.crc32(data[place + 4 : end - 4]) != struct.unpack_from(">I", data, end - 4)[0]:
            raise InvalidInput(f"{what}: is damaged: a checksum at byte {place} is wrong")
        if kind == b"IEND":
            return rows
        if kind == b"IDAT":
            rows.append(data[place + 8 : end - 4])
        place = end
    raise InvalidInput(f"{what}: is truncated: it ends after {len(data)} bytes within the image")


def _check_rows(rows: list[bytes], header: PngHeader, what: str) -> None:
    """The image has all its rows: Pillow would leave missing ones at 0."""
    wanted = header.height * (1 + 2 * header.width)
    stream = zlib.decompressobj()
    try:
        found = len(stream.decompress(b"".join(rows), wanted + 1))
    except zlib.error as error:
        raise InvalidInput(f"{what}: is damaged: {error}") from None
    if found != wanted:
        more = "more" if found > wanted else f"{found}"
        raise InvalidInput(f"{what}: is damaged: its rows have {more} bytes, {wanted} belong to its size")
