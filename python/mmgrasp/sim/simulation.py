"""Runs planned motions in MuJoCo: tracked base, driven arm, closing gripper; contact and friction only."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .._core import Gripper, InvalidInput, JointGroup, JointTrajectory, Robot, World
from .model import BASE_JOINTS, Physics, SimPart, build
from .result import SimResult

GIVE = 0.005  # a finger this far from where it should be presses with all its force [m]


def mujoco_module() -> Any:
    """MuJoCo, or an error that says how to get it."""
    try:
        import mujoco
    except ImportError:
        raise InvalidInput("the simulation needs MuJoCo: pip install 'mmgrasp[sim]'") from None
    return mujoco


@dataclass
class Execution:
    """How a trajectory is run. Times are those of the plan; `speed` stretches them all."""

    speed: float = 1.0
    """Share of the planned speed, in (0, 1]."""
    close_at: float | None = None
    """Plan time at which the gripper begins to close [s]; None: at the plan's end."""
    opening: float | None = None
    """Of the gripper at first [m]; None: fully open."""
    closing_speed: float = 0.1
    """How fast the opening shrinks [m/s] (P1 4.4.1); not stretched by `speed`."""
    lift: float = 0.1
    """The tool then rises this far [m]; 0: no lift."""
    lift_time: float = 2.0
    """[s]"""
    hold: float = 2.0
    """And stands this long [s]."""
    tracking: dict[str, Any] = field(default_factory=dict)
    """Keywords of BaseTracker; kp, feedback, ..."""
    slip: tuple[float, float] = (0.0, 0.0)
    """Share of the left and right wheel's speed that is lost; in [0, 1)."""
    travel_noise: float = 0.0
    """Deviation of a wheel's travel after 1 m [m]."""
    position_noise: float = 0.0
    """Deviation of the base's measured x and y [m]."""
    heading_noise: float = 0.0
    """Deviation of its measured heading [rad]."""
    frame_period: float = 0.04
    """Between two recorded states [s]."""
    seed: int = 1
    """Same seed, same run."""

    def check(self) -> None:
        def rule(name: str, holds: bool, text: str) -> None:
            if not holds:
                raise InvalidInput(f"{name} = {getattr(self, name)!r}: must {text}")

        rule("speed", 0 < self.speed <= 1, "lie in (0, 1]")
        for name in ("closing_speed", "lift_time", "frame_period"):
            rule(name, 0 < getattr(self, name) < np.inf, "be finite and positive")
        for name in ("lift", "hold", "travel_noise", "position_noise", "heading_noise"):
            rule(name, 0 <= getattr(self, name) < np.inf, "be finite and not negative")
        rule("slip", len(self.slip) == 2 and all(0 <= s < 1 for s in self.slip), "be two shares in [0, 1)")
        rule("close_at", self.close_at is None or 0 <= self.close_at < np.inf, "be a time of the plan")
        rule("opening", self.opening is None or 0 <= self.opening < np.inf, "be finite and not negative")


