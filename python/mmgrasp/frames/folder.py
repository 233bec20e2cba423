"""A folder of frames: which layout it has, its sensors, and its frames as depth images in metres."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType

import numpy as np

from .._argument_errors import checked
from .._core import DepthCamera, DepthImage, InvalidInput, IoError
from .._files import printable, read_head
from ..documents.reading import near_miss
from . import npz, redwood, seven_scenes, tum
from .depth_png import png_header, read_depth_png
from .frame import Frame, FrameBytes, frame_bytes
from .intrinsics import find_intrinsics, searched
from .poses import matrix, rigid
from .sensors import SENSORS_FILE, Sensor, read_sensors

INVALID_DEPTH = 65535  # of an image of 16 bits: nothing measured, beside 0
DEFAULT_SENSOR = "camera"


@dataclass(frozen=True)
class Layout:
    """A way in which folders hold frames."""

    name: str
    looked_for: str
    reader: ModuleType
    z_is_up: bool
    """World frames of such data have z upwards; otherwise they lie anyhow."""

    @property
    def depth_scale(self) -> float:
        """Units of a depth image in a metre."""
        return float(self.reader.DEPTH_SCALE)

    def found(self, folder: Path) -> bool:
        """Whether a folder looks like this layout."""
        return bool(self.reader.found(folder))

    def frames(self, folder: Path, root: Path, sensor: str) -> list[Frame]:
        """Frames of a folder in order; raises IoError or InvalidInput where they do not fit."""
        listed: list[Frame] = self.reader.frames(folder, root, sensor)
        return listed


NPZ = Layout("npz", "*.npz (mmgrasp)", npz, True)
LAYOUTS = (
    Layout("TUM RGB-D", "groundtruth.txt with depth.txt or depth/", tum, True),
    Layout("Redwood / Open3D", "depth/ with a trajectory *.log", redwood, False),
    Layout("7-Scenes", "*.depth.png with *.pose.txt", seven_scenes, False),
    NPZ,
)


@dataclass(frozen=True)
class LoadedFrame:
    """A frame as ProbabilisticSdf.integrate takes it."""

    image: DepthImage
    camera: DepthCamera
    sigma: np.ndarray | None = None
    pose_covariance: np.ndarray | None = None


class FrameFolder:
    """Frames of one folder in the order of their integration, and the sensors that took them."""

    def __init__(self, path: Path, sensors: dict[str, Sensor], layouts: dict[str, Layout], frames: list[Frame]) -> None:
        self.path = path
        self.sensors = sensors
        self.layouts = layouts
        """Layout of each sensor, by its folder."""
        self.frames = frames
        self.from_file = any(sensor.place for sensor in sensors.values())
        """The sensors come from a file; otherwise they are assumed."""

    def __repr__(self) -> str:
        names = ", ".join(dict.fromkeys(layout.name for layout in self.layouts.values()))
        return f"FrameFolder({self.path}: {len(self.frames)} frames, {names}, sensors {', '.join(self.sensors)})"

    def read(self, frame: Frame, content: FrameBytes | None = None) -> LoadedFrame:
        """Raises InvalidInput or IoError naming the frame and what is wrong with it."""
        content = content or frame_bytes(frame)
        what = printable(frame.name)
        if frame.path.suffix == ".npz":
            return self._read_npz(frame, content, what)
        sensor = self.sensors[frame.sensor]
        assert sensor.intrinsics is not None
        header = png_header(content.image, what)
        header.check_depth(what)
        self._check_size(sensor, header.width, header.height, what)
        raw = read_depth_png(content.image, what)
        raw[raw == INVALID_DEPTH] = 0
        image = self._image(sensor, raw, self._pose(frame, content), what)
        return LoadedFrame(image, sensor.camera(), None, sensor.pose_covariance())

    @property
    def names_sensors(self) -> bool:
        """Whether frames name their sensors, of which no file tells."""
        return not self.from_file and NPZ in self.layouts.values()

    @property
    def z_is_up(self) -> bool:
        """Whether the frames' world has z upwards, as far as its layouts tell."""
        return all(layout.z_is_up for layout in self.layouts.values())

    def depth_scale(self, sensor: Sensor) -> float:
        """Units of its integer images in a metre."""
        return sensor.depth_scale or self.layouts[sensor.folder].depth_scale

    def _pose(self, frame: Frame, content: FrameBytes) -> np.ndarray:
        if isinstance(frame.pose, Path):
            what = f"{printable(frame.name)}: {printable(frame.pose.name)}"
            try:
                text = content.pose.decode("utf-8")
            except UnicodeDecodeError:
                raise InvalidInput(f"{what}: is no text") from None
            return rigid(matrix(text, 4, what), what)
        assert frame.pose is not None
        return rigid(frame.pose, printable(frame.name))

    def _image(self, sensor: Sensor, raw: np.ndarray, T: np.ndarray, what: str) -> DepthImage:
        depth = raw / self.depth_scale(sensor) if raw.dtype.kind in "iu" else np.nan_to_num(raw, nan=0.0, posinf=0.0)
        if not (depth > 0).any():
            raise InvalidInput(f"{what}: no pixel is measured: at least one depth must be above 0")
        return DepthImage(depth, sensor.camera().intrinsics, sensor.camera_pose(T))

    def _check_size(self, sensor: Sensor, width: int, height: int, what: str) -> None:
        at = sensor.intrinsics
        assert at is not None
        if (width, height) != (at.width, at.height):
            raise InvalidInput(
                f"{what}: has {width} x {height} pixels, but the intrinsics of {sensor.shown} are for "
                f"{at.width} x {at.height}"
            )

    def _read_npz(self, frame: Frame, content: FrameBytes, what: str) -> LoadedFrame:
        found = npz.read_npz(content.image, what)
        sensor = self._sensor_of(found, what)
        if sensor.intrinsics is None or sensor.intrinsics.width is None:
            known = found.intrinsics or sensor.intrinsics
            if known is None:
                raise InvalidInput(f"{what}: intrinsics are missing, and {sensor.shown} has none")
            sensor = replace(sensor, intrinsics=known.sized(found.depth.shape[1], found.depth.shape[0]))
        at = sensor.intrinsics
        assert at is not None
        self._check_size(sensor, found.depth.shape[1], found.depth.shape[0], what)
        own = found.intrinsics
        if own is not None and (own.fx, own.fy, own.cx, own.cy) != (at.fx, at.fy, at.cx, at.cy):
            raise InvalidInput(f"{what}: its intrinsics are not those of {sensor.shown}, fx = {at.fx:g} and so on")
        image = self._image(sensor, found.depth, found.T_world_camera, what)
        covariance = sensor.pose_covariance() if found.pose_covariance is None else found.pose_covariance
        camera = sensor.camera()
        self.sensors[sensor.name] = sensor  # the first good frame of a sensor fixes its intrinsics
        return LoadedFrame(image, camera, found.sigma, covariance)

    def _sensor_of(self, found: npz.NpzFrame, what: str) -> Sensor:
        if self.from_file:
            if not found.sensor and len(self.sensors) > 1:
                raise InvalidInput(f"{what}: sensor is missing: which of {', '.join(self.sensors)} took it?")
            name = found.sensor or next(iter(self.sensors))
            if name not in self.sensors:
                raise InvalidInput(f"{what}: sensor = {name!r}: unknown{near_miss(name, list(self.sensors))}")
            return self.sensors[name]
        name = found.sensor or DEFAULT_SENSOR
        return self.sensors.get(name, Sensor(name))


