"""The command `mmgrasp`.

Exit codes: 0 done, 1 a plan has faults, a robot cannot be planned for or an exact value of a paper is missed, 2 bad input, 3 there is provably no plan or no
frame could be used, 4 none was found, which proves nothing. A command that a signal ended removes what it had half written; its code is 128 and
the signal's number: 130 Ctrl-C, 143 SIGTERM, 129 SIGHUP, 141 when nobody reads its output any more.
"""

from __future__ import annotations

import argparse
import contextlib
import errno
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.console import Console

from .._core import Error, InvalidInput, Outcome
from .._files import check_folder, check_new_file, printable, temporary_room, write_file
from ..documents.reading import Document
from ..part_supply import (
    ScenarioPlan,
    plan_drive_by_picks,
    plan_part_supply,
    plan_to_check,
    read_plan,
    verify_plan,
    verify_schedule,
)
from ..part_supply.drive_by import check_in_passing
from ..part_supply.plan_file import check_names
from ..part_supply.schedule_check import is_schedule
from ..scenario import load_scenario
from .arguments import build_parser
from .arrive import run_arrive
from .check import check_robot, describe
from .console import CommandConsole, Reporter, leave_streams, open_streams
from .exit_codes import BAD_INPUT, DONE, FAULTY, INTERRUPTED, exit_code
from .grasp import run_grasp
from .grippers import run_grippers
from .init import run_init
from .output_folder import OutputFolder
from .pipe import run_pipe
from .scan import run_scan
from .schedule import print_schedule_verdict, run_schedule
from .segment import run_segment
from .signals import Ended, code_of, ended_by_signals
from .tables import bench_table, drive_by_summary, print_verdict, summary

if TYPE_CHECKING:
    from ..reproduce.entry import Sweep


