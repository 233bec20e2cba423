"""Colours shared by every picture: a colour-blind-safe set (Okabe and Ito), the same colour for the same tray everywhere."""

from __future__ import annotations

import colorsys

TRAY_COLOURS = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00", "#B8A600", "#7A5195"]
STOP = "#C1121F"
ROUTE = "#333333"
OBSTACLE = "#A8A29A"
TRAY_BODY = "#D8C9A8"
PART = "#E07A1F"
ROBOT = "#C9D3DC"
ROBOT_ARM = "#3E6FA8"
FLOOR = "#F2F1ED"


def tray_colour(index: int) -> str:
    """Colour of the tray at this place in the plan's list of trays."""
    return TRAY_COLOURS[index % len(TRAY_COLOURS)]


def segment_colour(index: int) -> str:
    """Colour of a part's segment: eight that everybody can tell apart, then others around the circle."""
    return TRAY_COLOURS[index] if index < len(TRAY_COLOURS) else hue_colour((0.618 * index) % 1, 0.45, 0.8)


def hue_colour(hue: float, saturation: float, value: float) -> str:
    """'#RRGGBB' of numbers in [0, 1]."""
    red, green, blue = (round(255 * c) for c in colorsys.hsv_to_rgb(hue, saturation, value))
    return f"#{red:02X}{green:02X}{blue:02X}"


def rgb(colour: str) -> tuple[float, float, float]:
    """'#RRGGBB' as three numbers in [0, 1]."""
    return tuple(int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5))  # type: ignore[return-value]
