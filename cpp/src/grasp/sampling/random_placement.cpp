#include "mmgrasp/grasp/random_placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kSmallStep = 0.001;  // thinner parts than this could be passed through [m]
constexpr double kOnFloor = 0.001;    // a part whose lowest point is no higher lies on the floor [m]

/// The part as a robot that is one body flying freely: q = (x, y, z, yaw, pitch, roll).
JointGroup flying_body(const std::vector<LinkShape>& shapes, double range) {
  std::string urdf = "<robot name='part'><link name='root'/>";
  std::string parent = "root";
  const auto joint = [&](const char* name, const char* type, const char* axis, double limit) {
    const std::string bound = std::to_string(limit), child = std::string("after_") + name;
    urdf += "<link name='" + child + "'/><joint name='" + name + "' type='" + type + "'><parent link='" + parent +
            "'/><child link='" + child + "'/><axis xyz='" + axis + "'/><limit lower='-" + bound + "' upper='" + bound +
            "' velocity='1' effort='1'/></joint>";
    parent = child;
  };
  joint("x", "prismatic", "1 0 0", range);
  joint("y", "prismatic", "0 1 0", range);
  joint("z", "prismatic", "0 0 1", range);
  joint("yaw", "revolute", "0 0 1", 10);
  joint("pitch", "revolute", "0 1 0", 10);
  joint("roll", "revolute", "1 0 0", 10);
  const Robot bare = Robot::from_strings(urdf + "</robot>");
  return bare.with_link("body", parent, Pose::Identity(), shapes).chain("root", parent);
}

Eigen::VectorXd configuration(const Pose& T) {
  const Vector3d rpy = rpy_from_rotation(T.linear());
  Eigen::VectorXd q(6);
  q << T.translation(), rpy.z(), rpy.y(), rpy.x();
  return q;
}

Eigen::AlignedBox3d bounds_of(const std::vector<LinkShape>& shapes, const Pose& T) {
  Eigen::AlignedBox3d box;
  for (const LinkShape& shape : shapes) box.extend(shape_bounds(shape.shape, T * shape.T_link_shape));
  return box;
}

/// Fills a tray part by part: each falls from a random place until it meets the floor or another part.
class Placer {
 public:
  Placer(const std::vector<LinkShape>& part, const Vector3d& tray_size, double wall, const PlacementOptions& options)
      : part_(part),
        size_(tray_size),
        inner_(tray_size.head<2>() / 2 - Vector2d::Constant(wall + options.clearance)),
        options_(options),
        rests_(resting_poses(part)),
        rng_(options.seed) {
    const Eigen::AlignedBox3d box = bounds_of(part, Pose::Identity());
    body_.emplace(flying_body(part, 10 * (box.diagonal().norm() + tray_size.norm()) + 1));
    world_.add("tray", WorldObject{tray_shapes(tray_size, wall), Pose::Identity()});
    checker_.emplace(make_checker());
  }

  bool fits_anywhere() {
    for (const RestingPose& rest : rests_) {
      for (int i = 0; i < 36; ++i) {
        const Pose T = Eigen::Translation3d(Vector3d::Zero()) *
                       Eigen::AngleAxisd(i * detail::kPi / 36, Vector3d::UnitZ()) * rest.T_floor_part;
        if (room(bounds_of(part_, T)).minCoeff() >= 0) return true;
      }
    }
    return false;
  }

  std::optional<PlacedPart> place(const CancelToken& stop) {
    for (const bool on_others : {false, true}) {
      if (on_others && !options_.stack) break;
      for (int i = 0; i < options_.draws && !stop.stopped(); ++i) {
        std::optional<PlacedPart> found = drop(on_others);
        if (found) {
          keep(*found);
          return found;
        }
      }
    }
    return std::nullopt;
  }

 private:
  CollisionChecker make_checker() const {
    CheckerOptions options;
    options.check_self = false;
    return CollisionChecker(*body_, world_, options);
  }

  Vector2d room(const Eigen::AlignedBox3d& box) const { return 2 * inner_ - box.sizes().head<2>(); }

  int draw_rest() {
    double left = rng_.uniform();
    for (int i = 0; i < static_cast<int>(rests_.size()); ++i) {
      left -= rests_[i].probability;
      if (left < 0) return i;
    }
    return 0;
  }

