"""The plan seen from above, as SVG: regions, intersections, stops, route. Crisp at any size, with titles on hover."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

import numpy as np

from ..bodies import Body, stored_pose, stored_shape
from ..part_supply.drives import all_drives
from .style import OBSTACLE, PART, ROUTE, STOP, TRAY_BODY, tray_colour

SCALE = 120.0  # pixels a metre
CHI_SQUARED_95 = 5.991  # of two degrees of freedom


def footprint(shapes: list[dict[str, Any]], pose: dict[str, Any]) -> list[np.ndarray]:
    """Outlines (n, 2) of a body's shapes seen from above."""
    T_body = stored_pose(pose)
    outlines = []
    for shape in shapes:
        T = T_body @ stored_pose(shape["pose"])
        kind = shape["type"]
        if kind == "box":
            half = np.asarray(shape["size"], float) / 2
            corners = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]) * half
        elif kind in ("cylinder", "capsule"):
            angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
            half_length = float(shape["length"]) / 2 + (float(shape["radius"]) if kind == "capsule" else 0.0)
            ring = np.stack([np.cos(angles), np.sin(angles)], axis=1) * float(shape["radius"])
            corners = np.concatenate([np.c_[ring, np.full(24, z)] for z in (-half_length, half_length)])
        elif kind == "sphere":
            angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
            corners = np.c_[np.cos(angles), np.sin(angles), np.zeros(24)] * float(shape["radius"])
            T = T.copy()
            T[:3, :3] = np.eye(3)
        else:
            corners = Body("", (stored_shape({**shape, "pose": {"xyz": [0, 0, 0]}}),), np.eye(4)).vertices
        outlines.append(convex_outline((corners @ T[:3, :3].T + T[:3, 3])[:, :2]))
    return outlines


def convex_outline(points: np.ndarray) -> np.ndarray:
    """Convex hull of points (n, 2), counter-clockwise (monotone chain)."""
    ordered = sorted((float(x), float(y)) for x, y in np.round(points, 9))

    def chain(sequence: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
        hull: list[tuple[float, float]] = []
        for p in sequence:
            while len(hull) > 1 and _turn(hull[-2], hull[-1], p) <= 0:
                hull.pop()
            hull.append(p)
        return hull[:-1]

    outline = chain(ordered) + chain(reversed(ordered))
    return np.array(outline or ordered[:1])


def _turn(o: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])


def layer_mask(plan: dict[str, Any], region: dict[str, Any], layer: int) -> np.ndarray:
    """Cells (ny, nx) of one region at one heading."""
    mask = np.zeros((plan["grid"]["ny"], plan["grid"]["nx"]), dtype=bool)
    for iy, start, end in region["cells"].get(str(layer), []):
        mask[iy, start:end] = True
    return mask


def shared_cells(plan: dict[str, Any], intersection: dict[str, Any]) -> np.ndarray:
    """Cells (ny, nx) that all regions of an intersection share."""
    regions = {region["tray"]: region for region in plan["regions"]}
    masks = [layer_mask(plan, regions[tray], intersection["heading"]) for tray in intersection["trays"]]
    return np.asarray(np.logical_and.reduce(masks))


