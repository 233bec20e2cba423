#include "mmgrasp/grasp/finger_length_range.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Mesh = std::shared_ptr<const TriangleMesh>;

Mesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(), i & 4 ? high.z() : low.z());
  }
  return convex_hull(corners);
}

Mesh cylinder(double radius, double low, double high) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 64; ++i) {
    const double turn = 2 * M_PI * i / 64;
    for (const double z : {low, high}) points.emplace_back(radius * std::cos(turn), radius * std::sin(turn), z);
  }
  return convex_hull(points);
}

/// A ring of square cross-section round z, in four open strips: outer and inner wall, both ends.
Mesh ring(double inner, double outer, double low, double high) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  const int n = 64;
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * M_PI * i / n;
    for (const auto& [r, z] : {std::pair{outer, low}, {outer, high}, {inner, high}, {inner, low}}) {
      vertices.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 4; ++k) {
      const int a = 4 * i + k, b = 4 * i + (k + 1) % 4, c = 4 * ((i + 1) % n) + k, d = 4 * ((i + 1) % n) + (k + 1) % 4;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  }
  return make_mesh(vertices, triangles);
}

Pose at(double x, double y, double z) {
  Pose out = Pose::Identity();
  out.translation() << x, y, z;
  return out;
}

/// From above, tips at a height.
Pose from_above(double tips) {
  Pose out = at(0, 0, tips);
  out.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return out;
}

/// A sleeve is put over a shaft that stands out of it by `out` at the end (P1 figure 5.16 (d)).
AssemblyOperation sleeve_on_shaft(double out) {
  AssemblyOperation operation;
  operation.active = {{"sleeve", ring(0.010, 0.020, 0, 0.015), Pose::Identity()}};
  operation.passive = {{"shaft", cylinder(0.009, -0.05, 0.015 + out), Pose::Identity()}};
  operation.motion = {at(0, 0, out + 0.02), at(0, 0, 0)};
  return operation;
}

AssemblyGrasp centric(double opening, double tips) {
  AssemblyGrasp grasp;
  grasp.fingers = 3;
  grasp.opening = opening;
  grasp.T_active_tool = from_above(tips);
  return grasp;
}

TEST(FingerLengthRange, ShaftsThatStandOutAskForLongFingers) {
  for (const double out : {0.041, 0.0227, 0.050}) {  // Figure 5.13's lengths.
    for (const double depth : {0.0, 0.003, 0.010}) {
      const FingerLengthRange range = finger_length_range(centric(0.040, 0.015 - depth), sleeve_on_shaft(out));
      EXPECT_TRUE(range.free);
      EXPECT_NEAR(range.shortest, out + depth, 2e-6);
      EXPECT_EQ(range.longest, std::numeric_limits<double>::infinity());
      EXPECT_EQ(range.shortest_by, "shaft at the end");
      EXPECT_EQ(range.longest_by, "");
    }
  }
}

TEST(FingerLengthRange, TeethAskForTheirDepth) {
  // Jaws reach past a gear's rim of 4.5 mm to its boss from the side.
  AssemblyOperation operation;
  operation.active = {{"boss", box({-0.0085, -0.03, -0.01}, {0.0085, 0.03, 0.01}), Pose::Identity()},
                      {"rim", box({-0.0085, -0.03, 0.01}, {0.0085, 0.03, 0.0145}), Pose::Identity()}};
  operation.motion = {Pose::Identity()};
  AssemblyGrasp grasp;
  grasp.opening = 0.017;
  grasp.T_active_tool = from_above(0.01);
  const FingerLengthRange range = finger_length_range(grasp, operation);
  EXPECT_TRUE(range.free);
  EXPECT_NEAR(range.shortest, 0.0045, 2e-6);
  EXPECT_EQ(range.shortest_by, "rim at the grasp");

  // A rim wider than the boss stands in the fingers' way.
  operation.active[1].mesh = box({-0.0125, -0.03, 0.01}, {0.0125, 0.03, 0.0145});
  const FingerLengthRange blocked = finger_length_range(grasp, operation);
  EXPECT_FALSE(blocked.free);
  EXPECT_EQ(blocked.longest_by, "rim at the grasp");
}

