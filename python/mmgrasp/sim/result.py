"""What a run in physics found out: grasped or not and why, what touched what, and the recorded motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .control import RecordedState


@dataclass
class ContactEvent:
    """Two bodies touching without a break."""

    a: str
    b: str
    begin: float
    """[s]"""
    end: float
    """[s]"""
    peak_force: float
    """Largest normal force, summed over the contact points [N]."""

    def __repr__(self) -> str:
        return f"ContactEvent('{self.a}' - '{self.b}', {self.begin:.2f} to {self.end:.2f} s, {self.peak_force:.1f} N)"


@dataclass
class PartMotion:
    """What happened to one part."""

    grasped: bool
    """Lifted, held to the end by the gripper alone, and still in it."""
    cause: str
    """Why not, or how firmly."""
    displacement: float
    """How far it was pushed over the ground before both fingers had it, or to the end if they never did [m]."""
    rise: float
    """Height at the end less that at the start [m]."""
    slip: float
    """Motion in the hand while held [m]."""


@dataclass
class SimResult:
    """A run. `parts` has a verdict for each part; `states` the motion, for pictures."""

    parts: dict[str, PartMotion]
    contacts: list[ContactEvent]
    duration: float
    """[s]"""
    base_error: float
    """Largest distance of the base from its plan [m]; 0 for a base that stands."""
    arm_error: float
    """Largest deviation of a planned joint [rad or m]."""
    states: list[RecordedState] = field(default_factory=list, repr=False)
    """Every `frame_period`."""

    @property
    def grasped(self) -> bool:
        """Every part was."""
        return all(p.grasped for p in self.parts.values())

    def touching(self, a: str, b: str) -> list[ContactEvent]:
        """Contacts of two bodies, in either order."""
        return [e for e in self.contacts if {e.a, e.b} == {a, b}]

    def to_dict(self) -> dict[str, Any]:
        """Plain values; without the states."""
        return {
            "grasped": self.grasped,
            "parts": {name: dict(vars(p)) for name, p in self.parts.items()},
            "contacts": [dict(vars(e)) for e in self.contacts],
            "duration": self.duration,
            "base_error": self.base_error,
            "arm_error": self.arm_error,
        }


class ContactLog:
    """Joins contacts of single steps to events; gaps shorter than `longest_break` [s] do not end one."""

    def __init__(self, longest_break: float = 0.05):
        self.longest_break = longest_break
        self.open: dict[tuple[str, str], ContactEvent] = {}
        self.closed: list[ContactEvent] = []

    def step(self, time: float, forces: Mapping[tuple[str, str], float]) -> None:
        """Takes in the normal forces [N] of the pairs that touch at a time [s]."""
        for pair, force in forces.items():
            event = self.open.get(pair)
            if event is None or time - event.end > self.longest_break:
                if event is not None:
                    self.closed.append(event)
                event = self.open[pair] = ContactEvent(*pair, time, time, 0.0)
            event.end = time
            event.peak_force = max(event.peak_force, force)

    def events(self) -> list[ContactEvent]:
        """All contacts by their beginning."""
        return sorted([*self.closed, *self.open.values()], key=lambda e: (e.begin, e.a, e.b))


class PartWatch:
    """Follows one part through a run and judges it in the end."""

    def __init__(self, name: str, T_world_part: np.ndarray, sides: list[set[str]], hand: set[str]):
        """`sides`: fingers either side of the part; `hand`: all that may touch a held part."""
        self.name, self.start, self.sides, self.hand = name, T_world_part.copy(), sides, hand
        self.squeezed: np.ndarray | None = None
        self.touched = False
        self.held_at: np.ndarray | None = None
        self.slip = 0.0
        self.other: str | None = None
        self.lost = False

    def step(self, T_world_part: np.ndarray, T_world_hand: np.ndarray, touching: set[str], holding: bool) -> None:
        """`touching`: bodies in contact with the part now; `holding`: the arm stands with it lifted."""
        self.touched |= bool(touching & self.hand)
        if self.squeezed is None and self.sides and all(side & touching for side in self.sides):
            self.squeezed = T_world_part.copy()
        if not holding:
            return
        T_hand_part = np.linalg.inv(T_world_hand) @ T_world_part
        if self.held_at is None:
            self.held_at = T_hand_part
        self.slip = max(self.slip, float(np.linalg.norm(T_hand_part[:3, 3] - self.held_at[:3, 3])))
        self.lost |= not touching & self.hand
        others = touching - self.hand
        if others and self.other is None:
            self.other = min(others)

    def verdict(self, T_world_part: np.ndarray, lift: float) -> PartMotion:
        """Whether it was grasped, at the end of a run whose tool rose by `lift` [m]."""
        seen = T_world_part if self.squeezed is None else self.squeezed
        displacement = float(np.linalg.norm((seen - self.start)[:2, 3]))
        rise = float(T_world_part[2, 3] - self.start[2, 3])
        if not self.touched:
            grasped, cause = False, "the gripper never touched it"
        elif self.squeezed is None:
            grasped, cause = False, "the fingers never had it between them"
        elif rise < 0.8 * lift:
            grasped, cause = False, "it was not lifted"
        elif self.other is not None:
            grasped, cause = False, f"it still touches '{self.other}'"
        elif self.lost or self.slip > 0.01:
            grasped, cause = False, "it slipped out of the fingers"
        else:
            grasped, cause = True, f"held, moving {1000 * self.slip:.1f} mm in the hand"
        return PartMotion(grasped, cause, displacement, rise, self.slip)
