#include "mmgrasp/reach/reach_solve.hpp"

#include <gtest/gtest.h>

#include <kdl/chainfksolverpos_recursive.hpp>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/base_placement.hpp"
#include "mmgrasp/reach/reach_arrays.hpp"
#include "support/reach_arms.hpp"

namespace mmgrasp {
namespace {

using test::seven_joints;
using test::with_samples;

constexpr double kPi = 3.14159265358979323846;

/// seven_joint_urdf written down by hand for KDL.
KDL::Chain kdl_seven_joints() {
  using KDL::Frame;
  using KDL::Joint;
  using KDL::Vector;
  KDL::Chain chain;
  const auto add = [&](Joint::JointType axis, double to_next) {
    chain.addSegment(KDL::Segment(Joint(axis), Frame(Vector(0, 0, to_next))));
  };
  chain.addSegment(KDL::Segment(Joint(Joint::Fixed), Frame(Vector(0, 0, 0.36))));
  add(Joint::RotZ, 0);
  add(Joint::RotY, 0.4);
  add(Joint::RotZ, 0);
  add(Joint::RotY, 0.4);
  add(Joint::RotZ, 0);
  add(Joint::RotY, 0);
  add(Joint::RotZ, 0.2);
  return chain;
}

Pose kdl_fk(const Eigen::VectorXd& q) {
  KDL::Chain chain = kdl_seven_joints();
  KDL::ChainFkSolverPos_recursive solver(chain);
  KDL::JntArray joints(7);
  for (int i = 0; i < 7; ++i) joints(i) = q[i];
  KDL::Frame frame;
  solver.JntToCart(joints, frame);
  Pose T = Pose::Identity();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) T.linear()(r, c) = frame.M(r, c);
    T.translation()[r] = frame.p[r];
  }
  return T;
}

const ReachDatabase& shared_database() {
  static const ReachDatabase database = ReachDatabase::build(seven_joints(), with_samples(100000));
  return database;
}

bool holds_column(const Eigen::MatrixXd& columns, const Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < columns.cols(); ++i)
    if (columns.col(i) == q) return true;
  return false;
}

TEST(ReachSolve, StoredConfigurationsLieWithinLimitsInTheirVoxelAndAreFree) {
  const JointGroup arm = seven_joints();
  const ReachDatabase& database = shared_database();
  CollisionChecker checker(arm, World{});
  const ReachArrays arrays = reach_arrays(database);
  ASSERT_EQ(arrays.size, database.size());
  for (std::int64_t position = 0; position < arrays.positions; ++position) {
    for (std::uint32_t cell = arrays.position_first[position]; cell < arrays.position_first[position + 1]; cell += 5) {
      for (std::uint32_t i = arrays.cell_first[cell]; i < arrays.cell_first[cell + 1]; ++i) {
        Eigen::VectorXd q(7);
        for (int k = 0; k < 7; ++k)
          q[k] = arrays.joint_lower[k] + arrays.joint_step[k] * arrays.configurations[7 * i + static_cast<unsigned>(k)];
        EXPECT_EQ(q, database.configuration(i));
        EXPECT_TRUE(arm.within_limits(q, 0));
        const Pose T = kdl_fk(q);
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_EQ(static_cast<int>(std::floor(T.translation()[axis] / database.options().position_cell)),
                    arrays.position_cells[3 * position + axis]);
        EXPECT_TRUE(holds_column(database.cell(T), q));
        EXPECT_TRUE(checker.is_free(q));
      }
    }
  }
}

