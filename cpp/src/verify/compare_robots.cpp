#include "verify/compare_robots.hpp"

#include <algorithm>
#include <cmath>

#include "verify/context.hpp"
#include "verify/robot/kdl_pose.hpp"

namespace mmgrasp::verify::detail {
namespace {

// Roll, pitch and yaw written out and read again lose about 1e-8 rad where the pitch is a right angle.
constexpr double kSlack = 1e-6;      // [m] or [rad], or relative for what is larger than 1
constexpr double kMeshSlack = 1e-5;  // [m]: assimp rounds vertices to float

bool same(double a, double b) {
  return a == b || std::abs(a - b) <= kSlack * std::max({1.0, std::abs(a), std::abs(b)});
}

std::string shown(double value) {
  return text(value);
}

std::string shown(const Eigen::Vector3d& v) {
  return text(v);
}

std::string shown(const KDL::Vector& v) {
  return text(Eigen::Vector3d(v.x(), v.y(), v.z()));
}

std::string shown(const std::string& name) {
  return "'" + name + "'";
}

/// Goes through links and joints of two robots by name and notes what differs.
class Comparison {
 public:
  Comparison(const RobotModel& read, const RobotModel& planned, Faults& faults)
      : read_(read), planned_(planned), faults_(faults) {}

  void run() {
    for (const ModelLink& link : read_.links) {
      const int other = planned_.link_index(link.name);
      if (other < 0) {
        add("link " + shown(link.name), "the robot that was planned for lacks it");
      } else {
        compare_carriers(link, planned_.links[other]);
        compare_shapes(link, planned_.links[other]);
      }
    }
    for (const ModelLink& link : planned_.links) {
      if (read_.link_index(link.name) < 0)
        add("link " + shown(link.name), "the robot's description has no such link, but the plan was made with it");
    }
  }

 private:
  void add(const std::string& where, const std::string& message) {
    faults_.push_back({"robot-differs", where, message});
  }

  template <typename T>
  void differs(const std::string& where, const std::string& what, const T& read, const T& planned) {
    add(where, what + " is " + shown(read) + " by the URDF, the plan was made with " + shown(planned));
  }

  void compare_carriers(const ModelLink& link, const ModelLink& planned_link) {
    if (link.joint < 0 && planned_link.joint < 0) return;
    if (link.joint < 0 || planned_link.joint < 0) {
      add("link " + shown(link.name), link.joint < 0 ? "is the root, the plan was made with it on a joint"
                                                     : "hangs on a joint, the plan was made with it as the root");
      return;
    }
    const ModelJoint& a = read_.joints[link.joint];
    const ModelJoint& b = planned_.joints[planned_link.joint];
    const std::string where = "joint " + shown(a.name);
    const std::string parent = read_.links[a.parent].name, planned_parent = planned_.links[b.parent].name;
    if (a.name != b.name) differs(where, "its name", a.name, b.name);
    if (a.kind != b.kind) differs(where, "its type", std::string(to_string(a.kind)), std::string(to_string(b.kind)));
    if (parent != planned_parent) differs(where, "its parent link", parent, planned_parent);
    compare_frames(where, a, b);
    if (a.kind == b.kind) compare_motion(where, a, b);
  }

  void compare_frames(const std::string& where, const ModelJoint& a, const ModelJoint& b) {
    const KDL::Vector& p = a.T_parent_child.p;
    if ((p - b.T_parent_child.p).Norm() > kSlack * std::max(1.0, p.Norm()))
      differs(where, "its origin", p, b.T_parent_child.p);
    const KDL::Rotation &R = a.T_parent_child.M, &planned_R = b.T_parent_child.M;
    if (KDL::diff(R, planned_R).Norm() <= kSlack) return;
    KDL::Vector rpy, planned_rpy;
    R.GetRPY(rpy[0], rpy[1], rpy[2]);
    planned_R.GetRPY(planned_rpy[0], planned_rpy[1], planned_rpy[2]);
    differs(where, "its origin's rpy", rpy, planned_rpy);
  }

