"""Safe intervals against plain counting on a grid of time, the command, and two robots in the shipped storeroom."""

from __future__ import annotations

import copy
import json
import math
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from mmgrasp.cli.commands import main
from mmgrasp.part_supply import ScenarioPlan, plan_part_supply, schedule_plans, verify_schedule
from mmgrasp.part_supply.course import Course, Element
from mmgrasp.part_supply.meetings import Meetings
from mmgrasp.part_supply.safe_intervals import Interval, earliest_course, free_of, merged
from plan_by_hand import URDF
from schedule_plans import east, north, plan_along, plan_with_pick, west, write_plans

GRID, HORIZON = 0.5, 60.0


def counted(durations: list[float], blocked: list[list[Interval]]) -> float | None:
    """The earliest end by trying every step of a grid; None: there is no way."""

    def free(element: int, time: float) -> bool:
        return not any(low < time < high for low, high in blocked[element])

    times = [k * GRID for k in range(int(HORIZON / GRID))]
    here = [False] * len(times)
    if free(0, 0.0):
        here[0] = True
    for k in range(len(durations) + 1):
        for i in range(1, len(times)):
            stays = here[i - 1] and free(2 * k, times[i - 1] + GRID / 2) and free(2 * k, times[i])
            here[i] = (here[i] or stays) and free(2 * k, times[i])
        if k == len(durations):
            break
        there = [False] * len(times)
        for i, time in enumerate(times):
            arrival = i + round(durations[k] / GRID)
            if here[i] and free(2 * k + 1, time) and arrival < len(times):
                there[arrival] = free(2 * k + 2, times[arrival])
        here = there
    last = max((high for _, high in blocked[-1]), default=0.0)
    stays_free = [here[i] and (times[i] >= last) for i in range(len(times))]
    # whoever stands there when the last interval has passed may have come before it
    if not any(stays_free):
        return None
    i = stays_free.index(True)
    while i > 0 and here[i - 1] and free(2 * len(durations), times[i] - GRID / 2):
        i -= 1
    return times[i]


@pytest.mark.parametrize("seed", range(60))
def test_the_earliest_course_is_that_of_plain_counting(seed: int) -> None:
    rng = random.Random(seed)
    durations = [float(rng.randint(1, 3)) for _ in range(rng.randint(1, 4))]
    blocked = []
    for element in range(2 * len(durations) + 1):
        count = rng.randint(0, 3) if element else rng.randint(0, 1)
        begins = [rng.randint(1, 18) for _ in range(count)]
        blocked.append(merged([(float(b), float(b + rng.randint(1, 5))) for b in begins]))
    found = earliest_course(durations, lambda element, since: blocked[element])
    expected = counted(durations, blocked)
    assert (found.starts is None) == (expected is None)
    if found.starts is not None:
        assert found.arrival == expected and found.arrival == found.starts[-1] + durations[-1]


def test_intervals() -> None:
    assert merged([(3.0, 4.0), (0.0, 1.0), (1.0, 2.0), (3.5, 3.6)]) == [(0.0, 2.0), (3.0, 4.0)]
    assert free_of([(0.0, 2.0), (3.0, 4.0)]) == [(0.0, 0.0), (2.0, 3.0), (4.0, math.inf)]
    assert free_of([(-1.0, 2.0), (3.0, math.inf)]) == [(2.0, 3.0)]
    assert free_of([]) == [(0.0, math.inf)]


