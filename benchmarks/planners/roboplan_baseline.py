"""RoboPlan's RRT-Connect with shortcuts on what bench_ordinary.py asks; runs in the baselines' environment.

Reads the problems as JSON and prints {"seconds": s, "path": [[...]] or null} for each problem and seed.
"""

from __future__ import annotations

import itertools
import json
import sys
import time
from pathlib import Path

import numpy as np
from roboplan.core import (
    Box,
    Cylinder,
    JointConfiguration,
    PathShortcutter,
    PathShortcuttingOptions,
    Scene,
    Sphere,
    loadUrdfSceneDescriptionFromXml,
)
from roboplan.rrt import RRT, RRTOptions

STEP = 0.05
ADD = {
    "box": ("addBoxGeometry", Box),
    "cylinder": ("addCylinderGeometry", Cylinder),
    "sphere": ("addSphereGeometry", Sphere),
}


def scene_of(robot: dict, problem: dict) -> Scene:
    """The robot with the pairs the problem allows, and the problem's primitives."""
    urdf = Path(robot["urdf"])
    text = urdf.read_text().replace("package://meshes", str(urdf.parent / "meshes"))
    scene = Scene(problem["name"], loadUrdfSceneDescriptionFromXml(text, [str(urdf.parent)]))
    scene.importSrdf(Path(robot["srdf"]).read_text())
    links = set(scene.getJointGroupInfo("").link_names)
    scene.setCollisions([(a, b) for a, b in problem["allowed"] if a in links and b in links], False)
    for shape in problem["scene"]:
        method, kind = ADD[shape["kind"]]
        pose = np.asfortranarray(shape["pose"], dtype=float)
        getattr(scene, method)(shape["name"], "universe", kind(*shape["sizes"]), pose, np.ones(4))
    scene.setCollisions(list(itertools.combinations([shape["name"] for shape in problem["scene"]], 2)), False)
    return scene


def configuration(names: list[str], values: dict[str, float]) -> JointConfiguration:
    return JointConfiguration(names, np.array([values[name] for name in names]))


def main() -> None:
    query = json.load(sys.stdin)
    for problem in query["problems"]:
        scene = scene_of(query["robot"], problem)
        group = problem["group"]
        names = list(scene.getJointGroupInfo(group).joint_names)
        start, goal = configuration(names, problem["start"]), configuration(names, problem["goal"])
        options = RRTOptions(
            group_name=group,
            rrt_connect=True,
            max_nodes=1_000_000,
            max_connection_distance=1.0,
            collision_check_step_size=STEP,
            max_planning_time=query["time_limit"],
        )
        for seed in range(1, query["seeds"] + 1):
            planner = RRT(scene, options)
            planner.setRngSeed(seed)
            shortcuts = PathShortcutter(scene, PathShortcuttingOptions(group_name=group, max_step_size=STEP, seed=seed))
            begin = time.process_time()
            try:
                path = shortcuts.shortcut(planner.plan(start, goal)).positions
            except (RuntimeError, ValueError) as error:  # so it says that none was found
                print(problem["name"], seed, error, file=sys.stderr)
                path = None
            seconds = time.process_time() - begin
            print(json.dumps({"seconds": seconds, "path": None if path is None else np.array(path).tolist()}))


if __name__ == "__main__":
    main()
