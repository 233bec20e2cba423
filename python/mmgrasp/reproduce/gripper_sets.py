"""P1 5.3.4 and figure 5.13: the least set of grippers for the thirteen parts, and how it grows with strokes and parts."""

from __future__ import annotations

import itertools
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import GripperActuator, SegmentRequirement, minimal_grippers
from .drawing import figure
from .entry import Context, Entry, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SCALE = 0.55
"""P1 5.4: the product was printed at this scale, and figure 5.13's lengths go with it."""

SEGMENTS: dict[str, tuple[tuple[int, float, float], ...]] = {
    "1": ((3, 227, 0),),
    "2": ((3, 227, 0),),
    "3": ((3, 110, 0),),
    "4": ((3, 25, 0),),
    "5": ((3, 32, 0), (3, 40, 41)),
    "6": ((3, 18, 0),),
    "7": tuple((2, width, 0.0) for width in (16.7, 19.1, 17.2, 15.9, 16.5, 15.8, 16.9, 18.5)),
    "8": ((2, 60, 0), (3, 40, 50)),
    "9": ((3, 32, 0), (3, 40, 41)),
    "10": ((2, 17, 4.5),),
    "11": ((3, 20, 0),),
    "12": ((2, 15, 0), (2, 32.8, 0)),
    "13": ((3, 37.5, 22.7),),
}
"""Figure 5.13: fingers, opening and least finger length [mm] of each part's graspable segments, in the order of assembly."""

ACTUATORS = [GripperActuator("SMC MHF2-12D2", 0.048), GripperActuator("SMC MHSL3-32D", 0.008, fingers=3)]
PAPER = ((2, 0.0, 33.0, 30.0), (3, 14.0, 22.0, 30.0), (3, 52.5, 60.5, 30.0), (3, 116.9, 124.9, 30.0))
"""P1 5.4: fingers, least and largest opening, finger length [mm]."""


def requirements(scale: float = SCALE) -> list[SegmentRequirement]:
    return [
        SegmentRequirement(
            part, width * scale * 1e-3, segment=str(i + 1), fingers=f, min_finger_length=least * scale * 1e-3
        )
        for part, segments in SEGMENTS.items()
        for i, (f, width, least) in enumerate(segments)
    ]


def taken_by_paper(printed: bool) -> dict[str, str]:
    """The number of the paper's gripper that takes each part, by (5.2) as printed or with <=; a dash for none."""
    out = {}
    for part, segments in SEGMENTS.items():
        out[part] = "-"
        for (i, (f, low, high, length)), (fingers, width, least) in itertools.product(enumerate(PAPER, 1), segments):
            w, least_length = round(width * SCALE, 9), round(least * SCALE, 9)
            inside = (
                low < w < high and least_length < length if printed else low <= w <= high and least_length <= length
            )
            if f == fingers and inside and out[part] == "-":
                out[part] = str(i)
    return out


def figure_5_13(context: Context) -> Result:
    required = requirements()
    found = minimal_grippers(required, ACTUATORS)
    grid = minimal_grippers(required, ACTUATORS, grid=(100, 3))
    printed, closed = taken_by_paper(True), taken_by_paper(False)
    result = Result(
        setup={
            "scale": SCALE,
            "strokes [mm]": [48, 8],
            "paper's grippers": [
                f"{f} fingers, {low:g} to {high:g} mm, {long:g} mm long" for f, low, high, long in PAPER
            ],
            "our grippers": [
                f"{g.fingers} fingers, {1e3 * g.min_opening:.2f} to {1e3 * g.max_opening:.2f} mm, "
                f"at least {1e3 * g.finger_length:.2f} mm long"
                for g in found.grippers
            ],
            "outcome": str(found.outcome).rpartition(".")[2],
        }
    )
    for i, part in enumerate(found.parts):
        values = result.row({"part": part})
        requirement = required[found.requirement_of_part[i]]
        values["gripper, (5.2) with <="] = (closed[part], str(found.gripper_of_part[i] + 1))
        values["gripper, (5.2) as printed"] = (printed[part], None)
        values["held by opening [mm]"] = (None, round(1e3 * requirement.opening, 3))
    values = result.row({"part": "all"})
    values["grippers"] = (4, len(found.grippers))
    values["proven least"] = (None, found.lower_bound)
    values["grippers, P1's grid of 100 x 3"] = (None, len(grid.grippers))
    values["changes of the gripper"] = (None, found.changes)
    left = [part for part, gripper in closed.items() if gripper == "-"]
    result.exact("the paper's four grippers leave parts 4, 6 and 11, and no others", left == ["4", "6", "11"])
    result.exact("five grippers take all parts, proven least", found.lower_bound == len(found.grippers) == 5)
    result.trend("P1's grid of 100 x 3 needs as many", len(grid.grippers) == 5)
    result.notes.append(
        f"At {SCALE:.0%} the paper's grippers leave parts {', '.join(left)}: they need "
        + ", ".join(f"{SCALE * SEGMENTS[part][0][1]:g}" for part in left)
        + " mm, outside of [14, 22]; what the paper says of four grippers does not follow from its table."
    )
    lost = [part for part, gripper in printed.items() if gripper == "-" and part not in left]
    result.notes.append(
        f"By (5.2) as printed (<) they also leave {', '.join(lost)}, which are exactly as wide as a gripper opens; with <= they do not."
    )
    result.drawing = {
        "grippers": [[g.fingers, g.min_opening, g.max_opening, g.finger_length] for g in found.grippers],
        "segments": [[r.part, r.fingers, r.opening, r.min_finger_length] for r in required],
    }
    return result


