"""Pictures of a run from its recorded states: single frames, a strip, an animated GIF.

The renderer "own" is the library's software renderer and needs nothing; "mujoco" is MuJoCo's, which needs OpenGL without a display
(MUJOCO_GL=egl or osmesa).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from .. import _core
from .._core import Hand, InvalidInput, JointTrajectory, Robot, World
from ..bodies import SceneBodies, floor_tiles
from ..viz.film import write_gif as write_gif
from ..viz.png import write_png
from ..viz.raster import Camera, Scene, render
from ..viz.style import FLOOR, OBSTACLE, PART, ROBOT, ROBOT_ARM
from .control import RecordedState
from .model import SimPart
from .result import SimResult
from .simulation import Simulation

FLOOR_REACH = 4.0  # of the floor drawn round what the camera looks at [m]


class Painter:
    """Draws recorded states of a robot, a scene and parts with the software renderer. Needs no MuJoCo."""

    def __init__(self, robot: Robot, gripper: Hand | None, world: World, parts: Iterable[SimPart]):
        self.bodies = SceneBodies.of_world(robot, world, parts)
        self.fingers = set(gripper.finger_links) if gripper else set()
        self.limits = {j["name"]: (j["lower"], j["upper"]) for j in robot.joint_table}

    def picture(self, state: RecordedState, camera: Camera) -> np.ndarray:
        """uint8 (height, width, 3)."""
        scene = Scene()
        middle = np.asarray(camera.target, float)[:2]
        scene.add(*floor_tiles(middle - FLOOR_REACH, middle + FLOOR_REACH, self.bodies.floor), FLOOR)
        for body in self.bodies.obstacles:
            scene.add(body.vertices_at(), body.faces, OBSTACLE)
        # Physics may stand a hair beyond a limit, which the model refuses.
        joints = {n: float(np.clip(v, *self.limits[n])) for n, v in state["joints"].items()}
        poses = self.bodies.link_poses(joints, state["base"])
        for link in self.bodies.links:
            colour = ROBOT_ARM if link.name in self.fingers else ROBOT
            scene.add(link.vertices_at(poses[link.name]), link.faces, colour)
        for part in self.bodies.parts.values():
            scene.add(part.vertices_at(state["parts"][part.name]), part.faces, PART)
        return render(scene, camera)


def planned_states(
    robot: Robot,
    trajectory: JointTrajectory,
    times: Iterable[float],
    parts: Iterable[SimPart] = (),
    *,
    joints: dict[str, float] | None = None,
    attached: tuple[str, float, str] | None = None,
) -> list[RecordedState]:
    """States for a Painter from the plan alone, without physics.

    `joints` stand where a trajectory does not move them. `attached` = (part, time, link): the part moves with the link from then on.
    """

    def state(time: float) -> RecordedState:
        q = dict(zip(trajectory.names, map(float, trajectory.at(time)), strict=True))
        base = [q.pop(n, 0.0) for n in ("x", "y", "theta")]
        return {"time": float(time), "base": base, "joints": {**(joints or {}), **q}, "parts": {}}

    def link_pose(of: RecordedState, link: str) -> np.ndarray:
        x, y, theta = of["base"]
        return robot.link_poses(of["joints"], _core.pose([x, y, 0], rpy=[0, 0, theta]))[link]

    states = []
    for time in times:
        now = state(time)
        for part in parts:
            T = np.asarray(part.pose, float)
            if attached and attached[0] == part.name and time > attached[1]:
                T = link_pose(now, attached[2]) @ np.linalg.inv(link_pose(state(attached[1]), attached[2])) @ T
            now["parts"][part.name] = T
        states.append(now)
    return states


def frames(
    sim: Simulation,
    result: SimResult,
    times: Sequence[float] | None = None,
    *,
    eye: Sequence[float],
    target: Sequence[float],
    width: int = 480,
    height: int = 360,
    renderer: str = "own",
) -> list[np.ndarray]:
    """Pictures (height, width, 3) of the states nearest to the times [s], or of all recorded ones.

    The camera looks from `eye` to `target` [m]. Raises InvalidInput for an unknown renderer and where OpenGL is missing.
    """
    if renderer not in ("own", "mujoco"):
        raise InvalidInput(f"renderer = {renderer!r}: must be own or mujoco")
    clock = np.array([s["time"] for s in result.states])
    chosen = range(len(clock)) if times is None else [int(np.abs(clock - t).argmin()) for t in times]
    states = [result.states[i] for i in chosen]
    camera = Camera(np.asarray(eye, float), np.asarray(target, float), width, height)
    if renderer == "mujoco":
        return _mujoco_frames(sim, states, camera)
    painter = Painter(sim.robot, sim.gripper, sim.world, sim.parts.values())
    return [painter.picture(state, camera) for state in states]


def _mujoco_frames(sim: Simulation, states: list[RecordedState], camera: Camera) -> list[np.ndarray]:
    mujoco = sim.mujoco
    try:
        made = mujoco.Renderer(sim.model, camera.height, camera.width)
    except Exception as error:
        raise InvalidInput(
            f"renderer = 'mujoco': no OpenGL without a display here (MUJOCO_GL=egl or osmesa): {error}; renderer='own' needs none"
        ) from None
    view = mujoco.MjvCamera()
    line = camera.eye - camera.target
    view.lookat[:] = camera.target
    view.distance = np.linalg.norm(line)
    view.azimuth = np.degrees(np.arctan2(-line[1], -line[0]))
    view.elevation = np.degrees(np.arcsin(-line[2] / view.distance))
    data = mujoco.MjData(sim.model)
    pictures = []
    for state in states:
        for name, address in sim.address.items():
            data.qpos[address] = state["joints"][name]
        if sim.base is not None:
            sim.base.place(state["base"], data)
        for name, T in state["parts"].items():
            at = int(sim.model.joint(f"part/{name}").qposadr[0])
            quat = np.zeros(4)
            mujoco.mju_mat2Quat(quat, np.ascontiguousarray(T[:3, :3]).ravel())
            data.qpos[at : at + 7] = [*T[:3, 3], *quat]
        mujoco.mj_forward(sim.model, data)
        made.update_scene(data, view)
        pictures.append(made.render().copy())
    made.close()
    return pictures


def write_strip(path: str | Path, pictures: Sequence[np.ndarray], columns: int = 4, gap: int = 4) -> Path:
    """PNG of pictures of one size in rows, in reading order."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    sheet = np.full((rows * (height + gap) - gap, columns * (width + gap) - gap, 3), 255, np.uint8)
    for i, picture in enumerate(pictures):
        y, x = (i // columns) * (height + gap), (i % columns) * (width + gap)
        sheet[y : y + height, x : x + width] = picture
    return write_png(path, sheet)
