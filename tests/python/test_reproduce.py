"""Reproduced tables and figures: the shape of their JSON, the exact values, the trends, and that nothing is remembered.

No check about time is looked at here.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.cli import main
from mmgrasp.reproduce import ENTRIES, entry, reproduce
from mmgrasp.reproduce.page import markdown, store
from mmgrasp.reproduce.rows import PAPER_ROWS
from mmgrasp.reproduce.setup import Row, database, robot_setup
from mmgrasp.reproduce.statements import ANSWERS

pytestmark = pytest.mark.slow

SIDE = {"type": ["number", "string", "boolean", "null", "array"]}
# What a paper claims and its own table denies (docs/errata.md): must come out reversed, and nothing else may.
NOT_AS_PRINTED = {
    "p1-figure-5.14": ["four grippers take all 13 parts: 10 of 13"],  # by the printed rule's own arithmetic
    "p1-figure-4.13": ["common: fewer tasks are solved, or half as many iterations more are needed"],  # ours solves it
}

SCHEMA = {
    "type": "object",
    "required": ["name", "rows", "setup", "checks", "quick", "seed", "machine", "date"],
    "properties": {
        "name": {"enum": list(ENTRIES)},
        "rows": {
            "type": "array",
            "minItems": 1,
            "items": {
                "type": "object",
                "required": ["key", "values"],
                "additionalProperties": False,
                "properties": {
                    "key": {"type": "object", "minProperties": 1},
                    "values": {
                        "type": "object",
                        "minProperties": 1,
                        "additionalProperties": {
                            "type": "object",
                            "required": ["paper", "ours"],
                            "additionalProperties": False,
                            "properties": {"paper": SIDE, "ours": SIDE},
                        },
                    },
                },
            },
        },
        "checks": {
            "type": "array",
            "items": {"properties": {"kind": {"enum": ["E", "T", "S"]}, "answer": {"enum": list(ANSWERS)}}},
        },
    },
}


@pytest.fixture(scope="session")
def quick() -> Callable[[str], dict[str, Any]]:
    """Results of the quick versions, each computed once."""
    done: dict[str, dict[str, Any]] = {}

    def result(name: str) -> dict[str, Any]:
        if name not in done:
            if name in ("p1-figure-4.10", "p1-figure-4.12"):
                pytest.importorskip("mujoco", reason="MuJoCo is not installed (pip install 'mmgrasp[sim]')")
            done[name] = reproduce(name, quick=True)
        return done[name]

    return result


def values(result: dict[str, Any], column: str, side: str = "ours") -> list[Any]:
    return [row["values"][column][side] for row in result["rows"] if column in row["values"]]


@pytest.mark.parametrize("name", ENTRIES)
def test_every_entry_has_the_shape_and_its_picture(
    name: str, quick: Callable[[str], dict[str, Any]], tmp_path: Path
) -> None:
    result = quick(name)
    jsonschema.validate(json.loads(json.dumps(result, allow_nan=False)), SCHEMA)
    page = store(result, tmp_path)
    assert markdown(result).splitlines()[0] in page.read_text()
    picture = tmp_path / "reproduction" / f"{name}.png"
    assert picture.exists() == (ENTRIES[name].draw is not None)
    if picture.exists():
        assert picture.stat().st_size > 5000


def test_other_seeds_stand_beside_the_first(quick: Callable[[str], dict[str, Any]], tmp_path: Path) -> None:
    first = quick("p1-figure-3.9")
    store(first, tmp_path)
    fault = {"kind": "T", "what": "the sky is green", "holds": False, "clock": False}
    page = store({**first, "seed": 2, "checks": [first["checks"][0], fault]}, tmp_path).read_text()
    assert "Seed 2: 1 of 2 statements hold; not: the sky is green." in page
    kept = [json.loads((tmp_path / "reproduction" / f"p1-figure-3.9{end}.json").read_text()) for end in ("", "-seed-2")]
    assert [k["seed"] for k in kept] == [1, 2]
    assert page.count(markdown(first).splitlines()[0]) == 1


@pytest.mark.parametrize("name", ENTRIES)
def test_exact_values_and_trends_hold(name: str, quick: Callable[[str], dict[str, Any]]) -> None:
    late = [c["what"] for c in quick(name)["checks"] if not c["holds"] and not c["clock"]]
    assert late == NOT_AS_PRINTED.get(name, [])


def test_sequence_sizes_are_the_papers(quick: Callable[[str], dict[str, Any]]) -> None:
    result = quick("p1-table-3.3")
    counts = [row["key"]["trays"] for row in result["rows"]]
    assert values(result, "sequence size") == [PAPER_ROWS[n][0] for n in counts] == [n // 2 for n in counts]
    assert values(result, "proven least") == values(result, "sequence size")
    assert values(result, "time [s]", "paper") == [PAPER_ROWS[n][1] for n in counts]
    assert result["setup"]["radius at the spacing [m]"] >= 0.10 > result["setup"]["radius at twice the spacing [m]"]
    assert min(values(result, "least radius [m]")) >= 0.10
    for n, row in zip(counts, result["rows"], strict=True):
        assert row["values"]["objects"]["ours"] == row["values"]["grasps"]["ours"] == 12 * n


def test_figure_3_9_against_circles(quick: Callable[[str], dict[str, Any]]) -> None:
    """The discs of two circles' lens are known in closed form: half the overlap of their diameters."""
    result = quick("p1-figure-3.9")
    assert values(result, "robust intersections") == [5, 3, 0, 8]
    assert values(result, "stops") == [3]
    for trays, _, radius in result["drawing"]["kept"]:
        ends = [(0.0, 0.45, 0.90, 1.65, 2.80)[t - 1] for t in trays]
        assert radius == pytest.approx(0.5 - (max(ends) - min(ends)) / 2, abs=0.015)


