"""Arguments so large that a call takes long, and calls with them: what the table of costly_calls.py is made of."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import argument_objects as ao
import long_work as lw
import mmgrasp as mg
from argument_objects import ARM, BOX, POSE, Q
from mmgrasp import _core
from mmgrasp._progress import Progress

CALL = Callable[[], Any]
HUGE = 2_000_000_000  # the most that is counted

rng = np.random.default_rng(1)


def rows_of_arm(count: int = 3_000_000) -> np.ndarray:
    return np.tile(Q, (count, 1))


def points(count: int = 8_000_000) -> np.ndarray:
    return rng.uniform(-1, 1, (count, 3))


def slab(side: int = 500) -> mg.Mesh:
    return mg.Mesh.from_arrays(*lw.grid(side))


def long_operation() -> mg.gripper_design.AssemblyOperation:
    """A part that slides through another one in small steps."""
    design, mesh = mg.gripper_design, slab(300)
    path = [mg.pose([0, 0, 0.5 * i / 100_000]) for i in range(100_000)]
    return design.AssemblyOperation(
        [design.PlacedMesh("part", mesh)], [design.PlacedMesh("other", mesh, mg.pose([0.3, 0, -1e-3]))], path
    )


def on_sphere(count: int = 300_000) -> mg.Mesh:
    corners = rng.normal(size=(count, 3))
    corners /= np.linalg.norm(corners, axis=1)[:, None]
    return mg.Mesh.from_arrays(corners, np.arange(count).reshape(-1, 3))


def folder() -> Path:
    return Path(tempfile.mkdtemp())


def database() -> mg.ReachDatabase:
    return mg.ReachDatabase.build(ARM, samples=300_000, threads=1)


def masks(count: int, side: int, share: float, seed: int = 2) -> list[np.ndarray]:
    random = np.random.default_rng(seed)
    return [(random.random((1, side, side)) < share).astype(np.uint8) for _ in range(count)]


def square(side: int) -> mg.base.BaseGrid:
    return mg.base.BaseGrid([0.0, 0.0], 0.05, side, side, [0.0])


def robust() -> CALL:
    regions = masks(16, 60, 0.999)
    return lambda: _core.robust_intersections(square(60), regions, 0.02, 10_000_000)


def maximal() -> CALL:
    regions = masks(60, 300, 0.9)
    return lambda: _core.maximal_intersections(square(300), regions, 0.02)


def exact_stops() -> CALL:
    regions = masks(60, 300, 0.9)
    return lambda: _core.plan_stops_exact(square(300), regions, 0.02, time_limit=1000)


def optimised() -> CALL:
    cells = [masks(60, 200, 0.9, tray) for tray in range(2)]
    orders = [list(range(60))] * 2
    return lambda: _core.optimised_order(square(200), cells, [[0, 1]], orders)


def policy() -> CALL:
    cells = [masks(30, 200, 0.9, tray) for tray in range(4)]
    return lambda: _core.run_policy(square(200), cells, [list(range(30))] * 4, time_limit=1000)


def cover() -> CALL:
    regions = [mg.base.BaseRegion(str(i), cells, square(40)) for i, cells in enumerate(masks(60, 40, 0.5))]
    found = _core.robust_intersections(square(40), regions, 0.02, 3_000).robust
    return lambda: [_core.cover_from_intersections(square(40), found, 60) for _ in range(10_000)]


def circle() -> CALL:
    cells = masks(1, 2500, 0.9999)[0]
    return lambda: _core.inscribed_circle(square(2500), cells)


def paired() -> CALL:
    places = [rng.random((1500, 2)) for _ in range(3)]
    return lambda: _core.paired_order(places)


def shared() -> CALL:
    times = rng.uniform(1, 2, (1020, 1020))
    return lambda: _core.share_stops(times, [1.0] * 1000, 10)


def tour() -> CALL:
    lengths = rng.uniform(1, 2, (1202, 1202))
    return lambda: _core.shortest_visiting_tour(lengths)


def assignment() -> CALL:
    costs = rng.random((4000, 4000)) + np.arange(4000) * np.arange(4000)[:, None] * 1e-6
    return lambda: _core.cheapest_assignment(costs)


def set_cover() -> CALL:
    sets = [[i % 300, *np.random.default_rng(i).integers(0, 300, 11).tolist()] for i in range(900)]
    return lambda: _core.solve_set_cover(300, sets, time_limit=1000)


def stl() -> Path:
    return lw.stl_file(folder())


def urdf() -> str:
    return f"<robot name='r'><link name='a'><collision><geometry><mesh filename='file://{stl()}'/></geometry></collision></link></robot>"


def robot_file() -> CALL:
    path = folder() / "r.urdf"
    path.write_text(urdf())
    return lambda: mg.Robot.load(path)


def robot_text() -> CALL:
    text = urdf()
    return lambda: mg.Robot.from_strings(text)


def long_chain() -> mg.Robot:
    link = "<link name='l{}'><collision><geometry><box size='0.01 0.01 0.03'/></geometry></collision></link>"
    joint = "<joint name='j{}' type='revolute'><parent link='l{}'/><child link='l{}'/><origin xyz='0 0 0.04'/><axis xyz='1 0 0'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint>"  # fmt: skip
    links = "".join(link.format(i) for i in range(200))
    return mg.Robot.from_strings(
        f"<robot name='r'>{links}{''.join(joint.format(i, i, i + 1) for i in range(199))}</robot>"
    )


def deep_image(width: int = 4000, height: int = 3000) -> mg.mapping.DepthImage:
    camera = mg.mapping.PinholeCamera(width=width, height=height, fx=3000.0, fy=3000.0, cx=width / 2, cy=height / 2)
    return mg.mapping.DepthImage(np.full((height, width), 0.5, np.float32), camera)


def fine_sdf() -> mg.ProbabilisticSdf:
    sdf = mg.ProbabilisticSdf(voxel=0.0015)
    image = deep_image(1200, 900)
    sdf.integrate(image, mg.mapping.DepthCamera(image.camera, mg.mapping.DepthNoise(constant=0.001)))
    return sdf


def fine_occupancy() -> mg.mapping.OccupancyMap:
    occupancy = mg.mapping.OccupancyMap(resolution=0.002)
    image = deep_image(600, 450)
    occupancy.integrate(image, mg.mapping.DepthCamera(image.camera, mg.mapping.DepthNoise(constant=0.001)))
    return occupancy


def integrated(make: Callable[[], Any]) -> CALL:
    image, target = deep_image(), make()
    camera = mg.mapping.DepthCamera(image.camera, mg.mapping.DepthNoise(constant=0.001))
    return lambda: target.integrate(image, camera)


def rays() -> CALL:
    sdf, origins = ao.sdf_map(), points(3_000_000)
    directions = origins / np.linalg.norm(origins, axis=1)[:, None]
    return lambda: sdf.cast_rays(origins, directions, threads=1)


def rendered() -> CALL:
    camera = mg.mapping.PinholeCamera(width=4000, height=4000, fx=2000.0, fy=2000.0, cx=2000.0, cy=2000.0)
    scene = [mg.LinkShape(on_sphere(3000))]
    return lambda: mg.mapping.render_depth(scene, camera, np.eye(4), threads=1)


def height_map(side: int = 1500) -> mg.mapping.HeightMap:
    heights = np.random.default_rng(5).uniform(0, 0.05, (side, side)).astype(np.float32)
    return mg.mapping.HeightMap(heights, 0.0005)


def graspability() -> CALL:
    heights, hand = height_map(), ao.gripper()
    return lambda: mg.grasping.evaluate_graspability(heights, hand, threads=1)


def one_graspability() -> CALL:
    heights, hand = height_map(3000), ao.gripper()
    return lambda: mg.grasping.graspability_map(heights, hand, 0.3, 0.05, 0.01, threads=1)


def placement(part: list[mg.LinkShape]) -> CALL:
    return lambda: mg.mapping.random_placement(part, [0.6, 0.4, 0.2], count=1000, draws=1_000_000)


def sharp_part() -> CALL:
    part = [mg.LinkShape(on_sphere())]
    return lambda: mg.mapping.resting_poses(part)


def hull_faces() -> CALL:
    part = [mg.LinkShape(on_sphere(30_000))]
    return lambda: mg.mapping.resting_poses(part)


def sampled_grasps(call: Callable[..., Any]) -> CALL:
    part, hand = [mg.LinkShape(slab(300))], ao.gripper()
    return lambda: call(part, hand, mesh_samples=100_000, approaches=10)


def sampled_by_cups() -> CALL:
    cups = mg.grasping.Suction([mg.grasping.SuctionCup([0.03 * i, 0, 0], 0.01) for i in range(20)])
    hand = mg.Hand.of_cups("tool", approach=[0, 0, 1], suction=cups)
    part = [mg.LinkShape(slab(300))]
    return lambda: mg.grasping.sample_suction_grasps(part, hand, turns=10, surface_samples=100_000)


def many_grasps_of_nothing() -> CALL:
    hand = ao.gripper()
    grasps = [mg.Grasp(mg.pose([9, 0, 0]), 0.02)] * 1_000_000
    return lambda: mg.grasping.fingers_meet(ao.ARM, hand, [BOX], grasps)


def many_grasps_that_fit() -> CALL:
    hand = ao.gripper()
    grasps = [mg.Grasp(mg.pose([9, 0, 0]), 0.02)] * 1_000_000
    return lambda: mg.grasping.fingers_fit(ao.ARM, hand, [BOX], grasps)


def many_bodies() -> CALL:
    bodies = [
        _core.verify.CheckedBody(str(i), [BOX], mg.pose([0.2 * (i % 200), 0.2 * (i // 200), 0])) for i in range(40_000)
    ]
    return lambda: _core.verify.overlapping_bodies(bodies)


def fine_bodies() -> CALL:
    bodies = [_core.verify.CheckedBody(name, [mg.LinkShape(slab(700))], np.eye(4)) for name in "ab"]
    return lambda: _core.verify.overlapping_bodies(bodies)


def checked_path() -> CALL:
    path = np.array([Q, -Q])
    return lambda: _core.verify.check_path(ao.ROBOT, ["i", "j", "k"], path, [], joint_step=1e-7)


def moved_object(poses: int) -> mg.grasping.ObjectPathProblem:
    path = np.tile(POSE, (poses, 1, 1))
    return mg.grasping.ObjectPathProblem(ARM, ao.world(), [BOX], path)


def evaluated() -> CALL:
    evaluator = mg.grasping.ObjectPathEvaluator(moved_object(20_000))
    return lambda: evaluator.evaluate(mg.Grasp(np.eye(4)))


def followed() -> CALL:
    problem = moved_object(20_000)
    return lambda: mg.grasping.follow_object_path(problem, mg.Grasp(np.eye(4)))


def frame(nodes: int) -> mg.grasping.BeamFrame:
    corners = np.stack([np.arange(nodes) * 0.1, np.zeros(nodes), np.zeros(nodes)], axis=1)
    section, material = mg.grasping.round_section(0.01), mg.grasping.copper()
    return mg.grasping.BeamFrame(
        corners, [mg.grasping.BeamMember(i, i + 1, section, material) for i in range(nodes - 1)]
    )


def supported() -> CALL:
    given = frame(1500)
    return lambda: [mg.grasping.SupportedFrame(given, mg.grasping.BeamSupport(0, 0.0)) for _ in range(50)]


def trajectory(samples: int = 2_000_000) -> mg.planning.JointTrajectory:
    return mg.planning.JointTrajectory(["i", "j", "k"], np.arange(samples) * 0.01, rng.random((samples, 3)))


def capability(tips: int) -> tuple[mg.base.CapabilityMap, np.ndarray]:
    return ao.capability_map(), np.tile(POSE, (tips, 1, 1))


def scored() -> CALL:
    found, tips = capability(500_000)
    return lambda: found.score(tips)


def best_distance() -> CALL:
    found, tips = capability(20_000)
    return lambda: found.best_base_distance(tips, np.linspace(0.1, 2, 2000).tolist())


def solved_batch() -> CALL:
    found, tips = database(), np.tile(POSE, (200_000, 1, 1))
    return lambda: found.solve_batch(ARM, tips, threads=1)


def placed_base() -> CALL:
    found, tips = database(), np.tile(POSE, (3000, 1, 1))
    return lambda: found.find_base_placement(ARM, tips, step=0.005, headings=100, threads=1)


def base_regions() -> CALL:
    problem, found = ao.part_supply_problem(), database()
    grid = mg.base.BaseGrid([-2.0, -2.0], 0.001, 4000, 4000)
    return lambda: mg.base.compute_base_regions(problem, found, grid)


def sliding_box() -> tuple[mg.CollisionChecker, np.ndarray, np.ndarray]:
    """A box that slides 1e-7 m above a floor: what is proven of the edge at once is as short as that."""
    robot = mg.Robot.from_strings(
        """<robot name="r"><link name="o"/><link name="a"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
