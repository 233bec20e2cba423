#include "verify/judge.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::verify::detail {
namespace {

void place_solids(PlacedBody& body, const Pose& T_world_body) {
  body.T_world_shape.resize(body.solids.size());
  body.bounds.resize(body.solids.size());
  body.total.setEmpty();
  for (std::size_t i = 0; i < body.solids.size(); ++i) {
    body.T_world_shape[i] = T_world_body * body.solids[i].T_body_shape;
    body.bounds[i] = bounds_at(body.solids[i], body.T_world_shape[i]);
    body.total.extend(body.bounds[i]);
  }
}

/// How far the robot can get from its root, by adding up every joint's offset and stroke.
double robot_reach(const RobotModel& robot, const std::vector<std::vector<Solid>>& link_solids) {
  std::vector<double> origin(robot.links.size(), 0.0);
  double reach = link_solids[0].empty() ? 0 : radius_of(link_solids[0]);
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const ModelJoint& joint = robot.joints[i];
    double stroke = 0;
    // A mimic joint's own limits need not hold it: what it follows may drive it farther.
    if (joint.kind == JointKind::prismatic) {
      stroke = joint.source != static_cast<int>(i) ? mmgrasp::detail::kInfinity
                                                   : std::max(std::abs(joint.lower), std::abs(joint.upper));
    }
    origin[joint.child] = origin[joint.parent] + joint.T_parent_child.p.Norm() + stroke;
    const std::vector<Solid>& solids = link_solids[joint.child];
    if (!solids.empty()) reach = std::max(reach, origin[joint.child] + radius_of(solids));
  }
  return reach;
}

int parent_of(const RobotModel& robot, int link) {
  const int joint = robot.links[link].joint;
  return joint < 0 ? -1 : robot.joints[joint].parent;
}

/// The link that `link` is joined to, looking through links without shapes.
int carrier_of(const RobotModel& robot, int link) {
  int above = parent_of(robot, link);
  while (above >= 0 && robot.links[above].shapes.empty() && !robot.links[above].shapes_left_out)
    above = parent_of(robot, above);
  return above;
}

/// First link of the rigid body that this link belongs to.
int rigid_body_of(const RobotModel& robot, int link) {
  int joint = robot.links[link].joint;
  while (joint >= 0 && robot.joints[joint].kind == JointKind::fixed) {
    link = robot.joints[joint].parent;
    joint = robot.links[link].joint;
  }
  return link;
}

bool joined(const RobotModel& robot, int a, int b) {
  return carrier_of(robot, a) == b || carrier_of(robot, b) == a || rigid_body_of(robot, a) == rigid_body_of(robot, b);
}

/// Links that are said to touch never must not touch: testing them shows whether that is true. Links joined by a joint
/// or rigidly touch by construction, others for a reason that this check cannot know.
bool needs_test(const RobotModel& robot, int a, int b) {
  const auto disabled = robot.disabled.find({a, b});
  if (disabled != robot.disabled.end()) return disabled->second && !joined(robot, a, b);
  return robot.enabled.count({a, b}) > 0 || !joined(robot, a, b);
}

}  // namespace

std::vector<bool> links_of_the_arm(const RobotModel& robot, const ArmSetup& setup) {
  std::set<int> driven(setup.arm.begin(), setup.arm.end());
  for (const auto& finger : setup.fingers) driven.insert(finger.joint);
  std::vector<bool> moved(robot.links.size(), false);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {  // joint j carries link j + 1, parents first
    const ModelJoint& joint = robot.joints[j];
    moved[joint.child] = moved[joint.parent] || driven.count(joint.source) > 0;
  }
  return moved;
}

PlacedBody place_body(const std::string& name, const std::vector<LinkShape>& shapes, const Pose& T_world_body) {
  PlacedBody body;
  body.name = name;
  body.solids = make_solids(shapes);
  place_solids(body, T_world_body);
  return body;
}

Stage make_stage(std::shared_ptr<const RobotModel> robot, const ArmSetup& setup, const std::vector<int>& finger_links,
                 const std::vector<CheckedPair>& allowed) {
  Stage stage{std::move(robot), setup, {}, {}, {}, {}, 0, 0, {}};
  for (const auto& [a, b] : allowed) stage.allowed.insert({{a, b}, {b, a}});
  for (const ModelLink& link : stage.robot->links) stage.link_solids.push_back(make_solids(link.shapes));
  const int links = static_cast<int>(stage.robot->links.size());
  for (int a = 0; a < links; ++a) {
    for (int b = a + 1; b < links; ++b) {
      const bool solid = !stage.link_solids[a].empty() && !stage.link_solids[b].empty();
      const bool allowed_pair = stage.may_touch(stage.robot->links[a].name, stage.robot->links[b].name);
      if (solid && !allowed_pair && needs_test(*stage.robot, a, b)) stage.self_pairs.emplace_back(a, b);
    }
  }
  stage.is_finger.assign(links, false);
  for (const int link : finger_links) stage.is_finger[link] = true;
  stage.reach = robot_reach(*stage.robot, stage.link_solids);
  return stage;
}

