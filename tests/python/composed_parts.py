"""Parts composed of known primitives, with the primitive that each face belongs to: the ground truth of the segmentation tests.

Solids are united exactly by manifold3d. A face belongs to the primitive whose solid lies right behind it, so walls of holes belong to what they are
drilled through; the faces of fillets belong to none (-1), for either neighbour is right. Lengths are millimetres here and metres in the mesh.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import manifold3d as m3
import numpy as np

SEGMENTS = 48
Inside = Callable[[np.ndarray], np.ndarray]


@dataclass
class Part:
    """`widths`: the diameter, the three lengths of a box, or the width and height of a hexagon, of each primitive [mm]."""

    name: str
    solid: m3.Manifold
    insides: list[Inside] = field(default_factory=list)
    widths: list[tuple[float, ...]] = field(default_factory=list)

    def add(self, solid: m3.Manifold, inside: Inside, *widths: float) -> None:
        self.solid = self.solid + solid
        self.insides.append(inside)
        self.widths.append(widths)

    def mesh(self, edge: float, noise: float = 0.0, seed: int = 0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Vertices [m], triangles and the primitive of each; edges of at most `edge` and vertices moved by `noise` [mm] (one standard deviation)."""
        got = self.solid.refine_to_length(edge).to_mesh()
        vertices, triangles = np.array(got.vert_properties, dtype=float)[:, :3], np.array(got.tri_verts)
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        areas = np.linalg.norm(normals, axis=1)
        triangles, normals = triangles[areas > 1e-9], normals[areas > 1e-9] / areas[areas > 1e-9, None]
        behind = vertices[triangles].mean(axis=1) - 0.02 * normals
        labels = np.full(len(triangles), -1)
        for k, inside in reversed(list(enumerate(self.insides))):
            labels[inside(behind)] = k
        vertices += noise * np.random.default_rng(seed).normal(size=vertices.shape)
        return 1e-3 * vertices, triangles, labels


def cylinder(radius: float, low: float, high: float, x: float = 0, y: float = 0) -> tuple[m3.Manifold, Inside]:
    solid = m3.Manifold.cylinder(high - low, radius, radius, SEGMENTS).translate((x, y, low))

    def inside(p: np.ndarray) -> np.ndarray:
        return (np.hypot(p[:, 0] - x, p[:, 1] - y) < radius) & (p[:, 2] > low) & (p[:, 2] < high)

    return solid, inside


def cone(radius: float, top: float, low: float, high: float) -> tuple[m3.Manifold, Inside]:
    solid = m3.Manifold.cylinder(high - low, radius, top, SEGMENTS).translate((0, 0, low))

    def inside(p: np.ndarray) -> np.ndarray:
        share = (p[:, 2] - low) / (high - low)
        return np.asarray((np.hypot(p[:, 0], p[:, 1]) < radius + share * (top - radius)) & (share > 0) & (share < 1))

    return solid, inside


def ball(radius: float, z: float) -> tuple[m3.Manifold, Inside]:
    solid = m3.Manifold.sphere(radius, SEGMENTS).translate((0, 0, z))
    return solid, lambda p: np.linalg.norm(p - [0, 0, z], axis=1) < radius


def box(size: tuple[float, float, float], low: tuple[float, float, float]) -> tuple[m3.Manifold, Inside]:
    solid = m3.Manifold.cube(size).translate(low)
    return solid, lambda p: np.all((p > np.array(low)) & (p < np.array(low) + size), axis=1)


def screw(crest: float, root: float, pitch: float, low: float, high: float) -> tuple[m3.Manifold, Inside]:
    """A right-handed screw thread of a trapezoidal profile, as a twisted cross-section."""
    turn = np.arange(SEGMENTS) / SEGMENTS
    height = np.interp(turn, [0, 0.125, 0.5, 0.625, 1], [1, 1, 0, 0, 1])
    radius = root + (crest - root) * height
    outline = np.column_stack([radius * np.cos(2 * np.pi * turn), radius * np.sin(2 * np.pi * turn)])
    turns = (high - low) / pitch
    section = m3.CrossSection([outline])
    solid = m3.Manifold.extrude(section, high - low, int(SEGMENTS * turns), 360 * turns).translate((0, 0, low))
    return solid, lambda p: (np.hypot(p[:, 0], p[:, 1]) < crest) & (p[:, 2] > low) & (p[:, 2] < high)


