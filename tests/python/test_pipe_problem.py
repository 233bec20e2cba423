"""Pipe problems: files read with care, the plan held against independent values, and what `mmgrasp pipe` writes."""

from __future__ import annotations

import copy
import csv
import json
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

import mmgrasp as mg
from mmgrasp import _core
from mmgrasp._files import ASSETS
from mmgrasp._files import shipped as shipped_file
from mmgrasp._turns import rotation_about, rotation_vector
from mmgrasp.cli import main
from mmgrasp.grasping import BeamSupport, SupportedFrame, optimize_grasp
from mmgrasp.pipes import PipePlan, arc_poses, line_poses, load_pipe_problem, plan_pipe, planning
from mmgrasp.pipes.timed_motion import UntimedError, _dense, timed_motion
from mmgrasp.viz.pipe_report import pipe_report_html

SHIPPED = ASSETS / "pipes" / "pipe1.yaml"


def shipped() -> dict[str, Any]:
    content: dict[str, Any] = yaml.safe_load(SHIPPED.read_text())
    content["options"] |= {"max_evaluations": 300, "algorithm": "bees"}  # branch and bound takes 11 s
    return content


def written(folder: Path, content: dict[str, Any]) -> Path:
    path = folder / "problem.yaml"
    path.write_text(yaml.safe_dump(content, sort_keys=False))
    return path


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> PipePlan:
    return plan_pipe(load_pipe_problem(written(tmp_path_factory.mktemp("pipe"), shipped())))


# --- poses -------------------------------------------------------------------------------------------------------


def test_rotation_vectors_and_rotations_belong_together() -> None:
    rng = np.random.default_rng(3)
    for angle in (0.0, 1e-9, 0.3, 2.0, np.pi - 1e-9):
        for _ in range(20):
            axis = rng.normal(size=3)
            vector = angle * axis / np.linalg.norm(axis)
            assert np.allclose(rotation_about(vector) @ rotation_about(vector).T, np.eye(3), atol=1e-12)
            assert np.allclose(
                rotation_about(rotation_vector(rotation_about(vector))), rotation_about(vector), atol=1e-7
            )
            if angle < 3:
                assert np.allclose(rotation_vector(rotation_about(vector)), vector, atol=1e-8)


def test_lines_and_arcs_are_those_of_the_textbook() -> None:
    start, end = mg.pose([0.4, 0.1, 0.3], rpy=[0, 0, 0.2]), mg.pose([0.6, 0.1, 0.5], rpy=[0, 0, 1.0])
    line = line_poses(start, end, 4)
    assert len(line) == 4
    assert np.allclose(line[1], mg.pose([0.5, 0.1, 0.4], rpy=[0, 0, 0.6]))
    assert np.allclose(line[3], end)
    arc = arc_poses(mg.pose([0.5, 0, 0.3]), np.array([0, 0, 9.0]), np.array([0, 0, 2.0]), 1.2, 3)
    for i, T in enumerate(arc, start=1):
        assert np.allclose(T, mg.pose([0.5 * np.cos(0.4 * i), 0.5 * np.sin(0.4 * i), 0.3], rpy=[0, 0, 0.4 * i]))
    straight = arc_poses(mg.pose([0.5, 0, 0.3]), np.zeros(3), np.array([0, 0, 1.0]), 1.2, 3, turns=False)
    assert np.allclose(straight[2][:3, :3], np.eye(3))


# --- reading -----------------------------------------------------------------------------------------------------


def test_the_shipped_problem_is_pipe1_of_p2() -> None:
    problem = load_pipe_problem("pipe1")
    assert problem.frame.mass - 0.02 == pytest.approx(3.797 / 9.81, rel=1e-3)  # and a fitting of 20 g
    assert len(problem.T_world_pipe) == 1 + 8 + 18 + 8
    weights = [problem.preferences.options[f"{key}_weight"] for key in ("motion", "deflection", "manipulability")]
    assert weights == pytest.approx([0.587, 0.089, 0.324], abs=5e-4)
    assert problem.preferences.consistency_ratio == pytest.approx(0.0079, abs=5e-5)


