"""progress.json: which frames a map holds, beside the map, so that a run goes on where another ended."""

from __future__ import annotations

from dataclasses import MISSING, asdict, fields
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from .._argument_errors import checked
from .._core import InvalidInput, ProbabilisticSdf, __version__
from .._files import printable
from ..documents.reading import Node, read_json
from ..frames.intrinsics import Intrinsics
from ..frames.poses import rigid
from ..frames.sensors import Sensor
from .integration import PROGRESS_FILE as PROGRESS_FILE
from .integration import FrameRecord, Scan, ScanOptions, SkippedFrame

FORMAT, VERSION = "mmgrasp-scan", 1
Row = TypeVar("Row", FrameRecord, SkippedFrame)
LARGEST_MEMORY = 1e13  # [bytes], as the command's option
_FATES = ("used", "out_of_range", "too_noisy", "too_slanted", "without_normal", "outliers")


@checked
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


@checked
def read_scan(path: Path) -> Scan:
    """The scan whose progress.json this is, with its map. Raises InvalidInput or IoError naming file, key, value and rule."""
    root = read_json(path).root
    if "format" not in root or root["format"].raw != FORMAT:
        found = repr(root["format"].raw)[:40] if "format" in root else "missing"
        raise InvalidInput(printable(f"{path}: format is {found}: is no progress of mmgrasp scan"))
    if root["version"].integer() != VERSION:
        root["version"].fail(f"this version of mmgrasp reads version {VERSION}")
    root.mapping("format version mmgrasp map options sensors frames skipped")
    root["mmgrasp"].string()
    options = root["options"].mapping("voxel truncation max_memory", "outlier_gate max_incidence register")
    values: dict[str, Any] = {key: options[key].number(above=0) for key in ("voxel", "truncation")}
    values["max_memory"] = options["max_memory"].number(above=0, most=LARGEST_MEMORY)
    if "outlier_gate" in options:
        values["outlier_gate"] = options["outlier_gate"].number(least=0)
        if 0 < values["outlier_gate"] < 3:
            options["outlier_gate"].fail("must be 0, or at least 3")
    if "max_incidence" in options:
        values["max_incidence"] = options["max_incidence"].number(above=0, most=1.549)
    if "register" in options:
        values["register"] = options["register"].boolean()
    name = root["map"].string()
    if "/" in name or not name.endswith(".sdf"):
        root["map"].fail("must be a file in the same folder")
    scan = Scan(
        ScanOptions(**values),
        ProbabilisticSdf.load(path.parent / name),
        [_record(node, FrameRecord) for node in root["frames"].elements()],
        [_record(node, SkippedFrame) for node in root["skipped"].elements()],
        {sensor: _sensor(node) for sensor, node in root["sensors"].items()},
    )
    for record, node in zip(scan.frames, root["frames"].elements(), strict=True):
        if record.sensor not in scan.sensors:
            node["sensor"].fail(f"is none of its sensors ({', '.join(scan.sensors)})")
    _check_map(scan, path.parent / name, path)
    return scan


def _check_map(scan: Scan, path: Path, progress: Path) -> None:
    sdf, options = scan.sdf, scan.options
    for key, there in (("voxel", sdf.voxel), ("truncation", sdf.truncation)):
        if there != getattr(options, key):
            raise InvalidInput(f"{path}: has {key} = {there:g}, {progress.name} says {getattr(options, key):g}")
    if sdf.frames != len(scan.frames):
        raise InvalidInput(f"{path}: holds {sdf.frames} frames, {progress.name} names {len(scan.frames)}")


def _sensor(node: Node) -> dict[str, Any]:
    """What Sensor.to_dict wrote, in that form."""
    example = Sensor("", intrinsics=Intrinsics(1.0, 1.0, 1.0, 1.0, 1, 1, ""), depth_scale=1.0, T_link_camera=np.eye(4))
    _check_like(node, example.to_dict())
    return dict(node.raw)


_MAY_BE_NULL = ("intrinsics", "depth_scale", "T_link_camera")


def _check_like(node: Node, example: Any) -> None:
    """Raises InvalidInput unless the value has the form of the example: keys, lengths of lists, and what is a number or a text."""
    if node.raw is None and node.path[-1] in _MAY_BE_NULL:
        return
    if isinstance(example, dict):
        node.mapping(" ".join(example))
        for key, value in example.items():
            _check_like(node[key], value)
    elif isinstance(example, list):
        elements = node.elements()
        if len(elements) != len(example):
            node.fail(f"must be a list of {len(example)}")
        for element, value in zip(elements, example, strict=True):
            _check_like(element, value)
    elif isinstance(example, str):
        if not isinstance(node.raw, str):
            node.fail("must be a text")
    elif isinstance(example, int):
        node.integer(least=1)
    else:
        node.number()


def _record(node: Node, kind: type[Row]) -> Row:
    optional = {f.name: f.default for f in fields(kind) if f.default is not MISSING}
    node.mapping(" ".join(f.name for f in fields(kind) if f.name not in optional), " ".join(optional))
    values: dict[str, Any] = dict(optional)
    for f in fields(kind):
        if f.name not in node:
            continue
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
            rigid(np.array(child.raw), f"{child.place}: {child.name}")
            values[f.name] = child.raw
    if kind is FrameRecord and values["measured"] != sum(values[key] for key in _FATES):
        node["measured"].fail("must be the sum of " + ", ".join(_FATES))
    return kind(**values)