def hexagon(width: float, low: float, high: float) -> tuple[m3.Manifold, Inside]:
    angles = np.pi / 3 * np.arange(6)
    corner = width / np.sqrt(3)
    outline = corner * np.column_stack([np.cos(angles), np.sin(angles)])
    solid = m3.Manifold.extrude(m3.CrossSection([outline]), high - low).translate((0, 0, low))
    return solid, lambda p: (np.hypot(p[:, 0], p[:, 1]) < corner) & (p[:, 2] > low) & (p[:, 2] < high)


def fillet(radius: float, around: float, z: float, up: bool) -> m3.Manifold:
    """A rounded inward edge around a cylinder of radius `around` that stands on the plane at z (or hangs below it)."""
    arc = np.linspace(0, np.pi / 2, 9)
    outline = np.array(
        [
            [around - 0.5, -0.5],
            [around + radius, -0.5],
            *np.column_stack([around + radius - radius * np.sin(arc), radius - radius * np.cos(arc)]),
            [around - 0.5, radius],
        ]
    )
    ring = m3.Manifold.revolve(m3.CrossSection([outline], m3.FillRule.NonZero), SEGMENTS)
    return (ring if up else ring.mirror((0, 0, 1))).translate((0, 0, z))


def stepped_shaft(rng: np.random.Generator, bore: bool, fillets: bool, threaded: bool) -> Part:
    part = Part("shaft" + " bored" * bore + " filleted" * fillets + " threaded" * threaded, m3.Manifold())
    count = int(rng.integers(2, 5))
    radius, z = rng.uniform(5, 10), 0.0
    radii, heights = [], [z]
    for _ in range(count):
        factor = rng.uniform(1.3, 1.8)
        radius = radius * factor if (radius < 7 or rng.random() < 0.5) and radius * factor < 22 else radius / factor
        length = rng.uniform(6, 25)
        part.add(*cylinder(radius, z, z + length), 2 * radius)
        z += length
        radii.append(radius)
        heights.append(z)
    if threaded:
        crest = max(4.0, radii[-1] * 0.7)
        part.add(*screw(crest, crest - 0.9, 1.5, z, z + 12), 2 * crest)
        z += 12
    if fillets:
        for k in range(count - 1):
            if radii[k] > radii[k + 1]:
                part.solid = part.solid + fillet(rng.uniform(0.5, 1.2), radii[k + 1], heights[k + 1], up=True)
            else:
                part.solid = part.solid + fillet(rng.uniform(0.5, 1.2), radii[k], heights[k + 1], up=False)
    if bore:
        part.solid = part.solid - cylinder(0.5 * min(radii), -1, z + 1)[0]
    return part


def plate_with_bosses(rng: np.random.Generator) -> Part:
    part = Part("plate with bosses and holes", m3.Manifold())
    size = (rng.uniform(50, 90), rng.uniform(30, 60), rng.uniform(4, 10))
    part.add(*box(size, (0, 0, 0)), *size)
    places = [(0.25, 0.5), (0.75, 0.5)][: int(rng.integers(1, 3))]
    for u, v in places:
        radius, length = rng.uniform(4, 9), rng.uniform(6, 20)
        x, y = u * size[0], v * size[1]
        part.add(*cylinder(radius, size[2], size[2] + length, x, y), 2 * radius)
        if rng.random() < 0.5:
            part.solid = part.solid - cylinder(0.5 * radius, -1, size[2] + length + 1, x, y)[0]
    for u, v in [(0.1, 0.15), (0.9, 0.15), (0.1, 0.85), (0.9, 0.85)]:
        part.solid = part.solid - cylinder(2, -1, size[2] + 1, u * size[0], v * size[1])[0]
    return part


def block_with_pegs(rng: np.random.Generator) -> Part:
    part = Part("block with pegs", m3.Manifold())
    a, b, c = rng.uniform(20, 40, 3)
    part.add(*box((a, b, c), (-a / 2, -b / 2, -c / 2)), a, b, c)
    p, q, length = 0.4 * a, 0.35 * b, rng.uniform(8, 20)
    part.add(*box((p, q, length), (-p / 2, -q / 2, c / 2)), p, q, length)
    radius = rng.uniform(0.15, 0.35) * min(a, b)
    part.add(*cylinder(radius, -c / 2 - rng.uniform(8, 25), -c / 2), 2 * radius)
    if rng.random() < 0.5:  # a blind hole
        part.solid = part.solid - cylinder(0.5 * radius, -1000, -c / 2 + 3)[0]
    return part


