"""Frames of a folder into one map, each once: what is unfit is named and left out, whole."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._argument_errors import checked
from .._core import (
    DepthImage,
    Error,
    IntegrationReport,
    InvalidInput,
    OccupancyMap,
    ProbabilisticSdf,
    _sdf_option_table,
    register_frame,
)
from .._progress import Progress
from ..frames import Frame, FrameFolder, LoadedFrame
from ..frames.frame import frame_bytes
from ..frames.intrinsics import Intrinsics
from ..frames.sensors import Sensor

STAGE = "integrating frames"
PROGRESS_FILE = "progress.json"
DEFAULTS: dict[str, Any] = {name: value for name, (value, _) in _sdf_option_table().items()}
"""Defaults of the library's options."""
_MOST_INVERTED = 3
_CELL_BYTES = 64  # of OctoMap's tree, and of the set of cells that one frame changes
_NO_POSE_ERROR = "has no pose_error: --register moves a pose as far as that says"
_PUT_BACK = "put it back, or make the map anew with --start-over"


@dataclass(frozen=True)
class ScanOptions:
    """Resolution and size of a map; see ProbabilisticSdf."""

    voxel: float
    truncation: float
    max_memory: float
    outlier_gate: float = 0.0
    max_incidence: float = DEFAULTS["max_incidence"]
    register: bool = False
    """Each frame is moved onto the map before it is integrated, as far as its sensor's pose_error allows."""

    def new_map(self) -> ProbabilisticSdf:
        """An empty map with these options."""
        return ProbabilisticSdf(
            voxel=self.voxel,
            truncation=self.truncation,
            max_memory=self.max_memory,
            outlier_gate=self.outlier_gate,
            max_incidence=self.max_incidence,
        )


@dataclass(frozen=True)
class FrameRecord:
    """A frame that is in the map; counts are of pixels."""

    name: str
    sensor: str
    digest: str
    T_world_camera: list[list[float]]
    measured: int
    used: int
    out_of_range: int
    too_noisy: int
    too_slanted: int
    without_normal: int
    new_blocks: int
    agreement: float | None
    warning: str
    outliers: int = 0
    """Pixels that the gate left out; 0 where none was asked for."""


@dataclass(frozen=True)
class SkippedFrame:
    """A frame that is not in the map, and why."""

    name: str
    sensor: str
    reason: str


@dataclass
class Scan:
    """A map and how it came to be."""

    options: ScanOptions
    sdf: ProbabilisticSdf
    frames: list[FrameRecord] = field(default_factory=list)
    skipped: list[SkippedFrame] = field(default_factory=list)
    sensors: dict[str, dict[str, Any]] = field(default_factory=dict)
    """As they were when their first frame was integrated."""
    absent: list[str] = field(default_factory=list)
    """Frames in the map that are no longer in the folder."""

    @classmethod
    def begin(cls, options: ScanOptions) -> Scan:
        """Raises InvalidInput on options out of range."""
        return cls(options, options.new_map())


