"""The tutorials do what they say: their blocks are run as they stand, one after the other, in an empty folder."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image, ImageSequence

from conftest import REPOSITORY
from mmgrasp.part_supply import read_plan

TUTORIAL = REPOSITORY / "docs" / "tutorials" / "your_robot_your_room.md"
TIAGO = "robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"


def blocks(page: Path) -> list[tuple[str, str]]:
    """(language, text) of the fenced blocks above the page's second section."""
    walk = page.read_text().split("\n## ")[1]
    return re.findall(r"```(sh|python)\n(.*?)```", walk, re.S)


@pytest.mark.slow
def test_your_robot_your_room(data: Path, tmp_path: Path) -> None:
    environment = os.environ | {
        "ROBOT": str(data / TIAGO),
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }
    found = blocks(TUTORIAL)
    assert [language for language, _ in found] == ["sh", "python", "sh", "sh"]
    said = ""
    for language, text in found:
        command = ["bash", "-euo", "pipefail", "-c", text] if language == "sh" else [sys.executable, "-c", text]
        done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=900)
        assert done.returncode == 0, done.stdout + done.stderr
        said += done.stdout
    assert "base diff_drive" in said and "a hand: no fingers were found at arm_7_link" in said
    assert "the plan holds" in said
    plan = read_plan(tmp_path / "out" / "plan.json")
    assert plan["outcome"] == "solved" and len(plan["picks"]) == 6 + 4
    assert plan["scenario"]["trays"][1]["roof"] == 0.4
    assert any(len(obstacle["shapes"]) > 4 for obstacle in plan["scenario"]["obstacles"])  # the map's walls and pillar
    with Image.open(tmp_path / "round.gif") as film:
        frames = [frame.convert("RGB").tobytes() for frame in ImageSequence.Iterator(film)]
    assert len(set(frames)) > 100
