"""How large the base grid of a scenario becomes at least, checked where the scenario is read."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..documents.reading import Node
from .tray_section import TraySetup

MOST_CELLS = 20_000_000
SAME_HEADING = 1e-6  # [rad]: such are one layer


def check_grid_size(root: Node, trays: list[TraySetup], options: dict[str, Any]) -> None:
    """Refuses trays whose base grid would have too many cells; how far the arm reaches is not known yet, so that planning may refuse more."""
    picked = [tray.tray for tray in trays if tray.targets]
    headings = [h for tray in picked for h in tray.headings or [math.atan2(*tray.T_world_tray[1::-1, 0])]]
    layers = len(_distinct(np.array(headings)))
    middles = np.array([tray.T_world_tray[:2, 3] for tray in picked])
    beyond = np.array([options["grid_max_distance"] or np.linalg.norm(tray.size[:2]) / 2 for tray in picked])
    sides = (middles + beyond[:, None]).max(axis=0) - (middles - beyond[:, None]).min(axis=0)
    cells = np.floor(sides / options["grid_resolution"])
    if float(cells.prod()) * layers <= MOST_CELLS:
        return
    root["trays"].fail(
        f"the base grid around them, {cells[0]:.0f} x {cells[1]:.0f} cells of {options['grid_resolution']:g} m in {layers} headings, "
        "is larger than 20 million cells: list fewer headings, raise options.grid_resolution, lower options.grid_max_distance, "
        "or plan for trays that are nearer to each other"
    )


def _distinct(headings: np.ndarray) -> np.ndarray:
    """Those that differ by more than SAME_HEADING over a turn, sorted."""
    turned = np.sort(np.mod(headings, 2 * math.pi))
    return turned[np.diff(turned, append=turned[0] + 2 * math.pi) > SAME_HEADING]
