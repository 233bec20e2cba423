"""Grasps of unknown parts through the Python door, in maps of rendered frames."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mmgrasp as mg

DATA = Path(__file__).resolve().parents[2].parent / "shared" / "data"
INTRINSICS = mg.mapping.PinholeCamera(width=160, height=120, fx=200.0, fy=200.0, cx=79.5, cy=59.5)
CAMERA = mg.mapping.DepthCamera(INTRINSICS, mg.mapping.DepthNoise(constant=0.0008))
TABLE = mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0))
HAND = mg.Hand(
    "tool", approach=[0, 0, 1], closing=[0, 1, 0], max_opening=0.09, finger_depth=0.02, finger_width=0.018, clearance=0.008,
    body=mg.grasping.HandBody(finger_thickness=0.01, finger_length=0.07, palm_length=0.12, palm_width=0.06),
)  # fmt: skip


def looking_at(eye: np.ndarray, target: np.ndarray) -> np.ndarray:
    z = (target - eye) / np.linalg.norm(target - eye)
    x = np.cross(z, [0, 0, 1]) / np.linalg.norm(np.cross(z, [0, 0, 1]))
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    T[:3, 3] = eye
    return T


def scan(scene: list[mg.LinkShape]) -> mg.ProbabilisticSdf:
    rng = np.random.default_rng(1)
    sdf = mg.ProbabilisticSdf()
    for k in range(10):
        angle, up = 2.4 * k, np.radians(25 + 20 * (k % 3))
        eye = 0.35 * np.array([np.cos(up) * np.cos(angle), np.cos(up) * np.sin(angle), np.sin(up)])
        image = mg.mapping.render_depth(scene, INTRINSICS, looking_at(eye, np.array([0, 0, 0.04])))
        depth = np.array(image.depth)
        depth[depth > 0] += 0.0008 * rng.standard_normal(int((depth > 0).sum()))
        sdf.integrate(mg.mapping.DepthImage(depth, INTRINSICS, image.T_world_camera), CAMERA)
    return sdf


@pytest.fixture(scope="module")
def box_map() -> mg.ProbabilisticSdf:
    return scan([TABLE, mg.LinkShape(mg.Box([0.04, 0.07, 0.06]), mg.pose([0, 0, 0.03]))])


def test_a_box_and_what_its_grasps_say(box_map: mg.ProbabilisticSdf) -> None:
    found = mg.synthesize_grasps(box_map, HAND, table=0.0, surface_draws=100)
    assert found.outcome == mg.Outcome.solved and len(found.grasps) == len(found.ratings) > 0
    assert np.allclose(found.object_centre, [0, 0, 0.03], atol=0.004)
    assert found.object_longest == pytest.approx(0.07, abs=0.006)
    weights = {"angle": 0.6, "placement": 0.1, "centring": 0.2, "certainty": 0.1}
    for grasp, rating in zip(found.grasps, found.ratings, strict=True):
        success = rating.success.to_dict()
        assert success["weighted"] == pytest.approx(sum(w * success[name] for name, w in weights.items()))
        assert grasp.quality == success["probability"] == success["weighted"] and success["force_closure"]
        # P_1 to P_4 anew from the patches.
        cone, h = np.arctan(0.5), HAND.clearance
        beta = [np.pi - np.arccos(np.clip(p.normal @ p.pad_normal, -1, 1)) for p in rating.patches]
        assert success["angle"] == pytest.approx(np.prod([1 - b / cone for b in beta]), abs=1e-6)
        assert success["placement"] == pytest.approx(np.exp(-sum(abs(p.distance - h) for p in rating.patches) / 0.01))
        a, b = (p.point for p in rating.patches)
        off = np.linalg.norm(np.cross(found.object_centre - a, b - a)) / np.linalg.norm(b - a)
        assert success["centring"] == pytest.approx(1 - off / (found.object_longest / 2))
        assert success["certainty"] == pytest.approx(np.prod([1 - p.sigma / 0.005 for p in rating.patches]))
        assert rating.drawn is not None and 0 < rating.drawn.probability <= rating.drawn.holds <= 1
        assert rating.q is None and grasp.opening < rating.pretouch_opening <= HAND.max_opening
    counts = found.counts
    lost = sum(
        counts[k] for k in ("missed", "uneven", "slipping", "uncertain", "collision", "table", "arm", "near_better")
    )
    assert counts["evaluated"] == lost + len(found.grasps)
    again = mg.synthesize_grasps(box_map, HAND, table=0.0, threads=1)
    assert [g.quality for g in again.grasps] == [g.quality for g in found.grasps]


def test_bad_input_has_one_message(box_map: mg.ProbabilisticSdf) -> None:
    with pytest.raises(mg.InvalidInput, match="map = 0 frames: has no surface"):
        mg.synthesize_grasps(mg.ProbabilisticSdf(), HAND)
    with pytest.raises(mg.InvalidInput, match=r"sampels.*samples"):
        mg.synthesize_grasps(box_map, HAND, **{"sampels": 3})  # type: ignore[arg-type]
    with pytest.raises(mg.InvalidInput, match="sum of the four weights"):
        mg.synthesize_grasps(box_map, HAND, angle_weight=0.9)
    with pytest.raises(mg.InvalidInput, match="world = given: goes with an arm"):
        mg.synthesize_grasps(box_map, HAND, world=mg.World())
    with pytest.raises(mg.InvalidInput, match="object"):
        mg.synthesize_grasps(box_map, HAND, object=[[1, 1, 1], [0, 0, 0]])
    narrow = mg.Hand(
        "tool", approach=[0, 0, 1], closing=[0, 1, 0], max_opening=0.03, finger_depth=0.02, finger_width=0.018
    )
    none = mg.synthesize_grasps(box_map, narrow, table=0.0)
    assert none.outcome == mg.Outcome.not_found and none.grasps == []
    assert none.counts["too_wide"] > none.counts["drawn"] / 3 and "no grasp" in none.summary()


def test_the_arm_gets_to_what_is_returned(box_map: mg.ProbabilisticSdf) -> None:
    """A seven-joint arm beside the table: tool poses by its own forward kinematics, no collision with table and part."""
    folder = Path(mg.__file__).parent / "assets" / "robots" / "tm14like"
    robot = mg.Robot.load(folder / "tm14like.urdf", srdf=folder / "tm14like.srdf", base="fixed")
    hand = mg.Hand.from_robot(robot, "gripper_tcp", group="gripper", clearance=0.006)
    arm = robot.group("arm")
    base = np.eye(4)
    base[:3, 3] = [-0.55, 0.0, 0.0]
    placed = arm.at(base)
    world = mg.World()
    world.add_box("table", size=(0.6, 0.6, 0.05), pose=mg.pose([0, 0, -0.025]))
    found = mg.synthesize_grasps(box_map, hand, table=0.0, arm=placed, world=world, samples=150, max_grasps=5)
    assert found.outcome == mg.Outcome.solved, found.summary()
    checker = mg.CollisionChecker(robot, world, group=placed)
    for grasp, rating in zip(found.grasps, found.ratings, strict=True):
        assert rating.q is not None and checker.is_free(rating.q)
        assert np.allclose(placed.fk(rating.q), grasp.T_object_hand, atol=2e-4)
    base[:3, 3] = [-5.0, 0.0, 0.0]
    far = mg.synthesize_grasps(box_map, hand, table=0.0, arm=arm.at(base), samples=60)
    assert far.outcome == mg.Outcome.not_found and far.arm.unreachable == far.counts["arm"] > 0


def test_a_hand_of_seven_joints_pinches(box_map: mg.ProbabilisticSdf) -> None:
    """Groups 2, 2, 2, 1; on the part the two tips are as far apart as it is wide, by the robot's own kinematics."""
    robot = mg.Robot.load(Path(mg.__file__).parent / "assets" / "grippers" / "sdhlike" / "sdhlike.urdf")
    groups = [(f, [f"{f}_proximal", f"{f}_distal"]) for f in ("thumb", "finger_1", "finger_2")] + [
        ("spread", ["spread"])
    ]
    opened, closed = np.radians([-90, 0, -25, 25, -25, 25, 90]), np.radians([-90, 0, 12, -12, 12, -12, 90])
    hand = mg.grasping.eigengrasp_hand(robot, "tcp", groups, open=opened, closed=closed, name="pinch")
    assert hand.max_opening == pytest.approx(2 * (0.033 + 0.0865 * np.sin(np.radians(25)) - 0.012))
    assert hand.preshape == {"thumb": 1.0, "spread": 1.0}
    found = mg.synthesize_grasps(box_map, hand, robot=robot, table=0.0)
    assert found.outcome == mg.Outcome.solved, found.summary()
    for grasp in found.grasps:
        poses = robot.link_poses(hand.joint_values(grasp))
        tips = [(poses[f"finger_{i}_tip"] @ [0, 0, 0.03425, 1])[:3] for i in (1, 2)]
        assert np.linalg.norm(tips[0] - tips[1]) - 0.024 == pytest.approx(grasp.opening, abs=0.004)