@checked
def open_frames(folder: Path | str, sensors: Path | str | None = None) -> FrameFolder:
    """Recognises the layout and lists the frames.

    `sensors`: a file that describes the cameras; default: `sensors.yaml` in the folder, where there is one. Raises
    InvalidInput or IoError naming file, key, value and rule.
    """
    root = Path(folder)
    if not root.is_dir():
        raise IoError(
            f"{printable(str(root))}: cannot be read: " + ("is no folder" if root.exists() else "is not there")
        )
    try:
        known = _sensors_of(root, None if sensors is None else Path(sensors))
        layouts = {place: _layout_of(root / place) for place in dict.fromkeys(s.folder for s in known.values())}
        frames: list[Frame] = []
        for place, layout in layouts.items():
            here = [sensor for sensor in known.values() if sensor.folder == place]
            if layout is NPZ:
                frames += layout.frames(root / place, root, "")
                continue
            if len(here) > 1:
                names = ", ".join(sensor.name for sensor in here)
                raise InvalidInput(
                    f"{here[1].place}: folder = {place}: is that of several sensors ({names}); in the layout of "
                    f"{layout.name} each must have a folder of its own"
                )
            listed = layout.frames(root / place, root, here[0].name)
            known[here[0].name] = _with_intrinsics(here[0], root, listed)
            frames += listed
    except OSError as error:
        if isinstance(error, IoError):
            raise
        raise IoError(f"{printable(str(root))}: cannot be read: {error.strerror or error}") from None
    if all(layout is NPZ for layout in layouts.values()) and not any(s.place for s in known.values()):
        known = {}  # the frames name them
    return FrameFolder(root, known, layouts, frames)


