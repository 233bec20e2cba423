#include "mmgrasp/verify/plan_check.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "verify/compare_robots.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify {
namespace {

using namespace detail;

/// Null, with a fault, when the robot cannot be read.
std::shared_ptr<const RobotModel> model_of(const PlanToCheck& plan, Faults& faults) {
  try {
    auto robot = std::make_shared<RobotModel>(read_robot(plan.robot));
    if (!plan.planned_robot.urdfs.empty()) compare_robots(*robot, read_robot(plan.planned_robot, false), faults);
    return robot;
  } catch (const Error& error) {
    faults.push_back({"robot-unreadable", "robot", error.what()});
    return nullptr;
  }
}

/// The ground, with every link that the arm cannot bring nearer to it allowed to touch it.
void add_floor(double height, Stage& stage) {
  stage.bodies.push_back(place_body(kFloor, {{Plane{Eigen::Vector3d::UnitZ(), height}}}, Pose::Identity()));
  const std::vector<bool> moved = links_of_the_arm(*stage.robot, stage.setup);
  for (std::size_t link = 0; link < moved.size(); ++link) {
    if (moved[link]) continue;
    const std::string& name = stage.robot->links[link].name;
    stage.allowed.insert({{name, kFloor}, {kFloor, name}});
  }
}

std::shared_ptr<const Stage> build_stage(const PlanToCheck& plan, std::shared_ptr<const RobotModel> robot,
                                         const ArmSetup& setup, const std::vector<int>& finger_links) {
  auto stage = std::make_shared<Stage>(make_stage(std::move(robot), setup, finger_links, plan.allowed_collisions));
  const auto add = [&](const CheckedBody& body) {
    stage->bodies.push_back(place_body(body.name, body.shapes, body.T_world_body));
  };
  if (std::isfinite(plan.floor)) add_floor(plan.floor, *stage);
  for (const CheckedBody& obstacle : plan.obstacles) add(obstacle);
  stage->first_part = stage->bodies.size();
  for (const CheckedPart& part : plan.parts) add(part.body);
  return stage;
}

bool bodies_touch(const PlacedBody& a, const PlacedBody& b, const Eigen::Vector3d& shift) {
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    mmgrasp::detail::throw_if_interrupted();
    const Pose T_a = Eigen::Translation3d(shift) * a.T_world_shape[i];
    const Bounds bounds = bounds_at(a.solids[i], T_a);
    for (std::size_t j = 0; j < b.solids.size(); ++j) {
      if (bounds.intersects(b.bounds[j]) && touches(a.solids[i], T_a, b.solids[j], b.T_world_shape[j])) return true;
    }
  }
  return false;
}

/// Whether no small move sets them apart. Works for any shapes, where a depth of penetration is not defined for all.
bool bodies_overlap(const PlacedBody& a, const PlacedBody& b) {
  constexpr double kDepth = 1e-4;  // [m]
  if (!a.total.intersects(b.total) || !bodies_touch(a, b, Eigen::Vector3d::Zero())) return false;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Eigen::Vector3d way(x, y, z);
        if (way.squaredNorm() > 0 && !bodies_touch(a, b, kDepth * way.normalized())) return false;
      }
    }
  }
  return true;
}

