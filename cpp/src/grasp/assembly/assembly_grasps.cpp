#include "mmgrasp/grasp/assembly_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "grasp/assembly/pad_contact.hpp"
#include "grasp/assembly/shadow_grid.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp {
namespace {

using detail::kTwoPi;

/// Points of a wall are off its cylinder by no more than so many times the median: four standard deviations.
constexpr double kRough = 6;

Eigen::Vector3d scaled_normal(const TriangleMesh& mesh, int face) {
  const auto& t = mesh.triangles[face];
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2;
}

std::vector<int> given_or_all(const TriangleMesh& mesh, std::vector<int> faces) {
  const int count = static_cast<int>(mesh.triangles.size());
  for (const int f : faces) require(f >= 0 && f < count, "faces", f, "must be numbers of the mesh's triangles");
  if (!faces.empty()) return faces;
  faces.resize(count);
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

/// Faces that share an edge with each of `faces`, among them.
std::map<int, std::vector<int>> neighbours(const TriangleMesh& mesh, const std::vector<int>& faces) {
  std::map<std::pair<int, int>, std::vector<int>> of_edge;
  detail::InterruptionPoll poll(256);
  for (const int f : faces) {
    poll();
    const auto& t = mesh.triangles[f];
    for (int i = 0; i < 3; ++i) of_edge[std::minmax(t[i], t[(i + 1) % 3])].push_back(f);
  }
  std::map<int, std::vector<int>> out;
  for (const auto& [edge, sharing] : of_edge) {
    poll();
    for (const int f : sharing) {
      for (const int g : sharing) {
        if (f != g) out[f].push_back(g);
      }
    }
  }
  return out;
}

/// Axes of a plane: x, y, and its normal as z.
Eigen::Matrix3d plane_axes(const Eigen::Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(2) = normal;
  const Eigen::Vector3d least = std::abs(normal.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  axes.col(0) = least.cross(normal).normalized();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

using Polygon = std::vector<Eigen::Vector3d>;

/// Triangles of a facet in the plane's axes, turned counter-clockwise; those without a shadow are left out.
std::vector<Polygon> shadow(const TriangleMesh& mesh, const Facet& facet, const Eigen::Matrix3d& axes) {
  std::vector<Polygon> out;
  for (const int f : facet.faces) {
    Polygon t;
    for (const int v : mesh.triangles[f]) t.push_back(axes.transpose() * mesh.vertices[v]);
    const double area = detail::edge_side((t[1] - t[0]).head<2>(), (t[2] - t[0]).head<2>());
    if (area < 0) std::swap(t[1], t[2]);
    if (area != 0) out.push_back(std::move(t));
  }
  return out;
}

bool apart(const Polygon& a, const Polygon& b) {
  for (int axis = 0; axis < 2; ++axis) {
    const auto [a0, a1] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
    const auto [b0, b1] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
    if (a1 <= b0 || b1 <= a0) return true;
  }
  return false;
}

/// Where the shadows of two facets lie on each other, in convex pieces.
std::vector<Polygon> overlap_of(const std::vector<Polygon>& first, const std::vector<Polygon>& second) {
  std::vector<Polygon> out;
  const detail::ShadowGrid grid(second);
  detail::InterruptionPoll poll(256);
  for (const Polygon& a : first) {
    for (const int near : grid.near(a)) {
      poll();
      const Polygon& b = second[near];
      if (apart(a, b)) continue;
      Polygon piece = a;
      for (std::size_t i = 0; i < b.size() && !piece.empty(); ++i) {
        const Eigen::Vector2d edge = (b[(i + 1) % b.size()] - b[i]).head<2>(), out_of(edge.y(), -edge.x());
        piece = detail::clip_polygon(piece, {out_of, out_of.dot(b[i].head<2>())});
      }
      if (piece.size() >= 3) out.push_back(std::move(piece));
    }
  }
  return out;
}

double area_of(const Polygon& p) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < p.size(); ++i)
    area += detail::edge_side((p[i] - p[0]).head<2>(), (p[i + 1] - p[0]).head<2>()) / 2;
  return area;
}

/// Centre of area; none when there is no area.
std::optional<Eigen::Vector2d> centre_of(const std::vector<Polygon>& pieces) {
  double area = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Polygon& p : pieces) {
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
      const double part = detail::edge_side((p[i] - p[0]).head<2>(), (p[i + 1] - p[0]).head<2>()) / 2;
      area += part;
      sum += part / 3 * (p[0] + p[i] + p[i + 1]).head<2>();
    }
  }
  if (area < 1e-12) return std::nullopt;
  return sum / area;
}

std::vector<double> depths(double extent, const AssemblyGraspOptions& options) {
  std::vector<double> out;
  const double most = std::max(extent - options.tip_clearance, std::min(extent, options.min_contact));
  for (const double wanted : {options.min_contact, options.pad_length / 2, options.pad_length}) {
    const double depth = std::min(wanted, most);
    if (detail::at_most(options.min_contact, depth) && (out.empty() || depth > out.back() + 1e-6)) out.push_back(depth);
  }
  return out;
}

