#include "task/base_region/ik_seed_grid.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/no_time_limit.hpp"
#include "mmgrasp/robot/detail/ik_closed_form.hpp"
#include "task/base_region/warm_started_ik.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kFruitless = 2;    // Seeds without a solution after which a node counts as out of reach.
constexpr int kIterations = 20;  // Most of one IK search: from a stored configuration near by a success takes 4 to 10.
constexpr double kFar = 1.2;  // A node is out of reach without a stored configuration so near [cells of the database],
                              // where the database is as dense as by its defaults.
constexpr double kSameConfiguration = 1e-3;  // Configurations nearer than this are one [rad or m].
constexpr double kPerUnit =
    8;  // Cells per unit of a rotation matrix's entries, centred on 0 and 1, so that upright tools are.
// Cells begin at no round number: base grids and trays have those, and roundings would decide between two cells.
constexpr double kOffset = 0.0137;  // [m]

int floor_cell(double value) {
  return static_cast<int>(std::floor((value - kOffset) / IkSeedGrid::kEdge));
}

double middle(int cell) {
  return (cell + 0.5) * IkSeedGrid::kEdge + kOffset;
}

/// The rotation in the middle of a cell: from its first two columns, made orthonormal.
Eigen::Matrix3d rotation_of(const std::array<int, 7>& key) {
  Eigen::Vector3d a(key[0], key[1], key[2]), b(key[3], key[4], key[5]);
  a.normalize();
  b -= a.dot(b) * a;
  b.normalize();
  Eigen::Matrix3d R;
  R.col(0) = a;
  R.col(1) = b;
  R.col(2) = a.cross(b);
  return R;
}

/// kFar for this database: the distance from a reachable pose to the nearest of N configurations drawn in six
/// dimensions grows with their sixth root.
double far_in(const ReachOptions& cells) {
  const auto in_a_cell = [](const ReachOptions& options) {
    return static_cast<double>(options.samples) * std::pow(options.position_cell * options.rotation_cell, 3);
  };
  return kFar * std::max(1.0, std::pow(in_a_cell(ReachOptions()) / in_a_cell(cells), 1.0 / 6));
}

bool six_joints_in_closed_form(const JointGroup& arm) {
  const Screws screws = screws_of(arm);
  return screws.size == 6 && closed_form_of(screws).family != ClosedForm::Family::none;
}

}  // namespace

IkSeedGrid::IkSeedGrid(const JointGroup& arm, const ReachDatabase& database, int seeds)
    : arm_(arm),
      database_(database),
      seeds_(seeds),
      far_(far_in(database.options())),
      closed_form_(six_joints_in_closed_form(arm)) {
  ik_.max_iterations = kIterations;
  ik_.time_limit = kNoTimeLimit;
}

IkBranches IkSeedGrid::branches(const Pose& T_base_hand) const {
  // Where a singularity makes the closed form fall back on random starts, their number ends the search.
  IkOptions options;
  options.restarts = 0;
  options.time_limit = kNoTimeLimit;
  return solve_ik_branches(arm_, T_base_hand, options);
}

IkSeedGrid::Slice& IkSeedGrid::slice(const Eigen::Matrix3d& R, double z) const {
  Key key;
  for (int i = 0; i < 6; ++i) key[i] = static_cast<int>(std::lround(kPerUnit * R(i % 3, i / 3)));
  key[6] = floor_cell(z);
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<Slice>& slice = slices_[key];
  if (!slice) slice = std::make_unique<Slice>(*this, rotation_of(key), middle(key[6]));
  return *slice;
}

IkSeedGrid::Slice::Slice(const IkSeedGrid& grid, const Eigen::Matrix3d& R, double z) : R_(R), z_(z) {
  const Eigen::AlignedBox3d bounds = grid.database_.bounds();
  if (bounds.isEmpty() || z < bounds.min().z() - kEdge || z > bounds.max().z() + kEdge) return;
  x0_ = floor_cell(bounds.min().x()) - 1;
  y0_ = floor_cell(bounds.min().y()) - 1;
  nx_ = floor_cell(bounds.max().x()) + 2 - x0_;
  ny_ = floor_cell(bounds.max().y()) + 2 - y0_;
  const std::size_t count = static_cast<std::size_t>(nx_) * ny_;
  nodes_ = std::make_unique<std::atomic<Node*>[]>(count);
  for (std::size_t i = 0; i < count; ++i) nodes_[i].store(nullptr, std::memory_order_relaxed);
}

IkSeedGrid::Slice::~Slice() {
  for (int i = 0; i < nx_ * ny_; ++i) delete nodes_[i].load();
}

