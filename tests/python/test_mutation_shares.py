"""Answers about changed documents are those of one code, and each document is counted once. (`mutation_shares.py` by
itself judges all.)"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import mutation_shares
from field_changes import all_changes
from mutation_shares import Count, Document, all_together, changes_key, main, package_files, results, run

PLAN: dict[str, Any] = {"a": 1.5, "scenario": {"b": "x"}}
SCENARIO: dict[str, Any] = {"c": [1, 2]}
CHANGES = sum(len(list(all_changes(document, 4))) for document in (PLAN, SCENARIO))
FOREVER = 1e6  # [min]


@pytest.fixture
def judged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Two small documents, and what is judged of them."""
    asked: list[Any] = []

    def documents(folder: Path) -> Iterator[Document]:
        def plan(values: dict[str, Any]) -> dict[str, bool]:
            asked.append(values)
            return {"alone": values != PLAN, "beside": values != PLAN}

        def scenario(values: dict[str, Any]) -> dict[str, bool]:
            asked.append(values)
            return {"scenario": values != SCENARIO}

        yield Document("plan", PLAN, plan)
        yield Document("scenario", SCENARIO, scenario)

    monkeypatch.setattr(mutation_shares, "FOLDER", tmp_path)
    monkeypatch.setattr(mutation_shares, "documents", documents)
    monkeypatch.setattr(mutation_shares, "code_key", lambda: "one code")
    return asked


def test_each_changed_document_is_counted_once(judged: list[Any]) -> None:
    count = run(4, FOREVER)
    assert count == Count(CHANGES, 0, True)
    assert len(judged) == CHANGES + 2  # and both as they are
    assert str(count).startswith(f"{CHANGES} tries: changed documents judged now")
    assert sum(len(results(case, 4)) for case in ("alone", "stored", "scenario")) == CHANGES
    assert all_together(4) == (CHANGES, CHANGES)


def leave_first(count: int) -> None:
    """As a run that was ended early leaves the plan's answers."""
    file = mutation_shares.answers_file("plan", 4)
    file.write_text("".join(file.read_text().splitlines(keepends=True)[: 1 + count]))


def test_a_run_that_was_ended_goes_on(judged: list[Any]) -> None:
    run(4, FOREVER)
    answers = results("beside", 4)
    leave_first(7)
    judged.clear()
    again = run(4, FOREVER)
    plan_changes = len(list(all_changes(PLAN, 4)))
    assert again == Count(plan_changes - 7, CHANGES - plan_changes + 7, True)
    assert len(judged) == plan_changes - 7
    assert results("beside", 4) == answers
    assert f"{plan_changes - 7} tries" in str(again) and "in earlier runs" in str(again)


def test_other_code_begins_anew(judged: list[Any], monkeypatch: pytest.MonkeyPatch) -> None:
    run(4, FOREVER)
    leave_first(7)
    monkeypatch.setattr(mutation_shares, "code_key", lambda: "other code")
    assert run(4, FOREVER) == Count(CHANGES, 0, True)


def test_what_came_to_its_end_begins_anew(judged: list[Any]) -> None:
    run(4, FOREVER)
    assert run(4, FOREVER) == Count(CHANGES, 0, True)


def test_a_document_that_is_refused_as_it_is_tells_nothing(judged: list[Any], monkeypatch: pytest.MonkeyPatch) -> None:
    refused = Document("plan", PLAN, lambda values: {"alone": True, "beside": True})
    monkeypatch.setattr(mutation_shares, "documents", lambda folder: [refused])
    with pytest.raises(AssertionError, match="the plan as it was made is refused"):
        run(4, FOREVER)


def test_time_that_is_over_is_told(judged: list[Any], capsys: pytest.CaptureFixture[str]) -> None:
    assert run(4, -1.0) == Count(0, 0, False)
    assert "plan: 0 of " in capsys.readouterr().out


def test_keys_differ_with_code_document_and_changes() -> None:
    changes = list(all_changes(PLAN, 4))
    keys = {
        changes_key("a", PLAN, changes),
        changes_key("b", PLAN, changes),
        changes_key("a", {**PLAN, "a": 1.6}, changes),
        changes_key("a", PLAN, changes[:-1]),
        changes_key("a", PLAN, changes[::-1]),
    }
    assert len(keys) == 5


def test_the_code_is_all_that_answers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    names = [path.name for path in package_files()]
    assert {"verification.py", "consistency.py", "plan.schema.json"} <= set(names)
    assert any(name.startswith("_core.") for name in names) and any(name.startswith("libmmgrasp.") for name in names)
    file = tmp_path / "verification.py"
    monkeypatch.setattr(mutation_shares, "package_files", lambda: [file])
    keys = set()
    for text in ("a", "b"):
        file.write_text(text)
        keys.add(mutation_shares.code_key())
    assert len(keys) == 2


def test_answers_of_other_code_are_not_written(
    judged: list[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = tmp_path / "verify.md"
    page.write_text(f"before\n{mutation_shares.BEGIN}\nold\n{mutation_shares.END}\nafter\n")
    monkeypatch.setattr(mutation_shares, "PAGE", page)
    monkeypatch.setattr("sys.argv", ["mutation_shares.py", "--write"])
    assert main() == 2, "nothing was run"
    run(4, FOREVER)
    assert main() == 0
    assert "old" not in page.read_text() and f"{CHANGES} of {CHANGES}" in page.read_text()
    monkeypatch.setattr(mutation_shares, "code_key", lambda: "other code")
    assert main() == 2
    first = json.loads(mutation_shares.answers_file("plan", 4).read_text().splitlines()[0])
    assert first["code"] == "one code"


def test_the_last_line_counts(
    judged: list[Any], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["mutation_shares.py"])
    assert main() == 1, "reasons that nothing needs"
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith(f"{CHANGES} tries: ") and " complaints" in last and not last.endswith(" 0 complaints")
