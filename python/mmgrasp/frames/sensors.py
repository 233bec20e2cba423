"""The sensors' file: what each camera of a folder sees, how well it measures, and what its poses mean."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from .._argument_errors import checked
from .._core import DepthCamera, DepthNoise, InvalidInput, PinholeCamera
from ..documents.reading import LONGEST_NAME, Node, read_yaml
from .intrinsics import Intrinsics, read_intrinsics
from .poses import inverse

SENSORS_FILE = "sensors.yaml"
VERSION = 1
NOISES = {
    "structured_light": "",
    "time_of_flight": "",
    "stereo": "baseline disparity_sigma focal",
    "polynomial": "constant linear quadratic slant slant_power",
}
_SEEN = PinholeCamera()  # the range that the library gives a camera


@dataclass(frozen=True)
class Sensor:
    """One depth camera; frames of it share its systematic error."""

    name: str
    folder: str = "."
    intrinsics: Intrinsics | None = None
    """None: a file of the data set, or each frame, has them."""
    nearest: float = _SEEN.nearest
    farthest: float = _SEEN.farthest
    depth_scale: float | None = None
    """Units of an integer image in a metre; None: the layout's."""
    noise: DepthNoise = field(default_factory=DepthNoise.structured_light)
    noise_model: str = "structured_light"
    systematic: float = 0.0
    systematic_scale: float = 0.0
    link: str = ""
    """Poses are those of this link; empty: of the camera."""
    T_link_camera: np.ndarray | None = None
    inverted: bool = False
    """Poses lead from the world to the camera (or link)."""
    pose_error: tuple[float, float] = (0.0, 0.0)
    """Standard deviation of each frame's pose along and about each axis [m, rad]."""
    place: str = ""
    """File and line, for messages; empty: no file."""

    @property
    def shown(self) -> str:
        """Its name and where it is described, for messages."""
        return f"sensor '{self.name}'" + (f" ({self.place})" if self.place else "")

    def camera(self) -> DepthCamera:
        """Raises InvalidInput on values that do not fit each other."""
        assert self.intrinsics is not None
        pinhole = self.intrinsics.camera(self.nearest, self.farthest)
        try:
            return DepthCamera(pinhole, self.noise, self.name, self.systematic, self.systematic_scale)
        except InvalidInput as error:
            raise InvalidInput(f"{self.shown}: {error}") from None

    def camera_pose(self, T: np.ndarray) -> np.ndarray:
        """T_world_camera of a frame whose pose the layout gives as T."""
        T_world_body = inverse(T) if self.inverted else T
        return T_world_body if self.T_link_camera is None else T_world_body @ self.T_link_camera

    def pose_covariance(self) -> np.ndarray | None:
        """(6, 6) as ProbabilisticSdf.integrate takes it; None: exact poses."""
        along, about = self.pose_error
        if along == 0 and about == 0:
            return None
        return np.diag([along**2] * 3 + [about**2] * 3)

    def to_dict(self) -> dict[str, Any]:
        """Everything that the map depends on, as plain values."""
        at = self.intrinsics
        keys = ("width", "height", "fx", "fy", "cx", "cy")
        noise = {key: getattr(self.noise, key) for key in NOISES["polynomial"].split()}
        return {
            "folder": self.folder,
            "intrinsics": None if at is None else {key: getattr(at, key) for key in keys},
            "range": [self.nearest, self.farthest],
            "depth_scale": self.depth_scale,
            "noise": {"model": self.noise_model, **noise},
            "systematic": self.systematic,
            "systematic_scale": self.systematic_scale,
            "link": self.link,
            "T_link_camera": None if self.T_link_camera is None else self.T_link_camera.tolist(),
            "poses": "world_to_camera" if self.inverted else "camera_to_world",
            "pose_error": list(self.pose_error),
        }


