// Holds grasps against their parts: every one listed must have something of the part between the pads, and at those
// that are used pads of the gripper's size must meet it, both where the grasp says.
#include <algorithm>
#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kThickness = 1e-3;  // Thickness of a pad [m]: more than a step, so that it passes through nothing.
constexpr double kStep = 5e-4;       // A pad comes in by such steps [m].
constexpr int kHalvings = 12;        // How often the last step is halved.

CheckedPads pads_of(const PlanToCheck& plan) {
  return {plan.approach, plan.closing, plan.max_opening, plan.finger_depth, plan.finger_width, plan.clearance};
}

/// The axes of a hand at its tool frame: approach, closing, across.
Pose hand_axes(const CheckedPads& hand, const Pose& T_object_hand) {
  Eigen::Matrix3d axes;
  axes << hand.approach, hand.closing, hand.approach.cross(hand.closing);
  Pose T = T_object_hand;
  T.linear() = T_object_hand.linear() * axes;
  return T;
}

/// A pad that comes in from one side.
class Pad {
 public:
  Pad(const CheckedPads& hand, const PlacedBody& part, const Pose& T_object_hand) : part_(part) {
    T_object_pads_ = hand_axes(hand, T_object_hand);
    LinkShape shape;
    shape.shape = Box{Eigen::Vector3d(hand.finger_depth, kThickness, hand.finger_width)};
    pad_ = make_solids({shape}).front();
  }

  /// How far from the hand's middle plane it stops on the side 1 or -1 when it comes from there [m]; beyond `from`
  /// where it has no room at the start, negative where it passes through the middle.
  double stops_at(double side, double from) const {
    if (touches_at(side, from)) return from + kStep;
    double free = from;
    while (free > -from && !touches_at(side, free - kStep)) free -= kStep;
    double blocked = free - kStep;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (free + blocked);
      (touches_at(side, middle) ? blocked : free) = middle;
    }
    return free;
  }

 private:
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
    if (part.scanned) continue;
    const CheckedGrasp& grasp = part.grasps[g];
    const std::string unlike = pads_unlike_grasp(pads_of(plan), part.body.shapes, grasp);
    if (!unlike.empty()) faults.push_back({"grasp-opening", context.pick_name(pick), unlike});
  }
}

}  // namespace mmgrasp::verify::detail

namespace mmgrasp::verify {

std::string pads_unlike_grasp(const CheckedPads& pads, const std::vector<LinkShape>& part, const CheckedGrasp& grasp) {
  const detail::PlacedBody body = detail::place_body("part", part, Pose::Identity());
  const double half = 0.5 * grasp.opening, play = grip_play(grasp.opening);
  const double before = std::min(half + pads.clearance, 0.5 * pads.max_opening);
  const double from = std::max(half + play, before - detail::kThickness);
  const detail::Pad pad(pads, body, grasp.T_object_hand);
  double one = pad.stops_at(1, from), other = pad.stops_at(-1, from);
  if (std::abs(one - half) <= play && std::abs(other - half) <= play) return {};
  const std::string size =
      "pads of " + detail::text(pads.finger_depth) + " x " + detail::text(pads.finger_width) + " m";
  if (std::max(one, other) > from) {  // They come from farther out than the hand would be open before the grasp.
    const double widest = 0.5 * pads.max_opening + play;
    one = pad.stops_at(1, widest);
    other = pad.stops_at(-1, widest);
    if (std::max(one, other) > widest) return size + " have no room beside the part, however far the hand opens";
  }
  if (one + other <= 0) return size + " meet nothing of the part between them";
  if (std::abs(one + other - grasp.opening) <= 2 * play)
    return size + " meet the part " + detail::text(0.5 * std::abs(one - other)) +
           " m beside the middle of the hand, whose fingers close alike";
  return "its opening is " + detail::text(grasp.opening) + " m, " + size + " meet the part at " +
         detail::text(one + other) + " m";
}

}  // namespace mmgrasp::verify
