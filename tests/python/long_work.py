"""Calls with so much work that Ctrl-C comes in the middle, and a process that makes one (test_long_work.py).

python tests/python/long_work.py [NAME [MOMENT...]]      how long each takes to end, in processor time
"""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import mmgrasp as mg

REACTION_CAP = 5.0  # [s] of processor time: far above what is promised, far below what the calls take


def grid(side: int) -> tuple[np.ndarray, np.ndarray]:
    """A closed slab of about 4 side^2 triangles, bumpy on both sides."""
    x, y = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    bumps = np.random.default_rng(1).uniform(0, 0.4, (2, side, side))
    sheets = [np.stack([x, y, z], -1).reshape(-1, 3) for z in (bumps[0], -1 - bumps[1])]
    k = np.arange(side * side).reshape(side, side)
    a, b, c, d = k[:-1, :-1], k[1:, :-1], k[1:, 1:], k[:-1, 1:]
    up = np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    rim = np.concatenate([k[:-1, 0], k[-1, :-1], k[:0:-1, -1], k[0, :0:-1]])
    to = np.roll(rim, -1)
    below = side * side
    wall = np.concatenate([np.stack([rim + below, to + below, to], -1), np.stack([rim + below, to, rim], -1)])
    return 0.001 * np.concatenate(sheets), np.concatenate([up, up[:, ::-1] + below, wall])


def table_scan(points: int) -> np.ndarray:
    rng = np.random.default_rng(2)
    xyz = rng.uniform([-1, -1, 0], [1, 1, 0.002], (points, 3))
    on_box = rng.random(points) < 0.3
    xyz[on_box, 2] = 0.1 + 0.05 * np.sin(20 * xyz[on_box, 0]) * np.sin(20 * xyz[on_box, 1])
    return xyz


