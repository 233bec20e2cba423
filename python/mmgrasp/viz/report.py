"""The report of a plan: one self-contained page that a person likes to read."""

from __future__ import annotations

import base64
import itertools
import math
from collections.abc import Collection, Sequence
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from .._files import write_file
from .._shares import share_interval
from ..part_supply.drives import all_drives, carried_in_hand
from ..part_supply.premises import premises, premises_text
from .style import tray_colour
from .timeline import Timeline
from .topview import TOPVIEW_CSS, TopView

CAUSES = [
    ("unreachable", "out of reach"),
    ("limits", "joint limits"),
    ("self_collision", "robot hits itself"),
    ("scene", "robot hits the scene"),
    ("grasp_filter", "hand hits something"),
]

CSS = """
:root { --paper: #ffffff; --page: #f4f3ef; --ink: #22262b; --faint: #737b84; --line: #e4e2dc; --accent: #0072B2; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #1d2126; --page: #15181c; --ink: #e8eaed; --faint: #98a1ab; --line: #31373e; --accent: #56B4E9; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, "Segoe UI", sans-serif; }
main { max-width: 1080px; margin: 0 auto; padding: 32px 24px 64px; }
h1 { font-size: 30px; line-height: 1.2; margin: 0 0 4px; }
h2 { font-size: 20px; margin: 40px 0 10px; }
.lead { color: var(--faint); margin: 0 0 22px; }
.cards { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 12px; margin: 20px 0; }
.card { background: var(--paper); border-radius: 8px; padding: 14px 16px; }
.card b { display: block; font-size: 26px; line-height: 1.2; }
.card span { color: var(--faint); font-size: 14px; }
table { border-collapse: collapse; width: 100%; background: var(--paper); border-radius: 8px; overflow: hidden; }
th, td { text-align: left; padding: 7px 12px; border-bottom: 1px solid var(--line); font-size: 14.5px; }
th { color: var(--faint); font-weight: 600; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
tr:last-child td { border-bottom: 0; }
.scroll { overflow-x: auto; }
.dot { display: inline-block; width: 11px; height: 11px; border-radius: 50%; margin-right: 7px; }
.bad { background: #C1121F14; border-left: 5px solid #C1121F; padding: 14px 18px; border-radius: 6px; margin: 14px 0; }
.bar { background: var(--accent); height: 11px; border-radius: 3px; min-width: 2px; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(320px, 1fr)); gap: 14px; }
figure { margin: 0; background: var(--paper); border-radius: 8px; overflow: hidden; }
figure img { width: 100%; display: block; }
figcaption { padding: 8px 12px; color: var(--faint); font-size: 14px; }
details { background: var(--paper); border-radius: 8px; padding: 10px 14px; margin: 10px 0; }
summary { cursor: pointer; font-weight: 600; }
@media print { body { background: #fff; } main { max-width: none; padding: 0; } h2 { break-after: avoid; } }
"""


def write_report(plan: dict[str, Any], out_dir: str | Path) -> Path:
    """Writes report.html beside the pictures (those already in `out_dir` are embedded). Returns its path."""
    path = Path(out_dir) / "report.html"
    write_file(path, report_html(plan, Path(out_dir)))
    return path


def report_html(
    plan: dict[str, Any], pictures_dir: Path | None = None, timings: Sequence[tuple[str, float]] = ()
) -> str:
    """The page as text; `timings`: stages of planning and how long each took [s]."""
    name = plan["scenario"].get("name", "plan")
    sections = [_headline(plan), _obstructions(plan), _top_view(plan)]
    if plan["outcome"] == "solved":
        sections += [_stops(plan), _picks(plan), _in_passing(plan)]
    sections += [_alternatives(plan), _candidates(plan), _pictures(plan, pictures_dir), _timings(timings), _facts(plan)]
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{escape(name)} - mmgrasp plan</title><style>{CSS}{TOPVIEW_CSS}</style></head><body><main>"
        + "".join(sections)
        + "</main></body></html>\n"
    )


def plural(count: int, word: str) -> str:
    """'1 stop', '2 stops'."""
    return f"{count} {word}{'' if count == 1 else 's'}"


def clock(seconds: float) -> str:
    """'12.3 s' or '3 min 05 s'."""
    if seconds < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02d} s"


def headline(plan: dict[str, Any]) -> str:
    """The plan in one sentence."""
    trays = plural(len(plan["regions"]), "tray")
    if plan["outcome"] != "solved":
        return f"No plan for {trays}: {plan['outcome'].replace('_', ' ')}"
    serve = "serves" if len(plan["stops"]) == 1 else "serve"
    duration = clock(Timeline(plan).duration)
    return f"{plural(len(plan['stops']), 'stop')} {serve} {trays}: {plural(len(plan['picks']), 'part')} in {duration}"


