"""Table 3.5's idea carried on (P1 4): one object from each of three trays by stopping at every tray, by the minimal sequence of stops,
and without stopping."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from .._core import Outcome
from .entry import Context, Entry, Result
from .experiments import MIDDLES
from .rows import SPACING
from .setup import UNCERTAINTY, Row, database, describe, reach_samples, robot_setup

CLOSING_SPEED = 0.1  # of the gripper's opening [m/s] (P1 4.4.1)
SETTLING = 0.1  # fingers press before the object is lifted [s]

SOLUTIONS = 2  # the first one found may be three times slower than the next


def the_row() -> Row:
    return Row(trays=3, objects=(1, 1), middles=MIDDLES)


def stopping(samples: int, minimal: bool) -> dict[str, Any]:
    """Stops at the middle of each tray's region, or as few as serve all; drives, picks and what they take."""
    row = the_row()
    reach, problem = database(row, samples), row.problem()
    grid = _core.make_base_grid(problem, reach)
    regions = _core.compute_base_regions(problem, reach, grid)
    if minimal:
        sets = _core.robust_intersections(grid, regions, UNCERTAINTY)
        found = _core.cover_from_intersections(grid, sets.robust, len(regions)).stops
        stops = [(np.asarray(s.pose), list(s.trays)) for s in found]
    else:
        circles = [_core.inscribed_circle(grid, r.cells(grid))[0] for r in regions]
        stops = [(np.array([c[0], c[1], 0.0]), [t]) for t, c in enumerate(circles)]
    stops.sort(key=lambda s: s[0][1])  # the way leads along the row
    here, driving, picking, remaining = problem.start, 0.0, 0.0, {(t, 0) for t in range(len(problem.trays))}
    for pose, trays in [*stops, (problem.goal, [])]:
        leg = _core.plan_base_route(problem.arm, problem.world, home=problem.home, start=here, goal=pose)
        if leg.outcome != Outcome.solved:
            return {"solved": False}
        driving += leg.duration(problem.robot)
        for tray in sorted(trays):
            pick = _core.plan_pick(problem, reach, pose, tray, 0, sorted(remaining))
            if pick.outcome != Outcome.solved:
                return {"solved": False}
            remaining.discard((tray, 0))
            times = {m.kind: m.trajectory.duration for m in pick.motions}
            width = problem.trays[tray].parts[0].grasps[pick.grasp].opening
            closing = (pick.motions[0].opening - width) / CLOSING_SPEED + SETTLING
            # From home into the grasp, and back home; the way to the bin is left out in every row.
            picking += times["transit"] + times["approach"] + closing + times["lift"] + times["transit"]
        here = pose
    return {"solved": True, "stops": len(stops), "driving": driving, "picking": picking}


def passing(samples: int, seed: int) -> dict[str, Any]:
    """All three in one motion: the hand stands still over each tray while it closes, the base does not."""
    row = the_row()
    problem, setup = row.problem(), robot_setup(row.torso)
    opening = problem.gripper.pregrasp_opening(problem.trays[0].parts[0].grasps[0].opening)
    joints = {**setup.other_joints, **problem.gripper.joint_values(opening)}
    group = problem.robot.group(problem.arm.name, tip=problem.gripper.tool_link, with_base=True).with_reference(joints)
    tasks = []
    for tray in problem.trays:
        (part,) = tray.parts
        dwell = (opening - part.grasps[0].opening) / CLOSING_SPEED + SETTLING
        tasks.append(_core.DriveByTask(part.T_world_part @ part.grasps[0].T_object_hand, dwell=dwell))
    found = _core.plan_drive_by(
        problem.robot,
        group,
        problem.world,
        start=[*problem.start, *problem.home],
        tasks=tasks,
        goal=[*problem.goal, *problem.home],
        waypoints=60,
        solutions=SOLUTIONS,
        seed=seed,
    )
    if found.outcome != Outcome.solved:
        return {"solved": False}
    return {
        "solved": True,
        "duration": found.duration,
        "slowest": min(e["base_speed"] for e in found.events),
        "seconds": found.seconds,
    }


def run(context: Context) -> Result:
    samples = reach_samples(context.quick)
    row = the_row()
    database(row, samples, progress=context.progress)
    three, least = context.sweep(stopping, [{"samples": samples, "minimal": m} for m in (False, True)], "stops")
    (drive_by,) = context.sweep(passing, [{"samples": samples, "seed": context.seed}], "drive-by")
    result = Result(setup=describe(row, samples, "spacing [m]", "trays"))
    result.setup["trays"] = f"1, 2 and 4 of a row {SPACING} m apart, one object each"
    result.setup["closing speed [m/s]"] = CLOSING_SPEED
    result.setup["solutions compared"] = SOLUTIONS
    whole: list[float] = []
    for name, ours in (("a stop at each tray", three), ("minimal sequence", least)):
        values = result.row({"way": name})
        if ours["solved"]:
            whole.append(ours["driving"] + ours["picking"])
        values["stops"] = (None, ours.get("stops"))
        values["driving [s]"] = (None, ours.get("driving"))
        values["arm while standing [s]"] = (None, ours.get("picking"))
        values["whole time [s]"] = (None, whole[-1] if ours["solved"] else None)
    values = result.row({"way": "drive-by"})
    values["stops"] = (None, 0 if drive_by["solved"] else None)
    values["whole time [s]"] = (None, drive_by.get("duration"))
    values["slowest base at a grasp [m/s]"] = (None, drive_by.get("slowest"))
    values["planned in [s]"] = (None, drive_by.get("seconds"))
    solved = three["solved"] and least["solved"] and drive_by["solved"]
    result.trend("all three ways are planned", solved)
    result.trend("each way is faster than the one before", solved and drive_by["duration"] < whole[1] < whole[0])
    if solved:
        result.trend("the base drives at more than 0.1 m/s at every grasp", drive_by["slowest"] > 0.1)
    result.notes.append(
        "The paper's table 3.5 has driving times of the first two. Here the arm's motions are counted too, from home into the grasp and "
        "home again; how an object gets into the bin is left out in all three."
    )
    return result


ENTRIES = [Entry("p1-table-3.5-drive-by", "Three trays: a stop each, the minimal sequence, no stop at all", run)]
