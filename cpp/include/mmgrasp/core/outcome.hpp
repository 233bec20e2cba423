#pragma once

#include <cstddef>
#include <string>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// How a query ended. "No solution" is a value, not an exception. Whoever gets `infeasible` may rely on it: other
/// seeds, more samples or more time cannot find an answer to the same question. `not_found` and `timeout` promise
/// nothing of the kind (docs/concepts.md says which functions prove what).
enum class Outcome {
  solved,         ///< The answer is there and passed its check.
  approximate,    ///< The best that was found; misses its tolerance or bound. Never used for a path in collision.
  infeasible,     ///< Proven: there is no answer.
  not_found,      ///< The method came to its end without an answer (samples, a roadmap, a local optimum): no proof.
  timeout,        ///< The budget (samples, iterations or clock) ended first: no proof either.
  stopped,        ///< The caller's cancel token ended it.
  invalid_start,  ///< The start violates limits or is in collision, or no such start was found.
  invalid_goal,   ///< No goal given or found is inside limits and collision-free.
};

MMGRASP_EXPORT const char* to_string(Outcome outcome);

/// Why one candidate (a configuration, a grasp, a base pose) was rejected.
enum class Rejection { none, unreachable, limits, self_collision, scene, grasp_filter };

MMGRASP_EXPORT const char* to_string(Rejection cause);

/// How many candidates fell at which filter.
struct MMGRASP_EXPORT Rejections {
  std::size_t unreachable = 0;     ///< No arm configuration reaches the pose.
  std::size_t limits = 0;          ///< Reached only outside joint limits.
  std::size_t self_collision = 0;  ///< Reached, but the robot, or what is attached to it, hits the robot.
  std::size_t scene = 0;           ///< Reached, but the robot, or what is attached to it, hits the scene.
  std::size_t grasp_filter = 0;    ///< Rejected before IK (gripper too small, hand hits its part, ...).

  void add(Rejection cause, std::size_t count = 1);
  Rejections& operator+=(const Rejections& other);
  std::size_t total() const;
  std::string summary() const;  ///< "unreachable 12, scene 3", or "none".
  bool operator==(const Rejections& other) const;
};

}  // namespace mmgrasp
