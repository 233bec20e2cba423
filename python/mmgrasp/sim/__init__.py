"""Planned motions carried out in physics (MuJoCo): a tracked base, driven joints, closing fingers, friction and contact only.

    from mmgrasp import sim

    run = sim.Simulation(robot, world, [sim.SimPart("box", shapes, T_world_box)], gripper=gripper).run(trajectory, arm=arm)
    run.grasped, run.parts["box"].cause, run.contacts

Closed loops: give `SimScene.drive` a controller of your own (see `sim.control`). Needs the extra `sim` (docs/methods/sim.md). Pictures of a run need nothing more: see `frames`.
"""

from .control import Command as Command
from .control import Controller as Controller
from .control import Observer as Observer
from .control import RecordedState as RecordedState
from .control import Recorder as Recorder
from .control import SceneState as SceneState
from .execution import Execution as Execution
from .model import Physics as Physics
from .model import SimPart as SimPart
from .model import build as build
from .result import ContactEvent as ContactEvent
from .result import PartMotion as PartMotion
from .result import SimResult as SimResult
from .rolling import RollingBase as RollingBase
from .scene import SimScene as SimScene
from .simulation import Simulation as Simulation
