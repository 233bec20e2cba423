// Smallest signed distance against 20 boxes and between the links, links placed inside the timing: mmgrasp without and
// with the gradient, FCL and coal in one process on the same configurations, taking turns. Values are compared.

#include <cmath>
#include <cstdlib>
#include <functional>

#include "coal_distance_baseline.hpp"
#include "collision_case.hpp"
#include "fcl_distance_baseline.hpp"
#include "report.hpp"

namespace {

using Configurations = std::vector<Eigen::VectorXd>;

struct Program {
  std::string who, settings;
  std::function<double(const Eigen::VectorXd&)> distance;
  std::vector<double> all, free, hit;  ///< Time per query of each round [us].
  double worst = 0;                    ///< Largest difference from ours on free configurations [m].
};

double time_of(Program& program, const Configurations& draws, double& sum) {
  if (draws.empty()) return 0;
  const double start = bench::now();
  for (const Eigen::VectorXd& q : draws) sum += program.distance(q);
  return 1e6 * (bench::now() - start) / static_cast<double>(draws.size());
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

// With `self` the links are measured against each other as well; on many arms neighbours in the chain are then the
// nearest pair nearly always, so both are reported.
bool run(const bench::Arm& arm, bool self, int count, int rounds) {
  // Nearer than for yes or no, so that enough of them are hit.
  bench::Arm near = arm;
  near.reach = 0.75 * arm.reach;
  near.high = std::min(arm.high, 1.3);
  const mmgrasp::World world = bench::twenty_boxes(near, 3);
  mmgrasp::CheckerOptions options;
  options.check_self = self;
  mmgrasp::CollisionChecker checker(arm.group, world, options);
  const Configurations draws = bench::planner_draws(checker, count, 5);
  bench::FclDistanceBaseline fcl_convex(arm.group, world, true, self), fcl_trees(arm.group, world, false, self);
  std::vector<Program> programs;
  const auto add = [&](const std::string& who, const std::string& settings, auto distance) {
    programs.push_back({who, settings, distance, {}, {}, {}, 0});
  };
  add("mmgrasp", "value and witness points", [&](const Eigen::VectorXd& q) { return checker.distance(q).value; });
  add("mmgrasp with gradient", "value, witness points and gradient", [&](const Eigen::VectorXd& q) {
    const mmgrasp::DistanceResult result = checker.distance_and_gradient(q);
    return result.value + 0 * result.gradient.sum();
  });
  add("FCL, convex meshes as Convex",
      "DynamicAABBTree manager for the scene, running minimum, tolerance 1e-9, value only",
      [&](const Eigen::VectorXd& q) { return fcl_convex.distance(q); });
  add("FCL, meshes as BVH",
      "DynamicAABBTree manager for the scene, OBBRSS, running minimum, tolerance 1e-9, value only",
      [&](const Eigen::VectorXd& q) { return fcl_trees.distance(q); });
#ifdef MMGRASP_WITH_COAL
  bench::CoalDistanceBaseline coal(arm.group, world, self);
  add("coal", "DynamicAABBTree manager for the scene, Convex or OBBRSS, running minimum, value only",
      [&](const Eigen::VectorXd& q) { return coal.distance(q); });
#endif
  Configurations free, hit;
  for (const Eigen::VectorXd& q : draws) (checker.distance(q).value > 0 ? free : hit).push_back(q);
  for (const Eigen::VectorXd& q : free) {
    const double ours = checker.distance(q).value;
    for (Program& program : programs) program.worst = std::max(program.worst, std::abs(program.distance(q) - ours));
  }
  double sum = 0;
  for (int round = 0; round < rounds; ++round) {
    for (Program& program : programs) {
      program.all.push_back(time_of(program, draws, sum));
      program.free.push_back(time_of(program, free, sum));
      program.hit.push_back(time_of(program, hit, sum));
    }
  }
  bool same = true;
  const double hits = static_cast<double>(hit.size()) / static_cast<double>(draws.size());
  for (Program& program : programs) {
    char more[256];
    std::snprintf(more, sizeof more,
                  "\"hits\": %.3f, \"free us\": %.4g, \"colliding us\": %.4g, \"queries\": %zu, "
                  "\"largest difference m\": %.2g",
                  hits, median(program.free), median(program.hit), draws.size(), program.worst);
    bench::print({"signed distance", arm.name + (self ? ", 20 boxes and itself" : ", 20 boxes"), program.who, "us",
                  median(program.all), more, program.settings});
    same = same && program.worst < 1e-6;
  }
  return same && std::isfinite(sum);
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 550, rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  bool good = true;
  for (const bench::Arm& arm : bench::arms()) {
    for (const bool self : {false, true}) good = run(arm, self, count, rounds) && good;
  }
  return good ? 0 : 1;
}
