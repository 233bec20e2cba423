"""Frames of beams and objects carried along paths at the Python door."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import ASSETS
from mmgrasp.grasping import (
    BeamFrame,
    BeamMaterial,
    BeamMember,
    BeamSection,
    BeamSupport,
    NodeLoad,
    ObjectPathEvaluator,
    ObjectPathProblem,
    Pipe,
    PipeProvenance,
    SupportedFrame,
    beam_frame,
    copper,
    follow_object_path,
    grasp_search_names,
    optimize_grasp,
    population_search_names,
    rectangular_section,
    round_section,
)
from mmgrasp.optim import pairwise_weights
from mmgrasp.problems.pipe_cells import FINGERS, pipe_robot, pipe_structures
from mmgrasp.reproduce.grasp_search_runs import PIPES, path_problem, search


def pipe1() -> tuple[Pipe, BeamFrame]:
    pipe = pipe_structures()[5]
    return pipe, beam_frame(pipe, 0.010, copper())


def test_pipe1_weighs_what_p2_gives() -> None:
    pipe, frame = pipe1()
    assert pipe.lengths == pytest.approx([0.2, 0.2, 0.15, 0.2, 0.4, 0.1])
    assert frame.mass * 9.81 == pytest.approx(3.797, abs=5e-4)
    state = frame.deflection(pipe.grasp(2, 0.05, 0.3), mg.pose([1, 2, 3], rpy=[0.4, 0.5, 0.6]))
    assert np.linalg.norm(state.reactions[0, :3]) == pytest.approx(3.797, abs=5e-4)


def test_orientation_is_what_turns_gravity() -> None:
    pipe, frame = pipe1()
    grasp = pipe.grasp(3, 0.1, 0.0)
    T = mg.pose([0, 0, 0], rpy=[0.3, -1.2, 2.0])
    held = SupportedFrame(frame, grasp)
    expected = held.state(T[:3, :3].T @ [0, 0, -9.81])
    state = frame.deflection(grasp, T)
    assert state.displacement.value == pytest.approx(expected.displacement.value, rel=1e-12)
    assert state.nodes == pytest.approx(expected.nodes)
    turned = frame.deflection(grasp, mg.pose([5, 5, 5], rpy=[0, 0, 1.0]) @ T)  # a heading changes nothing
    assert turned.displacement.value == pytest.approx(state.displacement.value, rel=1e-9)


def test_two_grasps_sag_less_than_either() -> None:
    pipe, frame = pipe1()
    one, other = pipe.grasp(0, 0.1, 0.0), pipe.grasp(4, 0.3, 0.0)
    both = frame.deflection([one, other], np.eye(4))
    assert both.reactions.shape == (2, 6)
    single = min(frame.deflection(g, np.eye(4)).displacement.value for g in (one, other))
    assert both.displacement.value < single
    assert both.reactions[:, 2].sum() == pytest.approx(3.797, abs=5e-4)


def test_logan_5_30_of_the_shared_data(data: Path) -> None:
    case: dict[str, Any] = json.loads((data / "reference/transcribed/frame_logan530.json").read_text())
    names = list(case["nodes"])
    section = BeamSection(case["A"], case["in_plane_I"], case["Iy"], case["J"])  # y is the object's z here
    material = BeamMaterial(0.0, case["E"], case["G"])
    members = [BeamMember(names.index(a), names.index(b), section, material) for _, a, b in case["members"]]
    loads = [NodeLoad(names.index(name), force=[0, load, 0]) for name, _, load in case["loads"]]
    frame = BeamFrame(list(case["nodes"].values()), members, loads)
    supports: list[Any] = [BeamSupport(0, 0.0), BeamSupport(4, 360.0)]
    state = SupportedFrame(frame, supports).state([0, 0, 0])
    for row, name in zip(state.reactions, case["fixed"], strict=True):
        expected = case["expected"]["reactions"][name]
        assert [row[0], row[1], row[5]] == pytest.approx([expected["FX"], expected["FY"], expected["MZ"]], rel=1e-5)
    assert state.stress is None


def test_weights_of_the_shared_comparisons(data: Path) -> None:
    case: dict[str, Any] = json.loads((data / "reference/transcribed/ahp_drinks.json").read_text())
    names = sorted({name for a, b, _ in case["drinks"] for name in (a, b)})
    matrix = np.eye(len(names))
    for a, b, value in case["drinks"]:
        i, j = names.index(a), names.index(b)
        matrix[i, j], matrix[j, i] = value, 1 / value
    found = pairwise_weights(matrix)
    wanted = [case["expected"]["weights_4dp"][name] for name in names]
    assert found.eigenvector == pytest.approx(wanted, abs=5.1e-5)
    assert found.consistency_ratio == pytest.approx(case["expected"]["consistency_ratio_saaty_RI"], abs=5e-4)


def test_weights_of_p2() -> None:
    found = pairwise_weights([[1.0, 6.0, 2.0], [1 / 6, 1.0, 1 / 4], [1 / 2, 4.0, 1.0]])
    assert found.weights == pytest.approx([0.587, 0.089, 0.324], abs=5e-4)
    assert found.consistency_ratio == pytest.approx(0.0079, abs=5e-5)
    with pytest.raises(mg.InvalidInput, match="reciprocal"):
        pairwise_weights([[1, 2], [2, 1]])
    with pytest.raises(mg.InvalidInput, match="10 %"):
        pairwise_weights([[1, 9, 1 / 9], [1 / 9, 1, 9], [9, 1 / 9, 1]])


def test_what_cannot_be_is_refused_by_name() -> None:
    _, frame = pipe1()
    tube, metal = round_section(0.012, 0.010), copper()
    with pytest.raises(mg.InvalidInput, match="inner_diameter"):
        round_section(0.010, 0.012)
    with pytest.raises(mg.InvalidInput, match="wall"):
        rectangular_section(0.02, 0.02, 0.01)
    with pytest.raises(mg.InvalidInput, match=r"members\[0\].nodes .*apart"):
        BeamFrame([[0, 0, 0], [0, 0, 0]], [BeamMember(0, 1, tube, metal)])
    with pytest.raises(mg.InvalidInput, match="one connected piece"):
        BeamFrame(np.arange(12.0).reshape(4, 3), [BeamMember(0, 1, tube, metal), BeamMember(2, 3, tube, metal)])
    with pytest.raises(mg.InvalidInput, match=r"members\[0\].nodes .*indices"):
        BeamFrame([[0, 0, 0], [1, 0, 0]], [BeamMember(0, 7, tube, metal)])
    with pytest.raises(mg.InvalidInput, match="unstable"):
        SupportedFrame(frame, [])
    with pytest.raises(mg.InvalidInput, match="unstable"):
        SupportedFrame(frame, BeamSupport(0, 0.1, [True, True, True, True, True, False]))
    with pytest.raises(mg.InvalidInput, match=r"supports\[0\].distance"):
        frame.deflection(BeamSupport(0, 0.9), np.eye(4))
    with pytest.raises(mg.InvalidInput, match="provenance"):
        frame.deflection(mg.Grasp(np.eye(4), 0.01), np.eye(4))
    with pytest.raises(mg.InvalidInput, match="youngs_modulus"):
        BeamMaterial(8960, 0, 1)


def arc(poses: int, **keywords: Any) -> ObjectPathProblem:
    _, arm, gripper = pipe_robot("tm14like")
    pipe, frame = pipe1()
    turns = np.linspace(-0.6, 0.6, poses)
    path = [mg.pose([0.6 * math.cos(t), 0.6 * math.sin(t), 0.45], rpy=[0, 0.2 * t, t]) for t in turns]
    world = mg.World()
    world.add_box("table", [2.6, 2.6, 0.05], mg.pose([0, 0, -0.03]))
    given: dict[str, Any] = {"gripper": gripper, "touch_links": sorted(FINGERS), "frame": frame, **keywords}
    return ObjectPathProblem(arm, world, pipe.shapes(), np.array(path), **given)


def test_follow_a_path_with_the_best_of_some_grasps() -> None:
    problem = arc(12)
    pipe, frame = pipe1()
    _, arm, gripper = pipe_robot("tm14like")
    evaluator = ObjectPathEvaluator(problem)
    grasps = pipe.sample_grasps(60, gripper=gripper, seed=2)
    results = [evaluator.evaluate(grasp) for grasp in grasps]
    solved = [i for i, result in enumerate(results) if result.outcome == mg.Outcome.solved]
    assert len(solved) > 5
    assert all((result.violation == 0) == (result.outcome == mg.Outcome.solved) for result in results)
    best = min(solved, key=lambda i: results[i].cost)
    found = follow_object_path(problem, grasps[best])
    assert found.outcome == mg.Outcome.solved
    assert found.cost >= results[best].cost * (1 - 1e-9)
    for q, T in zip(found.path, problem.T_world_object, strict=True):
        assert arm.fk(q) == pytest.approx(T @ grasps[best].T_object_hand, abs=1e-4)
    sag = [frame.deflection(grasps[best], T).displacement.value for T in problem.T_world_object]
    assert found.sag == pytest.approx(sag, rel=1e-9)
    assert found.deflection == pytest.approx(sum(sag[1:]), rel=1e-9)
    trajectory = mg.time_parameterize(found.path, arm.velocity_limits, arm.acceleration_limits)
    assert trajectory.duration > 0
    assert found.to_dict()["outcome"] == "solved"


def test_what_falls_says_where() -> None:
    problem = arc(5)
    T = problem.T_world_object.copy()
    T[3, :3, 3] += [5, 0, 0]
    _, arm, gripper = pipe_robot("tm14like")
    pipe, _ = pipe1()
    far = ObjectPathProblem(arm, mg.World(), pipe.shapes(), T, gripper=gripper, touch_links=sorted(FINGERS))
    result = follow_object_path(far, pipe.grasp(2, 0.05, 0.3, gripper=gripper))
    assert result.outcome == mg.Outcome.not_found and result.path is None
    assert result.violations[3] == 2
    assert "out of reach" in repr(result)
    with pytest.raises(mg.InvalidInput, match="T_world_object"):
        ObjectPathProblem(arm, mg.World(), pipe.shapes(), T[:1])
    wrong: dict[str, Any] = {"motion_wieght": 1.0}
    with pytest.raises(mg.InvalidInput, match="motion_wieght"):
        ObjectPathEvaluator(far, **wrong)


def test_the_best_grasp_is_the_cheapest_and_comes_again() -> None:
    problem = arc(8)
    pipe, _ = pipe1()
    best = optimize_grasp(problem, pipe, max_evaluations=300, seed=3)
    assert best.outcome == mg.Outcome.approximate
    assert best.evaluations == 300 == len(best.history)
    assert best.history == sorted(best.history, reverse=True)
    costs = [feasible.grasp.cost for feasible in best.feasible]
    assert costs == sorted(costs) and costs[0] == pytest.approx(best.path.cost, rel=1e-9)
    assert best.grasp is not None and best.grasp.cost == costs[0]
    assert 0 in best.front
    again = optimize_grasp(problem, pipe, max_evaluations=300, seed=3)
    assert again.history == best.history
    met = optimize_grasp(problem, pipe, max_evaluations=300, seed=3, target=costs[5])
    assert met.outcome == mg.Outcome.solved and met.evaluations <= 300


def test_the_optimum_is_proven_to_a_gap() -> None:
    problem = arc(8)
    pipe, _ = pipe1()
    best = optimize_grasp(problem, pipe, algorithm="branch_and_bound", max_evaluations=200, max_gap=0.2, max_boxes=2000)
    assert best.boxes > 0 and 0 < best.lower_bound <= best.path.cost
    assert best.gap == pytest.approx(1 - best.lower_bound / best.path.cost)
    assert (best.outcome == mg.Outcome.solved) == (best.gap <= 0.2)
    assert "none below" in repr(best)
    for seed in (1, 2):
        other = optimize_grasp(problem, pipe, max_evaluations=300, seed=seed)
        assert other.path.cost >= best.lower_bound
        assert (other.lower_bound, other.gap, other.boxes) == (0, 1, 0)
    assert grasp_search_names() == [*population_search_names(), "branch_and_bound"]
    for wrong, rule in (
        ("max_gap", 0.0),
        ("max_boxes", 0),
        ("time_limit", 0.0),
        ("threads", -1),
        ("front_searches", -1),
    ):
        with pytest.raises(mg.InvalidInput, match=wrong):
            optimize_grasp(problem, pipe, algorithm="branch_and_bound", **{wrong: rule})  # type: ignore[arg-type]


def test_front_searches_find_what_the_search_for_cost_passes_by() -> None:
    once, more = (search("Pipe1", max_evaluations=300, seed=1, front_searches=n) for n in (0, 3))
    assert more.evaluations == 4 * once.evaluations == 1200
    assert list(more.history) == list(once.history)

    def least(found: Any) -> np.ndarray:
        rows = [(f.joint_motion, f.deflection, f.force_manipulability) for f in found.feasible]
        return np.asarray(np.array(rows).min(axis=0))

    assert np.all(least(more) <= least(once)) and np.any(least(more) < least(once))
    assert more.path.cost <= once.path.cost
    assert np.all(np.diff([more.feasible[i].joint_motion for i in more.front]) >= 0)


def test_no_grasp_at_a_millimetre_and_a_degree_undercuts_the_proven_one() -> None:
    """A slice of benchmarks/structure/run_grid.py: Pipe3 of P2's tables, 15 mm and 30 degrees to either side."""
    pipe = pipe_structures()[PIPES["Pipe3"] - 1]
    gripper = pipe_robot("kr6like")[2]
    proven = search("Pipe3", algorithm="branch_and_bound", max_boxes=20_000, time_limit=1e6)
    assert proven.outcome == mg.Outcome.solved and proven.gap <= 1e-3
    assert proven.grasp is not None
    at = proven.grasp.provenance
    assert isinstance(at, PipeProvenance)
    evaluator = ObjectPathEvaluator(path_problem("Pipe3"), check_edges=False)
    middle, turn = round(1000 * at.length), round(math.degrees(at.angle))
    margin, length = gripper.finger_width / 2, pipe.lengths[at.section]
    costs = []
    for mm in range(middle - 15, middle + 16):
        if not margin <= mm / 1000 <= length - margin:
            continue
        for degrees in range(turn - 30, turn + 31):
            for flip in (False, True):
                grasp = pipe.grasp(at.section, mm / 1000, math.radians(degrees), flip, gripper=gripper)
                result = evaluator.evaluate(grasp)
                if result.outcome == mg.Outcome.solved:
                    costs.append(result.cost)
    assert len(costs) > 500
    assert proven.lower_bound <= min(costs) <= 1.001 * proven.path.cost
    assert proven.path.cost <= min(costs) / (1 - 1e-3)


