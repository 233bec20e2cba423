"""A pipe that bends in MuJoCo: rigid pieces joined by springs, held by an arm that moves exactly as planned.

Every section of length L is cut into `pieces` elements of length h, each with three hinges in its middle: EI/h about the section's
y and z, GJ/h about its axis. The sum over the hinges is the midpoint rule of the beam's integral, so a cantilever's tip is
1/(4 pieces^2) short of the beam's. MuJoCo's own cable needs one bending stiffness for both axes and no branches.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from dataclasses import dataclass, field

import numpy as np

from .._core import (
    BeamFrame,
    Grasp,
    InvalidInput,
    JointGroup,
    JointTrajectory,
    PipeProvenance,
    Robot,
    World,
)
from .model import Physics, build
from .scene import mujoco_module

ROOT = "pipe"
_SERVO = 1e7  # armature of the arm's joints: they move as commanded, whatever hangs on them [kg m2 or kg]


@dataclass(frozen=True)
class _Branch:
    """A stretch of a member, walked from `begin` to `end`."""

    member: int
    begin: np.ndarray
    end: np.ndarray
    node: int
    """That it ends at."""


@dataclass
class PipeMotion:
    """How far the pipe was from where a stiff one would have been."""

    times: np.ndarray
    """[s]"""
    displacement: np.ndarray
    """The largest over the pipe at each time [m]."""
    duration: float
    """Duration of the arm's motion; afterwards it stands still [s]."""

    @property
    def peak(self) -> float:
        """The largest of all [m]."""
        return float(self.displacement.max())

    @property
    def vibration(self) -> float:
        """Half the range of the displacement once the arm stands still [m]."""
        rest = self.displacement[self.times >= self.duration]
        return float(np.ptp(rest)) / 2


