"""Several robots in one room: when each may go, by sums on paper, and a check that refuses what does not hold."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import REMOVE, edited
from mmgrasp import Error, InvalidInput, Outcome
from mmgrasp.cli import main
from mmgrasp.part_supply import Schedule, schedule_plans, verify_schedule
from plan_by_hand import URDF
from schedule_plans import (
    ACCELERATION,
    RADIUS,
    SPEED,
    drive_time,
    driven,
    east,
    north,
    plan_along,
    plan_with_pick,
    west,
    write_plans,
)

CLEARANCE = 0.1
LATER = 0.04
"""A schedule may wait so much longer than needed: four steps of the clock [s]."""


def codes(schedule: dict[str, Any]) -> list[str]:
    return [fault.code for fault in verify_schedule(schedule).faults]


@pytest.fixture
def crossing(tmp_path: Path) -> Schedule:
    return schedule_plans(write_plans(tmp_path, plan_along(east()), plan_along(north())), clearance=CLEARANCE)


def test_the_wait_at_a_crossing_is_that_of_two_discs(crossing: Schedule) -> None:
    """At full speed v and w apart in time the distance of the middles is never less than v w / sqrt(2)."""
    needed = math.sqrt(2) * (2 * RADIUS + CLEARANCE) / SPEED
    first, second = crossing.robots
    assert crossing.outcome == Outcome.solved
    assert first.waited == 0.0 and first.end == pytest.approx(drive_time(6.0), abs=1e-9)
    assert needed - 2e-3 <= second.waited <= needed + LATER
    assert second.end - 2 * LATER <= second.earliest_end <= needed + drive_time(6.0) + 1e-6
    assert verify_schedule(crossing.to_dict()).ok


def test_parts_carried_in_the_hand_are_refused(tmp_path: Path) -> None:
    first, second = write_plans(tmp_path, plan_along(east()), plan_along(north()))
    content = json.loads(Path(second).read_text())
    content["scenario"].pop("place_region")
    content["scenario"]["unload_region"] = {
        "pose": {"xyz": [0, 0, 0.5], "quat_xyzw": [0, 0, 0, 1]},
        "size": [0.3, 0.3],
        "drop_height": 0.03,
    }
    Path(second).write_text(json.dumps(content))
    with pytest.raises(InvalidInput, match="unload_region: robots that carry parts in the hand are not scheduled"):
        schedule_plans([first, second], clearance=CLEARANCE)


def test_a_wait_that_is_shortened_is_refused(crossing: Schedule) -> None:
    content = crossing.to_dict()
    piece = content["robots"][1]["pieces"][0]
    for key in ("wait", "start"):
        piece[key] -= 0.5
    for key in ("end", "waited"):
        content["robots"][1][key] -= 0.5
    assert codes(content) == ["robots-meet"]
    (fault,) = verify_schedule(content).faults
    assert "'drive to the goal, section 1'" in fault.message and "'base' to 'base'" in fault.message


def test_the_check_sees_half_a_centimetre(crossing: Schedule) -> None:
    content = crossing.to_dict()
    needed = math.sqrt(2) * (2 * RADIUS + CLEARANCE) / SPEED
    for less, found in ((0.0, []), (math.sqrt(2) * 0.005 / SPEED, ["robots-meet"])):
        wait = needed - less
        row = content["robots"][1]
        row["pieces"][0] |= {"wait": wait, "start": wait}
        row |= {"waited": wait, "end": wait + drive_time(6.0)}
        assert codes(content) == found


@pytest.mark.parametrize(
    ("change", "code"),
    [
        ({"wait": 9.0}, "wrong-values"),
        ({"start": 0.0, "wait": 0.0}, "wrong-values"),
        ({"duration": 1.0}, "wrong-values"),
    ],
)
def test_times_that_disagree_are_faults(crossing: Schedule, change: dict[str, float], code: str) -> None:
    content = crossing.to_dict()
    content["robots"][1]["pieces"][0] |= change
    assert code in codes(content)


def test_pieces_left_out_and_pieces_too_early_are_faults(tmp_path: Path) -> None:
    corner = [*east(5.0), [3.0, 5.0, math.pi / 2], [3.0, 8.0, math.pi / 2]]
    found = schedule_plans(write_plans(tmp_path, plan_along(east()), plan_along(corner)))
    content = found.to_dict()
    assert codes(content) == []
    short = copy.deepcopy(content)
    gone = short["robots"][1]["pieces"].pop()
    short["robots"][1]["end"] -= gone["duration"]
    assert codes(short) == ["schedule-pieces"]
    early = copy.deepcopy(content)
    early["robots"][1]["pieces"][1]["start"] -= 1.0
    early["robots"][1]["pieces"][0]["duration"] -= 1.0
    for piece in early["robots"][1]["pieces"][2:]:
        piece["start"] -= 1.0
    early["robots"][1]["end"] -= 1.0
    assert "too-early" in codes(early)


def test_two_that_change_places_in_an_aisle_have_no_schedule(tmp_path: Path) -> None:
    found = schedule_plans(write_plans(tmp_path, plan_along(east()), plan_along(west())))
    assert found.outcome == Outcome.infeasible
    assert "robot 2" in found.obstruction and "robot 1" in found.obstruction
    assert "'drive to the goal, section 1' meets its stand at the goal of robot 1" in found.obstruction
    assert "its start is in the way of 'drive to the goal, section 1' of robot 1" in found.obstruction
    assert codes(found.to_dict()) == ["no-schedule"]


def test_who_stands_at_the_goal_is_in_the_way_of_later_ones(tmp_path: Path) -> None:
    stays, passes = plan_along(east(end=0.0)), plan_along(north())
    found = schedule_plans(write_plans(tmp_path, stays, passes))
    assert found.outcome == Outcome.infeasible
    assert "'drive to the goal, section 1' meets its stand at the goal of robot 1" in found.obstruction


def test_the_other_order_gives_another_schedule(tmp_path: Path) -> None:
    """The one that passes goes first; the other one arrives when it has gone far enough."""
    stays, passes = plan_along(east(end=0.0)), plan_along(north())
    found = schedule_plans(write_plans(tmp_path, passes, stays), clearance=CLEARANCE)
    assert found.outcome == Outcome.solved and found.robots[0].waited == 0.0
    apart = 2 * RADIUS + CLEARANCE
    times = np.arange(0.0, 20.0, 0.002)
    first = np.array([driven(t, 6.0) - 3.0 for t in times])

    def meets(wait: float) -> bool:
        second = np.array([driven(t - wait, 3.0) - 3.0 for t in times])
        return bool((np.hypot(first, second) < apart).any())

    waits = np.arange(0.0, 6.0, 0.01)
    needed = waits[np.flatnonzero([meets(w) for w in waits])[-1] + 1]
    assert needed - 0.02 <= found.robots[1].waited <= needed + LATER
    assert codes(found.to_dict()) == []


def test_one_follows_another_and_waits_on_the_way(tmp_path: Path) -> None:
    """The second may come up to the corner, where it stands until the first has passed."""
    first = plan_along(east(begin=-5.0, end=9.0))
    second = plan_along([*north(begin=-4.0, end=-2.0), [0.0, 3.0, math.pi / 2]])
    found = schedule_plans(write_plans(tmp_path, first, second), clearance=CLEARANCE)
    half_ramps = 0.5 * SPEED / ACCELERATION
    needed = 5.0 / SPEED + half_ramps + math.sqrt(2) * (2 * RADIUS + CLEARANCE) / SPEED
    needed -= drive_time(2.0) + 2.0 / SPEED + half_ramps
    waits = found.robots[1].waits()
    assert waits[0] == 0.0 and needed - 2e-3 <= waits[1] <= needed + LATER
    assert codes(found.to_dict()) == []


def test_arms_count_where_bases_are_clear(tmp_path: Path) -> None:
    """Lanes 0.9 m apart leave 0.5 m between the bases; arms of 0.6 m that point to each other do not pass."""
    for turn, outcome in ((0.0, Outcome.solved), (math.pi / 2, Outcome.infeasible)):
        home = (0.0, turn)
        plans = plan_along(east(), URDF, home), plan_along(west(0.9), URDF, home)
        plans[1]["scenario"]["home"] = [0.0, turn]
        found = schedule_plans(write_plans(tmp_path, *plans), clearance=CLEARANCE)
        assert found.outcome == outcome
    assert "drive to the goal" in found.obstruction


def test_a_part_in_the_hand_counts(tmp_path: Path) -> None:
    """A bar that is swung about reaches farther than the arm: the lane beside it is free when it is in the bin."""
    lane = plan_along(north(1.15, -5.0, 5.0), URDF, (0.0, 0.0))
    waited = {}
    for length in (0.04, 0.8):
        first = plan_with_pick(length)
        found = schedule_plans(write_plans(tmp_path, first, lane), clearance=CLEARANCE)
        assert found.outcome == Outcome.solved and codes(found.to_dict()) == []
        waited[length] = found.robots[1].waited
    assert waited[0.04] == 0.0 and waited[0.8] > 1.0


def test_the_check_sees_a_part_in_the_hand(tmp_path: Path) -> None:
    lane = plan_along(north(1.15, -5.0, 5.0), URDF, (0.0, 0.0))
    content = schedule_plans(write_plans(tmp_path, plan_with_pick(0.8), lane), clearance=CLEARANCE).to_dict()
    row = content["robots"][1]
    row["end"] -= row["waited"]
    row["waited"] = row["pieces"][0]["wait"] = row["pieces"][0]["start"] = 0.0
    (fault,) = verify_schedule(content).faults
    assert fault.code == "robots-meet" and "'A/brick_0'" in fault.message and "transfer A/brick_0" in fault.message


def test_one_plan_twice_is_refused(tmp_path: Path) -> None:
    pick = plan_with_pick(0.04)
    with pytest.raises(InvalidInput, match=r"picks 'A/brick_0', which .* picks, too"):
        schedule_plans(write_plans(tmp_path, pick, pick))
    drive = plan_along(east())
    found = schedule_plans(write_plans(tmp_path, drive, drive))
    assert found.outcome == Outcome.infeasible
    assert "is in the way of its start of robot 1" in found.obstruction and "too close at once" in found.obstruction


def test_three_robots_each_wait_for_those_before(tmp_path: Path) -> None:
    plans = plan_along(east()), plan_along(north()), plan_along(north(0.8))
    found = schedule_plans(write_plans(tmp_path, *plans), clearance=CLEARANCE)
    assert [robot.waited > 0 for robot in found.robots] == [False, True, True]
    assert {area.robots for area in found.areas} == {(0, 1), (0, 2)}
    for area in found.areas:
        for windows in area.windows:
            assert all(a < b for a, b in windows)
    assert codes(found.to_dict()) == []


def test_windows_are_where_and_when_they_cross(crossing: Schedule) -> None:
    (area,) = crossing.areas
    apart = 2 * RADIUS + CLEARANCE
    assert area.robots == (0, 1)
    assert area.low == pytest.approx((-apart, -apart), abs=0.05) and area.high == pytest.approx(
        (apart, apart), abs=0.05
    )
    middle = drive_time(6.0) / 2
    [(a, b)], [(c, d)] = area.windows
    assert (a, b) == pytest.approx((middle - apart / SPEED, middle + apart / SPEED), abs=0.05)
    assert (c - a, d - b) == pytest.approx([crossing.robots[1].waited] * 2, abs=0.05)


def test_the_motion_has_its_waits(crossing: Schedule) -> None:
    first, second = (robot.motion() for robot in crossing.robots)
    assert first.duration == pytest.approx(drive_time(6.0), abs=1e-9)
    assert second.duration == pytest.approx(crossing.robots[1].end, abs=1e-9)
    at = np.searchsorted(second.times, crossing.robots[1].waited + 1e-9)
    assert np.allclose(second.base_poses[:at], [0.0, -3.0, math.pi / 2])
    times = np.linspace(0.0, second.duration, 2000)
    places = [np.column_stack([np.interp(times, m.times, m.base_poses[:, k]) for k in (0, 1)]) for m in (first, second)]
    assert np.hypot(*(places[0] - places[1]).T).min() >= 2 * RADIUS + CLEARANCE - 1e-3


def test_the_motion_without_waits_is_that_of_the_round(tmp_path: Path) -> None:
    found = schedule_plans(write_plans(tmp_path, plan_with_pick(0.04), plan_along(north(5.0))))
    motion = found.robots[0].motion()
    assert [(row["command"], row["opening"], row["object"]) for row in motion.gripper] == [("open", 0.05, "")]
    assert motion.duration == pytest.approx(20.0)


def test_files(crossing: Schedule, tmp_path: Path) -> None:
    path = crossing.save(tmp_path / "schedule.json")
    assert json.loads(path.read_text()) == crossing.to_dict()
    assert verify_schedule(path).ok
    names = sorted(p.name for p in crossing.save_trajectories(tmp_path / "motions"))
    assert names == ["robot_1.csv", "robot_1.json", "robot_2.csv", "robot_2.json"]
    Path(crossing.robots[0].plan).write_text(json.dumps(plan_along(east(1.0))))
    with pytest.raises(InvalidInput, match=r"robots\[0\].plan.*has changed"):
        verify_schedule(path)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("format", "mmgrasp-plan", "format"),
        ("version", 2, "reads version 1"),
        ("clearance", 0.0, "clearance"),
        ("clearance", "0.1", "must be a number"),
        ("robots", {}, "robots"),
        ("robots", [], "at least 2"),
        ("extra", 1, "unknown key"),
    ],
)
def test_files_that_are_no_schedule(crossing: Schedule, key: str, value: Any, message: str) -> None:
    with pytest.raises(InvalidInput, match=message):
        verify_schedule(crossing.to_dict() | {key: value})


DESCRIBES = ("mmgrasp", "areas", "obstruction", "earliest_end", "name")
"""What a schedule says beside what is checked."""


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where all values of a file are."""
    if path:
        yield path
    if isinstance(value, dict | list):
        for key in value if isinstance(value, dict) else range(len(value)):
            yield from places(value[key], (*path, key))


