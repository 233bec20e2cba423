#include "collision/checker/bodies.hpp"

#include <algorithm>

#include "collision/narrow/field_query.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

namespace {

// Padding pushes out the corners of a box by up to sqrt(3) of it.
constexpr double kCornerGrowth = 1.75;

BodyShape place_on_link(const LinkShape& shape, const Rigid& in_link, int body, int link, double padding) {
  BodyShape out;
  out.body = body;
  out.link = link;
  out.solid = shared_solid(shape.shape, 0);
  out.padded = padding > 0 ? shared_solid(shape.shape, padding) : out.solid;
  out.growth = kCornerGrowth * padding;
  out.bounds = shared_bounds(*out.solid, shape.shape);
  out.place(in_link);
  return out;
}

Rigid in_link(const Pose& T_link_object, const LinkShape& part) {
  return Rigid(T_link_object) * Rigid(part.T_link_shape);
}

void add_subtree(const Robot& robot, int link, std::vector<char>& in) {
  if (in[link]) return;
  in[link] = 1;
  for (const int joint : robot.links()[link].child_joints) add_subtree(robot, robot.joints()[joint].child_link, in);
}

bool is_below(const Robot& robot, int link, int ancestor) {
  while (link != ancestor) {
    const int joint = robot.links()[link].parent_joint;
    if (joint < 0) return false;
    link = robot.joints()[joint].parent_link;
  }
  return true;
}

// The SRDF names a group's joints; its links are those that they, or joints that mimic them, join, and all below. A
// group of links alone has no joints: then it is what hangs on the end effector's parent.
std::vector<char> end_effector_links(const Robot& robot, const EndEffectorDescription& effector) {
  std::vector<char> in(robot.links().size(), 0);
  bool any = false;
  const auto add = [&](int link) {
    if (link == robot.link_index(effector.parent_link) ||
        !is_below(robot, link, robot.link_index(effector.parent_link)))
      return;
    add_subtree(robot, link, in);
    any = true;
  };
  for (const GroupDescription& group : robot.groups()) {
    if (group.name != effector.group) continue;
    for (const std::string& name : group.joints) {
      const int leader = robot.joint_index(name);
      for (std::size_t j = 0; j < robot.joints().size(); ++j) {
        const Joint& joint = robot.joints()[j];
        if (static_cast<int>(j) != leader && joint.mimic_joint != leader) continue;
        add(joint.parent_link);
        add(joint.child_link);
      }
    }
    if (!group.base_link.empty()) add(robot.link_index(group.base_link));
    if (!group.tip_link.empty()) add(robot.link_index(group.tip_link));
  }
  if (!any) {
    for (const int joint : robot.links()[robot.link_index(effector.parent_link)].child_joints) {
      add(robot.joints()[joint].child_link);
    }
  }
  return in;
}

}  // namespace

void BodyShape::place(const Rigid& pose_in_link) {
  in_link = pose_in_link;
  sphere_centre = in_link * solid->sphere_centre;
}

std::vector<int> default_touch_links(const Robot& robot, int link) {
  std::vector<char> in(robot.links().size(), 0);
  add_subtree(robot, link, in);
  for (const EndEffectorDescription& effector : robot.end_effectors()) {
    if (!robot.has_link(effector.parent_link)) continue;
    const std::vector<char> links = end_effector_links(robot, effector);
    if (!links[link] && !is_below(robot, link, robot.link_index(effector.parent_link))) continue;
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = in[i] || links[i];
  }
  std::vector<int> out;
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (in[i]) out.push_back(static_cast<int>(i));
  }
  return out;
}

Snapshot::Snapshot(const Robot& robot_in, const World& world_in, const CheckerOptions& options_in)
    : robot(robot_in), world(world_in), options(options_in), allowed_pairs(robot, world) {
  const BodyPadding padding(robot, world);
  add_robot(padding);
  first_attached = static_cast<int>(shapes.size());
  add_attached(padding);
  add_scene(padding);
  mark_allowed();
}