TEST(FingerLengthRange, RoofsBoundFingersFromAbove) {
  // The part is pushed sideways under a roof 30 mm above the tips, and drawn out again before it is let go.
  AssemblyOperation operation;
  operation.active = {{"part", box({-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}), Pose::Identity()}};
  operation.passive = {{"roof", box({-0.02, 0.05, 0.03}, {0.02, 0.1, 0.04}), Pose::Identity()}};
  operation.motion = {at(0, 0, 0), at(0, 0.05, 0), at(0, 0, 0)};
  AssemblyGrasp grasp;
  grasp.palm_radius = 0.005;  // Stays outside: only the fingers reach under the roof.
  grasp.width = 0.06;
  grasp.T_active_tool = from_above(0.0);
  const FingerLengthRange range = finger_length_range(grasp, operation, 0.0005);
  EXPECT_FALSE(range.free);  // The palm does too, after 45 mm: it would have to be longer than 40 mm.
  operation.motion[1] = at(0, 0.04, 0);
  const FingerLengthRange shallow = finger_length_range(grasp, operation, 0.0005);
  EXPECT_TRUE(shallow.free);
  EXPECT_NEAR(shallow.longest, 0.03, 0.0005);
  EXPECT_LE(shallow.longest, 0.03);
  EXPECT_EQ(shallow.longest_by, "roof at the motion");
  operation.motion.pop_back();  // Let go under the roof: the fingers cannot come out.
  EXPECT_FALSE(finger_length_range(grasp, operation).free);
}

TEST(FingerLengthRange, OpenFingersComeToThePartWhereTheMotionBegins) {
  // Walls beside the part at the beginning only, where fingers are closed free of them.
  AssemblyOperation operation;
  operation.active = {{"bar", box({-0.005, -0.02, -0.01}, {0.005, 0.02, 0.01}), Pose::Identity()}};
  AssemblyGrasp grasp;
  grasp.opening = 0.01;
  grasp.palm_radius = 0.005;
  grasp.T_active_tool = from_above(0.0);
  const double closed = 0.005 + grasp.thickness, open = closed + grasp.clearance;
  for (const double wall : {closed + 0.5 * grasp.clearance, open + 1e-4}) {
    operation.passive = {{"wall", box({wall, -0.05, 0.03}, {wall + 0.006, 0.05, 0.09}), Pose::Identity()}};
    operation.motion = {at(0, 0, 0.05), at(0, 0, -0.1)};
    const FingerLengthRange range = finger_length_range(grasp, operation);
    EXPECT_EQ(range.free, wall > open) << wall;
    EXPECT_EQ(range.longest_by == "wall at the start", wall < open) << range.longest_by;
  }
}

TEST(FingerLengthRange, TipsInsideASolidAreBlocked) {
  AssemblyOperation operation;
  operation.active = {{"plate", box({-0.01, -0.05, -0.001}, {0.01, 0.05, 0.001}), Pose::Identity()}};
  operation.passive = {{"block", box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), Pose::Identity()}};
  operation.motion = {Pose::Identity()};
  AssemblyGrasp grasp;
  grasp.T_active_tool = from_above(0.0);
  EXPECT_FALSE(finger_length_range(grasp, operation).free);
  operation.motion = {at(0, 0, 0.501)};  // On top of it.
  const FingerLengthRange above = finger_length_range(grasp, operation);
  EXPECT_TRUE(above.free);
  EXPECT_NEAR(above.shortest, 0.001, 2e-6);
}

/// Heights above the tips of points drawn in a box, within the outlines of palm and fingers.
struct Drawn {
  double palm = 0, finger = 0;
};

