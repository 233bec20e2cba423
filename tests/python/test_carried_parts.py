"""A robot without a bin: each part rides to the goal in the hand, in scenario, plan, check, motion, film and report."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mmgrasp as mg
from conftest import REMOVE, REPOSITORY, edited
from mmgrasp.base import write_plan
from mmgrasp.cli.commands import report_page
from mmgrasp.part_supply import read_plan
from mmgrasp.viz.film import write_film
from mmgrasp.viz.scene import PlanScene
from mmgrasp.viz.timeline import Timeline

Write = Callable[..., Path]
Planned = mg.part_supply.ScenarioPlan
SCENARIO = REPOSITORY / "tests" / "scenarios" / "storeroom_without_bin.yaml"
KINDS = ["transit", "approach", "lift", "stow", "transfer", "retreat"]


@pytest.fixture(scope="module")
def carried(small: dict[str, Any]) -> dict[str, Any]:
    """The small storeroom with its parts put on the workbench, which stands before the goal."""
    raw = edited(small, "place_region", REMOVE)
    raw["unload_region"] = {"pose": {"xyz": [-2.35, 1.2, 0.8]}, "size": [0.3, 0.6], "drop_height": 0.02}
    return raw


@pytest.fixture(scope="module")
def path(carried: dict[str, Any], write: Write) -> Path:
    return write(carried, "carried.yaml")


@pytest.fixture(scope="module")
def planned(path: Path) -> Planned:
    plan = mg.plan_part_supply(path)
    assert plan.outcome == mg.Outcome.solved, plan.obstructions
    return plan


def codes_of(content: dict[str, Any]) -> set[str]:
    return {fault.code for fault in mg.verify_plan(content, samples=20).faults}


def test_one_part_a_trip(planned: Planned, path: Path, small_plan: Planned) -> None:
    assert planned.scenario.setup.place_region is None
    assert "place_bin" not in planned.scenario.setup.robot.links
    assert [[m.kind for m in pick.motions] for pick in planned.picks] == [KINDS, KINDS]
    (unloading,) = planned.plan.unloadings
    assert unloading.after_pick == 0 and unloading.back is not None
    assert len(planned.stops) == len(small_plan.stops) and planned.plan.proven_minimal
    content = planned.to_dict()
    assert "place_region" not in content["scenario"]
    assert content["scenario"]["unload_region"]["size"] == [0.3, 0.6]
    assert mg.verify_plan(content, scenario=path, samples=100).faults == []
    assert mg.plan_part_supply(path, threads=1).to_dict() == content


def test_parts_are_let_go_over_the_region(planned: Planned) -> None:
    arm = planned.scenario.setup.arm.at(mg.pose([*planned.scenario.goal[:2], 0], rpy=[0, 0, planned.scenario.goal[2]]))
    region = planned.scenario.unload_region
    assert region is not None
    for pick in planned.picks:
        part = planned.scenario.trays[pick.tray].tray.parts[pick.part]
        T_world_hand = arm.fk(pick.motions[4].trajectory.positions[-1])
        T_world_part = T_world_hand @ np.linalg.inv(part.grasps[pick.grasp].T_object_hand)
        x, y, z = (np.linalg.inv(region.T_world_region) @ T_world_part)[:3, 3]
        assert abs(x) <= 0.15 and abs(y) <= 0.3
        assert z == pytest.approx(0.02 + 0.035, abs=2e-3)  # half of a bracket's height above


@pytest.mark.parametrize(
    ("change", "code"),
    [
        (lambda p: p.pop("unloadings"), "capacity"),
        (lambda p: p["unloadings"][0].update(after_pick=1), "unloading"),
        (lambda p: p["unloadings"][0].pop("back"), "route-ends"),
        (lambda p: p["unloadings"][0]["to_goal"]["poses"].pop(), "route-ends"),
        (lambda p: p["scenario"]["unload_region"]["pose"]["xyz"].__setitem__(1, 1.9), "release-outside"),
        (lambda p: p["scenario"]["unload_region"].update(drop_height=0.1), "release-height"),
        (lambda p: p["picks"][0]["motions"].pop(3), "motion-order"),
        (lambda p: p["picks"][0]["motions"].pop(4), "motion-order"),
        (lambda p: p["picks"][0]["motions"][3].update(attached=False), "attachment"),
        (lambda p: p["picks"][1]["motions"][0].update(attached=True), "attachment"),
        (lambda p: p["picks"][1]["motions"][0].update(opening=0.03), "opening"),
        (lambda p: p["scenario"].update(goal=[-1.6, 1.1, 3.14159265]), "route-ends"),
    ],
)
def test_broken_trips_are_seen(planned: Planned, change: Callable[[dict[str, Any]], Any], code: str) -> None:
    content = planned.to_dict()
    change(content)
    assert code in codes_of(content)


def test_a_grain_that_the_part_touches_is_seen(planned: Planned) -> None:
    """A grain where the part in the hand passes, and nothing else of the robot at home: a room that was changed since."""
    content = planned.to_dict()
    scene = PlanScene(content)
    segment = next(s for s in scene.timeline.segments if s.kind == "drive" and s.attached is not None)
    state = scene.timeline.state_at(segment.start + 0.6 * segment.duration)
    links = scene.robot_poses(state)
    assert state.attached is not None
    T = scene.part_pose(state.attached[0], state, links)
    assert T is not None
    own = {"xyz": [0.0, 0.0, 0.0], "quat_xyzw": [0.0, 0.0, 0.0, 1.0]}
    grain = {"type": "box", "size": [0.004, 0.004, 0.004], "pose": own}
    content["scenario"]["obstacles"].append(
        {"name": "grain", "pose": own | {"xyz": T[:3, 3].tolist()}, "shapes": [grain]}
    )
    faults = mg.verify_plan(content, samples=20).faults
    assert any(f.code == "route-collision" and "grain" in f.message for f in faults), faults


def test_a_plan_with_both_places_is_refused(planned: Planned, small_plan_dict: dict[str, Any]) -> None:
    content = planned.to_dict()
    content["scenario"]["place_region"] = small_plan_dict["scenario"]["place_region"]
    with pytest.raises(mg.InvalidInput, match="unload_region: must not stand beside a place_region"):
        mg.verify_plan(content)
    content = planned.to_dict()
    del content["scenario"]["unload_region"]
    with pytest.raises(mg.InvalidInput, match="place_region"):
        mg.verify_plan(content)


def test_the_part_is_in_the_hand_on_the_drives(planned: Planned, tmp_path: Path) -> None:
    content = planned.to_dict()
    timeline = Timeline(content)
    drives = [(s.label, s.attached is not None) for s in timeline.segments if s.kind == "drive"]
    assert drives == [
        ("drive to stop 1", False),
        ("drive to the goal to unload", True),
        ("drive to stop 1 again", False),
        ("drive to the goal", True),
    ]
    assert [s.label.split()[0] for s in timeline.segments[-4:]] == ["drive", "transfer", "release", "retreat"]
    for before, after in zip(timeline.segments, timeline.segments[1:], strict=False):
        end, start = (timeline.state_at(t) for t in (after.start - 1e-9, after.start + 1e-9))
        np.testing.assert_allclose(end.base[:2], start.base[:2], atol=1e-3, err_msg=f"{before.label}, {after.label}")
        np.testing.assert_allclose(end.arm, start.arm, atol=1e-3)
    assert len(timeline.state_at(timeline.duration).removed) == 2
    page = report_page(content, tmp_path, [])
    assert "trips, each with one part in the hand" in page and "stow [s]" in page
    assert write_film(content, tmp_path / "film.gif", frames=6).stat().st_size > 1000


def test_motion_and_csv(planned: Planned, tmp_path: Path) -> None:
    motion = planned.motion()
    lines = motion.to_csv().splitlines()
    base = np.array([[float(word) for word in line.split(",")[1:3]] for line in lines[1:]])
    assert np.abs(np.diff(base, axis=0)).max() < 0.3  # joined to one motion
    done = [(event["command"], event["object"]) for event in motion.gripper if event["object"]]
    parts = [planned.scenario.trays[p.tray].tray.parts[p.part].name for p in planned.picks]
    for part in parts:
        told = [command for command, held in done if held == part]
        assert told[-2:] == ["close", "open"] and told.count("close") == 1  # held from the stop to the goal
    # Each part is let go with the base at the goal.
    opened = [event["time"] for event in motion.gripper if event["command"] == "open" and event["object"] in parts]
    at = [motion.base_poses[np.searchsorted(motion.times, time)][:2] for time in opened]
    assert sum(bool(np.allclose(where, planned.scenario.goal[:2], atol=1e-6)) for where in at) == 2
    names = {path.name for path in planned.save_trajectories(tmp_path)}
    for ending, base in (("_3_stow.csv", planned.stops[0].pose), ("_4_transfer.csv", planned.scenario.goal)):
        first = (tmp_path / next(name for name in names if name.endswith(ending))).read_text().splitlines()
        x = first[0].split(",").index("base.x")
        assert float(first[1].split(",")[x]) == pytest.approx(base[0])
    assert json.dumps(motion.to_joint_trajectory(), allow_nan=False)


def test_written_from_objects_it_is_the_same(planned: Planned, tmp_path: Path) -> None:
    scenario, plan = planned.scenario, planned.plan
    write_plan(scenario.problem(), scenario.reach_database(), plan, tmp_path / "plan.json", name="a", source="b")
    mine, own = read_plan(tmp_path / "plan.json"), planned.to_dict()
    assert mine["unloadings"] == own["unloadings"]
    assert mine["scenario"]["unload_region"] == own["scenario"]["unload_region"]
    assert "place_region" not in mine["scenario"]


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("unload_region", REMOVE, "needs a place_region, the bin on the robot, or an unload_region"),
        (
            "place_region",
            {"parent": "base_link", "pose": {"xyz": [-0.06, -0.27, 0.6]}, "size": [0.2, 0.2, 0.2]},
            "unload_region: parts go into the bin",
        ),
        ("unload_region.size", [0.3, 0.6, 0.1], "unload_region.size"),
        ("unload_region.size", [0.3, 0], "unload_region.size"),
        ("unload_region.drop_height", -0.1, "drop_height"),
        ("unload_region.pose", {"xyz": [-2.35, 1.2, 0.8], "rpy": [0.1, 0, 0]}, "unload_region.pose: .*level"),
        ("unload_region.pose", {"xyz": [-2350, 1200, 800]}, "from the goal, .* in metres"),
        ("unload_region.parent", "base_link", "parent: unknown key"),
        ("unload_region.capacity", 2, "capacity: unknown key"),
    ],
)
def test_odd_regions_are_refused(carried: dict[str, Any], write: Write, key: str, value: Any, words: str) -> None:
    with pytest.raises(mg.InvalidInput, match=words):
        mg.load_scenario(write(edited(carried, key, value)))


def test_a_region_out_of_reach_says_so(carried: dict[str, Any], write: Write) -> None:
    raw = edited(carried, "unload_region.pose", {"xyz": [-2.35, 3.5, 0.8]})
    raw["trays"][0]["targets"] = [0]
    raw["options"] = raw.get("options", {}) | {"motion_time_limit": 0.5}
    plan = mg.plan_part_supply(write(raw))
    assert plan.outcome == mg.Outcome.not_found
    assert "unload_region" in plan.obstructions[0].message


def test_what_needs_a_bin_says_so(planned: Planned) -> None:
    with pytest.raises(mg.InvalidInput, match="unload_region: --drive-by takes no parts in passing"):
        mg.part_supply.plan_drive_by_picks(planned)
    with pytest.raises(mg.InvalidInput, match="unload_region: picks are not planned from a measured pose"):
        mg.part_supply.arrive(planned, 0, planned.stops[0].pose)


def test_cups_carry_nothing(write: Write) -> None:
    import yaml

    raw = yaml.safe_load((Path(mg.__file__).parent / "assets" / "scenarios" / "suction_cell.yaml").read_text())
    raw.pop("place_region", None)
    raw["unload_region"] = {"pose": {"xyz": [*raw["goal"][:2], 0.5]}, "size": [0.3, 0.3]}
    with pytest.raises(mg.InvalidInput, match="unload_region: a hand of suction cups carries nothing"):
        mg.load_scenario(write(raw))


def test_problems_take_one_place(planned: Planned) -> None:
    problem = planned.scenario.problem()
    assert problem.place_region is None and problem.unload_region is not None
    region = problem.unload_region

    def with_places(
        place: mg.base.PlaceRegion | None, unload: mg.base.UnloadRegion | None
    ) -> mg.base.PartSupplyProblem:
        return mg.base.PartSupplyProblem(
            problem.robot,
            problem.arm,
            problem.gripper,
            problem.world,
            problem.trays,
            problem.home,
            problem.start,
            problem.goal,
            place,
            unload_region=unload,
        )

    with pytest.raises(mg.InvalidInput, match="needs an unload_region"):
        with_places(None, None)
    with pytest.raises(mg.InvalidInput, match="give one of both"):
        with_places(mg.base.PlaceRegion(np.eye(4), [0.3, 0.3]), region)
    again = with_places(None, region).unload_region
    assert again is not None
    np.testing.assert_array_equal(again.T_world_region, region.T_world_region)


def test_a_profile_loses_its_bin(small: dict[str, Any], carried: dict[str, Any], write: Write) -> None:
    profile: dict[str, Any] = {"format": "mmgrasp-robot", "version": 3}
    profile |= {key: copy.deepcopy(small[key]) for key in ("robot", "gripper", "place_region")}
    raw = {key: value for key, value in carried.items() if key != "gripper"}
    raw["robot"] = {"name": str(write(profile, "robot.yaml"))}
    assert mg.load_scenario(write(raw)).setup.place_region is None
    del raw["unload_region"]
    assert mg.load_scenario(write(raw)).setup.place_region is not None


def test_the_shipped_scenario_reads() -> None:
    scenario = mg.load_scenario(SCENARIO)
    assert scenario.unload_region is not None and len(scenario.trays) == 2
