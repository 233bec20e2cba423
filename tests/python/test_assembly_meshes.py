"""Parts of an assembly that come from mesh files: their size, what is mended in them, and which can be no part."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.grippers import load_assembly, plan_grippers
from test_segment_command import write_stl

pytestmark = pytest.mark.slow


def write_torus(file: Path, triangles: int) -> None:
    """A torus of 80 mm with at least so many triangles as binary STL in mm."""
    n = int(np.ceil(np.sqrt(triangles / 2)))
    u, v = np.meshgrid(*2 * [2 * np.pi / n * np.arange(n)], indexing="ij")
    around = 30 + 10 * np.cos(v)
    at = np.stack([around * np.cos(u), around * np.sin(u), 10 * np.sin(v)], axis=-1)
    right, up = np.roll(at, -1, axis=0), np.roll(at, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    corners = np.concatenate([np.stack([at, right, both], axis=2), np.stack([at, both, up], axis=2)])
    rows = np.zeros(2 * n * n, dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["corners"] = corners.reshape(-1, 3, 3)
    file.write_bytes(bytes(80) + np.uint32(len(rows)).tobytes() + rows.tobytes())


@pytest.fixture
def block_file(tmp_path: Path) -> Callable[..., Path]:
    """An assembly of a block from a mesh file that is put on a plate from above; keywords go to `write_stl`."""

    def write(part: dict[str, Any] | None = None, **options: Any) -> Path:
        write_stl(tmp_path / "block.stl", **options)
        content = {
            "format": "mmgrasp-assembly",
            "version": 1,
            "name": "block on a plate",
            "unit": "mm",
            "parts": [
                {"name": "plate", "box": [120, 120, 10], "pose": {"xyz": [0, 0, -10]}},
                {"name": "block", "mesh": "block.stl", **(part or {})},
            ],
            "order": [{"part": "block", "onto": ["plate"], "from": {"xyz": [0, 0, 80]}}],
            "actuators": [{"name": "jaws", "fingers": 2, "stroke": 48}],
        }
        file = tmp_path / "block.yaml"
        file.write_text(yaml.safe_dump(content))
        return file

    return write


def test_meshes_inside_out_are_turned_and_told(
    tmp_path: Path, block_file: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    """Closed or open, the block gets the gripper that it gets from a file without fault."""
    right = plan_grippers(load_assembly(block_file(scale=1000)))
    assert right.solved and right.notes == [] and right.result is not None
    closed = plan_grippers(load_assembly(block_file(scale=1000, turn=True)))
    assert closed.solved and closed.notes == ["block: the mesh was inside out: its faces were turned"]
    opened = plan_grippers(load_assembly(block_file(scale=1000, turn=True, drop=1)))
    assert opened.solved and len(opened.notes) == 2 and "the mesh is open" in opened.notes[0]
    assert "inside out" in opened.notes[1]
    command = ["grippers", str(block_file(scale=1000, turn=True, drop=1)), "-o", str(tmp_path / "out"), "--no-pictures"]
    assert main(command) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "note: block: the mesh is open" in printed
    assert "note: block: the mesh was inside out: its faces were turned" in printed
    for plan in (closed, opened):
        assert plan.result is not None
        assert [g.to_dict() for g in plan.result.grippers] == [g.to_dict() for g in right.result.grippers]


def test_mesh_files_that_cannot_be_parts(
    tmp_path: Path, block_file: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    """One line each, with file, line, key and rule; nothing is written."""

    def said(file: Path) -> str:
        assert main(["grippers", str(file), "-o", str(tmp_path / "out")]) == 2
        error = " ".join(capsys.readouterr().err.split())
        assert re.search(rf"{re.escape(str(file))}:\d+: parts\[1\]", error) and "Traceback" not in error
        assert not (tmp_path / "out" / "result.json").exists()
        return error

    bearing = said(block_file(scale=1.07e6))  # 40 m
    assert "is 40.04 m from corner to corner with unit: mm" in bearing and "is another unit meant?" in bearing
    file, mesh = block_file(scale=1000), tmp_path / "block.stl"
    mesh.write_text(mesh.read_text().replace("vertex 15", "vertex nan", 1))
    assert "block.stl': vertex" in said(file) and "is not finite" in said(file)
    mesh.write_text("solid part\nendsolid part\n")
    assert "holds no triangle" in said(file)
    write_torus(mesh, 1_000_001)
    assert re.search(
        r"block.stl' ?: has 1,00\d,\d{3} triangles: parts of up to 1,000,000 .* export it coarser", said(file)
    )


def test_assemblies_and_segments_have_one_rule_for_sizes(
    tmp_path: Path, block_file: Callable[..., Path], capsys: pytest.CaptureFixture[str]
) -> None:
    """The block is 37.4 mm from corner to corner; a mesh in inches is as large as one in metres."""
    diagonal = float(np.linalg.norm([0.03, 0.02, 0.01]))
    for size, is_taken in ((0.00101, True), (0.00099, False), (2.99, True), (3.01, False)):
        file = block_file(scale=1000 * size / diagonal)
        if is_taken:
            load_assembly(file)
            continue
        assert main(["segment", str(tmp_path / "block.stl"), "--unit", "mm"]) == 2
        rule = "a part for a gripper is from 0.001 m to 3 m: is "
        assert rule in " ".join(capsys.readouterr().err.split())
        with pytest.raises(mg.InvalidInput, match=rule):
            load_assembly(file)
    inches = block_file(scale=1 / 0.0254)
    inches.write_text(inches.read_text().replace("unit: mm", "unit: inch").replace("120", "4.7").replace("80", "3"))
    vertices = np.asarray(load_assembly(inches).parts["block"].mesh.vertices)
    assert np.ptp(vertices, axis=0) == pytest.approx([0.03, 0.02, 0.01], abs=1e-8)
