// Every derivative that optimisers are given, against central differences.
#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/random.hpp"
#include "support/derivatives.hpp"
#include "support/fetchlike.hpp"
#include "trajopt/tool_chain.hpp"
#include "trajopt/unicycle_arc.hpp"
#include "trajopt/whole_body_nlp.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

VectorXd random_vector(Rng& rng, Eigen::Index n, double scale) {
  VectorXd v(n);
  for (Eigen::Index i = 0; i < n; ++i) v[i] = rng.uniform(-scale, scale);
  return v;
}

/// Few waypoints, every kind of constraint.
WholeBodyProblem everything(const JointGroup& group) {
  WholeBodyProblem problem(group);
  problem.start = VectorXd::Zero(group.size());
  problem.goal_lower = problem.goal_upper = VectorXd::Constant(group.size(), 0.3);
  problem.segments = {{2}, {1}};
  problem.jerk_time = 0.2;
  ToolConstraint tool;
  tool.waypoint = 2;
  tool.T_world_tip = pose_from_xyz_rpy({1.2, -0.4, 0.8}, {0.7, -0.3, 0.5});
  tool.max_speed = 0.3;
  tool.velocity_lower = Eigen::Vector3d(0.05, -0.1, -0.1);
  tool.velocity_upper = Eigen::Vector3d(0.2, 0.1, 0.1);
  problem.tool.push_back(tool);
  tool.waypoint = 1;
  tool.lower.tail<3>() = Vector6d::Constant(-std::numeric_limits<double>::infinity()).tail<3>();
  tool.upper.tail<3>() = Vector6d::Constant(std::numeric_limits<double>::infinity()).tail<3>();
  problem.tool.push_back(tool);
  return problem;
}

BaseLimits with_wheels() {
  BaseLimits limits;
  limits.wheel_velocity = 0.7;
  return limits;
}

class Derivatives : public ::testing::TestWithParam<BaseKind> {};

TEST_P(Derivatives, OfTheWholeProblemAreExact) {
  const JointGroup group = test::fetchlike_whole_body(GetParam(), with_wheels());
  detail::WholeBodyNlp nlp(everything(group), 0.5);
  Rng rng(3);
  for (int round = 0; round < 3; ++round) {
    VectorXd x = random_vector(rng, nlp.layout().size(), 1.5);
    for (int s = 0; s < 2; ++s) x[nlp.layout().h(s)] = rng.uniform(0.2, 1.5);
    const Eigen::Index rows = nlp.constraint_bounds().lower.size();
    test::expect_exact_derivatives(nlp, x, 0.7, random_vector(rng, rows, 1));
  }
}

INSTANTIATE_TEST_SUITE_P(Bases, Derivatives, ::testing::Values(BaseKind::fixed, BaseKind::diff_drive, BaseKind::omni),
                         [](const auto& info) { return to_string(info.param); });

TEST(Derivatives, OfMecanumWheelsAreExact) {
  BaseLimits limits = with_wheels();
  limits.wheelbase = 0.6;
  detail::WholeBodyNlp plain(everything(test::fetchlike_whole_body(BaseKind::omni, with_wheels())), 0.5);
  detail::WholeBodyNlp nlp(everything(test::fetchlike_whole_body(BaseKind::omni, limits)), 0.5);
  // Of three intervals in two segments: three, four and one more, and four places, of four wheels each.
  const Eigen::Index rows = nlp.constraint_bounds().lower.size();
  EXPECT_EQ(rows - plain.constraint_bounds().lower.size(), 4 * (3 + 5 + 4));
  Rng rng(4);
  for (int round = 0; round < 3; ++round) {
    VectorXd x = random_vector(rng, nlp.layout().size(), 1.5);
    for (int s = 0; s < 2; ++s) x[nlp.layout().h(s)] = rng.uniform(0.2, 1.5);
    test::expect_exact_derivatives(nlp, x, 0.7, random_vector(rng, rows, 1));
  }
}

