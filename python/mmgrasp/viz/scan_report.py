"""The report of a scan: one self-contained page."""

from __future__ import annotations

import base64
from html import escape
from pathlib import Path
from typing import Any

from .._files import printable
from ..scan.summary import PIXELS
from .report import CSS, plural, table

PICTURES = (
    ("surface.png", "The surface from three sides, and the standard deviation of its distance along the normal"),
    ("objects.png", "What stands on the supporting plane; numbers as in the table"),
    (
        "sensors.png",
        "What became of each sensor's pixels; share of pixels that confirm an earlier frame, frame by frame",
    ),
)
_MOST_ROWS = 200


def scan_report_html(summary: dict[str, Any], objects: dict[str, Any], title: str, pictures: Path | None) -> str:
    """The page as text; pictures in the folder are embedded."""
    sections = [_headline(summary, title), _notes(summary), _picture(pictures, 0)]
    sections += [_objects(objects), _picture(pictures, 1), _sensors(summary), _picture(pictures, 2)]
    sections += [_skipped(summary), _doubtful(summary), _setup(summary)]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(title)} - mmgrasp scan</title><style>{CSS}figure {{ margin: 18px 0; }}</style></head><body><main>"
        + "".join(sections)
        + "</main></body></html>\n"
    )


def _headline(summary: dict[str, Any], title: str) -> str:
    made = summary["map"]
    skipped = len(summary["skipped"])
    sigma = made["sigma_quantiles"].get("50 %")
    used = sum(row["used"] for row in summary["sensors"]) / max(sum(row["measured"] for row in summary["sensors"]), 1)
    cards = [
        (f"{made['frames']}", f"frames in the map, {skipped or 'none'} skipped"),
        (f"{100 * used:.0f} %", "of their measured pixels used"),
        (f"{1e3 * made['voxel']:g} mm", f"voxels; truncation {1e3 * made['truncation']:g} mm"),
        ("-" if sigma is None else f"{1e3 * sigma:.2f} mm", "median sigma of the surface"),
        (f"{made['bytes'] / 1e6:.0f} MB", f"in {made['blocks']:,} blocks"),
        (str(summary["objects"]), "objects on the plane" if summary["plane"] else "objects: no plane found"),
    ]
    tiles = "".join(f'<div class="card"><b>{escape(a)}</b><span>{escape(b)}</span></div>' for a, b in cards)
    line = f"{plural(made['frames'], 'frame')} of {plural(len(summary['sensors']), 'sensor')} made one map"
    return f"<h1>{escape(line)}</h1><p class='lead'>Folder {escape(title)}</p><div class='cards'>{tiles}</div>"


def _notes(summary: dict[str, Any]) -> str:
    return "".join(f"<p class='lead'>{escape(note)}</p>" for note in summary["notes"])


def _picture(folder: Path | None, index: int) -> str:
    name, caption = PICTURES[index]
    if folder is None or not (folder / name).is_file():
        return ""
    data = base64.b64encode((folder / name).read_bytes()).decode()
    return f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{data}"><figcaption>{escape(caption)}</figcaption></figure>'


def _objects(objects: dict[str, Any]) -> str:
    plane = objects["plane"]
    if plane is None:
        return ""
    normal = ", ".join(f"{x:.3f}" for x in plane["normal"])
    lead = f"<p class='lead'>Supporting plane ({normal}) . x = {plane['offset']:.4f} m.</p>"
    rows = []
    for k, row in enumerate(objects["objects"]):
        x, y, z = row["pose"]["xyz"]
        size = " x ".join(f"{1e3 * s:.0f}" for s in row["size"])
        sigma = f"{1e3 * row['sigma']:.2f}" if "sigma" in row else "-"
        cells = [
            str(k + 1),
            f"{x:.3f}, {y:.3f}, {z:.3f}",
            size,
            f"{100 * row['fill']:.0f} %",
            f"{row['points']:,}",
            sigma,
        ]
        rows.append(cells)
    head = ["", "middle [m]", "box around it [mm]", "top seen", "points", "sigma [mm]"]
    body = table(head, rows, {3, 4, 5}) if rows else "<p>Nothing stands on it.</p>"
    return "<h2>Objects</h2>" + lead + body


def _sensors(summary: dict[str, Any]) -> str:
    rows = []
    for row in summary["sensors"]:
        measured = max(row["measured"], 1)
        shares = [f"{100 * row[key] / measured:.1f} %" for key in PIXELS[1:]]
        agreement = row["agreement"]
        agree = f"{100 * agreement['median']:.0f} % ({100 * agreement['least']:.0f} %)" if agreement else "-"
        rows.append([escape(row["name"]), str(row["frames"]), f"{row['measured']:,}", *shares, agree])
    head = [
        "sensor",
        "frames",
        "pixels measured",
        "in the map",
        "out of range",
        "too noisy",
        "too slanted",
        "no normal",
        "outliers",
        "agreement (least)",
    ]
    return "<h2>Sensors</h2>" + table(head, rows, set(range(1, 10)))


def _skipped(summary: dict[str, Any]) -> str:
    rows = [[escape(printable(row["frame"])), escape(row["reason"])] for row in summary["skipped"]]
    return _rows("Frames that were skipped", ["frame", "why"], rows)


def _doubtful(summary: dict[str, Any]) -> str:
    rows = [[escape(printable(row["frame"])), escape(row["warning"])] for row in summary["doubtful"]]
    return _rows("Frames in the map that look wrong", ["frame", "what"], rows)


def _rows(title: str, head: list[str], rows: list[list[str]]) -> str:
    if not rows:
        return ""
    more = f"<p class='lead'>{len(rows) - _MOST_ROWS} more are in progress.json.</p>" if len(rows) > _MOST_ROWS else ""
    return f"<h2>{title}</h2>" + table(head, rows[:_MOST_ROWS]) + more


def _setup(summary: dict[str, Any]) -> str:
    rows = []
    for row in summary["sensors"]:
        was = row["described_as"]
        at = was["intrinsics"]
        noise = was["noise"]["model"].replace("_", " ")
        cells = [
            escape(row["name"]),
            f"{at['width']} x {at['height']}, f {at['fx']:g}, {at['fy']:g}, c {at['cx']:g}, {at['cy']:g}",
            f"{was['range'][0]:g} to {was['range'][1]:g} m",
            f"{was['depth_scale']:g} a metre",
            escape(noise),
            f"{1e3 * was['systematic']:g} mm + {100 * was['systematic_scale']:g} %",
            escape(was["link"] or "camera"),
        ]
        rows.append(cells)
    head = ["sensor", "image [pixels]", "range", "depth units", "noise", "systematic", "poses are of"]
    return "<h2>Set-up</h2>" + table(head, rows)
