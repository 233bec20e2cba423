#pragma once

#include "collision/checker/checker_impl.hpp"
#include "mmgrasp/collision/checker.hpp"

namespace mmgrasp::detail {

/// The inside of a checker, for algorithms of this module that are not its methods.
struct CheckerAccess {
  using Impl = CollisionChecker::Impl;
  static Impl& of(CollisionChecker& checker) { return *checker.impl_; }
};

}  // namespace mmgrasp::detail
