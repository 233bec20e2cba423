"""What outsiders broke first stays mended: each of their rows (A1, A2, ...) has tests, which hostile_rows.json names.

An entry is a file, `file::test`, `file.cpp::Suite.Test`, each with `: words` behind it that the file must hold (the
case among the parameters).
"""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import pytest

from conftest import REPOSITORY

ROWS: dict[str, list[str]] = json.loads((Path(__file__).parent / "hostile_rows.json").read_text())
FIRST_ROWS = REPOSITORY.parent / "shared" / "audits" / "abuse.md"


@cache
def text_of(file: str) -> str:
    (path,) = (REPOSITORY / "tests").rglob(file)
    return path.read_text()


def missing(entry: str) -> str:
    """What of an entry is not there; empty when all is."""
    where, _, words = entry.partition(": ")
    file, _, test = where.partition("::")
    text = text_of(file)
    if file.endswith(".cpp"):
        suite, _, name = test.partition(".")
        begins = rf"^TEST(_F|_P)?\({suite}, {name}\)" if test else ""
    else:
        begins = rf"^def {test}\(" if test else r"^def test_"
    if not re.search(begins, text, re.MULTILINE):
        return f"{entry}: no such test"
    return "" if words in text else f"{entry}: no such words"


@pytest.mark.parametrize("row", ROWS)
def test_the_tests_of_each_row_are_there(row: str) -> None:
    assert ROWS[row]
    assert [said for said in map(missing, ROWS[row]) if said] == []


def test_what_is_not_there_is_found() -> None:
    assert missing("test_hostile_rows.py::test_of_nothing")
    assert missing("test_hostile_rows.py::missing: " + "no such " * 3)
    assert missing("test_file_copy.cpp::FileCopy.Nothing")


def test_every_row_has_tests() -> None:
    if not FIRST_ROWS.exists():
        pytest.skip("the report with the rows is not beside this copy")
    text = FIRST_ROWS.read_text().partition("\n## A")[2]
    found = set(re.findall(r"(?:^|[.] )([A-F][1-9]\d?) ", text, re.MULTILINE))
    assert len(found) > 40
    assert found == ROWS.keys()
