// Lower and upper limits of the finger length in an operation: how high the parts stand above the plane of the finger
// tips, below the fingers' and below the palm's outline.
#include "mmgrasp/grasp/finger_length_range.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"
#include "mmgrasp/grasp/detail/motion_looks.hpp"

namespace mmgrasp {
namespace {

using detail::HalfPlane;
using detail::kInfinity;
using detail::kTwoPi;

constexpr double kTouching = 1e-6;  // [m]
constexpr int kPalmCorners = 96;    // Corners of the polygon around the palm; 0.05 % larger.
constexpr int kMaxLooks = 1000000;

/// A convex outline, endless along the approach.
class Column {
 public:
  explicit Column(std::vector<HalfPlane> sides) : sides_(std::move(sides)) {}

  Column grown(double margin) const {
    Column out = *this;
    for (HalfPlane& side : out.sides_) side.d += margin;
    return out;
  }

  Eigen::Vector2d middle() const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& c : corners()) sum += c;
    return sum / static_cast<double>(sides_.size());
  }

  /// The part of a triangle inside: least and largest height, or nothing.
  bool heights(const std::array<Eigen::Vector3d, 3>& triangle, double& low, double& high) const {
    std::vector<Eigen::Vector3d> polygon(triangle.begin(), triangle.end());
    for (const HalfPlane& side : sides_) {
      polygon = detail::clip_polygon(polygon, side);
      if (polygon.empty()) return false;
    }
    low = kInfinity;
    high = -kInfinity;
    for (const Eigen::Vector3d& p : polygon) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    return true;
  }

  /// Half the size of a square about the origin around it.
  double reach() const {
    double out = 0;
    for (const Eigen::Vector2d& c : corners()) out = std::max(out, c.cwiseAbs().maxCoeff());
    return out;
  }

 private:
  std::vector<Eigen::Vector2d> corners() const {
    std::vector<Eigen::Vector2d> out;
    for (std::size_t i = 0; i < sides_.size(); ++i) {
      const HalfPlane &a = sides_[i], &b = sides_[(i + 1) % sides_.size()];
      Eigen::Matrix2d lines;
      lines << a.n.transpose(), b.n.transpose();
      out.push_back(lines.inverse() * Eigen::Vector2d(a.d, b.d));
    }
    return out;
  }

  std::vector<HalfPlane> sides_;  // Sorted by angle.
};

/// A finger between `from` and `to` off the axis; number `i` of `grasp.fingers`.
Column finger(const AssemblyGrasp& grasp, int i, double from, double to) {
  const double turn = kTwoPi * i / grasp.fingers;
  const Eigen::Vector2d out(std::cos(turn), std::sin(turn)), side(-out.y(), out.x());
  const double half = grasp.width / 2 - kTouching;
  return Column({{out, to - kTouching}, {side, half}, {-out, -(from + kTouching)}, {-side, half}});
}

Column palm(const AssemblyGrasp& grasp) {
  std::vector<HalfPlane> sides;
  for (int i = 0; i < kPalmCorners; ++i) {
    const double turn = kTwoPi * i / kPalmCorners;
    sides.push_back({{std::cos(turn), std::sin(turn)}, grasp.palm_radius - kTouching});
  }
  return Column(std::move(sides));
}

/// Transform from the pose's parent to the frame of heights: x and y in the plane of the tips, z towards the palm.
Eigen::Isometry3d height_frame(const Pose& T_parent_tool) {
  Eigen::Isometry3d flip = Eigen::Isometry3d::Identity();
  flip.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();  // Mirrored fingers are the same fingers.
  return flip * T_parent_tool.inverse();
}

/// Collects from every part, over the whole operation, how high it stands under fingers and palm.
class Range {
 public:
  Range(const AssemblyGrasp& grasp, const AssemblyOperation& operation, double step)
      : grasp_(grasp),
        operation_(operation),
        step_(step),
        middle_(detail::middle_of(operation.active)),
        palm_(palm(grasp)) {
    const double r = grasp.opening / 2, back = grasp.thickness;
    for (int i = 0; i < grasp.fingers; ++i) {
      closed_.push_back(finger(grasp, i, r, r + back));
      opening_.push_back(finger(grasp, i, r, r + grasp.clearance + back));
    }
    reach_ = palm_.reach();
    for (const Column& c : opening_) reach_ = std::max(reach_, c.reach());
  }

