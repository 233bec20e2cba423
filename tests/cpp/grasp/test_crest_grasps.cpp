// Grasps of turned parts whose surface under the pads is edges: threads, grooves, bellows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kSides = 48;
constexpr double kDegree = kPi / 180;

/// A point of a turned part's outline.
struct Ring {
  double z, radius;
};

/// The solid that rings of kSides vertices make about z, one after the other, with a disc at either end.
std::shared_ptr<const TriangleMesh> closed_by_discs(std::vector<Eigen::Vector3d> vertices, int rings) {
  std::vector<std::array<int, 3>> triangles;
  const int bottom = rings * kSides, top = bottom + 1;
  const double low = vertices.front().z(), high = vertices.back().z();
  vertices.emplace_back(0, 0, low);
  vertices.emplace_back(0, 0, high);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    for (int k = 0; k + 1 < rings; ++k) {
      const int a = k * kSides + i, b = k * kSides + next;
      triangles.push_back({a, b, b + kSides});
      triangles.push_back({a, b + kSides, a + kSides});
    }
    triangles.push_back({bottom, next, i});
    triangles.push_back({top, (rings - 1) * kSides + i, (rings - 1) * kSides + next});
  }
  return make_mesh(vertices, triangles);
}

/// The solid that an outline makes about z.
std::shared_ptr<const TriangleMesh> turned(const std::vector<Ring>& outline) {
  std::vector<Eigen::Vector3d> vertices;
  for (const Ring& ring : outline)
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2 * kPi * i / kSides;
      vertices.emplace_back(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z);
    }
  return closed_by_discs(vertices, static_cast<int>(outline.size()));
}

/// A rod about z with a screw thread of triangular crests, meshed in rings around its axis.
std::shared_ptr<const TriangleMesh> threaded(double radius, double depth, double length, double pitch) {
  constexpr int kPerTurn = 8;
  const int rings = static_cast<int>(std::lround(length / pitch * kPerTurn)) + 1;
  std::vector<Eigen::Vector3d> vertices;
  for (int k = 0; k < rings; ++k)
    for (int i = 0; i < kSides; ++i) {
      const double z = length * k / (rings - 1) - length / 2, turns = static_cast<double>(i) / kSides;
      const double phase = z / pitch - turns, below = 2 * std::abs(phase - std::round(phase));  // 0 at a crest
      const double r = radius - depth * below;
      vertices.emplace_back(r * std::cos(2 * kPi * turns), r * std::sin(2 * kPi * turns), z);
    }
  return closed_by_discs(vertices, rings);
}

/// V-shaped grooves of 60 degrees from end to end, crests at the radius.
std::vector<Ring> grooved(double radius, double length, double pitch) {
  const double depth = pitch / 2 / std::tan(30 * kDegree);
  const int count = static_cast<int>(std::lround(length / pitch));
  std::vector<Ring> outline;
  for (int i = 0; i < count; ++i) {
    outline.push_back({-length / 2 + i * pitch, radius});
    outline.push_back({-length / 2 + (i + 0.5) * pitch, radius - depth});
  }
  outline.push_back({length / 2, radius});
  return outline;
}

std::vector<Ring> smooth(double radius, double length) {
  return {{-length / 2, radius}, {length / 2, radius}};
}

/// A shaft with crests of 60 degrees that stand 4 mm out of it.
std::vector<Ring> shaft_with_crests(const std::vector<double>& heights) {
  const double radius = 0.010, out = 0.004, half = out * std::tan(30 * kDegree);
  std::vector<Ring> outline{{-0.03, radius}};
  for (const double z : heights)
    for (const Ring& ring : {Ring{z - half, radius}, Ring{z, radius + out}, Ring{z + half, radius}})
      outline.push_back(ring);
  outline.push_back({0.03, radius});
  return outline;
}

Hand gripper() {
  Hand hand;
  hand.finger_depth = 0.04;
  hand.finger_width = 0.022;
  return hand;
}

std::vector<Grasp> grasps_of(const std::vector<Ring>& outline, int most = 1000000) {
  LinkShape part;
  part.shape = MeshShape{turned(outline)};
  GraspSamplerOptions options;
  options.max_grasps = most;
  options.mesh_samples = 100;
  options.approaches = 4;
  return sample_grasps({part}, gripper(), options).grasps;
}

Eigen::Vector3d closing(const Grasp& grasp) {
  return grasp.T_object_hand.linear() * gripper().closing;
}

/// How far the pads are from standing straight across the axis of a turned part [rad].
double tilt(const Grasp& grasp) {
  return std::asin(std::min(1.0, std::abs(closing(grasp).z())));
}

/// The first that close across the axis rather than along it.
std::vector<Grasp> best_across(const std::vector<Grasp>& grasps, std::size_t most) {
  std::vector<Grasp> across;
  for (const Grasp& grasp : grasps)
    if (tilt(grasp) < 45 * kDegree && across.size() < most) across.push_back(grasp);
  return across;
}

verify::CheckedPads checked_pads() {
  const Hand hand = gripper();
  return {hand.approach, hand.closing, hand.max_opening, hand.finger_depth, hand.finger_width, hand.clearance};
}

