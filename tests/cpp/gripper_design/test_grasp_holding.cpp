// Soft fingers against closed forms: sizes and torques of contacts, and what two and three fingers hold.
#include "mmgrasp/gripper_design/grasp_holding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

AssemblyGrasp grasp_of(int fingers, double opening, double length, double width) {
  AssemblyGrasp g;
  g.fingers = fingers;
  g.opening = opening;
  g.contact_length = length;
  g.contact_width = width;
  return g;
}

FingerGrip grip_of(double force, double friction) {
  FingerGrip grip;
  grip.force = force;
  grip.friction = friction;
  return grip;
}

TEST(SoftContact, MeanDistancesOfASquareAndOfAStrip) {
  // A unit square: (sqrt 2 + ln(1 + sqrt 2)) / 6; a strip: a quarter of its length.
  EXPECT_NEAR(flat_contact(1, 1).torsion_radius, (std::sqrt(2) + std::log(1 + std::sqrt(2))) / 6, 1e-15);
  EXPECT_NEAR(flat_contact(1, 1e-7).torsion_radius, 0.25, 1e-9);
  EXPECT_DOUBLE_EQ(flat_contact(0.02, 0.01).torsion_radius, flat_contact(0.01, 0.02).torsion_radius);
  EXPECT_DOUBLE_EQ(flat_contact(0.02, 0.01).area(), 2e-4);
}

TEST(SoftContact, LineContactIsHertz) {
  // Johnson 1985 (4.43): b^2 = 4 (F / l) R / (pi E).
  const ContactArea c = line_contact(40, 0.02, 0.01, 1, 2e6, kInfinite);
  EXPECT_NEAR(c.width / 2, std::sqrt(4 * (40 / 0.01) * 0.02 / (M_PI * 2e6)), 1e-12);
  // Half an ellipse of pressure across a line without length: mean distance 4 b / (3 pi); along one without width l
  // / 4.
  const ContactArea across = line_contact(1e-3, 0.02, 1e-7, 1, 2e6, kInfinite);
  EXPECT_NEAR(across.torsion_radius / (across.width / 2), 4 / (3 * M_PI), 1e-5);
  const ContactArea along = line_contact(1e-9, 0.02, 0.01, 1, 2e9, kInfinite);
  EXPECT_NEAR(along.torsion_radius, 0.0025, 1e-8);
}

TEST(SoftContact, PressureIntegratesToItsMeanDistance) {
  const ContactArea c = line_contact(40, 0.02, 0.012, 1, 2e6, kInfinite);
  double sum = 0, weight = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < n; ++k) {
      const double u = 2 * (i + 0.5) / n - 1, y = c.length * ((k + 0.5) / n - 0.5), p = std::sqrt(1 - u * u);
      sum += p * std::hypot(u * c.width / 2, y);
      weight += p;
    }
  }
  EXPECT_NEAR(c.torsion_radius, sum / weight, 1e-4 * c.torsion_radius);
}

TEST(SoftContact, MoreAlikeCurvaturesTouchMore) {
  double before = 0;
  for (const double pad : {kInfinite, 0.08, 0.04, 0.025}) {
    const double width = line_contact(20, 0.02, 0.01, 1, 3e6, pad).width;
    EXPECT_GT(width, before);
    before = width;
  }
  EXPECT_DOUBLE_EQ(line_contact(20, 0.02, 0.01, 0.015, 3e6, 0.02).width, 0.015);  // it fits
  EXPECT_GT(line_contact(20, 0.03, 0.01, 1, 3e6, kInfinite).width,
            line_contact(20, 0.02, 0.01, 1, 3e6, kInfinite).width);  // P1 5.2.1: larger cylinders touch more
  EXPECT_THROW(line_contact(20, 0.02, 0.01, 1, 3e6, 0.01), InvalidInput);
}

TEST(SoftContact, LimitSurfaceIsAnEllipse) {
  EXPECT_DOUBLE_EQ(soft_finger_torque(50, 0.5, 0.004), 0.1);
  EXPECT_NEAR(soft_finger_torque(50, 0.5, 0.004, 15), 0.1 * 0.8, 1e-15);  // 3, 4, 5
  EXPECT_DOUBLE_EQ(soft_finger_torque(50, 0.5, 0.004, 25), 0);
  EXPECT_DOUBLE_EQ(soft_finger_torque(50, 0.5, 0.004, 30), 0);
  EXPECT_THROW(soft_finger_torque(-1, 0.5, 0.004), InvalidInput);
}

TEST(GraspHolding, JawsCarryAWeightByFriction) {
  // Weight along the approach, through the middle: each pad half, slip at mu N each.
  AssemblyLoad load;
  load.weight = Vector3d(0, 0, -10);
  load.centre = Vector3d(0, 0, -0.005);
  const GraspHolding h = grasp_holding(grasp_of(2, 0.03, 0.01, 0.012), grip_of(40, 0.5), load);
  EXPECT_NEAR(h.safety, 2 * 0.5 * 40 / 10, 1e-9);
  EXPECT_NEAR(h.pad_torque, soft_finger_torque(40, 0.5, flat_contact(0.01, 0.012).torsion_radius, 5), 1e-12);
  EXPECT_EQ(h.insertion_moment, 0);
}

