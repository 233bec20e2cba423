"""Compares a plan with the maps its trays were scanned into: bodies with the surface, picked grasps with what pads meet there.

The bodies of a plan are boxes made from values of the map's field; here its mesh and rays through it are asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import _core
from .._core import IoError, LinkShape, ProbabilisticSdf
from .._core import verify as checks
from .._files import sha256_of
from ..documents.reading import Node
from ..scenario.map_bodies import inside_boxes, large_pieces
from ..scenario.scan_section import synthesis_options, tolerance
from ..scenario.shapes import shape_from_node
from .fingertip_pads import Fingertips, Pad, two_pads

_MOST_OFF = 0.1
"""A probability may differ by so much from the one found here: pads meet edges, and the part's middle is that of its boxes."""
_TRIPLES = 100
"""Planes through three points that are tried on what a pad meets."""
_FEWER = 0.15
"""Fewer of a pad's hits, as a share, than the search asked for may lie on a plane here: the pose differs a little."""
_MOST_WIDER = 0.004  # and so may the width from the distance of what the pads meet [m]


def check_scans(root: Node) -> list[checks.Fault]:
    """Faults of the trays that were scanned. Raises InvalidInput when a map is gone or another one now."""
    scenario = root["scenario"]
    if "scans" not in scenario:
        return []
    bodies = [_body(node) for key in ("obstacles", "parts") for node in scenario[key].elements()]
    faults: list[checks.Fault] = []
    covered: set[str] = set()
    trays = {tray["name"].raw for tray in scenario["trays"].elements()}
    for node in scenario["scans"].elements():
        if node["tray"].string() not in trays:
            node["tray"].fail("no such tray")
        sdf = _load(node)
        if node["map"].raw not in covered:
            covered.add(node["map"].raw)
            faults += _uncovered(node, sdf, bodies)
        faults += _improbable(root, node, sdf)
    return faults


def _body(node: Node) -> tuple[list[LinkShape], np.ndarray]:
    return [shape_from_node(shape) for shape in node["shapes"].elements()], node["pose"].pose()


def _load(node: Node) -> ProbabilisticSdf:
    path = node["map"].string()
    try:
        if sha256_of(path) != node["sha256"].string():
            node["map"].fail("the map has changed since the plan was made")
        return ProbabilisticSdf.load(str(Path(path)))
    except (OSError, IoError) as error:
        node["map"].fail(f"cannot be read, so that the plan cannot be compared with it: {error}")


def _uncovered(
    node: Node, sdf: ProbabilisticSdf, bodies: list[tuple[list[LinkShape], np.ndarray]]
) -> list[checks.Fault]:
    """Surface, as far out as the scenario's sigmas take it, that lies in or beside no body of the plan."""
    mesh, sigma = sdf.mesh()
    points, triangles = mesh.vertices, mesh.triangles
    outwards = np.minimum(node["sigmas"].number(least=0) * sigma, tolerance(sdf))[:, None] * _normals(points, triangles)
    left = np.ones(len(points), dtype=bool)
    for shapes, T in bodies:
        index = np.flatnonzero(left)
        grown = tolerance(sdf)
        inside = inside_boxes(points[index], shapes, T, grown) & inside_boxes(
            points[index] + outwards[index], shapes, T, 2 * grown
        )
        left[index[inside]] = False
    left = large_pieces(triangles, left)
    if not left.any():
        return []
    where = ", ".join(f"{x:.3f}" for x in points[np.flatnonzero(left)[0]])
    return [
        checks.Fault(
            "scan-uncovered",
            f"tray {node['tray'].raw}",
            f"{int(left.sum())} of {len(points)} points of the map's surface lie in no body of the plan, one of them at ({where})",
        )
    ]


