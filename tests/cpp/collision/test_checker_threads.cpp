// Eight threads, each with a checker of its own, answer what one answers: bit for bit, and without a race (./dev
// sanitize thread). Half of them build theirs at the same time from the same robot and world, half clone one.

#include <gtest/gtest.h>

#include <thread>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/joint_group.hpp"

using namespace mmgrasp;

namespace {

constexpr int kThreads = 8;

/// All that a checker says about one configuration.
struct Answer {
  Rejection rejection = Rejection::none;
  std::vector<std::pair<std::string, std::string>> contacts;
  double distance = 0;
  std::string a, b;
  Eigen::Vector3d point_a = Eigen::Vector3d::Zero(), point_b = Eigen::Vector3d::Zero();
  Eigen::VectorXd gradient;
  bool edge = false;
  double fraction = 0;

  bool operator==(const Answer& o) const {
    return rejection == o.rejection && contacts == o.contacts && distance == o.distance && a == o.a && b == o.b &&
           point_a == o.point_a && point_b == o.point_b && gradient == o.gradient && edge == o.edge &&
           fraction == o.fraction;
  }
};

Answer ask(CollisionChecker& checker, const Eigen::VectorXd& q, const Eigen::VectorXd& to) {
  Answer answer;
  answer.rejection = checker.rejection(q);
  for (const Contact& contact : checker.contacts(q)) answer.contacts.emplace_back(contact.a, contact.b);
  const DistanceResult nearest = checker.distance_and_gradient(q);
  answer.distance = nearest.value;
  answer.a = nearest.a;
  answer.b = nearest.b;
  answer.point_a = nearest.point_a;
  answer.point_b = nearest.point_b;
  answer.gradient = nearest.gradient;
  answer.edge = checker.edge_is_free(q, to);
  EdgeOptions continuous;
  continuous.continuous = true;
  answer.fraction = check_edge(checker, q, to, continuous).fraction;
  return answer;
}

std::shared_ptr<const TriangleMesh> bent_sheet() {
  return make_mesh({{0, 0, 0}, {0.3, 0, 0.1}, {0.3, 0.3, 0}, {0, 0.3, 0.1}}, {{0, 1, 2}, {0, 2, 3}});
}

// A box whose lid is pressed in: closed, not convex.
std::shared_ptr<const TriangleMesh> concave_box(const Eigen::Vector3d& size) {
  const Eigen::Vector3d h = 0.5 * size;
  return make_mesh({{-h[0], -h[1], -h[2]},
                    {h[0], -h[1], -h[2]},
                    {h[0], h[1], -h[2]},
                    {-h[0], h[1], -h[2]},
                    {-h[0], -h[1], h[2]},
                    {h[0], -h[1], h[2]},
                    {h[0], h[1], h[2]},
                    {-h[0], h[1], h[2]},
                    {0, 0, 0.2 * h[2]}},
                   {{0, 2, 1},
                    {0, 3, 2},
                    {0, 1, 5},
                    {0, 5, 4},
                    {1, 2, 6},
                    {1, 6, 5},
                    {2, 3, 7},
                    {2, 7, 6},
                    {3, 0, 4},
                    {3, 4, 7},
                    {4, 5, 8},
                    {5, 6, 8},
                    {6, 7, 8},
                    {7, 4, 8}});
}

// Links of closed concave meshes and capsules on a chain that folds back on itself: fields and covers are made when
// first asked for.
Robot mesh_chain(double step, int links) {
  const auto mesh = concave_box({0.1, 0.12, 0.3});
  std::string urdf = "<robot name='chain'><link name='l0'/>";
  for (int i = 1; i <= links; ++i) {
    const std::string n = std::to_string(i);
    urdf += "<link name='l" + n + "'/><joint name='j" + n + "' type='revolute'><parent link='l" +
            std::to_string(i - 1) + "'/><child link='l" + n + "'/><origin xyz='0 0 " +
            std::to_string(i == 1 ? 0.0 : step) + "'/><axis xyz='" + (i % 2 ? "1 0.2 0" : "0 1 0.3") +
            "'/><limit lower='-2.6' upper='2.6' velocity='1' effort='1'/></joint>";
  }
  Robot robot = Robot::from_strings(urdf + "</robot>");
  for (int i = 1; i <= links; ++i) {
    Pose half = Pose::Identity();
    half.translation().z() = 0.17;
    LinkShape shape;
    shape.shape = i % 3 == 0 ? Shape(Capsule{0.04, 0.2}) : Shape(MeshShape{mesh});
    shape.T_link_shape = half;
    robot = robot.with_link("body" + std::to_string(i), "l" + std::to_string(i), Pose::Identity(), {shape});
  }
  return robot;
}

World cloud(Rng& rng) {
  auto cells = std::make_shared<std::vector<Eigen::Vector3d>>();
  for (int i = 0; i < 40; ++i)
    cells->emplace_back(0.04 * std::floor(rng.uniform(-20, 20)), 0.04 * std::floor(rng.uniform(-20, 20)),
                        0.04 * std::floor(rng.uniform(5, 25)));
  World world;
  world.add("cloud", Voxels{cells, 0.04}, Pose::Identity());
  Pose T = Pose::Identity();
  T.translation() << 0.5, 0.2, 0.5;
  world.add("dented", MeshShape{concave_box({0.3, 0.2, 0.4})}, T);
  return world;
}

World cluttered(Rng& rng) {
  World world;
  for (int i = 0; i < 12; ++i) {
    Pose T = Pose::Identity();
    T.translation() << rng.uniform(0.4, 1.1), rng.uniform(-0.8, 0.8), rng.uniform(0.2, 1.4);
    T.linear() = rng.rotation().toRotationMatrix();
    const std::string name = "object" + std::to_string(i);
    if (i % 4 == 0) world.add(name, Box{Eigen::Vector3d(0.1, 0.2, 0.3)}, T);
    if (i % 4 == 1) world.add(name, Cylinder{0.1, 0.2}, T);
    if (i % 4 == 2) world.add(name, Capsule{0.05, 0.2}, T);
    if (i % 4 == 3) world.add(name, MeshShape{bent_sheet()}, T);
  }
  return world;
}

void expect_all_answer_like_one(const JointGroup& group, const World& world, Rng& rng) {
  const CollisionChecker shared(group, world);
  const Eigen::VectorXd lower = group.lower().cwiseMax(-3.0), upper = group.upper().cwiseMin(3.0);  // some turn freely
  std::vector<Eigen::VectorXd> samples, ends;
  for (int i = 0; i < 120; ++i) {
    samples.push_back(rng.uniform(lower, upper));
    ends.push_back(samples.back() +
                   0.2 * rng.uniform(-Eigen::VectorXd::Ones(group.size()), Eigen::VectorXd::Ones(group.size())));
  }
  std::vector<std::vector<Answer>> answers(kThreads, std::vector<Answer>(samples.size()));
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      CollisionChecker own = t % 2 ? shared.clone() : CollisionChecker(group, world);
      // Each in its own order: what was asked before must not matter. The strides have no factor in common with 120.
      const std::size_t strides[kThreads] = {1, 7, 11, 13, 17, 19, 23, 29};
      for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t k = (i * strides[t] + 17 * static_cast<std::size_t>(t)) % samples.size();
        answers[t][k] = ask(own, samples[k], ends[k]);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();

  CollisionChecker one(group, world);
  int colliding = 0, edges = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Answer expected = ask(one, samples[i], ends[i]);
    colliding += !expected.contacts.empty();
    edges += expected.edge;
    for (int t = 0; t < kThreads; ++t) ASSERT_TRUE(answers[t][i] == expected) << "thread " << t << ", sample " << i;
  }
  EXPECT_GT(colliding, 10);
  EXPECT_LT(colliding, 110);
  EXPECT_GT(edges, 5);
  Eigen::MatrixXd Q(group.size(), static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) Q.col(static_cast<Eigen::Index>(i)) = samples[i];
  EXPECT_EQ(are_free(shared, Q, kThreads), are_free(shared, Q, 1));
}

}  // namespace

TEST(CheckerThreads, EightAnswerLikeOne) {
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  Rng rng(8);
  const World world = cluttered(rng);
  expect_all_answer_like_one(robot.group("arm_with_torso"), world, rng);
}

TEST(CheckerThreads, EightAnswerLikeOneWithMeshesAndACloud) {
  Rng rng(9);
  const World world = cloud(rng);
  expect_all_answer_like_one(mesh_chain(0.38, 6).chain("l0", "l6"), world, rng);
}
