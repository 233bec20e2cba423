#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/reach_arms.hpp"

namespace mmgrasp {
namespace {

constexpr double kRounding = 3e-4;  // stored tool poses take 16 bytes each
constexpr double kPi = 3.14159265358979323846;

using test::gantry;
using test::seven_joints;
using test::with_samples;

/// The distance that nearest() sorts by, from kinematics.
double pose_distance(const ReachOptions& options, const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() / options.position_cell +
         rotation_distance(a, b) / options.rotation_cell;
}

bool holds_column(const Eigen::MatrixXd& columns, const Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    if (columns.col(i) == q) return true;
  return false;
}

TEST(ReachNearest, NearestIsTheTrueNearest) {
  for (const bool with_gantry : {true, false}) {
    const JointGroup arm = with_gantry ? gantry() : seven_joints();
    ReachOptions options = with_samples(60000, 0);
    options.position_cell = 0.3;
    const auto database = ReachDatabase::build(arm, options);
    std::vector<Pose> stored;
    for (std::int64_t i = 0; i < database.size(); ++i) stored.push_back(arm.fk(database.configuration(i)));
    Rng rng(11);
    int exact = 0;
    for (int trial = 0; trial < 60; ++trial) {
      const auto at = rng.index(stored.size());
      Pose T = stored[at];
      T.translation() += 0.03 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      T.linear() *= Eigen::AngleAxisd(0.2 * rng.normal(), Eigen::Vector3d::UnitX()).toRotationMatrix();
      std::vector<double> all;
      for (const Pose& other : stored) all.push_back(pose_distance(database.options(), T, other));
      std::sort(all.begin(), all.end());
      Eigen::MatrixXd out;
      const int found = database.nearest(T, 8, out);
      double previous = 0;
      for (int k = 0; k < found; ++k) {
        const double distance = pose_distance(database.options(), T, arm.fk(out.col(k)));
        EXPECT_GE(distance, previous - kRounding);
        EXPECT_GE(distance, all[k] - kRounding);
        previous = distance;
      }
      for (int k = 0; k < 8 && all[k] < 0.5; ++k, ++exact) {
        ASSERT_GT(found, k);
        EXPECT_NEAR(pose_distance(database.options(), T, arm.fk(out.col(k))), all[k], kRounding);
      }
      // Whatever shares the query's cell was looked at: it is among the answer or farther away.
      const Eigen::MatrixXd cell = database.cell(T), answer = out.leftCols(found);
      for (Eigen::Index k = 0; k < cell.cols(); ++k) {
        EXPECT_TRUE(holds_column(answer, cell.col(k)) ||
                    (found == 8 && pose_distance(database.options(), T, arm.fk(cell.col(k))) >= previous - kRounding));
      }
    }
    EXPECT_GT(exact, 20);
  }
}

TEST(ReachNearest, NeighbourhoodsHoldWhereAnglesWrapAndAtPitchNinety) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(300000, 0);
  options.position_cell = 2;  // dense in rotation
  options.max_per_cell = 1000;
  const auto database = ReachDatabase::build(arm, options);
  std::vector<Pose> stored;
  for (std::int64_t i = 0; i < database.size(); ++i) stored.push_back(arm.fk(database.configuration(i)));
  int exact = 0;
  for (const Eigen::Vector3d& rpy :
       {Eigen::Vector3d(0.3, kPi / 2, 0.1), Eigen::Vector3d(-2, kPi / 2 - 0.01, 1), Eigen::Vector3d(0.3, -kPi / 2, 2),
        Eigen::Vector3d(kPi, 0, 0), Eigen::Vector3d(0, 0, kPi), Eigen::Vector3d(0, 0, -kPi + 1e-9),
        Eigen::Vector3d(kPi, 0.2, kPi), Eigen::Vector3d(kPi / 4, 0, 0), Eigen::Vector3d(0, 0, 0)}) {
    for (const double x : {-1e-6, 1e-6, 0.249}) {
      const Pose T = pose_from_xyz_rpy({x, -x, 0.1}, rpy);
      std::vector<double> all;
      for (const Pose& other : stored) all.push_back(pose_distance(options, T, other));
      std::sort(all.begin(), all.end());
      Eigen::MatrixXd out;
      ASSERT_EQ(database.nearest(T, 5, out), 5) << rpy.transpose();
      for (int k = 0; k < 5 && all[k] < 0.5; ++k, ++exact)
        EXPECT_NEAR(pose_distance(options, T, arm.fk(out.col(k))), all[k], kRounding) << rpy.transpose() << " " << k;
    }
  }
  EXPECT_GT(exact, 100);
}

TEST(ReachNearest, FinePositionAndRotationCellsAgreeWithBruteForceToo) {
  const JointGroup arm = gantry();
  for (const double rotation_cell : {0.12, 1.0, 3.0}) {
    ReachOptions options = with_samples(50000, 0);
    options.rotation_cell = rotation_cell;
    options.position_cell = 0.8;
    options.max_per_cell = 1000;
    const auto database = ReachDatabase::build(arm, options);
    std::vector<Pose> stored;
    for (std::int64_t i = 0; i < database.size(); ++i) stored.push_back(arm.fk(database.configuration(i)));
    Rng rng(3);
    for (int trial = 0; trial < 40; ++trial) {
      Pose T = Pose::Identity();
      T.linear() = rng.rotation().toRotationMatrix();
      T.translation() << rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5);
      double best = 1e9;
      for (const Pose& other : stored) best = std::min(best, pose_distance(options, T, other));
      if (best >= 0.5) continue;
      Eigen::MatrixXd out;
      ASSERT_EQ(database.nearest(T, 1, out), 1);
      EXPECT_NEAR(pose_distance(options, T, arm.fk(out.col(0))), best, kRounding) << rotation_cell;
    }
  }
}