@pytest.mark.skipif(not (DATA / "meshes" / "ycb").exists(), reason="no shared data")
def test_a_ycb_object_is_held_where_its_mesh_is() -> None:
    """Every contact line against the true mesh: its two ends lie on it, with opposed normals."""
    mesh = mg.Mesh.load(DATA / "meshes" / "ycb" / "YcbMustardBottle" / "textured_simple_reoriented.obj")
    vertices = np.asarray(mesh.vertices)
    offset = -np.append((vertices.min(0) + vertices.max(0))[:2] / 2, vertices[:, 2].min())
    sdf = scan([TABLE, mg.LinkShape(mesh, mg.pose(offset))])
    found = mg.synthesize_grasps(sdf, HAND, table=0.0)
    assert found.outcome == mg.Outcome.solved, found.summary()
    assert found.grasps[0].quality > 0.6
    for grasp, rating in zip(found.grasps, found.ratings, strict=True):
        for patch in rating.patches:
            assert np.min(np.linalg.norm(vertices + offset - patch.point, axis=1)) < 0.006
        # No vertex of the true mesh lies in the open hand.
        for box in HAND.shapes(rating.pretouch_opening):
            assert isinstance(box.shape, mg.Box)
            T = np.linalg.inv(grasp.T_object_hand @ box.pose)
            inside = np.abs((vertices + offset) @ T[:3, :3].T + T[:3, 3]) < np.asarray(box.shape.size) / 2
            assert not np.any(np.all(inside, axis=1))


def test_the_next_view_shows_the_other_side() -> None:
    scene = [TABLE, mg.LinkShape(mg.Box([0.07, 0.04, 0.06]), mg.pose([0, 0, 0.03]))]
    sdf = mg.ProbabilisticSdf(threads=1)
    sdf.integrate(
        mg.mapping.render_depth(scene, INTRINSICS, looking_at(np.array([0, -0.33, 0.14]), np.array([0, 0, 0.03]))),
        CAMERA,
    )
    found = mg.grasping.next_view(sdf, HAND, CAMERA, table=0.0, candidates=8, draws=1, distance=0.33)
    assert found.outcome == mg.Outcome.solved and len(found.candidates) == 8
    best = found.candidates[0]
    assert best.T_world_camera[1, 3] > 0.05 and best.unseen > 0.1 and best.certain > 0.5
    with pytest.raises(mg.InvalidInput, match="candidates"):
        mg.grasping.next_view(sdf, HAND, CAMERA, candidates=0)
    with pytest.raises(mg.InvalidInput, match="world"):
        mg.grasping.next_view(sdf, HAND, CAMERA, world=mg.World())
