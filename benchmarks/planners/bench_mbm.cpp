// MotionBenchMaker's problems: plan_motion beside OMPL's RRT-Connect with FCL in one process, taking turns, with one
// edge resolution and one range. Times are of the processor (one thread); the wall's stand beside them. Every path of
// ours is looked at again by FCL at 0.005 rad.
//
//     bench_mbm <problems.txt> [seeds] [baseline: 0 or 1] [only this set; "": all] [longest tree edge by the diagonal
//     of the sampling bounds, 0.05]

#include <algorithm>
#include <map>
#include <optional>

#include "core/report.hpp"
#include "mbm_problem.hpp"
#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "ompl_baseline.hpp"

namespace {

constexpr double kWorkspaceStep = 0.005, kVerifyStep = 0.005, kLimit = 10;

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

struct Runs {
  std::vector<double> milliseconds, wall, lengths;
  std::size_t solved = 0, verified = 0, queries = 0;

  void print(const std::string& on, const std::string& who, const std::string& settings) const {
    char more[256];
    std::snprintf(more, sizeof more,
                  "\"p95\": %.4g, \"mean\": %.4g, \"wall\": %.4g, \"solved\": %zu, \"verified\": %zu, \"runs\": %zu, "
                  "\"length\": %.3f, "
                  "\"checks\": %zu",
                  quantile(milliseconds, 0.95), mean(milliseconds), quantile(wall, 0.5), solved, verified,
                  milliseconds.size(), mean(lengths), queries / milliseconds.size());
    bench::print({"mbm", on, who, "ms", quantile(milliseconds, 0.5), more, settings});
  }

  static double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
  }
};

bool verified(bench::FclBaseline& fcl, const std::vector<Eigen::VectorXd>& path) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!fcl.edge_is_free(path[i], path[i + 1], kVerifyStep)) return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 1;
  const bool with_baseline = argc > 3 ? std::atoi(argv[3]) != 0 : true;
  const std::string only = argc > 4 ? argv[4] : "";
  const double range_share = argc > 5 ? std::atof(argv[5]) : 0.05;
  std::map<std::string, std::map<std::string, Runs>> sets;
  for (const bench::MbmProblem& problem : bench::MbmReader(argv[1]).read()) {
    if (!only.empty() && problem.set.find(only) == std::string::npos) continue;
    mmgrasp::CollisionChecker checker(problem.group, problem.world);
    bench::FclBaseline judge(problem.group, problem.world, false);
    const bench::EdgeSteps steps{mmgrasp::motion_bounds(checker), 0.02, kWorkspaceStep};
    std::optional<bench::OmplBaseline> baseline;
    if (with_baseline) baseline.emplace(problem.group, problem.world, steps);
    const double range = range_share * (problem.group.sample_upper() - problem.group.sample_lower()).norm();
    auto& runs = sets[problem.set];
    for (int seed = 1; seed <= seeds; ++seed) {
      for (const bool shorten : {false, true}) {
        mmgrasp::MotionOptions options;
        options.workspace_step = kWorkspaceStep;
        options.range = range;
        options.time_limit = kLimit;
        options.max_iterations = 100000000;
        options.shorten = shorten;
        options.seed = static_cast<unsigned>(seed);
        const double begin = bench::processor_seconds();
        const mmgrasp::MotionResult result = plan_motion(checker, problem.start, problem.goals, options);
        Runs& run = runs[shorten ? "mmgrasp, shortened" : "mmgrasp"];
        run.milliseconds.push_back(1e3 * (bench::processor_seconds() - begin));
        run.wall.push_back(1e3 * result.stats.seconds);
        run.queries += result.stats.collision_queries;
        if (!result.path) continue;
        ++run.solved;
        run.lengths.push_back(result.cost);
        if (verified(judge, result.path->waypoints)) {
          ++run.verified;
        } else {
          std::fprintf(stderr, "%s seed %d: FCL finds a collision\n", problem.name.c_str(), seed);
        }
      }
      if (!with_baseline) continue;
      const double begin = bench::processor_seconds();
      const auto answer = baseline->solve(problem.start, problem.goals, range, static_cast<unsigned>(seed), kLimit);
      Runs& run = runs["OMPL RRTConnect + FCL"];
      run.milliseconds.push_back(1e3 * (bench::processor_seconds() - begin));
      run.wall.push_back(1e3 * answer.seconds);
      run.solved += answer.solved;
      run.verified += answer.solved && verified(judge, answer.path);
      double length = 0;
      for (std::size_t i = 1; i < answer.path.size(); ++i) length += (answer.path[i] - answer.path[i - 1]).norm();
      if (answer.solved) run.lengths.push_back(length);
    }
  }
  for (const auto& [set, programs] : sets) {
    for (const auto& [who, run] : programs) {
      run.print(set, who,
                "edges at 5 mm of any link point, 10 s, range " + std::to_string(range_share) +
                    " of the diagonal of the joint limits");
    }
  }
  return 0;
}
