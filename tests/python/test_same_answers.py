"""benchmarks/same_answers.py: what counts as the same answer, and what its comparison says."""

from __future__ import annotations

import importlib.util
import json
import sys
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from conftest import REPOSITORY

SCRIPT = REPOSITORY / "benchmarks" / "same_answers.py"


@pytest.fixture(scope="module")
def script() -> Any:
    spec = importlib.util.spec_from_file_location("same_answers", SCRIPT)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class Old(Enum):
    solved = 0
    reach = 1


class New(Enum):
    solved = 0
    unreachable = 1


PATH = np.array([[0.1, 0.2], [0.3, 0.4]])


@pytest.mark.parametrize(
    ("a", "b"),
    [
        ({"cost": 1.5, "path": PATH}, {"way": PATH, "length": 1.5}),
        ([Old.reach, "text", 3], [New.unreachable, "another", np.int64(3)]),
        (PATH, np.asfortranarray(PATH)),
        ({"cost": 1.5, "seconds": 2.0}, {"cost": 1.5, "seconds": 3.0, "report": "words"}),
    ],
)
def test_other_names_are_the_same_answer(script: Any, a: object, b: object) -> None:
    assert script.digest(a) == script.digest(b)


@pytest.mark.parametrize(
    ("a", "b"),
    [
        (PATH, np.nextafter(PATH, 1)),
        (PATH, PATH.T),
        (PATH, PATH.ravel()),
        (1.0, np.nextafter(1.0, 2)),
        (0.0, -0.0),
        (1, 1.0),
        (True, False),
        ([1, 2], [2, 1]),
        ([[1], [2]], [[1, 2]]),
        ([None], []),
        (Old.solved, Old.reach),
        ({"cost": 1.5}, {"cost": 1.5, "grasp": 1}),
    ],
)
def test_other_numbers_are_another_answer(script: Any, a: object, b: object) -> None:
    assert script.digest(a) != script.digest(b)


def test_what_is_no_number_is_refused(script: Any) -> None:
    with pytest.raises(TypeError, match="object"):
        script.digest([object()])


def answers(**calls: object) -> dict[str, object]:
    return {"format": "mmgrasp-answers", "version": 1, "calls": calls}


def test_the_table_and_the_exit_code(
    script: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    one = {"sha256": "1", "parts": {"path": "p", "cost": "c"}, "shown": {"cost": 1.0}}
    other = {"sha256": "2", "parts": {"path": "q", "cost": "c"}, "shown": {"cost": 1.0}}
    failed, skipped = {"error": "InvalidInput: no"}, {"skipped": "no data"}

    def compared(a: dict[str, object], b: dict[str, object], *options: str) -> tuple[int, str]:
        files = [tmp_path / "a.json", tmp_path / "b.json"]
        for file, content in zip(files, (a, b), strict=True):
            file.write_text(json.dumps(content))
        monkeypatch.setattr(sys, "argv", ["same_answers.py", "--compare", *map(str, files), *options])
        return script.main(), capsys.readouterr().out

    assert compared(answers(x=one, y=skipped), answers(x=one, y=one))[0] == 0
    code, text = compared(answers(x=one, y=one), answers(x=one, y=other))
    assert code == 1 and "differs  in path" in text and "1 differs, 1 same" in text
    assert compared(answers(x=one, y=one), answers(x=one, y=other), "--only", "x")[0] == 0
    for a, b in ((failed, failed), (one, failed)):
        code, text = compared(answers(x=one, y=a), answers(x=one, y=b))
        assert code == 1 and "InvalidInput: no" in text
    code, text = compared(answers(x=one, y=one), answers(x=one))
    assert code == 1 and "only in the first" in text
    assert compared(answers(), answers())[0] == 1
    with pytest.raises(SystemExit, match="--write has written"):
        compared({"format": "another"}, answers(x=one))


def test_some_calls_repeat(
    script: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.syspath_prepend(str(SCRIPT.parent))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    names, file = ["forward_kinematics", "rrt_connect_omni", "prm_star_mg_bar"], tmp_path / "answers.json"
    monkeypatch.setattr(sys, "argv", ["same_answers.py", "--write", str(file), "--threads", "1", "--only", *names])
    assert script.main() == 0
    assert set(json.loads(file.read_text())["calls"]) == set(names)
    monkeypatch.setattr(sys, "argv", ["same_answers.py", "--against", str(file), "--threads", "2", "--only", *names])
    assert script.main() == 0
    assert "3 same" in capsys.readouterr().out