<joint name="i" type="prismatic"><parent link="o"/><child link="a"/><axis xyz="1 0 0"/><limit lower="0" upper="1" velocity="1"/></joint></robot>"""
    )
    world = mg.World()
    world.add_box("floor", [3, 3, 0.1], mg.pose([0, 0, -0.1 - 1e-7]))
    return mg.CollisionChecker(robot, world, robot.group(base_link="o", tip="a")), np.zeros(1), np.ones(1)


def object_regions() -> CALL:
    problem, found = ao.part_supply_problem(), database()
    grid = mg.base.BaseGrid([-2.0, -2.0], 0.001, 4000, 4000)
    return lambda: mg.base.ObjectRegions.compute(problem, found, grid)


def routes() -> CALL:
    positions = np.column_stack([rng.uniform(-20, 20, (300, 2)), np.zeros(300)])
    return lambda: mg.base.route_lengths(ARM, ao.world(), home=Q, positions=positions, threads=1)


def far_route() -> CALL:
    world = ao.world()
    for i, (x, y, size) in enumerate([(8, 0, (0.2, 16, 2)), (-8, 0, (0.2, 16, 2)), (0, 8, (16, 0.2, 2)), (0, -8, (16, 0.2, 2))]):  # fmt: skip
        world.add_box(f"wall {i}", size, mg.pose([x, y, 1]))
    return lambda: mg.base.plan_base_route(ARM, world, home=Q, start=[0, 0, 0], goal=[12, 0, 0], resolution=0.01)


def blind_motion(progress: Progress = None) -> CALL:
    """The square post cannot turn between the walls beside it, so no motion leads from one quarter turn to the next."""
    world = mg.World()
    for side in (-1, 1):
        world.add_box(f"wall {side}", [0.01, 0.4, 0.6], mg.pose([side * 0.062, 0, 0]))
    checker = mg.CollisionChecker(ao.ROBOT, world, ARM)
    return lambda: mg.plan_motion(
        checker,
        start=[0, 0.5, 0.5],
        goal=[np.pi / 2, 0.5, 0.5],
        time_limit=1000,
        max_iterations=HUGE,
        progress=progress,
    )


def derivative_free() -> CALL:
    def slow(x: np.ndarray) -> float:
        spread = np.linalg.svd(np.sin(np.outer(x, np.arange(200))), compute_uv=False)
        return float(np.sum(spread) + x @ x)

    return lambda: mg.optim.minimize_derivative_free(
        slow, np.full(40, 0.5), np.full(40, -1), np.ones(40), max_evaluations=10**8, tolerance=1e-300
    )


def segmented(call: Callable[[Any], Any]) -> CALL:
    mesh = slab(250)
    return lambda: call(mesh)


def primitives() -> CALL:
    mesh = slab(300)
    labels = np.arange(len(mesh.triangles)) // 100
    return lambda: mg.grasping.fit_primitives(mesh, labels)


def registered() -> CALL:
    image = deep_image(2000, 1500)
    camera = mg.mapping.DepthCamera(image.camera, mg.mapping.DepthNoise(constant=0.001))
    sdf = fine_sdf()
    return lambda: [
        _core.register_frame(sdf, image, camera, pose_covariance=1e-6 * np.eye(6), max_points=HUGE, threads=1)
        for _ in range(20)
    ]


def synthesis() -> CALL:
    return lambda: mg.synthesize_grasps(ao.wall_map(), ao.gripper(), samples=1_000_000, threads=1)


def timed(call: Callable[..., Any]) -> CALL:
    path = np.cumsum(rng.normal(size=(20_000, 3)) / 10, axis=0)
    return lambda: call(path, [1] * 3, [1] * 3, jerk_limits=[1] * 3)


def tracked() -> CALL:
    given = mg.planning.JointTrajectory(["x", "y", "theta"], [0.0, 1e4], np.zeros((2, 3)))
    return lambda: mg.base.track_base(ao.ROBOT, given, period=0.01)


def hull_mesh() -> CALL:
    mesh = on_sphere()
    return lambda: mg.collision.simplify_mesh(mesh, tolerance=0.01)


def scene_file() -> CALL:
    path = stl()
    return lambda: mg.World().add_mesh("m", path)


def octree_file() -> CALL:
    path = folder() / "map.ot"
    fine_occupancy().save(path)
    return repeated(5000, lambda: mg.World().add_octree("m", path))


def depth_segments() -> CALL:
    image = deep_image(4000, 3000)
    return lambda: mg.mapping.segment_depth_image(image, up=[0, 0, -1], leaf=0.001)


CLOUD = lw.table_scan
DRIVEN: dict[str, Callable[[mg.planning.DriveByResult], Any]] = {
    "DriveByResult.to_csv": lambda d: d.to_csv(between=20_000),
    "WholeBodyTrajectory.sampled": lambda d: d.trajectory.sampled(between=50_000),
    "WholeBodyTrajectory.rolled_out": lambda d: repeated(
        20, lambda: d.trajectory.rolled_out(1_000_000 // len(d.trajectory.times))
    )(),
    "WholeBodyTrajectory.to_csv": lambda d: d.trajectory.to_csv(between=20_000),
    "RobotMotion.of_drive_by": lambda d: repeated(20, lambda: mg.planning.RobotMotion.of_drive_by(d, period=1e-4))(),
}


def saved_sdf() -> CALL:
    sdf, path = fine_sdf(), folder() / "map.sdf"
    return repeated(200, lambda: sdf.save(path))


def loaded_sdf() -> CALL:
    path = folder() / "map.sdf"
    fine_sdf().save(path)
    return lambda: [mg.ProbabilisticSdf.load(path, threads=1) for _ in range(200)]


def repeated(count: int, call: Callable[[], object]) -> CALL:
    def calls() -> None:
        for _ in range(count):
            call()

    return calls


def of(make: Callable[[], Any], call: Callable[[Any], Any]) -> Callable[[], CALL]:
    """What is made beforehand, and the call with it."""

    def prepare() -> CALL:
        made = make()
        return lambda: call(made)

    return prepare
