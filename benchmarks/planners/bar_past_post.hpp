#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/manipulation.hpp"

namespace bench {

inline mmgrasp::Pose translated(double x, double y, double z) {
  mmgrasp::Pose T = mmgrasp::Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

/// The hand closes across the bar (along x) at `place`, `angle` away from straight down.
inline mmgrasp::Grasp bar_grasp(double place, double angle) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d z = Eigen::AngleAxisd(angle, x) * Eigen::Vector3d(0, 0, -1);
  mmgrasp::Pose T = mmgrasp::Pose::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = place * x - 0.12 * z;
  T.linear() = T.linear() * Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {T, 0, 0};
}

/// An arm moves a bar past a post on a table; drawn by `run`. Kinds: "499 in the table", "499 out of reach" (one grasp
/// is reachable), "all good", and "gate": all good, and a beam above the post.
inline mmgrasp::ManipulationProblem bar_past_post(const mmgrasp::JointGroup& group, const std::string& kind,
                                                  unsigned run, int grasps = 500) {
  using namespace mmgrasp;
  Rng rng(run);
  LinkShape bar;
  bar.shape = Box{{0.3, 0.03, 0.03}};
  ManipulationProblem problem{group, {}, {bar}, translated(0.45, 0.3, 0.05), translated(0.45, -0.3, 0.3)};
  problem.T_world_start.linear() =
      Eigen::AngleAxisd(rng.uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  problem.world.add("table", Box{{1.2, 1.6, 0.04}}, translated(0.7, 0, -0.03));
  problem.world.add("post", Box{{0.06, 0.06, 0.5}}, translated(0.5, 0.0, 0.25));
  if (kind == "gate") problem.world.add("beam", Box{{0.8, 0.06, 0.06}}, translated(0.6, 0.0, 0.75));
  for (int i = 0; i < grasps; ++i) {
    const double place = rng.uniform(-0.14, 0.14);
    if (kind == "499 in the table") {
      problem.grasps.push_back(bar_grasp(place, M_PI + rng.uniform(-0.8, 0.8)));
    } else {
      problem.grasps.push_back(bar_grasp(place, rng.uniform(-0.5, 0.5)));
      if (kind == "499 out of reach") problem.grasps.back().T_object_hand.translation().x() += rng.uniform(0.6, 1.5);
    }
  }
  problem.grasps[rng.index(grasps)] = bar_grasp(0.02, 0.1);
  return problem;
}

}  // namespace bench
