#include "mmgrasp/grasp/eigengrasp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr int kOpenings = 16;         // postures at which the opening is measured
constexpr double kLimitSlack = 1e-6;  // limits are often written with few digits
constexpr double kSameValue = 1e-12;  // joints that move less keep their value

}  // namespace

Eigen::MatrixXd eigengrasp_matrix(const std::vector<int>& sizes, const Eigen::VectorXd& open,
                                  const Eigen::VectorXd& closed) {
  int joints = 0;
  for (const int size : sizes) {
    require(size > 0, "sizes", size, "every group needs a joint");
    joints += size;
  }
  require(open.size() == joints, "open", std::to_string(open.size()) + " values",
          "must be one for each of " + std::to_string(joints) + " joints");
  require(closed.size() == joints, "closed", std::to_string(closed.size()) + " values",
          "must be one for each of " + std::to_string(joints) + " joints");
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(joints, static_cast<Eigen::Index>(sizes.size()));
  int row = 0;
  for (std::size_t group = 0; group < sizes.size(); ++group) {
    for (int j = 0; j < sizes[group]; ++j, ++row) M(row, static_cast<Eigen::Index>(group)) = closed[row] - open[row];
  }
  return M;
}

Hand eigengrasp_hand(const Robot& robot, const std::string& tool_link, const std::vector<EigengraspGroup>& groups,
                     const GraspType& type, const Vector3d& approach, double clearance) {
  require(std::abs(approach.norm() - 1) <= 1e-6, "approach", approach.norm(), "must be a unit vector");
  std::vector<int> sizes;
  for (const EigengraspGroup& group : groups) sizes.push_back(static_cast<int>(group.joints.size()));
  const Eigen::MatrixXd M = eigengrasp_matrix(sizes, type.open, type.closed);
  Hand hand;
  hand.tool_link = tool_link;
  hand.kind = ClosingKind::adaptive;
  hand.approach = approach;
  hand.clearance = clearance;
  hand.closing = approach.unitOrthogonal();
  int row = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (M.col(static_cast<Eigen::Index>(g)).cwiseAbs().maxCoeff() < kSameValue) hand.preshape[groups[g].name] = 1;
    for (const std::string& joint : groups[g].joints) {
      const Joint& driven = robot.joints()[robot.joint_index(joint)];
      for (const double value : {type.open[row], type.closed[row]})
        require(value >= driven.lower - kLimitSlack && value <= driven.upper + kLimitSlack, type.name + "." + joint,
                value, "must lie within the joint's limits");
      hand.joints.push_back({joint, type.closed[row], type.open[row], groups[g].name});
      ++row;
    }
  }
  // Axes and openings are those of the pads, which do not depend on them.
  const auto model = make_hand_model(hand, robot);
  const auto line_at = [&](double share) {
    return closing_line(model->pads(std::vector<double>(model->groups(), share)));
  };
  const Vector3d axis = line_at(0.5).axis, across = axis - axis.dot(approach) * approach;
  require(across.norm() > 0.5, "approach", type.name, "the fingertips close along it, not across it");
  hand.closing = across.normalized();
  std::vector<double> openings;
  for (int k = 0; k <= kOpenings; ++k) openings.push_back(std::max(0.0, line_at(1.0 * k / kOpenings).opening));
  hand.max_opening = *std::max_element(openings.begin(), openings.end());
  hand.min_opening = openings.front();
  require(hand.min_opening < hand.max_opening, "type", type.name, "its fingertips do not move apart");
  // A table where the fingers part all the way; where they first meet on it, what is beyond is closed too.
  if (std::adjacent_find(openings.begin(), openings.end(), [](double a, double b) { return a >= b; }) == openings.end())
    hand.openings = openings;
  const std::vector<FingerPad> pads = model->pads(std::vector<double>(model->groups(), 0.5));
  hand.finger_depth = pads[0].depth;
  hand.finger_width = pads[0].width;
  hand.finger_links = model->link_of_pad();
  hand.check_fingers();
  return hand;
}

}  // namespace mmgrasp
