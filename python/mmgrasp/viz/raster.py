"""A small software renderer: triangles with a z-buffer, flat shading and outlines, so that pictures need no display."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .style import rgb


@dataclass
class Camera:
    """A pinhole camera looking from `eye` to `target`, z up. Lengths in metres, `fov` in degrees (vertical)."""

    eye: np.ndarray
    target: np.ndarray
    width: int = 1100
    height: int = 800
    fov: float = 40.0

    def project(self, points: np.ndarray) -> np.ndarray:
        """World points (n, 3) to (column, row, depth along the view axis), shape (n, 3)."""
        forward = self.target - self.eye
        forward = forward / np.linalg.norm(forward)
        right = np.cross(forward, [0.0, 0.0, 1.0])
        norm = np.linalg.norm(right)
        right = np.array([0.0, -1.0, 0.0]) if norm < 1e-9 else right / norm
        down = np.cross(forward, right)
        local = (points - self.eye) @ np.stack([right, down, forward], axis=1)
        focal = 0.5 * self.height / np.tan(np.radians(self.fov) / 2)
        depth = np.maximum(local[:, 2], 1e-6)
        return np.stack(
            [self.width / 2 + focal * local[:, 0] / depth, self.height / 2 + focal * local[:, 1] / depth, local[:, 2]],
            axis=1,
        )


@dataclass
class Scene:
    """Coloured triangle bodies in world coordinates."""

    vertices: list[np.ndarray] = field(default_factory=list)
    faces: list[np.ndarray] = field(default_factory=list)
    colours: list[tuple[float, float, float]] = field(default_factory=list)

    def add(self, vertices: np.ndarray, faces: np.ndarray, colour: str) -> None:
        """Adds one body: vertices (n, 3) [m], faces (m, 3) vertex indices."""
        self.vertices.append(np.asarray(vertices, dtype=float))
        self.faces.append(np.asarray(faces, dtype=int))
        self.colours.append(rgb(colour))


LIGHT = np.array([0.35, -0.5, 0.79])
NEAR = 0.05


def render(scene: Scene, camera: Camera, background: str = "#FFFFFF", supersample: int = 2) -> np.ndarray:
    """Picture of the scene as uint8 (height, width, 3)."""
    big = Camera(camera.eye, camera.target, camera.width * supersample, camera.height * supersample, camera.fov)
    image = np.empty((big.height, big.width, 3), dtype=np.float32)
    image[:] = rgb(background)
    nearness = np.zeros((big.height, big.width), dtype=np.float32)  # 1 / depth
    body_of = np.full((big.height, big.width), -1, dtype=np.int32)
    for body, (vertices, faces, colour) in enumerate(zip(scene.vertices, scene.faces, scene.colours, strict=True)):
        if len(faces):
            _draw_body(big, vertices, faces, np.array(colour), body, image, nearness, body_of)
    _draw_outlines(image, nearness, body_of)
    small = image.reshape(camera.height, supersample, camera.width, supersample, 3).mean(axis=(1, 3))
    return np.asarray((np.clip(small, 0, 1) * 255 + 0.5).astype(np.uint8))


def _draw_body(
    camera: Camera,
    vertices: np.ndarray,
    faces: np.ndarray,
    colour: np.ndarray,
    body: int,
    image: np.ndarray,
    nearness: np.ndarray,
    body_of: np.ndarray,
) -> None:
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    keep = lengths > 1e-14
    normals = normals[keep] / lengths[keep, None]
    corners = corners[keep]
    towards = camera.eye - corners.mean(axis=1)
    facing = np.einsum("ij,ij->i", normals, towards) < 0
    normals[facing] *= -1  # both sides are shaded: open meshes have no inside
    view = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    headlight = np.abs(np.einsum("ij,ij->i", normals, view))
    shade = 0.56 + 0.26 * np.clip(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0, 1) + 0.2 * headlight
    screen = camera.project(corners.reshape(-1, 3)).reshape(-1, 3, 3)
    low = np.floor(screen[:, :, :2].min(axis=1)).astype(int)
    high = np.ceil(screen[:, :, :2].max(axis=1)).astype(int)
    visible = (
        (screen[:, :, 2].min(axis=1) > NEAR)
        & (high[:, 0] >= 0)
        & (high[:, 1] >= 0)
        & (low[:, 0] < camera.width)
        & (low[:, 1] < camera.height)
    )
    for t in np.nonzero(visible)[0]:
        _draw_triangle(screen[t], low[t], high[t], np.minimum(colour * shade[t], 1.0), body, image, nearness, body_of)


def _draw_triangle(
    corners: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    colour: np.ndarray,
    body: int,
    image: np.ndarray,
    nearness: np.ndarray,
    body_of: np.ndarray,
) -> None:
    height, width = nearness.shape
    x0, y0 = max(low[0], 0), max(low[1], 0)
    x1, y1 = min(high[0] + 1, width), min(high[1] + 1, height)
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = corners
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if abs(area) < 1e-12 or x1 <= x0 or y1 <= y0:
        return
    # Barycentric weights and 1 / depth are linear over the picture: one addition a pixel each.
    x = (np.arange(x0, x1) + (0.5 - ax)) / area
    y = ((np.arange(y0, y1) + (0.5 - ay)) / area)[:, None]
    u = (x * (cy - ay)).astype(np.float32) - (y * (cx - ax)).astype(np.float32)
    v = (y * (bx - ax)).astype(np.float32) - (x * (by - ay)).astype(np.float32)
    near = np.float32(1 / az) + u * np.float32(1 / bz - 1 / az) + v * np.float32(1 / cz - 1 / az)
    window = (slice(y0, y1), slice(x0, x1))
    closer = (u >= -1e-6) & (v >= -1e-6) & (u + v <= 1 + 1e-6) & (near > nearness[window])
    nearness[window][closer] = near[closer]
    image[window][closer] = colour
    body_of[window][closer] = body


def _draw_outlines(image: np.ndarray, nearness: np.ndarray, body_of: np.ndarray) -> None:
    """Darkens pixels where the body or, within one, the depth changes abruptly."""
    edge = np.zeros(nearness.shape, dtype=bool)
    finite = 1 / np.maximum(nearness, 1e-3)
    for axis in (0, 1):
        change = np.diff(body_of, axis=axis) != 0
        jump = np.abs(np.diff(finite, axis=axis)) > 0.06
        lines = change | jump
        if axis == 0:
            edge[1:] |= lines
        else:
            edge[:, 1:] |= lines
    image[edge] *= 0.55
