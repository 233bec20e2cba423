"""Parts of WRS 2020's belt drive and of NIST's boards cut into segments: a list of them, and a picture to look at.

    python benchmarks/gripper_design/real_parts.py [--write]

Needs the shared data. With --write the list goes to real_parts.md and the picture to docs/images/real_parts.png.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import mmgrasp as mg
from mmgrasp._core import FittedPrimitive, MeshSegmentation
from mmgrasp.grasping import fit_primitives, segment_mesh
from mmgrasp.viz.segment_pictures import coloured, segment_colour
from mmgrasp.viz.two_sides import two_sides

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
MESHES = REPOSITORY.parent / "shared" / "data" / "meshes"
COLUMNS = 4


def files() -> list[tuple[Path, float]]:
    """Mesh files of single parts, and the length of their unit [m]."""
    wrs = [(f, 0.001) for f in sorted((MESHES / "o2ac_wrs").glob("*.stl")) if "collision" not in f.name]
    nist = sorted((MESHES / "nist_factory" / "factory_insertion").glob("*"))
    pegs = [(f, 1.0) for f in nist if f.suffix in (".obj", ".stl") and ("peg" in f.name or "gear" in f.name)]
    return wrs + pegs


def size_text(primitive: FittedPrimitive) -> str:
    """Its lengths [mm]."""
    x, y, z = 1e3 * np.asarray(primitive.size)
    if primitive.kind == "cylinder":
        return f"{x:.2f} dia. x {z:.2f}"
    if primitive.kind == "cone":
        return f"{x:.2f} to {y:.2f} dia. x {z:.2f}"
    return f"{x:.2f} dia." if primitive.kind == "sphere" else f"{x:.2f} x {y:.2f} x {z:.2f}"


def lines_of(
    name: str, mesh: mg.Mesh, found: MeshSegmentation, primitives: list[FittedPrimitive], seconds: float
) -> list[str]:
    """One line a segment, the part's own figures in the first."""
    total = sum(s.area for s in found.segments)
    closed = "" if mesh.closed else ", open"
    out = []
    for i, (segment, primitive) in enumerate(zip(found.segments, primitives, strict=True)):
        part = f"{name} ({len(mesh.triangles)} faces{closed}) | {seconds:.1f}" if i == 0 else " | "
        widths = ", ".join(f"{1e3 * w.width:.2f}" for w in primitive.widths) or "-"
        kind = primitive.kind + (", threaded" if segment.threaded else "")
        share = 100 * segment.area / total
        out.append(
            f"| {part} | {i} | {kind} | {size_text(primitive)} | {share:.0f} | {1e3 * primitive.deviation:.3f} | {widths} |"
        )
    return out


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="store list and picture")
    given = parser.parse_args()
    lines = [
        "| part | time [s] | segment | primitive | size [mm] | of the area [%] | mean deviation [mm] | widths to hold [mm] |",
        "|---|---|---|---|---|---|---|---|",
    ]
    tiles = []
    for file, unit in files():
        mesh = mg.Mesh.load(file, [unit] * 3)
        begin = time.process_time()
        found = segment_mesh(mesh)
        primitives = fit_primitives(mesh, found.labels, threads=found.threads)
        lines += lines_of(file.stem, mesh, found, primitives, time.process_time() - begin)
        print("\n".join(lines[-len(primitives) :]), flush=True)
        bodies = coloured(
            np.asarray(mesh.vertices), np.asarray(mesh.triangles), np.asarray(found.labels), segment_colour
        )
        tiles.append((file.stem, two_sides(bodies, side=240)))
    if not given.write:
        return
    (HERE / "real_parts.md").write_text("\n".join(lines) + "\n")
    rows = -(-len(tiles) // COLUMNS)
    figure, axes = plt.subplots(rows, COLUMNS, figsize=(3.4 * COLUMNS, 1.9 * rows))
    for axis in axes.flat:
        axis.axis("off")
    for axis, (name, picture) in zip(axes.flat, tiles, strict=False):
        axis.imshow(picture)
        axis.set_title(name, fontsize=8)
    figure.tight_layout()
    figure.savefig(REPOSITORY / "docs" / "images" / "real_parts.png", dpi=70)


if __name__ == "__main__":
    main()
