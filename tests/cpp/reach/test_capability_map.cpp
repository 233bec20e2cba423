#include "mmgrasp/reach/capability_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <set>
#include <thread>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/reach_arms.hpp"
#include "support/robot_support.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using test::gantry;
using test::seven_joints;
using test::urdf_joint;
using test::urdf_link;

/// A turret, two links of 0.5 and 0.3 m that flex in one plane, and a wrist whose three axes meet; no limits, no
/// shapes. The tip stands `tool` beyond the wrist along its last axis.
JointGroup shell_arm(const std::string& tool = "0.1", const std::string& wrist_type = "continuous",
                     const std::string& wrist_limit = "3.2") {
  const std::string negative = "-" + wrist_limit;
  return Robot::from_strings("<robot name='shell'>" + urdf_link("base") + urdf_link("a") + urdf_link("b") +
                             urdf_link("c") + urdf_link("d") + urdf_link("e") + urdf_link("f") + urdf_link("tip") +
                             urdf_joint("turret", "continuous", "base", "a", "0 0 0.8", "0 0 1") +
                             urdf_joint("shoulder", "continuous", "a", "b", "0 0 0", "0 1 0") +
                             urdf_joint("elbow", "continuous", "b", "c", "0.5 0 0", "0 1 0") +
                             urdf_joint("wrist_1", "continuous", "c", "d", "0.3 0 0", "1 0 0") +
                             urdf_joint("wrist_2", wrist_type, "d", "e", "0 0 0", "0 1 0", negative, wrist_limit) +
                             urdf_joint("wrist_3", "continuous", "e", "f", "0 0 0", "1 0 0") +
                             urdf_joint("flange", "fixed", "f", "tip", tool + " 0 0", "1 0 0") + "</robot>")
      .chain("base", "tip");
}

CapabilityOptions small(double voxel = 0.2, int poses = 24) {
  CapabilityOptions options;
  options.lower = {-1, -1, 0};
  options.upper = {1, 1, 1.6};
  options.voxel = voxel;
  options.poses = poses;
  options.approach = Vector3d::UnitX();
  return options;
}

CapabilityOptions around_seven_joints(int poses = 24) {
  CapabilityOptions options = small(0.2, poses);
  options.lower = {-1.2, -1.2, -0.6};
  options.upper = {1.2, 1.2, 1.4};
  options.approach = Vector3d::UnitZ();
  return options;
}

World wall(double x) {
  World world;
  Pose T = Pose::Identity();
  T.translation() = Vector3d(x, 0, 0.5);
  world.add("wall", Box{{0.05, 4, 4}}, T);
  return world;
}

void each_pose(const CapabilityMap& map, const std::function<void(std::int64_t, int)>& use) {
  for (std::int64_t voxel = 0; voxel < map.voxel_count(); ++voxel)
    for (int pose = 0; pose < map.options().poses; ++pose) use(voxel, pose);
}

