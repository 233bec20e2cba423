#include "mmgrasp/robot/ik_objective.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "support/robot_support.hpp"
#include "support/small_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

Eigen::VectorXd differences(const IkObjective& objective, const Eigen::VectorXd& q) {
  constexpr double kStep = 1e-5;
  Eigen::VectorXd gradient(q.size()), unused, moved = q;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    moved[i] = q[i] + kStep;
    const double above = objective.evaluate(moved, unused);
    moved[i] = q[i] - kStep;
    gradient[i] = (above - objective.evaluate(moved, unused)) / (2 * kStep);
    moved[i] = q[i];
  }
  return gradient;
}

/// Compares the gradient with central differences, relative to its size, where `smooth` says so. Returns how many
/// configurations had a cost.
int expect_gradient(const JointGroup& group, const IkObjective& objective, int count) {
  Rng rng(12);
  int active = 0;
  for (int i = 0; i < count; ++i) {
    const Eigen::VectorXd q = rng.uniform(group.sample_lower(), group.sample_upper());
    Eigen::VectorXd gradient;
    const double cost = objective.evaluate(q, gradient);
    EXPECT_GE(cost, 0);
    EXPECT_EQ(gradient.size(), q.size());
    const Eigen::VectorXd reference = differences(objective, q);
    EXPECT_LE((gradient - reference).norm(), 1e-6 * (1 + reference.norm())) << objective.name() << "\n"
                                                                            << gradient.transpose() << "\n"
                                                                            << reference.transpose();
    active += cost > 0;
  }
  return active;
}

IkObjectives panda_objectives(const JointGroup& group) {
  return {make_joint_limit_objective(group, 0.25, 1.0), make_singularity_objective(group, 0.08, 1.0)};
}

double total(const IkObjectives& objectives, const Eigen::VectorXd& q) {
  double sum = 0;
  Eigen::VectorXd unused;
  for (const auto& objective : objectives) sum += objective->evaluate(q, unused);
  return sum;
}

}  // namespace

TEST(IkObjective, GradientsMatchDifferences) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup arm = panda().group("panda_arm");
  EXPECT_GT(expect_gradient(arm, *make_joint_limit_objective(arm, 0.2, 3.0), 300), 200);
  EXPECT_GT(expect_gradient(arm, *make_singularity_objective(arm, 0.1, 2.0), 300), 150);
  Pose T_link_camera = pose_from_xyz_rpy({0.05, 0.02, 0.03}, {0.3, -0.2, 0.1});
  const int hand = arm.robot().link_index("panda_link7");
  EXPECT_EQ(expect_gradient(arm, *make_camera_view_objective(arm, hand, T_link_camera, {0.6, 0.1, 0.2}, 2.0), 300),
            300);
}

TEST(IkObjective, GradientsMatchDifferencesWithABase) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup whole = tiago().group("arm_torso", "", true);
  expect_gradient(whole, *make_joint_limit_objective(whole, 0.3), 100);
  EXPECT_GT(expect_gradient(whole, *make_singularity_objective(whole, 0.3), 100), 50);
  const int head = whole.robot().link_index("torso_lift_link");
  expect_gradient(whole, *make_camera_view_objective(whole, head, Pose::Identity(), {1.2, 0.3, 0.8}), 100);
}

TEST(IkObjective, MimicJointsFallBackToDifferences) {
  std::string urdf = test::seven_joint_urdf();
  const std::string place = "<joint name='j7' type='continuous'>";
  ASSERT_NE(urdf.find(place), std::string::npos);
  urdf.replace(urdf.find(place), place.size(),
               "<joint name='j7' type='revolute'><mimic joint='j5' multiplier='0.5' offset='0.1'/>");
  const JointGroup group = Robot::from_strings(urdf).chain("column", "tool");
  ASSERT_EQ(group.size(), 6);
  EXPECT_GT(expect_gradient(group, *make_singularity_objective(group, 0.2), 100), 10);
}