def _sensors_of(root: Path, given: Path | None) -> dict[str, Sensor]:
    path = given or root / SENSORS_FILE
    if given is None and not path.exists():
        return {DEFAULT_SENSOR: Sensor(DEFAULT_SENSOR)}
    return read_sensors(path)


def _layout_of(folder: Path) -> Layout:
    shown = printable(str(folder))
    if not folder.is_dir():
        raise IoError(f"{shown}: cannot be read: is no folder")
    found = [layout for layout in LAYOUTS if layout.found(folder)]
    if len(found) == 1:
        return found[0]
    looked = "; ".join(f"{layout.name}: {layout.looked_for}" for layout in found or LAYOUTS)
    if found:
        raise InvalidInput(f"{shown}: has the layouts of several kinds of data ({looked}): must have one")
    inside = sorted(folder.iterdir())
    content = "has no layout that is known" if inside else "is empty"
    hint = next(
        (f"; try {printable(str(p))}" for p in inside if p.is_dir() and any(one.found(p) for one in LAYOUTS)), ""
    )
    raise InvalidInput(f"{shown}: {content}; looked for {looked}{hint}")


def _with_intrinsics(sensor: Sensor, root: Path, frames: Iterable[Frame]) -> Sensor:
    """The sensor with its intrinsics and, where no file tells it, the size that most of its images have."""
    at = sensor.intrinsics or find_intrinsics(root / sensor.folder)
    if at is None:
        raise InvalidInput(_advice(root / sensor.folder, sensor))
    if at.width is None:
        sizes = Counter(size for frame in frames if (size := _size_of(frame)) is not None)
        if not sizes:
            return replace(sensor, intrinsics=replace(at, width=1, height=1))  # no image can be read: nothing will fit
        (width, height), _ = sizes.most_common(1)[0]
        at = at.sized(width, height)
    return replace(sensor, intrinsics=at)


def _size_of(frame: Frame) -> tuple[int, int] | None:
    if frame.problem:
        return None
    with contextlib.suppress(InvalidInput, IoError):
        header = png_header(read_head(frame.path, 33), frame.name)
        header.check_depth(frame.name)
        return header.width, header.height
    return None


def _advice(folder: Path, sensor: Sensor) -> str:
    where = sensor.place or printable(str(folder))
    return (
        f"{where}: intrinsics of sensor '{sensor.name}' are missing; looked for {searched()} there and in the folder around it. "
        f"Write them into {SENSORS_FILE}, with the numbers of your camera:\nversion: 1\nsensors:\n  {sensor.name}:\n"
        "    intrinsics: {fx: 525, fy: 525, cx: 319.5, cy: 239.5}"
    )
