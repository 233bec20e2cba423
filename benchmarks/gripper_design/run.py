"""Segments of 50 composed parts against the primitives they were made of: share of faces right, and seconds for the call alone: processor time, and the
clock's, which the machine's load (stated) adds to.

    python benchmarks/gripper_design/run.py [--parts 50] [--triangles 0]

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
from test_segment_mesh import EDGE, as_mesh


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
arguments = parser.parse_args()
shares, seconds, clock, peer = [], [], [], cgal()
peer_shares, peer_seconds = [], []
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
        shares.append(faces_right(truth, found.labels))
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