TEST(FingerLengthRange, AgreesWithDrawnPoints) {
  Rng rng(3);
  int open = 0, blocked = 0, grazed = 0;
  for (int trial = 0; trial < 200; ++trial) {
    AssemblyGrasp grasp = centric(0.01 + 0.03 * rng.uniform(), 0);
    grasp.fingers = trial % 2 ? 3 : 2;
    grasp.palm_radius = 0.05;
    grasp.width = 0.03;
    AssemblyOperation operation;
    operation.active = {{"part", box({-0.001, -0.001, -0.001}, {0.001, 0.001, 0}), Pose::Identity()}};
    const Eigen::Vector3d low(rng.uniform(-0.06, 0.04), rng.uniform(-0.06, 0.04), rng.uniform(-0.05, 0.1));
    const Eigen::Vector3d size(rng.uniform(0.01, 0.04), rng.uniform(0.01, 0.04), rng.uniform(0.01, 0.03));
    operation.passive = {{"box", box(low, low + size), Pose::Identity()}};
    const double drop = rng.uniform(-0.05, 0.05);
    operation.motion = {at(0, 0, drop), at(0, 0, 0)};
    Drawn drawn;
    const auto share = [&] { return std::clamp(rng.uniform(-0.4, 1.4), 0.0, 1.0); };  // Often on a face.
    for (int i = 0; i < 20000; ++i) {
      const Eigen::Vector3d p = low + size.cwiseProduct(Eigen::Vector3d(share(), share(), share()));
      for (const double way : {0.0, share()}) {
        const double h = p.z() - drop * way, open_by = way > 0 && way < 1 ? 0 : grasp.clearance;
        if (h <= 0) continue;
        if (p.head<2>().norm() < grasp.palm_radius) drawn.palm = std::max(drawn.palm, h);
        for (int f = 0; f < grasp.fingers; ++f) {
          const Eigen::Vector2d q = Eigen::Rotation2Dd(-2 * M_PI * f / grasp.fingers) * p.head<2>();
          if (std::abs(q.y()) < grasp.width / 2 && q.x() > grasp.opening / 2 &&
              q.x() < grasp.opening / 2 + grasp.thickness + open_by)
            drawn.finger = std::max(drawn.finger, h);
        }
      }
    }
    const FingerLengthRange range = finger_length_range(grasp, operation);
    if (range.free) {
      EXPECT_GE(range.shortest, drawn.palm - 1e-5) << trial;
      EXPECT_NEAR(range.shortest, drawn.palm, 0.004) << trial;
    }
    if (drawn.finger > 0) {  // Nothing may stand above the tips when the gripper opens, or come there before.
      EXPECT_FALSE(range.free) << trial;
      ++blocked;
    } else if (range.free) {
      EXPECT_EQ(range.longest, std::numeric_limits<double>::infinity()) << trial;
      ++open;
    } else {
      ++grazed;  // Points drawn at random miss what only just reaches into an outline.
    }
  }
  EXPECT_GT(open, 20);
  EXPECT_GT(blocked, 20);
  EXPECT_LT(grazed, 10);
}

/// A bar 0.3 m long, its middle where the file has it, turns by 90 degrees in place; it is held at its one end.
AssemblyOperation turning_bar(const Eigen::Vector3d& middle) {
  AssemblyOperation operation;
  const Eigen::Vector3d half(0.15, 0.005, 0.005);
  operation.active = {{"bar", box(middle - half, middle + half), Pose::Identity()}};
  Pose turned = Pose::Identity();
  turned.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turned.translation() = middle - turned.linear() * middle;
  operation.motion = {turned, Pose::Identity()};
  return operation;
}

AssemblyGrasp at_end_of_bar(const Eigen::Vector3d& middle) {
  AssemblyGrasp grasp;
  grasp.opening = 0.01;
  grasp.T_active_tool = from_above(0);
  grasp.T_active_tool.linear() =
      grasp.T_active_tool.linear() * Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  grasp.T_active_tool.translation() += middle + Eigen::Vector3d(0.14, 0, 0);
  return grasp;
}

PlacedMesh pin_at(const Eigen::Vector3d& place) {
  return {"pin", box(place - Eigen::Vector3d(0.002, 0.002, 0.1), place + Eigen::Vector3d(0.002, 0.002, 0.2)),
          Pose::Identity()};
}

