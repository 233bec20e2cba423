"""Maps of depth cameras as obstacles, through the Python door."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg
from camera_poses import look_at
from conftest import REPOSITORY

INTRINSICS = mg.mapping.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)
CAMERA = mg.mapping.DepthCamera(INTRINSICS, mg.mapping.DepthNoise(constant=0.001))
TOP = 0.0402  # of the box, between two layers of voxels
SCENE = [
    mg.LinkShape(mg.Box([0.3, 0.3, 0.02]), mg.pose([0, 0, -0.0098])),
    mg.LinkShape(mg.Box([0.06, 0.05, 0.04]), mg.pose([0, 0, TOP - 0.02])),
]
# A small box that slides along x, y and z.
SLIDER = """<robot name="slider"><link name="root"/><link name="a"/><link name="b"/>
<link name="probe"><collision><geometry><box size="0.002 0.002 0.002"/></geometry></collision></link>
<joint name="x" type="prismatic"><parent link="root"/><child link="a"/><axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="y" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="z" type="prismatic"><parent link="b"/><child link="probe"/><axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
</robot>"""
ROBOT = mg.Robot.from_strings(SLIDER)
ARM = ROBOT.group(base_link="root", tip="probe")
EYES = [[0.0, 0.0, 0.35], [0.02, 0.01, 0.35], [-0.03, 0.02, 0.36]]


def frame(eye: list[float]) -> mg.mapping.DepthImage:
    return mg.mapping.render_depth(SCENE, INTRINSICS, mg.mapping.look_down(eye))


def free(world: mg.World, x: float, y: float, z: float) -> bool:
    return mg.CollisionChecker(ROBOT, world, group=ARM).is_free([x, y, z])


@pytest.fixture(scope="module")
def sdf() -> mg.ProbabilisticSdf:
    sdf = mg.ProbabilisticSdf(voxel=0.002)
    for eye in EYES:
        sdf.integrate(frame(eye), CAMERA)
    return sdf


@pytest.fixture(scope="module")
def occupancy() -> mg.mapping.OccupancyMap:
    occupancy = mg.mapping.OccupancyMap(resolution=0.01)
    for eye in EYES:
        report = occupancy.integrate(frame(eye), CAMERA)
        assert report.used == report.measured > 1000 and report.invalid == 0
    return occupancy


def test_a_map_is_an_obstacle(sdf: mg.ProbabilisticSdf) -> None:
    world = mg.World()
    world.add_sdf("scan", sdf, sigmas=0.0)
    # Half the probe, half a voxel for edges and a cell above the top: 1 + 1 + 2 mm.
    assert not free(world, 0, 0, TOP) and not free(world, 0.012, -0.01, TOP + 0.0009)
    assert free(world, 0, 0, TOP + 0.0041) and free(world, 0, 0, 0.2)
    assert free(world, 0, 0, -0.3)  # what no camera saw
    wider = mg.World()
    wider.add_sdf("scan", sdf, sigmas=4.0)
    _, sigma, _ = sdf.query([[0.001, 0.001, TOP]])
    assert not free(wider, 0, 0, TOP + 4 * sigma[0]) and free(wider, 0, 0, TOP + 4 * 0.001 + 0.0041)
    cells = sdf.obstacle_cells(4.0)
    assert [v.resolution for v in cells] == sorted(v.resolution for v in cells)
    added = [s.shape for s in wider.shapes_of("scan")]
    assert [len(v.centres) for v in added if isinstance(v, mg.collision.Voxels)] == [len(v.centres) for v in cells]
    # The object is what any other is.
    wider.move("scan", mg.pose([0.5, 0, 0]))
    assert free(wider, 0, 0, TOP) and not free(wider, 0.5, 0, TOP)
    wider.remove("scan")
    assert "scan" not in wider


def test_distances_edges_ik_and_planners_take_a_map() -> None:
    """A box on a table seen from above and all around; what they say is held against the two true boxes."""
    sdf = mg.ProbabilisticSdf(voxel=0.002)
    eyes = [[0.25 * np.cos(a), 0.25 * np.sin(a), 0.2] for a in np.arange(8) * np.pi / 4]
    for eye in eyes:
        T = look_at(np.array(eye), np.array([0.0, 0.0, 0.02]))
        sdf.integrate(mg.mapping.render_depth(SCENE, INTRINSICS, T), CAMERA)
    sdf.integrate(frame(EYES[0]), CAMERA)
    seen, truth = mg.World(), mg.World()
    seen.add_sdf("scan", sdf, sigmas=2.0)
    for k, part in enumerate(SCENE):
        assert isinstance(part.shape, mg.Box)
        truth.add_box(f"part {k}", part.shape.size, pose=part.pose)
    by_map, by_truth = (mg.CollisionChecker(ROBOT, world, group=ARM) for world in (seen, truth))
    rng = np.random.default_rng(5)
    margin = 2 * 0.003 + 0.006  # of two standard deviations, which are large at rims, and three cells
    for q in rng.uniform([-0.08, -0.08, 0.06], [0.08, 0.08, 0.12], (40, 3)):
        found, true = by_map.distance(q).value, by_truth.distance(q).value
        assert true - margin <= found <= true + 1e-6
        assert by_map.is_free(q)
    drawn = rng.uniform([-0.06, -0.06, 0.02], [0.06, 0.06, 0.09], (400, 2, 3))
    outside = [by_truth.are_free(ends).all() for ends in drawn]  # what is within is seen from nowhere
    blocked = [not by_truth.edge_is_free(a, b, joint_step=0.001) for a, b in drawn[outside]]
    assert 40 < sum(blocked) < sum(outside) - 40
    assert not any(by_map.edge_is_free(a, b, joint_step=0.001) for a, b in drawn[outside][blocked])
    reached = ARM.ik(mg.pose([0.01, 0.0, TOP + 0.012]), world=seen)
    assert reached.outcome == mg.Outcome.solved and by_map.is_free(reached.q)
    inside = ARM.ik(mg.pose([0.01, 0.0, TOP - 0.001]), world=seen)
    assert inside.outcome != mg.Outcome.solved and inside.rejections.scene > 0
    start, goal = [-0.06, 0.0, 0.02], [0.06, 0.005, 0.02]
    assert not by_map.edge_is_free(start, goal, joint_step=0.001)
    plan = mg.plan_motion(ROBOT, ARM, seen, start=start, goal=goal, joint_step=0.001, seed=1, time_limit=60.0)
    assert plan.outcome == mg.Outcome.solved
    path = np.array(plan.path)
    for a, b in itertools.pairwise(path):
        assert by_truth.are_free(a + np.linspace(0, 1, 200)[:, None] * (b - a)).all()


@pytest.mark.slow
def test_unknown_space_is_an_obstacle_when_asked(sdf: mg.ProbabilisticSdf) -> None:
    world = mg.World()
    bounds = [[-0.1, -0.1, -0.1], [0.1, 0.1, 0.3]]
    world.add_sdf("scan", sdf, 0.0, "occupied", bounds=bounds)
    assert not free(world, 0, 0, -0.09) and not free(world, 0, 0, 0.2)
    assert free(world, 0.2, 0, -0.2)
    with pytest.raises(mg.InvalidInput, match="unknown = maybe: must be one of free, occupied"):
        world.add_sdf("more", sdf, unknown="maybe")  # type: ignore[arg-type]
    with pytest.raises(mg.InvalidInput, match="bounds"):
        world.add_sdf("more", sdf, bounds=[[0, 0, 0], [-1, 1, 1]])
    with pytest.raises(mg.InvalidInput, match="sigmas"):
        world.add_sdf("more", sdf, sigmas=-1.0)
    with pytest.raises(mg.InvalidInput, match="nothing there is occupied"):
        world.add_sdf("more", mg.ProbabilisticSdf())
    with pytest.raises(mg.InvalidInput, match="scan: is in use already"):
        world.add_sdf("scan", sdf)


def test_an_octree_knows_what_was_looked_through(occupancy: mg.mapping.OccupancyMap, tmp_path: Path) -> None:
    points = [[0, 0, 0.2], [0.001, 0.001, TOP - 1e-4], [0, 0, 0.018], [0, 0, -0.2]]
    occupied, known = occupancy.query(points)
    assert known.tolist() == [True, True, False, False] and occupied.tolist() == [False, True, False, False]
    world = mg.World()
    world.add_occupancy("space", occupancy)
    assert free(world, 0, 0, 0.2) and free(world, 0, 0, 0.018) and not free(world, 0, 0, TOP - 0.001)
    careful = mg.World()
    lower, upper = occupancy.bounds
    careful.add_occupancy("space", occupancy, "occupied", bounds=[lower - [0, 0, 0.1], upper])
    assert free(careful, 0, 0, 0.2) and not free(careful, 0, 0, 0.018) and not free(careful, 0.01, 0.02, -0.08)
    for name in ("map.bt", "map.ot"):
        occupancy.save(tmp_path / name)
        again = mg.mapping.OccupancyMap.load(tmp_path / name)
        assert again.resolution == 0.01 and np.array_equal(again.query(points)[0], occupied)
        read = mg.World()
        read.add_octree("space", tmp_path / name)
        assert not free(read, 0, 0, TOP - 0.001) and free(read, 0, 0, 0.2)
    with pytest.raises(mg.IoError, match=r"must end in \.bt or \.ot"):
        occupancy.save(tmp_path / "map.octree")
    with pytest.raises(mg.IoError, match="does not exist"):
        mg.mapping.OccupancyMap.load(tmp_path / "none.bt")
    with pytest.raises(mg.InvalidInput, match="resolution"):
        mg.mapping.OccupancyMap(resolution=-1.0)


def test_what_was_not_measured_is_counted() -> None:
    image = frame(EYES[0])
    depth = image.depth.copy()
    depth[3, :5] = np.nan
    depth[4, :2] = [np.inf, -1.0]
    broken = mg.mapping.DepthImage(depth, INTRINSICS, image.T_world_camera)
    assert mg.ProbabilisticSdf().integrate(broken, CAMERA).invalid == 7
    assert mg.mapping.OccupancyMap().integrate(broken, CAMERA).invalid == 7
    assert mg.ProbabilisticSdf().integrate(image, CAMERA).invalid == 0


@pytest.mark.parametrize("constant", [-1.0, 0.0, np.nan, np.inf])
def test_noise_is_checked_when_made(constant: float) -> None:
    with pytest.raises(mg.InvalidInput, match=r"noise\.constant"):
        mg.mapping.DepthNoise(constant=constant)


@pytest.mark.slow
def test_an_arm_is_never_free_where_it_touches_what_was_seen(data: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Panda at a table with scanned objects, two noisy cameras; benchmarks/mapping/run_obstacle.py does it at full length."""
    for folder in ("benchmarks/mapping", "benchmarks"):
        monkeypatch.syspath_prepend(str(REPOSITORY / folder))
    import run_obstacle as obstacle  # type: ignore[import-not-found]

    robot, arm = obstacle.panda()
    scene = obstacle.true_scene()
    Q = np.random.default_rng(3).uniform(arm.lower, arm.upper, (12_000, arm.size))
    Q = Q[mg.CollisionChecker(robot, mg.World(), group=arm).are_free(Q)]
    sdf = mg.ProbabilisticSdf(voxel=0.006, truncation=0.03)
    seen, _ = obstacle.integrate(sdf, scene, 3, seed=2)
    truth, map_world = mg.World(), mg.World()
    truth.add_points("seen", seen, 0.001)
    map_world.add_sdf("map", sdf, sigmas=2.0)
    touches = ~mg.CollisionChecker(robot, truth, group=arm).are_free(Q)
    free = mg.CollisionChecker(robot, map_world, group=arm).are_free(Q)
    assert touches.sum() > 500 and not np.any(free & touches)
    truly = mg.CollisionChecker(robot, obstacle.world_of(scene), group=arm).are_free(Q)
    assert np.mean(free[truly]) > 0.95
