"""Damaged mesh files are read or refused at once and within little memory. (`mesh_fuzz.py` by itself tries every change.)"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import mesh_fuzz
import mmgrasp as mg
from mesh_fuzz import FILES, TRIANGLES, VERTEX, collada, joined


@pytest.mark.parametrize("every", [211, pytest.param(13, marks=pytest.mark.slow)])
def test_one_changed_character(every: int) -> None:
    script = [sys.executable, str(Path(mesh_fuzz.__file__)), str(every)]
    done = subprocess.run(script, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, f"{done.stdout[-2000:]}{done.stderr[-2000:]}"
    assert done.stdout.endswith(" 0 complaints\n") and int(done.stdout.split()[0]) > 250_000 // every - 10


@pytest.mark.parametrize("name", FILES)
def test_undamaged_ones_are_the_same_box(name: str, tmp_path: Path) -> None:
    path = tmp_path / f"box.{name}"
    path.write_bytes(FILES[name])
    mesh = mg.Mesh.load(path)
    assert mesh.closed and len(mesh.triangles) == 12
    moved = [1.0, 0, 0] if name == "polylist.dae" else [0.0, 0, 0]
    expected = sorted(tuple(np.add(c, moved).round(6)) for c in mesh_fuzz.CORNERS)
    assert sorted(map(tuple, np.asarray(mesh.vertices).round(6))) == expected


BOX = FILES["dae"].decode()
WHOLE = f'<triangles count="12">{VERTEX}<p>{joined(TRIANGLES)}</p></triangles>'


def placed(*ids: str) -> str:
    return "".join(f'<instance_node url="#{name}"/>' for name in ids)


def chain(links: int, times: int) -> str:
    """Nodes that place each the next so many times, the last of them the box."""
    nodes = "".join(f'<node id="n{i}">{placed(*[f"n{i + 1}"] * times)}</node>' for i in range(links))
    return f'{nodes}<node id="n{links}"><instance_geometry url="#g"/></node>'


REFUSED = {
    "no index": (BOX.replace(" 7 5 ", " 7 = "), "<p> '=' is no index"),
    "negative": (BOX.replace(" 7 5 ", " 7 -5 "), "<p> '-5' is no index"),
    "no number": (BOX.replace("0.1 0.1 0.1<", "0.1 0.1 0,1<"), "<float_array> '0,1' is no number"),
    "too few numbers": (BOX.replace('count="24"', 'count="4000000000"'), "count = '4000000000' must be a whole number"),
    "too many numbers": (BOX.replace('count="24"', 'count="2"'), "holds 24 numbers where 2 are due"),
    "accessor beyond": (BOX.replace('count="8"', 'count="9"'), "source 'p' reaches beyond its <float_array>"),
    "wide stride": (BOX.replace('stride="3"', 'stride="300"', 1), "source 'p' reaches beyond"),
    "many triangles": (BOX.replace('count="12"', 'count="120000000"'), "36 indices where 360000000 are due"),
    "no triangles": (BOX.replace('count="12"', 'count="0"'), "36 indices where count is 0"),
    "wide corners": (BOX.replace('offset="0"', 'offset="99999999"'), "indices where"),
    "no vertices": (BOX.replace('semantic="VERTEX"', 'semantic="NORMAL"'), ""),
    "no positions": (BOX.replace("POSITION", "MATERIAL"), "has no vertices with one list of positions"),
    "twice": (collada(WHOLE.replace("</triangles>", f"<p>{joined(TRIANGLES)}</p></triangles>")).decode(), "holds 24 where"),
    "no vcount": (collada(WHOLE.replace("triangles", "polylist")).decode(), "<p> must follow a <vcount>"),
    "empty polygon": (
        collada(f'<polylist count="2">{VERTEX}<vcount>0 3</vcount><p>0 1 2</p></polylist>').decode(),
        "a polygon without corners",
    ),
    "element in a list": (BOX.replace(" 7 5 ", " 7 <!-- 5 --> 5 "), "<p> must hold text only"),
    "reference": (BOX.replace('"#g"', '"#&#103;"'), "url must hold no '&'"),
    "holes": (collada(f'<polygons count="1">{VERTEX}<ph><p>0 1 3</p></ph></polygons>').decode(), "holes are not read"),
    "skin": (BOX.replace("instance_geometry", "instance_controller"), "is no link of a robot"),
    "skew": (BOX.replace('<node id="n">', '<node id="n"><skew>0 1 0 0 0 1 0</skew>'), "<skew> of a node is not read"),
    "an id twice": (
        collada(WHOLE + '<source id="p"><float_array id="pb" count="0"></float_array></source>' + WHOLE).decode(),
        "<source> has the id of another: 'p'",
    ),
    "circle": (collada(WHOLE, f'<node id="a">{placed("a")}</node>').decode(), "more than 200 deep (a circle?)"),
    "circle of two": (
        collada(WHOLE, placed("a"), f'<node id="a">{placed("b")}</node><node id="b">{placed("a")}</node>').decode(),
        "more than 200 deep",
    ),
    "long chain": (collada(WHOLE, placed("n0"), chain(5000, 1)).decode(), "more than 200 deep"),
    "billion boxes": (collada(WHOLE, placed("n0"), chain(9, 10)).decode(), "multiply to more than 1000000 nodes"),
    "short matrix": (
        collada(WHOLE, '<node id="n"><matrix>1 0 0 0</matrix><instance_geometry url="#g"/></node>').decode(),
        "<matrix> holds 4 numbers where 16 are due",
    ),
    "other text": ("<html></html>", "<html> must be <COLLADA>"),
    "no text": ("nothing", "holds no <COLLADA>"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_collada_that_is_refused(what: str, tmp_path: Path) -> None:
    text, words = REFUSED[what]
    path = tmp_path / "m.dae"
    path.write_text(text)
    with pytest.raises(mg.IoError) as refused:
        mg.Mesh.load(path)
    assert words in str(refused.value) and str(path) in str(refused.value)


TAKEN: dict[str, Callable[[str], str]] = {
    "animations": lambda text: text.replace("<library_nodes>", "<library_animations><p>=</p></library_animations><library_nodes>"),
    "materials": lambda text: text.replace(
        '<instance_geometry url="#g"/>',
        '<instance_geometry url="#g"><bind_material><technique_common/></bind_material></instance_geometry>',
    ),
    "lines": lambda text: text.replace("<triangles", f'<lines count="9">{VERTEX}<p>0 1</p></lines><triangles', 1),
    "names": lambda text: text.replace('node id="n"', 'node id="n" name="a &amp; b"'),
    "comments": lambda text: text.replace("<mesh>", "<mesh><!-- <p>=</p> -->"),
    "many boxes": lambda text: text.replace('<instance_geometry url="#g"/>', '<instance_geometry url="#g"/>' * 100),
}  # fmt: skip


@pytest.mark.parametrize("what", TAKEN)
def test_what_makes_no_shape_is_passed_over(what: str, tmp_path: Path) -> None:
    path = tmp_path / "m.dae"
    path.write_text(TAKEN[what](BOX))
    assert path.read_text() != BOX
    assert len(mg.Mesh.load(path).triangles) == 12


def test_a_corner_far_beyond_is_not_taken_for_another(tmp_path: Path) -> None:
    """2**32 + 1 is no first corner."""
    path = tmp_path / "m.obj"
    path.write_bytes(FILES["obj"].replace(b"f 1 2/", b"f 4294967297 2/", 1))
    with pytest.raises(mg.IoError, match="4294967297"):
        mg.Mesh.load(path)


def test_faces_without_corners_are_refused(tmp_path: Path) -> None:
    """Assimp, with which `verify` reads meshes again, ends the process at one."""
    path = tmp_path / "m.ply"
    path.write_bytes(FILES["ply"].replace(b"\n3 0 1 3\n", b"\n0\n", 1))
    with pytest.raises(mg.IoError, match="a face has 0 corners"):
        mg.Mesh.load(path)
