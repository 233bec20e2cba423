"""Poses as text files give them: rounded, sometimes inverted, sometimes none."""

from __future__ import annotations

import math

import numpy as np

from .._core import InvalidInput, pose

EXACT = 1e-6  # largest entry of R^T R - 1 that counts as a rotation
ROUNDED = 2e-3  # and what a file with few digits may have


def rigid(T: np.ndarray, what: str) -> np.ndarray:
    """The pose (4, 4) itself, or with the nearest rotation where its digits were rounded. Raises InvalidInput naming `what`."""
    if not np.isfinite(T).all():
        raise InvalidInput(f"{what}: must be finite numbers (the tracking was lost there)")
    if np.abs(T[3] - [0, 0, 0, 1]).max() > 1e-9:
        raise InvalidInput(f"{what}: the last row must be 0 0 0 1, not {' '.join(f'{x:g}' for x in T[3])}")
    R = T[:3, :3]
    with np.errstate(over="ignore", invalid="ignore"):
        skew = float(np.abs(R.T @ R - np.eye(3)).max())
    if not skew <= ROUNDED:
        raise InvalidInput(
            f"{what}: is no rotation: largest entry of R^T R - 1 is {skew:.3g}, must be at most {ROUNDED:g}"
        )
    if np.linalg.det(R) < 0:
        raise InvalidInput(f"{what}: is a mirror image, no rotation: its determinant must be +1")
    if np.abs(T[:3, 3]).max() > 1e6:
        raise InvalidInput(f"{what}: the position must lie within 1e6 m")
    out = T.copy()
    if skew > EXACT:
        left, _, right = np.linalg.svd(R)
        out[:3, :3] = left @ right
    return out


def numbers(text: str, what: str) -> list[float]:
    """Numbers separated by blanks or commas. Raises InvalidInput naming `what` and the word."""
    out = []
    for word in text.replace(",", " ").split():
        try:
            if "_" in word:
                raise ValueError
            out.append(float(word))
        except ValueError:
            # the C library of Windows writes -1.#IND and 1.#INF
            if "#" not in word:
                raise InvalidInput(f"{what}: {word[:40]!r} is no number") from None
            out.append(math.nan)
    return out


def matrix(text: str, rows: int, what: str) -> np.ndarray:
    """(rows, rows) numbers, row by row."""
    values = numbers(text, what)
    if len(values) != rows * rows:
        raise InvalidInput(f"{what}: holds {len(values)} numbers, must hold {rows} x {rows}")
    return np.array(values, dtype=float).reshape(rows, rows)


def pose_of_quaternion(xyz: list[float], quat_xyzw: list[float], what: str) -> np.ndarray:
    """(4, 4) of a position and a quaternion with few digits."""
    norm = math.sqrt(sum(x * x for x in quat_xyzw)) if all(abs(x) < 1e3 for x in quat_xyzw) else math.nan
    if not all(math.isfinite(x) and abs(x) <= 1e6 for x in xyz) or not math.isfinite(norm):
        raise InvalidInput(f"{what}: must be finite numbers, positions within 1e6 m")
    if abs(norm - 1) > 1e-2:
        raise InvalidInput(f"{what}: the quaternion qx qy qz qw has norm {norm:.4g}, must have norm 1")
    return pose(xyz, quat_xyzw=quat_xyzw if abs(norm - 1) <= EXACT else [x / norm for x in quat_xyzw])


def between(first: np.ndarray, second: np.ndarray, share: float) -> np.ndarray:
    """The pose at `share` in [0, 1] of the way: positions along a line, rotations about one axis."""
    turn = first[:3, :3].T @ second[:3, :3]
    angle = math.acos(min(1.0, max(-1.0, (float(np.trace(turn)) - 1) / 2)))
    out = np.eye(4)
    out[:3, 3] = (1 - share) * first[:3, 3] + share * second[:3, 3]
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    length = float(np.linalg.norm(axis))
    if length < 1e-12:  # no turn, or half a one, about which two rotations say nothing
        out[:3, :3] = first[:3, :3] if share < 0.5 else second[:3, :3]
        return out
    x, y, z = axis / length
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    partial = np.eye(3) + math.sin(share * angle) * K + (1 - math.cos(share * angle)) * K @ K
    out[:3, :3] = first[:3, :3] @ partial
    return out


def inverse(T: np.ndarray) -> np.ndarray:
    """Inverse of a rigid motion."""
    out = np.eye(4)
    out[:3, :3] = T[:3, :3].T
    out[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return out
