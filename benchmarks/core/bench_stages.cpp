// What single queries, edges and whole plans cost with the library at hand: run_stages.py runs it with one stage of the
// checks left out after the other. The answers are hashed, for they must be the same without a stage. Arguments:
// rounds, and the beginning of the rows to run, each of which then starts with nothing made by the others.

#include <algorithm>
#include <cstdlib>

#include "collision_case.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "report.hpp"

namespace {

/// Folds answers into one number.
struct Digest {
  std::size_t value = 0;
  void add(std::size_t answer) { value = 1099511628211u * (value ^ answer); }
};

/// Times `work`, which answers `count` questions, on the processor: the first round, which fills what is made when
/// first needed, and the least of the others.
template <class Work>
void measure(const bench::Arm& arm, const std::string& row, std::size_t count, int rounds, const Work& work) {
  double first = 0, least = 1e9;
  Digest digest;
  for (int i = 0; i <= rounds; ++i) {
    digest = {};
    const double start = bench::processor_seconds();
    work(digest);
    const double time = 1e6 * (bench::processor_seconds() - start) / static_cast<double>(count);
    (i == 0 ? first : least) = i == 0 ? time : std::min(least, time);
  }
  bench::print({row, arm.name + ", 20 boxes", "mmgrasp", "us", least,
                "\"first\": " + std::to_string(first) + ", \"answers\": \"" + std::to_string(digest.value) + "\"", ""});
}

void run(const bench::Arm& arm, int rounds, const std::string& only) {
  using namespace mmgrasp;
  const auto wanted = [&](const std::string& row) { return row.compare(0, only.size(), only) == 0; };
  CollisionChecker checker(arm.group, bench::twenty_boxes(arm, 3));
  const std::vector<Eigen::VectorXd> draws = bench::planner_draws(checker, 4400, 5);
  if (wanted("free or not")) {
    measure(arm, "free or not", draws.size(), rounds, [&](Digest& digest) {
      for (const Eigen::VectorXd& q : draws) digest.add(checker.is_free(q));
    });
  }
  for (const double length : {0.5, 2.0}) {
    const std::string row = length < 1 ? "edge of 0.5 rad" : "edge of 2 rad";
    if (!wanted(row)) continue;
    const auto edges = bench::planner_edges(checker, 400, length, 7);
    measure(arm, row, edges.size(), rounds, [&](Digest& digest) {
      for (const auto& [from, to] : edges) digest.add(checker.edge_is_free(from, to, 0.02));
    });
  }
  for (const bool free : {false, true}) {
    const std::string row = free ? "free edge of 0.5 rad" : "blocked edge of 0.5 rad";
    if (!wanted(row)) continue;
    auto edges = bench::planner_edges(checker, 800, 0.5, 11);
    edges.erase(
        std::remove_if(edges.begin(), edges.end(),
                       [&](const auto& edge) { return checker.edge_is_free(edge.first, edge.second, 0.02) != free; }),
        edges.end());
    measure(arm, row, edges.size(), rounds, [&](Digest& digest) {
      for (const auto& [from, to] : edges) digest.add(checker.edge_stays_free(from, to, 0.02));
    });
  }
  if (!wanted("whole plan")) return;
  const auto ends = bench::planner_edges(checker, 40, 0.5, 9);
  measure(arm, "whole plan", ends.size() - 1, rounds, [&](Digest& digest) {
    for (std::size_t i = 1; i < ends.size(); ++i) {
      MotionOptions options;
      options.time_limit = 1e3;
      options.max_iterations = 2000;
      options.seed = static_cast<unsigned>(i);
      const MotionResult result = plan_motion(checker, ends[i - 1].first, {ends[i].first}, options);
      if (!result.path) continue;
      for (const Eigen::VectorXd& q : result.path->waypoints) digest.add(std::hash<double>()(q.sum()));
    }
  });
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 5;
  for (const bench::Arm& arm : bench::arms()) run(arm, rounds, argc > 2 ? argv[2] : "");
}
