"""A tray whose parts nobody typed: from frames, rendered with noise, to a plan that holds against the map and against the truth."""

from __future__ import annotations

import copy
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.scenario import load_scenario, map_bodies
from mmgrasp.scenario.map_bodies import cells_around, edge_for, large_pieces, merged, rectangles

SCENARIO = "asset:scenarios/scanned_tray.yaml"
TRUTH: dict[
    tuple[float, float], tuple[float, mg.Box | mg.Cylinder]
] = {  # place in the tray, yaw, sides of the box or radius and length
    (-0.06, -0.12): (0.5, mg.Box([0.05, 0.04, 0.06])),
    (-0.05, 0.02): (0.0, mg.Cylinder(0.025, 0.08)),
    (-0.04, 0.13): (1.2, mg.Box([0.025, 0.06, 0.075])),
    (0.07, 0.09): (-0.3, mg.Box([0.05, 0.04, 0.06])),
}
FLOOR = np.array([1.68, 0.0, 0.756])


@pytest.fixture(scope="module")
def planned(own_cache: None) -> mg.scenario.Scenario:
    return load_scenario(SCENARIO)


@pytest.fixture(scope="module")
def plan(planned: mg.scenario.Scenario) -> dict[str, Any]:
    found = mg.plan_part_supply(planned)
    assert found.outcome == mg.Outcome.solved
    content: dict[str, Any] = json.loads(json.dumps(found.to_dict()))
    return content


def truth_at(place: np.ndarray) -> tuple[mg.LinkShape, np.ndarray]:
    """The typed part nearest to a place in the world, and where it stands."""
    x, y = min(TRUTH, key=lambda at: float(np.hypot(*(place[:2] - FLOOR[:2] - at))))
    yaw, shape = TRUTH[x, y]
    height = float(shape.size[2]) if isinstance(shape, mg.Box) else shape.length
    return mg.LinkShape(shape), mg.pose([*(FLOOR + [x, y, 0.001 + height / 2])], rpy=[0, 0, yaw])


@pytest.mark.slow
def test_every_part_is_found_where_it_lies(planned: mg.scenario.Scenario) -> None:
    parts = planned.trays[0].tray.parts
    assert [p.name for p in parts] == [f"mixed/object_{k}" for k in range(1, 5)]
    for part in parts:
        shape, T = truth_at(part.T_world_part[:3, 3])
        true = mg.LinkShape(shape.shape, T).bounds
        boxes = [mg.LinkShape(s.shape, part.T_world_part @ s.pose).bounds for s in part.shapes]
        low, high = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
        # It holds the part, whose sharp edges a field of 3 mm rounds, and sticks out by two standard deviations, more at rims.
        assert (low <= true[0] + 2e-3).all() and (low >= true[0] - 7e-3).all(), (part.name, low, true[0])
        assert (high >= true[1] - 2e-3).all() and (high <= true[1] + 7e-3).all(), (part.name, high, true[1])
        assert all(0 < grasp.quality <= 1 for grasp in part.grasps) and part.grasps[0].quality > 0.8
        volume = sum(float(np.prod(s.shape.size)) for s in part.shapes if isinstance(s.shape, mg.Box))
        solid = float(np.prod(shape.shape.size)) if isinstance(shape.shape, mg.Box) else np.pi * 0.025**2 * 0.08
        assert solid < volume < 1.35 * solid


@pytest.mark.slow
def test_the_plan_holds_against_map_and_truth(plan: dict[str, Any]) -> None:
    verdict = mg.verify_plan(plan, samples=100)
    assert verdict.ok, verdict.faults
    assert {s["tray"] for s in plan["scenario"]["scans"]} == {"mixed"}
    used = [
        next(p for p in plan["scenario"]["parts"] if p["name"] == k["part"])["grasps"][k["grasp"]]
        for k in plan["picks"]
    ]
    assert len(used) == 4 and all(grasp["probability"] == grasp["quality"] > 0.5 for grasp in used)
    # The same motions among the bodies that were rendered, which the planner never saw.
    real = copy.deepcopy(plan)
    del real["scenario"]["scans"]
    for part in real["scenario"]["parts"]:
        shape, T = truth_at(np.array(part["pose"]["xyz"]))
        T_part_shape = np.linalg.inv(mg.pose(part["pose"]["xyz"], quat_xyzw=part["pose"]["quat_xyzw"])) @ T
        part["shapes"] = [mg.scenario.shapes.shape_to_dict(mg.LinkShape(shape.shape, T_part_shape))]
    verdict = mg.verify_plan(real, samples=100)
    assert {fault.code for fault in verdict.faults} <= {"grasp-opening"}, verdict.faults
    assert len(verdict.faults) <= 1  # a pad askew to a face


