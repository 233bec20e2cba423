#pragma once

#include <Eigen/Core>

#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp::verify::detail {

/// How a base drives a straight piece from rest to rest within its limits: the share of the piece that is done, from 0
/// to 1, as quickly as speed, turning rate and wheels allow.
class DriveProfile {
 public:
  DriveProfile(const Eigen::Vector3d& from, const Eigen::Vector3d& to, BaseKind base, const BaseLimits& limits);

  double duration() const { return duration_; }  ///< [s]; 0 where there is no way.
  double share(double time) const;               ///< Done after so long [s].
  double top() const { return top_; }            ///< The share's highest rate [1/s].

 private:
  double top_ = 0, acceleration_ = 0, duration_ = 0;
};

}  // namespace mmgrasp::verify::detail
