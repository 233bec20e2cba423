#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mmgrasp/core/detail/rigid.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The way from the world to a point of the robot, with derivatives of any order in closed form. Rotations are kept as
/// unit quaternions that are smooth functions of the configuration.
class MMGRASP_EXPORT ToolChain {
 public:
  /// The way to the group's tip. Throws InvalidInput for planar, floating and mimicking joints on the way.
  explicit ToolChain(const JointGroup& group);
  /// The way to the frame of any link.
  ToolChain(const JointGroup& group, int link);

  struct Step {
    Rigid before;  ///< The joint in the frame of the one before (in the world, for the first).
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    bool turns = true;
    int column = 0;
  };
  /// Joints from the base outwards; columns of the group that do not move the tip do not appear.
  const std::vector<Step>& steps() const { return steps_; }

  /// First derivatives of the tip, one entry per step: v of its origin, w its turning axis (0 where a joint slides).
  struct State {
    Eigen::Vector3d p;
    Eigen::Quaterniond rotation;
    std::vector<Eigen::Vector3d> v, w;
  };
  void evaluate(const double* q, State& state) const;

  /// d2 p / d step a d step b, a <= b.
  static Eigen::Vector3d second(const State& s, std::size_t a, std::size_t b) { return s.w[a].cross(s.v[b]); }
  /// d3 p / d a d b d c, a <= b <= c.
  static Eigen::Vector3d third(const State& s, std::size_t a, std::size_t b, std::size_t c) {
    return s.w[a].cross(s.w[b].cross(s.v[c]));
  }

 private:
  std::vector<Step> steps_;
  Rigid T_last_tip_;
};

}  // namespace mmgrasp::detail
