#include "mmgrasp/grasp/hand.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "grasp/hand/hand_outline.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr double kUnitTolerance = 1e-6;
constexpr double kOpeningSlack = 1e-9;  // openings are often width + 2 clearance, computed with rounding
constexpr double kPalmDepth = 0.05;     // of the palm's box along the approach [m]

void check_unit_axis(const Eigen::Vector3d& axis, const std::string& field) {
  require(axis.allFinite(), field, "not finite", "must be a unit vector");
  require(std::abs(axis.norm() - 1.0) <= kUnitTolerance, field + " norm", axis.norm(), "must be 1 within 1e-6");
}

}  // namespace

void HandJoint::check(const std::string& field) const {
  require_number(closed, field + ".closed");
  require_number(open, field + ".open");
}

namespace {

void check_joints(const std::vector<HandJoint>& joints) {
  std::set<std::string> names;
  for (const HandJoint& joint : joints) {
    require(!joint.name.empty(), "hand.joints", "\"\"", "a joint needs a name");
    require(names.insert(joint.name).second, "hand.joints", joint.name, "each joint may be listed once");
    const std::string field = "hand.joints." + joint.name;
    joint.check(field);
    require(!joint.group.empty(), field + ".group", "\"\"", "must have a name");
  }
}

void check_openings(const std::vector<double>& openings, double least, double largest) {
  if (openings.empty()) return;
  require(openings.size() > 1, "hand.openings", std::to_string(openings.size()) + " values", "must be none or >= 2");
  const bool rising = std::adjacent_find(openings.begin(), openings.end(),
                                         [](double a, double b) { return !(a < b); }) == openings.end();
  require(rising, "hand.openings", "not rising", "must rise from closed to open");
  require(openings.front() == least && openings.back() == largest, "hand.openings", openings.back(),
          "must go from min_opening to max_opening");
}

void check_suction(const Hand& hand) {
  hand.suction->check();
  const double sizes[] = {hand.min_opening, hand.max_opening, hand.finger_depth, hand.finger_width, hand.clearance};
  const bool none = std::all_of(std::begin(sizes), std::end(sizes), [](double size) { return size == 0; });
  require(none && hand.joints.empty() && hand.openings.empty() && hand.preshape.empty(), "hand.suction",
          "beside fingers",
          "cups have no fingers: openings, finger_depth, finger_width and clearance must be 0, no joints");
  for (const SuctionCup& cup : hand.suction->cups) {
    const double off = cup.position.dot(hand.approach);
    require(std::abs(off) <= kUnitTolerance, "hand.suction.cups position . hand.approach", off,
            "must be 0: the rims lie in the plane through the tool frame's origin, across the approach [m]");
  }
}

}  // namespace

const char* to_string(ClosingKind kind) {
  switch (kind) {
    case ClosingKind::parallel:
      return "parallel";
    case ClosingKind::angular:
      return "angular";
    case ClosingKind::adaptive:
      return "adaptive";
  }
  return "unknown";
}

void HandBody::check() const {
  require_length(finger_thickness, "hand.body.finger_thickness");
  require_length(finger_length, "hand.body.finger_length");
  require_length(palm_length, "hand.body.palm_length");
  require_length(palm_width, "hand.body.palm_width");
}

Hand Hand::of_cups(const std::string& tool_link, const Eigen::Vector3d& approach, const Suction& suction,
                   const std::vector<std::string>& cup_links) {
  check_unit_axis(approach, "approach");
  Hand hand;
  hand.tool_link = tool_link;
  hand.approach = approach;
  hand.closing = approach.unitOrthogonal();
  hand.max_opening = hand.finger_depth = hand.finger_width = hand.clearance = 0;
  hand.finger_links = cup_links;
  hand.suction = suction;
  hand.check();
  return hand;
}

void Hand::check() const {
  check_unit_axis(approach, "hand.approach");
  check_unit_axis(closing, "hand.closing");
  const double dot = approach.dot(closing);
  require(std::abs(dot) <= kUnitTolerance, "hand.approach . hand.closing", dot,
          "the two axes must be orthogonal within 1e-6");
  if (!std::isinf(payload) || payload < 0) require_positive(payload, "hand.payload", "kg");  // infinite: none is stated
  if (suction) return check_suction(*this);
  require_length(max_opening, "hand.max_opening");
  require(min_opening >= 0 && min_opening < max_opening, "hand.min_opening", min_opening,
          "must be in [0, max_opening) [m]");
  require_length(finger_depth, "hand.finger_depth");
  require_length(finger_width, "hand.finger_width");
  require_not_negative(clearance, "hand.clearance", "m");
  check_joints(joints);
  check_openings(openings, min_opening, max_opening);
  const std::vector<std::string> known = groups();
  for (const auto& [group, share] : preshape) {
    require(std::find(known.begin(), known.end(), group) != known.end(), "hand.preshape", group,
            "must be a group of the hand's joints");
    require(share >= 0 && share <= 1, "hand.preshape." + group, share, "must be in [0, 1]");
  }
  body.check();
}

