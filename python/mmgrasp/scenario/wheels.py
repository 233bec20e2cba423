"""What the wheels of a base leave to its platform: their data as a robot's sheet has them, in place of speeds of the base.

A rim runs at radius times the wheel's speed. Two driven wheels on one axle have rims at v -+ omega track / 2 (P1 4.11), four Mecanum wheels at
v_x -+ v_y -+ omega (track + wheelbase) / 2, which planners and `verify` keep as they stand: full speed ahead, aside and turning are not had at once.
Accelerations are shared out: the base's limits are such that every combination of them keeps the wheels' own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..documents.reading import Node

WHEEL_KEYS = "radius speed track"
MORE_WHEEL_KEYS = "wheelbase acceleration"
COUPLED = ("wheel_velocity", "wheel_separation", "wheelbase")  # limits of the base that the wheels' data give
ROUNDING = 1e-9


@dataclass(frozen=True)
class Wheels:
    """Driven wheels of one size."""

    radius: float
    """[m]"""
    speed: float
    """Fastest a wheel turns [rad/s]."""
    track: float
    """Between left and right wheels [m]."""
    wheelbase: float | None
    """Between front and rear ones [m], of four Mecanum wheels; None: two wheels on one axle."""
    acceleration: float | None
    """[rad/s^2]; None: not known."""

    @property
    def lever(self) -> float:
        """Speed of a rim per turning rate of the base [m]."""
        return 0.5 * (self.track + (self.wheelbase or 0.0))

    @property
    def along(self) -> float:
        """Speed of a rim per speed of the base, at the worst heading."""
        return 1.0 if self.wheelbase is None else math.sqrt(2.0)


def read_wheels(node: Node, base: str) -> Wheels:
    """The section `wheels` of a robot."""
    node.mapping(WHEEL_KEYS, MORE_WHEEL_KEYS)
    if base == "fixed":
        node.fail("the base is fixed: state its kind beside them, base: diff_drive or base: omni")
    if base == "omni" and "wheelbase" not in node:
        node.fail("an omnidirectional base has four Mecanum wheels: wheelbase is missing")
    if base == "diff_drive" and "wheelbase" in node:
        node["wheelbase"].fail("a diff-drive base has its two driven wheels on one axle: leave it out")
    wheelbase, acceleration = (node[key].number(above=0) if key in node else None for key in MORE_WHEEL_KEYS.split())
    radius, speed, track = (node[key].number(above=0) for key in WHEEL_KEYS.split())
    return Wheels(radius, speed, track, wheelbase, acceleration)


def limits_of_wheels(node: Node, base: str, stated: dict[str, float]) -> dict[str, float]:
    """`base_limits` of the section: what is stated beside it, refused where the wheels cannot do it, and the rest from the wheels."""
    for key in COUPLED:
        if key in stated:
            node.fail(f"base_limits.{key} says the same: leave one of them out")
    wheels = read_wheels(node, base)
    limits, rim = dict(stated), wheels.radius * wheels.speed
    limits |= {"wheel_velocity": rim, "wheel_separation": wheels.track}  # couples speed and turning rate
    if wheels.wheelbase is not None:
        limits["wheelbase"] = wheels.wheelbase
    for key, most in (("linear_velocity", rim), ("angular_velocity", rim / wheels.lever)):
        if stated.get(key, most) > most * (1 + ROUNDING):
            node.fail(f"base_limits.{key} = {stated[key]:g} is more than these wheels do, {most:g}")
        limits.setdefault(key, most)
    if wheels.acceleration is not None:
        reach = wheels.radius * wheels.acceleration
        if base == "omni":
            # A turning platform's own axes turn under its velocity, of which the rims leave (rim - lever omega) omega.
            most_turned = wheels.along * limits["linear_velocity"] * limits["angular_velocity"]
            by_turning = min(most_turned, rim**2 / (4 * wheels.lever))
            if by_turning >= reach:
                node["acceleration"].fail(
                    f"must be more than {by_turning / wheels.radius:.3g}, which turning at base_limits.angular_velocity, {limits['angular_velocity']:.3g}, "
                    f"takes while the base drives at linear_velocity, {limits['linear_velocity']:.3g}: or give lower ones"
                )
            reach -= by_turning
        limits |= _shared_acceleration(node, wheels, stated, reach)
    return limits


def _shared_acceleration(node: Node, wheels: Wheels, stated: dict[str, float], rim: float) -> dict[str, float]:
    """Linear and angular limit that together ask no more of a rim than `rim`; half of it for each where neither is stated."""
    linear, angular = stated.get("linear_acceleration"), stated.get("angular_acceleration")
    if linear is None:
        linear = (0.5 * rim if angular is None else rim - wheels.lever * angular) / wheels.along
    if angular is None:
        angular = (rim - wheels.along * linear) / wheels.lever
    asked = wheels.along * linear + wheels.lever * angular
    if min(linear, angular) <= 0 or asked > rim * (1 + ROUNDING):
        most = f"{rim:.3g}, {max(rim, 0) / wheels.radius:.3g} times the radius"
        node.fail(
            f"base_limits: linear_acceleration and angular_acceleration together ask more of these wheels' rims than {most}"
        )
    return {"linear_acceleration": linear, "angular_acceleration": angular}
