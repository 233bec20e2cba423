"""The vertices of a PLY file, with faces or without: a cloud of points."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .._core import InvalidInput
from .._files import read_bytes

LARGEST_FILE = 1_000_000_000  # [bytes]
_LONGEST_HEADER = 100_000
_TYPES = {
    **{
        "char": "i1",
        "int8": "i1",
        "uchar": "u1",
        "uint8": "u1",
        "short": "i2",
        "int16": "i2",
        "ushort": "u2",
        "uint16": "u2",
    },
    **{
        "int": "i4",
        "int32": "i4",
        "uint": "u4",
        "uint32": "u4",
        "float": "f4",
        "float32": "f4",
        "double": "f8",
        "float64": "f8",
    },
}
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def read_ply_points(path: Path) -> np.ndarray:
    """Points (n, 3); raises InvalidInput with the file for what is none, IoError for what cannot be read."""
    data = read_bytes(path, LARGEST_FILE)

    def fail(rule: str) -> InvalidInput:
        return InvalidInput(f"{path}: {rule}")

    end = data[:_LONGEST_HEADER].find(b"end_header")
    if not data.startswith(b"ply") or end < 0:
        raise fail("is no PLY file: it must begin with 'ply' and have an 'end_header'")
    order, count, columns, element = None, -1, [], ""
    for line in data[:end].decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"] and len(words) == 3:
            order = _ORDERS.get(words[1])
        elif words[:1] == ["element"] and len(words) == 3:
            if count < 0 and (words[1] != "vertex" or not words[2].isdecimal()):
                raise fail(f"{line.strip()!r}: the vertices must come first, with their number")
            count = int(words[2]) if count < 0 else count
            element = words[1]
        elif words[:1] == ["property"] and element == "vertex":
            if len(words) != 3 or words[1] not in _TYPES:
                raise fail(f"{line.strip()!r}: a vertex must have numbers alone")
            columns.append((words[2], _TYPES[words[1]]))
    names = [name for name, _ in columns]
    if order is None or count < 0 or len(set(names)) < len(names) or not {"x", "y", "z"} <= set(names):
        raise fail("must have a format, and an element vertex with the properties x, y and z, each once")
    body = data[data.find(b"\n", end) + 1 :]
    if order == "":
        values = body.split(None, count * len(names))[: count * len(names)]
        try:
            rows = np.array([float(word) for word in values]).reshape(-1, len(names))
        except ValueError:
            raise fail("must hold numbers, one for each property of each vertex") from None
        points = rows[:, [names.index(axis) for axis in "xyz"]]
    else:
        kind = np.dtype([(name, order + own) for name, own in columns])
        table = np.frombuffer(body[: min(len(body), count * kind.itemsize) // kind.itemsize * kind.itemsize], kind)
        points = np.column_stack([table[axis].astype(float) for axis in "xyz"])
    if len(points) < count:
        raise fail(f"is truncated: {len(points)} of {count} vertices")
    return points
