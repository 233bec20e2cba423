#include "collision/checker/pair_plan.hpp"

#include <algorithm>
#include <map>

#include "collision/checker/limit_slack.hpp"

namespace mmgrasp::detail {

namespace {

// Numbers links so that two share a number when no joint for which `breaks` holds lies between them. Breadth-first
// order: parents come before their children.
template <class Breaks>
std::vector<int> group_links(const Robot& robot, const Breaks& breaks) {
  std::vector<int> number(robot.links().size());
  for (std::size_t i = 0; i < number.size(); ++i) {
    const int joint = robot.links()[i].parent_joint;
    const bool own = joint < 0 || breaks(joint);
    number[i] = own ? static_cast<int>(i) : number[robot.joints()[joint].parent_link];
  }
  return number;
}

// Joints whose value the group sets, mimicking ones included.
std::vector<char> active_joints(const Robot& robot, const JointGroup& group) {
  const std::vector<int>& driven = group.joints();
  std::vector<char> active(robot.joints().size(), 0);
  for (std::size_t j = 0; j < active.size(); ++j) {
    const Joint& joint = robot.joints()[j];
    const int leader = joint.mimic_joint >= 0 ? joint.mimic_joint : static_cast<int>(j);
    active[j] = std::find(driven.begin(), driven.end(), leader) != driven.end();
  }
  return active;
}

bool never_needs_check(const Snapshot& snapshot, const Body& a, const Body& b, const std::vector<int>& assembly) {
  if (assembly[a.link] == assembly[b.link] || snapshot.allowed_pairs(a.name, b.name)) return true;
  const auto may_touch = [](const Body& attached, const Body& link) {
    return std::binary_search(attached.touch_links.begin(), attached.touch_links.end(), link.link);
  };
  if (a.attached && b.attached) return false;
  if (a.attached) return may_touch(a, b);
  if (b.attached) return may_touch(b, a);
  return snapshot.robot.pair_disabled(a.link, b.link);
}

}  // namespace

std::vector<int> rigid_assemblies(const Robot& robot) {
  return group_links(robot, [&](int joint) { return robot.joints()[joint].type != JointType::fixed; });
}

PairPlan::PairPlan(const Snapshot& snapshot, const JointGroup& group)
    : frame_bounds(group),
      // Limits are kept up to kLimitSlack.
      largest_(group.lower().cwiseAbs().cwiseMax(group.upper().cwiseAbs()) +
               Eigen::VectorXd::Constant(group.size(), kLimitSlack)) {
  sort_shapes(snapshot, group);
  placed.resize(snapshot.shapes.size());
  for (std::size_t s = 0; s < snapshot.shapes.size(); ++s) place_shape(snapshot, static_cast<int>(s));
  list_pairs(snapshot, group);
  block_pairs();
  find_clearance_tables(snapshot);
  rates = bound_motion(largest_);
}

void PairPlan::sort_shapes(const Snapshot& snapshot, const JointGroup& group) {
  std::vector<char> link_moves(snapshot.robot.links().size(), 0);
  for (const int link : group.moving_links()) link_moves[link] = 1;
  for (std::size_t s = 0; s < snapshot.shapes.size(); ++s) {
    const BodyShape& shape = snapshot.shapes[s];
    if (shape.solid->never_collides()) continue;
    (link_moves[shape.link] ? moving : fixed).push_back(static_cast<int>(s));
  }
  const auto in_scene = [&](int s) {
    return !snapshot.options.attached_only || snapshot.bodies[snapshot.shapes[s].body].attached;
  };
  const auto scene_first = [&](std::vector<int>& shapes) {
    return static_cast<int>(std::stable_partition(shapes.begin(), shapes.end(), in_scene) - shapes.begin());
  };
  moving_in_scene = scene_first(moving);
  fixed_in_scene = scene_first(fixed);
  sphere_of.assign(snapshot.shapes.size(), -1);
  int sphere = 0;
  for (const auto* shapes : {&moving, &fixed}) {
    for (const int s : *shapes) sphere_of[s] = sphere++;
  }
  spheres.resize(sphere);
}

void PairPlan::place_shape(const Snapshot& snapshot, int s) {
  const BodyShape& shape = snapshot.shapes[s];
  const FrameTree& tree = frame_bounds.tree();
  placed[s] = {tree.frame_of_link[shape.link], tree.link_in_frame[shape.link] * shape.in_link};
  if (sphere_of[s] < 0) return;
  const Eigen::Vector3d centre = placed[s].in_frame * shape.padded->sphere_centre;
  spheres[sphere_of[s]] = {{centre[0], centre[1], centre[2]}, shape.padded->sphere_radius, placed[s].frame};
}

void PairPlan::place_attached(const Snapshot& snapshot) {
  for (int s = snapshot.first_attached; s < static_cast<int>(snapshot.shapes.size()); ++s) place_shape(snapshot, s);
}

void PairPlan::list_pairs(const Snapshot& snapshot, const JointGroup& group) {
  const Robot& robot = snapshot.robot;
  const std::vector<int> assembly = rigid_assemblies(robot);
  const std::vector<char> active = active_joints(robot, group);
  const std::vector<int> moved_by = group_links(robot, [&](int joint) { return active[joint] != 0; });
  for (std::size_t i = 0; i < snapshot.shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < snapshot.shapes.size(); ++j) {
      const BodyShape &a = snapshot.shapes[i], &b = snapshot.shapes[j];
      const Body &body_a = snapshot.bodies[a.body], &body_b = snapshot.bodies[b.body];
      if (a.body == b.body || a.solid->never_collides() || b.solid->never_collides()) continue;
      if (snapshot.options.attached_only && !body_a.attached && !body_b.attached) continue;
      if (never_needs_check(snapshot, body_a, body_b, assembly)) continue;
      ShapePair pair;
      pair.a = static_cast<int>(i);
      pair.b = static_cast<int>(j);
      pair.sphere_a = sphere_of[i];
      pair.sphere_b = sphere_of[j];
      pair.reach = a.solid->sphere_radius + b.solid->sphere_radius;
      (moved_by[a.link] == moved_by[b.link] ? constant : varying).push_back(pair);
    }
  }
}

