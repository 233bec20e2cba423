"""`mmgrasp grippers`: from an assembly's file to grippers that were rehearsed, and what is wrong with a file."""

from __future__ import annotations

import base64
import html
import json
import re
from collections.abc import Callable
from dataclasses import replace
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.grippers import load_assembly, plan_grippers
from mmgrasp.grippers.assembly_file import shipped_assembly
from mmgrasp.grippers.output import GRIPPER_FILES, result_to_dict
from mmgrasp.grippers.planning import FINGERS_OF, GripperPlan, operation_of
from mmgrasp.grippers.turned_parts import block, turned
from mmgrasp.reproduce import segmentation
from mmgrasp.viz.gripper_pictures import SIDE, operation_bodies, write_gripper_pictures
from mmgrasp.viz.gripper_report import gripper_report_html
from mmgrasp.viz.png import write_png
from mmgrasp.viz.segment_pictures import segment_picture
from mmgrasp.viz.two_sides import FROM_ABOVE_AND_ASIDE, two_sides
from test_segment_mesh import as_mesh

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def pulley() -> GripperPlan:
    return plan_grippers(load_assembly("pulley"))


def changed(tmp_path: Path, **changes: Any) -> Path:
    """The shipped assembly with some top-level keys changed."""
    content = yaml.safe_load(shipped_assembly("pulley").read_text())
    content.update(changes)
    file = tmp_path / "assembly.yaml"
    file.write_text(yaml.safe_dump(content))
    return file


def test_turned_parts_are_solids() -> None:
    ring = turned([[0.01, 0.0], [0.02, 0.0], [0.02, 0.005], [0.01, 0.005]])
    assert ring.closed
    sides = 64
    area = sides / 2 * np.sin(2 * np.pi / sides) * (0.02**2 - 0.01**2)
    assert ring.volume == pytest.approx(area * 0.005)
    cone = turned([[0.0, 0.0], [0.01, 0.0], [0.0, 0.03]])
    assert cone.closed
    assert block([0.1, 0.2, 0.3]).volume == pytest.approx(0.006)


def test_the_shipped_assembly_gets_grippers_that_were_rehearsed(pulley: GripperPlan) -> None:
    assert pulley.solved
    assert pulley.result is not None
    assert pulley.result.lower_bound == len(pulley.result.grippers)
    assert set(pulley.rehearsed) == {step.name for step in pulley.assembly.steps}
    # The shaft stands 24 mm out of the sleeve's top at 36 mm, the tips lie below it.
    sleeve = [r for r in pulley.requirements if r.part == "sleeve" and r.fingers == 3]
    assert sleeve and min(r.min_finger_length for r in sleeve) >= 0.044
    for i, part in enumerate(pulley.result.parts):
        requirement = pulley.requirements[pulley.result.requirement_of_part[i]]
        assert requirement.part == part
        assert pulley.result.grippers[pulley.result.gripper_of_part[i]].holds(requirement)


def test_rehearsal_meets_what_too_short_fingers_would(pulley: GripperPlan) -> None:
    assert pulley.result is not None
    i = pulley.result.parts.index("sleeve")
    grasp = pulley.grasps[pulley.result.requirement_of_part[i]]
    gripper = pulley.result.grippers[pulley.result.gripper_of_part[i]]
    step = pulley.assembly.steps[i]
    numbers = gripper.to_dict()
    asked = pulley.requirements[pulley.result.requirement_of_part[i]].min_finger_length
    short = mg.gripper_design.Gripper(**{**numbers, "finger_length": asked - 0.001})
    just = mg.gripper_design.Gripper(**{**numbers, "finger_length": asked + 1e-5})
    operation = operation_of(pulley.assembly, step)
    assert mg.gripper_design.rehearse_operation(just, grasp, operation) == ""
    assert "shaft" in mg.gripper_design.rehearse_operation(short, grasp, operation)


