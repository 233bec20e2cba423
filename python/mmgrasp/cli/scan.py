"""`mmgrasp scan`: from a folder of depth frames to a map, its mesh, the objects in it and a report."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import time
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from .._core import InvalidInput, IoError, OccupancyMap
from .._files import printable, write_file
from ..frames import FrameFolder, open_frames
from ..scan import (
    Scan,
    choose_options,
    integrate_frames,
    mean_up,
    objects_on_plane,
    occupancy_of,
    read_scan,
    scan_to_dict,
    write_ply,
)
from ..scan.objects import GUESSED_UP, KNOWN_UP, Segmentation, objects_to_dict, vertex_normals
from ..scan.progress_file import PROGRESS_FILE
from ..scan.summary import scan_summary, thin_share
from .console import Reporter
from .exit_codes import DONE, NOTHING_USABLE
from .output_folder import LIST, OutputFolder
from .signals import uninterrupted

MAP = "map.sdf"
PARTIAL = "partial_*.sdf"
OCTREE = "occupancy.bt"
SCAN_FILES = (
    *(MAP, PARTIAL, PROGRESS_FILE, "mesh.ply", "objects.json", OCTREE, "report.html", LIST),
    *("surface.png", "objects.png", "sensors.png"),
)
CHECKPOINT_SECONDS = 5.0
_OPTIONS = ("voxel", "truncation", "max_memory", "outlier_gate", "max_incidence", "register")
_MOST_LINES = 10


def run_scan(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp scan`: depth frames to a map with its objects; the exit code."""
    folder = OutputFolder(arguments.out, SCAN_FILES, goes_on=(MAP, PARTIAL, PROGRESS_FILE))
    if folder.path == Path(os.path.realpath(arguments.frames)):
        raise InvalidInput(f"--out {arguments.out}: must be another folder than that of the frames")
    with Reporter(console) as report:
        frames = open_frames(arguments.frames, arguments.sensors)
        scan = _begin(arguments, frames, folder)
        checkpoints = _Checkpoints(folder, scan, arguments.start_over)
        with checkpoints.last_one(scan, report):
            added = integrate_frames(frames, scan, arguments.every, report, checkpoints, uninterrupted)
            if not scan.frames:
                _print_nothing(scan, console, arguments.json)
                return NOTHING_USABLE
            octree = None if arguments.octree is None else occupancy_of(frames, scan, arguments.octree, report)
            # The map first, so that it is there whatever becomes of the rest.
            report("writing the map", 0.0)
            folder.fill(lambda draft: _save(scan, draft, MAP))
        summary = _write(scan, frames, folder, octree, report, arguments)
    if arguments.json:
        print(json.dumps({**summary, "added": added}, indent=1, allow_nan=False))
    else:
        _print(summary, added, arguments.out, console)
    return DONE


def _begin(arguments: argparse.Namespace, frames: FrameFolder, folder: OutputFolder) -> Scan:
    """A new map, or that of an earlier run with the same options."""
    path = folder.path / PROGRESS_FILE
    if not arguments.start_over and (folder.path / MAP).exists() and not path.exists():
        raise InvalidInput(
            f"{printable(str(folder.path / MAP))}: there is no {PROGRESS_FILE} beside it, which says what frames it holds: "
            "put that back, or make the map anew with --start-over"
        )
    if arguments.start_over or not path.exists():
        chosen = {name: getattr(arguments, name) for name in _OPTIONS}
        return Scan.begin(choose_options(frames, **{**chosen, "register": bool(arguments.register)}))
    try:
        scan = read_scan(path)
    except (InvalidInput, IoError) as error:
        raise type(error)(f"{error}: make the map anew with --start-over, or choose another folder") from None
    for name, was in asdict(scan.options).items():
        now = getattr(arguments, name)
        if now is not None and now != was:
            flag = "--" + name.replace("_", "-")
            unit = 1e6 if name == "max_memory" else 1.0
            given = flag if name == "register" else f"{flag} {now / unit:g}"
            before = f"{was / unit:g}" if was else "none"
            raise InvalidInput(
                f"{given}: the map in {printable(str(arguments.out))} was made with {before}: "
                f"leave {flag} out to go on with it, or make it anew with --start-over"
            )
    return scan


class _Checkpoints:
    """Saves the map now and then, with the list of its frames; each one replaces the one before."""

    def __init__(self, folder: OutputFolder, scan: Scan, start_over: bool) -> None:
        self._folder = folder
        self._last = time.monotonic()
        self._pause = CHECKPOINT_SECONDS
        self._saved = len(scan.frames)
        self._start_over = start_over
        self._replaces = start_over and (folder.path / PROGRESS_FILE).exists()

    def __call__(self, scan: Scan) -> None:
        begun = time.monotonic()
        if begun - self._last < self._pause:
            return
        self._fill(scan)
        self._last = time.monotonic()
        self._pause = max(CHECKPOINT_SECONDS, 20 * (self._last - begun))  # large maps take long to save

    @contextlib.contextmanager
    def last_one(self, scan: Scan, report: Reporter) -> Iterator[None]:
        """Saves what the map holds when Ctrl-C or a signal ends the block; a second one ends that, too.

        Another map that --start-over is about to replace stays what it is until the first checkpoint.
        """
        try:
            yield
        except KeyboardInterrupt as ended:  # or Ended, with the signal's number
            done = len(scan.frames)
            if done > self._saved and scan.sdf.frames == done and not self._replaces:
                report("saving the map", 0.0)
                self._fill(scan)
            if self._saved and not self._replaces:
                count = f"{self._saved} frame{'' if self._saved == 1 else 's'}"
                where, rest = printable(str(self._folder.path)), ", without --start-over" if self._start_over else ""
                ended.args = (f"the map of {count} is in {where}; the same command goes on{rest}",)
            raise

    def _fill(self, scan: Scan) -> None:
        name = PARTIAL.replace("*", f"{len(scan.frames):06d}")
        self._folder.fill(lambda draft: _save(scan, draft, name), added=True, replacing=PARTIAL)
        self._saved, self._replaces = len(scan.frames), False