TEST(IkObjective, JointLimitCostGrowsAtBothEndsAndNowhereElse) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const auto objective = make_joint_limit_objective(group, 0.1, 2.0);
  const Eigen::VectorXd range = group.upper() - group.lower(), middle = 0.5 * (group.lower() + group.upper());
  Eigen::VectorXd gradient;
  EXPECT_EQ(objective->evaluate(middle, gradient), 0);
  EXPECT_EQ(gradient, Eigen::VectorXd::Zero(7));
  for (Eigen::Index i = 0; i < 7; ++i) {
    // (5.10) alone would be largest at the lower limit of every joint that is far from the upper one, or, cut to its
    // soft zone, silent there: the mirror is what holds the lower limit.
    Eigen::VectorXd q = middle;
    q[i] = group.lower()[i];
    EXPECT_NEAR(objective->evaluate(q, gradient), 2 * std::pow(0.1 * range[i], 2), 1e-12);
    EXPECT_NEAR(gradient[i], -4 * 0.1 * range[i], 1e-12);
    q[i] = group.upper()[i];
    EXPECT_NEAR(objective->evaluate(q, gradient), 2 * std::pow(0.1 * range[i], 2), 1e-12);
    EXPECT_NEAR(gradient[i], 4 * 0.1 * range[i], 1e-12);
  }
}

TEST(IkObjective, SingularityCostInNumbers) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup whole = tiago().group("arm_torso", "", true), arm = tiago().group("arm_torso");
  Rng rng(13);
  Eigen::VectorXd gradient;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = rng.uniform(whole.sample_lower(), whole.sample_upper());
    const double M = arm.manipulability(q.tail(arm.size()));  // the base does not count
    const double expected = M < 0.2 ? 1.5 * std::pow(1 - M / 0.2, 2) : 0;
    EXPECT_NEAR(make_singularity_objective(whole, 0.2, 1.5)->evaluate(q, gradient), expected, 1e-9);
    EXPECT_EQ(gradient.head<3>(), Eigen::Vector3d::Zero());
  }
}

TEST(IkObjective, CameraCostIsTheDistanceFromTheAxis) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup arm = panda().group("panda_arm");
  const Eigen::VectorXd q = 0.5 * (arm.lower() + arm.upper());
  const int link = arm.tip_link();
  const Pose T_world_camera = arm.fk(q);
  Eigen::VectorXd gradient;
  const auto cost = [&](const Eigen::Vector3d& p_camera) {
    return make_camera_view_objective(arm, link, Pose::Identity(), T_world_camera * p_camera, 2.0)
        ->evaluate(q, gradient);
  };
  EXPECT_NEAR(cost({0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(cost({0.1, -0.2, 1}), 2 * 0.05, 1e-12);
  EXPECT_NEAR(cost({0.1, -0.2, -0.5}), 2 * 0.3, 1e-12);  // behind the camera
}

TEST(IkObjective, NullSpaceStepsDoNotMoveTheTip) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = tiago().group("arm_torso", "", true);
  Rng rng(18);
  const std::vector<double> weights{2, 2, 5, 1, 1, 3, 1, 1, 0.5, 1, 4};
  ASSERT_EQ(group.size(), 11);
  for (int i = 0; i < 100; ++i) {
    const Matrix6Xd J = group.jacobian(rng.uniform(group.sample_lower(), group.sample_upper()));
    const Eigen::VectorXd xi = rng.uniform(Eigen::VectorXd::Constant(11, -1), Eigen::VectorXd::Ones(11));
    const Eigen::VectorXd plain = project_onto_null_space(J, xi), weighted = project_onto_null_space(J, xi, weights);
    EXPECT_LE((J * plain).norm(), 1e-12 * J.norm());
    EXPECT_LE((J * weighted).norm(), 1e-12 * J.norm());
    // P3 3.5 as printed, J^+ = J^T (J J^T)^-1, where J has full rank.
    const Eigen::VectorXd printed = xi - J.transpose() * (J * J.transpose()).ldlt().solve(J * xi);
    EXPECT_LE((plain - printed).norm(), 1e-9 * (1 + 1 / (J * J.transpose()).determinant()));
    EXPECT_LE((project_onto_null_space(J, plain) - plain).norm(), 1e-12);  // a projection
    EXPECT_GT(plain.dot(xi), 0);
    EXPECT_GT(weighted.dot(xi), 0);
  }
  EXPECT_THROW(project_onto_null_space(Matrix6Xd::Zero(6, 7), Eigen::VectorXd::Zero(6)), InvalidInput);
  EXPECT_THROW(project_onto_null_space(Matrix6Xd::Zero(6, 2), Eigen::VectorXd::Zero(2), {1, -1}), InvalidInput);
}

TEST(IkObjective, SlidingLowersTheCostAndKeepsThePose) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  IkOptions with;
  with.objectives = panda_objectives(group);
  Rng rng(14);
  const Eigen::VectorXd seed = 0.5 * (group.lower() + group.upper());
  double before = 0, after = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkResult plain = solve_ik(group, target, seed), better = solve_ik(group, target, seed, with);
    ASSERT_EQ(plain.outcome, Outcome::solved);
    ASSERT_EQ(better.outcome, Outcome::solved);
    EXPECT_EQ(plain.objective, 0);
    EXPECT_NEAR(better.objective, total(with.objectives, better.q), 1e-12);
    EXPECT_LE(better.objective, total(with.objectives, plain.q));
    EXPECT_TRUE(group.within_limits(better.q));
    const Vector6d error = pose_difference(group.fk(better.q), target);
    EXPECT_LE(error.head<3>().norm(), 1e-5);
    EXPECT_LE(error.tail<3>().norm(), 1e-4);
    before += total(with.objectives, plain.q);
    after += better.objective;
  }
  EXPECT_LT(after, 0.8 * before);  // one freedom, of which limits leave little
}

