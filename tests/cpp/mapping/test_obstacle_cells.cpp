// ProbabilisticSdf::obstacle_cells: what may be solid is held, what is seen to be free is not.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mapping/obstacle_scenes.hpp"
#include "mmgrasp/collision/add_cells.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "support/free_body.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

/// Whatever the noise: where the map itself says that mean - k sigma is zero or less, there is a cell.
TEST(ObstacleCells, HoldEveryPointThatMayBeSolid) {
  DepthCamera fine = small_camera(0.0007), coarse = small_camera(0.002);
  fine.name = "fine";
  coarse.name = "coarse";
  coarse.systematic = 0.0008;
  const std::vector<PlacedShape> scene{{Box{{0.06, 0.05, 0.04}}, placed({0.001, 0.002, 0.003}, 0.4)}};
  for (const int layers : {1, 2}) {
    ProbabilisticSdf sdf;
    for (int k = 0; k < 6; ++k) {
      const DepthCamera& camera = k % layers ? coarse : fine;
      DepthImage image = frame_of(scene, camera, look_at(0.3 * direction_of(k, 12), {0, 0, 0}));
      Rng rng(5, static_cast<std::uint64_t>(k));
      disturb(image, camera, rng);
      sdf.integrate(image, camera, FrameUncertainty::of_pose(0.0005, 0.001));
    }
    Rng rng(1);
    Matrix3Xd points(3, 200000);
    for (double& value : points.reshaped()) value = rng.uniform(-0.06, 0.06);
    const SdfValues at = sdf.query(points);
    for (const double sigmas : {0.0, 1.0, 2.0, 4.0}) {
      const CellSet cells = cells_of(sdf, sigmas);
      int solid = 0, missed = 0;
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        if (!at.known[i] || at.mean[i] - sigmas * at.sigma[i] > 0) continue;
        ++solid;
        missed += !cells.has(points.col(i));
      }
      EXPECT_GT(solid, 3000);
      EXPECT_EQ(missed, 0) << layers << " layers, " << sigmas << " sigma";
    }
  }
}

/// What the margin costs above a wall across the lattice: k sigma, half a voxel, and what is left of a voxel.
TEST(ObstacleCells, MarginAboveAPlaneInClosedForm) {
  const DepthCamera camera = small_camera(0.001);
  for (const double depth : {0.3003, 0.3007, 0.3011, 0.3019}) {
    DepthImage image{camera.intrinsics, Pose::Identity(), {}};
    image.depth.assign(160 * 120, static_cast<float>(depth));
    ProbabilisticSdf sdf;
    sdf.integrate(image, camera);
    for (const double sigmas : {0.0, 1.0, 2.0}) {
      // The nearest layer of voxels whose distance is at most k sigma + h / 2, and the cells in front of it.
      const double h = 0.002, margin = sigmas * 0.001 + 0.5 * h;
      const double front = h * (std::ceil((depth - margin) / h - 1e-6) - 1);
      const CellSet cells = cells_of(sdf, sigmas);
      Rng rng(2);
      for (int k = 0; k < 500; ++k) {
        const Vector3d at(rng.uniform(-0.05, 0.05), rng.uniform(-0.04, 0.04), front);
        EXPECT_TRUE(cells.has(at + Vector3d(0, 0, 1e-5))) << depth << ", " << sigmas;
        EXPECT_FALSE(cells.has(at - Vector3d(0, 0, 1e-5))) << depth << ", " << sigmas;
        // Never thinner than this behind the surface, never nearer than the margin in front of it.
        EXPECT_TRUE(cells.has({at.x(), at.y(), depth + rng.uniform(0, 0.0035)}));
        EXPECT_FALSE(cells.has({at.x(), at.y(), depth - margin - h - 1e-5 - rng.uniform(0, 0.05)}));
      }
    }
  }
}

/// Without noise nothing of the true surface that a pixel showed is free, up to edges and rims: primitives and thin
/// things, from one side or many.
TEST(ObstacleCells, HoldWhatAnyPixelSaw) {
  const auto scenes = primitive_scenes();
  for (const double truncation : {0.006, 0.010}) {
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      for (const int views : {1, 6, 30}) {
        SdfOptions options;
        options.truncation = truncation;
        ProbabilisticSdf sdf(options);
        const std::vector<DepthImage> frames = exact_frames(scenes[s], views, s == 7);
        for (const DepthImage& frame : frames) sdf.integrate(frame, small_camera());
        const SeenPoints seen = look_up(scenes[s], frames, cells_of(sdf, 0));
        EXPECT_GT(seen.count, s == 4 && views == 1 ? 10 : 1000);
        EXPECT_EQ(seen.outside, 0) << "scene " << s << ", " << views << " views, truncation " << truncation;
      }
    }
  }
}

