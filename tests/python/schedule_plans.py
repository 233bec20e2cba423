"""Small plans for two robots, written by hand, whose meetings can be computed on paper."""

from __future__ import annotations

import copy
import json
import math
from pathlib import Path
from typing import Any

from plan_by_hand import box, motion, plan_by_hand, pose

RADIUS, SPEED, ACCELERATION = 0.25, 0.6, 0.5
PUCK = f"""<robot name="puck">
  <link name="base"><collision><origin xyz="0 0 0.15"/><geometry><cylinder radius="{RADIUS}" length="0.3"/></geometry></collision></link>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="column"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5" velocity="0.2" effort="10"/></joint>
  <link name="column"/>
  <joint name="turn" type="revolute"><parent link="column"/><child link="arm"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="1" effort="10"/></joint>
  <link name="arm"/>
  <joint name="tool" type="fixed"><parent link="arm"/><child link="tcp"/><origin xyz="0.1 0 0"/></joint>
  <link name="tcp"/>
</robot>"""

SRDF = '<robot name="by_hand"/>'
OPTIONS = {"approach_distance": 0.05, "lift_height": 0.05, "grid_max_distance": 0.0}


def drive_time(way: float) -> float:
    """From rest to rest over so many metres [s]."""
    return way / SPEED + SPEED / ACCELERATION


def driven(time: float, way: float) -> float:
    """Metres after so long of a drive that reaches its full speed."""
    ramp, end = SPEED / ACCELERATION, drive_time(way)
    if time <= 0 or time >= end:
        return 0.0 if time <= 0 else way
    if time < ramp:
        return 0.5 * ACCELERATION * time**2
    left = end - time
    return way - 0.5 * ACCELERATION * left**2 if left < ramp else SPEED * (time - 0.5 * ramp)


def plan_along(poses: list[list[float]], urdf: str = PUCK, home: tuple[float, float] = (0.0, 0.0)) -> dict[str, Any]:
    """A drive along poses, without stops."""
    plan = plan_by_hand()
    scenario = plan["scenario"]
    scenario["robot"]["urdf"] = scenario["robot"]["urdfs"][0]["urdf"] = urdf
    scenario["robot"]["srdf"], scenario["options"] = SRDF, OPTIONS
    scenario["robot"]["base_limits"] = {
        "linear_velocity": SPEED,
        "linear_acceleration": ACCELERATION,
        "angular_velocity": 1.0,
        "angular_acceleration": 1.0,
    }
    scenario["home"], scenario["start"], scenario["goal"] = list(home), poses[0], poses[-1]
    plan["route"] = [{"poses": poses, "length": 1.0, "turning": 0.0, "duration": 1.0}]
    plan["stops"], plan["picks"] = [], []
    scenario["trays"], scenario["parts"] = [], []
    plan["regions"], plan["intersections"] = [], []
    return plan


def east(y: float = 0.0, begin: float = -3.0, end: float = 3.0) -> list[list[float]]:
    """A straight drive along x."""
    return [[begin, y, 0.0], [end, y, 0.0]]


def west(y: float = 0.0, begin: float = 3.0, end: float = -3.0) -> list[list[float]]:
    """A straight drive against x."""
    return [[begin, y, math.pi], [end, y, math.pi]]


def north(x: float = 0.0, begin: float = -3.0, end: float = 3.0) -> list[list[float]]:
    """A straight drive along y."""
    return [[x, begin, math.pi / 2], [x, end, math.pi / 2]]


def plan_with_pick(length: float) -> dict[str, Any]:
    """A robot that stands at (0, 0) and swings a bar of this length about itself, the arm reaching 0.6 m and the bar's middle 0.7 m."""
    plan = plan_by_hand()
    plan["scenario"]["robot"]["srdf"], plan["scenario"]["options"] = SRDF, OPTIONS
    plan["scenario"]["start"] = plan["scenario"]["goal"] = [0.0, 0.0, 0.0]
    plan["stops"] = [plan["stops"][0] | {"pose": [0.0, 0.0, 0.0]}]
    here = {"poses": [[0.0, 0.0, 0.0]], "length": 0.0, "turning": 0.0, "duration": 0.0}
    plan["route"] = [here, copy.deepcopy(here)]
    home, there, away = [0.1, -2.9], [0.1, -1.6], [0.1, 1.6]
    pick = plan["picks"][0]
    pick["motions"] = [
        motion("transit", home, there, False, 4.0),
        motion("approach", there, there, False, 1.0),
        motion("lift", there, there, True, 1.0),
        motion("transfer", there, away, True, 6.0),
        motion("retreat", away, home, False, 8.0),
    ]
    plan["scenario"]["home"] = home
    plan["picks"] = [pick]
    part = plan["scenario"]["parts"][0]
    part["shapes"] = box(length, 0.04, 0.04)
    part["pose"] = pose(0.0, -0.7, 0.8)
    return plan


def write_plans(folder: Path, *plans: dict[str, Any]) -> list[Path]:
    """Each plan as FOLDER/robot_K/plan.json."""
    paths = []
    for i, plan in enumerate(plans):
        path = folder / f"robot_{i + 1}" / "plan.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(plan))
        paths.append(path)
    return paths
