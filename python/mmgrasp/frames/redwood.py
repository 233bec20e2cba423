"""Redwood and Open3D: depth/*.png by number and a trajectory (.log) of 4 x 4 poses, 1000 units in a metre."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .._core import InvalidInput
from .._files import read_text
from .frame import Frame
from .poses import matrix, numbers, rigid

DEPTH_SCALE = 1000.0
FIRST_NAME = "trajectory.log"
_LARGEST = 500_000_000  # [bytes]


def found(folder: Path) -> bool:
    """Whether a folder has depth/ and a trajectory."""
    return (folder / "depth").is_dir() and any(folder.glob("*.log"))


def frames(folder: Path, root: Path, sensor: str) -> list[Frame]:
    """Images by number; entry k of the trajectory belongs to image k, counted from 0."""
    path = _trajectory(folder)
    poses = _read_trajectory(path)
    images: list[Path] = []
    foreign: list[Path] = []
    for image in sorted((folder / "depth").glob("*.png")):
        number = re.match(r"[0-9]{1,15}", image.name)
        (images if number else foreign).append(image)
    images.sort(key=lambda image: (_number(image), image.name))
    out = []
    for index, image in zip(_indices(images, poses, path), images, strict=True):
        name = image.relative_to(root).as_posix()
        pose = poses.get(index, f"{path.name} has no pose for frame {index}")
        out.append(
            Frame(name, image, sensor, problem=pose) if isinstance(pose, str) else Frame(name, image, sensor, pose)
        )
    problem = "foreign: its name does not begin with a number"
    return out + [Frame(image.relative_to(root).as_posix(), image, sensor, problem=problem) for image in foreign]


def _number(image: Path) -> int:
    found = re.match(r"[0-9]+", image.name)
    assert found is not None
    return int(found.group())


def _trajectory(folder: Path) -> Path:
    logs = sorted(folder.glob("*.log"))
    named = [path for path in logs if path.name == FIRST_NAME]
    if not named and len(logs) > 1:
        names = ", ".join(path.name for path in logs)
        raise InvalidInput(f"{folder}: holds several trajectories ({names}): call the right one {FIRST_NAME}")
    return (named or logs)[0]


def _read_trajectory(path: Path) -> dict[int, np.ndarray | str]:
    """Pose of the camera by frame number, or what is wrong with it."""
    rows = [(i, line) for i, line in enumerate(read_text(path, _LARGEST).splitlines(), 1) if line.strip()]
    if not rows:
        raise InvalidInput(f"{path}: holds no pose")
    out: dict[int, np.ndarray | str] = {}
    for k in range(0, len(rows), 5):
        line, head = rows[k]
        words = numbers(head, f"{path}:{line}")
        if len(words) != 3 or any(not np.isfinite(w) or w != int(w) or abs(w) > 1e15 for w in words):
            raise InvalidInput(f"{path}:{line}: must hold three whole numbers, the first one the frame's")
        frame = int(words[0])
        if len(rows) < k + 5:
            raise InvalidInput(f"{path}:{line}: frame {frame}: is truncated: four rows of its pose must follow")
        if frame in out:
            raise InvalidInput(f"{path}:{line}: frame {frame} has a pose already: must be given once")
        T = matrix(" ".join(row for _, row in rows[k + 1 : k + 5]), 4, f"{path}:{line}: frame {frame}")
        try:
            out[frame] = rigid(T, f"{path}:{line}: frame {frame}")
        except InvalidInput as error:
            out[frame] = str(error)
    return out


def _indices(images: list[Path], poses: dict[int, np.ndarray | str], path: Path) -> list[int]:
    """Which entry of the trajectory each image is: by place where all are there, else by number where that is certain."""
    if len(images) == len(poses):
        return sorted(poses)
    own = [_number(image) for image in images]
    if len(set(own)) == len(own):
        if 0 in own:
            return own
        if own == list(range(1, len(own) + 1)) and len(own) > len(poses):
            return [number - 1 for number in own]
    raise InvalidInput(
        f"{path}: has {len(poses)} poses for {len(images)} numbered images in depth/: which belongs to which is not known; "
        "number the images from 0, or let there be as many"
    )
