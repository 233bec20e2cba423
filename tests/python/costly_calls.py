"""Every call of the binary module whose cost grows with its arguments, with an argument so large that Ctrl-C comes in the middle.

Each is made in a child process; a second thread counts how much processor time passes between two of its own turns (the
longest: how long the call held the interpreter's lock) and then sends Ctrl-C, and the time until the call has ended is
taken. test_costly_calls.py compares the table with the stubs.

    python tests/python/costly_calls.py [NAME...]      what is measured of all, or of those
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import threading
import time
import types
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import argument_objects as ao
import long_work as lw
import mmgrasp as mg
from argument_objects import ARM, BOX, OBJECTS, POSE, Q
from costly_work import (
    CALL,
    CLOUD,
    DRIVEN,
    HUGE,
    assignment,
    base_regions,
    best_distance,
    blind_motion,
    checked_path,
    circle,
    cover,
    database,
    deep_image,
    depth_segments,
    derivative_free,
    evaluated,
    exact_stops,
    far_route,
    fine_bodies,
    fine_occupancy,
    fine_sdf,
    folder,
    followed,
    graspability,
    hull_faces,
    hull_mesh,
    integrated,
    loaded_sdf,
    long_chain,
    long_operation,
    many_bodies,
    many_grasps_of_nothing,
    many_grasps_that_fit,
    maximal,
    object_regions,
    octree_file,
    of,
    one_graspability,
    optimised,
    paired,
    placed_base,
    placement,
    points,
    policy,
    primitives,
    rays,
    registered,
    rendered,
    repeated,
    robot_file,
    robot_text,
    robust,
    routes,
    rows_of_arm,
    sampled_by_cups,
    sampled_grasps,
    saved_sdf,
    scene_file,
    scored,
    segmented,
    set_cover,
    shared,
    sharp_part,
    slab,
    sliding_box,
    solved_batch,
    stl,
    supported,
    synthesis,
    timed,
    tour,
    tracked,
    trajectory,
)
from mmgrasp import _core

BEGUN = 0.2  # [s] of processor time after which Ctrl-C comes
GIVEN_UP = 30  # [s] of processor time for one call and what it needs

CHECKER = OBJECTS["CollisionChecker"]
AHEAD = ARM.fk(Q + [0, 0, 0.2])
TURNED = POSE @ mg.pose([0, 0, 0], rpy=[0.4, 0.4, 0.4])  # within reach, not for three joints

COSTLY: dict[str, Callable[[], CALL]] = {
    "Robot.load": robot_file,
    "Robot.from_strings": robot_text,
    "compute_disabled_pairs": of(long_chain, lambda r: _core.compute_disabled_pairs(r, threads=1)),
    "with_sampled_pairs": of(long_chain, lambda r: _core.with_sampled_pairs(r)),
    "JointGroup.fk_batch": of(rows_of_arm, ARM.fk_batch),
    "JointGroup.jacobian_batch": of(rows_of_arm, ARM.jacobian_batch),
    "JointGroup.manipulability_batch": of(lambda: rows_of_arm(30_000_000), ARM.manipulability_batch),
    "JointGroup.ik": lambda: lambda: ARM.ik(TURNED, seed=Q, restarts=HUGE, time_limit=1000),
    "JointGroup.ik_all": lambda: lambda: ARM.ik_all(TURNED, count=10**6, restarts=HUGE, time_limit=1000),
    "Mesh.from_arrays": of(lambda: lw.grid(700), lambda m: mg.Mesh.from_arrays(*m)),
    "Mesh.load": of(stl, mg.Mesh.load),
    "_mesh_with_faults": of(stl, lambda path: repeated(100, lambda: _core._mesh_with_faults(path))()),
    "LinkShape.mesh": of(stl, mg.LinkShape.mesh),
    "LinkShape.surface": lambda: lambda: mg.LinkShape(mg.Sphere(0.5)).surface(1500),
    "World.add_mesh": scene_file,
    "World.add_octree": octree_file,
    "World.add_points": of(lambda: CLOUD(5_000_000), lambda p: mg.World().add_points("p", p, 0.0005)),
    "World.add_sdf": of(fine_sdf, lambda s: repeated(50, lambda: mg.World().add_sdf("s", s))()),
    "World.add_occupancy": of(fine_occupancy, lambda o: repeated(5000, lambda: mg.World().add_occupancy("o", o))()),
    "Voxels": of(lambda: CLOUD(20_000_000), lambda p: _core.Voxels(p, 0.0005)),
    "MeshDistanceField": of(lambda: slab(400), _core.MeshDistanceField),
    "DistanceField.distances": of(points, lambda p: ao.distance_field().distances(p)),
    "DistanceField.distances_and_gradients": of(points, lambda p: ao.distance_field().distances_and_gradients(p)),
    "CollisionChecker": of(slab, lambda m: lw.checker_of(m)()),
    "CollisionChecker.are_free": of(rows_of_arm, CHECKER().are_free),
    "CollisionChecker.check_edge": of(sliding_box, lambda s: s[0].check_edge(*s[1:], joint_step=2e-9)),
    "CollisionChecker.edge_is_free": of(sliding_box, lambda s: s[0].edge_is_free(*s[1:], joint_step=2e-9)),
    "ReachDatabase.build": lambda: lambda: mg.ReachDatabase.build(ARM, samples=2_000_000_000),
    "ReachDatabase.build_to": of(folder, lambda f: mg.ReachDatabase.build_to(f / "d", ARM, samples=2_000_000_000)),
    "ReachDatabase.build_parts": of(
        folder, lambda f: mg.ReachDatabase.build_parts(f, ARM, [0, 1, 2], samples=2_000_000_000)
    ),
    "ReachDatabase.load_or_build": of(folder, lambda f: mg.ReachDatabase.load_or_build(ARM, f, samples=2_000_000_000)),
    "ReachDatabase.solve_batch": solved_batch,
    "ReachDatabase.find_base_placement": placed_base,
    "ReachDatabase.base_poses_for": of(
        database, lambda d: d.base_poses_for(ARM, POSE, count=10**6, candidates=10**6, step=0.004, headings=100)
    ),
    "CapabilityMap.build": lambda: lambda: mg.base.CapabilityMap.build(ARM, voxel=0.05, threads=1),
    "CapabilityMap.score": scored,
    "CapabilityMap.best_base_distance": best_distance,
    "Roadmap.build": lambda: lambda: mg.planning.Roadmap.build(ARM, vertices=500_000),
    "ObjectRegions.compute": object_regions,
    "compute_base_regions": base_regions,
    "DepthImage.points": of(deep_image, lambda i: i.points()),
    "ProbabilisticSdf.integrate": lambda: integrated(lambda: mg.ProbabilisticSdf(voxel=0.0015)),
    "ProbabilisticSdf.cast_rays": rays,
    "ProbabilisticSdf.distances": of(points, ao.sdf_map().distances),
    "ProbabilisticSdf.query": of(points, lambda p: ao.sdf_map().query(p, threads=1)),
    "ProbabilisticSdf.mesh": of(fine_sdf, lambda s: [s.mesh() for _ in range(400)]),
    "ProbabilisticSdf.points": of(fine_sdf, lambda s: [s.points() for _ in range(50)]),
    "ProbabilisticSdf.obstacle_cells": of(fine_sdf, lambda s: [s.obstacle_cells() for _ in range(50)]),
    "ProbabilisticSdf.save": saved_sdf,
    "ProbabilisticSdf.load": loaded_sdf,
    "OccupancyMap.integrate": lambda: integrated(lambda: mg.mapping.OccupancyMap(resolution=0.01)),
    "OccupancyMap.query": of(points, ao.occupancy_map().query),
    "OccupancyMap.obstacle_cells": of(fine_occupancy, lambda o: [o.obstacle_cells() for _ in range(10_000)]),
    "JointTrajectory.to_csv": of(trajectory, lambda t: t.to_csv()),
    "Pipe.sample_grasps": lambda: (
        lambda: ao.pipe().sample_grasps(1_000_000, draws=1_000_000, length_spacing=1e-6, angle_spacing=1e-3)
    ),
    "SupportedFrame": supported,
    "ObjectPathEvaluator.evaluate": evaluated,
    "follow_object_path": followed,
    "_sample_grasps": lambda: sampled_grasps(_core._sample_grasps),
    "sample_grasps": lambda: sampled_grasps(mg.grasping.sample_grasps),
    "sample_suction_grasps": lambda: sampled_by_cups(),
    "cheapest_assignment": assignment,
    "cover_from_intersections": cover,
    "evaluate_graspability": graspability,
    "graspability_map": one_graspability,
    "hand_masks": lambda: lambda: mg.grasping.hand_masks(ao.gripper(), 0.05, 0.3, 1e-5),
    "fit_cuboids": of(
        lambda: CLOUD(3_000_000), lambda c: mg.mapping.fit_cuboids(c, leaf=0.002, cluster_tolerance=0.02)
    ),
    "fit_primitives": primitives,
    "inscribed_circle": circle,
    "jaw_grasps": of(
        slab, lambda m: _core.jaw_grasps(m, facet_angle=0.5, parallel_angle=0.5, directions=360, min_contact=1e-4)
    ),
    "planar_facets": of(slab, lambda m: _core.planar_facets(m)),
    "make_height_map": lambda: lw.WORK["make_height_map"].prepare(Path()),
    "maximal_intersections": maximal,
    "minimize_derivative_free": derivative_free,
    "operation_overlap": of(long_operation, lambda o: _core.operation_overlap(o)),
    "optimised_order": optimised,
    "paired_order": paired,
    "plan_base_route": far_route,
    "plan_cartesian": lambda: lambda: mg.plan_cartesian(CHECKER(), [POSE, AHEAD], near=Q, position_step=1e-12),
    "plan_straight_line": lambda: lambda: mg.planning.plan_straight_line(CHECKER(), Q, AHEAD, position_step=1e-12),
    "plan_motion": blind_motion,
    "plan_stops_exact": exact_stops,
    "random_placement": lambda: placement([BOX]),
    "read_pcd": of(lambda: lw.pcd_file(folder()), mg.mapping.read_pcd),
    "register_frame": registered,
    "render_depth": rendered,
    "resting_poses": sharp_part,
    "resting_poses, faces": hull_faces,
    "robust_intersections": robust,
    "route_lengths": routes,
    "run_policy": policy,
    "segment_depth_image": depth_segments,
    "segment_mesh": lambda: segmented(lambda m: mg.grasping.segment_mesh(m, threads=1)),
    "segment_objects": of(lambda: CLOUD(3_000_000), lambda c: mg.mapping.segment_objects(c, leaf=0.001, patch=0.01)),
    "shape_diameters": lambda: segmented(lambda m: mg.grasping.shape_diameters(m, threads=1)),
    "share_stops": shared,
    "shortest_visiting_tour": tour,
    "simplify_mesh": hull_mesh,
    "solve_set_cover": set_cover,
    "synthesize_grasps": synthesis,
    "time_parameterize": lambda: timed(mg.time_parameterize),
    "time_parameterize_free": lambda: (
        lambda: mg.planning.time_parameterize_free(CHECKER(), [Q, Q / 2], joint_step=1e-9)
    ),
    "track_base": tracked,
    "verify.check_path": checked_path,
    "verify.overlapping_bodies": many_bodies,
    "verify.overlapping_bodies, a fine mesh": fine_bodies,
    "fingers_meet": many_grasps_of_nothing,
    "fingers_fit": many_grasps_that_fit,
    **{name: of(ao.drive_by, call) for name, call in DRIVEN.items()},
}


class Measured(NamedTuple):
    """What became of one call: how it ended, and in processor time the longest turn without the interpreter's lock and the time from Ctrl-C to the end [s]."""

    name: str
    how: str
    gap: float
    reaction: float


