#include "mmgrasp/collision/collision_objective.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/small_robots.hpp"

using namespace mmgrasp;

namespace {

/// Two spheres of 0.1 m radius on the base and on the tip of a planar arm; the sphere halfway along the upper link has
/// 0.05 m.
CollisionChecker two_spheres() {
  return CollisionChecker(Robot::from_strings(test::two_balls_urdf()).chain("base", "tip"), World());
}

/// Distance of the tip's centre from the base: both links are 0.5 m.
double tip_distance(const Eigen::VectorXd& q) {
  return 2 * 0.5 * std::abs(std::cos(q[1] / 2));
}

}  // namespace

TEST(SelfDistanceObjective, ClosedFormOfTwoSpheres) {
  const CollisionChecker checker = two_spheres();
  const auto objective = make_self_distance_objective(checker, 0.15, 2.0);
  Rng rng(19);
  int near = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::VectorXd q = rng.uniform(checker.group().lower(), checker.group().upper());
    const double base_clearance = tip_distance(q) - 0.2;
    // The small sphere sits at 0.25 m on the upper link, the tip at 0.5 m behind the elbow.
    const double x = 0.25 + 0.5 * std::cos(q[1]), y = 0.5 * std::sin(q[1]);
    const double upper_clearance = std::hypot(x, y) - 0.15;
    const auto part = [](double clearance) { return clearance < 0.15 ? 2 * std::pow(1 - clearance / 0.15, 2) : 0; };
    const bool upper_counts = !checker.group().robot().pair_disabled(checker.group().robot().link_index("upper"),
                                                                     checker.group().robot().link_index("tip"));
    const double expected = part(base_clearance) + (upper_counts ? part(upper_clearance) : 0);
    Eigen::VectorXd gradient;
    EXPECT_NEAR(objective->evaluate(q, gradient), expected, 1e-9) << q.transpose();
    if (expected == 0) continue;
    ++near;
    EXPECT_NEAR(gradient[0], 0, 1e-9);  // the first joint turns everything together
    Eigen::VectorXd unused, a = q, b = q;
    a[1] += 1e-6;
    b[1] -= 1e-6;
    const double difference = (objective->evaluate(a, unused) - objective->evaluate(b, unused)) / 2e-6;
    EXPECT_NEAR(gradient[1], difference, 1e-5 * (1 + std::abs(difference)));
  }
  EXPECT_GT(near, 20);
}

TEST(SelfDistanceObjective, SlidingMovesLinksApart) {
  const Robot robot = Robot::from_strings(test::seven_joint_urdf());
  const JointGroup group = robot.chain("column", "tool");
  CollisionChecker checker(group, World());
  IkOptions options;
  options.objectives = {make_self_distance_objective(checker, 0.3)};
  Rng rng(20);
  double before = 0, after = 0;
  int solved = 0;
  for (int i = 0; i < 40; ++i) {
    Eigen::VectorXd q;
    do q = rng.uniform(group.sample_lower(), group.sample_upper());
    while (!checker.is_free(q));
    const IkResult plain = solve_collision_free_ik(checker, group.fk(q), q);
    const IkResult apart = solve_collision_free_ik(checker, group.fk(q), q, options);
    if (plain.outcome != Outcome::solved || apart.outcome != Outcome::solved) continue;
    ++solved;
    Eigen::VectorXd unused;
    const double cost = options.objectives[0]->evaluate(plain.q, unused);
    EXPECT_LE(apart.objective, cost + 1e-12);
    EXPECT_TRUE(checker.is_free(apart.q));
    before += cost;
    after += apart.objective;
  }
  EXPECT_GT(solved, 35);
  EXPECT_LT(after, before);
}

TEST(SelfDistanceObjective, ThreadsShareIt) {
  const CollisionChecker checker = two_spheres();
  const auto objective = make_self_distance_objective(checker, 0.5);
  Rng rng(21);
  std::vector<Eigen::VectorXd> q;
  std::vector<double> alone;
  Eigen::VectorXd gradient;
  for (int i = 0; i < 200; ++i) {
    q.push_back(rng.uniform(checker.group().lower(), checker.group().upper()));
    alone.push_back(objective->evaluate(q.back(), gradient));
  }
  std::vector<std::thread> threads;
  std::vector<int> wrong(4, 0);
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      Eigen::VectorXd mine;
      for (std::size_t i = 0; i < q.size(); ++i) wrong[t] += objective->evaluate(q[i], mine) != alone[i];
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(SelfDistanceObjective, BadInput) {
  const CollisionChecker checker = two_spheres();
  EXPECT_THROW(make_self_distance_objective(checker, 0), InvalidInput);
  EXPECT_THROW(make_self_distance_objective(checker, 0.1, NAN), InvalidInput);
}
