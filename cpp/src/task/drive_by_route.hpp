#pragma once

#include "mmgrasp/collision/checker.hpp"
#include "task/drive_by_guess.hpp"

namespace mmgrasp::detail {

/// A drive around obstacles between two configurations, the arm held as at one of them; without poses when none was
/// found. Headings run on continuously from `from`.
GuidedBase guided_base(const JointGroup& group, const CollisionChecker& checker, const Eigen::VectorXd& from,
                       const Eigen::VectorXd& to, const Monitor& monitor);

/// True when the root link touches the scene at a waypoint of the guess.
bool base_collides(const std::vector<CollisionChecker*>& checkers, const WholeBodyGuess& guess);

}  // namespace mmgrasp::detail
