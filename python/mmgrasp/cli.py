"""The command `mmgrasp`.

Exit codes: 0 done, 1 a plan has faults, a robot cannot be planned for or an exact value of a paper is missed, 2 bad input, 3 there is no plan, 130 Ctrl-C.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from . import _core
from ._console import Reporter
from ._core import Error, InvalidInput, Outcome
from ._files import write_file
from ._reading import read_json
from .check import check_robot, describe
from .drive_by import DriveByPlan, plan_drive_by_picks
from .part_supply import PartSupplyPlan, plan_part_supply
from .plan_file import plan_to_check, read_plan
from .scenario import load_scenario
from .verification import PlanVerdict, verify_plan

DONE, FAULTY, BAD_INPUT, NO_PLAN, INTERRUPTED = 0, 1, 2, 3, 130


class _Parser(argparse.ArgumentParser):
    """An argument parser whose options may not be abbreviated: a script keeps its meaning when options are added."""

    def __init__(self, **keywords) -> None:
        super().__init__(allow_abbrev=False, **keywords)


def build_parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="mmgrasp", description="Planning for mobile manipulators.")
    parser.add_argument("--version", action="version", version=f"mmgrasp {_core.__version__}")
    commands = parser.add_subparsers(dest="command", required=True, metavar="command", parser_class=_Parser)

    plan = commands.add_parser(
        "plan", help="plan a part-supply round and write plan, report, pictures and trajectories"
    )
    plan.add_argument("scenario", type=Path, help="scenario file (YAML)")
    plan.add_argument("-o", "--out", type=Path, required=True, metavar="DIR", help="folder to write into")
    plan.add_argument("--robot", metavar="NAME", help="another robot: a shipped profile (tiago, ...) or a profile file")
    plan.add_argument("--threads", type=_count, metavar="N", help="0: all (default); the plan does not depend on it")
    plan.add_argument("--seed", type=_count, metavar="N", help="same seed, same plan")
    plan.add_argument(
        "--drive-by", action="store_true", help="take the first part at each stop without stopping for it"
    )
    plan.add_argument("--no-pictures", action="store_true", help="write plan.json and the trajectories only")
    plan.set_defaults(run=run_plan)

    verify = commands.add_parser("verify", help="check a finished plan without the planner")
    verify.add_argument("plan", type=Path, help="plan.json")
    verify.add_argument("--scenario", type=Path, metavar="FILE", help="compare with this scenario, read anew")
    verify.add_argument("--robot", metavar="NAME", help="the robot profile the plan was made with")
    verify.add_argument("--samples", type=_count, metavar="N", help="base poses drawn at each stop (default 1000)")
    verify.add_argument("--threads", type=_count, metavar="N", help="0: all (default)")
    verify.add_argument("--json", action="store_true", help="print the verdict as JSON")
    verify.set_defaults(run=run_verify)

    check = commands.add_parser("check", help="tell what mmgrasp understands of a robot")
    check.add_argument("urdf", type=Path, help="a URDF, or a .xacro file that expands to one")
    check.add_argument("--srdf", type=Path, metavar="FILE")
    check.add_argument(
        "--xacro-arg",
        action="append",
        default=[],
        metavar="NAME=VALUE",
        type=_xacro_argument,
        help="an argument of the xacro file; may be repeated",
    )
    check.add_argument(
        "--package",
        action="append",
        default=[],
        metavar="NAME=DIR",
        type=_package,
        help="where package://NAME/... lies; may be repeated",
    )
    check.add_argument("--base", choices=["fixed", "diff_drive", "omni"], default="fixed")
    check.add_argument(
        "--mesh-tolerance",
        type=float,
        default=0.0,
        metavar="M",
        help="how far simpler solids may stick out of collision meshes [m] (default 0: only the same solid)",
    )
    check.add_argument("--write-srdf", type=Path, metavar="FILE", help="write an SRDF with the computed link pairs")
    check.add_argument("--json", action="store_true")
    check.set_defaults(run=run_check)

    again = commands.add_parser(
        "reproduce", help="compute a paper's tables and figures again, beside the paper's numbers"
    )
    again.add_argument("name", nargs="*", help="p1-table-3.3, ... or all; none: list them")
    again.add_argument("--quick", action="store_true", help="smaller set-ups that show the same in seconds")
    again.add_argument(
        "--json", action="store_true", help="print JSON instead of Markdown: an object for one name, else a list"
    )
    again.add_argument(
        "--out", type=Path, metavar="DIR", help="also write JSON and pictures there, and a page of all of them"
    )
    again.add_argument("--seed", type=_count, default=1, metavar="N", help="of whatever is random (default 1)")
    _add_cluster_options(again)
    again.set_defaults(run=run_reproduce)

    bench = commands.add_parser("bench", help="run published problem sets and look at every answer again")
    bench.add_argument("name", choices=["mbm"], help="mbm: MotionBenchMaker's problems for Panda and UR5")
    bench.add_argument(
        "--data",
        type=Path,
        default=Path("../shared/data"),
        metavar="DIR",
        help="folder with robots/ and planning/ (default ../shared/data)",
    )
    bench.add_argument("--robot", nargs="+", default=["panda", "ur5"], metavar="NAME")
    bench.add_argument("--set", nargs="+", metavar="NAME", help="bookshelf_small, ...; default: all seven")
    bench.add_argument("--limit", type=_at_least_one, default=50, metavar="N", help="problems of each set (default 50)")
    bench.add_argument("--seeds", type=_at_least_one, default=1, metavar="N", help="runs of each problem (default 1)")
    bench.add_argument("--planner", default="rrt_connect", help="a name of planner_names()")
    bench.add_argument("--json", action="store_true")
    bench.set_defaults(run=run_bench)

    view = commands.add_parser("view", help="show a plan in the browser, or draw it")
    view.add_argument("plan", type=Path, help="plan.json")
    view.add_argument("--png", type=Path, metavar="FILE", help="write a picture instead of opening the browser")
    view.add_argument("--port", type=_count, default=8080, metavar="N")
    view.set_defaults(run=run_view)
    return parser


def _add_cluster_options(parser: argparse.ArgumentParser) -> None:
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers", type=_count, metavar="N", help="spread the work over N local processes (0: one a core)"
    )
    where.add_argument("--scheduler", metavar="ADDRESS", help="spread the work over a Dask cluster, tcp://host:port")
    parser.add_argument(
        "--shards", type=Path, metavar="DIR", help="where --workers and --scheduler keep finished shards"
    )


def _count(text: str) -> int:
    try:
        value = int(text)
    except ValueError:
        value = -1
    if not 0 <= value <= 2**31 - 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no whole number >= 0")
    return value


def _at_least_one(text: str) -> int:
    value = _count(text)
    if value == 0:
        raise argparse.ArgumentTypeError("0 is none: must be at least 1")
    return value


def _package(text: str) -> tuple[str, str]:
    name, found, folder = text.partition("=")
    if not found or not name or not folder:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=DIR")
    if not Path(folder).is_dir():
        raise argparse.ArgumentTypeError(f"{folder!r} is no folder")
    return name, folder


def _xacro_argument(text: str) -> tuple[str, str]:
    name, found, value = text.partition("=")
    if not found or not name:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=VALUE")
    return name.removesuffix(":"), value  # xacro's own command writes NAME:=VALUE


# --- commands ---------------------------------------------------------------------------------------------------------
def run_plan(arguments: argparse.Namespace, console: Console) -> int:
    with Reporter(console) as report:
        scenario = load_scenario(
            arguments.scenario, robot=arguments.robot, seed=arguments.seed, threads=arguments.threads, progress=report
        )
        plan = plan_part_supply(scenario, progress=report)
        written = write_outputs(plan, arguments.out, report, pictures=not arguments.no_pictures)
        passing = None
        if arguments.drive_by and plan.outcome == Outcome.solved:
            passing = plan_drive_by_picks(plan, progress=report)
            passing.save(arguments.out)
            if not arguments.no_pictures:
                from .viz.report import write_report

                write_report(passing.plan_to_dict(), arguments.out)
    if plan.outcome != Outcome.solved:
        console.print(f"no plan: {plan.outcome.name}", style="bold red", markup=False)
        for obstruction in plan.obstructions:
            console.print(f"- {obstruction.message}", markup=False, soft_wrap=True)
    else:
        console.print(summary(plan))
    if passing is not None:
        console.print(drive_by_summary(passing))
    console.print(f"report: {written}", markup=False, soft_wrap=True)
    return exit_code(plan.outcome)


def exit_code(outcome: Outcome) -> int:
    return {
        Outcome.solved: DONE,
        Outcome.stopped: INTERRUPTED,
        Outcome.invalid_start: BAD_INPUT,
        Outcome.invalid_goal: BAD_INPUT,
    }.get(outcome, NO_PLAN)


def write_outputs(plan: PartSupplyPlan, out: Path, report: Callable[[str, float], None], pictures: bool) -> Path:
    """Writes everything into the folder and returns the page to look at."""
    report("writing", 0.0)
    path = plan.save(out / "plan.json")
    plan.save_trajectories(out / "trajectories")
    if pictures:
        from .viz.pictures import write_pictures
        from .viz.report import write_report

        content = plan.to_dict()
        report("writing", 0.3)
        write_pictures(content, out)
        report("writing", 0.9)
        path = Path(write_report(content, out) or out / "report.html")
    report("writing", 1.0)
    return path


def summary(plan: PartSupplyPlan) -> Table:
    table = Table(
        title=f"{plan.scenario.name}: {len(plan.stops)} stops (proven least {plan.result.lower_bound}), "
        f"{len(plan.picks)} picks"
    )
    for title in ("stop", "x [m]", "y [m]", "heading [deg]", "free disc [m]", "trays", "picks", "arm time [s]"):
        table.add_column(title, justify="left" if title == "trays" else "right")
    names = [plan.scenario.trays[t].tray.name for t in plan.result.region_trays]
    for i, stop in enumerate(plan.stops):
        picks = [pick for pick in plan.picks if pick.stop == i]
        x, y, theta = stop.pose
        table.add_row(
            str(i + 1),
            f"{x:.2f}",
            f"{y:.2f}",
            f"{theta * 57.29578:.0f}",
            f"{stop.radius:.3f}",
            ", ".join(names[t] for t in stop.trays),
            str(len(picks)),
            f"{sum(p.duration for p in picks):.1f}",
        )
    length = sum(leg.length for leg in plan.route)
    seconds = sum(leg.duration(plan.scenario.setup.robot) for leg in plan.route)
    planning = sum(seconds for _, seconds in plan.timings)
    table.caption = f"drive {length:.2f} m in {seconds:.1f} s, planned in {planning:.1f} s"
    return table


def drive_by_summary(passing: DriveByPlan) -> Table:
    table = Table(title="parts taken in passing")
    for title in ("stop", "part", "stop and pick [s]", "drive-by [s]", ""):
        table.add_column(title, justify="left" if title in ("part", "") else "right")
    for pick in passing.picks:
        now = f"{pick.drive_by:.1f}" if pick.used else "-"
        table.add_row(str(pick.stop + 1), pick.part, f"{pick.stop_and_pick:.1f}", now, pick.why)
    share = 100 * passing.saved / passing.stop_and_pick
    table.caption = f"whole round {passing.stop_and_pick:.1f} s, in passing {passing.drive_by:.1f} s: {passing.saved:.1f} s or {share:.1f} % saved"
    return table


def run_verify(arguments: argparse.Namespace, console: Console) -> int:
    options = {key: value for key in ("samples", "threads") if (value := getattr(arguments, key)) is not None}
    with Reporter(console) as report:
        verdict = verify_plan(
            arguments.plan, scenario=arguments.scenario, robot=arguments.robot, progress=report, **options
        )
    if arguments.json:
        print(json.dumps(verdict.to_dict(), indent=1))
    else:
        _print_verdict(verdict, console)
    return DONE if verdict.ok else FAULTY


def _print_verdict(verdict: PlanVerdict, console: Console) -> None:
    for fault in verdict.faults:
        console.print(f"FAULT {fault.code}: {fault.where}: {fault.message}", markup=False, soft_wrap=True)
    for rate in verdict.rates:
        share = 100 * rate.good / max(rate.samples, 1)
        worst = f" (worst: {rate.worst_part})" if rate.good < rate.samples else ""
        console.print(
            f"stop {rate.stop + 1}: every part graspable from {rate.good} of {rate.samples} base poses, "
            f"{share:.2f} %{worst}",
            markup=False,
        )
    if verdict.ok:
        console.print(
            f"the plan holds: {verdict.configurations_checked} configurations checked, "
            f"{verdict.minimal_stops} stops are the least",
            markup=False,
        )
    else:
        count = len(verdict.faults)
        console.print(f"the plan does not hold: {count} fault{'s' if count > 1 else ''}", markup=False)


def run_check(arguments: argparse.Namespace, console: Console) -> int:
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
    if arguments.write_srdf:
        write_file(arguments.write_srdf, found.srdf())
    print(json.dumps(found.to_dict(), indent=1, default=str) if arguments.json else describe(found))
    return DONE if found.ok else FAULTY


def run_view(arguments: argparse.Namespace, console: Console) -> int:
    content = read_plan(arguments.plan)
    if content.get("outcome") == "solved":
        plan_to_check(read_json(arguments.plan).root)  # says what is wrong with a damaged plan before anything is drawn
    if arguments.png:
        from .viz.viewer import write_png

        write_png(content, arguments.png)
        console.print(str(arguments.png), markup=False)
        return DONE
    from .viz.viewer import view

    try:
        view(content, port=arguments.port)
    except ImportError:
        raise InvalidInput("the browser view needs viser: pip install 'mmgrasp[view]'") from None
    return DONE


def run_bench(arguments: argparse.Namespace, console: Console) -> int:
    from .motion_bench import MBM_SETS
    from .motion_bench_run import holds, run_motion_bench

    with Reporter(console) as report:
        results = run_motion_bench(
            arguments.data,
            arguments.robot,
            arguments.set or MBM_SETS,
            arguments.limit,
            range(1, 1 + arguments.seeds),
            progress=report,
            planner=arguments.planner,
        )
    rows = [result.to_dict() for result in results]
    if arguments.json:
        print(json.dumps({"rows": rows, "holds": holds(results)}))
    else:
        table = Table(
            title="MotionBenchMaker: edges at 5 mm of any link point, paths looked at again by FCL at 0.005 rad"
        )
        for title in ("robot", "set", "solved", "verified", "median [ms]", "p95 [ms]", "call median [ms]"):
            table.add_column(title, justify="left" if title in ("robot", "set") else "right")
        for row in rows:
            times = [f"{row[key]:.2f}" for key in ("median [ms]", "p95 [ms]", "call median [ms]")]
            solved = f"{row['solved']}/{row['runs']}"
            table.add_row(row["robot"], row["set"], solved, f"{row['verified']}/{row['solved']}", *times)
        console.print(table)
        for fault in (fault for row in rows for fault in row["faults"]):
            console.print(f"- {fault}", markup=False, soft_wrap=True)
    return DONE if holds(results) else FAULTY


def run_reproduce(arguments: argparse.Namespace, console: Console) -> int:
    from . import reproduce as again
    from .reproduce.page import markdown, store

    if not arguments.name:
        for entry in again.ENTRIES.values():
            print(f"{entry.name:<24}{entry.title}")
        return DONE
    names = [e for name in arguments.name for e in (again.ENTRIES if name == "all" else [again.entry(name).name])]
    results = []
    with Reporter(console) as report, _sweep(arguments) as sweep:
        for name in dict.fromkeys(names):
            result = again.reproduce(name, quick=arguments.quick, seed=arguments.seed, progress=report, sweep=sweep)
            results.append(result)
            if arguments.out:
                store(result, arguments.out)
            if not arguments.json:
                print(markdown(result), flush=True)
    if arguments.json:
        print(json.dumps(results[0] if len(results) == 1 else results, allow_nan=False))
    return DONE if all(c["holds"] for result in results for c in result["checks"] if c["kind"] == "E") else FAULTY


@contextlib.contextmanager
def _sweep(arguments: argparse.Namespace) -> Iterator[Callable]:
    """Calls here, or on the cluster that the arguments ask for."""
    if arguments.workers is None and arguments.scheduler is None:
        from .reproduce import sweep_here

        yield sweep_here
        return
    from . import cluster

    with cluster.connect(workers=arguments.workers, scheduler=arguments.scheduler, folder=arguments.shards) as engine:
        yield engine.run


def main(arguments: Sequence[str] | None = None) -> int:
    parsed = build_parser().parse_args(arguments)
    console = Console(highlight=False)
    try:
        return parsed.run(parsed, console)
    except (Error, OSError) as error:
        print(f"mmgrasp: {error}", file=sys.stderr)
        return BAD_INPUT
    except MemoryError:
        print("mmgrasp: out of memory: use a coarser grid, fewer samples or fewer parts", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("mmgrasp: interrupted", file=sys.stderr)
        return INTERRUPTED


if __name__ == "__main__":
    sys.exit(main())
