"""plan_manipulation and Roadmap from Python: an arm of three links in the plane carries a bar past two posts."""

from __future__ import annotations

import json
import os
import signal
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg

LENGTH = 0.4


def planar_arm(joints: int = 3, length: float = LENGTH) -> mg.robot.JointGroup:
    links, rows = ['<link name="l0"/>'], []
    for i in range(1, joints + 1):
        links.append(
            f'<link name="l{i}"><collision><origin xyz="{length / 2} 0 0"/><geometry><box size="{length} 0.02 0.02"/>'
            f'</geometry></collision></link><joint name="j{i}" type="revolute"><parent link="l{i - 1}"/><child link="l{i}"/>'
            f'<origin xyz="{length if i > 1 else 0} 0 0"/><axis xyz="0 0 1"/>'
            '<limit effort="1" velocity="2" lower="-2.8" upper="2.8"/></joint>'
        )
        rows += [f'<disable_collisions link1="l{k}" link2="l{i}" reason="User"/>' for k in range(i)]
    links.append(
        f'<link name="tip"/><joint name="t" type="fixed"><parent link="l{joints}"/><child link="tip"/>'
        f'<origin xyz="{length} 0 0"/></joint>'
    )
    urdf = f'<robot name="planar">{"".join(links)}</robot>'
    robot = mg.Robot.from_strings(urdf, f'<robot name="planar">{"".join(rows)}</robot>')
    return robot.group(base_link="l0", tip="tip")


ARM = planar_arm()
BAR = mg.LinkShape(mg.Box([0.4, 0.02, 0.02]))


def flat(x: float, y: float, yaw: float) -> np.ndarray:
    return mg.pose([x, y, 0], rpy=[0, 0, yaw])


def scene() -> mg.World:
    world = mg.World()
    world.add_box("post", [0.1, 0.1, 0.2], flat(0.85, 0, 0))
    world.add_box("corner", [0.06, 0.06, 0.2], flat(0.35, -0.75, 0))
    return world


GRASPS = [mg.Grasp(flat(-0.18 + 0.04 * i, 0, side)) for i in range(10) for side in (0.5 * np.pi, -0.5 * np.pi)]


def problem(**changes: Any) -> mg.ManipulationProblem:
    arguments = {
        "group": ARM,
        "world": scene(),
        "object": BAR,
        "T_world_start": flat(0.55, 0.45, 1.2),
        "T_world_goal": flat(0.6, -0.45, 0.9),
        "grasps": GRASPS,
        "touch_links": ["l3", "tip"],
    }
    return mg.ManipulationProblem(**{**arguments, **changes})


OPTIONS: dict[str, Any] = {"vertices": 300, "ik_solutions": 2, "time_limit": 100, "shorten": False}


def plan(**changes: Any) -> mg.planning.ManipulationResult:
    return mg.plan_manipulation(problem(**changes), **OPTIONS)


def test_the_bar_is_carried_from_start_to_goal() -> None:
    improvements: list[mg.planning.Improvement] = []
    result = mg.plan_manipulation(problem(), on_solution=improvements.append, **OPTIONS)
    assert result.outcome == mg.Outcome.solved
    grasp = GRASPS[result.grasp_index]
    assert result.cost == pytest.approx(np.linalg.norm(np.diff(result.path, axis=0), axis=1).sum(), abs=1e-12)
    assert result.stats.roadmap_bound == pytest.approx(result.cost)
    assert result.lower_bound < result.cost
    assert improvements[-1].cost == result.cost and improvements[-1].grasp == result.grasp_index
    assert np.array_equal(improvements[-1].path, result.path)
    for better in improvements:
        assert better.cost == pytest.approx(np.linalg.norm(np.diff(better.path, axis=0), axis=1).sum(), abs=1e-12)
    tool_object = np.linalg.inv(grasp.T_object_hand)
    assert np.allclose(ARM.fk(result.path[0]) @ tool_object, flat(0.55, 0.45, 1.2), atol=3e-4)
    assert np.allclose(ARM.fk(result.path[-1]) @ tool_object, flat(0.6, -0.45, 0.9), atol=3e-4)
    world = scene()
    world.add("bar", [BAR])
    world.attach("bar", "tip", tool_object, {"l3", "tip"})
    checker = mg.CollisionChecker(ARM.robot, world, ARM)
    for a, b in zip(result.path, result.path[1:], strict=False):
        assert checker.edge_is_free(a, b, 0.002)


