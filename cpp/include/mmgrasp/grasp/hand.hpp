#pragma once

#include <Eigen/Core>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/grasp.hpp"
#include "mmgrasp/grasp/suction.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

class Robot;

/// How the fingers of a hand meet.
enum class ClosingKind {
  parallel,  ///< Two fingers whose pads stay parallel.
  angular,   ///< Two fingers whose pads turn while they close.
  adaptive,  ///< More than two fingers, or fingers of several driven joints.
};
MMGRASP_EXPORT const char* to_string(ClosingKind kind);

/// A driven joint of a hand: how far it goes between closed and open, linear in how far its group is open.
struct MMGRASP_EXPORT HandJoint {
  std::string name;
  double closed = 0;              ///< Value while the fingers are closed [rad] or [m].
  double open = 0;                ///< Value while they are open.
  std::string group = "fingers";  ///< Joints of one group move together.
  void check(const std::string& field) const;
};

/// Boxes around the fingers and the palm; what lies between the fingers follows from Hand's opening and pads.
struct MMGRASP_EXPORT HandBody {
  double finger_thickness = 0.012;  ///< Size of a finger along the closing axis [m]; > 0.
  double finger_length = 0.12;      ///< From the finger tips back to the palm [m]; > 0.
  double palm_length = 0.13;        ///< Size of the palm along the closing axis [m]; > 0.
  double palm_width = 0.065;        ///< Size of the palm across it [m]; > 0.
  void check() const;
};

/// What a robot's files leave open about its hand.
struct MMGRASP_EXPORT HandReading {
  /// SRDF end effector, or SRDF group, that holds the hand's joints; empty: the joints of all links below the body
  /// that carries the tool link.
  std::string group;
  /// Unit vectors of the tool frame; none: the frame's axis next to the way from palm to finger tips, and the direction
  /// across it in which the tips move most (need not be an axis of the frame: Panda's fingers close half way between x
  /// and y of panda_link8).
  std::optional<Eigen::Vector3d> approach, closing;
  double clearance = 0.01;  ///< See Hand::clearance [m]; >= 0.
  int postures = 32;        ///< Intervals from closed to open at which the opening is measured; from 2 to 1000.
  void check() const;
};

/// The hand at the end of an arm: where its tool frame is, how it moves in and closes, how its joints follow from the
/// opening, and how much room it takes. A parallel gripper is the case of one group of joints, linear in the opening.
///
/// The origin of the tool frame (what others call tool centre point) lies midway between the pads' centres. Every group
/// of joints has one number, 0 closed and 1 open; a posture is one number a group.
///
///     Hand hand;                                    // by its numbers
///     hand.tool_link = "gripper_tcp";
///     hand.max_opening = 0.1;
///     hand.joints = {{"left_finger_joint", 0.0, 0.05}, {"right_finger_joint", 0.0, 0.05}};
///     hand.joint_values(0.04);                      // {left_finger_joint: 0.02, right_finger_joint: 0.02}
///
///     Hand read = Hand::from_robot(robot, "tool");   // from URDF and SRDF, measured by forward kinematics
///
/// A hand of suction cups has no fingers: no joints, and every opening is 0.
struct MMGRASP_EXPORT Hand {
  std::string tool_link;                                ///< Robot link whose frame is the tool frame.
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< Unit axis of the tool frame along which the hand moves in.
  Eigen::Vector3d closing = Eigen::Vector3d::UnitY();   ///< Unit axis of the tool frame along which the pads close.
  ClosingKind kind = ClosingKind::parallel;
  double min_opening = 0;      ///< Thinnest part that is held [m]; in [0, max_opening).
  double max_opening = 0.1;    ///< Widest part that fits [m], > 0.
  double finger_depth = 0.03;  ///< Pad length along the approach axis [m], > 0: half of it reaches past the tool frame.
  double finger_width = 0.02;  ///< Pad size across approach and closing [m], > 0.
  double clearance = 0.01;     ///< Kept free on each side of the part while moving in [m], >= 0.
  std::vector<HandJoint> joints;
  /// Openings from closed to open at equal steps of the joints [m], rising from min_opening to max_opening; empty: the
  /// opening is linear in them.
  std::vector<double> openings;
  /// Groups that the opening does not move (how the fingers are spread), and how far open they stay, in [0, 1].
  std::map<std::string, double> preshape;
  std::vector<std::string> finger_links;  ///< Links that may touch the attached part.
  HandBody body;
  /// Cups in place of fingers: then there are no joints, and openings, pads and clearance are 0.
  std::optional<Suction> suction;
  double payload = std::numeric_limits<double>::infinity();  ///< Heaviest part that hand and arm may carry [kg], > 0.

  /// Reads a hand from a robot loaded with its meshes. Which joints spread the fingers and which end of a closing joint
  /// is open comes from forward kinematics; SRDF states of the group named open and closed (or close) take precedence
  /// over joint limits. The opening is the free space between the collision shapes of the finger tips in the band of
  /// the pads; closed is where they first meet. Throws InvalidInput when the group has no joint with limits, no two
  /// finger tips stand opposite each other, a tip has no shape, or the tool link lies beyond the tips.
  static Hand from_robot(const Robot& robot, const std::string& tool_link, const HandReading& reading = {});

  /// A hand of suction cups that face along `approach` (unit, tool frame); `cup_links` may touch the attached part.
  static Hand of_cups(const std::string& tool_link, const Eigen::Vector3d& approach, const Suction& suction,
                      const std::vector<std::string>& cup_links);

  void check() const;  ///< Throws InvalidInput: axes unit and orthogonal, sizes positive, joints and groups known.
  void check_fingers() const;  ///< check(), and throws InvalidInput for a hand of suction cups.
  /// Names of the joint groups in the order of their first joints.
  std::vector<std::string> groups() const;
  /// How far open the fingers are at an opening, in [0, 1]; below min_opening they are closed. Throws InvalidInput
  /// outside [0, max_opening].
  double share_open(double opening) const;
  /// The opening at which the fingers are so far open; the inverse of share_open().
  double opening_at(double share_open) const;
  /// Joint values at an opening in [0, max_opening]; groups of `preshape` keep theirs.
  std::map<std::string, double> joint_values(double opening) const;
  /// Joint values of a posture: one number in [0, 1] for each of groups().
  std::map<std::string, double> joint_values(const std::vector<double>& posture) const;
  /// Joint values while holding: those of the grasp's posture if it has one, else of its opening.
  std::map<std::string, double> joint_values(const Grasp& grasp) const;
  /// Opening while moving in on a part of this width: width + 2 clearance, at most max_opening.
  double pregrasp_opening(double width) const;
  /// Fingers and palm as boxes in the tool frame, the fingers at an opening: left and right finger, palm.
  std::vector<LinkShape> shapes(double opening) const;
};

}  // namespace mmgrasp
