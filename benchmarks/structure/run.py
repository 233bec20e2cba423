"""Frames of beams beside PyNite, and what one grasp costs along a path, in one run.

    python benchmarks/structure/run.py [--frames 200] [--baselines FOLDER] [--write]

PyNite (in an environment of its own, made when it is not there) and mmgrasp bend the same random frames: trees of 2 to 12
nodes with up to three closing members, round tubes, gravity in any direction, clamped at a node. Then all grasps of a pipe
are costed along an arc of 30 poses in a pipe cell. --write puts the tables into benchmarks/README.md.
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
    ObjectPathEvaluator,
    ObjectPathProblem,
    SupportedFrame,
    beam_frame,
    copper,
    round_section,
)
from mmgrasp.problems.pipe_cells import FINGERS, pipe_robot, pipe_structures

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from programs import BUILD, baselines_environment
from tables import markdown, show

G = 9.81
MATERIAL = (110e9, 40e9)
DENSITY = 8960.0


def random_frame(rng: np.random.Generator, nodes: int) -> tuple[BeamFrame, int, np.ndarray]:
    """A frame, the node at which it is clamped, and gravity in its frame."""
    while True:
        points = rng.uniform(-0.5, 0.5, (nodes, 3))
        pairs = {(int(rng.integers(i)), i) for i in range(1, nodes)}
        for _ in range(rng.integers(4)):
            a, b = sorted(rng.choice(nodes, 2, replace=False))
            pairs.add((int(a), int(b)))
        if all(np.linalg.norm(points[a] - points[b]) > 0.05 for a, b in pairs):
            break
    material = BeamMaterial(DENSITY, *MATERIAL)
    members = []
    for a, b in sorted(pairs):
        outer = rng.uniform(0.01, 0.03)
        members.append(BeamMember(a, b, round_section(outer, outer * rng.uniform(0.0, 0.9)), material))
    down = rng.normal(size=3)
    return BeamFrame(points, members), int(rng.integers(nodes)), G * down / np.linalg.norm(down)


def clamp_at(frame: BeamFrame, node: int) -> BeamSupport:
    for i, member in enumerate(frame.members):
        if node in member.nodes:
            a, b = member.nodes
            return BeamSupport(i, 0.0 if node == a else float(np.linalg.norm(frame.nodes[a] - frame.nodes[b])))
    raise AssertionError("every node is of a member")


def best_time(work, repeat: int = 20) -> float:
    best = float("inf")
    for _ in range(repeat):
        began = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - began)
    return best


def as_plain(frame: BeamFrame, node: int, gravity: np.ndarray) -> dict:
    sections = [m.section for m in frame.members]
    return {
        "nodes": frame.nodes.tolist(),
        "members": [list(m.nodes) for m in frame.members],
        "sections": [[s.area, s.iy, s.iz, s.torsion] for s in sections],
        "material": MATERIAL,
        "fixed": node,
        "weights": [(DENSITY * s.area * gravity).tolist() for s in sections],
    }


def frames_table(count: int, folder: Path) -> str:
    rng = np.random.default_rng(1)
    cases = [random_frame(rng, int(rng.integers(2, 13))) for _ in range(count)]
    nine = random_frame(np.random.default_rng(2), 9)
    try:
        python = baselines_environment(folder, HERE / "baselines.txt")
    except subprocess.CalledProcessError as error:
        return f"skipped: PyNite could not be installed ({error})"
    given = {"frames": [as_plain(*case) for case in [*cases, nine]], "repeat": 3}
    done = subprocess.run(
        [python, HERE / "pynite_baseline.py"], input=json.dumps(given), capture_output=True, text=True, check=True
    )
    theirs = json.loads(done.stdout)
    worst, times = 0.0, []
    for (frame, node, gravity), wanted in zip([*cases, nine], theirs["displacements"], strict=True):
        support = clamp_at(frame, node)
        ours = SupportedFrame(frame, support).state(gravity).nodes[:, :3]
        worst = max(worst, float(np.abs(ours - wanted).max() / np.abs(wanted).max()))
        times.append(best_time(lambda f=frame, s=support, g=gravity: SupportedFrame(f, s).state(g)))
    frame, node, gravity = nine
    held = SupportedFrame(frame, clamp_at(frame, node))
    more = best_time(lambda: held.largest_displacement(gravity), 200)
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
        "largest difference over largest displacement",
    ]
    return markdown(head, rows)


def arc_problem(robot: str, number: int, poses: int) -> tuple[ObjectPathProblem, list]:
    """A pipe on an arc around the arm, above a table and beside a column."""
    _, arm, gripper = pipe_robot(robot)
    pipe = pipe_structures()[number - 1]
    scale = 1.0 if robot == "tm14like" else 0.75
    path = []
    for s in np.linspace(0, 1, poses):
        turn = -0.6 + 1.2 * s
        at = [0.6 * scale * np.cos(turn), 0.6 * scale * np.sin(turn), 0.45 * scale + 0.1 * np.sin(np.pi * s)]
        path.append(mg.pose(at, rpy=[0.3 * s, 0.4 * s, turn]))
    world = mg.World()
    world.add_box("table", [2.6, 2.6, 0.05], mg.pose([0, 0, -0.03]))
    world.add_cylinder("column", 0.05, 0.4, mg.pose([0.35 * scale, 0, 0.2]))
    grasps = [g for g in pipe.sample_grasps(300, gripper=gripper, seed=3)]
    problem = ObjectPathProblem(
        arm,
        world,
        pipe.shapes(),
        np.array(path),
        gripper=gripper,
        touch_links=sorted(FINGERS),
        frame=beam_frame(pipe, 0.010, copper()),
        object_name="pipe",
    )
    return problem, grasps


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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--frames", type=int, default=200)
    parser.add_argument("--baselines", type=Path, default=BUILD / "structure-baselines")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    text = f"Python {platform.python_version()}, one core.\n\n{frames_table(args.frames, args.baselines)}\n\n"
    text += (
        "One grasp along 30 poses (P2: 26 to 48 ms; goal 0.5 ms for a feasible one), 300 grasps:\n\n" + paths_table()
    )
    show("structure", text, args.write)


if __name__ == "__main__":
    main()