void Hand::check_fingers() const {
  check();
  require(!suction, "hand", "suction cups", "must be a hand with fingers");
}

std::vector<std::string> Hand::groups() const {
  std::vector<std::string> names;
  for (const HandJoint& joint : joints)
    if (std::find(names.begin(), names.end(), joint.group) == names.end()) names.push_back(joint.group);
  return names;
}

double Hand::share_open(double opening) const {
  require(opening >= -kOpeningSlack && opening <= max_opening + kOpeningSlack, "opening", opening,
          "must lie between 0 and the hand's max_opening " + std::to_string(max_opening) + " [m]");
  if (suction) return 0;
  if (openings.empty()) return std::clamp((opening - min_opening) / (max_opening - min_opening), 0.0, 1.0);
  const double within = std::clamp(opening, min_opening, max_opening);
  const auto above = std::upper_bound(openings.begin() + 1, openings.end() - 1, within);
  const double low = *(above - 1), rest = (within - low) / (*above - low);
  return (static_cast<double>(above - 1 - openings.begin()) + rest) / static_cast<double>(openings.size() - 1);
}

double Hand::opening_at(double share_open) const {
  require(share_open >= 0 && share_open <= 1, "share_open", share_open, "must be in [0, 1], 0 closed and 1 open");
  if (openings.empty()) return min_opening + share_open * (max_opening - min_opening);
  const double at = share_open * static_cast<double>(openings.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), openings.size() - 2);
  return openings[below] + (at - static_cast<double>(below)) * (openings[below + 1] - openings[below]);
}

std::map<std::string, double> Hand::joint_values(double opening) const {
  const double open = share_open(opening);
  std::map<std::string, double> values;
  for (const HandJoint& joint : joints) {
    const auto kept = preshape.find(joint.group);
    const double share = kept == preshape.end() ? open : kept->second;
    values[joint.name] = joint.closed + share * (joint.open - joint.closed);
  }
  return values;
}

std::map<std::string, double> Hand::joint_values(const std::vector<double>& posture) const {
  const std::vector<std::string> names = groups();
  require(posture.size() == names.size(), "posture", std::to_string(posture.size()) + " numbers",
          "must be one for each of the hand's " + std::to_string(names.size()) + " joint groups");
  std::map<std::string, double> values;
  for (const HandJoint& joint : joints) {
    const double share = posture[std::find(names.begin(), names.end(), joint.group) - names.begin()];
    require(share >= 0 && share <= 1, "posture of " + joint.group, share, "must be in [0, 1], 0 closed and 1 open");
    values[joint.name] = joint.closed + share * (joint.open - joint.closed);
  }
  return values;
}

std::map<std::string, double> Hand::joint_values(const Grasp& grasp) const {
  return grasp.posture.empty() ? joint_values(grasp.opening) : joint_values(grasp.posture);
}

double Hand::pregrasp_opening(double width) const {
  require(width >= 0 && width <= max_opening + kOpeningSlack, "width", width,
          "must lie between 0 and the hand's max_opening " + std::to_string(max_opening) + " [m]");
  return std::min(width + 2 * clearance, max_opening);
}

std::vector<LinkShape> Hand::shapes(double opening) const {
  check_fingers();
  const detail::HandOutline outline(*this, opening);
  Pose T_hand_axes = Pose::Identity();
  T_hand_axes.linear() << approach, closing, approach.cross(closing);
  const double tips = finger_depth / 2;
  const auto box = [&](double near, double far, double left, double right, double side) {
    LinkShape shape;
    shape.shape.emplace<Box>().size << far - near, right - left, 2 * side;
    shape.T_link_shape = T_hand_axes * Eigen::Translation3d((near + far) / 2, (left + right) / 2, 0);
    return shape;
  };
  const double palm = tips - body.finger_length;
  return {box(palm, tips, -outline.outer, -outline.inner, outline.side),
          box(palm, tips, outline.inner, outline.outer, outline.side),
          box(palm - kPalmDepth, palm, -outline.palm, outline.palm, outline.palm_side)};
}

namespace detail {

HandOutline::HandOutline(const Hand& hand, double opening)
    : inner(opening / 2),
      outer(inner + hand.body.finger_thickness),
      side(hand.finger_width / 2),
      palm(std::max(hand.body.palm_length / 2, outer)),
      palm_side(std::max(hand.body.palm_width / 2, side)) {
  require(opening >= 0 && opening <= hand.max_opening + kOpeningSlack, "opening", opening,
          "must be from 0 to the hand's max_opening [m]");
}

}  // namespace detail
}  // namespace mmgrasp