TEST(CapabilityMap, ToolPosesStandOnTheInscribedSphereAndPointAtItsCentre) {
  CapabilityOptions options = small(0.1, 200);
  options.lower = {0, 0, 0};
  options.upper = {0.1, 0.1, 0.1};
  for (const int rolls : {1, 4}) {
    options.rolls = rolls;
    const auto map = CapabilityMap::build(shell_arm(), World{}, options);
    ASSERT_EQ(map.voxel_count(), 1);
    const Vector3d centre = map.centre(0);
    EXPECT_TRUE(centre.isApprox(Vector3d(0.05, 0.05, 0.05)));
    Vector3d sum = Vector3d::Zero();
    double widest = 0;
    std::vector<Vector3d> outwards;
    for (int k = 0; k < options.poses; ++k) {
      const Pose T = map.tool_pose(0, k);
      const Vector3d from_centre = T.translation() - centre;
      EXPECT_NEAR(from_centre.norm(), 0.05, 1e-12);
      EXPECT_NEAR((T.linear() * Vector3d::UnitX()).dot(from_centre.normalized()), -1, 1e-12);
      EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
      sum += from_centre.normalized();
      if (k % rolls == 0) outwards.push_back(from_centre.normalized());
    }
    // Even: the mean direction vanishes, and every direction has a neighbour about as near as on a hexagonal lattice of
    // as many points, whose nearest are sqrt(8 pi / (sqrt(3) n)) apart.
    EXPECT_LT(sum.norm() / options.poses, 0.01);
    const double lattice = std::sqrt(8 * M_PI / (std::sqrt(3.0) * static_cast<double>(outwards.size())));
    for (const Vector3d& a : outwards) {
      double nearest = 10;
      for (const Vector3d& b : outwards)
        if (&a != &b) nearest = std::min(nearest, std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
      EXPECT_GT(nearest, 0.6 * lattice);
      widest = std::max(widest, nearest);
    }
    EXPECT_LT(widest, 1.2 * lattice);
    // Rolls: orientations of a direction differ by whole parts of a turn.
    if (rolls == 4) {
      EXPECT_NEAR(rotation_distance(map.tool_pose(0, 0), map.tool_pose(0, 1)), M_PI / 2, 1e-9);
      EXPECT_NEAR(rotation_distance(map.tool_pose(0, 0), map.tool_pose(0, 2)), M_PI, 1e-6);
    }
  }
}

TEST(CapabilityMap, ReachesExactlyTheShellThatTwoLinksSpan) {
  const auto map = CapabilityMap::build(shell_arm(), World{}, small());
  std::int64_t reached = 0, refused = 0;
  each_pose(map, [&](std::int64_t voxel, int pose) {
    const Pose T = map.tool_pose(voxel, pose);
    const double wrist = (T * Vector3d(-0.1, 0, 0) - Vector3d(0, 0, 0.8)).norm();
    if (std::abs(wrist - 0.8) < 1e-3 || std::abs(wrist - 0.2) < 1e-3) return;  // within tolerance of the border
    const bool inside = wrist < 0.8 && wrist > 0.2;
    EXPECT_EQ(map.classified(voxel, pose), inside ? Rejection::none : Rejection::unreachable);
    (inside ? reached : refused) += 1;
  });
  EXPECT_GT(reached, 3000);
  EXPECT_GT(refused, 3000);
}

TEST(CapabilityMap, LimitsTakeAwayExactlyTheDirectionsTheyForbid) {
  // The wrist's middle joint turns by the angle between forearm and tool. Both elbows are closed forms.
  constexpr double kLimit = 1.0;
  const auto map = CapabilityMap::build(shell_arm("0.1", "revolute", "1.0"), World{}, small());
  std::int64_t reached = 0, limited = 0;
  each_pose(map, [&](std::int64_t voxel, int pose) {
    const Pose T = map.tool_pose(voxel, pose);
    const Vector3d from_shoulder = T * Vector3d(-0.1, 0, 0) - Vector3d(0, 0, 0.8);
    const double d = from_shoulder.norm();
    if (std::abs(d - 0.8) < 1e-3 || std::abs(d - 0.2) < 1e-3 || d < 0.2 || d > 0.8) return;
    // Angle at the wrist between the forearm and the line to the shoulder, bent up or down in the vertical plane.
    const double bend = std::acos((d * d + 0.09 - 0.25) / (2 * d * 0.3));
    const Vector3d across = Vector3d::UnitZ().cross(from_shoulder);
    if (across.norm() < 1e-6) return;  // any vertical plane would do
    double best = 10;
    for (const double sign : {-1.0, 1.0}) {
      const Vector3d forearm = Eigen::AngleAxisd(sign * bend, across.normalized()) * from_shoulder / d;
      best = std::min(best, std::acos(std::clamp(forearm.dot(T.linear().col(0)), -1.0, 1.0)));
    }
    if (std::abs(best - kLimit) < 1e-3) return;
    EXPECT_EQ(map.classified(voxel, pose), best < kLimit ? Rejection::none : Rejection::limits) << best;
    (best < kLimit ? reached : limited) += 1;
  });
  EXPECT_GT(reached, 1000);
  EXPECT_GT(limited, 1000);
}

TEST(CapabilityMap, SlidesReachTheirBox) {
  CapabilityOptions options;
  options.lower = {-0.8, -0.8, -0.8};
  options.upper = {0.8, 0.8, 0.8};
  options.voxel = 0.4;
  options.poses = 20;
  const auto map = CapabilityMap::build(gantry(), World{}, options);
  each_pose(map, [&](std::int64_t voxel, int pose) {
    const double farthest = map.tool_pose(voxel, pose).translation().cwiseAbs().maxCoeff();
    if (std::abs(farthest - 0.5) < 1e-3) return;
    EXPECT_EQ(map.classified(voxel, pose) == Rejection::none, farthest < 0.5) << farthest;
  });
  EXPECT_EQ(map.maximum(), 1);
}

TEST(CapabilityMap, EveryReachedPoseIsReachedByItsConfiguration) {
  const JointGroup arm = seven_joints().at(pose_from_planar({0.3, -0.2, 0.7}));
  World world;
  Pose T = Pose::Identity();
  T.translation() = Vector3d(0.7, 0.2, 0.3);
  world.add("box", Box{{0.3, 0.5, 0.6}}, T);
  const auto map = CapabilityMap::build(arm, world, around_seven_joints());
  CollisionChecker checker(arm, world);
  const KDL::Chain chain = testing_support::kdl_chain(arm.robot(), arm.tip_link());
  KDL::ChainFkSolverPos_recursive fk(chain);
  std::int64_t reached = 0;
  Rejections rejections;
  each_pose(map, [&](std::int64_t voxel, int pose) {
    const Eigen::VectorXd q = map.configuration(voxel, pose);
    if (map.classified(voxel, pose) != Rejection::none) {
      EXPECT_EQ(q.size(), 0);
      rejections.add(map.classified(voxel, pose));
      return;
    }
    ++reached;
    KDL::JntArray joints(7);
    joints.data = q;
    KDL::Frame frame;
    ASSERT_GE(fk.JntToCart(joints, frame), 0);
    const KDL::Twist error = KDL::diff(frame, testing_support::to_kdl(map.tool_pose(voxel, pose)));
    EXPECT_LE(error.vel.Norm(), 1e-5);
    EXPECT_LE(error.rot.Norm(), 1e-4);
    EXPECT_EQ(checker.rejection(q), Rejection::none);
  });
  EXPECT_EQ(reached, map.reached());
  EXPECT_TRUE(rejections == map.rejections());
  EXPECT_GT(map.rejections().scene, 0u);
  EXPECT_GT(map.rejections().self_collision, 0u);
  double sum = 0;
  for (const float index : map.index()) sum += static_cast<double>(index) * map.options().poses;
  EXPECT_NEAR(sum, static_cast<double>(reached), 1e-3 * static_cast<double>(reached));
}

TEST(CapabilityMap, FewPosesAreClassedOtherwiseThanByManyRestarts) {
  const JointGroup arm = seven_joints();
  World world;
  Pose T = Pose::Identity();
  T.translation() = Vector3d(0.6, 0, 0.4);
  world.add("table", Box{{0.6, 1.2, 0.05}}, T);
  const auto map = CapabilityMap::build(arm, world, around_seven_joints());
  CollisionChecker checker(arm, world);
  IkOptions ik;
  ik.restarts = 300;
  ik.time_limit = 60;
  Rng rng(3);
  int missed = 0, tried = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto voxel = static_cast<std::int64_t>(rng.index(map.voxel_count()));
    const int pose = static_cast<int>(rng.index(24));
    const bool solved =
        solve_collision_free_ik(checker, map.tool_pose(voxel, pose), Eigen::VectorXd::Zero(7), ik).outcome ==
        Outcome::solved;
    tried += solved;
    missed += solved && map.classified(voxel, pose) != Rejection::none;
  }
  EXPECT_GT(tried, 100);
  EXPECT_LE(missed, 2);
}

