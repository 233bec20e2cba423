#include "mmgrasp/verify/plan_check.hpp"

#include "mmgrasp/core/error.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify {
namespace {

std::shared_ptr<const Stage> build_stage(const PlanToCheck& plan, const ArmSetup& setup,
                                         const std::vector<int>& finger_links) {
  auto stage = std::make_shared<Stage>(make_stage(plan.robot, setup, finger_links));
  const auto add = [&](const CheckedBody& body) {
    stage->bodies.push_back(place_body(body.name, body.shapes, body.T_world_body));
  };
  for (const CheckedBody& obstacle : plan.obstacles) add(obstacle);
  stage->first_part = stage->bodies.size();
  for (const CheckedPart& part : plan.parts) add(part.body);
  return stage;
}

}  // namespace

void PlanCheckOptions::check() const {
  require(joint_step > 0 && joint_step < 1e3, "joint_step", joint_step, "must be positive");
  require(base_step > 0 && base_step < 1e3, "base_step", base_step, "must be positive");
  require(position_tolerance > 0, "position_tolerance", position_tolerance, "must be positive");
  require(rotation_tolerance > 0, "rotation_tolerance", rotation_tolerance, "must be positive");
  require(samples > 0, "samples", samples, "must be positive");
  require(required_rate > 0 && required_rate <= 1, "required_rate", required_rate, "must be in (0, 1]");
  require(threads >= 0, "threads", threads, "must be 0 (all) or positive");
}

PlanCheckResult check_plan(const PlanToCheck& plan, const PlanCheckOptions& options, const Monitor& monitor) {
  options.check();
  PlanCheckResult result;
  ArmSetup setup;
  std::vector<int> finger_links;
  if (!check_structure(plan, result.faults, setup, finger_links)) return result;

  Context context{plan, options, monitor, build_stage(plan, setup, finger_links), {}, {}, {}};
  for (std::size_t i = 0; i < plan.parts.size(); ++i) context.part_index[plan.parts[i].body.name] = static_cast<int>(i);
  check_pick_list(context, result.faults);
  check_stops(context, result.faults, result.minimal_stops);
  check_route(context, result.faults, result.configurations_checked);
  check_arm_motions(context, result.faults, result.configurations_checked);
  check_robustness(context, result.faults, result.rates, result.configurations_checked);
  // An answer that was not finished must not look like a good one.
  if (monitor.stopped()) result.faults.push_back({"stopped", "check", "was ended before everything was checked"});
  return result;
}

}  // namespace mmgrasp::verify