Judge::Judge(std::shared_ptr<const Stage> stage)
    : stage_(std::move(stage)), kinematics_(*stage_->robot, stage_->setup) {
  present_.assign(stage_->bodies.size(), true);
  const std::size_t links = stage_->link_solids.size();
  solid_poses_.resize(links);
  solid_bounds_.resize(links);
  link_bounds_.resize(links);
  for (std::size_t link = 0; link < links; ++link) {
    solid_poses_[link].resize(stage_->link_solids[link].size());
    solid_bounds_[link].resize(stage_->link_solids[link].size());
    if (!stage_->link_solids[link].empty()) solid_links_.push_back(static_cast<int>(link));
  }
  find_near_bodies();
}

void Judge::set_base(const Eigen::Vector3d& x_y_theta) {
  T_world_root_ = pose_from_planar(x_y_theta);
  find_near_bodies();
}

void Judge::find_near_bodies() {
  near_.clear();
  const Eigen::Vector3d root = T_world_root_.translation();
  for (std::size_t i = 0; i < stage_->bodies.size(); ++i) {
    if (stage_->bodies[i].total.exteriorDistance(root) <= stage_->reach) near_.push_back(i);
  }
}

void Judge::set_present(std::size_t body, bool present) {
  present_[body] = present;
}

void Judge::hold(std::size_t body, const Pose& T_tip_body) {
  present_[body] = false;
  attached_ = static_cast<int>(body);
  attached_body_ = stage_->bodies[body];
  T_tip_attached_ = T_tip_body;
}

void Judge::drop() {
  attached_ = -1;
}

void Judge::place(const Eigen::VectorXd& arm, double opening) {
  ++queries_;
  const Poses& links = kinematics_.place(arm, opening);
  for (const int link : solid_links_) {
    const Pose T_world_link = T_world_root_ * links[link];
    link_bounds_[link].setEmpty();
    for (std::size_t i = 0; i < solid_poses_[link].size(); ++i) {
      const Solid& solid = stage_->link_solids[link][i];
      solid_poses_[link][i] = T_world_link * solid.T_body_shape;
      solid_bounds_[link][i] = bounds_at(solid, solid_poses_[link][i]);
      link_bounds_[link].extend(solid_bounds_[link][i]);
    }
  }
  if (attached_ >= 0) place_solids(attached_body_, T_world_root_ * links[stage_->setup.tip_link] * T_tip_attached_);
}

bool Judge::link_touches(int link, const Solid& solid, const Pose& T, const Bounds& bounds) const {
  if (!link_bounds_[link].intersects(bounds)) return false;
  for (std::size_t i = 0; i < solid_poses_[link].size(); ++i) {
    if (solid_bounds_[link][i].intersects(bounds) &&
        touches(stage_->link_solids[link][i], solid_poses_[link][i], solid, T)) {
      return true;
    }
  }
  return false;
}

Touch Judge::self_touch() const {
  const std::vector<ModelLink>& links = stage_->robot->links;
  for (const auto& [a, b] : stage_->self_pairs) {
    if (!link_bounds_[a].intersects(link_bounds_[b])) continue;
    for (std::size_t i = 0; i < solid_poses_[b].size(); ++i) {
      if (link_touches(a, stage_->link_solids[b][i], solid_poses_[b][i], solid_bounds_[b][i])) {
        return {TouchKind::self, links[a].name, links[b].name};
      }
    }
  }
  return {};
}

Touch Judge::scene_touch() const {
  Bounds all;
  for (const int link : solid_links_) all.extend(link_bounds_[link]);
  for (const std::size_t index : near_) {
    const PlacedBody& body = stage_->bodies[index];
    if (!present_[index] || !all.intersects(body.total)) continue;
    for (std::size_t i = 0; i < body.solids.size(); ++i) {
      if (!all.intersects(body.bounds[i])) continue;
      for (const int link : solid_links_) {
        if (stage_->may_touch(stage_->robot->links[link].name, body.name)) continue;
        if (link_touches(link, body.solids[i], body.T_world_shape[i], body.bounds[i])) {
          return {TouchKind::scene, stage_->robot->links[link].name, body.name};
        }
      }
    }
  }
  return {};
}

