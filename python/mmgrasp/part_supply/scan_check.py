"""Compares a plan with the maps its trays were scanned into: bodies with the surface, picked grasps with what pads meet there.

The bodies of a plan are boxes made from values of the map's field; here its mesh and rays through it are asked.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .. import _core
from .._core import IoError, LinkShape, ProbabilisticSdf
from .._core import verify as checks
from .._files import sha256_of
from ..documents.reading import Node
from ..scenario.map_bodies import inside_boxes, large_pieces
from ..scenario.scan_section import tolerance
from ..scenario.shapes import shape_from_node

_MOST_OFF = 0.1
"""A probability may differ by so much from the one found here: pads meet edges, and the part's middle is that of its boxes."""
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
        found = _pads(root, scan, part, grasp, sdf)
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


def _pads(root: Node, scan: Node, part: Node, grasp: Node, sdf: ProbabilisticSdf) -> tuple[float, float, float] | None:
    """(4.9) of P3 with the criteria of docs/methods/grasp.md, what is between the surfaces that the pads meet, and how far their middle is from the hand's [m]."""
    gripper = root["scenario"]["gripper"]
    options = {key: default for key, (default, _) in _core._synthesis_option_table().items()}
    options |= dict(scan["grasp_options"].raw)
    T_world_part = part["pose"].pose()
    T = T_world_part @ grasp["pose"].pose()
    approach, closing = (np.array(gripper[key].numbers(3)) for key in ("approach", "closing"))
    clearance = gripper["clearance"].number(least=0)
    wide = min(grasp["opening"].number() + 2 * clearance, gripper["max_opening"].number())
    n = int(options["rays"])
    steps = (np.arange(n) + 0.5) / n - 0.5
    u, v = np.meshgrid(
        steps * gripper["finger_depth"].number(), steps * gripper["finger_width"].number(), indexing="ij"
    )
    pad = u.reshape(-1, 1) * approach + v.reshape(-1, 1) * np.cross(approach, closing)
    patches = []
    for side in (1.0, -1.0):
        origins = (pad + side * wide / 2 * closing) @ T[:3, :3].T + T[:3, 3]
        push = T[:3, :3] @ (-side * closing)
        hits = sdf.cast_rays(origins, np.tile(push, (len(origins), 1)))
        met = np.asarray(hits.hit, dtype=bool) & (np.nan_to_num(np.asarray(hits.distance), nan=np.inf) <= wide)
        if met.mean() < options["min_hits"]:
            return None
        points, sigma, distance = (np.asarray(a)[met] for a in (hits.point, hits.sigma, hits.distance))
        own = np.abs(distance - np.median(distance)) <= 3 * options["plane_tolerance"]
        normal = np.linalg.svd(points[own] - points[own].mean(axis=0))[2][2]
        near = np.abs((points - points[own].mean(axis=0)) @ normal) <= options["plane_tolerance"]
        normal = np.linalg.svd(points[near] - points[near].mean(axis=0))[2][2]
        beta = np.arccos(min(1.0, abs(float(normal @ push))))
        patches.append((points[near].mean(axis=0), beta, float(distance[near].mean()), float(sigma[near].mean())))
    (a, beta_a, d_a, sigma_a), (b, beta_b, d_b, sigma_b) = patches
    cone = np.arctan(options["friction"])
    angle = max(0.0, 1 - beta_a / cone) * max(0.0, 1 - beta_b / cone)
    sure = max(0.0, 1 - sigma_a / options["max_sigma"]) * max(0.0, 1 - sigma_b / options["max_sigma"])
    if angle <= 0 or sure <= 0:
        return None
    placement = np.exp(-(abs(d_a - clearance) + abs(d_b - clearance)) / options["placement_scale"])
    bounds = [LinkShape(s.shape, T_world_part @ s.pose).bounds for s in _body(part)[0]]
    low, high = np.min([x for x, _ in bounds], axis=0), np.max([x for _, x in bounds], axis=0)
    off = np.linalg.norm(np.cross((low + high) / 2 - a, b - a)) / np.linalg.norm(b - a)
    centring = max(0.0, 1 - off / ((high - low).max() / 2))
    weights = [options[f"{key}_weight"] for key in ("angle", "placement", "centring", "certainty")]
    return (
        float(np.dot(weights, [angle, placement, centring, sure])),
        float(wide - d_a - d_b),
        float(abs(d_a - d_b) / 2),
    )
