#include "task/base_route/base_moves.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/detail/base_workspace.hpp"
#include "mmgrasp/task/base_route.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kTurnStep = 0.05;  // [rad]
constexpr double kNear = 1e-9;      // [m]
constexpr double kMargin = 1e-3;    // [m] on the quick test with boxes

/// The robot's extent around its root's vertical axis with the arm at home, what it holds included.
struct Extent {
  double radius = 0, low = kInfinity, high = -kInfinity;

  void add(const std::vector<LinkShape>& shapes, const Pose& T_root_body) {
    for (const LinkShape& shape : shapes) {
      const Eigen::AlignedBox3d box = shape_bounds(shape.shape, T_root_body * shape.T_link_shape);
      const Eigen::Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
      radius = std::max(radius, far.norm());
      low = std::min(low, box.min().z());
      high = std::max(high, box.max().z());
    }
  }
};

Extent robot_extent(const JointGroup& arm, const Eigen::VectorXd& home, const World& world) {
  Poses poses;
  arm.at(Pose::Identity()).link_poses(home, poses);
  Extent extent;
  const std::vector<Link>& links = arm.robot().links();
  for (std::size_t i = 0; i < links.size(); ++i) extent.add(links[i].collisions, poses[i]);
  for (const auto& entry : world.attached()) {
    const AttachedObject& held = entry.second;
    extent.add(held.shapes, poses[arm.robot().link_index(held.link)] * held.T_link_object);
  }
  return extent;
}

bool is_ground(const WorldObject& object) {
  return std::all_of(object.shapes.begin(), object.shapes.end(), [&](const LinkShape& item) {
    const auto* plane = std::get_if<Plane>(&item.shape);
    if (plane == nullptr) return false;
    const Eigen::Vector3d normal = object.T_world_object.linear() * (item.T_link_shape.linear() * plane->normal);
    return normal.normalized().z() > 1 - 1e-9;
  });
}

/// What the robot holds is grown by `padding` as well, which a checker's options do for its links alone.
World with_attached_padded(World world, double padding) {
  Padding grown = world.padding();
  grown.attached = std::max(grown.attached, padding);
  for (const auto& entry : world.attached()) {
    const auto own = grown.by_name.find(entry.first);
    if (own != grown.by_name.end()) own->second = std::max(own->second, padding);
  }
  world.set_padding(std::move(grown));
  return world;
}

World without_ground(World world) {
  std::vector<std::string> ground;
  for (const auto& [name, object] : world.objects()) {
    if (is_ground(object)) ground.push_back(name);
  }
  for (const std::string& name : ground) world.remove(name);
  return world;
}

CheckerOptions padded_by(CheckerOptions options, double padding) {
  options.padding = std::max(options.padding, padding);
  options.check_self = false;
  return options;
}

}  // namespace

BaseClearance::BaseClearance(CollisionChecker& checker, const Eigen::VectorXd& home, double check_step)
    : checker_(checker), home_(home), check_step_(check_step) {
  const Extent extent = robot_extent(checker.group(), home, checker.world());
  const Padding& padding = checker.world().padding();
  // Grown boxes reach out at their corners by up to sqrt(3) of the padding, the robot's and the object's.
  const double margin = kMargin + 1.75 * (std::max(checker.options().padding, padding.most()) + padding.most());
  radius_ = extent.radius + margin;
  for (const auto& [name, object] : checker.world().objects()) {
    Eigen::AlignedBox3d box;
    for (const LinkShape& shape : object.shapes) {
      box.extend(shape_bounds(shape.shape, object.T_world_object * shape.T_link_shape));
    }
    if (box.min().z() > extent.high + margin || box.max().z() < extent.low - margin) continue;
    obstacles_.emplace_back(Eigen::Vector2d(box.min().head<2>()), Eigen::Vector2d(box.max().head<2>()));
  }
  // A field may hold something anywhere.
  const Eigen::Vector2d everywhere = Eigen::Vector2d::Constant(detail::kInfinity);
  if (!checker.world().fields().empty()) obstacles_.emplace_back(Eigen::Vector2d(-everywhere), everywhere);
  const Rejection here = checker.rejection(home);
  home_is_sound_ = here != Rejection::limits && here != Rejection::self_collision;
}