def outline_edges(mask: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Edges (ix0, iy0, ix1, iy1) between cells inside and outside, in cell corners; runs along a line are joined."""
    padded = np.pad(mask, 1)
    edges = []
    for vertical in (False, True):
        grid = padded.T if vertical else padded
        change = grid[1:, :] != grid[:-1, :]
        for line, row in enumerate(change):
            steps = np.flatnonzero(np.diff(np.concatenate([[False], row, [False]]).astype(int)))
            for start, end in zip(steps[::2] - 1, steps[1::2] - 1, strict=True):
                a, b, c, d = int(start), line, int(end), line
                edges.append((b, a, d, c) if vertical else (a, b, c, d))
    return edges


def stop_intersections(plan: dict[str, Any]) -> list[dict[str, Any]]:
    """The intersections of two or more regions that the stops use."""
    used = [plan["intersections"][stop["intersection"]] for stop in plan["stops"] if stop["intersection"] >= 0]
    return [item for item in used if len(item["trays"]) > 1]


def arrival_ellipse(covariance: list[list[float]]) -> tuple[float, float, float]:
    """Half axes [m] of the ellipse in which 95 of 100 arrivals come to stand, and how far the first is turned from x [deg]."""
    variances, axes = np.linalg.eigh(np.array(covariance)[:2, :2])
    across, along = np.sqrt(CHI_SQUARED_95 * np.maximum(variances, 0))
    return float(along), float(across), float(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])))


def sure(stop: dict[str, Any]) -> str:
    """How likely a stop serves all its parts, as the end of a sentence."""
    seen = stop.get("arrivals")
    return f"; all parts from {100 * seen['served'] / seen['drawn']:.1f} % of the arrivals" if seen else ""


class TopView:
    """Builds the SVG of one plan."""

    def __init__(self, plan: dict[str, Any]):
        self.plan = plan
        self.scenario = plan["scenario"]
        self.tray_index = {tray["name"]: i for i, tray in enumerate(self.scenario["trays"])}
        self.low, self.high = self._bounds()
        self.items: list[str] = []

    def _bounds(self) -> tuple[np.ndarray, np.ndarray]:
        points = [np.asarray(self.scenario[key][:2], float) for key in ("start", "goal")]
        for obstacle in self.scenario["obstacles"]:
            for outline in footprint(obstacle["shapes"], obstacle["pose"]):
                points += [outline.min(axis=0), outline.max(axis=0)]
        for leg in all_drives(self.plan):
            points += [np.asarray(p[:2], float) for p in leg["poses"]]
        stacked = np.array(points)
        return stacked.min(axis=0) - 0.25, stacked.max(axis=0) + 0.25

    def point(self, xy: Sequence[float] | np.ndarray) -> tuple[float, float]:
        """World [m] to picture [px]."""
        return (float(xy[0]) - self.low[0]) * SCALE, (self.high[1] - float(xy[1])) * SCALE

    def svg(self) -> str:
        """The whole picture."""
        self.items = []
        self._grid_lines()
        self._regions()
        self._intersections()
        self._bodies()
        self._route()
        self._stops()
        self._ends()
        self._labels()
        width, height = (self.high - self.low) * SCALE
        name = escape(self.scenario.get("name", "plan"))
        return (
            f'<svg class="topview" viewBox="0 0 {width:.0f} {height:.0f}" role="img" '
            f'aria-label="Top view of {name}" xmlns="http://www.w3.org/2000/svg">' + "".join(self.items) + "</svg>"
        )

    def _polygon(self, outline: np.ndarray, attributes: str, title: str = "") -> None:
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in map(self.point, outline))
        body = f"<title>{escape(title)}</title>" if title else ""
        self.items.append(f'<polygon points="{points}" {attributes}>{body}</polygon>')

    def _grid_lines(self) -> None:
        width, height = (self.high - self.low) * SCALE
        for x in range(int(np.ceil(self.low[0])), int(np.floor(self.high[0])) + 1):
            px = self.point((x, 0))[0]
            self.items.append(f'<line x1="{px:.1f}" y1="0" x2="{px:.1f}" y2="{height:.0f}" class="grid"/>')
            self.items.append(f'<text x="{px + 3:.1f}" y="{height - 4:.0f}" class="axis">{x} m</text>')
        for y in range(int(np.ceil(self.low[1])), int(np.floor(self.high[1])) + 1):
            py = self.point((0, y))[1]
            self.items.append(f'<line x1="0" y1="{py:.1f}" x2="{width:.0f}" y2="{py:.1f}" class="grid"/>')
            self.items.append(f'<text x="3" y="{py - 3:.1f}" class="axis">{y} m</text>')

    def _regions(self) -> None:
        grid = self.plan["grid"]
        h = grid["resolution"]
        for region in self.plan["regions"]:
            index = self.tray_index[region["tray"]]
            cells = sum(end - start for runs in region["cells"].values() for _, start, end in runs)
            title = f"base region of tray {region['tray']}: {cells} cells"
            path = []
            for runs in region["cells"].values():
                for iy, start, end in runs:
                    x, y = self.point((grid["origin"][0] + start * h, grid["origin"][1] + (iy + 1) * h))
                    path.append(f"M{x:.1f} {y:.1f}h{(end - start) * h * SCALE:.1f}v{h * SCALE:.1f}H{x:.1f}z")
            self.items.append(
                f'<path d="{"".join(path)}" fill="{tray_colour(index)}" class="region" '
                f'data-tray="{escape(region["tray"])}" data-cells="{cells}"><title>{escape(title)}</title></path>'
            )

    def _intersections(self) -> None:
        grid = self.plan["grid"]
        for item in stop_intersections(self.plan):
            path = []
            for x0, y0, x1, y1 in outline_edges(shared_cells(self.plan, item)):
                corners = np.array([[x0, y0], [x1, y1]]) * grid["resolution"] + grid["origin"]
                (ax, ay), (bx, by) = map(self.point, corners)
                path.append(f"M{ax:.1f} {ay:.1f}L{bx:.1f} {by:.1f}")
            title = f"shared by trays {', '.join(item['trays'])}: {item['cells']} cells, disc of {item['radius']:.3f} m"
            self.items.append(f'<path d="{"".join(path)}" class="intersection"><title>{escape(title)}</title></path>')

    def _bodies(self) -> None:
        for obstacle in self.scenario["obstacles"]:
            tray = obstacle["name"].startswith("tray ")
            colour = TRAY_BODY if tray else OBSTACLE
            for outline in footprint(obstacle["shapes"], obstacle["pose"]):
                self._polygon(outline, f'fill="{colour}" class="{"tray" if tray else "obstacle"}"', obstacle["name"])
        for part in self.scenario["parts"]:
            colour = PART if part["target"] else "#8F8A82"
            for outline in footprint(part["shapes"], part["pose"]):
                self._polygon(outline, f'fill="{colour}" class="part"', part["name"])

    def _route(self) -> None:
        for leg in all_drives(self.plan):
            points = " ".join(f"{x:.1f},{y:.1f}" for x, y in (self.point(p) for p in leg["poses"]))
            title = f"{leg['length']:.2f} m driven, {np.degrees(leg['turning']):.0f} degrees turned"
            self.items.append(f'<polyline points="{points}" class="route"><title>{title}</title></polyline>')

    def _stops(self) -> None:
        uncertainty = self.scenario["positioning_uncertainty"] * SCALE
        for number, stop in enumerate(self.plan["stops"], start=1):
            x, y = self.point(stop["pose"])
            title = f"stop {number}: trays {', '.join(stop['trays'])}; disc of {stop['radius']:.3f} m" + sure(stop)
            self.items.append(
                f'<g class="stop"><title>{escape(title)}</title>'
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{stop["radius"] * SCALE:.1f}" class="disc"/>'
                f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{uncertainty:.1f}" class="uncertainty"/>'
                + self._arrivals(x, y)
                + self._arrow(stop["pose"], STOP, 0.30)
                + f'<circle cx="{x:.1f}" cy="{y:.1f}" r="13" fill="{STOP}"/>'
                f'<text x="{x:.1f}" y="{y + 5:.1f}" class="stopnumber">{number}</text></g>'
            )

    def _arrivals(self, x: float, y: float) -> str:
        """The ellipse in which 95 of 100 arrivals come to stand."""
        if "arrival_covariance" not in self.scenario:
            return ""
        along, across, turn = arrival_ellipse(self.scenario["arrival_covariance"])
        return (
            f'<ellipse cx="{x:.1f}" cy="{y:.1f}" rx="{along * SCALE:.1f}" ry="{across * SCALE:.1f}" '
            f'transform="rotate({-turn:.1f} {x:.1f} {y:.1f})" class="uncertainty"/>'
        )

    def _arrow(self, pose: Sequence[float], colour: str, length: float) -> str:
        x, y = self.point(pose)
        theta = float(pose[2])
        tip = self.point((pose[0] + length * np.cos(theta), pose[1] + length * np.sin(theta)))
        left = self.point(
            (pose[0] + 0.72 * length * np.cos(theta + 0.25), pose[1] + 0.72 * length * np.sin(theta + 0.25))
        )
        right = self.point(
            (pose[0] + 0.72 * length * np.cos(theta - 0.25), pose[1] + 0.72 * length * np.sin(theta - 0.25))
        )
        return (
            f'<path d="M{x:.1f} {y:.1f}L{tip[0]:.1f} {tip[1]:.1f}M{left[0]:.1f} {left[1]:.1f}L{tip[0]:.1f} {tip[1]:.1f}'
            f'L{right[0]:.1f} {right[1]:.1f}" stroke="{colour}" stroke-width="3.5" fill="none" stroke-linecap="round"/>'
        )

    def _ends(self) -> None:
        for word, key in (("start", "start"), ("goal", "goal")):
            pose = self.scenario[key]
            x, y = self.point(pose)
            self.items.append(
                self._arrow(pose, ROUTE, 0.30)
                + f'<circle cx="{x:.1f}" cy="{y:.1f}" r="7" class="end"/>'
                + f'<text x="{x + 12:.1f}" y="{y - 10:.1f}" class="label">{word}</text>'
            )

    def _labels(self) -> None:
        for tray in self.scenario["trays"]:
            x, y = self.point(tray["pose"]["xyz"])
            colour = tray_colour(self.tray_index[tray["name"]])
            self.items.append(
                f'<g class="traylabel"><circle cx="{x:.1f}" cy="{y:.1f}" r="14" fill="{colour}"/>'
                f'<text x="{x:.1f}" y="{y + 5:.1f}" class="stopnumber">{escape(tray["name"])}</text></g>'
            )


TOPVIEW_CSS = f"""
.topview {{ width: 100%; height: auto; background: var(--paper); border-radius: 8px; font-family: inherit; }}
.topview .grid {{ stroke: var(--line); stroke-width: 1; }}
.topview .axis {{ font-size: 11px; fill: var(--faint); }}
.topview .region {{ fill-opacity: 0.28; }}
.topview .region:hover {{ fill-opacity: 0.5; }}
.topview .intersection {{ stroke: var(--ink); stroke-width: 1.6; stroke-linecap: square; fill: none; }}
.topview .obstacle {{ stroke: #6b665f; stroke-width: 1; fill-opacity: 0.85; }}
.topview .tray {{ stroke: #8b7d5c; stroke-width: 1; }}
.topview .part {{ stroke: #7a3d08; stroke-width: 0.6; }}
.topview .route {{ fill: none; stroke: var(--ink); stroke-width: 2.5; stroke-dasharray: 9 6; stroke-linejoin: round; }}
.topview .disc {{ fill: {STOP}; fill-opacity: 0.16; stroke: {STOP}; stroke-width: 2; }}
.topview .uncertainty {{ fill: none; stroke: {STOP}; stroke-width: 1.5; stroke-dasharray: 4 3; }}
.topview .stopnumber {{ fill: #fff; font-size: 14px; font-weight: 700; text-anchor: middle; }}
.topview .label {{ fill: var(--ink); font-size: 14px; font-weight: 600; }}
.topview .end {{ fill: var(--paper); stroke: var(--ink); stroke-width: 3; }}
"""
