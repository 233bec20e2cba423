"""Intrinsics of a camera: from the sensors' file, or from the files that data sets carry."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

from .._core import InvalidInput, PinholeCamera
from .._files import read_text
from ..documents.reading import Node, read_json
from .depth_png import MOST_PIXELS
from .poses import matrix

TEXT_NAMES = ("camera-intrinsics.txt", "camera_intrinsics.txt", "intrinsics.txt", "intrinsic.txt")
JSON_PATTERNS = ("*intrinsic*.json", "*camera*.json")
_LARGEST = 100_000  # [bytes]


@dataclass(frozen=True)
class Intrinsics:
    """Focal lengths and principal point [pixels]; the size is None where only the images tell it."""

    fx: float
    fy: float
    cx: float
    cy: float
    width: int | None = None
    height: int | None = None
    place: str = "intrinsics"
    """File and line, for messages."""

    def check(self) -> Intrinsics:
        """Raises InvalidInput naming place, key, value and rule."""
        for key, value in (("fx", self.fx), ("fy", self.fy)):
            if not (math.isfinite(value) and 1e-3 <= value <= 1e6):
                raise InvalidInput(f"{self.place}: {key} = {value:g}: must be positive, a focal length in pixels")
        for key, size in (("width", self.width), ("height", self.height)):
            if size is not None and not 0 < size <= MOST_PIXELS:
                raise InvalidInput(f"{self.place}: {key} = {size}: must lie between 1 and {MOST_PIXELS} pixels")
        if self.width is not None and self.height is not None and self.width * self.height > MOST_PIXELS:
            raise InvalidInput(f"{self.place}: {self.width} x {self.height}: must be at most {MOST_PIXELS} pixels")
        for key, value, size in (("cx", self.cx, self.width), ("cy", self.cy, self.height)):
            if not math.isfinite(value):
                raise InvalidInput(f"{self.place}: {key} = {value:g}: must be finite")
            if size is not None and not 0 <= value <= size - 1:
                raise InvalidInput(
                    f"{self.place}: {key} = {value:g}: must lie in the image, between 0 and {size - 1} "
                    "(are these the intrinsics of another resolution?)"
                )
        return self

    def sized(self, width: int, height: int) -> Intrinsics:
        """With the size of the images where the file gives none."""
        if self.width is not None:
            return self
        return replace(self, width=width, height=height).check()

    def camera(self, nearest: float, farthest: float) -> PinholeCamera:
        """The camera, once the size of its images is known."""
        assert self.width is not None and self.height is not None
        return PinholeCamera(self.width, self.height, self.fx, self.fy, self.cx, self.cy, nearest, farthest)


def read_intrinsics(node: Node) -> Intrinsics:
    """{width, height, fx, fy, cx, cy} of the sensors' file."""
    node.mapping("fx fy cx cy", "width height")
    if ("width" in node) != ("height" in node):
        node.fail("give width and height, or neither")
    size = [node[key].integer(least=1) if key in node else None for key in ("width", "height")]
    values = [node[key].number() for key in ("fx", "fy", "cx", "cy")]
    return Intrinsics(
        values[0], values[1], values[2], values[3], size[0], size[1], f"{node.place}: {node.name}"
    ).check()


def find_intrinsics(folder: Path) -> Intrinsics | None:
    """From the files of a data set in the folder or, where it has none, in the one around it."""
    for place in (folder, folder.absolute().parent):
        found = sorted({path for pattern in JSON_PATTERNS for path in place.glob(pattern)})
        found += [place / name for name in TEXT_NAMES if (place / name).is_file()]
        if len(found) > 1:
            names = ", ".join(path.name for path in found)
            raise InvalidInput(
                f"{place}: holds several files of intrinsics ({names}): name the right ones in sensors.yaml"
            )
        if found:
            return _read_json(found[0]) if found[0].suffix == ".json" else _read_text(found[0])
    return None


def searched() -> str:
    """What find_intrinsics looks for, for messages."""
    return ", ".join((*TEXT_NAMES, *JSON_PATTERNS))


def _read_text(path: Path) -> Intrinsics:
    K = matrix(read_text(path, _LARGEST), 3, str(path))
    if any(abs(K[i, j] - v) > 1e-9 for i, j, v in ((1, 0, 0.0), (2, 0, 0.0), (2, 1, 0.0), (2, 2, 1.0))):
        raise InvalidInput(f"{path}: must hold rows fx 0 cx, 0 fy cy, 0 0 1")
    if abs(K[0, 1]) > 1e-9:
        raise InvalidInput(f"{path}: has a skew of {K[0, 1]:g}: images must be rectified")
    return Intrinsics(K[0, 0], K[1, 1], K[0, 2], K[1, 2], place=str(path)).check()


def _read_json(path: Path) -> Intrinsics:
    """Open3D's: width, height and the columns of the matrix one after the other."""
    root = read_json(path).root
    if "intrinsic_matrix" not in root:
        raise InvalidInput(f"{path}: intrinsic_matrix is missing (Open3D's pinhole camera has width, height and it)")
    K = root["intrinsic_matrix"].numbers(9)
    if any(abs(K[i] - v) > 1e-9 for i, v in ((1, 0.0), (2, 0.0), (3, 0.0), (5, 0.0), (8, 1.0))):
        root["intrinsic_matrix"].fail("must hold the columns fx 0 0, 0 fy 0, cx cy 1, one after the other")
    size = root["width"].integer(least=1), root["height"].integer(least=1)
    return Intrinsics(K[0], K[4], K[6], K[7], size[0], size[1], place=str(path)).check()