TEST(ToolChain, AgreesWithTheGroupsKinematics) {
  const JointGroup group = test::fetchlike_whole_body();
  const detail::ToolChain chain(group);
  ASSERT_EQ(chain.steps().size(), 10u);
  Rng rng(5);
  detail::ToolChain::State state;
  for (int round = 0; round < 200; ++round) {
    const VectorXd q = random_vector(rng, group.size(), 3);
    chain.evaluate(q.data(), state);
    const Pose T = group.fk(q);
    EXPECT_LT((state.p - T.translation()).norm(), 1e-12);
    EXPECT_LT((state.rotation.toRotationMatrix() - T.linear()).norm(), 1e-12);
    const Matrix6Xd J = group.jacobian(q);
    for (std::size_t i = 0; i < chain.steps().size(); ++i) {
      EXPECT_LT((J.col(chain.steps()[i].column).head<3>() - state.v[i]).norm(), 1e-12);
      EXPECT_LT((J.col(chain.steps()[i].column).tail<3>() - state.w[i]).norm(), 1e-12);
    }
  }
}

TEST(ToolChain, RotationErrorVanishesAtTheTargetAlone) {
  // The vector of sines that is often used is also 0 at 180 degrees from the target.
  const JointGroup group = test::fetchlike_whole_body();
  WholeBodyProblem problem(group);
  Rng rng(6);
  const VectorXd q = random_vector(rng, group.size(), 1);
  VectorXd opposite = q;
  opposite[group.size() - 1] += M_PI;  // the last joint turns the tool about its x
  problem.start = VectorXd::Zero(group.size());
  ToolConstraint tool;
  tool.T_world_tip = group.fk(q);
  const Eigen::Matrix3d E = tool.T_world_tip.linear().transpose() * group.fk(opposite).linear();
  EXPECT_LT(Eigen::Vector3d(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1)).norm(), 1e-12);
  problem.tool = {tool};
  problem.goal_lower = problem.goal_upper = problem.start;
  problem.segments = {{1}};
  detail::WholeBodyNlp nlp(problem, 0);
  const auto error = [&](const VectorXd& at) {
    VectorXd x = VectorXd::Zero(nlp.layout().size()), c(nlp.constraint_bounds().lower.size());
    x.segment(nlp.layout().q(0, 0), group.size()) = at;
    nlp.constraints(x, c);
    for (int i = 0; i < c.size(); ++i)
      if (nlp.constraint_name(i).rfind("task", 0) == 0) return VectorXd(c.segment(i, 6));
    return VectorXd();
  };
  EXPECT_LT(error(q).norm(), 1e-12);
  EXPECT_NEAR(error(opposite).tail<3>().norm(), 2, 1e-9);
  VectorXd turned = q;
  turned[group.size() - 1] += 2 * M_PI;
  EXPECT_LT(error(turned).norm(), 1e-12);
}

TEST(UnicycleArc, MatchesACircleAndALongIntegration) {
  detail::UnicycleArc arc;
  detail::UnicycleArc::Locals circle;
  circle << 0.3, 0.9, 0.9, 0.5, 0.5, 1.4;
  arc.evaluate(circle, 1, 0);
  const double r = 0.5 / 0.9, end = 0.3 + 0.9 * 1.4;
  EXPECT_NEAR(arc.way[0], r * (std::sin(end) - std::sin(0.3)), 1e-13);
  EXPECT_NEAR(arc.way[1], -r * (std::cos(end) - std::cos(0.3)), 1e-13);
  Rng rng(8);
  for (int round = 0; round < 20; ++round) {
    detail::UnicycleArc::Locals l = random_vector(rng, 6, 1);
    l[5] = rng.uniform(0.1, 1.5);
    const double s = rng.uniform(0.1, 1);
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    const int steps = 200000;
    for (int k = 0; k < steps; ++k) {
      const double at = s * (k + 0.5) / steps;
      const double heading = l[0] + detail::unicycle_turn(l, at), speed = l[3] + at * (l[4] - l[3]);
      sum += l[5] * s / steps * speed * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
    arc.evaluate(l, s, 0);
    EXPECT_LT((arc.way - sum).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace mmgrasp