def test_sag_alone_asks_for_another_grasp() -> None:
    problem = arc(8)
    pipe, _ = pipe1()
    still = optimize_grasp(problem, pipe, max_evaluations=500, deflection_weight=0.0)
    stiff = optimize_grasp(problem, pipe, max_evaluations=500, motion_weight=0.0, manipulability_weight=0.0)
    assert stiff.path.deflection < still.path.deflection
    assert still.path.joint_motion < stiff.path.joint_motion


def test_best_grasps_are_candidates_of_a_planner() -> None:
    problem = arc(8)
    pipe, _ = pipe1()
    _, arm, gripper = pipe_robot("tm14like")
    best = optimize_grasp(problem, pipe, max_evaluations=200)
    T = problem.T_world_object
    candidates = [feasible.grasp for feasible in best.feasible[:5]]
    task = mg.ManipulationProblem(
        arm, problem.world, pipe.shapes(), T[0], T[-1], candidates, gripper=gripper, touch_links=sorted(FINGERS)
    )
    found = mg.plan_manipulation(task, vertices=200, time_limit=20.0)
    assert found.outcome == mg.Outcome.solved
    assert found.cost >= min(grasp.cost for grasp in candidates)


def test_searches_refuse_what_they_do_not_know() -> None:
    problem = arc(3)
    pipe, _ = pipe1()
    wrong: dict[str, Any] = {"max_evaluation": 5}
    assert population_search_names() == ["bees", "ga", "pso"]
    with pytest.raises(mg.InvalidInput, match="algorithm = ants: must be one of bees, ga, pso"):
        optimize_grasp(problem, pipe, algorithm="ants")
    with pytest.raises(mg.InvalidInput, match="same_section"):
        optimize_grasp(problem, pipe, neighbourhood_kind="same")
    with pytest.raises(mg.InvalidInput, match="did you mean"):
        optimize_grasp(problem, pipe, **wrong)
    with pytest.raises(mg.InvalidInput, match="recruits of all sites"):
        optimize_grasp(problem, pipe, elite_recruits=100)
    thick = Pipe(pipe.nodes, pipe.sections, 0.2)
    with pytest.raises(mg.InvalidInput, match="the hand fits"):
        optimize_grasp(problem, thick)