void BaseClearance::keep(double clearance, const std::vector<Eigen::Vector3d>& ends) {
  if (!(clearance > 0)) return;
  for (const Eigen::Vector3d& end : ends) ends_.emplace_back(end.head<2>());
  const double between = 0.5 * check_step_ + 0.5 * kTurnStep * radius_;  // no point of the robot gets farther
  padded_.emplace(checker_.group(), with_attached_padded(without_ground(checker_.world()), clearance + between),
                  padded_by(checker_.options(), clearance + between));
  padded_clearance_ = std::make_unique<BaseClearance>(*padded_, home_, check_step_);
}

bool BaseClearance::is_near_an_end(const Eigen::Vector2d& position) const {
  const double near = kNearEnds - check_step_;  // what lies between two poses is not farther than kNearEnds either
  return std::any_of(ends_.begin(), ends_.end(),
                     [&](const Eigen::Vector2d& end) { return (position - end).norm() <= near; });
}

bool BaseClearance::nothing_near(const Eigen::Vector2d& position) const {
  const double reach = radius_ * radius_;
  for (const Eigen::AlignedBox2d& box : obstacles_) {
    if (!(box.squaredExteriorDistance(position) > reach)) return false;
  }
  return true;
}

bool BaseClearance::free(const Eigen::Vector3d& pose) {
  if (!home_is_sound_ || !in_workspace(checker_.group().robot().base_limits(), pose)) return false;
  if (padded_clearance_ && !is_near_an_end(pose.head<2>()) && !padded_clearance_->free(pose)) return false;
  if (nothing_near(pose.head<2>())) return true;
  checker_.set_root(pose_from_planar(pose));
  return checker_.rejection(home_) == Rejection::none;
}

bool BaseClearance::segment_free(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  const double travel = std::max(d.head<2>().norm() / check_step_, std::abs(d.z()) / kTurnStep);
  const int steps = std::max(1, static_cast<int>(std::ceil(travel)));
  if (!free(a) || !free(b)) return false;
  for (int stride = steps; stride > 1; stride = (stride + 1) / 2) {  // coarse to fine: a blocked way shows early
    const int half = (stride + 1) / 2;
    for (int i = half; i < steps; i += half) {
      if (i % stride == 0) continue;
      if (!free(a + d * (static_cast<double>(i) / steps))) return false;
    }
  }
  return true;
}

double way_cost(const Eigen::Vector3d& from, const std::vector<Eigen::Vector3d>& way, double turn_weight) {
  double cost = 0;
  Eigen::Vector3d last = from;
  for (const Eigen::Vector3d& pose : way) {
    cost += (pose - last).head<2>().norm() + turn_weight * std::abs(pose.z() - last.z());
    last = pose;
  }
  return cost;
}

std::vector<std::vector<Eigen::Vector3d>> direct_ways(BaseKind base, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                                      double turn_weight) {
  using Way = std::vector<Eigen::Vector3d>;
  std::vector<Way> ways;
  const Eigen::Vector2d d = b.head<2>() - a.head<2>();
  const double whole = kTwoPi;
  const auto turns = [&](double from, double to) {
    const double shortest = wrap_angle(to - from);
    if (std::abs(shortest) < 1e-12) return std::vector<double>{from};
    return std::vector<double>{from + shortest, from + shortest - std::copysign(whole, shortest)};
  };
  if (base == BaseKind::omni || d.norm() < kNear) {
    for (double theta : turns(a.z(), b.z())) ways.push_back({Eigen::Vector3d(b.x(), b.y(), theta)});
  } else {
    const double forwards = std::atan2(d.y(), d.x());
    for (double direction : {forwards, forwards + kPi}) {
      for (double first : turns(a.z(), direction)) {
        for (double second : turns(first, b.z())) {
          Way way;
          if (std::abs(first - a.z()) > 1e-12) way.emplace_back(a.x(), a.y(), first);
          way.emplace_back(b.x(), b.y(), first);
          if (std::abs(second - first) > 1e-12) way.emplace_back(b.x(), b.y(), second);
          ways.push_back(way);
        }
      }
    }
  }
  std::stable_sort(ways.begin(), ways.end(), [&](const Way& one, const Way& other) {
    return way_cost(a, one, turn_weight) < way_cost(a, other, turn_weight) - 1e-12;
  });
  return ways;
}

}  // namespace mmgrasp::detail
