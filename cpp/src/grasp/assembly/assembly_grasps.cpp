#include "mmgrasp/grasp/assembly_grasps.hpp"

#include <algorithm>
#include <cmath>

#include "grasp/assembly/pad_contact.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/clip_polygon.hpp"
#include "mmgrasp/geometry/detail/faces_or_all.hpp"
#include "mmgrasp/geometry/opposite_facets.hpp"

namespace mmgrasp {
namespace {

using detail::kTwoPi;
using Polygon = std::vector<Eigen::Vector3d>;

/// Points of a wall are off its cylinder by no more than so many times the median: four standard deviations.
constexpr double kRough = 6;

OppositeFacetsOptions facets_held(const AssemblyGraspOptions& options) {
  OppositeFacetsOptions out;
  out.facet_angle = options.facet_angle;
  out.parallel_angle = options.parallel_angle;
  out.min_contact = options.min_contact;
  out.max_width = options.max_opening;
  return out;
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
void add_pair(const TriangleMesh& mesh, const std::vector<int>& faces, const OppositeFacets& pair,
              const AssemblyGraspOptions& options, std::vector<AssemblyGrasp>& out) {
  const Eigen::Matrix3d& axes = pair.axes;
  const Eigen::Vector3d normal = axes.col(2);
  const detail::PadFaces first = detail::pad_faces(mesh, faces, pair.first, normal);
  const detail::PadFaces second = detail::pad_faces(mesh, faces, pair.second, -normal);
  for (int i = 0; i < options.directions; ++i) {
    const double turn = kTwoPi * i / options.directions;
    const Eigen::Vector2d approach(std::cos(turn), std::sin(turn)), across(-approach.y(), approach.x());
    double near = detail::kInfinity, far = -detail::kInfinity;
    std::vector<Polygon> strip;  // what fingers cover
    for (const Polygon& whole : pair.overlap) {
      detail::throw_if_interrupted();
      Polygon piece = detail::clip_polygon(whole, {across, across.dot(pair.middle) + options.finger_width / 2});
      strip.push_back(detail::clip_polygon(piece, {-across, -across.dot(pair.middle) + options.finger_width / 2}));
      for (const Eigen::Vector3d& p : strip.back()) {
        near = std::min(near, approach.dot(p.head<2>() - pair.middle));
        far = std::max(far, approach.dot(p.head<2>() - pair.middle));
      }
    }
    for (const double depth : depths(far - near, options)) {
      AssemblyGrasp grasp = grasp_at(2, pair.width, options);
      const Eigen::Vector2d tip = pair.middle + (near + depth) * approach;
      const Eigen::Vector3d z = axes * Eigen::Vector3d(approach.x(), approach.y(), 0);
      grasp.T_active_tool.linear().col(0) = normal;
      grasp.T_active_tool.linear().col(1) = z.cross(normal);
      grasp.T_active_tool.linear().col(2) = z;
      grasp.T_active_tool.translation() = axes * Eigen::Vector3d(tip.x(), tip.y(), pair.height);
      double area = 0;
      for (const Polygon& piece : strip)
        area += detail::shadow_area(detail::clip_polygon(piece, {approach, approach.dot(tip)}));
      grasp.contact_length = depth;
      grasp.contact_width = area / depth;
      detail::stand_on_facets(mesh, first, second, grasp);
      if (detail::at_most(grasp.opening, options.max_opening)) out.push_back(grasp);
    }
  }
}

}  // namespace

void AssemblyGraspOptions::check() const {
  require_positive(max_opening, "max_opening", "m");
  facets_held(*this).check();
  require(directions >= 1 && directions <= 360, "directions", directions, "must be from 1 to 360");
  const auto positive = [](const char* field, double value) { require_positive(value, field, "m"); };
  positive("pad_length", pad_length);
  positive("finger_width", finger_width);
  positive("finger_thickness", finger_thickness);
  require(pad_length >= min_contact, "pad_length", pad_length, "must be at least min_contact [m]");
  require_not_negative(clearance, "clearance", "m");
  require_not_negative(tip_clearance, "tip_clearance", "m");
  require_not_negative(palm_margin, "palm_margin", "m");
}

std::vector<AssemblyGrasp> jaw_grasps(const TriangleMesh& mesh, const std::vector<int>& faces,
                                      const AssemblyGraspOptions& options) {
  options.check();
  const std::vector<int> segment = detail::faces_or_all(mesh, faces);
  std::vector<AssemblyGrasp> out;
  visit_opposite_facets(mesh, segment, facets_held(options),
                        [&](const OppositeFacets& pair) { add_pair(mesh, segment, pair, options, out); });
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
  const std::vector<int> segment = detail::faces_or_all(mesh, faces);
  const double rough = kRough * detail::wall_deviation(mesh, segment, cylinder);
  const std::vector<int> beyond = detail::faces_beyond(mesh, segment, cylinder);
  for (AssemblyGrasp& grasp : out)
    detail::stand_on_wall(mesh, beyond, std::min(rough, options.parallel_angle * grasp.contact_length), grasp);
  const auto too_wide = [&](const AssemblyGrasp& g) { return !detail::at_most(g.opening, options.max_opening); };
  out.erase(std::remove_if(out.begin(), out.end(), too_wide), out.end());
  return out;
}

}  // namespace mmgrasp
