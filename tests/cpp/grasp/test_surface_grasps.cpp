#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <variant>

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

/// The triangles that come as near to a line.
TriangleMesh near_line(const TriangleMesh& mesh, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       double radius) {
  TriangleMesh near;
  near.vertices = mesh.vertices;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3d first = mesh.vertices[triangle[0]];
    double size = 0;
    for (const int v : triangle) size = std::max(size, (mesh.vertices[v] - first).norm());
    if ((first - origin).cross(direction).norm() <= radius + size) near.triangles.push_back(triangle);
  }
  return near;
}

/// How far a mesh reaches towards a finger on one side of the hand, by lines over its pad; what a gap for a
/// finger separates from the middle does not count.
struct Reached {
  double most = 0;
  bool within_cone = false;  // Some surface among the outermost 0.5 mm is held by friction.
};

Reached reached(const TriangleMesh& mesh, const Grasp& grasp, const Hand& hand, double side, double friction) {
  constexpr int kLines = 21;  // the outermost ones just within the pad's edges
  const Eigen::Matrix3d R = grasp.T_object_hand.linear();
  const Eigen::Vector3d out = side * (R * hand.closing), along = R * hand.approach, across = along.cross(out);
  const TriangleMesh near =
      near_line(mesh, grasp.T_object_hand.translation(), out, std::hypot(hand.finger_depth, hand.finger_width) / 2);
  std::vector<Crossing> found;
  for (int i = 0; i < kLines; ++i) {
    for (int k = 0; k < kLines; ++k) {
      const double u = 0.9999 * hand.finger_depth * (i / (kLines - 1.0) - 0.5),
                   v = 0.9999 * hand.finger_width * (k / (kLines - 1.0) - 0.5);
      const Eigen::Vector3d from = grasp.T_object_hand.translation() + u * along + v * across;
      for (const Crossing& crossing : line_crossings(near, from, out)) found.push_back(crossing);
    }
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  const double gap = std::max(hand.clearance, hand.body.finger_thickness);
  Reached result;
  for (const Crossing& crossing : found)
    if (crossing.t < std::max(result.most, 0.5 * grasp.opening - 1e-9) + gap)
      result.most = std::max(result.most, crossing.t);
  for (const Crossing& crossing : found)
    result.within_cone |= std::abs(crossing.t - 0.5 * grasp.opening) < 1.5e-3 &&
                          std::acos(std::min(1.0, crossing.normal.dot(out))) <= std::atan(friction) + 1e-9;
  return result;
}

/// Both pads stand on the part, neither in it, and friction holds what they stand on.
void expect_held(const TriangleMesh& mesh, const Grasp& grasp, const Hand& hand, double friction) {
  for (const double side : {-1.0, 1.0}) {
    const Reached own = reached(mesh, grasp, hand, side, friction);
    EXPECT_LE(own.most, 0.5 * grasp.opening + 1e-9) << "a pad is in the part at side " << side;
    EXPECT_GE(own.most, 0.5 * grasp.opening - 2e-3) << "a pad touches nothing at side " << side;
    EXPECT_TRUE(own.within_cone) << "nothing holds at side " << side;
  }
}

TEST(SurfaceGrasps, PadsStandOnRealMeshesByBruteForce) {
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
    EXPECT_GT(grasps.size(), 50u) << name;
    for (const Grasp& grasp : grasps) EXPECT_LE(grasp.opening, gripper.max_opening);
    for (std::size_t i = 0; i < grasps.size(); i += grasps.size() / 12)
      expect_held(*mesh, grasps[i], gripper, options.friction);
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
    // A tilted line between the two faces is longer by 1 / cos, and tilted by no more than the cone; pads that stand
    // across it are kept farther apart by the faces' outer ends.
    EXPECT_GE(cosine, std::cos(std::atan(options.friction)) - 1e-12);
    EXPECT_GE(grasp.opening, size[axis] / cosine - 1e-9);
    if (cosine < 1 - 1e-12) continue;
    EXPECT_NEAR(grasp.opening, size[axis], 1e-9);
    ++straight;
  }
  TriangleMesh placed = *shape_mesh(Box{size});
  for (Eigen::Vector3d& vertex : placed.vertices) vertex = T * vertex;
  for (std::size_t i = 0; i < grasps.size(); i += 40) expect_held(placed, grasps[i], gripper, options.friction);
  EXPECT_GE(straight, static_cast<int>(grasps.size()) / 3);
}

