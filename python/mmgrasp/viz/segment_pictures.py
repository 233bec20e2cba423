"""Pictures of a part's segments, their primitives and shape diameters, from two opposite sides."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .._core import FittedPrimitive
from .legend import legend
from .png import write_png
from .primitive_bodies import primitive_body
from .style import hue_colour, segment_colour
from .two_sides import Body, two_sides

_SHADES = 12


def coloured(
    vertices: np.ndarray, triangles: np.ndarray, groups: np.ndarray, colour: Callable[[int], str]
) -> list[Body]:
    """One body for each group of triangles."""
    return [(vertices, triangles[groups == group], colour(int(group))) for group in np.unique(groups)]


def write_segment_pictures(
    vertices: np.ndarray,
    triangles: np.ndarray,
    labels: np.ndarray,
    names: Sequence[str],
    primitives: Sequence[FittedPrimitive],
    diameters: np.ndarray,
    folder: Path,
) -> None:
    """segments.png, a colour a segment with its name below, primitives.png, what stands for them in the same colours, and diameters.png, thin (blue)
    to thick (red) by rank."""
    write_png(folder / "segments.png", segment_picture(vertices, triangles, labels, names))
    bodies = [primitive_body(p.kind, p.size, p.T_mesh_primitive, segment_colour(i)) for i, p in enumerate(primitives)]
    write_png(folder / "primitives.png", two_sides(bodies))
    write_png(folder / "diameters.png", two_sides(diameter_bodies(vertices, triangles, diameters)))


def segment_picture(
    vertices: np.ndarray, triangles: np.ndarray, labels: np.ndarray, names: Sequence[str], side: int = 620
) -> NDArray[np.uint8]:
    """A part from two sides, a colour a segment, and below which name has which colour."""
    picture = two_sides(coloured(vertices, triangles, labels, segment_colour), side=side)
    entries = [(name, segment_colour(i)) for i, name in enumerate(names)]
    return np.concatenate([picture, legend(entries, picture.shape[1])], axis=0)


def diameter_bodies(vertices: np.ndarray, triangles: np.ndarray, diameters: np.ndarray) -> list[Body]:
    """Faces in twelve shades by their shape diameter, from thin (blue) to thick (red)."""
    shades = np.zeros(len(diameters), dtype=int)
    if np.ptp(diameters) > 0:
        share = (np.log(np.maximum(diameters, 1e-9)) - np.log(np.quantile(diameters[diameters > 0], 0.02))) / max(
            1e-9, np.log(np.quantile(diameters, 0.98) / np.quantile(diameters[diameters > 0], 0.02))
        )
        shades = np.clip(share * _SHADES, 0, _SHADES - 1).astype(int)

    def shade(index: int) -> str:
        return hue_colour(0.66 * (1 - index / (_SHADES - 1)), 0.75, 0.9)

    return coloured(vertices, triangles, shades, shade)
