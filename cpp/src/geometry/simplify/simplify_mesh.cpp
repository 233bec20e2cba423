#include "mmgrasp/geometry/simplify_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/hierarchy/triangle_tree.hpp"
#include "geometry/simplify/decimate_outwards.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSameSolid = 1e-9;  // of the size: what counts as rounding
constexpr int kRim = 128;            // points on a cylinder's rim at which distances are taken
constexpr double kWorthwhile = 0.8;  // share of its triangles that a decimated mesh may keep
constexpr int kCentreSteps = 300;
constexpr std::size_t kFrames = 24;  // large faces of the hull that boxes and cylinders are aligned with

using Points = std::vector<Vector3d>;

double size_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box.diagonal().norm();
}

Pose placed(const Matrix3d& R, const Vector3d& p) {
  Pose T = Pose::Identity();
  T.linear() = R;
  T.translation() = p;
  return T;
}

/// The rows of R are the axes of a right-handed frame with `z` (unit) last and `x` as near as it can be.
Matrix3d frame_along(const Vector3d& z, const Vector3d& x) {
  Matrix3d R;
  R.col(2) = z;
  const Vector3d flat = x - x.dot(z) * z;
  R.col(0) = flat.norm() > 1e-6 * x.norm() && x.norm() > 0 ? flat.normalized() : z.unitOrthogonal();
  R.col(1) = R.col(2).cross(R.col(0));
  return R;
}

/// The box itself when a closed convex mesh is one.
bool exact_box(const TriangleMesh& mesh, MeshStandIn& found) {
  if (!mesh.closed || !mesh.convex || mesh.vertices.size() != 8) return false;
  const double size = size_of(mesh.vertices);
  std::vector<Vector3d> axes;
  for (const auto& t : mesh.triangles) {
    const Vector3d& a = mesh.vertices[t[0]];
    const Vector3d n = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
    const bool known =
        std::any_of(axes.begin(), axes.end(), [&](const Vector3d& axis) { return n.cross(axis).norm() < 1e-6; });
    if (!known) axes.push_back(n);
  }
  if (axes.size() != 3) return false;
  const Matrix3d R = frame_along(axes[2], axes[0]);
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& v : mesh.vertices) centre += v / 8;
  Vector3d half = Vector3d::Zero();
  for (const Vector3d& v : mesh.vertices) half = half.cwiseMax((R.transpose() * (v - centre)).cwiseAbs());
  for (const Vector3d& v : mesh.vertices)
    if (((R.transpose() * (v - centre)).cwiseAbs() - half).cwiseAbs().maxCoeff() > kSameSolid * size) return false;
  found.chosen = "box";
  found.shape = Box{2 * half};
  found.T_mesh_shape = placed(R, centre);
  found.triangles_saved = static_cast<int>(mesh.triangles.size());
  return true;
}

/// Centre of a sphere around the points that is nearly as small as can be (Badoiu and Clarkson's steps towards the
/// farthest point).
template <typename Vector>
Vector sphere_centre(const std::vector<Vector>& points) {
  Vector centre = points.front();
  for (int step = 1; step <= kCentreSteps; ++step) {
    detail::throw_if_interrupted();
    const auto farthest = std::max_element(points.begin(), points.end(), [&](const Vector& a, const Vector& b) {
      return (a - centre).squaredNorm() < (b - centre).squaredNorm();
    });
    centre += (*farthest - centre) / (step + 1.0);
  }
  return centre;
}

/// Primitives around a mesh, measured against its hull.
class PrimitiveFit {
 public:
  PrimitiveFit(const TriangleMesh& mesh, const TriangleMesh& hull) : mesh_(mesh), hull_(hull), tree_(hull) {}

  /// The one with the least deviation from the hull.
  MeshStandIn best() {
    try_sphere();
    for (const Matrix3d& R : frames()) {
      try_box(R);
      for (int axis = 0; axis < 3; ++axis) try_cylinder(frame_along(R.col(axis), R.col((axis + 1) % 3)));
    }
    best_.triangles_saved = static_cast<int>(mesh_.triangles.size());
    return best_;
  }