  FingerLengthRange run() {
    const Eigen::Isometry3d from_active = height_frame(grasp_.T_active_tool);
    for (const PlacedMesh& part : operation_.active) {
      look(part, from_active * part.pose, from_active * part.pose, opening_, true, 0, "the grasp");
    }
    if (operation_.motion.size() > 1) {  // fingers come open to where the motion begins
      const Eigen::Isometry3d at_start = from_passive(operation_.motion.front());
      for (const PlacedMesh& part : operation_.passive)
        look(part, at_start * part.pose, at_start * part.pose, opening_, true, 0, "the start");
    }
    const Eigen::Isometry3d at_end = from_passive(operation_.motion.back());
    for (const PlacedMesh& part : operation_.passive) {
      look(part, at_end * part.pose, at_end * part.pose, opening_, true, 0, "the end");
    }
    for (std::size_t i = 0; i + 1 < operation_.motion.size(); ++i) {
      follow(operation_.motion[i], operation_.motion[i + 1]);
    }
    range_.free = range_.shortest <= range_.longest;
    range_.longest = std::max(range_.longest, 0.0);
    return range_;
  }

 private:
  Eigen::Isometry3d from_passive(const Pose& T_passive_active) const {
    return height_frame(T_passive_active * grasp_.T_active_tool);
  }

  void follow(const Pose& from, const Pose& to) {
    const Eigen::Isometry3d a = from_passive(from), b = from_passive(to);
    const detail::MotionPiece piece(from, to, middle_);
    const Eigen::Vector3d rise = b.translation() - a.translation();
    if (piece.angle() < 1e-12 && rise.head<2>().norm() < 1e-12) {
      for (const PlacedMesh& part : operation_.passive) {
        look(part, a * part.pose, b * part.pose, closed_, false, 0, "the motion");
      }
      return;
    }
    const double moved = longest_way(piece), count = std::ceil(moved / step_);
    if (!(count < kMaxLooks))
      throw InvalidInput("step = " + std::to_string(step_) + ": the motion would be checked more than 1000000 times");
    const int looks = std::max(1, static_cast<int>(count));
    for (int k = 0; k <= looks && range_.shortest <= range_.longest; ++k) {
      const Eigen::Isometry3d at = from_passive(piece.at(static_cast<double>(k) / looks));
      for (const PlacedMesh& part : operation_.passive) {
        look(part, at * part.pose, at * part.pose, closed_, false, moved / looks / 2, "the motion");
      }
    }
  }

  /// No point of the passive subassembly moves farther than this, seen from the gripper: as the middle does, and as far
  /// as it is from the middle times the turn. Distances from a point that moves straight are largest at an end.
  double longest_way(const detail::MotionPiece& piece) const {
    double farthest = 0;
    for (const PlacedMesh& part : operation_.passive) {
      if (piece.angle() == 0) break;
      for (const Eigen::Vector3d& v : part.mesh->vertices) {
        const Eigen::Vector3d p = part.pose * v;
        farthest = std::max({farthest, (p - piece.middle_from()).norm(), (p - piece.middle_to()).norm()});
      }
    }
    return piece.way().norm() + piece.angle() * farthest;
  }

  /// A part that moves straight along the approach from `a` to `b`. Fingers that move in or back along it (`passing`)
  /// allow nothing above their tips.
  void look(const PlacedMesh& part, const Eigen::Isometry3d& a, const Eigen::Isometry3d& b,
            const std::vector<Column>& fingers, bool passing, double margin, const char* when) {
    if (range_.shortest > range_.longest) return;
    const double rise = b.translation().z() - a.translation().z();
    const double up = std::max(rise, 0.0), down = std::min(rise, 0.0);
    const Eigen::AlignedBox3d& box = box_of(part);
    const Eigen::Vector3d centre = a * box.center();
    const double radius = box.diagonal().norm() / 2, outer = std::sqrt(2.0) * reach_ + margin + radius;
    if (centre.z() + radius + up + margin <= kTouching || centre.head<2>().norm() > outer) return;
    const Column palm = palm_.grown(margin);
    std::vector<Column> grown;
    for (const Column& c : fingers) grown.push_back(c.grown(margin));
    const double reach = reach_ + margin;
    std::vector<Eigen::Vector3d> points;
    points.reserve(part.mesh->vertices.size());
    for (const Eigen::Vector3d& v : part.mesh->vertices) points.push_back(a * v);
    for (const auto& t : part.mesh->triangles) {
      poll_();
      const std::array<Eigen::Vector3d, 3> corners{points[t[0]], points[t[1]], points[t[2]]};
      if (std::max({corners[0].z(), corners[1].z(), corners[2].z()}) + up + margin <= kTouching) continue;
      const Eigen::Vector3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
      const Eigen::Vector3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
      if (low.head<2>().maxCoeff() > reach || high.head<2>().minCoeff() < -reach) continue;
      double least = 0, most = 0;
      if (palm.heights(corners, least, most)) raise(most + up + margin, part, when);
      for (const Column& c : grown) {
        if (c.heights(corners, least, most)) block(least + down - margin, most + up + margin, passing, part, when);
      }
    }
    if (!part.mesh->closed) return;
    const Eigen::Isometry3d back = a.inverse();
    for (const Column& c : grown) {  // A tip deep inside meets no surface.
      const Eigen::Vector2d middle = c.middle();
      const Eigen::Vector3d tip = back * Eigen::Vector3d(middle.x(), middle.y(), kTouching);
      if (box.contains(tip) && mesh_contains(*part.mesh, tip)) block(-kInfinity, kInfinity, passing, part, when);
    }
  }

