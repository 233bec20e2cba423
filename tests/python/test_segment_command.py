"""`mmgrasp segment`: what it writes and prints, and what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import manifold3d as m3
import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.viz.legend import legend
from mmgrasp.viz.style import rgb


def write_stl(path: Path, scale: float = 1.0, drop: int = 0, turn: bool = False) -> Path:
    mesh = mg.LinkShape(mg.Box([0.03, 0.02, 0.01])).surface()
    corners = scale * mesh.vertices[mesh.triangles]
    rows = ["solid part"]
    for corner in corners[drop:]:
        a, b, c = corner[::-1] if turn else corner
        points = "".join(f" vertex {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in (a, b, c))
        rows.append(f"facet normal 0 0 0 outer loop{points} endloop endfacet")
    path.write_text("\n".join([*rows, "endsolid part"]) + "\n")
    return path


@pytest.mark.slow
def test_segments_of_a_box(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part = write_stl(tmp_path / "part.stl", scale=1000)
    assert main(["segment", str(part), "--unit", "mm", "-o", str(tmp_path / "out"), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    written = json.loads((tmp_path / "out" / "segments.json").read_text())
    assert printed == written
    (segment,) = written["segments"]
    assert segment["primitive"] == "box" and segment["name"] == "box_1"
    assert sorted(w["width"] for w in segment["widths"]) == pytest.approx([0.01, 0.02, 0.03], abs=1e-8)
    assert segment["segment"] == 0 and written["labels"] == [0] * 12 and written["notes"] == []
    for picture in ("segments.png", "primitives.png", "diameters.png"):
        assert (tmp_path / "out" / picture).read_bytes().startswith(b"\x89PNG")


def test_names_stand_below_the_picture() -> None:
    """A swatch of each colour and ink beside it; a strip too narrow for all names has more rows."""
    entries = [("cylinder_1", "#0072B2"), ("box_1", "#E69F00"), ("cylinder_2", "#009E73")]
    wide, narrow = legend(entries, 600), legend(entries, 160)
    assert wide.shape == (wide.shape[0], 600, 3) and narrow.shape[0] == 3 * wide.shape[0]
    for strip in (wide, narrow):
        swatches = [(strip == np.round(255 * np.array(rgb(colour)))).all(axis=2) for _, colour in entries]
        assert {int(s.sum()) for s in swatches} == {15 * 15}
        for swatch in swatches:
            rows, columns = np.nonzero(swatch)
            beside = strip[rows.min() : rows.max() + 1, columns.max() + 1 : columns.max() + 60]
            assert (beside < 100).any()


@pytest.mark.slow
def test_table_names_widths(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["segment", str(write_stl(tmp_path / "part.stl"))]) == 0
    out = capsys.readouterr().out
    assert "box_1" in out and "20.00 (100" in out


def write_prism(path: Path, profile: list[tuple[float, float]], length: float, refined: int) -> Path:
    """A profile [mm] extruded along z, each triangle cut into `refined` squared."""
    solid = m3.Manifold.extrude(m3.CrossSection([profile]), length).refine(refined).to_mesh()
    vertices, triangles = np.array(solid.vert_properties)[:, :3], np.array(solid.tri_verts)
    rows = ["solid part"]
    for corners in vertices[triangles]:
        points = "".join(f" vertex {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in corners)
        rows.append(f"facet normal 0 0 0 outer loop{points} endloop endfacet")
    path.write_text("\n".join([*rows, "endsolid part"]) + "\n")
    return path


PROFILES: dict[str, tuple[list[tuple[float, float]], list[float]]] = {
    "L": ([(0, 0), (60, 0), (60, 5), (5, 5), (5, 40), (0, 40)], [5, 30, 40, 60]),
    "U": ([(0, 0), (50, 0), (50, 30), (44, 30), (44, 8), (6, 8), (6, 30), (0, 30)], [6, 8, 30, 50]),
    "T": (
        [(20, 0), (28, 0), (28, 30), (48, 30), (48, 36), (0, 36), (0, 30), (20, 30)],
        [6, 8, 30, 48],
    ),  # its flange and its stem
}


@pytest.mark.slow
@pytest.mark.parametrize(("name", "refined"), [("L", 1), ("L", 32), ("U", 1), ("U", 32), ("T", 1), ("T", 32)])
def test_widths_of_profiles_are_those_that_grasps_have(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, refined: int
) -> None:
    """Walls of a profile, its whole widths and the length of its prism, as jaws close on them."""
    profile, widths = PROFILES[name]
    part = write_prism(tmp_path / "part.stl", profile, 30, refined)
    assert main(["segment", str(part), "--unit", "mm", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    mesh, labels, held_by_any = mg.Mesh.load(part, scale=0.001), np.array(found["labels"]), set()
    for segment in found["segments"]:
        grasps = mg.gripper_design.jaw_grasps(mesh, list(np.flatnonzero(labels == segment["segment"])))
        held = {round(1e3 * g.opening, 3) for g in grasps}
        assert {round(1e3 * w["width"], 3) for w in segment["widths"]} == held
        held_by_any |= held
    assert held_by_any == set(widths)


@pytest.mark.slow
def test_open_mesh_inside_out_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part = write_stl(tmp_path / "part.stl", drop=1, turn=True)
    assert main(["segment", str(part), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert not found["closed"]
    assert any("open" in note for note in found["notes"]) and any("inside out" in note for note in found["notes"])
    assert len(found["segments"][0]["widths"]) == 3


@pytest.mark.slow
def test_closed_mesh_inside_out_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """It is turned when it is loaded; the file is wrong all the same."""
    for turn in (False, True):
        part = write_stl(tmp_path / "part.stl", turn=turn)
        assert main(["segment", str(part), "--json"]) == 0
        found = json.loads(capsys.readouterr().out)
        assert found["closed"] and len(found["segments"][0]["widths"]) == 3
        assert found["notes"] == (["the mesh was inside out: its faces were turned"] if turn else [])


def write_faulty_box(path: Path, turned: int = 0, twice: bool = False, beside: float = 0.0) -> Path:
    """The box of `write_stl` with some faces turned, every face twice, or a second box at a distance along x [m]."""
    mesh = mg.LinkShape(mg.Box([0.03, 0.02, 0.01])).surface()
    corners = np.array(mesh.vertices[mesh.triangles])
    corners[:turned] = corners[:turned, ::-1]
    if twice:
        corners = np.concatenate([corners, corners])
    if beside:
        corners = np.concatenate([corners, corners + [beside, 0, 0]])
    rows = ["solid part"]
    for c in corners:
        points = "".join(f" vertex {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in c)
        rows.append(f"facet normal 0 0 0 outer loop{points} endloop endfacet")
    path.write_text("\n".join([*rows, "endsolid part"]) + "\n")
    return path


TURNED = "faces of 12 looked another way than the rest of the mesh: they were turned"
TWICE = "the mesh has 12 faces twice: one of each was left out"
FAULTS = {
    "six turned": ({"turned": 6}, [f"6 {TURNED}"]),
    "one turned": ({"turned": 1}, [f"1 {TURNED}".replace("faces", "face", 1)]),
    "all twice": ({"twice": True}, [TWICE]),
    "five turned, all twice": ({"turned": 5, "twice": True}, [TWICE, f"5 {TURNED}"]),
}


@pytest.mark.slow
@pytest.mark.parametrize("fault", FAULTS)
def test_faulty_meshes_are_mended_and_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], fault: str) -> None:
    """Volume and widths are those of the mesh without fault."""
    how, notes = FAULTS[fault]
    part = write_faulty_box(tmp_path / "part.stl", **how)  # type: ignore[arg-type]
    assert mg.Mesh.load(part).volume == pytest.approx(0.03 * 0.02 * 0.01, rel=1e-6)
    assert main(["segment", str(part), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["closed"] and found["triangles"] == 12 and found["notes"] == notes
    (segment,) = found["segments"]
    assert sorted(w["width"] for w in segment["widths"]) == pytest.approx([0.01, 0.02, 0.03], abs=1e-8)
    assert [w["covered"] for w in segment["widths"]] == pytest.approx([1, 1, 1])


def write_box_in_box(path: Path, outwards: tuple[bool, bool]) -> Path:
    """A box of 30 x 20 x 10 mm with one of half the size in its middle; each looks outwards or inwards."""
    mesh = mg.LinkShape(mg.Box([0.03, 0.02, 0.01])).surface()
    corners = np.array(mesh.vertices[mesh.triangles])
    shells = [size * (corners if out else corners[:, ::-1]) for size, out in zip((1.0, 0.5), outwards, strict=True)]
    rows = ["solid part"]
    for c in np.concatenate(shells):
        points = "".join(f" vertex {p[0]:.9g} {p[1]:.9g} {p[2]:.9g}" for p in c)
        rows.append(f"facet normal 0 0 0 outer loop{points} endloop endfacet")
    path.write_text("\n".join([*rows, "endsolid part"]) + "\n")
    return path


NESTED = {
    (True, False): (0.875, []),
    (False, False): (0.875, ["12 faces of 24 looked another way than the rest of the mesh: they were turned"]),
    (False, True): (0.875, ["the mesh was inside out: its faces were turned"]),
    (True, True): (
        1.0,
        [
            "1 body lies wholly within the material of another and would be weighed twice: left out; "
            "the walls of a void must look into it"
        ],
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("outwards", NESTED)
def test_a_box_in_a_box_is_a_void_or_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], outwards: tuple[bool, bool]
) -> None:
    """The walls around a void are no widths: no finger gets there."""
    share, notes = NESTED[outwards]
    part = write_box_in_box(tmp_path / "part.stl", outwards)
    assert mg.Mesh.load(part).volume == pytest.approx(share * 0.03 * 0.02 * 0.01, rel=1e-6)
    assert main(["segment", str(part), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["closed"] and found["notes"] == notes
    widths = [w["width"] for s in found["segments"] for w in s["widths"]]
    assert sorted(widths) == pytest.approx([0.01, 0.02, 0.03], abs=1e-8)


@pytest.mark.slow
def test_two_bodies_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for beside, bodies in ((0.04, 2), (0.03, 1)):  # apart by 10 mm; face to face
        part = write_faulty_box(tmp_path / "part.stl", beside=beside)
        assert main(["segment", str(part), "--json"]) == 0
        notes = json.loads(capsys.readouterr().out)["notes"]
        assert len(notes) == bodies - 1
        assert all("2 bodies that do not touch" in note for note in notes)


@pytest.mark.parametrize(("scale", "unit"), [(1000.0, "m"), (1e-3, "m"), (1.0, "mm")])
def test_units_that_cannot_be_right(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], scale: float, unit: str
) -> None:
    part = write_stl(tmp_path / "part.stl", scale=scale)
    assert main(["segment", str(part), "--unit", unit]) == 2
    said = capsys.readouterr().err
    assert "m from corner to corner" in said and str(part) in said
    if scale == 1000.0:
        assert "mm" in said


def test_a_number_that_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part = write_stl(tmp_path / "part.stl")
    part.write_text(part.read_text().replace("vertex 0.015", "vertex nan", 1))
    assert main(["segment", str(part)]) == 2
    assert "part.stl" in capsys.readouterr().err


def test_a_sheet_has_no_thickness(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part = tmp_path / "sheet.stl"
    rows = ["solid s"]
    for a, b, c in (((0, 0, 0), (0.1, 0, 0), (0.1, 0.1, 0)), ((0, 0, 0), (0.1, 0.1, 0), (0, 0.1, 0))):
        points = "".join(" vertex {} {} {}".format(*p) for p in (a, b, c))
        rows.append(f"facet normal 0 0 1 outer loop{points} endloop endfacet")
    part.write_text("\n".join([*rows, "endsolid s"]) + "\n")
    assert main(["segment", str(part), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert any("sheet" in note for note in found["notes"])
    assert all(not segment["widths"] for segment in found["segments"])
    assert np.isfinite(found["segments"][0]["volume"])
