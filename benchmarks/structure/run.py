"""Frames of beams beside PyNite, and what one grasp costs along a path, in one run.

    python benchmarks/structure/run.py [--frames 200] [--baselines FOLDER] [--write | --store]

PyNite (in an environment of its own, made when it is not there) and mmgrasp bend the same random frames: trees of 2 to 12
nodes with up to three closing members, round tubes and turned rectangles, masses, forces and moments on nodes, gravity in any
direction, clamped at a node. Displacements, rotations and reactions must agree within 1e-8, else the exit code is 1. Then all
grasps of a pipe are costed along an arc of 30 poses in a pipe cell. --write puts the tables into benchmarks/README.md, --store
makes the answers that tests/python/test_beam_frame.py is held against.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

import mmgrasp as mg
from mmgrasp.grasping import (
    BeamFrame,
    BeamMaterial,
    BeamMember,
    BeamSupport,
    NodeLoad,
    ObjectPathEvaluator,
    ObjectPathProblem,
    SupportedFrame,
    rectangular_section,
    round_section,
)
from mmgrasp.problems.pipe_cells import pipe_robot, pipe_structures
from mmgrasp.reproduce.grasp_search_runs import arc_around_arm, carrying

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, baselines_environment
from tables import markdown, show

G = 9.81
MATERIAL = (110e9, 40e9)
DENSITY = 8960.0
REPEAT = 10
WITHIN = 1e-8
STORED = HERE.parents[1] / "tests/python/pynite_frames.json"


def random_frame(rng: np.random.Generator, nodes: int) -> dict:
    """Plain numbers: nodes [m], members with their shapes and the direction of y, loads, the clamped node, gravity."""
    while True:
        points = rng.uniform(-0.5, 0.5, (nodes, 3))
        pairs = {(int(rng.integers(i)), i) for i in range(1, nodes)}
        for _ in range(rng.integers(4)):
            a, b = sorted(rng.choice(nodes, 2, replace=False))
            pairs.add((int(a), int(b)))
        if all(np.linalg.norm(points[a] - points[b]) > 0.05 for a, b in pairs):
            break
    members = []
    for a, b in sorted(pairs):
        outer, inner = rng.uniform(0.01, 0.03), rng.uniform(0.0, 0.9)
        sides = rng.uniform(0.01, 0.03, 2)
        wall = float(rng.choice([0.0, 0.1 * sides.min()]))
        round_ = bool(rng.integers(2))
        shape = ["round", outer, outer * inner] if round_ else ["rectangle", *sides.tolist(), wall]
        along = (points[b] - points[a]) / np.linalg.norm(points[b] - points[a])
        y = np.cross(along, rng.normal(size=3))
        members.append({"nodes": [a, b], "shape": shape, "y": (y / np.linalg.norm(y)).tolist()})
    down = rng.normal(size=3)
    loads = [
        {"node": int(rng.integers(nodes)), "mass": rng.uniform(0, 0.5)}
        | {"force": rng.normal(0, 2, 3).tolist(), "moment": rng.normal(0, 0.2, 3).tolist()}
        for _ in range(rng.integers(3))
    ]
    gravity = (G * down / np.linalg.norm(down)).tolist()
    return {
        "nodes": points.tolist(),
        "members": members,
        "loads": loads,
        "fixed": int(rng.integers(nodes)),
        "gravity": gravity,
    }


def frame_of(plain: dict) -> tuple[BeamFrame, BeamSupport]:
    """mmgrasp's frame, and the clamp at its node."""
    material = BeamMaterial(DENSITY, *MATERIAL)
    make = {"round": round_section, "rectangle": rectangular_section}
    members = [
        BeamMember(*m["nodes"], make[m["shape"][0]](*m["shape"][1:]), material, m["y"]) for m in plain["members"]
    ]
    frame = BeamFrame(plain["nodes"], members, [NodeLoad(**load) for load in plain["loads"]])
    for i, member in enumerate(frame.members):
        if plain["fixed"] in member.nodes:
            a, b = member.nodes
            length = float(np.linalg.norm(frame.nodes[a] - frame.nodes[b]))
            return frame, BeamSupport(i, 0.0 if plain["fixed"] == a else length)
    raise AssertionError("every node is of a member")


def for_pynite(plain: dict) -> dict:
    """With sections' numbers, weights a length, and forces and moments on nodes."""
    frame, _ = frame_of(plain)
    gravity = np.array(plain["gravity"])
    sections = [m.section for m in frame.members]
    return plain | {
        "sections": [[s.area, s.iy, s.iz, s.torsion] for s in sections],
        "material": MATERIAL,
        "weights": [(DENSITY * s.area * gravity).tolist() for s in sections],
        "node_loads": [
            [load["node"], *(np.array(load["force"]) + load["mass"] * gravity).tolist(), *load["moment"]]
            for load in plain["loads"]
        ],
    }


def largest_difference(plain: dict, theirs: dict) -> float:
    """Largest difference of displacements, rotations, reaction force and moment, each over the largest of its kind."""
    frame, support = frame_of(plain)
    state = SupportedFrame(frame, support).state(plain["gravity"])
    worst = 0.0
    for ours, wanted in (
        (state.nodes, np.array(theirs["nodes"])),
        (state.reactions, np.array([theirs["reaction"]])),
    ):
        for part in (slice(0, 3), slice(3, 6)):
            size = float(np.abs(wanted[:, part]).max())
            worst = max(worst, float(np.abs(ours[:, part] - wanted[:, part]).max()) / max(size, 1e-12))
    return worst


