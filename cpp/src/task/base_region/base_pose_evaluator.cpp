#include "mmgrasp/task/base_pose_evaluator.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/base_workspace.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "task/base_region/grasp_search.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {
namespace {

using detail::GraspSearch;
using detail::GraspSearchTables;
using detail::part_of;

constexpr int kCheckRestarts = 12;

}  // namespace

struct BasePoseEvaluator::Impl {
  std::shared_ptr<const GraspSearchTables> tables;
  const ReachDatabase* database;
  std::vector<PartRef> in_place;
  CollisionChecker at_rest;
  GraspSearch search;

  /// Makes an evaluator, and checks in this world which grasps of the tables are blocked.
  static std::unique_ptr<Impl> make(GraspSearchTables tables, const ReachDatabase& database,
                                    std::vector<PartRef> in_place, const World& world) {
    const PartSupplyProblem& problem = *tables.problem;
    tables.grasps.find_blocked(in_place, world);
    CollisionChecker at_rest(problem.arm, world);
    std::vector<CollisionChecker> opened;
    for (double opening : tables.grasps.openings())
      opened.push_back(at_rest.with_group(detail::arm_with_opening(problem.arm, problem.gripper, opening)));
    auto shared = std::make_shared<const GraspSearchTables>(std::move(tables));
    GraspSearch search(shared, std::move(opened));
    return std::unique_ptr<Impl>(
        new Impl{std::move(shared), &database, std::move(in_place), std::move(at_rest), std::move(search)});
  }

  std::unique_ptr<Impl> clone() const {
    return std::unique_ptr<Impl>(new Impl{tables, database, in_place, at_rest.clone(), search.clone()});
  }

  const PartSupplyProblem& problem() const { return *tables->problem; }
};

BasePoseEvaluator::BasePoseEvaluator(const PartSupplyProblem& problem, const ReachDatabase& database) {
  const std::string difference = database.difference(problem.arm);
  if (!difference.empty()) throw InvalidInput("database: was built for another arm than the problem's: " + difference);
  const JointGroup arm = problem.arm.at(Pose::Identity());
  auto seeds = std::make_shared<const detail::IkSeedGrid>(arm, database, detail::ik_seeds_of_a_grasp(problem));
  std::vector<PartRef> parts = detail::all_parts(problem);
  const World world = detail::world_with_parts(problem, parts);
  impl_ = Impl::make({&problem, arm, std::move(seeds), detail::GraspTable(problem)}, database, std::move(parts), world);
}

BasePoseEvaluator BasePoseEvaluator::without(const std::vector<PartRef>& removed) const {
  std::vector<PartRef> left = impl_->in_place;
  World world = impl_->at_rest.world();
  for (const PartRef& part : removed) {
    const auto it = std::find(left.begin(), left.end(), part);
    require(it != left.end(), "part", part.part, "must be a part of the tray that is in place");
    left.erase(it);
    world.remove(part_of(impl_->problem(), part).name);
  }
  return BasePoseEvaluator(Impl::make(*impl_->tables, *impl_->database, std::move(left), world));
}

BasePoseEvaluator::BasePoseEvaluator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
BasePoseEvaluator::BasePoseEvaluator(BasePoseEvaluator&&) noexcept = default;
BasePoseEvaluator& BasePoseEvaluator::operator=(BasePoseEvaluator&&) noexcept = default;
BasePoseEvaluator::~BasePoseEvaluator() = default;

BasePoseEvaluator BasePoseEvaluator::clone() const {
  return BasePoseEvaluator(impl_->clone());
}

Rejection BasePoseEvaluator::home(const Eigen::Vector3d& base_pose) {
  if (!detail::in_workspace(impl_->problem().robot.base_limits(), base_pose)) return Rejection::limits;
  impl_->at_rest.set_root(pose_from_planar(base_pose));
  return impl_->at_rest.rejection(impl_->problem().home);
}

PartAtPose BasePoseEvaluator::part(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp) {
  PartAtPose result;
  result.grasp = impl_->search.find(base_pose, part, first_grasp, false, result.causes);
  result.feasible = result.grasp >= 0;
  if (result.feasible) {
    result.q = impl_->search.q();
    result.causes.clear();
  }
  return result;
}

int BasePoseEvaluator::find_grasp(const Eigen::Vector3d& base_pose, PartRef part, int first_grasp,
                                  std::vector<Rejection>& causes) {
  return impl_->search.find(base_pose, part, first_grasp, true, causes);
}

bool BasePoseEvaluator::part_with_restarts(const Eigen::Vector3d& base_pose, PartRef ref, int first_grasp) {
  if (part(base_pose, ref, first_grasp).feasible) return true;
  const GraspSearchTables& tables = *impl_->tables;
  const Part& wanted = part_of(*tables.problem, ref);
  const int begin = tables.grasps.first(ref);
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * wanted.T_world_part;
  for (int g = 0; g < static_cast<int>(wanted.grasps.size()); ++g) {
    if (hand_blocked(ref, g)) continue;
    CollisionChecker& checker = impl_->search.checker_at(tables.grasps.opening(begin + g), base_pose);
    IkOptions options;
    options.restarts = kCheckRestarts;
    options.time_limit = detail::kNoTimeLimit;
    options.seed = static_cast<unsigned>(g) + 1;
    const IkResult found = solve_ik(tables.arm, T_base_part * wanted.grasps[g].T_object_hand, tables.problem->home,
                                    options, [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
    if (found.outcome == Outcome::solved) return true;
  }
  return false;
}

bool BasePoseEvaluator::hand_blocked(PartRef part, int grasp) const {
  const detail::GraspTable& grasps = impl_->tables->grasps;
  return grasps.blocked(grasps.first(part) + grasp);
}

double BasePoseEvaluator::reach_deficit(const Eigen::Vector3d& base_pose, PartRef ref) const {
  const Part& part = part_of(impl_->problem(), ref);
  const Eigen::AlignedBox3d bounds = impl_->database->bounds();
  const Pose T_base_part = pose_from_planar(base_pose).inverse() * part.T_world_part;
  double nearest = detail::kInfinity;
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(ref, g)) continue;
    const Eigen::Vector3d p = (T_base_part * part.grasps[g].T_object_hand).translation();
    const double outside = std::sqrt(bounds.squaredExteriorDistance(p));
    nearest = std::min(nearest, std::max(outside, p.norm() - impl_->database->reach()));
  }
  return std::isfinite(nearest) ? std::max(nearest, 0.0) : 0.0;
}

double BasePoseEvaluator::height_deficit(PartRef ref) const {
  const Part& part = part_of(impl_->problem(), ref);
  const Eigen::AlignedBox3d bounds = impl_->database->bounds();
  double nearest = detail::kInfinity;
  for (int g = 0; g < static_cast<int>(part.grasps.size()); ++g) {
    if (hand_blocked(ref, g)) continue;
    const double z = (part.T_world_part * part.grasps[g].T_object_hand).translation().z();
    const double outside = z - std::clamp(z, bounds.min().z(), bounds.max().z());
    if (std::abs(outside) < std::abs(nearest)) nearest = outside;
  }
  return std::isfinite(nearest) ? nearest : 0.0;
}

}  // namespace mmgrasp
