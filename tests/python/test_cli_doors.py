"""The command's own door: bad options, closed and narrow streams, names with markup. One message, never a traceback."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from conftest import ASSETS
from mmgrasp.cli import main

FETCH = str(ASSETS / "robots" / "fetchlike" / "fetchlike.urdf")

REFUSED_BY_THE_PARSER = [
    ["plan", "s.yaml", "-o", ""],
    ["plan", "", "-o", "x"],
    ["plan", "s.yaml", "-o", "x", "--seed", "1_0"],
    ["plan", "s.yaml", "-o", "x", "--seed", "٣"],
    ["plan", "s.yaml", "-o", "x", "--seed", " 1"],
    ["plan", "s.yaml", "-o", "x", "--seed", "-1"],
    ["plan", "s.yaml", "-o", "x", "--seed", "1" * 5000],
    ["plan", "s.yaml", "-o", "x", "--threads", "1000000"],
    ["verify", "p.json", "--samples", "2147483647"],
    ["verify", "p.json", "--samples", "0"],
    ["verify", "p.json", "--scenario", ""],
    ["check", "r.urdf", "--write-srdf", ""],
    ["check", "r.urdf", "--mesh-tolerance", "nan"],
    ["check", "r.urdf", "--mesh-tolerance", "1e9"],
    ["check", "r.urdf", "--mesh-tolerance", "0_1"],
    ["view", "p.json", "--png", ""],
    ["view", "p.json", "--port", "65536"],
    ["bench", "mbm", "--limit", "0"],
    ["reproduce", "--out", ""],
    ["reproduce", "--workers", "100000"],
]


@pytest.mark.parametrize("arguments", REFUSED_BY_THE_PARSER, ids=lambda a: " ".join(a)[:60])
def test_options_out_of_range(
    arguments: list[str], capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    assert "must be" in capfd.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_current_folder_that_is_gone(tmp_path: Path) -> None:
    code = "import os, sys; os.rmdir(os.getcwd()); from mmgrasp.cli import main; sys.exit(main(['check', 'r.urdf']))"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stderr) == (
        2,
        "mmgrasp: the current folder is no longer there: change to another one\n",
    )


@pytest.mark.parametrize("command", [["plan", "{}", "-o", "out"], ["verify", "{}"], ["view", "{}", "--png", "x.png"]])
@pytest.mark.parametrize("what", ["/dev/zero", "pipe", "folder", "missing"])
def test_files_that_are_none(
    command: list[str], what: str, capfd: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    os.mkdir("folder")
    assert main([word.format(what) for word in command]) == 2
    error = capfd.readouterr().err.splitlines()[-1]
    inside = "/plan.json" if what == "folder" and command[0] != "plan" else ""
    assert error.startswith(f"mmgrasp: {what}{inside}: cannot be read")


def test_a_robot_needs_a_scenario_to_be_compared_with(
    small_plan_dict: dict[str, Any], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "plan.json").write_text(json.dumps(small_plan_dict))
    assert main(["verify", str(tmp_path / "plan.json"), "--robot", "tiago"]) == 2
    assert "needs scenario" in capfd.readouterr().err


def test_verify_says_what_it_compared_with(
    small_plan_dict: dict[str, Any], small_path: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    plan = tmp_path / "plan.json"
    plan.write_text(json.dumps(small_plan_dict))
    assert main(["verify", str(plan), "--samples", "20"]) == 0
    assert "the scenario stored in it (not compared with a file)" in capfd.readouterr().out.splitlines()[-1]
    assert main(["verify", str(plan), "--samples", "20", "--scenario", str(small_path)]) == 0
    assert capfd.readouterr().out.splitlines()[-1].endswith(f"checked against {small_path}")
    plan.write_text(json.dumps({**small_plan_dict, "outcome": "not_found"}))
    assert main(["verify", str(plan), "--scenario", str(small_path)]) == 1
    assert capfd.readouterr().out.splitlines()[-1].endswith("1 fault; checked against nothing")


@pytest.mark.parametrize("png", ["/dev/full", "{}/no/such/\0", "{}"])
def test_view_finds_out_at_once_where_it_cannot_write(
    png: str, small_plan_dict: dict[str, Any], tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "plan.json").write_text(json.dumps(small_plan_dict))
    try:
        code = main(["view", str(tmp_path / "plan.json"), "--png", png.format(tmp_path)])
    except SystemExit as stop:  # the parser's
        code = int(str(stop.code))
    assert code == 2
    assert "Traceback" not in capfd.readouterr().err


def run(arguments: list[str], redirect: str = "", **environment: str) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, its streams as a shell would redirect them."""
    words = " ".join(f"'{word}'" for word in [sys.executable, "-m", "mmgrasp", *arguments])
    return subprocess.run(
        ["/bin/sh", "-c", f"{words} {redirect}"], capture_output=True, text=True, env={**os.environ, **environment}
    )


