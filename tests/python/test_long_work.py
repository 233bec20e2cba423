"""Work without a time limit or a report of its own hears Ctrl-C wherever it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from long_work import REACTION_CAP, WORK, reactions


@pytest.mark.slow
@pytest.mark.parametrize("name", WORK)
def test_work_is_ended_by_ctrl_c(name: str, tmp_path: Path) -> None:
    found = reactions(name, tmp_path)
    assert [how for _, how, _ in found] == ["interrupted"] * len(WORK[name].moments), found
    assert max(reaction for *_, reaction in found) < REACTION_CAP, found
