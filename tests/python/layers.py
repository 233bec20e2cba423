"""The structure of the C++ tree as its includes tell it: modules, their rooms, and who includes whom."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterator
from graphlib import TopologicalSorter
from pathlib import Path, PurePosixPath

REPOSITORY = Path(__file__).resolve().parents[2]
LAYERS = tomllib.loads((REPOSITORY / "layers.toml").read_text())
MODULES: dict[str, list[str]] = LAYERS["modules"]
ROOMS: dict[str, dict[str, list[str]]] = LAYERS["rooms"]
SOURCE = REPOSITORY / "cpp" / "src"
PUBLIC = REPOSITORY / "cpp" / "include" / "mmgrasp"
INCLUDED = {".cpp", ".hpp", ".h", ".inc", ".inl", ".ipp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def includes(path: Path) -> list[tuple[str, str]]:
    """Bracket and name of every include of a file."""
    return INCLUDE.findall(path.read_text())


def files_of(module: str) -> Iterator[Path]:
    for root in (PUBLIC / module, SOURCE / module):
        yield from sorted(path for path in root.rglob("*") if path.suffix in INCLUDED)


def module_of(path: Path) -> str:
    root = PUBLIC if path.is_relative_to(PUBLIC) else SOURCE
    return path.relative_to(root).parts[0]


def target(name: str) -> Path | None:
    """The file of the tree that an include names, or nothing."""
    for path in (PUBLIC.parent / name, SOURCE / name):
        if path.is_file():
            return path
    return None


def room_of(path: Path) -> str:
    """Folder inside the module; of a public header the one of its source file, unless layers.toml says otherwise."""
    module = module_of(path)
    if path.is_relative_to(SOURCE):
        room = path.parent.relative_to(SOURCE / module).as_posix()
        return "" if room == "." else room
    stated: str | None = LAYERS["headers"].get(path.relative_to(PUBLIC).as_posix())
    if stated is not None:
        return stated
    sources = sorted((SOURCE / module).rglob(path.stem + ".cpp"))
    return room_of(sources[0]) if sources else ""


def edges_between_modules() -> set[tuple[str, str]]:
    return {
        (module, module_of(to))
        for module in MODULES
        for path in files_of(module)
        for _, name in includes(path)
        if (to := target(name)) and module_of(to) != module
    }


def edges_between_rooms(module: str) -> dict[tuple[str, str], list[str]]:
    """Pairs of rooms of a module, with the includes behind each."""
    edges: dict[tuple[str, str], list[str]] = {}
    for path in files_of(module):
        for _, name in includes(path):
            to = target(name)
            if to and module_of(to) == module and room_of(to) != room_of(path):
                edges.setdefault((room_of(path), room_of(to)), []).append(f"{path.relative_to(REPOSITORY)} -> {name}")
    return edges


def reduced(edges: set[tuple[str, str]]) -> set[tuple[str, str]]:
    """Without the edges that longer ways imply."""
    below: dict[str, set[str]] = {}
    for a, b in edges:
        below.setdefault(a, set()).add(b)

    TopologicalSorter(below).prepare()  # raises CycleError, which names a circle

    def reaches(a: str, b: str) -> bool:
        return any(c == b or reaches(c, b) for c in below.get(a, ()))

    return {(a, b) for a, b in edges if not any(c != b and reaches(c, b) for c in below[a])}


def architecture_page() -> str:
    """docs/architecture.md: what the includes say, as Mermaid diagrams."""

    def diagram(edges: set[tuple[str, str]], nodes: list[str], label: Callable[[str], str]) -> list[str]:
        key = {node: f"n{i}" for i, node in enumerate(nodes)}
        lines = ["```mermaid", "graph TD"]
        lines += [f'  {key[node]}["{label(node)}"]' for node in nodes]
        lines += [f"  {key[a]} --> {key[b]}" for a, b in sorted(reduced(edges))]
        return [*lines, "```", ""]

    page = [
        "# Architecture",
        "",
        "Written by `./dev architecture` from the includes of the C++ tree; a test fails when it is out of date. An arrow means",
        "*includes*; arrows that longer ways imply are left out. Who *may* include whom is [layers.toml](../layers.toml).",
        "",
        "## Modules",
        "",
        *diagram(edges_between_modules(), sorted(MODULES), str),
    ]
    for module in sorted(ROOMS):

        def name_of(room: str, module: str = module) -> str:
            return room or f"{module}/"

        page += [
            f"## Rooms of `{module}`",
            "",
            *diagram(set(edges_between_rooms(module)), sorted(ROOMS[module]), name_of),
            "| room | files | public headers |",
            "| --- | --- | --- |",
        ]
        files = list(files_of(module))
        for room in sorted(ROOMS[module]):
            inside = [path for path in files if room_of(path) == room]
            headers = [path.name for path in inside if path.is_relative_to(PUBLIC) and "detail" not in path.parts]
            page.append(
                f"| {f'`{room}`' if room else 'the module itself'} | {len(inside)} | {', '.join(f'`{h}`' for h in headers)} |"
            )
        page.append("")
    return "\n".join(page)


def is_private(path: Path) -> bool:
    return path.is_relative_to(SOURCE)


def is_detail(path: Path) -> bool:
    return "detail" in PurePosixPath(path.relative_to(PUBLIC.parent)).parts if path.is_relative_to(PUBLIC) else False


def write_architecture_page() -> None:
    (REPOSITORY / "docs" / "architecture.md").write_text(architecture_page())


if __name__ == "__main__":
    write_architecture_page()
