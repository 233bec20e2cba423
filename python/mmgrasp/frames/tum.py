"""TUM RGB-D: groundtruth.txt with timestamps and poses, depth images by timestamp, 5000 units in a metre."""

from __future__ import annotations

import bisect
from pathlib import Path, PurePosixPath

import numpy as np

from .._core import InvalidInput
from .._files import printable, read_text
from .frame import Frame
from .poses import between, numbers, pose_of_quaternion

DEPTH_SCALE = 5000.0
TRUTH = "groundtruth.txt"
LIST = "depth.txt"
PAIRS = ("associations.txt", "association.txt", "associate.txt", "associated.txt", "assoc.txt")
FARTHEST_POSE = 0.05
"""A pose this much earlier or later than the image says nothing about it [s]."""
_LARGEST = 500_000_000  # [bytes]


def found(folder: Path) -> bool:
    """Whether a folder has a ground truth as TUM RGB-D does."""
    return (folder / TRUTH).is_file()


def frames(folder: Path, root: Path, sensor: str) -> list[Frame]:
    """Images in the order of their timestamps, each with the pose between the two nearest of groundtruth.txt."""
    times, poses = _read_truth(folder / TRUTH)
    listed = _read_list(folder)
    out = []
    for time, name in sorted(listed, key=lambda entry: entry[0]):
        path = folder / name
        shown = path.relative_to(root).as_posix()
        if not path.is_file():
            out.append(Frame(shown, path, sensor, problem="half a frame: the depth image is not there"))
            continue
        pose = _pose_at(time, times, poses)
        if pose is None:
            problem = f"{TRUTH} has no pose within {FARTHEST_POSE:g} s of its time {time:.6f}{_nearest(time, times)}"
            out.append(Frame(shown, path, sensor, problem=problem))
        else:
            out.append(Frame(shown, path, sensor, pose))
    return out + _foreign(folder, root, sensor, {name for _, name in listed})


def _foreign(folder: Path, root: Path, sensor: str, listed: set[str]) -> list[Frame]:
    """Images beside the listed ones: said, since a list that was cut short would go unnoticed. (Pairs may leave images out.)"""
    source = _list_of(folder)
    if source is not None and source.name != LIST:
        return []
    problem = f"foreign: {LIST} does not name this image" if source else "foreign: its name is no timestamp"
    return [
        Frame(path.relative_to(root).as_posix(), path, sensor, problem=problem)
        for path in sorted((folder / "depth").glob("*.png"))
        if path.relative_to(folder).as_posix() not in listed
    ]


def _read_rows(path: Path) -> list[tuple[int, str]]:
    """Lines with content, by their number."""
    rows = enumerate(read_text(path, _LARGEST).splitlines(), 1)
    return [(i, line) for i, line in rows if line.strip() and not line.lstrip().startswith("#")]


def _timestamp(text: str, place: str) -> float:
    values = numbers(text, place)
    if len(values) != 1 or not 0 <= values[0] < 1e12:
        raise InvalidInput(f"{place}: timestamp = {text[:40]!r}: must be a number of seconds, 0 or more")
    return values[0]


def _read_truth(path: Path) -> tuple[list[float], list[np.ndarray]]:
    seen: dict[float, tuple[int, np.ndarray]] = {}
    for i, line in _read_rows(path):
        place = f"{path}:{i}"
        words = line.replace(",", " ").split()
        if len(words) != 8:
            raise InvalidInput(f"{place}: has {len(words)} columns, must have 8: timestamp tx ty tz qx qy qz qw")
        time = _timestamp(words[0], place)
        values = numbers(" ".join(words[1:]), place)
        pose = pose_of_quaternion(values[:3], values[3:], place)
        if time in seen and not np.array_equal(seen[time][1], pose):
            raise InvalidInput(
                f"{place}: timestamp {words[0]} has another pose than in line {seen[time][0]}: must be given once"
            )
        seen.setdefault(time, (i, pose))
    if not seen:
        raise InvalidInput(f"{path}: holds no pose")
    times = sorted(seen)
    return times, [seen[time][1] for time in times]


def _list_of(folder: Path) -> Path | None:
    return next((folder / name for name in (LIST, *PAIRS) if (folder / name).is_file()), None)


def _read_list(folder: Path) -> list[tuple[float, str]]:
    """(timestamp, path of the depth image below the folder), each once."""
    path = _list_of(folder)
    if path is None:
        images = sorted((folder / "depth").glob("*.png"))
        return [
            (float(p.stem), f"depth/{p.name}")
            for p in images
            if p.stem.replace(".", "", 1).isascii() and p.stem.replace(".", "", 1).isdigit()
        ]
    out: list[tuple[float, str]] = []
    times: dict[float, int] = {}
    for i, line in _read_rows(path):
        place = f"{path}:{i}"
        time_text, name = _depth_columns(line.split(), path, place)
        time = _timestamp(time_text, place)
        if time in times:
            raise InvalidInput(f"{place}: timestamp {time_text} is that of line {times[time]}: must be given once")
        times[time] = i
        parts = PurePosixPath(name).parts
        if name.startswith("/") or ".." in parts or "\0" in name:
            raise InvalidInput(f"{place}: {printable(name[:80])}: must lie below the folder")
        out.append((time, PurePosixPath(name).as_posix()))
    return out


def _depth_columns(words: list[str], path: Path, place: str) -> tuple[str, str]:
    if path.name == LIST:
        if len(words) == 2:
            return words[0], words[1]
        raise InvalidInput(f"{place}: has {len(words)} columns, must have 2: timestamp path")
    if len(words) == 4:
        for time, name in ((words[0], words[1]), (words[2], words[3])):
            if "depth" in name:
                return time, name
        raise InvalidInput(f"{place}: neither of its two paths has 'depth' in it")
    raise InvalidInput(f"{place}: has {len(words)} columns, must have 4: timestamp path timestamp path")


def _pose_at(time: float, times: list[float], poses: list[np.ndarray]) -> np.ndarray | None:
    """The pose of that very time, or between its neighbours where both are near."""
    i = bisect.bisect_left(times, time)
    if i < len(times) and times[i] == time:
        return poses[i]
    if i == 0 or i == len(times):  # before the first pose or after the last: nothing to go between
        return None
    before, after = time - times[i - 1], times[i] - time
    if before > FARTHEST_POSE or after > FARTHEST_POSE:
        return None
    return between(poses[i - 1], poses[i], before / (before + after))


def _nearest(time: float, times: list[float]) -> str:
    i = bisect.bisect_left(times, time)
    off = min((other - time for other in times[max(0, i - 1) : i + 1]), key=abs)
    if abs(off) <= FARTHEST_POSE:
        return " on both sides"
    return f" (the nearest is {abs(off):.3f} s {'later' if off > 0 else 'earlier'})"