  void compare_motion(const std::string& where, const ModelJoint& a, const ModelJoint& b) {
    if (!a.moves()) return;
    if ((a.axis - b.axis).Norm() > kSlack) differs(where, "its axis", a.axis, b.axis);
    if (!same(a.lower, b.lower)) differs(where, "its lower limit", a.lower, b.lower);
    if (!same(a.upper, b.upper)) differs(where, "its upper limit", a.upper, b.upper);
    if (!same(a.velocity, b.velocity)) differs(where, "its velocity limit", a.velocity, b.velocity);
    const std::string source = read_.joints[a.source].name, planned_source = planned_.joints[b.source].name;
    if (source != planned_source) differs(where, "the joint it follows", source, planned_source);
    if (!same(a.multiplier, b.multiplier)) differs(where, "its mimic multiplier", a.multiplier, b.multiplier);
    if (!same(a.offset, b.offset)) differs(where, "its mimic offset", a.offset, b.offset);
  }

  void compare_shapes(const ModelLink& a, const ModelLink& b) {
    const std::string where = "link " + shown(a.name);
    if (a.shapes.size() != b.shapes.size())
      return differs(where, "the number of its collision shapes", static_cast<double>(a.shapes.size()),
                     static_cast<double>(b.shapes.size()));
    for (std::size_t i = 0; i < a.shapes.size(); ++i)
      compare_shape(where + ", collision " + std::to_string(i), a.shapes[i], b.shapes[i]);
  }

  void compare_shape(const std::string& where, const LinkShape& a, const LinkShape& b) {
    const auto* mesh = std::get_if<MeshShape>(&a.shape);
    if (mesh && !std::holds_alternative<MeshShape>(b.shape)) {
      if (mesh->mesh) compare_stand_in(where, a, b);
      return;
    }
    if (a.shape.index() != b.shape.index())
      return differs(where, "its shape", std::string(shape_kind(a.shape)), std::string(shape_kind(b.shape)));
    const Vector6d difference = pose_difference(a.T_link_shape, b.T_link_shape);
    if (difference.head<3>().norm() > kSlack)
      differs(where, "its origin", Eigen::Vector3d(a.T_link_shape.translation()),
              Eigen::Vector3d(b.T_link_shape.translation()));
    if (difference.tail<3>().norm() > kSlack)
      differs(where, "its origin's rpy", rpy_from_rotation(a.T_link_shape.linear()),
              rpy_from_rotation(b.T_link_shape.linear()));
    if (mesh) {
      if (a.mesh_path != b.mesh_path) differs(where, "its mesh file", a.mesh_path, b.mesh_path);
      if (!a.mesh_scale.isApprox(b.mesh_scale, kSlack)) differs(where, "its mesh scale", a.mesh_scale, b.mesh_scale);
      return;
    }
    const Eigen::Vector3d size = shape_bounds(a.shape).sizes(), planned_size = shape_bounds(b.shape).sizes();
    if (!size.isApprox(planned_size, kSlack)) differs(where, "its size", size, planned_size);
  }

  void compare_stand_in(const std::string& where, const LinkShape& a, const LinkShape& b) {
    const Eigen::AlignedBox3d mesh = shape_bounds(a.shape, a.T_link_shape);
    Eigen::AlignedBox3d planned = shape_bounds(b.shape, b.T_link_shape);
    planned.min().array() -= kMeshSlack;
    planned.max().array() += kMeshSlack;
    if (planned.contains(mesh)) return;
    add(where, "the mesh '" + a.mesh_path + "' of extent " + shown(Eigen::Vector3d(mesh.sizes())) +
                   " is not inside the " + shape_kind(b.shape) + " of extent " +
                   shown(Eigen::Vector3d(planned.sizes())) + " that the plan was made with");
  }

  const RobotModel& read_;
  const RobotModel& planned_;
  Faults& faults_;
};

}  // namespace

void compare_robots(const RobotModel& read, const RobotModel& planned, Faults& faults) {
  Comparison(read, planned, faults).run();
}

}  // namespace mmgrasp::verify::detail
