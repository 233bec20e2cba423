// What the whole turns of goals are worth: a UR5e between two walls under a roof goes to tool poses, with every turn of
// the arm configurations there as a goal and with the turn nearest to the middle of the limits alone.
#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "report.hpp"
#include "support/mesh_robots.hpp"

namespace {

using namespace mmgrasp;

constexpr int kPoses = 60;

World walls() {
  World world;
  const Shape wall(Box{{0.6, 0.02, 0.5}});
  world.add("front", wall, pose_from_xyz_rpy({0.75, 0, 0.5}, {0, 0, 0}));
  world.add("back", wall, pose_from_xyz_rpy({-0.75, 0, 0.4}, {0, 0, 0}));
  world.add("roof", Shape(Box{{1.5, 1.5, 0.02}}), pose_from_xyz_rpy({0, 0, 1.05}, {0, 0, 0}));
  return world;
}

void run(const JointGroup& group, const std::string& planner, bool wound, bool all_turns) {
  CollisionChecker checker(group, walls());
  Rng rng(7);
  const Eigen::VectorXd half = Eigen::VectorXd::Constant(group.size(), M_PI);
  MotionOptions options;
  options.planner = planner;
  if (planner != "rrt_connect") options.max_iterations = 800;
  std::vector<double> times;
  double cost = 0;
  int solved = 0;
  while (static_cast<int>(times.size()) < kPoses) {
    const Eigen::VectorXd start = wound ? rng.uniform(group.lower(), group.upper()) : rng.uniform(-half, half);
    const Eigen::VectorXd made = rng.uniform(-half, half);
    if (!checker.is_free(start) || !checker.is_free(made)) continue;
    MotionGoals goals;
    const double before = bench::processor_seconds();
    if (all_turns) {
      goals.tool_poses = {group.fk(made)};
    } else {
      goals.configurations = solve_ik_all(group, group.fk(made), options.ik_solutions);
    }
    const MotionResult result = plan_motion_to(checker, start, goals, options);
    times.push_back(1e3 * (bench::processor_seconds() - before));
    solved += result.path ? 1 : 0;
    cost += result.cost;
  }
  std::sort(times.begin(), times.end());
  double sum = 0;
  for (const double time : times) sum += time;
  bench::print({"whole turns of goals",
                std::string("UR5e, ") + (wound ? "starts in any turn" : "starts within half a turn"),
                planner + (all_turns ? ", every turn" : ", one turn"), "ms", times[times.size() / 2],
                "\"solved\": " + std::to_string(solved) + ", \"mean ms\": " + std::to_string(sum / kPoses) +
                    ", \"mean cost\": " + std::to_string(cost / std::max(1, solved)),
                "defaults; anytime planners 800 states; " + std::to_string(kPoses) + " poses"});
}

}  // namespace

int main() {
  const JointGroup group = testing_support::ur5e_arm().group;
  for (const bool wound : {false, true})
    for (const char* planner : {"rrt_connect", "ompl_rrt_connect", "bit_star"})
      for (const bool all_turns : {false, true}) run(group, planner, wound, all_turns);
}