TEST(ReachSolve, SolutionsAreExactDifferentAndFree) {
  const JointGroup arm = seven_joints();
  World world;
  world.add("wall", Box{{0.4, 2, 2}}, pose_from_xyz_rpy({0.75, 0, 0.5}, {0, 0, 0}));
  CollisionChecker checker(arm, world);
  Rng rng(12);
  ReachSolveOptions options;
  options.count = 5;
  int solved = 0, with_all = 0, of_all = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::VectorXd truth = rng.uniform(arm.sample_lower(), arm.sample_upper());
    if (!checker.is_free(truth)) continue;
    ++of_all;
    const Pose T = kdl_fk(truth);
    const auto found = solve_reach(shared_database(), arm, T, options, &checker);
    ASSERT_LE(found.size(), 5u);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Pose reached = kdl_fk(found[i]);
      EXPECT_LE((reached.translation() - T.translation()).norm(), options.ik.position_tolerance + 1e-12);
      EXPECT_LE(rotation_distance(reached, T), options.ik.rotation_tolerance + 1e-9);
      EXPECT_TRUE(arm.within_limits(found[i], 1e-9));
      EXPECT_EQ(checker.rejection(found[i]), Rejection::none);
      for (std::size_t k = 0; k < i; ++k) EXPECT_GT((found[i] - found[k]).cwiseAbs().maxCoeff(), options.distinct);
    }
    solved += !found.empty();
    with_all += found.size() == 5;
  }
  EXPECT_GT(of_all, 60);
  EXPECT_GT(solved, 0.9 * of_all);
  EXPECT_GT(with_all, 0.5 * of_all) << "seven joints leave a choice";
}

TEST(ReachSolve, ABatchGivesWhatSingleCallsDoAtAnyThreadCount) {
  const JointGroup arm = seven_joints();
  Rng rng(3);
  Poses poses;
  for (int i = 0; i < 40; ++i) poses.push_back(arm.fk(rng.uniform(arm.sample_lower(), arm.sample_upper())));
  for (const int threads : {1, 3}) {
    ReachSolveOptions options;
    options.threads = threads;
    const auto batch = solve_reach_batch(shared_database(), arm, poses, options);
    ASSERT_EQ(batch.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i)
      EXPECT_EQ(batch[i], solve_reach(shared_database(), arm, poses[i], options));
  }
  EXPECT_THROW(solve_reach(shared_database(), test::gantry(), poses[0]), InvalidInput);
  ReachSolveOptions wrong;
  wrong.count = 0;
  EXPECT_THROW(solve_reach(shared_database(), arm, poses[0], wrong), InvalidInput);
}

TEST(ReachSolve, BasePosesAreThoseOfBruteForceOverTheStoredConfigurations) {
  const JointGroup arm = seven_joints();
  const ReachDatabase& database = shared_database();
  const Pose target = pose_from_xyz_rpy({3.037, -2.041, 0.637}, {0.4, 1.2, 0.3});
  BasePlacementOptions options;
  options.step = 0.1;
  options.headings = 8;
  const auto found = base_poses_for(database, arm, target, 1000000, options);
  ASSERT_GT(found.size(), 20u);
  for (const BaseReach& reach : found) {
    const Pose T = pose_from_planar(reach.base_pose) * kdl_fk(reach.q);
    EXPECT_LE((T.translation() - target.translation()).norm(), options.ik.position_tolerance + 1e-12);
    EXPECT_LE(rotation_distance(T, target), options.ik.rotation_tolerance + 1e-9);
  }
  // Every base pose of the grid, one by one: the same have a configuration in the target's voxel that can be refined.
  const auto is_found = [&](const Eigen::Vector3d& base) {
    for (const BaseReach& reach : found)
      if ((reach.base_pose - base).norm() < 1e-9) return true;
    return false;
  };
  int with_voxel = 0, agreed = 0;
  for (int h = 0; h < 8; ++h) {
    const double heading = 2 * kPi * h / 8 > kPi ? 2 * kPi * h / 8 - 2 * kPi : 2 * kPi * h / 8;
    for (int i = 10; i < 50; ++i) {
      for (int j = -40; j < 0; ++j) {
        const Eigen::Vector3d base(0.1 * i, 0.1 * j, heading);
        const Pose T = pose_from_planar(base).inverse() * target;
        const bool voxel = database.cell(T).cols() > 0;
        if (!voxel) {
          EXPECT_FALSE(is_found(base)) << base.transpose();
          continue;
        }
        ++with_voxel;
        ReachSolveOptions exact;
        exact.candidates = options.seeds;
        agreed += is_found(base) == !solve_reach(database, arm, T, exact).empty();
      }
    }
  }
  EXPECT_GT(with_voxel, 20);
  EXPECT_EQ(agreed, with_voxel);
}

