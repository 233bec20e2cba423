"""The whole plan on one clock: where base, arm, fingers and parts are at any time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..bodies import stored_pose
from ..part_supply.drives import carried_in_hand, unloading_after

GRIP_TIME = 0.5  # Shown for closing and for opening the fingers [s].


@dataclass
class State:
    """Everything that moves, at one time."""

    base: np.ndarray  # x, y, theta
    arm: np.ndarray  # configuration of the arm's joints
    opening: float  # of the fingers [m]
    attached: tuple[str, np.ndarray] | None = None  # part name and T_hand_part
    removed: frozenset[str] = frozenset()  # parts in the bin, or let go at the goal


@dataclass
class Segment:
    """A stretch of the clock in which one thing happens."""

    label: str
    start: float
    duration: float
    kind: str  # "drive", "motion", "grip" or "drive-by"
    data: Any
    attached: tuple[str, np.ndarray] | None = None
    removed: frozenset[str] = frozenset()
    base: np.ndarray = field(default_factory=lambda: np.zeros(3))
    opening: float = 0.0
    after: float = 0.0  # of the motion's own clock, where the segment begins [s]


class Timeline:
    """Segments of a plan (a dictionary as in plan.json) in the order in which they are carried out."""

    def __init__(self, plan: dict[str, Any]):
        self.plan = plan
        self.home = np.asarray(plan["scenario"]["home"], float)
        self.segments: list[Segment] = []
        self._carried: dict[str, Any] | None = None  # the pick whose part rides to the goal in the hand
        parts = {part["name"]: part for part in plan["scenario"]["parts"]}
        removed: frozenset[str] = frozenset()
        clock = 0.0
        stops = plan["stops"]
        passing = {motion["pick"]: motion for motion in plan.get("drive_by", {"motions": []})["motions"]}
        for index, leg in enumerate(plan["route"]):
            goal = "the goal" if index == len(stops) else f"stop {index + 1}"
            picks = [(i, pick) for i, pick in enumerate(plan["picks"]) if pick["stop"] == index]
            if not picks or picks[0][0] not in passing:
                clock, removed = self._add_drive(f"drive to {goal}", leg, parts, removed, clock)
            for i, pick in picks:
                base = np.asarray(stops[index]["pose"], float)
                keeps_retreat = passing.get(i + 1, {}).get("begins") != "release"
                clock = self._add_pick(pick, base, parts, removed, clock, passing.get(i), keeps_retreat)
                if carried_in_hand(plan):
                    self._carried = pick
                else:
                    removed = removed | {pick["part"]}
                for where, drive in unloading_after(plan, i):
                    clock, removed = self._add_drive(f"drive to {where}", drive, parts, removed, clock)
        self.duration = clock

    def _add_drive(
        self, name: str, leg: dict[str, Any], parts: dict[str, Any], removed: frozenset[str], clock: float
    ) -> tuple[float, frozenset[str]]:
        """A drive, and where it brings a part to the goal in the hand, what lets it go there."""
        poses = np.asarray(leg["poses"], float).reshape(-1, 3)
        segment = Segment(name, clock, float(leg["duration"]), "drive", poses, removed=removed)
        pick, self._carried = self._carried, None
        if pick is None:
            return self._add(segment), removed
        grasp = parts[pick["part"]]["grasps"][pick["grasp"]]
        segment.attached, segment.opening = _in_hand(pick["part"], grasp), float(grasp["opening"])
        clock = self._add(segment)
        goal = np.asarray(self.plan["scenario"]["goal"], float)
        motions = [motion for motion in pick["motions"] if motion["kind"] in ("transfer", "retreat")]
        clock = self._add_motions(pick["part"], motions, segment.attached, removed, clock, goal)
        return clock, removed | {pick["part"]}

    def _add(self, segment: Segment) -> float:
        self.segments.append(segment)
        return segment.start + segment.duration

    def _add_pick(
        self,
        pick: dict[str, Any],
        base: np.ndarray,
        parts: dict[str, Any],
        removed: frozenset[str],
        clock: float,
        passing: dict[str, Any] | None,
        keeps_retreat: bool,
    ) -> float:
        name = pick["part"]
        grasp = parts[name]["grasps"][pick["grasp"]]
        in_hand = _in_hand(name, grasp)
        motions = pick["motions"]
        if carried_in_hand(self.plan):
            motions = [motion for motion in motions if motion["kind"] not in ("transfer", "retreat")]
        if passing is not None:
            closed, end = float(passing["closed_at"]), float(passing["times"][-1])
            coming = Segment(f"drive by {name}", clock, closed, "drive-by", (passing, grasp["opening"]), None, removed)
            leaving = Segment(
                f"drive on with {name}", clock + closed, end - closed, "drive-by", coming.data, in_hand, removed
            )
            leaving.after = closed
            clock = self._add(coming)
            clock = self._add(leaving)
            motions = [m for m in motions if m["kind"] in ("transfer", "retreat")]
            if passing.get("ends") == "release":
                clock = self._add_grip("release", name, clock, motions.pop(0), in_hand, removed, base)
        kept = motions if keeps_retreat else [m for m in motions if m["kind"] != "retreat"]
        return self._add_motions(name, kept, in_hand, removed, clock, base)

    def _add_motions(
        self,
        name: str,
        motions: list[dict[str, Any]],
        in_hand: tuple[str, np.ndarray],
        removed: frozenset[str],
        clock: float,
        base: np.ndarray,
    ) -> float:
        for motion in motions:
            attached = in_hand if motion["attached"] else None
            binned = removed | {name} if motion["kind"] == "retreat" else removed
            label = f"{motion['kind']} {name}"
            segment = Segment(label, clock, float(motion["times"][-1]), "motion", motion, attached, binned, base)
            segment.opening = float(motion["opening"])
            clock = self._add(segment)
            if motion["kind"] in ("approach", "transfer"):
                word = "grasp" if motion["kind"] == "approach" else "release"
                held = in_hand if word == "release" else None
                clock = self._add_grip(word, name, clock, motion, held, removed, base)
        return clock

    def _add_grip(
        self,
        word: str,
        name: str,
        clock: float,
        motion: dict[str, Any],
        attached: tuple[str, np.ndarray] | None,
        removed: frozenset[str],
        base: np.ndarray,
    ) -> float:
        """The fingers move where a motion ends."""
        grip = Segment(f"{word} {name}", clock, GRIP_TIME, "grip", motion, attached, removed, base)
        grip.opening = float(motion["opening"])
        return self._add(grip)

    def segment_at(self, time: float) -> Segment:
        """The segment in which this time lies (clamped to the plan)."""
        for segment in self.segments:
            if time < segment.start + segment.duration:
                return segment
        return self.segments[-1]

    def state_at(self, time: float) -> State:
        """Where everything is at this time [s] (clamped to the plan)."""
        if not self.segments:  # a plan that was not found: the robot waits at the start
            return State(np.asarray(self.plan["scenario"]["start"], float), self.home, 0.0)
        segment = self.segment_at(max(0.0, min(time, self.duration)))
        local = min(max(time - segment.start, 0.0), segment.duration)
        if segment.kind == "drive":
            share = local / segment.duration if segment.duration > 0 else 1.0
            base = along_route(segment.data, share)
            return State(base, self.home, segment.opening, segment.attached, segment.removed)
        if segment.kind == "drive-by":
            motion, width = segment.data
            when = segment.after + local
            row = [np.interp(when, motion["times"], column) for column in np.transpose(motion["positions"])]
            opening = np.interp(when, [motion["close_at"], motion["closed_at"]], [motion["opening"], width])
            return State(np.array(row[:3]), np.array(row[3:]), float(opening), segment.attached, segment.removed)
        motion = segment.data
        times = np.asarray(motion["times"], float)
        positions = np.asarray(motion["positions"], float)
        when = local if segment.kind == "motion" else times[-1]
        arm = np.array([np.interp(when, times, positions[:, j]) for j in range(positions.shape[1])])
        return State(segment.base, arm, segment.opening, segment.attached, segment.removed)

    def grasp_times(self) -> list[tuple[int, float]]:
        """(stop index, time at which the part is reached), one for each pick."""
        result = []
        for segment in self.segments:
            for word in ("grasp ", "drive on with "):
                if segment.kind == "motion" or not segment.label.startswith(word):
                    continue
                name = segment.label.removeprefix(word)
                stop = next(p["stop"] for p in self.plan["picks"] if p["part"] == name)
                result.append((stop, segment.start))
        return result


def _in_hand(name: str, grasp: dict[str, Any]) -> tuple[str, np.ndarray]:
    """A part's name and T_hand_part while it is held so."""
    return name, np.linalg.inv(stored_pose(grasp["pose"]))


def along_route(poses: np.ndarray, share: float) -> np.ndarray:
    """Base pose after this share of a leg, metres and radians of turning counted alike."""
    if len(poses) == 1:
        return np.asarray(poses[0])
    steps = np.diff(poses, axis=0)
    weights = np.hypot(steps[:, 0], steps[:, 1]) + np.abs(steps[:, 2])
    reached = np.concatenate([[0.0], np.cumsum(weights)])
    if reached[-1] <= 0:
        return np.asarray(poses[-1])
    where = share * reached[-1]
    index = min(int(np.searchsorted(reached, where, side="right")) - 1, len(steps) - 1)
    local = (where - reached[index]) / weights[index] if weights[index] > 0 else 1.0
    return np.asarray(poses[index] + min(max(local, 0.0), 1.0) * steps[index])
