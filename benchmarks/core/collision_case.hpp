#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/disabled_pairs.hpp"
#include "mmgrasp/core/random.hpp"

namespace bench {

inline std::string shared(const std::string& path) {
  return std::string(MMGRASP_SHARED_DATA) + "/" + path;
}

/// A robot, its group and how far its arm reaches.
struct Arm {
  std::string name;
  mmgrasp::JointGroup group;
  double reach = 0.8, low = 0, high = 1;  ///< Where obstacles stand [m].
  double keep_out = 0.35;                 ///< No obstacle nearer to the root's z axis than this [m].
};

/// Panda with its SRDF, UR5 with its SRDF and TIAGo's arm with its torso (meshes; pairs sampled).
inline std::vector<Arm> arms() {
  using namespace mmgrasp;
  RobotOptions panda, tiago;
  panda.package_dirs["moveit_resources_panda_description"] = shared("robots/panda/moveit_resources_panda_description");
  tiago.package_dirs["example-robot-data"] = shared("robots/tiago/example-robot-data");
  const Robot arm7 = Robot::load(shared("robots/panda/expanded/panda.urdf"),
                                 shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"), panda);
  const Robot arm6 = Robot::load(shared("robots/ur5_vamp/ur5/ur5.urdf"), shared("robots/ur5_vamp/ur5/ur5.srdf"));
  const Robot mobile = compute_disabled_pairs(Robot::load(
      shared("robots/tiago/example-robot-data/robots/tiago_description/robots/tiago_no_hand.urdf"), "", tiago));
  std::vector<Arm> out;
  out.push_back({"Panda", arm7.group("panda_arm"), 0.85, 0.0, 1.1, 0.35});
  std::string ur5 = arm6.groups().empty() ? "" : arm6.groups().front().name;
  for (const GroupDescription& group : arm6.groups()) {
    if (group.joints.size() == 6) ur5 = group.name;
  }
  out.push_back({"UR5", arm6.group(ur5), 0.85, 0.0, 1.9, 0.35});
  out.push_back({"TIAGo", mobile.chain("torso_fixed_link", "arm_7_link"), 1.0, 0.1, 1.5, 0.45});
  return out;
}

/// Twenty boxes in the arm's reach, turned at random.
inline mmgrasp::World twenty_boxes(const Arm& arm, unsigned seed) {
  using namespace mmgrasp;
  Rng rng(seed);
  World world;
  for (int i = 0; i < 20; ++i) {
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(arm.keep_out + 0.15, arm.reach);
    Pose T = Pose::Identity();
    T.translation() << r * std::cos(angle), r * std::sin(angle), rng.uniform(arm.low, arm.high);
    T.linear() = rng.rotation().toRotationMatrix();
    world.add("box" + std::to_string(i), Box{{rng.uniform(0.04, 0.2), rng.uniform(0.04, 0.2), rng.uniform(0.04, 0.2)}},
              T);
  }
  return world;
}

/// Configurations as a tree-growing planner draws them: one uniform sample, then points 0.05 apart along an edge of 0.5
/// from a free configuration towards it.
inline std::vector<Eigen::VectorXd> planner_draws(mmgrasp::CollisionChecker& checker, int count, unsigned seed) {
  using namespace mmgrasp;
  Rng rng(seed);
  const JointGroup& group = checker.group();
  const Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
  std::vector<Eigen::VectorXd> draws, tree;
  while (tree.size() < 200) {
    const Eigen::VectorXd q = rng.uniform(lower, upper);
    if (checker.is_free(q)) tree.push_back(q);
  }
  while (static_cast<int>(draws.size()) < count) {
    const Eigen::VectorXd target = rng.uniform(lower, upper);
    draws.push_back(target);
    const Eigen::VectorXd& from = tree[static_cast<std::size_t>(rng.uniform(0, 1) * 200) % 200];
    const Eigen::VectorXd step = (target - from) / (target - from).cwiseAbs().maxCoeff();
    for (int i = 1; i <= 10; ++i) draws.push_back(from + 0.05 * i * step);
  }
  return draws;
}

/// Straight edges whose largest joint motion is `length`, from free configurations of a tree.
inline std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> planner_edges(mmgrasp::CollisionChecker& checker,
                                                                              int count, double length, unsigned seed) {
  using namespace mmgrasp;
  Rng rng(seed);
  const JointGroup& group = checker.group();
  const Eigen::VectorXd lower = group.sample_lower(), upper = group.sample_upper();
  std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> edges;
  while (static_cast<int>(edges.size()) < count) {
    const Eigen::VectorXd from = rng.uniform(lower, upper), target = rng.uniform(lower, upper);
    const Eigen::VectorXd delta = (target - from) * (length / (target - from).cwiseAbs().maxCoeff());
    if (delta.norm() > (target - from).norm() || !checker.is_free(from)) continue;
    edges.emplace_back(from, from + delta);
  }
  return edges;
}

}  // namespace bench
