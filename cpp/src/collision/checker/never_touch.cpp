#include "collision/checker/never_touch.hpp"

#include <algorithm>
#include <queue>

#include "collision/narrow/narrow.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr double kBeyondLimits =
    1e-4;  // values a little outside of their printed limits are taken as within [rad or m]
constexpr double kLeastClearance = 1e-6;  // nearer bodies count as touching [m]

}  // namespace

NeverTouch::NeverTouch(const Snapshot& snapshot) : snapshot_(snapshot), shapes_of_(snapshot.bodies.size()) {
  for (std::size_t s = 0; s < snapshot.shapes.size(); ++s)
    shapes_of_[snapshot.shapes[s].body].push_back(static_cast<int>(s));
}

bool NeverTouch::proven(int body_a, int body_b, int max_boxes) const {
  std::vector<Mover> of_a, of_b;
  if (!movers_between(snapshot_.bodies[body_a].link, snapshot_.bodies[body_b].link, of_a, of_b)) return false;
  // The box with the least clearance first: bodies that touch are found out soon.
  const auto later = [](const Box& x, const Box& y) { return x.clearance > y.clearance; };
  std::priority_queue<Box, std::vector<Box>, decltype(later)> open(later);
  open.push(whole_range(of_a, of_b));
  if (!open.top().half.allFinite()) return false;
  for (int boxes = 0; !open.empty(); ++boxes) {
    if (boxes == max_boxes) return false;
    Box box = open.top();
    open.pop();
    const Verdict verdict = judge(box, body_a, body_b, of_a, of_b);
    if (verdict.touching) return false;
    if (verdict.proven) continue;
    box.clearance = verdict.clearance;
    box.half[verdict.widest] /= 2;
    box.middle[verdict.widest] -= box.half[verdict.widest];
    open.push(box);
    box.middle[verdict.widest] += 2 * box.half[verdict.widest];
    open.push(box);
  }
  return true;
}

bool NeverTouch::movers_between(int link_a, int link_b, std::vector<Mover>& of_a, std::vector<Mover>& of_b) const {
  const Robot& robot = snapshot_.robot;
  std::vector<char> above_a(robot.links().size(), 0);
  for (int link = link_a; link >= 0;) {
    above_a[link] = 1;
    const int joint = robot.links()[link].parent_joint;
    link = joint < 0 ? -1 : robot.joints()[joint].parent_link;
  }
  int common = link_b;
  while (!above_a[common]) common = robot.joints()[robot.links()[common].parent_joint].parent_link;
  return movers_up_to(link_a, common, of_a) && movers_up_to(link_b, common, of_b);
}

// The movers from a link up to one above it, the nearest first; false where a joint has several values.
bool NeverTouch::movers_up_to(int link, int top, std::vector<Mover>& out) const {
  const Robot& robot = snapshot_.robot;
  while (link != top) {
    const Joint& joint = robot.joints()[robot.links()[link].parent_joint];
    if (joint.value_count() > 1) return false;
    const Joint& driven = joint.mimic_joint >= 0 ? robot.joints()[joint.mimic_joint] : joint;
    if (driven.value_index >= 0) {
      const double factor = joint.mimic_joint >= 0 ? std::abs(joint.mimic_multiplier) : 1;
      out.push_back({link, driven.value_index, factor, joint.axis, joint.type == JointType::prismatic});
    }
    link = joint.parent_link;
  }
  return true;
}

NeverTouch::Box NeverTouch::whole_range(const std::vector<Mover>& of_a, const std::vector<Mover>& of_b) const {
  const Robot& robot = snapshot_.robot;
  Box box{robot.default_values(), Eigen::VectorXd::Zero(robot.value_count()), 0};
  for (const std::vector<Mover>* movers : {&of_a, &of_b}) {
    for (const Mover& mover : *movers) {
      const auto joint = std::find_if(robot.joints().begin(), robot.joints().end(),
                                      [&](const Joint& j) { return j.value_index == mover.value; });
      if (joint->type == JointType::continuous) {
        box.middle[mover.value] = 0;
        box.half[mover.value] = kPi;
      } else {
        box.middle[mover.value] = (joint->lower + joint->upper) / 2;
        box.half[mover.value] = (joint->upper - joint->lower) / 2 + kBeyondLimits;
      }
    }
  }
  return box;
}