Touch Judge::attached_touch() const {
  for (std::size_t i = 0; i < attached_body_.solids.size(); ++i) {
    const Solid& solid = attached_body_.solids[i];
    for (const int link : solid_links_) {
      if (stage_->is_finger[link] || stage_->may_touch(stage_->robot->links[link].name, attached_body_.name)) continue;
      if (link_touches(link, solid, attached_body_.T_world_shape[i], attached_body_.bounds[i])) {
        return {TouchKind::attached, attached_body_.name, stage_->robot->links[link].name};
      }
    }
    for (std::size_t index = 0; index < stage_->bodies.size(); ++index) {
      const PlacedBody& body = stage_->bodies[index];
      if (!present_[index] || !attached_body_.bounds[i].intersects(body.total)) continue;
      if (stage_->may_touch(attached_body_.name, body.name)) continue;
      for (std::size_t j = 0; j < body.solids.size(); ++j) {
        if (attached_body_.bounds[i].intersects(body.bounds[j]) &&
            touches(solid, attached_body_.T_world_shape[i], body.solids[j], body.T_world_shape[j])) {
          return {TouchKind::attached, attached_body_.name, body.name};
        }
      }
    }
  }
  return {};
}

Touch Judge::touch(const Eigen::VectorXd& arm, double opening) {
  mmgrasp::detail::throw_if_interrupted();
  place(arm, opening);
  if (Touch found = self_touch()) return found;
  if (Touch found = scene_touch()) return found;
  return attached_ >= 0 ? attached_touch() : Touch{};
}

Touch Judge::comes_near(const Eigen::VectorXd& arm, double opening, double margin) {
  mmgrasp::detail::throw_if_interrupted();
  place(arm, opening);
  for (std::size_t index = 0; index < stage_->bodies.size(); ++index) {
    const PlacedBody& body = stage_->bodies[index];
    if (!present_[index] || body.name == kFloor) continue;
    for (const int link : solid_links_) {
      const std::string& name = stage_->robot->links[link].name;
      if (!stage_->may_touch(name, body.name) && link_comes_near(link, body, margin))
        return {TouchKind::scene, name, body.name};
    }
    if (attached_ >= 0 && !stage_->may_touch(attached_body_.name, body.name) && attached_comes_near(body, margin))
      return {TouchKind::attached, attached_body_.name, body.name};
  }
  return {};
}

bool Judge::attached_comes_near(const PlacedBody& body, double margin) const {
  for (std::size_t i = 0; i < attached_body_.solids.size(); ++i) {
    for (std::size_t k = 0; k < body.solids.size(); ++k) {
      if (attached_body_.bounds[i].exteriorDistance(body.bounds[k]) < margin &&
          closer_than(margin, attached_body_.solids[i], attached_body_.T_world_shape[i], body.solids[k],
                      body.T_world_shape[k]))
        return true;
    }
  }
  return false;
}

bool Judge::link_comes_near(int link, const PlacedBody& body, double margin) const {
  const auto far = [margin](const Bounds& a, const Bounds& b) { return a.exteriorDistance(b) >= margin; };
  if (far(link_bounds_[link], body.total)) return false;
  for (std::size_t i = 0; i < solid_poses_[link].size(); ++i) {
    for (std::size_t k = 0; k < body.solids.size(); ++k) {
      if (far(solid_bounds_[link][i], body.bounds[k])) continue;
      if (closer_than(margin, stage_->link_solids[link][i], solid_poses_[link][i], body.solids[k],
                      body.T_world_shape[k]))
        return true;
    }
  }
  return false;
}

void Judge::find_sides(const Eigen::VectorXd& arm) {
  place(arm, stage_->setup.openings.back());
  --queries_;  // of no motion: each thread would count its own
  const Pose T_tip_world = tip(arm).inverse(Eigen::Isometry);
  std::map<int, double> along;
  for (const int link : solid_links_) {
    if (stage_->is_finger[link])
      along[link] = stage_->setup.closing.dot(T_tip_world * Eigen::Vector3d(link_bounds_[link].center()));
  }
  const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto [low, high] = std::minmax_element(along.begin(), along.end(), less);
  for (const auto& [link, at] : along) side_[link] = at > (low->second + high->second) / 2;
}

int Judge::sides_touching_attached(const Eigen::VectorXd& arm, double opening) {
  mmgrasp::detail::throw_if_interrupted();
  if (side_.empty()) find_sides(arm);
  place(arm, opening);
  if (attached_ < 0) return 0;
  bool touched[2] = {false, false};
  for (const auto& [link, side] : side_) {
    for (std::size_t i = 0; i < attached_body_.solids.size() && !touched[side]; ++i) {
      touched[side] =
          link_touches(link, attached_body_.solids[i], attached_body_.T_world_shape[i], attached_body_.bounds[i]);
    }
  }
  return touched[0] + touched[1];
}

}  // namespace mmgrasp::verify::detail
