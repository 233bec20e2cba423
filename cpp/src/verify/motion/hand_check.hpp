#pragma once

#include <string>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// What robot, hand and attached part meet, for motions of the arm alone and of base and arm.
class HandCheck {
 public:
  HandCheck(const Context& context, Judge& judge, Faults& faults) : context_(context), judge_(judge), faults_(faults) {}

  /// "self-collision", "attached-collision", "scene-collision"; true when a fault was added.
  bool collides(const Eigen::VectorXd& arm, double opening, const std::string& where);
  /// Fingers moving with the arm at rest.
  void check_fingers(const Eigen::VectorXd& arm, double from, double to, const std::string& where);
  /// "grasp-empty": fingers of both sides must meet the attached part at once, at the grasp's width or somewhat below:
  /// collision shapes may stand back a little from the pads that the width is meant for. Otherwise nothing is held.
  void check_grip(const Eigen::VectorXd& arm, double width, const std::string& where);
  /// "grasp-fingers": no finger link meets the attached part before the fingers are as near as its width between the
  /// pads says, or grip_play() on either side of it; the hand may be `moved` off the grasp [m].
  void check_room(const Eigen::VectorXd& arm, double width, double moved, const std::string& where);

 private:
  const Context& context_;
  Judge& judge_;
  Faults& faults_;
};

}  // namespace mmgrasp::verify::detail