@checked
def read_sensors(path: Path) -> dict[str, Sensor]:
    """The sensors of a file by name. Messages name file, line, key, value and rule."""
    root = read_yaml(path).root.mapping("version sensors")
    root.read_version(VERSION)
    sensors = {name: _read_sensor(node, name) for name, node in root["sensors"].items() if _check_name(node, name)}
    if not sensors:
        root["sensors"].fail("must name at least one sensor")
    return sensors


def _check_name(node: Node, name: str) -> bool:
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        node.fail(f"the name of a sensor must have 1 to {LONGEST_NAME} printable characters")
    return True


def _read_sensor(node: Node, name: str) -> Sensor:
    optional = "folder intrinsics range depth_scale noise systematic systematic_scale mounted_on poses pose_error"
    node.mapping("", optional)
    sensor = Sensor(name, place=node.place)
    if "folder" in node:
        sensor = replace(sensor, folder=_read_folder(node["folder"]))
    if "intrinsics" in node:
        sensor = replace(sensor, intrinsics=read_intrinsics(node["intrinsics"]))
    if "range" in node:
        nearest, farthest = node["range"].numbers(2, above=0)
        if not farthest > nearest:
            node["range"].fail("must be [nearest, farthest] with farthest above nearest [m]")
        sensor = replace(sensor, nearest=nearest, farthest=farthest)
    if "depth_scale" in node:
        sensor = replace(sensor, depth_scale=node["depth_scale"].number(above=0))
    for key in ("systematic", "systematic_scale"):
        if key in node:
            sensor = replace(sensor, **{key: node[key].number(least=0)})  # type: ignore[arg-type]
    if "noise" in node:
        sensor = replace(sensor, noise=_read_noise(node["noise"], sensor), noise_model=node["noise"]["model"].string())
    if "mounted_on" in node:
        mount = node["mounted_on"].mapping("link pose")
        sensor = replace(sensor, link=mount["link"].label(), T_link_camera=mount["pose"].pose())
    if "poses" in node:
        inverted = node["poses"].choice("camera_to_world", "world_to_camera") == "world_to_camera"
        sensor = replace(sensor, inverted=inverted)
    if "pose_error" in node:
        error = node["pose_error"].mapping("", "translation rotation")
        values = [error[key].number(least=0) if key in error else 0.0 for key in ("translation", "rotation")]
        sensor = replace(sensor, pose_error=(values[0], values[1]))
    _check_noise(node, sensor)
    return sensor


def _read_folder(node: Node) -> str:
    path = PurePosixPath(node.string())
    if path.is_absolute() or ".." in path.parts or "\0" in str(path):
        node.fail("must be a folder below that of the frames")
    return str(path)


def _read_noise(node: Node, sensor: Sensor) -> DepthNoise:
    model = node["model"].choice(*NOISES)
    keys = NOISES[model]
    node.mapping("model", keys)
    if model == "structured_light":
        return DepthNoise.structured_light()
    if model == "time_of_flight":
        return DepthNoise.time_of_flight()
    if model == "stereo":
        node.mapping("model baseline disparity_sigma" + ("" if sensor.intrinsics else " focal"), keys)
        focal = node["focal"].number(above=0) if "focal" in node else sensor.intrinsics.fx  # type: ignore[union-attr]
        baseline, sigma = node["baseline"].number(above=0), node["disparity_sigma"].number(above=0)
        with node.blamed():
            return DepthNoise.stereo(focal, baseline, sigma)
    values = {key: node[key].number() for key in keys.split() if key in node}
    with node.blamed():
        return DepthNoise(**values)


def _check_noise(node: Node, sensor: Sensor) -> None:
    """The library's own rules over the camera's range; what they say does not depend on the intrinsics."""
    pinhole = PinholeCamera(nearest=sensor.nearest, farthest=sensor.farthest)
    with node.blamed():
        DepthCamera(pinhole, sensor.noise, sensor.name, sensor.systematic, sensor.systematic_scale)
