"""Frames of a camera that goes around a typed scene, and the map of them: for who has no camera at hand."""

from __future__ import annotations

import os
import shutil
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._core import IoError, LinkShape, PinholeCamera, render_depth
from .._files import check_folder, write_file
from .._progress import Progress
from ..frames import open_frames, write_npz_frame
from .integration import Scan, choose_options, integrate_frames
from .map_folder import MAP, load_map

PINHOLE = PinholeCamera(width=320, height=240, fx=300.0, fy=300.0, cx=159.5, cy=119.5)
_ELEVATIONS = (0.7, 1.0, 1.25)  # of the eye above the level, in turn [rad]
_ASIDE = 1.9  # farthest that the eye goes round from where the robot stands [rad]
_GOLDEN = 0.6180339887  # shares of that range that lie apart
_SENSORS = """version: 1
sensors:
  camera:
    range: [0.1, 3.0]
    noise: {{model: polynomial, constant: 0.0, quadratic: {noise!r}}}
"""


@dataclass(frozen=True)
class Tour:
    """Where the camera goes and how well it measures."""

    views: int = 16
    distance: float = 0.6
    """Distance of the eye from what it looks at [m]."""
    noise: float = 0.002
    """Standard deviation of a depth at 1 m; it grows with the square of the depth [m]."""
    seed: int = 1

    def eyes(self, T_world_target: np.ndarray) -> list[np.ndarray]:
        """Poses T_world_camera, from above and around the target's -x, where the robot stands."""
        out = []
        target, x = T_world_target[:3, 3], T_world_target[:3, 0]
        for k in range(self.views):
            up = _ELEVATIONS[k % len(_ELEVATIONS)]
            turn = np.arctan2(-x[1], -x[0]) + _ASIDE * (2 * ((k + 1) * _GOLDEN % 1.0) - 1)
            forward = -np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
            right = np.array([-np.sin(turn), np.cos(turn), 0.0])
            T = np.eye(4)
            T[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
            T[:3, 3] = target - self.distance * forward
            out.append(T)
        return out


def rendered_map(
    folder: Path, scene: list[LinkShape], T_world_target: np.ndarray, tour: Tour, progress: Progress = None
) -> Path:
    """The folder `map` below `folder`, made of the frames that it holds beside; both are made where they are not.

    `scene` in the world, `T_world_target` (4, 4) is what the camera looks at. The same arguments give the same bytes. Raises IoError where the
    folder cannot be written.
    """
    made = folder / "map"
    if _readable(made):
        return made
    check_folder(folder.parent)
    folder.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(dir=folder.parent, prefix=".rendering."))
    try:
        write_frames(draft / "frames", scene, T_world_target, tour, progress)
        frames = open_frames(draft / "frames")
        scan = Scan.begin(choose_options(frames, None, None, None))
        integrate_frames(frames, scan, progress=progress)
        (draft / "map").mkdir()
        scan.sdf.save(str(draft / "map" / MAP))
        if folder.exists() and not _readable(made):  # damaged
            shutil.rmtree(folder)
        try:
            os.rename(draft, folder)
        except OSError:
            if not _readable(made):  # else another process was faster, with the same bytes
                raise
    finally:
        shutil.rmtree(draft, ignore_errors=True)
    return made


def _readable(folder: Path) -> bool:
    try:
        load_map(folder)
    except IoError:
        return False
    return True


def write_frames(
    folder: Path, scene: list[LinkShape], T_world_target: np.ndarray, tour: Tour, progress: Progress = None
) -> None:
    """`tour.views` frames with noise, as .npz files beside their sensors.yaml (docs/frames_format.md)."""
    folder.mkdir(parents=True, exist_ok=True)
    intrinsics = np.array([PINHOLE.fx, PINHOLE.fy, PINHOLE.cx, PINHOLE.cy])
    for k, T in enumerate(tour.eyes(T_world_target)):
        if progress:
            progress("rendering frames", k / tour.views)
        image = render_depth(scene, PINHOLE, T, noise=tour.noise, seed=tour.seed * 1000 + k)
        write_npz_frame(folder / f"{k:03d}.npz", image.depth, T, intrinsics, sensor="camera")
    write_file(folder / "sensors.yaml", _SENSORS.format(noise=float(tour.noise)))
