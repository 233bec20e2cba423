#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// A configuration of the group from values by name [rad or m]. What is not named is as in `base`, or, when that is
/// empty, as in the group's reference values (0 for base joints). Throws InvalidInput for a name that is none of
/// JointGroup::names(), with the nearest one, for numbers that are not finite and a `base` of the wrong length.
MMGRASP_EXPORT Eigen::VectorXd named_configuration(const JointGroup& group,
                                                   const std::map<std::string, double>& by_name,
                                                   const Eigen::VectorXd& base = {});

/// The SRDF's group state of this name: of the SRDF group that the joint group is, or else of one that has all its
/// joints. Joints that the state leaves out are as above. Throws InvalidInput, listing the states there are, for
/// others.
MMGRASP_EXPORT Eigen::VectorXd state_configuration(const JointGroup& group, const std::string& state,
                                                   const Eigen::VectorXd& base = {});

}  // namespace mmgrasp
