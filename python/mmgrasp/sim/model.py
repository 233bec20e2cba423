"""The MuJoCo model of a robot, a scene and loose parts, as MJCF text. Needs no MuJoCo itself.

Every collision shape becomes one geom; meshes collide as their convex hulls. The robot does not collide with itself (planned
motions are checked for that) nor with the floor, but for wheels it rolls on; parts collide with everything.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._argument_errors import checked
from .._core import (
    Box,
    Capsule,
    Cylinder,
    Hand,
    HandJoint,
    InvalidInput,
    LinkShape,
    Mesh,
    Plane,
    Robot,
    Sphere,
    Voxels,
    World,
)
from ..bodies import SceneBodies
from .finger_drives import TOGETHER, FingerDrive, finger_drives
from .rolling import BASE_JOINTS, CASTER_RADIUS, ROOT_JOINT, TYRES, RollingBase

ROBOT, SCENE, PART, FLOOR, WHEEL = 1, 2, 4, 8, 16
COLLIDES = {
    ROBOT: SCENE | PART,
    SCENE: ROBOT | PART,
    PART: ROBOT | SCENE | PART | FLOOR,
    FLOOR: PART | WHEEL,
    WHEEL: FLOOR,
}
JOINT_TYPES = {"revolute": "hinge", "continuous": "hinge", "prismatic": "slide"}


@dataclass
class SimPart:
    """A loose rigid body: what is to be grasped."""

    name: str
    shapes: Sequence[LinkShape]
    pose: np.ndarray
    """T_world_part (4, 4) at the start."""
    mass: float = 0.2
    """[kg], > 0"""
    friction: float = 0.3
    """Coefficient on everything that grips no better; the larger one of two surfaces counts."""

    def check(self) -> None:
        """Raises InvalidInput naming field, value and rule."""
        for name in ("mass", "friction"):
            value = float(getattr(self, name))
            if not (np.isfinite(value) and value > 0):
                raise InvalidInput(f"{name} = {value!r} of part '{self.name}': must be finite and positive")
        if not self.shapes:
            raise InvalidInput(f"shapes of part '{self.name}': must hold at least one shape")


@dataclass
class Physics:
    """Numbers of the model that no robot file holds."""

    time_step: float = 0.002
    """[s]. A held part creeps outwards where the hand swings, with its centripetal acceleration times a step [m/s] (MuJoCo's constraints
    leave that acceleration out): take finer steps for hands that swing fast."""
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.81)
    """[m/s^2]"""
    finger_friction: float = 0.9
    """Coefficient of the fingers on parts."""
    scene_friction: float = 0.3
    """Coefficient of scene and floor; parts may have more of their own."""
    grip_force: float = 40.0
    """Largest force at a fingertip, in the mean of those that one drive moves [N]."""
    base_force: float = 300.0
    """Largest force of the wheels on the base [N]."""
    base_torque: float = 100.0
    """Largest torque of the wheels about the vertical [N m]."""
    stiffness: float = 60.0
    """Natural frequency of the arm's joint controllers, critically damped [rad/s]."""
    rolling: RollingBase | None = None
    """The base rolls on these wheels, which stand on the floor; None: forces move it along x, y and theta."""
    impedance: tuple[float, float] = (0.95, 0.99)
    """How hard contacts are, where bodies begin to touch and 1 mm deep, between 0 and 1 (`solimp`); light parts held firmly need more."""

    def check(self) -> None:
        """Raises InvalidInput naming field, value and rule."""
        for name in (
            "time_step",
            "finger_friction",
            "scene_friction",
            "grip_force",
            "base_force",
            "base_torque",
            "stiffness",
        ):
            value = float(getattr(self, name))
            if not (np.isfinite(value) and value > 0):
                raise InvalidInput(f"{name} = {value!r}: must be finite and positive")
        soft, hard = self.impedance
        if not 0 < soft <= hard < 1:
            raise InvalidInput(
                f"impedance = {self.impedance!r}: must be two numbers between 0 and 1, the second no smaller"
            )
        if self.time_step > 0.01:
            raise InvalidInput(f"time_step = {self.time_step!r}: must be at most 0.01 s, contacts need fine steps")


@dataclass
class Built:
    """The text, and who is who in it."""

    xml: str
    joints: list[str] = field(default_factory=list)
    """Driven joints of the robot, one actuator each, in this order; then the three of the base, or its two wheels, if it moves."""
    fingers: dict[str, FingerDrive] = field(default_factory=dict)
    """Joints of the hand."""
    owner: dict[str, str] = field(default_factory=dict)
    """Link, part or scene object of each geom by its name."""
    floor: float = 0.0
    """Height of the floor [m]."""