def test_experiment_saves_a_stop(quick: Callable[[str], dict[str, Any]]) -> None:
    result = quick("p1-experiment-3.7.1")
    assert values(result, "stops") == [2, 3] == values(result, "stops", "paper")
    assert values(result, "trays of each stop") == ["{1,2} {4}", "{1} {2} {4}"]
    assert values(result, "objects") == [12]


def test_setups_are_the_papers() -> None:
    row = Row(objects=(9, 12))
    problem = row.problem()
    assert list(problem.trays[0].size) == [0.30, 0.40, 0.10]
    assert len(problem.trays[0].parts) == 108
    assert all(len(part.grasps) == 1 for part in problem.trays[0].parts)
    assert problem.options["grid_resolution"] == 0.05
    assert problem.options["positioning_uncertainty"] == 0.10
    assert problem.arm.size == 7
    places = np.array([part.T_world_part[:2, 3] for part in problem.trays[0].parts])
    gaps = [np.diff(np.unique(places[:, k].round(9))) for k in (0, 1)]
    np.testing.assert_allclose(gaps[0], (0.30 - 2 * row.margin) / 8)
    np.testing.assert_allclose(gaps[1], (0.40 - 2 * row.margin) / 11)


@pytest.mark.parametrize("objects", [(2, 2), (3, 4), (6, 8), (21, 28)])
def test_objects_fill_the_corners(objects: tuple[int, int]) -> None:
    """P1 3.6.1: with four objects and more the four corners of the tray are filled, whatever lies between them."""
    row = Row(objects=objects)
    places = {tuple(place) for place in row.object_places().round(9)}
    assert len(places) == objects[0] * objects[1]
    assert {(sx * 0.13, sy * 0.18) for sx in (-1, 1) for sy in (-1, 1)} <= places
    assert np.abs(list(places)).max(axis=0) == pytest.approx([0.13, 0.18])


