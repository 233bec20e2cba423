#include "task/part_supply/pick_remedies.hpp"

#include <algorithm>
#include <set>
#include <utility>
#include <variant>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "task/pick/part_pick.hpp"
#include "task/pick/search_pick.hpp"
#include "task/problem/scene.hpp"
#include "task/problem/wording.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kShortMove = 0.02;       // Straight moves that hardly ask for room [m].
constexpr double kMotionTimeLimit = 0.5;  // Enough for motions that are not hard to find [s].
constexpr std::size_t kObstacles = 8;     // Left out, each by itself.

struct Remedy {
  std::string advice;
  PickProblem pick;
};

/// Distance from a point to the box around a body; planes have none.
double distance_to(const WorldObject& object, const Eigen::Vector3d& point) {
  Eigen::AlignedBox3d box;
  for (const LinkShape& shape : object.shapes) {
    if (std::holds_alternative<Plane>(shape.shape)) return kInfinity;
    box.extend(shape_bounds(shape.shape, object.T_world_object * shape.T_link_shape));
  }
  return box.exteriorDistance(point);
}

/// What stands near the part, the nearest first, other parts left out.
std::vector<std::string> near_objects(const PickProblem& pick, const std::set<std::string>& parts, double reach) {
  const Eigen::Vector3d middle = pick.world.objects().at(pick.object).T_world_object.translation();
  std::vector<std::pair<double, std::string>> near;
  for (const auto& [name, object] : pick.world.objects()) {
    const double distance = parts.count(name) > 0 ? kInfinity : distance_to(object, middle);
    if (distance < reach) near.emplace_back(distance, name);
  }
  std::sort(near.begin(), near.end());
  if (near.size() > kObstacles) near.resize(kObstacles);
  std::vector<std::string> names;
  for (auto& [distance, name] : near) names.push_back(std::move(name));
  return names;
}

/// The shapes of a body that lie wholly above a point, as a tray's roof does above its parts, or the others.
WorldObject part_of_body(const WorldObject& body, const Eigen::Vector3d& point, bool above) {
  const Eigen::Vector3d local = body.T_world_object.inverse(Eigen::Isometry) * point;
  WorldObject part{{}, body.T_world_object};
  for (const LinkShape& shape : body.shapes) {
    const bool lies_above = shape_bounds(shape.shape, shape.T_link_shape).min().z() >= local.z();
    if (lies_above == above) part.shapes.push_back(shape);
  }
  return part;
}

/// Its walls and its roof, each left out by itself.
void try_without_parts_of_tray(const PickProblem& pick, const std::string& tray, std::vector<Remedy>& tries) {
  const WorldObject& body = pick.world.objects().at(tray);
  const Eigen::Vector3d middle = pick.world.objects().at(pick.object).T_world_object.translation();
  const WorldObject roof = part_of_body(body, middle, true), rest = part_of_body(body, middle, false);
  tries.push_back({"lower the walls of '" + tray + "'", pick});
  tries.back().pick.world.remove(tray);
  if (roof.shapes.empty()) return;
  tries.back().pick.world.add(tray, roof);
  if (rest.shapes.empty()) return;
  tries.push_back({"raise the roof of '" + tray + "'", pick});
  tries.back().pick.world.remove(tray);
  tries.back().pick.world.add(tray, rest);
}

std::vector<Remedy> remedies_to_try(const PickProblem& pick, const std::set<std::string>& parts,
                                    const std::string& own_tray, double reach) {
  std::vector<Remedy> tries;
  for (const std::string& name : near_objects(pick, parts, reach)) {
    if (name == own_tray) {
      try_without_parts_of_tray(pick, name, tries);
      continue;
    }
    tries.push_back({"move '" + name + "' away", pick});
    tries.back().pick.world.remove(name);
  }
  tries.push_back({"leave more room between the parts", pick});
  for (const std::string& name : parts) {
    if (name != pick.object && pick.world.has(name)) tries.back().pick.world.remove(name);
  }
  if (pick.options.lift_height > kShortMove) {
    tries.push_back({"lower lift_height (" + six_digits(kShortMove) + " m works)", pick});
    tries.back().pick.options.lift_height = kShortMove;
  }
  if (pick.options.approach_distance > kShortMove) {
    tries.push_back({"shorten approach_distance (" + six_digits(kShortMove) + " m works)", pick});
    tries.back().pick.options.approach_distance = kShortMove;
  }
  if (!pick.places.empty()) {
    tries.push_back(
        {pick.T_world_root_at_place ? "move unload_region or the goal" : "move the bin (place_region)", pick});
    tries.back().pick.places.clear();
  }
  return tries;
}

}  // namespace

std::vector<std::string> pick_remedies(const PartSupplyProblem& problem, const ReachDatabase& database,
                                       const Eigen::Vector3d& base_pose, PartRef part,
                                       const std::vector<PartRef>& remaining, const std::vector<std::string>& known,
                                       const Monitor& monitor) {
  std::set<std::string> parts;
  for (const PartRef& ref : all_parts(problem)) parts.insert(part_of(problem, ref).name);
  PickProblem pick = pick_of(problem, base_pose, part, remaining);
  pick.options.motion_time_limit = std::min(pick.options.motion_time_limit, kMotionTimeLimit);
  std::vector<Remedy> tries =
      remedies_to_try(pick, parts, "tray " + tray_of(problem, part.tray).name, database.reach());
  if (!known.empty()) {
    const auto unknown = [&](const Remedy& r) { return std::count(known.begin(), known.end(), r.advice) == 0; };
    tries.erase(std::remove_if(tries.begin(), tries.end(), unknown), tries.end());
  }
  std::vector<char> helps(tries.size(), 0);
  parallel_for(
      tries.size(), problem.options.threads,
      [&](std::size_t i, int) {
        helps[i] = search_pick(tries[i].pick, database, monitor, false).outcome == Outcome::solved;
      },
      monitor, "what would help");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < tries.size(); ++i) {
    if (helps[i]) found.push_back(tries[i].advice);
  }
  return found;
}

}  // namespace mmgrasp::detail
