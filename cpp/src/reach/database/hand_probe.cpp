#include "reach/database/hand_probe.hpp"

#include <algorithm>
#include <set>

#include "mmgrasp/collision/detail/named_bodies.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

/// Links whose pose in `frame` (a link, or the world for -1) is the same whatever the configuration.
std::vector<int> still_links(const JointGroup& arm, int frame) {
  constexpr int kTries = 4;
  constexpr double kPoseTolerance = 1e-9;  // relative difference of poses that count as the same
  Rng rng(1);
  std::vector<Poses> tries(kTries);
  for (Poses& poses : tries) arm.link_poses(rng.uniform(arm.sample_lower(), arm.sample_upper()), poses);
  const auto seen = [&](const Poses& poses, std::size_t link) {
    return frame < 0 ? poses[link] : poses[frame].inverse() * poses[link];
  };
  std::vector<int> still;
  for (std::size_t link = 0; link < tries[0].size(); ++link) {
    bool same = true;
    for (const Poses& poses : tries) same = same && seen(poses, link).isApprox(seen(tries[0], link), kPoseTolerance);
    if (same) still.push_back(static_cast<int>(link));
  }
  return still;
}

void append(std::vector<LinkShape>& shapes, const std::vector<LinkShape>& more, const Pose& T) {
  for (LinkShape shape : more) {
    if (std::holds_alternative<Plane>(shape.shape)) continue;
    shape.T_link_shape = T * shape.T_link_shape;
    shapes.push_back(std::move(shape));
  }
}

std::optional<CollisionChecker> probe(const std::vector<LinkShape>& hand, World world) {
  if (hand.empty() || (world.objects().empty() && world.fields().empty())) return std::nullopt;
  // Attached objects go wherever the root of this robot of nothing is put.
  static const Robot nothing = Robot::from_strings(
      "<robot name='nothing'><link name='tip'/><link name='end'/><joint name='still' type='revolute'>"
      "<parent link='tip'/><child link='end'/><axis xyz='0 0 1'/>"
      "<limit lower='-1' upper='1' velocity='1' effort='1'/></joint></robot>");
  const std::string name = "the hand and what it holds";
  world.add(name, WorldObject{hand, Pose::Identity()});
  world.attach(name, "tip", Pose::Identity());
  CheckerOptions options;
  options.check_self = false;
  return CollisionChecker(nothing.chain("tip", "end"), world, options);
}

}  // namespace

HandProbe::HandProbe(const JointGroup& arm, const World& world) : still_(Eigen::VectorXd::Zero(1)) {
  const Robot& robot = arm.robot();
  const std::vector<int> hand_links = still_links(arm, arm.tip_link()), fixed_links = still_links(arm, -1);
  Poses poses;
  arm.link_poses(0.5 * (arm.sample_lower() + arm.sample_upper()), poses);
  const Pose T_tip_world = poses[arm.tip_link()].inverse();
  std::vector<LinkShape> links, all;
  std::set<std::string> names;
  for (const int link : hand_links) {
    append(links, robot.links()[link].collisions, T_tip_world * poses[link]);
    names.insert(robot.links()[link].name);
  }
  all = links;
  for (const auto& [name, held] : world.attached()) {
    if (!robot.has_link(held.link)) continue;
    const int link = robot.link_index(held.link);
    if (std::find(hand_links.begin(), hand_links.end(), link) == hand_links.end()) continue;
    append(all, held.shapes, T_tip_world * poses[link] * held.T_link_object);
    names.insert(name);
  }
  const AllowedPairs allowed(robot, world);
  World fixed;
  for (const int link : fixed_links) {
    bool looked_at = true;
    const Link& body = robot.links()[link];
    for (const int hand : hand_links) {
      looked_at = looked_at && hand != link && !robot.pair_disabled(hand, link) &&
                  !allowed(robot.links()[hand].name, body.name);
    }
    std::vector<LinkShape> shapes;
    append(shapes, body.collisions, Pose::Identity());
    if (looked_at && !shapes.empty()) fixed.add(body.name, WorldObject{shapes, poses[link]});
  }
  robot_ = probe(links, std::move(fixed));
  scene_ = probe(all, objects_never_touched(robot, world, names));
}

HandProbe::HandProbe(const HandProbe& other) : still_(other.still_) {
  if (other.robot_) robot_ = other.robot_->clone();
  if (other.scene_) scene_ = other.scene_->clone();
}

Rejection HandProbe::rejection(const Pose& T_world_tip) {
  const auto hits = [&](std::optional<CollisionChecker>& checker) {
    if (!checker) return false;
    checker->set_root(T_world_tip);
    return !checker->is_free(still_);
  };
  if (hits(robot_)) return Rejection::self_collision;
  return hits(scene_) ? Rejection::scene : Rejection::none;
}

}  // namespace mmgrasp::detail
