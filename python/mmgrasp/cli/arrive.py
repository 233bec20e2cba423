"""`mmgrasp arrive`: the picks of a stop from where the base really stands."""

from __future__ import annotations

import argparse
import json
import math

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from .._core import InvalidInput, Outcome
from .._files import printable
from ..part_supply.arrival import Arrival, arrive
from ..part_supply.plan_file import read_plan
from .console import Reporter
from .exit_codes import exit_code
from .output_folder import LIST, OutputFolder

FILES = ("arrival.json", LIST, "trajectories")


def run_arrive(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code."""
    folder = None if arguments.out is None else OutputFolder(arguments.out, FILES)
    with Reporter(console) as report:
        report("reading", 0.0)
        stops = len(read_plan(arguments.plan)["stops"])
        if not stops:
            raise InvalidInput(f"{arguments.plan}: holds no stops")
        if arguments.stop > stops:
            raise InvalidInput(
                f"--stop {arguments.stop}: must be at most {stops}, the number of stops in {arguments.plan}"
            )
        found = arrive(
            arguments.plan,
            arguments.stop - 1,
            arguments.pose,
            picked=arguments.picked,
            scenario=arguments.scenario,
            robot=arguments.robot,
            progress=report,
        )
        if folder is not None:
            folder.fill(found.save)
    if arguments.json:
        print(json.dumps(found.to_dict(), indent=1, allow_nan=False))
    else:
        _print(found, console)
    return exit_code(found.outcome)


def _print(found: Arrival, console: Console) -> None:
    if found.outcome != Outcome.solved:
        console.print(f"no picks: {found.outcome.name.replace('_', ' ')}", style="bold red", markup=False)
        for why in found.explanations:
            console.print(f"- {printable(why)}", markup=False, soft_wrap=True)
        return
    table = Table(title=f"stop {found.stop + 1} from where the base stands")
    for title in ("pick", "part", "grasp", "arm time [s]"):
        table.add_column(title, justify="left" if title == "part" else "right")
    for i, pick in enumerate(found.picks):
        name = found.scenario.trays[pick.tray].tray.parts[pick.part].name
        table.add_row(str(i + 1), escape(name), str(pick.grasp), f"{pick.duration:.1f}")
    table.caption = (
        f"{found.offset:.3f} m and {math.degrees(found.turned):.1f}° from the plan's base pose (its disc: "
        f"{found.radius:.3f} m), planned in {found.seconds:.2f} s"
    )
    console.print(table)
