"""The least set of grippers for random assemblies of about a thousand segments: processor time, and what was proven.

python benchmarks/gripper_design/least_set.py [--parts 400] [--runs 6] [--windows] [--preferred]
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from mmgrasp.gripper_design import GripperActuator, SegmentRequirement, minimal_grippers, preferred_grippers
from mmgrasp.reproduce.gripper_sets import random_assembly


def with_windows(required: list[SegmentRequirement], seed: int) -> list[SegmentRequirement]:
    """The same segments with finger lengths from and to random ones [m]."""
    rng = np.random.default_rng(seed)
    return [
        SegmentRequirement(
            r.part,
            r.opening,
            segment=r.segment,
            fingers=r.fingers,
            min_finger_length=(least := float(rng.uniform(0, 0.06))),
            max_finger_length=least + float(rng.uniform(0.02, 0.08)),
        )
        for r in required
    ]


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--parts", type=int, default=400, help="of each assembly, with 1 to 4 segments each (default 400)")
parser.add_argument("--runs", type=int, default=6, help="assemblies for each stroke (default 6)")
parser.add_argument("--windows", action="store_true", help="finger lengths have random ends")
parser.add_argument("--preferred", action="store_true", help="segments have random values, and the best are preferred")
given = parser.parse_args()
for stroke in (0.008, 0.024, 0.048):
    drives = [GripperActuator("jaws", stroke), GripperActuator("centric", stroke, fingers=3)]
    seconds, segments, least, changes, finished = [], [], 0, 0, 0
    for seed in range(given.runs):
        required = random_assembly(given.parts, seed)
        if given.windows:
            required = with_windows(required, seed)
        values = np.random.default_rng(seed).uniform(size=len(required))
        begin = time.process_time()
        found = preferred_grippers(required, values, drives) if given.preferred else minimal_grippers(required, drives)
        seconds.append(time.process_time() - begin)
        segments.append(len(required))
        least += found.lower_bound == len(found.grippers)
        changes += found.changes == found.changes_bound
        finished += found.preference_finished
    preference = f", every better segment decided in {finished}" if given.preferred else ""
    print(
        f"stroke {1e3 * stroke:2.0f} mm: {np.mean(segments):.0f} segments on average, {np.median(seconds):.2f} s (median), "
        f"{max(seconds):.2f} s (longest), of {given.runs} sets {least} proven least, {changes} with fewest changes{preference}"
    )
