#include "mmgrasp/collision/world.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

namespace {

void check_pose(const Pose& T, const std::string& field) {
  checked_pose(T.matrix(), field);
}

void check_shapes(const std::vector<LinkShape>& shapes, const std::string& name) {
  require(!shapes.empty(), "object '" + name + "' shapes", "0", "must hold at least one");
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string field = "object '" + name + "' shape " + std::to_string(i);
    check_shape(shapes[i].shape, field);
    check_pose(shapes[i].T_link_shape, field + " pose");
  }
}

}  // namespace

double Padding::most() const {
  double most = std::max({links, attached, objects});
  for (const auto& [name, padding] : by_name) most = std::max(most, padding);
  return most;
}

void Padding::check() const {
  const auto check_one = [](double padding, const std::string& field) {
    require_within(padding, 0, kLargestLength, field, "m");
  };
  check_one(links, "padding.links");
  check_one(attached, "padding.attached");
  check_one(objects, "padding.objects");
  for (const auto& [name, padding] : by_name) check_one(padding, "padding.by_name['" + name + "']");
}

void World::add(const std::string& name, const Shape& shape, const Pose& T_world_object) {
  WorldObject object;
  LinkShape only;
  only.shape = shape;
  object.shapes.push_back(only);
  object.T_world_object = T_world_object;
  add(name, std::move(object));
}

void World::add(const std::string& name, WorldObject object) {
  require(!name.empty(), "object name", "\"\"", "must not be empty");
  require(!has(name), "object name", name, "is in use already");
  check_shapes(object.shapes, name);
  check_pose(object.T_world_object, "object '" + name + "' pose");
  objects_.emplace(name, std::move(object));
}

void World::add_field(const std::string& name, const FieldObstacle& obstacle) {
  require(!name.empty(), "object name", "\"\"", "must not be empty");
  require(!has(name), "object name", name, "is in use already");
  obstacle.check();
  fields_.emplace(name, obstacle);
}

void World::move(const std::string& name, const Pose& T_world_object) {
  if (const auto field = fields_.find(name); field != fields_.end()) {
    check_pose(T_world_object, "object '" + name + "' pose");
    field->second.T_world_field = T_world_object;
    return;
  }
  const auto it = objects_.find(name);
  require(it != objects_.end(), "object name", name,
          attached_.count(name) != 0 ? "is attached; detach it first" : "is not in the world");
  check_pose(T_world_object, "object '" + name + "' pose");
  it->second.T_world_object = T_world_object;
}

void World::remove(const std::string& name) {
  require(objects_.erase(name) + attached_.erase(name) + fields_.erase(name) > 0, "object name", name,
          "is not in the world");
  forget(name);
}

void World::attach(const std::string& name, const std::string& link, const Pose& T_link_object,
                   std::set<std::string> touch_links) {
  const auto it = objects_.find(name);
  require(fields_.count(name) == 0, "object name", name, "is a distance field, which cannot be attached");
  require(it != objects_.end(), "object name", name,
          attached_.count(name) != 0 ? "is attached already" : "is not in the world");
  require(!link.empty(), "link", "\"\"", "must name the robot link that holds '" + name + "'");
  check_pose(T_link_object, "object '" + name + "' pose on link '" + link + "'");
  AttachedObject attached;
  attached.shapes = it->second.shapes;
  attached.link = link;
  attached.T_link_object = T_link_object;
  attached.touch_links = std::move(touch_links);
  for (const LinkShape& shape : attached.shapes) {
    require(!std::holds_alternative<Plane>(shape.shape), "object '" + name + "'", "plane",
            "cannot be attached: it has no end");
  }
  attached_.emplace(name, std::move(attached));
  objects_.erase(it);
}

void World::detach(const std::string& name, const Pose& T_world_object) {
  const auto it = attached_.find(name);
  require(it != attached_.end(), "object name", name,
          objects_.count(name) != 0 ? "is not attached" : "is not in the world");
  check_pose(T_world_object, "object '" + name + "' pose");
  WorldObject object;
  object.shapes = it->second.shapes;
  object.T_world_object = T_world_object;
  objects_.emplace(name, std::move(object));
  attached_.erase(it);
}

void World::allow(const std::string& a, const std::string& b) {
  require(!a.empty() && !b.empty(), "allowed pair", "('" + a + "', '" + b + "')", "must name two bodies");
  allowed_.insert(std::minmax(a, b));
}

void World::disallow(const std::string& a, const std::string& b) {
  require(allowed_.erase(std::minmax(a, b)) > 0, "allowed pair", "('" + a + "', '" + b + "')",
          "is not among the world's allowed ones");
}

void World::set_padding(Padding padding) {
  padding.check();
  padding_ = std::move(padding);
}

void World::forget(const std::string& name) {
  for (auto it = allowed_.begin(); it != allowed_.end();)
    it = it->first == name || it->second == name ? allowed_.erase(it) : std::next(it);
  padding_.by_name.erase(name);
}

bool World::has(const std::string& name) const {
  return objects_.count(name) + attached_.count(name) + fields_.count(name) > 0;
}

}  // namespace mmgrasp