@pytest.mark.parametrize(("name", "weights"), [("p2", (0.587, 0.089, 0.324)), ("p2_printed", (0.56, 0.12, 0.32))])
def test_weights_have_names(name: str, weights: tuple[float, ...], tmp_path: Path) -> None:
    content = shipped() | {"preferences": {"weights": name}}
    read = load_pipe_problem(written(tmp_path, content)).preferences
    assert tuple(read.options[f"{key}_weight"] for key in ("motion", "deflection", "manipulability")) == weights
    assert name in read.source


def test_poses_may_be_listed_one_by_one(tmp_path: Path) -> None:
    content = shipped()
    poses = load_pipe_problem("pipe1").T_world_pipe
    listed = []
    for T in poses:
        xyz, quat = _core.pose_to_xyz_quat(T)
        listed.append({"xyz": [float(v) for v in xyz], "quat_xyzw": [float(v) for v in quat]})
    content["path"] = {"poses": listed}
    assert np.allclose(load_pipe_problem(written(tmp_path, content)).T_world_pipe, poses, atol=1e-9)


Change = Callable[[dict[str, Any]], None]


def put(*keys: Any, value: Any) -> Change:
    def change(content: dict[str, Any]) -> None:
        for key in keys[:-1]:
            content = content[key]
        content[keys[-1]] = value

    return change


def drop(*keys: Any) -> Change:
    def change(content: dict[str, Any]) -> None:
        for key in keys[:-1]:
            content = content[key]
        del content[keys[-1]]

    return change


def in_pieces(content: dict[str, Any]) -> None:
    content["structure"]["nodes"] += [[1, 1, 1], [1, 1, 2]]
    content["structure"]["sections"].append({"nodes": [7, 8]})


def in_millimetres(content: dict[str, Any]) -> None:
    content["structure"]["nodes"] = [[1000 * x for x in node] for node in content["structure"]["nodes"]]


def short(content: dict[str, Any]) -> None:
    content["structure"]["nodes"] = [[x / 25 for x in node] for node in content["structure"]["nodes"]]
    del content["compare"]