class Simulation:
    """A robot among obstacles and loose parts. Built once, run as often as wanted, each time from the start."""

    def __init__(
        self,
        robot: Robot,
        scene: World,
        parts: Iterable[SimPart] = (),
        *,
        gripper: Gripper | None = None,
        physics: Physics | None = None,
        joints: dict[str, float] | None = None,
    ):
        """`joints`: where joints stand that a trajectory does not name. Raises InvalidInput without MuJoCo."""
        self.mujoco = mujoco_module()
        self.robot, self.scene, self.gripper = robot, scene.copy(), gripper
        self.physics = physics or Physics()
        self.parts = {part.name: part for part in parts}
        self.built = build(robot, scene, self.parts.values(), gripper, self.physics)
        self.joints = dict(joints or {})
        for name in self.joints:
            if name not in self.built.joints:
                raise InvalidInput(f"joints['{name}']: the robot has no such joint")
        mujoco = self.mujoco
        self.model = mujoco.MjModel.from_xml_string(self.built.xml)
        self.data = mujoco.MjData(self.model)
        self._weigh_parts()
        self.actuator = {name: self.model.actuator(name).id for name in self.built.joints}
        self.address = {name: int(self.model.joint(name).qposadr[0]) for name in self.built.joints}
        self.moves = robot.base != "fixed"
        self.base_address = [int(self.model.joint(n).qposadr[0]) for n in BASE_JOINTS] if self.moves else []
        self.base_actuator = [self.model.actuator(n).id for n in BASE_JOINTS] if self.moves else []
        self.owner = [self.built.owner[self.model.geom(i).name] for i in range(self.model.ngeom)]
        self.is_part = [name in self.parts for name in self.owner]

    def _weigh_parts(self) -> None:
        for part in self.parts.values():
            body = self.model.body(f"part/{part.name}").id
            scale = part.mass / self.model.body_mass[body]
            self.model.body_mass[body] *= scale
            self.model.body_inertia[body] *= scale
        self.mujoco.mj_setConst(self.model, self.data)

    def part_pose(self, name: str) -> np.ndarray:
        """T_world_part now, (4, 4)."""
        return self._pose(f"part/{name}")

    def _pose(self, body: str) -> np.ndarray:
        T = np.eye(4)
        b = self.data.body(body)
        T[:3, :3] = b.xmat.reshape(3, 3)
        T[:3, 3] = b.xpos
        return T

    def base_pose(self) -> np.ndarray:
        """(x, y, theta) now."""
        return self.data.qpos[self.base_address].copy() if self.moves else np.zeros(3)

    def reset(self, base: np.ndarray, joints: dict[str, float]) -> None:
        """Robot and parts back to a start, at rest."""
        self.mujoco.mj_resetData(self.model, self.data)
        for name, value in joints.items():
            self.data.qpos[self.address[name]] = value
        if self.moves:
            self.data.qpos[self.base_address] = base
        self.mujoco.mj_forward(self.model, self.data)
        self._tune()

    def _tune(self) -> None:
        """Gains from the inertia each joint carries: critically damped, the base's wheels following within 20 ms."""
        w = self.physics.stiffness
        for name, index in self.actuator.items():
            inertia = self._inertia(name)
            stiff = self.physics.grip_force / GIVE if name in self.built.fingers else inertia * w * w
            self._gains(index, stiff, 2 * np.sqrt(stiff * inertia))
        for name, index in zip(BASE_JOINTS, self.base_actuator, strict=True) if self.moves else ():
            self._gains(index, 0.0, self._inertia(name) / 0.02)

    def _inertia(self, joint: str) -> float:
        """What a joint has to accelerate where the robot stands now [kg or kg m^2]."""
        unit, product = np.zeros(self.model.nv), np.zeros(self.model.nv)
        dof = int(self.model.joint(joint).dofadr[0])
        unit[dof] = 1.0
        self.mujoco.mj_mulM(self.model, self.data, product, unit)
        return float(product[dof])

    def _gains(self, index: int, kp: float, kv: float) -> None:
        self.model.actuator_gainprm[index, 0] = kp if kp > 0 else kv
        self.model.actuator_biasprm[index, 1] = -kp
        self.model.actuator_biasprm[index, 2] = -kv

    def run(
        self,
        trajectory: JointTrajectory,
        *,
        base: Any = (0.0, 0.0, 0.0),
        arm: JointGroup | None = None,
        **execution: Any,
    ) -> SimResult:
        """Runs a trajectory: joints by its names, the base by its columns x, y, theta (else it stands at `base`).

        The gripper closes at `close_at`; with an `arm` (a group without base) the tool then rises by `lift`, and everything stands
        for `hold` seconds. Keywords are the fields of Execution.
        """
        from .execution import Run

        try:
            how = Execution(**execution)
        except TypeError as error:
            raise InvalidInput(f"run(): {error}") from None
        how.check()
        return Run(self, trajectory, np.asarray(base, float), arm, how).result()

    def contact_forces(self) -> dict[tuple[str, str], float]:
        """Normal force [N] by pair of bodies that touch now; names in alphabetical order."""
        forces: dict[tuple[str, str], float] = {}
        wrench = np.zeros(6)
        for i in range(self.data.ncon):
            first, second = self.data.contact.geom[i]
            self.mujoco.mj_contactForce(self.model, self.data, i, wrench)
            if wrench[0] <= 0:
                continue
            pair = tuple(sorted((self.owner[first], self.owner[second])))
            forces[pair] = forces.get(pair, 0.0) + float(wrench[0])
        return forces
