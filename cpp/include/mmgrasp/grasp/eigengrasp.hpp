#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/grasp/hand_model.hpp"

namespace mmgrasp {

class Robot;

/// Driven joints of a hand that one number moves together: a finger's, or those that spread the fingers (P3's J).
struct MMGRASP_EXPORT EigengraspGroup {
  std::string name;
  std::vector<std::string> joints;
};

/// A kind of grasp by its opening and its closing posture (P3 4.6.1): values of all groups' joints, in their order
/// [rad] or [m]. Joints whose two values agree keep them; groups of such joints alone take no part in the grasp.
struct MMGRASP_EXPORT GraspType {
  std::string name;
  Eigen::VectorXd open;    ///< P_b.
  Eigen::VectorXd closed;  ///< P_e.
};

/// P3's Algorithm 3: the matrix M of (4.18), j = M alpha + P_b, joints by groups; `sizes` are the groups' numbers of
/// joints. As printed its row counter grows by the number of groups (line 13) where it must grow by the group's own
/// number of joints, and M is not set to zero. Throws InvalidInput on sizes that do not match.
MMGRASP_EXPORT Eigen::MatrixXd eigengrasp_matrix(const std::vector<int>& sizes, const Eigen::VectorXd& open,
                                                 const Eigen::VectorXd& closed);

/// A robot hand set up for one type of grasp. alpha is 1 minus the shares of Hand and HandModel, since a posture there
/// is 0 closed and 1 open. Groups that take no part are held by Hand::preshape. Its axes, openings and pads come from
/// forward kinematics; the links of the pads are its finger links. `clearance` as Hand's [m]. Throws InvalidInput on
/// unknown joints, postures of another size, a tool link or approach that is none, and when fewer than two fingertips,
/// or none against another, are moved.
MMGRASP_EXPORT Hand eigengrasp_hand(const Robot& robot, const std::string& tool_link,
                                    const std::vector<EigengraspGroup>& groups, const GraspType& type,
                                    const Eigen::Vector3d& approach = Eigen::Vector3d::UnitZ(),
                                    double clearance = 0.01);

/// Pads and bodies of a hand with many joints, by the robot's forward kinematics; keeps what it needs of the robot. A
/// pad is the inner face of a fingertip, the last link with shapes of a finger that the closing groups move: it faces
/// the way the tip moves while closing, across the finger's length. Bodies are the bounding boxes of the collision
/// shapes of all links beyond the body that carries the tool link. Throws InvalidInput as eigengrasp_hand().
MMGRASP_EXPORT std::shared_ptr<const HandModel> make_hand_model(const Hand& hand, const Robot& robot);

}  // namespace mmgrasp