@checked
def integrate_frames(
    folder: FrameFolder,
    scan: Scan,
    every: int = 1,
    progress: Progress = None,
    on_frame: Callable[[Scan], object] | None = None,
    undivided: Callable[[], contextlib.AbstractContextManager[object]] = contextlib.nullcontext,
) -> int:
    """Adds what is not yet in the map and returns how many frames that were.

    Takes every `every`-th frame of each sensor. Afterwards `scan.skipped` holds all that were left out. `on_frame` is
    called after each that was added. What holds a signal back for a moment may be given as `undivided`: a frame comes into the map and
    into `scan.frames` within it. Raises InvalidInput, with the map as it was before that frame, when what was integrated
    earlier has changed, when the map grows too large, and when poses turn out to lead from the world to the camera.
    """
    _compare_sensors(folder, scan)
    _compare_frames(folder, scan, progress)
    known = {record.name for record in scan.frames}
    todo = [frame for frame in every_nth(folder.frames, every) if frame.name not in known]
    scan.skipped = []
    added = inverted = 0
    for i, frame in enumerate(todo):
        if progress:
            progress(STAGE, i / len(todo))
        try:
            _add(folder, scan, frame, undivided)
        except Error as error:
            reason = _advised(folder, frame, str(error))
            if str(error).startswith("max_memory"):
                raise InvalidInput(f"{frame.name}: {error}: see --voxel and --max-memory") from None
            if reason.endswith(_NO_POSE_ERROR):
                raise InvalidInput(f"{frame.name}: {reason}") from None
            inverted += "when the poses are inverted" in reason
            if inverted >= _MOST_INVERTED:
                raise InvalidInput(f"{frame.name}: {reason}; {inverted} frames say so") from None
            scan.skipped.append(SkippedFrame(frame.name, frame.sensor, reason))
            continue
        added += 1
        if on_frame:
            on_frame(scan)
    if inverted and inverted >= len(scan.frames):
        raise InvalidInput(scan.skipped[-1].reason)
    if progress and todo:
        progress(STAGE, 1.0)
    return added


@checked
def occupancy_of(folder: FrameFolder, scan: Scan, resolution: float, progress: Progress = None) -> OccupancyMap:
    """An octree of free, occupied and unknown cells of `resolution` [m], from the frames in a scan's map at the poses they have there.

    Raises InvalidInput when one of them is no longer in the folder, and before the cells take more memory than the map may.
    """
    out = OccupancyMap(resolution=resolution)
    by_name = {frame.name: frame for frame in folder.frames}
    for i, record in enumerate(scan.frames):
        if progress:
            progress("octree", i / len(scan.frames))
        if record.name not in by_name:
            raise InvalidInput(
                f"{record.name}: is in the map, but no longer in the folder: an octree needs all frames; leave --octree out"
            )
        loaded = folder.read(by_name[record.name])
        cells = out.cells + _volume_seen(loaded) / resolution**3
        if cells * _CELL_BYTES > scan.options.max_memory:
            raise InvalidInput(
                f"{record.name}: an octree of {resolution:g} m may have {cells:.1e} cells with this frame, {cells * _CELL_BYTES / 1e6:.0f} MB, "
                f"more than the {scan.options.max_memory / 1e6:g} MB of --max-memory: give --octree larger cells"
            )
        out.integrate(DepthImage(loaded.image.depth, loaded.image.camera, record.T_world_camera), loaded.camera)
    return out


def _volume_seen(loaded: LoadedFrame) -> float:
    """Between the camera and what it measured [m^3]: a pyramid for each pixel."""
    at, depth = loaded.camera.intrinsics, np.asarray(loaded.image.depth, dtype=float)
    seen = depth[(depth >= at.nearest) & (depth <= at.farthest)]
    return float((seen**3).sum() / (3 * at.fx * at.fy))


def every_nth(frames: list[Frame], every: int) -> list[Frame]:
    """Every nth of each sensor, the first one included."""
    counts: dict[str, int] = {}
    out = []
    for frame in frames:
        count = counts.get(frame.sensor, 0)
        counts[frame.sensor] = count + 1
        if count % every == 0:
            out.append(frame)
    return out