TEST(ReachSolve, APlacementServesAsManyTargetsAsAnyOfAFinerGrid) {
  const JointGroup arm = seven_joints();
  World world;
  world.add("shelf", Box{{0.3, 2, 0.4}}, pose_from_xyz_rpy({1.2, 0, 0.2}, {0, 0, 0}));
  CollisionChecker checker(arm, world);
  Rng rng(6);
  Poses targets;
  for (int i = 0; i < 12; ++i)
    targets.push_back(pose_from_xyz_rpy({rng.uniform(1.1, 1.3), rng.uniform(-0.9, 0.9), rng.uniform(0.5, 0.9)},
                                        {0, rng.uniform(1.2, 2.5), rng.uniform(-1, 1)}));
  const BasePlacement placement = find_base_placement(shared_database(), arm, targets, {}, &checker);
  ASSERT_EQ(placement.configurations.size(), targets.size());
  int reached = 0;
  checker.set_root(pose_from_planar(placement.base_pose));
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const Eigen::VectorXd& q = placement.configurations[i];
    if (q.size() == 0) continue;
    ++reached;
    const Pose T = pose_from_planar(placement.base_pose) * kdl_fk(q);
    EXPECT_LE((T.translation() - targets[i].translation()).norm(), 1e-5 + 1e-12);
    EXPECT_LE(rotation_distance(T, targets[i]), 1e-4 + 1e-9);
    EXPECT_TRUE(checker.is_free(q));
  }
  EXPECT_EQ(reached, placement.reached);
  // Every pose of a grid by inverse kinematics, without the votes.
  int best = 0;
  ReachSolveOptions exact;
  exact.count = 1;
  exact.candidates = 8;
  for (double x = -0.2; x < 2.6; x += 0.2) {
    for (double y = -1.2; y < 1.3; y += 0.2) {
      for (double heading = 0; heading < 2 * kPi; heading += kPi / 4) {
        const Pose base = pose_from_planar({x, y, heading});
        checker.set_root(base);
        int served = 0;
        for (const Pose& target : targets)
          served += !solve_reach(shared_database(), arm, base.inverse() * target, exact, &checker).empty();
        best = std::max(best, served);
      }
    }
  }
  EXPECT_GT(best, 4);
  EXPECT_GE(placement.reached, best);
  const BasePlacement again = [&] {
    BasePlacementOptions one;
    one.threads = 1;
    return find_base_placement(shared_database(), arm, targets, one, &checker);
  }();
  EXPECT_EQ(again.base_pose, placement.base_pose);
  EXPECT_EQ(again.configurations, placement.configurations);
}

TEST(ReachSolve, NothingIsReachedFromNowhere) {
  const JointGroup arm = seven_joints();
  const Poses targets{pose_from_xyz_rpy({0, 0, 9}, {0, 0, 0})};
  const BasePlacement placement = find_base_placement(shared_database(), arm, targets);
  EXPECT_EQ(placement.reached, 0);
  ASSERT_EQ(placement.configurations.size(), 1u);
  EXPECT_EQ(placement.configurations[0].size(), 0);
  EXPECT_TRUE(base_poses_for(shared_database(), arm, targets[0], 5).empty());
  EXPECT_THROW(find_base_placement(shared_database(), arm, {}), InvalidInput);
  BasePlacementOptions wrong;
  wrong.step = 0;
  EXPECT_THROW(find_base_placement(shared_database(), arm, targets, wrong), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
