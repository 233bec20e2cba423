// What the tuning constants of RRT*-MG are worth: each is switched off or changed alone, and the Panda plans for a bar
// held by one of 200 grasps again. Prints a Markdown table; numbers are ratios to the constants as they are, so that
// more than 1 means the constant's value helps: mean cost, processor time, and problems solved.
//
//     bench_rrt_star_mg_tuning [runs, 10]

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "core/collision_case.hpp"
#include "core/report.hpp"
#include "plan/manipulation/rrt_star_mg/rrt_star_mg_planner.hpp"
#include "planners/bar_past_post.hpp"

namespace {

using namespace mmgrasp;

detail::RrtStarMgTuning tuning;  // Of the planner below.

const detail::ManipulationPlanner kTunedPlanner{"rrt_star_mg",
                                                [](detail::ManipulationInput& input, ManipulationResult& result) {
                                                  return detail::run_rrt_star_mg(input, result, tuning);
                                                }};

struct Variant {
  std::string name;
  std::function<void(detail::RrtStarMgTuning&)> change;
};

const std::vector<Variant> kVariants = {
    {"as it is", [](detail::RrtStarMgTuning&) {}},
    {"no straight lines", [](detail::RrtStarMgTuning& t) { t.straight_line_grasps = 0; }},
    {"trees_per_sample 0", [](detail::RrtStarMgTuning& t) { t.trees_per_sample = 0; }},
    {"near_line_probability 0", [](detail::RrtStarMgTuning& t) { t.near_line_probability = 0; }},
    {"min_detour 1", [](detail::RrtStarMgTuning& t) { t.min_detour = 1; }},
    {"detour_range 1", [](detail::RrtStarMgTuning& t) { t.detour_range = 1; }},
    {"min_near_vertices 0", [](detail::RrtStarMgTuning& t) { t.min_near_vertices = 0; }},
    {"max_connections 1000", [](detail::RrtStarMgTuning& t) { t.max_connections = 1000; }},
    {"max_duplicates 0", [](detail::RrtStarMgTuning& t) { t.max_duplicates = 0; }},
    {"first_connection_bound 1", [](detail::RrtStarMgTuning& t) { t.first_connection_bound = 1; }},
    {"shortcut_probability 0", [](detail::RrtStarMgTuning& t) { t.shortcut_probability = 0; }},
    {"other_grasp_probability 0", [](detail::RrtStarMgTuning& t) { t.other_grasp_probability = 0; }},
    {"joint_shortcut_probability 0", [](detail::RrtStarMgTuning& t) { t.joint_shortcut_probability = 0; }},
    {"joint_shortcut_probability 1", [](detail::RrtStarMgTuning& t) { t.joint_shortcut_probability = 1; }},
};

struct Case {
  std::string name, kind;
  int first_grasps, samples;
};

const std::vector<Case> kCases = {{"default options, post", "all good", 4, 1000},
                                  {"default options, gate", "gate", 4, 1000},
                                  {"trees alone, post", "all good", 0, 3000},
                                  {"trees alone, gate", "gate", 0, 3000}};

struct Measured {
  double cost = 0;     ///< Mean over the problems solved.
  double seconds = 0;  ///< Processor time of all runs without inverse kinematics.
  int solved = 0;
};

Measured measure(const JointGroup& group, const Case& which, int runs) {
  Measured out;
  for (int run = 1; run <= runs; ++run) {
    const ManipulationProblem problem = bench::bar_past_post(group, which.kind, static_cast<unsigned>(run), 200);
    ManipulationOptions options;
    options.planner = "rrt_star_mg";
    options.first_grasps = which.first_grasps;
    options.rrt.max_iterations = which.samples;
    options.time_limit = 1000;
    options.threads = 1;
    options.seed = static_cast<unsigned>(run);
    const double begin = bench::processor_seconds();
    const ManipulationResult result = detail::plan_manipulation_with(kTunedPlanner, problem, options, nullptr, {}, {});
    out.seconds += bench::processor_seconds() - begin - result.stats.ik_seconds;
    if (!result.path) continue;
    ++out.solved;
    out.cost += result.cost;
  }
  out.cost /= out.solved > 0 ? out.solved : 1;
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 10;
  const JointGroup group = bench::arms().front().group;
  std::printf("| constant |");
  for (const Case& which : kCases) std::printf(" %s: cost | time | solved |", which.name.c_str());
  std::printf("\n|---|");
  for (std::size_t i = 0; i < 3 * kCases.size(); ++i) std::printf("---|");
  std::printf("\n");
  std::vector<Measured> base;
  for (const Variant& variant : kVariants) {
    tuning = {};
    variant.change(tuning);
    std::printf("| %s |", variant.name.c_str());
    for (std::size_t c = 0; c < kCases.size(); ++c) {
      const Measured found = measure(group, kCases[c], runs);
      if (base.size() <= c) base.push_back(found);
      if (&variant == &kVariants.front()) {
        std::printf(" %.4f rad | %.3f s | %d of %d |", found.cost, found.seconds / runs, found.solved, runs);
      } else {
        std::printf(" %.3f | %.2f | %d |", found.cost / base[c].cost, found.seconds / base[c].seconds, found.solved);
      }
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}
