"""Which bodies of a scenario may touch, and how far they are padded."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any, NoReturn

from .._core import Robot, World
from ..documents.reading import Node, near_miss


@dataclass(frozen=True)
class ContactRules:
    """The keys `allowed_collisions` and `padding` of a scenario."""

    allowed: list[tuple[str, str]] = field(default_factory=list)
    """Pairs of links, obstacles and parts; groups taken apart."""
    padding: dict[str, Any] = field(default_factory=dict)
    """As World.padding; empty: none."""

    def apply(self, world: World, without: Collection[str] = ()) -> None:
        """Tells the world, but for what is said of the names in `without`."""
        for a, b in self.allowed:
            if a not in without and b not in without:
                world.allow(a, b)
        if self.padding:
            named = {name: value for name, value in self.padding.get("by_name", {}).items() if name not in without}
            world.padding = {**self.padding, "by_name": named}

    def to_dict(self) -> dict[str, Any]:
        """What plan.json says of them: nothing when there are none."""
        out: dict[str, Any] = {}
        if self.allowed:
            out["allowed_collisions"] = [list(pair) for pair in self.allowed]
        if self.padding:
            out["padding"] = self.padding
        return out


def read_contact_rules(root: Node, robot: Robot, obstacles: list[str], parts: list[str]) -> ContactRules:
    """Reads both keys; every name must be a link or an SRDF group of the robot, an obstacle or a part."""
    groups = robot.groups
    known = [*robot.links, *groups, *obstacles, *parts]
    return ContactRules(_read_allowed(root, robot, known, [*obstacles, *parts]), _read_padding(root, known))


def _read_allowed(root: Node, robot: Robot, known: list[str], objects: list[str]) -> list[tuple[str, str]]:
    if "allowed_collisions" not in root:
        return []
    bodies = {name: {name} for name in (*robot.links, *objects)}
    for group, links in robot.group_links.items():
        bodies[group] = bodies.get(group, set()) | set(links)
    pairs, listed = set(), set()
    for node in root["allowed_collisions"].elements():
        names = node.elements()
        if len(names) != 2:
            node.fail("must be a pair of names")
        for name in names:
            if name.string() not in known:
                _unknown(name, name.raw, known)
        if (pair := frozenset(name.raw for name in names)) in listed:
            node.fail("is listed twice")
        listed.add(pair)
        pairs |= {(min(a, b), max(a, b)) for a in bodies[names[0].raw] for b in bodies[names[1].raw]}
    return sorted(pairs)


def _read_padding(root: Node, known: list[str]) -> dict[str, Any]:
    if "padding" not in root:
        return {}
    node = root["padding"]
    if not isinstance(node.raw, dict):
        return {"links": node.number(least=0)}
    node.mapping("", "links attached objects by_name")
    padding: dict[str, Any] = {
        key: node[key].number(least=0) for key in ("links", "attached", "objects") if key in node
    }
    if "by_name" in node:
        for name, value in node["by_name"].items():
            if name not in known:
                _unknown(value, name, known)
            padding.setdefault("by_name", {})[name] = value.number(least=0)
    return padding


def _unknown(node: Node, name: str, known: list[str]) -> NoReturn:
    node.fail(f"{name} is no link or group of the robot, obstacle or part{near_miss(name, known)}")
