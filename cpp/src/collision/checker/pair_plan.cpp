#include <algorithm>
#include <array>
#include <map>

#include "collision/checker/bodies.hpp"

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
  if (assembly[a.link] == assembly[b.link]) return true;
  const auto may_touch = [](const Body& held, const Body& link) {
    return std::binary_search(held.touch_links.begin(), held.touch_links.end(), link.link);
  };
  if (a.held && b.held) return false;
  if (a.held) return may_touch(a, b);
  if (b.held) return may_touch(b, a);
  return snapshot.robot.pair_disabled(a.link, b.link);
}

}  // namespace

std::vector<int> rigid_assemblies(const Robot& robot) {
  return group_links(robot, [&](int joint) { return robot.joints()[joint].type != JointType::fixed; });
}

PairPlan::PairPlan(const Snapshot& snapshot, const JointGroup& group) : frames(group) {
  const Robot& robot = snapshot.robot;
  const std::vector<int> assembly = rigid_assemblies(robot);
  const std::vector<char> active = active_joints(robot, group);
  const std::vector<int> moved_by = group_links(robot, [&](int joint) { return active[joint] != 0; });

  std::vector<char> link_moves(robot.links().size(), 0);
  for (const int link : group.moving_links()) link_moves[link] = 1;
  for (std::size_t s = 0; s < snapshot.shapes.size(); ++s) {
    const BodyShape& shape = snapshot.shapes[s];
    placed.push_back({frames.frame_of(shape.link), frames.link_in_frame(shape.link) * shape.in_link});
    if (shape.solid->never_collides()) continue;
    (link_moves[shape.link] ? moving : fixed).push_back(static_cast<int>(s));
  }
  const auto in_scene = [&](int s) {
    return !snapshot.options.held_only || snapshot.bodies[snapshot.shapes[s].body].held;
  };
  const auto scene_first = [&](std::vector<int>& shapes) {
    return static_cast<int>(std::stable_partition(shapes.begin(), shapes.end(), in_scene) - shapes.begin());
  };
  moving_in_scene = scene_first(moving);
  fixed_in_scene = scene_first(fixed);
  ball_of.assign(snapshot.shapes.size(), -1);
  for (const auto* shapes : {&moving, &fixed}) {
    for (const int s : *shapes) {
      const Solid& solid = *snapshot.shapes[s].padded;
      const Eigen::Vector3d centre = placed[s].in_frame * solid.ball_centre;
      ball_of[s] = static_cast<int>(balls.size());
      balls.push_back({{centre[0], centre[1], centre[2]}, solid.ball_radius, placed[s].frame});
    }
  }
  for (std::size_t i = 0; i < snapshot.shapes.size(); ++i) {
    for (std::size_t j = i + 1; j < snapshot.shapes.size(); ++j) {
      const BodyShape &a = snapshot.shapes[i], &b = snapshot.shapes[j];
      if (a.body == b.body || a.solid->never_collides() || b.solid->never_collides()) continue;
      if (snapshot.options.held_only && !snapshot.bodies[a.body].held && !snapshot.bodies[b.body].held) continue;
      if (never_needs_check(snapshot, snapshot.bodies[a.body], snapshot.bodies[b.body], assembly)) continue;
      const ShapePair pair{static_cast<int>(i),
                           static_cast<int>(j),
                           ball_of[i],
                           ball_of[j],
                           a.solid->ball_radius + b.solid->ball_radius,
                           nullptr,
                           {}};
      (moved_by[a.link] == moved_by[b.link] ? constant : varying).push_back(pair);
    }
  }
  block_pairs();
  find_gap_tables(snapshot);
  // Limits are kept up to rounding.
  rates = bound_motion(group.lower().cwiseAbs().cwiseMax(group.upper().cwiseAbs()) +
                       Eigen::VectorXd::Constant(group.size(), 1e-6));
}

void PairPlan::find_gap_tables(const Snapshot& snapshot) {
  for (ShapePair& pair : varying) {
    const BodyShape &a = snapshot.shapes[pair.a], &b = snapshot.shapes[pair.b];
    if (a.solid->kind != SolidKind::mesh || b.solid->kind != SolidKind::mesh) continue;
    if (snapshot.bodies[a.body].held || snapshot.bodies[b.body].held) continue;
    // Frames are numbered from the root outwards.
    const bool b_outer = placed[pair.b].frame > placed[pair.a].frame;
    const PlacedShape &inner = placed[b_outer ? pair.a : pair.b], &outer = placed[b_outer ? pair.b : pair.a];
    if (outer.frame == 0) continue;
    const FrameStep& second = frames.steps()[outer.frame - 1];
    if (second.parent == 0) continue;
    const FrameStep& first = frames.steps()[second.parent - 1];
    const auto plain = [](const FrameStep& s) {
      return s.motion == FrameMotion::turn && s.multiplier == 1 && s.offset == 0;
    };
    if (first.parent != inner.frame || !plain(first) || !plain(second)) continue;
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(frames.columns());
    frames.add_closing_rates(balls[pair.ball_a], balls[pair.ball_b], rates, rates);
    TwoTurns turns;
    turns.before = inner.in_frame.to(MovingFrames::rest(first));
    turns.between = MovingFrames::rest(second);
    turns.after = outer.in_frame;
    turns.rates = {rates[first.column], rates[second.column]};
    pair.gaps = b_outer ? shared_gap_table({a.solid, a.bounds}, {b.solid, b.bounds}, turns)
                        : shared_gap_table({b.solid, b.bounds}, {a.solid, a.bounds}, turns);
    pair.columns = {first.column, second.column};
  }
}

void PairPlan::block_pairs() {
  std::map<std::pair<int, int>, std::array<int, kLanes>> lanes;
  for (std::size_t i = 0; i < varying.size(); ++i) {
    const auto [ball, other] = std::minmax(varying[i].ball_a, varying[i].ball_b);
    const auto [block, fresh] = lanes.try_emplace({ball, other / kLanes * kLanes});
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

MotionRates PairPlan::bound_motion(const Eigen::VectorXd& largest) const {
  const auto radius = [&](int ball) { return Eigen::Vector3d(balls[ball].p).norm() + balls[ball].radius; };
  MotionRates out;
  Eigen::VectorXd column(largest.size());
  out.shapes.resize(largest.size(), static_cast<Eigen::Index>(moving.size()));
  for (Eigen::Index i = 0; i < out.shapes.cols(); ++i) {
    column.setZero();
    frames.add_rates(balls[i].frame, radius(static_cast<int>(i)), -1, largest, column);
    out.shapes.col(i) = column;
  }
  out.pairs.resize(largest.size(), static_cast<Eigen::Index>(varying.size()));
  for (Eigen::Index i = 0; i < out.pairs.cols(); ++i) {
    const ShapePair& pair = varying[i];
    column.setZero();
    frames.add_closing_rates(balls[pair.ball_a], balls[pair.ball_b], largest, column);
    out.pairs.col(i) = column;
  }
  out.finite = out.shapes.allFinite() && out.pairs.allFinite();
  return out;
}

}  // namespace mmgrasp::detail
