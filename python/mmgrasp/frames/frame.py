"""One frame of a folder, as listed: where its depths and its pose are, or why it cannot be used."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._core import InvalidInput
from .._files import printable, read_bytes

LARGEST_IMAGE = 400_000_000  # [bytes]
LARGEST_POSE = 10_000  # [bytes]


@dataclass(frozen=True)
class Frame:
    """One depth image of a folder, in the order in which frames are integrated."""

    name: str
    """Path of the depth image below the folder."""
    path: Path
    sensor: str
    """Name in the sensors' file; empty: the frame itself names it."""
    pose: np.ndarray | Path | None = None
    """(4, 4) as the layout gives it, the file it is in, or None: in `path` itself."""
    problem: str = ""
    """Why it cannot be used; empty: nothing known against it."""


@dataclass(frozen=True)
class FrameBytes:
    """The files of a frame, unread, so that they are read once for the digest and the content."""

    image: bytes
    pose: bytes

    @property
    def digest(self) -> str:
        """SHA-256 of image and pose."""
        sums = hashlib.sha256(len(self.image).to_bytes(8, "little"))
        sums.update(self.image)
        sums.update(self.pose)
        return sums.hexdigest()


def frame_bytes(frame: Frame) -> FrameBytes:
    """Reads the files of a frame. Raises IoError naming the file, InvalidInput for a frame with a problem."""
    if frame.problem:
        raise InvalidInput(f"{printable(frame.name)}: {frame.problem}")
    image = read_bytes(frame.path, LARGEST_IMAGE)
    if isinstance(frame.pose, Path):
        return FrameBytes(image, read_bytes(frame.pose, LARGEST_POSE))
    return FrameBytes(image, b"" if frame.pose is None else np.ascontiguousarray(frame.pose, dtype="<f8").tobytes())
