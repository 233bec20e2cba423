#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Base pose (x, y, theta) after `time` [s] at a constant platform velocity (v_x, v_y, omega): the exact arc. Theta
/// counts full turns. The chord of an arc of turn D points along the heading half way and is sin(D/2)/(D/2) as long as
/// the arc, which needs no case for driving straight. Throws InvalidInput for numbers that are not finite and negative
/// times.
MMGRASP_EXPORT Eigen::Vector3d drive_arc(const Eigen::Vector3d& pose, const Eigen::Vector3d& platform_velocity,
                                         double time);

/// The constant platform velocity that leads from one pose to another in `time` [s]: the inverse of drive_arc. What a
/// diff-drive cannot do comes out as v_y. Throws InvalidInput unless time > 0 and the headings differ by less than a
/// full turn.
MMGRASP_EXPORT Eigen::Vector3d arc_velocity(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double time);

}  // namespace mmgrasp
