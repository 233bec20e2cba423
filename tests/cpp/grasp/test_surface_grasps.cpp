#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"

namespace mmgrasp {
namespace {

LinkShape shape_at(const Shape& shape, const Pose& pose = Pose::Identity()) {
  LinkShape result;
  result.shape = shape;
  result.T_link_shape = pose;
  return result;
}

/// A crossing of a line with the surface.
struct Crossing {
  double t;
  Eigen::Vector3d normal;
};

/// By the plane of each triangle and three edge tests: another way than the sampler's.
std::vector<Crossing> line_crossings(const TriangleMesh& mesh, const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& direction) {
  std::vector<Crossing> crossings;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
    const double slope = normal.dot(direction);
    if (std::abs(slope) < 1e-12) continue;
    const double t = normal.dot(a - origin) / slope;
    const Eigen::Vector3d p = origin + t * direction;
    const double tolerance = -1e-12;
    if ((b - a).cross(p - a).dot(normal) < tolerance || (c - b).cross(p - b).dot(normal) < tolerance ||
        (a - c).cross(p - c).dot(normal) < tolerance)
      continue;
    crossings.push_back({t, normal});
  }
  return crossings;
}

/// Both contacts are crossings of the contact line, normals outward, within the friction cone.
void expect_antipodal(const TriangleMesh& mesh, const Grasp& grasp, const Hand& gripper, double friction) {
  const Eigen::Vector3d closing = grasp.T_object_hand.linear() * gripper.closing;
  const auto crossings = line_crossings(mesh, grasp.T_object_hand.translation(), closing);
  for (const double side : {-1.0, 1.0}) {
    const bool found = std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
      const double cosine = side * crossing.normal.dot(closing);
      return std::abs(crossing.t - side * grasp.opening / 2) < 1e-7 && cosine > 0 &&
             std::acos(std::min(1.0, cosine)) <= std::atan(friction) + 1e-9;
    });
    EXPECT_TRUE(found) << "no contact at side " << side;
  }
}

TEST(SurfaceGrasps, PairsOnRealMeshesAreAntipodalByBruteForce) {
  const std::filesystem::path folder = std::filesystem::path(MMGRASP_SHARED_DATA) / "meshes";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no meshes in " << folder;
  Hand gripper;
  gripper.max_opening = 0.12;
  GraspSamplerOptions options;
  options.friction = 0.4;
  options.max_grasps = 1000000;
  options.approaches = 1;
  for (const char* name :
       {"ycb/YcbMustardBottle/textured_simple_reoriented.obj", "ycb/YcbBanana/textured_simple_reoriented.obj",
        "ariac/battery/meshes/battery_collision.stl"}) {
    const auto mesh = load_mesh((folder / name).string());
    ASSERT_TRUE(mesh->closed) << name;
    const auto grasps = sample_grasps({shape_at(MeshShape{mesh})}, gripper, options).grasps;
    EXPECT_GT(grasps.size(), 100u) << name;
    for (const Grasp& grasp : grasps) {
      expect_antipodal(*mesh, grasp, gripper, options.friction);
      EXPECT_LE(grasp.opening, gripper.max_opening);
    }
  }
}

TEST(SurfaceGrasps, MeshOfABoxGivesTheBoxesWidths) {
  const Eigen::Vector3d size(0.03, 0.05, 0.08);
  const Pose T = pose_from_xyz_rpy({0.2, 0.1, 0}, {0.3, 0.2, 0.1});
  Hand gripper;
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  options.friction = 0.3;
  const auto grasps = sample_grasps({shape_at(MeshShape{shape_mesh(Box{size})}, T)}, gripper, options).grasps;
  ASSERT_GT(grasps.size(), 1000u);
  int straight = 0;
  for (const Grasp& grasp : grasps) {
    const Eigen::Vector3d closing = T.linear().transpose() * (grasp.T_object_hand.linear() * gripper.closing);
    Eigen::Index axis;
    const double cosine = closing.cwiseAbs().maxCoeff(&axis);
    // A tilted line between the two faces is longer by 1 / cos, and tilted by no more than the cone.
    EXPECT_NEAR(grasp.opening, size[axis] / cosine, 1e-9);
    EXPECT_GE(cosine, std::cos(std::atan(options.friction)) - 1e-12);
    straight += cosine > 1 - 1e-12;
  }
  EXPECT_GE(straight, static_cast<int>(grasps.size()) / 3);
}

