// What tells one robot from another in caches.
#include "mmgrasp/core/hash.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp {
namespace {

void add_pose(Hasher& hasher, const Pose& T) {
  const Eigen::Matrix<double, 3, 4> values = T.matrix().topRows<3>();
  hasher.add(Eigen::MatrixXd(values));
}

void add_vector(Hasher& hasher, const Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i) hasher.add(v[i]);
}

void add_mesh(Hasher& hasher, const TriangleMesh& mesh) {
  hasher.add(mesh.vertices.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) hasher.add(vertex.data(), 3 * sizeof(double));
  hasher.add(mesh.triangles.size());
  for (const std::array<int, 3>& triangle : mesh.triangles) hasher.add(triangle.data(), sizeof(triangle));
  hasher.add(mesh.closed).add(mesh.convex);
}

struct ShapeHash {
  Hasher& hasher;
  void operator()(const Box& box) const { add_vector(hasher, box.size); }
  void operator()(const Sphere& sphere) const { hasher.add(sphere.radius); }
  void operator()(const Cylinder& cylinder) const { hasher.add(cylinder.radius).add(cylinder.length); }
  void operator()(const Capsule& capsule) const { hasher.add(capsule.radius).add(capsule.length); }
  void operator()(const Plane& plane) const {
    add_vector(hasher, plane.normal);
    hasher.add(plane.offset);
  }
  void operator()(const MeshShape& shape) const {
    if (shape.mesh) add_mesh(hasher, *shape.mesh);
  }
  void operator()(const Voxels& voxels) const {
    hasher.add(voxels.resolution);
    if (voxels.centres)
      for (const Eigen::Vector3d& centre : *voxels.centres) add_vector(hasher, centre);
  }
};

void add_link(Hasher& hasher, const Link& link) {
  hasher.add(link.name).add(link.parent_joint).add(link.collisions.size());
  for (const LinkShape& shape : link.collisions) {
    hasher.add(shape.shape.index());
    add_pose(hasher, shape.T_link_shape);
    std::visit(ShapeHash{hasher}, shape.shape);
  }
}

void add_joint(Hasher& hasher, const Joint& joint) {
  hasher.add(joint.name).add(joint.type).add(joint.parent_link).add(joint.child_link);
  add_pose(hasher, joint.T_parent_joint);
  add_vector(hasher, joint.axis);
  hasher.add(joint.lower).add(joint.upper).add(joint.velocity).add(joint.effort);
  hasher.add(joint.mimic_joint).add(joint.mimic_multiplier).add(joint.mimic_offset);
}

}  // namespace

std::string Robot::hash() const {
  Hasher hasher;
  hasher.add(data_->base);
  const BaseLimits& limits = data_->base_limits;
  hasher.add(limits.linear_velocity).add(limits.angular_velocity).add(limits.linear_acceleration);
  hasher.add(limits.angular_acceleration).add(limits.workspace);
  hasher.add(limits.wheel_velocity).add(limits.wheel_separation);
  if (limits.wheelbase > 0) hasher.add(limits.wheelbase);
  for (const Link& link : data_->links) add_link(hasher, link);
  for (const Joint& joint : data_->joints) add_joint(hasher, joint);
  // Only which pairs are off matters to a result, not why.
  for (const auto& entry : data_->disabled_pairs) hasher.add(entry.first.first).add(entry.first.second);
  return hasher.hex();
}

}  // namespace mmgrasp
