// make_hand_model of a hand with many joints: pads and boxes by forward kinematics.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grasp/hand/finger_shapes.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "mmgrasp/grasp/eigengrasp.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kPadLength = 0.6;   // of a fingertip's length that its pad takes
constexpr double kLeastPad = 0.004;  // least side of a pad [m]
constexpr double kShareStep = 0.01;  // for the way a tip moves, by finite differences

/// A hand whose pads and bodies follow from forward kinematics of its driven joints.
class JointedHand final : public HandModel {
 public:
  JointedHand(const Hand& hand, const Robot& robot)
      : hand_(hand), robot_(robot), tool_(robot.link_index(hand.tool_link)) {
    names_ = hand_.groups();
    for (const std::string& name : names_)
      if (hand_.preshape.count(name) == 0) closing_.push_back(name);
    require(!closing_.empty(), "hand", hand_.tool_link, "no group of joints closes its fingers");
    find_boxes();
    find_pads();
  }

  const Hand& hand() const override { return hand_; }
  int groups() const override { return static_cast<int>(closing_.size()); }
  std::vector<int> group_of_pad() const override { return pad_group_; }
  std::vector<std::string> link_of_pad() const override {
    std::vector<std::string> names;
    for (const int link : pad_link_) names.push_back(robot_.links()[link].name);
    return names;
  }
  bool parallel() const override { return false; }

  std::vector<FingerPad> pads(const std::vector<double>& shares) const override {
    const Poses poses = in_tool_frame(shares);
    std::vector<FingerPad> pads = link_pads_;
    for (std::size_t k = 0; k < pads.size(); ++k) pads[k].T_hand_pad = poses[pad_link_[k]] * link_pads_[k].T_hand_pad;
    return pads;
  }

  std::vector<LinkShape> boxes(const std::vector<double>& shares) const override {
    const Poses poses = in_tool_frame(shares);
    std::vector<LinkShape> boxes = link_boxes_;
    for (std::size_t k = 0; k < boxes.size(); ++k)
      boxes[k].T_link_shape = poses[box_link_[k]] * link_boxes_[k].T_link_shape;
    return boxes;
  }

  std::vector<double> posture(const std::vector<double>& shares) const override {
    std::vector<double> posture;
    std::size_t next = 0;
    for (const std::string& name : names_) {
      const auto held = hand_.preshape.find(name);
      posture.push_back(held != hand_.preshape.end() ? held->second : shares.at(next++));
    }
    return posture;
  }

  std::vector<double> shares_of(double, const std::vector<double>& posture) const override {
    std::vector<double> shares;
    for (std::size_t k = 0; k < names_.size(); ++k)
      if (hand_.preshape.count(names_[k]) == 0) shares.push_back(posture.at(k));
    return shares;
  }

 private:
  Poses in_tool_frame(const std::vector<double>& shares) const {
    Eigen::VectorXd values = robot_.default_values();
    for (const auto& [name, value] : hand_.joint_values(posture(shares)))
      values[robot_.joints()[robot_.joint_index(name)].value_index] = value;
    Poses poses = robot_.link_poses(values);
    const Pose T_tool_root = poses[tool_].inverse(Eigen::Isometry);
    for (Pose& pose : poses) pose = T_tool_root * pose;
    return poses;
  }

  void find_boxes() {
    const int body = detail::rigid_body_root(robot_, tool_);
    for (int link = 0; link < static_cast<int>(robot_.links().size()); ++link) {
      if (!detail::hangs_on(robot_, link, body)) continue;
      for (const LinkShape& shape : robot_.links()[link].collisions) {
        const Eigen::AlignedBox3d bounds = shape_bounds(shape.shape);
        link_boxes_.emplace_back();
        link_boxes_.back().shape = Box{bounds.sizes()};
        link_boxes_.back().T_link_shape = shape.T_link_shape * Eigen::Translation3d(bounds.center());
        box_link_.push_back(link);
      }
    }
  }

