#pragma once

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// A checker of the hand alone, fingers opened so far [m]: its root is the tool centre point and can be put anywhere
/// (set_root); its one joint has no effect. What the hand touches at a grasp it touches with any arm configuration.
CollisionChecker hand_checker(const PartSupplyProblem& problem, double opening, const World& world);

}  // namespace mmgrasp::detail
