"""7-Scenes: frame-000000.depth.png beside frame-000000.pose.txt, 1000 units in a metre, 65535 where nothing was measured."""

from __future__ import annotations

from pathlib import Path

from .frame import Frame

DEPTH_SCALE = 1000.0
IMAGE, POSE = ".depth.png", ".pose.txt"
BESIDE = (".color.png", ".rgb.png")  # other images that belong to a frame


def found(folder: Path) -> bool:
    """Whether a folder has images or poses named as 7-Scenes does."""
    return any(folder.glob(f"*{IMAGE}")) or any(folder.glob(f"*{POSE}"))


def frames(folder: Path, root: Path, sensor: str) -> list[Frame]:
    """Frames in the order of their names, each with its pose file."""
    below = folder.relative_to(root)
    images = {path.name.removesuffix(IMAGE): path for path in folder.glob(f"*{IMAGE}")}
    poses = {path.name.removesuffix(POSE): path for path in folder.glob(f"*{POSE}")}
    out = []
    for stem in sorted(images.keys() | poses.keys()):
        name = (below / f"{stem}{IMAGE}").as_posix()
        problem = ""
        if stem not in poses:
            problem = f"half a frame: {stem}{POSE} is not there"
        elif stem not in images:
            problem = "half a frame: there is a pose, but no depth image"
        out.append(Frame(name, folder / f"{stem}{IMAGE}", sensor, poses.get(stem), problem))
    known = tuple(path.name for path in images.values())
    for path in sorted(folder.glob("*.png")):
        if path.name not in known and not path.name.endswith(BESIDE):
            name = (below / path.name).as_posix()
            out.append(Frame(name, path, sensor, problem=f"foreign: depth images are called NAME{IMAGE}"))
    return out