def draw_figure_5_13(result: dict[str, Any]) -> Figure:
    fig, axes = figure(9.0, 3.4, columns=2)
    for axis, fingers in zip(axes, (2, 3), strict=True):
        for i, (f, low, high, _) in enumerate(result["drawing"]["grippers"]):
            if f == fingers:
                axis.axvspan(max(1e3 * low, 6), 1e3 * high, alpha=0.2, color=f"C{i}")
                axis.annotate(
                    f"{i + 1}",
                    (1e3 * max(low, 0.006) ** 0.5 * high**0.5, 1),
                    xycoords=("data", "axes fraction"),
                    ha="center",
                    va="bottom",
                )
        names: dict[tuple[float, float], list[str]] = {}
        for part, _, opening, length in (s for s in result["drawing"]["segments"] if s[1] == fingers):
            names.setdefault((1e3 * opening, 1e3 * length), []).append(part)
        axis.plot(*zip(*names, strict=True), "k.")
        for i, (place, parts) in enumerate(sorted(names.items())):
            text = ", ".join(dict.fromkeys(parts))
            offset = (0, 6 + 9 * (i % 3) if place[1] == 0 else 4)  # neighbours' names one above the other
            axis.annotate(text, place, textcoords="offset points", xytext=offset, fontsize=7, ha="center")
        axis.set_xscale("log")
        axis.set_xticks([t for t in (5, 10, 20, 50, 100) if fingers == 3 or t <= 50], minor=False)
        axis.xaxis.set_major_formatter("{x:g}")
        axis.xaxis.set_minor_formatter("")
        axis.set(xlabel=f"opening [mm], {fingers} fingers", ylabel="least finger length [mm]")
    return fig


def random_assembly(parts: int, seed: int) -> list[SegmentRequirement]:
    """One to four segments a part, 5 to 200 mm wide (evenly in the logarithm), jaws or centric; one in four needs long fingers."""
    rng = np.random.default_rng([parts, seed])
    out = []
    for part in range(parts):
        for segment in range(int(rng.integers(1, 5))):
            width = float(np.round(np.exp(rng.uniform(np.log(0.005), np.log(0.2))), 4))
            least = float(np.round(rng.uniform(0.01, 0.06), 4)) if rng.random() < 0.25 else 0.0
            out.append(
                SegmentRequirement(
                    str(part), width, segment=str(segment), fingers=int(rng.integers(2, 4)), min_finger_length=least
                )
            )
    return out


TRIES = 100_000  # grippers put into sets, one after the other
LONG_FINGER = 0.1  # [m]


def takers(required: list[SegmentRequirement], strokes: dict[int, float]) -> list[int]:
    """What each gripper takes that ends at a segment and has long fingers, a bit a part; none that takes only what another does."""
    number = {part: i for i, part in enumerate(dict.fromkeys(r.part for r in required))}
    segments = [(r.fingers, r.opening, r.min_finger_length, 1 << number[r.part]) for r in required]
    masks = set()
    for fingers, end, _, _ in segments:
        low = max(0.0, end - strokes[fingers])
        mask = 0
        for f, opening, least, part in segments:
            if f == fingers and low - 1e-9 <= opening <= low + strokes[f] + 1e-9 and least <= LONG_FINGER:
                mask |= part
        masks.add(mask)
    return sorted(m for m in masks if not any(m != other and m & other == m for other in masks))


