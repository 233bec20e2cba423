"""The section `structure` of a pipe problem: nodes, sections, materials and what hangs on the nodes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeVar

from .._core import BeamFrame, BeamMaterial, BeamMember, InvalidInput, NodeLoad, Pipe, copper, round_section
from ..documents.reading import Node, near_miss

STIFFEST = 1e13  # no modulus and no stress in a file is larger [Pa]
SOFTEST = 1e3  # nor smaller: what is less was not given in Pa
LONGEST = 100.0  # no arm carries a pipe that spans more [m]
SHARED = "outer_diameter inner_diameter material"
_Made = TypeVar("_Made")


def read_structure(node: Node, stress_limit: float = 0.0) -> tuple[Pipe, BeamFrame]:
    """The pipe and the frame that it is: member i is section i. `stress_limit` [Pa] holds for every material that states no lower one; 0: none."""
    node.mapping("nodes sections", SHARED + " materials loads")
    materials = _read_materials(node, stress_limit)
    nodes = [element.numbers(3) for element in node["nodes"].elements()]
    if not nodes:
        node["nodes"].fail("must not be empty")
    span = max((max(values) - min(values) for values in zip(*nodes, strict=True)), default=0.0)
    if span > LONGEST:
        node["nodes"].fail(f"span {span:g} m, must be at most {LONGEST:g} m: coordinates are in metres")
    pairs, diameters, members = [], [], []
    for element in node["sections"].elements():
        element.mapping("nodes", SHARED)
        ends = [end.integer(least=0) for end in element["nodes"].elements()]
        if len(ends) != 2:
            element["nodes"].fail("must be two nodes, counted from 0")
        for i, end in enumerate(ends):
            if end >= len(nodes):
                element["nodes"].elements()[i].fail(f"there is no such node, only 0 to {len(nodes) - 1}")
        outer_node = _shared(element, node, "outer_diameter")
        inner_node = _shared(element, node, "inner_diameter")
        outer = _need(outer_node, element, "outer_diameter").number(above=0)
        inner = inner_node.number(least=0) if inner_node is not None else 0.0
        if inner_node is not None and inner >= outer:
            inner_node.fail(f"must be less than the outer diameter, {outer:g} m")
        name = _need(_shared(element, node, "material"), element, "material")
        if name.string() not in materials:
            name.fail(f"no such material{near_miss(name.raw, list(materials))}")
        pairs.append((ends[0], ends[1]))
        diameters.append(outer)
        section = _made(element, partial(round_section, outer, inner))
        members.append(BeamMember(ends[0], ends[1], section, materials[name.raw]))
    if not pairs:
        node["sections"].fail("must not be empty")
    pipe = _made(node, lambda: Pipe(nodes, pairs, diameters))
    loads = [_read_load(element, len(nodes)) for element in node["loads"].elements()] if "loads" in node else []
    return pipe, _made(node, lambda: BeamFrame(nodes, members, loads))


def _made(node: Node, make: Callable[[], _Made]) -> _Made:
    """What the library says of a value, with the place in the file."""
    with node.blamed():
        return make()


def _shared(element: Node, structure: Node, key: str) -> Node | None:
    """A section's own value, or the one that the structure gives for all."""
    return element[key] if key in element else structure[key] if key in structure else None


def _need(node: Node | None, element: Node, key: str) -> Node:
    if node is None:
        raise InvalidInput(f"{element.place}: {element.name}: {key} is missing, here and for the whole structure")
    return node


def _read_materials(node: Node, stress_limit: float) -> dict[str, BeamMaterial]:
    def limited(own: float) -> float:
        return min(own, stress_limit) if own > 0 and stress_limit > 0 else max(own, stress_limit)

    metal = copper()
    materials = {
        "copper": BeamMaterial(metal.density, metal.youngs_modulus, metal.shear_modulus, limited(metal.stress_limit))
    }
    for name, given in node["materials"].items() if "materials" in node else []:
        given.mapping("density youngs_modulus shear_modulus", "stress_limit")
        if name in materials:
            given.fail("is the copper of P2 table 3.4, which needs no entry; call another one otherwise")
        own = pressure(given["stress_limit"]) if "stress_limit" in given else 0.0
        materials[name] = BeamMaterial(
            given["density"].number(least=0),
            pressure(given["youngs_modulus"]),
            pressure(given["shear_modulus"]),
            limited(own),
        )
    return materials


def pressure(node: Node) -> float:
    """A modulus or a stress [Pa]."""
    value = node.number(above=0, most=STIFFEST)
    if value < SOFTEST:
        node.fail(f"must be at least {SOFTEST:g}: it is in Pa (1 MPa is 1.0e6, 1 GPa is 1.0e9)")
    return value


def _read_load(node: Node, nodes: int) -> NodeLoad:
    node.mapping("node", "mass force moment")
    if node["node"].integer(least=0) >= nodes:
        node["node"].fail(f"there is no such node, only 0 to {nodes - 1}")
    if not {"mass", "force", "moment"} & node.raw.keys():
        node.fail("must have a mass, a force or a moment")
    mass = node["mass"].number(least=0) if "mass" in node else 0.0
    force, moment = (node[key].numbers(3) if key in node else [0.0, 0.0, 0.0] for key in ("force", "moment"))
    return NodeLoad(node["node"].integer(), mass, force, moment)
