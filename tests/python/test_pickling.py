"""Data of the library goes to other processes and comes back to the last bit; of what does not, the error says what to do."""

from __future__ import annotations

import concurrent.futures
import copy
import dataclasses
import multiprocessing
import pickle
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from argument_calls import CALLS, callable_of, other_arguments
from argument_objects import ARM, GRID, OBJECTS, PLACE_REGION, ROBOT, Q, cube
from mmgrasp import _core
from number_tables import QUICK

NOT_DATA = {
    *("World", "CollisionChecker", "IkObjective", "BaseTracker", "NonlinearProblem", "WholeBodyProgram", "PlanToCheck"),
    *("ReachDatabase", "CapabilityMap", "Roadmap", "ProbabilisticSdf", "OccupancyMap", "IkSeedDatabase"),
    *("DistanceField", "MeshDistanceField", "GridDistanceField", "SupportedFrame", "ObjectRegions"),
    *("ManipulationProblem", "ObjectPathProblem", "ObjectPathEvaluator", "PartSupplyProblem", "DriveByTask"),
    *("ToolRegion", "OrientationConstraint", "_PlacedBodies"),
}
OWN_COPIES = {"Robot", "JointGroup", "Mesh", "ReachDatabase", "CapabilityMap", "Roadmap", "ObjectRegions"}


def is_data(kind: type) -> bool:
    return kind.__name__ not in NOT_DATA and not kind.__name__.startswith("Checked")


def collect(thing: Any, found: dict[str, Any], depth: int = 0) -> None:
    """Puts one object of each class of the binary module into `found`: the thing, what it holds, and so on."""
    if isinstance(thing, (list, tuple)):
        for one in thing[:3]:
            collect(one, found, depth)
        return
    kind = type(thing)
    if not kind.__module__.startswith("mmgrasp._core") or kind.__name__ in found or hasattr(kind, "__members__"):
        return
    found[kind.__name__] = thing
    for name in [name for name in dir(thing) if not name.startswith("_")] if depth < 5 else []:
        try:
            held = getattr(thing, name)
        except (mg.Error, TypeError):
            continue
        if not callable(held):
            collect(held, found, depth + 1)


@pytest.fixture(scope="module")
def made() -> dict[str, Any]:
    """One object of nearly each class: from the tables of the tests of arguments, and what quick calls give."""
    found: dict[str, Any] = {}
    for make in OBJECTS.values():
        collect(make(), found)
    for call in CALLS:
        if call.is_setter:
            continue
        needed = tuple(p.name for p in call.parameters if p.is_needed)
        try:
            keywords = {**other_arguments(call.function, "", needed), **QUICK.get(call.function, dict)()}
            collect(callable_of(call.function)(**keywords), found)
        except (mg.Error, TypeError, OSError, StopIteration):
            continue
    return found


def same(a: Any, b: Any) -> bool:
    """Bit for bit: what goes into the pickle of one and of the other. (A missing member does not compile.)"""
    return pickle.dumps(a) == pickle.dumps(b) and type(a) is type(b)


def test_data_comes_back_to_the_last_bit(made: dict[str, Any]) -> None:
    data = {name: thing for name, thing in made.items() if is_data(type(thing))}
    assert len(data) > 105
    for name, thing in data.items():
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            again = pickle.loads(pickle.dumps(thing, protocol))
            assert same(thing, again), name
            assert " object at " in repr(thing) or repr(again) == repr(thing), name
        for copied in (copy.copy(thing), copy.deepcopy(thing)):
            assert same(thing, copied), name
            assert (copied is thing) == (name in OWN_COPIES), name


def test_every_class_is_data_or_known_not_to_be(made: dict[str, Any]) -> None:
    kinds = [k for scope in (_core, _core.verify) for k in vars(scope).values() if isinstance(k, type)]
    named = {k.__name__ for k in kinds}
    assert named >= NOT_DATA
    for name, thing in made.items():
        if is_data(type(thing)):
            continue
        with pytest.raises(TypeError, match=rf"^{name}: cannot be pickled or copied: "):
            pickle.dumps(thing)
        if name not in OWN_COPIES and name != "World":
            with pytest.raises(TypeError, match=r"cannot be pickled or copied"):
                copy.deepcopy(thing)


@pytest.mark.parametrize(
    ("name", "words"), [("World", r"copy\(\)"), ("ReachDatabase", r"save\(\)"), ("CollisionChecker", "make it")]
)
def test_what_to_do_instead(name: str, words: str) -> None:
    with pytest.raises(TypeError, match=words):
        pickle.dumps(OBJECTS[name]())


def test_numbers_that_are_none_and_names_that_are_no_utf8() -> None:
    trajectory = mg.planning.JointTrajectory(["ä", ""], [0.0, 5e-324], [[-0.0, 1e-300], [np.pi, 1e6]])
    again = pickle.loads(pickle.dumps(trajectory))
    assert again.names == ["ä", ""]
    for field in ("times", "positions", "velocities"):
        assert getattr(again, field).tobytes() == getattr(trajectory, field).tobytes()


def test_shapes_in_shapes() -> None:
    mesh = cube()
    shape = mg.LinkShape(mesh, mg.pose([0.1, 0, 0], rpy=[0.1, 0.2, 0.3]))
    again = pickle.loads(pickle.dumps(shape))
    assert again.pose.tobytes() == shape.pose.tobytes()
    assert again.shape.vertices.tobytes() == mesh.vertices.tobytes() and again.shape.closed is mesh.closed


