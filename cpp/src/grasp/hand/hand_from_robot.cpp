// Hand::from_robot: a hand read from URDF and SRDF, its opening measured by forward kinematics.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "grasp/hand/finger_shapes.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {
namespace {

using detail::FingerShapes;
using Eigen::Vector3d;

constexpr double kSameOpening = 1e-9;  // a table that deviates less from a line is one [m]
constexpr double kTurned = 1e-3;       // pads that turn less stay parallel [rad]
constexpr int kBisections = 60;
constexpr double kNextToAxis = 0.05;  // directions this near to an axis of the tool frame are that axis [rad]
constexpr double kOffAxis = 0.35;     // fingers that point farther from every axis tell no approach [rad]

/// The range of a driven joint.
struct Drive {
  int joint = -1;
  double closed = 0, open = 0;
  bool spreads = false;      ///< Moves its fingers across the plane in which they close.
  bool stated_open = false;  ///< The SRDF says where the hand is open, or closed.
};

/// SRDF end effector, group or, without a name, every driven joint below the tool's rigid body.
std::vector<int> driven_joints(const Robot& robot, const std::string& group, int tool_link) {
  std::vector<int> joints;
  if (group.empty()) {
    const int body = detail::rigid_body_root(robot, tool_link);
    for (std::size_t i = 0; i < robot.joints().size(); ++i) {
      const Joint& joint = robot.joints()[i];
      if (joint.type != JointType::fixed && joint.mimic_joint < 0 && detail::hangs_on(robot, joint.parent_link, body))
        joints.push_back(static_cast<int>(i));
    }
    return joints;
  }
  std::string name = group;
  for (const EndEffectorDescription& effector : robot.end_effectors())
    if (effector.name == group) name = effector.group;
  for (const GroupDescription& described : robot.groups()) {
    if (described.name != name) continue;
    for (const std::string& joint : described.joints) joints.push_back(robot.joint_index(joint));
    return joints;
  }
  throw InvalidInput("group = " + group + ": the SRDF has no end effector or group of this name");
}

/// Joint values of an SRDF state of the hand's group; nothing when there is none of these names.
std::map<std::string, double> state_of(const Robot& robot, const std::string& group,
                                       const std::vector<std::string>& names) {
  std::string of = group;
  for (const EndEffectorDescription& effector : robot.end_effectors())
    if (effector.name == group) of = effector.group;
  const auto states = robot.group_states().find(of);
  if (states == robot.group_states().end()) return {};
  for (const std::string& name : names)
    if (const auto found = states->second.find(name); found != states->second.end()) return found->second;
  return {};
}

/// Builds a Hand step by step: its driven joints, its axes, which end of each joint is open, range and openings.
class Reader {
 public:
  Reader(const Robot& robot, const std::string& tool_link, const HandReading& reading)
      : robot_(robot), reading_(reading), tool_(robot.link_index(tool_link)), values_(robot.default_values()) {
    hand_.tool_link = tool_link;
    hand_.clearance = reading.clearance;
  }

  Hand read() {
    find_drives();
    shapes_.emplace(robot_, tool_, joints());
    for (const Drive& drive : drives_) value(drive) = (drive.closed + drive.open) / 2;
    find_axes();
    if (!shapes_->choose_tips(values_, hand_.approach, hand_.closing))
      throw unreadable("no two finger tips stand on opposite sides of the tool frame", "closing");
    orient_drives();
    set_range();
    describe();
    hand_.check();
    return hand_;
  }

 private:
  std::vector<int> joints() const {
    std::vector<int> indices;
    for (const Drive& drive : drives_) indices.push_back(drive.joint);
    return indices;
  }
  double& value(const Drive& drive) { return values_[robot_.joints()[drive.joint].value_index]; }

  void find_drives() {
    for (const int index : driven_joints(robot_, reading_.group, tool_)) {
      const Joint& joint = robot_.joints()[index];
      const std::string field = "joint '" + joint.name + "' of the hand";
      require(joint.value_count() == 1 && joint.type != JointType::continuous, field, to_string(joint.type),
              "must be revolute or prismatic");
      require(std::isfinite(joint.lower) && std::isfinite(joint.upper) && joint.lower < joint.upper, field,
              std::to_string(joint.lower) + " to " + std::to_string(joint.upper), "must have limits");
      drives_.push_back({index, joint.lower, joint.upper});
    }
    const auto closed = state_of(robot_, reading_.group, {"closed", "close"});
    const auto open = state_of(robot_, reading_.group, {"open", "opened"});
    for (Drive& drive : drives_) {
      const std::string& name = robot_.joints()[drive.joint].name;
      const auto from = closed.find(name), to = open.find(name);
      drive.stated_open = from != closed.end() || to != open.end();
      if (!drive.stated_open) continue;
      // The end that is not stated is the limit farther from the one that is.
      const auto other = [&](double stated) {
        return stated - drive.closed < drive.open - stated ? drive.open : drive.closed;
      };
      const double shut = from != closed.end() ? from->second : other(to->second);
      drive.open = to != open.end() ? to->second : other(from->second);
      drive.closed = shut;
    }
    require(!drives_.empty(), "tool_link", hand_.tool_link, "no driven joint was found that moves fingers beside it");
  }

