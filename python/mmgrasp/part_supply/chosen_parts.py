"""Parts asked for by number ("3 brackets", any of them): which of them a round picks."""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .. import _core
from .._core import Part, ReachDatabase, Tray
from .._progress import Progress
from ..scenario import Scenario, TraySetup

_MOST_CHOICES = 5_000  # choices of a tray that are all compared; of more, parts are given up one by one


def by_number(scenario: Scenario) -> bool:
    """Whether a tray's parts are asked for by number and not chosen yet."""
    return any(len(tray.targets) > sum(tray.wanted.values()) for tray in scenario.trays if tray.wanted)


def choose_parts(
    scenario: Scenario, database: ReachDatabase, without: Collection[str] = (), progress: Progress = None
) -> Scenario:
    """The scenario with the parts chosen that leave the base most room, tray by tray: the most cells from which all of them can be grasped
    while every part is in place. Parts in `without` are left where others will do."""
    problem = scenario.problem()
    regions = _core.ObjectRegions.compute(problem, database, _core.make_base_grid(problem, database), progress=progress)
    names: set[str] = set()
    for k, tray in enumerate(scenario.trays):
        if not tray.wanted:
            continue
        cells = {
            tray.tray.parts[i].name: np.flatnonzero(regions.region(k, [i])).astype(np.int64) for i in regions.parts(k)
        }
        size = regions.grid.nx * regions.grid.ny * len(regions.grid.headings)
        names.update(_choice(cells, size, tray, set(without)))
    return with_targets(scenario, names)


def with_targets(scenario: Scenario, names: Collection[str]) -> Scenario:
    """The scenario in which, of parts asked for by number, those of these names are picked."""
    return replace(scenario, trays=[_only(tray, names) if tray.wanted else tray for tray in scenario.trays])


def chosen_as(scenario: Scenario, plan: Mapping[str, Any]) -> Scenario:
    """The scenario with the parts that a plan.json chose, so that both can be compared."""
    return with_targets(scenario, {part["name"] for part in plan["scenario"]["parts"] if part["target"]})


def others_will_do(scenario: Scenario, names: Iterable[str]) -> set[str]:
    """Those of the parts that were chosen by number while more of their type are there."""
    found = set(names)
    spare: set[str] = set()
    for tray in scenario.trays:
        for kind, count in tray.wanted.items():
            of = tray.of_kind(kind)
            spare |= found & set(of) if len(of) > count else set()
    return spare


def _choice(cells: dict[str, np.ndarray], size: int, tray: TraySetup, without: set[str]) -> list[str]:
    """Names of the parts to pick, given from which cells of the base grid each can be grasped."""
    groups = {kind: _usable(tray.of_kind(kind), count, without) for kind, count in tray.wanted.items()}
    masks = {}
    for name in itertools.chain.from_iterable(groups.values()):
        masks[name] = np.zeros(size, dtype=bool)
        masks[name][cells[name]] = True
    if math.prod(math.comb(len(names), tray.wanted[kind]) for kind, names in groups.items()) <= _MOST_CHOICES:
        every = itertools.product(*(itertools.combinations(names, tray.wanted[kind]) for kind, names in groups.items()))
        choices = [list(itertools.chain.from_iterable(choice)) for choice in every]
        return max(choices, key=lambda names: (_shared(masks, names), sum(int(masks[n].sum()) for n in names)))
    return _given_up_one_by_one(groups, masks, tray.wanted)


def _usable(names: list[str], count: int, without: set[str]) -> list[str]:
    """The parts to choose from, those that should be left only where they are needed."""
    good = [name for name in names if name not in without]
    return good + [name for name in names if name in without][: max(0, count - len(good))]


def _shared(masks: Mapping[str, np.ndarray], names: Iterable[str]) -> int:
    return int(np.logical_and.reduce([masks[name] for name in names]).sum())


def _given_up_one_by_one(
    groups: dict[str, list[str]], masks: Mapping[str, np.ndarray], wanted: Mapping[str, int]
) -> list[str]:
    """From all parts the one is given up, time and again, without which the others share most cells; where that makes no difference, the one
    with the fewest cells."""
    left = {kind: list(names) for kind, names in groups.items()}
    while any(len(names) > wanted[kind] for kind, names in left.items()):
        every = list(itertools.chain.from_iterable(left.values()))
        lacking = sum(~masks[name] for name in every)  # how many parts cannot be grasped from a cell
        candidates = [(kind, name) for kind, names in left.items() if len(names) > wanted[kind] for name in names]
        # Without a part those cells are shared at which nothing, or only this part, is lacking.
        gains = [(int(((lacking == 1) & ~masks[name]).sum()), -int(masks[name].sum())) for _, name in candidates]
        kind, name = candidates[max(range(len(candidates)), key=lambda i: gains[i])]
        left[kind].remove(name)
    return list(itertools.chain.from_iterable(left.values()))


def _only(setup: TraySetup, names: Collection[str]) -> TraySetup:
    tray = setup.tray
    candidates = {name for kind in setup.wanted for name in setup.of_kind(kind)}
    parts = [
        Part(
            *(part.name, part.shapes, part.T_world_part, part.grasps),
            target=part.name in names and part.name in candidates,
            grasps_too_wide=part.grasps_too_wide,
            mass=part.mass,
            grasps_sampled=part.grasps_sampled,
        )
        for part in tray.parts
    ]
    made = Tray(tray.name, tray.T_world_tray, tray.size, parts, list(tray.headings))
    return replace(setup, tray=made, targets=[part.name for part in parts if part.target])