def test_the_json_of_the_command_is_the_contract(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "p1-figure-3.9", "--json", "--quick"]) == 0
    printed = json.loads(capfd.readouterr().out)
    assert printed["name"] == "p1-figure-3.9"
    assert printed["rows"][0] == {"key": {"order": 1}, "values": {"robust intersections": {"paper": 5, "ours": 5}}}
    assert printed["rows"][3]["values"]["proven least"]["paper"] is None


def test_the_command_lists_and_refuses(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce"]) == 0
    listed = [line.split()[0] for line in capfd.readouterr().out.splitlines()]
    assert listed == list(ENTRIES)
    assert main(["reproduce", "p1-table-3.33"]) == 2
    assert "p1-table-3.3" in capfd.readouterr().err


def test_names_may_be_written_in_capitals() -> None:
    assert entry("P2-TABLE-4.2") is entry("p2-table-4.2")
    with pytest.raises(mg.InvalidInput, match=r"name = 'P2-TABLE-9.9': .*did you mean p2-table"):
        entry("P2-TABLE-9.9")


def test_a_figure_is_found_by_its_table(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "p1-figure-3.13", "--quick", "--json"]) == 0
    assert json.loads(capfd.readouterr().out)["name"] == "p1-table-3.1"


REGION = """
import sys, mmgrasp as mg, numpy as np
from mmgrasp.reproduce.setup import Row, database
row = Row(trays=2, objects=(2, 2), spacing=0.4, shift=float(sys.argv[1]))
problem, reach = row.problem(), database(row, 200_000)
grid = mg.base.make_base_grid(problem, reach)
np.save(sys.argv[2], [r.cells(grid) for r in mg.base.compute_base_regions(problem, reach, grid)])
"""


def test_trays_moved_by_3_cm_give_what_empty_caches_give(tmp_path: Path) -> None:
    """After other trays in the same process, and in a process that computed nothing before."""
    row = Row(trays=2, objects=(2, 2), spacing=0.4)
    reach = database(row, 200_000)
    found = {}
    for shift in (0.0, 0.03):
        problem = row.with_(shift=shift).problem()
        grid = mg.base.make_base_grid(problem, reach)
        regions = mg.base.compute_base_regions(problem, reach, grid)
        found[shift] = [region.cells(grid) for region in regions]
        kept = mg.base.ObjectRegions.compute(problem, reach, grid)
        for t, cells in enumerate(found[shift]):
            np.testing.assert_array_equal(kept.region(t, kept.parts(t)), cells)
    assert np.sum(found[0.03]) > 0
    fresh = tmp_path / "fresh.npy"
    subprocess.run([sys.executable, "-c", REGION, "0.03", str(fresh)], check=True)
    np.testing.assert_array_equal(np.load(fresh), found[0.03])


def test_regions_and_grids_survive_pickling() -> None:
    import pickle

    row = Row(objects=(1, 2))
    problem, reach = row.problem(), database(row, 200_000)
    grid = mg.base.make_base_grid(problem, reach)
    region = mg.base.compute_base_regions(problem, reach, grid)[0]
    again, same = pickle.loads(pickle.dumps((grid, region)))
    assert (again.nx, again.ny, again.resolution, again.headings) == (grid.nx, grid.ny, grid.resolution, grid.headings)
    np.testing.assert_array_equal(again.origin, grid.origin)
    np.testing.assert_array_equal(same.cells(again), region.cells(grid))
    for a, b in zip(same.part_cells(again), region.part_cells(grid), strict=True):
        np.testing.assert_array_equal(a, b)
    assert [e.to_dict() for e in same.explanations] == [e.to_dict() for e in region.explanations]
    assert (same.tray, same.base_poses_in_collision) == (region.tray, region.base_poses_in_collision)


def test_the_robot_is_the_shipped_one() -> None:
    setup = robot_setup(Row().torso)
    assert setup.robot.name == "fetchlike"
    assert setup.robot.base == "diff_drive"
