"""The least set of grippers for random assemblies of about a thousand segments: processor time, and whether it was proven.

python benchmarks/gripper_design/least_set.py [--parts 400] [--runs 6]
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from mmgrasp.gripper_design import GripperActuator, minimal_grippers
from mmgrasp.reproduce.gripper_sets import random_assembly

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--parts", type=int, default=400, help="of each assembly, with 1 to 4 segments each (default 400)")
parser.add_argument("--runs", type=int, default=6, help="assemblies for each stroke (default 6)")
given = parser.parse_args()
for stroke in (0.008, 0.024, 0.048):
    drives = [GripperActuator("jaws", stroke), GripperActuator("centric", stroke, fingers=3)]
    seconds, segments, proven = [], [], 0
    for seed in range(given.runs):
        required = random_assembly(given.parts, seed)
        begin = time.process_time()
        found = minimal_grippers(required, drives)
        seconds.append(time.process_time() - begin)
        segments.append(len(required))
        proven += found.lower_bound == len(found.grippers)
    print(
        f"stroke {1e3 * stroke:2.0f} mm: {np.mean(segments):.0f} segments on average, {np.median(seconds):.2f} s (median), "
        f"{max(seconds):.2f} s (longest), {proven} of {given.runs} proven least"
    )