BAD: list[tuple[str, Change, list[str]]] = [
    ("no format", drop("format"), ["is no pipe problem", "format: mmgrasp-pipe"]),
    ("another format", put("format", value="mmgrasp-scenario"), ["format", "must be one of mmgrasp-pipe"]),
    ("old version", put("version", value=9), ["version = 9", "reads version 1"]),
    ("unknown key", put("pose", value=1), ["pose", "unknown key"]),
    # the frame
    ("in pieces", in_pieces, ["structure", "connected"]),
    ("no length", put("structure", "nodes", 1, value=[-0.2, -0.248, -0.097]), ["structure", "0"]),
    ("in millimetres", in_millimetres, ["structure.nodes", "span ", "coordinates are in metres"]),
    ("too thick for the hand", put("structure", "outer_diameter", value=0.3), ["structure", "no section fits the hand", "0.3 m thick"]),
    ("too short for the hand", short, ["structure", "longer than its fingers are wide"]),
    ("no thickness", put("structure", "outer_diameter", value=0), ["structure.outer_diameter = 0", "must be > 0"]),
    ("inner not less", put("structure", "inner_diameter", value=0.012), ["inner_diameter = 0.012", "less than the outer diameter, 0.012 m"]),
    ("own inner not less", put("structure", "sections", 2, value={"nodes": [2, 3], "inner_diameter": 0.02}), ["sections[2].inner_diameter = 0.02", "less than"]),
    ("no such node", put("structure", "sections", 0, "nodes", value=[0, 7]), ["sections[0].nodes[1] = 7", "only 0 to 6"]),
    ("one node", put("structure", "sections", 0, "nodes", value=[0]), ["sections[0].nodes", "two nodes"]),
    ("twice the same", put("structure", "sections", 1, "nodes", value=[1, 0]), ["structure", "same"]),
    ("unused node", put("structure", "nodes", value=[*shipped()["structure"]["nodes"], [1, 1, 1]]), ["structure", "7"]),
    ("unknown material", put("structure", "material", value="coper"), ["structure.material = 'coper'", "did you mean copper?"]),
    ("no diameter", drop("structure", "outer_diameter"), ["sections[0]", "outer_diameter is missing"]),
    ("soft as nothing", put("structure", "materials", value={"air": {"density": 1, "youngs_modulus": 0, "shear_modulus": 1}}), ["materials.air.youngs_modulus = 0", "> 0"]),
    ("in gigapascals", put("structure", "materials", value={"steel": {"density": 7850, "youngs_modulus": 210, "shear_modulus": 80}}), ["materials.steel.youngs_modulus = 210", "it is in Pa", "1 GPa is 1.0e9"]),
    ("a copper of one's own", put("structure", "materials", value={"copper": {"density": 1, "youngs_modulus": 1e9, "shear_modulus": 1e9}}), ["materials.copper", "call another one otherwise"]),
    ("no nodes", put("structure", "nodes", value=[]), ["structure.nodes = []", "must not be empty"]),
    ("no load", put("structure", "loads", 0, value={"node": 6}), ["structure.loads[0]", "must have a mass, a force or a moment"]),
    ("load on no node", put("structure", "loads", 0, "node", value=7), ["loads[0].node = 7", "only 0 to 6"]),
    ("mass below zero", put("structure", "loads", 0, "mass", value=-1), ["loads[0].mass = -1", ">= 0"]),
    # the path
    ("not from the start", put("path", value={"poses": [{"xyz": [0.42, -0.25, 0.23], "rpy": [0, 0, -0.6]}, {"xyz": [0.4, -0.2, 0.3]}]}), ["path.poses[0]", "must be the start", "0.01 m"]),
    ("both", put("path", "poses", value=[]), ["path", "either poses or segments"]),
    ("only the start", put("path", value={"segments": []}), ["path", "at least two poses"]),
    ("no axis", put("path", "segments", 1, "arc", "axis", value=[0, 0, 0]), ["arc.axis", "other than 0, 0, 0"]),
    ("half a turn", put("path", "segments", 0, "line", value={"to": {"xyz": [0.4, -0.25, 0.3], "rpy": [3.1415926, 0, -0.6]}, "poses": 1}), ["path", "half a turn", "pose 0 to pose 1"]),
    ("in degrees", put("start", "rpy", value=[0, 0, -34]), ["start.rpy = [0, 0, -34]", "in radians"]),
    ("arc in degrees", put("path", "segments", 1, "arc", "angle", value=180), ["arc.angle = 180", "18 poses turn by half a turn or more"]),
    ("no poses", put("path", "segments", 0, "line", "poses", value=0), ["line.poses = 0", ">= 1"]),
    # grasps to compare
    ("no such section", put("compare", 0, "section", value=6), ["compare[0].section = 6", "only 0 to 5"]),
    ("outside its section", put("compare", 0, "length", value=0.5), ["compare[0].length = 0.5", "beyond the end of section 4", "0.4 m long"]),
    # preferences and limits
    ("not reciprocal", put("preferences", "comparison", 1, value=[0.5, 1, 0.25]), ["preferences.comparison", "reciprocal"]),
    ("inconsistent", put("preferences", "comparison", value=[[1, 5, 0.2], [0.2, 1, 5], [5, 0.2, 1]]), ["preferences.comparison", "10"]),
    ("two rows", put("preferences", "comparison", value=[[1, 2], [0.5, 1]]), ["preferences.comparison", "three rows"]),
    ("both ways", put("preferences", "weights", value={"motion": 1, "deflection": 1, "manipulability": 1}), ["preferences", "not both"]),
    ("no such weights", put("preferences", value={"weights": "p3"}), ["preferences.weights", "must be one of p2, p2_printed"]),
    ("nothing counts", put("preferences", value={"weights": {"motion": 0, "deflection": 0, "manipulability": 0}}), ["preferences.weights", "above zero"]),
    ("no limit", put("limits", "sag", value=0), ["limits.sag = 0", "> 0"]),
    ("in megapascals", put("limits", "stress", value=33), ["limits.stress = 33", "1 MPa is 1.0e6"]),
    ("hours", put("timing", "speed", value=1e-6), ["timing.speed = 1e-06", "at least 0.001"]),
    ("nearly reciprocal", put("preferences", "comparison", value=[[1, 6, 2], [0.167, 1, 0.25], [0.5, 4, 1]]), ["preferences.comparison", "one over its opposite, 5.9880"]),
    ("too quick", put("timing", "speed", value=1.5), ["timing.speed = 1.5", "at most 1"]),
    # robot, world, options
    ("no robot", put("robot", value={"name": "kr6lik"}), ["kr6lik", "did you mean kr6like?"]),
    ("the pipe's name", put("obstacles", 0, "name", value="pipe"), ["obstacles[0].name", "name of the pipe"]),
    ("a name twice", put("obstacles", 0, "name", value="column"), ["obstacles[1].name", "used twice"]),
    ("unknown option", put("options", "max_evaluation", value=3), ["options.max_evaluation", "did you mean max_evaluations?"]),
    ("no search", put("options", "algorithm", value="ants"), ["options.algorithm = 'ants'", "bees"]),
    ("no evaluations", put("options", "max_evaluations", value=0), ["options.max_evaluations = 0", ">= 1"]),
]  # fmt: skip


