// Whole robots with their meshes among random obstacles: each answer against FCL called directly pair by pair.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/fcl_reference.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::shared;

namespace {

Robot load_panda() {
  RobotOptions options;
  options.package_dirs["moveit_resources_panda_description"] =
      shared("robots/panda/moveit_resources_panda_description");
  return Robot::load(shared("robots/panda/expanded/panda.urdf"),
                     shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"), options);
}

Robot load_tiago(BaseKind base) {
  RobotOptions options;
  options.base = base;
  options.package_dirs["example-robot-data"] = shared("robots/tiago/example-robot-data");
  const Robot robot = Robot::load(
      shared("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"), "", options);
  DisabledPairsOptions pairs;
  pairs.samples = 1000;
  return compute_disabled_pairs(robot, pairs);
}

World random_world(Rng& rng, double reach, double height) {
  World world;
  for (int i = 0; i < 12; ++i) {
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(0.35, reach), size = rng.uniform(0.03, 0.12);
    Pose T = Pose::Identity();
    T.translation() << r * std::cos(angle), r * std::sin(angle), rng.uniform(0, height);
    T.linear() = rng.rotation().toRotationMatrix();
    const std::string name = "object" + std::to_string(i);
    if (i % 4 == 0) world.add(name, Box{Eigen::Vector3d(size, 1.5 * size, 2 * size)}, T);
    if (i % 4 == 1) world.add(name, Cylinder{size, 2 * size}, T);
    if (i % 4 == 2) world.add(name, Sphere{size}, T);
    if (i % 4 == 3) {
      world.add(name, MeshShape{load_mesh(shared("meshes/ycb/YcbBanana/collision_vhacd.obj"))}, T);
    }
  }
  return world;
}

struct Placed {
  fcl_reference::Body body;
  Pose T_body = Pose::Identity();
  int link = -1;
};

std::vector<Placed> reference_links(const Robot& robot) {
  std::vector<Placed> out;
  for (std::size_t i = 0; i < robot.links().size(); ++i) {
    for (const LinkShape& shape : robot.links()[i].collisions) {
      out.push_back({fcl_reference::make_body(shape.shape), shape.T_link_shape, static_cast<int>(i)});
    }
  }
  return out;
}

std::vector<Placed> reference_scene(const World& world) {
  std::vector<Placed> out;
  for (const auto& [name, object] : world.objects()) {
    for (const LinkShape& shape : object.shapes) {
      out.push_back({fcl_reference::make_body(shape.shape), object.T_world_object * shape.T_link_shape, -1});
    }
  }
  return out;
}

// Links joined by fixed joints only.
bool rigid_pair(const Robot& robot, int a, int b) {
  const auto top = [&](int link) {
    while (robot.links()[link].parent_joint >= 0 &&
           robot.joints()[robot.links()[link].parent_joint].type == JointType::fixed) {
      link = robot.joints()[robot.links()[link].parent_joint].parent_link;
    }
    return link;
  };
  return top(a) == top(b);
}

struct Tally {
  int none = 0, self = 0, scene = 0, unjudged = 0;
};

// Compares `count` random configurations; fills the tally.
void compare(const JointGroup& group, const World& world, int count, Rng& rng, Tally& tally) {
  const Robot& robot = group.robot();
  CollisionChecker checker(group, world);
  const std::vector<Placed> links = reference_links(robot), scene = reference_scene(world);
  Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
  if (group.has_base()) {
    lower.head<2>().setConstant(-0.8);
    upper.head<2>().setConstant(0.8);
  }
  for (int n = 0; n < count; ++n) {
    const Eigen::VectorXd q = rng.uniform(lower, upper);
    const Poses poses = robot.link_poses(group.full_values(q), group.root_pose(q));
    const auto all_pairs = [&](bool shaken) {
      const auto touching = [&](const Placed& a, const Pose& T_a, const Placed& b, const Pose& T_b) {
        const Pose A = T_a * a.T_body, B = T_b * b.T_body;
        return shaken ? fcl_reference::on_the_edge(a.body, A, b.body, B) : fcl_reference::touch(a.body, A, b.body, B);
      };
      for (std::size_t i = 0; i < links.size(); ++i) {
        for (std::size_t j = i + 1; j < links.size(); ++j) {
          const int a = links[i].link, b = links[j].link;
          if (a == b || robot.pair_disabled(a, b) || rigid_pair(robot, a, b)) continue;
          if (touching(links[i], poses[a], links[j], poses[b])) return Rejection::self_collision;
        }
      }
      for (const Placed& link : links) {
        for (const Placed& object : scene) {
          if (touching(link, poses[link.link], object, Pose::Identity())) return Rejection::scene;
        }
      }
      return Rejection::none;
    };
    const Rejection expected = all_pairs(false);
    const Rejection answer = checker.rejection(q);
    if (answer != expected && all_pairs(true) != Rejection::none) {
      ++tally.unjudged;
      continue;
    }
    ASSERT_EQ(to_string(answer), std::string(to_string(expected))) << "q = " << q.transpose();
    ASSERT_EQ(checker.is_free(q), expected == Rejection::none);
    tally.none += expected == Rejection::none;
    tally.self += expected == Rejection::self_collision;
    tally.scene += expected == Rejection::scene;
  }
}

void expect_agreement(const JointGroup& group, int worlds, int count, double reach, double height) {
  Rng rng(11);
  Tally tally;
  for (int i = 0; i < worlds && !::testing::Test::HasFatalFailure(); ++i) {
    compare(group, random_world(rng, reach, height), count, rng, tally);
  }
  std::printf("agreement with FCL: %d free, %d self, %d scene, %d in the 1e-6 m band\n", tally.none, tally.self,
              tally.scene, tally.unjudged);
  EXPECT_GT(tally.none, worlds * count / 10);
  EXPECT_GT(tally.self, worlds * count / 50);
  EXPECT_GT(tally.scene, worlds * count / 20);
  EXPECT_LE(tally.unjudged, 3);
}

}  // namespace

TEST(CheckerRobots, PandaAgreesWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_agreement(load_panda().group("panda_arm"), 10, 200, 0.8, 1.0);
}

TEST(CheckerRobots, TiagoArmAgreesWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_agreement(load_tiago(BaseKind::fixed).chain("torso_fixed_link", "arm_7_link"), 5, 200, 1.0, 1.4);
}

TEST(CheckerRobots, TiagoOnItsBaseAgreesWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  expect_agreement(load_tiago(BaseKind::diff_drive).chain("torso_fixed_link", "arm_7_link", true), 5, 200, 1.5, 1.4);
}

TEST(CheckerRobots, CloudAgreesWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  Rng rng(21);
  // Spheres of cells, hollow ones and full ones, and single cells strewn about.
  auto centres = std::make_shared<std::vector<Eigen::Vector3d>>();
  const double edge = 0.02;
  for (int sphere = 0; sphere < 8; ++sphere) {
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(0.4, 0.8), inner = sphere % 2 == 0 ? 0 : 3;
    const Eigen::Vector3d middle(std::floor(r * std::cos(angle) / edge), std::floor(r * std::sin(angle) / edge),
                                 std::floor(rng.uniform(0, 1) / edge));
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        for (int k = -4; k <= 4; ++k) {
          const Eigen::Vector3d cell(i, j, k);
          if (cell.norm() > 4 || cell.norm() < inner) continue;
          centres->push_back(edge * (middle + cell + Eigen::Vector3d::Constant(0.5)));
        }
      }
    }
  }
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d cell = rng.uniform(Eigen::Vector3d(-40, -40, 0), Eigen::Vector3d(40, 40, 50)).array().floor();
    if (cell.head<2>().norm() > 15) centres->push_back(edge * (cell + Eigen::Vector3d::Constant(0.5)));
  }
  World world;
  world.add("cloud", Voxels{centres, edge}, pose_from_xyz_rpy({0.02, -0.03, 0.05}, {0.1, 0.05, 0.7}));
  Tally tally;
  compare(load_panda().group("panda_arm"), world, 60, rng, tally);
  EXPECT_GT(tally.none, 8);
  EXPECT_GT(tally.scene, 8);
  EXPECT_LE(tally.unjudged, 1);
}