def table(head: list[str], rows: list[list[str]], numeric: Collection[int] = ()) -> str:
    """An HTML table; cells are HTML already."""

    def row(cells: list[str], tag: str) -> str:
        marks = (' class="n"' if i in numeric else "" for i in range(len(cells)))
        return "<tr>" + "".join(f"<{tag}{m}>{c}</{tag}>" for m, c in zip(marks, cells, strict=True)) + "</tr>"

    body = "".join(row(r, "td") for r in rows)
    return f'<div class="scroll"><table><thead>{row(head, "th")}</thead><tbody>{body}</tbody></table></div>'


def _tray(plan: dict[str, Any], name: str) -> str:
    names = [tray["name"] for tray in plan["scenario"]["trays"]]
    return f'<span class="dot" style="background:{tray_colour(names.index(name))}"></span>{escape(name)}'


def _headline(plan: dict[str, Any]) -> str:
    scenario = plan["scenario"]
    driven = sum(leg["length"] for leg in all_drives(plan))
    cards = []
    if plan["outcome"] == "solved":
        drive = sum(leg["duration"] for leg in all_drives(plan))
        radius = min(stop["radius"] for stop in plan["stops"])
        cards = [
            (str(len(plan["stops"])), f"stops; fewer than {plan['lower_bound']} is proven impossible"),
            (str(len(plan["picks"])), "parts picked"),
            (f"{driven:.1f} m", f"driven in {clock(drive)}"),
            *([(str(len(plan["unloadings"]) + 1), _trips(plan))] if "unloadings" in plan else []),
            (f"{radius:.2f} m", f"smallest disc; {scenario['positioning_uncertainty']:.2f} m asked for"),
            (
                f"{100 * plan['robustness_rate']:.1f} %",
                "of the base poses sampled at a stop, at least, reach every part",
            ),
        ]
    tiles = "".join(f'<div class="card"><b>{escape(a)}</b><span>{escape(b)}</span></div>' for a, b in cards)
    source = escape(scenario.get("name", ""))
    proof = ""
    if plan["outcome"] == "solved" and plan["proven_minimal"]:
        proof = f"<p class='lead'>The number of stops is proven {escape(premises_text(premises(plan)))}.</p>"
    return (
        f"<h1>{escape(headline(plan))}</h1><p class='lead'>Scenario {source}, planned by mmgrasp "
        f"{escape(plan['mmgrasp'])}</p><div class='cards'>{tiles}</div>{proof}"
    )


def _trips(plan: dict[str, Any]) -> str:
    ends = [*(unloading["after_pick"] + 1 for unloading in plan["unloadings"]), len(plan["picks"])]
    loads = [str(b - a) for a, b in itertools.pairwise([0, *ends])]
    if carried_in_hand(plan):
        return "trips, each with one part in the hand"
    return f"trips, of {', '.join(loads[:-1])} and {loads[-1]} parts; the bin takes {plan['scenario']['place_region']['capacity']}"


def _obstructions(plan: dict[str, Any]) -> str:
    items = []
    for item in plan["obstructions"]:
        where = f"Tray {item['tray']}" if item["tray"] else "The round"
        if item["part"]:
            where += f", part {item['part']}"
        advice = ""
        if item["largest_uncertainty"] >= 0 and item["stage"] == "robustness":
            largest = f"{item['largest_uncertainty']:.5f}".removesuffix("00")  # advised in steps of 1e-5 m
            advice = f" The largest positioning uncertainty that works is {largest} m."
        if item["reach_deficit"] > 0:
            advice += f" The reach falls short by {item['reach_deficit']:.3f} m."
        items.append(f'<div class="bad"><b>{escape(where)}</b>: {escape(item["message"])}{escape(advice)}</div>')
    return "<h2>What stands in the way</h2>" + "".join(items) if items else ""


def _top_view(plan: dict[str, Any]) -> str:
    note = (
        "Coloured cells: the base can stand anywhere in them and reach every part of that tray. Outlined: cells that the trays of a stop share. Red disc: room around the "
        "stop; dotted: the positioning uncertainty. Rest the pointer on anything for its name."
    )
    return f"<h2>From above</h2>{TopView(plan).svg()}<p class='lead'>{note}</p>"


