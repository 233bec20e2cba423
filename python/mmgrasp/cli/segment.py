"""`mmgrasp segment`: the simple bodies that a part is composed of, the primitives that stand for them and the widths at which they can be held."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from .. import _core
from .._core import InvalidInput
from .._files import printable, write_file
from ..grippers.part_mesh import load_part_mesh
from ..grippers.part_size import UNITS, wrong_size
from ..scan.objects import pose_to_dict
from ..viz.style import segment_colour
from .console import Reporter
from .exit_codes import DONE
from .output_folder import LIST, OutputFolder

FORMAT, VERSION = "mmgrasp-segments", 2
FILES = ("segments.json", "segments.png", "primitives.png", "diameters.png", LIST)
_UNKNOWN_SHARE = 0.2
_MOST_WIDTHS = 8  # in a row of the table; segments.json has all


def run_segment(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code."""
    folder = None if arguments.out is None else OutputFolder(arguments.out, FILES)
    with Reporter(console) as report:
        report("reading", 0.0)
        mesh, faults = load_part_mesh(str(arguments.mesh), UNITS[arguments.unit])
        points = mesh.vertices
        size = np.ptp(points, axis=0)
        _check_size(arguments, float(np.linalg.norm(size)))
        found = _core.segment_mesh(mesh, seed=arguments.seed, threads=arguments.threads, progress=report)
        primitives = _core.fit_primitives(mesh, found.labels, threads=found.threads, progress=report)
        content = segments_to_dict(arguments, mesh, size, found, primitives, faults)
        if folder is not None:
            report("writing", 0.0)
            text = json.dumps(content, indent=1, allow_nan=False) + "\n"
            folder.fill(lambda draft: write_file(draft / "segments.json", text))
            if not arguments.no_pictures:
                from ..viz.segment_pictures import write_segment_pictures

                with folder.illustrated() as draft:
                    names = [segment["name"] for segment in content["segments"]]
                    write_segment_pictures(
                        points, mesh.triangles, found.labels, names, primitives, found.diameters, draft
                    )
            report("writing", 1.0)
    if arguments.json:
        print(json.dumps(content, indent=1, allow_nan=False))
    else:
        _print(content, arguments.out, console)
    return DONE


def _check_size(arguments: argparse.Namespace, diagonal: float) -> None:
    rule = wrong_size(diagonal, arguments.unit)
    if rule:
        file = printable(str(arguments.mesh))
        raise InvalidInput(
            f"{file}: would be {diagonal:.4g} m from corner to corner with --unit {arguments.unit}; {rule}"
        )


def segments_to_dict(
    arguments: argparse.Namespace,
    mesh: _core.Mesh,
    size: np.ndarray,
    found: _core.MeshSegmentation,
    primitives: list[_core.FittedPrimitive],
    faults: list[str],
) -> dict[str, Any]:
    """What segments.json holds: SI units. `faults`: notes on the file's mesh."""
    notes = []
    if not mesh.closed:
        notes.append("the mesh is open: walls around its gaps may be joined wrongly")
    notes += faults
    unknown = float(np.mean(found.diameters == 0))
    if unknown > _UNKNOWN_SHARE:
        notes.append(f"{100 * unknown:.0f} % of the faces have nothing behind them: the mesh may be a sheet")
    segments = []
    names = _core.segment_names(primitives)
    for number, (segment, primitive) in enumerate(zip(found.segments, primitives, strict=True)):
        widths = [
            {"width": w.width, "axis": [float(x) for x in w.axis], "covered": w.covered} for w in primitive.widths
        ]
        segments.append(
            {
                "segment": number,
                "name": names[number],
                "colour": segment_colour(number),
                "faces": len(segment.faces),
                "area": segment.area,
                "diameter": segment.diameter,
                "threaded": segment.threaded,
                "primitive": primitive.kind,
                "T_mesh_primitive": pose_to_dict(primitive.T_mesh_primitive),
                "size": [float(x) for x in primitive.size],
                "volume": primitive.volume,
                "hull_volume": primitive.hull_volume,
                "deviation": primitive.deviation,
                "widths": [] if segment.threaded else widths,
            }
        )
    threads = [
        {
            "T_mesh_thread": pose_to_dict(t.T_mesh_thread),
            "diameter": 2 * t.crest_radius,
            "pitch": t.pitch,
            "length": t.length,
        }
        for t in found.threads
    ]
    return {
        "format": FORMAT,
        "version": VERSION,
        "mesh": str(arguments.mesh),
        "unit": arguments.unit,
        "triangles": len(found.labels),
        "closed": mesh.closed,
        "size": [float(x) for x in size],
        "notes": notes,
        "threads": threads,
        "segments": segments,
        "labels": [int(x) for x in found.labels],
    }


def _print(content: dict[str, Any], out: Path | None, console: Console) -> None:
    across = " x ".join(f"{1e3 * x:.4g}" for x in content["size"])
    console.print(
        f"{printable(content['mesh'])}: {content['triangles']} triangles, {across} mm", markup=False, soft_wrap=True
    )
    table = Table(
        title="segments; sizes in mm; widths to hold, in brackets how much of the size across lies between them"
    )
    for column in ("no.", "", "name", "size", "thickness", "volume", "widths"):
        table.add_column(column, justify="right" if column in ("no.", "thickness", "volume") else "left")
    for row in content["segments"]:
        ratio = row["volume"] / row["hull_volume"] if row["hull_volume"] > 0 else float("nan")
        listed = [f"{1e3 * w['width']:.2f} ({100 * w['covered']:.0f} %)" for w in row["widths"]]
        widths = ", ".join(listed[:_MOST_WIDTHS])
        if len(listed) > _MOST_WIDTHS:
            widths += f", and {len(listed) - _MOST_WIDTHS} less covered"
        table.add_row(
            str(row["segment"]),
            f"[on {row['colour']}]  [/]",
            row["name"],
            " x ".join(f"{1e3 * x:.2f}" for x in row["size"]),
            f"{1e3 * row['diameter']:.2f}",
            "-" if np.isnan(ratio) else f"{ratio:.2f} of hull",
            "thread: not to be held" if row["threaded"] else widths or "no surface to hold",
        )
    console.print(table)
    for thread in content["threads"]:
        hand = "right" if thread["pitch"] > 0 else "left"
        console.print(
            f"thread: diameter {1e3 * thread['diameter']:.2f} mm, pitch {1e3 * abs(thread['pitch']):.2f} mm, {hand}-handed, "
            f"{1e3 * thread['length']:.1f} mm long",
            markup=False,
            soft_wrap=True,
        )
    console.print(
        "mmgrasp grippers: `keep_off: [name, ...]` of a part keeps fingers off its segments",
        markup=False,
        soft_wrap=True,
    )
    for note in content["notes"]:
        console.print(f"note: {note}", markup=False, soft_wrap=True)
    if out is not None:
        console.print(f"written: {printable(str(out / 'segments.json'))}", markup=False, soft_wrap=True)