void PairPlan::find_clearance_tables(const Snapshot& snapshot) {
  for (ShapePair& pair : varying) {
    const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
    if (a.solid->kind != SolidKind::mesh || b.solid->kind != SolidKind::mesh) continue;
    if (snapshot.bodies[a.body].attached || snapshot.bodies[b.body].attached) continue;
    // Links are numbered from the root outwards.
    const bool b_outer = placed[pair.b].frame > placed[pair.a].frame;
    const PlacedShape &inner = placed[b_outer ? pair.a : pair.b], &outer = placed[b_outer ? pair.b : pair.a];
    const std::vector<const ElementaryMotion*> above = frame_bounds.tree().motions_above(outer.frame);
    if (above.size() < 2 || above[1]->parent != inner.frame) continue;
    const ElementaryMotion &first = *above[1], &second = *above[0];
    const auto plain = [](const ElementaryMotion& m) {
      return m.motion == Motion::revolute && m.drive.multiplier == 1 && m.drive.offset == 0;
    };
    if (!plain(first) || !plain(second)) continue;
    // No prismatic joint lies between the two, so no limit has a part in this.
    const Eigen::VectorXd closing = pair_rates(pair, Eigen::VectorXd::Zero(frame_bounds.columns()));
    RevolutePair joints;
    // The table's joints turn about z.
    const Rigid first_z(rotation_from_z(first.axis), Eigen::Vector3d::Zero());
    const Rigid second_z(rotation_from_z(second.axis), Eigen::Vector3d::Zero());
    joints.before = inner.in_frame.to(first.rest * first_z);
    joints.between = first_z.to(second.rest * second_z);
    joints.after = second_z.to(outer.in_frame);
    joints.rates = {closing[first.drive.column], closing[second.drive.column]};
    pair.clearances = b_outer ? shared_clearance_table({a.solid, a.bounds}, {b.solid, b.bounds}, joints)
                              : shared_clearance_table({b.solid, b.bounds}, {a.solid, a.bounds}, joints);
    pair.columns = {first.drive.column, second.drive.column};
  }
}