TEST(CapabilityMap, AWallHidesWhatIsBehindIt) {
  const JointGroup arm = seven_joints();
  const CapabilityOptions options = around_seven_joints();
  const auto free = CapabilityMap::build(arm, World{}, options);
  const auto walled = CapabilityMap::build(arm, wall(0.45), options);
  std::int64_t hidden = 0, before = 0;
  for (std::int64_t voxel = 0; voxel < free.voxel_count(); ++voxel) {
    const double x = free.centre(voxel).x();
    const float was = free.index()[voxel], is = walled.index()[voxel];
    if (x > 0.6) {  // the wall is 4 m wide and high: no way around it
      EXPECT_EQ(is, 0);
      hidden += was > 0;
    } else if (x < 0.2) {
      before += is > 0;
    }
  }
  EXPECT_GT(hidden, 50);
  EXPECT_GT(before, 50);
  EXPECT_GT(walled.rejections().scene, 0u);
}

TEST(CapabilityMap, AnObstacleNeverAddsReachedPoses) {
  const JointGroup arm = seven_joints();
  const CapabilityOptions options = around_seven_joints(16);
  const auto free = CapabilityMap::build(arm, World{}, options);
  const auto walled = CapabilityMap::build(arm, wall(0.5), options);
  const auto restricted = free.restricted(arm, wall(0.5));
  std::int64_t added = 0, differ = 0;
  for (std::size_t i = 0; i < free.classes().size(); ++i) {
    if (free.classes()[i] != 0) {
      added += walled.classes()[i] == 0;
      EXPECT_NE(restricted.classes()[i], 0);
    }
    differ += (walled.classes()[i] == 0) != (restricted.classes()[i] == 0);
  }
  EXPECT_EQ(added, 0);
  EXPECT_LE(static_cast<double>(differ), 0.005 * static_cast<double>(free.classes().size()));
  const auto everything = free.restricted(arm, World{});
  EXPECT_EQ(everything.classes(), free.classes());
  EXPECT_EQ(everything.configurations(), free.configurations());
}

