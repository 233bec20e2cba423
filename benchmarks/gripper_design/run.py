"""Segments of 50 composed parts against the primitives they were made of: share of faces right, widths offered, and
seconds for the call alone: processor time, and the clock's, which the machine's load (stated) adds to.

    python benchmarks/gripper_design/run.py [--parts 50] [--triangles 0] [--write]

With --write the table goes to composed_parts.md, or with --triangles to composed_parts_TRIANGLES.md.
Needs manifold3d (pip install 'mmgrasp[test]'). CGAL's segmentation (GPL; pip install cgal-pybind) stands beside where it can be imported; its options
are the defaults of its binding.
"""

from __future__ import annotations

import argparse
import importlib
import os
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

import mmgrasp as mg

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "python"))
from composed_parts import composed_parts, faces_right
from test_segment_mesh import EDGE, as_mesh, widths_offered


def cgal() -> Any:
    try:
        return importlib.import_module("cgal_pybind")
    except ImportError:
        return None


def edge_for(part: Any, triangles: int) -> float:
    """Edge length [mm] at which the part has about so many triangles."""
    low, high = 0.05, EDGE
    for _ in range(14):
        middle = (low * high) ** 0.5
        low, high = (middle, high) if part.solid.refine_to_length(middle).num_tri() > triangles else (low, middle)
    return low


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--parts", type=int, default=50, help="how many (default 50)")
parser.add_argument("--triangles", type=int, default=0, help=f"of each mesh, about (0: edges of {EDGE:g} mm)")
parser.add_argument("--write", action="store_true", help="store the table")
arguments = parser.parse_args()
names, shares, seconds, clock, peer = [], [], [], [], cgal()
peer_shares, peer_seconds = [], []
widths_off: list[list[float]] = []  # by part: of each width offered, from the nearest of the primitive's [mm]
held: list[tuple[int, int]] = []  # by part: primitives of which a width is offered, and how many there are
print(f"load {os.getloadavg()[0]:.2f} on {os.cpu_count()} cores", flush=True)
with tempfile.TemporaryDirectory() as folder:
    for k, (part, noise) in enumerate(composed_parts(arguments.parts)):
        edge = edge_for(part, arguments.triangles) if arguments.triangles else EDGE
        vertices, triangles, truth = part.mesh(edge, noise, k)
        mesh = as_mesh(vertices, triangles, Path(folder) / "part.ply")
        begin, began = time.process_time(), time.perf_counter()
        found = mg.grasping.segment_mesh(mesh)
        seconds.append(time.process_time() - begin)
        clock.append(time.perf_counter() - began)
        names.append(part.name)
        shares.append(faces_right(truth, found.labels))
        off, offering = [], set()
        for segment, widths in widths_offered(mesh, found):
            own = truth[segment.faces]
            primitive = int(np.bincount(own[own >= 0]).argmax())
            off += [min(abs(w - true) for true in part.widths[primitive]) for w in widths if part.widths[primitive]]
            offering |= {primitive} if widths else set()
        widths_off.append(off)
        held.append((len(offering), len(np.unique(truth[truth >= 0]))))
        beside = ""
        if peer is not None:
            surface = peer.Polyhedron()
            surface.build(vertices.tolist(), triangles.tolist())
            begin = time.process_time()
            labels = np.asarray(surface.segmentation()[1], dtype=int)
            spent = time.process_time() - begin
            peer_shares.append(faces_right(truth, labels))
            peer_seconds.append(spent)
            beside = f"  CGAL {100 * peer_shares[-1]:6.1f} % right {spent:6.2f} s"
        print(
            f"{k:3} {part.name:32} noise {noise:.2f} mm  {len(truth):6} faces  {100 * shares[-1]:6.1f} % right {seconds[-1]:6.2f} s, {clock[-1]:.2f} s by the clock{beside}",
            flush=True,
        )


def summary(name: str, right: list[float], spent: list[float]) -> str:
    """What became of all parts."""
    return (
        f"{name}: mean {100 * np.mean(right):.1f} %, {sum(s < 0.95 for s in right)} of {len(right)} below 95 %; "
        f"{np.median(spent):.2f} s of processor time (median), {max(spent):.2f} s at most"
    )


print(
    summary("ours", shares, seconds) + f"; by the clock {np.median(clock):.2f} s (median), {max(clock):.2f} s at most"
)
if peer is not None:
    print(summary("CGAL", peer_shares, peer_seconds))
print(f"load {os.getloadavg()[0]:.2f}")


def page() -> str:
    """The table, a row a kind of part, and what became of all."""
    size = f"about {arguments.triangles:,} triangles each" if arguments.triangles else f"edges of {EDGE:g} mm"
    lines = [
        f"Segments of {len(shares)} composed parts, {size}, two parts of five with noise of 0.02 mm "
        f"(`run.py`; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores at the end).",
        "",
        summary("All", shares, seconds)
        + f"; by the clock {np.median(clock):.2f} s (median), {max(clock):.2f} s at most. "
        + f"{sum(s < 3 for s in seconds)} of {len(seconds)} take less than 3 s of processor time, "
        + f"{sum(s < 3 for s in clock)} by the clock.",
        "",
        f"Widths: {sum(map(len, widths_off))} offered, {sum(w < 0.1 for part in widths_off for w in part)} of them within 0.1 mm of the primitive's, "
        f"{max(w for part in widths_off for w in part):.2f} mm off at most; of {sum(n for _, n in held)} primitives {sum(n for n, _ in held)} are offered.",
        "",
        "| part | parts | right, least [%] | right, mean [%] | widths off, at most [mm] | primitives offered | processor time, median [s] | at most [s] | by the clock, median [s] | at most [s] |",
        "|---|---|---|---|---|---|---|---|---|---|",
    ]
    for name in dict.fromkeys(names):
        of = [i for i, other in enumerate(names) if other == name]
        right, spent, passed = (np.array(values)[of] for values in (shares, seconds, clock))
        lines.append(
            f"| {name} | {len(of)} | {100 * right.min():.1f} | {100 * right.mean():.1f} | "
            f"{max((w for i in of for w in widths_off[i]), default=0):.2f} | {sum(held[i][0] for i in of)} of {sum(held[i][1] for i in of)} | {np.median(spent):.2f} | "
            f"{spent.max():.2f} | {np.median(passed):.2f} | {passed.max():.2f} |"
        )
    return "\n".join(lines) + "\n"


if arguments.write:
    suffix = f"_{arguments.triangles}" if arguments.triangles else ""
    (Path(__file__).resolve().parent / f"composed_parts{suffix}.md").write_text(page())