TEST(CheckerRobots, MovingTheRootEqualsANewChecker) {
  MMGRASP_NEEDS_SHARED_DATA();
  Rng rng(5);
  const JointGroup group = load_panda().group("panda_arm");
  const World world = random_world(rng, 0.8, 1.0);
  CollisionChecker moved(group, world);
  int scene = 0;
  for (int i = 0; i < 30; ++i) {
    const Pose T = pose_from_planar({rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5), rng.uniform(-3, 3)});
    moved.set_root(T);
    CollisionChecker fresh(group.at(T), world), derived = moved.with_group(group.at(T));
    for (int k = 0; k < 20; ++k) {
      const Eigen::VectorXd q = rng.uniform(group.lower(), group.upper());
      const Rejection expected = fresh.rejection(q);
      ASSERT_EQ(moved.rejection(q), expected);
      ASSERT_EQ(derived.rejection(q), expected);
      scene += expected == Rejection::scene;
    }
  }
  EXPECT_GT(scene, 50);
}

TEST(CheckerRobots, ClonesAnswerAlikeInThreads) {
  MMGRASP_NEEDS_SHARED_DATA();
  Rng rng(6);
  const JointGroup group = load_panda().group("panda_arm");
  const CollisionChecker checker(group, random_world(rng, 0.8, 1.0));
  std::vector<Eigen::VectorXd> samples;
  for (int i = 0; i < 2000; ++i) samples.push_back(rng.uniform(group.lower(), group.upper()));
  std::vector<std::vector<Rejection>> answers(8);
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&, t] {
      CollisionChecker own = checker.clone();
      answers[t].resize(samples.size());
      // Each thread in its own order (odd steps not divisible by 5 visit all): what was asked before must not matter.
      const std::size_t strides[] = {1, 3, 7, 9, 11, 13, 17, 19};
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t k = (i * strides[t] + 17 * t) % samples.size();
        answers[t][k] = own.rejection(samples[k]);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CollisionChecker own = checker.clone();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Rejection expected = own.rejection(samples[i]);
    for (int t = 0; t < 8; ++t) ASSERT_EQ(answers[t][i], expected);
  }
  EXPECT_EQ(checker.queries(), 0u);
}

