"""Stored results and the sources they were made from: what is older than its sources is named on the page."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

from conftest import REPOSITORY
from mmgrasp.reproduce import ENTRIES
from mmgrasp.reproduce.page import STALE, store, write_page
from mmgrasp.reproduce.sources import SOURCES, sources_hash, stale_results

DOCS = REPOSITORY / "docs"


def test_the_page_names_every_stale_result_of_these_chapters() -> None:
    """`./dev reproduce NAME` makes one again; `mmgrasp.reproduce.page.write_page(Path("docs"))` writes the page from what is stored."""
    stale = stale_results(DOCS / "reproduction", REPOSITORY)
    page = (DOCS / "reproduction.md").read_text()
    reported = re.search(rf"^{STALE}: (.*)\.$", page, re.MULTILINE)
    assert (reported.group(1).split(", ") if reported else []) == stale
    assert page.count(f"*{STALE}.*") == len(stale)
    assert {n for n in ENTRIES if n.startswith(("p1-figure-4.", "p1-figure-5.", "p3-figure-4.", "p3-table-4."))} <= set(
        SOURCES
    )


def test_sources_are_there() -> None:
    """Files that exist and folders that hold sources are named: what was moved would no longer count."""
    for place in {place for places in SOURCES.values() for place in places}:
        path = REPOSITORY / place
        assert path.is_file() or any(p.suffix in (".cpp", ".hpp", ".py") for p in path.rglob("*")), place


def test_a_changed_source_makes_its_results_stale_and_no_others(tmp_path: Path) -> None:
    for place in {place for places in SOURCES.values() for place in places} | {"layers.toml"}:
        source, target = REPOSITORY / place, tmp_path / place
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, dirs_exist_ok=True)
        else:
            shutil.copyfile(source, target)
    docs = tmp_path / "docs"
    for name in ("p1-figure-4.4", "p1-figure-4.9", "p3-figure-4.6", "p3-table-4.1"):
        store(json.loads((DOCS / "reproduction" / f"{name}.json").read_text()), docs)
    assert stale_results(docs / "reproduction", tmp_path) == []
    assert STALE not in (docs / "reproduction.md").read_text()
    before = sources_hash("p1-figure-4.4", tmp_path)
    with (tmp_path / "cpp/src/trajopt/terms.cpp").open("a") as file:
        file.write("// changed\n")
    assert sources_hash("p1-figure-4.4", tmp_path) != before
    assert stale_results(docs / "reproduction", tmp_path) == ["p1-figure-4.4"]
    with (tmp_path / "cpp/src/grasp/synthesis/map_surface.cpp").open("a") as file:
        file.write("// changed\n")
    assert stale_results(docs / "reproduction", tmp_path) == ["p1-figure-4.4", "p3-table-4.1"]
    page = write_page(docs).read_text()
    assert f"{STALE}: p1-figure-4.4, p3-table-4.1.\n" in page
    assert page.count(f"*{STALE}.*") == 2
    assert sources_hash("p1-figure-4.4", tmp_path / "docs") is None  # no repository: nothing is said