  const Eigen::AlignedBox3d& box_of(const PlacedMesh& part) {
    const auto [place, is_new] = boxes_.try_emplace(part.mesh.get());
    if (is_new) {
      for (const Eigen::Vector3d& v : part.mesh->vertices) place->second.extend(v);
    }
    return place->second;
  }

  /// The palm's outline has something up to this height.
  void raise(double height, const PlacedMesh& part, const char* when) {
    if (height - kTouching <= range_.shortest) return;
    range_.shortest = height;
    range_.shortest_by = part.name + " at " + when;
  }

  /// A finger's outline has something between these heights.
  void block(double low, double high, bool passing, const PlacedMesh& part, const char* when) {
    if (high <= kTouching) return;
    const double longest = passing ? 0 : std::max(low, 0.0);
    if (longest >= range_.longest) return;
    range_.longest = longest <= kTouching ? 0 : longest;
    range_.longest_by = part.name + " at " + when;
    if (range_.longest == 0) range_.longest = -1;  // No length at all.
  }

  const AssemblyGrasp& grasp_;
  const AssemblyOperation& operation_;
  double step_;
  Eigen::Vector3d middle_;  // The active parts'.
  Column palm_;
  std::vector<Column> closed_, opening_;
  double reach_ = 0;
  std::map<const TriangleMesh*, Eigen::AlignedBox3d> boxes_;
  FingerLengthRange range_;
  detail::InterruptionPoll poll_;
};

bool is_pose(const Pose& pose) {
  return pose.matrix().allFinite() && (pose.linear() * pose.linear().transpose()).isIdentity(1e-6) &&
         pose.linear().determinant() > 0;
}

void check_parts(const std::vector<PlacedMesh>& parts, const std::string& field) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::string at = field + "[" + std::to_string(i) + "]";
    if (!parts[i].mesh) throw InvalidInput(at + ".mesh is missing");
    if (!is_pose(parts[i].pose)) throw InvalidInput(at + ".pose is no pose: rotation and translation expected");
  }
}

}  // namespace

void AssemblyOperation::check() const {
  if (active.empty()) throw InvalidInput("active is empty: an operation moves at least one part");
  check_parts(active, "active");
  check_parts(passive, "passive");
  if (motion.empty()) throw InvalidInput("motion is empty: give T_passive_active at the operation's end at least");
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (!is_pose(motion[i])) throw InvalidInput("motion[" + std::to_string(i) + "] is no pose");
  }
  require_not_negative(insertion_force, "insertion_force", "N");
  if (hole) require_numbers(*hole, "hole", "m");
  if (insertion_force == 0) return;
  const bool straight =
      motion.size() > 1 &&
      detail::MotionPiece(motion.end()[-2], motion.back(), detail::middle_of(active)).way().norm() > kTouching;
  require(straight, "insertion_force", insertion_force, "needs a motion that ends with a straight line");
}

void AssemblyGrasp::check() const {
  require(fingers == 2 || fingers == 3, "fingers", fingers, "must be 2 or 3");
  const auto positive = [](const char* field, double value) {
    require_number(value, field, "m");
    require(value > 10 * kTouching, field, value, "must be a length above 1e-5 [m]");
  };
  positive("opening", opening);
  positive("width", width);
  positive("thickness", thickness);
  positive("palm_radius", palm_radius);
  const auto not_negative = [](const char* field, double value) { require_not_negative(value, field, "m"); };
  not_negative("clearance", clearance);
  not_negative("contact_length", contact_length);
  not_negative("contact_width", contact_width);
  if (!is_pose(T_active_tool)) throw InvalidInput("T_active_tool is no pose: rotation and translation expected");
}

FingerLengthRange finger_length_range(const AssemblyGrasp& grasp, const AssemblyOperation& operation, double step) {
  grasp.check();
  operation.check();
  require_length(step, "step");
  return Range(grasp, operation, step).run();
}

}  // namespace mmgrasp
