#include "mmgrasp/reach/reach_database.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/reach_arms.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;

using test::gantry;
using test::seven_joints;
using test::with_samples;

bool holds_column(const Eigen::MatrixXd& columns, const Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    if (columns.col(i) == q) return true;
  return false;
}

TEST(ReachDatabase, StoredConfigurationsLieInTheCellOfTheirToolPose) {
  const JointGroup arm = seven_joints();
  const auto database = ReachDatabase::build(arm, with_samples(40000));
  ASSERT_GT(database.size(), 10000);
  Rng rng(5);
  for (int i = 0; i < 500; ++i) {
    const auto index = static_cast<std::int64_t>(rng.index(database.size()));
    const Eigen::VectorXd q = database.configuration(index);
    EXPECT_TRUE(arm.within_limits(q));
    EXPECT_TRUE(holds_column(database.cell(arm.fk(q)), q));
    EXPECT_LT((database.tool_pose(index).matrix() - arm.fk(q).matrix()).norm(), 1e-12);
  }
}

TEST(ReachDatabase, CellsAreAsSmallAsAskedAndHoldAtMostTheirLimit) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(60000, 0);
  options.position_cell = 0.5;
  options.max_per_cell = 4;
  const auto database = ReachDatabase::build(arm, options);
  std::int64_t cells = 0, full = 0;
  std::set<std::int64_t> seen;
  for (std::int64_t i = 0; i < database.size(); i += 7) {
    const Pose T = arm.fk(database.configuration(i));
    const Eigen::MatrixXd cell = database.cell(T);
    ASSERT_GE(cell.cols(), 1);
    ASSERT_LE(cell.cols(), 4);
    ++cells;
    full += cell.cols() == 4;
    for (Eigen::Index k = 0; k < cell.cols(); ++k) {
      const Pose other = arm.fk(cell.col(k));
      EXPECT_LT((T.translation() - other.translation()).cwiseAbs().maxCoeff(), 0.5);
      // Direction and roll differ by at most about a diagonal of the cell each.
      EXPECT_LT(rotation_distance(T, other), 2 * options.rotation_cell);
    }
  }
  EXPECT_GT(full, cells / 2);
  EXPECT_LE(database.size(), 4 * database.cell_count());
}

TEST(ReachDatabase, PositionsAreFlooredSoTheCellAtZeroIsNoWider) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(200000, 0);
  options.position_cell = 0.25;
  options.rotation_cell = 3;
  options.max_per_cell = 100000;
  const auto database = ReachDatabase::build(arm, options);
  ASSERT_EQ(database.size(), 200000);  // nothing to drop: the closed form is the joints themselves
  double smallest = 1e9, largest = 0;
  for (int i = -2; i < 2; ++i) {
    std::int64_t slab = 0;
    for (std::int64_t k = 0; k < database.size(); ++k) {
      const double x = database.configuration(k)[0];
      slab += x >= 0.25 * i && x < 0.25 * (i + 1);
    }
    smallest = std::min(smallest, static_cast<double>(slab));
    largest = std::max(largest, static_cast<double>(slab));
  }
  EXPECT_LT(largest, 1.1 * smallest);
  for (const double x : {-0.01, 0.01}) {
    Pose T = pose_from_xyz_rpy({x, 0.1, 0.1}, {0.1, 0.2, 0.3});
    const Eigen::MatrixXd cell = database.cell(T);
    ASSERT_GT(cell.cols(), 50);
    EXPECT_GE(cell.row(0).minCoeff(), x < 0 ? -0.25 : 0.0);
    EXPECT_LT(cell.row(0).maxCoeff(), x < 0 ? 0.0 : 0.25);
  }
}

TEST(ReachDatabase, RotationCellsHaveNearlyEqualSizes) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(400000, 0);
  options.position_cell = 10;
  options.max_per_cell = 1000000;
  const auto database = ReachDatabase::build(arm, options);
  // Six faces of 3 x 3 directions, 12 rolls; the position range touches eight cells around the origin.
  ASSERT_EQ(database.cell_count(), 8 * 54 * 12);
  // Uniform yaw, pitch, roll weighted by |cos pitch| is uniform over rotations: the weight in a cell is its volume. The
  // solid angles of an equiangular cube's cells differ by at most sqrt 2; the rest is sampling noise.
  Rng rng(21);
  double smallest = 1e9, largest = 0, sum = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    Pose T = Pose::Identity();
    T.linear() = rng.rotation().toRotationMatrix();
    double weight = 0;
    for (int octant = 0; octant < 8; ++octant) {
      T.translation() << (octant & 1 ? 0.1 : -0.1), (octant & 2 ? 0.1 : -0.1), (octant & 4 ? 0.1 : -0.1);
      weight += database.cell(T).row(4).array().cos().abs().sum();
    }
    smallest = std::min(smallest, weight);
    largest = std::max(largest, weight);
    sum += weight / 3000;
  }
  EXPECT_LT(largest / smallest, 2.0);
  EXPECT_NEAR(sum, 400000 * 2 / kPi / 648, 0.05 * sum);
}

TEST(ReachDatabase, KeepsNoSelfCollision) {
  const JointGroup arm = Robot::from_strings(test::two_balls_urdf()).chain("base", "tip");
  ReachOptions options = with_samples(20000, 0);
  options.max_per_cell = 1000000;
  const auto database = ReachDatabase::build(arm, options);
  // |tip| = cos(elbow / 2) for two links of 0.5 m; the balls touch below 0.2 m.
  double closest = 1;
  for (std::int64_t i = 0; i < database.size(); ++i)
    closest = std::min(closest, std::cos(database.configuration(i)[1] / 2));
  EXPECT_GE(closest, 0.2);
  EXPECT_LT(closest, 0.205);
  // Share that is free: elbow within +-2 acos(0.2) of +-3.
  EXPECT_NEAR(static_cast<double>(database.size()) / 20000, 2 * std::acos(0.2) / 3.0, 0.01);
  EXPECT_NEAR(database.reach(), 1.0, 1e-5);
  EXPECT_TRUE(database.bounds().contains(Eigen::Vector3d(0.9, 0, 0)));
  EXPECT_LE(database.bounds().max().maxCoeff(), 1 + 2e-6);
}

