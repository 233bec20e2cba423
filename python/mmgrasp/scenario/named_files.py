"""Files that a document names: beside it, shipped, of a package of robots, or a profile by its name."""

from __future__ import annotations

import importlib.util
from pathlib import Path

from .._core import InvalidInput
from .._files import ASSETS, shipped
from ..documents.reading import RENAMED, Node, near_miss, read_yaml


def find_file(node: Node) -> Path:
    """A path relative to its file, `asset:...` in the shipped assets, or `robot-data:...` in example-robot-data."""
    text = node.string()
    if text.startswith("asset:"):
        path = shipped(text)
    elif text.startswith("robot-data:"):
        path = robot_data_folder(node) / text.removeprefix("robot-data:")
    else:
        try:
            path = Path(node.document.source).parent / Path(text).expanduser()
        except RuntimeError:
            node.fail("no such file: the user's home folder is not known")
    try:
        found = path.exists()
    except (OSError, ValueError):  # too long, or no name at all
        found = False
    if not found:
        node.fail(f"no such file ({path})")
    return path


def robot_data_folder(node: Node) -> Path:
    """Where the optional package example-robot-data keeps its robots."""
    spec = importlib.util.find_spec("cmeel")
    for folder in [Path(p) for p in (spec.submodule_search_locations or [])] if spec else []:
        data = folder.parent / "cmeel.prefix" / "share" / "example-robot-data"
        if data.is_dir():
            return data
    node.fail("needs the robots of example-robot-data: pip install 'mmgrasp[robots]'")


def profile_path(name: str, folders: tuple[str, ...] = ("robots",)) -> Path:
    """A robot profile by name (one shipped in these folders of the assets) or by path."""
    path = Path(name)
    if path.suffix in (".yaml", ".yml"):
        return path
    shipped_ones = [p for folder in folders for p in (ASSETS / folder).glob("*/*.yaml") if p.stem == p.parent.name]
    known = {p.stem: p for p in sorted(shipped_ones)}
    if name not in known:
        what = "robot" if folders == ("robots",) else "robot or gripper"
        raise InvalidInput(f"{what} name = {name!r}: no such {what}{near_miss(name, list(known))}")
    return known[name]


def find_profile(node: Node, folders: tuple[str, ...] = ("robots",)) -> Path:
    """The profile that a file names: by the name of one shipped in these folders, or by a path as in find_file()."""
    name = node.string()
    with node.blamed():
        return find_file(node) if name.endswith((".yaml", ".yml")) else profile_path(name, folders)


def read_profile(path: Path) -> Node:
    """The top of a robot profile, its header and keys checked."""
    return check_profile(read_yaml(path).root)


def check_profile(profile: Node) -> Node:
    """The same, once its header and keys are those of a robot profile."""
    profile["format"].choice("mmgrasp-robot")
    profile.read_version(3, RENAMED)
    return profile.mapping("format version robot gripper", "place_region")
