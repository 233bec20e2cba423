#pragma once

#include <Eigen/Core>
#include <kdl/segment.hpp>
#include <map>
#include <vector>

#include "mmgrasp/core/pose.hpp"
#include "verify/robot/robot_model.hpp"

namespace mmgrasp::verify::detail {

/// A finger joint as a linear function of the opening.
struct FingerMap {
  int joint = -1;
  double closed = 0, open = 0;
};

/// Which joints of a robot the plan moves, and where the others stand.
struct ArmSetup {
  std::vector<int> arm;  ///< Joint indices, in the order of a configuration.
  int tip_link = -1;
  std::map<int, double> others;  ///< Joint index -> value held.
  std::vector<FingerMap> fingers;
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();  ///< Unit axis in the tip frame along which the pads close.
  /// Openings at equal steps of the finger joints from closed to open; at least two [m].
  std::vector<double> openings = {0.0, 0.1};

  /// How far the fingers are open, in [0, 1].
  double share_open(double opening) const;
};

/// Forward kinematics and Jacobian by the segments of the KDL tree, all in the root link's frame. One a thread: KDL's
/// joints remember their last pose. Planar and floating joints are held at zero.
class Kinematics {
 public:
  Kinematics(const RobotModel& robot, const ArmSetup& setup);

  int arm_size() const { return static_cast<int>(setup_.arm.size()); }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  const std::vector<bool>& continuous() const { return continuous_; }

  /// Pose of every link (by link index) with the fingers at `opening` [m].
  const Poses& place(const Eigen::VectorXd& arm, double opening);
  Pose tip(const Eigen::VectorXd& arm);
  /// Twist of the tip (linear; angular) in root axes for unit joint speeds.
  void tip_and_jacobian(const Eigen::VectorXd& arm, Pose& T_root_tip, Matrix6Xd& J);

 private:
  /// One joint with the link it carries.
  struct Element {
    int parent = -1, link = -1;
    KDL::Segment segment;
    int source = -1;  ///< Joint whose value it follows: itself, or what it mimics.
    double multiplier = 1, offset = 0;
    int column = -1;  ///< Arm joint that drives it; -1: none.
  };
  Element make_element(const RobotModel& robot, const ModelJoint& joint) const;
  void set_arm(const Eigen::VectorXd& arm);
  double value(const Element& element) const;

  ArmSetup setup_;
  std::vector<Element> elements_;   ///< Elements by joint index, parents first.
  std::vector<int> chain_;          ///< Elements from the root to the tip.
  std::vector<double> values_;      ///< Values by joint index.
  std::vector<KDL::Frame> frames_;  ///< Frames by link index.
  Poses poses_;
  Eigen::VectorXd lower_, upper_;
  std::vector<bool> continuous_;
};

}  // namespace mmgrasp::verify::detail
