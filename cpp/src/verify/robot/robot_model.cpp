#include "verify/robot/robot_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "verify/robot/kdl_pose.hpp"
#include "verify/robot/mesh_file.hpp"
#include "verify/robot/srdf_pairs.hpp"
#include "verify/robot/urdf_document.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kLargest = 1e12;         // [m] or [rad]: sums and products of what is read stay finite
constexpr double kUnknownVelocity = 1.0;  // [rad/s] or [m/s], where a URDF gives none

KDL::Frame frame_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

JointKind kind_of(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return JointKind::revolute;
    case urdf::Joint::CONTINUOUS:
      return JointKind::continuous;
    case urdf::Joint::PRISMATIC:
      return JointKind::prismatic;
    case urdf::Joint::PLANAR:
      return JointKind::planar;
    case urdf::Joint::FLOATING:
      return JointKind::floating;
    default:
      return JointKind::fixed;
  }
}

/// A joint before links and joints have indices.
struct NamedJoint {
  ModelJoint joint;
  std::string parent, child, mimic;
};

KDL::Joint kdl_joint(const ModelJoint& joint) {
  const KDL::Vector axis = joint.T_parent_child.M * joint.axis;
  if (joint.turns()) return {joint.name, joint.T_parent_child.p, axis, KDL::Joint::RotAxis};
  if (joint.kind == JointKind::prismatic) return {joint.name, joint.T_parent_child.p, axis, KDL::Joint::TransAxis};
  return KDL::Joint(joint.name, KDL::Joint::Fixed);
}

/// Gathers the links and joints of all sources, then orders them.
class Assembly {
 public:
  explicit Assembly(bool load_meshes) : load_meshes_(load_meshes) {}

  void add(const UrdfSource& source);
  void add(const AddedLink& added);
  void order(RobotModel& model);

 private:
  void add_link(ModelLink link) {
    const std::string name = link.name;
    if (!links_.emplace(name, std::move(link)).second) throw InvalidInput("link \"" + name + "\": exists twice");
  }
  void add_joint(NamedJoint named) {
    const std::string name = named.joint.name;
    if (!joints_.emplace(name, std::move(named)).second) throw InvalidInput("joint \"" + name + "\": exists twice");
  }
  void add_fixed(const std::string& name, const std::string& parent, const std::string& child, const Pose& T) {
    NamedJoint named;
    named.joint.name = name;
    named.joint.T_parent_child = to_kdl(T);
    named.parent = parent;
    named.child = child;
    add_joint(std::move(named));
  }
  ModelLink read_link(const UrdfSource& source, const UrdfDocument& document, const urdf::Link& link);
  void read_mesh(const UrdfSource& source, const urdf::Mesh& mesh, const std::string& where, LinkShape& shape);
  NamedJoint read_joint(const UrdfSource& source, const urdf::Joint& joint);
  void resolve_mimics(RobotModel& model) const;

  bool load_meshes_;
  MeshFiles mesh_files_;
  std::map<std::string, ModelLink> links_;
  std::map<std::string, NamedJoint> joints_;
};

void Assembly::add(const UrdfSource& source) {
  const UrdfDocument document = read_urdf(source.urdf, source.origin);
  for (const auto& [name, link] : document.model->links_) add_link(read_link(source, document, *link));
  for (const auto& [name, joint] : document.model->joints_) add_joint(read_joint(source, *joint));
  if (source.parent_link.empty()) return;
  add_fixed(source.prefix + "mount_joint", source.parent_link, source.prefix + document.model->getRoot()->name,
            source.T_parent_root);
}

void Assembly::add(const AddedLink& added) {
  ModelLink link;
  link.name = added.name;
  link.shapes = added.shapes;
  for (LinkShape& shape : link.shapes) {
    if (load_meshes_ && !shape.mesh_path.empty())
      shape.shape = MeshShape{mesh_files_.read(shape.mesh_path, shape.mesh_scale)};
  }
  add_link(std::move(link));
  add_fixed(added.name + "_joint", added.parent_link, added.name, added.T_parent_link);
}

