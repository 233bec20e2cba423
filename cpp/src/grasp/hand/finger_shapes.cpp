#include "grasp/hand/finger_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kOffMiddle = 1e-3;  // a finger's root this far from the middle tells its side [m]
constexpr double kThinnest = 1e-3;   // least size of a box of the body [m]

}  // namespace

int rigid_body_root(const Robot& robot, int link) {
  for (int joint = robot.links()[link].parent_joint; joint >= 0; joint = robot.links()[link].parent_joint) {
    if (robot.joints()[joint].type != JointType::fixed) break;
    link = robot.joints()[joint].parent_link;
  }
  return link;
}

bool hangs_on(const Robot& robot, int link, int ancestor) {
  while (link != ancestor) {
    const int joint = robot.links()[link].parent_joint;
    if (joint < 0) return false;
    link = robot.joints()[joint].parent_link;
  }
  return true;
}

FingerShapes::FingerShapes(const Robot& robot, int tool_link, const std::vector<int>& driven)
    : robot_(robot), tool_(tool_link), driven_(driven) {
  const int count = static_cast<int>(robot.links().size());
  const auto moved = [&](int link) {
    return std::any_of(driven.begin(), driven.end(), [&](int joint) { return moves(joint, link); });
  };
  for (int link = 0; link < count; ++link) {
    if (!moved(link)) continue;
    Body body = body_of(link);
    if (!body.vertices.empty()) moved_.push_back(std::move(body));
  }
  require(!moved_.empty(), "hand", robot.name(), "no link that its joints move has a collision shape");
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const bool ends = std::none_of(moved_.begin(), moved_.end(), [&](const Body& other) {
      return other.link != moved_[i].link && hangs_on(robot, other.link, moved_[i].link);
    });
    if (!ends) continue;
    int root = moved_[i].link;
    for (int joint = robot.links()[root].parent_joint; joint >= 0 && moved(robot.joints()[joint].parent_link);
         joint = robot.links()[root].parent_joint) {
      root = robot.joints()[joint].parent_link;
    }
    leaves_.push_back(static_cast<int>(i));
    roots_.push_back(root);
  }
}

Poses FingerShapes::in_tool_frame(const Eigen::VectorXd& values) const {
  Poses poses = robot_.link_poses(values);
  const Pose T_tool_root = poses[tool_].inverse(Eigen::Isometry);
  for (Pose& pose : poses) pose = T_tool_root * pose;
  return poses;
}

FingerShapes::Body FingerShapes::body_of(int link) const {
  Body body;
  body.link = link;
  for (const LinkShape& shape : robot_.links()[link].collisions) {
    const auto mesh = shape_mesh(shape.shape);
    const int first = static_cast<int>(body.vertices.size());
    for (const Vector3d& vertex : mesh->vertices) body.vertices.push_back(shape.T_link_shape * vertex);
    for (const auto& [a, b, c] : mesh->triangles) body.triangles.push_back({first + a, first + b, first + c});
  }
  return body;
}

bool FingerShapes::moves(int joint, int link) const {
  const std::vector<Joint>& joints = robot_.joints();
  for (int above = robot_.links()[link].parent_joint; above >= 0;
       above = robot_.links()[joints[above].parent_link].parent_joint) {
    if (above == joint || joints[above].mimic_joint == joint) return true;
  }
  return false;
}

std::pair<double, double> FingerShapes::extent(const Body& body, const Pose& T, const Vector3d& axis) {
  double least = kInfinity, largest = -kInfinity;
  for (const Vector3d& vertex : body.vertices) {
    const double at = axis.dot(T * vertex);
    least = std::min(least, at);
    largest = std::max(largest, at);
  }
  return {least, largest};
}

std::vector<Vector3d> FingerShapes::leaf_centres(const Eigen::VectorXd& values) const {
  const Poses poses = in_tool_frame(values);
  std::vector<Vector3d> centres;
  for (const int leaf : leaves_) {
    const Body& body = moved_[leaf];
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& vertex : body.vertices) sum += vertex;
    centres.push_back(poses[body.link] * Vector3d(sum / static_cast<double>(body.vertices.size())));
  }
  return centres;
}

Vector3d FingerShapes::outward(const Eigen::VectorXd& values) const {
  const Poses poses = in_tool_frame(values);
  const std::vector<Vector3d> centres = leaf_centres(values);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < centres.size(); ++i) sum += centres[i] - poses[roots_[i]].translation();
  return sum / static_cast<double>(centres.size());
}

bool FingerShapes::choose_tips(const Eigen::VectorXd& values, const Vector3d& approach, const Vector3d& closing) {
  approach_ = approach;
  closing_ = closing;
  const Poses poses = in_tool_frame(values);
  const std::vector<Vector3d> centres = leaf_centres(values);
  std::vector<double> far;
  double farthest = -kInfinity, begin = kInfinity;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    const Body& body = moved_[leaves_[i]];
    far.push_back(extent(body, poses[body.link], approach).second);
    farthest = std::max(farthest, far.back());
    begin = std::min(begin, approach.dot(poses[roots_[i]].translation()));
  }
  tips_.clear();
  bool left = false, right = false;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (far[i] < farthest - (farthest - begin) / 4) continue;
    const double root = closing.dot(poses[roots_[i]].translation());
    const double side = (std::abs(root) > kOffMiddle ? root : closing.dot(centres[i])) < 0 ? -1.0 : 1.0;
    tips_.push_back({static_cast<int>(i), side});
    (side < 0 ? left : right) = true;
  }
  return left && right;
}

