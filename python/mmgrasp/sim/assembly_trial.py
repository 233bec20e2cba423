"""An assembly put together in physics, part after part, by the grippers that were designed for it, on a fixed arm.

Parts and jig are bodies of revolution about vertical axes here (`sim.convex_rings`); each part waits on a post narrower than itself, turned
as it will stand. The arm knows the nominal poses only: each post's part and each piece of the jig stands off by its own noise. All parts but the
jig's move freely the whole time; a gripper change brings them to rest. Each is judged after its own operation and once more at the very end.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .._core import AssemblyGrasp, Cylinder, Gripper, InvalidInput, LinkShape, World
from ..grippers.assembly_file import Assembly, AssemblyStep
from ..grippers.planning import GripperPlan
from .control import Command, RecordedState, Recorder, SceneState
from .convex_rings import Slice, convex_shapes, revolution_slices
from .gripper_arm import GripperArm, gripper_arm
from .insertion import Errand, Insertion
from .model import Physics, SimPart
from .scene import SimScene

Points = NDArray[np.float64]

CELL = (0.55, 0.10, 0.12)  # the assembly's origin [m]
POSTS, APART, POST = (0.40, -0.22), 0.09, 0.10  # first post, next one along x, height [m]
OVER = 0.02  # a part is carried so far above everything [m]
SLIM = 0.9  # radius of a post over that of the part's lower end
HOME = (0.0, 0.0, 1.5708, 0.0, 1.5708, 0.0)
DEEP, ASIDE, TILTED = 0.0005, 0.0003, np.radians(2)  # a part is in its place within these [m], [rad]
REST = 1.0  # after an operation the tool stands still so long before parts are judged [s]
FORCE = 40.0  # of each finger [N]
HARD = (0.99, 0.999)  # of contacts, see Physics.impedance
STOP = (0.004, 1.0)  # `solref` of the ends of a drive's stroke
ASLEEP = 1e-6  # bodies slower than this are at rest until something that moves touches them [m/s]
LEAST_MASS = 0.01  # contacts of lighter parts would give way by millimetres where fingers press with FORCE [kg]


@dataclass
class TrialChoice:
    """How an assembly is tried."""

    jig: Sequence[str]
    """Parts that are fixed: the first is taken as it is (a plate), the others are bodies of revolution on it."""
    noise: float = 0.0005
    """Standard deviation of each part's and each jig piece's x and y [m]."""
    widen: Mapping[str, float] = field(default_factory=dict)
    """Added to the radius of a part's holes [m]."""
    record: float = np.inf
    """A state is kept every so often [s]."""


@dataclass(frozen=True)
class PartPlace:
    """Where a part is, against where it must be."""

    name: str
    deep: float
    """How much higher than its place it is [m]."""
    aside: float
    """From the axis of the jig piece it belongs to [m]."""
    tilted: float
    """[rad]"""

    @property
    def there(self) -> bool:
        """It is in its place, to DEEP, ASIDE and TILTED."""
        return abs(self.deep) < DEEP and self.aside < ASIDE and self.tilted < TILTED


@dataclass(frozen=True)
class OperationOutcome:
    """What became of one operation."""

    name: str
    gripper: str
    place: PartPlace
    """Where its part was when the tool had left it and stood still."""
    searched: float = 0.0
    """Time on the spiral [s]."""
    duration: float = 0.0
    """[s]"""
    why: str = ""
    """What went wrong."""

    @property
    def success(self) -> bool:
        """The gripper brought the part to its place, let go, and the part was there."""
        return not self.why


@dataclass(frozen=True)
class AssemblyOutcome:
    """What became of an assembly, or of what was tried of it."""

    operations: list[OperationOutcome]
    """Those that were tried: up to the first that failed."""
    places: list[PartPlace]
    """Every part that was brought, at the very end."""
    asked: int
    """So many operations were to be done."""

    @property
    def left(self) -> list[PartPlace]:
        """Parts that are not in their places at the end, although their own operations succeeded."""
        failed = {o.place.name for o in self.operations if not o.success}
        return [place for place in self.places if not place.there and place.name not in failed]

    @property
    def complete(self) -> bool:
        """Every operation succeeded, and at the end every part is in its place."""
        done = sum(operation.success for operation in self.operations)
        return done == self.asked and all(place.there for place in self.places)

    @property
    def why(self) -> str:
        """What went wrong, '' nothing."""
        failed = [o.why for o in self.operations if not o.success]
        return "; ".join([*failed, *(f"{place.name} left its place" for place in self.left)])


@dataclass
class Film:
    """States of one operation, and what is needed to draw them."""

    tool: GripperArm
    world: World
    parts: list[SimPart]
    states: list[RecordedState]
    released: float
    """When the fingers began to open [s]."""