@checked
def choose_options(
    folder: FrameFolder,
    voxel: float | None,
    truncation: float | None,
    max_memory: float | None,
    outlier_gate: float | None = None,
    max_incidence: float | None = None,
    register: bool = False,
) -> ScanOptions:
    """Options as given; the others from the first frame that can be read.

    A voxel is as large as what a pixel covers at the median depth, in whole millimetres, and at least the library's. The truncation
    is as many voxels as the library's, and more where the noise at the depth that 95 % of the pixels stay below asks for it:
    depths noisier than a third of it are not used.
    """
    if voxel is None or truncation is None:
        loaded = _first_readable(folder)
        if loaded is not None:
            near, far = _depths(loaded.image, loaded.camera.intrinsics.nearest, loaded.camera.intrinsics.farthest)
            pinhole = loaded.camera.intrinsics
            if voxel is None:
                voxel = max(DEFAULTS["voxel"], _whole_mm(near / min(pinhole.fx, pinhole.fy)))
            if truncation is None:
                wanted = max(
                    voxel * DEFAULTS["truncation"] / DEFAULTS["voxel"], _whole_mm(3 * loaded.camera.noise.sigma(far))
                )
                truncation = min(wanted, 50 * voxel)
    voxel = voxel or DEFAULTS["voxel"]
    truncation = truncation or voxel * DEFAULTS["truncation"] / DEFAULTS["voxel"]
    memory, gate = max_memory or DEFAULTS["max_memory"], outlier_gate or DEFAULTS["outlier_gate"]
    slanted = max_incidence or DEFAULTS["max_incidence"]
    return ScanOptions(voxel, round(truncation, 9), memory, gate, slanted, register)


def _whole_mm(length: float) -> float:
    return math.ceil(length * 1000 - 1e-6) / 1000


def _first_readable(folder: FrameFolder) -> LoadedFrame | None:
    for frame in folder.frames:
        try:
            loaded = folder.read(frame)
        except Error:
            continue
        pinhole = loaded.camera.intrinsics
        if ((loaded.image.depth >= pinhole.nearest) & (loaded.image.depth <= pinhole.farthest)).any():
            return loaded
    return None


def _depths(image: DepthImage, nearest: float, farthest: float) -> tuple[float, float]:
    """Median and 95 % quantile of what is in range."""
    seen = image.depth[(image.depth >= nearest) & (image.depth <= farthest)]
    return float(np.median(seen)), float(np.quantile(seen, 0.95))


def _add(
    folder: FrameFolder, scan: Scan, frame: Frame, undivided: Callable[[], contextlib.AbstractContextManager[object]]
) -> None:
    content = frame_bytes(frame)
    loaded = folder.read(frame, content)
    unregistered = ""
    if scan.options.register:
        loaded, unregistered = _registered(scan.sdf, loaded, folder.sensors[loaded.camera.name])
    sensor = loaded.camera.name
    with undivided():
        report = scan.sdf.integrate(
            loaded.image, loaded.camera, pose_covariance=loaded.pose_covariance, sigma=loaded.sigma
        )
        scan.sensors.setdefault(sensor, described(folder, folder.sensors[sensor]))
        scan.frames.append(_record(frame.name, sensor, content.digest, loaded.image, report, unregistered))


def _registered(sdf: ProbabilisticSdf, loaded: LoadedFrame, sensor: Sensor) -> tuple[LoadedFrame, str]:
    """The frame moved onto the map, or as it was and why it was not moved."""
    if loaded.pose_covariance is None:
        raise InvalidInput(f"{sensor.shown} {_NO_POSE_ERROR}")
    if not sdf.frames:
        return loaded, ""
    image = loaded.image
    found = register_frame(sdf, image, loaded.camera, pose_covariance=loaded.pose_covariance, sigma=loaded.sigma)
    if found.reason:
        return loaded, f"not registered: {found.reason}"
    moved = DepthImage(image.depth, image.camera, found.T_world_camera)
    return LoadedFrame(moved, loaded.camera, loaded.sigma, found.covariance), ""


def _record(
    name: str, sensor: str, digest: str, image: DepthImage, report: IntegrationReport, unregistered: str
) -> FrameRecord:
    return FrameRecord(
        name,
        sensor,
        digest,
        image.T_world_camera.tolist(),
        report.measured,
        report.used,
        report.out_of_range,
        report.too_noisy,
        report.too_slanted,
        report.without_normal,
        report.new_blocks,
        None if math.isnan(report.agreement) else report.agreement,
        "; ".join(filter(None, (unregistered, report.warning))),
        report.outliers,
    )


