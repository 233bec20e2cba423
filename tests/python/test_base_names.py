"""Columns of a moving base are x, y and theta: no joint of its arm may be called so."""

from __future__ import annotations

import pytest

import mmgrasp as mg

LIMIT = '<axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/>'


@pytest.mark.parametrize("name", ["x", "y", "theta"])
def test_joints_called_like_the_columns_of_a_base_are_refused(name: str) -> None:
    text = (
        '<robot name="r"><link name="a"/><link name="b"/>'
        f'<joint name="{name}" type="revolute"><parent link="a"/><child link="b"/>{LIMIT}</joint></robot>'
    )
    driving = mg.Robot.from_strings(text, base="diff_drive")
    with pytest.raises(mg.InvalidInput, match=f'joint "{name}" has the name of another column'):
        driving.group(base_link="a", tip="b", with_base=True)
    assert driving.group(base_link="a", tip="b").names == [name]