TEST(ReachNearest, NearestReusesTheCallersMatrix) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(20000, 0);
  options.position_cell = 0.5;
  const auto database = ReachDatabase::build(arm, options);
  Eigen::MatrixXd out(6, 20);
  const double* storage = out.data();
  EXPECT_EQ(database.nearest(Pose::Identity(), 16, out), 16);
  EXPECT_EQ(out.data(), storage);
  EXPECT_EQ(out.cols(), 20);
  const Pose far = pose_from_xyz_rpy({5, 0, 0}, {0, 0, 0});
  EXPECT_EQ(database.nearest(far, 4, out), 0);
  EXPECT_EQ(database.cell(far).cols(), 0);
  EXPECT_EQ(database.cell(far).rows(), 6);
  EXPECT_EQ(database.nearest(pose_from_xyz_rpy({1e12, 0, 0}, {0, 0, 0}), 4, out), 0);
  EXPECT_THROW(database.nearest(Pose::Identity(), 0, out), InvalidInput);
  Pose broken = Pose::Identity();
  broken.linear()(0, 0) = std::nan("");
  EXPECT_THROW(database.nearest(broken, 1, out), InvalidInput);
  EXPECT_THROW(database.cell(broken), InvalidInput);
  EXPECT_THROW(database.configuration(database.size()), InvalidInput);
}

TEST(ReachNearest, MoreSamplesReachMore) {
  const JointGroup arm = seven_joints();
  const IkOptions ik;
  IkWorkspace workspace;
  std::vector<int> solved;
  for (const std::int64_t samples : {2000, 20000, 200000}) {
    const auto database = ReachDatabase::build(arm, with_samples(samples));
    Rng rng(99);  // the same poses for all three
    Eigen::MatrixXd out;
    int count = 0;
    for (int trial = 0; trial < 400; ++trial) {
      const Pose T = arm.fk(rng.uniform(0.9 * arm.sample_lower(), 0.9 * arm.sample_upper()));
      const int found = database.nearest(T, 8, out);
      bool converged = false;
      for (int k = 0; k < found && !converged; ++k) {
        Eigen::VectorXd q = out.col(k);
        converged = refine_ik(arm, T, q, ik, workspace);
        EXPECT_TRUE(!converged || pose_difference(arm.fk(q), T).norm() < 2e-4);
      }
      count += converged;
    }
    solved.push_back(count);
  }
  RecordProperty("solved_of_400",
                 std::to_string(solved[0]) + " " + std::to_string(solved[1]) + " " + std::to_string(solved[2]));
  EXPECT_LT(solved[0], solved[1]);
  EXPECT_LE(solved[1], solved[2]);
  EXPECT_GE(solved[2], 390);
}

TEST(ReachNearest, SeedsInverseKinematicsOfTheRealPanda) {
  const std::filesystem::path folder = std::filesystem::path(MMGRASP_SHARED_DATA) / "robots/panda";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no robot in " << folder;
  RobotOptions loading;
  loading.package_dirs["moveit_resources_panda_description"] = (folder / "moveit_resources_panda_description").string();
  const std::filesystem::path srdf = folder / "moveit_resources_panda_moveit_config/config/panda.srdf";
  const Robot robot = Robot::load((folder / "expanded/panda.urdf").string(),
                                  std::filesystem::exists(srdf) ? srdf.string() : "", loading);
  const JointGroup arm = robot.chain("panda_link0", "panda_link8");
  // Several draws, since a single one is off by some percent either way: 89.4 % when last looked at.
  constexpr int kDraws = 10, kTrials = 500;
  int solved = 0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    ReachOptions options = with_samples(30000);
    options.seed = seed;
    const auto database = ReachDatabase::build(arm, options);
    ASSERT_GT(database.size(), 5000);
    EXPECT_LT(database.reach(),
              0.333 + 0.316 + 0.384 + 0.088 + 0.107 + 0.1);  // the links stretched out, elbow offset included
    Rng rng(4);
    Eigen::MatrixXd out;
    IkWorkspace workspace;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Pose T = arm.fk(database.configuration(static_cast<std::int64_t>(rng.index(database.size())))) *
                     pose_from_xyz_rpy({0.02, -0.02, 0.01}, {0.1, -0.1, 0.1});
      const int found = database.nearest(T, 8, out);
      bool converged = false;
      for (int k = 0; k < found && !converged; ++k) {
        Eigen::VectorXd q = out.col(k);
        converged = refine_ik(arm, T, q, {}, workspace) && arm.within_limits(q);
      }
      solved += converged;
    }
  }
  EXPECT_GE(solved, 89 * kDraws * kTrials / 100);
}

}  // namespace
}  // namespace mmgrasp
