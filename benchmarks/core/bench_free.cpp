// Free or not against 20 boxes, links placed inside the timing: mmgrasp, FCL and coal in one process on the same
// configurations, taking turns. Every answer is compared.

#include <cmath>
#include <cstdlib>

#include "coal_baseline.hpp"
#include "collision_case.hpp"
#include "fcl_baseline.hpp"
#include "report.hpp"

namespace {

using Configurations = std::vector<Eigen::VectorXd>;

struct Program {
  std::string who, settings;
  std::function<bool(const Eigen::VectorXd&)> is_free;
  std::vector<double> all, free, hit;  ///< Time per query of each round [us].
};

double time_of(Program& program, const Configurations& draws, std::size_t& sum) {
  const double start = bench::now();
  for (const Eigen::VectorXd& q : draws) sum += program.is_free(q);
  return 1e6 * (bench::now() - start) / static_cast<double>(draws.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// True when all programs give every answer alike; answers within 1e-6 m of touching are not judged.
bool agree(std::vector<Program>& programs, mmgrasp::CollisionChecker& checker, const Configurations& draws,
           std::size_t& unjudged) {
  bool same = true;
  for (const Eigen::VectorXd& q : draws) {
    const bool expected = programs[0].is_free(q);
    for (std::size_t p = 1; p < programs.size(); ++p) {
      if (programs[p].is_free(q) == expected) continue;
      const double distance = checker.distance(q).value;
      if (std::abs(distance) < 1e-6) {
        ++unjudged;
        continue;
      }
      std::fprintf(stderr, "%s says %s, mmgrasp the opposite; distance %.9f m\n", programs[p].who.c_str(),
                   expected ? "hit" : "free", distance);
      same = false;
    }
  }
  return same;
}

bool run(const bench::Arm& arm, int count, int rounds) {
  const mmgrasp::World world = bench::twenty_boxes(arm, 3);
  mmgrasp::CollisionChecker checker(arm.group, world);
  const Configurations draws = bench::planner_draws(checker, count, 5);
  bench::FclBaseline fcl_convex(arm.group, world, true), fcl_trees(arm.group, world, false);
  std::vector<Program> programs;
  programs.push_back({"mmgrasp", "defaults", [&](const Eigen::VectorXd& q) { return checker.is_free(q); }, {}, {}, {}});
  programs.push_back({"FCL, convex meshes as Convex",
                      "DynamicAABBTree manager for the scene, libccd, first contact only",
                      [&](const Eigen::VectorXd& q) { return fcl_convex.is_free(q); },
                      {},
                      {},
                      {}});
  programs.push_back({"FCL, meshes as BVH",
                      "DynamicAABBTree manager for the scene, OBBRSS, first contact only",
                      [&](const Eigen::VectorXd& q) { return fcl_trees.is_free(q); },
                      {},
                      {},
                      {}});
#ifdef MMGRASP_WITH_COAL
  bench::CoalBaseline coal(arm.group, world);
  programs.push_back({"coal",
                      "DynamicAABBTree manager for the scene, Convex or OBBRSS, first contact only",
                      [&](const Eigen::VectorXd& q) { return coal.is_free(q); },
                      {},
                      {},
                      {}});
#endif
  Configurations free, hit;
  for (const Eigen::VectorXd& q : draws) (checker.is_free(q) ? free : hit).push_back(q);
  std::size_t unjudged = 0, sum = 0;
  const bool same = agree(programs, checker, draws, unjudged);
  for (int round = 0; round < rounds; ++round) {
    for (Program& program : programs) {
      program.all.push_back(time_of(program, draws, sum));
      program.free.push_back(time_of(program, free, sum));
      program.hit.push_back(time_of(program, hit, sum));
    }
  }
  const double hits = static_cast<double>(hit.size()) / static_cast<double>(draws.size());
  for (Program& program : programs) {
    char more[256];
    std::snprintf(
        more, sizeof more,
        "\"hits\": %.3f, \"free us\": %.4g, \"colliding us\": %.4g, \"queries\": %zu, \"in the 1e-6 m band\": "
        "%zu, \"answers agree\": %s",
        hits, median(program.free), median(program.hit), draws.size(), unjudged, same ? "true" : "false");
    bench::print(
        {"free or not", arm.name + ", 20 boxes", program.who, "us", median(program.all), more, program.settings});
  }
  return same && sum > 0 && hits >= 0.05 && hits <= 0.5;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 11000, rounds = argc > 2 ? std::atoi(argv[2]) : 7;
  bool good = true;
  for (const bench::Arm& arm : bench::arms()) good = run(arm, count, rounds) && good;
  // coal comes with an OctoMap of its own beside FCL's: taking both down at the end would crash.
  std::fflush(stdout);
  std::_Exit(good ? 0 : 1);
}