def spoiled(plan: dict[str, Any], change: Callable[[dict[str, Any]], None]) -> set[str]:
    content = copy.deepcopy(plan)
    change(content)
    return {fault.code for fault in mg.verify_plan(content, samples=10).faults}


@pytest.mark.slow
def test_tampered_plans_are_refused(plan: dict[str, Any]) -> None:
    def part(content: dict[str, Any], name: str) -> dict[str, Any]:
        found: dict[str, Any] = next(p for p in content["scenario"]["parts"] if p["name"] == name)
        return found

    def lowered(content: dict[str, Any]) -> None:  # half of an object is cut off
        for shape in part(content, "mixed/object_4")["shapes"]:
            shape["size"][2] /= 2
            shape["pose"]["xyz"][2] /= 2

    def moved(content: dict[str, Any]) -> None:
        part(content, "mixed/object_2")["pose"]["xyz"][0] += 0.03

    def surer(content: dict[str, Any]) -> None:
        pick = content["picks"][0]
        grasp = part(content, pick["part"])["grasps"][pick["grasp"]]
        grasp["probability"] = grasp["quality"] = grasp["probability"] - 0.3

    def typed(content: dict[str, Any]) -> None:
        pick = content["picks"][0]
        del part(content, pick["part"])["grasps"][pick["grasp"]]["probability"]

    assert "scan-uncovered" in spoiled(plan, lowered)
    assert {"scan-uncovered"} <= spoiled(plan, moved)
    assert spoiled(plan, surer) == {"grasp-probability"}
    assert spoiled(plan, typed) == {"grasp-probability"}


@pytest.mark.slow
def test_another_map_and_no_map_are_refused(plan: dict[str, Any], tmp_path: Path) -> None:
    file = Path(plan["scenario"]["scans"][0]["map"])
    other = copy.deepcopy(plan)
    other["scenario"]["scans"][0]["map"] = str(tmp_path / "map.sdf")
    with pytest.raises(mg.InvalidInput, match=r"scans\[0\]\.map.*cannot be read"):
        mg.verify_plan(other)
    (tmp_path / "map.sdf").write_bytes(file.read_bytes()[:-1])
    with pytest.raises(mg.InvalidInput, match="the map has changed since the plan was made"):
        mg.verify_plan(other)