def test_cells_hold_at_random_times(tmp_path: Path) -> None:
    """Outside of the cells no two robots are too close, and in those that are sure always, at times that no knot of the search has."""
    clearance = 0.1
    plans = plan_with_pick(0.8), plan_along(north(1.0, -2.0, 2.0), URDF, (0.0, 1.0))
    first, second = (Course(plan, str(i)) for i, plan in enumerate(plans))
    meetings = Meetings(first, second, clearance, lambda: None)
    rng = np.random.default_rng(1)
    counts = {"safe": 0, "open": 0, "sure": 0}
    for i, a in enumerate(first.elements):
        for j, b in enumerate(second.elements):
            cells = meetings.unsafe(i, j)
            drawn = rng.uniform(0.0, [a.duration, b.duration], (50, 2))
            if len(cells):
                around = rng.uniform(cells[:, [0, 2]].min(axis=0), cells[:, [1, 3]].max(axis=0), (1500, 2))
                drawn = np.vstack([drawn, around])
            for t, s in drawn:
                distance = placed_at(a, t).distance(placed_at(b, s), 1e6)
                inside = (cells[:, 0] <= t) & (t <= cells[:, 1]) & (cells[:, 2] <= s) & (s <= cells[:, 3])
                if not inside.any():
                    assert distance >= clearance - 1e-4
                    counts["safe"] += 1
                elif cells[inside, 4].any():
                    assert distance < clearance + 1e-4
                    counts["sure"] += 1
                else:
                    assert abs(distance - clearance) < 0.05
                    counts["open"] += 1
    assert min(counts.values()) > 20, counts


def placed_at(element: Element, time: float) -> Any:
    """The body between two knots, which are so near to each other that a straight line is as good as the motion."""

    def between(rows: np.ndarray) -> np.ndarray:
        columns = rows.reshape(len(element.times), -1).T
        return np.array([np.interp(time, element.times, column) for column in columns])

    opening = float(between(element.opening)[0])
    return element._body.place(between(element.base), between(element.arm), opening, element.held)


