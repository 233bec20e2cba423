// What a checker has found out about its links while it was asked may never change an answer: configurations are asked
// about again and again in small neighbourhoods, so that links are proven apart over cells of joint values, and every
// answer is held against distance(), which knows nothing of cells.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/mesh_robots.hpp"

using namespace mmgrasp;

namespace {

CheckerOptions self_only() {
  CheckerOptions options;
  options.check_scene = false;
  return options;
}

Eigen::VectorXd drawn(Rng& rng, const JointGroup& group) {
  return rng.uniform(group.sample_lower(), group.sample_upper());
}

Eigen::VectorXd beside(Rng& rng, const JointGroup& group, Eigen::VectorXd q, double width) {
  for (Eigen::Index j = 0; j < q.size(); ++j)
    q[j] = std::clamp(q[j] + rng.uniform(-width, width), group.sample_lower()[j], group.sample_upper()[j]);
  return q;
}

struct Count {
  int free = 0, hit = 0, wrong = 0;
};

// Answers within 1e-6 m of touching are not judged.
void judge(CollisionChecker& checker, CollisionChecker& reference, const Eigen::VectorXd& q, Count& count) {
  const double gap = reference.distance(q).value;
  if (std::abs(gap) < 1e-6) return;
  const bool free = checker.rejection(q) == Rejection::none;
  ++(free ? count.free : count.hit);
  count.wrong += free != (gap > 0);
  count.wrong += checker.first_contact(q).has_value() == free;
}

void compare(const testing_support::MeshArm& arm, int centres, unsigned seed) {
  CollisionChecker checker(arm.group, World(), self_only());
  CollisionChecker reference = checker.clone();
  Rng rng(seed);
  Count count;
  for (int i = 0; i < centres; ++i) {
    const Eigen::VectorXd centre = drawn(rng, arm.group);
    for (int k = 0; k < 150; ++k) checker.is_free(beside(rng, arm.group, centre, 0.1));
    for (int k = 0; k < 15; ++k) judge(checker, reference, beside(rng, arm.group, centre, 0.3), count);
  }
  EXPECT_EQ(count.wrong, 0) << arm.name;
  EXPECT_GT(count.free, 0) << arm.name;
  EXPECT_GT(count.hit, 0) << arm.name;
}

}  // namespace

TEST(PairTable, RepeatedQuestionsChangeNoAnswer) {
  MMGRASP_NEEDS_SHARED_DATA();
  compare(testing_support::ur5_arm(), 60, 1);
  compare(testing_support::panda_arm(), 40, 2);
  compare(testing_support::tiago_arm(), 40, 3);
}

TEST(PairTable, AnswersHoldOnTheBordersOfCells) {
  MMGRASP_NEEDS_SHARED_DATA();
  const testing_support::MeshArm arm = testing_support::ur5_arm();
  CollisionChecker checker(arm.group, World(), self_only());
  CollisionChecker reference = checker.clone();
  Rng rng(4);
  Count count;
  for (int i = 0; i < 60; ++i) {
    // Full turns are cut into powers of two: where coarse and fine cells meet, from both sides and a turn apart.
    Eigen::VectorXd q = drawn(rng, arm.group);
    constexpr double kCell = 2 * M_PI / 64;
    for (Eigen::Index j = 0; j < q.size(); ++j) q[j] = std::round(q[j] / kCell) * kCell;
    for (int k = 0; k < 100; ++k) checker.is_free(beside(rng, arm.group, q, 0.05));
    for (const double side : {-1e-12, 0.0, 1e-12}) {
      for (const double turn : {-2 * M_PI, 0.0, 2 * M_PI}) {
        Eigen::VectorXd at = q;
        for (Eigen::Index j = 0; j < q.size(); ++j) {
          at[j] += side + turn;
          if (at[j] < arm.group.lower()[j] || at[j] > arm.group.upper()[j]) at[j] = q[j];
        }
        judge(checker, reference, at, count);
      }
    }
  }
  EXPECT_EQ(count.wrong, 0);
  EXPECT_GT(count.free, 0);
  EXPECT_GT(count.hit, 0);
}

TEST(PairTable, EdgesAreThoseOfLookingAtEachStep) {
  MMGRASP_NEEDS_SHARED_DATA();
  const testing_support::MeshArm arm = testing_support::ur5_arm();
  CollisionChecker checker(arm.group, World(), self_only());
  CollisionChecker reference = checker.clone();
  Rng rng(5);
  int free = 0, hit = 0, wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::VectorXd from = drawn(rng, arm.group), to = beside(rng, arm.group, from, 0.5);
    const int pieces = static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff() / 0.02 - 1e-9));
    double least = std::numeric_limits<double>::infinity(), nearest = least;
    for (int k = 0; k <= pieces; ++k) {
      const double gap = reference.distance(from + (to - from) * (static_cast<double>(k) / pieces)).value;
      least = std::min(least, gap);
      nearest = std::min(nearest, std::abs(gap));
    }
    if (nearest < 1e-6) continue;
    // The first answers teach the checker, the last ones use it.
    for (int k = 0; k < 10; ++k) wrong += checker.edge_is_free(from, to) != (least > 0);
    ++(least > 0 ? free : hit);
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(free, 0);
  EXPECT_GT(hit, 0);
}

TEST(PairTable, ThreadsThatLearnTogetherAnswerAlike) {
  MMGRASP_NEEDS_SHARED_DATA();
  const testing_support::MeshArm arm = testing_support::ur5_arm();
  const CollisionChecker checker(arm.group, World(), self_only());
  std::vector<Eigen::VectorXd> draws;
  Rng rng(6);
  for (int i = 0; i < 10; ++i) {
    const Eigen::VectorXd centre = drawn(rng, arm.group);
    for (int k = 0; k < 60; ++k) draws.push_back(beside(rng, arm.group, centre, 0.05));
  }
  std::vector<std::vector<char>> answers(4);
  std::vector<std::thread> threads;
  for (auto& own : answers) {
    threads.emplace_back([&] {
      CollisionChecker mine = checker.clone();
      for (const Eigen::VectorXd& q : draws) own.push_back(mine.is_free(q));
    });
  }
  for (std::thread& thread : threads) thread.join();
  CollisionChecker reference = checker.clone();
  for (const auto& own : answers) EXPECT_EQ(own, answers.front());
  for (std::size_t i = 0; i < draws.size(); ++i) {
    const double gap = reference.distance(draws[i]).value;
    if (std::abs(gap) > 1e-6) EXPECT_EQ(answers.front()[i] != 0, gap > 0);
  }
}