def described(folder: FrameFolder, sensor: Sensor) -> dict[str, Any]:
    """A sensor as plain values, with the depth scale that holds for it."""
    scale = folder.depth_scale(sensor) if sensor.folder in folder.layouts else sensor.depth_scale
    return {**sensor.to_dict(), "depth_scale": scale}


def _advised(folder: FrameFolder, frame: Frame, reason: str) -> str:
    """What went wrong, and which key of the sensors' file is about it."""
    reason = reason.removeprefix(f"{frame.name}: ")
    sensor = folder.sensors.get(frame.sensor)
    if sensor is None:
        return reason
    if "check the depth scale" in reason:
        return reason + f"; depth_scale of {sensor.shown} is {folder.depth_scale(sensor):g} units in a metre"
    if "when the poses are inverted" in reason:
        now = "world_to_camera" if sensor.inverted else "camera_to_world"
        return reason + f"; poses of {sensor.shown} is {now}"
    if "is its median depth, and none is in" in reason:
        return reason + f"; see range and depth_scale of {sensor.shown}"
    return reason


# --- what was integrated earlier ------------------------------------------------------------------------------------------


def _compare_sensors(folder: FrameFolder, scan: Scan) -> None:
    """Takes over intrinsics that the frames of an earlier run gave, and refuses sensors that differ from what they were."""
    for name, was in scan.sensors.items():
        sensor = folder.sensors.get(name)
        if sensor is None and not folder.from_file and folder.names_sensors:
            sensor = Sensor(name)
        if sensor is None:
            _check_missing(folder, scan, name)
            continue
        at = was["intrinsics"]
        if sensor.intrinsics is None and at is not None:
            sized = Intrinsics(at["fx"], at["fy"], at["cx"], at["cy"], at["width"], at["height"], PROGRESS_FILE)
            sensor = Sensor(**{**vars(sensor), "intrinsics": sized})
        folder.sensors[name] = sensor
        now = described(folder, sensor)
        for key, new, old in _differences(now, was):
            raise InvalidInput(
                f"{sensor.shown}: {key} = {new}: the map was made with {old} ({PROGRESS_FILE}: sensors.{name}.{key}): {_PUT_BACK}"
            )


def _differences(now: Any, was: Any, key: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Keys whose values differ, with the new and the old one."""
    if isinstance(now, dict) and isinstance(was, dict):
        for name in now:
            yield from _differences(now[name], was.get(name), f"{key}.{name}" if key else name)
    elif now != was:
        yield key, now, was


def _check_missing(folder: FrameFolder, scan: Scan, sensor: str) -> None:
    """A sensor of the map that nothing describes any more may be gone only together with its frames."""
    there = {frame.name for frame in folder.frames}
    frame = next((record.name for record in scan.frames if record.sensor == sensor and record.name in there), None)
    if frame is not None:
        raise InvalidInput(
            f"{frame}: was integrated as a frame of sensor '{sensor}', and the sensors are {', '.join(folder.sensors) or 'unknown'} now: "
            f"{_PUT_BACK}"
        )


def _compare_frames(folder: FrameFolder, scan: Scan, progress: Progress) -> None:
    """Frames in the map must be what they were; those that are gone are noted."""
    by_name = {frame.name: frame for frame in folder.frames}
    scan.absent = []
    for i, record in enumerate(scan.frames):
        if progress:
            progress("checking frames", i / len(scan.frames))
        frame = by_name.get(record.name)
        if frame is None:
            scan.absent.append(record.name)
            continue
        try:
            same = frame_bytes(frame).digest == record.digest
        except Error:
            same = False
        if not same:
            raise InvalidInput(
                f"{record.name}: is in the map, but its image or pose has changed since ({PROGRESS_FILE}: frames[{i}].digest): {_PUT_BACK}"
            )
