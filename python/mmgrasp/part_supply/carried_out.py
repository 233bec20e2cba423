"""Whether the drives and motions of a plan follow from one another, so that a robot can carry it out. All else `mmgrasp verify` says."""

from __future__ import annotations

from collections.abc import Sequence

from ..documents.reading import Node
from .drives import unloading_after

_SAME = 1e-6  # [m], [rad]


def check_carried_out(root: Node) -> None:
    """Raises InvalidInput naming the first place of a plan (whose form is that of the schema) at which the robot is not where it should be."""
    _check_drives(root)
    _check_motions(root)
    root["scenario"]["gripper"]["max_opening"].number(above=0)


def _check_drives(root: Node) -> None:
    legs, stops = root["route"].elements(), root["stops"].elements()
    if len(legs) != len(stops) + 1:
        root["route"].fail(f"has {len(legs)} legs: must be one more than the {len(stops)} stops")
    at = root["scenario"]["start"].numbers(3)
    for i, leg in enumerate(legs):
        poses = leg["poses"].elements()
        _expect(poses[0] if poses else leg["poses"], at, "the robot stands")
        at = poses[-1].numbers(3)
        if i == len(stops):
            continue
        _expect(stops[i]["pose"], at, "the robot arrives")
        for k, pick in enumerate(root.raw["picks"]):
            if pick["stop"] != i:
                continue
            for where, drive in unloading_after(root.raw, k):
                if not _near(drive["poses"][0], at):
                    root["unloadings"].fail(f"the drive to {where} begins elsewhere than the robot stands")
                at = drive["poses"][-1]
    _expect(root["scenario"]["goal"], at, "the robot arrives")


def _check_motions(root: Node) -> None:
    joints = len(root["scenario"]["arm"]["joints"].elements())
    at = root["scenario"]["home"].numbers(joints)
    for pick in root["picks"].elements():
        for motion in pick["motions"].elements():
            samples = motion["positions"].elements()
            if len(samples) < 2:
                motion["positions"].fail("must be two samples at least")
            _expect(samples[0], at, "the motion before ends")
            at = samples[-1].numbers(joints)


def _expect(node: Node, at: Sequence[float], what: str) -> None:
    if not _near(node.numbers(len(at)), at):
        there = ", ".join(f"{x:g}" for x in at)
        node.fail(f"must be [{there}], where {what}")


def _near(a: Sequence[float], b: Sequence[float]) -> bool:
    return len(a) == len(b) and all(abs(x - y) <= _SAME for x, y in zip(a, b, strict=True))