void Snapshot::add_robot(const BodyPadding& padding) {
  for (std::size_t link = 0; link < robot.links().size(); ++link) {
    const Link& description = robot.links()[link];
    if (description.collisions.empty()) continue;
    Body body;
    body.name = description.name;
    body.link = static_cast<int>(link);
    bodies.push_back(body);
    for (const LinkShape& shape : description.collisions) {
      shapes.push_back(place_on_link(shape, Rigid(shape.T_link_shape), static_cast<int>(bodies.size()) - 1,
                                     static_cast<int>(link), std::max(options.padding, padding.link(body.name))));
    }
  }
}

void Snapshot::add_attached(const BodyPadding& padding) {
  for (const auto& [name, object] : world.attached()) {
    if (!robot.has_link(object.link)) {
      throw InvalidInput("attached object '" + name + "': link = " + object.link + ": is no link of robot '" +
                         robot.name() + "'");
    }
    Body body;
    body.name = name;
    body.link = robot.link_index(object.link);
    body.attached = true;
    for (const std::string& link : object.touch_links) body.touch_links.push_back(robot.link_index(link));
    if (object.touch_links.empty()) body.touch_links = default_touch_links(robot, body.link);
    std::sort(body.touch_links.begin(), body.touch_links.end());
    bodies.push_back(body);
    for (const LinkShape& shape : object.shapes) {
      shapes.push_back(place_on_link(shape, in_link(object.T_link_object, shape), static_cast<int>(bodies.size()) - 1,
                                     body.link, padding.attached(name)));
    }
  }
}

void Snapshot::place_attached(const Pose& T_link_object) {
  auto shape = shapes.begin() + first_attached;
  for (const LinkShape& part : world.attached().begin()->second.shapes) (shape++)->place(in_link(T_link_object, part));
}

void Snapshot::add_scene(const BodyPadding& padding) {
  std::vector<SceneShape> others;
  std::vector<ScenePacks::Item> items;
  for (const auto& [name, object] : world.objects()) {
    object_names.push_back(name);
    for (const LinkShape& shape : object.shapes) {
      SceneShape out;
      out.object = static_cast<int>(object_names.size()) - 1;
      out.T_world = Rigid(object.T_world_object) * Rigid(shape.T_link_shape);
      out.bare = shared_solid(shape.shape, 0);
      const double growth = padding.object(name);
      out.solid = growth > 0 ? shared_solid(shape.shape, growth) : out.bare;
      if (out.solid->never_collides()) continue;
      out.sphere_centre = out.T_world * out.solid->sphere_centre;
      if (out.solid->kind == SolidKind::plane || out.solid->kind == SolidKind::voxels) {
        others.push_back(out);
        continue;
      }
      items.push_back(
          {{out.T_world.R, out.T_world * out.solid->box_centre}, out.solid->box_half.array() + out.solid->margin});
      scene.push_back(out);
    }
  }
  for (const auto& [name, obstacle] : world.fields()) {
    SceneShape out;
    out.object = static_cast<int>(object_names.size());
    object_names.push_back(name);
    out.T_world = Rigid(obstacle.T_world_field);
    out.bare = make_field_solid(obstacle, 0);
    out.solid = make_field_solid(obstacle, padding.object(name));
    others.push_back(out);
  }
  packed = static_cast<int>(scene.size());
  packs = ScenePacks(items);
  scene.insert(scene.end(), others.begin(), others.end());
}

void Snapshot::mark_allowed() {
  if (allowed_pairs.empty()) return;
  for (BodyShape& shape : shapes) {
    for (std::size_t i = 0; i < scene.size(); ++i) {
      if (!allowed_pairs(bodies[shape.body].name, object_names[scene[i].object])) continue;
      shape.may_touch.resize(scene.size(), 0);
      shape.may_touch[i] = 1;
    }
  }
}

}  // namespace mmgrasp::detail