TEST(CapabilityMap, WhatTheHandHoldsCounts) {
  const JointGroup arm = seven_joints();
  CapabilityOptions options = around_seven_joints(12);
  const World empty_handed = wall(0.6);
  World holding = empty_handed;
  holding.add("rod", Cylinder{0.01, 0.5}, Pose::Identity());
  Pose T = Pose::Identity();
  T.translation() = Vector3d(0, 0, 0.3);
  holding.attach("rod", "tool", T);
  const auto without = CapabilityMap::build(arm, empty_handed, options);
  const auto with = CapabilityMap::build(arm, holding, options);
  EXPECT_LT(with.reached(), without.reached());
  for (std::size_t i = 0; i < with.classes().size(); ++i) {
    if (without.classes()[i] != static_cast<std::uint8_t>(Rejection::unreachable)) continue;
    EXPECT_NE(with.classes()[i], static_cast<std::uint8_t>(Rejection::none));
  }
}

TEST(CapabilityMap, TheSameAtAnyThreadCount) {
  CapabilityOptions options = around_seven_joints(12);
  options.threads = 1;
  const auto one = CapabilityMap::build(seven_joints(), wall(0.5), options);
  options.threads = 3;
  const auto three = CapabilityMap::build(seven_joints(), wall(0.5), options);
  EXPECT_EQ(one.classes(), three.classes());
  EXPECT_EQ(one.configurations(), three.configurations());
}

TEST(CapabilityMap, MovesWithTheRobot) {
  const Pose T = pose_from_planar({3, -2, 1.2});
  World moved;
  Pose T_wall = Pose::Identity();
  T_wall.translation() = Vector3d(0.5, 0, 0.5);
  moved.add("wall", Box{{0.05, 4, 4}}, T * T_wall);
  const CapabilityOptions options = around_seven_joints(12);
  const auto here = CapabilityMap::build(seven_joints(), wall(0.5), options);
  const auto there = CapabilityMap::build(seven_joints().at(T), moved, options);
  std::int64_t differ = 0;
  for (std::size_t i = 0; i < here.classes().size(); ++i)
    differ += (here.classes()[i] == 0) != (there.classes()[i] == 0);
  EXPECT_LE(differ, static_cast<std::int64_t>(here.classes().size() / 5000)) << "roundings at borders only";
}

TEST(CapabilityMap, VoxelsAndIndicesAnswerForPoints) {
  const auto map = CapabilityMap::build(shell_arm(), World{}, small(0.2, 8));
  EXPECT_EQ(map.shape(), (std::array<int, 3>{10, 10, 8}));
  for (const std::int64_t voxel : {0L, 7L, 8L, 799L}) EXPECT_EQ(map.voxel_at(map.centre(voxel)), voxel);
  EXPECT_EQ(map.voxel_at({-1, -1, 0}), 0) << "lower faces belong to a voxel";
  EXPECT_EQ(map.voxel_at({1, 0, 0.1}), -1);
  EXPECT_EQ(map.voxel(1, 2, 3), 1 * 80 + 2 * 8 + 3);
  EXPECT_EQ(map.index_at({0.5, 0.1, 0.9}), static_cast<double>(map.index()[map.voxel_at({0.5, 0.1, 0.9})]));
  EXPECT_EQ(map.index_at({9, 0, 0}), 0);
  EXPECT_EQ(map.maximum(), map.index_at(map.centre(map.best_voxel())));
  EXPECT_THROW(map.voxel(10, 0, 0), InvalidInput);
  EXPECT_THROW(map.centre(800), InvalidInput);
  EXPECT_THROW(map.tool_pose(0, 8), InvalidInput);
}