@pytest.mark.parametrize("odd", [None, "x", -1, 1e300, [], {}, True, [1], "plan.json"])
def test_no_odd_value_passes_or_breaks_the_check(crossing: Schedule, odd: Any) -> None:
    good = crossing.to_dict()
    for path in places(good):
        if set(path) & set(DESCRIBES):
            continue
        content = copy.deepcopy(good)
        target: Any = content
        for key in path[:-1]:
            target = target[key]
        if target[path[-1]] == odd:
            continue
        target[path[-1]] = odd
        try:
            assert not verify_schedule(content).ok, path
        except Error as error:
            assert str(error)


def test_plans_that_cannot_be_scheduled(tmp_path: Path) -> None:
    first, second = plan_along(east()), plan_along(north())
    second["scenario"]["obstacles"][0]["pose"]["xyz"][0] += 0.1
    with pytest.raises(InvalidInput, match="plans of one room have the same obstacles"):
        schedule_plans(write_plans(tmp_path, first, second))
    second = plan_along(north()) | {"outcome": "timeout"}
    with pytest.raises(InvalidInput, match="must be solved"):
        schedule_plans(write_plans(tmp_path, first, second))
    still = plan_along([[0.0, -2.0, 0.0], [0.0, -2.0, 0.0]])
    with pytest.raises(InvalidInput, match=r"robot 2 \(.*\): does not move in its plan"):
        schedule_plans(write_plans(tmp_path, first, still))
    picks = plan_with_pick(0.04)
    picks["picks"][0]["part"] = "nobody"
    with pytest.raises(InvalidInput, match="no such part"):
        schedule_plans(write_plans(tmp_path, first, picks))
    picks = plan_with_pick(0.04)
    picks["picks"][0]["motions"][2]["times"] = [0.0, 0.0]
    with pytest.raises(InvalidInput, match=r"robot 2 \(.*\): .*times"):
        schedule_plans(write_plans(tmp_path, first, picks))
    paths = write_plans(tmp_path, first, plan_along(north()))
    for clearance in (0.0, 11.0, math.nan):
        with pytest.raises(InvalidInput, match="clearance"):
            schedule_plans(paths, clearance=clearance)
    for few in ([], paths[:1], paths * 9):
        with pytest.raises(InvalidInput, match="must be 2 to 16"):
            schedule_plans(few)