NeverTouch::Extent::Extent(const BodyShape& shape, const Pose& link)
    : centre(link * shape.sphere_centre), radius(shape.solid->sphere_radius) {
  const Rigid T_world_shape = Rigid(link) * shape.in_link;
  // A rounded body comes nowhere that its core does not bring it: a sphere that turns about itself does not move.
  const double rounding = shape.solid->kind == SolidKind::convex ? shape.solid->core.radius : 0;
  const Eigen::Vector3d half =
      (shape.solid->box_half.array() - rounding).max(0).matrix() + Eigen::Vector3d::Constant(shape.solid->margin);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d sign(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    corners[k] = T_world_shape * (shape.solid->box_centre + sign.cwiseProduct(half));
  }
}

double NeverTouch::Extent::from_axis(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis) const {
  const auto squared = [&](const Eigen::Vector3d& point) { return axis.cross(point - origin).squaredNorm(); };
  double of_box = 0;
  for (const Eigen::Vector3d& corner : corners) of_box = std::max(of_box, squared(corner));
  return std::min(std::sqrt(of_box), std::sqrt(squared(centre)) + radius);
}

// A bound on how far a point of the shape moves while the movers do. They move one after the other, the nearest to the
// body first: by then the others' axes stand where they do at the middle, and the point is at most as far from there as
// it has moved so far.
double NeverTouch::motion(const std::vector<Mover>& movers, const Poses& links, const Extent& extent,
                          const Eigen::VectorXd& half, Eigen::VectorXd& of_value) const {
  double moved = 0;
  for (const Mover& mover : movers) {
    const double by = mover.factor * half[mover.value];
    double step = by;
    if (!mover.slides) {
      const Pose& frame = links[mover.link];
      const double lever = extent.from_axis(frame.translation(), frame.linear() * mover.axis) + moved;
      step = 2 * lever * std::sin(std::min(by, kPi) / 2);  // the chord
    }
    moved += step;
    of_value[mover.value] += step;
  }
  return moved;
}

NeverTouch::Verdict NeverTouch::judge(const Box& box, int body_a, int body_b, const std::vector<Mover>& of_a,
                                      const std::vector<Mover>& of_b) const {
  const Poses links = snapshot_.robot.link_poses(box.middle);
  Verdict verdict{true, false, kInfinity, -1};
  double least_margin = 0;  // of the clearance over the motion
  Eigen::VectorXd of_value(box.half.size());
  for (const int i : shapes_of_[body_a]) {
    for (const int j : shapes_of_[body_b]) {
      const BodyShape &a = snapshot_.shapes[i], &b = snapshot_.shapes[j];
      const Extent at_a(a, links[a.link]), at_b(b, links[b.link]);
      of_value.setZero();
      const double moved =
          motion(of_a, links, at_a, box.half, of_value) + motion(of_b, links, at_b, box.half, of_value);
      const double apart = (at_a.centre - at_b.centre).norm(), needed = moved + kLeastClearance;
      double clearance = apart - at_a.radius - at_b.radius;
      if (clearance > needed) continue;
      // No body is nearer to the other one than spheres are, nor farther away than their middles: a larger motion is
      // beyond what the exact distance could prove.
      if (apart > needed) {
        clearance = solids_distance(*a.solid, Rigid(links[a.link]) * a.in_link, *b.solid,
                                    Rigid(links[b.link]) * b.in_link, needed + kLeastClearance)
                        .distance;
        if (clearance > needed) continue;
        if (clearance <= kLeastClearance) verdict.touching = true;
      }
      verdict.proven = false;
      verdict.clearance = std::min(verdict.clearance, clearance);
      if (verdict.widest < 0 || clearance - needed < least_margin) {
        least_margin = clearance - needed;
        of_value.maxCoeff(&verdict.widest);
      }
    }
  }
  return verdict;
}

}  // namespace mmgrasp::detail