TEST(CapabilityMap, TheBestDistanceIsWhereTheShellLies) {
  // All directions are reached between 0.3 and 0.7 m from the shoulder, fewer outside: the score of targets at its
  // height falls with the distance from the middle of the shell.
  const auto map = CapabilityMap::build(shell_arm(), World{}, small(0.1, 50));
  Poses targets;
  for (const double y : {-0.05, 0.05}) {
    Pose T = Pose::Identity();
    T.translation() = Vector3d(2, 1 + y, 0.8);
    targets.push_back(T);
  }
  const BaseDistance best = best_base_distance(map, targets, 0, {0.1, 0.2, 0.5, 0.75, 0.85, 1.2});
  EXPECT_EQ(best.distance, 0.5);
  EXPECT_EQ(best.score, 1);
  EXPECT_EQ(best.scores.back(), 0);
  EXPECT_GT(best.scores[3], best.scores[4]);
  // Facing away from the grid's middle changes nothing for an arm that turns all around.
  EXPECT_EQ(best_base_distance(map, targets, M_PI / 2, {0.5}).score, 1);
  // A tool that comes from above: the part of poses in its cone alone.
  for (Pose& T : targets) T.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()).toRotationMatrix();
  const double down = map.score(targets, pose_from_planar({2 - 0.75, 1, 0}), 0.5);
  for (Pose& T : targets) T.linear() = Eigen::AngleAxisd(M_PI, Vector3d::UnitZ()).toRotationMatrix();
  const double backwards = map.score(targets, pose_from_planar({2 - 0.75, 1, 0}), 0.5);
  EXPECT_GT(down, backwards) << "the wrist of a tool that points back at the robot lies beyond the shell";
  EXPECT_THROW(best_base_distance(map, {}, 0, {1}), InvalidInput);
  EXPECT_THROW(best_base_distance(map, targets, 0, {}), InvalidInput);
}

TEST(CapabilityMap, RefusesOptionsOutOfRange) {
  const auto refused = [](const std::function<void(CapabilityOptions&)>& change, const std::string& field) {
    CapabilityOptions options = small();
    change(options);
    try {
      CapabilityMap::build(shell_arm(), World{}, options);
      ADD_FAILURE() << field << " was taken";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).rfind(field, 0), 0u) << error.what();
    }
  };
  refused([](auto& o) { o.voxel = 0; }, "voxel");
  refused([](auto& o) { o.upper[1] = -2; }, "upper");
  refused([](auto& o) { o.upper[2] = 1.55; }, "upper");
  refused([](auto& o) { o.lower[0] = NAN; }, "lower");
  refused([](auto& o) { o.poses = 0; }, "poses");
  refused([](auto& o) { o.rolls = 5; }, "rolls");
  refused([](auto& o) { o.approach.setZero(); }, "approach");
  refused([](auto& o) { o.samples = -1; }, "samples");
  refused([](auto& o) { o.sweeps = -1; }, "sweeps");
  refused([](auto& o) { o.restarts = -1; }, "restarts");
  refused([](auto& o) { o.padding = -0.1; }, "padding");
  refused([](auto& o) { o.threads = -1; }, "threads");
}

TEST(CapabilityMap, StopsWithAnEmptyMap) {
  Monitor monitor;
  double last = 0;
  monitor.progress = [&](const std::string& stage, double fraction) {
    EXPECT_EQ(stage, "capability map");
    EXPECT_GE(fraction, last);
    last = fraction;
    if (fraction > 0.1) monitor.stop.stop();
  };
  const auto map = CapabilityMap::build(seven_joints(), World{}, around_seven_joints(), monitor);
  EXPECT_EQ(map.voxel_count(), 0);
  EXPECT_EQ(map.best_voxel(), -1);
  EXPECT_EQ(map.index_at({0.5, 0, 0.5}), 0);
  EXPECT_GT(last, 0.1);
}

}  // namespace
}  // namespace mmgrasp