def test_open_meshes_are_named(pulley: GripperPlan) -> None:
    assert pulley.notes == []
    sleeve = pulley.assembly.parts["sleeve"]
    mesh = mg.Mesh.from_arrays(sleeve.mesh.vertices, np.asarray(sleeve.mesh.triangles)[1:])
    parts = {**pulley.assembly.parts, "sleeve": replace(sleeve, mesh=mesh)}
    plan = replace(pulley, assembly=replace(pulley.assembly, parts=parts))
    (note,) = plan.notes
    assert note.startswith("sleeve: the mesh is open")
    assert note in gripper_report_html(plan, None)
    assert result_to_dict(plan)["notes"] == [note]


def test_command_writes_files_that_load(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    two = str(changed(tmp_path, order=[{"part": "base"}, {"part": "shaft", "from": {"xyz": [0, 0, 80]}}]))
    assert main(["grippers", two, "-o", str(tmp_path / "out"), "--no-pictures"]) == 0
    assert main(["grippers", two, "-o", str(tmp_path / "out")]) == 0  # the same folder again
    printed = capsys.readouterr().out
    assert "proven: no set of grippers costs less" in printed
    result = json.loads((tmp_path / "out" / "result.json").read_text())
    assert result["outcome"] == "solved"
    for gripper in result["grippers"]:
        folder = tmp_path / "out" / gripper["name"]
        robot = mg.Robot.load(folder / "gripper.urdf", srdf=folder / "gripper.srdf")
        assert robot.group("fingers").upper[0] == pytest.approx((gripper["max_opening"] - gripper["min_opening"]) / 2)
    assert {o["met"] for o in result["operations"]} == {""}
    report = (tmp_path / "out" / "report.html").read_text()
    assert report.count("<img") == 2 * len(result["operations"])


def test_what_cannot_be_held_says_why(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    order = [{"part": part, "from": {"xyz": [0, 0, 80]}} for part in ("shaft", "sleeve")]
    file = changed(tmp_path, order=order, actuators=[{"name": "jaws", "fingers": 2, "stroke": 48, "max_opening": 48}])
    assert main(["grippers", str(file), "-o", str(tmp_path / "out"), "--no-pictures"]) == 3
    printed = capsys.readouterr().out
    assert "no actuator has 3 fingers" in printed
    assert "sleeve: no segment can be held" in printed
    assert "would help: sleeve: a drive with 3 fingers" in printed


def test_what_would_help_is_a_longer_finger_or_another_stroke(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """And with what is said to help it is held. Exit code 4: grasps were tried and none goes through; 3: there is none to try."""
    order = [{"part": "sleeve", "onto": ["base", "shaft"], "from": {"xyz": [0, 0, 80]}}]
    chuck = {"name": "chuck", "fingers": 3, "stroke": 16}

    def said(code: int, **changes: Any) -> str:
        file = changed(tmp_path, order=order, **changes)
        assert main(["grippers", str(file), "-o", str(tmp_path / "out"), "--no-pictures"]) == code
        return capsys.readouterr().out

    short = said(4, actuators=[chuck], fingers={"longest": 30})
    found = re.search(r"would help: sleeve: fingers of ([\d.]+) mm would do", short)
    assert found and 44 <= float(found[1]) < 60  # the shaft stands 24 mm out of the sleeve, whose tips lie below
    assert "sleeve/cylinder_1: " in short
    said(0, actuators=[chuck], fingers={"longest": float(found[1])})
    narrow = said(3, actuators=[{**chuck, "max_opening": 16}])
    found = re.search(
        r"would help: sleeve: a drive with 3 fingers, a stroke of ([\d.]+) mm and an opening of up to ([\d.]+) mm",
        narrow,
    )
    assert found and "wider than any actuator opens" in narrow
    said(0, actuators=[{**chuck, "stroke": float(found[1]), "max_opening": float(found[2])}])


def test_fixtures_are_there_all_the_time(tmp_path: Path) -> None:
    """A part that no operation moves is one as soon as any operation has things put onto it; others are in nobody's way, which is told."""
    order: list[dict[str, Any]] = [{"part": "sleeve"}, {"part": "shaft", "onto": ["base"]}, {"part": "cap"}]
    read = load_assembly(changed(tmp_path, order=order))
    assert [step.passive for step in read.steps] == [["base"], ["base"], ["base", "sleeve", "shaft"]]
    order[1]["onto"] = ["sleeve"]
    read = load_assembly(changed(tmp_path, order=order))
    assert [step.passive for step in read.steps] == [[], ["sleeve"], ["sleeve", "shaft"]]
    alone = load_assembly(changed(tmp_path, order=[{"part": "key", "onto": ["base"], "from": {"xyz": [0, 0, 80]}}]))
    notes = [f"{name}: no operation moves it, and none has it in onto: it is in nobody's way" for name in alone.parts]
    plan = plan_grippers(alone)
    assert plan.solved and plan.notes == [note for note in notes if note.split(":")[0] not in ("key", "base")]


def test_fingers_by_kind_are_those_of_the_library(tang_file: Callable[..., Path], pulley: GripperPlan) -> None:
    """The rule of 5.2.1 is written in C++ and, for the reproduction, in Python."""
    fates = [fate for plan in (pulley, plan_grippers(load_assembly(tang_file()))) for fate in plan.fates]
    assert {fate.kind for fate in fates} >= set(FINGERS_OF)
    assert {fate.fingers for fate in fates} >= set(FINGERS_OF.values())
    for fate in fates:
        assert fate.fingers == FINGERS_OF.get(fate.kind, 0)
    assert segmentation.KIND == {fingers: kind for kind, fingers in FINGERS_OF.items()}


def captioned(page: str) -> dict[str, bytes]:
    """Pictures of a report by what stands under them."""
    found = re.findall(r'src="data:image/png;base64,([^"]*)"><figcaption>(.*?)</figcaption>', page)
    assert len({caption for _, caption in found}) == len(found)
    return {html.unescape(caption): base64.b64decode(data) for data, caption in found}


def test_names_that_look_alike_in_files_have_pictures_of_their_own(tmp_path: Path) -> None:
    """Blocks of which only letters and digits would be told apart, or none at all."""
    names = ["a b", "a_b", "Ä", "夹具", "x" * 200, "x" * 199 + "y"]
    content: dict[str, Any] = {
        "format": "mmgrasp-assembly",
        "version": 1,
        "name": "blocks",
        "unit": "mm",
        "parts": [{"name": "plate", "box": [900, 120, 10], "pose": {"xyz": [0, 0, -5]}}],
        "order": [{"part": name, "onto": ["plate"], "from": {"xyz": [0, 0, 80]}} for name in names],
        "actuators": [{"name": "jaws", "fingers": 2, "stroke": 48}],
    }
    for i, name in enumerate(names):
        pose = {"xyz": [120 * i - 300, 0, 10]}
        content["parts"].append({"name": name, "box": [16 + 2 * i, 20 + 2 * i, 20], "pose": pose})
    file = tmp_path / "assembly.yaml"
    file.write_text(yaml.safe_dump(content, allow_unicode=True))
    plan = plan_grippers(load_assembly(file))
    assert plan.solved
    paths = write_gripper_pictures(plan, tmp_path, lambda what, share: None)
    assert len(set(paths)) == len({path.name.lower() for path in paths}) == 2 * len(names)
    assert all(path.read_bytes().startswith(b"\x89PNG") and len(path.name) < 100 for path in paths)
    assert all(any(fnmatch(path.name, known) for known in GRIPPER_FILES) for path in paths)
    shown = captioned(gripper_report_html(plan, tmp_path))
    assert list(shown) == [*names, *(f"Segments of {name}" for name in names)]
    for i, name in enumerate(names):
        mesh, labels = plan.assembly.parts[name].mesh, np.asarray(plan.segmentations[name].labels)
        image = segment_picture(mesh.vertices, np.asarray(mesh.triangles), labels, plan.segment_names[name], SIDE)
        assert shown[f"Segments of {name}"] == write_png(tmp_path / "own.png", image).read_bytes()
        image = two_sides(operation_bodies(plan, i), FROM_ABOVE_AND_ASIDE, SIDE)
        assert shown[name] == write_png(tmp_path / "own.png", image).read_bytes()
    assert len(set(shown.values())) == len(shown)


def test_parts_that_stand_in_each_other_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """From below, through the base; and an end 3 mm too low, which a larger max_overlap lets pass."""
    below = changed(tmp_path, order=[{"part": "shaft", "onto": ["base"], "from": {"xyz": [0, 0, -80]}}])
    assert main(["grippers", str(below), "-o", str(tmp_path / "out"), "--no-pictures"]) == 3
    assert re.search(r"shaft stands [\d.]+ mm deep in base [\d.]+ mm before its end", capsys.readouterr().out)
    parts = yaml.safe_load(shipped_assembly("pulley").read_text())["parts"]
    next(p for p in parts if p["name"] == "base")["pose"] = {"xyz": [0, 0, -2]}
    order = [{"part": "shaft", "onto": ["base"], "from": {"xyz": [0, 0, 80]}}]
    low = changed(tmp_path, parts=parts, order=order)
    assert main(["grippers", str(low), "-o", str(tmp_path / "out"), "--no-pictures"]) == 3
    assert "shaft stands 3 mm deep in base at its end (max_overlap is 0.5 mm)" in capsys.readouterr().out
    allowed = changed(tmp_path, parts=parts, order=order, options={"max_overlap": 3.5})
    assert not plan_grippers(load_assembly(allowed)).missing


def test_boxes_keep_fingers_off_a_part_of_a_segment(tmp_path: Path) -> None:
    """The shaft's collar, 6 mm high, is held up to 5.5 mm deep; where a strip around its middle is to be left alone, up to that strip."""

    def depths(plan: GripperPlan) -> list[float]:
        return [1e3 * g.contact_length for g in plan.grasps if abs(g.opening - 0.04) < 1e-4]

    parts = yaml.safe_load(shipped_assembly("pulley").read_text())["parts"]
    order = [{"part": "shaft", "from": {"xyz": [0, 0, 80]}}]
    assert max(depths(plan_grippers(load_assembly(changed(tmp_path, order=order))))) == pytest.approx(5.5, abs=0.1)
    shaft = next(p for p in parts if p["name"] == "shaft")
    shaft["keep_off"] = [{"box": [50, 50, 1], "pose": {"xyz": [0, 0, 3]}}]
    kept = plan_grippers(load_assembly(changed(tmp_path, order=order, parts=parts)))
    assert kept.solved
    assert 1.5 <= min(depths(kept)) + 1e-6 and max(depths(kept)) < 2.5
    shaft["keep_off"] = [99]
    with pytest.raises(
        mg.InvalidInput,
        match=r"assembly.yaml:\d+: parts\[\d\].keep_off\[0\]: keep_off of part 'shaft' = 99: must be the number of one of its \d+ ",
    ):
        plan_grippers(load_assembly(changed(tmp_path, order=order, parts=parts)))


@pytest.fixture
def tang_file(tmp_path: Path) -> Callable[..., Path]:
    """An assembly of a cylinder of 40 mm with a tang of 24 x 14 mm on it; `keep_off` is the part's."""
    m3 = pytest.importorskip("manifold3d")
    solid = m3.Manifold.cylinder(30, 20, 20, 96) + m3.Manifold.cube((24, 14, 20), True).translate((0, 0, 40))
    mesh = solid.to_mesh()
    as_mesh(np.asarray(mesh.vert_properties)[:, :3], np.asarray(mesh.tri_verts), tmp_path / "tang.ply")

    def write(*keep_off: Any) -> Path:
        content = {
            "format": "mmgrasp-assembly",
            "version": 1,
            "name": "a tang",
            "unit": "mm",
            "parts": [
                {"name": "plate", "box": [120, 120, 10], "pose": {"xyz": [0, 0, -5]}},
                {"name": "tang", "mesh": "tang.ply", "keep_off": list(keep_off)},
            ],
            "order": [{"part": "tang", "onto": ["plate"], "from": {"xyz": [0, 0, 80]}}],
            "actuators": [
                {"name": "jaws", "fingers": 2, "stroke": 48},
                {"name": "chuck", "fingers": 3, "stroke": 16},
            ],
        }
        file = tmp_path / "tang.yaml"
        file.write_text(yaml.safe_dump(content))
        return file

    return write


def touched(plan: GripperPlan) -> set[str]:
    """What the pads of the chosen gripper lie on, by points drawn on the part: its round wall, its flats, or anything else."""
    assert plan.result is not None
    grasp = plan.grasps[plan.result.requirement_of_part[0]]
    gripper = plan.result.grippers[plan.result.gripper_of_part[0]]
    mesh = plan.assembly.parts["tang"].mesh
    corners = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    rng = np.random.default_rng(1)
    which = rng.choice(len(areas), 400_000, p=areas / areas.sum())
    weights = rng.dirichlet([1, 1, 1], len(which))
    points = np.einsum("ij,ijk->ik", weights, corners[which])
    tool = np.linalg.inv(grasp.T_active_tool)
    local = points @ tool[:3, :3].T + tool[:3, 3]  # z along the approach, tips in z = 0
    facing = (normals[which] / areas[which, None]) @ tool[:3, :3].T
    out: set[str] = set()
    for k in range(gripper.fingers):
        angle = 2 * np.pi * k / gripper.fingers
        away = local[:, 0] * np.cos(angle) + local[:, 1] * np.sin(angle) - grasp.opening / 2
        aside = local[:, 1] * np.cos(angle) - local[:, 0] * np.sin(angle)
        on = (np.abs(away) < 5e-5) & (np.abs(aside) < gripper.finger_width / 2)
        on &= facing[:, 0] * np.cos(angle) + facing[:, 1] * np.sin(angle) > 0.99
        on &= (local[:, 2] < 0) & (local[:, 2] > -gripper.finger_length)
        assert on.sum() > 20
        for x, y, _ in points[on]:
            flat = min(abs(abs(y) - 0.007), abs(abs(x) - 0.012)) < 1e-6
            out.add("flats" if flat else "wall" if abs(np.hypot(x, y) - 0.02) < 1e-4 else "other")
    return out


def test_a_segment_by_name_moves_the_grasp_to_other_faces(tang_file: Callable[..., Path]) -> None:
    free = plan_grippers(load_assembly(tang_file()))
    assert free.segment_names == {"tang": ["cylinder_1", "box_1"]}
    assert free.solved and touched(free) in ({"wall"}, {"flats"})
    for name, left in (("cylinder_1", {"flats"}), ("box_1", {"wall"}), ("tang/box_1", {"wall"})):
        plan = plan_grippers(load_assembly(tang_file(name)))
        assert plan.solved and touched(plan) == left
        fate = next(f for f in plan.fates if f.refused == "not to be touched")
        assert fate.name == name.removeprefix("tang/")
        assert f"<td>{fate.name}</td>" in gripper_report_html(plan, None)
        assert {s["name"]: s["refused"] for s in result_to_dict(plan)["segments"]}[fate.name] == "not to be touched"
        assert {r.segment for r in plan.requirements} == {
            f"tang/{other}" for other in ("cylinder_1", "box_1") if other != fate.name
        }
    both = plan_grippers(load_assembly(tang_file("cylinder_1", "box_1")))
    assert not both.solved and both.missing == [
        "tang: no segment can be held; tang/cylinder_1, tang/box_1: not to be touched"
    ]


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("cylinder_3", "= cylinder_3: must be the name of one of its segments, cylinder_1, box_1; did you mean"),
        (
            "cilinder_1",
            "= 'cilinder_1': must be the name of a segment as `mmgrasp segment` gives it; did you mean cylinder_1?",
        ),
        ("plate/box_1", "= 'plate/box_1': must be the name of a segment"),
        ("box_0", "= 'box_0': must be the name of a segment as `mmgrasp segment` gives it; did you mean box_1?"),
    ],
)
def test_wrong_names_of_segments_are_told_at_their_line(
    tmp_path: Path, tang_file: Callable[..., Path], capsys: pytest.CaptureFixture[str], name: str, message: str
) -> None:
    file = tang_file("box_1", name)
    assert main(["grippers", str(file), "-o", str(tmp_path / "out")]) == 2
    error = " ".join(capsys.readouterr().err.split())
    line = next(i for i, text in enumerate(file.read_text().splitlines(), 1) if name in text)
    assert f"{file}:{line}: parts[1].keep_off[1]" in error and message in error
    assert not (tmp_path / "out" / "result.json").exists()


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"unit": "m"},
            "is 170 m from corner to corner with unit: m; a part for a gripper is from 0.001 m to 3 m: is mm meant?",
        ),
        ({"unit": "feet"}, "unit = 'feet'"),
        ({"order": [{"part": "no such"}]}, "is no part"),
        ({"order": []}, "must not be empty"),
        ({"order": [{"part": "shaft"}, {"part": "shaft"}]}, "an order names a part once"),
        ({"order": [{"part": "shafts"}]}, "did you mean shaft"),
        ({"order": [{"part": "shaft", "onto": ["shaft"]}]}, "cannot be moved and stay"),
        (
            {"order": [{"part": "base"}, {"part": "shaft", "onto": ["base", "cap"]}, {"parts": ["key", "cap"]}]},
            "order[1].onto[1] = 'cap': is brought to its place only later, by order[2]",
        ),
        ({"actuators": []}, "must not be empty"),
        ({"actuators": [{"name": "a", "fingers": 4, "stroke": 8}]}, "must be 2 or 3"),
        ({"fingers": {"longest": 5, "shortest": 10}}, "must be at least shortest"),
        ({"fingers": {"lenght": 5}}, "lenght"),
        ({"parts": []}, "must not be empty"),
        ({"parts": [{"name": "a", "turned": [[1, 0], [1, 1]]}]}, "at least three rows"),
        ({"parts": [{"name": "a", "turned": [[0, 0], [0, 5], [0, 10]]}]}, "a radius must be above 0"),
        ({"parts": [{"name": "a", "turned": [[True, 0], [1, 0], [1, 1]]}]}, "must be numbers"),
        ({"parts": [{"name": "a", "turned": [["1", 0], [1, 0], [1, 1]]}]}, "must be numbers"),
        ({"parts": [{"name": "a", "mesh": "a.stl", "box": [1, 1, 1]}]}, "one of mesh, turned and box"),
        ({"parts": [{"name": "a", "mesh": "no_such.stl"}]}, "no_such.stl"),
        ({"parts": [{"name": "a", "box": [1, 1, 1], "keep_off": [{"box": [1, 0, 1]}]}]}, "must be > 0"),
        ({"parts": [{"name": "a", "box": [1, 1, 1], "keep_off": [{"ball": 1}]}]}, "ball"),
        ({"parts": [{"name": "a", "box": [1, 1, 1], "keep_off": [-1]}]}, "keep_off[0] = -1: must be >= 0"),
        ({"parts": [{"name": "a", "box": [1, float("nan"), 1]}]}, "parts[0].box[1] = nan: must be finite"),
        ({"parts": [{"name": "a", "turned": [[1, 0], [float("nan"), 0], [1, 1]]}]}, "nan"),
        ({"actuators": [{"name": "a", "fingers": 3, "stroke": float("nan")}]}, "stroke = nan: must be finite"),
        ({"order": [{"part": "shaft", "from": {"xyz": [0, float("inf"), 0]}}]}, "= inf: must be finite"),
        ({"options": {"max_overlap": -1}}, "max_overlap = -1"),
        ({"version": 9}, "version"),
        ({"format": "mmgrasp-scenario"}, "mmgrasp-assembly"),
    ],
)
def test_mistakes_in_the_file_are_named(
    tmp_path: Path, changes: dict[str, Any], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = changed(tmp_path, **changes)
    assert main(["grippers", str(file), "-o", str(tmp_path / "out")]) == 2
    error = capsys.readouterr().err
    assert message in " ".join(error.split())
    assert re.search(rf"{re.escape(str(file))}:\d+: ", error)
    assert "Traceback" not in error
    assert not (tmp_path / "out" / "result.json").exists()