def _stops(plan: dict[str, Any]) -> str:
    rows = []
    arrivals = "arrival_covariance" in plan["scenario"]
    for number, stop in enumerate(plan["stops"], start=1):
        picks = [p for p in plan["picks"] if p["stop"] == number - 1]
        seconds = sum(m["times"][-1] for p in picks for m in p["motions"])
        leg = plan["route"][number - 1]
        rows.append(
            [
                str(number),
                " ".join(_tray(plan, t) for t in stop["trays"]),
                f"{stop['pose'][0]:.3f}, {stop['pose'][1]:.3f}, {stop['pose'][2]:.3f}",
                f"{stop['radius']:.3f}",
                *([_share(stop["arrivals"])] if arrivals else []),
                f"{leg['length']:.2f}",
                clock(leg["duration"]),
                str(len(picks)),
                clock(seconds),
            ]
        )
    head = ["stop", "trays", "base x, y, heading [m, m, rad]", "disc [m]", "drive [m]", "drive", "picks", "arm time"]
    if not arrivals:
        return "<h2>Stops</h2>" + table(head, rows, {3, 4, 5, 6, 7})
    head.insert(4, "arrivals that serve all (95 %)")
    deviations = np.sqrt(np.diag(plan["scenario"]["arrival_covariance"]))
    note = (
        f"Arrivals are drawn about each stop with standard deviations of {deviations[0]:.3f} m and {deviations[1]:.3f} m along x and y and "
        f"{np.degrees(deviations[2]):.1f}°; in brackets the interval that the share lies in at 95 % confidence. All stops serve all their parts in "
        f"{100 * np.prod([stop['arrivals']['served'] / stop['arrivals']['drawn'] for stop in plan['stops']]):.1f} % of the rounds; "
        "<code>mmgrasp arrive</code> plans anew from where the base really stands."
    )
    return f"<h2>Stops</h2><p class='lead'>{note}</p>" + table(head, rows, {3, 4, 5, 6, 7, 8})


def _share(seen: dict[str, int]) -> str:
    """A share and its 95 % interval."""
    low, high = share_interval(seen["served"], seen["drawn"])
    return f"{100 * seen['served'] / seen['drawn']:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def _picks(plan: dict[str, Any]) -> str:
    kinds = ["transit", "approach", "lift", *(["stow"] if carried_in_hand(plan) else []), "transfer", "retreat"]
    parts = {part["name"]: part for part in plan["scenario"]["parts"]}
    scanned = "scans" in plan["scenario"]
    rows = []
    for number, pick in enumerate(plan["picks"], start=1):
        times = {m["kind"]: m["times"][-1] for m in pick["motions"]}
        sure = parts[pick["part"]]["grasps"][pick["grasp"]].get("probability")
        rows.append(
            [str(number), str(pick["stop"] + 1), _tray(plan, pick["tray"]), escape(pick["part"]), str(pick["grasp"])]
            + ([] if not scanned else ["" if sure is None else f"{sure:.2f}"])
            + [f"{times.get(kind, 0):.2f}" for kind in kinds]
            + [f"{sum(times.values()):.2f}"]
        )
    head = ["pick", "stop", "tray", "part", "grasp", *(f"{k} [s]" for k in kinds), "all [s]"]
    if scanned:
        head.insert(5, "probability")
    return "<h2>Picks</h2>" + table(head, rows, {0, 1, *range(4, len(head))})


def _in_passing(plan: dict[str, Any]) -> str:
    if "drive_by" not in plan:
        return ""
    speed = plan["scenario"]["gripper"]["closing_speed"]
    rows = []
    for motion in plan["drive_by"]["motions"]:
        pick = plan["picks"][motion["pick"]]
        part = next(p for p in plan["scenario"]["parts"] if p["name"] == pick["part"])
        closing = (motion["opening"] - part["grasps"][pick["grasp"]]["opening"]) / speed
        kinds = ["transit", "approach", "lift"] + (["transfer"] if motion.get("ends") == "release" else [])
        stopping = sum(m["times"][-1] for m in pick["motions"] if m["kind"] in kinds) + closing
        before = plan["picks"][motion["pick"] - 1] if motion.get("begins") == "release" else None
        if before is not None:
            stopping += before["motions"][-1]["times"][-1]
        if before is None or before["stop"] != pick["stop"]:
            stopping += plan["route"][pick["stop"]]["duration"]
        now = motion["times"][-1]
        cells = [str(pick["stop"] + 1), _tray(plan, pick["tray"]), escape(pick["part"])]
        rows.append([*cells, clock(stopping), clock(now), clock(stopping - now)])
    note = (
        "Each pick as one motion from where the part before is let go, with the drive to the stop where it is the first one there: base and arm "
        "do not stop for the part, and the arm does not come home."
    )
    head = ["stop", "tray", "part", "stop and pick", "in passing", "saved"]
    body = table(head, rows, {0, 3, 4, 5}) if rows else "<p>None was found to be faster.</p>"
    return f"<h2>Parts taken in passing</h2><p class='lead'>{note}</p>" + body