TEST(CheckerRobots, DistanceAgreesWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  Rng rng(9);
  const JointGroup group = load_panda().group("panda_arm");
  const Robot& robot = group.robot();
  const World world = random_world(rng, 0.9, 1.0);
  CheckerOptions options;
  options.check_self = false;  // FCL takes 40 us a mesh pair: the scene is enough
  CollisionChecker checker(group, world, options);
  const std::vector<Placed> links = reference_links(robot), scene = reference_scene(world);
  int compared = 0;
  for (int n = 0; n < 40; ++n) {
    const Eigen::VectorXd q = rng.uniform(group.lower(), group.upper());
    const DistanceResult result = checker.distance(q);
    const bool hit = checker.rejection(q) == Rejection::scene;
    ASSERT_EQ(hit, result.value <= 0) << result.value;
    if (hit) continue;
    const Poses poses = robot.link_poses(group.full_values(q));
    double least = 1e9;
    for (const Placed& link : links) {
      for (const Placed& object : scene) {
        fcl::CollisionObjectd a(link.body.parts[0].geometry, Pose(poses[link.link] * link.T_body));
        fcl::CollisionObjectd b(object.body.parts[0].geometry, object.T_body);
        fcl::DistanceRequestd request;
        request.distance_tolerance = 1e-9;
        fcl::DistanceResultd found;
        least = std::min(least, fcl::distance(&a, &b, request, found));
      }
    }
    ASSERT_NEAR(result.value, least, 2e-6);
    ASSERT_NEAR((result.point_a - result.point_b).norm(), result.value, 1e-9);
    ++compared;
  }
  EXPECT_GT(compared, 10);
}