@pytest.mark.slow
def test_the_same_frames_give_the_same_scenario(
    planned: mg.scenario.Scenario, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    again = load_scenario(SCENARIO)
    was, now = planned.trays[0].scan, again.trays[0].scan
    assert was is not None and now is not None and was.map_file != now.map_file
    assert was.map_file.read_bytes() == now.map_file.read_bytes()
    assert (now.map_file.parent.parent / "frames" / "000.npz").exists()
    for a, b in zip(planned.trays[0].tray.parts, again.trays[0].tray.parts, strict=True):
        assert [g.T_object_hand.tolist() for g in a.grasps] == [g.T_object_hand.tolist() for g in b.grasps]
    # A damaged map in the cache is made anew.
    content = now.map_file.read_bytes()
    now.map_file.write_bytes(content[: len(content) // 2])
    assert load_scenario(SCENARIO).trays[0].scan == now and now.map_file.read_bytes() == content


@pytest.mark.slow
def test_a_folder_of_mmgrasp_scan_and_bad_input(
    planned: mg.scenario.Scenario, write: Callable[..., Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert planned.trays[0].scan is not None
    frames = planned.trays[0].scan.map_file.parent.parent / "frames"
    assert main(["scan", str(frames), "-o", str(tmp_path / "map"), "--no-pictures"]) == 0
    values = yaml.safe_load((ASSETS / "scenarios" / "scanned_tray.yaml").read_text())

    def with_scan(scan: Any, **more: Any) -> Path:
        changed = copy.deepcopy(values)
        changed["trays"][0]["scan"] = scan
        changed["trays"][0] |= more
        del changed["part_types"]
        return write(changed)

    found = load_scenario(with_scan(str(tmp_path / "map"), targets=[0, "object_3"]))
    assert found.trays[0].targets == ["mixed/object_1", "mixed/object_3"]
    assert [len(p.shapes) for p in found.trays[0].tray.parts] == [len(p.shapes) for p in planned.trays[0].tray.parts]

    def refused(scan: Any, **more: Any) -> str:
        with pytest.raises(mg.Error) as error:
            load_scenario(with_scan(scan, **more))
        assert ("scenario.yaml:" in str(error.value) and "scan" in str(error.value)) or more
        return str(error.value)

    assert "no such file" in refused(str(tmp_path / "mop"))
    (tmp_path / "empty").mkdir()
    assert "holds no map.sdf" in refused(str(tmp_path / "empty"))
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "map.sdf").write_text("nothing")
    assert "map.sdf" in refused(str(tmp_path / "broken"))
    assert "shows no object in tray mixed" in refused(str(tmp_path / "map"), pose={"xyz": [1.0, 0.0, 0.756]})
    assert "must be below the number of parts, 4" in refused(str(tmp_path / "map"), targets=[4])
    assert "did you mean object_" in refused(str(tmp_path / "map"), targets=["object_9"])
    assert "must have either map or rendered" in refused({"sigmas": 2})
    assert "unknown key; did you mean friction?" in refused(
        {"map": str(tmp_path / "map"), "grasp_options": {"frictoin": 1}}
    )
    assert "friction" in refused({"map": str(tmp_path / "map"), "grasp_options": {"friction": -1}})
    narrow = copy.deepcopy(values)
    narrow["gripper"] |= {"max_opening": 0.02, "clearance": 0.005}
    for joint in narrow["gripper"]["joints"]:
        joint["open"] = joint["closed"] + 0.01
    narrow["trays"][0]["scan"] = str(tmp_path / "map")
    with pytest.raises(
        mg.InvalidInput,
        match=r"trays\[0\]\.scan.*object_1 has no grasp.*wider there than the hand opens.*no part has a grasp",
    ):
        load_scenario(write(narrow))
    both = copy.deepcopy(values)
    both["trays"][0]["parts"] = both["trays"][0]["scan"]["rendered"]["parts"]
    with pytest.raises(mg.InvalidInput, match="must have either parts or scan"):
        load_scenario(write(both))


@pytest.mark.slow
def test_frames_that_cannot_be_rendered_are_refused(
    write: Callable[..., Path], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    values = yaml.safe_load((ASSETS / "scenarios" / "scanned_tray.yaml").read_text())

    def refused(**more: Any) -> str:
        changed = copy.deepcopy(values)
        changed["trays"][0]["scan"]["rendered"] |= more
        with pytest.raises(mg.Error) as error:
            load_scenario(write(changed))
        assert "scenario.yaml:" in str(error.value) and "trays[0].scan.rendered" in str(error.value)
        return str(error.value)

    assert "must hold at least one part" in refused(parts=[])
    assert "no such part type; did you mean block?" in refused(parts=[{"type": "blck", "xyz": [0, 0]}])
    assert "must be at most 500" in refused(views=501)
    assert "must be > 0" in refused(noise=0.0)
    assert "must be at most 0.02" in refused(noise=0.5)
    assert "shows no object in tray mixed" in refused(parts=[{"type": "block", "xyz": [0, 0, 5.0]}])
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    assert "set XDG_CACHE_HOME" in refused(seed=7)


@pytest.mark.slow
def test_what_stands_beside_the_parts_is_an_obstacle(
    planned: mg.scenario.Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same map in a scenario that knows nothing of the table's other half: what it shows there becomes a body."""
    assert planned.trays[0].scan is not None
    folder = tmp_path / "map"
    shutil.copytree(planned.trays[0].scan.map_file.parent, folder)
    values = yaml.safe_load((ASSETS / "scenarios" / "scanned_tray.yaml").read_text())
    values["trays"][0]["scan"] = str(folder)
    values["obstacles"][1] = {"name": "table top", "box": [0.50, 0.40, 0.04], "pose": {"xyz": [1.74, 0.0, 0.73]}}
    path = tmp_path / "scenario.yaml"
    path.write_text(yaml.safe_dump(values))
    scenario = load_scenario(path)
    rest = next(o for o in scenario.obstacles if o.name == "scan mixed")
    with monkeypatch.context() as few:
        few.setattr(map_bodies, "_MOST_CELLS", 2000)
        coarse = next(o for o in load_scenario(path).obstacles if o.name == "scan mixed")
    assert len(coarse.shapes) < len(rest.shapes) / 2
    bounds = np.array([s.bounds for s in rest.shapes])
    assert len(rest.shapes) > 10 and (np.abs(bounds[:, :, 1]).max(axis=1) > 0.19).all()
    assert bounds[:, 1, 2].max() < 0.77 and bounds[:, 0, 2].min() > 0.70
    mesh, _ = mg.ProbabilisticSdf.load(folder / "map.sdf").mesh()
    seen = mesh.vertices[
        (np.abs(mesh.vertices[:, 1]) > 0.22) & (np.abs(mesh.vertices[:, 1]) < 0.26) & (mesh.vertices[:, 2] > 0.745)
    ]
    inside = [((bounds[:, 0] - 1e-9 <= p) & (p <= bounds[:, 1] + 1e-9)).all(axis=1).any() for p in seen[:500]]
    assert len(seen) > 100 and np.mean(inside) > 0.95


def test_boxes_cover_cells_once() -> None:
    rng = np.random.default_rng(1)
    levels = rng.integers(0, 3, (17, 23))
    again = np.zeros_like(levels)
    for (x0, y0), (x1, y1), level in rectangles(levels):
        assert (again[x0:x1, y0:y1] == 0).all()
        again[x0:x1, y0:y1] = level
    assert (again == levels).all()
    cells = np.unique(rng.integers(-4, 4, (150, 3)), axis=0)
    covered = [
        tuple(int(v) for v in low + offset) for low, high in merged(cells) for offset in np.ndindex(*(high - low))
    ]
    assert sorted(covered) == sorted(map(tuple, cells.tolist()))
    found = {tuple(c) for c in cells_around(np.array([[0.5, 0.5, 0.5]]), np.array([2.0]), 1.0).tolist()}
    ball = [tuple(x - 2 for x in c) for c in np.ndindex(5, 5, 5)]
    assert found == {c for c in ball if sum(x * x for x in c) <= 4}


def test_cells_around_a_large_surface_are_larger() -> None:
    """A floor of 4 x 4 m: cells of 2 mm around it would be looked at a billion times."""
    side = np.arange(-2, 2, 0.01)
    points = np.stack(np.meshgrid(side, side, [0.5], indexing="ij"), axis=-1).reshape(-1, 3)
    radii = np.full(len(points), 0.02)
    assert edge_for(points[:100], radii[:100], 0.002) == 0.002
    edge = edge_for(points, radii, 0.002)
    assert edge in (0.008, 0.016, 0.032, 0.064)
    cells = {tuple(cell) for cell in cells_around(points, radii, edge).tolist()}
    assert len(cells) < 1_000_000
    rng = np.random.default_rng(1)
    for offset in rng.normal(size=(2000, 3)):
        near = rng.choice(points) + 0.02 * rng.uniform() * offset / np.linalg.norm(offset)
        assert tuple(np.floor(near / edge).astype(int).tolist()) in cells


def test_pieces_are_counted_over_triangles() -> None:
    strip = np.array([[i, i + 1, i + 2] for i in range(60)])
    other = 62 + np.array([[i, i + 1, i + 2] for i in range(20)])
    triangles = np.concatenate([strip, other])
    kept = np.ones(84, dtype=bool)
    assert large_pieces(triangles, kept).tolist() == [True] * 62 + [False] * 22
    kept[[30, 31]] = False  # two neighbours out: the strip falls into two pieces of 30
    assert not large_pieces(triangles, kept).any()


@pytest.mark.slow
def test_the_command_plans_and_verifies(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "scanned"
    scenario = str(ASSETS / "scenarios" / "scanned_tray.yaml")
    assert main(["plan", scenario, "-o", str(out), "--no-pictures"]) == 0
    assert "modelled probability of the grasps of scanned parts 0." in " ".join(capsys.readouterr().out.split())
    assert main(["verify", str(out / "plan.json"), "--scenario", scenario]) == 0
    assert "the plan holds" in capsys.readouterr().out
    from mmgrasp.viz.report import report_html

    page = report_html(json.loads((out / "plan.json").read_text()))
    assert "<th>probability</th>" in page or ">probability<" in page
