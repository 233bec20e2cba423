#include "task/base_route/floor_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "task/base_route/base_moves.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kMargin = 2.0;            // [m] around what is in the scene
constexpr double kMaxCells = 40000;        // Largest number of cells of a floor.
constexpr double kConnectionRadius = 2.0;  // A place is connected with the cells within this radius, in cells.
constexpr double kCheckStep = 0.02;        // [m]; nothing is swept here, BaseClearance wants one

/// Eight axes of driving, each both ways.
constexpr std::array<std::array<int, 2>, 8> kAxes = {
    {{1, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 1}, {-1, 2}, {-1, 1}, {-2, 1}}};

}  // namespace

Eigen::AlignedBox2d floor_bounds(const World& world, const std::vector<Eigen::Vector3d>& poses, double workspace) {
  Eigen::AlignedBox2d bounds;
  for (const Eigen::Vector3d& pose : poses) bounds.extend(Eigen::Vector2d(pose.head<2>()));
  for (const auto& [name, object] : world.objects()) {
    for (const LinkShape& shape : object.shapes) {
      const Eigen::AlignedBox3d box = shape_bounds(shape.shape, object.T_world_object * shape.T_link_shape);
      if (!box.min().allFinite() || !box.max().allFinite()) continue;  // a plane has no end
      bounds.extend(Eigen::Vector2d(box.min().head<2>()));
      bounds.extend(Eigen::Vector2d(box.max().head<2>()));
    }
  }
  for (const auto& [name, obstacle] : world.fields()) {
    const Eigen::AlignedBox3d domain = obstacle.field->properties().domain;
    if (!domain.min().allFinite() || !domain.max().allFinite()) continue;
    const Eigen::AlignedBox3d box = domain.transformed(obstacle.T_world_field);
    bounds.extend(Eigen::Vector2d(box.min().head<2>()));
    bounds.extend(Eigen::Vector2d(box.max().head<2>()));
  }
  bounds = {Eigen::Vector2d(bounds.min().array() - kMargin), Eigen::Vector2d(bounds.max().array() + kMargin)};
  const double edge = workspace + kMargin;
  return bounds.intersection(Eigen::AlignedBox2d(Eigen::Vector2d(-edge, -edge), Eigen::Vector2d(edge, edge)));
}

FloorField::FloorField(const CollisionChecker& checker, const Eigen::VectorXd& home, const BaseRouteOptions& options,
                       const std::vector<Eigen::Vector3d>& places, int threads, const Monitor& monitor)
    : bounds_(floor_bounds(checker.world(), places, checker.group().robot().base_limits().workspace)) {
  const Eigen::Vector2d size = bounds_.sizes();
  resolution_ = std::max(options.resolution, std::sqrt(size.x() * size.y() / kMaxCells));
  nx_ = static_cast<int>(std::ceil(size.x() / resolution_));
  ny_ = static_cast<int>(std::ceil(size.y() / resolution_));
  free_.assign(static_cast<std::size_t>(nx_) * ny_, 0);
  look_at_rows(checker, home, options, places, threads, monitor);
  const auto n = static_cast<Eigen::Index>(places.size());
  lengths_ = Eigen::MatrixXd::Zero(n, n);
  complete_ = parallel_for(
      places.size(), threads,
      [&](std::size_t i, int) {
        const Eigen::Vector2d from = places[i].head<2>();
        const std::vector<double> field = search(from);
        for (std::size_t j = 0; j < places.size(); ++j) {
          if (j == i) continue;
          const Eigen::Vector2d to = places[j].head<2>();
          double best = (from - to).norm() <= kConnectionRadius * resolution_ ? (from - to).norm() : kInfinity;
          around(to, [&](std::size_t cell, double distance) { best = std::min(best, field[cell] + distance); });
          lengths_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = best;
        }
      },
      monitor, "route");
}

void FloorField::look_at_rows(const CollisionChecker& checker, const Eigen::VectorXd& home,
                              const BaseRouteOptions& options, const std::vector<Eigen::Vector3d>& places, int threads,
                              const Monitor& monitor) {
  parallel_for(
      ny_, threads,
      [&](std::size_t row, int) {
        CollisionChecker own = checker.clone();
        BaseClearance clearance(own, home, kCheckStep);
        clearance.keep(options.clearance, places);
        const int iy = static_cast<int>(row);
        for (int ix = 0; ix < nx_; ++ix) {
          unsigned free = 0;
          for (unsigned axis = 0; axis < kAxes.size(); ++axis) {
            const double angle = std::atan2(static_cast<double>(kAxes[axis][1]), static_cast<double>(kAxes[axis][0]));
            const Eigen::Vector2d p = middle(ix, iy);
            if (clearance.free({p.x(), p.y(), angle}) || clearance.free({p.x(), p.y(), angle + kPi}))
              free |= 1u << axis;
          }
          if (options.base == BaseKind::omni && free != 0) free = 0xff;
          free_[cell(ix, iy)] = static_cast<unsigned char>(free);
        }
      },
      monitor, "route");
}

bool FloorField::passable(int ix, int iy, int direction) const {
  return ix >= 0 && iy >= 0 && ix < nx_ && iy < ny_ && (free_[cell(ix, iy)] >> direction & 1) != 0;
}

template <class Visit>
void FloorField::around(const Eigen::Vector2d& place, const Visit& visit) const {
  const Eigen::Vector2d at = (place - bounds_.min()) / resolution_;
  for (int iy = static_cast<int>(at.y() - kConnectionRadius); iy <= static_cast<int>(at.y() + kConnectionRadius);
       ++iy) {
    for (int ix = static_cast<int>(at.x() - kConnectionRadius); ix <= static_cast<int>(at.x() + kConnectionRadius);
         ++ix) {
      if (ix < 0 || iy < 0 || ix >= nx_ || iy >= ny_ || free_[cell(ix, iy)] == 0) continue;
      const double distance = (middle(ix, iy) - place).norm();
      if (distance <= kConnectionRadius * resolution_) visit(cell(ix, iy), distance);
    }
  }
}

std::vector<double> FloorField::search(const Eigen::Vector2d& from) const {
  std::vector<double> field(free_.size(), kInfinity);
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  around(from, [&](std::size_t cell, double distance) {
    field[cell] = distance;
    open.push({distance, cell});
  });
  while (!open.empty()) {
    const auto [so_far, at] = open.top();
    open.pop();
    if (so_far > field[at]) continue;
    const int ix = static_cast<int>(at % nx_), iy = static_cast<int>(at / nx_);
    for (int axis = 0; axis < static_cast<int>(kAxes.size()); ++axis) {
      if (!passable(ix, iy, axis)) continue;
      const auto& step = kAxes[axis];
      for (const int sign : {1, -1}) {
        const int jx = ix + sign * step[0], jy = iy + sign * step[1];
        if (!passable(jx, jy, axis)) continue;
        const double there = so_far + resolution_ * std::hypot(step[0], step[1]);
        double& known = field[cell(jx, jy)];
        if (there >= known) continue;
        known = there;
        open.push({there, cell(jx, jy)});
      }
    }
  }
  return field;
}

}  // namespace mmgrasp::detail
