// Holds grasps against their parts: every one listed must have something of the part between the pads, and those that
// are used the width at which pads of the gripper's size meet it.
#include <algorithm>
#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kThickness = 0.02;  // Thickness of the pads that stand for the fingers [m].
constexpr double kPoint = 1e-3;      // Size of a pad's middle [m].
constexpr double kStep = 5e-4;       // A pad comes in by such steps [m].
constexpr int kHalvings = 12;        // How often the last step is halved.
constexpr double kPlay = 3e-3;       // How far the width may be off the part's [m],
constexpr double kShare = 0.1;       // or this share of it.

CheckedPads pads_of(const PlanToCheck& plan) {
  return {plan.approach, plan.closing, plan.max_opening, plan.finger_depth, plan.finger_width};
}

/// The axes of a hand at its tool frame: approach, closing, across.
Pose hand_axes(const CheckedPads& hand, const Pose& T_object_hand) {
  Eigen::Matrix3d axes;
  axes << hand.approach, hand.closing, hand.approach.cross(hand.closing);
  Pose T = T_object_hand;
  T.linear() = T_object_hand.linear() * axes;
  return T;
}

/// How far from the middle plane of the hand a pad stops when it comes in on one side. `depth` and `width`: its size
/// along the approach and across approach and closing.
class Pad {
 public:
  Pad(const CheckedPads& hand, const PlacedBody& part, const Pose& T_object_hand, double depth, double width)
      : part_(part) {
    T_object_pads_ = hand_axes(hand, T_object_hand);
    LinkShape shape;
    shape.shape = Box{Eigen::Vector3d(depth, kThickness, width)};
    pad_ = make_solids({shape}).front();
  }

  /// What is between two pads that come in from both sides [m].
  double between(double from) const { return stops_at(1, from) + stops_at(-1, from); }

 private:
  /// `side`: 1 or -1; `from`: where it starts [m]. A negative answer: it passes through the middle and meets nothing.
  double stops_at(double side, double from) const {
    double free = from;
    while (free > -from && !touches_at(side, free - kStep)) free -= kStep;
    double blocked = free - kStep;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (free + blocked);
      (touches_at(side, middle) ? blocked : free) = middle;
    }
    return free;
  }

  bool touches_at(double side, double distance) const {
    Pose T = T_object_pads_;
    T.translate(Eigen::Vector3d(0, side * (distance + 0.5 * kThickness), 0));
    const Bounds bounds = bounds_at(pad_, T);
    for (std::size_t i = 0; i < part_.solids.size(); ++i) {
      if (bounds.intersects(part_.bounds[i]) && touches(pad_, T, part_.solids[i], part_.T_world_shape[i])) return true;
    }
    return false;
  }

  const PlacedBody& part_;
  Pose T_object_pads_ = Pose::Identity();
  Solid pad_;
};

/// Whether fingers that close from their widest opening meet anything.
bool holds_something(const CheckedPads& hand, const PlacedBody& part, const Pose& T_object_hand) {
  LinkShape shape;
  shape.shape = Box{Eigen::Vector3d(hand.finger_depth, hand.max_opening, hand.finger_width)};
  const Solid between = make_solids({shape}).front();
  const Pose T = hand_axes(hand, T_object_hand);
  const Bounds bounds = bounds_at(between, T);
  for (std::size_t i = 0; i < part.solids.size(); ++i) {
    if (bounds.intersects(part.bounds[i]) && touches(between, T, part.solids[i], part.T_world_shape[i])) return true;
  }
  return false;
}

/// Grasps that hold nothing would let parts pass as graspable, whether they are used or not.
void check_listed_grasps(const PlanToCheck& plan, Faults& faults) {
  for (const CheckedPart& part : plan.parts) {
    if (!part.target) continue;
    const PlacedBody body = place_body(part.body.name, part.body.shapes, Pose::Identity());
    const auto empty = std::count_if(part.grasps.begin(), part.grasps.end(), [&](const CheckedGrasp& grasp) {
      return !holds_something(pads_of(plan), body, grasp.T_object_hand);
    });
    if (empty == 0) continue;
    faults.push_back({"grasp-empty", "part '" + part.body.name + "'",
                      std::to_string(empty) + " of its " + std::to_string(part.grasps.size()) +
                          " grasps have nothing of it between the fingers"});
  }
}

}  // namespace

void check_grasp_openings(const Context& context, Faults& faults) {
  const PlanToCheck& plan = context.plan;
  if (!(plan.finger_depth > 0 && plan.finger_width > 0)) return;
  check_listed_grasps(plan, faults);
  for (std::size_t pick = 0; pick < plan.picks.size(); ++pick) {
    const int index = context.pick_part[pick], g = plan.picks[pick].grasp;
    if (index < 0 || g < 0 || g >= static_cast<int>(plan.parts[index].grasps.size())) continue;  // said at the pick
    const CheckedPart& part = plan.parts[index];
    const CheckedGrasp& grasp = part.grasps[g];
    const std::optional<double> width = width_unlike_opening(pads_of(plan), part.body.shapes, grasp);
    if (!width) continue;
    faults.push_back({"grasp-opening", context.pick_name(pick),
                      "its grasp says " + text(grasp.opening) + " m, pads of " + text(plan.finger_depth) + " x " +
                          text(plan.finger_width) + " m meet the part at " + text(*width) + " m"});
  }
}

}  // namespace mmgrasp::verify::detail

namespace mmgrasp::verify {

std::optional<double> width_unlike_opening(const CheckedPads& pads, const std::vector<LinkShape>& part,
                                           const CheckedGrasp& grasp) {
  const detail::PlacedBody body = detail::place_body("part", part, Pose::Identity());
  const double from = 0.5 * pads.max_opening + 2 * detail::kPlay;
  const double play = std::max(detail::kPlay, detail::kShare * grasp.opening);
  // Where the pads' middles meet the part, or where the first of their edges does: pads are said to be larger than
  // what the part leaves room for beside a bend.
  const detail::Pad point(pads, body, grasp.T_object_hand, detail::kPoint, detail::kPoint);
  if (std::abs(point.between(from) - grasp.opening) <= play) return {};
  const detail::Pad pad(pads, body, grasp.T_object_hand, pads.finger_depth, pads.finger_width);
  const double between = pad.between(from);
  if (std::abs(between - grasp.opening) <= play) return {};
  return between;
}

}  // namespace mmgrasp::verify
