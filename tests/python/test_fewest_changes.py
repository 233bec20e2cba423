"""Grippers and changes of random assemblies beside the optimum of an integer programme, which HiGHS solved (scipy 1.17.1).

Least sum of changes; a part is taken by one gripper that is there, and as many grippers are there as the least set has.
"""

from __future__ import annotations

import pytest

from mmgrasp import Outcome
from mmgrasp.gripper_design import GripperActuator, minimal_grippers
from mmgrasp.reproduce.gripper_sets import random_assembly


@pytest.mark.parametrize(
    ("parts", "stroke", "grippers", "changes"),
    [(100, 0.008, 20, 72), (200, 0.008, 25, 150), (200, 0.024, 12, 113), (200, 0.048, 7, 91)],
)
def test_changes_are_the_fewest(parts: int, stroke: float, grippers: int, changes: int) -> None:
    drives = [GripperActuator("jaws", stroke), GripperActuator("centric", stroke, fingers=3)]
    found = minimal_grippers(random_assembly(parts, 0), drives)
    assert found.outcome == Outcome.solved
    assert (len(found.grippers), found.changes, found.changes_bound) == (grippers, changes, changes)