TEST(IkObjective, SlidingEndsWhereTheProjectedGradientVanishes) {
  // A planar arm whose pose leaves one freedom: at the end, moving along the solutions must not lower the cost.
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  IkOptions options;
  options.objectives = {make_joint_limit_objective(group, 0.5)};  // distance from the middle of every joint
  options.objective_iterations = 300;
  Rng rng(15);
  int interior = 0;
  for (int i = 0; i < 50; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkResult result = solve_ik(group, target, rng.uniform(group.lower(), group.upper()), options);
    ASSERT_EQ(result.outcome, Outcome::solved);
    if (std::min((result.q - group.lower()).minCoeff(), (group.upper() - result.q).minCoeff()) < 1e-6) continue;
    ++interior;
    const Eigen::MatrixXd J = group.jacobian(result.q);
    const Eigen::VectorXd along = J.fullPivLu().kernel().col(0).normalized();
    Eigen::VectorXd gradient;
    options.objectives[0]->evaluate(result.q, gradient);
    EXPECT_LE(std::abs(along.dot(gradient)), 1e-3 * gradient.norm());
  }
  EXPECT_GT(interior, 30);
}

TEST(IkObjective, FilterStillHoldsAfterSliding) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  IkOptions options;
  options.objectives = panda_objectives(group);
  const auto valid = [](const Eigen::VectorXd& q) { return q[0] > 0.2 ? Rejection::none : Rejection::scene; };
  Rng rng(16);
  int solved = 0;
  for (int i = 0; i < 60; ++i) {
    const Pose target = group.fk(rng.uniform(group.lower(), group.upper()));
    const IkResult result = solve_ik(group, target, rng.uniform(group.lower(), group.upper()), options, valid);
    if (result.outcome != Outcome::solved) continue;
    ++solved;
    EXPECT_GT(result.q[0], 0.2);
  }
  EXPECT_GT(solved, 30);
}

TEST(IkObjective, WeightsSayWhichJointsMove) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Rng rng(17);
  IkOptions heavy;
  heavy.joint_weights = {1, 1, 1, 1, 1, 1, 1};
  heavy.joint_weights[2] = 1e8;
  IkWorkspace workspace;
  int solved = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd goal =
        rng.uniform(Eigen::VectorXd(group.lower().array() + 0.3), Eigen::VectorXd(group.upper().array() - 0.3));
    Eigen::VectorXd q = goal;
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] += rng.uniform(-0.02, 0.02);
    const Eigen::VectorXd start = q;
    if (group.jacobian(goal).rightCols<4>().norm() == 0) continue;
    // Joint 3 is so costly that it rests where the other six can do without it.
    if (group.manipulability(goal) < 0.03) continue;
    if (!refine_ik(group, group.fk(goal), q, heavy, workspace)) continue;
    Eigen::MatrixXd others(6, 6);
    const Matrix6Xd J = group.jacobian(goal);
    others << J.leftCols<2>(), J.rightCols<4>();
    if (others.fullPivLu().rcond() < 0.02) continue;
    ++solved;
    EXPECT_LT(std::abs(q[2] - start[2]), 1e-5);
  }
  EXPECT_GT(solved, 50);
}