@pytest.mark.parametrize("redirect", ["2>&-", ">&-", "<&- >&- 2>&-"])
def test_closed_streams(redirect: str) -> None:
    done = run(["check", FETCH], redirect)
    assert done.returncode == 0
    assert "Traceback" not in done.stderr + done.stdout


def test_streams_that_only_know_ascii(tmp_path: Path) -> None:
    (tmp_path / "ü.urdf").write_text(Path(FETCH).read_text().replace("fetchlike", "fetchlikeü"))
    done = run(["check", str(tmp_path / "ü.urdf")], PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert done.returncode in (0, 1, 2)
    assert "Traceback" not in done.stderr
    assert "\\xfc" in done.stdout + done.stderr


def test_control_characters_of_a_file_do_not_reach_the_terminal(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    urdf, srdf = tmp_path / "r.urdf", tmp_path / "r.srdf"
    urdf.write_text(Path(FETCH).read_text().replace('ixx="0.00265"', 'ixx="&#27;[31m"'))
    srdf.write_text('<robot name="&#27;[2J"><group name="&#27;[31m"><joint name="shoulder_pan_joint"/></group></robot>')
    assert main(["check", str(urdf), "--srdf", str(srdf)]) == 0
    printed = capfd.readouterr()
    assert "\x1b" not in printed.out + printed.err
    assert "\\x1b[2J" in printed.out


def test_a_profile_whose_hand_has_no_such_link(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    profile = tmp_path / "p.yaml"
    source = ASSETS / "robots" / "kr6like" / "kr6like.yaml"
    content = yaml.safe_load(source.read_text())
    content["robot"]["tool_link"] = "gripper"
    profile.write_text(yaml.safe_dump(content))
    assert main(["grasp", str(tmp_path), "--gripper", str(profile)]) == 2
    message = capfd.readouterr().err
    assert "p.yaml:" in message and "robot.tool_link = 'gripper': the robot has no such link" in message


def test_a_reader_that_goes_away() -> None:
    done = run(["check", FETCH], "| true")
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_markup_in_names_is_text(small: dict[str, Any], tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    scenario = {**small, "name": "[bold]x[/foo]", "trays": [{**small["trays"][0], "name": "[red]hi[/]"}]}
    (tmp_path / "s.yaml").write_text(yaml.safe_dump(scenario))
    assert main(["plan", str(tmp_path / "s.yaml"), "-o", str(tmp_path / "out"), "--no-pictures"]) == 0
    printed = capfd.readouterr().out
    assert "[bold]x[/foo]" in printed
    assert "[red]hi[/]" in printed


def test_a_foreign_backend_for_pictures_does_not_end_a_command() -> None:
    code = "import contextlib\nfrom mmgrasp.cli import main\nwith contextlib.suppress(SystemExit): main(['--version'])\nimport matplotlib"
    environment = {**os.environ, "MPLBACKEND": "nonsense"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