/// With noise of half a voxel, and errors of the poses that the frames were given: at 2 sigma nothing seen is free,
/// but for what a pose's error moves sideways at a rim. Without the margin much is.
TEST(ObstacleCells, TwoSigmaHoldWhatNoisyFramesSaw) {
  const auto scenes = primitive_scenes();
  const DepthCamera camera = small_camera(0.001);
  for (const bool poses : {false, true}) {
    int count = 0, at_zero = 0, at_two = 0;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
      ProbabilisticSdf sdf;
      const std::vector<DepthImage> frames = exact_frames(scenes[s], 6, s == 7);
      for (std::size_t k = 0; k < frames.size(); ++k) {
        DepthImage image = frames[k];
        Rng rng(5, k);
        disturb(image, camera, rng);
        if (poses) {
          const Vector3d turn = 0.003 * Vector3d(rng.normal(), rng.normal(), rng.normal());
          image.T_world_camera.linear() =
              Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix() * image.T_world_camera.linear();
          image.T_world_camera.translation() += 0.001 * Vector3d(rng.normal(), rng.normal(), rng.normal());
        }
        sdf.integrate(image, camera, FrameUncertainty::of_pose(poses ? 0.001 : 0, poses ? 0.003 : 0));
      }
      const SeenPoints without = look_up(scenes[s], frames, cells_of(sdf, 0));
      count += without.count;
      at_zero += without.outside;
      at_two += look_up(scenes[s], frames, cells_of(sdf, 2)).outside;
    }
    std::printf("%s: of %d seen points %d outside at 0 sigma, %d at 2\n", poses ? "with pose errors" : "noise alone",
                count, at_zero, at_two);
    EXPECT_GT(count, 100000);
    if (poses) {
      EXPECT_GT(at_zero, 300);
    }
    EXPECT_LE(at_two, poses ? count / 10000 : 0);
  }
}

/// A sphere seen all around is solid to its middle, and no thicker than the margin.
TEST(ObstacleCells, SphereSeenAllAround) {
  const double radius = 0.05;
  const DepthCamera camera = small_camera();
  ProbabilisticSdf sdf;
  for (int k = 0; k < 20; ++k) {
    sdf.integrate(frame_of({{Sphere{radius}}}, camera, look_at(0.3 * direction_of(k, 20), {0, 0, 0})), camera);
  }
  const std::vector<Voxels> sizes = sdf.obstacle_cells(at_sigmas(0));
  EXPECT_GT(sizes.size(), 1u);  // the inside is merged
  const CellSet cells(sizes);
  Rng rng(4);
  for (int k = 0; k < 20000; ++k) {
    const Vector3d direction = direction_of(k, 20000);
    EXPECT_TRUE(cells.has(rng.uniform(0, radius) * direction));
    // Corners within h / 2 of the surface, but for the map's own error, and their cells.
    EXPECT_FALSE(cells.has((radius + 0.001 + 0.0004 + std::sqrt(3.0) * 0.002) * direction));
  }
  World world;
  add_cells(world, "seen", sizes);
  for (const double small : {0.001, 0.004, 0.02}) {
    const JointGroup body = free_body::group({free_body::link_shape(Box{{small, 0.5 * small, small}})});
    CollisionChecker checker(body, world);
    for (int k = 0; k < 300; ++k) {
      const Vector3d at = rng.uniform(0, radius) * direction_of(k, 300);
      Eigen::VectorXd q(6);
      q << at, rng.uniform(-3, 3), rng.uniform(-3, 3), rng.uniform(-3, 3);
      EXPECT_FALSE(checker.is_free(q)) << "a body wholly inside";
    }
  }
}

/// What moved away leaves nothing, not even in front of where it was; what it stood on stays.
TEST(ObstacleCells, RemovedObjectsGo) {
  const DepthCamera camera = small_camera();
  const PlacedShape floor{Box{{0.4, 0.4, 0.02}}, placed({0, 0, -0.0103})};
  const PlacedShape box{Box{{0.04, 0.04, 0.04}}, placed({0.001, 0.0005, 0.0197})};
  const Pose eyes[] = {look_at({0, 0, 0.35}, {0, 0, 0}), look_at({0.15, 0, 0.3}, {0, 0, 0}),
                       look_at({-0.1, 0.1, 0.3}, {0, 0, 0})};
  ProbabilisticSdf sdf;
  for (const Pose& eye : eyes) sdf.integrate(frame_of({floor, box}, camera, eye), camera);
  const double top = floor.T_world_shape.translation().z() + 0.01;
  EXPECT_TRUE(cells_of(sdf, 2).has({0.001, 0.0005, 0.0396}));
  std::vector<DepthImage> after;
  for (int k = 0; k < 8; ++k) {
    after.push_back(frame_of({floor}, camera, eyes[k % 3]));
    sdf.integrate(after.back(), camera);
  }
  for (const double sigmas : {0.0, 2.0}) {
    const CellSet cells = cells_of(sdf, sigmas);
    EXPECT_EQ(look_up({floor}, after, cells).outside, 0);
    // Within a depth's reach of the floor, 7.5 mm, frames before and after are averaged, and then comes the cell.
    Rng rng(6);
    for (int k = 0; k < 20000; ++k) {
      const Vector3d at(rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), rng.uniform(top + 0.0095, 0.06));
      EXPECT_FALSE(cells.has(at)) << at.transpose();
    }
  }
}

