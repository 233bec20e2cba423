// Builds a reachability database in files, opens it and asks it:
//   bench_reach_build [fetchlike | panda] [samples] [folder]
// The reference (P1 3.2.1: 92 million poses in about 2 million voxels) is fetchlike with 119000000 samples.

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/report.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "reach_case.hpp"

namespace {

using namespace mmgrasp;
namespace fs = std::filesystem;

void line(const std::string& on, const std::string& who, const std::string& unit, double value,
          const std::string& more = "") {
  bench::print({"reach build", on, who, unit, value, more, "max_per_cell 1000"});
}

void run(const bench::ReachCase& robot, std::int64_t samples, const fs::path& folder) {
  const std::string on = robot.name + ", " + std::to_string(samples) + " samples";
  ReachOptions options;
  options.samples = samples;
  options.max_per_cell = 1000;
  const std::string path = (folder / ("bench_" + robot.name + ".reach")).string();
  const double before = bench::now(), used = bench::processor_time();
  const ReachDatabase built = ReachDatabase::build_to(path, robot.arm, options);
  const double wall = bench::now() - before, processor = bench::processor_time() - used;
  const double memory = bench::peak_memory();
  double bytes = 0;
  for (const auto& entry : fs::directory_iterator(path)) bytes += static_cast<double>(entry.file_size());
  const auto size = static_cast<double>(built.size());
  char more[400];
  std::snprintf(more, sizeof(more),
                "\"stored\": %.0f, \"cells\": %lld, \"wall_s\": %.2f, \"processor_s\": %.2f, "
                "\"processor_us_a_pose\": %.3f, \"peak_GiB\": %.2f, \"bytes_a_pose\": %.2f",
                size, static_cast<long long>(built.cell_count()), wall, processor, 1e6 * processor / size, memory,
                bytes / size);
  line(on, "mmgrasp", "million poses/s", 1e-6 * size / wall, more);

  const double opening = bench::now();
  const ReachDatabase database = ReachDatabase::load(path, robot.arm);
  line(on, "mmgrasp, open", "s", bench::now() - opening);

  Rng rng(7);
  Poses poses;
  for (int i = 0; i < 20000; ++i)
    poses.push_back(database.tool_pose(static_cast<std::int64_t>(rng.index(database.size()))));
  std::int64_t found = 0;
  // Processor time of the quickest of some rounds: warm, and not disturbed by others on the machine.
  const auto per_pose = [&](const auto& ask) {
    double best = 1e9;
    for (int round = 0; round < 7; ++round) {
      const double begun = bench::processor_time();
      for (const Pose& T : poses) ask(T);
      best = std::min(best, bench::processor_time() - begun);
    }
    return 1e6 * best / static_cast<double>(poses.size());
  };
  line(on, "mmgrasp, voxel", "us", per_pose([&](const Pose& T) {
         const auto [begin, end] = database.voxel(T);
         found += end - begin;
       }));
  line(on, "mmgrasp, voxel's configurations", "us", per_pose([&](const Pose& T) { found += database.cell(T).cols(); }));
  Eigen::MatrixXd out;
  line(on, "mmgrasp, 8 nearest", "us", per_pose([&](const Pose& T) { found += database.nearest(T, 8, out); }));
  if (found == 0) std::exit(1);
  fs::remove_all(path);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string only = argc > 1 ? argv[1] : "";
  const std::int64_t samples = argc > 2 ? std::atoll(argv[2]) : 2'000'000;
  const std::string folder = argc > 3 ? argv[3] : fs::temp_directory_path().string();
  for (const bench::ReachCase& robot : bench::reach_cases(only)) run(robot, samples, folder);
}
