"""The command: what it writes, its exit codes, and that it never shows a traceback."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from rich.console import Console

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.cli import main
from mmgrasp.cli.console import Reporter
from mmgrasp.part_supply.plan_file import plan_schema, read_plan

FETCH = ASSETS / "robots" / "fetchlike"


@pytest.fixture(scope="module")
def out(small_path: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("out")
    assert main(["plan", str(small_path), "-o", str(folder)]) == 0
    return folder


def test_plan_writes_everything(out: Path) -> None:
    assert (out / "report.html").stat().st_size > 10_000
    assert sorted(out.rglob("*.png"))
    plan = read_plan(out / "plan.json")
    jsonschema.validate(plan, plan_schema())
    motions = sum(len(pick["motions"]) for pick in plan["picks"])
    assert len(list((out / "trajectories").glob("pick_*.csv"))) == motions
    assert len(list((out / "trajectories").glob("drive_*.csv"))) == len(plan["route"]) == len(plan["stops"]) + 1
    assert not [p for p in out.rglob(".*") if p.is_file()], "a temporary file was left"


def test_csv_holds_the_plans_numbers(out: Path) -> None:
    plan = read_plan(out / "plan.json")
    first = sorted((out / "trajectories").glob("pick_00_*_0_transit.csv"))[0]
    rows = list(csv.reader(first.read_text().splitlines()))
    motion = plan["picks"][0]["motions"][0]
    assert rows[0][:4] == ["time", "base.x", "base.y", "base.theta"]
    assert rows[0][7 : 7 + len(plan["scenario"]["home"])] == plan["scenario"]["arm"]["joints"]
    values = np.array(rows[1:], dtype=float)
    np.testing.assert_array_equal(values[:, 0], motion["times"])
    np.testing.assert_array_equal(values[:, 7 : 7 + len(plan["scenario"]["home"])], motion["positions"])


def test_verify_accepts_the_plan(out: Path, small_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(out / "plan.json"), "--scenario", str(small_path)]) == 0
    assert "the plan holds" in capfd.readouterr().out
    assert main(["verify", str(out / "plan.json"), "--json", "--samples", "50"]) == 0
    assert json.loads(capfd.readouterr().out)["ok"] is True


@pytest.mark.slow
def test_plan_in_passing(small_path: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The command's table says what is saved, and verify looks at the motion in passing too."""
    assert main(["plan", str(small_path), "-o", str(tmp_path), "--drive-by", "--no-pictures"]) == 0
    printed = capfd.readouterr()
    assert "parts taken in passing" in printed.out
    assert "drive-by 1 of 2" in printed.err
    assert "drive-by 2 of 2" in printed.err
    saved = json.loads((tmp_path / "drive_by.json").read_text())["saved"]
    assert saved > 1.0
    assert f"{saved:.1f} s" in printed.out
    assert len(list((tmp_path / "trajectories").glob("drive_by_*.csv"))) == 2
    assert main(["verify", str(tmp_path / "plan.json"), "--scenario", str(small_path)]) == 0
    plan = read_plan(tmp_path / "plan.json")
    motion = plan["drive_by"]["motions"][0]
    motion["closed_at"] = motion["close_at"]
    (tmp_path / "spoiled.json").write_text(json.dumps(plan))
    assert main(["verify", str(tmp_path / "spoiled.json")]) == 1
    assert "closing-time" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("content", "piece"),
    [
        ("{", "is no valid JSON"),
        ("[]", "format"),
        ('{"format": "mmgrasp-scenario"}', "mmgrasp-plan"),
        ('{"format": "mmgrasp-plan", "version": 7}', "version"),
        ('{"format": "mmgrasp-plan", "version": 4, "mmgrasp": "0", "outcome": "solved"}', "scenario"),
    ],
)
def test_verify_refuses_what_is_no_plan(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], content: str, piece: str
) -> None:
    (tmp_path / "plan.json").write_text(content)
    assert main(["verify", str(tmp_path / "plan.json")]) == 2
    error = capfd.readouterr().err
    assert piece in error
    assert "plan.json" in error


def test_check_describes_the_robot(capfd: pytest.CaptureFixture[str]) -> None:
    assert (
        main(["check", str(FETCH / "fetchlike.urdf"), "--srdf", str(FETCH / "fetchlike.srdf"), "--base", "diff_drive"])
        == 0
    )
    text = capfd.readouterr().out
    for piece in ("arm_with_torso", "torso_lift_joint", "never touch", "can be planned for", "diff_drive"):
        assert piece in text
    assert main(["check", str(FETCH / "fetchlike.urdf"), "--json"]) == 0
    assert json.loads(capfd.readouterr().out)["ok"] is True