/// A wall beside space that was carved free: two faces meet at a corner that a removed box had filled.
TEST(ObstacleCells, CornerBesideCarvedSpace) {
  const DepthCamera camera = small_camera();
  const std::vector<PlacedShape> corner{{Box{{0.3, 0.3, 0.02}}, placed({0, 0, -0.0103})},
                                        {Box{{0.02, 0.3, 0.1}}, placed({-0.0493, 0, 0.0397})}};
  std::vector<PlacedShape> filled = corner;
  filled.push_back({Box{{0.03, 0.05, 0.03}}, placed({-0.0243, 0, 0.0147})});
  const Pose eyes[] = {look_at({0.15, 0, 0.3}, {0, 0, 0}), look_at({0.2, 0.1, 0.2}, {0, 0, 0}),
                       look_at({0.2, -0.1, 0.2}, {0, 0, 0})};
  ProbabilisticSdf sdf;
  for (int k = 0; k < 3; ++k) sdf.integrate(frame_of(filled, camera, eyes[k]), camera);
  std::vector<DepthImage> after;
  for (int k = 0; k < 8; ++k) {
    after.push_back(frame_of(corner, camera, eyes[k % 3]));
    sdf.integrate(after.back(), camera);
  }
  for (const double sigmas : {0.0, 2.0}) {
    const CellSet cells = cells_of(sdf, sigmas);
    const SeenPoints seen = look_up(corner, after, cells);
    EXPECT_GT(seen.count, 10000);
    EXPECT_EQ(seen.outside, 0);
    for (double x = -0.030; x < -0.012; x += 0.0013) {
      for (double z = 0.009; z < 0.027; z += 0.0013) EXPECT_FALSE(cells.has({x, 0.003, z})) << x << " " << z;
    }
  }
}