def stl_file(folder: Path) -> Path:
    vertices, triangles = grid(700)
    facets = np.zeros(len(triangles), np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")]))
    facets["v"] = vertices[triangles]
    path = folder / "slab.stl"
    path.write_bytes(bytes(80) + np.uint32(len(facets)).tobytes() + facets.tobytes())
    return path


def pcd_file(folder: Path) -> Path:
    xyz = table_scan(200_000)
    path = folder / "scan.pcd"
    head = f"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {20 * len(xyz)}\nHEIGHT 1\nPOINTS {20 * len(xyz)}\nDATA ascii\n"
    path.write_text(head + 20 * "".join(f"{x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in xyz))
    return path


def checker_of(mesh: mg.Mesh) -> Callable[[], Any]:
    robot = mg.Robot.from_strings('<robot name="r"><link name="a"/><link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint></robot>')  # fmt: skip
    group = robot.group(base_link="a", tip="b")

    def make() -> Any:
        # A moved copy each time: what was made of a mesh is kept.
        world = mg.World()
        world.add("slab", mg.Mesh.from_arrays(mesh.vertices, mesh.triangles))
        return mg.CollisionChecker(robot, world, group)

    return make


def ball(triangles: int) -> mg.Mesh:
    return mg.LinkShape(mg.Sphere(0.5)).surface(int(np.sqrt(triangles)))


class Work(NamedTuple):
    prepare: Callable[[Path], Callable[[], Any]]
    moments: tuple[float, ...] = (0.1, 0.7, 2.0)  # [s] of processor time after the call began


def _segment(folder: Path) -> Callable[[], Any]:
    cloud = table_scan(3_000_000)
    return lambda: mg.mapping.segment_objects(cloud, leaf=0.001, patch=0.01)


def _segment_up(folder: Path) -> Callable[[], Any]:
    cloud = table_scan(3_000_000)
    return lambda: mg.mapping.segment_objects(
        cloud, up=[0, 0, 1], leaf=0.001, plane_iterations=10**6, min_plane_share=0.9
    )


def _fit(folder: Path) -> Callable[[], Any]:
    cloud = table_scan(3_000_000)
    return lambda: mg.mapping.fit_cuboids(cloud, leaf=0.002, cluster_tolerance=0.02)


def _assign(folder: Path) -> Callable[[], Any]:
    costs = np.random.default_rng(3).random((4000, 4000)) + np.arange(4000) * np.arange(4000)[:, None] * 1e-6
    return lambda: mg.optim.cheapest_assignment(costs)


def _arrays(folder: Path) -> Callable[[], Any]:
    vertices, triangles = grid(700)
    return lambda: mg.Mesh.from_arrays(vertices, triangles)


def _load(folder: Path) -> Callable[[], Any]:
    path = stl_file(folder)
    return lambda: mg.Mesh.load(path)


def _decimate(folder: Path) -> Callable[[], Any]:
    mesh = mg.Mesh.from_arrays(*grid(400))
    return lambda: mg.collision.simplify_mesh(mesh, tolerance=0.0005)


def _hull(folder: Path) -> Callable[[], Any]:
    on_sphere = np.random.default_rng(4).normal(size=(300_000, 3))
    on_sphere /= np.linalg.norm(on_sphere, axis=1)[:, None]
    triangles = np.arange(300_000).reshape(-1, 3)
    mesh = mg.Mesh.from_arrays(on_sphere, triangles)
    return lambda: mg.collision.simplify_mesh(mesh, tolerance=0.01)


def _checker(folder: Path) -> Callable[[], Any]:
    return checker_of(mg.Mesh.from_arrays(*grid(700)))


def _points(folder: Path) -> Callable[[], Any]:
    cloud = table_scan(5_000_000)

    def add() -> None:
        mg.World().add_points("scan", cloud, 0.0005)

    return add


def _pcd(folder: Path) -> Callable[[], Any]:
    path = pcd_file(folder)
    return lambda: mg.mapping.read_pcd(path)


def _height_map(folder: Path) -> Callable[[], Any]:
    camera = mg.mapping.PinholeCamera(width=3000, height=2000, fx=2000.0, fy=2000.0, cx=1500.0, cy=1000.0)
    depth = np.zeros((2000, 3000), np.float32)
    depth[0, 0] = 1.0  # all others are a hole
    image = mg.mapping.DepthImage(depth, camera)
    return lambda: mg.mapping.make_height_map(image, mg.pose([0, 0, 0]), [2.0, 2.0], hole_radius=2_000_000_000)


WORK: dict[str, Work] = {
    "segment_objects": Work(_segment),
    "segment_objects, many planes": Work(_segment_up),
    "fit_cuboids": Work(_fit),
    "cheapest_assignment": Work(_assign),
    "Mesh.from_arrays": Work(_arrays, (0.1, 0.5, 1.0)),
    "Mesh.load": Work(_load, (0.1, 0.5, 1.0)),
    "simplify_mesh, decimated": Work(_decimate),
    "simplify_mesh, hull": Work(_hull),
    "CollisionChecker": Work(_checker),
    "World.add_points": Work(_points, (0.1, 0.3, 0.5)),
    "read_pcd": Work(_pcd, (0.1, 0.3, 0.6)),
    "make_height_map": Work(_height_map),
}


def _child(name: str, folder: str, moments: list[float]) -> None:
    """Makes the call once for each moment and prints when it began and how it ended, in processor time."""
    call = WORK[name].prepare(Path(folder))
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for _ in moments:
        try:
            print(json.dumps(["began", time.process_time()]), flush=True)
            call()
            print(json.dumps(["returned", time.process_time()]), flush=True)
        except KeyboardInterrupt:
            print(json.dumps(["interrupted", time.process_time()]), flush=True)


def _processor_time(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def reactions(name: str, folder: Path, moments: tuple[float, ...] = ()) -> list[tuple[float, str, float]]:
    """(moment, how the call ended, processor time from Ctrl-C to the end [s]) of each moment."""
    moments = moments or WORK[name].moments
    child = subprocess.Popen(
        [sys.executable, __file__, "--child", name, str(folder), *map(str, moments)], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    found = []
    for moment in moments:
        began = json.loads(child.stdout.readline())[1]
        is_over = False  # before the signal came
        while not is_over and _processor_time(child.pid) < began + moment:
            is_over = bool(select.select([child.stdout], [], [], 0.01)[0])
        sent = _processor_time(child.pid)
        if not is_over:
            child.send_signal(signal.SIGINT)
        how, ended = json.loads(child.stdout.readline())
        found.append((moment, how, ended - sent))
        if how == "returned":
            break
    child.kill()
    child.communicate()
    return found


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        _child(sys.argv[2], sys.argv[3], [float(a) for a in sys.argv[4:]])
    else:
        import tempfile

        for chosen in sys.argv[1:2] or list(WORK):
            with tempfile.TemporaryDirectory() as there:
                for row in reactions(chosen, Path(there), tuple(float(a) for a in sys.argv[2:])):
                    print(chosen, *row, flush=True)
