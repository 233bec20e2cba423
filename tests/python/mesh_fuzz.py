"""Mesh files with one character changed, at every place: read or refused, within so much memory.

As a script: `mesh_fuzz.py [EVERY [FORMAT...]]` tries each EVERY-th change (1: all of them). The process has little more
memory than the libraries need, so a reader that asks for more than a few hundred times the file is found.
"""

from __future__ import annotations

import ctypes
import itertools
import resource
import struct
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import mmgrasp as mg

CORNERS = [(x, y, z) for x in (0.0, 0.1) for y in (0.0, 0.1) for z in (0.0, 0.1)]
TRIANGLES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4),
             (1, 5, 7), (1, 7, 3)]  # fmt: skip
CHANGES = [*b"=-+.,0123456789eEx#<>/\"' \n\\&", 0, 0xFF]  # put in the place of a byte
PIECES = [b"", b"99999999", b"<p>", b"-1 ", b" "]  # put before a byte; the first stands for the byte cut out
MEMORY = 100_000_000  # [bytes] beyond what the loaded libraries take; the files have a few kB
TOO_LONG = 2.0  # [s] of processor time for one file


def joined(rows: Sequence[tuple[float, ...]]) -> str:
    return " ".join(str(number) for row in rows for number in row)


def collada(
    primitives: str, scene: str = '<node id="n"><instance_geometry url="#g"/></node>', nodes: str = ""
) -> bytes:
    """A box as COLLADA; `primitives` are the elements that name its corners."""
    return (
        '<?xml version="1.0"?><COLLADA version="1.4.1"><asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>'
        f'<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="24">{joined(CORNERS)}'
        '</float_array><technique_common><accessor source="#pa" count="8" stride="3"><param name="X" type="float"/>'
        '<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>'
        '<source id="q"><float_array id="qa" count="3">0 0 1</float_array><technique_common><accessor source="#qa" '
        'count="1" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>'
        '</accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
        f"{primitives}</mesh></geometry></library_geometries><library_nodes>{nodes}</library_nodes>"
        f'<library_visual_scenes><visual_scene id="s">{scene}</visual_scene></library_visual_scenes>'
        '<scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    ).encode()


VERTEX = '<input semantic="VERTEX" source="#v" offset="0"/>'
NORMAL = '<input semantic="NORMAL" source="#q" offset="1"/>'
WITH_NORMALS = [(corner, 0) for triangle in TRIANGLES for corner in triangle]


def wavefront() -> bytes:
    lines = [f"v {x} {y} {z}" for x, y, z in CORNERS] + [f"f {a + 1} {b + 1}/1/1 {c - 8}" for a, b, c in TRIANGLES]
    return ("\n".join(lines) + "\n").encode()


def polygon_file(ascii_text: bool) -> bytes:
    form = "ascii" if ascii_text else "binary_little_endian"
    head = f"ply\nformat {form} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n"
    if ascii_text:
        rows = [" ".join(map(str, corner)) for corner in CORNERS] + [f"3 {joined([t])}" for t in TRIANGLES]
        return (head + "\n".join(rows) + "\n").encode()
    return head.encode() + b"".join(
        [struct.pack("<3f", *c) for c in CORNERS] + [struct.pack("<B3i", 3, *t) for t in TRIANGLES]
    )


def stereo(ascii_text: bool) -> bytes:
    if ascii_text:
        loops = ("".join(f"vertex {joined([CORNERS[c]])}\n" for c in triangle) for triangle in TRIANGLES)
        facets = "".join(f"facet normal 0 0 0\nouter loop\n{loop}endloop\nendfacet\n" for loop in loops)
        return f"solid box\n{facets}endsolid box\n".encode()
    records = (struct.pack("<12fH", 0, 0, 0, *(v for c in t for v in CORNERS[c]), 0) for t in TRIANGLES)
    return b" " * 80 + struct.pack("<I", len(TRIANGLES)) + b"".join(records)


FILES = {
    "dae": collada(f'<triangles count="12">{VERTEX}<p>{joined(TRIANGLES)}</p></triangles>'),
    "polylist.dae": collada(
        f'<polylist count="12">{VERTEX}{NORMAL}<vcount>{"3 " * 12}</vcount><p>{joined(WITH_NORMALS)}</p></polylist>',
        '<node id="a"><translate>1 0 0</translate><instance_node url="#b"/></node>',
        '<node id="b"><matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>',
    ),
    "strips.dae": collada(
        f'<tristrips count="1">{VERTEX}<p>0 1 2 3 6 7 4 5</p></tristrips><trifans count="1">{VERTEX}<p>0 4 5 1</p></trifans>'
        f'<polygons count="2">{VERTEX}<p>0 2 6 4</p><p>1 5 7 3</p></polygons>'
    ),
    "obj": wavefront(),
    "ply": polygon_file(True),
    "binary.ply": polygon_file(False),
    "stl": stereo(True),
    "binary.stl": stereo(False),
}  # fmt: skip


def damaged(content: bytes) -> Iterator[bytes]:
    """The content with one byte changed, cut out, or something put before it; at every place."""
    for at in range(len(content)):
        before, after = content[:at], content[at + 1 :]
        for byte in CHANGES:
            yield before + bytes([byte]) + after
        yield before + after
        for piece in PIECES[1:]:
            yield before + piece + content[at:]


URDF = """<robot name="r"><link name="a"/><link name="b"><collision><geometry><mesh filename="{}"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""


def read_twice(path: Path) -> None:
    """Our readers read it, and assimp what they take, as `verify` does."""
    mg.Mesh.load(path)
    mg.verify.check_path(mg.Robot.from_strings(URDF.format(path)), ["j"], [[0.0], [0.1]], [])


def what_came(path: Path) -> str:
    """How reading ended: "read", "refused", or what to complain of."""
    begun = time.process_time()
    try:
        read_twice(path)
        ended = "read"
    except mg.Error as error:
        words = str(error)
        ended = "refused" if words and "alloc" not in words else f"refused: {words}"
    except Exception as error:
        ended = f"{type(error).__name__}: {error}"
    took = time.process_time() - begun
    return ended if took < TOO_LONG else f"{ended} after {took:.1f} s of processor time"


def limit_memory() -> None:
    ctypes.CDLL(None).mallopt(-8, 1)  # one arena: each thread would reserve 64 MB for its own, or try to
    taken = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (taken + MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))


def search(names: list[str], every: int) -> tuple[dict[str, int], list[str]]:
    """How many changed files ended in which way, and the complaints."""
    ends: dict[str, int] = {"read": 0, "refused": 0}
    complaints = []
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            path = Path(folder) / f"m.{name}"
            for number, content in itertools.islice(enumerate(damaged(FILES[name])), 0, None, every):
                path.write_bytes(content)
                ended = what_came(path)
                if ended in ends:
                    ends[ended] += 1
                else:
                    complaints.append(f"{name} {number}: {ended}")
    return ends, complaints


def main() -> int:
    every = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    names = sys.argv[2:] or list(FILES)
    limit_memory()
    ends, complaints = search(names, every)
    tries = sum(ends.values()) + len(complaints)
    told = f"{tries} tries: {ends['read']} read, {ends['refused']} refused, {len(complaints)} complaints"
    print("\n".join([*complaints[:50], told]))
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
