"""Our own layout: one `.npz` a frame, which holds everything that ProbabilisticSdf.integrate takes."""

from __future__ import annotations

import io
import math
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._argument_errors import checked
from .._core import InvalidInput
from .._files import write_file
from ..documents.reading import near_miss
from .depth_png import MOST_PIXELS
from .frame import Frame
from .intrinsics import Intrinsics
from .poses import rigid

DEPTH_SCALE = 1000.0
KEYS = ("depth", "T_world_camera", "intrinsics", "sensor", "sigma", "pose_covariance")
_LARGEST_MEMBER = 8 * MOST_PIXELS + 10_000  # [bytes]


@dataclass(frozen=True)
class NpzFrame:
    """The content of a file; what it does not hold is None or empty."""

    depth: np.ndarray
    T_world_camera: np.ndarray
    intrinsics: Intrinsics | None
    sensor: str
    sigma: np.ndarray | None
    pose_covariance: np.ndarray | None


def found(folder: Path) -> bool:
    """Whether a folder holds .npz files."""
    return any(folder.glob("*.npz"))


def frames(folder: Path, root: Path, sensor: str) -> list[Frame]:
    """Frames in the order of their names."""
    return [Frame(path.relative_to(root).as_posix(), path, sensor) for path in sorted(folder.glob("*.npz"))]


@checked
def write_npz_frame(
    path: Path,
    depth: np.ndarray,
    T_world_camera: np.ndarray,
    intrinsics: np.ndarray | None = None,
    sensor: str = "",
    sigma: np.ndarray | None = None,
    pose_covariance: np.ndarray | None = None,
) -> None:
    """Writes one frame: `depth` (h, w) in metres as floats (0 or NaN: nothing measured) or in units of the sensor's
    depth_scale as integers, `T_world_camera` (4, 4), `intrinsics` (4,) fx, fy, cx, cy in pixels or (3, 3), the name of the
    `sensor`, `sigma` (h, w) of each depth [m] and `pose_covariance` (6, 6), as ProbabilisticSdf.integrate takes them.
    """
    given: dict[str, Any] = {"depth": depth, "T_world_camera": T_world_camera, "intrinsics": intrinsics}
    given |= {"sensor": np.array(sensor) if sensor else None, "sigma": sigma, "pose_covariance": pose_covariance}
    file = io.BytesIO()
    arrays = {key: np.asarray(value) for key, value in given.items() if value is not None}
    np.savez_compressed(file, **arrays)  # type: ignore[arg-type]
    read_npz(file.getvalue(), str(path))
    write_file(Path(path), file.getvalue())


def read_npz(data: bytes, what: str) -> NpzFrame:
    """Raises InvalidInput naming `what`, the key and the rule."""
    arrays = _arrays(data, what)
    for key in ("depth", "T_world_camera"):
        if key not in arrays:
            raise InvalidInput(f"{what}: {key} is missing")
    depth = arrays["depth"]
    if depth.ndim != 2 or depth.dtype.kind not in "fiu" or not 0 < depth.size <= MOST_PIXELS:
        raise InvalidInput(f"{what}: depth: must be numbers (height, width), is {depth.dtype} {depth.shape}")
    depth = depth.astype(np.float64) if depth.dtype.kind == "f" else depth
    if (depth < 0).any():
        raise InvalidInput(f"{what}: depth = {depth.min():g}: must be 0 or more (0 or NaN where nothing was measured)")
    T = rigid(_floats(arrays["T_world_camera"], (4, 4), f"{what}: T_world_camera"), f"{what}: T_world_camera")
    sigma = _floats(arrays["sigma"], depth.shape, f"{what}: sigma") if "sigma" in arrays else None
    covariance = arrays.get("pose_covariance")
    if covariance is not None:
        covariance = _floats(covariance, (6, 6), f"{what}: pose_covariance")
    return NpzFrame(
        depth, T, _intrinsics(arrays.get("intrinsics"), depth, what), _name(arrays, what), sigma, covariance
    )


def _floats(array: np.ndarray, shape: tuple[int, ...], what: str) -> np.ndarray:
    if array.dtype.kind not in "fiu" or array.shape != shape:
        raise InvalidInput(f"{what}: must be numbers {shape}, is {array.dtype} {array.shape}")
    return array.astype(np.float64)


def _name(arrays: dict[str, np.ndarray], what: str) -> str:
    if "sensor" not in arrays:
        return ""
    array = arrays["sensor"]
    if array.dtype.kind != "U" or array.shape != () or not str(array) or not str(array).isprintable():
        raise InvalidInput(f"{what}: sensor: must be one name, is {array.dtype} {array.shape}")
    return str(array)


def _intrinsics(array: np.ndarray | None, depth: np.ndarray, what: str) -> Intrinsics | None:
    if array is None:
        return None
    if array.shape == (3, 3):
        K = _floats(array, (3, 3), f"{what}: intrinsics")
        if not np.array_equal(K[[0, 1, 2, 2, 2], [1, 0, 0, 1, 2]], [0, 0, 0, 0, 1]):
            raise InvalidInput(f"{what}: intrinsics: must hold rows fx 0 cx, 0 fy cy, 0 0 1")
        values = [K[0, 0], K[1, 1], K[0, 2], K[1, 2]]
    else:
        values = list(_floats(array, (4,), f"{what}: intrinsics"))
    fx, fy, cx, cy = (float(x) if math.isfinite(x) else math.nan for x in values)
    return Intrinsics(fx, fy, cx, cy, depth.shape[1], depth.shape[0], f"{what}: intrinsics").check()


def _arrays(data: bytes, what: str) -> dict[str, np.ndarray]:
    """The known arrays of a file: sizes are checked before anything is allocated, and no object is ever built from it."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            out = {}
            for entry in archive.infolist():
                key = entry.filename.removesuffix(".npy")
                if key not in KEYS:
                    raise InvalidInput(f"{what}: {key[:80]!r}: unknown key{near_miss(key[:80], list(KEYS))}")
                if key in out:
                    raise InvalidInput(f"{what}: {key}: is given twice")
                if entry.file_size > _LARGEST_MEMBER:
                    raise InvalidInput(
                        f"{what}: {key}: has {entry.file_size} bytes, must have at most {_LARGEST_MEMBER}"
                    )
                with archive.open(entry) as file:
                    out[key] = _array(file.read(_LARGEST_MEMBER + 1), f"{what}: {key}")
            return out
    except InvalidInput:
        raise
    except Exception as error:  # a foreign decoder: whatever it raises means that the file is damaged
        raise InvalidInput(f"{what}: is no whole .npz file: {str(error) or type(error).__name__}") from None


def _array(data: bytes, what: str) -> np.ndarray:
    file = io.BytesIO(data)
    version = np.lib.format.read_magic(file)
    if version == (1, 0):
        shape, by_columns, kind = np.lib.format.read_array_header_1_0(file)
    elif version == (2, 0):
        shape, by_columns, kind = np.lib.format.read_array_header_2_0(file)
    else:
        raise InvalidInput(f"{what}: has version {version} of the format, this program reads 1.0 and 2.0")
    content = data[file.tell() :]
    if kind.hasobject or kind.itemsize == 0 or math.prod(shape) * kind.itemsize != len(content):
        raise InvalidInput(f"{what}: {kind} {shape} does not fit its {len(content)} bytes")
    values = np.frombuffer(content, dtype=kind)
    return values.reshape(shape, order="F" if by_columns else "C")