 private:
  void offer(const char* kind, const Shape& shape, const Pose& T, double deviation) {
    if (!(deviation < best_.deviation)) return;
    best_.chosen = kind;
    best_.shape = shape;
    best_.T_mesh_shape = T;
    best_.deviation = deviation;
  }

  /// The mesh's own axes, and those of the hull's largest faces.
  std::vector<Matrix3d> frames() const {
    struct Face {
      double area;
      Matrix3d R;
    };
    std::vector<Face> faces;
    for (const auto& t : hull_.triangles) {
      const Vector3d &a = hull_.vertices[t[0]], &b = hull_.vertices[t[1]], &c = hull_.vertices[t[2]];
      const Vector3d n = (b - a).cross(c - a);
      const std::array<Vector3d, 3> edges = {b - a, c - b, a - c};
      const auto longest = std::max_element(edges.begin(), edges.end(), [](const Vector3d& one, const Vector3d& other) {
        return one.squaredNorm() < other.squaredNorm();
      });
      if (!(n.norm() > 0)) continue;
      faces.push_back({n.norm(), frame_along(n.normalized(), *longest)});
      // A rectangle's diagonal is its longest edge: the sides of its triangles are meant.
      for (const Vector3d& edge : edges)
        if (edge.squaredNorm() < longest->squaredNorm()) faces.push_back({n.norm(), frame_along(n.normalized(), edge)});
    }
    std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.area > b.area; });
    std::vector<Matrix3d> result = {Matrix3d::Identity()};
    const auto same = [](const Matrix3d& a, const Matrix3d& b) {
      const Matrix3d turned = (a.transpose() * b).cwiseAbs();
      return (turned.colwise().maxCoeff().array() > 1 - 1e-9).all();
    };
    for (const Face& face : faces) {
      if (result.size() > kFrames) break;
      if (std::none_of(result.begin(), result.end(), [&](const Matrix3d& R) { return same(R, face.R); }))
        result.push_back(face.R);
    }
    return result;
  }

  void try_sphere() {
    const Vector3d centre = sphere_centre(hull_.vertices);
    double radius = 0;
    for (const Vector3d& v : mesh_.vertices) radius = std::max(radius, (v - centre).norm());
    // A sphere about the same centre lies in the hull: no point of the sphere is farther from it than the radii differ.
    double inner = detail::kInfinity;
    for (const auto& t : hull_.triangles) {
      const Vector3d& a = hull_.vertices[t[0]];
      const Vector3d n = (hull_.vertices[t[1]] - a).cross(hull_.vertices[t[2]] - a);
      if (n.norm() > 0) inner = std::min(inner, n.dot(a - centre) / n.norm());
    }
    if (inner > 0) offer("sphere", Sphere{radius}, placed(Matrix3d::Identity(), centre), radius - inner);
  }

  void try_box(const Matrix3d& R) {
    detail::throw_if_interrupted();
    Eigen::AlignedBox3d box;
    for (const Vector3d& v : mesh_.vertices) box.extend(R.transpose() * v);
    double deviation = 0;  // a convex function on a box is largest at a corner
    for (int i = 0; i < 8; ++i)
      deviation = std::max(deviation, tree_.distance(R * box.corner(static_cast<decltype(box)::CornerType>(i))));
    offer("box", Box{box.sizes()}, placed(R, R * box.center()), deviation);
  }

  void try_cylinder(const Matrix3d& R) {
    std::vector<Eigen::Vector2d> shadow;
    for (const Vector3d& v : hull_.vertices) shadow.push_back((R.transpose() * v).head<2>());
    const Eigen::Vector2d centre = sphere_centre(shadow);
    double low = detail::kInfinity, high = -low, radius = 0;
    for (const Vector3d& v : mesh_.vertices) {
      const Vector3d p = R.transpose() * v;
      radius = std::max(radius, (p.head<2>() - centre).norm());
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    // Largest on the rims; between two of the points taken there an arc is no farther from their chord than this.
    const double sagitta = radius * (1 - std::cos(detail::kPi / kRim));
    double deviation = 0;
    for (int i = 0; i < kRim && deviation + sagitta < best_.deviation; ++i) {
      const double angle = detail::kTwoPi * i / kRim;
      const Eigen::Vector2d rim = centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      for (const double z : {low, high})
        deviation = std::max(deviation, tree_.distance(R * Vector3d(rim.x(), rim.y(), z)));
    }
    offer("cylinder", Cylinder{radius, high - low}, placed(R, R * Vector3d(centre.x(), centre.y(), 0.5 * (low + high))),
          deviation + sagitta);
  }

  const TriangleMesh& mesh_;
  const TriangleMesh& hull_;
  detail::TriangleTree tree_;
  MeshStandIn best_ = [] {
    MeshStandIn none;
    none.deviation = detail::kInfinity;
    return none;
  }();
};