class AssemblyCell:
    """The cell of an assembly: shapes are made once, `run` as often as wanted."""

    def __init__(self, assembly: Assembly, choice: TrialChoice):
        """Raises InvalidInput for parts of the jig that are none, and for operations that move several parts."""
        self.assembly, self.choice = assembly, choice
        for name in choice.jig:
            if name not in assembly.parts:
                raise InvalidInput(f"jig: '{name}' is no part of {assembly.name}")
        for step in assembly.steps:
            if len(step.active) > 1:
                raise InvalidInput(
                    f"operation '{step.name}': moves {len(step.active)} parts; one at a time can be tried"
                )
        self.loose = [step.active[0] for step in assembly.steps]
        self.slices: dict[str, list[Slice]] = {}
        for name in [*choice.jig[1:], *self.loose]:
            part = assembly.parts[name]
            T = part.pose.copy()
            T[:2, 3] = 0
            self.slices[name] = revolution_slices(part.mesh, T, choice.widen.get(name, 0.0))
        self.shapes = {name: convex_shapes(slices) for name, slices in self.slices.items()}
        self.tools: dict[tuple[tuple[str, object], ...], GripperArm] = {}

    def goal(self, name: str) -> Points:
        """T_world_axis of a part in its place, nominal: heights as in the assembly."""
        x, y = self.assembly.parts[name].pose[:2, 3]
        return _core.pose([CELL[0] + x, CELL[1] + y, CELL[2]])

    def waiting(self, name: str) -> Points:
        """T_world_axis of a part on its post, nominal."""
        return _core.pose([POSTS[0] + APART * self.loose.index(name), POSTS[1], POST - self.slices[name][0].low])

    def belongs_to(self, name: str) -> str:
        """The jig piece on whose axis a part is put."""
        at = self.assembly.parts[name].pose[:2, 3]
        pieces = self.choice.jig[1:]
        return min(pieces, key=lambda p: float(np.linalg.norm(self.assembly.parts[p].pose[:2, 3] - at)))

    def run(
        self,
        grippers: Sequence[Gripper],
        grasps: Sequence[AssemblyGrasp],
        seed: int,
        films: list[Film] | None = None,
        steps: Sequence[str] | None = None,
    ) -> AssemblyOutcome:
        """The operations in their order, each with its gripper and grasp; ends with the first that fails.

        `steps`: only these operations, everything before them in its place already. States are added to `films`.
        """
        rng = np.random.default_rng(seed)
        names = [*self.choice.jig[1:], *self.loose]
        off = {name: np.append(rng.normal(scale=self.choice.noise, size=2), 0.0) for name in names}
        world = self._world({name: off[name] for name in self.choice.jig[1:]})
        goals = {name: _moved(self.goal(name), off[self.belongs_to(name)]) for name in self.loose}
        poses = {name: _moved(self.waiting(name), off[name]) for name in self.loose}
        wanted = [step.name for step in self.assembly.steps if steps is None or step.name in steps]
        outcomes: list[OperationOutcome] = []
        brought: list[str] = []
        for step, gripper, grasp in zip(self.assembly.steps, grippers, grasps, strict=True):
            if len(outcomes) == len(wanted) or (outcomes and not outcomes[-1].success):
                break
            brought.append(step.active[0])
            if step.name in wanted:
                outcomes.append(self._operation(step, gripper, grasp, world, poses, goals, films))
            else:
                poses[brought[-1]] = goals[brought[-1]]
        places = [_place(name, poses[name], goals[name]) for name in brought]
        return AssemblyOutcome(outcomes, places, len(wanted))

    def _world(self, off: Mapping[str, Points]) -> World:
        world = World()
        plate = self.assembly.parts[self.choice.jig[0]]
        T = _core.pose(CELL) @ plate.pose
        world.add(self.choice.jig[0], [LinkShape(plate.mesh)], T)
        for name, shift in off.items():
            world.add(name, self.shapes[name], _moved(self.goal(name), shift))
        for name in self.loose:
            low = self.slices[name][0]
            at = self.waiting(name)
            post = LinkShape(Cylinder(SLIM * low.outer[0], POST))
            world.add(f"post of {name}", [post], _core.pose([at[0, 3], at[1, 3], POST / 2]))
        return world

    def _tool(self, gripper: Gripper) -> GripperArm:
        key = tuple(gripper.to_dict().items())
        if key not in self.tools:
            self.tools[key] = gripper_arm(gripper)
        return self.tools[key]

    def _operation(
        self,
        step: AssemblyStep,
        gripper: Gripper,
        grasp: AssemblyGrasp,
        world: World,
        poses: dict[str, Points],
        goals: Mapping[str, Points],
        films: list[Film] | None,
    ) -> OperationOutcome:
        """One operation, all loose parts free; where they are afterwards goes to `poses`."""
        tool, name = self._tool(gripper), step.active[0]
        parts = [SimPart(n, self.shapes[n], poses[n], mass=self._mass(n)) for n in self.loose]
        physics = Physics(grip_force=FORCE, impedance=HARD)
        scene = SimScene(tool.robot, world, parts, gripper=tool.hand, physics=physics)
        try:
            control = Insertion(tool, self._errand(step, grasp), np.array(HOME), physics.time_step, physics.stiffness)
        except RuntimeError as error:
            return OperationOutcome(step.name, gripper.name, _place(name, poses[name], goals[name]), why=str(error))
        _prepare(scene, tool)
        scene.reset(np.zeros(3), control.start_joints())
        recorder = Recorder(self.choice.record)
        duration = scene.drive(control, [recorder] if films is not None else [])
        if films is not None:
            recorder.record(duration, scene)
            films.append(Film(tool, world, parts, recorder.states, control.released))
        scene.drive(_Standing(control.joints, control.period, scene))
        poses.update({n: scene.part_pose(n) for n in self.loose})
        place = _place(name, poses[name], goals[name])
        return OperationOutcome(
            step.name, gripper.name, place, control.searched, duration, _fault(control.in_time, place.there)
        )

    def _errand(self, step: AssemblyStep, grasp: AssemblyGrasp) -> Errand:
        place = _core.pose(CELL) @ grasp.T_active_tool
        shift = (self.waiting(step.active[0]) - self.goal(step.active[0]))[:3, 3]
        before = step.path[-2][:3, 3] if len(step.path) > 1 else np.array([0, 0, 0.05])
        top = max(slices[-1].high for slices in self.slices.values())
        height = place[2, 3] + top + OVER - self.slices[step.active[0]][0].low
        return Errand(_moved(place, shift), place, _moved(place, before), grasp.opening, grasp.clearance, float(height))

    def _mass(self, name: str) -> float:
        """Volume times the assembly's density, steel's where none is given; at least LEAST_MASS [kg]."""
        holding = self.assembly.holding
        density = 7850.0 if holding is None else holding.density
        volume = sum(
            np.pi * (s.high - s.low) * (np.mean(np.square(s.outer)) - np.mean(np.square(s.inner)))
            for s in self.slices[name]
        )
        return max(LEAST_MASS, float(density * volume))


