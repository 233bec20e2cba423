// Capability maps (P3 3.9.2): 2 x 2 x 2.6 m in voxels of 10 cm, 200 tool poses each: time to build, and how often a
// sampled pose is classed otherwise than by collision-aware inverse kinematics with 1000 restarts.
//
//   bench_capability [--case NAME] [--truth POSES] [--threads N]    default: every case, 20000 poses, all threads
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <sstream>

#include "core/report.hpp"
#include "mmgrasp/collision/collision_ik.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/reach/capability_map.hpp"
#include "support/mesh_robots.hpp"

using namespace mmgrasp;

namespace {

struct Case {
  std::string name;
  JointGroup arm;
  World world;
  CapabilityOptions options;
};

JointGroup fetchlike(const std::string& group) {
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/fetchlike";
  const Robot robot = Robot::load(folder + ".urdf", folder + ".srdf");
  // Holding the lift half-way, the gripper open.
  const JointGroup arm = robot.group(group);
  return arm.with_reference(robot.values({{"torso_lift_joint", 0.2}}));
}

/// A table of 0.75 m in front of the robot.
World table() {
  World world;
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(0.85, 0, 0.725);
  world.add("table top", Box{{0.8, 1.6, 0.05}}, T);
  return world;
}

std::vector<Case> cases() {
  CapabilityOptions forwards;
  forwards.approach = Eigen::Vector3d::UnitX();
  std::vector<Case> all{{"fetchlike arm", fetchlike("arm"), {}, forwards},
                        {"fetchlike arm, table", fetchlike("arm"), table(), forwards},
                        {"fetchlike arm and lift", fetchlike("arm_with_torso"), {}, forwards}};
  if (!std::filesystem::exists(MMGRASP_SHARED_DATA)) return all;
  CapabilityOptions low;
  low.lower = {-1, -1, -1};
  low.upper = {1, 1, 1.6};
  all.push_back({"Panda", testing_support::panda_arm().group, {}, low});
  all.push_back({"UR5", testing_support::ur5_arm().group, {}, low});
  all.push_back({"TIAGo arm and lift", testing_support::tiago_arm().group, {}, forwards});
  return all;
}

double processor_time() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Poses of the map drawn at random, judged by inverse kinematics with many restarts.
void judge(const Case& c, const CapabilityMap& map, int poses, int threads) {
  constexpr int kRestarts = 1000;
  IkOptions ik;
  ik.restarts = kRestarts;
  ik.time_limit = 3600;
  CheckerOptions checking;
  checking.padding = c.options.padding;
  const CollisionChecker checker(c.arm, c.world, checking);
  std::vector<CollisionChecker> checkers;
  for (int i = 0; i < resolve_threads(threads); ++i) checkers.push_back(checker.clone());
  const Eigen::VectorXd middle = 0.5 * (c.arm.sample_lower() + c.arm.sample_upper());
  std::vector<char> solved(poses), reached(solved.size());
  std::vector<double> times(solved.size());
  const double start = bench::now();
  parallel_for(solved.size(), threads, [&](std::size_t i, int worker) {
    Rng rng(7, i);
    const auto voxel = static_cast<std::int64_t>(rng.index(map.voxel_count()));
    const int pose = static_cast<int>(rng.index(c.options.poses));
    const Pose target = c.arm.T_world_root() * map.tool_pose(voxel, pose);
    IkOptions own = ik;
    own.seed = static_cast<unsigned>(i + 1);
    const double begun = bench::now();
    solved[i] = solve_collision_free_ik(checkers[worker], target, middle, own).outcome == Outcome::solved;
    times[i] = bench::now() - begun;
    reached[i] = map.classified(voxel, pose) == Rejection::none;
    if (std::getenv("MMGRASP_BENCH_DIFFERENCES") && solved[i] != reached[i])
      std::fprintf(stderr, "voxel %ld pose %d: %s, map says %s\n", static_cast<long>(voxel), pose,
                   solved[i] ? "solved" : "not solved", to_string(map.classified(voxel, pose)));
  });
  int missed = 0, more = 0, reachable = 0;
  double sum = 0;
  for (std::size_t i = 0; i < solved.size(); ++i) {
    missed += solved[i] && !reached[i];
    more += !solved[i] && reached[i];
    reachable += solved[i] || reached[i];
    sum += times[i];
  }
  std::ostringstream members;
  members << "\"poses\": " << poses << ", \"reachable\": " << reachable << ", \"missed by the map\": " << missed
          << ", \"missed by inverse kinematics\": " << more << ", \"seconds\": " << bench::now() - start
          << ", \"us a pose\": " << 1e6 * sum / poses;
  bench::print({"capability map, truth", c.name, "mmgrasp", "% classed otherwise", 100.0 * (missed + more) / poses,
                members.str(),
                std::to_string(poses) + " poses, IK with 1000 restarts, closed form included, and collision checks"});
}

void run(const Case& c, int poses, int threads) {
  CapabilityOptions options = c.options;
  options.threads = threads;
  const double start = bench::now(), processor = processor_time();
  const CapabilityMap map = CapabilityMap::build(c.arm, c.world, options);
  const double time = bench::now() - start, used = processor_time() - processor;
  std::ostringstream members;
  members << "\"poses\": " << map.classes().size() << ", \"reached\": " << map.reached()
          << ", \"maximum\": " << map.maximum() << ", \"processor_s\": " << used
          << ", \"us a pose and core\": " << 1e6 * used / static_cast<double>(map.classes().size())
          << ", \"refused\": \"" << map.rejections().summary() << "\"";
  bench::print({"capability map", c.name, "mmgrasp", "s", time, members.str(), "defaults, 200 poses a voxel"});
  if (poses > 0) judge(c, map, poses, threads);
}

}  // namespace

int main(int argc, char** argv) {
  std::string only;
  int poses = 20000, threads = 0;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (!std::strcmp(argv[i], "--case")) only = argv[i + 1];
    if (!std::strcmp(argv[i], "--truth")) poses = std::atoi(argv[i + 1]);
    if (!std::strcmp(argv[i], "--threads")) threads = std::atoi(argv[i + 1]);
  }
  for (const Case& c : cases())
    if (only.empty() || only == c.name) run(c, poses, threads);
}
