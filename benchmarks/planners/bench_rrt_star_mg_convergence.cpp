// How near RRT*-MG comes to the optimum with its default options. A gantry of two joints, and one of six, moves a cube
// past walls and boxes, where the optimum is known exactly (a visibility graph); a Panda moves a bar with one of ten
// grasps, where the cheapest path of all runs stands in for it. Prints a Markdown table: how much the paths cost more
// than that, in percent, mean and worst of all runs after so many samples. Less than zero: the checks' steps of 5 mm
// let a path cut the corner of a wall.
//
// Each run's percentages go to the error stream, so that a long table can be taken in pieces.
//
//     bench_rrt_star_mg_convergence [runs, 20] [samples, 20000] [scenes whose name contains this] [first seed, 1]

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "core/collision_case.hpp"
#include "core/report.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "planners/bar_past_post.hpp"
#include "support/gantry_walls.hpp"

namespace {

using namespace mmgrasp;

const std::vector<int> kSamples = {500, 1000, 2000, 5000, 20000, 100000};

struct Case {
  std::string name;
  ManipulationProblem problem;
  double optimum;  ///< Not positive: unknown.
};

struct Run {
  std::vector<double> costs;  ///< After each of kSamples.
  std::size_t waypoints = 0;
  double seconds = 0;
};

Run run(const ManipulationProblem& problem, unsigned seed, int samples) {
  ManipulationOptions options;
  options.planner = "rrt_star_mg";
  options.rrt.max_iterations = samples;
  options.time_limit = 1e5;
  options.seed = seed;
  options.threads = 1;
  Run out;
  out.costs.assign(kSamples.size(), std::numeric_limits<double>::infinity());
  double done = 0;  // Samples, at the last report.
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double fraction) {
    if (stage == "search") done = fraction * samples;
  };
  const double begin = bench::processor_seconds();
  const ManipulationResult result =
      plan_manipulation(problem, options, nullptr, monitor, [&](const Improvement& better) {
        for (std::size_t i = 0; i < kSamples.size(); ++i)
          if (done < kSamples[i]) out.costs[i] = better.cost;
      });
  out.seconds = bench::processor_seconds() - begin;
  if (result.path) out.waypoints = result.path->waypoints.size();
  return out;
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const bool wrist : {false, true})
    for (const auto& [name, walls] : {std::pair("wall of 2 mm", test::wall_with_door(0.002)),
                                      std::pair("wall of 80 mm", test::wall_with_door(0.08)),
                                      std::pair("two walls", test::two_walls()), std::pair("boxes", test::boxes())}) {
      const test::GantryWalls made = test::gantry_walls_problem(walls, wrist);
      out.push_back({std::string(wrist ? "6 joints, " : "2 joints, ") + name, made.problem, made.optimum});
    }
  for (const char* kind : {"all good", "gate"})
    out.push_back({std::string("Panda, ") + (kind == std::string("gate") ? "gate" : "post"),
                   bench::bar_past_post(bench::arms()[0].group, kind, 1, 10), 0});
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 20, samples = argc > 2 ? std::atoi(argv[2]) : 20000;
  const auto columns =
      static_cast<std::size_t>(std::upper_bound(kSamples.begin(), kSamples.end(), samples) - kSamples.begin());
  std::printf("| scene, %d runs | optimum |", runs);
  for (std::size_t i = 0; i < columns; ++i) std::printf(" %d samples |", kSamples[i]);
  std::printf(" waypoints | time |\n|---|---|");
  for (std::size_t i = 0; i < columns + 2; ++i) std::printf("---|");
  std::printf("\n");
  const std::string wanted = argc > 3 ? argv[3] : "";
  const int first = argc > 4 ? std::atoi(argv[4]) : 1;
  for (const Case& which : cases()) {
    if (which.name.find(wanted) == std::string::npos) continue;
    std::vector<Run> found;
    double seconds = 0, best = std::numeric_limits<double>::infinity();
    std::size_t waypoints = 0;
    for (int seed = first; seed < first + runs; ++seed) {
      found.push_back(run(which.problem, static_cast<unsigned>(seed), samples));
      seconds += found.back().seconds / runs;
      waypoints = std::max(waypoints, found.back().waypoints);
      best = std::min(best, found.back().costs[columns - 1]);
      std::fprintf(stderr, "%s, seed %d, %.2f s:", which.name.c_str(), seed, found.back().seconds);
      for (std::size_t i = 0; i < columns && which.optimum > 0; ++i)
        std::fprintf(stderr, " %.4f", 100 * (found.back().costs[i] / which.optimum - 1));
      std::fprintf(stderr, "\n");
    }
    const bool known = which.optimum > 0;
    const double optimum = known ? which.optimum : best;
    std::printf("| %s | %.4f%s |", which.name.c_str(), optimum, known ? "" : " (best run)");
    for (std::size_t i = 0; i < columns; ++i) {
      double mean = 0, worst = -std::numeric_limits<double>::infinity();
      for (const Run& own : found) {
        mean += 100 * (own.costs[i] / optimum - 1) / runs;
        worst = std::max(worst, 100 * (own.costs[i] / optimum - 1));
      }
      std::printf(" %.2f, %.2f |", mean, worst);
    }
    std::printf(" at most %zu | %.2f s |\n", waypoints, seconds);
    std::fflush(stdout);
  }
}
