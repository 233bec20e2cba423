"""Commands that write single files replace nothing that is there, `reproduce` nothing but its own pages."""

from __future__ import annotations

from pathlib import Path

import pytest

import mmgrasp as mg
from mmgrasp._files import PNG
from mmgrasp.cli import main

# Each command that writes single files, with what it must not replace, whose name stands in {}.
FOREIGN = [
    ("map.sdf", ["grasp", "MAP", "--gripper", "asset:scenarios/storeroom.yaml", "-o", "{}"]),
    ("objects.json", ["grasp", "MAP", "--gripper", "asset:scenarios/storeroom.yaml", "-o", "{}"]),
    ("objects.json", ["grasp", "MAP", "--gripper", "asset:scenarios/storeroom.yaml", "--png", "{}"]),
    ("part.xacro", ["check", "r.urdf", "--write-srdf", "{}"]),
    ("plan.json", ["view", "plan.json", "--png", "{}"]),
    ("plan.json", ["view", "plan.json", "--film", "{}"]),
    ("photo.png", ["view", "plan.json", "--png", "{}"]),
    ("film.gif", ["view", "plan.json", "--film", "{}"]),
    ("grasps.json", ["grasp", "MAP", "--gripper", "asset:scenarios/storeroom.yaml", "-o", "{}"]),
    ("photo.png", ["grasp", "MAP", "--gripper", "asset:scenarios/storeroom.yaml", "--png", "{}"]),
    ("plan.json", ["schedule", "plan.json", "plan.json", "-o", "{}"]),
    ("mine.json", ["schedule", "plan.json", "plan.json", "-o", "{}"]),
    ("photo.png", ["schedule", "plan.json", "plan.json", "-o", "new.json", "--png", "{}"]),
    ("mine.yaml", ["init", "r.urdf", "-o", "{}"]),
    ("out/reproduction.md", ["reproduce", "p1-table-3.4", "--quick", "--out", "out"]),
    ("out/reproduction/p1-table-3.4.json", ["reproduce", "p1-table-3.4", "--quick", "--out", "out"]),
    ("out/reproduction/p1-table-3.4.png", ["reproduce", "p1-table-3.4", "--quick", "--out", "out"]),
]


MINE = {".png": PNG + b"mine", ".gif": b"GIF89a mine", ".json": b'{\n "format": "mmgrasp-grasps",\n "by hand": 1\n}\n'}


@pytest.mark.parametrize(("name", "command"), FOREIGN)
def test_no_command_replaces_what_is_not_its_own(
    name: str,
    command: list[str],
    tmp_path: Path,
    small_plan: mg.part_supply.ScenarioPlan,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "r.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    small_plan.save(tmp_path / "plan.json")
    foreign = tmp_path / name.replace("objects", "MAP/objects").replace("map.sdf", "MAP/map.sdf")
    foreign.parent.mkdir(parents=True, exist_ok=True)
    if name != "plan.json":
        foreign.write_bytes(MINE.get(Path(name).suffix, b"mine") if "/" not in name else b"mine")
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    assert main([word.format(foreign) for word in command]) == 2
    assert "is not replaced" in capsys.readouterr().err
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before


def test_two_outputs_of_one_name_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    one = str(tmp_path / "x")
    assert main(["grasp", str(tmp_path), "--gripper", "asset:scenarios/storeroom.yaml", "-o", one, "--png", one]) == 2
    assert "is the file of -o, too" in capsys.readouterr().err


def test_trajectories_are_not_added_to_those_of_another_plan(
    small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path
) -> None:
    written = small_plan.save_trajectories(tmp_path)
    assert small_plan.save_trajectories(tmp_path) == written
    (tmp_path / "pick_99_screw_0_lift.csv").write_text("older")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with pytest.raises(mg.IoError, match=r"holds pick_99_screw_0_lift.csv of another result"):
        small_plan.save_trajectories(tmp_path)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
