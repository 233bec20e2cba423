"""The sections `preferences` and `limits` of a pipe problem: what counts how much, and what may not be exceeded."""

from __future__ import annotations

from dataclasses import dataclass

from .._core import pairwise_weights
from ..documents.reading import Node
from .structure_section import pressure

OBJECTIVES = ("motion", "deflection", "manipulability")
"""Joint motion (O1), sag (O2), force manipulability (O3) of P2 3.2.3.3, in this order in comparison matrices, too."""

NAMED_WEIGHTS = {"p2": (0.587, 0.089, 0.324), "p2_printed": (0.56, 0.12, 0.32)}
"""Weights of P2's comparison matrix by P2's method (the default), and those that P2 prints for it, which belong to another matrix."""


@dataclass(frozen=True)
class Preferences:
    """Options of the search, and where they come from."""

    options: dict[str, float]
    """Weights and scales as ObjectPathOptions calls them; empty: the library's own."""
    source: str = "P2's comparison matrix, the default"
    consistency_ratio: float | None = None
    """Consistency ratio of the comparison matrix, when one was given."""


def read_preferences(root: Node) -> Preferences:
    """Weights, or a comparison matrix by Saaty's method, and the scales of the three objectives."""
    if "preferences" not in root:
        return Preferences({})
    node = root["preferences"].mapping("", "weights comparison scales")
    if "weights" in node and "comparison" in node:
        node.fail("give weights or a comparison, not both")
    options: dict[str, float] = {}
    ratio, source = None, Preferences.source
    if "weights" in node:
        options = _read_weights(node["weights"])
        source = f"weights {node['weights'].raw}" if isinstance(node["weights"].raw, str) else "weights given"
    if "comparison" in node:
        rows = node["comparison"].elements()
        if len(rows) != len(OBJECTIVES):
            node["comparison"].fail("must be three rows: " + ", ".join(OBJECTIVES))
        matrix = [row.numbers(len(OBJECTIVES), above=0) for row in rows]
        with node["comparison"].blamed():
            found = pairwise_weights(matrix)
        options = {f"{key}_weight": float(w) for key, w in zip(OBJECTIVES, found.weights, strict=True)}
        ratio = float(found.consistency_ratio)
        source = "comparison matrix given"
    if "scales" in node:
        scales = node["scales"].mapping("", " ".join(OBJECTIVES))
        options |= {f"{key}_scale": value.number(above=0) for key, value in scales.items()}
    return Preferences(options, source, ratio)


def _read_weights(node: Node) -> dict[str, float]:
    """A name of NAMED_WEIGHTS, or a number for each objective."""
    if isinstance(node.raw, str):
        values: tuple[float, ...] = NAMED_WEIGHTS[node.choice(*NAMED_WEIGHTS)]
    else:
        given = node.mapping(" ".join(OBJECTIVES))
        values = tuple(given[key].number(least=0) for key in OBJECTIVES)
    if not any(values):
        node.fail("at least one must be above zero")
    return {f"{key}_weight": value for key, value in zip(OBJECTIVES, values, strict=True)}


@dataclass(frozen=True)
class Limits:
    """0: none."""

    sag: float = 0.0
    """Largest displacement at any pose [m]."""
    stress: float = 0.0
    """Von Mises [Pa]."""


def read_limits(root: Node) -> Limits:
    """The problem's `limits`: sag [m] and stress [Pa]."""
    if "limits" not in root:
        return Limits()
    node = root["limits"].mapping("", "sag stress")
    return Limits(
        node["sag"].number(above=0) if "sag" in node else 0.0,
        pressure(node["stress"]) if "stress" in node else 0.0,
    )
