"""Nobody includes whom they may not: the includes against layers.toml, and graphlib for the order."""

from __future__ import annotations

import re
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from layers import (
    INCLUDED,
    LAYERS,
    MODULES,
    PUBLIC,
    REPOSITORY,
    ROOMS,
    SOURCE,
    architecture_page,
    edges_between_rooms,
    files_of,
    includes,
    is_detail,
    is_private,
    module_of,
    room_of,
    target,
)

STANDARD = re.compile(r"[a-z_0-9]+|Eigen/\w+|unistd\.h")


def relative(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def test_layers_are_a_hierarchy() -> None:
    order = list(TopologicalSorter(MODULES).static_order())
    assert order[0] == "core"
    assert set(order) == set(MODULES)
    for rooms in ROOMS.values():
        assert set(TopologicalSorter(rooms).static_order()) == set(rooms)


def test_every_folder_is_a_module_or_a_room() -> None:
    folders = {path.relative_to(SOURCE).as_posix() for path in SOURCE.rglob("*") if path.is_dir()}
    files = {path.parent.relative_to(SOURCE).as_posix() for path in SOURCE.rglob("*") if path.suffix in INCLUDED}
    assert files <= folders
    known = {f"{module}/{room}".rstrip("/") for module, rooms in ROOMS.items() for room in rooms}
    assert {folder for folder in files if "/" in folder} <= known
    assert {folder.split("/")[0] for folder in folders} <= set(MODULES)


@pytest.mark.parametrize("module", sorted(MODULES))
def test_module_includes_only_what_it_may(module: str) -> None:
    allowed = {module, *MODULES[module]}
    wrong: list[str] = []
    for path in files_of(module):
        for _, name in includes(path):
            to = target(name)
            if to and module_of(to) not in allowed:
                wrong.append(f"{relative(path)} includes {name}")
            if to and module_of(to) != module and is_private(to):
                wrong.append(f"{relative(path)} includes {name}, a private header of another module")
            if not to and name.split("/")[0] in {"mmgrasp", *MODULES}:
                wrong.append(f"{relative(path)} includes {name}, which is not there")
    assert not wrong


@pytest.mark.parametrize("module", sorted(ROOMS))
def test_room_includes_only_what_it_may(module: str) -> None:
    assert {room_of(path) for path in files_of(module)} == set(ROOMS[module])
    wrong = [
        f"{room or module} -> {other or module}: {include}"
        for (room, other), behind in edges_between_rooms(module).items()
        if other not in ROOMS[module][room]
        for include in behind
    ]
    assert not wrong


@pytest.mark.parametrize("module", sorted(LAYERS["only"]))
def test_narrow_rules(module: str) -> None:
    rules = LAYERS["only"][module]
    limited = {rule.split("/")[0] for rule in rules}
    wrong: list[str] = []
    for path in files_of(module):
        for _, name in includes(path):
            short = name.removeprefix("mmgrasp/")
            if short.split("/")[0] in limited and "/" in short and short not in rules:
                wrong.append(f"{relative(path)} includes {name}")
    assert not wrong


def test_public_headers_need_std_and_eigen_only() -> None:
    wrong: list[str] = []
    for path in sorted(PUBLIC.rglob("*.hpp")):
        for bracket, name in includes(path):
            if not name.startswith("mmgrasp/") and (bracket == '"' or not STANDARD.fullmatch(name)):
                wrong.append(f"{relative(path)} includes {name}")
            if "/detail/" in name and not is_detail(path):
                wrong.append(f"{relative(path)} includes {name}, which is not installed")
    assert not wrong


def test_a_source_without_a_header_says_what_it_is() -> None:
    silent = []
    for path in sorted(SOURCE.rglob("*.cpp")):
        module = module_of(path)
        headers = (
            path.with_suffix(".hpp"),
            PUBLIC / module / f"{path.stem}.hpp",
            PUBLIC / module / "detail" / f"{path.stem}.hpp",
        )
        if not any(header.is_file() for header in headers) and not path.read_text().startswith("// "):
            silent.append(relative(path))
    assert not silent


def test_ompl_stays_in_its_plugin() -> None:
    wrong = [
        relative(path)
        for root in ("cpp", "python/bindings")
        for path in sorted((REPOSITORY / root).rglob("*"))
        if path.suffix in INCLUDED
        and "ompl_plugin" not in path.parts
        and any(name.startswith("ompl/") for _, name in includes(path))
    ]
    assert not wrong


def test_numbers_and_clocks_are_written_once() -> None:
    """Pi and infinity are in core/detail/numbers.hpp, clocks in stopwatch.hpp; public headers have the standard library alone."""
    again = re.compile(
        r"M_PI\b|3\.14159|numeric_limits<double>::infinity|__builtin_(inf|huge_val)\b|(steady|high_resolution)_clock::now"
    )
    once = {"numbers.hpp", "stopwatch.hpp"}
    wrong = [
        f"{relative(path)} says {found[0]}"
        for root in (SOURCE, REPOSITORY / "python/bindings", PUBLIC)
        for path in sorted(root.rglob("*"))
        if path.suffix in INCLUDED and path.name not in once and (root != PUBLIC or is_detail(path))
        if (found := again.search(path.read_text()))
    ]
    assert not wrong


def test_architecture_page_is_what_the_includes_say() -> None:
    page = (REPOSITORY / "docs" / "architecture.md").read_text()
    assert page == architecture_page(), "out of date: ./dev architecture"