def chosen(plan: GripperPlan) -> tuple[list[Gripper], list[AssemblyGrasp]]:
    """The gripper and the grasp of each operation. Raises InvalidInput for a plan without."""
    if plan.result is None or not plan.result.grippers:
        raise InvalidInput(f"plan of {plan.assembly.name}: has no grippers")
    grippers = [plan.result.grippers[i] for i in plan.result.gripper_of_part]
    return grippers, [plan.grasps[i] for i in plan.result.requirement_of_part]


def other_gripper(gripper: Gripper, **changed: float) -> Gripper:
    """A gripper with other numbers: what (5.2) would have refused."""
    return Gripper(**(gripper.to_dict() | changed))


def _moved(T: Points, by: Points) -> Points:
    out = np.array(T)
    out[:3, 3] += by
    return out


def _prepare(scene: SimScene, tool: GripperArm) -> None:
    """Makes the ends of the drive's stroke hard, and lets sleep what rests: parts of many pieces cost time as they stand.

    An older MuJoCo, which knows no sleep, takes longer.
    """
    for joint in tool.hand.joints:
        stop = scene.model.joint(joint.name).id
        scene.model.jnt_solref[stop], scene.model.jnt_solimp[stop, :2] = STOP, HARD
    sleep = getattr(scene.mujoco.mjtEnableBit, "mjENBL_SLEEP", None)
    if sleep is not None:
        scene.model.opt.enableflags |= int(sleep)
        scene.model.opt.sleep_tolerance = ASLEEP


def _place(name: str, at: Points, goal: Points) -> PartPlace:
    aside = float(np.linalg.norm(at[:2, 3] - goal[:2, 3]))
    return PartPlace(name, float(at[2, 3] - goal[2, 3]), aside, float(np.arccos(np.clip(at[2, 2], -1, 1))))


def _fault(in_time: bool, there: bool) -> str:
    """What went wrong with an operation; '' nothing."""
    if in_time:
        return "" if there else "not in its place"
    return "let go before its place" + (", fell into it" if there else "")


class _Standing:
    """The controller of a robot that stays where it is for REST."""

    def __init__(self, joints: list[str], period: float, scene: SimScene):
        self.joints, self.period = joints, period
        self.still = Command(np.array([scene.joint(name) for name in joints]))

    def finished(self, time: float, scene: SceneState) -> bool:
        return time >= REST

    def command(self, time: float, scene: SceneState) -> Command:
        return self.still