@dataclass
class FlexiblePipe:
    """A frame of beams without closed loops, clamped where a grasp holds it, as bodies under an arm's tool frame."""

    frame: BeamFrame
    grasp: Grasp
    robot: Robot
    arm: JointGroup
    tool_link: str
    """The tip of the arm."""
    pieces: int = 8
    """Elements a section (or part of the one that is held)."""
    damping_ratio: float = 0.01
    """Damping ratio of the slowest mode; springs and dampers are proportional."""
    time_step: float = 1e-4
    """[s]"""
    gravity: float = 9.81
    """[m/s2]"""
    _hinges: list[tuple[str, float]] = field(default_factory=list, init=False)
    _sites: list[tuple[str, np.ndarray]] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        if not isinstance(self.grasp.provenance, PipeProvenance):
            raise InvalidInput(f"grasp = {self.grasp!r}: must come from a pipe")
        if len(self.frame.members) != len(self.frame.nodes) - 1:
            raise InvalidInput("frame: has closed loops, which a tree of bodies cannot have")
        if any(np.any(load.force) or np.any(load.moment) for load in self.frame.loads):
            raise InvalidInput("frame: loads must be masses here, not forces or moments")
        if self.pieces < 1:
            raise InvalidInput(f"pieces = {self.pieces}: must be at least 1")
        self._mujoco = mujoco_module()
        self._nodes = np.asarray(self.frame.nodes, float)
        self._adjacent: dict[int, list[int]] = {}
        for i, member in enumerate(self.frame.members):
            for node in member.nodes:
                self._adjacent.setdefault(node, []).append(i)
        self._model = self._mujoco.MjModel.from_xml_string(self._xml())
        self._data = self._mujoco.MjData(self._model)
        self._dofs = np.array([self._model.joint(name).dofadr[0] for name, _ in self._hinges])
        self._at = np.array([self._model.joint(name).qposadr[0] for name, _ in self._hinges])
        self._stiffness = np.array([k for _, k in self._hinges])
        self._arm_dofs = np.array([self._model.joint(name).dofadr[0] for name in self.arm.names])
        self._arm_at = np.array([self._model.joint(name).qposadr[0] for name in self.arm.names])
        self._rest = np.array([point for _, point in self._sites])
        self._site_ids = [self._model.site(name).id for name, _ in self._sites]
        self._tool = self._model.body(f"link/{self.tool_link}").id
        self._model.dof_armature[self._arm_dofs] = _SERVO
        self._model.dof_damping[self._arm_dofs] = 0.0
        self.slowest = self._slowest()
        self._model.dof_damping[self._dofs] = self._stiffness * (2 * self.damping_ratio / self.slowest)

    # --- the model ------------------------------------------------------------------------------------------------
    def _xml(self) -> str:
        tree = ET.fromstring(build(self.robot, World(), [], None, Physics()).xml)
        for name in ("actuator", "contact", "equality", "sensor", "keyframe"):
            for element in tree.findall(name):
                tree.remove(element)
        option = tree.find("option")
        if option is None:
            option = ET.SubElement(tree, "option")
        option.clear()
        option.attrib |= {"timestep": f"{self.time_step:g}", "gravity": f"0 0 {-self.gravity:g}", "integrator": "Euler"}
        ET.SubElement(option, "flag", contact="disable", limit="disable", frictionloss="disable")
        tool = next(b for b in tree.iter("body") if b.get("name") == f"link/{self.tool_link}")
        T = np.linalg.inv(self.grasp.T_object_hand)  # the pipe's frame in the hand's
        root = ET.SubElement(tool, "body", name=ROOT, pos=_text(T[:3, 3]), quat=_text(_quaternion(T[:3, :3])))
        place = self.grasp.provenance
        assert isinstance(place, PipeProvenance)
        a, b = self.frame.members[place.section].nodes
        at = self._nodes[a] + place.length * _unit(self._nodes[b] - self._nodes[a])
        for node in (a, b):
            self._grow(root, np.zeros(3), _Branch(place.section, at, self._nodes[node], node))
        return ET.tostring(tree, encoding="unicode")

    def _grow(self, body: ET.Element, origin: np.ndarray, branch: _Branch) -> None:
        """Bodies of a stretch and of all that hangs on its end; every body's frame is the pipe's, moved to its hinges."""
        member = self.frame.members[branch.member]
        section, material = member.section, member.material
        length = float(np.linalg.norm(branch.end - branch.begin))
        weight = material.density * section.area
        ways = self._axes(branch.member)
        end_body, end_origin = body, origin
        if length > 1e-9:
            h = length / self.pieces
            way = (branch.end - branch.begin) / length
            last = branch.begin
            for k in range(self.pieces):
                middle = branch.begin + (k + 0.5) * h * way
                self._rod(end_body, last - end_origin, middle - end_origin, weight)
                end_body = ET.SubElement(end_body, "body", pos=_text(middle - end_origin))
                end_origin, last = middle, middle
                moduli = (
                    material.shear_modulus * section.torsion,
                    *(material.youngs_modulus * i for i in (section.iy, section.iz)),
                )
                for axis, modulus in zip(ways, moduli, strict=True):
                    name = f"{ROOT}/{len(self._hinges)}"
                    stiffness = modulus / h
                    self._hinges.append((name, stiffness))
                    ET.SubElement(
                        end_body,
                        "joint",
                        name=name,
                        type="hinge",
                        axis=_text(axis),
                        stiffness=f"{stiffness:.9g}",
                        pos="0 0 0",
                    )
                self._site(end_body, end_origin, middle)
            self._rod(end_body, last - end_origin, branch.end - end_origin, weight)
        self._site(end_body, end_origin, branch.end)
        for load in self.frame.loads:
            if load.node == branch.node and load.mass > 0:
                ET.SubElement(
                    end_body,
                    "geom",
                    type="sphere",
                    size="0.01",
                    pos=_text(branch.end - end_origin),
                    mass=f"{load.mass:.9g}",
                )
        for other in self._adjacent[branch.node]:
            if other == branch.member:
                continue
            a, b = self.frame.members[other].nodes
            far = b if a == branch.node else a
            self._grow(end_body, end_origin, _Branch(other, branch.end, self._nodes[far], far))

    def _axes(self, member: int) -> np.ndarray:
        """Rows: x, y and z of the member in the pipe's frame; the sections here are as stiff about y as about z."""
        a, b = self.frame.members[member].nodes
        x = _unit(self._nodes[b] - self._nodes[a])
        section = self.frame.members[member].section
        if abs(section.iy - section.iz) > 1e-9 * section.iy:
            raise InvalidInput(f"frame.members[{member}].section: must be as stiff about y as about z")
        y = _unit(np.cross(x, np.eye(3)[int(np.argmin(np.abs(x)))]))
        return np.array([x, y, np.cross(x, y)])

    def _rod(self, body: ET.Element, begin: np.ndarray, end: np.ndarray, weight: float) -> None:
        mass = weight * float(np.linalg.norm(end - begin))
        ET.SubElement(
            body,
            "geom",
            type="cylinder",
            fromto=f"{_text(begin)} {_text(end)}",
            size="0.005",
            mass=f"{max(mass, 1e-9):.9g}",
        )

    def _site(self, body: ET.Element, origin: np.ndarray, point: np.ndarray) -> None:
        name = f"{ROOT}/site/{len(self._sites)}"
        ET.SubElement(body, "site", name=name, pos=_text(point - origin), size="0.001")
        self._sites.append((name, point.copy()))

    # --- what it does ---------------------------------------------------------------------------------------------
    @property
    def points(self) -> np.ndarray:
        """(n, 3) points of the pipe whose displacement is reported, in the pipe's frame, not bent [m]."""
        return self._rest.copy()

    def _slowest(self) -> float:
        """Angular frequency of the slowest mode of the pipe in a hand that stands still [rad/s]."""
        mujoco = self._mujoco
        mujoco.mj_forward(self._model, self._data)
        inertia = np.zeros((len(self._dofs), len(self._dofs)))
        column, unit = np.zeros(self._model.nv), np.zeros(self._model.nv)
        for i, dof in enumerate(self._dofs):
            unit[:] = 0
            unit[dof] = 1
            mujoco.mj_mulM(self._model, self._data, column, unit)
            inertia[:, i] = column[self._dofs]
        root = np.diag(1 / np.sqrt(self._stiffness))
        return float(1 / np.sqrt(np.linalg.eigvalsh(root @ inertia @ root)[-1]))

    def _place_arm(self, q: np.ndarray, v: np.ndarray | None = None) -> None:
        self._data.qpos[self._arm_at] = q
        self._data.qvel[self._arm_dofs] = 0.0 if v is None else v

    def at_rest(self, q: np.ndarray) -> np.ndarray:
        """(n, 3) displacements of the points in the pipe's frame [m], the arm standing at q. Raises InvalidInput when the pipe folds."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._place_arm(np.asarray(q, float))
        for _ in range(200):
            self._mujoco.mj_forward(self._model, self._data)
            bent = -self._data.qfrc_bias[self._dofs] / self._stiffness
            change = float(np.abs(bent - self._data.qpos[self._at]).max())
            self._data.qpos[self._at] = bent
            if change < 1e-13:
                self._mujoco.mj_forward(self._model, self._data)
                return self._displacements()
        raise InvalidInput("frame: is so soft that it does not come to rest")

    def _displacements(self) -> np.ndarray:
        R = self._data.xmat[self._tool].reshape(3, 3) @ np.linalg.inv(self.grasp.T_object_hand)[:3, :3]
        origin = (
            self._data.xpos[self._tool]
            + self._data.xmat[self._tool].reshape(3, 3) @ np.linalg.inv(self.grasp.T_object_hand)[:3, 3]
        )
        out: np.ndarray = (self._data.site_xpos[self._site_ids] - origin) @ R - self._rest
        return out

    def carry(self, trajectory: JointTrajectory, settle: float = 1.0, every: int = 10) -> PipeMotion:
        """The arm moves along the trajectory from rest and stands still for `settle` [s]; displacements at each `every`-th step."""
        self.at_rest(trajectory.positions[0])
        self._data.qvel[:] = 0
        reference = _Hermite(trajectory)
        times, largest = [], []
        steps = int(np.ceil((trajectory.duration + settle) / self.time_step))
        for step in range(steps):
            q, v, a = reference.at(step * self.time_step)
            self._place_arm(q, v)
            self._data.qfrc_applied[self._arm_dofs] = _SERVO * a
            self._mujoco.mj_step(self._model, self._data)
            if step % every == 0:
                self._mujoco.mj_kinematics(self._model, self._data)
                times.append((step + 1) * self.time_step)
                largest.append(float(np.linalg.norm(self._displacements(), axis=1).max()))
        return PipeMotion(np.array(times), np.array(largest), trajectory.duration)


class _Hermite:
    """Cubics through a trajectory's positions and velocities: continuous speed."""

    def __init__(self, trajectory: JointTrajectory) -> None:
        self.times = np.asarray(trajectory.times)
        self.q, self.v = np.asarray(trajectory.positions), np.asarray(trajectory.velocities)

    def at(self, time: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Position, velocity and acceleration; at rest beyond the end."""
        if time >= self.times[-1]:
            return self.q[-1], np.zeros_like(self.q[-1]), np.zeros_like(self.q[-1])
        i = int(np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 2))
        h = self.times[i + 1] - self.times[i]
        s = (time - self.times[i]) / h
        q0, q1, v0, v1 = self.q[i], self.q[i + 1], h * self.v[i], h * self.v[i + 1]
        b, c = 3 * (q1 - q0) - 2 * v0 - v1, 2 * (q0 - q1) + v0 + v1
        return q0 + s * (v0 + s * (b + s * c)), (v0 + s * (2 * b + 3 * s * c)) / h, (2 * b + 6 * s * c) / h**2


def _unit(vector: np.ndarray) -> np.ndarray:
    out: np.ndarray = vector / np.linalg.norm(vector)
    return out


def _text(values: np.ndarray) -> str:
    return " ".join(f"{value:.12g}" for value in values)


def _quaternion(R: np.ndarray) -> np.ndarray:
    """(w, x, y, z) as MuJoCo has it."""
    from .._core import quat_xyzw_from_rotation

    x, y, z, w = quat_xyzw_from_rotation(R)
    return np.array([w, x, y, z])
