// Where pads come to stand on faces that are not quite where the grasp takes them to be.
#include "grasp/assembly/pad_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSameOpening = 1e-9;  // Changes below it are rounding [m].
constexpr double kTouching = 1e-6;     // [m]
constexpr double kOutward = 0.9;       // Cosine of a wall's normals to the radius.

/// How far off the tool's axis a piece of surface reaches, towards a finger [m].
struct Reach {
  double least = kInfinity, most = -kInfinity;
  bool none() const { return most < least; }
};

/// The surface under one finger of a grasp, from its tip to its root.
class UnderFinger {
 public:
  UnderFinger(const TriangleMesh& mesh, const AssemblyGrasp& grasp, int i) : mesh_(mesh), half_(grasp.width / 2) {
    const double turn = kTwoPi * i / grasp.fingers;
    const Pose T_tool_mesh = grasp.T_active_tool.inverse();
    Eigen::Matrix3d axes;
    axes.row(0) << -std::sin(turn), std::cos(turn), 0;  // across
    axes.row(1) << 0, 0, 1;                             // along the approach
    axes.row(2) << std::cos(turn), std::sin(turn), 0;   // outwards
    turn_ = axes * T_tool_mesh.linear();
    shift_ = axes * T_tool_mesh.translation();
  }

  Reach of(int face) const {
    std::vector<Vector3d> piece;
    piece.reserve(3);
    for (const int v : mesh_.triangles[face]) piece.push_back(turn_ * mesh_.vertices[v] + shift_);
    Reach out;
    if (beside(piece)) return out;
    for (const HalfPlane& side : {HalfPlane{{1, 0}, half_}, HalfPlane{{-1, 0}, half_}, HalfPlane{{0, 1}, 0}})
      piece = clip_polygon(piece, side);
    for (const Vector3d& p : piece) {
      out.least = std::min(out.least, p.z());
      out.most = std::max(out.most, p.z());
    }
    return out;
  }

  Reach of(const std::vector<int>& faces) const {
    Reach out;
    InterruptionPoll poll;
    for (const int f : faces) {
      poll();
      const Reach one = of(f);
      out.least = std::min(out.least, one.least);
      out.most = std::max(out.most, one.most);
    }
    return out;
  }

  /// The outermost of the faces that reach no farther than `limit`, or `least`.
  double most_within(const std::vector<int>& faces, double limit, double least) const {
    InterruptionPoll poll;
    for (const int f : faces) {
      poll();
      const double most = of(f).most;
      if (most <= limit) least = std::max(least, most);
    }
    return least;
  }

 private:
  bool beside(const std::vector<Vector3d>& t) const {
    const auto all = [&](const auto& out) { return out(t[0]) && out(t[1]) && out(t[2]); };
    return all([&](const Vector3d& p) { return p.x() > half_; }) ||
           all([&](const Vector3d& p) { return p.x() < -half_; }) || all([](const Vector3d& p) { return p.y() > 0; });
  }

  const TriangleMesh& mesh_;
  double half_;
  Eigen::Matrix3d turn_;  // Into a frame of across, along the approach, outwards.
  Vector3d shift_;
};

/// Where a pad stops on a facet: its outermost point, or that of another face that stands out of it by no more than its
/// own points differ.
double stop_on(const TriangleMesh& mesh, const PadFaces& faces, const AssemblyGrasp& grasp, int finger) {
  const UnderFinger under(mesh, grasp, finger);
  const Reach own = under.of(faces.facet.faces);
  if (own.none()) return grasp.opening / 2;
  return under.most_within(faces.reaching_out, own.most + (own.most - own.least) + kTouching, own.most);
}

double outermost(const TriangleMesh& mesh, int face, const Vector3d& outwards) {
  const auto& t = mesh.triangles[face];
  return std::max(
      {outwards.dot(mesh.vertices[t[0]]), outwards.dot(mesh.vertices[t[1]]), outwards.dot(mesh.vertices[t[2]])});
}

}  // namespace

PadFaces pad_faces(const TriangleMesh& mesh, const std::vector<int>& segment, const Facet& facet,
                   const Eigen::Vector3d& outwards) {
  double lowest = kInfinity;
  for (const int f : facet.faces) {
    for (const int v : mesh.triangles[f]) lowest = std::min(lowest, outwards.dot(mesh.vertices[v]));
  }
  PadFaces out{facet, {}};
  InterruptionPoll poll;
  for (const int f : segment) {
    poll();
    const bool own = std::binary_search(facet.faces.begin(), facet.faces.end(), f);
    if (!own && outermost(mesh, f, outwards) > lowest) out.reaching_out.push_back(f);
  }
  return out;
}

void stand_on_facets(const TriangleMesh& mesh, const PadFaces& first, const PadFaces& second, AssemblyGrasp& grasp) {
  const double to_first = stop_on(mesh, first, grasp, 0), to_second = stop_on(mesh, second, grasp, 1);
  const double shift = (to_first - to_second) / 2, opening = to_first + to_second;
  if (std::abs(shift) < kSameOpening && std::abs(opening - grasp.opening) < kSameOpening) return;
  grasp.opening = opening;
  grasp.T_active_tool.translation() += shift * grasp.T_active_tool.linear().col(0);
}

double wall_deviation(const TriangleMesh& mesh, const std::vector<int>& faces, const CylinderFit& cylinder) {
  const Pose T_cylinder_mesh = cylinder.T_mesh_cylinder.inverse();
  std::vector<std::pair<double, double>> off;  // Distance and area.
  double area = 0;
  InterruptionPoll poll;
  for (const int f : faces) {
    poll();
    std::array<Vector3d, 3> c;
    for (int i = 0; i < 3; ++i) c[i] = T_cylinder_mesh * mesh.vertices[mesh.triangles[f][i]];
    const Vector3d scaled = (c[1] - c[0]).cross(c[2] - c[0]);
    Vector3d radial = c[0] + c[1] + c[2];
    radial.z() = 0;
    if (scaled.dot(radial) <= kOutward * scaled.norm() * radial.norm()) continue;
    for (const Vector3d& p : c) off.emplace_back(std::abs(p.head<2>().norm() - cylinder.diameter / 2), scaled.norm());
    area += 3 * scaled.norm();
  }
  std::sort(off.begin(), off.end());
  double sum = 0;
  for (const auto& [distance, weight] : off) {
    sum += weight;
    if (2 * sum >= area) return distance;
  }
  return 0;
}

std::vector<int> faces_beyond(const TriangleMesh& mesh, const std::vector<int>& faces, const CylinderFit& cylinder) {
  const Pose T_cylinder_mesh = cylinder.T_mesh_cylinder.inverse();
  std::vector<int> out;
  InterruptionPoll poll;
  for (const int f : faces) {
    poll();
    const auto& t = mesh.triangles[f];
    const auto beyond = [&](int v) {
      return (T_cylinder_mesh * mesh.vertices[v]).head<2>().norm() > cylinder.diameter / 2;
    };
    if (std::any_of(t.begin(), t.end(), beyond)) out.push_back(f);
  }
  return out;
}

void stand_on_wall(const TriangleMesh& mesh, const std::vector<int>& faces, double rough, AssemblyGrasp& grasp) {
  const double nominal = grasp.opening / 2;
  double reach = nominal;
  for (int i = 0; i < grasp.fingers; ++i)
    reach = UnderFinger(mesh, grasp, i).most_within(faces, nominal + rough + kTouching, reach);
  if (reach > nominal + kSameOpening) grasp.opening = 2 * reach;
}

}  // namespace mmgrasp::detail
