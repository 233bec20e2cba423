#pragma once

#include "collision/checker/engine.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace mmgrasp {

/// Hides the engine's types from the public header.
struct CollisionChecker::Impl {
  detail::CheckerEngine engine;
};

}  // namespace mmgrasp
