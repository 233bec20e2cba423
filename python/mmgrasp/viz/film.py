"""A plan as an animation: the whole round at a constant pace, the camera over the robot."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._core import InvalidInput
from .._files import write_file
from .._progress import Progress
from .raster import Camera, render
from .scene import PlanScene

FRAMES = 160
SECONDS_PER_FRAME = 0.1
_SIZE = (480, 360)
_ABOVE, _AWAY, _FOCUS = 2.4, 2.8, 0.6  # the camera above the floor and from the base, and the height it looks at [m]
_DIRECTIONS = 8  # from which the camera may look


def write_gif(path: str | Path, pictures: Sequence[np.ndarray], seconds_per_frame: float) -> Path:
    """An endless animation."""
    from PIL import Image

    images = [Image.fromarray(p).quantize(64) for p in pictures]
    buffer = io.BytesIO()
    images[0].save(
        buffer, "GIF", save_all=True, append_images=images[1:], duration=round(1000 * seconds_per_frame), loop=0
    )
    write_file(Path(path), buffer.getvalue())
    return Path(path)


def write_film(plan: dict[str, Any], path: str | Path, frames: int = FRAMES, progress: Progress = None) -> Path:
    """The plan's whole round as an animated GIF. Raises InvalidInput for a plan without motions."""
    scene = PlanScene(plan)
    if not scene.timeline.segments:
        raise InvalidInput(f"{path}: a plan that was not found has no motions to show")
    times = np.linspace(0.0, scene.timeline.duration, frames)
    states = [scene.timeline.state_at(float(time)) for time in times]
    aside = _viewpoint(scene, np.array([state.base[:2] for state in states]))
    pictures = []
    for i, state in enumerate(states):
        if progress is not None:
            progress("film", i / frames)
        focus = np.array([*state.base[:2], scene.bodies.floor + _FOCUS])
        pictures.append(render(scene.at(state), Camera(focus + aside, focus, *_SIZE), background="#F7F7F5"))
    return write_gif(path, pictures, SECONDS_PER_FRAME)


def _viewpoint(scene: PlanScene, places: np.ndarray) -> np.ndarray:
    """From the base to the camera, the same all along so that the picture does not jump: the direction from which least is in the way."""
    angles = 2 * np.pi * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
    towards = np.column_stack([np.cos(angles), np.sin(angles)])
    low, high = scene.bounds()
    eyes = places[:, None] + _AWAY * towards
    room = np.minimum(eyes - low, high - eyes).min(axis=2).min(axis=0)  # how far inside of the room
    side = towards[int(np.argmax(room))]
    return np.array([*(_AWAY * side), _ABOVE - _FOCUS])