  /// Why fingers half way between the ends of their joints tell nothing, with what to do about it.
  InvalidInput unreadable(const std::string& why, const std::string& axis) const {
    const Drive& widest = *std::max_element(drives_.begin(), drives_.end(), [](const Drive& a, const Drive& b) {
      return std::abs(a.open - a.closed) < std::abs(b.open - b.closed);
    });
    const auto number = [](double x) {
      const std::string text = std::to_string(x);
      return text.substr(0, text.size() - 3);
    };
    return InvalidInput("hand = " + robot_.name() + ", tool_link = " + hand_.tool_link +
                        ": half way between the ends of the joints (" + robot_.joints()[widest.joint].name + ": " +
                        number(widest.closed) + " to " + number(widest.open) + ") " + why +
                        ". Limits wider than the hand's own let its fingers curl past the palm: narrow them, or name "
                        "states 'open' and 'closed' of the hand's group in the SRDF; else give `" +
                        axis + "` or another tool frame");
  }

  /// How a drive moves each tip from its lower to its upper end, all others half way.
  std::vector<Vector3d> tip_moves(const Drive& drive) {
    const double before = value(drive);
    value(drive) = drive.closed;
    std::vector<Vector3d> moves = shapes_->leaf_centres(values_);
    for (Vector3d& move : moves) move = -move;
    value(drive) = drive.open;
    const std::vector<Vector3d> ends = shapes_->leaf_centres(values_);
    for (std::size_t i = 0; i < moves.size(); ++i) moves[i] += ends[i];
    value(drive) = before;
    return moves;
  }

  void find_axes() {
    const Vector3d outward = shapes_->outward(values_);
    if (reading_.approach) {
      hand_.approach = *reading_.approach;
    } else {
      Eigen::Index axis = 0;
      outward.cwiseAbs().maxCoeff(&axis);
      hand_.approach = Vector3d::Unit(axis) * (outward[axis] < 0 ? -1.0 : 1.0);
      if (!(outward.dot(hand_.approach) > std::cos(kOffAxis) * outward.norm()))
        throw unreadable("no axis of the tool frame lies along the fingers", "approach");
    }
    if (reading_.closing) {
      hand_.closing = *reading_.closing;
      return;
    }
    // Across the approach, the direction in which the tips move most: the frame may be turned against the fingers.
    Eigen::Matrix3d moved = Eigen::Matrix3d::Zero();
    for (const Drive& drive : drives_) {
      for (Vector3d move : tip_moves(drive)) {
        move -= move.dot(hand_.approach) * hand_.approach;
        moved += move * move.transpose();
      }
    }
    const Vector3d most = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moved).eigenvectors().col(2);
    Eigen::Index axis = 0;
    most.cwiseAbs().maxCoeff(&axis);
    const bool on_axis = std::abs(most[axis]) > std::cos(kNextToAxis);
    hand_.closing = on_axis ? Vector3d(Vector3d::Unit(axis)) : Vector3d(most[axis] < 0 ? -most : most);
    hand_.closing = (hand_.closing - hand_.closing.dot(hand_.approach) * hand_.approach).normalized();
  }

  /// Turns every drive's range so that `open` is the end at which its tips stand farther from the middle.
  void orient_drives() {
    const Vector3d across = hand_.approach.cross(hand_.closing);
    for (Drive& drive : drives_) {
      const std::vector<Vector3d> moves = tip_moves(drive);
      double outward = 0, along = 0, aside = 0;
      for (const FingerShapes::Tip& tip : shapes_->tips()) {
        outward += tip.side * moves[tip.leaf].dot(hand_.closing);
        along += std::abs(moves[tip.leaf].dot(hand_.closing));
        aside += std::abs(moves[tip.leaf].dot(across));
      }
      drive.spreads = aside > along;
      if (!drive.spreads && !drive.stated_open && outward < 0) std::swap(drive.closed, drive.open);
    }
  }

  void set_share(double share) {
    const Eigen::VectorXd rest = robot_.default_values();
    for (const Drive& drive : drives_) {
      value(drive) = drive.spreads ? rest[robot_.joints()[drive.joint].value_index]
                                   : drive.closed + share * (drive.open - drive.closed);
    }
  }

  double clearance_at(double share) {
    set_share(share);
    return shapes_->clearance_between(values_, hand_.finger_depth / 2);
  }

