"""Inverse kinematics by baselines that are Python packages, on the poses and seeds of bench_ik.

    python benchmarks/core/baselines_ik.py [BENCH_IK [POSES]]

bench_ik (default: benchmarks/bench_ik below the working directory) writes the poses, the baselines answer them through their
compiled solvers (only the first POSES of the 10,000 when given), one call a pose, and bench_ik judges the answers with KDL and prints the lines. The time of a call
contains Python's call into the solver, about 1 us.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np

DATA = Path(__file__).resolve().parents[2] / "../shared/data/robots"
ROBOTS = {
    "panda": (DATA / "panda/moveit_resources_panda_description/urdf/panda.urdf", "panda_link0", "panda_link8"),
    "ur5": (DATA / "ur5_vamp/ur5/ur5.urdf", "base_link", "ee_link"),
}
BRANCH_POSES = 2000


def origin(element: ElementTree.Element) -> np.ndarray:
    """A joint's <origin> as a matrix."""
    tag = element.find("origin")
    numbers = {"xyz": "0 0 0", "rpy": "0 0 0"} | (tag.attrib if tag is not None else {})
    r, p, y = (float(v) for v in numbers["rpy"].split())
    cr, sr, cp, sp, cy, sy = np.cos(r), np.sin(r), np.cos(p), np.sin(p), np.cos(y), np.sin(y)
    T = np.eye(4)
    T[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    T[:3, 3] = [float(v) for v in numbers["xyz"].split()]
    return T


def chain(urdf: Path, base: str, tip: str) -> list[ElementTree.Element]:
    """The joints from base to tip."""
    parents = {
        j.find("child").get("link"): j
        for j in ElementTree.parse(urdf).getroot().iter("joint")
        if j.find("child") is not None
    }
    joints = []
    while tip != base:
        joints.insert(0, parents[tip])
        tip = joints[0].find("parent").get("link")
    return joints


def rtb_solver(urdf: Path, base: str, tip: str):
    """roboticstoolbox's compiled Levenberg-Marquardt with its restarts and joint limits."""
    import roboticstoolbox as rtb

    ets = rtb.ETS()
    count = 0
    for joint in chain(urdf, base, tip):
        ets = ets * rtb.ETS([rtb.ET.SE3(origin(joint))])
        if joint.get("type") == "revolute":
            axis = [float(v) for v in joint.find("axis").get("xyz").split()]
            k = int(np.argmax(np.abs(axis)))
            limit = [float(joint.find("limit").get(end)) for end in ("lower", "upper")]
            make = (rtb.ET.Rx, rtb.ET.Ry, rtb.ET.Rz)[k]
            ets = ets * rtb.ETS([make(flip=axis[k] < 0, qlim=limit, jindex=count)])
            count += 1
    settings = "method chan, k 1, ilimit 30, slimit 100, tol 5e-11 (1e-5 m), joint_limits"

    def solve(T: np.ndarray, seed: np.ndarray):
        found = ets.ik_LM(T, q0=seed, tol=5e-11)
        return found.q if found.success else None

    return settings, solve


def trac_solver(urdf: Path, base: str, tip: str):
    """TRAC-IK, solve type Speed."""
    import pytracik
    from trac_ik import TracIK

    solver = TracIK(base, tip, str(urdf), timeout=0.02, epsilon=1e-5)
    # The wrapper reads zero limits from these URDFs.
    limits = [j.find("limit") for j in chain(urdf, base, tip) if j.get("type") == "revolute"]
    lower, upper = ([float(limit.get(end)) for limit in limits] for end in ("lower", "upper"))
    pytracik.set_joint_limits(solver._ik_solver, np.array(lower), np.array(upper))

    def solve(T: np.ndarray, seed: np.ndarray):
        return solver.ik(T[:3, 3], T[:3, :3], seed)

    return "solve type Speed, epsilon 1e-5, timeout 20 ms, limits of the URDF", solve


def answer(folder: Path, name: str, key: str, who: str, solver, poses: int) -> None:
    """Writes one line a pose: time [us], configuration (nothing when there is none)."""
    settings, solve = solver
    table = np.loadtxt(folder / f"{name}.poses")[:poses]
    lines = [f"# {who}|{settings}"]
    for row in table:
        T, seed = row[:16].reshape(4, 4), row[16:].copy()
        start = time.perf_counter()
        q = solve(T, seed)
        elapsed = 1e6 * (time.perf_counter() - start)
        lines.append(" ".join(f"{v:.17g}" for v in [elapsed, *([] if q is None else q)]))
    (folder / f"{name}.{key}.answers").write_text("\n".join(lines) + "\n")


def write_urdf(path: Path, module) -> None:
    """The chain of a prebuilt ssik arm, so that both programs solve exactly the same arm."""
    lines = ["<robot name='arm'>"] + [f"<link name='l{i}'/>" for i in range(module.DOF + 2)]
    before = np.eye(4)

    def origin_tag(T: np.ndarray) -> str:
        R = T[:3, :3]
        rpy = (
            np.arctan2(R[2, 1], R[2, 2]),
            np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0])),
            np.arctan2(R[1, 0], R[0, 0]),
        )
        if np.hypot(R[0, 0], R[1, 0]) < 1e-9:
            rpy = 0.0, rpy[1], np.arctan2(-R[0, 1], R[1, 1])
        text = [" ".join(f"{v:.17g}" for v in triple) for triple in (T[:3, 3], rpy)]
        return f"<origin xyz='{text[0]}' rpy='{text[1]}'/>"

    for i, joint in enumerate(module._KB.joints):
        axis = " ".join(f"{v:.17g}" for v in joint.axis)
        lower, upper = (f"{v:.17g}" for v in joint.limits)
        lines.append(
            f"<joint name='j{i}' type='revolute'><parent link='l{i}'/><child link='l{i + 1}'/>{origin_tag(before @ joint.T_left)}"
            f"<axis xyz='{axis}'/><limit lower='{lower}' upper='{upper}' velocity='1' effort='1'/></joint>"
        )
        before = joint.T_right
    n = module.DOF
    lines.append(
        f"<joint name='flange' type='fixed'><parent link='l{n}'/><child link='l{n + 1}'/>{origin_tag(before)}</joint></robot>"
    )
    path.write_text("\n".join(lines))