@pytest.mark.parametrize(
    ("keys", "value", "said"),
    [
        ("scenario.start", [1.0, 1.0, 1.0], r"route\[0\].*must be \[1, 1, 1\], where the robot stands"),
        ("scenario.goal", [9.0, 9.0, 0.0], r"scenario.goal.*where the robot arrives"),
        ("route.0", REMOVE, r"route.*has 1 legs: must be one more than the 1 stops"),
        ("picks.0.motions.1.positions.0", [0.3, 0.3], r"motions\[1\].positions\[0\].*where the motion before ends"),
        ("scenario.gripper.max_opening", 0.0, r"max_opening.*must be > 0"),
    ],
)
def test_plans_that_nobody_can_carry_out_are_refused(tmp_path: Path, keys: str, value: Any, said: str) -> None:
    first, second = write_plans(tmp_path, plan_with_pick(0.04), plan_along(north(5.0)))
    schedule_plans([first, second], clearance=CLEARANCE)
    first.write_text(json.dumps(edited(json.loads(first.read_text()), keys, value)))
    with pytest.raises(InvalidInput, match=said):
        schedule_plans([first, second], clearance=CLEARANCE)


def test_trays_of_one_room_hold_the_same_parts(tmp_path: Path) -> None:
    first, second = write_plans(tmp_path, plan_with_pick(0.04), plan_with_pick(0.04))
    content = json.loads(second.read_text())
    content["scenario"]["parts"][0]["name"] += " of another room"
    content["picks"][0]["part"] = content["scenario"]["parts"][0]["name"]
    second.write_text(json.dumps(content))
    with pytest.raises(InvalidInput, match=r"tray .*differs from that of .*robot_1.*same trays and parts"):
        schedule_plans([first, second], clearance=CLEARANCE)


def test_a_schedule_may_have_its_keys_in_any_order(crossing: Schedule, tmp_path: Path) -> None:
    content = crossing.to_dict()
    path = tmp_path / "sorted.json"
    path.write_text(json.dumps(dict(sorted(content.items(), reverse=True))))
    assert main(["verify", str(path)]) == 0


def test_outputs_do_not_lie_among_the_trajectories(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    plans = [str(path) for path in write_plans(tmp_path, plan_along(east()), plan_along(north()))]
    folder, out = str(tmp_path / "csv"), str(tmp_path / "s.json")
    for more in (["-o", f"{folder}/s.json"], ["-o", out, "--png", f"{folder}/robot_1.csv"]):
        assert main(["schedule", *plans, "--trajectories", folder, *more]) == 2
        assert "lies in the folder of --trajectories" in " ".join(capsys.readouterr().err.split())
    assert not Path(folder).exists() and not Path(out).exists()
