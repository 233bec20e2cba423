"""Planned motions carried out in physics (MuJoCo): a tracked base, driven joints, closing fingers, friction and contact only.

    from mmgrasp import sim

    run = sim.Simulation(robot, scene, [sim.SimPart("box", shapes, T_world_box)], gripper=gripper).run(trajectory, arm=arm)
    run.grasped, run.parts["box"].cause, run.contacts

Needs the extra `sim` (docs/methods/sim.md). Pictures of a run need nothing more: see `frames`.
"""

from .execution import Execution
from .model import Physics, SimPart, build
from .result import ContactEvent, PartMotion, SimResult
from .simulation import Simulation

__all__ = ["ContactEvent", "Execution", "PartMotion", "Physics", "SimPart", "SimResult", "Simulation", "build"]
