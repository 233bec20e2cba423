"""Nobody includes whom they may not: an include regex against layers.toml, and graphlib for the order."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from conftest import REPOSITORY

LAYERS = tomllib.loads((REPOSITORY / "layers.toml").read_text())
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
STANDARD = re.compile(r"[a-z_0-9]+|Eigen/\w+|unistd\.h")


def files(*patterns: str) -> Iterator[Path]:
    for pattern in patterns:
        yield from sorted(REPOSITORY.glob(pattern))


def includes(path: Path) -> list[tuple[str, str]]:
    return INCLUDE.findall(path.read_text())


def test_layers_are_a_hierarchy() -> None:
    order = list(TopologicalSorter(LAYERS["modules"]).static_order())
    assert order[0] == "core"
    assert set(order) == set(LAYERS["modules"])


@pytest.mark.parametrize("module", sorted(LAYERS["modules"]))
def test_module_includes_only_what_it_may(module: str) -> None:
    allowed = {module, *LAYERS["modules"][module]}
    wrong = []
    for path in files(f"cpp/include/mmgrasp/{module}/**/*.hpp", f"cpp/src/{module}/**/*.[ch]pp"):
        for _, name in includes(path):
            parts = name.removeprefix("mmgrasp/").split("/")
            if len(parts) > 1 and parts[0] in LAYERS["modules"] and parts[0] not in allowed:
                wrong.append(f"{path.relative_to(REPOSITORY)} includes {name}")
    assert not wrong


@pytest.mark.parametrize("module", sorted(LAYERS["only"]))
def test_narrow_rules(module: str) -> None:
    rules = LAYERS["only"][module]
    limited = {rule.split("/")[0] for rule in rules}
    wrong = []
    for path in files(f"cpp/include/mmgrasp/{module}/**/*.hpp", f"cpp/src/{module}/**/*.[ch]pp"):
        for _, name in includes(path):
            short = name.removeprefix("mmgrasp/")
            if short.split("/")[0] in limited and "/" in short and short not in rules:
                wrong.append(f"{path.relative_to(REPOSITORY)} includes {name}")
    assert not wrong


def test_public_headers_need_std_and_eigen_only() -> None:
    wrong = []
    for path in files("cpp/include/**/*.hpp"):
        for bracket, name in includes(path):
            if not name.startswith("mmgrasp/") and (bracket == '"' or not STANDARD.fullmatch(name)):
                wrong.append(f"{path.relative_to(REPOSITORY)} includes {name}")
    assert not wrong


def test_ompl_stays_in_its_plugin() -> None:
    wrong = [
        str(path.relative_to(REPOSITORY))
        for path in files("cpp/**/*.[ch]pp", "python/bindings/*.[ch]pp")
        if "ompl_plugin" not in path.parts and any(name.startswith("ompl/") for _, name in includes(path))
    ]
    assert not wrong