double FingerShapes::reach(const Eigen::VectorXd& values) const {
  const Poses poses = in_tool_frame(values);
  double least = kInfinity;
  for (const Tip& tip : tips_) {
    const Body& body = moved_[leaves_[tip.leaf]];
    least = std::min(least, extent(body, poses[body.link], approach_).second);
  }
  return least;
}

double FingerShapes::clearance_between(const Eigen::VectorXd& values, double half_depth) const {
  const Poses poses = in_tool_frame(values);
  double inner[2] = {kInfinity, kInfinity};  // of the tips on either side: nearest coordinate, away from the middle
  for (const Tip& tip : tips_) {
    const Body& body = moved_[leaves_[tip.leaf]];
    const Pose& T = poses[body.link];
    double& nearest = inner[tip.side < 0 ? 0 : 1];
    for (const auto& triangle : body.triangles) {
      for (int k = 0; k < 3; ++k) {
        // Within the band a triangle comes nearest at a corner, or where an edge crosses the band's end.
        const Vector3d a = T * body.vertices[triangle[k]], b = T * body.vertices[triangle[(k + 1) % 3]];
        const double along_a = approach_.dot(a), along_b = approach_.dot(b);
        const double aside_a = tip.side * closing_.dot(a), aside_b = tip.side * closing_.dot(b);
        if (std::abs(along_a) <= half_depth) nearest = std::min(nearest, aside_a);
        for (const double end : {-half_depth, half_depth}) {
          if ((along_a - end) * (along_b - end) >= 0) continue;
          nearest = std::min(nearest, aside_a + (end - along_a) / (along_b - along_a) * (aside_b - aside_a));
        }
      }
    }
  }
  return inner[0] + inner[1];
}

double FingerShapes::tip_width(const Eigen::VectorXd& values) const {
  const Poses poses = in_tool_frame(values);
  double widest = 0;
  for (const Tip& tip : tips_) {
    const Body& body = moved_[leaves_[tip.leaf]];
    const auto [least, largest] = extent(body, poses[body.link], approach_.cross(closing_));
    widest = std::max(widest, largest - least);
  }
  return widest;
}

HandBody FingerShapes::body(const Eigen::VectorXd& values, double half_depth) const {
  const Poses poses = in_tool_frame(values);
  const auto half_length = [&](const Body& body, const Vector3d& axis) {
    const auto [least, largest] = extent(body, poses[body.link], axis);
    return std::max(std::abs(least), std::abs(largest));
  };
  double outer = 0;
  for (const Body& body : moved_) outer = std::max(outer, half_length(body, closing_));
  HandBody out;
  const double opening = clearance_between(values, half_depth);
  out.finger_thickness = std::max(kThinnest, outer - std::max(0.0, opening < kInfinity ? opening / 2 : 0.0));
  const Body palm = body_of(robot_.joints()[robot_.links()[roots_.front()].parent_joint].parent_link);
  double top = kInfinity;
  if (palm.vertices.empty()) {
    out.palm_length = 2 * outer;
    out.palm_width = tip_width(values);
    for (const int root : roots_) top = std::min(top, approach_.dot(poses[root].translation()));
  } else {
    out.palm_length = 2 * half_length(palm, closing_);
    out.palm_width = 2 * half_length(palm, approach_.cross(closing_));
    top = extent(palm, poses[palm.link], approach_).second;
  }
  out.finger_length = std::max(kThinnest, reach(values) - top);
  return out;
}

std::vector<Eigen::Matrix3d> FingerShapes::tip_rotations(const Eigen::VectorXd& values) const {
  const Poses poses = in_tool_frame(values);
  std::vector<Eigen::Matrix3d> rotations;
  for (const Tip& tip : tips_) rotations.push_back(poses[moved_[leaves_[tip.leaf]].link].linear());
  return rotations;
}

int FingerShapes::drives_of_a_tip() const {
  std::ptrdiff_t most = 0;
  for (const Tip& tip : tips_) {
    const int link = moved_[leaves_[tip.leaf]].link;
    most = std::max(most, std::count_if(driven_.begin(), driven_.end(), [&](int joint) { return moves(joint, link); }));
  }
  return static_cast<int>(most);
}

std::string FingerShapes::finger_of(int joint) const {
  for (const Tip& tip : tips_) {
    const int link = moved_[leaves_[tip.leaf]].link;
    if (moves(joint, link)) return robot_.links()[link].name;
  }
  return "fingers";
}

std::vector<std::string> FingerShapes::finger_links() const {
  std::vector<std::string> names;
  for (const Body& body : moved_) names.push_back(robot_.links()[body.link].name);
  return names;
}

}  // namespace mmgrasp::detail
