#include "mmgrasp/task/platform_locations.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"
#include "support/small_storeroom.hpp"
#include "support/temporary_folder.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;

namespace {

/// The small robot with a seventh joint's worth of freedom from its base; a camera mast stands on the base.
Robot small_robot(BaseKind base = BaseKind::omni) {
  RobotOptions options;
  options.base = base;
  return Robot::from_strings(small_robot_urdf(), "", options, "small");
}

World table() {
  World world;
  world.add("table", box_shape(0.30, 3.0, 0.04), at(0.9, 0.0, 0.42));
  return world;
}

/// Tool pose above the table, pointing down, turned by `yaw`.
Pose above(double x, double y, double yaw) {
  Pose T = at(x, y, 0.56);
  T.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

/// Looks ahead and down from a mast over the base.
MountedCamera head_camera(const Robot& robot) {
  MountedCamera camera;
  camera.link = robot.link_index("base_link");
  camera.T_link_camera = at(0.0, 0.0, 1.3);
  camera.T_link_camera.linear() = (Eigen::AngleAxisd(-M_PI / 2, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(-M_PI / 2 - 0.7, Eigen::Vector3d::UnitX()))
                                      .toRotationMatrix();
  return camera;
}

PlatformLocationsProblem problem_of(const Robot& robot, double apart) {
  PlatformLocationsProblem problem;
  problem.T_world_pick = above(0.88, -0.5 * apart, 0.3);
  problem.T_world_place = above(0.88, 0.5 * apart, -0.4);
  problem.pick_point = problem.T_world_pick.translation() - Eigen::Vector3d(0, 0, 0.05);
  problem.place_point = problem.T_world_place.translation() - Eigen::Vector3d(0, 0, 0.05);
  problem.camera = head_camera(robot);
  return problem;
}

struct SmallCell {
  explicit SmallCell(BaseKind base = BaseKind::omni)
      : robot(small_robot(base)), group(robot.chain("base_link", "tcp", true)), checker(group, table()) {}
  Robot robot;
  JointGroup group;
  CollisionChecker checker;
};

/// Every constraint of (3.1) by KDL, by hand and by a fresh checker.
void expect_valid(const SmallCell& setup, const Eigen::VectorXd& q, const Pose& target, const Eigen::Vector3d& point,
                  const PlatformLocationsProblem& problem, double least_manipulability) {
  const JointGroup& group = setup.group;
  ASSERT_EQ(q.size(), 9);
  const KDL::Chain chain = testing_support::kdl_chain(setup.robot, group.tip_link());
  ASSERT_EQ(chain.getNrOfJoints(), 6u);
  KDL::ChainFkSolverPos_recursive fk(chain);
  KDL::JntArray joints(6);
  joints.data = q.tail<6>();
  KDL::Frame frame;
  ASSERT_GE(fk.JntToCart(joints, frame), 0);
  const KDL::Frame T_world_root(KDL::Rotation::RotZ(q[2]), KDL::Vector(q[0], q[1], 0));
  const KDL::Twist error = KDL::diff(T_world_root * frame, testing_support::to_kdl(target));
  EXPECT_LE(error.vel.Norm(), 1.001e-5);
  EXPECT_LE(error.rot.Norm(), 1.001e-4);
  EXPECT_TRUE(group.within_limits(q));
  const JointGroup arm = setup.robot.chain("base_link", "tcp");
  EXPECT_GE(arm.manipulability(q.tail<6>()), least_manipulability * (1 - 1e-9));
  if (problem.camera) {
    const Pose T_world_camera = pose_from_planar(q.head<3>()) * problem.camera->T_link_camera;  // on the base link
    const Eigen::Vector3d p = T_world_camera.inverse() * point;
    const PinholeCamera& camera = problem.camera->camera;
    EXPECT_GE(p[2], camera.nearest);
    EXPECT_LE(std::abs(camera.fx * p[0] / p[2] + camera.cx - 319.5), 320);
    EXPECT_LE(std::abs(camera.fy * p[1] / p[2] + camera.cy - 239.5), 240);
  }
  EXPECT_EQ(CollisionChecker(group, table()).rejection(q), Rejection::none);
}

}  // namespace

TEST(PlatformLocations, OneStopServesPosesThatLieTogether) {
  for (const BaseKind base : {BaseKind::omni, BaseKind::diff_drive}) {
    SmallCell setup(base);
    const PlatformLocationsProblem problem = problem_of(setup.robot, 0.3);
    const PlatformLocations found = plan_platform_locations(setup.checker, problem);
    ASSERT_EQ(found.outcome, Outcome::solved);
    expect_valid(setup, found.q_pick, problem.T_world_pick, problem.pick_point, problem, 0.02);
    expect_valid(setup, found.q_place, problem.T_world_place, problem.place_point, problem, 0.02);
    EXPECT_EQ(found.cost, 0);
    EXPECT_EQ(found.q_pick.head<3>(), found.q_place.head<3>());
  }
}

TEST(PlatformLocations, TravelIsNearTheLeastWhenThePosesAreFarApart) {
  SmallCell setup;
  const PlatformLocationsProblem problem = problem_of(setup.robot, 2.6);
  PlatformLocationsOptions options;
  options.turn_weight = 0;
  const PlatformLocations found = plan_platform_locations(setup.checker, problem, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  expect_valid(setup, found.q_pick, problem.T_world_pick, problem.pick_point, problem, 0.02);
  expect_valid(setup, found.q_place, problem.T_world_place, problem.place_point, problem, 0.02);
  EXPECT_DOUBLE_EQ(found.travel, (found.q_pick.head<2>() - found.q_place.head<2>()).norm());
  EXPECT_DOUBLE_EQ(found.cost, found.travel);
  // Algorithm 2 as printed: c_1 drawn once, the best of 100 c_2; the mean of five runs.
  double printed = 0;
  constexpr int kRuns = 5;
  for (unsigned run = 0; run < kRuns; ++run) {
    Rng rng(50 + run);
    const auto draw = [&](const Pose& target, const Eigen::Vector3d& point) {
      IkOptions ik;
      const auto valid = [&](const Eigen::VectorXd& q) {
        const Pose T_world_camera = pose_from_planar(q.head<3>()) * problem.camera->T_link_camera;
        if (!problem.camera->camera.project(T_world_camera.inverse() * point)) return Rejection::grasp_filter;
        if (setup.robot.chain("base_link", "tcp").manipulability(q.tail<6>()) < 0.02) return Rejection::grasp_filter;
        return setup.checker.rejection(q);
      };
      ik.restarts = 200;
      for (;;) {
        Eigen::VectorXd start = rng.uniform(setup.group.sample_lower(), setup.group.sample_upper());
        start[0] = target.translation().x() + rng.uniform(-1.0, 1.0);
        start[1] = target.translation().y() + rng.uniform(-1.0, 1.0);
        ik.seed = static_cast<unsigned>(rng.next());
        const IkResult result = solve_ik(setup.group, target, start, ik, valid);
        if (result.outcome == Outcome::solved) return result.q;
      }
    };
    const Eigen::VectorXd first = draw(problem.T_world_pick, problem.pick_point);
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 100; ++i)
      best = std::min(best, (draw(problem.T_world_place, problem.place_point).head<2>() - first.head<2>()).norm());
    printed += best / kRuns;
  }
  EXPECT_LT(found.travel, printed);
  EXPECT_GT(found.travel, 2.6 - 2 * 1.2);  // both arms stretched towards each other
}

TEST(PlatformLocations, DatabaseSavesIterations) {
  // A series of problems along the table: with a database that grows, and with an empty one each time.
  SmallCell setup;
  IkSeedDatabase grown(setup.group);
  std::size_t with = 0, without = 0;
  Rng rng(60);
  for (int i = 0; i < 12; ++i) {
    PlatformLocationsProblem problem = problem_of(setup.robot, rng.uniform(1.8, 2.6));
    PlatformLocationsOptions options;
    options.samples = 30;
    options.seed = static_cast<unsigned>(i);
    const PlatformLocations empty = plan_platform_locations(setup.checker, problem, options);
    const PlatformLocations seeded = plan_platform_locations(setup.checker, problem, options, &grown);
    ASSERT_EQ(empty.outcome, Outcome::solved);
    ASSERT_EQ(seeded.outcome, Outcome::solved);
    if (i < 4) continue;  // the database fills
    without += empty.pick.iterations + empty.place.iterations;
    with += seeded.pick.iterations + seeded.place.iterations;
  }
  RecordProperty("iterations_without", static_cast<int>(without));
  RecordProperty("iterations_with", static_cast<int>(with));
  EXPECT_GT(grown.size(), 200u);
  EXPECT_LT(2 * with, without) << with << " of " << without;
}

TEST(PlatformLocations, SameSeedSameAnswer) {
  SmallCell setup;
  const PlatformLocationsProblem problem = problem_of(setup.robot, 1.5);
  PlatformLocationsOptions options;
  options.samples = 20;
  const PlatformLocations a = plan_platform_locations(setup.checker, problem, options);
  const PlatformLocations b = plan_platform_locations(setup.checker, problem, options);
  ASSERT_EQ(a.outcome, Outcome::solved);
  EXPECT_EQ(a.q_pick, b.q_pick);
  EXPECT_EQ(a.q_place, b.q_place);
}

TEST(PlatformLocations, WhyThereIsNone) {
  SmallCell setup;
  PlatformLocationsOptions options;
  options.samples = 5;
  options.max_draws = 60;
  PlatformLocationsProblem high = problem_of(setup.robot, 0.3);
  high.T_world_place.translation().z() = 4;
  const PlatformLocations unreachable = plan_platform_locations(setup.checker, high, options);
  EXPECT_EQ(unreachable.outcome, Outcome::not_found);
  EXPECT_EQ(unreachable.q_pick.size(), 0);
  EXPECT_EQ(unreachable.place.rejections.unreachable + unreachable.place.rejections.limits, 60u);
  PlatformLocationsProblem unseen = problem_of(setup.robot, 0.3);
  unseen.camera->T_link_camera.linear() = Eigen::Matrix3d::Identity();  // looks at the ceiling
  const PlatformLocations blind = plan_platform_locations(setup.checker, unseen, options);
  EXPECT_EQ(blind.outcome, Outcome::not_found);
  EXPECT_GT(blind.pick.view, 0u);
  PlatformLocationsOptions strict = options;
  strict.least_manipulability = 10;
  const PlatformLocations singular = plan_platform_locations(setup.checker, problem_of(setup.robot, 0.3), strict);
  EXPECT_EQ(singular.outcome, Outcome::not_found);
  EXPECT_GT(singular.pick.singular, 0u);
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(plan_platform_locations(setup.checker, unseen, options, nullptr, monitor).outcome, Outcome::stopped);
}

TEST(PlatformLocations, BadInputNamesTheField) {
  SmallCell setup;
  const auto message = [&](const auto& change) {
    PlatformLocationsProblem problem = problem_of(setup.robot, 0.3);
    PlatformLocationsOptions options;
    change(problem, options);
    try {
      plan_platform_locations(setup.checker, problem, options);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_NE(message([](auto&, auto& o) { o.samples = 0; }).find("samples"), std::string::npos);
  EXPECT_NE(message([](auto&, auto& o) { o.turn_weight = -1; }).find("turn_weight"), std::string::npos);
  EXPECT_NE(message([](auto& p, auto&) { p.place_point[2] = NAN; }).find("place_point[2]"), std::string::npos);
  EXPECT_NE(message([](auto& p, auto&) { p.camera->link = 77; }).find("camera.link"), std::string::npos);
  EXPECT_NE(message([](auto& p, auto&) { p.T_world_pick.linear() *= 2; }).find("T_world_pick"), std::string::npos);
  CollisionChecker fixed(setup.robot.chain("base_link", "tcp"), table());
  EXPECT_THROW(plan_platform_locations(fixed, problem_of(setup.robot, 0.3)), InvalidInput);
}

TEST(IkSeedDatabase, PutsTheBaseWhereTheRememberedArmReaches) {
  SmallCell setup;
  IkSeedDatabase database(setup.group);
  Rng rng(61);
  for (int i = 0; i < 50; ++i) database.add(rng.uniform(setup.group.sample_lower(), setup.group.sample_upper()));
  Eigen::VectorXd q = rng.uniform(setup.group.sample_lower(), setup.group.sample_upper());
  q.head<3>() << 3, -2, 0.7;
  database.add(q);
  // The same arm posture, the whole moved and turned over the floor: the match is exact.
  Eigen::VectorXd moved = q;
  moved.head<3>() << -1, 4, -2.5;
  const std::vector<Eigen::VectorXd> seeds = database.seeds(setup.group.fk(moved), 3);
  ASSERT_EQ(seeds.size(), 3u);
  EXPECT_LE((seeds[0] - moved).norm(), 1e-9);
  EXPECT_TRUE(IkSeedDatabase(setup.group).seeds(setup.group.fk(moved), 3).empty());
}

TEST(IkSeedDatabase, ForgetsTheOldestWhenFull) {
  SmallCell setup;
  IkSeedDatabase database(setup.group, 3);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(9);
  std::vector<Eigen::VectorXd> added;
  for (int i = 0; i < 5; ++i) {
    q[4] = 0.1 * i;
    database.add(q);
    added.push_back(q);
  }
  EXPECT_EQ(database.size(), 3u);
  double least = 10;
  for (const Eigen::VectorXd& seed : database.seeds(setup.group.fk(added[0]), 3)) least = std::min(least, seed[4]);
  EXPECT_DOUBLE_EQ(least, 0.2);
}

TEST(IkSeedDatabase, FileComesBackAndIsChecked) {
  SmallCell setup;
  IkSeedDatabase database(setup.group);
  Rng rng(62);
  for (int i = 0; i < 20; ++i) database.add(rng.uniform(setup.group.sample_lower(), setup.group.sample_upper()));
  const TemporaryFolder folder;
  const std::string path = folder.file("ik_seeds.txt");
  database.save(path);
  const IkSeedDatabase back = IkSeedDatabase::load(path, setup.group);
  ASSERT_EQ(back.size(), 20u);
  const Pose target = above(0.9, 0.2, 0.1);
  const auto a = database.seeds(target, 20), b = back.seeds(target, 20);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(a[i], b[i]);
  const auto refused = [&](const std::string& content, const std::string& why) {
    std::ofstream(path, std::ios::binary) << content;
    try {
      IkSeedDatabase::load(path, setup.group);
    } catch (const IoError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
      return;
    }
    ADD_FAILURE() << "taken: " << why;
  };
  std::ifstream file(path, std::ios::binary);
  const std::string content((std::istreambuf_iterator<char>(file)), {});
  for (std::size_t cut = 0; cut < content.size(); cut += content.size() / 50) refused(content.substr(0, cut), "is ");
  std::string changed = content;
  changed[content.size() / 2] = changed[content.size() / 2] == '1' ? '2' : '1';
  refused(changed, "damaged");
  database.save(path);
  const JointGroup hand = setup.robot.chain("base_link", "hand", true);
  EXPECT_THROW(IkSeedDatabase::load(path, hand), IoError);
  EXPECT_THROW(IkSeedDatabase::load(path + ".none", setup.group), IoError);
  EXPECT_THROW(database.save("/nowhere/at/all"), IoError);
  EXPECT_THROW(IkSeedDatabase(setup.robot.chain("base_link", "tcp")), InvalidInput);
  EXPECT_THROW(IkSeedDatabase(setup.group, 0), InvalidInput);
}

TEST(IkSeedDatabase, ThreadsMayShareOne) {
  SmallCell setup;
  IkSeedDatabase database(setup.group, 50);
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (unsigned t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      Rng rng(70 + t);
      for (int i = 0; i < 300; ++i) {
        const Eigen::VectorXd q = rng.uniform(setup.group.sample_lower(), setup.group.sample_upper());
        database.add(q);
        for (const Eigen::VectorXd& seed : database.seeds(setup.group.fk(q), 8))
          wrong += !setup.group.within_limits(seed);
        wrong += database.size() > 50;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(database.size(), 50u);
}
