"""Every number of every public call, found in the stubs, set to what no number should be (number_walk.py)."""

from __future__ import annotations

import pytest

from number_walk import complaint, numbers, tries, walk

QUICK = ("nan", "1e160", "1e300", "2**31-1", "a word")


def test_the_stubs_were_read() -> None:
    found = {(call.function, name) for call, name, _ in numbers()}
    assert len(found) > 800
    assert {("make_height_map", "hole_radius"), ("plan_drive_by", "waypoints"), ("JointTrajectory.at", "time")} <= found


@pytest.mark.slow
def test_numbers_that_are_none_are_refused_or_end() -> None:
    """A call that is not in the tables (argument_values.py, number_tables.py) is told: "no call"."""
    outcomes = walk(tries(values=QUICK))
    complaints = {str(one): complaint(one, outcome) for one, outcome in outcomes.items()}
    assert {name: fault for name, fault in complaints.items() if fault} == {}