def test_a_base_that_cannot_go_sideways_is_refused() -> None:
    robot = mg.Robot.load(
        ASSETS / "robots/fetchlike/fetchlike.urdf", ASSETS / "robots/fetchlike/fetchlike.srdf", base="diff_drive"
    )
    group = robot.group("arm", with_base=True)
    pipe, _ = pipe1()
    with pytest.raises(mg.InvalidInput, match="diff_drive"):
        ObjectPathProblem(group, mg.World(), pipe.shapes(), np.array([np.eye(4)] * 2))


PYNITE = json.loads((Path(__file__).with_name("pynite_frames.json")).read_text())["frames"]


@pytest.mark.parametrize("plain", PYNITE)
def test_frames_bend_as_pynite_says(plain: dict[str, Any]) -> None:
    """Tubes and turned rectangles, masses, forces and moments on nodes (benchmarks/structure/run.py --store)."""
    make: dict[str, Any] = {"round": round_section, "rectangle": rectangular_section}
    metal = BeamMaterial(8960, 110e9, 40e9)
    members = [
        BeamMember(m["nodes"][0], m["nodes"][1], make[m["shape"][0]](*m["shape"][1:]), metal, m["y"])
        for m in plain["members"]
    ]
    frame = BeamFrame(plain["nodes"], members, [NodeLoad(**load) for load in plain["loads"]])
    held = next(i for i, m in enumerate(members) if plain["fixed"] in m.nodes)
    a, b = members[held].nodes
    length = float(np.linalg.norm(frame.nodes[a] - frame.nodes[b]))
    support = BeamSupport(held, 0.0 if plain["fixed"] == a else length)
    state = SupportedFrame(frame, support).state(plain["gravity"])
    pairs = (
        (state.nodes, np.array(plain["answer"]["nodes"])),
        (state.reactions, np.array([plain["answer"]["reaction"]])),
    )
    for ours, theirs in pairs:
        for part in (slice(0, 3), slice(3, 6)):  # displacements and rotations, forces and moments
            np.testing.assert_allclose(
                ours[:, part], theirs[:, part], rtol=0, atol=1e-8 * np.abs(theirs[:, part]).max()
            )


def test_the_frames_of_pynite_have_all_kinds() -> None:
    shapes = {m["shape"][0] for plain in PYNITE for m in plain["members"]}
    assert shapes == {"round", "rectangle"} and len(PYNITE) == 16
    assert any(plain["loads"] for plain in PYNITE)
