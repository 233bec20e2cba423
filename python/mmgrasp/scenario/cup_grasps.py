"""Grasps of a part type by a hand of suction cups: sampled, or listed and looked at by the rule of `verify`."""

from __future__ import annotations

import numpy as np

from .. import _core
from .._core import Grasp, Hand, InvalidInput, LinkShape
from .._core import verify as checks
from ..documents.reading import Node
from .part_type import PartType, read_grasp_options


def read_cup_grasps(entry: Node, name: str, shapes: list[LinkShape], hand: Hand, mass: float) -> PartType:
    """One of `part_types`; a part that no cups hold is refused where it is a target."""
    options = read_grasp_options(entry, _core._suction_option_table())
    if "grasps" in entry:
        return PartType(shapes, _listed(entry["grasps"], name, shapes, hand, mass), 0, entry, mass)
    where = entry["grasp_options"] if options else entry
    try:
        found = _core.sample_suction_grasps(shapes, hand, mass, **options)
    except InvalidInput as error:
        where.fail(str(error))
    return PartType(shapes, found.grasps, 0, entry, mass, "" if found.grasps else _why_none(found, hand, mass))


def _why_none(found: _core.SampledSuctionGrasps, hand: Hand, mass: float) -> str:
    suction = hand.suction
    assert suction is not None
    if found.too_heavy:
        held = _core._suction_used() * mass / found.least_share
        return (
            f"it weighs {mass:g} kg, the cups, of {suction.force:.4g} N, hold {held:.3g} kg of it in every direction (friction "
            f"{suction.friction:g}, safety {suction.safety:g}): more or larger cups, or more vacuum, would help"
        )
    radius = max(cup.radius for cup in suction.cups)
    return (
        f"it is too small or too curved for the suction cups: at none of {found.unsealed} places and turns does its surface lie "
        f"within {suction.max_gap:g} m before every rim (the largest has a radius of {radius:g} m)"
    )


def _listed(node: Node, name: str, shapes: list[LinkShape], hand: Hand, mass: float) -> list[Grasp]:
    assert hand.suction is not None
    grasps = []
    for entry in node.elements():
        entry.mapping("pose", "quality")
        quality = entry["quality"].number(least=0) if "quality" in entry else 1.0
        T = entry["pose"].pose()
        broken = checks.broken_seal(hand, shapes, checks.CheckedGrasp(T, 0.0))
        if broken:
            entry["pose"].fail(f"the suction cups do not seal on part type {name}: {broken}")
        centre = np.linalg.inv(T) @ [*_core._centre_of_mass(shapes), 1.0]
        share = _core.suction_share(hand.suction, hand.approach, mass, centre[:3])
        if share > _core._suction_used():
            entry["pose"].fail(
                f"the suction cups hold {_core._suction_used() * mass / share:.3g} kg there in every direction, part type {name} weighs {mass:g} kg"
            )
        grasps.append(Grasp(T, 0.0, quality=quality))
    return grasps
