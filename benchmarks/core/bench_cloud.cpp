// Free or not against a point cloud of 300,000 points, links placed inside the timing: mmgrasp's voxels and FCL with
// OctoMap hold the same cells. Every answer is compared.

#include <fcl/geometry/octree/octree.h>
#include <octomap/OcTree.h>

#include <cmath>

#include "collision_case.hpp"
#include "fcl_baseline.hpp"
#include "mmgrasp/geometry/octree.hpp"
#include "report.hpp"

namespace {

constexpr double kResolution = 0.01;

// What a depth camera leaves of a cell: points on the faces of boxes, on a table and on a wall.
std::vector<Eigen::Vector3d> cloud(const bench::Arm& arm, int count) {
  using namespace mmgrasp;
  const World world = bench::twenty_boxes(arm, 3);
  Rng rng(9);
  std::vector<const WorldObject*> boxes;
  for (const auto& entry : world.objects()) boxes.push_back(&entry.second);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const int kind = i % 4;
    if (kind == 3) {
      points.emplace_back(-arm.reach - 0.1, rng.uniform(-1, 1), rng.uniform(arm.low, arm.high));
      continue;
    }
    if (kind == 2) {
      const double angle = rng.uniform(-M_PI, M_PI), r = std::sqrt(rng.uniform(0.16, 1.0));
      points.emplace_back(r * std::cos(angle), r * std::sin(angle), arm.low - 0.05);
      continue;
    }
    const WorldObject& object = *boxes[static_cast<std::size_t>(rng.uniform(0, 1) * 20) % 20];
    const Eigen::Vector3d half = 0.5 * std::get<Box>(object.shapes[0].shape).size;
    Eigen::Vector3d p;
    for (int k = 0; k < 3; ++k) p[k] = rng.uniform(-half[k], half[k]);
    const int axis = static_cast<int>(rng.uniform(0, 3)) % 3;
    p[axis] = rng.uniform(0, 1) < 0.5 ? -half[axis] : half[axis];
    points.push_back(object.T_world_object * p);
  }
  return points;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

bool run(const bench::Arm& arm, int count, int rounds) {
  const std::vector<Eigen::Vector3d> points = cloud(arm, 300000);
  double start = bench::now();
  mmgrasp::World world;
  const mmgrasp::Voxels voxels = mmgrasp::voxelize(points, kResolution);
  world.add("cloud", voxels, mmgrasp::Pose::Identity());
  mmgrasp::CollisionChecker checker(arm.group, world);
  const double our_build = bench::now() - start;

  start = bench::now();
  auto tree = std::make_shared<octomap::OcTree>(kResolution);
  for (const Eigen::Vector3d& p : points) tree->updateNode(p[0], p[1], p[2], true, true);
  tree->updateInnerOccupancy();
  tree->prune();
  bench::FclBaseline fcl(arm.group, mmgrasp::World(), false);
  fcl.add(std::make_shared<fcl::OcTreed>(tree));
  const double their_build = bench::now() - start;

  const std::vector<Eigen::VectorXd> draws = bench::planner_draws(checker, count, 5);
  std::vector<Eigen::VectorXd> free, hit;
  std::size_t unjudged = 0, sum = 0;
  bool same = true;
  for (const Eigen::VectorXd& q : draws) {
    const bool answer = checker.is_free(q);
    (answer ? free : hit).push_back(q);
    if (fcl.is_free(q) == answer) continue;
    if (std::abs(checker.distance(q).value) < 1e-6) {
      ++unjudged;
      continue;
    }
    std::fprintf(stderr, "FCL says %s, mmgrasp the opposite; distance %.9f\n", answer ? "hit" : "free",
                 checker.distance(q).value);
    same = false;
  }
  std::vector<double> times[2][3];
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Eigen::VectorXd>* sets[3] = {&draws, &free, &hit};
    for (int k = 0; k < 3; ++k) {
      for (int p = 0; p < 2; ++p) {
        start = bench::now();
        for (const Eigen::VectorXd& q : *sets[k]) sum += p == 0 ? checker.is_free(q) : fcl.is_free(q);
        times[p][k].push_back(1e6 * (bench::now() - start) / static_cast<double>(sets[k]->size()));
      }
    }
  }
  const double hits = static_cast<double>(hit.size()) / static_cast<double>(draws.size());
  for (int p = 0; p < 2; ++p) {
    char more[320];
    std::snprintf(
        more, sizeof more,
        "\"hits\": %.3f, \"free us\": %.4g, \"colliding us\": %.4g, \"queries\": %zu, \"cells\": %zu, \"build "
        "s\": %.3f, \"in the 1e-6 m band\": %zu, \"answers agree\": %s",
        hits, median(times[p][1]), median(times[p][2]), draws.size(), voxels.centres->size(),
        p == 0 ? our_build : their_build, unjudged, same ? "true" : "false");
    bench::print(
        {"point cloud", arm.name + ", 300,000 points", p == 0 ? "mmgrasp" : "FCL and OctoMap", "us",
         median(times[p][0]), more,
         p == 0 ? "voxelize, 0.01 m" : "OcTree of 0.01 m, pruned, in a DynamicAABBTree manager; meshes as BVH"});
  }
  return same && sum > 0 && hits >= 0.05 && hits <= 0.5;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1650, rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  bool good = true;
  for (const bench::Arm& arm : bench::arms()) good = run(arm, count, rounds) && good;
  return good ? 0 : 1;
}
