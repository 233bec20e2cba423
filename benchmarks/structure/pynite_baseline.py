"""PyNite's answers for the frames that run.py draws; runs in the baselines' environment.

Reads {"frames": [...], "repeat": n} as run.py's `for_pynite` writes them and prints {"answers": [{"nodes": (n, 6), "reaction":
(6,)}], "seconds": [s per frame], "version": "..."}: displacements and rotations of the nodes, force and moment of the clamp. The
time is that of making the model and solving it, the best of `repeat`.
"""

from __future__ import annotations

import json
import sys
import time
from importlib.metadata import version

import numpy as np
from Pynite import FEModel3D


def turn_of(model: FEModel3D, name: str, y: list[float]) -> float:
    """Angle by which the member's axes must be turned about it so that its y is this direction [degrees]."""
    axes = np.array(model.members[name].T())[:3, :3]  # rows: x, y, z
    return float(np.degrees(np.arctan2(axes[2] @ y, axes[1] @ y)))


def solved(frame: dict, turns: list[float]) -> FEModel3D:
    model = FEModel3D()
    model.add_material("m", *frame["material"], 0.3, 0.0)  # weights are given as loads
    for i, node in enumerate(frame["nodes"]):
        model.add_node(f"n{i}", *node)
    for i, (member, section, weight, turn) in enumerate(
        zip(frame["members"], frame["sections"], frame["weights"], turns, strict=True)
    ):
        a, b = member["nodes"]
        model.add_section(f"s{i}", *section)
        model.add_member(f"m{i}", f"n{a}", f"n{b}", "m", f"s{i}", rotation=turn)
        for axis, load in zip("XYZ", weight, strict=True):
            model.add_member_dist_load(f"m{i}", f"F{axis}", load, load)
    for node, *loads in frame["node_loads"]:
        for kind, load in zip(("FX", "FY", "FZ", "MX", "MY", "MZ"), loads, strict=True):
            model.add_node_load(f"n{node}", kind, load)
    model.def_support(f"n{frame['fixed']}", *[True] * 6)
    return model


def turns_of(frame: dict) -> list[float]:
    """The turns of all members; their y is then where it was asked for."""
    plain = solved(frame, [0.0] * len(frame["members"]))
    turns = [turn_of(plain, f"m{i}", m["y"]) for i, m in enumerate(frame["members"])]
    turned = solved(frame, turns)
    for i, member in enumerate(frame["members"]):
        if not np.allclose(np.array(turned.members[f"m{i}"].T())[1, :3], member["y"], atol=1e-9):
            turns[i] = -turns[i]  # the sign of a turn depends on PyNite's version
    turned = solved(frame, turns)
    for i, member in enumerate(frame["members"]):
        assert np.allclose(np.array(turned.members[f"m{i}"].T())[1, :3], member["y"], atol=1e-9)
    return turns


def main() -> None:
    given = json.load(sys.stdin)
    answers, seconds = [], []
    for frame in given["frames"]:
        turns = turns_of(frame)
        best = float("inf")
        for _ in range(given["repeat"]):
            began = time.perf_counter()
            model = solved(frame, turns)
            model.analyze_linear(check_stability=False)
            best = min(best, time.perf_counter() - began)
        nodes = [model.nodes[f"n{i}"] for i in range(len(frame["nodes"]))]
        moved = [[getattr(node, kind)["Combo 1"] for kind in ("DX", "DY", "DZ", "RX", "RY", "RZ")] for node in nodes]
        clamp = nodes[frame["fixed"]]
        held = [getattr(clamp, kind)["Combo 1"] for kind in ("RxnFX", "RxnFY", "RxnFZ", "RxnMX", "RxnMY", "RxnMZ")]
        answers.append({"nodes": moved, "reaction": held})
        seconds.append(best)
    json.dump({"answers": answers, "seconds": seconds, "version": version("PyNiteFEA")}, sys.stdout)


if __name__ == "__main__":
    main()
