"""Everything public of the package's own Python has a docstring: modules, classes, functions, methods and properties."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import mmgrasp as mg

PACKAGE = Path(mg.__file__).parent
TOOLS = ("reproduce",)  # one module a table: `run` and `draw`, said once in reproduce.entry


def entries(body: list[ast.stmt], within: str = "") -> Iterator[tuple[str, bool]]:
    """Name, and whether it says what it is."""
    for node in body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or node.name.startswith("_"):
            continue
        marks = {ast.unparse(decorator).rpartition(".")[2] for decorator in node.decorator_list}
        if not marks & {"setter", "overload"}:
            yield within + node.name, ast.get_docstring(node) is not None
        if isinstance(node, ast.ClassDef):
            yield from entries(node.body, f"{within}{node.name}.")


def test_everything_public_of_the_package_is_documented() -> None:
    found: dict[str, bool] = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        place = path.relative_to(PACKAGE)
        if place.parts[0] in TOOLS or (path.name.startswith("_") and path.name != "__init__.py"):
            continue
        tree = ast.parse(path.read_text())
        found[str(place)] = ast.get_docstring(tree) is not None
        found |= {f"{place}: {name}": said for name, said in entries(tree.body)}
    assert len(found) > 500
    assert [name for name, said in found.items() if not said] == []
