// plan_pick() of a part-supply problem: the part as an object of the scene, bin or unload region as its place.
#include "task/pick/part_pick.hpp"

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/pick.hpp"
#include "task/pick/release.hpp"
#include "task/pick/search_pick.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

void check_part(const PartSupplyProblem& problem, PartRef part, const std::string& tray_name,
                const std::string& part_name) {
  const auto check = [](int index, std::size_t count, const std::string& name) {
    require(index >= 0 && index < static_cast<int>(count), name, std::to_string(index),
            "must be in [0, " + std::to_string(count) + ")");
  };
  check(part.tray, problem.trays.size(), tray_name);
  check(part.part, detail::tray_of(problem, part.tray).parts.size(), part_name);
}

}  // namespace

namespace detail {

PickProblem pick_of(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, PartRef ref,
                    const std::vector<PartRef>& remaining) {
  const Pose T_world_root = pose_from_planar(base_pose);
  const Part& part = part_of(problem, ref);
  const PartSupplyOptions& options = problem.options;
  const unsigned seed =
      options.seed * 1000003u + static_cast<unsigned>(ref.tray) * 1009u + static_cast<unsigned>(ref.part);
  PickProblem pick{
      problem.arm.at(T_world_root),
      problem.gripper,
      world_with_parts(problem, remaining),
      part.name,
      part.grasps,
      problem.home,
      places_over(problem.unload_region.value_or(top_of_bin(problem.place_region, T_world_root)), part),
      {options.approach_distance, options.lift_height, options.motion_time_limit, ik_seeds_of_a_grasp(problem), seed},
      part.mass};
  if (problem.unload_region) pick.T_world_root_at_place = pose_from_planar(problem.goal);
  return pick;
}

Pick pick_part(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
               PartRef part, const std::vector<PartRef>& remaining, const Monitor& monitor, const HeldDrive& drive) {
  std::function<bool(int)> carries;
  if (drive) carries = [&](int grasp) { return drive(base_pose, part, grasp, remaining); };
  Pick pick = search_pick(pick_of(problem, base_pose, part, remaining), database, monitor, true, carries);
  pick.part = part;
  return pick;
}

}  // namespace detail

Pick plan_pick(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
               PartRef part, const std::vector<PartRef>& remaining, const Monitor& monitor) {
  check_part(problem, part, "tray", "part");
  for (std::size_t i = 0; i < remaining.size(); ++i) {
    const std::string name = "remaining[" + std::to_string(i) + "]";
    check_part(problem, remaining[i], name + ".tray", name + ".part");
  }
  return detail::pick_part(problem, database, base_pose, part, remaining, monitor);
}

}  // namespace mmgrasp