TEST(SurfaceGrasps, AWedgeNeedsFrictionForHalfItsAngleOnEachSide) {
  // Prism over an isosceles triangle whose two long faces meet at 30 degrees: each normal is 15 degrees off the line
  // across, so pairs over these faces exist if and only if friction exceeds tan(15 degrees) = 0.268.
  const double h = 0.06, half = h * std::tan(0.2617993877991494), depth = 0.02;
  std::vector<Eigen::Vector3d> points;
  for (const double y : {-depth, depth})
    for (const auto& [x, z] : {std::pair{-half, 0.0}, std::pair{half, 0.0}, std::pair{0.0, h}})
      points.emplace_back(x, y, z);
  const auto wedge = convex_hull(points);
  Hand gripper;
  const auto across = [&](double friction) {
    GraspSamplerOptions options;
    options.friction = friction;
    options.mesh_samples = 4000;
    options.max_grasps = 1000000;
    int count = 0;
    for (const Grasp& grasp : sample_grasps({shape_at(MeshShape{wedge})}, gripper, options).grasps)
      count += std::abs((grasp.T_object_hand.linear() * gripper.closing).x()) > 0.8;
    return count;
  };
  EXPECT_EQ(across(0.25), 0);
  EXPECT_GT(across(0.40), 0);
}

TEST(SurfaceGrasps, TooWidePairsEqualARecountWithAWiderGripper) {
  const auto mesh = shape_mesh(Cylinder{0.03, 0.09});
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  options.approaches = 1;
  Hand narrow, wide;
  narrow.max_opening = 0.07;
  wide.max_opening = 1;
  const auto [kept, narrow_count] = sample_grasps({shape_at(MeshShape{mesh})}, narrow, options);
  const auto [all, wide_count] = sample_grasps({shape_at(MeshShape{mesh})}, wide, options);
  EXPECT_EQ(wide_count, 0);
  const auto wider = std::count_if(all.begin(), all.end(), [](const Grasp& grasp) { return grasp.opening > 0.07; });
  EXPECT_GT(wider, 0);
  EXPECT_EQ(narrow_count, wider / 2);  // a pair gives one approach here, and its flip
  EXPECT_EQ(kept.size() + wider, all.size());
}

TEST(SurfaceGrasps, ShapesThatOverlapAreOneSolid) {
  // Two boxes that overlap by 1 cm make a bar of 9 x 2 x 2 cm: no contact may lie on the walls buried inside.
  const Box half{{0.05, 0.02, 0.02}};
  for (const double shift : {0.02, 0.025}) {  // overlapping, and touching face to face
    Pose left = Pose::Identity(), right = Pose::Identity();
    left.translation().x() = -shift;
    right.translation().x() = shift;
    const double length = 0.05 + 2 * shift;
    Hand gripper;
    gripper.max_opening = 0.2;
    GraspSamplerOptions options;
    options.max_grasps = 1000000;
    options.friction = 0.2;
    const auto grasps = sample_grasps({shape_at(half, left), shape_at(half, right)}, gripper, options).grasps;
    ASSERT_GT(grasps.size(), 1000u);
    for (const Grasp& grasp : grasps) {
      const Eigen::Vector3d closing = grasp.T_object_hand.linear() * gripper.closing;
      Eigen::Index axis;
      const double cosine = closing.cwiseAbs().maxCoeff(&axis);
      EXPECT_NEAR(grasp.opening, (axis == 0 ? length : 0.02) / cosine, 1e-9);
    }
  }
}

TEST(SurfaceGrasps, OpenSurfacesAreHeldFromWallToWall) {
  // Two parallel square plates 4 cm apart, no sides.
  const auto mesh = make_mesh(
      {{0, 0, 0}, {.05, 0, 0}, {.05, .05, 0}, {0, .05, 0}, {0, 0, .04}, {.05, 0, .04}, {.05, .05, .04}, {0, .05, .04}},
      {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}});
  ASSERT_FALSE(mesh->closed);
  Hand gripper;
  const auto grasps = sample_grasps({shape_at(MeshShape{mesh})}, gripper).grasps;
  ASSERT_FALSE(grasps.empty());
  for (const Grasp& grasp : grasps) {
    const double cosine = std::abs((grasp.T_object_hand.linear() * gripper.closing).z());
    EXPECT_NEAR(grasp.opening, 0.04 / cosine, 1e-9);
  }
}

TEST(SurfaceGrasps, SeedDecidesTheAnswer) {
  const auto mesh = shape_mesh(Sphere{0.03});
  Hand gripper;
  GraspSamplerOptions options;
  const auto first = sample_grasps({shape_at(MeshShape{mesh})}, gripper, options).grasps;
  const auto again = sample_grasps({shape_at(MeshShape{mesh})}, gripper, options).grasps;
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].T_object_hand.matrix(), again[i].T_object_hand.matrix());
    EXPECT_EQ(first[i].quality, again[i].quality);
  }
  options.seed = 2;
  const auto other = sample_grasps({shape_at(MeshShape{mesh})}, gripper, options).grasps;
  ASSERT_FALSE(other.empty());
  EXPECT_NE(first.front().T_object_hand.matrix(), other.front().T_object_hand.matrix());
}

}  // namespace
}  // namespace mmgrasp
