"""What the command `mmgrasp` prints of its answers."""

from __future__ import annotations

from collections.abc import Sized
from typing import Any

from rich.console import Console
from rich.markup import escape
from rich.table import Table

from .._files import printable
from .._shares import share_interval
from ..part_supply import DriveByPlan, PlanVerdict, ScenarioPlan
from ..part_supply.premises import premises_text


def count(items: Sized, word: str) -> str:
    """ "1 stop", "2 stops"."""
    return f"{len(items)} {word}{'s' if len(items) != 1 else ''}"


def summary(plan: ScenarioPlan) -> Table:
    """Stops of a plan."""
    table = Table(
        title=f"{escape(plan.scenario.name)}: {count(plan.stops, 'stop')} (proven least {plan.plan.lower_bound}), "
        f"{count(plan.picks, 'pick')}"
    )
    known = any(stop.arrivals for stop in plan.stops)
    sure = ("all parts from",) if known else ()
    for title in ("stop", "x [m]", "y [m]", "heading [deg]", "free disc [m]", *sure, "trays", "picks", "arm time [s]"):
        table.add_column(title, justify="left" if title == "trays" else "right")
    names = [plan.scenario.trays[t].tray.name for t in plan.plan.region_trays]
    for i, stop in enumerate(plan.stops):
        picks = [pick for pick in plan.picks if pick.stop == i]
        x, y, theta = stop.pose
        table.add_row(
            str(i + 1),
            f"{x:.2f}",
            f"{y:.2f}",
            f"{theta * 57.29578:.0f}",
            f"{stop.radius:.3f}",
            *([f"{100 * stop.arrivals_served / stop.arrivals:.1f} % of arrivals"] if known else []),
            escape(", ".join(names[t] for t in stop.trays)),
            str(len(picks)),
            f"{sum(p.duration for p in picks):.1f}",
        )
    drives = [*plan.route, *(leg for u in plan.plan.unloadings for leg in (u.to_goal, u.back) if leg is not None)]
    length = sum(leg.length for leg in drives)
    seconds = sum(leg.duration(plan.scenario.setup.robot) for leg in drives)
    planning = sum(seconds for _, seconds in plan.timings)
    table.caption = f"drive {length:.2f} m in {seconds:.1f} s, planned in {planning:.1f} s{_probabilities(plan)}"
    if plan.plan.unloadings:
        place = plan.scenario.setup.place_region
        load = "the hand carries one part" if place is None else f"the bin takes {place.capacity}"
        table.caption += f"\n{len(plan.plan.unloadings) + 1} trips: {load} at a time"
    table.caption += f"\nno fewer stops {premises_text(plan.premises)}" if plan.plan.proven_minimal else ""
    return table


def _probabilities(plan: ScenarioPlan) -> str:
    """Probabilities of the grasps that were found in a scan."""
    trays = plan.scenario.trays
    found = [trays[p.tray].tray.parts[p.part].grasps[p.grasp].quality for p in plan.picks if trays[p.tray].scan]
    return (
        f"; modelled probability of the grasps of scanned parts {min(found):.2f} to {max(found):.2f}" if found else ""
    )


def drive_by_summary(passing: DriveByPlan) -> Table:
    """Parts taken in passing, and what that saves."""
    table = Table(title="parts taken in passing")
    for title in ("stop", "part", "stop and pick [s]", "drive-by [s]", ""):
        table.add_column(title, justify="left" if title in ("part", "") else "right")
    for pick in passing.picks:
        now = f"{pick.drive_by:.1f}" if pick.used else "-"
        table.add_row(str(pick.stop + 1), escape(pick.part), f"{pick.stop_and_pick:.1f}", now, escape(pick.why))
    share = 100 * passing.saved / passing.stop_and_pick
    table.caption = f"whole round {passing.stop_and_pick:.1f} s, in passing {passing.drive_by:.1f} s: {passing.saved:.1f} s or {share:.1f} % saved"
    return table


def print_verdict(verdict: PlanVerdict, console: Console) -> None:
    """Faults, rates of success, and whether the plan holds."""
    for fault in verdict.faults:
        console.print(printable(f"FAULT {fault.code}: {fault.where}: {fault.message}"), markup=False, soft_wrap=True)
    for rate in verdict.rates:
        low, high = share_interval(rate.good, rate.samples)
        worst = f" (worst: {rate.worst_part})" if rate.good < rate.samples else ""
        console.print(
            f"stop {rate.stop + 1}: every part graspable from {rate.good} of {rate.samples} base poses, "
            f"{100 * rate.good / max(rate.samples, 1):.2f} % (95 %: {100 * low:.2f} to {100 * high:.2f}){worst}",
            markup=False,
        )
    if verdict.allowed_collisions:
        pairs = ", ".join(f"{a} and {b}" for a, b in verdict.allowed_collisions)
        console.print(f"not checked, since the scenario lets them touch: {pairs}", markup=False, soft_wrap=True)
    if verdict.ok:
        console.print(
            f"the plan holds: {verdict.configurations_checked} configurations checked, "
            f"{_least(verdict)}{_compared(verdict)}",
            markup=False,
            soft_wrap=True,
        )
    else:
        count = len(verdict.faults)
        console.print(
            f"the plan does not hold: {count} fault{'s' if count > 1 else ''}{_compared(verdict)}",
            markup=False,
            soft_wrap=True,
        )


def _least(verdict: PlanVerdict) -> str:
    """What the check proved about the number of stops by its own means."""
    if verdict.minimal_stops == 1:
        return "1 stop is the least"
    whole = "" if verdict.regions_searched else " for its regions as they stand (nothing was looked for that they lack)"
    if verdict.lower_bound == verdict.minimal_stops:
        return f"{verdict.minimal_stops} stops are the least{whole}"
    cut = ", since the search for shared regions was cut" if verdict.search_cut else ""
    return f"whether {verdict.minimal_stops} stops are the least was not decided (at least {verdict.lower_bound}){cut}{whole}"


def _compared(verdict: PlanVerdict) -> str:
    stored = verdict.compared_with == PlanVerdict([]).compared_with
    return f"; checked against {printable(verdict.compared_with)}" + (" (not compared with a file)" if stored else "")


def bench_table(rows: list[dict[str, Any]]) -> Table:
    """The problem sets of `mmgrasp bench mbm`."""
    table = Table(title="MotionBenchMaker: edges at 5 mm of any link point, paths checked again by FCL at 0.005 rad")
    for title in ("robot", "set", "solved", "verified", "median [ms]", "p95 [ms]", "call median [ms]"):
        table.add_column(title, justify="left" if title in ("robot", "set") else "right")
    for row in rows:
        times = [f"{row[key]:.2f}" for key in ("median [ms]", "p95 [ms]", "call median [ms]")]
        solved = f"{row['solved']}/{row['runs']}"
        table.add_row(row["robot"], row["set"], solved, f"{row['verified']}/{row['solved']}", *times)
    return table
