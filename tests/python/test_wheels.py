"""Limits of a base from the data of its wheels (scenario key `robot.wheels`)."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.documents.reading import read_yaml
from mmgrasp.scenario.robot_section import compose

DIFF = {"radius": 0.06, "speed": 17.4, "track": 0.37476}
MECANUM = {"radius": 0.05, "speed": 20.0, "track": 0.4, "wheelbase": 0.5}
LIMITS = ("linear_velocity", "angular_velocity", "linear_acceleration", "angular_acceleration")
Robots = Callable[..., mg.Robot]


@pytest.fixture
def made(storeroom: dict[str, Any], write: Callable[..., Path]) -> Robots:
    """The storeroom's robot with these wheels and limits."""

    def make(base: str, wheels: dict[str, float], **limits: float) -> mg.Robot:
        section = copy.deepcopy(storeroom["robot"]) | {"base": base, "wheels": wheels, "base_limits": limits}
        return compose(read_yaml(write({"robot": section})).root["robot"])

    return make


def mecanum(vx: float, vy: float, omega: float, wheels: dict[str, float]) -> np.ndarray:
    """Turning rates of the four wheels, rollers at 45 degrees: of each, velocity of its middle along its drive."""
    rates = []
    for x, y, side in ((1, 1, -1), (1, -1, 1), (-1, 1, 1), (-1, -1, -1)):
        at = np.array([x * wheels["wheelbase"] / 2, y * wheels["track"] / 2])
        v = np.array([vx - omega * at[1], vy + omega * at[0]])
        rates.append((v[0] + side * v[1]) / wheels["radius"])
    return np.array(rates)


def test_a_diff_drives_limits_are_its_wheels(made: Robots) -> None:
    limits = made("diff_drive", DIFF).base_limits
    assert limits["wheel_velocity"] == pytest.approx(17.4 * 0.06)
    assert limits["wheel_separation"] == 0.37476
    assert limits["linear_velocity"] == pytest.approx(1.044)
    assert limits["angular_velocity"] == pytest.approx(2 * 1.044 / 0.37476)
    slower = made("diff_drive", DIFF, linear_velocity=0.6, angular_velocity=1.0).base_limits
    assert (slower["linear_velocity"], slower["angular_velocity"]) == (0.6, 1.0)
    assert slower["wheel_velocity"] == limits["wheel_velocity"]


def test_speed_and_turning_share_the_wheels(made: Robots) -> None:
    """What the robot scales commands to, against the rims by hand: |v| + |omega| b / 2 <= r x speed."""
    robot = made("diff_drive", DIFF)
    rng = np.random.default_rng(1)
    for v, omega in rng.uniform([-2, -8], [2, 8], (200, 2)):
        rim = abs(v) + abs(omega) * DIFF["track"] / 2
        most = {
            "linear_velocity": 1.044 / abs(v),
            "angular_velocity": 2 * 1.044 / 0.37476 / abs(omega),
            "rim": 1.044 / rim,
        }
        assert robot.velocity_scale([v, 0, omega]) == pytest.approx(min(1.0, *most.values()))


def test_four_wheels_share_ahead_aside_and_turning(made: Robots) -> None:
    robot = made("omni", MECANUM)
    limits = robot.base_limits
    assert [limits[key] for key in ("wheel_velocity", "wheel_separation", "wheelbase")] == [1.0, 0.4, 0.5]
    assert limits["linear_velocity"] == pytest.approx(1.0)
    assert limits["angular_velocity"] == pytest.approx(1 / 0.45)
    rng = np.random.default_rng(3)
    for vx, vy, omega in rng.uniform(-1.5, 1.5, (200, 3)):
        rates = np.abs(mecanum(vx, vy, omega, MECANUM)).max()
        most = (20 / rates, 1 / math.hypot(vx, vy), 1 / 0.45 / abs(omega))
        assert robot.velocity_scale([vx, vy, omega]) == pytest.approx(min(1.0, *most))