def _save(scan: Scan, draft: Path, name: str) -> None:
    scan.sdf.save(draft / name)
    write_file(draft / PROGRESS_FILE, json.dumps(scan_to_dict(scan, name), indent=1) + "\n")


def _write(
    scan: Scan,
    frames: FrameFolder,
    folder: OutputFolder,
    octree: OccupancyMap | None,
    report: Reporter,
    arguments: argparse.Namespace,
) -> dict[str, Any]:
    """What is made of the map."""
    report("mesh", 0.0)
    mesh, sigmas = scan.sdf.mesh()
    points, triangles = mesh.vertices, mesh.triangles
    report("objects", 0.0)
    normals = vertex_normals(points, triangles)
    found, objects = _objects(scan, frames, arguments.up, points, normals, sigmas)
    summary = scan_summary(scan, frames, sigmas, objects, thin_share(scan.sdf, points, normals))
    report("writing", 0.0)
    with folder.illustrated() as draft:
        write_ply(draft / "mesh.ply", points, triangles, sigmas)
        write_file(draft / "objects.json", json.dumps(objects, indent=1, allow_nan=False) + "\n")
        if octree is not None:
            octree.save(draft / OCTREE)
        if not arguments.no_pictures:
            from ..viz.scan_pictures import write_scan_pictures

            write_scan_pictures(scan, points, sigmas, found, draft, report)
        from ..viz.scan_report import scan_report_html

        title = printable(str(arguments.frames))
        write_file(draft / "report.html", scan_report_html(summary, objects, title, draft))
    report("writing", 1.0)
    return summary


def _objects(
    scan: Scan,
    frames: FrameFolder,
    given: list[float] | None,
    points: np.ndarray,
    normals: np.ndarray,
    sigmas: np.ndarray,
) -> tuple[Segmentation, dict[str, Any]]:
    cameras = [np.array(record.T_world_camera) for record in scan.frames]
    up: np.ndarray | None
    if given is not None:
        up, angle, how = np.array(given) / np.linalg.norm(given), KNOWN_UP, "given"
    elif frames.z_is_up:
        up, angle, how = np.array([0.0, 0.0, 1.0]), KNOWN_UP, "the world's z was taken"
    else:
        up, angle, how = mean_up(cameras), GUESSED_UP, "it was guessed from how the cameras were held"
    eye = np.mean([T[:3, 3] for T in cameras], axis=0)
    found = objects_on_plane(points, normals, up=up, eye=eye, voxel=scan.options.voxel, up_angle=angle)
    return found, objects_to_dict(found, points, sigmas, up, how)


def _print(summary: dict[str, Any], added: int, out: Path, console: Console) -> None:
    made = summary["map"]
    lines = [
        f"{made['frames']} frame{'' if made['frames'] == 1 else 's'} in the map ({added} new): voxels of {1e3 * made['voxel']:g} mm, truncation "
        f"{1e3 * made['truncation']:g} mm, {made['blocks']} blocks, {made['bytes'] / 1e6:.0f} MB"
    ]
    if made["sigma_quantiles"]:
        low, middle, high = (1e3 * x for x in made["sigma_quantiles"].values())
        lines.append(f"sigma of the surface: median {middle:.2f} mm, 90 % between {low:.2f} and {high:.2f} mm")
    if summary["plane"]:
        lines.append(f"objects on the supporting plane: {summary['objects']}")
    lines += [f"note: {note}" for note in summary["notes"]]
    for key, what, why in (("skipped", "skipped", "reason"), ("doubtful", "doubtful", "warning")):
        rows = summary[key]
        lines += [f"{what}: {row['frame']}: {row[why]}" for row in rows[:_MOST_LINES]]
        if len(rows) > _MOST_LINES:
            lines.append(f"{what}: {len(rows) - _MOST_LINES} more, see the report")
    lines.append(f"report: {out / 'report.html'}")
    for line in lines:
        console.print(printable(line), markup=False, soft_wrap=True)


def _print_nothing(scan: Scan, console: Console, as_json: bool) -> None:
    skipped = [{"frame": frame.name, "reason": frame.reason} for frame in scan.skipped]
    if as_json:
        print(json.dumps({"map": None, "skipped": skipped}, indent=1))
        return
    console.print(f"no frame could be used, {len(skipped)} examined", style="bold red", markup=False)
    for row in skipped[:_MOST_LINES]:
        console.print(printable(f"- {row['frame']}: {row['reason']}"), markup=False, soft_wrap=True)
    if len(skipped) > _MOST_LINES:
        console.print(f"- and {len(skipped) - _MOST_LINES} more", markup=False)
