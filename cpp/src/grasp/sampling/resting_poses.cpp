// resting_poses(): the faces of the hull on which a part lies still.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/random_placement.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

struct Solid {
  std::vector<Vector3d> vertices;
  Vector3d centre_of_mass = Vector3d::Zero();
};

/// Volume and first moment, as the sum over tetrahedra from the origin.
void add_moments(const TriangleMesh& mesh, const Pose& T, double& volume, Vector3d& moment) {
  for (const auto& t : mesh.triangles) {
    const Vector3d a = T * mesh.vertices[t[0]], b = T * mesh.vertices[t[1]], c = T * mesh.vertices[t[2]];
    const double six = a.dot(b.cross(c));
    volume += six / 6;
    moment += six / 24 * (a + b + c);
  }
}

Solid solid_of(const std::vector<LinkShape>& part) {
  require(!part.empty(), "part", "no shapes", "needs at least one");
  Solid solid;
  double volume = 0;
  Vector3d moment = Vector3d::Zero();
  for (const LinkShape& shape : part) {
    const auto surface = shape_mesh(shape.shape);
    for (const Vector3d& v : surface->vertices) solid.vertices.push_back(shape.T_link_shape * v);
    add_moments(surface->closed ? *surface : *convex_hull(surface->vertices), shape.T_link_shape, volume, moment);
  }
  solid.centre_of_mass = moment / volume;
  return solid;
}

/// Triangles of a hull that lie in one plane.
struct Face {
  Vector3d normal;
  double offset;
  std::vector<int> triangles;
};

std::vector<Face> faces_of(const TriangleMesh& hull, double size) {
  std::vector<Face> faces;
  for (int i = 0; i < static_cast<int>(hull.triangles.size()); ++i) {
    detail::throw_if_interrupted();
    const auto& t = hull.triangles[i];
    const Vector3d a = hull.vertices[t[0]];
    const Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).normalized();
    const auto same = std::find_if(faces.begin(), faces.end(), [&](const Face& f) {
      return f.normal.dot(n) > 1 - 1e-9 && std::abs(f.normal.dot(a) - f.offset) < 1e-6 * size;
    });
    if (same == faces.end()) {
      faces.push_back({n, n.dot(a), {i}});
    } else {
      same->triangles.push_back(i);
    }
  }
  return faces;
}

/// Solid angle of a triangle seen from the origin (Van Oosterom and Strackee).
double solid_angle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
}

bool above(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& n, const Vector3d& p) {
  const auto side = [&](const Vector3d& from, const Vector3d& to) { return n.dot((to - from).cross(p - from)); };
  const double slack = -1e-12;
  return side(a, b) >= slack && side(b, c) >= slack && side(c, a) >= slack;
}

}  // namespace

std::vector<RestingPose> resting_poses(const std::vector<LinkShape>& part) {
  const Solid solid = solid_of(part);
  const auto hull = convex_hull(solid.vertices);
  Eigen::AlignedBox3d box;
  for (const Vector3d& v : hull->vertices) box.extend(v);
  const Vector3d& com = solid.centre_of_mass;
  std::vector<RestingPose> poses;
  double total = 0;
  for (const Face& face : faces_of(*hull, box.diagonal().norm())) {
    bool stands = false;
    double angle = 0;
    for (const int i : face.triangles) {
      const auto& t = hull->triangles[i];
      const Vector3d a = hull->vertices[t[0]], b = hull->vertices[t[1]], c = hull->vertices[t[2]];
      stands = stands || above(a, b, c, face.normal, com);
      angle += std::abs(solid_angle(a - com, b - com, c - com));
    }
    if (!stands) continue;
    RestingPose pose;
    pose.probability = angle;
    total += angle;
    const Eigen::Matrix3d R = Eigen::Quaterniond::FromTwoVectors(face.normal, -Vector3d::UnitZ()).toRotationMatrix();
    pose.T_floor_part.linear() = R;
    const Vector3d at = R * com;
    pose.T_floor_part.translation() << -at.x(), -at.y(), face.offset;
    poses.push_back(pose);
  }
  for (RestingPose& pose : poses) pose.probability /= total;
  std::stable_sort(poses.begin(), poses.end(),
                   [](const RestingPose& a, const RestingPose& b) { return a.probability > b.probability; });
  return poses;
}

}  // namespace mmgrasp
