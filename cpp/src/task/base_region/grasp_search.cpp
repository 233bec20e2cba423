#include "task/base_region/grasp_search.hpp"

#include <algorithm>

#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kNeighbours = 3;  // Nodes around that are tried where the cell's own one is of no use.

/// How far a configuration got before it was rejected.
int stage(Rejection cause) {
  switch (cause) {
    case Rejection::limits:
      return 1;
    case Rejection::self_collision:
      return 2;
    case Rejection::scene:
      return 3;
    default:
      return 0;
  }
}

}  // namespace

GraspSearch::GraspSearch(std::shared_ptr<const GraspSearchTables> tables, std::vector<CollisionChecker> checkers)
    : tables_(std::move(tables)),
      checkers_(std::move(checkers)),
      root_at_(checkers_.size(), Eigen::Vector3d::Constant(std::nan(""))),
      ik_(tables_->arm),
      placed_(tables_->grasps.size()),
      rejected_(tables_->arm.size(), 16) {}

GraspSearch GraspSearch::clone() const {
  std::vector<CollisionChecker> copies;
  for (const CollisionChecker& checker : checkers_) copies.push_back(checker.clone());
  return GraspSearch(tables_, std::move(copies));
}

CollisionChecker& GraspSearch::checker_at(int opening, const Eigen::Vector3d& base_pose) {
  CollisionChecker& checker = checkers_[opening];
  if (root_at_[opening] != base_pose) {
    checker.set_root(pose_from_planar(base_pose));
    root_at_[opening] = base_pose;
  }
  return checker;
}

int GraspSearch::find(const Eigen::Vector3d& base_pose, PartRef ref, int first_grasp, bool any_order,
                      std::vector<Rejection>& causes) {
  const Part& part = part_of(*tables_->problem, ref);
  const int begin = tables_->grasps.first(ref);
  const int count = static_cast<int>(part.grasps.size());
  causes.resize(part.grasps.size());
  for (int turn = first_grasp >= 0 ? -1 : 0; turn < count; ++turn) {
    const int g = turn < 0 ? first_grasp : turn;
    if (turn >= 0 && g == first_grasp) continue;
    Rejection& cause = causes[g];
    cause = tables_->grasps.blocked(begin + g) ? Rejection::grasp_filter
                                               : try_grasp(base_pose, part, g, begin + g, any_order);
    if (cause == Rejection::none) return g;
  }
  return -1;
}

/// `index`: of the grasp in the part's list; `grasp`: in the table.
const GraspSearch::PlacedGrasp& GraspSearch::placed(double heading, const Part& part, int index, int grasp) {
  if (heading != heading_) {
    for (PlacedGrasp& old : placed_) old.slice = nullptr;
    heading_ = heading;
  }
  PlacedGrasp& result = placed_[grasp];
  if (result.slice == nullptr) {
    result.T_root_hand = pose_from_planar(Eigen::Vector3d(0, 0, heading)).inverse() *
                         (part.T_world_part * part.grasps[index].T_object_hand);
    result.slice = &tables_->seeds->slice(result.T_root_hand.linear(), result.T_root_hand.translation().z());
  }
  return result;
}

/// Solves from one seed to the pose, in `q_`. True when it arrives; `cause` is then what the checker says.
bool GraspSearch::solve_from(const double* seed, const Pose& T_base_hand, CollisionChecker& checker, Rejection& cause) {
  q_ = Eigen::Map<const Eigen::VectorXd>(seed, tables_->arm.size());
  if (!ik_.solve(T_base_hand, q_)) return false;
  cause = checker.rejection(q_);
  return true;
}