_listening = [False]  # a late Ctrl-C is none


def _interrupt(number: int, frame: types.FrameType | None) -> None:
    if _listening[0]:
        raise KeyboardInterrupt


def _measure(name: str) -> Measured:
    call = COSTLY[name]()
    spent = sum(resource.getrusage(resource.RUSAGE_SELF)[:2])
    resource.setrlimit(resource.RLIMIT_CPU, (int(spent) + GIVEN_UP, resource.RLIM_INFINITY))
    begun = time.process_time()
    beats, sent = [begun], [0.0]
    _listening[0] = True

    def beat() -> None:
        while _listening[0]:
            time.sleep(0.003)
            beats.append(time.process_time())
            if not sent[0] and beats[-1] > begun + BEGUN:
                sent[0] = beats[-1]
                os.kill(os.getpid(), signal.SIGINT)

    watch = threading.Thread(target=beat)
    try:
        watch.start()
        call()
        how = "returned"
    except KeyboardInterrupt:
        how = "interrupted"
    except Exception as error:
        how = f"{type(error).__name__}: {error}"[:300]
    _listening[0] = False
    ended = time.process_time()
    watch.join()
    gaps = [b - a for a, b in zip(beats, [*beats[1:], ended], strict=True)]
    return Measured(name, how, max(gaps), ended - sent[0] if sent[0] else 0.0)


