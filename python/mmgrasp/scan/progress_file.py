"""progress.json: which frames a map holds, beside the map, so that a run goes on where another ended."""

from __future__ import annotations

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any, TypeVar

from .._core import InvalidInput, IoError, ProbabilisticSdf, __version__
from ..documents.reading import Node, read_json
from .integration import FrameRecord, Scan, ScanOptions, SkippedFrame

FORMAT, VERSION = "mmgrasp-scan", 1
PROGRESS_FILE = "progress.json"
Row = TypeVar("Row", FrameRecord, SkippedFrame)
_AGAIN = "make the map anew with --start-over"


def scan_to_dict(scan: Scan, map_name: str) -> dict[str, Any]:
    """The content of progress.json beside the map of that name."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "mmgrasp": __version__,
        "map": map_name,
        "options": asdict(scan.options),
        "sensors": scan.sensors,
        "frames": [asdict(record) for record in scan.frames],
        "skipped": [asdict(frame) for frame in scan.skipped],
    }


def read_scan(path: Path) -> Scan:
    """The scan whose progress.json this is, with its map. Raises InvalidInput or IoError naming file, key, value and rule."""
    root = read_json(path).root
    if "format" not in root or root["format"].raw != FORMAT:
        raise InvalidInput(f"{path}: is no progress of mmgrasp scan: {_AGAIN}, or choose another folder")
    if root["version"].integer() != VERSION:
        root["version"].fail(f"this version of mmgrasp reads version {VERSION}: {_AGAIN}")
    root.mapping("format version mmgrasp map options sensors frames skipped")
    options = root["options"].mapping("voxel truncation max_memory")
    values = [_positive(options[key]) for key in ("voxel", "truncation", "max_memory")]
    name = root["map"].string()
    if "/" in name or not name.endswith(".sdf"):
        root["map"].fail("must be a file in the same folder")
    scan = Scan(
        ScanOptions(*values),
        _read_map(path.parent / name),
        [_record(node, FrameRecord) for node in root["frames"].elements()],
        [_record(node, SkippedFrame) for node in root["skipped"].elements()],
        {sensor: _sensor(node) for sensor, node in root["sensors"].items()},
    )
    for record, node in zip(scan.frames, root["frames"].elements(), strict=True):
        if record.sensor not in scan.sensors:
            node["sensor"].fail(f"is none of its sensors ({', '.join(scan.sensors)}): {_AGAIN}")
    _check_map(scan, path.parent / name, path)
    return scan


def _read_map(path: Path) -> ProbabilisticSdf:
    try:
        return ProbabilisticSdf.load(path)
    except IoError as error:
        raise IoError(f"{error}: {_AGAIN}") from None


def _check_map(scan: Scan, path: Path, progress: Path) -> None:
    sdf, options = scan.sdf, scan.options
    for key, there in (("voxel", sdf.voxel), ("truncation", sdf.truncation)):
        if there != getattr(options, key):
            raise InvalidInput(
                f"{path}: has {key} = {there:g}, {progress.name} says {getattr(options, key):g}: {_AGAIN}"
            )
    if sdf.frames != len(scan.frames):
        raise InvalidInput(f"{path}: holds {sdf.frames} frames, {progress.name} names {len(scan.frames)}: {_AGAIN}")


def _positive(node: Node) -> float:
    if isinstance(node.raw, bool) or not isinstance(node.raw, int | float) or not node.raw > 0:
        node.fail("must be a positive number")
    return float(node.raw)


def _sensor(node: Node) -> dict[str, Any]:
    node.mapping("intrinsics", " ".join(key for key, _ in node.items()))
    if node["intrinsics"].raw is not None:
        at = node["intrinsics"].mapping("width height fx fy cx cy")
        for key, value in at.items():
            value.integer(least=1) if key in ("width", "height") else value.number()
    return dict(node.raw)


def _record(node: Node, kind: type[Row]) -> Row:
    node.mapping(" ".join(f.name for f in fields(kind)))
    values: dict[str, Any] = {}
    for f in fields(kind):
        child = node[f.name]
        if f.type == "int":
            values[f.name] = child.integer(least=0)
        elif f.type == "str":
            if not isinstance(child.raw, str):
                child.fail("must be a text")
            values[f.name] = child.raw
        elif f.type == "float | None":
            values[f.name] = None if child.raw is None else child.number()
        else:
            if child.array(4).shape != (4, 4):
                child.fail("must be a pose, 4 x 4 numbers")
            values[f.name] = child.raw
    return kind(**values)