TEST(IkObjective, BadInputNamesTheField) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const auto message = [](const auto& call) {
    try {
      call();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_NE(message([&] { make_joint_limit_objective(group, 0.6); }).find("soft_fraction"), std::string::npos);
  EXPECT_NE(message([&] { make_joint_limit_objective(group, 0.1, -1); }).find("weight"), std::string::npos);
  EXPECT_NE(message([&] { make_singularity_objective(group, 0); }).find("threshold"), std::string::npos);
  EXPECT_NE(message([&] {
              make_camera_view_objective(group, 99, Pose::Identity(), Eigen::Vector3d::Zero());
            }).find("camera_link"),
            std::string::npos);
  EXPECT_NE(message([&] {
              make_camera_view_objective(group, 1, Pose::Identity(), {0, NAN, 0});
            }).find("p_world_point[1]"),
            std::string::npos);
  IkOptions options;
  options.objectives = {nullptr};
  EXPECT_NE(message([&] { options.check(); }).find("ik.objectives[0]"), std::string::npos);
  options = {};
  options.joint_weights = {1, 1, 1, 0, 1, 1, 1};
  EXPECT_NE(message([&] { options.check(); }).find("joint_weights[3]"), std::string::npos);
  options.joint_weights = {1, 1};
  EXPECT_NE(message([&] {
              solve_ik(group, Pose::Identity(), Eigen::VectorXd::Zero(7), options);
            }).find("joint_weights length"),
            std::string::npos);
}

TEST(IkObjective, SixJointsTakeTheCheapestBranch) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  IkOptions options;
  options.objectives = {make_joint_limit_objective(group, 0.4, 1.0)};
  Rng rng(31);
  int differs = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::VectorXd made = rng.uniform(group.sample_lower(), group.sample_upper());
    const Pose target = group.fk(made);
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::VectorXd& q : solve_ik_branches(group, target).solutions)
      least = std::min(least, total(options.objectives, q));
    // The seed is itself a solution: no reason to stay with it.
    const IkResult result = solve_ik(group, target, made, options);
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_NEAR(result.objective, total(options.objectives, result.q), 1e-12);
    EXPECT_LE(result.objective, least + 1e-9);
    differs += total(options.objectives, made) > least + 1e-3;
  }
  EXPECT_GT(differs, 50);
}

TEST(IkObjective, WeightsDecideWhichBranchIsNearest) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = load_kinematics("robots/ur/expanded/ur5e.urdf").chain("base_link", "tool0");
  Rng rng(32);
  int differs = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose target = group.fk(rng.uniform(group.sample_lower(), group.sample_upper()));
    const Eigen::VectorXd seed = rng.uniform(Eigen::VectorXd::Constant(6, -1), Eigen::VectorXd::Constant(6, 1));
    IkOptions options;
    options.joint_weights = {1, 50, 1, 1, 1, 1};
    const IkResult weighted = solve_ik(group, target, seed, options), plain = solve_ik(group, target, seed);
    ASSERT_EQ(weighted.outcome, Outcome::solved);
    double least = std::numeric_limits<double>::infinity();
    const auto distance = [&](const Eigen::VectorXd& q) {
      double sum = 0;
      for (int j = 0; j < 6; ++j) {
        const bool once = group.upper()[j] < 4;  // the elbow cannot take whole turns
        const double way = once ? q[j] - seed[j] : std::remainder(q[j] - seed[j], 2 * M_PI);
        sum += options.joint_weights[j] * way * way;
      }
      return sum;
    };
    for (const Eigen::VectorXd& q : solve_ik_branches(group, target).solutions) least = std::min(least, distance(q));
    EXPECT_NEAR(distance(weighted.q), least, 1e-5);
    differs += (weighted.q - plain.q).norm() > 0.1;
  }
  EXPECT_GT(differs, 20);
}
