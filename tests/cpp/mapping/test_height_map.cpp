#include "mmgrasp/mapping/height_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/tray_scene.hpp"

using namespace mmgrasp;
using tray_scene::flat;

namespace {

const Plane kFloor{Eigen::Vector3d::UnitZ(), 0.0};
const PlacedShape kBox{Box{{0.06, 0.04, 0.05}}, flat(0.11, -0.06, 0.025, 0.4)};

bool on_box(const Eigen::Vector2d& p, double grow) {
  const Eigen::Vector3d q = kBox.T_world_shape.inverse() * Eigen::Vector3d(p.x(), p.y(), 0);
  return std::abs(q.x()) < 0.03 + grow && std::abs(q.y()) < 0.02 + grow;
}

}  // namespace

TEST(HeightMap, FloorAndBoxAtTheirHeights) {
  const HeightMap map = tray_scene::map_of({{kFloor, Pose::Identity()}, kBox}, {0.4, 0.3});
  ASSERT_EQ(map.nx, 200);
  ASSERT_EQ(map.ny, 150);
  EXPECT_NEAR(map.pixel, 0.8 / 525, 1e-9);
  int top = 0, hidden = 0;
  for (int iy = 0; iy < map.ny; ++iy) {
    for (int ix = 0; ix < map.nx; ++ix) {
      const float h = map.height[map.index(ix, iy)], upper = map.upper[map.index(ix, iy)];
      const Eigen::Vector2d p = map.centre(ix, iy);
      // The box hides at most 0.05 / 0.75 of its distance from the axis behind it, and pixels are 1.5 mm wide.
      if (on_box(p, -0.002)) {
        ASSERT_NEAR(h, 0.05, 1e-5);
        ++top;
      } else if (!on_box(p, 0.013)) {
        ASSERT_NEAR(h, 0, 1e-5);
        ASSERT_NEAR(upper, 0, 1e-5);
      } else if (std::isnan(h)) {
        ++hidden;
      }
      // No surface lies higher than `upper`, whatever part of the cell it is in.
      if (on_box(p, -0.0001)) {
        ASSERT_GE(upper, 0.05 - 1e-5);
      }
    }
  }
  EXPECT_GT(top, 400);
  EXPECT_GT(hidden, 10);
}

TEST(HeightMap, UpperBoundsEverySceneFromAnySide) {
  // Balls and boxes seen askew: a fine rendering from straight above says how high they truly are.
  Rng rng(11);
  std::vector<PlacedShape> scene{{kFloor, Pose::Identity()}};
  for (int i = 0; i < 12; ++i) {
    Pose T = Pose(rng.rotation());
    T.translation() << rng.uniform(-0.12, 0.12), rng.uniform(-0.1, 0.1), rng.uniform(0.0, 0.04);
    scene.push_back({i % 2 ? Shape(Box{{0.05, 0.03, 0.02}}) : Shape(Sphere{0.02}), T});
  }
  const HeightMap truth = [&] {
    PinholeCamera fine;  // from so far away that the rays are parallel
    fine.width = 400;
    fine.height = 300;
    fine.fx = fine.fy = 1e6;
    fine.cx = 199.5;
    fine.cy = 149.5;
    fine.farthest = 1e4;
    HeightMapOptions options;
    options.resolution = 0.002;
    return make_height_map(render_depth(scene, fine, look_down({0, 0, 1000})), Pose::Identity(), {0.34, 0.26}, options);
  }();
  for (const double tilt : {-0.4, 0.0, 0.5}) {
    const Pose camera = Pose(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX())) * look_down({0.05, 0, 0.7});
    const HeightMap map = make_height_map(render_depth(scene, PinholeCamera(), camera), Pose::Identity(), {0.34, 0.26});
    int known = 0, below = 0;
    for (std::size_t i = 0; i < map.upper.size(); ++i) {
      if (std::isnan(map.upper[i]) || std::isnan(truth.height[i])) continue;
      ++known;
      below += map.upper[i] < truth.height[i] - 0.0015;  // slopes between two pixels
    }
    EXPECT_GT(known, 10000);
    EXPECT_LE(below, known / 1000) << tilt;
  }
}

TEST(HeightMap, SmallHolesAreFilledLargeOnesStayUnknown) {
  std::vector<PlacedShape> scene{{kFloor, Pose::Identity()}};
  RenderOptions render;
  render.missing = 0.2;
  HeightMap map = tray_scene::map_of(scene, {0.3, 0.2}, 0.002, render);
  for (const float h : map.height) ASSERT_NEAR(h, 0, 1e-5);
  PinholeCamera camera;
  DepthImage image = render_depth(scene, camera, look_down({0, 0, 0.8}));
  for (int v = 200; v < 260; ++v)
    for (int u = 300; u < 360; ++u) image.depth[static_cast<std::size_t>(v) * 640 + u] = 0;
  map = make_height_map(image, Pose::Identity(), {0.3, 0.2});
  int unknown = 0;
  for (const float h : map.upper) unknown += std::isnan(h);
  const double hole = 60 * map.pixel / map.resolution, least = 50 * map.pixel / map.resolution;
  EXPECT_LT(unknown, hole * hole);
  EXPECT_GT(unknown, least * least);
}

TEST(HeightMap, MisuseIsRefused) {
  DepthImage image{PinholeCamera(), Pose::Identity(), {}};
  EXPECT_THROW(make_height_map(image, Pose::Identity(), {0.3, 0.2}), InvalidInput);
  image.depth.assign(640 * 480, 1.0f);
  EXPECT_THROW(make_height_map(image, Pose::Identity(), {-0.3, 0.2}), InvalidInput);
  HeightMapOptions options;
  options.resolution = 0;
  EXPECT_THROW(make_height_map(image, Pose::Identity(), {0.3, 0.2}, options), InvalidInput);
}
