"""Whether the grasps of an operation hold the parts' weight and the insertion, and which segment is preferred (P1 5.3.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import AssemblyGrasp, FingerGrip, InvalidInput, SegmentRequirement
from .assembly_file import Assembly, AssemblyStep

GRAVITY = 9.81  # [m/s2], along -z of the assembly

Rank = tuple[float, float]


def mass_and_centre(assembly: Assembly, names: list[str]) -> tuple[float, NDArray[np.float64]]:
    """Mass [kg] of parts in their places, and its centre in the assembly [m].

    Raises InvalidInput for a part whose mesh is not closed: it has no volume.
    """
    assert assembly.holding is not None
    mass, moment = 0.0, np.zeros(3)
    for name in names:
        part = assembly.parts[name]
        if not part.mesh.closed:
            raise InvalidInput(f"parts: {name}: must be a closed mesh for its weight to be known (holding)")
        corners = np.asarray(part.mesh.vertices)[np.asarray(part.mesh.triangles)]
        volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
        volume = float(volumes.sum())
        centre = (volumes[:, None] * corners.sum(axis=1) / 4).sum(axis=0) / volume
        mass += assembly.holding.density * abs(volume)
        moment += assembly.holding.density * abs(volume) * (part.pose[:3, :3] @ centre + part.pose[:3, 3])
    return mass, moment / mass


@dataclass(frozen=True)
class Held:
    """What a grasp does about the loads of its operation."""

    safety: float
    """The loads may grow at least by this factor before a pad slips, on the way and at its end."""
    insertion_moment: float
    """The insertion's resistance has this moment about the middle between the pads [N m]."""
    pad_torque: float
    """About its normal, that a pad holds beside the forces it carries at the end [N m]."""
    contact_area: float
    """One pad touches this much [m2]."""


@dataclass(frozen=True)
class OperationLoad:
    """Weight and insertion of one operation, in the frame of the assembly with the parts in their places."""

    grip: FingerGrip
    weights: list[NDArray[np.float64]]
    """At each pose of the way: gravity turns when the parts do [N]."""
    centre: NDArray[np.float64]
    resistance: NDArray[np.float64]
    hole: NDArray[np.float64]


def load_of(assembly: Assembly, step: AssemblyStep) -> OperationLoad | None:
    """None where the assembly says nothing of weight and insertion."""
    choice = assembly.holding
    if choice is None:
        return None
    grip = FingerGrip(
        force=choice.force, friction=choice.friction, modulus=choice.modulus, pad_radius=choice.pad_radius
    )
    mass, centre = mass_and_centre(assembly, step.active)
    weights = [T[:3, :3].T @ np.array([0, 0, -mass * GRAVITY]) for T in step.path]
    resistance = np.zeros(3)
    if step.insertion_force > 0:
        way = step.path[-1][:3, 3] - step.path[-2][:3, 3]
        resistance = -step.insertion_force * way / np.linalg.norm(way)
    return OperationLoad(grip, weights, centre, resistance, centre if step.hole is None else step.hole)


def held_by(grasp: AssemblyGrasp, load: OperationLoad | None) -> Held | None:
    """What a grasp, in the frame of the assembly, does about a load; None for none."""
    if load is None:
        return None
    found = [
        _core.grasp_holding(grasp, load.grip, weight=weight, centre=load.centre, resistance=resistance, hole=load.hole)
        for weight, resistance in [
            *((w, np.zeros(3)) for w in load.weights[:-1]),
            (load.weights[-1], load.resistance),
        ]
    ]
    end = found[-1]
    return Held(min(h.safety for h in found), end.insertion_moment, end.pad_torque, end.contact.area)


def rank(holding: Held | None) -> Rank:
    """Less is better: first how unevenly the insertion bears on the fingers, then how near they are to slipping."""
    if holding is None:
        return (0.0, 0.0)
    return (round(holding.insertion_moment, 4), -round(min(holding.safety, 1e6), 3))


def preference(requirements: list[SegmentRequirement], holdings: list[Held | None]) -> list[float]:
    """A value for each requirement: higher where its rank is better; equal ranks are worth the same."""
    ranks = [rank(holding) for holding in holdings]
    place = {r: i for i, r in enumerate(sorted(set(ranks), reverse=True))}
    return [float(place[r]) for r in ranks]