def test_poses_in_an_array_are_grasps() -> None:
    poses = np.array([grasp.T_object_hand for grasp in GRASPS])
    by_array, by_list = plan(grasps=poses), plan()
    assert by_array.cost == by_list.cost and by_array.grasp_index == by_list.grasp_index
    assert np.array_equal(by_array.path, by_list.path)


@pytest.mark.parametrize("batch", [0, 1, 5])
def test_variants_threads_and_a_loaded_roadmap_agree(tmp_path: Path, batch: int) -> None:
    roadmap = mg.planning.Roadmap.build(ARM, vertices=300)
    roadmap.save(tmp_path / "arm.roadmap")
    loaded = mg.planning.Roadmap.load(tmp_path / "arm.roadmap", ARM)
    expected = plan()
    for threads in (1, 2):
        found = mg.plan_manipulation(
            problem(), roadmap=loaded, batch=batch, threads=threads, ik_solutions=2, time_limit=100, shorten=False
        )
        assert found.cost == pytest.approx(expected.cost, abs=1e-12)
        assert found.stats.roadmap_seconds == 0


def test_a_roadmap_tells_of_itself() -> None:
    roadmap = mg.planning.Roadmap.build(ARM, vertices=200, neighbours=5, seed=3)
    assert len(roadmap) == 200 and roadmap.vertices.shape == (200, 3)
    degree = np.bincount(roadmap.edges.ravel(), minlength=200)
    assert degree.min() >= 5 and roadmap.statistics["mean_degree"] == pytest.approx(degree.mean())
    q = np.array([0.1, 0.2, 0.3])
    nearest = np.argsort(np.linalg.norm(roadmap.vertices - q, axis=1))[:5]
    assert roadmap.near(q) == sorted(nearest.tolist())
    assert roadmap.to_dict()["options"] == {
        "vertices": 200,
        "gamma": 0.0,
        "neighbours": 5,
        "joint_weights": None,
        "seed": 3,
    }
    assert "200 vertices" in repr(roadmap)


def test_stages_and_a_roadmap_in_pieces_are_told() -> None:
    result = mg.plan_manipulation(problem(), **OPTIONS)
    assert [*result.stats.stages] == list(dict.fromkeys(better.stage for better in result.improvements))
    last = result.stats.stages[result.improvements[-1].stage]
    assert last["cost"] == result.cost and last["last_seconds"] == result.improvements[-1].seconds
    assert result.warnings == [] and "warning" not in repr(result)
    torn = mg.plan_manipulation(problem(), **{**OPTIONS, "gamma": 0.5})
    (warning,) = torn.warnings
    assert "of 300 vertices" in warning and "neighbours = 0" in warning
    assert warning in repr(torn) and torn.to_dict()["warnings"] == [warning]


def test_results_convert_and_print() -> None:
    result = plan()
    data = json.loads(json.dumps(result.to_dict()))
    assert data["outcome"] == "solved" and len(data["grasps"]) == 20 and data["path"] == result.path.tolist()
    assert data["stats"]["graph_searches"] > 0 and data["improvements"][-1]["cost"] == result.cost
    assert "grasp" in repr(result) and "of 20" in repr(result)
    assert "20 grasps" in repr(problem())


def test_out_of_reach_with_every_grasp() -> None:
    result = plan(T_world_start=flat(5, 0, 0))
    assert result.outcome == mg.Outcome.invalid_start and result.path is None
    assert [report.start.unreachable for report in result.grasps] == [1] * 20
    assert result.rejections.unreachable == 20 and result.contacts == []


def test_start_in_collision_with_every_grasp_names_the_pair() -> None:
    result = plan(T_world_start=flat(0.85, 0, np.pi / 2))
    assert result.outcome == mg.Outcome.invalid_start
    assert result.rejections.scene > 0 and all(report.start_solutions == 0 for report in result.grasps)
    assert any(contact.b == "post" for contact in result.contacts)
    assert "'post'" in repr(result)


