"""Depth frames that the tests render themselves, written in every layout that `mmgrasp scan` reads."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mmgrasp as mg
from camera_poses import look_at
from mmgrasp.cli import main
from mmgrasp.frames import FrameFolder, open_frames, write_npz_frame
from mmgrasp.robot import quat_xyzw_from_rotation

PINHOLE = mg.mapping.PinholeCamera(width=160, height=120, fx=180.0, fy=180.0, cx=79.5, cy=59.5)
INTRINSICS = {"width": 160, "height": 120, "fx": 180.0, "fy": 180.0, "cx": 79.5, "cy": 59.5}
SCENE = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.12, 0.08, 0.06]), mg.pose([0.10, 0.02, 0.03], rpy=[0, 0, 0.4])),
    mg.LinkShape(mg.Box([0.06, 0.06, 0.10]), mg.pose([-0.12, -0.05, 0.05])),
]
OPTIONS = ["--voxel", "0.004", "--truncation", "0.02"]
SCALES = {"seven_scenes": 1000.0, "redwood": 1000.0, "tum": 5000.0, "npz": 1000.0}
LAYOUTS = list(SCALES)


@dataclass
class Shot:
    """A depth image in units of a file, and the camera's pose, which is exactly that of its quaternion."""

    raw: np.ndarray
    T_world_camera: np.ndarray
    quat_xyzw: np.ndarray


def shots(count: int, scale: float, pinhole: mg.mapping.PinholeCamera = PINHOLE) -> list[Shot]:
    """Views from around the scene, 0.45 m away, 45 degrees down."""
    out = []
    for k in range(count):
        angle = 0.35 * k
        eye = np.array([0.32 * np.cos(angle), 0.32 * np.sin(angle), 0.34])
        T = look_at(eye, np.array([0.0, 0.0, 0.02]))
        quat = quat_xyzw_from_rotation(T[:3, :3])
        T = mg.pose(T[:3, 3], quat_xyzw=quat)
        depth = mg.mapping.render_depth(SCENE, pinhole, T).depth
        out.append(Shot(np.round(depth.astype(float) * scale).astype(np.uint16), T, quat))
    return out


def save_png(path: Path, raw: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(raw).save(path)


def matrix_text(T: np.ndarray) -> str:
    """Every digit, so that what is read is what was written."""
    return "".join(" ".join(repr(float(x)) for x in row) + "\n" for row in T)


def write_seven_scenes(folder: Path, taken: list[Shot]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for k, shot in enumerate(taken):
        raw = shot.raw.copy()
        raw[raw == 0] = 65535
        save_png(folder / f"frame-{k:06d}.depth.png", raw)
        (folder / f"frame-{k:06d}.pose.txt").write_text(matrix_text(shot.T_world_camera))
    at = INTRINSICS
    K = np.array([[at["fx"], 0, at["cx"]], [0, at["fy"], at["cy"]], [0, 0, 1.0]])
    (folder / "camera-intrinsics.txt").write_text(matrix_text(K))


def write_redwood(folder: Path, taken: list[Shot]) -> None:
    rows = []
    for k, shot in enumerate(taken):
        save_png(folder / "depth" / f"{k:05d}.png", shot.raw)
        rows.append(f"{k} {k} {k + 1}\n" + matrix_text(shot.T_world_camera))
    (folder / "trajectory.log").write_text("".join(rows))
    at = INTRINSICS
    columns = [at["fx"], 0, 0, 0, at["fy"], 0, at["cx"], at["cy"], 1]
    content = {"width": at["width"], "height": at["height"], "intrinsic_matrix": columns}
    (folder / "camera.json").write_text(json.dumps(content))


def write_tum(folder: Path, taken: list[Shot]) -> None:
    images, poses = ["# timestamp filename"], ["# timestamp tx ty tz qx qy qz qw"]
    for k, shot in enumerate(taken):
        time = f"{1305031102.160407 + k / 30:.6f}"
        save_png(folder / "depth" / f"{time}.png", shot.raw)
        images.append(f"{time} depth/{time}.png")
        values = [*shot.T_world_camera[:3, 3], *shot.quat_xyzw]
        poses.append(f"{time} " + " ".join(repr(float(x)) for x in values))
    (folder / "depth.txt").write_text("\n".join(images) + "\n")
    (folder / "groundtruth.txt").write_text("\n".join(poses) + "\n")
    write_sensors(folder)


def write_npz(folder: Path, taken: list[Shot], sensor: str = "camera") -> None:
    folder.mkdir(parents=True, exist_ok=True)
    at = [INTRINSICS[key] for key in ("fx", "fy", "cx", "cy")]
    for k, shot in enumerate(taken):
        write_npz_frame(folder / f"{sensor}_{k:03d}.npz", shot.raw, shot.T_world_camera, np.array(at), sensor)


WRITERS = {"seven_scenes": write_seven_scenes, "redwood": write_redwood, "tum": write_tum, "npz": write_npz}


def write_sensors(folder: Path, lines: str = "", name: str = "camera", intrinsics: bool = True) -> Path:
    """A sensors' file with the intrinsics of the rendered frames and more lines for its only sensor."""
    at = ", ".join(f"{key}: {value}" for key, value in INTRINSICS.items())
    text = f"version: 1\nsensors:\n  {name}:\n" + (f"    intrinsics: {{{at}}}\n" if intrinsics else "")
    text += "".join(f"    {line}\n" for line in lines.splitlines())
    path = folder / "sensors.yaml"
    path.write_text(text)
    return path


def write_frames(folder: Path, layout: str, count: int = 4) -> list[Shot]:
    """Frames of the scene in a layout; returns what was written."""
    taken = shots(count, SCALES[layout])
    WRITERS[layout](folder, taken)
    return taken


def direct_map(taken: list[Shot], scale: float, voxel: float = 0.004, truncation: float = 0.02) -> mg.ProbabilisticSdf:
    """The map that the library makes of the same frames, called by hand."""
    camera = mg.mapping.DepthCamera(PINHOLE, mg.mapping.DepthNoise.structured_light(), "camera")
    sdf = mg.ProbabilisticSdf(voxel=voxel, truncation=truncation)
    for shot in taken:
        sdf.integrate(mg.mapping.DepthImage(shot.raw / scale, PINHOLE, shot.T_world_camera), camera)
    return sdf


def run(frames: Path, out: Path, *more: str, pictures: bool = False) -> int:
    """`mmgrasp scan` with voxels that suit the scene; the exit code."""
    return main(["scan", str(frames), "-o", str(out), *OPTIONS, *([] if pictures else ["--no-pictures"]), *more])


def names(folder: Path) -> set[str]:
    """Files of a folder and below."""
    return {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}


def contents(folder: Path) -> dict[str, bytes]:
    """Every file's bytes by its name."""
    return {name: (folder / name).read_bytes() for name in names(folder)}


def problems(folder: FrameFolder) -> dict[str, str]:
    """What is wrong with each frame of a folder that can not be read."""
    out = {}
    for frame in folder.frames:
        try:
            folder.read(frame)
        except mg.Error as error:
            out[frame.name] = str(error)
    return out


def refused(folder: Path) -> str:
    """What is said of a folder that cannot be opened."""
    with pytest.raises(mg.Error) as caught:
        open_frames(folder)
    return str(caught.value)
