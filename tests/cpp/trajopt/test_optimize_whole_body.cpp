#include "mmgrasp/trajopt/optimize_whole_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/fetchlike.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

VectorXd vec(std::initializer_list<double> values) {
  VectorXd v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

/// Straight lines start - task - goal.
WholeBodyGuess straight(const WholeBodyProblem& problem, const std::vector<VectorXd>& knots, double step) {
  WholeBodyGuess guess;
  for (std::size_t s = 0; s < problem.segments.size(); ++s) {
    const int n = problem.segments[s].intervals;
    for (int i = 0; i < n; ++i) guess.positions.push_back(knots[s] + (knots[s + 1] - knots[s]) * i / n);
    guess.steps.push_back(step);
  }
  guess.positions.push_back(knots.back());
  return guess;
}

/// P1 4.2: figure 4.3.
WholeBodyProblem example(const JointGroup& group) {
  WholeBodyProblem problem(group);
  problem.start = VectorXd::Zero(10);
  problem.goal_lower = problem.goal_upper = vec({10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5});
  problem.segments = {{17}, {17}};
  ToolConstraint tool;
  tool.waypoint = 17;
  tool.T_world_tip = pose_from_xyz_rpy({5.5, -2, 0.5}, {1, 1, 0});
  problem.tool = {tool};
  return problem;
}

void print(const WholeBodyResult& r) {
  std::cout << to_string(r.outcome) << " " << r.message << " T=" << r.trajectory->duration() << " it=" << r.iterations
            << " " << r.seconds << " s\n";
  for (const Violation& v : r.violations)
    std::cout << "  " << v.kind << " " << v.value << " at " << v.time << " " << v.what << (v.kept() ? "" : " !!!")
              << "\n";
}

}  // namespace

TEST(OptimizeWholeBody, SolvesTheExampleOfP1) {
  const JointGroup group = test::fetchlike_whole_body();
  const WholeBodyProblem problem = example(group);
  VectorXd middle = 0.5 * (problem.start + problem.goal_lower);
  const WholeBodyResult r =
      optimize_whole_body(problem, straight(problem, {problem.start, middle, problem.goal_lower}, 0.6));
  print(r);
  EXPECT_EQ(r.outcome, Outcome::solved);
}

}  // namespace mmgrasp