TEST(SurfaceGrasps, TipsAreFlushWithTheFarthestVertexOfAFlatMesh) {
  Hand gripper;
  gripper.finger_depth = 0.04;
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  const Pose askew = pose_from_xyz_rpy({0.2, 0.1, 0}, {0.3, 0.2, 0.1});
  for (const auto& [shape, T] : {std::pair{Shape(Box{{0.05, 0.04, 0.016}}), Pose(Pose::Identity())},
                                 std::pair{Shape(Cylinder{0.03, 0.01}), Pose(Pose::Identity())},
                                 std::pair{Shape(Box{{0.05, 0.04, 0.016}}), askew}}) {
    TriangleMesh placed = *shape_mesh(shape);
    const SampledGrasps sampled = sample_grasps({shape_at(MeshShape{shape_mesh(shape)}, T)}, gripper, options);
    for (Eigen::Vector3d& vertex : placed.vertices) vertex = T * vertex;
    std::vector<Grasp> flush;
    int straight_down = 0;
    for (const Grasp& grasp : sampled.grasps) {
      if (!std::get<ContactPairProvenance>(grasp.provenance).tips_flush) continue;
      flush.push_back(grasp);
      const Eigen::Vector3d approach = grasp.T_object_hand.linear() * gripper.approach;
      double far = -1;
      for (const Eigen::Vector3d& vertex : placed.vertices) far = std::max(far, approach.dot(vertex));
      EXPECT_NEAR(approach.dot(grasp.T_object_hand.translation()) + 0.02, far, 1e-12);
      straight_down += std::abs(approach.dot(T.linear().col(2))) > 1 - 1e-9;
    }
    EXPECT_EQ(sampled.tips_flush, static_cast<int>(flush.size()));
    EXPECT_GT(flush.size(), 500u);
    if (T.isApprox(Pose::Identity())) {
      EXPECT_GT(straight_down, 20);
    }
    for (std::size_t i = 0; i < flush.size(); i += 1 + flush.size() / 50)
      expect_held(placed, flush[i], gripper, options.friction);
  }
}

TEST(SurfaceGrasps, PadsStandOnASlantedPartNotInIt) {
  // Half an angle of 20 degrees, within the friction cone, and pads of 4 cm: their lower ends meet the cone up to 2 cm
  // below the contacts, where it is wider by 2 * 20 mm * tan(20 degrees) = 15 mm.
  std::vector<Eigen::Vector3d> points{{0, 0, 0.08}};
  for (int i = 0; i < 32; ++i) {
    const double angle = i * 2 * 3.14159265358979323846 / 32;
    points.emplace_back(0.03 * std::cos(angle), 0.03 * std::sin(angle), 0);
  }
  const auto cone = convex_hull(points);
  Hand hand;
  hand.finger_depth = 0.04;
  hand.finger_width = 0.022;
  const auto grasps = sample_grasps({shape_at(MeshShape{cone})}, hand).grasps;
  EXPECT_EQ(grasps.size(), 200u);
  for (const Grasp& grasp : grasps) expect_held(*cone, grasp, hand, 0.5);
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

TEST(SurfaceGrasps, AKnobOnALargeBlockIsFound) {
  // The knob has 1 % of the surface; the rest is wider than the hand opens.
  const std::vector<LinkShape> block{shape_at(Box{{0.3, 0.3, 0.2}}),
                                     shape_at(Cylinder{0.015, 0.03}, pose_from_xyz_rpy({0, 0, 0.115}, {0, 0, 0}))};
  Hand hand;
  GraspSamplerOptions options;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    options.seed = seed;
    EXPECT_FALSE(sample_grasps(block, hand, options).grasps.empty()) << seed;
  }
}

TEST(SurfaceGrasps, TooWidePairsEqualARecountWithAWiderGripper) {
  const auto mesh = shape_mesh(Cylinder{0.03, 0.09});
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  options.approaches = 1;
  Hand narrow, wide;
  narrow.max_opening = 0.07;
  wide.max_opening = 1;
  const SampledGrasps kept = sample_grasps({shape_at(MeshShape{mesh})}, narrow, options);
  const SampledGrasps all = sample_grasps({shape_at(MeshShape{mesh})}, wide, options);
  EXPECT_EQ(all.too_wide, 0);
  std::map<int, double> narrowest;  // opening at each pair
  std::size_t wider = 0;
  for (const Grasp& grasp : all.grasps) {
    const int pair = std::get<ContactPairProvenance>(grasp.provenance).pair;
    const auto [found, added] = narrowest.try_emplace(pair, grasp.opening);
    found->second = std::min(found->second, grasp.opening);
    wider += grasp.opening > 0.07;
  }
  const auto too_wide =
      std::count_if(narrowest.begin(), narrowest.end(), [](const auto& one) { return one.second > 0.07; });
  EXPECT_GT(too_wide, 0);
  EXPECT_EQ(kept.too_wide, too_wide);
  EXPECT_EQ(kept.grasps.size() + wider, all.grasps.size());
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
      const double straight = axis == 0 ? length : 0.02;
      EXPECT_GE(grasp.opening, straight / cosine - 1e-9);
      if (cosine > 1 - 1e-12) {
        EXPECT_NEAR(grasp.opening, straight, 1e-9);
      }
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
    EXPECT_GE(grasp.opening, 0.04 / cosine - 1e-9);
    if (cosine > 1 - 1e-12) {
      EXPECT_NEAR(grasp.opening, 0.04, 1e-9);
    }
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
