"""A real plan broken in one physical way at a time is refused, with a fault that names it."""

from __future__ import annotations

import copy
import itertools
import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mmgrasp as mg
from conftest import ASSETS, DATA, REPOSITORY
from mmgrasp._core import RobotSource
from mmgrasp._core import verify as checks
from mmgrasp.part_supply.plan_writer import runs_of


def motion(plan: dict[str, Any], kind: str, pick: Any = 0) -> Any:
    return next(m for m in plan["picks"][pick]["motions"] if m["kind"] == kind)


def joint_moved(plan: dict[str, Any]) -> None:
    m = motion(plan, "transit")
    m["positions"][len(m["positions"]) // 2][1] += 0.3


def end_moved(plan: dict[str, Any]) -> None:
    motion(plan, "approach")["positions"][-1][3] += 0.02


def joint_beyond_limit(plan: dict[str, Any]) -> None:
    m = motion(plan, "transfer")
    m["positions"][len(m["positions"]) // 2][2] += 7.0


def too_fast(plan: dict[str, Any]) -> None:
    for m in plan["picks"][0]["motions"]:
        m["times"] = [t / 3 for t in m["times"]]
        m["velocities"] = [[3 * v for v in row] for row in m["velocities"]]


def obstacle_added(plan: dict[str, Any]) -> None:
    x, y, _ = plan["stops"][0]["pose"]
    shape = {"type": "box", "pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]}, "size": [0.5, 0.5, 2.0]}
    plan["scenario"]["obstacles"].append(
        {"name": "surprise", "pose": {"xyz": [x, y, 1.0], "quat_xyzw": [0, 0, 0, 1]}, "shapes": [shape]}
    )


def obstacle_on_the_route(plan: dict[str, Any]) -> None:
    poses = plan["route"][0]["poses"]
    a, b = max(itertools.pairwise(poses), key=lambda e: abs(e[0][0] - e[1][0]) + abs(e[0][1] - e[1][1]))
    xyz = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0.2]
    shape = {"type": "box", "pose": {"xyz": [0, 0, 0], "quat_xyzw": [0, 0, 0, 1]}, "size": [0.1, 0.1, 0.4]}
    plan["scenario"]["obstacles"].append(
        {"name": "box", "pose": {"xyz": xyz, "quat_xyzw": [0, 0, 0, 1]}, "shapes": [shape]}
    )


def stop_shifted(plan: dict[str, Any]) -> None:
    plan["stops"][0]["pose"][0] += 0.15


def stop_turned(plan: dict[str, Any]) -> None:
    plan["stops"][0]["pose"][2] += 0.2


def part_forgotten(plan: dict[str, Any]) -> None:
    del plan["picks"][-1]


def part_picked_twice(plan: dict[str, Any]) -> None:
    plan["picks"].append(copy.deepcopy(plan["picks"][0]))


def motions_swapped(plan: dict[str, Any]) -> None:
    m = plan["picks"][0]["motions"]
    m[1], m[2] = m[2], m[1]


def motion_missing(plan: dict[str, Any]) -> None:
    del plan["picks"][0]["motions"][2]


def picks_exchanged_motions(plan: dict[str, Any]) -> None:
    a, b = plan["picks"][0], plan["picks"][1]
    a["motions"], b["motions"] = b["motions"], a["motions"]


def part_renamed(plan: dict[str, Any]) -> None:
    plan["picks"][0]["part"] = "A/bracket_99"


def other_grasp(plan: dict[str, Any]) -> None:
    pick = plan["picks"][0]
    part = next(p for p in plan["scenario"]["parts"] if p["name"] == pick["part"])
    pick["grasp"] = (pick["grasp"] + 1) % len(part["grasps"])


def grasp_out_of_range(plan: dict[str, Any]) -> None:
    plan["picks"][0]["grasp"] = 100000


def part_moved(plan: dict[str, Any]) -> None:
    name = plan["picks"][0]["part"]
    part = next(p for p in plan["scenario"]["parts"] if p["name"] == name)
    part["pose"]["xyz"][0] += 0.01


def route_cut(plan: dict[str, Any]) -> None:
    del plan["route"][-1]


def route_jumps(plan: dict[str, Any]) -> None:
    leg = max(plan["route"], key=lambda leg: len(leg["poses"]))
    leg["poses"][len(leg["poses"]) // 2][1] += 0.4


def route_sideways(plan: dict[str, Any]) -> None:
    leg = plan["route"][0]
    leg["poses"] = [leg["poses"][0], leg["poses"][-1]]


def start_elsewhere(plan: dict[str, Any]) -> None:
    plan["scenario"]["start"][0] -= 0.3


def fingers_closed_too_early(plan: dict[str, Any]) -> None:
    motion(plan, "approach")["opening"] = 0.0
    motion(plan, "transit")["opening"] = 0.0


def fingers_open_while_holding(plan: dict[str, Any]) -> None:
    motion(plan, "transfer")["opening"] = plan["scenario"]["gripper"]["max_opening"]


def not_holding(plan: dict[str, Any]) -> None:
    motion(plan, "transfer")["holding"] = False


def time_runs_backwards(plan: dict[str, Any]) -> None:
    times = motion(plan, "lift")["times"]
    times[-1] = times[-2] - 0.01


def time_stands(plan: dict[str, Any]) -> None:
    times = motion(plan, "transit")["times"]
    times[3] = times[2]


def stop_added(plan: dict[str, Any]) -> None:
    plan["stops"].append(copy.deepcopy(plan["stops"][0]))
    last = plan["route"][-1]["poses"][0]
    plan["route"].insert(-1, {"poses": [list(last), list(last)], "length": 0, "turning": 0, "duration": 0})


def bound_lowered(plan: dict[str, Any]) -> None:
    plan["lower_bound"] = 0


def uncertainty_grown(plan: dict[str, Any]) -> None:
    plan["scenario"]["positioning_uncertainty"] = 0.8


def region_emptied(plan: dict[str, Any]) -> None:
    plan["regions"][0]["cells"] = {}


def wrist_jumps(plan: dict[str, Any]) -> None:
    m = motion(plan, "transfer")
    for row in m["positions"][len(m["positions"]) // 2 :]:
        row[-1] += 0.5


def robot_shrunk_arm_limits(plan: dict[str, Any]) -> None:
    plan["scenario"]["arm"]["velocity_limits"] = [v / 10 for v in plan["scenario"]["arm"]["velocity_limits"]]


def bin_moved(plan: dict[str, Any]) -> None:
    plan["scenario"]["place_region"]["pose"]["xyz"][0] -= 0.5


def approach_cut(plan: dict[str, Any]) -> None:
    """All but the last third is done in the transit."""
    transit, approach = plan["picks"][0]["motions"][:2]
    cut = 2 * len(approach["times"]) // 3
    for key in ("positions", "velocities", "accelerations"):
        transit[key] += approach[key][1 : cut + 1]
        approach[key] = approach[key][cut:]
    end, begin = transit["times"][-1], approach["times"][cut]
    transit["times"] += [end + t for t in approach["times"][1 : cut + 1]]
    approach["times"] = [t - begin for t in approach["times"][cut:]]


def lift_cut(plan: dict[str, Any]) -> None:
    lift, transfer = plan["picks"][0]["motions"][2:4]
    cut = len(lift["times"]) // 3
    begin, rest = lift["times"][cut], len(lift["times"]) - 1 - cut
    for key in ("positions", "velocities", "accelerations"):
        transfer[key] = lift[key][cut:-1] + transfer[key]
        lift[key] = lift[key][: cut + 1]
    ends = [t - begin for t in lift["times"][cut:]]
    transfer["times"] = ends[:rest] + [ends[-1] + t for t in transfer["times"]]
    lift["times"] = lift["times"][: cut + 1]


def accelerations_zeroed(plan: dict[str, Any]) -> None:
    for pick in plan["picks"]:
        for m in pick["motions"]:
            m["accelerations"] = [[0.0] * len(row) for row in m["accelerations"]]


def widths_scaled(plan: dict[str, Any], factor: float) -> None:
    for part in plan["scenario"]["parts"]:
        for grasp in part["grasps"]:
            grasp["width"] *= factor
    for pick in plan["picks"]:
        for m in pick["motions"]:
            if m["holding"]:
                m["opening"] *= factor


def fingers_press_into_the_part(plan: dict[str, Any]) -> None:
    widths_scaled(plan, 0.5)


def fingers_stand_clear_of_the_part(plan: dict[str, Any]) -> None:
    widths_scaled(plan, 1.2)


def region_and_radius_inflated(plan: dict[str, Any]) -> None:
    cells = plan["regions"][0]["cells"]
    rows = {iy: (a, b) for iy, a, b in cells["0"]}
    wide = min(a for a, _ in rows.values()) - 2, max(b for _, b in rows.values()) + 2
    cells["0"] = [[iy, *wide] for iy in range(min(rows) - 2, max(rows) + 3)]
    plan["stops"][0]["radius"] *= 1.3


def rate_halved(plan: dict[str, Any]) -> None:
    plan["robustness_rate"] = 0.5


def obstructed_and_solved(plan: dict[str, Any]) -> None:
    nothing = {"reach_deficit": 0, "advised_move": [0, 0], "move_trays": [], "move_objects": [], "needed_opening": 0}
    plan["obstructions"] = [
        {"tray": "A", "part": "", "stage": "region", "message": "x", "largest_uncertainty": -1, **nothing}
    ]


def called_not_minimal(plan: dict[str, Any]) -> None:
    plan["proven_minimal"] = False


def tcp_elsewhere(plan: dict[str, Any]) -> None:
    plan["scenario"]["gripper"]["tcp_link"] = "base_link"


def closing_along_the_approach(plan: dict[str, Any]) -> None:
    plan["scenario"]["gripper"]["closing"] = plan["scenario"]["gripper"]["approach"]


def other_intersection(plan: dict[str, Any]) -> None:
    plan["stops"][0]["intersection"] = 999


def cells_miscounted(plan: dict[str, Any]) -> None:
    plan["intersections"][0]["cells"] += 1


def tray_moved(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["pose"]["xyz"][0] += 0.05


def tray_flattened(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["size"][2] *= 0.5


def other_headings(plan: dict[str, Any]) -> None:
    plan["scenario"]["trays"][0]["headings"] = [0.3]


def causes_miscounted(plan: dict[str, Any]) -> None:
    plan["regions"][0]["explanations"][0]["rejections"]["scene"] += 1


def workspace_shrunk(plan: dict[str, Any]) -> None:
    plan["scenario"]["robot"]["base_limits"]["workspace"] = 0.5


BREAKS = [
    approach_cut,
    lift_cut,
    accelerations_zeroed,
    fingers_press_into_the_part,
    fingers_stand_clear_of_the_part,
    region_and_radius_inflated,
    rate_halved,
    obstructed_and_solved,
    called_not_minimal,
    tcp_elsewhere,
    closing_along_the_approach,
    other_intersection,
    cells_miscounted,
    tray_moved,
    tray_flattened,
    other_headings,
    causes_miscounted,
    workspace_shrunk,
    joint_moved,
    end_moved,
    joint_beyond_limit,
    too_fast,
    obstacle_added,
    obstacle_on_the_route,
    stop_shifted,
    stop_turned,
    part_forgotten,
    part_picked_twice,
    motions_swapped,
    motion_missing,
    picks_exchanged_motions,
    part_renamed,
    other_grasp,
    grasp_out_of_range,
    part_moved,
    route_cut,
    route_jumps,
    route_sideways,
    start_elsewhere,
    fingers_closed_too_early,
    fingers_open_while_holding,
    not_holding,
    time_runs_backwards,
    time_stands,
    stop_added,
    bound_lowered,
    uncertainty_grown,
    region_emptied,
    wrist_jumps,
    robot_shrunk_arm_limits,
    bin_moved,
]


def test_the_plan_itself_holds(small_plan_dict: dict[str, Any]) -> None:
    verdict = mg.verify_plan(small_plan_dict)
    assert verdict.ok, verdict.faults
    assert verdict.configurations_checked > 100
    assert all(rate.good >= 0.999 * rate.samples for rate in verdict.rates)
    assert verdict.minimal_stops == len(small_plan_dict["stops"])


@pytest.mark.parametrize("breaking", BREAKS, ids=lambda f: f.__name__)
def test_broken_plans_are_refused(small_plan_dict: dict[str, Any], breaking: Any) -> None:
    plan = copy.deepcopy(small_plan_dict)
    breaking(plan)
    assert plan != small_plan_dict, "the break changed nothing"
    verdict = mg.verify_plan(plan, samples=200)
    assert not verdict.ok
    assert all(fault.code and fault.message for fault in verdict.faults)


@pytest.mark.parametrize(
    ("breaking", "code"),
    [
        (approach_cut, "short-approach"),
        (lift_cut, "no-lift"),
        (accelerations_zeroed, "acceleration"),
        (fingers_press_into_the_part, "grasp-width"),
        (fingers_stand_clear_of_the_part, "grasp-width"),
        (region_and_radius_inflated, "stop-radius"),
        (workspace_shrunk, "base-workspace"),
    ],
    ids=lambda f: getattr(f, "__name__", f),
)
def test_broken_plans_are_refused_for_what_is_broken(small_plan_dict: dict[str, Any], breaking: Any, code: str) -> None:
    plan = copy.deepcopy(small_plan_dict)
    breaking(plan)
    assert code in {fault.code for fault in mg.verify_plan(plan, samples=50).faults}


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("proven_minimal", "banana"),
        ("regions.0.cells.0.0", 3),
        ("scenario.obstacles.0.pose", {"xyz": [0, 0, 0], "rpy": [0, 0, 0]}),
        ("scenario.obstacles.0.shapes", []),
        ("scenario.gripper.finger_depth", "x"),
        ("scenario.options.seed", None),
        ("scenario.extra", 1),
        ("timings", 3),
        ("stops.0.intersection", 1.5),
        ("robustness_rate", 1e400),
        ("lost_intersections", {}),
    ],
)
def test_values_of_another_form_are_named(small_plan_dict: dict[str, Any], path: str, value: Any) -> None:
    plan = copy.deepcopy(small_plan_dict)
    here: Any = plan
    *parents, last = [int(key) if key.isdigit() and not parent == "cells" else key
                      for parent, key in itertools.pairwise(["", *path.split(".")])]  # fmt: skip
    for key in parents:
        here = here[key]
    here[last] = value
    with pytest.raises(mg.InvalidInput, match=path.split(".")[0]):
        mg.verify_plan(plan)


@pytest.mark.parametrize(
    ("text", "piece"),
    [
        ('{"format": "mmgrasp-plan", "format": "mmgrasp-plan"}', "'format' is given twice"),
        ('{"format": "mmgrasp-plan", "version": ' + "9" * 5000 + "}", "5000 digits"),
        ('{"format": "mmgrasp-plan", "version": NaN}', "no number in JSON"),
        ('{"format": ' + "[" * 900 + "]" * 900 + "}", "nested"),
        ("[" * 100000, "nested"),
        ('{"format": "mmgrasp-plan", "version": 2', "is no valid JSON"),
        ("[]", "is no plan"),
        ('"\\ud800"', "is no plan"),
    ],
)
def test_texts_that_are_no_plan(tmp_path: Path, text: str, piece: str) -> None:
    (tmp_path / "plan.json").write_text(text)
    with pytest.raises(mg.InvalidInput, match=re.escape(piece)):
        mg.verify_plan(tmp_path / "plan.json")


def test_a_scenario_that_defines_another_problem_is_named(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    tray = {**small["trays"][0], "headings": [0.0, 0.3]}
    for changed, where in (
        ({**small, "trays": [tray]}, "trays[0].headings"),
        ({**small, "reach": {"samples": 400_000}}, "reach.samples"),
        ({**small, "gripper": {**small["gripper"], "closing_speed": 0.2}}, "gripper.closing_speed"),
    ):
        verdict = mg.verify_plan(small_plan_dict, scenario=write(changed), samples=20)
        assert [f.where for f in verdict.faults if f.code == "scenario-changed"] == [f"scenario.{where}"]


def urdf_changed(plan: dict[str, Any], old: str, new: str) -> None:
    """The URDF that was given says something else than the robot that was planned for."""
    urdf = next(u for u in plan["scenario"]["robot"]["urdfs"] if old in u["urdf"])
    urdf["urdf"] = urdf["urdf"].replace(old, new, 1)


def joint_text(plan: dict[str, Any], joint: str) -> str:
    text: str = next(u["urdf"] for u in plan["scenario"]["robot"]["urdfs"] if f'joint name="{joint}"' in u["urdf"])
    start = text.index(f'<joint name="{joint}"')
    return text[start : text.index("</joint>", start)]


@pytest.mark.parametrize(
    ("tag", "quantity"), [("origin", "its origin"), ("axis", "its axis"), ("limit", "its upper limit")]
)
def test_a_robot_that_was_read_wrongly_is_named(small_plan_dict: dict[str, Any], tag: str, quantity: str) -> None:
    plan = copy.deepcopy(small_plan_dict)
    joint = plan["scenario"]["arm"]["joints"][1]
    text = joint_text(plan, joint)
    (before, *_) = re.findall(f"<{tag} [^>]*>", text)
    after = {
        "origin": before.replace('xyz="', 'xyz="1'),
        "axis": re.sub('xyz="[^"]*"', 'xyz="0.6 0.8 0"', before),
        "limit": re.sub('upper="[^"]*"', 'upper="0.01"', re.sub('lower="[^"]*"', 'lower="-0.01"', before)),
    }[tag]
    urdf_changed(plan, text, text.replace(before, after))
    faults = mg.verify_plan(plan, samples=50).faults
    named = [f for f in faults if f.code == "robot-differs"]
    assert {f.where for f in named} == {f"joint '{joint}'"}
    assert any(quantity in f.message for f in named), named
    assert any(f.code != "robot-differs" for f in faults), "the motions must give it away, too"


FOLDERS = (ASSETS, REPOSITORY / "tests" / "fuzz" / "corpus" / "urdf", DATA / "robots")


@pytest.mark.parametrize(
    "path", [p for folder in FOLDERS for p in sorted(folder.rglob("*.urdf"))], ids=lambda p: p.stem
)
def test_urdfdom_reads_the_same_robot_as_we_do(path: Path) -> None:
    try:
        robot = mg.Robot.load(path, allow_missing_meshes=True)
    except mg.InvalidInput:
        pytest.skip("refused by our reader")
    files = {s.mesh_path: s.mesh_path for link in robot.links for s in robot.collisions(link) if s.mesh_path}
    plan = checks.PlanToCheck(robot.source)
    planned = RobotSource(srdf=robot.to_srdf())
    planned.add_urdf(robot.to_urdf(), mesh_files=files)
    plan.planned_robot = planned
    faults = checks.check_plan(plan).faults
    assert faults, "a plan without anything in it"
    assert not [f for f in faults if f.code in ("robot-differs", "robot-unreadable")], faults


def test_what_urdfdom_refuses_is_named(small_plan_dict: dict[str, Any]) -> None:
    plan = copy.deepcopy(small_plan_dict)
    urdf_changed(plan, "</robot>", '<joint name="loose" type="fixed"><parent link="nowhere"/></joint></robot>')
    (fault,) = mg.verify_plan(plan).faults
    assert fault.code == "robot-unreadable"
    assert "urdfdom" in fault.message
    assert "loose" in fault.message or "nowhere" in fault.message


def test_plans_without_the_urdfs_are_read_from_the_composed_one(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    plan = copy.deepcopy(small_plan_dict)
    del plan["scenario"]["robot"]["urdfs"], plan["scenario"]["robot"]["links"]
    verdict = mg.verify_plan(plan, scenario=write(small), samples=50)
    assert verdict.ok, verdict.faults


def test_a_changed_scenario_is_named(
    small_plan_dict: dict[str, Any], small: dict[str, Any], write: Callable[..., Path]
) -> None:
    changed = copy.deepcopy(small)
    changed["obstacles"][0]["box"][0] += 0.01
    verdict = mg.verify_plan(small_plan_dict, scenario=write(changed), samples=50)
    assert [f.code for f in verdict.faults] == ["scenario-changed"]
    assert "obstacles[0]" in verdict.faults[0].where


def test_values_that_are_no_numbers_are_refused(small_plan_dict: dict[str, Any]) -> None:
    for value in (None, "x", float("nan"), [1]):
        plan = json.loads(json.dumps(small_plan_dict))
        plan["picks"][0]["motions"][0]["positions"][0][0] = value
        with pytest.raises(mg.InvalidInput, match=r"picks\[0\]\.motions\[0\]\.positions"):
            mg.verify_plan(plan)


def test_runs_hold_every_cell() -> None:
    import numpy as np

    layer = np.random.default_rng(1).integers(0, 2, (7, 11))
    again = np.zeros_like(layer)
    for iy, a, b in runs_of(layer):
        again[iy, a:b] = 1
    np.testing.assert_array_equal(layer, again)
