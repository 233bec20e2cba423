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
  Eigen::VectorXd gradient;
  bool edge = false;
  double fraction = 0;

  bool operator==(const Answer& o) const {
    return rejection == o.rejection && contacts == o.contacts && distance == o.distance && a == o.a && b == o.b &&
           gradient == o.gradient && edge == o.edge && fraction == o.fraction;
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

}  // namespace

TEST(CheckerThreads, EightAnswerLikeOne) {
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  const JointGroup group = robot.group("arm_with_torso");
  Rng rng(8);
  const World world = cluttered(rng);
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
        answers[static_cast<std::size_t>(t)][k] = ask(own, samples[k], ends[k]);
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
    for (int t = 0; t < kThreads; ++t)
      ASSERT_TRUE(answers[static_cast<std::size_t>(t)][i] == expected) << "thread " << t << ", sample " << i;
  }
  EXPECT_GT(colliding, 10);
  EXPECT_LT(colliding, 110);
  EXPECT_GT(edges, 5);
  Eigen::MatrixXd Q(group.size(), static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) Q.col(static_cast<Eigen::Index>(i)) = samples[i];
  EXPECT_EQ(are_free(shared, Q, kThreads), are_free(shared, Q, 1));
}
