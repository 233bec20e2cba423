"""A map of surfaces from the frames of two depth cameras: how far, and how sure."""

import numpy as np

import mmgrasp as mg

scene = [
    mg.LinkShape(mg.collision.Plane([0, 0, 1], 0.0)),
    mg.LinkShape(mg.Box([0.08, 0.05, 0.06]), mg.pose([0.05, 0, 0.03])),
    mg.LinkShape(mg.Sphere(0.03), mg.pose([-0.05, 0.02, 0.03])),
]
pinhole = mg.mapping.PinholeCamera(width=320, height=240, fx=300.0, fy=300.0, cx=159.5, cy=119.5, farthest=2.0)
fine = mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise(constant=0.0005), name="fine", systematic=0.0003)
coarse = mg.mapping.DepthCamera(pinhole, mg.mapping.DepthNoise.stereo(300, 0.05, 0.1), name="coarse")

sdf = mg.ProbabilisticSdf(voxel=0.003, truncation=0.012)
for k in range(6):
    eye = mg.mapping.look_down([0.04 * np.cos(k), 0.04 * np.sin(k), 0.4])
    camera = fine if k % 2 else coarse
    image = mg.mapping.render_depth(scene, pinhole, eye, noise=0.003, seed=k + 1)
    report = sdf.integrate(image, camera, pose_covariance=np.diag([1e-7] * 3 + [1e-7] * 3))
    print(camera.name, report)
print(sdf)

mean, sigma, known = sdf.query([[0.05, 0, 0.062], [-0.05, 0.02, 0.061], [0, 0, -0.1]])
for where, m, s, k in zip(("above the box", "above the ball", "below the table"), mean, sigma, known, strict=True):
    print(f"{where}: {1e3 * m:.2f} mm from the surface, sigma {1e3 * s:.2f} mm" if k else f"{where}: unknown")
hits = sdf.cast_rays([[0.05, 0.0, 0.3]], [[0, 0, -1]])
print(f"a ray down meets the box at z = {hits.point[0, 2]:.4f} m, normal {np.round(hits.normal[0], 2)}")
mesh, sigmas = sdf.mesh()
print(f"{mesh}; sigma of its vertices from {1e3 * sigmas.min():.2f} to {1e3 * sigmas.max():.2f} mm")
sdf.save("scan.sdf")
