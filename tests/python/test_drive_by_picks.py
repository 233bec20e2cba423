"""Parts taken in passing: the tasks of a push-grasp, and the main job's first picks merged with the drive."""

from __future__ import annotations

import json

import numpy as np
import pytest

import mmgrasp as mg
from sim_scenes import gripper


def test_the_tasks_of_a_push_grasp_stand_in_line():
    numbers = {"tool_speed": 0.3, "planned_depth": 0.048}
    closing = mg.push_grasp(opening=0.08, object_width=0.056, along_error=0.02, max_push=0.02, **numbers)
    T = mg.pose([2.0, -0.8, 0.77], rpy=[0.1, 0.2, -0.9])
    before, begin, end = mg.push_grasp_tasks(T, gripper(), closing, object="bottle", free_length=0.1, **numbers)
    way = [np.asarray(task.candidates[0]) for task in (before, begin, end)]
    along = [float((P[:3, 3] - T[:3, 3]) @ T[:3, 0]) for P in way]
    assert along == pytest.approx([-0.148, closing.push.start - 0.048, closing.push.both_touch - 0.048])
    for P, distance in zip(way, along, strict=True):
        assert P[:3, :3] == pytest.approx(T[:3, :3])
        assert P[:3, 3] == pytest.approx(T[:3, 3] + distance * T[:3, 0])
    # At the speed asked for, the way between the two takes as long as the fingers need.
    assert (along[2] - along[1]) / 0.3 == pytest.approx(closing.closing_time)
    assert begin.max_tool_speed == end.max_tool_speed == 0.3
    assert (begin.object, end.object) == ("", "bottle")  # not pushed before both fingers touch


def test_a_part_that_is_pushed_is_held_from_the_palm_on():
    numbers = {"tool_speed": 0.5, "planned_depth": 0.045}
    closing = mg.push_grasp(object_width=0.05, max_push=0.3, along_error=0.03, **numbers)
    assert closing.push.pushed > 0
    _, begin, end = mg.push_grasp_tasks(np.eye(4), gripper(), closing, object="box", **numbers)
    assert (begin.object, end.object) == ("box", "")


def test_first_picks_in_passing(small_plan, tmp_path):
    """Whatever is found is shorter than what it replaces, stands where the plan goes on, and adds up."""
    passing = mg.plan_drive_by_picks(small_plan, attempts=2, time_limit=20.0)
    assert len(passing.picks) == len(small_plan.stops)
    problem = small_plan.scenario.problem()
    assert passing.saved == pytest.approx(passing.stop_and_pick - passing.drive_by)
    assert passing.saved == pytest.approx(sum(p.stop_and_pick - p.drive_by for p in passing.picks))
    for done in passing.picks:
        pick = next(p for p in small_plan.picks if p.stop == done.stop)
        assert done.part == problem.trays[pick.tray].parts[pick.part].name
        assert done.why
        if not done.used:
            assert done.drive_by == done.stop_and_pick
            continue
        assert done.drive_by < done.stop_and_pick
        q = done.result.trajectory.positions
        lift = next(m for m in pick.motions if m.kind == "lift").trajectory.positions[-1]
        assert q[0] == pytest.approx([*problem.start, *problem.home], abs=1e-6)
        assert q[-1][3:] == pytest.approx(lift, abs=1e-6)
    files = passing.save(tmp_path)
    assert json.loads(files[0].read_text())["saved"] == passing.saved
    assert len(files) == 1 + sum(p.used for p in passing.picks)