  /// One random place; nothing when the part does not fit there.
  std::optional<PlacedPart> drop(bool on_others) {
    PlacedPart out;
    out.resting_pose = draw_rest();
    Pose T = Pose(Eigen::AngleAxisd(rng_.uniform(-detail::kPi, detail::kPi), Vector3d::UnitZ())) *
             rests_[out.resting_pose].T_floor_part;
    const double rx = rng_.uniform(), ry = rng_.uniform();
    const Eigen::AlignedBox3d box = bounds_of(part_, T);
    const Vector2d free = room(box);
    if (free.minCoeff() < 0) return std::nullopt;
    T.translation().head<2>() += Vector2d(rx, ry).cwiseProduct(free) - inner_ - box.min().head<2>();
    // The primitives stand for themselves: a cylinder's hull has its facets a little inside.
    T.translation().z() += -box.min().z() + options_.clearance;
    if (!on_others) {
      if (!settles(T, T.translation().z())) return std::nullopt;
    } else {
      const double floor = T.translation().z();
      T.translation().z() += top_;
      if (!settles(T, floor)) return std::nullopt;
      if (bounds_of(part_, T).max().z() > size_.z()) return std::nullopt;
    }
    out.T_tray_part = T;
    out.on_floor = bounds_of(part_, T).min().z() <= kOnFloor;
    return out;
  }

  bool is_free(const Pose& T) { return checker_->is_free(configuration(T)); }

  /// Lets the part down from where it is, to the floor or until it meets something.
  bool settles(Pose& T, double floor) {
    if (!is_free(T)) return false;
    double& z = T.translation().z();
    while (z > floor) {
      // Moving by less than the distance is safe; so is a small step that is found free, past a wall close by.
      const double before = z, distance = checker_->distance(configuration(T)).value;
      z = std::max(floor, z - std::max(distance - options_.clearance / 2, kSmallStep));
      if (is_free(T)) continue;
      double low = z, high = before;
      while (high - low > options_.clearance / 4) {
        z = (low + high) / 2;
        is_free(T) ? high = z : low = z;
      }
      z = high;
      break;
    }
    return true;
  }

  void keep(const PlacedPart& placed) {
    world_.add("part " + std::to_string(count_++), WorldObject{part_, placed.T_tray_part});
    top_ = std::max(top_, bounds_of(part_, placed.T_tray_part).max().z());
    checker_.emplace(make_checker());
  }

  const std::vector<LinkShape>& part_;
  Vector3d size_;
  Vector2d inner_;
  PlacementOptions options_;
  std::vector<RestingPose> rests_;
  Rng rng_;
  std::optional<JointGroup> body_;
  World world_;
  std::optional<CollisionChecker> checker_;
  double top_ = 0;
  int count_ = 0;
};

}  // namespace

void PlacementOptions::check() const {
  require_count(count, "count", 0, 1'000'000);
  require_within(draws, 1, 1'000'000, "draws", "");
  require_positive(clearance, "clearance", "m");
}

std::vector<LinkShape> tray_shapes(const Vector3d& size, double wall) {
  for (int k = 0; k < 3; ++k) require_positive(size[k], "tray_size", "m");
  require_number(wall, "wall", "m");
  require(wall > 0 && 2 * wall < size.head<2>().minCoeff() && wall < size.z(), "wall", wall,
          "must be positive and leave room between the walls [m]");
  const auto box = [](double x, double y, double z, const Vector3d& at) {
    LinkShape shape;
    shape.shape = Box{Vector3d(x, y, z)};
    shape.T_link_shape.translation() = at;
    return shape;
  };
  // Walls stand on the level of the floor's lower face; their tops are `size.z - wall` above its upper one.
  const double middle = size.z() / 2 - wall, x = size.x() / 2 - wall / 2, y = size.y() / 2 - wall / 2;
  return {box(size.x(), size.y(), wall, {0, 0, -wall / 2}), box(wall, size.y(), size.z(), {x, 0, middle}),
          box(wall, size.y(), size.z(), {-x, 0, middle}), box(size.x() - 2 * wall, wall, size.z(), {0, y, middle}),
          box(size.x() - 2 * wall, wall, size.z(), {0, -y, middle})};
}

RandomPlacement random_placement(const std::vector<LinkShape>& part, const Vector3d& tray_size, double wall,
                                 const PlacementOptions& options, const Monitor& monitor) {
  options.check();
  Placer placer(part, tray_size, wall, options);
  require(placer.fits_anywhere(), "part", "its resting poses", "must fit between the walls of the empty tray");
  RandomPlacement out;
  for (int i = 0; i < options.count && !monitor.stopped(); ++i) {
    const auto placed = placer.place(monitor.stop);
    placed ? out.parts.push_back(*placed) : void(++out.not_placed);
    monitor.report("placing parts", (i + 1.0) / options.count);
  }
  return out;
}

}  // namespace mmgrasp
