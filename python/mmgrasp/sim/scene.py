"""A robot, obstacles and loose parts as one MuJoCo model: where everything is, and what touches what."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from .._core import Error, Hand, InvalidInput, Robot, World
from .base_drive import BaseDrive, JointDrive, WheelDrive
from .control import Command, Controller, Observer
from .model import Physics, SimPart, build

GIVE = 0.005  # a finger this far from where it should be presses with all its force [m]


def mujoco_module() -> Any:
    """MuJoCo, or an error that says how to get it."""
    try:
        import mujoco
    except ImportError:
        raise InvalidInput("the simulation needs MuJoCo: pip install 'mmgrasp[sim]'") from None
    if (
        mujoco.get_mju_user_warning() is None
    ):  # by itself it writes a file into the working folder; drive() raises instead
        mujoco.set_mju_user_warning(lambda message: None)
    return mujoco


class SimScene:
    """A robot among obstacles and loose parts; back at the start as often as wanted."""

    def __init__(
        self,
        robot: Robot,
        world: World,
        parts: Iterable[SimPart] = (),
        *,
        gripper: Hand | None = None,
        physics: Physics | None = None,
        joints: dict[str, float] | None = None,
    ):
        """`joints`: where joints stand that a trajectory does not name. Raises InvalidInput without MuJoCo."""
        self.mujoco = mujoco_module()
        self.robot, self.world, self.gripper = robot, world.copy(), gripper
        self.physics = physics or Physics()
        self.parts = {part.name: part for part in parts}
        self.built = build(robot, world, self.parts.values(), gripper, self.physics)
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
        self.base: BaseDrive | None = None
        if self.moves:
            rolling = self.physics.rolling
            self.base = JointDrive(self) if rolling is None else WheelDrive(self, rolling)
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
        if name not in self.parts:
            raise InvalidInput(f"part '{name}': is none of {', '.join(self.parts) or 'no part'}")
        return self.body_pose(f"part/{name}")

    def body_pose(self, body: str) -> np.ndarray:
        """T_world_body now, (4, 4); bodies are called link/NAME and part/NAME."""
        T = np.eye(4)
        b = self.data.body(body)
        T[:3, :3] = b.xmat.reshape(3, 3)
        T[:3, 3] = b.xpos
        return T

    def base_pose(self) -> np.ndarray:
        """(x, y, theta) now."""
        return self.base.pose() if self.base is not None else np.zeros(3)

    def joint(self, name: str) -> float:
        """Where a driven joint stands now [rad or m]."""
        return float(self.data.qpos[self.address[name]])

    def reset(self, base: np.ndarray, joints: dict[str, float]) -> None:
        """Robot and parts back to a start, at rest."""
        at = np.asarray(base, float)
        if at.shape != (3,) or not np.isfinite(at).all():
            raise InvalidInput(f"base = {base!r}: must be three finite numbers x, y, theta")
        for name, value in joints.items():
            if name not in self.address or not np.isfinite(value):
                raise InvalidInput(f"joints['{name}'] = {value!r}: must be a finite number of a driven joint")
        self.mujoco.mj_resetData(self.model, self.data)
        for name, value in joints.items():
            self.data.qpos[self.address[name]] = value
        self._place_followers()
        if self.base is not None:
            self.base.place(at, self.data)
        self.mujoco.mj_forward(self.model, self.data)
        self._tune()

    def _place_followers(self) -> None:
        """Joints that follow another one (`mimic`) stand where that one asks."""
        model = self.model
        for kind, first, second, line in zip(
            model.eq_type, model.eq_obj1id, model.eq_obj2id, model.eq_data, strict=True
        ):
            if kind == self.mujoco.mjtEq.mjEQ_JOINT and second >= 0 and model.joint(first).name not in self.address:
                self.data.qpos[model.jnt_qposadr[first]] = line[0] + line[1] * self.data.qpos[model.jnt_qposadr[second]]

    def drive(
        self,
        controller: Controller,
        observers: Sequence[Observer] = (),
        *,
        time_limit: float = np.inf,
    ) -> float:
        """Steps the physics under a controller, from the state of reset(), until it has finished; returns the time that took [s].

        Ends at `time_limit` [s] of the scene's own clock, too. Raises InvalidInput for a period that is no multiple of the time
        step, for joints the robot does not drive and for commands of the wrong size.
        """
        h = self.physics.time_step
        every = round(controller.period / h) if 0 < controller.period < np.inf else 0
        if every < 1 or abs(every * h - controller.period) > 1e-9:
            raise InvalidInput(f"period = {controller.period!r}: must be a multiple of the time step {h} s")
        for name in controller.joints:
            if name not in self.actuator:
                raise InvalidInput(f"joints: '{name}' is no driven joint of the robot")
        actuators = [self.actuator[name] for name in controller.joints]
        if not time_limit >= 0:
            raise InvalidInput(f"time_limit = {time_limit!r}: must be a time [s], >= 0")
        step, time, velocity = 0, 0.0, np.zeros(3)
        kinds = self.mujoco.mjtWarning
        bad = [int(k) for k in (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC, kinds.mjWARN_BADCTRL)]
        while time < time_limit and not controller.finished(time, self):
            if step % every == 0:
                velocity = self._apply(controller.command(time, self), actuators)
            for observer in observers:
                observer.before(step, time, self)
            if self.base is not None:
                self.base.command(velocity)
            self.mujoco.mj_step(self.model, self.data)
            if self.data.warning.number[bad].any():  # MuJoCo then goes on with zeros, or begins again
                raise Error(f"the physics diverged after {time:.3f} s: commands beyond what the robot can do?")
            for observer in observers:
                observer.after(step, time, self)
            step += 1
            time = step * h
        return time

    def _apply(self, command: Command, actuators: list[int]) -> np.ndarray:
        if not isinstance(command, Command):
            raise InvalidInput(f"controller.command() gave {command!r}: must give a Command")
        try:
            joints, base = np.asarray(command.joints, float), np.asarray(command.base, float)
        except (TypeError, ValueError):
            raise InvalidInput(f"{command!r}: joints and base must be numbers") from None
        if joints.shape != (len(actuators),) or not np.isfinite(joints).all():
            raise InvalidInput(
                f"command.joints: must be {len(actuators)} finite numbers, one for each of the controller's joints"
            )
        if base.shape != (3,) or not np.isfinite(base).all() or (not self.moves and base.any()):
            raise InvalidInput("command.base: must be three finite numbers vx, vy, omega, all 0 for a fixed base")
        self.data.ctrl[actuators] = joints
        return base

    def _tune(self) -> None:
        """Gains from the inertia each joint carries: critically damped, the base following within 20 ms."""
        w = self.physics.stiffness
        for name, index in self.actuator.items():
            inertia = self.inertia(name)
            drive = self.built.fingers.get(name)
            stiff = drive.stiffness(self.physics.grip_force / GIVE) if drive else inertia * w * w
            self.gains(index, stiff, 2 * np.sqrt(stiff * inertia))
        if self.base is not None:
            self.base.tune()

    def inertia(self, joint: str) -> float:
        """What a joint has to accelerate where the robot stands now [kg or kg m^2]."""
        unit, product = np.zeros(self.model.nv), np.zeros(self.model.nv)
        dof = int(self.model.joint(joint).dofadr[0])
        unit[dof] = 1.0
        self.mujoco.mj_mulM(self.model, self.data, product, unit)
        return float(product[dof])

    def gains(self, index: int, kp: float, kv: float) -> None:
        """Those of an actuator, by position and by velocity."""
        self.model.actuator_gainprm[index, 0] = kp if kp > 0 else kv
        self.model.actuator_biasprm[index, 1] = -kp
        self.model.actuator_biasprm[index, 2] = -kv

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