TEST(FingerLengthRange, TurningPartsTakeTheGripperRoundTheirMiddle) {
  for (const Eigen::Vector3d& middle : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.3, 0.2, 0)}) {
    AssemblyOperation operation = turning_bar(middle);
    const AssemblyGrasp grasp = at_end_of_bar(middle);
    const double half = std::sqrt(0.5);
    operation.passive = {pin_at(middle + 0.14 * Eigen::Vector3d(half, half, 0))};  // on the arc
    const FingerLengthRange blocked = finger_length_range(grasp, operation);
    EXPECT_FALSE(blocked.free);
    EXPECT_EQ(blocked.shortest_by + blocked.longest_by, "pin at the motionpin at the motion");
    operation.passive = {pin_at(middle + Eigen::Vector3d(0.07, 0.07, 0))};  // on the chord, 41 mm inside of the arc
    const FingerLengthRange free = finger_length_range(grasp, operation);
    EXPECT_TRUE(free.free);
    EXPECT_NEAR(free.shortest, 0.005, 2e-6);  // the bar itself
    EXPECT_EQ(free.longest, std::numeric_limits<double>::infinity());
  }
}

TEST(FingerLengthRange, NothingThatAFinerLookMeetsIsMissedOnATurn) {
  Rng rng(5);
  int bounded = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Vector3d middle(rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), 0);
    AssemblyOperation operation = turning_bar(middle);
    operation.motion[0].translation() += Eigen::Vector3d(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), 0);
    AssemblyGrasp grasp = at_end_of_bar(middle);
    grasp.palm_radius = 0.02;
    const double turn = rng.uniform(0, M_PI / 2), radius = rng.uniform(0.1, 0.18), high = rng.uniform(0.01, 0.05);
    const Eigen::Vector3d tip = middle + Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn), high);
    operation.passive = {{"needle", box(tip - Eigen::Vector3d(1e-5, 1e-5, 0.2), tip), Pose::Identity()}};
    double under_palm = 0;
    bool under_finger = false;
    constexpr int kFine = 20000;
    for (int k = 0; k <= kFine; ++k) {  // Worked out by hand: the middle straight, the turn even.
      const double share = static_cast<double>(k) / kFine;
      Pose at = Pose::Identity();
      at.linear() = Eigen::AngleAxisd((1 - share) * M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
      at.translation() = (1 - share) * (operation.motion[0] * middle) + share * middle - at.linear() * middle;
      const Eigen::Vector3d seen = (at * grasp.T_active_tool).inverse() * tip;
      if (seen.head<2>().norm() < grasp.palm_radius) under_palm = high;
      under_finger = under_finger || (std::abs(seen.y()) < grasp.width / 2 && std::abs(seen.x()) > grasp.opening / 2 &&
                                      std::abs(seen.x()) < grasp.opening / 2 + grasp.thickness);
    }
    const FingerLengthRange range = finger_length_range(grasp, operation, 0.01);  // Coarse: the margin must bear it.
    if (under_palm > 0 && range.free) {
      EXPECT_GE(range.shortest, under_palm) << trial;
    }
    if (under_finger) {
      EXPECT_FALSE(range.free) << trial;
    }
    bounded += under_finger || under_palm > 0;
  }
  EXPECT_GT(bounded, 20);
}

TEST(FingerLengthRange, EndsWhenInterrupted) {
  AssemblyOperation operation = turning_bar({0, 0, 0});
  const Eigen::Vector3d beside(0.07, 0.07, 0);
  operation.passive = {{"wall", ring(0.2, 0.21, -0.1, 0.1)}, pin_at(beside)};
  CancelToken stop;
  stop.stop();
  const detail::InterruptionScope scope(stop);
  EXPECT_THROW(finger_length_range(at_end_of_bar({0, 0, 0}), operation), detail::Interrupted);
}

TEST(FingerLengthRange, RefusesWhatCannotBe) {
  AssemblyOperation operation = sleeve_on_shaft(0.04);
  AssemblyGrasp grasp = centric(0.04, 0.01);
  grasp.fingers = 4;
  EXPECT_THROW(finger_length_range(grasp, operation), InvalidInput);
  grasp.fingers = 3;
  EXPECT_THROW(finger_length_range(grasp, operation, 0), InvalidInput);
  operation.motion.clear();
  EXPECT_THROW(finger_length_range(grasp, operation), InvalidInput);
  operation = sleeve_on_shaft(0.04);
  operation.active[0].mesh = nullptr;
  EXPECT_THROW(finger_length_range(grasp, operation), InvalidInput);
  operation = sleeve_on_shaft(0.04);
  operation.motion = {at(0, 0, 0), at(1000, 0, 0)};
  EXPECT_THROW(finger_length_range(grasp, operation), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
