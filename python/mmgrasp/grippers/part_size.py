"""Units of part files, and how large a part may be that a gripper takes: one rule for assemblies and for `mmgrasp segment`."""

from __future__ import annotations

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}  # [m]
SMALLEST_PART, LARGEST_PART = 0.001, 3.0  # from corner to corner [m]


def wrong_size(size: float, unit: str) -> str:
    """Why a part of this size [m] can be none that a gripper takes, and the units that would make it one; '' it can be."""
    if SMALLEST_PART <= size <= LARGEST_PART:
        return ""
    fits = [u for u, metres in UNITS.items() if SMALLEST_PART <= size / UNITS[unit] * metres <= LARGEST_PART / 2]
    meant = " or ".join(fits) or "another unit"
    return f"a part for a gripper is from {SMALLEST_PART:g} m to {LARGEST_PART:g} m: is {meant} meant?"