TEST(ReachDatabase, DropsWhatIsNearlySingular) {
  // Two joints in a plane: sqrt(det(J^T J)) at the tip has a closed form with translation and rotation rows; for arms
  // of six and more joints it is JointGroup::manipulability.
  const JointGroup arm = seven_joints();
  const auto range = [&](double share) {
    const auto database = ReachDatabase::build(arm, with_samples(40000, share));
    double smallest = 1e9, largest = 0;
    for (std::int64_t i = 0; i < database.size(); ++i) {
      const double value = arm.manipulability(database.configuration(i));
      smallest = std::min(smallest, value);
      largest = std::max(largest, value);
    }
    return std::pair(smallest, largest);
  };
  const auto [all_smallest, largest_free] = range(0);
  double all_largest = largest_free;
  Rng rng(8);  // samples in self-collision count too
  for (int i = 0; i < 200000; ++i)
    all_largest = std::max(all_largest, arm.manipulability(rng.uniform(arm.sample_lower(), arm.sample_upper())));
  EXPECT_LT(all_smallest, 0.01 * all_largest);
  const auto [smallest, largest] = range(0.3);
  EXPECT_GE(smallest, 0.3 * 0.9 * all_largest);  // the largest is estimated from the first samples
  EXPECT_LE(smallest, 0.3 * all_largest);
}

TEST(ReachDatabase, TheMostDifferentOfACellComeFirst) {
  const JointGroup arm = gantry();
  ReachOptions options = with_samples(50000, 0);
  options.position_cell = 1;
  const auto database = ReachDatabase::build(arm, options);
  const Eigen::VectorXd range = arm.sample_upper() - arm.sample_lower();
  int looked_at = 0;
  for (std::int64_t i = 0; i < database.size(); i += 97) {
    const Eigen::MatrixXd cell = database.cell(arm.fk(database.configuration(i)));
    const auto apart = [&](Eigen::Index a, Eigen::Index b) {
      return (cell.col(a) - cell.col(b)).cwiseQuotient(range).norm();
    };
    for (Eigen::Index k = 2; k < cell.cols(); ++k, ++looked_at) EXPECT_LE(apart(0, k), apart(0, 1) + 1e-6);
  }
  EXPECT_GT(looked_at, 100);
}

TEST(ReachDatabase, StopsAndReports) {
  const JointGroup arm = gantry();
  Monitor monitor;
  const auto caller = std::this_thread::get_id();
  std::vector<double> fractions;
  monitor.progress = [&](const std::string& stage, double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(stage, "reachability database");
    fractions.push_back(fraction);
  };
  EXPECT_GT(ReachDatabase::build(arm, with_samples(200000), monitor).size(), 0);
  ASSERT_GE(fractions.size(), 3u);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);

  Monitor stopping;
  stopping.progress = [&](const std::string&, double fraction) {
    if (fraction > 0) stopping.stop.stop();
  };
  const auto stopped = ReachDatabase::build(arm, with_samples(2000000), stopping);
  EXPECT_EQ(stopped.size(), 0);
  EXPECT_EQ(stopped.cell_count(), 0);
  EXPECT_EQ(stopped.reach(), 0);
  EXPECT_TRUE(stopped.bounds().isEmpty());
  Eigen::MatrixXd out;
  EXPECT_EQ(stopped.nearest(Pose::Identity(), 3, out), 0);
  EXPECT_EQ(stopped.cell(Pose::Identity()).cols(), 0);
}

TEST(ReachDatabase, RefusesBadInput) {
  const JointGroup arm = gantry();
  for (int field = 0; field < 7; ++field) {
    ReachOptions options = with_samples(1000);
    if (field == 0) options.samples = 0;
    if (field == 1) options.position_cell = 0;
    if (field == 2) options.position_cell = std::nan("");
    if (field == 3) options.rotation_cell = 0.05;
    if (field == 4) options.max_per_cell = 0;
    if (field == 5) options.min_manipulability = 1;
    if (field == 6) options.threads = -1;
    EXPECT_THROW(ReachDatabase::build(arm, options), InvalidInput) << field;
  }
  ReachOptions fine = with_samples(1000);
  fine.position_cell = 1e-5;
  EXPECT_THROW(ReachDatabase::build(arm, fine), InvalidInput);
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const Robot robot = Robot::from_strings(test::gantry_urdf(), "", omni);
  EXPECT_THROW(ReachDatabase::build(robot.chain("base", "c", true), with_samples(1000)), InvalidInput);
}

TEST(ReachDatabase, PosesAreRelativeToTheRoot) {
  const JointGroup arm = gantry();
  const auto here = ReachDatabase::build(arm, with_samples(3000));
  const auto there = ReachDatabase::build(arm.at(pose_from_planar({3, 2, 1})), with_samples(3000));
  EXPECT_EQ(here.key(), there.key());
  ASSERT_EQ(here.size(), there.size());
  EXPECT_EQ(here.bounds().min(), there.bounds().min());
  EXPECT_EQ(here.configuration(100), there.configuration(100));
}

}  // namespace
}  // namespace mmgrasp
