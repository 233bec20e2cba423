"""Segments of 50 composed parts against the primitives they were made of: share of faces right and seconds, part by part.

    python benchmarks/gripper_design/run.py [--parts 50]

Needs manifold3d (pip install 'mmgrasp[test]').
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "python"))
from composed_parts import composed_parts, faces_right
from test_segment_mesh import segmented

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--parts", type=int, default=50, help="how many (default 50)")
shares = []
with tempfile.TemporaryDirectory() as folder:
    for k, (part, noise) in enumerate(composed_parts(parser.parse_args().parts)):
        begin = time.perf_counter()
        _, truth, found = segmented(part, noise, k, Path(folder))
        shares.append(faces_right(truth, found.labels))
        print(
            f"{k:3} {part.name:32} noise {noise:.2f} mm  {len(truth):6} faces  {100 * shares[-1]:6.1f} % right  {time.perf_counter() - begin:5.1f} s"
        )
print(f"mean {100 * np.mean(shares):.1f} %, {sum(s < 0.95 for s in shares)} of {len(shares)} below 95 %")
