// Checks the form of a plan before anything is computed from it.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {
namespace {

// Lengths and angles beyond this are no part of a room; they would only break the arithmetic.
constexpr double kLargest = 1e6;
constexpr double kMostClosingSpeed = 10;  // [m/s]: no hand's opening shrinks faster.

bool finite(double value) {
  return std::abs(value) <= kLargest;
}  // false for NaN

bool finite(const Eigen::VectorXd& values) {
  return (values.array().abs() <= kLargest).all();
}

bool is_pose(const Pose& T) {
  return finite(Eigen::VectorXd(T.translation())) && T.linear().allFinite() &&
         (T.linear() * T.linear().transpose()).isIdentity(1e-6) && T.linear().determinant() > 0;
}

/// Collects structural faults; `ok` tells whether there were any.
struct Structure {
  const PlanToCheck& plan;
  const RobotModel& robot;
  Faults& faults;
  bool ok = true;

  bool need(bool good, const std::string& where, const std::string& message) {
    if (!good) {
      faults.push_back({"malformed", where, message});
      ok = false;
    }
    return good;
  }

  int joint(const std::string& name, const std::string& where) {
    const int index = robot.joint_index(name);
    if (!need(index >= 0, where, "the robot has no joint '" + name + "'")) return -1;
    const ModelJoint& joint = robot.joints[index];
    const bool drivable = joint.moves() && joint.source == index;
    need(drivable, where, "joint '" + name + "' cannot be set: it is fixed, planar, floating or a mimic");
    return drivable ? index : -1;
  }

  int link(const std::string& name, const std::string& where) {
    const int index = robot.link_index(name);
    need(index >= 0, where, "the robot has no link '" + name + "'");
    return index;
  }

