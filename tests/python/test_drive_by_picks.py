"""Parts taken in passing: the main job's first picks merged with the drive."""

from __future__ import annotations

import json

import pytest

import mmgrasp as mg


def test_first_picks_in_passing(small_plan, tmp_path):
    """Whatever is found is shorter than what it replaces, stands where the plan goes on, and adds up."""
    passing = mg.plan_drive_by_picks(small_plan, attempts=2)
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
