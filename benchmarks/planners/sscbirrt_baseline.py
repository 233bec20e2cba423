"""sscbirrt on what bench_ordinary.py asks, the robot and the scene as a MuJoCo model; runs in the baselines' environment.

Reads the problems as JSON and prints {"seconds": s, "path": [[...]] or null} for each problem and seed.
"""

from __future__ import annotations

import json
import sys
import time
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
from sscbirrt import CBiRRTConfig
from sscbirrt.mujoco import Arm, plan

GEOMS = {
    "box": mujoco.mjtGeom.mjGEOM_BOX,
    "cylinder": mujoco.mjtGeom.mjGEOM_CYLINDER,
    "sphere": mujoco.mjtGeom.mjGEOM_SPHERE,
}


def sizes_of(shape: dict) -> list[float]:
    """MuJoCo's half sizes."""
    sizes = shape["sizes"]
    if shape["kind"] == "box":
        return [x / 2 for x in sizes]
    return [sizes[0], sizes[1] / 2, 0] if shape["kind"] == "cylinder" else [sizes[0], 0, 0]


def model_of(robot: dict, problem: dict) -> mujoco.MjModel:
    """Collision geometry only; pairs of the SRDF and of the problem excluded."""
    urdf = Path(robot["urdf"])
    root = ET.fromstring(urdf.read_text())
    for link in root.iter("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
    for mesh in root.iter("mesh"):
        mesh.set("filename", mesh.get("filename").replace("package://meshes", str(urdf.parent / "meshes")))
    extension = ET.SubElement(root, "mujoco")
    ET.SubElement(
        extension, "compiler", strippath="false", fusestatic="false", discardvisual="false", balanceinertia="true"
    )
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    for shape in problem["scene"]:
        T = np.array(shape["pose"])
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, T[:3, :3].ravel())
        spec.worldbody.add_geom(
            name=shape["name"], type=GEOMS[shape["kind"]], size=sizes_of(shape), pos=T[:3, 3], quat=quaternion
        )
    bodies = {body.name for body in spec.bodies}
    disabled = ET.parse(robot["srdf"]).getroot().iter("disable_collisions")
    pairs = {tuple(sorted((d.get("link1"), d.get("link2")))) for d in disabled} | {tuple(p) for p in problem["allowed"]}
    for a, b in sorted(pairs):
        if a in bodies and b in bodies:
            spec.add_exclude(name=f"{a}-{b}", bodyname1=a, bodyname2=b)
    spec.bodies[-1].add_site(name="tip")
    return spec.compile()


def main() -> None:
    query = json.load(sys.stdin)
    for problem in query["problems"]:
        model = model_of(query["robot"], problem)
        names = list(problem["goal"])
        arm = Arm(model, names, ee_site="tip")
        data = mujoco.MjData(model)
        start, goal = (np.array([problem[what][name] for name in names]) for what in ("start", "goal"))
        for name, value in zip(names, start, strict=True):
            data.joint(name).qpos = value
        mujoco.mj_forward(model, data)
        config = CBiRRTConfig(timeout=query["time_limit"])
        plan(model, data, arm, start=start, goal=start, config=config, seed=0)  # the scene is built on its first use
        for seed in range(1, query["seeds"] + 1):
            begin = time.process_time()
            result = plan(model, data, arm, start=start, goal=goal, config=config, seed=seed)
            seconds = time.process_time() - begin
            path = np.array(result.path).tolist() if result.success else None
            if path is None:
                print(problem["name"], seed, result.failure_reason, result.backend, file=sys.stderr)
            print(json.dumps({"seconds": seconds, "path": path}))


if __name__ == "__main__":
    main()
