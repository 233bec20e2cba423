"""Part-supply rounds, their check, and grasping while driving."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from .lookup import PATIENT, Answer, ask, call, find, get, threads
from .results import rejections, shared_cells, stop, timed
from .setups import asset, group, pose, tucked

OPEN = {"left_gripper_finger_joint": 0.05, "right_gripper_finger_joint": 0.05}


@cache
def scenario(name: str, trays: int, targets: int) -> Any:
    """A shipped scenario with fewer trays, fewer parts to pick, a smaller database, and no clock."""
    values = yaml.safe_load(asset(f"scenarios/{name}.yaml").read_text())
    values["trays"] = values["trays"][:trays]
    for tray in values["trays"]:
        if tray["targets"] != "all":
            tray["targets"] = tray["targets"][:targets]
    values["reach"] = {"samples": 300_000}
    values["options"] = {**values.get("options", {}), "motion_time_limit": PATIENT}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scenario.yaml"
        path.write_text(yaml.safe_dump(values, sort_keys=False))
        return find("load_scenario")(path)


@cache
def plan(name: str, trays: int, targets: int) -> Any:
    return find("plan_part_supply")(scenario(name, trays, targets), seed=1, threads=threads())


def supply(name: str, trays: int, targets: int) -> Answer:
    made = plan(name, trays, targets)
    found = get(made, "plan", "result")
    picks = [
        [pick.outcome, pick.stop, pick.tray, pick.part, pick.grasp, rejections(pick.rejections)] for pick in found.picks
    ]
    parts = {
        "outcome": [found.outcome, found.lower_bound, found.robustness_rate],
        "regions": [region.cells(found.grid) for region in found.regions],
        "rejections": [
            [
                [e.grasps, e.base_poses_tried, e.base_poses_feasible, rejections(e.rejections)]
                for e in region.explanations
            ]
            for region in found.regions
        ],
        "intersections": shared_cells(found.intersections),
        "stops": [stop(s) for s in found.stops],
        "route": [[leg.poses, leg.length, leg.turning] for leg in found.route],
        "picks": picks,
        "motions": [
            [[timed(m.trajectory), m.opening, get(m, "attached", "holding")] for m in pick.motions]
            for pick in found.picks
        ],
    }
    shown = {
        "outcome": found.outcome.name,
        "stops": len(found.stops),
        "picks": len(picks),
        "driven": sum(leg.length for leg in found.route),
    }
    return parts, shown | {"motions [s]": sum(pick.duration for pick in found.picks)}


@call
def part_supply_storeroom() -> Answer:
    return supply("storeroom", 5, 4)


@call
def part_supply_omni() -> Answer:
    return supply("omni_cell", 2, 2)


@call
def verified() -> Answer:
    found = find("verify_plan")(plan("storeroom", 5, 4).to_dict(), samples=50)
    rates = [[rate.stop, rate.samples, rate.good] for rate in found.rates]
    parts = {
        "faults": len(found.faults),
        "rates": rates,
        "figures": [found.minimal_stops, found.configurations_checked],
    }
    return parts, {"faults": len(found.faults), "configurations": found.configurations_checked}


@call
def base_regions() -> Answer:
    chosen = scenario("storeroom", 2, 2)
    problem, database = chosen.problem(), chosen.reach_database()
    grid = find("make_base_grid")(problem, database)
    kept = find("ObjectRegions").compute(problem, database, grid)
    regions = [kept.base_region(tray) for tray in range(2)]
    before = [region.cells(grid) for region in regions]
    first = kept.parts(0)[0]
    kept.remove([(0, first)])
    after = [kept.base_region(0).cells(grid), kept.region(0, kept.parts(0)[:1])]
    return {"regions": before, "without a part": after, "parts": [r.part_cells(grid) for r in regions]}, {
        "cells": [r.count for r in regions]
    }


@call
def drive_by() -> Answer:
    limits = {"wheel_separation": 0.37476, "linear_velocity": 0.6, "wheel_velocity": 0.8}
    folder = asset("robots/fetchlike")
    moving = find("Robot").load(
        folder / "fetchlike.urdf", folder / "fetchlike.srdf", base="diff_drive", base_limits=limits
    )
    whole = moving.group("arm", tip="gripper_link", with_base=True).with_reference({"torso_lift_joint": 0.2})
    goal = [10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5]
    task = find("DriveByTask")(pose(5.5, -2, 0.5, rpy=[1, 1, 0]))
    found = ask(find("plan_drive_by"), moving, whole, find("World")(), start=[0.0] * 10, tasks=[task], goal=goal,
                                  time_limit=PATIENT, attempt_time_limit=PATIENT, threads=threads())  # fmt: skip
    way = found.trajectory
    parts = {
        "outcome": found.outcome,
        "trajectory": [way.times, way.positions, way.drive],
        "sampled": timed(way.sampled(3)),
    }
    parts["events"] = [[e["waypoint"], e["time"], e["base_speed"], e["tool_speed"]] for e in found.events]
    return parts | {"iterations": found.iterations}, {
        "outcome": found.outcome.name,
        "seconds": found.duration,
        "iterations": found.iterations,
    }


@call
def drive_by_past_a_table() -> Answer:
    """A bottle is taken in passing; the robot keeps clear of the table and of itself."""
    arm = group("fetchlike", "diff_drive", with_base=True).with_reference({"head_tilt_joint": 0.4, **OPEN})
    scene = find("World")()
    scene.add_box("table", [1.2, 0.5, 0.7], pose(2.0, -0.9, 0.35))
    scene.add_cylinder("bottle", 0.028, 0.16, pose(2.0, -0.8, 0.781))
    T_grasp, home = pose(2.0, -0.8, 0.77, rpy=[0, 0, -0.6]), tucked("fetchlike", "diff_drive")
    tasks = [
        find("DriveByTask")(T_grasp @ pose(-0.12, 0, 0), tolerance=[0.005] * 3 + [0.03] * 3),
        find("DriveByTask")(T_grasp, dwell=0.4, object="bottle"),
    ]
    ends = {"start": [0, 0, 0, *home], "goal": [4, 0, 0, *home]}
    options = {"waypoints": 45, "time_limit": PATIENT, "attempt_time_limit": PATIENT, "threads": threads()}
    found = ask(find("plan_drive_by"), arm.robot, arm, scene, tasks=tasks, **ends, **options)
    way = found.trajectory
    parts = {"outcome": [found.outcome, found.iterations, get(found, "solves", "attempts")]}
    parts["trajectory"] = [] if way is None else [way.times, way.positions, way.drive]
    return parts, {"outcome": found.outcome.name, "seconds": found.duration, "iterations": found.iterations}


@call
def drive_by_picks() -> Answer:
    """The first picks of a plan merged with the drive."""
    found = find("plan_drive_by_picks")(plan("omni_cell", 2, 2))
    parts = {"used": [[p.used, p.leg, p.stop, p.pick, p.stop_and_pick, p.drive_by] for p in found.picks]}
    parts["ways"] = [None if p.result.trajectory is None else p.result.trajectory.positions for p in found.picks]
    return parts, {"used": sum(p.used for p in found.picks), "saved": found.saved}


@call
def tracking() -> Answer:
    limits = {"linear_velocity": 2.0, "angular_velocity": 3.0, "wheel_separation": 0.4}
    moving = find("Robot").from_strings(
        '<robot name="r"><link name="base"/></robot>', base="diff_drive", base_limits=limits
    )
    times = np.arange(0.0, 4.01, 0.02)
    angle = 0.4 * times
    positions = np.column_stack([1.25 * np.sin(angle), 1.25 * (1 - np.cos(angle)), angle])
    velocities = np.column_stack([0.5 * np.cos(angle), 0.5 * np.sin(angle), np.full_like(angle, 0.4)])
    wanted = find("JointTrajectory")(["x", "y", "theta"], times, positions, velocities)
    noise = {"slip_left": 0.05, "travel_noise": 0.003, "position_noise": 0.002, "heading_noise": 0.002, "seed": 4}
    found = find("track_base")(moving, wanted, start_error=[0.1, -0.05, 0.2], **noise)
    parts = {
        "way": [found.times, found.actual, found.commands],
        "errors": [found.position_errors, found.heading_errors],
    }
    return parts, {"final error": found.final_error}