/// Pairs of bodies that overlap, the second at least `first`.
std::vector<std::pair<std::size_t, std::size_t>> overlapping(const std::vector<PlacedBody>& bodies, std::size_t first) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = first; j < bodies.size(); ++j) {
    mmgrasp::detail::throw_if_interrupted();
    for (std::size_t i = 0; i < j; ++i) {
      if (bodies_overlap(bodies[i], bodies[j])) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

/// Parts stand where nothing else is, and trays not in the ground.
void check_scene_at_rest(const PlanToCheck& plan, const Stage& stage, Faults& faults) {
  const auto is_tray = [&](const std::string& body) {
    return std::any_of(plan.trays.begin(), plan.trays.end(), [&](const auto& tray) { return body == "tray " + tray; });
  };
  for (std::size_t i = 1; std::isfinite(plan.floor) && i < stage.first_part; ++i) {
    if (is_tray(stage.bodies[i].name) && bodies_overlap(stage.bodies[0], stage.bodies[i]))
      faults.push_back({"tray-overlap", stage.bodies[i].name, "reaches under the floor by more than 1e-4 m"});
  }
  for (const auto& [other, part] : overlapping(stage.bodies, stage.first_part)) {
    faults.push_back({"part-overlap", "part '" + stage.bodies[part].name + "'",
                      "overlaps '" + stage.bodies[other].name + "' by more than 1e-4 m"});
  }
}

void check_all(const PlanToCheck& plan, const PlanCheckOptions& options, const Monitor& monitor,
               PlanCheckResult& result) {
  ArmSetup setup;
  std::vector<int> finger_links;
  const std::shared_ptr<const RobotModel> robot = model_of(plan, result.faults);
  if (!robot || !check_structure(plan, *robot, result.faults, setup, finger_links)) return;

  Context context{plan, options, monitor, build_stage(plan, robot, setup, finger_links), {}, {}, {}};
  for (std::size_t i = 0; i < plan.parts.size(); ++i) context.part_index[plan.parts[i].body.name] = static_cast<int>(i);
  check_scene_at_rest(plan, *context.stage, result.faults);
  check_pick_list(context, result.faults);
  check_payload(plan, result.faults);
  if (plan.suction.cups.empty()) {
    check_grasp_openings(context, result.faults);
  } else {
    check_seals(plan, result.faults);
  }
  check_stops(context, result);
  check_route(context, result.faults, result.configurations_checked);
  check_arm_motions(context, result.faults, result.configurations_checked);
  check_drive_by(context, result.faults, result.configurations_checked);
  check_robustness(context, result.faults, result.rates, result.configurations_checked);
  check_arrivals(context, result.faults, result.configurations_checked);
  check_regions(context, result.faults, result.configurations_checked);
  result.regions_searched = options.region_samples > 0 && !plan.padded;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> overlapping_bodies(const std::vector<CheckedBody>& bodies,
                                                                    const Monitor& monitor) {
  std::vector<PlacedBody> placed;
  for (const CheckedBody& body : bodies) {
    monitor.report("bodies that overlap", static_cast<double>(placed.size()) / static_cast<double>(bodies.size()));
    placed.push_back(place_body(body.name, body.shapes, body.T_world_body));
  }
  return overlapping(placed, 0);
}

void PlanCheckOptions::check() const {
  require(joint_step >= kLeastStep && joint_step <= 0.1, "joint_step", joint_step, "must be in [1e-9, 0.1] [rad or m]");
  require(base_step >= kLeastStep && base_step <= 0.1, "base_step", base_step, "must be in [1e-9, 0.1] [m]");
  require(position_tolerance > 0 && position_tolerance <= 0.01, "position_tolerance", position_tolerance,
          "must be in (0, 0.01] [m]");
  require(rotation_tolerance > 0 && rotation_tolerance <= 0.1, "rotation_tolerance", rotation_tolerance,
          "must be in (0, 0.1] [rad]");
  require(samples > 0, "samples", samples, "must be positive");
  require(required_rate > 0 && required_rate <= 1, "required_rate", required_rate, "must be in (0, 1]");
  require(samples <= 1000000, "samples", samples, "must be at most 1000000");
  require(region_samples >= 0 && region_samples <= 100000, "region_samples", region_samples, "must be in [0, 100000]");
  resolve_threads(threads);  // says what is wrong
}

PlanCheckResult check_plan(const PlanToCheck& plan, const PlanCheckOptions& options, const Monitor& monitor) {
  options.check();
  PlanCheckResult result;
  const mmgrasp::detail::InterruptionScope scope(monitor.stop);
  try {
    check_all(plan, options, monitor, result);
  } catch (const mmgrasp::detail::Interrupted&) {  // said below
  }
  // An answer that was not finished must not look like a good one.
  if (monitor.stopped()) result.faults.push_back({"stopped", "check", "was ended before everything was checked"});
  return result;
}

}  // namespace mmgrasp::verify
