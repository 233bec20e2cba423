"""How the base moves in physics: pushed along x, y and theta by forces on three joints, or rolling on its own wheels.

The three joints follow any velocity, sideways too, and slip is given. On wheels the robot stands with its weight on two driven wheels and on
casters without friction; friction at the rims alone drives and turns it, so that it slips, skids and tilts as far as physics says.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from .control import body_to_world
from .rolling import BASE_JOINTS, ROOT_JOINT, RollingBase

FOLLOWS_IN = 0.02  # velocities of joints and wheels are followed within [s]


class BaseDrive(Protocol):
    """What carries the base in a built model."""

    def pose(self) -> np.ndarray:
        """(x, y, theta) now."""

    def place(self, pose: ArrayLike, data: Any) -> None:
        """Puts the base of these MuJoCo data there."""

    def tune(self) -> None:
        """Gains from what is carried where the robot stands."""

    def command(self, velocity: np.ndarray) -> None:
        """Velocity ahead, to the left [m/s] and turning rate [rad/s] in the platform's frame for the next step."""


class JointDrive:
    """Forces on x, y and theta."""

    def __init__(self, scene: Any) -> None:
        self.scene, model = scene, scene.model
        self.address = [int(model.joint(n).qposadr[0]) for n in BASE_JOINTS]
        self.actuator = [model.actuator(n).id for n in BASE_JOINTS]

    def pose(self) -> np.ndarray:
        """(x, y, theta) now."""
        return np.array(self.scene.data.qpos[self.address])

    def place(self, pose: ArrayLike, data: Any) -> None:
        """Puts the base of these MuJoCo data there."""
        data.qpos[self.address] = pose

    def tune(self) -> None:
        """Gains from what each joint carries now."""
        for name, index in zip(BASE_JOINTS, self.actuator, strict=True):
            self.scene.gains(index, 0.0, self.scene.inertia(name) / FOLLOWS_IN)

    def command(self, velocity: np.ndarray) -> None:
        """The same velocity goes to the joints in the world's axes, as the base is turned now."""
        self.scene.data.ctrl[self.actuator] = body_to_world(velocity, float(self.pose()[2]))


class WheelDrive:
    """Turning rates of two wheels that stand on the floor; the arm's joints are held against their weight by themselves."""

    def __init__(self, scene: Any, rolling: RollingBase) -> None:
        self.scene, self.rolling, model = scene, rolling, scene.model
        self.root = int(model.joint(ROOT_JOINT).qposadr[0])
        self.actuator = [model.actuator(n).id for n in (rolling.left, rolling.right)]
        self.held = [int(model.joint(n).dofadr[0]) for n in scene.built.joints]

    def pose(self) -> np.ndarray:
        """(x, y, theta) of the root now; it tilts by some milliradians besides."""
        x, y, _, qw, qx, qy, qz = self.scene.data.qpos[self.root : self.root + 7]
        return np.array([x, y, np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2))])

    def place(self, pose: ArrayLike, data: Any) -> None:
        """Puts the robot of these MuJoCo data on the floor there."""
        x, y, theta = np.asarray(pose, float)
        z, half = self.scene.built.floor - self.rolling.height, theta / 2
        data.qpos[self.root : self.root + 7] = [x, y, z, np.cos(half), 0, 0, np.sin(half)]

    def tune(self) -> None:
        """Wheels carry the robot's mass between them."""
        root = self.scene.model.body(f"link/{self.scene.robot.links[0]}").id
        carried = float(self.scene.model.body_subtreemass[root]) / 2
        for index in self.actuator:
            self.scene.gains(index, 0.0, carried * self.rolling.radius**2 / FOLLOWS_IN)

    def command(self, velocity: np.ndarray) -> None:
        """Rims at v -+ omega track / 2."""
        ahead, _, omega = velocity
        side = omega * self.rolling.track / 2
        data = self.scene.data
        data.ctrl[self.actuator] = np.array([ahead - side, ahead + side]) / self.rolling.radius
        data.qfrc_applied[self.held] = data.qfrc_bias[self.held]