def flanged_bush(rng: np.random.Generator) -> Part:
    part = Part("flanged bush", m3.Manifold())
    radius, flange = rng.uniform(8, 14), rng.uniform(18, 28)
    thick, length = rng.uniform(3, 8), rng.uniform(12, 30)
    part.add(*cylinder(flange, 0, thick), 2 * flange)
    part.add(*cylinder(radius, thick, thick + length), 2 * radius)
    part.solid = part.solid - cylinder(rng.uniform(0.5, 0.75) * radius, -1, thick + length + 1)[0]
    for k in range(4):
        x, y = 0.5 * (radius + flange) * np.cos(k * np.pi / 2), 0.5 * (radius + flange) * np.sin(k * np.pi / 2)
        part.solid = part.solid - cylinder(1.5, -1, thick + 1, x, y)[0]
    return part


def bolt(rng: np.random.Generator) -> Part:
    part = Part("bolt", m3.Manifold())
    crest = rng.uniform(3, 8)
    pitch = rng.uniform(0.17, 0.25) * crest
    part.add(*hexagon(3.4 * crest, 0, 1.4 * crest), 3.4 * crest, 1.4 * crest)
    part.add(*screw(crest, crest - 0.6 * pitch, pitch, 1.4 * crest, 1.4 * crest + 8 * pitch), 2 * crest)
    return part


def pulley(rng: np.random.Generator) -> Part:
    part = Part("pulley", m3.Manifold())
    radius, width = rng.uniform(10, 16), rng.uniform(8, 14)
    hub, flange = rng.uniform(0.4, 0.6) * radius, rng.uniform(1.3, 1.6) * radius
    part.add(*cylinder(radius, 0, width), 2 * radius)
    part.add(*cylinder(flange, -3, 0), 2 * flange)
    part.add(*cylinder(flange, width, width + 3), 2 * flange)
    part.add(*cylinder(hub, width + 3, width + 12), 2 * hub)
    part.solid = part.solid - cylinder(0.5 * hub, -4, width + 13)[0]
    return part


def ball_rod(rng: np.random.Generator) -> Part:
    part = Part("ball and cone on a rod", m3.Manifold())
    radius, length = rng.uniform(3, 6), rng.uniform(20, 40)
    sphere = rng.uniform(1.5, 2.2) * radius
    part.add(*cylinder(radius, 0, length), 2 * radius)
    part.add(*ball(sphere, length + 0.8 * sphere), 2 * sphere)
    base = rng.uniform(1.5, 2.2) * radius
    part.add(*cone(0.3 * base, base, -2 * base, 0), 2 * base)
    return part


def composed_parts(count: int = 50, seed: int = 7) -> list[tuple[Part, float]]:
    """Parts and the noise of each [mm]: every kind once without, then once with, and so on."""
    out = []
    for k in range(count):
        rng = np.random.default_rng((seed, k))
        kinds: list[Callable[[np.random.Generator], Part]] = [
            lambda rng: stepped_shaft(rng, False, False, False),
            lambda rng: stepped_shaft(rng, True, False, False),
            lambda rng: stepped_shaft(rng, False, True, False),
            lambda rng: stepped_shaft(rng, False, False, True),
            plate_with_bosses,
            block_with_pegs,
            flanged_bush,
            bolt,
            pulley,
            ball_rod,
        ]
        out.append((kinds[k % len(kinds)](rng), 0.02 if (k // len(kinds)) % 2 else 0.0))
    return out


def faces_right(truth: np.ndarray, found: np.ndarray) -> float:
    """Share of faces whose segment is the one that stands for their primitive, each segment for one primitive at most (the best such choice, greedily)."""
    counted = truth >= 0
    table = np.zeros((truth.max() + 1, found.max() + 1), dtype=int)
    np.add.at(table, (truth[counted], found[counted]), 1)
    right = 0
    for _ in range(min(table.shape)):
        row, column = np.unravel_index(table.argmax(), table.shape)
        right += table[row, column]
        table[row, :] = table[:, column] = 0
    return float(right / counted.sum())