def _alternatives(plan: dict[str, Any]) -> str:
    chosen = {stop["intersection"] for stop in plan["stops"]}
    used = [set(stop["trays"]) for stop in plan["stops"]]
    rows = []
    bound = plan["scenario"]["positioning_uncertainty"]
    for index, item in enumerate(plan["intersections"]):
        trays = set(item["trays"])
        if index in chosen:
            verdict = "<b>chosen</b>"
        elif any(trays <= other for other in used):
            verdict = "the same trays are served by a chosen stop"
        else:
            verdict = f"would not lead to fewer than {plan['lower_bound']} stops"
        rows.append((item, verdict))
    for item in plan["too_small_intersections"]:
        rows.append((item, f"its disc of {item['radius']:.7g} m is smaller than the uncertainty of {bound:.7g} m"))
    rows.sort(key=lambda r: (-len(r[0]["trays"]), -r[0]["radius"]))
    shown = [
        [" ".join(_tray(plan, t) for t in i["trays"]), f"{i['radius']:.3f}", str(i["cells"]), verdict]
        for i, verdict in rows[:60]
    ]
    if not shown:
        return ""
    more = f"<p class='lead'>{len(rows) - 60} more are in plan.json.</p>" if len(rows) > 60 else ""
    return (
        "<h2>Alternatives, and why each lost</h2>"
        + table(["trays shared", "disc [m]", "cells", "verdict"], shown, {1, 2})
        + more
    )


def _candidates(plan: dict[str, Any]) -> str:
    blocks = []
    for region in plan["regions"]:
        cells = sum(end - start for runs in region["cells"].values() for _, start, end in runs)
        rows = []
        for item in region["explanations"]:
            counts = [f"{item['rejections'].get(key, 0):,}" for key, _ in CAUSES]
            feasible = f"{item['base_poses_feasible']:,} of {item['base_poses_tried']:,}"
            rows.append([escape(item["part"]), str(item["grasps"]), feasible, *counts])
        head = ["part", "grasps", "base poses that work", *(word for _, word in CAUSES)]
        open_mark = " open" if plan["outcome"] != "solved" and cells == 0 else ""
        blocks.append(
            f"<details{open_mark}><summary>{_tray(plan, region['tray'])}: base region of {cells} cells</summary>"
            + table(head, rows, {1, 2, 3, 4, 5, 6, 7})
            + "</details>"
        )
    note = "Grasp and base pose taken together, counted by what turned them down."
    return f"<h2>Candidates, tray by tray</h2><p class='lead'>{note}</p>" + "".join(blocks)


def _pictures(plan: dict[str, Any], pictures_dir: Path | None) -> str:
    if pictures_dir is None:
        return ""
    figures = []
    captions = {"regions.png": "Base region of each tray", "pick_1_joints.png": "Joints during the first pick"}
    for path in sorted(pictures_dir.glob("stop_*.png")) + [pictures_dir / name for name in captions]:
        if path.exists():
            data = base64.b64encode(path.read_bytes()).decode()
            caption = captions.get(path.name, f"At stop {path.stem.removeprefix('stop_')}, first grasp")
            figures.append(
                f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{data}">'
                f"<figcaption>{escape(caption)}</figcaption></figure>"
            )
    return "<h2>Pictures</h2><div class='pictures'>" + "".join(figures) + "</div>" if figures else ""


def _timings(timings: Sequence[tuple[str, float]]) -> str:
    longest = max((seconds for _, seconds in timings), default=0) or 1
    rows = [
        [
            escape(stage),
            f"{seconds:.2f}",
            f'<div class="bar" style="width:{100 * seconds / longest:.1f}%"></div>',
        ]
        for stage, seconds in timings
    ]
    return "<h2>Time spent planning</h2>" + table(["stage", "seconds", ""], rows, {1}) if rows else ""


def _hand(gripper: dict[str, Any]) -> list[str]:
    if "suction" not in gripper:
        return ["gripper opening", f"{gripper['max_opening']:.3f} m"]
    cups, vacuum = gripper["suction"]["cups"], gripper["suction"]["vacuum"]
    force = sum(vacuum * math.pi * cup["radius"] ** 2 for cup in cups)
    return ["suction cups", f"{len(cups)}, {force:.1f} N together"]


def _facts(plan: dict[str, Any]) -> str:
    scenario = plan["scenario"]
    gripper = scenario["gripper"]
    rows = [
        ["base", escape(scenario["robot"]["base"])],
        ["arm joints", escape(", ".join(scenario["arm"]["joints"]))],
        _hand(gripper),
        ["positioning uncertainty", f"{scenario['positioning_uncertainty']:.3f} m"],
        *([["drives keep", f"{scenario['drive_clearance']:.3f} m"]] if "drive_clearance" in scenario else []),
        ["grid", f"{plan['grid']['nx']} x {plan['grid']['ny']} cells of {plan['grid']['resolution']:.3f} m"],
        ["obstacles, parts", f"{len(scenario['obstacles'])}, {len(scenario['parts'])}"],
    ]
    return "<h2>Set-up</h2>" + table(["", ""], rows)
