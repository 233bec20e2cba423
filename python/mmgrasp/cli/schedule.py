"""`mmgrasp schedule`: when each of several robots may go so that they never meet."""

from __future__ import annotations

import argparse
import json
import math
import os

from rich.console import Console
from rich.table import Table

from .._core import InvalidInput, Outcome
from .._files import check_new_file, printable, temporary_room
from ..part_supply.schedule import Schedule, schedule_plans
from ..part_supply.schedule_check import ScheduleVerdict
from ..part_supply.shared_areas import SharedArea
from .console import Reporter
from .exit_codes import exit_code
from .output_folder import LIST, OutputFolder

FILES = ("robot_*.csv", "robot_*.json", LIST)


def run_schedule(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code."""
    check_new_file(arguments.out)
    folder = None if arguments.trajectories is None else OutputFolder(arguments.trajectories, FILES)
    if arguments.png is not None:
        check_new_file(arguments.png)
        if os.path.realpath(arguments.png) == os.path.realpath(arguments.out):
            raise InvalidInput(f"--png {arguments.png}: is the file of -o, too")
    for option, path in (("-o", arguments.out), ("--png", arguments.png)):
        if folder is not None and path is not None and os.path.realpath(path.absolute().parent) == str(folder.path):
            raise InvalidInput(f"{option} {path}: lies in the folder of --trajectories: give another one")
    with Reporter(console) as report:
        found = schedule_plans(arguments.plans, clearance=arguments.clearance, progress=report)
        if found.outcome == Outcome.solved and folder is not None:
            folder.fill(found.save_trajectories)
        found.save(arguments.out)
        if found.outcome == Outcome.solved:
            if arguments.png is not None:
                from ..viz.schedule_picture import write_schedule_picture

                with temporary_room(arguments.png.absolute().parent):
                    write_schedule_picture(found, arguments.png)
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=1, allow_nan=False))
    else:
        _print(found, console)
        console.print(f"schedule: {printable(str(arguments.out))}", markup=False, soft_wrap=True)
    return exit_code(found.outcome)


def _print(found: Schedule, console: Console) -> None:
    if found.outcome != Outcome.solved:
        console.print(f"no schedule: {found.outcome.name.replace('_', ' ')}", style="bold red", markup=False)
        console.print(f"- {printable(found.obstruction)}", markup=False, soft_wrap=True)
        console.print("- another order of the plans, or other ends of the drives, may have one", markup=False)
        return
    table = Table(title=f"robots that stay {found.clearance:g} m apart")
    for title in ("robot", "waits [s]", "longest wait", "done at [s]", "proven: not before [s]"):
        table.add_column(title, justify="left" if title == "longest wait" else "right")
    for i, robot in enumerate(found.robots):
        waits = robot.waits()
        longest = max(range(len(waits)), key=waits.__getitem__)
        where = f"{waits[longest]:.1f} s before {robot.course.pieces[longest].name}" if waits[longest] > 0 else "-"
        row = (str(i + 1), f"{robot.waited:.1f}", printable(where), f"{robot.end:.1f}", f"{robot.earliest_end:.1f}")
        table.add_row(*row)
    console.print(table)
    for i, robot in enumerate(found.robots):
        if "drive_by" in robot.course.plan:
            console.print(f"robot {i + 1} goes as its plan says without its motions in passing", markup=False)
    for area in found.areas:
        console.print(_area_line(area), markup=False, soft_wrap=True)


def _area_line(area: SharedArea) -> str:
    (x0, y0), (x1, y1) = area.low, area.high
    times = []
    for robot, windows in zip(area.robots, area.windows, strict=True):
        spoken = [
            f"{begin:.1f} to {end:.1f} s" if end < math.inf else f"from {begin:.1f} s on" for begin, end in windows
        ]
        times.append(f"robot {robot + 1} " + ", ".join(spoken))
    return f"shared, x {x0:.2f} to {x1:.2f} m, y {y0:.2f} to {y1:.2f} m: " + "; ".join(times)


def print_schedule_verdict(verdict: ScheduleVerdict, console: Console) -> None:
    """Faults, and whether the schedule holds."""
    for fault in verdict.faults:
        console.print(printable(f"FAULT {fault.code}: {fault.where}: {fault.message}"), markup=False, soft_wrap=True)
    if verdict.ok:
        console.print(
            f"the schedule holds: {verdict.robots} robots never come closer than {verdict.clearance:g} m (less 1 mm); each plan is a check of its own",
            markup=False,
            soft_wrap=True,
        )
    else:
        count = len(verdict.faults)
        console.print(f"the schedule does not hold: {count} fault{'s' if count > 1 else ''}", markup=False)
