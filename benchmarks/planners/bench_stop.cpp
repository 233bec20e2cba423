// How long calls run on after their cancel token was set: a Panda whose goal lies behind walls that it cannot pass,
// every planner by name, stopped at times drawn from 20 ms on. Prints one JSON line per call, value: the slowest.
//
//     bench_stop [runs of each, default 20] [latest stop in seconds, default 1] [name of the only one]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/collision_case.hpp"
#include "core/report.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"

namespace {

using namespace mmgrasp;

constexpr double kEarliest = 0.02;  // [s]
constexpr double kGoal = 100;       // [ms]
constexpr int kEndless = 2'000'000'000;
constexpr int kGrasps = 500;
constexpr double kTurn = 1.3;  // To either side of the wall [rad].

/// Runs a call with a monitor; says whether the cancel token ended it.
using Call = std::function<bool(const Monitor&)>;

Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

/// A wall in the plane y = 0 that leaves room for the shoulder alone.
World walled() {
  World world;
  world.add("floor", Box{{3, 3, 0.1}}, at(0, 0, -0.1));
  world.add("front", Box{{1.4, 0.02, 2}}, at(0.85, 0, 0.95));
  world.add("back", Box{{1.4, 0.02, 2}}, at(-0.9, 0, 0.95));
  world.add("above", Box{{0.4, 0.02, 1.4}}, at(-0.02, 0, 1.3));
  return world;
}

Eigen::VectorXd beside(double turn) {
  Eigen::VectorXd q(7);
  q << turn, 0.6, 0, -1.8, 0, 2.4, 0.7;
  return q;
}

Call motion(const JointGroup& arm, const std::string& planner) {
  return [&arm, planner](const Monitor& monitor) {
    CollisionChecker checker(arm, walled());
    MotionOptions options;
    options.planner = planner;
    options.max_iterations = kEndless;
    options.time_limit = 1e6;
    return plan_motion(checker, beside(kTurn), {beside(-kTurn)}, options, monitor).outcome == Outcome::stopped;
  };
}

ManipulationProblem transfer_problem(const JointGroup& arm) {
  LinkShape bar;
  bar.shape = Box{{0.3, 0.03, 0.03}};
  ManipulationProblem problem{arm, walled(), {bar}, at(0, 0.5, 0.3), at(0, -0.5, 0.3)};
  Rng rng(1);
  for (int i = 0; i < kGrasps; ++i) {
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
    const Eigen::Vector3d z = Eigen::AngleAxisd(rng.uniform(-0.5, 0.5), x) * Eigen::Vector3d(0, 0, -1);
    Pose T = Pose::Identity();
    T.linear() << x, z.cross(x), z;
    T.linear() = T.linear() * Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = rng.uniform(-0.14, 0.14) * x - 0.12 * z;
    problem.grasps.push_back({T, 0, 0});
  }
  return problem;
}

Call transfer(const ManipulationProblem& problem, const std::string& planner) {
  return [&problem, planner](const Monitor& monitor) {
    ManipulationOptions options;
    options.planner = planner;
    options.time_limit = 1e6;
    options.prm.max_vertices = 10'000'000;  // The roadmap is made denser until the end.
    options.rrt.max_iterations = 10'000'000;
    return plan_manipulation(problem, options, nullptr, monitor).outcome == Outcome::stopped;
  };
}

/// Across the wall in steps of a tenth of a micrometre.
Call cartesian_path(const JointGroup& arm) {
  return [&arm](const Monitor& monitor) {
    CollisionChecker checker(arm, walled());
    CartesianOptions options;
    options.line.position_step = 1e-7;
    const Pose from = arm.fk(beside(kTurn));
    Pose to = from;
    to.translation().y() = -to.translation().y();
    return plan_cartesian(checker, {from, to}, std::nullopt, options, monitor).outcome == Outcome::stopped;
  };
}

/// A path of 2,000 waypoints, with jerk limits.
Call timing(const JointGroup& arm) {
  JointPath path{{beside(kTurn)}};
  Rng rng(1);
  for (int i = 0; i < 2000; ++i)
    path.waypoints.push_back(path.waypoints.back() +
                             rng.uniform(Eigen::VectorXd::Constant(7, -0.1), Eigen::VectorXd::Constant(7, 0.1)));
  const Eigen::VectorXd limits = Eigen::VectorXd::Ones(arm.size());
  TimingOptions options;
  options.jerk_limits = 10 * limits;
  return [=](const Monitor& monitor) {
    return time_parameterize(path, limits, limits, options, {}, monitor).times.empty();
  };
}

struct Settings {
  int runs = 20;
  double latest = 1;  // [s]
  std::string only;   // Empty: all.
};

void measure(const std::string& name, const Call& call, const Settings& given) {
  if (!given.only.empty() && name != given.only) return;
  Rng rng(1);
  std::vector<double> late;
  int stopped = 0;
  for (int run = 0; run < given.runs; ++run) {
    Monitor monitor;
    double set = 0;
    std::thread stopper([&, wait = rng.uniform(kEarliest, given.latest)] {
      std::this_thread::sleep_for(std::chrono::duration<double>(wait));
      set = bench::now();
      monitor.stop.stop();
    });
    stopped += call(monitor) ? 1 : 0;
    const double returned = bench::now();
    stopper.join();
    late.push_back(1e3 * std::max(0.0, returned - set));
  }
  std::sort(late.begin(), late.end());
  char more[160], settings[80];
  std::snprintf(settings, sizeof settings, "stopped after %.2g to %.2g s", kEarliest, given.latest);
  std::snprintf(more, sizeof more, "\"median\": %.3g, \"stopped\": %d, \"runs\": %d, \"goal\": %.0f",
                late[late.size() / 2], stopped, given.runs, kGoal);
  bench::print({"cancel token", "Panda between walls", name, "ms", late.back(), more, settings});
}

}  // namespace

int main(int argc, char** argv) {
  Settings given;
  if (argc > 1) given.runs = std::max(1, std::atoi(argv[1]));
  if (argc > 2) given.latest = std::max(kEarliest, std::atof(argv[2]));
  if (argc > 3) given.only = argv[3];
  const JointGroup arm = bench::arms().front().group;
  CollisionChecker checker(arm, walled());
  if (!checker.is_free(beside(kTurn)) || !checker.is_free(beside(-kTurn))) throw Error("start and goal must be free");
  for (const std::string& planner : planner_names()) measure(planner, motion(arm, planner), given);
  const ManipulationProblem problem = transfer_problem(arm);
  for (const std::string& planner : manipulation_planner_names()) measure(planner, transfer(problem, planner), given);
  measure("plan_cartesian", cartesian_path(arm), given);
  measure("time_parameterize", timing(arm), given);
}