  /// The last link with shapes below each joint of a group: with none further out.
  std::vector<int> tips_of(const std::string& group) const {
    std::vector<int> tips;
    for (std::size_t k = 0; k < box_link_.size(); ++k) {
      const int link = box_link_[k];
      const bool moved = std::any_of(hand_.joints.begin(), hand_.joints.end(), [&](const HandJoint& joint) {
        return joint.group == group && joint.open != joint.closed &&
               detail::hangs_on(robot_, link, robot_.joints()[robot_.joint_index(joint.name)].child_link);
      });
      const bool last = std::none_of(box_link_.begin(), box_link_.end(),
                                     [&](int other) { return other != link && detail::hangs_on(robot_, other, link); });
      if (moved && last && std::find(tips.begin(), tips.end(), link) == tips.end()) tips.push_back(link);
    }
    return tips;
  }

  void find_pads() {
    const std::vector<double> half(closing_.size(), 0.5);
    for (int group = 0; group < groups(); ++group) {
      for (const int link : tips_of(closing_[group])) {
        // A joint that spreads fingers belongs to a group of its own; their own group makes the pad.
        if (std::find(pad_link_.begin(), pad_link_.end(), link) != pad_link_.end()) continue;
        link_pads_.push_back(inner_face(link, group, half));
        pad_link_.push_back(link);
        pad_group_.push_back(group);
      }
    }
    for (int group = 0; group < groups(); ++group) {
      require(std::find(pad_group_.begin(), pad_group_.end(), group) != pad_group_.end(), "hand", closing_[group],
              "a group of joints that closes no fingertip of its own must have one value, opened and closed");
    }
    require(pad_link_.size() >= 2, "hand", std::to_string(pad_link_.size()) + " fingertips",
            "at least two that its closing groups move are needed");
  }

  /// The finger's inner face, in the link's frame.
  FingerPad inner_face(int link, int group, const std::vector<double>& half) const {
    std::vector<double> closer = half;
    closer[group] -= kShareStep;
    const Pose now = in_tool_frame(half)[link], then = in_tool_frame(closer)[link];
    TriangleMesh all;
    for (const LinkShape& shape : robot_.links()[link].collisions) {
      const auto mesh = shape_mesh(shape.shape);
      const int first = static_cast<int>(all.vertices.size());
      for (const Vector3d& v : mesh->vertices) all.vertices.push_back(shape.T_link_shape * v);
      for (const auto& [a, b, c] : mesh->triangles) all.triangles.push_back({first + a, first + b, first + c});
    }
    Eigen::AlignedBox3d bounds;
    for (const Vector3d& v : all.vertices) bounds.extend(v);
    const Vector3d middle = bounds.center();
    // The joint that carries the tip is the link's origin: the finger's length runs from it to the middle.
    const Vector3d along = middle.norm() > 1e-6 ? Vector3d(middle.normalized()) : Vector3d(Vector3d::UnitZ());
    Vector3d normal = now.linear().transpose() * (then * middle - now * middle);
    normal -= normal.dot(along) * along;
    require(normal.norm() > 1e-9, "hand", robot_.links()[link].name, "this fingertip does not close");
    normal.normalize();
    const Vector3d side = normal.cross(along);
    const auto extent = [&](const Vector3d& axis) {
      double low = detail::kInfinity, high = -low;
      for (const Vector3d& v : all.vertices) {
        low = std::min(low, axis.dot(v));
        high = std::max(high, axis.dot(v));
      }
      return std::pair{low, high};
    };
    const auto [low, high] = extent(normal);
    const RayHit hit = RayCaster(all).closest_hit({middle + (high - low + 0.01) * normal, -normal});
    FingerPad pad;
    pad.T_hand_pad.linear() << along, normal.cross(along), normal;
    pad.T_hand_pad.translation() = hit ? hit.point : Vector3d(middle + (high - normal.dot(middle)) * normal);
    const auto [begin, end] = extent(along);
    const auto [left, right] = extent(side);
    pad.depth = std::max(kLeastPad, kPadLength * (end - begin));
    pad.width = std::max(kLeastPad, right - left);
    return pad;
  }

  Hand hand_;
  Robot robot_;
  int tool_;
  std::vector<std::string> names_, closing_;
  std::vector<LinkShape> link_boxes_;
  std::vector<int> box_link_;
  std::vector<FingerPad> link_pads_;
  std::vector<int> pad_link_, pad_group_;
};

}  // namespace

std::shared_ptr<const HandModel> make_hand_model(const Hand& hand, const Robot& robot) {
  return std::make_shared<JointedHand>(hand, robot);
}

}  // namespace mmgrasp