TEST(GraspHolding, JawsTurnAboutTheClosingAxisByTorsion) {
  // Figure 5.5 (a) of P1: the weight hangs beside the closing axis. Each pad has half of force and torque.
  const double weight = 6, arm = 0.02;
  AssemblyLoad load;
  load.weight = Vector3d(0, 0, -weight);
  load.centre = Vector3d(0, arm, -0.005);
  const AssemblyGrasp g = grasp_of(2, 0.03, 0.01, 0.012);
  const double r = flat_contact(0.01, 0.012).torsion_radius;
  const GraspHolding h = grasp_holding(g, grip_of(40, 0.5), load);
  EXPECT_NEAR(h.safety, 0.5 * 40 / std::hypot(weight / 2, weight * arm / 2 / r), 1e-9);
}

TEST(GraspHolding, JawsTakeMomentsAboutTheApproachByAPairOfForces) {
  AssemblyLoad load;
  load.weight = Vector3d(0, 5, 0);
  load.centre = Vector3d(0.01, 0, -0.005);  // 5 N, 10 mm along the closing axis
  const GraspHolding h = grasp_holding(grasp_of(2, 0.04, 0.01, 0.012), grip_of(40, 0.5), load);
  EXPECT_NEAR(h.safety, 0.5 * 40 / (2.5 + 5 * 0.01 / 0.04), 1e-9);
}

TEST(GraspHolding, AForceAlongTheClosingAxisRelievesOneJaw) {
  AssemblyLoad load;
  load.weight = Vector3d(10, 0, 0);
  load.centre = Vector3d(0, 0, -0.005);
  EXPECT_NEAR(grasp_holding(grasp_of(2, 0.04, 0.01, 0.012), grip_of(40, 0.5), load).safety, 40 / 5.0, 1e-9);
}

TEST(GraspHolding, ThreeFingersShareForceAndTurnAlike) {
  const AssemblyGrasp g = grasp_of(3, 0.04, 0.01, 0.012);
  AssemblyLoad load;
  load.weight = Vector3d(0, 0, -12);
  EXPECT_NEAR(grasp_holding(g, grip_of(40, 0.5), load).safety, 3 * 0.5 * 40 / 12, 1e-9);
  // A resistance beside the axis: 3 pads lift with F/3 and, about x, +-; P1 figure 5.16 (b5).
  AssemblyLoad aside;
  aside.resistance = Vector3d(0, 0, 9);
  aside.hole = Vector3d(0, 0.03, 0);
  const GraspHolding h = grasp_holding(g, grip_of(40, 0.5), aside);
  EXPECT_NEAR(h.insertion_moment, 9 * 0.03, 1e-12);
  EXPECT_LT(h.safety, 3 * 0.5 * 40 / 9);
  aside.hole = Vector3d(0, 0, 0.4);  // on the axis, however far
  const GraspHolding even = grasp_holding(g, grip_of(40, 0.5), aside);
  EXPECT_NEAR(even.insertion_moment, 0, 1e-12);
  EXPECT_NEAR(even.safety, 3 * 0.5 * 40 / 9, 1e-9);
}

TEST(GraspHolding, DoesNotDependOnTheFrame) {
  Rng rng(3);
  const auto any = [&] { return Vector3d(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)); };
  for (int k = 0; k < 50; ++k) {
    AssemblyGrasp g = grasp_of(2 + k % 2, 0.03, 0.01, 0.012);
    AssemblyLoad load{5 * any(), 0.02 * any(), 9 * any(), 0.03 * any()};
    const GraspHolding h = grasp_holding(g, grip_of(40, 0.5), load);
    Pose T = Pose::Identity();
    T.linear() = Eigen::AngleAxisd(rng.uniform(0, 3), any().normalized()).toRotationMatrix();
    T.translation() = any();
    g.T_active_tool = T;
    const AssemblyLoad moved{T.linear() * load.weight, T * load.centre, T.linear() * load.resistance, T * load.hole};
    const GraspHolding again = grasp_holding(g, grip_of(40, 0.5), moved);
    EXPECT_NEAR(again.safety, h.safety, 1e-8 * h.safety);
    EXPECT_NEAR(again.pad_torque, h.pad_torque, 1e-10);
    EXPECT_NEAR(again.insertion_moment, h.insertion_moment, 1e-10);
    EXPECT_GT(h.safety, 0);
  }
}

/// Forces of the pads that were given a part's whole load must balance it without slipping, up to `safety` times it:
/// doubling the load halves the factor, and no load is held by any factor.
TEST(GraspHolding, ScalesWithTheLoad) {
  const AssemblyGrasp g = grasp_of(2, 0.03, 0.01, 0.012);
  AssemblyLoad load;
  EXPECT_EQ(grasp_holding(g, grip_of(40, 0.5), load).safety, kInfinite);
  load.weight = Vector3d(1, 2, -3);
  load.centre = Vector3d(0.01, 0.02, 0.03);
  const double once = grasp_holding(g, grip_of(40, 0.5), load).safety;
  load.weight *= 2;
  EXPECT_NEAR(grasp_holding(g, grip_of(40, 0.5), load).safety, once / 2, 1e-9 * once);
  EXPECT_NEAR(grasp_holding(g, grip_of(80, 0.5), load).safety, once, 1e-9 * once);
}

TEST(GraspHolding, RefusesWhatIsNone) {
  const AssemblyGrasp g = grasp_of(2, 0.03, 0.01, 0.012);
  EXPECT_THROW(grasp_holding(grasp_of(2, 0.03, 0, 0.012), {}, {}), InvalidInput);
  EXPECT_THROW(grasp_holding(g, grip_of(0, 0.5), {}), InvalidInput);
  EXPECT_THROW(grasp_holding(g, grip_of(40, -1), {}), InvalidInput);
  AssemblyLoad load;
  load.hole.x() = std::nan("");
  EXPECT_THROW(grasp_holding(g, {}, load), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
