"""Rotations as vectors, and poses half way."""

from __future__ import annotations

import numpy as np


def rotation_vector(R: np.ndarray) -> np.ndarray:
    """Axis times angle of a rotation (3, 3), the angle at most half a turn [rad]."""
    cosine = float(np.clip((np.trace(R) - 1) / 2, -1, 1))
    skew = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2
    angle = float(np.arctan2(np.linalg.norm(skew), cosine))
    if angle < 1e-12:
        return np.zeros(3)
    if np.pi - angle > 1e-6:
        out: np.ndarray = skew * (angle / np.linalg.norm(skew))
        return out
    column = int(np.argmax(np.diag(R)))  # half a turn: the axis is in the symmetric part
    axis = R[:, column] + np.eye(3)[:, column]
    axis = axis / np.linalg.norm(axis)
    return angle * (axis if axis @ skew >= 0 else -axis)


def rotation_about(vector: np.ndarray) -> np.ndarray:
    """The rotation (3, 3) of a vector that is axis times angle [rad] (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-15:
        return np.eye(3)
    x, y, z = np.asarray(vector) / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    out: np.ndarray = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * (K @ K)
    return out


def rotation_vectors(R: np.ndarray) -> np.ndarray:
    """The vectors (n, 3) of rotations (n, 3, 3) [rad]. Near half a turn their directions lose digits, their lengths do not."""
    skew = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=1) / 2
    sine = np.linalg.norm(skew, axis=1)
    angle = np.arctan2(sine, (np.trace(R, axis1=1, axis2=2) - 1) / 2)
    unit = np.where(sine[:, None] > 1e-12, skew / np.maximum(sine, 1e-12)[:, None], [1.0, 0.0, 0.0])
    out: np.ndarray = angle[:, None] * unit
    return out


def rotations_about(vectors: np.ndarray) -> np.ndarray:
    """The rotations (n, 3, 3) of vectors (n, 3) [rad] (Rodrigues)."""
    angle = np.linalg.norm(vectors, axis=1)
    x, y, z = (vectors / np.maximum(angle, 1e-15)[:, None]).T
    zero = np.zeros_like(x)
    K = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    out: np.ndarray = np.eye(3) + np.sin(angle)[:, None, None] * K + (1 - np.cos(angle))[:, None, None] * (K @ K)
    return out


def between(a: np.ndarray, b: np.ndarray, share: float) -> np.ndarray:
    """The pose (4, 4) on the straight way from a to b that turns evenly about one axis; `share` in [0, 1]."""
    T = np.eye(4)
    T[:3, 3] = (1 - share) * a[:3, 3] + share * b[:3, 3]
    T[:3, :3] = a[:3, :3] @ rotation_about(share * rotation_vector(a[:3, :3].T @ b[:3, :3]))
    return T
