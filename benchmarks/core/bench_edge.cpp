// Straight edges of 0.5 rad checked at 0.02 rad against 20 boxes: mmgrasp and FCL in one process on the same edges,
// taking turns. Every answer is compared.

#include <cmath>

#include "collision_case.hpp"
#include "fcl_baseline.hpp"
#include "report.hpp"

namespace {

using Edges = std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>>;
constexpr double kStep = 0.02;

template <class Check>
double time_of(const Edges& edges, std::size_t& sum, const Check& check) {
  const double start = bench::now();
  for (const auto& [from, to] : edges) sum += check(from, to);
  return 1e6 * (bench::now() - start) / static_cast<double>(edges.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// The nearest any check of the edge comes to touching.
double nearest(mmgrasp::CollisionChecker& checker, const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  const int count = static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff() / kStep - 1e-9));
  double least = 1e9;
  for (int i = 0; i <= count; ++i)
    least = std::min(least, std::abs(checker.distance(from + (to - from) * (static_cast<double>(i) / count)).value));
  return least;
}

bool run(const bench::Arm& arm, int count, int rounds) {
  const mmgrasp::World world = bench::twenty_boxes(arm, 3);
  mmgrasp::CollisionChecker checker(arm.group, world);
  const Edges edges = bench::planner_edges(checker, count, 0.5, 5);
  bench::FclBaseline as_trees(arm.group, world, false), as_convex(arm.group, world, true);
  const auto ours = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return checker.edge_is_free(a, b, kStep);
  };
  const auto with = [](bench::FclBaseline& fcl) {
    return [&fcl](const Eigen::VectorXd& a, const Eigen::VectorXd& b) { return fcl.edge_is_free(a, b, kStep); };
  };
  const auto trees = with(as_trees), convex = with(as_convex);
  Edges free, hit;
  bool same = true;
  std::size_t unjudged = 0, sum = 0;
  for (const auto& [from, to] : edges) {
    const bool answer = ours(from, to);
    (answer ? free : hit).emplace_back(from, to);
    if (trees(from, to) == answer && convex(from, to) == answer) continue;
    if (nearest(checker, from, to) < 1e-6) {
      ++unjudged;
    } else {
      same = false;
    }
  }
  std::vector<double> times[3][3];
  for (int round = 0; round < rounds; ++round) {
    const Edges* sets[3] = {&edges, &free, &hit};
    for (int k = 0; k < 3; ++k) {
      times[0][k].push_back(time_of(*sets[k], sum, ours));
      times[1][k].push_back(time_of(*sets[k], sum, trees));
      times[2][k].push_back(time_of(*sets[k], sum, convex));
    }
  }
  const double hits = static_cast<double>(hit.size()) / static_cast<double>(edges.size());
  const char* names[3] = {"mmgrasp", "FCL, meshes as BVH", "FCL, convex meshes as Convex"};
  for (int p = 0; p < 3; ++p) {
    char more[256];
    std::snprintf(more, sizeof more,
                  "\"hits\": %.3f, \"free us\": %.4g, \"colliding us\": %.4g, \"edges\": %zu, \"in the 1e-6 m band\": "
                  "%zu, \"answers agree\": %s",
                  hits, median(times[p][1]), median(times[p][2]), edges.size(), unjudged, same ? "true" : "false");
    bench::print({"edge of 0.5 rad", arm.name + ", 20 boxes", names[p], "us", median(times[p][0]), more,
                  p == 0 ? "edge_is_free, step 0.02" : "DynamicAABBTree manager, step 0.02 from one end to the other"});
  }
  return same && sum > 0 && hits >= 0.05 && hits <= 0.5;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 500, rounds = argc > 2 ? std::atoi(argv[2]) : 5;
  bool good = true;
  for (const bench::Arm& arm : bench::arms()) good = run(arm, count, rounds) && good;
  return good ? 0 : 1;
}