TEST(CrestGrasps, AGroovedRodIsHeldAsTheSmoothOneOfItsOutline) {
  const double length = 0.05;
  for (const auto& [radius, pitch] : {std::pair{0.015, 0.001}, std::pair{0.003, 0.0005}, std::pair{0.002, 0.0002}}) {
    const std::vector<Ring> outline = grooved(radius, length, pitch);
    const std::vector<Grasp> rough = best_across(grasps_of(outline, 200), 12),
                             even = best_across(grasps_of(smooth(radius, length), 200), 12);
    ASSERT_EQ(rough.size(), 12u) << radius << " " << pitch;
    ASSERT_EQ(even.size(), 12u);
    LinkShape part;
    part.shape = MeshShape{turned(outline)};
    for (std::size_t i = 0; i < rough.size(); ++i) {
      EXPECT_NEAR(tilt(rough[i]), tilt(even[i]), 1 * kDegree) << radius << " " << pitch;
      EXPECT_NEAR(rough[i].opening, even[i].opening, 1e-4) << radius << " " << pitch;
      EXPECT_NEAR(rough[i].opening, 2 * radius, 1e-4);
      if (i % 4 > 0) continue;
      verify::CheckedGrasp grasp{rough[i].T_object_hand, rough[i].opening};
      EXPECT_EQ(verify::pads_unlike_grasp(checked_pads(), {part}, grasp), "");
      grasp.T_object_hand.translation() += 0.005 * closing(rough[i]);
      EXPECT_NE(verify::pads_unlike_grasp(checked_pads(), {part}, grasp), "");
    }
  }
}

TEST(CrestGrasps, ACoarseThreadHeldAskewIsLessAlignedThanStraightAcross) {
  LinkShape part;
  part.shape = MeshShape{threaded(0.012, 0.0025, 0.08, 0.004)};
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  options.approaches = 4;
  double straight = 0, askew = 0;
  for (const Grasp& grasp : sample_grasps({part}, gripper(), options).grasps) {
    const double alignment = grasp.quality_factors.front().value;
    if (tilt(grasp) < 3 * kDegree) straight = std::max(straight, alignment);
    if (tilt(grasp) > 8 * kDegree && tilt(grasp) < 45 * kDegree) askew = std::max(askew, alignment);
  }
  EXPECT_GT(straight, 0.75);
  EXPECT_LT(askew, straight - 0.2);
}

TEST(CrestGrasps, ASharpRingIsNoFlatContact) {
  // Pads on the one crest, which is 28 mm wide, can rock about its tangent; on the shaft beside it there is room for
  // none.
  for (const Grasp& grasp : grasps_of(shaft_with_crests({0}))) {
    if (tilt(grasp) > 45 * kDegree) continue;
    EXPECT_GT(std::abs(grasp.opening - 0.028), 1e-4) << tilt(grasp) / kDegree;
  }
}

TEST(CrestGrasps, TwoSharpRingsHoldAPad) {
  const std::vector<Grasp> across = best_across(grasps_of(shaft_with_crests({-0.006, 0.006})), 10);
  ASSERT_EQ(across.size(), 10u);
  for (const Grasp& grasp : across) {
    EXPECT_LT(tilt(grasp), 1 * kDegree);
    EXPECT_NEAR(grasp.opening, 0.028, 1e-4);
  }
}

TEST(CrestGrasps, AKnifeEdgeIsNoFlatContact) {
  // A rhombic prism: its edges of 60 degrees along z are 30 mm apart, those of 120 degrees 17 mm. Normals are 60 and 30
  // degrees off the lines across, and friction holds 26.6 degrees.
  const double half = 0.015, low = half * std::tan(30 * kDegree);
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {-0.03, 0.03})
    for (const Eigen::Vector2d& xy :
         {Eigen::Vector2d(half, 0), Eigen::Vector2d(-half, 0), Eigen::Vector2d(0, low), Eigen::Vector2d(0, -low)})
      corners.emplace_back(xy.x(), xy.y(), z);
  // A dent in an end face: the prism is no longer its own hull.
  const auto hull = convex_hull(corners);
  std::vector<Eigen::Vector3d> vertices = hull->vertices;
  std::vector<std::array<int, 3>> triangles;
  const int dent = static_cast<int>(vertices.size());
  vertices.emplace_back(0, 0, 0.025);
  std::vector<std::array<int, 3>> top;
  for (const auto& t : hull->triangles) {
    const bool on_top = std::all_of(t.begin(), t.end(), [&](int v) { return vertices[v].z() > 0.029; });
    (on_top ? top : triangles).push_back(t);
  }
  for (const auto& t : top)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      const bool inner = std::any_of(top.begin(), top.end(), [&](const auto& other) {
        for (int m = 0; m < 3; ++m)
          if (other[m] == b && other[(m + 1) % 3] == a) return true;
        return false;
      });
      if (!inner) triangles.push_back({a, b, dent});
    }
  LinkShape part;
  part.shape = MeshShape{make_mesh(vertices, triangles)};
  ASSERT_TRUE(std::get<MeshShape>(part.shape).mesh->closed);
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  for (const Grasp& grasp : sample_grasps({part}, gripper(), options).grasps) {
    EXPECT_LT(std::abs(closing(grasp).x()), std::cos(30 * kDegree));
    EXPECT_LT(std::abs(closing(grasp).y()), std::cos(3.4 * kDegree));
  }
}

}  // namespace
}  // namespace mmgrasp