def branches(folder: Path, name: str, module, poses: int, windings: bool) -> None:
    """ssik: one line a branch: number of the pose, the pose, time of the call [us], configuration."""
    rng = np.random.default_rng(2026)
    lower, upper = np.array(module._JOINT_LIMITS).T
    lines = [
        "# ssik|prebuilt arm, native solver, limits respected, "
        + (
            "every winding (enumerate_windings on)"
            if windings
            else "one representative a branch (enumerate_windings off)"
        )
    ]
    for i in range(poses):
        T = np.asarray(module.fk(rng.uniform(lower, upper)))
        start = time.perf_counter()
        found = module.solve(T, enumerate_windings=windings)
        elapsed = 1e6 * (time.perf_counter() - start)
        for q in [s.q for s in found] or [[]]:
            lines.append(" ".join(f"{v:.17g}" for v in [i, *T.ravel(), elapsed, *q]))
    (folder / f"{name}.ssik.{'windings' if windings else 'branches'}").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Measures and prints."""
    program = Path(sys.argv[1] if len(sys.argv) > 1 else "benchmarks/bench_ik").absolute()
    poses = int(sys.argv[2]) if len(sys.argv) > 2 else 10_000
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([program, "--poses", folder], check=True)
        for robot, model in ROBOTS.items():
            answer(folder, robot, "rtb", "roboticstoolbox ik_LM", rtb_solver(*model), poses)
            answer(folder, robot, "trac", "TRAC-IK", trac_solver(*model), poses)
        from ssik.prebuilt import franka_panda_ik
        from ssik.prebuilt.universal_robots import ur5_ik

        for robot, module in {"panda": franka_panda_ik, "ur5": ur5_ik}.items():
            write_urdf(folder / f"{robot}.urdf", module)
            branches(folder, robot, module, min(poses, BRANCH_POSES), windings=False)
        # The only one of the two whose limits leave room for a second turn.
        branches(folder, "ur5", ur5_ik, min(poses, BRANCH_POSES), windings=True)
        sys.stdout.flush()
        subprocess.run([program, "--answers", folder], check=True)
        subprocess.run([program, "--branches", folder], check=True)


if __name__ == "__main__":
    main()