  void arm(ArmSetup& setup);
  void gripper(ArmSetup& setup, std::vector<int>& finger_links);
  void suction();
  void scalars();
  void place();
  void body(const CheckedBody& body, const std::string& where, std::set<std::string>& names);
  void scene();
};

void Structure::arm(ArmSetup& setup) {
  const std::size_t count = plan.arm_joints.size();
  need(count > 0, "arm_joints", "empty: the arm needs at least one joint");
  std::set<std::string> seen;
  for (const std::string& name : plan.arm_joints) {
    need(seen.insert(name).second, "arm_joints", "joint '" + name + "' is listed twice");
    setup.arm.push_back(joint(name, "arm_joints"));
  }
  setup.tip_link = link(plan.tip_link, "tip_link");
  for (const auto& [name, value] : plan.other_joints) {
    const int index = joint(name, "other_joints");
    need(finite(value), "other_joints", "'" + name + "' is not a finite number");
    need(!seen.count(name), "other_joints", "'" + name + "' is an arm joint");
    if (index >= 0) setup.others[index] = value;
  }
  const auto limits = [&](const std::vector<double>& values, const char* field) {
    need(values.size() == count, field,
         "has " + text(values.size()) + " values, the arm has " + text(count) + " joints");
    for (const double value : values)
      need(value > 0 && finite(value), field, text(value) + ": must be positive and finite");
  };
  limits(plan.velocity_limits, "velocity_limits");
  limits(plan.acceleration_limits, "acceleration_limits");
  for (std::size_t i = 0; i < std::min(plan.velocity_limits.size(), count); ++i) {
    if (setup.arm[i] < 0 || !finite(plan.velocity_limits[i])) continue;
    const double most = robot.joints[setup.arm[i]].velocity;
    if (plan.velocity_limits[i] <= most * (1 + 1e-9)) continue;
    faults.push_back({"limit-exceeds-robot", "velocity_limits",
                      text(plan.velocity_limits[i]) + " for '" + plan.arm_joints[i] + "', the robot itself allows " +
                          text(most) + " rad/s or m/s"});
  }
  need(static_cast<std::size_t>(plan.home.size()) == count && finite(plan.home), "home",
       "must hold one finite value an arm joint (" + text(count) + ")");
}

void Structure::gripper(ArmSetup& setup, std::vector<int>& finger_links) {
  const bool cups = !plan.suction.cups.empty();
  if (cups) {
    suction();
  } else {
    need(finite(plan.max_opening) && plan.max_opening > 0, "max_opening",
         text(plan.max_opening) + ": must be positive");
  }
  need(plan.payload > 0, "payload", text(plan.payload) + ": must be positive");
  need(finite(plan.clearance) && plan.clearance >= 0, "clearance", text(plan.clearance) + ": must not be negative");
  need(std::abs(plan.approach.norm() - 1) < 1e-6, "approach", "must be a unit vector");
  const std::vector<double>& openings = plan.openings;
  bool rising = openings.empty() ||
                (openings.size() > 1 && openings.front() >= 0 && std::abs(openings.back() - plan.max_opening) < 1e-9);
  for (std::size_t i = 1; i < openings.size(); ++i) rising = rising && openings[i] > openings[i - 1];
  need(rising, "openings", "must rise from 0 or more to max_opening");
  setup.openings = rising && !openings.empty() ? openings : std::vector<double>{0.0, plan.max_opening};
  need(std::abs(plan.closing.norm() - 1) < 1e-6 && std::abs(plan.closing.dot(plan.approach)) < 1e-6, "closing",
       "must be a unit vector orthogonal to approach");
  setup.closing = plan.closing;
  need(finite(plan.finger_depth) && plan.finger_depth >= 0 && finite(plan.finger_width) && plan.finger_width >= 0,
       "finger_depth, finger_width", "must not be negative");
  need(finite(plan.approach_distance) && plan.approach_distance >= 0, "approach_distance", "must not be negative");
  need(finite(plan.lift_height) && plan.lift_height > 0, "lift_height", "must be positive");
  for (const CheckedFinger& finger : plan.fingers) {
    const int index = joint(finger.joint, "fingers");
    const bool finite_ends = need(finite(finger.closed) && finite(finger.open), "fingers",
                                  "'" + finger.joint + "' has a value that is not a finite number");
    if (index < 0 || !finite_ends) continue;
    for (const int arm_joint : setup.arm) need(arm_joint != index, "fingers", "'" + finger.joint + "' is an arm joint");
    setup.fingers.push_back({index, finger.closed, finger.open});
    const ModelJoint& limits = robot.joints[index];
    for (const double value : {finger.closed, finger.open}) {
      if (value >= limits.lower - 1e-6 && value <= limits.upper + 1e-6) continue;
      faults.push_back({"finger-limit", "fingers",
                        "'" + finger.joint + "' at " + text(value) + " is outside [" + text(limits.lower) + ", " +
                            text(limits.upper) + "]"});
    }
  }
  for (const std::string& name : plan.finger_links) finger_links.push_back(link(name, "finger_links"));
  const std::size_t different = std::set<std::string>(plan.finger_links.begin(), plan.finger_links.end()).size();
  if (ok && different < (cups ? 1 : 2)) {
    faults.push_back({"finger-links", "finger_links",
                      "names " + text(different) + " links: a gripper has at least " + (cups ? "one" : "two")});
  }
}

/// What holds a part, and that nothing else does.
void Structure::suction() {
  const CheckedSuction& own = plan.suction;
  need(plan.max_opening == 0 && plan.fingers.empty() && plan.openings.empty() && plan.clearance == 0, "suction",
       "a hand of suction cups has no fingers, and its openings are 0");
  need(own.max_gap > 0 && own.max_gap <= 0.1 && own.vacuum > 0 && own.vacuum <= 1.1e5 && own.friction > 0 &&
           own.friction <= 10 && own.safety >= 1 && finite(own.safety),
       "suction", "max_gap must be in (0, 0.1] m, vacuum in (0, 1.1e5] Pa, friction in (0, 10], safety at least 1");
  for (const CheckedCup& cup : own.cups) {
    need(finite(Eigen::VectorXd(cup.position)) && std::abs(cup.position.dot(plan.approach)) <= 1e-6 && cup.radius > 0 &&
             cup.radius <= 1,
         "suction", "rims must lie in the plane through the tool frame, across the approach, of radii in (0, 1] m");
  }
  for (const CheckedPart& part : plan.parts)
    need(!part.target || part.mass > 0, "part '" + part.body.name + "'", "has no mass: suction cups hold by force");
}

void Structure::scalars() {
  need(finite(Eigen::VectorXd(plan.start)), "start", "must be finite");
  need(finite(Eigen::VectorXd(plan.goal)), "goal", "must be finite");
  need(finite(plan.positioning_uncertainty) && plan.positioning_uncertainty >= 0, "positioning_uncertainty",
       text(plan.positioning_uncertainty) + ": must be finite and not negative");
  const Eigen::Matrix3d& covariance = plan.arrival_covariance;
  const double size = covariance.cwiseAbs().maxCoeff();
  need(covariance.allFinite() && (covariance - covariance.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * size &&
           (size == 0 || Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[0] >= -1e-9 * size),
       "arrival_covariance", "must be finite, symmetric and without a negative eigenvalue");
  need(finite(plan.drive_clearance) && plan.drive_clearance >= 0, "drive_clearance",
       text(plan.drive_clearance) + ": must be finite and not negative");
  place();
  need(plan.closing_speed > 0 && plan.closing_speed <= kMostClosingSpeed, "closing_speed",
       text(plan.closing_speed) + ": must be positive and at most " + text(kMostClosingSpeed) + " m/s");
  for (std::size_t i = 0; i < plan.stops.size(); ++i) {
    need(finite(Eigen::VectorXd(plan.stops[i].pose)) && finite(plan.stops[i].radius), "stop " + std::to_string(i),
         "must be finite");
    const int drawn = plan.stops[i].arrivals, served = plan.stops[i].arrivals_served;
    need((drawn > 0) == (size > 0) && served >= 0 && served <= drawn, "stop " + std::to_string(i),
         size > 0 ? "must say of how many arrivals, more than 0, how many serve all parts"
                  : "has arrivals without an arrival_covariance");
  }
}

/// Where parts go: the bin, or a rectangle at the goal.
void Structure::place() {
  need(is_pose(plan.T_base_bin), "place_region", "the bin's pose is not a finite rigid transform");
  need(finite(Eigen::VectorXd(plan.bin_size)) && plan.bin_size.minCoeff() > 0, "place_region",
       "the bin's size must be positive");
  need(plan.capacity >= 0, "place_region", "capacity must not be negative");
  need(finite(plan.drop_height) && plan.drop_height >= 0, "place_region", "drop_height must not be negative");
  if (!plan.unload_region) return;
  const CheckedUnloadRegion& region = *plan.unload_region;
  need(is_pose(region.T_world_region) && region.T_world_region.linear()(2, 2) > 1 - 1e-9, "unload_region",
       "its pose must be a finite rigid transform, and level");
  need(finite(Eigen::VectorXd(region.size)) && region.size.minCoeff() > 0, "unload_region",
       "its size must be positive");
  need(finite(region.drop_height) && region.drop_height >= 0, "unload_region", "drop_height must not be negative");
  need(plan.capacity == 0, "unload_region", "has no bin beside it: capacity must be 0");
  need(plan.drive_by.empty(), "unload_region", "no part is taken in passing that the hand carries to the goal");
  need(plan.suction.cups.empty(), "unload_region",
       "what the base's acceleration pulls at suction cups is not known: they carry nothing on drives");
}

void Structure::body(const CheckedBody& body, const std::string& where, std::set<std::string>& names) {
  need(!body.name.empty() && names.insert(body.name).second, where,
       "'" + body.name + "' is empty or used twice as a name");
  need(is_pose(body.T_world_body), where + " '" + body.name + "'", "its pose is not a finite rigid transform");
  need(!body.shapes.empty(), where + " '" + body.name + "'", "has no shape");
  try {
    check_shapes(body.shapes);
  } catch (const Error& error) {
    need(false, where + " '" + body.name + "'", error.what());
  }
}

void Structure::scene() {
  std::set<std::string> names;
  need(!(plan.floor > kLargest) && !std::isnan(plan.floor), "floor", text(plan.floor) + ": must be a finite height");
  if (std::isfinite(plan.floor)) names.insert(kFloor);
  for (const CheckedBody& obstacle : plan.obstacles) body(obstacle, "obstacle", names);
  const std::set<std::string> trays(plan.trays.begin(), plan.trays.end());
  need(trays.size() == plan.trays.size(), "trays", "a name is used twice");
  for (const CheckedPart& part : plan.parts) {
    const std::string where = "part '" + part.body.name + "'";
    body(part.body, "part", names);
    need(finite(part.mass) && part.mass >= 0, where, text(part.mass) + ": its mass must not be negative");
    need(trays.count(part.tray) > 0, where, "its tray '" + part.tray + "' is unknown");
    for (std::size_t i = 0; i < part.grasps.size(); ++i) {
      const CheckedGrasp& grasp = part.grasps[i];
      need(is_pose(grasp.T_object_hand) && finite(grasp.opening) && grasp.opening >= 0, where,
           "grasp " + std::to_string(i) + ": its pose is not rigid or its opening is not a number >= 0");
    }
  }
  for (const auto& [a, b] : plan.allowed_collisions) {
    for (const std::string& name : {a, b})
      need(names.count(name) > 0 || robot.link_index(name) >= 0, "allowed_collisions",
           "'" + name + "' is no link, obstacle or part");
  }
}

}  // namespace

std::string text(double value) {
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

std::string text(const Eigen::Vector3d& pose) {
  return "(" + text(pose.x()) + ", " + text(pose.y()) + ", " + text(pose.z()) + ")";
}

bool check_structure(const PlanToCheck& plan, const RobotModel& robot, Faults& faults, ArmSetup& setup,
                     std::vector<int>& finger_links) {
  Structure structure{plan, robot, faults};
  structure.arm(setup);
  structure.gripper(setup, finger_links);
  structure.scalars();
  structure.scene();
  return structure.ok;
}

}  // namespace mmgrasp::verify::detail