/// A room seen from within is not filled, though no way leads out of it: what is in front of its walls was seen.
TEST(ObstacleCells, RoomsAreNotFilled) {
  // So wide that every frame sees a part of what the first one saw.
  DepthCamera camera = small_camera();
  PinholeCamera& lens = camera.intrinsics;
  lens.width = lens.height = 400;
  lens.fx = lens.fy = 73;
  lens.cx = lens.cy = 199.5;
  lens.nearest = 0.02;
  const double voxel = 0.004, radius = 0.15;
  SdfOptions options;
  options.voxel = voxel;
  options.truncation = 5 * voxel;
  ProbabilisticSdf sdf(options);
  DepthImage image{lens, Pose::Identity(), {}};
  for (int v = 0; v < lens.height; ++v) {
    for (int u = 0; u < lens.width; ++u) {
      const Vector3d ray((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1);
      image.depth.push_back(static_cast<float>(radius / ray.norm()));
    }
  }
  for (int k = 0; k < 17; ++k) {
    const double angle = 2 * M_PI * k / 8, up = k == 0 ? 20 : k % 2 ? 0.6 : -0.6;
    image.T_world_camera = look_at(Vector3d::Zero(), Vector3d(std::cos(angle), std::sin(angle), up));
    sdf.integrate(image, camera);
  }
  const CellSet cells = cells_of(sdf, 2);
  EXPECT_TRUE(cells.has({0, 0.01, 0.151}));
  EXPECT_FALSE(cells.has({0.06, 0.07, -0.08}));
  // From the middle through faces of cells that are not held.
  std::set<std::array<int, 3>> reached{{0, 0, 0}};
  std::vector<std::array<int, 3>> open{{0, 0, 0}};
  bool out = false;
  while (!open.empty() && !out) {
    const std::array<int, 3> from = open.back();
    open.pop_back();
    for (int k = 0; k < 6; ++k) {
      std::array<int, 3> to = from;
      to[k / 2] += k % 2 ? 1 : -1;
      if (cells.holds(voxel * Vector3d(to[0] + 0.5, to[1] + 0.5, to[2] + 0.5)) || !reached.insert(to).second) continue;
      open.push_back(to);
      out = out || *std::max_element(to.begin(), to.end()) > 70 || *std::min_element(to.begin(), to.end()) < -70;
    }
  }
  ASSERT_FALSE(out) << "a way leads out: the room is no test";
  const double inside = 4 * M_PI / 3 * std::pow(radius, 3);
  EXPECT_LT(static_cast<double>(reached.size()) * std::pow(voxel, 3), inside);
  EXPECT_GT(static_cast<double>(reached.size()) * std::pow(voxel, 3), 0.8 * inside);
}

TEST(ObstacleCells, UnknownSpaceAsAnObstacle) {
  const DepthCamera camera = small_camera();
  DepthImage image{camera.intrinsics, Pose::Identity(), {}};
  image.depth.assign(160 * 120, 0.3f);
  ProbabilisticSdf sdf;
  sdf.integrate(image, camera);
  SdfObstacleOptions options;
  options.sigmas = 0;
  options.unknown = UnknownSpace::occupied;
  options.bounds = {Vector3d(-0.05, -0.04, 0.2), Vector3d(0.05, 0.04, 0.5)};
  const std::vector<Voxels> sizes = sdf.obstacle_cells(options);
  EXPECT_GE(sizes.size(), 3u);
  for (std::size_t k = 1; k < sizes.size(); ++k) EXPECT_GT(sizes[k].resolution, sizes[k - 1].resolution);
  const CellSet cells(sizes);
  Rng rng(3);
  for (int k = 0; k < 5000; ++k) {
    const double x = rng.uniform(-0.05, 0.05), y = rng.uniform(-0.04, 0.04);
    EXPECT_TRUE(cells.has({x, y, rng.uniform(0.2, 0.29)}));
    EXPECT_TRUE(cells.has({x, y, rng.uniform(0.3, 0.5)}));
    EXPECT_FALSE(cells.has({x, y, rng.uniform(0.2961, 0.2979)}));    // known to be in front
    EXPECT_FALSE(cells.has({x + 0.11, y, rng.uniform(0.2, 0.29)}));  // outside the bounds
  }
  // Every size tiles: volumes sum up to the bounds' but for the clear layer.
  double volume = 0;
  for (const Voxels& voxels : sizes) {
    for (const Vector3d& c : *voxels.centres) volume += options.bounds.contains(c) ? std::pow(voxels.resolution, 3) : 0;
  }
  EXPECT_NEAR(volume, 0.1 * 0.08 * (0.3 - 0.002), 1e-7);
  // Of a map without a surface only the bounds are left.
  const std::vector<Voxels> empty = ProbabilisticSdf().obstacle_cells(options);
  EXPECT_TRUE(CellSet(empty).has({0, 0, 0.3}));
}

TEST(ObstacleCells, RefusesAndAnswersNothing) {
  const ProbabilisticSdf sdf;
  EXPECT_TRUE(sdf.obstacle_cells().empty());
  World world;
  EXPECT_THROW(add_cells(world, "nothing", sdf.obstacle_cells()), InvalidInput);
  EXPECT_THROW(sdf.obstacle_cells(at_sigmas(-1)), InvalidInput);
  EXPECT_THROW(sdf.obstacle_cells(at_sigmas(2, UnknownSpace::unknown)), InvalidInput);
  const Vector3d far = Vector3d::Constant(1e300);
  EXPECT_THROW(sdf.obstacle_cells({2, UnknownSpace::occupied, {Vector3d(-far), far}}), InvalidInput);
  const Vector3d wide = Vector3d::Constant(50);
  EXPECT_THROW(sdf.obstacle_cells({2, UnknownSpace::occupied, {Vector3d(-wide), wide}}), InvalidInput);
  const Vector3d endless = Vector3d::Constant(std::numeric_limits<double>::infinity());
  EXPECT_THROW(sdf.obstacle_cells({2, UnknownSpace::occupied, {Vector3d(-endless), endless}}), InvalidInput);
}

TEST(ObstacleCells, SameCellsAtAnyThreads) {
  const DepthCamera camera = small_camera(0.002);
  std::vector<std::vector<Voxels>> found;
  for (const int threads : {1, 3}) {
    SdfOptions options;
    options.threads = threads;
    ProbabilisticSdf sdf(options);
    for (int k = 0; k < 4; ++k) {
      DepthImage image = frame_of({{Sphere{0.05}}}, camera, look_at(0.3 * direction_of(k, 4), {0, 0, 0}));
      Rng rng(9, static_cast<std::uint64_t>(k));
      disturb(image, camera, rng);
      sdf.integrate(image, camera);
    }
    found.push_back(sdf.obstacle_cells());
  }
  ASSERT_EQ(found[0].size(), found[1].size());
  for (std::size_t k = 0; k < found[0].size(); ++k) EXPECT_EQ(*found[0][k].centres, *found[1][k].centres);
}
