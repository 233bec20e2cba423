// Panda carries a bar past a post, 500 grasps, 20 runs each: only one of them reachable, or all of them. Times are
// those of the first path and of whole calls, inverse kinematics included, the roadmap's building not.
//
//     bench_many_grasps [threads, 0: all] [planner]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/collision_case.hpp"
#include "core/report.hpp"
#include "mmgrasp/plan/manipulation.hpp"

namespace {

using namespace mmgrasp;

constexpr int kGrasps = 500, kRuns = 20;

Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

/// The hand closes across the bar (along x) at `place`, `angle` away from straight down.
Grasp grasp(double place, double angle) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d z = Eigen::AngleAxisd(angle, x) * Eigen::Vector3d(0, 0, -1);
  Pose T = Pose::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = place * x - 0.12 * z;
  T.linear() = T.linear() * Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {T, 0, 0};
}

ManipulationProblem problem_of(const JointGroup& group, const std::string& kind, unsigned run) {
  Rng rng(run);
  LinkShape bar;
  bar.shape = Box{{0.3, 0.03, 0.03}};
  ManipulationProblem problem{group, {}, {bar}, at(0.45, 0.3, 0.05), at(0.45, -0.3, 0.3)};
  problem.T_world_start.linear() =
      Eigen::AngleAxisd(rng.uniform(-0.5, 0.5), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  problem.world.add("table", Box{{1.2, 1.6, 0.04}}, at(0.7, 0, -0.03));
  problem.world.add("post", Box{{0.06, 0.06, 0.5}}, at(0.5, 0.0, 0.25));
  for (int i = 0; i < kGrasps; ++i) {
    const double place = rng.uniform(-0.14, 0.14);
    if (kind == "499 in the table") {
      problem.grasps.push_back(grasp(place, M_PI + rng.uniform(-0.8, 0.8)));
    } else {
      problem.grasps.push_back(grasp(place, rng.uniform(-0.5, 0.5)));
      if (kind == "499 out of reach") problem.grasps.back().T_object_hand.translation().x() += rng.uniform(0.6, 1.5);
    }
  }
  problem.grasps[rng.index(kGrasps)] = grasp(0.02, 0.1);
  return problem;
}

void measure(const Roadmap& roadmap, const std::string& kind, const ManipulationOptions& options) {
  std::vector<double> firsts, seconds, processor;
  int solved = 0;
  double cost = 0;
  for (unsigned run = 0; run <= kRuns; ++run) {  // the first one warms up
    const ManipulationProblem problem = problem_of(roadmap.group(), kind, std::max(run, 1u));
    const double begin = bench::now(), begin_processor = bench::processor_seconds();
    const ManipulationResult result = plan_manipulation(problem, options, &roadmap);
    if (run == 0) continue;
    if (result.path) firsts.push_back(result.improvements.front().seconds);
    seconds.push_back(bench::now() - begin);
    processor.push_back(bench::processor_seconds() - begin_processor);
    solved += result.path ? 1 : 0;
    cost += result.cost / kRuns;
  }
  std::sort(firsts.begin(), firsts.end());
  std::sort(seconds.begin(), seconds.end());
  std::sort(processor.begin(), processor.end());
  const double first = firsts.empty() ? 0 : firsts[firsts.size() / 2];
  char more[240];
  std::snprintf(more, sizeof more,
                "\"solved\": %d, \"runs\": %d, \"first\": %.4g, \"slowest\": %.4g, \"processor\": %.4g, \"cost\": %.4g",
                solved, kRuns, 1e3 * first, 1e3 * seconds.back(), 1e3 * processor[kRuns / 2], cost);
  bench::print({"500 grasps", "Panda, " + kind, "mmgrasp " + options.planner, "ms", 1e3 * seconds[kRuns / 2], more,
                std::to_string(options.ik_solutions) + " arm configurations a grasp and end; roadmap of " +
                    std::to_string(roadmap.size()) + " vertices"});
}

}  // namespace

int main(int argc, char** argv) {
  ManipulationOptions options;
  if (argc > 1) options.threads = std::atoi(argv[1]);
  if (argc > 2) options.planner = argv[2];
  RoadmapOptions wanted;
  wanted.neighbours = 12;
  const Roadmap roadmap = Roadmap::build(bench::arms().front().group, wanted);
  for (const char* kind : {"499 in the table", "499 out of reach", "all good"}) measure(roadmap, kind, options);
}