def every_set(masks: list[int], parts: int, most: int, tries: int = TRIES) -> int | None:
    """Least number of grippers, up to `most`, by trying all sets: each gripper that takes the first part left, then each that takes the next.

    None when that asks for more than `tries`, `most` + 1 when no set is small enough.
    """
    by_part = [[m for m in masks if m >> part & 1] for part in range(parts)]
    left = tries

    def covers(rest: int, size: int) -> bool:
        nonlocal left
        if rest == 0:
            return True
        if size == 0 or left <= 0:
            return False
        for mask in by_part[(rest & -rest).bit_length() - 1]:
            left -= 1
            if covers(rest & ~mask, size - 1):
                return True
        return False

    for size in range(1, most + 1):
        if covers((1 << parts) - 1, size):
            return size
        if left <= 0:
            return None
    return most + 1


def growth(context: Context) -> Result:
    sizes = (10, 20) if context.quick else (10, 20, 50, 100, 200)
    strokes = (0.008, 0.024, 0.048)
    assemblies = 3 if context.quick else 20
    result = Result(setup={"assemblies": assemblies, "segments a part": "1 to 4", "widths [mm]": [5, 200]})
    means: dict[tuple[int, float], float] = {}
    tried: dict[tuple[int, float], int] = {}
    agreed: dict[tuple[int, float], int] = {}
    for size, stroke in itertools.product(sizes, strokes):
        drives = [GripperActuator("jaws", stroke), GripperActuator("centric", stroke, fingers=3)]
        counts, proven, changes, seconds = [], 0, [], []
        for seed in range(assemblies):
            if context.progress is not None:
                context.progress(f"{size} parts, stroke {1e3 * stroke:g} mm", seed / assemblies)
            required = random_assembly(size, seed)
            begin = time.perf_counter()
            found = minimal_grippers(required, drives)
            seconds.append(time.perf_counter() - begin)
            counts.append(len(found.grippers))
            proven += found.lower_bound == len(found.grippers)
            changes.append(found.changes)
            least = every_set(takers(required, {2: stroke, 3: stroke}), size, len(found.grippers))
            tried[size, stroke] = tried.get((size, stroke), 0) + (least is not None)
            agreed[size, stroke] = agreed.get((size, stroke), 0) + (least == len(found.grippers))
        values = result.row({"parts": size, "stroke [mm]": 1e3 * stroke})
        values["grippers, mean"] = (None, float(np.mean(counts)))
        values["proven least"] = (None, f"{proven} of {assemblies}")
        values["as few by trying all sets"] = (None, f"{agreed[size, stroke]} of {tried[size, stroke]} that ended")
        values["changes, mean"] = (None, float(np.mean(changes)))
        values["time, median [s]"] = (None, float(np.median(seconds)))
        values["time, longest [s]"] = (None, float(np.max(seconds)))
        means[size, stroke] = float(np.mean(counts))
        result.trend(f"{size} parts, stroke {1e3 * stroke:g} mm: every set proven least", proven == assemblies)
    ended = sum(tried.values())
    result.exact(
        f"trying all sets, where {TRIES} tries are enough, finds as many grippers ({ended} of {len(means) * assemblies} assemblies)",
        tried == agreed and all(tried[10, stroke] == assemblies for stroke in strokes),
    )
    for size in sizes:
        ordered = [means[size, stroke] for stroke in strokes]
        result.trend(f"{size} parts: longer strokes need fewer grippers", ordered == sorted(ordered, reverse=True))
    for stroke in strokes:
        ordered = [means[size, stroke] for size in sizes]
        result.trend(f"stroke {1e3 * stroke:g} mm: more parts need more grippers", ordered == sorted(ordered))
    result.drawing = {"means": [[size, stroke, mean] for (size, stroke), mean in means.items()]}
    return result


def draw_growth(result: dict[str, Any]) -> Figure:
    fig, (axis,) = figure(6.0, 3.4)
    for stroke in sorted({row[1] for row in result["drawing"]["means"]}):
        line = [(size, mean) for size, s, mean in result["drawing"]["means"] if s == stroke]
        axis.plot(*zip(*line, strict=True), "o-", label=f"stroke {1e3 * stroke:g} mm")
    axis.set(xlabel="parts", ylabel="grippers, mean")
    axis.set_ylim(bottom=0)
    axis.legend(frameon=False)
    return fig


ENTRIES = [
    Entry("p1-figure-5.13", "The least set of grippers for thirteen parts", figure_5_13, draw_figure_5_13),
    Entry("p1-gripper-growth", "How many grippers random assemblies need", growth, draw_growth),
]