def test_check_of_a_robot_with_missing_mesh(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    urdf = """<robot name="r"><link name="a"><collision><geometry><mesh filename="package://p/none.stl"/></geometry></collision>
    </link><link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>"""
    (tmp_path / "r.urdf").write_text(urdf)
    assert main(["check", str(tmp_path / "r.urdf")]) == 1
    text = capfd.readouterr().out
    assert "mesh not found: package://p/none.stl" in text
    assert "cannot be planned for" in text


@pytest.mark.parametrize(
    ("arguments", "code", "piece"),
    [
        (["--version"], 0, mg.__version__),
        ([], 2, "command"),
        (["plaan"], 2, "plaan"),
        (["plan", "none.yaml", "-o", "x"], 2, "none.yaml"),
        (["plan", "none.yaml"], 2, "--out"),
        (["plan", "none.yaml", "-o", "x", "--threads", "-2"], 2, "-2"),
        (["check", "none.urdf"], 2, "none.urdf"),
        (["check", "none.urdf", "--package", "p"], 2, "NAME=DIR"),
        (["verify", "none.json"], 2, "none.json"),
        (["view", "none.json"], 2, "none.json"),
        (["plan", "none.yaml", "-o", "x", "--seed", "4294967296"], 2, "at most 2147483647"),
        (["bench", "mbm", "--seeds", "-3"], 2, "at least 1"),
        (["bench", "mbm", "--robot", "panda", "ur6"], 2, "robot = 'ur6': must be one of panda, ur5; did you mean ur5?"),
        (["reproduce", "p2-figure-4"], 2, "did you mean p2-figure-4.6?"),
        (["reproduce", "all", "none"], 2, "name = 'none'"),
    ],
)
def test_exit_codes(arguments: list[Any], code: int, piece: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mmgrasp", *arguments],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        timeout=60,
        env={**os.environ, "COLUMNS": "200"},
    )
    assert done.returncode == code
    assert piece in done.stdout + done.stderr
    assert "Traceback" not in done.stderr


def test_unknown_robot_lists_the_known(small_path: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["plan", str(small_path), "-o", str(tmp_path), "--robot", "tiagoo"]) == 2
    assert "tiago" in capfd.readouterr().err


def test_output_folder_that_cannot_be(small_plan: mg.part_supply.ScenarioPlan, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(mg.IoError, match="file"):
        small_plan.save(tmp_path / "file" / "plan.json")


def test_output_folders_that_cannot_be_are_told_before_anything_runs(
    small_path: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    for command in (["plan", str(small_path)], ["reproduce", "p2-figure-4.5"]):
        for out in (tmp_path / "file", tmp_path / "file" / "below"):
            assert main([*command, "--out", str(out)]) == 2
            reported = capfd.readouterr()
            assert f"{out}: cannot be written: {tmp_path / 'file'} is no folder" in reported.err
            assert "s]" not in reported.err, "a stage had begun"
            assert not reported.out


def test_one_file_is_no_picture_and_film(out: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "below").mkdir()
    same = tmp_path / "below" / ".." / "a.gif"
    assert main(["view", str(out / "plan.json"), "--png", str(tmp_path / "a.gif"), "--film", str(same)]) == 2
    assert "cannot be both" in capfd.readouterr().err
    assert not (tmp_path / "a.gif").exists()


def test_view_draws_a_picture(out: Path, tmp_path: Path) -> None:
    assert main(["view", str(out / "plan.json"), "--png", str(tmp_path / "plan.png")]) == 0
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")


def test_long_stages_say_how_far_they_are_where_no_bars_are_shown(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = [100.0]
    monkeypatch.setattr("mmgrasp.cli.console.time.monotonic", lambda: clock[0])
    with Reporter(Console()) as report:
        for now, stage, fraction in (
            (100.0, "route", 0.0),
            (101.0, "route", 0.1),
            (109.9, "route", 0.2),
            (110.0, "route", 0.25),
            (112.0, "picks", 0.0),
            (121.9, "picks", 0.4),
            (122.0, "", 0.4),
            (123.5, "picks", 0.5),
        ):
            clock[0] = now
            report(stage, fraction)
    assert capsys.readouterr().err.splitlines() == [
        "[   0.0 s] route",
        "[  10.0 s] route, 25 %",
        "[  12.0 s] picks",
        "[  23.5 s] picks, 50 %",
    ]