ModelLink Assembly::read_link(const UrdfSource& source, const UrdfDocument& document, const urdf::Link& link) {
  ModelLink out;
  out.name = source.prefix + link.name;
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    const urdf::Collision& collision = *link.collision_array[i];
    const std::string where = source.origin + ": link \"" + link.name + "\", collision " + std::to_string(i) + ": ";
    if (!collision.geometry) throw InvalidInput(where + "has no geometry");
    LinkShape shape;
    shape.T_link_shape = from_kdl(frame_of(collision.origin));
    switch (collision.geometry->type) {
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(*collision.geometry).dim;
        shape.shape = Box{{size.x, size.y, size.z}};
        break;
      }
      case urdf::Geometry::SPHERE:
        shape.shape = Sphere{static_cast<const urdf::Sphere&>(*collision.geometry).radius};
        break;
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(*collision.geometry);
        if (document.capsules.count({link.name, i})) {
          shape.shape = Capsule{cylinder.radius, cylinder.length};
        } else {
          shape.shape = Cylinder{cylinder.radius, cylinder.length};
        }
        break;
      }
      case urdf::Geometry::MESH:
        read_mesh(source, static_cast<const urdf::Mesh&>(*collision.geometry), where, shape);
        if (shape.mesh_path.empty()) {
          out.shapes_left_out = true;
          continue;
        }
        break;
    }
    if (!std::holds_alternative<MeshShape>(shape.shape)) check_shape(shape.shape, where + "shape");
    if (!(shape.T_link_shape.translation().cwiseAbs().maxCoeff() < kLargest))
      throw InvalidInput(where + "its origin lies beyond 1e12 m (damaged?)");
    out.shapes.push_back(std::move(shape));
  }
  return out;
}

void Assembly::read_mesh(const UrdfSource& source, const urdf::Mesh& mesh, const std::string& where, LinkShape& shape) {
  const auto file = source.mesh_files.find(mesh.filename);
  if (file == source.mesh_files.end())
    throw InvalidInput(where + "mesh = \"" + mesh.filename + "\": no file is given for it");
  shape.mesh_path = file->second;
  shape.mesh_scale = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
  const bool good = shape.mesh_scale.cwiseAbs().minCoeff() > 0 && shape.mesh_scale.cwiseAbs().maxCoeff() < kLargest;
  if (!good) throw InvalidInput(where + "mesh = \"" + mesh.filename + "\": its scale must not be zero");
  MeshShape read;
  if (load_meshes_ && !shape.mesh_path.empty()) read.mesh = mesh_files_.read(shape.mesh_path, shape.mesh_scale);
  shape.shape = std::move(read);
}

NamedJoint Assembly::read_joint(const UrdfSource& source, const urdf::Joint& read) {
  const std::string where = source.origin + ": joint \"" + read.name + "\": ";
  NamedJoint named;
  ModelJoint& joint = named.joint;
  joint.name = source.prefix + read.name;
  joint.kind = kind_of(read);
  named.parent = source.prefix + read.parent_link_name;
  named.child = source.prefix + read.child_link_name;
  joint.T_parent_child = frame_of(read.parent_to_joint_origin_transform);
  if (!(joint.T_parent_child.p.Norm() < kLargest))
    throw InvalidInput(where + "its origin lies beyond 1e12 m (damaged?)");
  if (joint.kind == JointKind::fixed || joint.kind == JointKind::floating) return named;
  joint.axis = KDL::Vector(read.axis.x, read.axis.y, read.axis.z);
  const double length = joint.axis.Normalize();
  if (!(length > 1e-9 && length < kLargest)) throw InvalidInput(where + "its axis has no direction");
  const bool limited = joint.kind == JointKind::revolute || joint.kind == JointKind::prismatic;
  if (limited && !read.limits) throw InvalidInput(where + "has no limits");
  joint.lower = limited ? read.limits->lower : -mmgrasp::detail::kInfinity;
  joint.upper = limited ? read.limits->upper : mmgrasp::detail::kInfinity;
  if (joint.lower > joint.upper) throw InvalidInput(where + "its lower limit exceeds its upper one");
  joint.velocity = read.limits && read.limits->velocity > 0 ? read.limits->velocity : kUnknownVelocity;
  if (!read.mimic) return named;
  if (!joint.moves()) throw InvalidInput(where + "is " + to_string(joint.kind) + " and cannot mimic another joint");
  named.mimic = source.prefix + read.mimic->joint_name;
  joint.multiplier = read.mimic->multiplier;
  joint.offset = read.mimic->offset;
  return named;
}