def _child(answers: str, names: list[str]) -> None:
    signal.signal(signal.SIGINT, _interrupt)
    with open(answers, "w", buffering=1) as out:
        for name in names:
            print(json.dumps(_measure(name)), file=out)
    os._exit(0)


def measured(names: list[str]) -> Iterator[Measured]:
    """What became of each call; one that does not end is told, too."""
    while names:
        with tempfile.NamedTemporaryFile("r") as answers:
            child = subprocess.run(
                [sys.executable, "-W", "ignore", __file__, "--child", answers.name, *names], capture_output=True
            )
            found = [Measured(*json.loads(line)) for line in answers.read().splitlines()]
        yield from found
        if len(found) < len(names):
            why = "did not hear Ctrl-C" if child.returncode == -signal.SIGXCPU else f"ended with {child.returncode}"
            if child.returncode > 0:
                why += ": " + child.stderr.decode()[-300:]
            yield Measured(names[len(found)], why, 0.0, 0.0)
            found.append(Measured("", "", 0, 0))
        names = names[len(found) :]


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        _child(sys.argv[2], sys.argv[3:])
    else:
        for one in measured(sys.argv[1:] or list(COSTLY)):
            print(f"{one.name:40} {one.how:20} {one.gap:6.2f} {one.reaction:6.2f}", flush=True)