def test_goal_in_collision_with_every_grasp() -> None:
    result = plan(T_world_goal=flat(0.85, 0, np.pi / 2))
    assert result.outcome == mg.Outcome.invalid_goal
    assert sum(report.start_solutions for report in result.grasps) > 0
    assert sum(report.goal.scene for report in result.grasps) > 0


def test_only_one_of_many_grasps_leads_there() -> None:
    far = [mg.Grasp(flat(3 + 0.01 * i, 0, 0)) for i in range(300)]
    good = plan()
    result = plan(grasps=[*far, GRASPS[good.grasp_index], *far])
    assert result.outcome == mg.Outcome.solved and result.grasp_index == 300
    assert result.cost == pytest.approx(good.cost, abs=1e-3)  # descents start elsewhere for another index
    assert sum(report.start.unreachable for report in result.grasps) == 600


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"grasps": []}, ["grasps", "at least one"]),
        ({"grasps": [mg.Grasp(np.eye(4), cost=-1)]}, ["grasps[0].cost"]),
        ({"grasps": np.eye(4)}, ["grasps", "(4, 4)", "(m, 4, 4)"]),
        ({"grasps": [np.eye(4), 2 * np.eye(4)]}, ["grasps[1]"]),
        ({"grasps": "all"}, ["grasps"]),
        ({"T_world_goal": np.diag([1.0, 1, -1, 1])}, ["T_world_goal"]),
        ({"T_world_start": np.full((4, 4), np.nan)}, ["T_world_start", "nan"]),
        ({"T_world_start": np.eye(3)}, ["T_world_start", "(3, 3)"]),
        ({"object": []}, ["object"]),
        ({"object": 3}, ["object"]),
        ({"object_name": "post"}, ["object_name", "post"]),
        ({"touch_links": ["hand"]}, ["touch_links = hand"]),
        ({"touch_links": ["l33"]}, ["touch_links = l33", "l3"]),
        ({"touch_links": "l3"}, ["touch_links = 'l3'", "a list"]),
        ({"world": None}, ["world = None", "a World"]),
        ({"group": "arm"}, ["group = 'arm'", "a JointGroup"]),
        ({"gripper": "wide"}, ["gripper = 'wide'", "a Hand"]),
        ({"object_name": 3}, ["object_name = 3"]),
        ({"touch_link": ["l3"]}, ["touch_link=", "did you mean touch_links"]),
    ],
)
def test_bad_problems_are_refused(changes: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(mg.InvalidInput) as refused:
        plan(**changes)
    for word in words:
        assert word in str(refused.value)


def test_poses_of_grasps_must_be_rigid() -> None:
    with pytest.raises(mg.InvalidInput, match="T_object_hand"):
        mg.Grasp(2 * np.eye(4))
    with pytest.raises(mg.InvalidInput, match="opening"):
        mg.Grasp(np.eye(4), opening=float("nan"))
    wrong: Any = "a"
    with pytest.raises(mg.InvalidInput, match="cost = 'a'"):
        mg.Grasp(np.eye(4), cost=wrong)


def test_what_is_no_problem_and_no_roadmap_is_refused_by_name() -> None:
    three: Any = 3
    word: Any = "x"
    with pytest.raises(mg.InvalidInput, match="problem = 3: must be a ManipulationProblem"):
        mg.plan_manipulation(three)
    with pytest.raises(mg.InvalidInput, match="group = 3: must be a JointGroup"):
        mg.planning.Roadmap.build(group=three)
    with pytest.raises(mg.InvalidInput, match="group = 3: must be a JointGroup"):
        mg.planning.Roadmap.load("some.roadmap", group=three)
    with pytest.raises(mg.InvalidInput, match="on_solution = 3: must be a function, or None"):
        mg.plan_manipulation(problem(), on_solution=three)
    with pytest.raises(mg.InvalidInput, match="roadmap = 'x': must be a Roadmap"):
        mg.plan_manipulation(problem(), roadmap=word)


@pytest.mark.parametrize(
    ("name", "value"),
    [("batch", 1), ("lazy_grasps", True), ("refinements", 5), ("shorten", False), ("vertices", 50), ("gamma", 4.0)],
)
def test_options_of_prm_star_mg_are_not_rrt_star_mgs(name: str, value: Any) -> None:
    with pytest.raises(mg.InvalidInput, match=f"{name}: is an option of prm_star_mg, not of rrt_star_mg"):
        mg.plan_manipulation(problem(), planner="rrt_star_mg", **{name: value})


@pytest.mark.parametrize(
    ("name", "value"),
    [("max_iterations", 9), ("range", 0.5), ("rrt_gamma", 1.0), ("goal_cost", 2.0), ("keep_trees", True)],
)
def test_options_of_rrt_star_mg_are_not_prm_star_mgs(name: str, value: Any) -> None:
    with pytest.raises(mg.InvalidInput, match=f"{name}: is an option of rrt_star_mg, not of prm_star_mg"):
        mg.plan_manipulation(problem(), **{name: value})


def test_a_roadmap_is_of_no_use_to_rrt_star_mg() -> None:
    roadmap = mg.planning.Roadmap.build(ARM, vertices=20)
    with pytest.raises(mg.InvalidInput, match="roadmap: is an option of prm_star_mg"):
        mg.plan_manipulation(problem(), planner="rrt_star_mg", roadmap=roadmap)


def test_trees_are_handed_over_when_asked_for() -> None:
    given: dict[str, Any] = {"planner": "rrt_star_mg", "max_iterations": 500, "time_limit": 100.0}
    assert mg.plan_manipulation(problem(), **given).trees == []
    found = mg.plan_manipulation(problem(), keep_trees=True, **given)
    assert {tree.from_goal for tree in found.trees} == {False, True}
    for tree in found.trees:
        assert tree.vertices.shape == (len(tree.parents), 3) and len(tree.costs) == len(tree.parents)
        T_end = flat(0.6, -0.45, 0.9) if tree.from_goal else flat(0.55, 0.45, 1.2)
        for q, parent, cost in zip(tree.vertices, tree.parents, tree.costs, strict=True):
            if parent < 0:
                assert cost == 0
                assert np.allclose(ARM.fk(q), T_end @ GRASPS[tree.grasp].T_object_hand, atol=3e-4)
            else:
                way = np.linalg.norm(q - tree.vertices[parent])
                assert cost == pytest.approx(tree.costs[parent] + way, abs=1e-9)
    assert json.loads(json.dumps(found.trees[0].to_dict()))["grasp"] == found.trees[0].grasp


def test_grasps_searched_are_counted_once() -> None:
    found = mg.plan_manipulation(problem(), **{**OPTIONS, "shorten": True}, refinements=20)
    reached = [report for report in found.grasps if report.start_solutions and report.goal_solutions]
    searched = [report for report in found.grasps if report.searched]
    assert 0 < found.stats.grasps_searched == len(searched) <= len(reached) <= 20
    # Refinement rounds search again what was searched before.
    assert found.stats.graph_searches > 20


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"planner": "prm"}, ["planner", "prm_star_mg"]),
        ({"graps": 3}, ["unknown keyword"]),
        ({"batches": 3}, ["unknown keyword", "batch"]),
        ({"batch": -1}, ["batch"]),
        ({"vertices": 1}, ["vertices"]),
        ({"gamma": float("inf")}, ["gamma"]),
        ({"time_limit": 0}, ["time_limit"]),
        ({"ik_solutions": 0}, ["ik_solutions"]),
        ({"joint_step": 0}, ["joint_step"]),
        ({"seed": -1}, ["seed"]),
        ({"threads": -1}, ["threads"]),
        ({"threads": 10**6}, ["threads = 1000000", "1024"]),
    ],
)
def test_bad_options_are_refused(options: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(mg.InvalidInput) as refused:
        mg.plan_manipulation(problem(), **options)
    for word in words:
        assert word in str(refused.value)


def test_a_roadmap_of_another_robot_is_refused(tmp_path: Path) -> None:
    other = mg.planning.Roadmap.build(planar_arm(length=0.5), vertices=50)
    with pytest.raises(mg.InvalidInput, match=r"another robot.*origins, axes or limits"):
        mg.plan_manipulation(problem(), roadmap=other)
    with pytest.raises(mg.InvalidInput, match="for j1, j2, not for j1, j2, j3"):
        mg.plan_manipulation(problem(), roadmap=mg.planning.Roadmap.build(planar_arm(joints=2), vertices=50))
    other.save(tmp_path / "other.roadmap")
    with pytest.raises(mg.IoError, match="another robot"):
        mg.planning.Roadmap.load(tmp_path / "other.roadmap", ARM)
    with pytest.raises(mg.IoError, match="does not exist"):
        mg.planning.Roadmap.load(tmp_path / "none.roadmap", ARM)
    (tmp_path / "text").write_text("no roadmap")
    with pytest.raises(mg.IoError, match="no roadmap"):
        mg.planning.Roadmap.load(tmp_path / "text", ARM)


def test_what_improved_raises_ends_the_call() -> None:
    def fail(improvement: Any) -> None:
        raise RuntimeError("good enough")

    with pytest.raises(RuntimeError, match="good enough"):
        mg.plan_manipulation(problem(), on_solution=fail, **OPTIONS)


def test_ctrl_c_ends_it() -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            mg.plan_manipulation(problem(), vertices=5_000_000, neighbours=20, time_limit=1000)
    finally:
        timer.join()
        signal.signal(signal.SIGINT, before)


def test_other_threads_run_meanwhile() -> None:
    ticks, done = [], threading.Event()

    def tick() -> None:
        while not done.wait(0.001):
            ticks.append(1)

    thread = threading.Thread(target=tick)
    thread.start()
    mg.plan_manipulation(problem(), vertices=20000, neighbours=20, ik_solutions=2, time_limit=100)
    done.set()
    thread.join()
    assert len(ticks) > 5


def test_goal_cost_may_be_infinite() -> None:
    reported: list[mg.planning.Improvement] = []
    first = mg.plan_manipulation(
        problem(), planner="rrt_star_mg", goal_cost=float("inf"), seed=3, time_limit=100.0, on_solution=reported.append
    )
    assert first.outcome == mg.Outcome.solved
    # The first path alone; all that follows is that waypoints it can do without leave it.
    assert [str(better.stage) for better in reported[1:]] in ([], ["shortening"])
    assert first.cost == reported[-1].cost
    for wrong in (float("nan"), -float("inf"), -1.0):
        with pytest.raises(mg.InvalidInput, match="goal_cost"):
            mg.plan_manipulation(problem(), planner="rrt_star_mg", goal_cost=wrong)


@pytest.mark.parametrize("planner", ["prm_star_mg", "rrt_star_mg"])
def test_a_prepared_checker_gives_the_same_answer(planner: str) -> None:
    checker = mg.CollisionChecker(ARM.robot, scene(), group=ARM)
    made, prepared = (mg.plan_manipulation(problem(), planner=planner, checker=c) for c in (None, checker))
    assert made.outcome == mg.Outcome.solved
    assert np.array_equal(prepared.path, made.path) and prepared.cost == made.cost


def test_a_checker_of_something_else_is_refused() -> None:
    for checker, said in [
        (mg.CollisionChecker(ARM.robot, mg.World(), group=ARM), "its world lacks 'corner'"),
        (mg.CollisionChecker(ARM.robot, scene(), group=ARM.robot.group(base_link="l0", tip="l2")), "another group"),
        (mg.CollisionChecker(planar_arm(2).robot, scene(), group=planar_arm(2)), "another robot"),
    ]:
        with pytest.raises(mg.InvalidInput, match=said):
            mg.plan_manipulation(problem(), checker=checker)
    with pytest.raises(mg.InvalidInput, match="padding: must be left out with a checker"):
        mg.plan_manipulation(problem(), checker=mg.CollisionChecker(ARM.robot, scene(), group=ARM), padding=0.01)
