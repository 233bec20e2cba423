"""Frames for the map's benchmark as one .npz: depth [m] (n, height, width), poses (n, 4, 4), intrinsics, range."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path
from typing import NamedTuple

import numpy as np


class Frames(NamedTuple):
    depth: np.ndarray
    poses: np.ndarray
    intrinsics: np.ndarray  # fx, fy, cx, cy
    reach: np.ndarray  # nearest, farthest [m]

    def save(self, path: Path) -> None:
        np.savez(path, **self._asdict())

    @classmethod
    def load(cls, path: Path) -> Frames:
        with np.load(path) as content:
            return cls(**{name: content[name] for name in cls._fields})


def resident_memory() -> int:
    """What this process holds of the machine's memory, after what it has freed is given back [bytes]."""
    ctypes.CDLL(None).malloc_trim(0)
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
