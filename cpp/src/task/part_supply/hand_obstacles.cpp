#include "task/part_supply/hand_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "task/base_region/hand_checker.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kNamed = 3;  // More names tell a reader nothing new.

}  // namespace

std::string hand_obstacles(const PartSupplyProblem& problem, PartRef ref) {
  const Part& part = part_of(problem, ref);
  const World world = world_with_parts(problem, all_parts(problem));
  std::map<long, CollisionChecker> checkers;  // by opening, to a nanometre
  std::map<std::string, int> touched;
  for (const Grasp& grasp : part.grasps) {
    const double opening = problem.gripper.pregrasp_opening(grasp.opening);
    const long key = std::lround(opening * 1e9);
    if (checkers.count(key) == 0) checkers.emplace(key, hand_checker(problem, opening, world));
    CollisionChecker& checker = checkers.at(key);
    checker.set_root(part.T_world_part * grasp.T_object_hand);
    std::set<std::string> names;
    for (const Contact& contact : checker.contacts(Eigen::VectorXd::Zero(1))) {
      if (contact.with_scene) names.insert(contact.b);
    }
    for (const std::string& name : names) ++touched[name];
  }
  std::vector<std::pair<int, std::string>> most;
  for (const auto& [name, count] : touched) most.emplace_back(-count, name);
  std::sort(most.begin(), most.end());
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, most.size()); ++i) {
    text += (i == 0 ? "'" : ", '") + most[i].second + "' (" + std::to_string(-most[i].first) +
            (i == 0 ? " of " + std::to_string(part.grasps.size()) + " grasps)" : ")");
  }
  return text;
}

}  // namespace mmgrasp::detail
