#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "mmgrasp/robot/manipulability.hpp"
#include "mmgrasp/structure/object_path.hpp"

namespace mmgrasp {

/// Configurations at a pose of the tool.
using Configurations = std::function<std::vector<Eigen::VectorXd>(const Pose& T_world_hand)>;

inline Configurations all_branches(const JointGroup& group, int redundant_values = 0) {
  return [group, redundant_values](const Pose& T) {
    return solve_ik_branches(group, T, {}, {}, redundant_values).solutions;
  };
}

/// Everything checked by itself, all sequences enumerated.
struct Enumerated {
  std::vector<int> violations;
  double cost = std::numeric_limits<double>::infinity();
  long sequences = 0;

  Enumerated(const ObjectPathProblem& problem, const Grasp& grasp, const ObjectPathOptions& options,
             const Configurations& configurations) {
    World world = problem.world;
    world.add("pipe", WorldObject{problem.object, problem.T_world_object[0]});
    world.attach("pipe", problem.group.robot().links()[problem.group.tip_link()].name, grasp.T_object_hand.inverse(),
                 problem.touch_links);
    CollisionChecker checker(problem.group, world);
    std::vector<std::vector<Eigen::VectorXd>> layers;
    for (const Pose& T : problem.T_world_object) {
      const std::vector<Eigen::VectorXd> all = configurations(T * grasp.T_object_hand);
      layers.emplace_back();
      for (const Eigen::VectorXd& q : all) {
        if (checker.is_free(q)) layers.back().push_back(q);
      }
      violations.push_back(all.empty() ? 2 : layers.back().empty() ? 1 : 0);
    }
    const SupportedFrame held(*problem.frame, {beam_support(grasp)});
    double sag = 0;
    for (std::size_t i = 1; i < layers.size(); ++i) {
      sag += held.largest_displacement(gravity_in_object(problem.T_world_object[i])).value;
    }
    const std::function<void(std::size_t, const Eigen::VectorXd&, double)> go_on =
        [&](std::size_t i, const Eigen::VectorXd& last, double so_far) {
          if (i == layers.size()) {
            ++sequences;
            cost = std::min(cost, so_far + options.deflection_weight * sag / options.deflection_scale);
            return;
          }
          for (const Eigen::VectorXd& q : layers[i]) {
            if ((q - last).cwiseAbs().maxCoeff() > options.max_joint_step) continue;
            const Pose middle = problem.group.fk((q + last) / 2) * grasp.T_object_hand.inverse();
            const Pose &a = problem.T_world_object[i - 1], &b = problem.T_world_object[i];
            const Eigen::Quaterniond half = Eigen::Quaterniond(a.linear()).slerp(0.5, Eigen::Quaterniond(b.linear()));
            if ((middle.translation() - (a.translation() + b.translation()) / 2).norm() > options.position_tolerance)
              continue;
            if (half.angularDistance(Eigen::Quaterniond(middle.linear())) > options.rotation_tolerance) continue;
            if (!checker.edge_is_free(last, q, options.edge_step)) continue;
            const Vector6d motion = pose_difference(a * grasp.T_object_hand, b * grasp.T_object_hand);
            go_on(i + 1, q,
                  so_far + options.motion_weight * (q - last).norm() +
                      options.manipulability_weight * force_manipulability(problem.group, q, motion));
          }
        };
    for (const Eigen::VectorXd& q : layers[0]) go_on(1, q, 0);
  }
};

}  // namespace mmgrasp