void PairPlan::block_pairs() {
  std::map<std::pair<int, int>, std::array<int, kLanes>> lanes;
  for (std::size_t i = 0; i < varying.size(); ++i) {
    const auto [sphere, other] = std::minmax(varying[i].sphere_a, varying[i].sphere_b);
    const auto [block, fresh] = lanes.try_emplace({sphere, other / kLanes * kLanes});
    if (fresh) block->second.fill(-1);
    block->second[other % kLanes] = static_cast<int>(i);
  }
  for (const auto& [at, pairs] : lanes) {
    PairBlock block{at.first, at.second, 0};
    for (int lane = 0; lane < kLanes; ++lane) {
      const int pair = pairs[lane];
      if (pair >= 0) block.lanes = static_cast<std::uint8_t>(block.lanes | 1u << lane);
      pair_of.push_back(pair);
    }
    blocks.push_back(block);
  }
}

MotionRates PairPlan::rates_along(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) const {
  if (rates.finite) return {};
  return bound_motion(q0.cwiseAbs().cwiseMax(q1.cwiseAbs()));
}

Eigen::VectorXd PairPlan::pair_rates(const ShapePair& pair, const Eigen::VectorXd& largest) const {
  return frame_bounds.closing_rates(spheres[pair.sphere_a], spheres[pair.sphere_b], largest);
}

MotionRates PairPlan::bound_motion(const Eigen::VectorXd& largest) const {
  MotionRates out;
  const Eigen::Index columns = largest.size(), squares = frame_bounds.bends() ? columns * (columns + 1) / 2 : 0;
  out.shapes.resize(columns, static_cast<Eigen::Index>(moving.size()));
  out.shape_bends.resize(squares, out.shapes.cols());
  out.pairs.resize(columns, static_cast<Eigen::Index>(varying.size()));
  out.pair_bends.resize(squares, out.pairs.cols());
  out.b_moves.resize(varying.size());
  for (Eigen::Index i = 0; i < out.shapes.cols(); ++i) bound_shape(out, i, largest);
  for (Eigen::Index i = 0; i < out.pairs.cols(); ++i) bound_pair(out, i, largest);
  out.finite =
      out.shapes.allFinite() && out.pairs.allFinite() && out.shape_bends.allFinite() && out.pair_bends.allFinite();
  return out;
}

void PairPlan::bound_shape(MotionRates& out, Eigen::Index i, const Eigen::VectorXd& largest) const {
  out.shapes.col(i) = frame_bounds.point_rates(spheres[i], largest);
  if (frame_bounds.bends()) out.shape_bends.col(i) = frame_bounds.point_bends(spheres[i], largest);
}

void PairPlan::bound_pair(MotionRates& out, Eigen::Index i, const Eigen::VectorXd& largest) const {
  const ShapePair& pair = varying[i];
  out.pairs.col(i) = pair_rates(pair, largest);
  if (!frame_bounds.bends()) return;
  bool b_moves = false;
  out.pair_bends.col(i) = frame_bounds.closing_bends(spheres[pair.sphere_a], spheres[pair.sphere_b], largest, b_moves);
  out.b_moves[i] = b_moves;
}

void PairPlan::bound_attached(const Snapshot& snapshot) {
  const auto attached = [&](int s) { return s >= snapshot.first_attached; };
  for (Eigen::Index i = 0; i < rates.shapes.cols(); ++i) {
    if (attached(moving[i])) bound_shape(rates, i, largest_);
  }
  for (Eigen::Index i = 0; i < rates.pairs.cols(); ++i) {
    if (attached(varying[i].a) || attached(varying[i].b)) bound_pair(rates, i, largest_);
  }
}

Eigen::VectorXd PairPlan::motion_bounds(bool in_scene_only) const {
  const Eigen::Index count = in_scene_only ? moving_in_scene : rates.shapes.cols();
  if (count == 0) return Eigen::VectorXd::Zero(rates.shapes.rows());
  return rates.shapes.leftCols(count).rowwise().maxCoeff();
}

}  // namespace mmgrasp::detail
