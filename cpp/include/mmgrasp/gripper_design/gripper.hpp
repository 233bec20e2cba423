#pragma once

#include <map>
#include <memory>
#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/gripper_design/segment_requirement.hpp"

namespace mmgrasp {

struct Hand;

/// A design: a gripper with straight fingers on a drive: two parallel jaws, or three fingers that move towards one axis
/// (P1 5.2.1, figure 5.6). Its opening goes from `min_opening` to `max_opening`, the difference being the drive's
/// stroke.
///
///     Gripper gripper;
///     gripper.name = "centric_22";
///     gripper.fingers = 3;
///     gripper.min_opening = 0.014;
///     gripper.max_opening = 0.022;
///     gripper.finger_length = 0.030;
///     gripper.to_urdf("grippers/centric_22");       // gripper.urdf, gripper.srdf, finger.stl
///
/// Planners, samplers and masks know no designs but hands: hand() gives the Hand that this gripper is.
///
/// Frames: the base frame lies on the mounting face with z towards the tips; the first finger moves along x. The tool
/// frame lies on z, half a pad before the tips, with the base frame's axes.
struct MMGRASP_EXPORT Gripper {
  std::string name = "gripper";  ///< Letters, digits, `_`, `-` and `.`.
  std::string actuator;          ///< Name of the drive, or empty.
  int fingers = 2;               ///< 2 or 3.
  double min_opening = 0;        ///< Between the pads, or the diameter that three of them touch [m]; >= 0.
  double max_opening = 0.05;     ///< [m], > min_opening.
  double finger_length = 0.03;   ///< From the palm to the tips [m], > 0.
  double finger_width = 0.015;   ///< Across approach and closing direction [m], > 0; three fingers narrow towards the
                                 ///< pad where they would meet each other when closed.
  double finger_thickness = 0.008;  ///< Along the closing direction [m], > 0.
  double palm_height = 0.04;        ///< From the mounting face to the palm [m], > 0.
  double max_force = 50;            ///< Largest force of each finger's joint [N], > 0.
  double max_speed = 0.1;           ///< Largest speed of each finger's joint [m/s], > 0.

  void check() const;  ///< Throws InvalidInput naming field, value and rule.
  /// Whether it holds a segment, by (5.2) of P1 with <= in place of <: the printed form would refuse a part as wide as
  /// the largest opening, which P1's own grippers take; and neither a smaller opening nor a longer stroke than it
  /// allows. Lengths within 1e-9 m count as equal.
  bool holds(const SegmentRequirement& requirement) const;
  /// Half the pad's length along the approach lies on either side of the tool frame: the last 20 mm, or the finger.
  double pad_length() const;
  /// Width of the pad across the approach: the finger's, or what is left of it where three closed fingers would meet.
  double pad_width() const;
  /// Radius of the palm, a cylinder that covers the fingers while they are open [m].
  double palm_radius() const;
  /// What planners need to know of it: tool frame, openings, driven joint and body, the names those of files(). A
  /// gripper that is mounted under a prefix is read from its robot instead (Hand::from_robot). Throws InvalidInput for
  /// three fingers: a Hand has pads that stand opposite each other.
  Hand hand() const;
  /// One finger, to print: closed, convex, standing on the palm at z = 0, its pad in the plane x = 0, facing -x [m].
  std::shared_ptr<const TriangleMesh> finger_mesh() const;
  /// URDF and SRDF as texts by file name ("gripper.urdf", "gripper.srdf"), and the finger as a binary STL in
  /// millimetres, to print ("finger.stl"), which the URDF names by its relative path and scales. The group "fingers"
  /// holds the driven joint; the others follow it (mimic); the states "open" and "closed" are there; the end effector
  /// is mounted by "base".
  std::map<std::string, std::string> files() const;
  /// Writes files() into a folder, which is made where it is missing. Throws IoError naming the file.
  void to_urdf(const std::string& folder) const;
};

}  // namespace mmgrasp