@pytest.mark.parametrize(("change", "words"), [row[1:] for row in BAD], ids=[row[0] for row in BAD])
def test_wrong_input_is_one_message(
    change: Change, words: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    content = copy.deepcopy(shipped())
    change(content)
    path = written(tmp_path, content)
    assert main(["pipe", str(path), "-o", str(tmp_path / "out")]) == 2
    lines = [line for line in capsys.readouterr().err.splitlines() if not line.startswith("[")]
    assert len(lines) == 1, lines
    assert re.search(rf"{re.escape(str(path))}:\d+: ", lines[0])
    for word in words:
        assert word in lines[0]
    assert not (tmp_path / "out").exists()


def test_a_support_that_leaves_the_pipe_movable_is_refused() -> None:
    frame = load_pipe_problem("pipe1").frame
    hinge = BeamSupport(4, 0.2, (True, True, True, False, False, False))
    with pytest.raises(mg.InvalidInput, match="movable"):
        SupportedFrame(frame, [hinge])


# --- planning ----------------------------------------------------------------------------------------------------


def test_the_motion_carries_the_pipe_through_every_pose(plan: PipePlan) -> None:
    problem = plan.problem
    assert plan.grasp is not None and plan.trajectory is not None
    T_hand_pipe = np.linalg.inv(plan.grasp.T_object_hand)
    for i, (time, T) in enumerate(zip(plan.waypoint_times, problem.T_world_pipe, strict=True)):
        found = problem.arm.fk(plan.trajectory.at(time)) @ T_hand_pipe
        assert np.linalg.norm(found[:3, 3] - T[:3, 3]) < 0.005, i
        assert np.linalg.norm(rotation_vector(found[:3, :3].T @ T[:3, :3])) < 0.05, i
    assert np.all(np.diff(plan.waypoint_times) > 0)
    assert plan.path_error[0] < 0.003 and plan.path_error[1] < 0.02
    velocities = np.abs(plan.trajectory.velocities)
    assert np.all(velocities <= 0.5 * np.asarray(problem.arm.velocity_limits) * (1 + 1e-6))
    arm, world = problem.holding(plan.grasp)
    checker = mg.CollisionChecker(problem.robot, world, group=arm)
    for a, b in zip(plan.trajectory.positions[:-1], plan.trajectory.positions[1:], strict=True):
        assert checker.edge_is_free(a, b)


def test_gravity_is_the_librarys_unless_the_file_says(tmp_path: Path) -> None:
    content = shipped()
    T = mg.pose([1, 2, 3], rpy=[0.3, -0.5, 0.7])
    assert np.allclose(
        load_pipe_problem(written(tmp_path, content)).gravity_in_pipe(T), T[:3, :3].T @ [0, 0, -9.81], atol=1e-12
    )
    content["options"]["gravity"] = 1.62
    assert np.linalg.norm(load_pipe_problem(written(tmp_path, content)).gravity_in_pipe(T)) == pytest.approx(1.62)


def test_the_sags_are_the_frames(plan: PipePlan) -> None:
    assert plan.grasp is not None
    for row, T in zip(plan.sags, plan.problem.T_world_pipe, strict=True):
        state = plan.problem.frame.deflection(plan.grasp, T)
        assert row.sag == pytest.approx(state.displacement.value, rel=1e-9)
        assert state.stress is not None and row.stress is not None
        assert row.stress == pytest.approx(state.stress.value, rel=1e-9)
        assert row.over_limit == pytest.approx(row.stress / 33e6, rel=1e-9)
        assert row.sag <= 0.004
    assert [r.sag for r in plan.sags] == pytest.approx(list(plan.optimum.path.sag), rel=1e-9)


def test_it_beats_the_grasps_it_is_compared_with(plan: PipePlan) -> None:
    blocked, other = plan.compared
    assert blocked.path is None
    assert other.path is not None and other.cost >= plan.optimum.path.cost


@pytest.mark.slow
def test_unless_told_otherwise_the_grasp_is_proven(tmp_path: Path) -> None:
    content = shipped()
    del content["options"]["algorithm"]
    stages = set()
    plan = plan_pipe(load_pipe_problem(written(tmp_path, content)), lambda stage, _: stages.add(stage))
    assert plan.outcome == mg.Outcome.solved and 0 < plan.gap <= 1e-3
    assert "branch and bound" in stages
    assert plan.optimum.evaluations > 300  # the middles of boxes count, too


def test_arms_that_no_bounds_are_known_for_are_searched_by_bees() -> None:
    arm = load_pipe_problem("pipe1").arm
    assert _core.default_grasp_search(arm) == "branch_and_bound"
    robot = mg.Robot.load(shipped_file("asset:robots/kr6like/kr6like.urdf"))
    assert _core.default_grasp_search(robot.group(base_link="base_link", tip="link_5")) == "bees"


def test_too_low_a_limit_is_said_with_the_pose(tmp_path: Path) -> None:
    content = shipped()
    content["limits"] = {"stress": 1e5}
    plan = plan_pipe(load_pipe_problem(written(tmp_path, content)))
    assert plan.grasp is None
    assert min(plan.optimum.overloaded) == plan.optimum.evaluations
    assert "the pipe bears more stress than its material's limit with 300 of the 300 grasps tried" in plan.obstruction


def test_a_pose_out_of_reach_is_named(tmp_path: Path) -> None:
    content = shipped()
    content["path"]["segments"][2]["line"]["to"]["xyz"] = [1.8, 0.3, 0.3]
    path = written(tmp_path, content)
    plan = plan_pipe(load_pipe_problem(path))
    assert plan.grasp is None
    assert plan.optimum.unreachable[-1] == 300
    first = plan.optimum.unreachable.index(300)
    assert f"no arm configuration reaches pose {first} with 300 of the 300 grasps tried" in plan.obstruction
    assert main(["pipe", str(path), "-o", str(tmp_path / "out")]) == 4
    assert not (tmp_path / "out" / "trajectory.csv").exists()
    assert f"reaches pose {first}" in (tmp_path / "out" / "report.html").read_text()


# --- the command -------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_command_writes_everything_on_one_clock(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["pipe", str(written(tmp_path, shipped())), "-o", str(out), "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    stored = json.loads((out / "result.json").read_text())
    assert printed == stored
    sags = list(csv.DictReader((out / "sag.csv").read_text().splitlines()))
    assert [int(row["pose"]) for row in sags] == list(range(35))
    assert max(float(row["sag"]) for row in sags) == pytest.approx(stored["largest_sag"])
    rows = list(csv.DictReader((out / "trajectory.csv").read_text().splitlines()))
    message = json.loads((out / "joint_trajectory.json").read_text())
    poses = list(csv.DictReader((out / "pipe_path.csv").read_text().splitlines()))
    assert len(rows) == len(message["points"]) == len(poses)
    assert float(sags[-1]["time"]) == pytest.approx(stored["duration"], abs=1e-6)
    assert float(poses[-1]["time"]) == pytest.approx(stored["duration"], abs=1e-6)
    last = message["points"][-1]["time_from_start"]
    assert last["sec"] + 1e-9 * last["nanosec"] == pytest.approx(stored["duration"], abs=1e-6)
    grasps = list(csv.DictReader((out / "grasps.csv").read_text().splitlines()))
    assert len(grasps) == stored["feasible"]
    costs = [float(row["cost"]) for row in grasps]
    assert costs == sorted(costs) and costs[0] == pytest.approx(stored["cost"])
    page = (out / "report.html").read_text()
    assert page.count("data:image/png;base64,") == 4 and "http" not in page.replace("http-equiv", "")
    assert 'src="data' in page and {p.name for p in out.iterdir()} >= {
        "deformed.png",
        "trade_off.png",
        "sag.png",
        "motion.png",
    }


def test_the_same_seed_gives_the_same_files(tmp_path: Path) -> None:
    path = written(tmp_path, shipped())
    for name in ("a", "b"):
        assert main(["pipe", str(path), "-o", str(tmp_path / name), "--no-pictures", "--seed", "4"]) == 0
    for name in ("trajectory.csv", "sag.csv", "grasps.csv"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_a_folder_of_somebody_else_is_left_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "result.json").write_text("mine")
    assert main(["pipe", "pipe1", "-o", str(out)]) == 2
    assert "result.json" in capsys.readouterr().err
    assert (out / "result.json").read_text() == "mine"


def test_ctrl_c_ends_it_and_leaves_nothing(tmp_path: Path) -> None:
    content = shipped()
    content["options"]["max_evaluations"] = 100_000_000
    out = tmp_path / "out"
    command = [sys.executable, "-m", "mmgrasp", "pipe", str(written(tmp_path, content)), "-o", str(out)]
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job's children would ignore it
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        signal.signal(signal.SIGINT, before)
        assert process.stderr is not None
        for line in process.stderr:
            if "population" in line:
                break
        process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
    assert process.returncode == 130
    assert "interrupted" in rest and "Traceback" not in rest
    assert not out.exists()


def test_a_path_that_the_arm_leaves_between_poses_is_led_straight(plan: PipePlan) -> None:
    """The pipe's way between poses is straight: half way it is where the mean of both poses is."""
    assert plan.grasp is not None and plan.trajectory is not None
    dense = _dense(plan.problem, plan.grasp, np.asarray(plan.optimum.path.path))
    assert dense is not None
    T_hand_pipe = np.linalg.inv(plan.grasp.T_object_hand)
    places = plan.problem.T_world_pipe[:, :3, 3]
    for q in dense:
        at = (plan.problem.arm.fk(q) @ T_hand_pipe)[:3, 3]
        off = []
        for a, b in pairwise(places):
            share = np.clip((at - a) @ (b - a) / max(float((b - a) @ (b - a)), 1e-15), 0, 1)
            off.append(float(np.linalg.norm(at - a - share * (b - a))))
        assert min(off) < 1e-4


def test_an_unknown_name_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pipe", "pipe7", "-o", str(tmp_path / "out")]) == 2
    assert "did you mean pipe1?" in capsys.readouterr().err


# --- candidates for a planner of many grasps ---------------------------------------------------------------------


def test_the_candidates_carry_their_sag_as_their_cost(plan: PipePlan) -> None:
    candidates = plan.optimum.sag_candidates()
    assert len(candidates) == len(plan.optimum.feasible)
    for grasp, found in zip(candidates, plan.optimum.feasible, strict=True):
        assert grasp.cost == pytest.approx(found.deflection / (len(plan.problem.T_world_pipe) - 1), rel=1e-12)
        assert np.array_equal(grasp.T_object_hand, found.grasp.T_object_hand)


def test_the_pipe_sags_least_among_the_motions_that_are_short_enough(plan: PipePlan) -> None:
    problem = plan.problem
    candidates = plan.optimum.sag_candidates()[:60]
    task = problem.manipulation_problem(candidates)
    options: dict[str, Any] = {"planner": "prm_star_mg", "time_limit": 60.0, "vertices": 500, "refinements": 0}
    for grasp in candidates:
        assert grasp.cost > 0
    shortest = mg.plan_manipulation(task, **options)
    assert shortest.path is not None
    length = shortest.cost - candidates[shortest.grasp_index].cost
    wide = mg.plan_manipulation(task, max_length=1.5 * length, **options)
    tight = mg.plan_manipulation(task, max_length=length * (1 + 1e-9), **options)
    assert wide.path is not None and tight.path is not None
    for found, most in ((wide, 1.5 * length), (tight, length * (1 + 1e-9))):
        assert float(np.linalg.norm(np.diff(found.path, axis=0), axis=1).sum()) <= most + 1e-9
    assert candidates[wide.grasp_index].cost <= candidates[tight.grasp_index].cost
    assert mg.plan_manipulation(task, max_length=0.1 * length, **options).path is None


def test_limits_are_refused_without_a_frame() -> None:
    problem = load_pipe_problem("pipe1")
    task = _core.ObjectPathProblem(
        problem.arm, problem.world, problem.pipe.shapes(), problem.T_world_pipe, gripper=problem.gripper
    )
    with pytest.raises(mg.InvalidInput, match="max_sag"):
        optimize_grasp(task, problem.pipe, max_sag=1e-3, max_evaluations=5)


def test_a_grasp_whose_motion_cannot_be_timed_gives_way_to_the_next(
    plan: PipePlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    true_motion = timed_motion
    refused = [plan.optimum.feasible[0].grasp.T_object_hand]

    def timed(problem: Any, grasp: Any, *rest: Any) -> Any:
        if any(np.array_equal(grasp.T_object_hand, T) for T in refused):
            raise UntimedError("no time")
        return true_motion(problem, grasp, *rest)

    monkeypatch.setattr(planning, "timed_motion", timed)
    second = planning.plan_pipe(plan.problem)
    assert second.untimed >= 1 and second.grasp is not None and second.path is not None and plan.path is not None
    assert not np.array_equal(second.grasp.T_object_hand, refused[0])
    assert second.path.cost >= plan.path.cost
    assert len(second.sags) == len(plan.sags)
    page, path = pipe_report_html(second, None), second.path
    assert f"{path.cost:.3f}" in page and f"{path.joint_motion:.2f} rad" in page
    assert f"{plan.path.cost:.3f}" not in page and f"{plan.path.joint_motion:.3f}" not in page  # of the refused grasp
    best = page[page.index("<b>the best</b>") :]
    assert best.index(f"{path.cost:.3f}") < best.index("</tr>")
    refused += [f.grasp.T_object_hand for f in plan.optimum.feasible]
    with pytest.raises(UntimedError, match="grasps tried"):
        planning.plan_pipe(plan.problem)
