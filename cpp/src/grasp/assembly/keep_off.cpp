// Surface that fingers must not touch: its pieces, and whether the pads of a grasp lie on one.
#include "mmgrasp/grasp/keep_off.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"

namespace mmgrasp {
namespace {

using detail::clip_polygon;
using Polygon = std::vector<Eigen::Vector3d>;

constexpr double kTouching = 1e-6;  // Pads that meet a piece along a line do not lie on it [m].

Polygon triangle_of(const TriangleMesh& mesh, std::size_t face) {
  Polygon out;
  for (const int v : mesh.triangles[face]) out.push_back(mesh.vertices[v]);
  return out;
}

/// The part of a polygon between -half and half in x and y.
Polygon within(Polygon polygon, double half_x, double half_y) {
  const Eigen::Vector2d x(1, 0), y(0, 1);
  for (const detail::HalfPlane& side : {detail::HalfPlane{x, half_x}, {-x, half_x}, {y, half_y}, {-y, half_y}}) {
    if (polygon.empty()) break;
    polygon = clip_polygon(polygon, side);
  }
  return polygon;
}

/// The same polygon with y and z in place of x and y.
Polygon turned(Polygon polygon) {
  for (Eigen::Vector3d& p : polygon) p = Eigen::Vector3d(p.y(), p.z(), p.x());
  return polygon;
}

/// Whether a polygon, in the tool frame, lies on the pad of finger `i`.
bool on_pad(const AssemblyGrasp& grasp, int i, const Polygon& polygon, double near) {
  const double turn = detail::kTwoPi * i / grasp.fingers, half = grasp.width / 2 - kTouching;
  const Eigen::Vector2d out(std::cos(turn), std::sin(turn)), side(-out.y(), out.x());
  const double pad = grasp.opening / 2;
  Polygon left = polygon;
  for (const detail::HalfPlane& limit :
       {detail::HalfPlane{out, pad + near}, {-out, near - pad}, {side, half}, {-side, half}}) {
    left = clip_polygon(left, limit);
    if (left.empty()) return false;
  }
  return std::any_of(left.begin(), left.end(), [](const Eigen::Vector3d& p) { return p.z() < -kTouching; });
}

}  // namespace

void KeepOffBox::check() const {
  const bool rigid =
      T_mesh_box.matrix().allFinite() && (T_mesh_box.linear() * T_mesh_box.linear().transpose()).isIdentity(1e-6);
  if (!rigid) throw InvalidInput("T_mesh_box is no pose: rotation and translation expected");
  for (const double length : {size.x(), size.y(), size.z()}) require_positive(length, "size", "m");
}

SurfacePieces surface_of_faces(const TriangleMesh& mesh, const std::vector<int>& faces) {
  SurfacePieces out;
  for (const int f : faces) {
    require(f >= 0 && f < static_cast<int>(mesh.triangles.size()), "faces", f,
            "must be numbers of the mesh's triangles");
    out.push_back(triangle_of(mesh, f));
  }
  return out;
}

SurfacePieces surface_in_box(const TriangleMesh& mesh, const KeepOffBox& box) {
  box.check();
  const Pose T_box_mesh = box.T_mesh_box.inverse();
  const Eigen::Vector3d half = box.size / 2;
  SurfacePieces out;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Polygon piece = triangle_of(mesh, f);
    for (Eigen::Vector3d& p : piece) p = T_box_mesh * p;
    piece = within(std::move(piece), half.x(), half.y());
    piece = turned(turned(within(turned(std::move(piece)), half.y(), half.z())));
    if (piece.size() < 3) continue;
    for (Eigen::Vector3d& p : piece) p = box.T_mesh_box * p;
    out.push_back(std::move(piece));
  }
  return out;
}

bool pads_touch(const AssemblyGrasp& grasp, const SurfacePieces& pieces, double near) {
  grasp.check();
  require_positive(near, "near", "m");
  const Pose T_tool = grasp.T_active_tool.inverse();
  for (const Polygon& piece : pieces) {
    Polygon seen = piece;
    for (Eigen::Vector3d& p : seen) p = T_tool * p;
    for (int i = 0; i < grasp.fingers; ++i)
      if (on_pad(grasp, i, seen, near)) return true;
  }
  return false;
}

}  // namespace mmgrasp