@pytest.mark.parametrize("base", ["diff_drive", "omni"])
@pytest.mark.parametrize(
    "stated", [{}, {"linear_velocity": 0.3}, {"angular_velocity": 0.5}, {"linear_acceleration": 0.4}]
)
def test_no_combination_of_the_limits_is_too_much_for_a_wheel(
    made: Robots, base: str, stated: dict[str, float]
) -> None:
    """Any velocity that the robot's commands are scaled to and acceleration within the limits at any heading, by kinematics of each wheel
    and a small step in time."""
    wheels = {**(DIFF if base == "diff_drive" else MECANUM), "acceleration": 40.0}
    robot = made(base, wheels, **stated)
    limits = robot.base_limits
    for key, value in stated.items():
        assert limits[key] == value
    rng = np.random.default_rng(2)
    fastest = hardest = 0.0
    for _ in range(3000):
        angle, heading, turn = rng.uniform(-math.pi, math.pi, 3)
        v = limits["linear_velocity"] * np.array([math.cos(angle), math.sin(angle)])
        a = limits["linear_acceleration"] * np.array([math.cos(turn), math.sin(turn)])
        omega, alpha = (
            limits["angular_velocity"] * rng.choice([-1, 1]),
            limits["angular_acceleration"] * rng.choice([-1, 1]),
        )
        if base == "diff_drive":
            hard = abs(a[0]) + abs(alpha) * wheels["track"] / 2
            hardest = max(hardest, hard / wheels["radius"])
            continue
        c, s = math.cos(heading), math.sin(heading)
        share = robot.velocity_scale([c * v[0] + s * v[1], c * v[1] - s * v[0], omega])
        v, omega = share * v, share * omega
        h, rates = 1e-6, []
        for t in (0.0, h):
            theta, w = heading + omega * t, v + a * t
            c, s = math.cos(theta), math.sin(theta)
            rates.append(mecanum(c * w[0] + s * w[1], -s * w[0] + c * w[1], omega + alpha * t, wheels))
        fastest = max(fastest, float(np.abs(rates[0]).max()))
        hardest = max(hardest, float(np.abs(rates[1] - rates[0]).max() / h))
    assert hardest <= 40.0 * (1 + 1e-5)
    if base == "omni":
        assert fastest <= MECANUM["speed"] * (1 + 1e-9)
        assert fastest > 0.97 * MECANUM["speed"]  # and no less than they can do
    else:
        assert hardest > 0.97 * 40.0


def test_a_drive_by_keeps_the_wheels_and_uses_them(made: Robots) -> None:
    """Wheels that cannot do speed and turning at once: their rates, from the base's poses alone, come to their limit and not beyond."""
    slow = {**DIFF, "speed": 10.0}
    robot = made("diff_drive", slow, linear_velocity=0.6, angular_velocity=2.0)
    group = robot.group("arm", tip="gripper_link", with_base=True)
    start = np.zeros(group.size)
    goal = start.copy()
    goal[:3] = [1.0, 1.5, 2.5]
    task = mg.DriveByTask(mg.pose([1.2, 0.8, 0.8]), free_axes=["roll", "pitch", "yaw"])
    found = mg.plan_drive_by(robot, group, mg.World(), start=start, tasks=[task], goal=goal)
    assert found.outcome == mg.Outcome.solved, found.report
    fine = found.trajectory.sampled(between=19)
    x, y, theta = np.asarray(fine.positions)[:, :3].T
    h = np.diff(fine.times)
    way = np.hypot(np.diff(x), np.diff(y))
    rates = (way[:, None] / h[:, None] + np.abs(np.diff(theta) / h)[:, None] * slow["track"] / 2) / slow["radius"]
    assert rates.max() <= 10.0 * (1 + 1e-6)
    assert rates.max() > 9.9


def rims_of_drive(motion: dict[str, Any], lever: float) -> np.ndarray:
    """|v_x| + |v_y| + |omega| (track + wheelbase) / 2 at the samples of a motion in passing, in the base's frame [m/s]."""
    x, y, omega = np.array(motion["velocities"])[:, :3].T
    theta = np.array(motion["positions"])[:, 2]
    c, s = np.cos(theta), np.sin(theta)
    rims: np.ndarray = np.abs(c * x + s * y) + np.abs(c * y - s * x) + lever * np.abs(omega)
    return rims


