// What the tuning constants of RRT*-MG are worth: each is switched off or changed alone, and the Panda plans for a bar
// held by one of 200 grasps again, with the same seeds. Prints a Markdown table: by how many percent costs change on
// average, run by run, with half of the 95 % confidence interval (more than 0: the constant's value helps), and
// processor time by that of the constants as they are.
//
//     bench_rrt_star_mg_tuning [runs, 20] [cases whose name contains this] [variants whose name contains this]

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
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
    {"before the first path as P2",
     [](detail::RrtStarMgTuning& t) {
       t.near_line_probability = 0;
       t.trees_per_sample = 0;
     }},
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
  std::vector<double> costs;  ///< Of each run; infinite without a path.
  double seconds = 0;         ///< Processor time of all runs.
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
    const ManipulationResult result =
        detail::plan_manipulation_with(kTunedPlanner, problem, options, nullptr, {}, {}, nullptr);
    out.seconds += bench::processor_seconds() - begin;
    out.costs.push_back(result.path ? result.cost : std::numeric_limits<double>::infinity());
  }
  return out;
}

/// Mean change in percent and half of its 95 % confidence interval, of runs that both have solved.
void print_change(const Measured& base, const Measured& other) {
  std::vector<double> changes;
  int lost = 0;
  for (std::size_t i = 0; i < base.costs.size(); ++i) {
    if (std::isfinite(base.costs[i]) && std::isfinite(other.costs[i]))
      changes.push_back(100 * std::log(other.costs[i] / base.costs[i]));
    else
      lost += std::isfinite(base.costs[i]) ? 1 : 0;
  }
  const auto n = static_cast<double>(changes.size());
  double mean = 0, squares = 0;
  for (const double change : changes) mean += change / n;
  for (const double change : changes) squares += (change - mean) * (change - mean);
  constexpr double kQuantile = 2;  // Student's t of 60 runs; of 20 it is 2.09.
  std::printf(" %+.2f +- %.2f |", mean, kQuantile * std::sqrt(squares / (n - 1) / n));
  std::printf(" %.2f%s |", other.seconds / base.seconds, lost > 0 ? (", lost " + std::to_string(lost)).c_str() : "");
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::string wanted_case = argc > 2 ? argv[2] : "", wanted = argc > 3 ? argv[3] : "";
  const JointGroup group = bench::arms().front().group;
  std::vector<Case> cases;
  for (const Case& each : kCases)
    if (each.name.find(wanted_case) != std::string::npos) cases.push_back(each);
  std::printf("| constant |");
  for (const Case& which : cases) std::printf(" %s: cost [%%] | time |", which.name.c_str());
  std::printf("\n|---|");
  for (std::size_t i = 0; i < 2 * cases.size(); ++i) std::printf("---|");
  std::printf("\n");
  std::vector<Measured> base;
  for (const Variant& variant : kVariants) {
    const bool first = &variant == &kVariants.front();
    if (!first && variant.name.find(wanted) == std::string::npos) continue;
    tuning = {};
    variant.change(tuning);
    std::printf("| %s |", variant.name.c_str());
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const Measured found = measure(group, cases[c], runs);
      if (first) {
        base.push_back(found);
        double mean = 0;
        for (const double cost : found.costs) mean += cost / runs;
        std::printf(" %.4f rad | %.3f s |", mean, found.seconds / runs);
      } else {
        print_change(base[c], found);
      }
      std::fflush(stdout);
    }
    std::printf("\n");
  }
}
