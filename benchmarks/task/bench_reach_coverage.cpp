// How often a database knows an answer, as samples grow (P1's lemmas 1 and 2 as a curve), on random reachable poses:
// in the pose's own voxel, among its neighbours, after exact refinement. And a map of the kind Reuleaux makes, inverse
// kinematics solved for the pose in the middle of each voxel, beside a build that covers as many of the same voxels.
//   bench_reach_coverage [fetchlike | panda] [most samples] [poses]

#include <cmath>
#include <cstdlib>

#include "core/report.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/reach/reach_solve.hpp"
#include "reach_case.hpp"

namespace {

using namespace mmgrasp;

CollisionChecker self_checker(const JointGroup& arm) {
  CheckerOptions options;
  options.check_scene = false;
  return CollisionChecker(arm, World{}, options);
}

Poses reachable_poses(const JointGroup& arm, int count) {
  CollisionChecker checker = self_checker(arm);
  Rng rng(2026);
  Poses poses;
  while (static_cast<int>(poses.size()) < count) {
    const Eigen::VectorXd q = rng.uniform(arm.sample_lower(), arm.sample_upper());
    if (checker.is_free(q)) poses.push_back(arm.fk(q));
  }
  return poses;
}

void coverage(const bench::ReachCase& robot, std::int64_t samples, int count) {
  const Poses poses = reachable_poses(robot.arm, count);
  ReachOptions options;
  options.samples = samples;
  options.max_per_cell = 1000;
  options.min_manipulability = 0;
  const double start = bench::processor_time();
  const ReachDatabase database = ReachDatabase::build(robot.arm, options);
  const double built = bench::processor_time() - start;
  CollisionChecker checker = self_checker(robot.arm);
  int voxel = 0, near = 0, exact = 0;
  Eigen::MatrixXd out;
  ReachSolveOptions solving;
  solving.count = 1;
  double solve_time = 0;
  for (const Pose& T : poses) {
    const auto [begin, end] = database.voxel(T);
    voxel += end > begin;
    near += database.nearest(T, 1, out) > 0;
    const double before = bench::now();
    exact += !solve_reach(database, robot.arm, T, solving, &checker).empty();
    solve_time += bench::now() - before;
  }
  const double n = static_cast<double>(poses.size());
  char more[300];
  std::snprintf(more, sizeof(more),
                "\"stored\": %lld, \"cells\": %lld, \"in_voxel\": %.4f, \"near\": %.4f, \"exact\": %.4f, "
                "\"build_processor_s\": %.3f, \"solve_us\": %.1f",
                static_cast<long long>(database.size()), static_cast<long long>(database.cell_count()), voxel / n,
                near / n, exact / n, built, 1e6 * solve_time / n);
  bench::print({"reach coverage", robot.name, "mmgrasp", "samples", static_cast<double>(samples), more,
                std::to_string(samples) + " samples, " + std::to_string(count) + " poses"});
}

/// Poses in the middle of voxels, as Reuleaux tries them: positions on the grid, rotations evenly over a sphere and its
/// rolls. Here they are drawn at random among all voxels of the reach, so that a part stands for the whole.
void reuleaux(const bench::ReachCase& robot, std::int64_t samples) {
  ReachOptions options;
  options.samples = samples;
  options.max_per_cell = 1;
  options.min_manipulability = 0;
  const ReachDatabase database = ReachDatabase::build(robot.arm, options);
  CollisionChecker checker = self_checker(robot.arm);
  const auto valid = [&](const Eigen::VectorXd& q) { return checker.rejection(q); };
  Rng rng(9);
  IkOptions ik;
  ik.restarts = 20;
  const Eigen::AlignedBox3d box = database.bounds();
  const double edge = options.position_cell;
  int tried = 0, solved = 0, covered = 0;
  double ik_time = 0;
  const Eigen::VectorXd seed = 0.5 * (robot.arm.sample_lower() + robot.arm.sample_upper());
  for (; tried < 2000; ++tried) {
    Pose T = Pose::Identity();
    T.linear() = rng.rotation().toRotationMatrix();
    for (int i = 0; i < 3; ++i)
      T.translation()[i] = edge * (std::floor(rng.uniform(box.min()[i], box.max()[i]) / edge) + 0.5);
    const double before = bench::processor_time();
    const bool found = solve_ik(robot.arm, T, seed, ik, valid).outcome == Outcome::solved;
    ik_time += bench::processor_time() - before;
    solved += found;
    covered += found && database.cell(T).cols() > 0;
  }
  // All voxels of the box: how long inverse kinematics would take, against the build.
  double voxels = 4 * 3.14159265358979323846 * 2 * 3.14159265358979323846 / std::pow(options.rotation_cell, 3);
  for (int i = 0; i < 3; ++i) voxels *= std::ceil((box.max()[i] - box.min()[i]) / edge);
  const double start = bench::processor_time();
  ReachDatabase::build(robot.arm, options);
  const double built = bench::processor_time() - start;
  char more[300];
  std::snprintf(more, sizeof(more),
                "\"voxels\": %.0f, \"ik_us\": %.1f, \"ik_map_s\": %.1f, \"build_s\": %.1f, \"solved\": %.4f, "
                "\"covered_of_solved\": %.4f",
                voxels, 1e6 * ik_time / tried, voxels * ik_time / tried, built, static_cast<double>(solved) / tried,
                static_cast<double>(covered) / std::max(solved, 1));
  bench::print({"reach map by IK", robot.name, "IK per voxel / build", "ratio", voxels * ik_time / tried / built, more,
                "samples " + std::to_string(samples)});
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  const std::int64_t most = argc > 2 ? std::atoll(argv[2]) : 16'384'000;
  const int count = argc > 3 ? std::atoi(argv[3]) : 10'000;
  for (const bench::ReachCase& robot : bench::reach_cases(only)) {
    for (std::int64_t samples = 16'000; samples <= most; samples *= 4) coverage(robot, samples, count);
    reuleaux(robot, most);
  }
}
