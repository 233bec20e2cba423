"""`./dev hostile` runs what is there: its parts name files and scripts that exist, each file once."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

import hostile
from hostile import HERE, PARTS, files


def test_parts_name_what_is_there() -> None:
    named = [file for part in PARTS.values() for file in files(part)]
    assert len(named) == len(set(named)) > 25
    assert [file for file in named if not Path(file).exists()] == []
    scripts = [words.split()[0] for part in PARTS.values() for words in part.night if not words.startswith("./")]
    assert [script for script in scripts if not (HERE / script).exists()] == []


def test_every_table_of_bad_inputs_is_in_a_part() -> None:
    """Those are meant whose names say that they fuzz, break or refuse."""
    words = ("fuzz", "bad_", "odd_", "arguments", "mutations", "limits", "interrupt", "_doors", "refusals", "places")
    found = {str(f) for f in HERE.glob("test_*.py") if any(word in f.name for word in words)}
    assert found - {file for part in PARTS.values() for file in files(part)} == set()


def test_unknown_parts_are_told() -> None:
    done = subprocess.run([sys.executable, str(HERE / "hostile.py"), "nothing"], capture_output=True, text=True)
    assert done.returncode == 2 and "no part nothing; there are texts, " in done.stderr


@pytest.fixture
def own_record(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """One part with one search, a page of its own, and nothing on record."""
    for name, content in (
        ("hostile.md", f"before\n{hostile.BEGIN}\nold\n{hostile.END}\nafter\n"),
        ("record.json", "{}"),
    ):
        (tmp_path / name).write_text(content)
    monkeypatch.setattr(hostile, "KEPT", tmp_path)
    monkeypatch.setattr(hostile, "PAGE", tmp_path / "hostile.md")
    monkeypatch.setattr(hostile, "RECORD", tmp_path / "record.json")
    monkeypatch.setattr(hostile, "PARTS", {"texts": hostile.Part("Texts", "yaml_text", (str(tmp_path / "search.py"),))})
    return tmp_path


def test_tries_of_a_search_are_counted_and_written(own_record: Path) -> None:
    search = own_record / "search.py"
    search.write_text("print('1200 tries: 3 read'); print('no tries here')")
    good, _, tries = hostile.run_search(str(search))
    hostile.keep("texts", "tests", 34, True)
    hostile.keep("texts", str(search), tries, good)
    hostile.write()
    text = (own_record / "hostile.md").read_text()
    assert "1,200 | nothing" in text and "1,234 tries in all." in text and "old" not in text
    assert "not run yet" not in text
    assert text.startswith("before\n") and text.endswith("after\n")


@pytest.mark.parametrize(("script", "expected"), [
    ("print('3 tries: 1 complaints'); raise SystemExit(1)", (False, 3)),
    ("print('nothing is said of tries')", (False, 0)),
    ("print('0 tries: 0 complaints')", (False, 0)),
    ("print('1 tries: 0 complaints (a)'); print('2 tries: 0 complaints (b)')", (True, 3)),
])  # fmt: skip
def test_a_search_that_found_something_or_tried_nothing_has_failed(
    own_record: Path, script: str, expected: tuple[bool, int]
) -> None:
    (own_record / "search.py").write_text(script)
    lines, failed = hostile.search_all(["texts"])
    assert (failed == [], json.loads(hostile.RECORD.read_text()).popitem()[1]["tries"]) == expected
    assert lines[0].endswith("FAILED") is bool(failed)


def test_runs_without_a_record_are_listed(own_record: Path) -> None:
    hostile.keep("texts", "tests", 34, False)
    text = hostile.table()
    assert "| Texts | `tests` | 34 | something |" in text
    assert "search.py` | - | not run yet | - |" in text
    assert "34 tries in all." in text


REPORT = """<testsuites><testsuite>
<testcase classname="tests.python.test_numbers" name="a" time="1.5"/>
<testcase classname="tests.python.test_numbers" name="b" time="0.5"><skipped message="not here"/></testcase>
<testcase classname="tests.python.test_yaml_text.TestOfAll" name="c" time="2"><failure>x</failure></testcase>
<testcase classname="" name="tests.python.test_key_fuzz" time="0"><error>x</error></testcase>
</testsuite></testsuites>"""


def test_skipped_tests_are_no_tries_and_failures_stay_with_their_part(tmp_path: Path) -> None:
    (tmp_path / "report.xml").write_text(REPORT)
    found = hostile.count_tests(tmp_path / "report.xml", ["calls", "texts", "frames"])
    assert found == {
        "calls": hostile.Tests(2.0, 1, 0),
        "texts": hostile.Tests(2.0, 2, 2),
        "frames": hostile.Tests(0.0, 0, 0),
    }


def test_a_quick_size_that_takes_long_is_told() -> None:
    assert "MORE THAN 60 s" in hostile.quick_size(61.0)
    assert "MORE THAN" not in hostile.quick_size(59.0)


LIBFUZZER = """INFO: seed corpus: files: 12
#13	INITED cov: 160 ft: 161 corp: 1/1b exec/s: 0 rss: 27Mb
#524288	pulse  cov: 160 ft: 161 corp: 1/1b exec/s: 174762 rss: 27Mb
"""


@pytest.mark.parametrize(("log", "tries"), [
    (LIBFUZZER + "stat::number_of_executed_units: 817243\nstat::peak_rss_mb: 30\n", 817243),
    (LIBFUZZER, 524288),
    ("cannot start\n", 0),
])  # fmt: skip
def test_the_fuzzers_of_the_readers_say_how_many_files_they_tried(tmp_path: Path, log: str, tries: int) -> None:
    (tmp_path / "urdf.log").write_text(log)
    script = (hostile.REPOSITORY / "dev").read_text()
    function = script[script.index("tries_of() {") : script.index("\n}\n", script.index("tries_of() {")) + 3]
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", function + 'tries_of "$@"', "dev", str(tmp_path / "urdf.log"), "urdf", "0"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == f"{tries} tries: 0 complaints (urdf)\n"
    assert script.count('tries_of "build/fuzz/$format.log" "$format"') == 1
