// Panda carries a bar past a post, 500 grasps, 20 runs each: only one of them reachable, or all of them. Times are
// those of the first path and of whole calls, inverse kinematics included, the roadmap's building not.
//
//     bench_many_grasps [threads, 0: all] [planner]

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "core/collision_case.hpp"
#include "core/report.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "planners/bar_past_post.hpp"

namespace {

using namespace mmgrasp;

constexpr int kRuns = 20;

void measure(const Roadmap& roadmap, const std::string& kind, const ManipulationOptions& options) {
  std::vector<double> firsts, seconds, processor;
  int solved = 0;
  double cost = 0;
  for (unsigned run = 0; run <= kRuns; ++run) {  // the first one warms up
    const ManipulationProblem problem = bench::bar_past_post(roadmap.group(), kind, std::max(run, 1u));
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
  const Roadmap roadmap = Roadmap::build(bench::arms().front().group);
  for (const char* kind : {"499 in the table", "499 out of reach", "all good"}) measure(roadmap, kind, options);
}
