#include "mmgrasp/collision/detail/checker_difference.hpp"

#include <algorithm>
#include <map>
#include <type_traits>
#include <variant>
#include <vector>

namespace mmgrasp::detail {
namespace {

bool same_pose(const Pose& a, const Pose& b) {
  return a.matrix() == b.matrix();
}

bool same(const Box& a, const Box& b) {
  return a.size == b.size;
}
bool same(const Sphere& a, const Sphere& b) {
  return a.radius == b.radius;
}
bool same(const Cylinder& a, const Cylinder& b) {
  return a.radius == b.radius && a.length == b.length;
}
bool same(const Capsule& a, const Capsule& b) {
  return a.radius == b.radius && a.length == b.length;
}
bool same(const Plane& a, const Plane& b) {
  return a.normal == b.normal && a.offset == b.offset;
}
bool same(const MeshShape& a, const MeshShape& b) {
  return a.mesh == b.mesh || (a.mesh->vertices == b.mesh->vertices && a.mesh->triangles == b.mesh->triangles &&
                              a.mesh->closed == b.mesh->closed);
}
bool same(const Voxels& a, const Voxels& b) {
  return a.resolution == b.resolution && (a.centres == b.centres || *a.centres == *b.centres);
}

bool same_shapes(const std::vector<LinkShape>& a, const std::vector<LinkShape>& b) {
  const auto equal = [](const LinkShape& x, const LinkShape& y) {
    if (x.shape.index() != y.shape.index() || !same_pose(x.T_link_shape, y.T_link_shape)) return false;
    return std::visit([&](const auto& own) { return same(own, std::get<std::decay_t<decltype(own)>>(y.shape)); },
                      x.shape);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

std::string difference(const WorldObject& own, const WorldObject& wanted) {
  if (!same_pose(own.T_world_object, wanted.T_world_object)) return "stands elsewhere";
  return same_shapes(own.shapes, wanted.shapes) ? "" : "has other shapes";
}

std::string difference(const AttachedObject& own, const AttachedObject& wanted) {
  if (own.link != wanted.link || !same_pose(own.T_link_object, wanted.T_link_object)) return "is held elsewhere";
  if (own.touch_links != wanted.touch_links) return "may touch other links";
  return same_shapes(own.shapes, wanted.shapes) ? "" : "has other shapes";
}

std::string difference(const FieldObstacle& own, const FieldObstacle& wanted) {
  if (!same_pose(own.T_world_field, wanted.T_world_field)) return "stands elsewhere";
  const bool equal =
      own.field == wanted.field && own.resolution == wanted.resolution && own.unknown_is_free == wanted.unknown_is_free;
  return equal ? "" : "is another distance field";
}

template <class Item>
std::string difference(const std::map<std::string, Item>& own, const std::map<std::string, Item>& wanted) {
  for (const auto& [name, item] : wanted) {
    const auto at = own.find(name);
    if (at == own.end()) return "its world lacks '" + name + "'";
    const std::string what = difference(at->second, item);
    if (!what.empty()) return "in its world '" + name + "' " + what;
  }
  for (const auto& entry : own)
    if (wanted.count(entry.first) == 0) return "its world holds '" + entry.first + "' as well";
  return "";
}

std::string difference(const World& own, const World& wanted) {
  for (const std::string& what :
       {difference(own.objects(), wanted.objects()), difference(own.attached(), wanted.attached()),
        difference(own.fields(), wanted.fields())})
    if (!what.empty()) return what;
  if (own.allowed() != wanted.allowed()) return "in its world other pairs may touch";
  const Padding &a = own.padding(), &b = wanted.padding();
  const bool same_padding =
      a.links == b.links && a.attached == b.attached && a.objects == b.objects && a.by_name == b.by_name;
  return same_padding ? "" : "its world has another padding";
}

std::string difference(const JointGroup& own, const JointGroup& wanted) {
  const bool same_robot = &own.robot().data() == &wanted.robot().data() || own.robot().hash() == wanted.robot().hash();
  if (!same_robot) return "it is of another robot ('" + own.robot().name() + "', or other pairs of its links count)";
  if (own.joints() != wanted.joints() || own.has_base() != wanted.has_base() || own.tip_link() != wanted.tip_link())
    return "it is of another group ('" + own.name() + "')";
  if (own.reference() != wanted.reference()) return "its group holds other joints elsewhere";
  return same_pose(own.T_world_root(), wanted.T_world_root()) ? "" : "its robot stands elsewhere";
}

}  // namespace

std::string checker_difference(const CollisionChecker& checker, const JointGroup& group, const World& world) {
  const std::string of_group = difference(checker.group(), group);
  return of_group.empty() ? difference(checker.world(), world) : of_group;
}

}  // namespace mmgrasp::detail