def test_a_cell_on_mecanum_wheels_is_planned_driven_past_and_verified(write: Callable[..., Path]) -> None:
    """Wheels so slow that they bind on every drive; the plan made faster by a hundredth is refused."""
    values = yaml.safe_load((ASSETS / "scenarios" / "omni_cell.yaml").read_text())
    values["robot"]["wheels"] = {"radius": 0.05, "speed": 6.0, "track": 0.4, "wheelbase": 0.5}
    values["robot"]["base_limits"] = {"linear_acceleration": 0.6, "angular_acceleration": 1.2}
    values["trays"] = [{**values["trays"][0], "targets": [0, 4]}]
    values["goal"] = [-0.6, 0.4, 3.0]
    values["reach"] = {"samples": 500_000}
    path = write(values)
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan
    content = mg.part_supply.plan_drive_by_picks(plan).plan_to_dict()
    verdict = mg.verify_plan(content, scenario=path, samples=20)
    assert verdict.ok, verdict.faults
    for leg in content["route"]:
        assert leg["duration"] > 0
        faster = copy.deepcopy(content)
        faster["route"][content["route"].index(leg)]["duration"] /= 1.01
        assert "route-values" in {fault.code for fault in mg.verify_plan(faster, samples=20).faults}
    moving = [motion for motion in content["drive_by"]["motions"] if np.ptp(np.array(motion["positions"])[:, 0]) > 0.1]
    assert moving
    for motion in moving:
        fastest = float(rims_of_drive(motion, 0.45).max())
        assert 0.2 < fastest <= 0.3 * (1 + 1e-6)
        by = 1.01 * 0.3 / fastest
        motion["times"] = [t / by for t in motion["times"]]
        motion["velocities"] = [[by * v for v in row] for row in motion["velocities"]]
    assert "wheel-limit" in {fault.code for fault in mg.verify_plan(content, samples=20).faults}


@pytest.mark.parametrize(
    ("base", "wheels", "limits", "texts"),
    [
        ("diff_drive", {**DIFF, "wheelbase": 0.4}, {}, ["wheels.wheelbase", "one axle"]),
        ("omni", DIFF, {}, ["wheels", "wheelbase"]),
        ("fixed", DIFF, {}, ["wheels", "fixed"]),
        ("diff_drive", DIFF, {"wheel_velocity": 0.8}, ["wheels", "wheel_velocity"]),
        ("diff_drive", DIFF, {"linear_velocity": 1.05}, ["linear_velocity = 1.05", "1.044"]),
        ("diff_drive", DIFF, {"angular_velocity": 6.0}, ["angular_velocity = 6", "5.57"]),
        ("omni", MECANUM, {"linear_velocity": 1.05}, ["linear_velocity = 1.05", "these wheels do, 1"]),
        ("omni", MECANUM, {"angular_velocity": 2.3}, ["angular_velocity = 2.3", "2.22"]),
        ("omni", MECANUM, {"wheelbase": 0.5}, ["wheels", "wheelbase"]),
        ("omni", {**MECANUM, "acceleration": 20}, {"linear_acceleration": 0.4}, ["together"]),
        ("omni", {**MECANUM, "acceleration": 0.1}, {}, ["wheels.acceleration = 0.1", "angular_velocity, 2.22"]),
        ("diff_drive", {**DIFF, "radius": 0}, {}, ["wheels.radius"]),
        ("diff_drive", {**DIFF, "speed": -1}, {}, ["wheels.speed"]),
        ("diff_drive", {**DIFF, "speed": math.nan}, {}, ["wheels.speed"]),
        ("diff_drive", {**DIFF, "acceleration": "much"}, {}, ["wheels.acceleration"]),
        ("diff_drive", {**DIFF, "diameter": 0.12}, {}, ["wheels.diameter", "unknown key"]),
        ("diff_drive", {"radius": 0.06, "speed": 17.4}, {}, ["track"]),
    ],
)  # fmt: skip
def test_wheels_that_make_no_sense(
    made: Robots, base: str, wheels: dict[str, Any], limits: dict[str, float], texts: list[str]
) -> None:
    with pytest.raises(mg.InvalidInput) as caught:
        made(base, wheels, **limits)
    for text in texts:
        assert text in str(caught.value)
    assert "scenario.yaml:" in str(caught.value)
