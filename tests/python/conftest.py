"""What the tests share: paths, a small scenario that plans in seconds, and its plan, made once."""

from __future__ import annotations

import copy
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

import mmgrasp as mg

REPOSITORY = Path(__file__).resolve().parents[2]
DATA = REPOSITORY.parent / "shared" / "data"
ASSETS = Path(mg.__file__).parent / "assets"


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Tests never read or write the user's cache, but share one of their own."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def data() -> Path:
    if not DATA.is_dir():
        pytest.skip("the shared test data is not there")
    return DATA


@pytest.fixture(scope="session")
def fetch() -> mg.Robot:
    folder = ASSETS / "robots" / "fetchlike"
    return mg.Robot.load(folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive")


@pytest.fixture(scope="session")
def arm(fetch: mg.Robot) -> mg.robot.JointGroup:
    """The fetchlike robot's arm and torso, eight joints, on a base that stands."""
    return fetch.group("arm_with_torso", tip="gripper_tcp")


@pytest.fixture(scope="session")
def storeroom() -> dict[str, Any]:
    """The shipped scenario as plain values."""
    values: dict[str, Any] = yaml.safe_load((ASSETS / "scenarios" / "storeroom.yaml").read_text())
    return values


@pytest.fixture(scope="session")
def small(storeroom: dict[str, Any]) -> dict[str, Any]:
    """One tray of the storeroom with two parts to pick: everything a plan has, in a few seconds."""
    scenario = copy.deepcopy(storeroom)
    tray = copy.deepcopy(scenario["trays"][0])
    tray["targets"] = tray["targets"][:2]
    scenario["trays"] = [tray]
    scenario["name"] = "small"
    scenario["reach"] = {"samples": 500_000}
    return scenario


@pytest.fixture(scope="session")
def write(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Writes a scenario given as values and returns its path."""

    def write_scenario(values: dict[str, Any] | str, name: str = "scenario.yaml") -> Path:
        path = tmp_path_factory.mktemp("scenario") / name
        path.write_text(values if isinstance(values, str) else yaml.safe_dump(values, sort_keys=False))
        return path

    return write_scenario


@pytest.fixture(scope="session")
def small_path(small: dict[str, Any], write: Callable[..., Path]) -> Path:
    return write(small)


@pytest.fixture(scope="session")
def small_plan(small_path: Path) -> mg.part_supply.ScenarioPlan:
    plan = mg.plan_part_supply(small_path)
    assert plan.outcome == mg.Outcome.solved, plan
    return plan


@pytest.fixture(scope="session")
def small_plan_dict(small_plan: mg.part_supply.ScenarioPlan) -> dict[str, Any]:
    return small_plan.to_dict()


REMOVE = object()


def edited(scenario: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """A copy with one value set; the path is written like trays.0.size."""
    out = copy.deepcopy(scenario)
    target: Any = out
    *parents, last = [int(key) if key.isdigit() else key for key in path.split(".")]
    for key in parents:
        target = target[key]
    if value is REMOVE:
        del target[last]
    else:
        target[last] = value
    return out