IkSeedGrid::Node* IkSeedGrid::Slice::find(double x, double y, std::array<int, 2>& cell) {
  cell = {floor_cell(x) - x0_, floor_cell(y) - y0_};
  return at(cell[0], cell[1]);
}

IkSeedGrid::Node* IkSeedGrid::Slice::at(int ix, int iy) {
  if (ix < 0 || iy < 0 || ix >= nx_ || iy >= ny_) return nullptr;
  std::atomic<Node*>& slot = nodes_[static_cast<std::size_t>(iy) * nx_ + ix];
  Node* node = slot.load(std::memory_order_acquire);
  if (node != nullptr) return node;
  auto fresh = std::make_unique<Node>();
  if (slot.compare_exchange_strong(node, fresh.get(), std::memory_order_acq_rel)) return fresh.release();
  return node;
}

Pose IkSeedGrid::Slice::pose(int ix, int iy) const {
  Pose T = Pose::Identity();
  T.linear() = R_;
  T.translation() = Eigen::Vector3d(middle(ix + x0_), middle(iy + y0_), z_);
  return T;
}

double IkSeedGrid::Slice::squared_distance(int ix, int iy, double x, double y) const {
  const double dx = middle(ix + x0_) - x, dy = middle(iy + y0_) - y;
  return dx * dx + dy * dy;
}

const double* IkSeedGrid::Node::solution(int k, const IkSeedGrid& grid, const Pose& T_base_node) {
  if (k >= found_.load(std::memory_order_acquire)) {
    // The order matters: the last one may have been found in between.
    if (exhausted_.load(std::memory_order_acquire) && k >= found_.load(std::memory_order_acquire)) return nullptr;
    const std::lock_guard<std::mutex> lock(mutex_);
    while (k >= found_.load(std::memory_order_relaxed)) {
      if (!search(grid, T_base_node)) return nullptr;
    }
  }
  return configurations_.data() + static_cast<std::ptrdiff_t>(k) * configurations_.rows();
}

/// All branches, or the seeds to follow.
void IkSeedGrid::Node::start(const IkSeedGrid& grid, const Pose& T_base_node) {
  started_ = true;
  if (grid.closed_form_) {
    const IkBranches branches = grid.branches(T_base_node);
    const auto count = static_cast<Eigen::Index>(branches.solutions.size());
    configurations_.resize(grid.arm_.size(), count);
    for (Eigen::Index i = 0; i < count; ++i) configurations_.col(i) = branches.solutions[i];
    found_.store(static_cast<int>(count), std::memory_order_release);
    return;
  }
  thread_local Eigen::MatrixXd seeds;
  seeds_count_ = grid.database_.nearest(T_base_node, grid.seeds_, seeds);
  fruitless_ = kFruitless;
  if (seeds_count_ == 0) return;
  configurations_ = seeds.leftCols(seeds_count_);
  const ReachOptions& cells = grid.database_.options();
  const Pose T = grid.arm_.fk(configurations_.col(0));
  const double away = (T.translation() - T_base_node.translation()).norm() / cells.position_cell +
                      rotation_distance(T, T_base_node) / cells.rotation_cell;
  if (away > grid.far_) fruitless_ = 0;
}

/// Looks for one more configuration; false when there is none left to look for.
bool IkSeedGrid::Node::search(const IkSeedGrid& grid, const Pose& T_base_node) {
  thread_local Eigen::VectorXd q;
  const JointGroup& arm = grid.arm_;
  if (!started_) {
    start(grid, T_base_node);
    if (found_.load(std::memory_order_relaxed) > 0) return true;
  }
  const int found = found_.load(std::memory_order_relaxed);
  if (next_ >= seeds_count_ || (found == 0 && next_ >= fruitless_)) {
    exhausted_.store(true, std::memory_order_release);
    return false;
  }
  q = configurations_.col(next_);
  const bool last = found == 0 && next_ + 1 == std::min(fruitless_, seeds_count_);
  ++next_;
  if (last) {
    // This search, when it fails, also tells whether the pose is reached outside the limits only.
    IkOptions one = grid.ik_;
    one.restarts = 0;
    const IkResult end = solve_ik(arm, T_base_node, q, one);
    if (end.outcome != Outcome::solved) {
      if (end.rejections.limits > 0) cause_ = Rejection::limits;
      return true;
    }
    q = end.q;
  } else if (!WarmStartedIk(arm).solve(T_base_node, q)) {
    return true;
  }
  for (int i = 0; i < found; ++i) {
    if ((configurations_.col(i) - q).cwiseAbs().maxCoeff() < kSameConfiguration) return true;
  }
  configurations_.col(found) = q;
  found_.store(found + 1, std::memory_order_release);
  return true;
}

}  // namespace mmgrasp::detail