AssemblyGrasp grasp_at(int fingers, double opening, const AssemblyGraspOptions& options) {
  AssemblyGrasp grasp;
  grasp.fingers = fingers;
  grasp.opening = opening;
  grasp.width = options.finger_width;
  grasp.thickness = options.finger_thickness;
  grasp.clearance = options.clearance;
  const double open = opening / 2 + options.clearance + options.finger_thickness;
  grasp.palm_radius = std::hypot(open, options.finger_width / 2) + options.palm_margin;
  return grasp;
}

/// Grasps of one pair of facets of a segment.
void add_pair(const TriangleMesh& mesh, const std::vector<int>& faces, const Facet& a, const Facet& b,
              const AssemblyGraspOptions& options, std::vector<AssemblyGrasp>& out) {
  const Eigen::Matrix3d axes = plane_axes((a.normal - b.normal).normalized());
  const Eigen::Vector3d normal = axes.col(2);
  const double opening = normal.dot(a.centre - b.centre);
  if (opening <= 1e-4 || !detail::at_most(opening, options.max_opening)) return;
  const std::vector<Polygon> overlap = overlap_of(shadow(mesh, a, axes), shadow(mesh, b, axes));
  const std::optional<Eigen::Vector2d> middle = centre_of(overlap);
  if (!middle) return;
  const double height = normal.dot(a.centre + b.centre) / 2;
  const detail::PadFaces first = detail::pad_faces(mesh, faces, a, normal);
  const detail::PadFaces second = detail::pad_faces(mesh, faces, b, -normal);
  for (int i = 0; i < options.directions; ++i) {
    const double turn = kTwoPi * i / options.directions;
    const Eigen::Vector2d approach(std::cos(turn), std::sin(turn)), across(-approach.y(), approach.x());
    double near = detail::kInfinity, far = -detail::kInfinity;
    std::vector<Polygon> strip;  // what fingers cover
    for (const Polygon& whole : overlap) {
      detail::throw_if_interrupted();
      Polygon piece = detail::clip_polygon(whole, {across, across.dot(*middle) + options.finger_width / 2});
      strip.push_back(detail::clip_polygon(piece, {-across, -across.dot(*middle) + options.finger_width / 2}));
      for (const Eigen::Vector3d& p : strip.back()) {
        near = std::min(near, approach.dot(p.head<2>() - *middle));
        far = std::max(far, approach.dot(p.head<2>() - *middle));
      }
    }
    for (const double depth : depths(far - near, options)) {
      AssemblyGrasp grasp = grasp_at(2, opening, options);
      const Eigen::Vector2d tip = *middle + (near + depth) * approach;
      const Eigen::Vector3d z = axes * Eigen::Vector3d(approach.x(), approach.y(), 0);
      grasp.T_active_tool.linear().col(0) = normal;
      grasp.T_active_tool.linear().col(1) = z.cross(normal);
      grasp.T_active_tool.linear().col(2) = z;
      grasp.T_active_tool.translation() = axes * Eigen::Vector3d(tip.x(), tip.y(), height);
      double area = 0;
      for (const Polygon& piece : strip) area += area_of(detail::clip_polygon(piece, {approach, approach.dot(tip)}));
      grasp.contact_length = depth;
      grasp.contact_width = area / depth;
      detail::stand_on_facets(mesh, first, second, grasp);
      if (detail::at_most(grasp.opening, options.max_opening)) out.push_back(grasp);
    }
  }
}

}  // namespace

void AssemblyGraspOptions::check() const {
  require(facet_angle > 0 && facet_angle <= 0.5, "facet_angle", facet_angle, "must be in (0, 0.5] [rad]");
  require(parallel_angle > 0 && parallel_angle <= 0.5, "parallel_angle", parallel_angle, "must be in (0, 0.5] [rad]");
  require(directions >= 1 && directions <= 360, "directions", directions, "must be from 1 to 360");
  const auto positive = [](const char* field, double value) { require_positive(value, field, "m"); };
  positive("min_contact", min_contact);
  positive("pad_length", pad_length);
  positive("max_opening", max_opening);
  positive("finger_width", finger_width);
  positive("finger_thickness", finger_thickness);
  require(pad_length >= min_contact, "pad_length", pad_length, "must be at least min_contact [m]");
  require_not_negative(clearance, "clearance", "m");
  require_not_negative(tip_clearance, "tip_clearance", "m");
  require_not_negative(palm_margin, "palm_margin", "m");
}