def test_robots_and_groups() -> None:
    mounted = ROBOT.with_link("tool", ARM.tip, mg.pose([0, 0, 0.1]), [mg.LinkShape(mg.Box([0.1, 0.1, 0.1]))])
    group = mounted.group(base_link=mounted.links[0], tip="tool").at(mg.pose([1, 2, 3]))
    robot, arm, whole = pickle.loads(pickle.dumps((mounted, group, ARM)))
    assert robot.hash == mounted.hash
    assert (robot.links, robot.joints, robot.groups, robot.group_states) == (
        mounted.links, mounted.joints, mounted.groups, mounted.group_states)  # fmt: skip
    assert (robot.to_urdf(), robot.to_srdf()) == (mounted.to_urdf(), mounted.to_srdf())
    q = (group.sample_lower + group.sample_upper) / 3
    assert arm.fk(q).tobytes() == group.fk(q).tobytes()
    assert arm.T_world_root.tobytes() == group.T_world_root.tobytes()
    assert whole.fk(Q).tobytes() == ARM.fk(Q).tobytes()
    assert mg.ReachDatabase.build(whole, samples=10_000, threads=1).key == mg.ReachDatabase.build(
        ARM, samples=10_000, threads=1
    ).key  # fmt: skip


def test_regions_of_trays_without_targets_stay_so() -> None:
    """Pickles had forgotten it."""
    tray = mg.base.Tray("empty", mg.pose([1, 0, 0.5]), [0.3, 0.3, 0.1], [])
    problem = mg.base.PartSupplyProblem(
        ROBOT, ARM, OBJECTS["Hand"](), mg.World(), [tray], Q, [0, 0, 0], [0, 0, 0], PLACE_REGION, grid_max_distance=1.0
    )
    (region,) = mg.base.compute_base_regions(problem, OBJECTS["ReachDatabase"](), GRID)
    states: list[Any] = [r.__reduce_ex__(4)[1] for r in (region, pickle.loads(pickle.dumps(region)))]
    assert states[0][1][:2] == states[1][1][:2] == (b"empty", False)


def test_worlds_are_copied() -> None:
    world = mg.World()
    world.add_box("table", (1, 1, 0.1))
    for other in (copy.copy(world), copy.deepcopy(world)):
        other.remove("table")
        assert (world.objects, other.objects) == (["table"], [])


def test_classes_that_derive_from_ours_are_refused() -> None:
    class Named(mg.Box):
        pass

    with pytest.raises(TypeError, match="Named, derived from Box,: cannot be pickled"):
        pickle.dumps(Named([1, 1, 1]))


class Room(mg.World):
    """A world that knows how it is made again."""

    def __reduce__(self) -> tuple[type, tuple[()]]:
        return Room, ()


def test_classes_that_derive_from_ours_may_know_better() -> None:
    assert type(pickle.loads(pickle.dumps(Room()))) is Room


def test_states_of_other_versions_are_refused() -> None:
    reduced: Any = mg.Box([1, 2, 3]).__reduce_ex__(4)
    kind, state = reduced[1]
    for other in ((), (*state, 1), (1,), ((3, 1, b""),), ((2, 1, b"0" * 16),), None, b""):
        with pytest.raises(TypeError, match="another version of mmgrasp"):
            _core._from_pickle(kind, other)
    with pytest.raises(TypeError):
        _core._from_pickle(mg.World, ())


def changed_somewhere(state: Any, number: int) -> Iterator[Any]:
    """The state with one of its whole numbers replaced, for each of them."""
    if isinstance(state, int) and not isinstance(state, bool):
        yield number
    elif isinstance(state, tuple):
        for i, one in enumerate(state):
            yield from ((*state[:i], other, *state[i + 1 :]) for other in changed_somewhere(one, number))


@pytest.mark.parametrize("number", [1_000_000, -7, 0])
def test_indices_of_forged_robots_lead_nowhere_and_are_refused(number: int) -> None:
    """A link or joint that is not there ended the process."""
    reduced: Any = ARM.robot.__reduce_ex__(4)
    kind, state = reduced[1]
    refused = 0
    for forged in changed_somewhere(state, number):
        try:
            _core._from_pickle(kind, forged).group(ARM.name).fk(Q)
        except (TypeError, mg.Error):
            refused += 1
    assert number == 0 or refused > 20
    for forged in ((0, (10_000,)), (2, 10_000)):  # the joints of a group, its tip
        whole: Any = ARM.__reduce_ex__(4)
        robot, record = whole[1][1]
        with pytest.raises(TypeError, match="another version of mmgrasp"):
            _core._from_pickle(type(ARM), (robot, (*record[: forged[0]], forged[1], *record[forged[0] + 1 :])))


def test_scenarios_and_their_plans(small_path: Path) -> None:
    scenario = mg.load_scenario(small_path)
    for again in (copy.deepcopy(scenario), copy.copy(scenario), pickle.loads(pickle.dumps(scenario))):
        assert again.setup.robot.hash == scenario.setup.robot.hash
        assert [tray.tray.name for tray in again.trays] == [tray.tray.name for tray in scenario.trays]
        assert dataclasses.fields(again) == dataclasses.fields(scenario)
    plan = mg.plan_part_supply(scenario)
    assert pickle.loads(pickle.dumps(plan)).to_dict() == plan.to_dict()


def solve(seed: int, arm: Any) -> Any:
    target = arm.fk((2 * arm.sample_lower + arm.sample_upper) / 3)
    found = arm.ik(target, rng_seed=seed)
    path = mg.plan_motion(arm.robot, arm, mg.World(), start=Q, goal=Q * 0.9, seed=seed)
    return found, path


def test_answers_come_back_from_other_processes() -> None:
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=context) as pool:
        found, path = pool.submit(solve, 3, ARM).result(timeout=120)
    here, way = solve(3, ARM)
    assert same(found, here)
    assert np.array_equal(path.path, way.path) and path.outcome == way.outcome