def pynite(cases: list[dict], folder: Path, repeat: int) -> dict:
    python = baselines_environment(folder, HERE / "baselines.txt")
    given = {"frames": [for_pynite(case) for case in cases], "repeat": repeat}
    done = subprocess.run(
        [python, HERE / "pynite_baseline.py"], input=json.dumps(given), capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def store(folder: Path) -> None:
    """PyNite's answers for the frames of tests/python/test_beam_frame.py."""
    rng = np.random.default_rng(5)
    cases = [random_frame(rng, int(rng.integers(2, 9))) for _ in range(16)]
    theirs = pynite(cases, folder, 1)
    frames = [case | {"answer": answer} for case, answer in zip(cases, theirs["answers"], strict=True)]
    STORED.write_text(json.dumps({"version": theirs["version"], "frames": frames}) + "\n")


def best_time(work, repeat: int = REPEAT) -> float:
    best = float("inf")
    for _ in range(repeat):
        began = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - began)
    return best


def frames_table(count: int, folder: Path) -> tuple[str, float]:
    """And the largest difference."""
    rng = np.random.default_rng(1)
    cases = [random_frame(rng, int(rng.integers(2, 13))) for _ in range(count)]
    cases.append(random_frame(np.random.default_rng(2), 9))
    try:
        theirs = pynite(cases, folder, REPEAT)
    except subprocess.CalledProcessError as error:
        return f"skipped: PyNite could not be installed ({error})", 0.0
    worst = max(largest_difference(case, answer) for case, answer in zip(cases, theirs["answers"], strict=True))
    times = []
    for case in cases:
        frame, support = frame_of(case)
        times.append(best_time(lambda f=frame, s=support, g=case["gravity"]: SupportedFrame(f, s).state(g)))
    held = SupportedFrame(frame, support)
    more = best_time(lambda: held.largest_displacement(cases[-1]["gravity"]), 200)
    rows = [
        [f"{count} random frames, median", f"{1e3 * statistics.median(theirs['seconds'][:-1]):.2f} ms"]
        + [f"{1e6 * statistics.median(times[:-1]):.0f} us", f"{worst:.1e}"],
        ["one of 9 nodes", f"{1e3 * theirs['seconds'][-1]:.2f} ms", f"{1e6 * times[-1]:.0f} us"]
        + [f"{theirs['seconds'][-1] / times[-1]:.0f} times faster"],
        ["... one more orientation, largest displacement", "as above", f"{1e6 * more:.1f} us", ""],
    ]
    head = [
        "frames",
        f"PyNite {theirs['version']}",
        "mmgrasp, through Python",
        "largest difference over the largest of its kind",
    ]
    return markdown(head, rows), worst


def arc_problem(robot: str, number: int, poses: int) -> tuple[ObjectPathProblem, list]:
    """A pipe on an arc around the arm, above a table and beside a column."""
    _, arm, gripper = pipe_robot(robot)
    pipe = pipe_structures()[number - 1]
    scale = 1.0 if robot == "tm14like" else 0.75
    path = arc_around_arm(0.6 * scale, 0.45 * scale, 0.1, poses)
    world = mg.World()
    world.add_box("table", [2.6, 2.6, 0.05], mg.pose([0, 0, -0.03]))
    world.add_cylinder("column", 0.05, 0.4, mg.pose([0.35 * scale, 0, 0.2]))
    grasps = [g for g in pipe.sample_grasps(300, gripper=gripper, seed=3)]
    return carrying(arm, gripper, pipe, world, path), grasps


def paths_table() -> str:
    rows = []
    for robot in ("tm14like", "kr6like"):
        for name, number in (("Pipe1", 6), ("Pipe2", 5), ("Pipe3", 8)):
            problem, grasps = arc_problem(robot, number, 30)
            for edges in (True, False):
                evaluator = ObjectPathEvaluator(problem, check_edges=edges)
                feasible, fallen = [], []
                for grasp in grasps:
                    result = evaluator.evaluate(grasp)
                    kind = feasible if result.outcome == mg.Outcome.solved else fallen
                    kind.append(best_time(lambda e=evaluator, g=grasp: e.evaluate(g), 3))
                median = [f"{1e3 * statistics.median(kind):.2f} ms" if kind else "-" for kind in (feasible, fallen)]
                rows.append(
                    [
                        robot,
                        name,
                        "checked" if edges else "left out, as P2",
                        f"{len(feasible)} of {len(grasps)}",
                        *median,
                    ]
                )
    return markdown(["arm", "pipe", "motions between poses", "feasible", "feasible, median", "others, median"], rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--baselines", type=Path, default=BUILD / "structure-baselines")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--store", action="store_true", help="only make the answers that a test reads")
    args = parser.parse_args()
    if args.store:
        store(args.baselines)
        return 0
    table, worst = frames_table(args.frames, args.baselines)
    text = f"Python {platform.python_version()}, one core; the best of {REPEAT} repeats on either side.\n\n{table}\n\n"
    text += (
        "One grasp along 30 poses (P2: 26 to 48 ms; goal 0.5 ms for a feasible one), 300 grasps:\n\n" + paths_table()
    )
    show("structure", text, args.write)
    if worst > WITHIN:
        print(f"differs from PyNite by {worst:.1e}, more than {WITHIN:.0e}", file=sys.stderr)
    return int(worst > WITHIN)


if __name__ == "__main__":
    sys.exit(main())
