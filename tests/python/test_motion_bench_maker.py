"""MotionBenchMaker's problems: every start and every goal is free, and bad files are refused by name."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from mmgrasp.problems.motion_bench import read_motion_problem, read_motion_problems

SETS = ["bookshelf_small", "bookshelf_tall", "bookshelf_thin", "box", "cage", "table_pick", "table_under_pick"]


@pytest.fixture(scope="module")
def robots(data: Path) -> dict[str, mg.Robot]:
    return {
        name: mg.Robot.load(
            data / f"robots/{name}_vamp/{name}/{name}.urdf", data / f"robots/{name}_vamp/{name}/{name}.srdf"
        )
        for name in ("panda", "ur5")
    }


@pytest.mark.slow
@pytest.mark.parametrize("which", SETS)
@pytest.mark.parametrize("robot", ["panda", "ur5"])
def test_starts_and_goals_are_free(robot: str, which: str, robots: dict[str, Any], data: Path) -> None:
    problems = list(read_motion_problems(data / f"planning/vamp_{robot}/problems/{which}_{robot}"))
    assert len(problems) == 50
    refused = []
    for problem in problems:
        checker = problem.checker(robots[robot])
        assert len(problem.world.objects) >= 2
        for what, q in (("start", problem.start_of(checker.group)), ("goal", problem.goal_of(checker.group))):
            if not checker.is_free(q):
                refused.append((problem.name, what, str(checker.rejection(q)), checker.contacts(q)))
            else:
                assert checker.distance(q).value > 0
    assert not refused


@pytest.mark.parametrize("robot", ["panda", "ur5"])
def test_scenes_stand_in_the_way(robot: str, robots: dict[str, Any], data: Path) -> None:
    """The straight way from start to goal is blocked in most problems: the objects are where they should be."""
    blocked = 0
    for which in SETS:
        folder = data / f"planning/vamp_{robot}/problems/{which}_{robot}"
        problem = read_motion_problem(folder / "scene0001.yaml", folder / "request0001.yaml")
        checker = problem.checker(robots[robot])
        result = checker.check_edge(problem.start_of(checker.group), problem.goal_of(checker.group))
        blocked += not result and result.contact is not None
    assert blocked >= 4


def test_bad_files_are_refused_by_name(data: Path, tmp_path: Path) -> None:
    folder = data / "planning/vamp_panda/problems/box_panda"
    scene, request = tmp_path / "scene0001.yaml", tmp_path / "request0001.yaml"
    for wrong, right, message in (
        ("cylinder", "cone", "primitive type 'cone'"),
        ("primitive_poses", "poses", "primitive_poses is missing"),
        ("entry_names", "names", "entry_names is missing"),
    ):
        shutil.copy(folder / "request0001.yaml", request)
        scene.write_text((folder / "scene0001.yaml").read_text().replace(wrong, right))
        if wrong == "cylinder" and "cone" not in scene.read_text():
            scene.write_text((folder / "scene0001.yaml").read_text().replace("type: box", "type: cone"))
        with pytest.raises(mg.InvalidInput, match=message) as refused:
            read_motion_problem(scene, request)
        assert "scene0001.yaml" in str(refused.value)
    shutil.copy(folder / "scene0001.yaml", scene)
    request.write_text((folder / "request0001.yaml").read_text().replace("position: -", "position: x"))
    with pytest.raises(mg.InvalidInput, match=r"request0001.yaml: 'x.*must be a finite number"):
        read_motion_problem(scene, request)
    request.unlink()
    with pytest.raises(mg.IoError, match=r"request0001\.yaml"):
        read_motion_problem(scene, request)
    with pytest.raises(mg.IoError, match="no scene"):
        list(read_motion_problems(tmp_path / "nothing"))
