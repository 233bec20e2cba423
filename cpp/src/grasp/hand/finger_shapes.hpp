#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::detail {

/// The link that carries a link's rigid body: the last one up the tree with no movable joint between.
int rigid_body_root(const Robot& robot, int link);
/// True for the link itself and all that it carries.
bool hangs_on(const Robot& robot, int link, int ancestor);

/// The fingers of a hand as a robot's collision shapes tell them, in the tool frame at any joint values. A finger ends
/// in a leaf: the last link on its branch that has shapes. Its tip is a leaf that reaches nearly as far as any.
class FingerShapes {
 public:
  struct Tip {
    int leaf = 0;     ///< Index into the leaves.
    double side = 1;  ///< Which side of the middle along the closing axis: 1 or -1.
  };

  /// Throws InvalidInput when what the driven joints move has no shapes.
  FingerShapes(const Robot& robot, int tool_link, const std::vector<int>& driven);

  std::vector<Eigen::Vector3d> leaf_centres(const Eigen::VectorXd& values) const;
  /// Mean direction from the fingers' first joints to their leaves.
  Eigen::Vector3d outward(const Eigen::VectorXd& values) const;
  /// Fixes the axes and takes as tips the leaves that reach farthest along the approach. False unless some stand on
  /// either side.
  bool choose_tips(const Eigen::VectorXd& values, const Eigen::Vector3d& approach, const Eigen::Vector3d& closing);

  const std::vector<Tip>& tips() const { return tips_; }
  /// Least of the tips' far ends along the approach [m].
  double reach(const Eigen::VectorXd& values) const;
  /// Free length along the closing axis between the tips of both sides [m], of their surfaces within half_depth of the
  /// tool frame's origin along the approach; negative: they overlap; infinite: none is there.
  double clearance_between(const Eigen::VectorXd& values, double half_depth) const;
  /// Size of the widest tip across approach and closing [m].
  double tip_width(const Eigen::VectorXd& values) const;
  /// Boxes around fingers and palm; without shapes the palm is as long and wide as the fingers.
  HandBody body(const Eigen::VectorXd& values, double half_depth) const;
  std::vector<Eigen::Matrix3d> tip_rotations(const Eigen::VectorXd& values) const;
  /// Most driven joints that move one tip.
  int drives_of_a_tip() const;
  /// Name of the tip link that a driven joint moves; of several the first.
  std::string finger_of(int joint) const;
  /// All links that the driven joints move and that have shapes.
  std::vector<std::string> finger_links() const;

 private:
  /// Corners of a link's shapes in the link's frame, and their triangles.
  struct Body {
    int link = -1;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<std::array<int, 3>> triangles;
  };

  Poses in_tool_frame(const Eigen::VectorXd& values) const;
  Body body_of(int link) const;
  bool moves(int joint, int link) const;
  /// Least and largest coordinate of a body along an axis of the tool frame.
  static std::pair<double, double> extent(const Body& body, const Pose& T, const Eigen::Vector3d& axis);

  const Robot& robot_;
  int tool_;
  std::vector<int> driven_;
  std::vector<Body> moved_;  ///< Links with shapes that the driven joints move.
  std::vector<int> leaves_;  ///< Indices into moved_.
  std::vector<int> roots_;   ///< First moved link of each leaf's finger.
  std::vector<Tip> tips_;
  Eigen::Vector3d approach_ = Eigen::Vector3d::UnitX(), closing_ = Eigen::Vector3d::UnitY();
};

}  // namespace mmgrasp::detail