def _normals(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    corners = points[triangles]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    out = np.zeros_like(points)
    for k in range(3):
        np.add.at(out, triangles[:, k], flat)
    lengths = np.linalg.norm(out, axis=1, keepdims=True)
    return np.asarray(out / np.where(lengths > 0, lengths, 1))


def _improbable(root: Node, scan: Node, sdf: ProbabilisticSdf) -> list[checks.Fault]:
    """Picked grasps whose probability or width is not what the map says."""
    parts = {node["name"].raw: node for node in root["scenario"]["parts"].elements()}
    faults = []
    tips = Fingertips(root["scenario"]) if "fingertips" in scan and scan["fingertips"].boolean() else None
    for number, pick in enumerate(root["picks"].elements()):
        if pick["tray"].raw != scan["tray"].raw or pick["part"].raw not in parts:
            continue  # another tray, or a fault that is said elsewhere
        part, index = parts[pick["part"].raw], pick["grasp"].integer()
        if not 0 <= index < len(part["grasps"].raw):
            continue
        grasp = part["grasps"].elements()[index]
        where = f"pick {number} ({part['name'].raw})"
        if "probability" not in grasp:
            faults.append(checks.Fault("grasp-probability", where, "its grasp of a scanned part has no probability"))
            continue
        claimed, width = grasp["probability"].number(least=0), grasp["opening"].number(least=0)
        found = _rated(root, scan, part, grasp, sdf, tips)
        if found is None:
            faults.append(
                checks.Fault("grasp-probability", where, "its pads meet no surface of the map, or slip on it")
            )
            continue
        probability, between, beside = found
        if abs(probability - claimed) > _MOST_OFF or claimed != grasp["quality"].number():
            text = f"the plan says {claimed:.3f} for its grasp, rays through the map give {probability:.3f}"
            faults.append(checks.Fault("grasp-probability", where, text))
        if abs(between - width) > _MOST_WIDER:
            text = f"its grasp says {width:.4f} m, in the map the pads meet the part at {between:.4f} m"
            faults.append(checks.Fault("grasp-opening", where, text))
        if beside > _MOST_WIDER:
            text = f"in the map the pads meet the part {beside:.4f} m beside the middle of the hand, whose fingers close alike"
            faults.append(checks.Fault("grasp-opening", where, text))
    return faults


def _rated(
    root: Node, scan: Node, part: Node, grasp: Node, sdf: ProbabilisticSdf, tips: Fingertips | None
) -> tuple[float, float, float] | None:
    """(4.9) of P3 with the criteria of docs/methods/grasp.md, what is between the surfaces that the pads meet, and how far their middle is from the hand's [m]."""
    gripper = root["scenario"]["gripper"]
    options = {key: default for key, (default, _) in _core._synthesis_option_table().items()}
    options |= synthesis_options(scan["grasp_options"])
    T_world_part = part["pose"].pose()
    T = T_world_part @ grasp["pose"].pose()
    clearance = gripper["clearance"].number(least=0)
    wide = min(grasp["opening"].number() + 2 * clearance, gripper["max_opening"].number())
    if tips is not None:
        wide = tips.within(wide)
    pads = two_pads(gripper, wide) if tips is None else tips.pads(wide)
    met = _patches(sdf, pads, T, wide, options)
    if tips is not None and met:
        # The search has the planes, not the first points, `clearance` away.
        wide = tips.within(wide - 2 * (float(np.mean([patch.distance for patch in met])) - clearance))
        pads = tips.pads(wide)
        met = _patches(sdf, pads, T, wide, options)
    if not met:
        return None
    cone = np.arctan(options["friction"])
    angle = float(np.prod([max(0.0, 1 - patch.slant / cone) for patch in met]))
    sure = float(np.prod([max(0.0, 1 - patch.sigma / options["max_sigma"]) for patch in met]))
    if angle <= 0 or sure <= 0:
        return None
    placement = np.exp(-sum(abs(patch.distance - clearance) for patch in met) / options["placement_scale"])
    # Pads of one side count as one, at their mean.
    closing = np.array(gripper["closing"].numbers(3))
    sides = [
        [q for pad, q in zip(pads, met, strict=True) if (pad.push @ closing < 0) == side] for side in (True, False)
    ]
    if not all(sides):
        return None
    a, b = (np.mean([patch.middle for patch in side], axis=0) for side in sides)
    # Fingertips that move together stop at what they meet first; two flat pads at a face.
    d_a, d_b = (float(np.mean([q.nearest for q in side])) for side in sides)
    bounds = [LinkShape(s.shape, T_world_part @ s.pose).bounds for s in _body(part)[0]]
    low, high = np.min([x for x, _ in bounds], axis=0), np.max([x for _, x in bounds], axis=0)
    off = np.linalg.norm(np.cross((low + high) / 2 - a, b - a)) / np.linalg.norm(b - a)
    centring = max(0.0, 1 - off / ((high - low).max() / 2))
    weights = [options[f"{key}_weight"] for key in ("angle", "placement", "centring", "certainty")]
    return float(np.dot(weights, [angle, placement, centring, sure])), wide - d_a - d_b, abs(d_a - d_b) / 2


@dataclass(frozen=True)
class _Patch:
    """What the rays of a pad meet."""

    middle: np.ndarray
    slant: float
    """The angle of the surface to the pad [rad]."""
    distance: float
    """How far the plane is [m]."""
    nearest: float
    """How far the first point is [m]."""
    sigma: float


def _patches(
    sdf: ProbabilisticSdf, pads: list[Pad], T_world_hand: np.ndarray, reach: float, options: dict[str, float]
) -> list[_Patch]:
    """What each pad meets; empty where one meets too little."""
    patches = [_patch(sdf, pad, T_world_hand, reach, options) for pad in pads]
    return [patch for patch in patches if patch is not None] if None not in patches else []


def _patch(
    sdf: ProbabilisticSdf, pad: Pad, T_world_hand: np.ndarray, reach: float, options: dict[str, float]
) -> _Patch | None:
    origins = pad.grid(int(options["rays"])) @ T_world_hand[:3, :3].T + T_world_hand[:3, 3]
    push = T_world_hand[:3, :3] @ pad.push
    hits = sdf.cast_rays(origins, np.tile(push, (len(origins), 1)))
    met = np.asarray(hits.hit, dtype=bool) & (np.nan_to_num(np.asarray(hits.distance), nan=np.inf) <= reach)
    if met.mean() < options["min_hits"] or met.sum() < 3:
        return None
    points, sigma, distance = (np.asarray(a)[met] for a in (hits.point, hits.sigma, hits.distance))
    near = _on_plane(points, options["plane_tolerance"])
    if near.mean() < options["min_inliers"] - _FEWER or near.sum() < 3:
        return None
    normal = _normal(points[near])
    slant = float(np.arccos(min(1.0, abs(float(normal @ push)))))
    return _Patch(
        points[near].mean(axis=0), slant, float(distance[near].mean()), float(distance.min()), float(sigma[near].mean())
    )


def _on_plane(points: np.ndarray, tolerance: float) -> np.ndarray:
    """Which points lie within `tolerance` of the plane that holds most: theirs, or one through three of them."""
    normals, through = [_normal(points)], [points.mean(axis=0)]
    rng = np.random.default_rng(1)  # the same answer each time
    for a, b, c in (points[rng.choice(len(points), 3, replace=False)] for _ in range(_TRIPLES)):
        across = np.cross(b - a, c - a)
        if (area := np.linalg.norm(across)) > 1e-9:
            normals.append(across / area)
            through.append(a)
    off = np.abs(np.einsum("kni,ki->kn", points - np.array(through)[:, None], np.array(normals)))
    best = np.asarray((off <= tolerance)[np.argmax((off <= tolerance).sum(axis=1))])
    again = np.abs((points - points[best].mean(axis=0)) @ _normal(points[best])) <= tolerance
    return again if again.sum() >= best.sum() else best


def _normal(points: np.ndarray) -> np.ndarray:
    """The normal of the least squares plane."""
    return np.asarray(np.linalg.svd(points - points.mean(axis=0))[2][2])
