"""From depth frames to a grasp: a part that nobody typed is seen by two noisy cameras, and the hand asks where it would hold."""

import numpy as np

import mmgrasp as mg

# What stands there. The planner below sees only frames of it.
scene = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.14, 0.026, 0.026]), mg.pose([0, 0, 0.013])),
    mg.LinkShape(mg.Box([0.03, 0.07, 0.05]), mg.pose([0.06, 0, 0.025])),
]
pinhole = mg.mapping.PinholeCamera(width=240, height=180, fx=260.0, fy=260.0, cx=119.5, cy=89.5)
cameras = {
    "wrist": mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise(constant=0.0005, quadratic=0.002), "wrist"),
    "mast": mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise(constant=0.001, quadratic=0.006), "mast"),
}


def frame(name: str, angle: float, up: float, rng: np.random.Generator) -> mg.mapping.DepthImage:
    """A depth image from around, with the noise of its camera in every pixel."""
    middle = np.array([0.0, 0.0, 0.02])
    z = -np.array([np.cos(up) * np.cos(angle), np.cos(up) * np.sin(angle), np.sin(up)])
    x = np.cross(z, [0, 0, 1]) / np.linalg.norm(np.cross(z, [0, 0, 1]))
    T_world_camera = np.eye(4)
    T_world_camera[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    T_world_camera[:3, 3] = middle - 0.42 * z
    depth = np.array(mg.mapping.render_depth(scene, pinhole, T_world_camera).depth)
    noise = cameras[name].noise
    seen = depth > 0
    depth[seen] += (noise.constant + noise.quadratic * depth[seen] ** 2) * rng.standard_normal(int(seen.sum()))
    return mg.mapping.DepthImage(depth, pinhole, T_world_camera)


# 1. Frames become a map that knows how sure it is. The walls of low parts are seen under a slant alone.
sdf = mg.ProbabilisticSdf(voxel=0.0025, max_incidence=1.3)
rng = np.random.default_rng(1)
for k in range(10):
    if k == 3:
        sdf.save("three_frames.sdf")
    name = ("wrist", "mast")[k % 2]
    sdf.integrate(frame(name, 2.4 * k, np.radians(30 + 12 * (k % 3)), rng), cameras[name])
points, normals, sigmas = sdf.points()
print(f"{sdf}; sigma of the surface {1e3 * np.median(sigmas):.2f} mm (median)")

# 2. The table, and what stands on it.
found = mg.mapping.segment_objects(points, normals, up=[0, 0, 1])
assert found.plane is not None
table = float(found.plane.offset / found.plane.normal[2])
part = np.concatenate([points[np.array(found.labels) == k] for k in range(len(found.objects))])
box = np.array([part.min(axis=0), part.max(axis=0)])
print(
    f"table at {1e3 * table:.1f} mm; the part is {np.round(1e3 * (box[1] - box[0]))} mm in {len(found.objects)} pieces"
)

# 3. Grasps by their probability: (4.9) of P3, and (4.1) over surfaces drawn from the map.
hand = mg.Hand(
    "tool", approach=[0, 0, 1], closing=[0, 1, 0], max_opening=0.09, finger_depth=0.016, finger_width=0.018, clearance=0.008,
    body=mg.grasping.HandBody(finger_thickness=0.01, finger_length=0.07, palm_length=0.12, palm_width=0.06),
)  # fmt: skip
grasps = mg.synthesize_grasps(sdf, hand, table=table, object=box + [[-0.01], [0.01]], surface_draws=200, seed=1)
print(grasps.summary())
for grasp, rating in list(zip(grasps.grasps, grasps.ratings, strict=True))[:3]:
    assert rating.drawn is not None
    print(
        f"  {grasp.quality:.2f} (drawn surfaces: {rating.drawn.probability:.2f}) at "
        f"{np.round(1e3 * grasp.T_object_hand[:3, 3])} mm, open {1e3 * grasp.opening:.0f} mm; angle {rating.success.angle:.2f}, "
        f"placement {rating.success.placement:.2f}, centring {rating.success.centring:.2f}, certainty {rating.success.certainty:.2f}"
    )
lost = {cause: n for cause, n in grasps.counts.items() if n and cause not in ("drawn", "evaluated")}
print(f"why others lost, of {grasps.counts['drawn']} drawn and {grasps.counts['evaluated']} evaluated: {lost}")

# 4. The map of the first three frames alone: where should the camera look next?
few = mg.ProbabilisticSdf.load("three_frames.sdf")
view = mg.grasping.next_view(few, hand, cameras["wrist"], table=table, candidates=8, draws=1, samples=100)
best = view.candidates[0]
print(
    f"after three frames {view.probability_now:.2f}; with one more from {np.round(best.T_world_camera[:3, 3], 2)} m "
    f"{best.probability:.2f} and {100 * best.unseen:.0f} % of the part's pixels new"
)

# 5. The map as an obstacle of every planner.
world = mg.World()
world.add_sdf("scan", sdf, sigmas=2.0)
print(world)