  /// Moves both ends of the closing joints: open is where the fingers stand farthest apart, closed where they first
  /// meet from there, or come no nearer.
  void set_range() {
    const int n = reading_.postures;
    double reach = -detail::kInfinity;
    for (int i = 0; i <= n; ++i) {
      set_share(static_cast<double>(i) / n);
      reach = std::max(reach, shapes_->reach(values_));
    }
    require(reach > 0, "tool_link", hand_.tool_link, "lies beyond the finger tips along the approach");
    hand_.finger_depth = 2 * reach;
    std::vector<double> clearances;
    for (int i = 0; i <= n; ++i) clearances.push_back(clearance_at(static_cast<double>(i) / n));
    int open = n;
    while (open > 0 && !(clearances[open] < detail::kInfinity)) --open;
    while (open > 0 && clearances[open - 1] > clearances[open] && clearances[open - 1] < detail::kInfinity) --open;
    int closed = open;
    while (closed > 0 && clearances[closed] > 0 && clearances[closed - 1] < clearances[closed]) --closed;
    require(open > closed && clearances[open] > 0, "group", reading_.group, "its joints do not close the fingers");
    double meet = static_cast<double>(closed) / n;
    if (clearances[closed] < 0) {
      double low = meet, high = static_cast<double>(closed + 1) / n;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = (low + high) / 2;
        (clearance_at(middle) < 0 ? low : high) = middle;
      }
      meet = high;
    }
    const double wide = static_cast<double>(open) / n;
    for (Drive& drive : drives_) {
      if (drive.spreads) continue;
      const double range = drive.open - drive.closed, from = drive.closed;
      drive.closed = from + meet * range;
      drive.open = wide == 1 ? drive.open : from + wide * range;
    }
  }

  void describe() {
    set_share(0);
    const std::vector<Eigen::Matrix3d> closed = shapes_->tip_rotations(values_);
    hand_.body = shapes_->body(values_, hand_.finger_depth / 2);
    set_share(1);
    const double thickness = shapes_->body(values_, hand_.finger_depth / 2).finger_thickness;
    hand_.body.finger_thickness = std::max(hand_.body.finger_thickness, thickness);
    hand_.finger_width = shapes_->tip_width(values_);
    measure_openings();
    double turned = 0;
    const std::vector<Eigen::Matrix3d> open = shapes_->tip_rotations(values_);
    for (std::size_t i = 0; i < open.size(); ++i)
      turned = std::max(turned, rotation_vector(closed[i].transpose() * open[i]).norm());
    const bool several = shapes_->tips().size() > 2 || shapes_->drives_of_a_tip() > 1;
    hand_.kind = several ? ClosingKind::adaptive : turned > kTurned ? ClosingKind::angular : ClosingKind::parallel;
    name_joints(several);
    hand_.finger_links = shapes_->finger_links();
  }

  void measure_openings() {
    const int n = reading_.postures;
    std::vector<double> openings;
    for (int i = 0; i <= n; ++i) openings.push_back(std::max(0.0, clearance_at(static_cast<double>(i) / n)));
    hand_.min_opening = openings.front() < kSameOpening ? 0.0 : openings.front();
    openings.front() = hand_.min_opening;
    hand_.max_opening = openings.back();
    double bent = 0;
    for (int i = 0; i <= n; ++i) {
      const double share = static_cast<double>(i) / n;
      bent =
          std::max(bent, std::abs(openings[i] - hand_.min_opening - share * (hand_.max_opening - hand_.min_opening)));
    }
    if (bent > kSameOpening) hand_.openings = openings;
  }

  /// One group when one drive moves all fingers; else one a finger, named after its tip, and one for the spread.
  void name_joints(bool several) {
    for (const Drive& drive : drives_) {
      HandJoint joint{robot_.joints()[drive.joint].name, drive.closed, drive.open, "fingers"};
      if (several) joint.group = shapes_->finger_of(drive.joint);
      if (drive.spreads) {
        joint.group = "spread " + joint.name;
        const double rest = robot_.default_values()[robot_.joints()[drive.joint].value_index];
        hand_.preshape[joint.group] = (rest - drive.closed) / (drive.open - drive.closed);
      }
      hand_.joints.push_back(joint);
    }
  }

  const Robot& robot_;
  const HandReading& reading_;
  int tool_;
  Eigen::VectorXd values_;
  std::vector<Drive> drives_;
  std::optional<FingerShapes> shapes_;
  Hand hand_;
};

}  // namespace

void HandReading::check() const {
  for (const auto& [name, axis] : {std::pair("approach", approach), std::pair("closing", closing)})
    require(!axis || std::abs(axis->norm() - 1) <= 1e-6, name, axis ? axis->norm() : 1, "must be a unit vector");
  require_not_negative(clearance, "clearance", "m");
  require(postures >= 2 && postures <= 1000, "postures", postures, "must be from 2 to 1000");
}

Hand Hand::from_robot(const Robot& robot, const std::string& tool_link, const HandReading& reading) {
  reading.check();
  return Reader(robot, tool_link, reading).read();
}

}  // namespace mmgrasp