/// The hull, unless rounding left a vertex of the mesh outside it or there is none.
std::shared_ptr<const TriangleMesh> hull_around(const TriangleMesh& mesh) {
  std::shared_ptr<const TriangleMesh> hull;
  try {
    hull = convex_hull(mesh.vertices);
  } catch (const InvalidInput&) {
    return nullptr;  // flat
  }
  const double allowed = kSameSolid * size_of(mesh.vertices);
  for (const auto& t : hull->triangles) {
    const Vector3d& a = hull->vertices[t[0]];
    const Vector3d n = (hull->vertices[t[1]] - a).cross(hull->vertices[t[2]] - a).normalized();
    detail::throw_if_interrupted();
    for (const Vector3d& v : mesh.vertices)
      if (n.dot(v - a) > allowed) return nullptr;
  }
  auto named = std::make_shared<TriangleMesh>(*hull);
  named->source = mesh.source;
  return named;
}

/// The corners of a mesh lie in the solid around it: what its making promises, asked of the result.
bool holds_corners(const TriangleMesh& solid, const TriangleMesh& mesh) {
  const detail::TriangleTree tree(solid);
  const double allowed = kSameSolid * size_of(mesh.vertices);
  detail::InterruptionPoll poll(64);
  return std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vector3d& v) {
    poll();
    return tree.contains(v) || tree.distance(v) <= allowed;
  });
}

/// A mesh of fewer triangles around a closed one, when that saves a fair share of them.
void decimate(const std::shared_ptr<const TriangleMesh>& mesh, double tolerance, MeshStandIn& found) {
  // New corners keep a share of the tolerance; between them a surface may be farther, so that a smaller share follows.
  for (const double share : {0.8, 0.4}) {
    const auto fewer = detail::decimate_outwards(*mesh, share * tolerance);
    if (!fewer || fewer->triangles.size() > kWorthwhile * mesh->triangles.size()) return;
    const double deviation = bound_deviation(*fewer, *mesh, tolerance);
    if (!(deviation <= tolerance) || !holds_corners(*fewer, *mesh)) continue;
    found.chosen = "decimated";
    found.shape = MeshShape{fewer};
    found.triangles_saved = static_cast<int>(mesh->triangles.size() - fewer->triangles.size());
    found.deviation = deviation;
    return;
  }
}

}  // namespace

MeshStandIn simplify_mesh(const std::shared_ptr<const TriangleMesh>& mesh, double tolerance) {
  require_not_negative(tolerance, "mesh_tolerance");
  MeshStandIn found;
  found.shape = MeshShape{mesh};
  if (exact_box(*mesh, found)) return found;
  const bool convex = mesh->closed && mesh->convex;
  if (convex) found.chosen = "hull";
  if (tolerance == 0) return found;
  const std::shared_ptr<const TriangleMesh> hull = convex ? mesh : hull_around(*mesh);
  if (!hull) return found;
  // What holds the mesh and is convex holds its hull: when that is too far, so is every primitive.
  const double of_hull = convex ? 0 : bound_deviation(*hull, *mesh, tolerance);
  if (!(of_hull <= tolerance)) {
    if (mesh->closed) decimate(mesh, tolerance, found);
    return found;
  }
  MeshStandIn primitive = PrimitiveFit(*mesh, *hull).best();
  primitive.deviation += of_hull;
  if (primitive.deviation <= tolerance) return primitive;
  found.chosen = "hull";
  found.shape = MeshShape{hull};
  found.triangles_saved = static_cast<int>(mesh->triangles.size()) - static_cast<int>(hull->triangles.size());
  found.deviation = of_hull;
  return found;
}

}  // namespace mmgrasp
