#include "task/problem/moving_group.hpp"

#include "task/problem/scene.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kTouch = 0.005;       // Bodies nearer than this stand on one another [m].
constexpr double kFloorHeight = 0.02;  // What ends below this is floor [m].

using Bounds = std::vector<Eigen::AlignedBox3d>;

Bounds bounds_of(const std::vector<LinkShape>& shapes, const Pose& T_world) {
  Bounds bounds;
  for (const LinkShape& shape : shapes) bounds.push_back(shape_bounds(shape.shape, T_world * shape.T_link_shape));
  return bounds;
}

Bounds bounds_of(const WorldObject& object) {
  return bounds_of(object.shapes, object.T_world_object);
}

/// The tray's volume and its parts.
Bounds bounds_of(const Tray& tray) {
  Pose T = tray.T_world_tray;
  T.translate(Eigen::Vector3d(0, 0, 0.5 * tray.size.z()));
  Bounds bounds = {shape_bounds(Box{tray.size}, T)};
  for (const Part& part : tray.parts) {
    const Bounds some = bounds_of(part.shapes, part.T_world_part);
    bounds.insert(bounds.end(), some.begin(), some.end());
  }
  return bounds;
}

bool is_floor(const Eigen::AlignedBox3d& box) {
  return !box.sizes().allFinite() || box.max().z() < kFloorHeight;
}

bool touch(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  const Eigen::Vector3d clearance = Eigen::Vector3d::Constant(kTouch);
  return Eigen::AlignedBox3d(a.min() - clearance, a.max() + clearance).intersects(b);
}

/// One stands on the other.
bool stacked(const Bounds& some, const Bounds& others) {
  for (const Eigen::AlignedBox3d& a : some) {
    if (is_floor(a)) continue;
    for (const Eigen::AlignedBox3d& b : others) {
      if (is_floor(b) || !touch(a, b)) continue;
      if (a.min().z() > b.max().z() - kTouch || b.min().z() > a.max().z() - kTouch) return true;
    }
  }
  return false;
}

/// A body inside the tray's volume or around it is the tray itself (its walls and floor).
bool belongs_to(const Bounds& object, const Eigen::AlignedBox3d& tray) {
  for (const Eigen::AlignedBox3d& box : object) {
    if (is_floor(box) || !touch(box, tray)) return false;
    const Eigen::Vector3d margin = Eigen::Vector3d::Constant(0.05);
    if (!Eigen::AlignedBox3d(tray.min() - margin, tray.max() + margin).contains(box)) return false;
  }
  return true;
}

bool overlap(const Eigen::AlignedBox3d& a, const Eigen::AlignedBox3d& b) {
  return (a.min().array() < b.max().array() - 1e-9).all() && (b.min().array() < a.max().array() - 1e-9).all();
}

}  // namespace

MovingGroup moving_group(const PartSupplyProblem& problem, TrayId tray) {
  MovingGroup group;
  std::vector<Bounds> open;
  const auto take_tray = [&](TrayId index) {
    if (!group.trays.insert(index).second) return;
    open.push_back(bounds_of(problem.trays[index]));
    for (const auto& [name, object] : problem.world.objects()) {
      if (!belongs_to(bounds_of(object), open.back().front())) continue;
      if (group.objects.insert(name).second) open.push_back(bounds_of(object));
    }
  };
  take_tray(tray);
  while (!open.empty()) {
    const Bounds now = std::move(open.back());
    open.pop_back();
    for (const auto& [name, object] : problem.world.objects()) {
      const Bounds bounds = bounds_of(object);
      if (!group.objects.count(name) && stacked(now, bounds)) {
        group.objects.insert(name);
        open.push_back(bounds);
      }
    }
    for (TrayId other : all_trays(problem)) {
      if (!group.trays.count(other) && stacked(now, bounds_of(problem.trays[other]))) take_tray(other);
    }
  }
  return group;
}

PartSupplyProblem group_alone(const PartSupplyProblem& problem, const MovingGroup& group) {
  PartSupplyProblem alone = problem;
  for (const auto& entry : problem.world.objects()) {
    if (!group.objects.count(entry.first)) alone.world.remove(entry.first);
  }
  for (const auto& entry : problem.world.fields()) alone.world.remove(entry.first);
  for (TrayId tray : all_trays(alone)) {
    if (!group.trays.count(tray)) alone.trays[tray].parts.clear();
  }
  return alone;
}

World scene_without(const PartSupplyProblem& problem, const MovingGroup& group) {
  std::vector<PartRef> parts;
  for (const PartRef& part : all_parts(problem)) {
    if (!group.trays.count(part.tray)) parts.push_back(part);
  }
  World world = world_with_parts(problem, parts);
  for (const std::string& name : group.objects) world.remove(name);
  return world;
}

PartSupplyProblem with_group_moved(const PartSupplyProblem& problem, const MovingGroup& group,
                                   const Eigen::Vector2d& by) {
  PartSupplyProblem moved = problem;
  const auto shift = [&](const Pose& T) {
    Pose there = T;
    there.translation().head<2>() += by;
    return there;
  };
  for (const std::string& name : group.objects)
    moved.world.move(name, shift(problem.world.objects().at(name).T_world_object));
  for (TrayId index : group.trays) {
    Tray& tray = moved.trays[index];
    tray.T_world_tray = shift(tray.T_world_tray);
    for (Part& part : tray.parts) part.T_world_part = shift(part.T_world_part);
  }
  return moved;
}

GroupBounds::GroupBounds(const PartSupplyProblem& problem, const MovingGroup& group) {
  const auto add = [&](const Bounds& bounds, bool moves) {
    Bounds& list = moves ? moving_ : standing_;
    for (const Eigen::AlignedBox3d& box : bounds) {
      if (!is_floor(box)) list.push_back(box);
    }
  };
  for (const auto& [name, object] : problem.world.objects()) add(bounds_of(object), group.objects.count(name) > 0);
  for (TrayId tray : all_trays(problem)) {
    add(bounds_of(problem.trays[tray]), group.trays.count(tray) > 0);
  }
}

bool GroupBounds::pushes_into_something(const Eigen::Vector2d& by) const {
  const Eigen::Vector3d shift(by.x(), by.y(), 0);
  for (const Eigen::AlignedBox3d& box : moving_) {
    const Eigen::AlignedBox3d there(box.min() + shift, box.max() + shift);
    for (const Eigen::AlignedBox3d& other : standing_) {
      if (overlap(there, other) && !overlap(box, other)) return true;
    }
  }
  return false;
}

}  // namespace mmgrasp::detail
