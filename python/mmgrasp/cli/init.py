"""`mmgrasp init`: a first scenario for a robot."""

from __future__ import annotations

import argparse
import shlex

from rich.console import Console

from .._core import Error
from .._files import check_new_file, printable, write_result
from ..scenario import load_scenario
from ..scenario.first import first_scenario
from .console import Reporter
from .exit_codes import DONE, FAULTY


def run_init(arguments: argparse.Namespace, console: Console) -> int:
    """The command; returns its exit code: 1 where the scenario that was written cannot be planned yet."""
    check_new_file(arguments.out)
    with Reporter(console) as report:
        made = first_scenario(
            arguments.urdf,
            arguments.map,
            folder=arguments.out.parent,
            srdf=arguments.srdf,
            package_dirs=dict(arguments.package),
            xacro_args=dict(arguments.xacro_arg),
            mounts=arguments.mount,
            base=arguments.base,
            group=arguments.group,
            tool_link=arguments.tool_link,
            progress=report,
        )
        write_result(arguments.out, made.text)
        fault = ""
        try:
            load_scenario(arguments.out, progress=report)
        except Error as error:
            fault = str(error)
    for line in [*made.found, *(f"look       {doubt}" for doubt in made.doubts)]:
        console.print(printable(line), markup=False, soft_wrap=True)
    name = printable(str(arguments.out))
    if fault:
        console.print(
            printable(f"written to {name}, which cannot be planned yet: {fault}"), markup=False, soft_wrap=True
        )
        return FAULTY
    console.print(
        f"written to {name}; next: mmgrasp plan {printable(shlex.quote(str(arguments.out)))} -o out/",
        markup=False,
        soft_wrap=True,
    )
    return DONE
