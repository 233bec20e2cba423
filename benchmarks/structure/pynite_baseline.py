"""PyNite's node displacements of the frames that run.py draws; runs in the baselines' environment.

Reads {"frames": [{"nodes", "members", "sections", "material", "fixed", "weights"}], "repeat": n} and prints
{"displacements": [(n, 3) per frame], "seconds": [s per frame], "version": "..."}. The time is that of making the model and
solving it, the best of `repeat`.
"""

from __future__ import annotations

import json
import sys
import time
from importlib.metadata import version

from Pynite import FEModel3D


def solved(frame: dict) -> FEModel3D:
    model = FEModel3D()
    model.add_material("m", *frame["material"], 0.3, 0.0)  # weights are given as loads
    for i, node in enumerate(frame["nodes"]):
        model.add_node(f"n{i}", *node)
    for i, ((a, b), section, weight) in enumerate(
        zip(frame["members"], frame["sections"], frame["weights"], strict=True)
    ):
        model.add_section(f"s{i}", *section)
        model.add_member(f"m{i}", f"n{a}", f"n{b}", "m", f"s{i}")
        for axis, load in zip("XYZ", weight, strict=True):
            model.add_member_dist_load(f"m{i}", f"F{axis}", load, load)
    model.def_support(f"n{frame['fixed']}", *[True] * 6)
    model.analyze_linear(check_stability=False)
    return model


def main() -> None:
    given = json.load(sys.stdin)
    displacements, seconds = [], []
    for frame in given["frames"]:
        best = float("inf")
        for _ in range(given["repeat"]):
            began = time.perf_counter()
            model = solved(frame)
            best = min(best, time.perf_counter() - began)
        nodes = [model.nodes[f"n{i}"] for i in range(len(frame["nodes"]))]
        displacements.append([[node.DX["Combo 1"], node.DY["Combo 1"], node.DZ["Combo 1"]] for node in nodes])
        seconds.append(best)
    json.dump({"displacements": displacements, "seconds": seconds, "version": version("PyNiteFEA")}, sys.stdout)


if __name__ == "__main__":
    main()