@checked
def build(
    robot: Robot,
    world: World,
    parts: Iterable[SimPart] = (),
    gripper: Hand | None = None,
    physics: Physics | None = None,
) -> Built:
    """The model. The root stands where base/x, base/y and base/theta say; a fixed base does not move from there.

    Throws InvalidInput for joints and shapes that MuJoCo has no counterpart for, naming them.
    """
    physics = physics or Physics()
    physics.check()
    loose = {part.name: part for part in parts}
    return _Builder(SceneBodies.of_world(robot, world, loose.values()), loose, gripper, physics).built


class _Builder:
    def __init__(self, bodies: SceneBodies, loose: dict[str, SimPart], gripper: Hand | None, physics: Physics):
        self.bodies, self.robot, self.physics = bodies, bodies.robot, physics
        self.built = Built("", floor=bodies.floor)
        if physics.rolling is not None:
            physics.rolling.check(self.robot)
        self.meshes = 0
        self.root = ET.Element("mujoco", model=self.robot.name or "robot")
        ET.SubElement(
            self.root, "compiler", angle="radian", autolimits="true", inertiafromgeom="auto", balanceinertia="true"
        )
        ET.SubElement(self.root, "size", memory="128M")  # parts of many convex pieces touch in hundreds of points
        option = ET.SubElement(
            self.root, "option", timestep=_text(physics.time_step), gravity=_text(physics.gravity), cone="elliptic",
            integrator="implicitfast", impratio="10", noslip_iterations="4",
        )  # fmt: skip
        ET.SubElement(option, "flag", multiccd="enable")
        default = ET.SubElement(self.root, "default")
        ET.SubElement(
            default,
            "geom",
            solref=_text((3 * physics.time_step, 1)),
            condim="4",
            density="500",
            solimp=_text((*physics.impedance, 0.001)),
        )
        self.asset = ET.SubElement(self.root, "asset")
        world = ET.SubElement(self.root, "worldbody")
        self._geom(
            world, "floor", FLOOR, physics.scene_friction, type="plane", size="20 20 1", pos=f"0 0 {bodies.floor!r}"
        )
        finger_links = set(gripper.finger_links) if gripper else set()
        self.fingers = finger_drives(self.robot, gripper) if gripper else {}
        self.coupled = _coupling(gripper) if gripper else {}
        for obstacle in bodies.obstacles:
            element = ET.SubElement(world, "body", {"name": f"scene/{obstacle.name}", **_placed(obstacle.pose)})
            for shape in obstacle.shapes:
                self._shape(element, shape, obstacle.name, SCENE, physics.scene_friction)
        self._robot(world, finger_links)
        for part in bodies.parts.values():
            loose[part.name].check()
            element = ET.SubElement(world, "body", {"name": f"part/{part.name}", **_placed(part.pose)})
            ET.SubElement(element, "freejoint", name=f"part/{part.name}")
            for shape in part.shapes:
                self._shape(element, shape, part.name, PART, loose[part.name].friction)
        self.built.xml = ET.tostring(self.root, encoding="unicode")

    def _robot(self, world: ET.Element, finger_links: set[str]) -> None:
        urdf = ET.fromstring(self.robot.to_urdf())
        links = {_attribute(link, "name"): link for link in urdf.findall("link")}
        joints: dict[str, list[ET.Element]] = {}
        for joint in urdf.findall("joint"):
            joints.setdefault(_attribute(_child(joint, "parent"), "link"), []).append(joint)
        actuators = ET.Element("actuator")
        equality = ET.Element("equality")
        rolling = self.physics.rolling

        def add(parent: ET.Element, name: str, joint: ET.Element | None) -> None:
            T = np.eye(4) if joint is None else _origin(joint)
            carried = "1" if rolling is None else "0"  # weight has to be on the wheels: joints hold themselves up then
            body = ET.SubElement(parent, "body", {"name": f"link/{name}", "gravcomp": carried, **_placed(T)})
            if joint is not None:
                self._joint(body, joint, actuators, equality)
            elif rolling is not None:
                ET.SubElement(body, "freejoint", name=ROOT_JOINT)
                for x, y in rolling.casters:
                    at = {"pos": _text((x, y, rolling.height + CASTER_RADIUS)), "mass": "0", "condim": "1"}
                    self._geom(body, name, WHEEL, 0.0, type="sphere", size=_text([CASTER_RADIUS]), **at)
            elif self.robot.base != "fixed":
                for axis, kind, base_joint in zip(
                    ("1 0 0", "0 1 0", "0 0 1"), ("slide", "slide", "hinge"), BASE_JOINTS, strict=True
                ):
                    ET.SubElement(body, "joint", name=base_joint, type=kind, axis=axis)
            self._inertia(body, links[name], joint)
            friction = self.physics.finger_friction if name in finger_links else self.physics.scene_friction
            for shape in self.robot.collisions(name):
                self._shape(body, shape, name, ROBOT, friction)
            if rolling is not None and joint is not None and joint.get("name") in (rolling.left, rolling.right):
                # Crowned: it touches in a point, so that turning does not scrub.
                rim = {"type": "sphere", "size": _text([rolling.radius]), "mass": "0", "condim": "3"}
                self._geom(body, name, WHEEL, rolling.friction, **rim)
            for child in joints.get(name, []):
                add(body, _attribute(_child(child, "child"), "link"), child)

        add(world, self.robot.links[0], None)
        if self.robot.base != "fixed" and rolling is None:
            for name in BASE_JOINTS:
                limit = self.physics.base_torque if name.endswith("theta") else self.physics.base_force
                ET.SubElement(actuators, "velocity", name=name, joint=name, kv="1", forcerange=_text((-limit, limit)))
        for name, (first, line) in self.coupled.items():
            ET.SubElement(equality, "joint", joint1=name, joint2=first, polycoef=line, solref=TOGETHER)
        if len(equality):
            self.root.append(equality)
        self.root.append(actuators)

    def _joint(self, body: ET.Element, joint: ET.Element, actuators: ET.Element, equality: ET.Element) -> None:
        name, kind = _attribute(joint, "name"), _attribute(joint, "type")
        if kind == "fixed":
            return
        if kind not in JOINT_TYPES:
            raise InvalidInput(f"joint '{name}': is {kind}, which the simulation cannot drive")
        axis = joint.find("axis")
        limit = joint.find("limit")
        made = ET.SubElement(
            body,
            "joint",
            name=name,
            type=JOINT_TYPES[kind],
            axis=_attribute(axis, "xyz") if axis is not None else "1 0 0",
            armature="0.05",
        )
        if kind != "continuous" and limit is not None:
            made.set("range", f"{limit.get('lower', '0')} {limit.get('upper', '0')}")
        mimic = joint.find("mimic")
        if mimic is not None:
            line = f"{mimic.get('offset', '0')} {mimic.get('multiplier', '1')} 0 0 0"
            made = ET.SubElement(equality, "joint", joint1=name, joint2=_attribute(mimic, "joint"), polycoef=line)
            if _attribute(mimic, "joint") in self.fingers:
                made.set("solref", TOGETHER)
            return
        force = float(limit.get("effort", "0")) if limit is not None else 0.0
        if name in self.fingers:
            force = self.fingers[name].limit(self.physics.grip_force)
            self.built.fingers[name] = self.fingers[name]
        rolls = self.physics.rolling is not None and name in (self.physics.rolling.left, self.physics.rolling.right)
        actuator = ET.SubElement(actuators, "velocity" if rolls else "position", name=name, joint=name, kv="1")
        if force > 0 and np.isfinite(force):
            actuator.set("forcerange", _text((-force, force)))
        if not rolls:
            actuator.set("kp", "1")
            self.built.joints.append(name)

    def _inertia(self, body: ET.Element, link: ET.Element, joint: ET.Element | None) -> None:
        inertial = link.find("inertial")
        has_mass = inertial is not None and inertial.find("mass") is not None
        if inertial is not None and has_mass and float(_attribute(_child(inertial, "mass"), "value")) > 0:
            T, tensor = _origin(inertial), _child(inertial, "inertia")
            about = [float(tensor.get(k, "0")) for k in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")]
            xx, yy, zz, xy, xz, yz = about
            turned = T[:3, :3] @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ T[:3, :3].T
            full = [turned[0, 0], turned[1, 1], turned[2, 2], turned[0, 1], turned[0, 2], turned[1, 2]]
            mass = _attribute(_child(inertial, "mass"), "value")
            ET.SubElement(body, "inertial", pos=_text(T[:3, 3]), mass=mass, fullinertia=_text(full))
        elif not self.robot.collisions(_attribute(link, "name")) and joint is not None and joint.get("type") != "fixed":
            ET.SubElement(body, "inertial", pos="0 0 0", mass="0.01", diaginertia="1e-5 1e-5 1e-5")

    def _shape(self, body: ET.Element, shape: LinkShape, owner: str, group: int, friction: float) -> None:
        s, at = shape.shape, _placed(shape.pose)
        if isinstance(s, Box):
            self._geom(body, owner, group, friction, type="box", size=_text(np.asarray(s.size) / 2), **at)
        elif isinstance(s, Sphere):
            self._geom(body, owner, group, friction, type="sphere", size=_text([s.radius]), **at)
        elif isinstance(s, Cylinder | Capsule):
            self._geom(body, owner, group, friction, type=shape.kind, size=_text([s.radius, s.length / 2]), **at)
        elif isinstance(s, Plane):
            T = shape.pose @ _plane_frame(np.asarray(s.normal), s.offset)
            self._geom(body, owner, group, friction, type="plane", size="20 20 1", **_placed(T))
        elif isinstance(s, Mesh):
            name = f"mesh{self.meshes}"
            self.meshes += 1
            ET.SubElement(self.asset, "mesh", name=name, vertex=_text(np.asarray(s.vertices).ravel()))
            self._geom(body, owner, group, friction, type="mesh", mesh=name, **at)
        elif isinstance(s, Voxels):
            for centre in s.centres:
                T = shape.pose.copy()
                T[:3, 3] += T[:3, :3] @ centre
                size = _text([s.resolution / 2] * 3)
                self._geom(body, owner, group, friction, type="box", size=size, **_placed(T))
        else:
            raise InvalidInput(f"shape '{shape.kind}' of '{owner}': the simulation has none such")

    def _geom(self, body: ET.Element, owner: str, group: int, friction: float, **attributes: str) -> None:
        name = f"geom{len(self.built.owner)}"
        self.built.owner[name] = owner
        given = {"name": name, "contype": str(group), "conaffinity": str(COLLIDES[group])}
        if group == WHEEL:  # its own softness and friction count, not the floor's
            given |= {"priority": "1", "solref": TYRES}
        ET.SubElement(body, "geom", {**given, "friction": _text((friction, 0.005, 0.0001)), **attributes})


def _child(element: ET.Element, tag: str) -> ET.Element:
    found = element.find(tag)
    if found is None:
        raise InvalidInput(f"<{element.tag} name='{element.get('name', '')}'>: has no <{tag}>")
    return found


def _attribute(element: ET.Element, name: str) -> str:
    found = element.get(name)
    if found is None:
        raise InvalidInput(f"<{element.tag}>: has no attribute '{name}'")
    return found


def _coupling(hand: Hand) -> dict[str, tuple[str, str]]:
    """Joints of a group open together, as one drive moves them: each as a linear function of the group's first that moves."""
    lines = {}
    firsts: dict[str, HandJoint] = {}
    for joint in hand.joints:
        if joint.open != joint.closed:
            firsts.setdefault(joint.group, joint)
    for joint in hand.joints:
        first = firsts.get(joint.group, joint)
        if joint is not first:
            ratio = (joint.open - joint.closed) / (first.open - first.closed)
            lines[joint.name] = (first.name, _text((joint.closed - ratio * first.closed, ratio, 0, 0, 0)))
    return lines


def _text(values: ArrayLike) -> str:
    return " ".join(repr(float(v)) for v in np.atleast_1d(values))


def _placed(T: np.ndarray) -> dict[str, str]:
    x, y, z, w = _core.quat_xyzw_from_rotation(T[:3, :3])
    return {"pos": _text(T[:3, 3]), "quat": _text((w, x, y, z))}


def _origin(element: ET.Element) -> np.ndarray:
    origin = element.find("origin")
    if origin is None:
        return np.eye(4)
    xyz = [float(v) for v in origin.get("xyz", "0 0 0").split()]
    return _core.pose(xyz, rpy=[float(v) for v in origin.get("rpy", "0 0 0").split()])


def _plane_frame(normal: np.ndarray, offset: float) -> np.ndarray:
    """A frame on the plane n x = offset whose z is the normal."""
    z = normal / np.linalg.norm(normal)
    x = np.cross([0.0, 1.0, 0.0] if abs(z[1]) < 0.9 else [1.0, 0.0, 0.0], z)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    T[:3, 3] = z * offset
    return T
