"""A scan in numbers: what `mmgrasp scan --json` prints and the report shows."""

from __future__ import annotations

import statistics
from typing import Any

import numpy as np

from .._core import ProbabilisticSdf
from ..frames import FrameFolder
from .integration import FrameRecord, Scan

_THIN = 4.0
"""Surfaces nearer to one another, back to back, are pulled apart: a depth is told as far as 1.75 voxels behind it [voxels]."""
_THIN_SAMPLES, _THIN_SHARE = 4000, 0.01
PIXELS = ("measured", "used", "out_of_range", "too_noisy", "too_slanted", "without_normal", "outliers")


def thin_share(sdf: ProbabilisticSdf, points: np.ndarray, normals: np.ndarray) -> float:
    """Share of surface points that have another surface, seen from behind them, within a few voxels."""
    chosen = np.arange(0, len(points), max(1, len(points) // _THIN_SAMPLES))
    chosen = chosen[np.linalg.norm(normals[chosen], axis=1) > 0.5]
    if not len(chosen):
        return 0.0
    depth = _THIN * sdf.voxel
    hits = sdf.cast_rays(points[chosen] - depth * normals[chosen], normals[chosen])
    return float((hits.hit & (hits.distance < depth)).mean())


def scan_summary(
    scan: Scan, folder: FrameFolder, sigmas: np.ndarray, objects: dict[str, Any], thin: float
) -> dict[str, Any]:
    """Plain values; nothing in it depends on when or how often the scan was interrupted. `thin`: see thin_share()."""
    quantiles = [float(x) for x in np.quantile(sigmas, [0.05, 0.5, 0.95])] if len(sigmas) else []
    return {
        "map": {
            "voxel": scan.options.voxel,
            "truncation": scan.options.truncation,
            "outlier_gate": scan.options.outlier_gate,
            "max_incidence": scan.options.max_incidence,
            "registered": scan.options.register,
            "frames": len(scan.frames),
            "blocks": scan.sdf.blocks,
            "bytes": scan.sdf.memory,
            "vertices": len(sigmas),
            "sigma_quantiles": dict(zip(("5 %", "50 %", "95 %"), quantiles, strict=False)),
        },
        "sensors": [_sensor_row(scan, name) for name in dict.fromkeys(record.sensor for record in scan.frames)],
        "skipped": [{"frame": frame.name, "reason": frame.reason} for frame in scan.skipped],
        "doubtful": [{"frame": r.name, "warning": r.warning} for r in scan.frames if r.warning],
        "plane": objects["plane"] is not None,
        "objects": len(objects["objects"]),
        "notes": notes(scan, folder, objects, thin),
    }


def _sensor_row(scan: Scan, name: str) -> dict[str, Any]:
    own: list[FrameRecord] = [record for record in scan.frames if record.sensor == name]
    agreements = [record.agreement for record in own if record.agreement is not None]
    row: dict[str, Any] = {"name": name, "frames": len(own)}
    row |= {key: sum(getattr(record, key) for record in own) for key in PIXELS}
    row["agreement"] = {"median": statistics.median(agreements), "least": min(agreements)} if agreements else None
    return row | {"described_as": scan.sensors[name]}


def notes(scan: Scan, folder: FrameFolder, objects: dict[str, Any], thin: float) -> list[str]:
    """What a reader of the map should know."""
    out = []
    if not folder.from_file:
        names = ", ".join(dict.fromkeys(layout.name for layout in folder.layouts.values()))
        scales = sorted({row["depth_scale"] for row in scan.sensors.values()})
        shown = " or ".join(f"{scale:g}" for scale in scales)
        out.append(
            f"No sensors.yaml: assumed are the noise of a first Kinect (structured light), the library's range of depths, exact poses, "
            f"and {shown} units in a metre, as {names} has it. Sigma is as good as that."
        )
    if scan.options.register:
        out.append("Frames were moved onto the map: what the first ones are wrong by is in all, and not in sigma.")
    if scan.options.outlier_gate:
        out.append(f"Depths more than {scan.options.outlier_gate:g} standard deviations off were left out.")
    if thin > _THIN_SHARE:
        out.append(
            f"{thin:.0%} of the surface has another one less than {1e3 * _THIN * scan.options.voxel:g} mm behind it: things so thin come out too "
            "thick, by millimetres, and sigma does not tell. A finer --voxel helps, where the noise allows it."
        )
    if scan.absent:
        more = f" and {len(scan.absent) - 1} more" if len(scan.absent) > 1 else ""
        out.append(f"In the map, but no longer in the folder: {scan.absent[0]}{more}.")
    if objects["plane"] is None:
        out.append("No supporting plane was found; --up X,Y,Z says where up is.")
    elif objects["up"]["from"] != "given":
        out.append(f"Where up is was not given: {objects['up']['from']}; --up X,Y,Z says it.")
    return out