def test_progress_grows_and_its_errors_pass(tmp_path: Path) -> None:
    paths = write_plans(tmp_path, plan_along(east()), plan_along(north()))
    heard: dict[str, list[float]] = {}

    def listen(stage: str, fraction: float) -> None:
        heard.setdefault(stage, []).append(fraction)

    found = schedule_plans(paths, progress=listen)
    assert len(heard) == 3
    for fractions in heard.values():
        assert fractions == sorted(fractions) and fractions[-1] == 1.0

    def stop(stage: str, fraction: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        schedule_plans(paths, progress=stop)
    with pytest.raises(KeyboardInterrupt):
        verify_schedule(found.to_dict(), progress=stop)


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    paths = [str(path.parent) for path in write_plans(tmp_path, plan_along(east()), plan_along(north()))]
    out, png, folder = tmp_path / "schedule.json", tmp_path / "schedule.png", tmp_path / "motions"
    assert main(["schedule", *paths, "-o", str(out), "--png", str(png), "--trajectories", str(folder)]) == 0
    said = capsys.readouterr().out
    assert "1.5 s before" in said and "shared, x -0.6" in said
    assert png.read_bytes().startswith(b"\x89PNG") and (folder / "robot_2.csv").stat().st_size > 1000
    assert main(["verify", str(out)]) == 0
    assert "2 robots never come closer than 0.1 m" in capsys.readouterr().out
    out = tmp_path / "wider.json"
    assert main(["schedule", *paths, "-o", str(out), "--json", "--clearance", "0.2"]) == 0
    content = json.loads(capsys.readouterr().out)
    assert content == json.loads(out.read_text()) and content["clearance"] == 0.2
    content["robots"][1]["pieces"][0]["start"] = 0.0
    out.write_text(json.dumps(content))
    assert main(["verify", str(out), "--json"]) == 1
    assert {fault["code"] for fault in json.loads(capsys.readouterr().out)["faults"]} == {"wrong-values", "robots-meet"}


def test_what_the_command_refuses(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = map(str, write_plans(tmp_path, plan_along(east()), plan_along(west())))
    out = tmp_path / "schedule.json"
    assert main(["schedule", first, second, "-o", str(out)]) == 3
    assert "no schedule: infeasible" in capsys.readouterr().out
    assert main(["verify", str(out)]) == 1
    assert "no-schedule" in capsys.readouterr().out
    assert main(["verify", str(out), "--samples", "5"]) == 2
    assert "--samples: is for plans" in capsys.readouterr().err
    new = str(tmp_path / "new.json")
    assert main(["schedule", first, "-o", new]) == 2
    assert "must be 2 to 16" in capsys.readouterr().err
    assert main(["schedule", first, second, "-o", new, "--png", new]) == 2
    assert "is the file of -o, too" in capsys.readouterr().err
    assert main(["schedule", first, str(tmp_path / "none.json"), "-o", new]) == 2
    assert "none.json" in capsys.readouterr().err


@pytest.fixture(scope="module")
def storeroom_plans(storeroom: dict[str, Any], write: Callable[..., Path]) -> list[ScenarioPlan]:
    """Two robots that share the storeroom's trays: both pick from B."""
    shares = {"A": [0], "B": [0]}, {"B": [5], "D": [4]}
    ends = ([-1.6, -1.6, 0.0], [-1.6, 1.2, math.pi]), ([-1.6, -0.4, 0.0], [-1.6, 0.0, math.pi])
    plans = []
    for targets, (start, goal) in zip(shares, ends, strict=True):
        scenario = copy.deepcopy(storeroom)
        scenario |= {"start": start, "goal": goal, "reach": {"samples": 500_000}}
        for tray in scenario["trays"]:
            tray["targets"] = targets.get(tray["name"], [])
        plan = plan_part_supply(write(scenario))
        assert plan.outcome == mg.Outcome.solved, plan
        plans.append(plan)
    return plans


def saved(plans: list[ScenarioPlan], folder: Path) -> list[Path]:
    return [plan.save(folder / f"plan_{i}.json") for i, plan in enumerate(plans)]


def test_two_robots_in_the_storeroom(storeroom_plans: list[ScenarioPlan], tmp_path: Path) -> None:
    ends = {}
    paths = saved(storeroom_plans, tmp_path)
    for order in (paths, paths[::-1]):
        found = schedule_plans(order, clearance=0.1)
        assert found.outcome == mg.Outcome.solved, found
        first, second = found.robots
        assert first.waited == 0.0 and second.waited > 1.0
        assert second.earliest_end <= second.end <= second.earliest_end + 0.2
        assert verify_schedule(found.save(tmp_path / "schedule.json")).ok
        for robot in found.robots:
            assert robot.motion().duration == pytest.approx(robot.end, abs=1e-9)
        ends[order[0]] = [robot.end for robot in found.robots]
        content = found.to_dict()
        row = content["robots"][1]
        late = next(k for k, piece in enumerate(row["pieces"]) if piece["wait"] > 0.5)
        row["pieces"][late]["wait"] -= 0.5
        for piece in row["pieces"][late:]:
            piece["start"] -= 0.5
        row["end"], row["waited"] = row["end"] - 0.5, row["waited"] - 0.5
        assert [fault.code for fault in verify_schedule(content).faults] == ["robots-meet"]
    assert len({tuple(np.round(times, 3)) for times in ends.values()}) == 2


def test_the_motion_of_the_first_is_that_of_its_plan(storeroom_plans: list[ScenarioPlan], tmp_path: Path) -> None:
    """Drives, picks and gripper events come at the times of the plan's own export."""
    found = schedule_plans(saved(storeroom_plans, tmp_path)).robots[0].motion()
    own = storeroom_plans[0].motion()
    assert found.duration == pytest.approx(own.duration, abs=1e-9)
    times, expected = (np.array([row["time"] for row in motion.gripper]) for motion in (found, own))
    assert np.allclose(times, expected, rtol=0, atol=1e-9) and len(times) >= 5
    for key in ("command", "opening", "object", "duration"):
        assert [row[key] for row in found.gripper] == [row[key] for row in own.gripper]
    clock = np.linspace(0.0, own.duration, 5000)
    for rows in ("base_poses", "positions"):
        a, b = (
            np.column_stack([np.interp(clock, m.times, column) for column in getattr(m, rows).T]) for m in (found, own)
        )
        assert np.allclose(a, b, rtol=0, atol=1e-9)