Rejection GraspSearch::try_grasp(const Eigen::Vector3d& base_pose, const Part& part, int index, int grasp,
                                 bool any_order) {
  const PlacedGrasp& at_heading = placed(base_pose.z(), part, index, grasp);
  const double c = std::cos(base_pose.z()), s = std::sin(base_pose.z());
  Pose T_base_hand = at_heading.T_root_hand;
  T_base_hand.translation().x() -= c * base_pose.x() + s * base_pose.y();
  T_base_hand.translation().y() -= c * base_pose.y() - s * base_pose.x();
  const double x = T_base_hand.translation().x(), y = T_base_hand.translation().y();
  const IkSeedGrid& seeds = *tables_->seeds;
  std::array<int, 2> cell;
  IkSeedGrid::Node* node = at_heading.slice->find(x, y, cell);
  if (node == nullptr && !seeds.closed_form()) return Rejection::unreachable;
  CollisionChecker& checker = checker_at(tables_->grasps.opening(grasp), base_pose);
  Rejection worst = Rejection::unreachable;
  bool arrived = false;
  rejected_count_ = 0;
  const auto tried = [&](const double* seed) {
    Rejection cause;
    if (!solve_from(seed, T_base_hand, checker, cause)) return false;
    arrived = true;
    if (cause == Rejection::none) return true;
    if (stage(cause) > stage(worst)) worst = cause;
    if (seeds.closed_form() && rejected_count_ < rejected_.cols()) rejected_.col(rejected_count_++) = q_;
    return false;
  };
  int k = 0;
  if (node != nullptr) {
    const Pose T_base_node = at_heading.slice->pose(cell[0], cell[1]);
    const int first = any_order ? node->last_good.load(std::memory_order_relaxed) : 0;
    if (const double* seed = first > 0 ? node->solution(first, seeds, T_base_node) : nullptr; seed != nullptr)
      if (tried(seed)) return Rejection::none;
    for (; const double* seed = node->solution(k, seeds, T_base_node); ++k) {
      if (k == first && first > 0) continue;
      if (!tried(seed)) continue;
      if (any_order) node->last_good.store(k, std::memory_order_relaxed);
      return Rejection::none;
    }
  }
  if (seeds.closed_form()) return try_branches(T_base_hand, checker, worst);
  if (arrived) return worst;
  if (try_neighbours(*at_heading.slice, cell, x, y, tried)) return Rejection::none;
  if (arrived) return worst;
  return k == 0 ? node->cause() : Rejection::unreachable;
}

/// The same posture, whole turns aside: all joints of an arm with a closed form turn.
bool GraspSearch::was_rejected(const Eigen::VectorXd& q) const {
  constexpr double kSamePosture = 1e-3;  // [rad]
  for (Eigen::Index i = 0; i < rejected_count_; ++i) {
    Eigen::Index j = 0;
    while (j < q.size() && std::abs(wrap_angle(q[j] - rejected_(j, i))) < kSamePosture) ++j;
    if (j == q.size()) return true;
  }
  return false;
}

/// Every branch of the pose itself but those that were rejected already: after this nothing is left to find.
Rejection GraspSearch::try_branches(const Pose& T_base_hand, CollisionChecker& checker, Rejection worst) {
  const IkBranches branches = tables_->seeds->branches(T_base_hand);
  if (worst == Rejection::unreachable && branches.rejections.limits > 0) worst = Rejection::limits;
  for (const Eigen::VectorXd& branch : branches.solutions) {
    if (was_rejected(branch)) continue;
    const Rejection cause = checker.rejection(branch);
    if (cause == Rejection::none) {
      q_ = branch;
      return cause;
    }
    if (stage(cause) > stage(worst)) worst = cause;
  }
  return worst;
}

/// Near the edge of the reach a node may lie outside where the pose lies inside.
template <class Try>
bool GraspSearch::try_neighbours(IkSeedGrid::Slice& slice, const std::array<int, 2>& cell, double x, double y,
                                 const Try& tried) {
  struct Neighbour {
    double distance;
    const double* seed;
  };
  std::array<Neighbour, 8> near;
  std::size_t count = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      const int ix = cell[0] + dx, iy = cell[1] + dy;
      IkSeedGrid::Node* node = slice.at(ix, iy);
      if (node == nullptr) continue;
      const double* seed = node->solution(0, *tables_->seeds, slice.pose(ix, iy));
      if (seed != nullptr) near[count++] = {slice.squared_distance(ix, iy, x, y), seed};
    }
  }
  std::stable_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count),
                   [](const Neighbour& a, const Neighbour& b) { return a.distance < b.distance; });
  for (std::size_t i = 0; i < std::min<std::size_t>(count, kNeighbours); ++i) {
    if (tried(near[i].seed)) return true;
  }
  return false;
}

}  // namespace mmgrasp::detail