std::vector<Facet> planar_facets(const TriangleMesh& mesh, const std::vector<int>& faces, double angle) {
  require(angle > 0 && angle <= 0.5, "angle", angle, "must be in (0, 0.5] [rad]");
  std::vector<int> order = given_or_all(mesh, faces);
  const auto beside = neighbours(mesh, order);
  detail::InterruptionPoll poll(1024);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    poll();
    return scaled_normal(mesh, a).squaredNorm() > scaled_normal(mesh, b).squaredNorm();
  });
  std::vector<char> taken(mesh.triangles.size(), false);
  std::vector<Facet> out;
  for (const int seed : order) {
    if (taken[seed] || scaled_normal(mesh, seed).norm() == 0) continue;
    const Eigen::Vector3d normal = scaled_normal(mesh, seed).normalized();
    Facet facet;
    facet.faces = {seed};
    taken[seed] = true;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < facet.faces.size(); ++i) {
      poll();
      const int face = facet.faces[i];
      const Eigen::Vector3d scaled = scaled_normal(mesh, face);
      const auto& t = mesh.triangles[face];
      sum += scaled;
      facet.area += scaled.norm();
      facet.centre += scaled.norm() * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
      const auto found = beside.find(face);
      if (found == beside.end()) continue;
      for (const int next : found->second) {
        const Eigen::Vector3d n = scaled_normal(mesh, next);
        if (taken[next] || n.dot(normal) < std::cos(angle) * n.norm()) continue;
        taken[next] = true;
        facet.faces.push_back(next);
      }
    }
    facet.normal = sum.normalized();
    facet.centre /= facet.area;
    std::sort(facet.faces.begin(), facet.faces.end());
    out.push_back(std::move(facet));
  }
  std::stable_sort(out.begin(), out.end(), [](const Facet& a, const Facet& b) { return a.area > b.area; });
  return out;
}

std::vector<AssemblyGrasp> jaw_grasps(const TriangleMesh& mesh, const std::vector<int>& faces,
                                      const AssemblyGraspOptions& options) {
  options.check();
  const std::vector<int> segment = given_or_all(mesh, faces);
  std::vector<Facet> facets = planar_facets(mesh, segment, options.facet_angle);
  const double least_area = options.min_contact * options.min_contact;
  while (!facets.empty() && facets.back().area < least_area) facets.pop_back();
  std::vector<AssemblyGrasp> out;
  detail::InterruptionPoll poll;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    for (std::size_t k = i + 1; k < facets.size(); ++k) {
      poll();
      if (facets[i].normal.dot(facets[k].normal) <= -std::cos(options.parallel_angle))
        add_pair(mesh, segment, facets[i], facets[k], options, out);
    }
  }
  return out;
}

std::vector<AssemblyGrasp> centric_grasps(const CylinderFit& cylinder, const AssemblyGraspOptions& options) {
  options.check();
  require_number(cylinder.diameter, "diameter", "m");
  require(cylinder.diameter > 1e-4, "diameter", cylinder.diameter, "must be a length above 1e-4 [m]");
  require(std::isfinite(cylinder.high - cylinder.low) && cylinder.high > cylinder.low, "high", cylinder.high,
          "must be above low = " + std::to_string(cylinder.low) + " [m]");
  std::vector<AssemblyGrasp> out;
  if (!detail::at_most(cylinder.diameter, options.max_opening)) return out;
  for (const bool from_high : {true, false}) {
    for (const double depth : depths(cylinder.high - cylinder.low, options)) {
      for (int i = 0; i < options.directions; ++i) {
        const double turn = kTwoPi / 3 * i / options.directions;
        AssemblyGrasp grasp = grasp_at(3, cylinder.diameter, options);
        Pose T_cylinder_tool = Pose::Identity();
        if (from_high) T_cylinder_tool.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
        T_cylinder_tool.linear() =
            T_cylinder_tool.linear() * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        T_cylinder_tool.translation().z() = from_high ? cylinder.high - depth : cylinder.low + depth;
        grasp.T_active_tool = cylinder.T_mesh_cylinder * T_cylinder_tool;
        grasp.contact_length = depth;
        grasp.contact_width = std::min(options.finger_width, cylinder.diameter * std::tan(detail::kPi / 3));
        out.push_back(grasp);
      }
    }
  }
  return out;
}

std::vector<AssemblyGrasp> centric_grasps(const TriangleMesh& mesh, const std::vector<int>& faces,
                                          const CylinderFit& cylinder, const AssemblyGraspOptions& options) {
  std::vector<AssemblyGrasp> out = centric_grasps(cylinder, options);
  const std::vector<int> segment = given_or_all(mesh, faces);
  const double rough = kRough * detail::wall_deviation(mesh, segment, cylinder);
  const std::vector<int> beyond = detail::faces_beyond(mesh, segment, cylinder);
  for (AssemblyGrasp& grasp : out)
    detail::stand_on_wall(mesh, beyond, std::min(rough, options.parallel_angle * grasp.contact_length), grasp);
  const auto too_wide = [&](const AssemblyGrasp& g) { return !detail::at_most(g.opening, options.max_opening); };
  out.erase(std::remove_if(out.begin(), out.end(), too_wide), out.end());
  return out;
}

}  // namespace mmgrasp