def run_plan(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp plan`: plans a scenario and writes what it found; the exit code."""
    folder = OutputFolder(arguments.out)
    with Reporter(console) as report:
        scenario = load_scenario(
            arguments.scenario, robot=arguments.robot, seed=arguments.seed, threads=arguments.threads, progress=report
        )
        if arguments.drive_by:
            check_in_passing(scenario)
        plan = plan_part_supply(scenario, progress=report)
        page = write_outputs(plan, folder, report, pictures=not arguments.no_pictures)
        passing = None
        if arguments.drive_by and plan.outcome == Outcome.solved:
            passing = plan_drive_by_picks(plan, progress=report)
            folder.fill(passing.save, added=True)
            if not arguments.no_pictures:
                with folder.illustrated() as draft:
                    write_file(draft / "report.html", report_page(passing.plan_to_dict(), folder.path, plan.timings))
    if plan.outcome != Outcome.solved:
        console.print(f"no plan: {plan.outcome.name.replace('_', ' ')}", style="bold red", markup=False)
        for obstruction in plan.obstructions:
            console.print(f"- {obstruction.message}", markup=False, soft_wrap=True)
    else:
        console.print(summary(plan))
    if passing is not None:
        console.print(drive_by_summary(passing))
    console.print(f"report: {printable(str(arguments.out / page))}", markup=False, soft_wrap=True)
    return exit_code(plan.outcome)


def write_outputs(
    plan: ScenarioPlan, folder: OutputFolder, report: Callable[[str, float], None], pictures: bool
) -> str:
    """Writes the plan, then, so that it is there whatever becomes of them, pictures and report; returns the name of the page to look at."""
    report("writing", 0.0)
    rows = [{"stage": stage, "seconds": seconds} for stage, seconds in plan.timings]

    def write_plan(draft: Path) -> None:
        plan.save(draft / "plan.json")
        write_file(draft / "timings.json", json.dumps(rows, indent=1) + "\n")
        plan.save_trajectories(draft / "trajectories")

    folder.fill(write_plan)
    if pictures:
        from ..viz.pictures import write_pictures

        content = plan.to_dict()
        report("writing", 0.3)
        with folder.illustrated() as draft:
            write_pictures(content, draft)
            report("writing", 0.9)
            write_file(draft / "report.html", report_page(content, draft, plan.timings))
    report("writing", 1.0)
    return "report.html" if pictures else "plan.json"


def report_page(content: dict[str, Any], pictures: Path, timings: Sequence[tuple[str, float]]) -> str:
    """The report of a plan, with the pictures of a folder and how long each stage took [s]."""
    from ..viz.report import report_html

    return str(report_html(content, pictures, timings))


def run_verify(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp verify`: checks a plan or a schedule; the exit code."""
    if is_schedule(arguments.plan):
        return verify_schedule_file(arguments, console)
    options = {key: value for key in ("samples", "threads") if (value := getattr(arguments, key)) is not None}
    with Reporter(console) as report:
        verdict = verify_plan(
            arguments.plan, scenario=arguments.scenario, robot=arguments.robot, progress=report, **options
        )
    if arguments.json:
        print(json.dumps(verdict.to_dict(), indent=1))
    else:
        print_verdict(verdict, console)
    return DONE if verdict.ok else FAULTY


def verify_schedule_file(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp verify` of a schedule; the exit code."""
    for key in ("scenario", "robot", "samples", "threads"):
        if getattr(arguments, key) is not None:
            raise InvalidInput(f"--{key}: is for plans; {printable(str(arguments.plan))} is a schedule")
    with Reporter(console) as report:
        verdict = verify_schedule(arguments.plan, progress=report)
    if arguments.json:
        print(json.dumps(verdict.to_dict(), indent=1))
    else:
        print_schedule_verdict(verdict, console)
    return DONE if verdict.ok else FAULTY


def run_check(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp check`: looks at a robot; the exit code."""
    if arguments.write_srdf is not None:
        check_new_file(arguments.write_srdf)
    with Reporter(console) as report:
        found = check_robot(
            arguments.urdf,
            arguments.srdf,
            dict(arguments.package),
            arguments.base,
            report,
            arguments.mesh_tolerance,
            dict(arguments.xacro_arg) or None,
        )
    if arguments.write_srdf is not None:
        write_file(arguments.write_srdf, found.srdf())
    print(json.dumps(found.to_dict(), indent=1, default=str) if arguments.json else printable(describe(found)))
    return DONE if found.ok else FAULTY


def run_view(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp view`: a plan in the browser; the exit code."""
    content = read_plan(arguments.plan)
    root = Document(str(arguments.plan), content, {}).root  # says what is wrong with a damaged plan before it is drawn
    check_names(root)
    if content["outcome"] == "solved":
        plan_to_check(root)
    wanted = [file for file in (arguments.png, arguments.film) if file is not None]
    for file in wanted:
        check_new_file(file)
    if len(wanted) == 2 and os.path.realpath(wanted[0]) == os.path.realpath(wanted[1]):
        raise InvalidInput(f"--png and --film: {printable(str(wanted[0]))} cannot be both")
    if arguments.png is not None:
        from ..viz.viewer import write_png

        with temporary_room(Path(os.path.realpath(arguments.png)).parent):
            write_png(content, arguments.png)
    if arguments.film is not None:
        from ..viz.film import write_film

        with temporary_room(Path(os.path.realpath(arguments.film)).parent), Reporter(console) as report:
            write_film(content, arguments.film, progress=report)
    for file in wanted:
        console.print(printable(str(file)), markup=False)
    if wanted:
        return DONE
    from ..viz.viewer import view

    try:
        view(content, port=arguments.port)
    except ImportError:
        raise InvalidInput("the browser view needs viser: pip install 'mmgrasp[view]'") from None
    return DONE


def run_bench(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp bench`: plans the queries of a motion benchmark; the exit code."""
    from ..problems.motion_bench import MBM_SETS
    from ..problems.motion_bench_run import holds, run_motion_bench

    with Reporter(console) as report:
        results = run_motion_bench(
            arguments.data,
            list(dict.fromkeys(arguments.robot)),
            list(dict.fromkeys(arguments.set or MBM_SETS)),
            arguments.limit,
            range(1, 1 + arguments.seeds),
            progress=report,
            planner=arguments.planner,
        )
    rows = [result.to_dict() for result in results]
    if arguments.json:
        print(json.dumps({"rows": rows, "holds": holds(results)}))
    else:
        console.print(bench_table(rows))
        for fault in (fault for row in rows for fault in row["faults"]):
            console.print(printable(f"- {fault}"), markup=False, soft_wrap=True)
    return DONE if holds(results) else FAULTY


def run_reproduce(arguments: argparse.Namespace, console: Console) -> int:
    """`mmgrasp reproduce`: papers' tables beside ours; the exit code."""
    from .. import reproduce as again
    from ..reproduce.page import check_places, markdown, store

    if not arguments.name:
        for entry in again.ENTRIES.values():
            print(f"{entry.name:<24}{entry.title}")
        return DONE
    names = [e for name in arguments.name for e in (again.ENTRIES if name == "all" else [again.entry(name).name])]
    if arguments.out is not None:
        check_folder(arguments.out)
        for name in names:
            check_places(name, arguments.seed, arguments.out)
    results = []
    room = contextlib.nullcontext() if arguments.out is None else temporary_room(arguments.out)
    with Reporter(console) as report, room, _sweep(arguments) as sweep:
        for name in dict.fromkeys(names):
            result = again.reproduce(name, quick=arguments.quick, seed=arguments.seed, progress=report, sweep=sweep)
            results.append(result)
            if arguments.out is not None:
                store(result, arguments.out)
            if not arguments.json:
                print(markdown(result), flush=True)
    if arguments.json:
        print(json.dumps(results[0] if len(results) == 1 else results, allow_nan=False))
    return DONE if all(c["holds"] for result in results for c in result["checks"] if c["kind"] == "E") else FAULTY


@contextlib.contextmanager
def _sweep(arguments: argparse.Namespace) -> Iterator[Sweep]:
    """Calls here, or on the cluster that the arguments ask for."""
    if arguments.workers is None and arguments.scheduler is None:
        from ..reproduce.entry import sweep_here

        yield sweep_here
        return
    from .. import cluster

    with cluster.connect(workers=arguments.workers, scheduler=arguments.scheduler, folder=arguments.shards) as engine:
        yield engine.run


COMMANDS = {
    "plan": run_plan,
    "verify": run_verify,
    "check": run_check,
    "init": run_init,
    "scan": run_scan,
    "grasp": run_grasp,
    "pipe": run_pipe,
    "segment": run_segment,
    "grippers": run_grippers,
    "reproduce": run_reproduce,
    "bench": run_bench,
    "view": run_view,
    "arrive": run_arrive,
    "schedule": run_schedule,
}


def main(arguments: Sequence[str] | None = None) -> int:
    """The command; its exit code. Errors of the user are one line on stderr."""
    open_streams()
    os.environ["MPLBACKEND"] = "Agg"  # pictures go to files; of a name it does not know matplotlib cannot be imported
    try:
        with ended_by_signals():
            try:
                return _run(arguments)
            finally:
                sys.stdout.flush()  # what nobody reads is found here, not when the interpreter ends
    except BrokenPipeError:
        leave_streams()
        return code_of(signal.SIGPIPE)
    except Ended as end:
        name = signal.Signals(end.number).name
        return _said(": ".join([f"ended by {name}", *map(str, end.args)]), code_of(end.number))
    except KeyboardInterrupt as end:
        return _said(": ".join(["interrupted", *map(str, end.args)]), INTERRUPTED)
    except (Error, OSError, RecursionError, MemoryError, ImportError) as error:
        return _said(_reason(error), BAD_INPUT)


def _run(arguments: Sequence[str] | None) -> int:
    parsed = build_parser().parse_args(arguments)
    try:
        os.getcwd()
    except FileNotFoundError:
        return _said("the current folder is no longer there: change to another one", BAD_INPUT)
    return COMMANDS[parsed.command](parsed, CommandConsole(highlight=False))


def _said(message: str, code: int) -> int:
    """The code, with one line on stderr."""
    try:
        print(f"mmgrasp: {printable(message)}", file=sys.stderr, flush=True)
        sys.stdout.flush()
    except OSError:  # nobody reads, or the disk is full
        leave_streams()
    return code


_OF_STREAMS = (errno.ENOSPC, errno.EIO, errno.EBADF, errno.EFBIG, errno.EDQUOT, errno.EINVAL)


def _reason(error: Exception) -> str:
    if isinstance(error, RecursionError):
        return "the input is nested too deeply"
    if isinstance(error, MemoryError):
        return "out of memory: use a coarser grid, larger voxels, fewer samples or fewer parts"
    if isinstance(error, ImportError):  # a library that is broken, or that there is no memory for
        return f"a part of the installation cannot be loaded: {error}"
    if isinstance(error, OSError) and not isinstance(error, Error) and error.strerror and error.filename is None:
        what = "standard output: cannot be written" if error.errno in _OF_STREAMS else "the system gives no more"
        return f"{what}: {error.strerror}"  # files have their names
    return str(error)