void Assembly::order(RobotModel& model) {
  std::map<std::string, std::vector<const NamedJoint*>> below;
  std::map<std::string, const NamedJoint*> carrier;
  for (const auto& [name, named] : joints_) {
    for (const std::string* link : {&named.parent, &named.child}) {
      if (!links_.count(*link)) throw InvalidInput("joint \"" + name + "\": there is no link \"" + *link + "\"");
    }
    if (!carrier.emplace(named.child, &named).second)
      throw InvalidInput("link \"" + named.child + "\": is carried by two joints");
    below[named.parent].push_back(&named);
  }
  std::vector<std::string> roots;
  for (const auto& [name, link] : links_) {
    if (!carrier.count(name)) roots.push_back(name);
  }
  if (roots.size() != 1)
    throw InvalidInput("the robot has " + std::to_string(roots.size()) + " links that nothing carries: must have one");

  model.tree = KDL::Tree(roots.front());
  model.links.push_back(links_.at(roots.front()));
  for (std::size_t parent = 0; parent < model.links.size(); ++parent) {
    for (const NamedJoint* named : below[model.links[parent].name]) {
      const int index = static_cast<int>(model.joints.size());
      ModelJoint joint = named->joint;
      joint.parent = static_cast<int>(parent);
      joint.child = index + 1;
      model.tree.addSegment(KDL::Segment(named->child, kdl_joint(joint), joint.T_parent_child), named->parent);
      model.links[parent].child_joints.push_back(index);
      model.joints.push_back(std::move(joint));
      model.links.push_back(links_.at(named->child));
      model.links.back().joint = index;
    }
  }
  if (model.links.size() != links_.size()) throw InvalidInput("the robot's joints form a circle");
  resolve_mimics(model);
}

/// A mimic joint may follow another mimic joint.
void Assembly::resolve_mimics(RobotModel& model) const {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    ModelJoint& joint = model.joints[i];
    const NamedJoint* step = &joints_.at(joint.name);
    double multiplier = 1, offset = 0;
    for (std::size_t hops = 0; !step->mimic.empty(); ++hops) {
      const auto followed = joints_.find(step->mimic);
      if (followed == joints_.end() || hops > joints_.size() || !followed->second.joint.moves())
        throw InvalidInput("joint \"" + joint.name + "\": mimics \"" + step->mimic +
                           "\", which is no movable joint, or follows joints in a circle");
      offset += multiplier * step->joint.offset;
      multiplier *= step->joint.multiplier;
      step = &followed->second;
    }
    if (!(std::abs(multiplier) < kLargest && std::abs(offset) < kLargest))
      throw InvalidInput("joint \"" + joint.name + "\": its mimic multiplier or offset is above 1e12 (damaged?)");
    joint.source = model.joint_index(step->joint.name);
    joint.multiplier = multiplier;
    joint.offset = offset;
  }
}

}  // namespace

const char* to_string(JointKind kind) {
  static constexpr std::array<const char*, 6> kNames = {"fixed",     "revolute", "continuous",
                                                        "prismatic", "planar",   "floating"};
  return kNames[static_cast<std::size_t>(kind)];
}

int RobotModel::link_index(const std::string& name) const {
  const auto found = std::find_if(links.begin(), links.end(), [&](const ModelLink& l) { return l.name == name; });
  return found == links.end() ? -1 : static_cast<int>(found - links.begin());
}

int RobotModel::joint_index(const std::string& name) const {
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const ModelJoint& j) { return j.name == name; });
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

RobotModel read_robot(const RobotSource& source, bool load_meshes) {
  Assembly assembly(load_meshes);
  for (const UrdfSource& urdf : source.urdfs) assembly.add(urdf);
  for (const AddedLink& link : source.added_links) assembly.add(link);
  RobotModel model;
  model.base = source.base;
  model.base_limits = source.base_limits;
  assembly.order(model);
  read_srdf_pairs(source.srdf, model);
  return model;
}

}  // namespace mmgrasp::verify::detail
