#include "mmgrasp/geometry/fit_primitives.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "geometry/segmentation/find_threads.hpp"
#include "geometry/segmentation/jaw_widths.hpp"
#include "geometry/segmentation/segment_surface.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/inside_out.hpp"

namespace mmgrasp {
namespace {

using detail::SegmentSurface;
using Eigen::Vector3d;
/// Cosine of the bend up to which faces at a corner share its normal.
constexpr double kSmooth = 0.766;
/// Faces this close to parallel to a box' face, and this close to it as a share of the segment's size, lie on it.
constexpr double kParallel = 0.99, kOnBox = 0.02;
constexpr int kDirections = 64;
/// Round surfaces off by less are as good as their outlines, as a share of the segment's size.
constexpr double kExact = 1e-5;
/// Corners of a grooved surface's hull lie closer to its outline than this share of what the surface is off: noise puts
/// the outer ones off by a quarter of what it puts the surface off.
constexpr double kSharper = 0.1;

/// The direction that most of the area faces, to both sides, of those across `axis` (zero: any). Zero when there is
/// none.
Vector3d main_normal(const SegmentSurface& s, const Vector3d& axis) {
  Vector3d best = Vector3d::Zero();
  double most = 0;
  std::vector<int> large(s.areas.size());
  for (std::size_t f = 0; f < large.size(); ++f) large[f] = static_cast<int>(f);
  std::stable_sort(large.begin(), large.end(), [&](int a, int b) { return s.areas[a] > s.areas[b]; });
  const std::size_t stride = 1 + large.size() / kDirections;
  for (std::size_t k = 0; k < large.size(); k += stride) {
    const Vector3d& tried = s.face_normals[large[k]];
    if (tried.isZero() || std::abs(tried.dot(axis)) > 0.02) continue;
    double area = 0;
    Vector3d sum = Vector3d::Zero();
    for (std::size_t f = 0; f < s.areas.size(); ++f) {
      const double cosine = s.face_normals[f].dot(tried);
      if (std::abs(cosine) < kParallel) continue;
      area += s.areas[f];
      sum += (cosine > 0 ? s.areas[f] : -s.areas[f]) * s.face_normals[f];
    }
    if (area <= most) continue;
    most = area;
    best = (sum - sum.dot(axis) * axis).normalized();
  }
  return best;
}

FittedPrimitive box_along(const SegmentSurface& s, const Eigen::Matrix3d& axes) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : s.hull.points) box.extend(axes.transpose() * p);
  // Area of the faces on each side, and their mean place along the axis by area, which noise does not push out.
  double area[3][2] = {}, place[3][2] = {}, off = 0, all = 0;
  for (std::size_t f = 0; f < s.areas.size(); ++f) {
    const Vector3d middle = axes.transpose() * ((s.corners[f][0] + s.corners[f][1] + s.corners[f][2]) / 3);
    const Vector3d normal = axes.transpose() * s.face_normals[f];
    for (int k = 0; k < 3; ++k) {
      for (int side = 0; side < 2; ++side) {
        const double sign = side ? 1 : -1, edge = side ? box.max()[k] : box.min()[k];
        if (sign * normal[k] < kParallel || std::abs(middle[k] - edge) > kOnBox) continue;
        area[k][side] += s.areas[f];
        place[k][side] += s.areas[f] * middle[k];
        off += s.areas[f] * std::abs(middle[k] - edge);
        all += s.areas[f];
      }
    }
  }
  FittedPrimitive out;
  Vector3d low = box.min(), high = box.max();
  for (int k = 0; k < 3; ++k) {
    if (area[k][0] > 0) low[k] = place[k][0] / area[k][0];
    if (area[k][1] > 0) high[k] = place[k][1] / area[k][1];
  }
  const Vector3d size = high - low;
  out.kind = PrimitiveKind::box;
  out.size = s.scale * size;
  // Around the hull, as the round candidates' is: the end of a bore that runs on must not count for one kind alone.
  out.volume = std::pow(s.scale, 3) * box.sizes().prod();
  out.deviation = all > 0 ? s.scale * off / all : 0;
  out.T_mesh_primitive.linear() = axes;
  out.T_mesh_primitive.translation() = s.to_mesh(axes * (0.5 * (low + high)));
  return out;
}

}  // namespace

namespace detail {

SegmentSurface segment_surface(const TriangleMesh& mesh, const std::vector<int>& faces, CornerWeight weight) {
  SegmentSurface out;
  Eigen::AlignedBox3d box;
  for (const int f : faces) {
    for (const int v : mesh.triangles[f]) box.extend(mesh.vertices[v]);
  }
  if (box.isEmpty()) return out;
  out.origin = box.center();
  out.scale = std::max(box.diagonal().norm(), 1e-300);
  std::map<int, std::vector<int>> around;
  for (std::size_t k = 0; k < faces.size(); ++k) {
    std::array<Vector3d, 3> c;
    for (int i = 0; i < 3; ++i) {
      c[i] = (mesh.vertices[mesh.triangles[faces[k]][i]] - out.origin) / out.scale;
      around[mesh.triangles[faces[k]][i]].push_back(static_cast<int>(k));
    }
    const Vector3d cross = (c[1] - c[0]).cross(c[2] - c[0]);
    out.corners.push_back(c);
    out.areas.push_back(cross.norm() / 2);
    out.face_normals.push_back(cross.norm() > 0 ? Vector3d(cross.normalized()) : Vector3d::Zero());
    out.area += out.areas.back();
  }
  out.corner_normals.resize(out.corners.size());
  std::vector<Vector3d> corners;
  for (const auto& [vertex, at] : around) {
    const Vector3d p = (mesh.vertices[vertex] - out.origin) / out.scale;
    corners.push_back(p);
    std::vector<Vector3d> found;
    for (const int k : at) {
      Vector3d sum = Vector3d::Zero();
      for (const int other : at) {
        if (out.face_normals[k].dot(out.face_normals[other]) < kSmooth) continue;
        int i = 0;
        for (int c = 0; c < 3; ++c) {
          if (mesh.triangles[faces[other]][c] == vertex) i = c;
        }
        const auto& c = out.corners[other];
        const Vector3d u = c[(i + 1) % 3] - c[i], v = c[(i + 2) % 3] - c[i];
        const double angle = std::atan2(u.cross(v).norm(), u.dot(v));
        sum += (weight == CornerWeight::angle ? angle : out.areas[other]) * out.face_normals[other];
      }
      const Vector3d normal = sum.norm() > 0 ? Vector3d(sum.normalized()) : out.face_normals[k];
      for (int c = 0; c < 3; ++c) {
        if (mesh.triangles[faces[k]][c] == vertex) out.corner_normals[k][c] = normal;
      }
      if (normal.isZero()) continue;
      const bool known =
          std::any_of(found.begin(), found.end(), [&](const Vector3d& n) { return n.dot(normal) > 0.999; });
      if (known) continue;
      found.push_back(normal);
      out.points.push_back(p);
      out.normals.push_back(normal);
    }
  }
  out.hull = region_hull(corners);
  return out;
}

FittedPrimitive box_candidate(const SegmentSurface& s) {
  FittedPrimitive best;
  double least = detail::kInfinity;
  const auto offer = [&](const Vector3d& z, const Vector3d& x) {
    Eigen::Matrix3d axes;
    axes << x, z.cross(x), z;
    FittedPrimitive box = box_along(s, axes);
    if (box.volume >= least) return;
    least = box.volume;
    best = std::move(box);
  };
  Vector3d z = main_normal(s, Vector3d::Zero());
  if (z.isZero()) z = Vector3d::UnitZ();
  const Vector3d x = main_normal(s, z);
  if (!x.isZero()) {
    offer(z, x);
    return best;
  }
  for (int k = 0; k < kDirections; ++k) {  // nothing flat across: a round part
    const double angle = 1.57079632679489661923 * k / kDirections;
    const Vector3d u = z.unitOrthogonal();
    offer(z, std::cos(angle) * u + std::sin(angle) * z.cross(u));
  }
  return best;
}

}  // namespace detail

namespace {

/// A primitive that may stand for a segment: how far its volume is from the hull's [m^3], and the points that it was
/// fitted to from it [m].
struct PrimitiveChoice {
  FittedPrimitive primitive;
  double off = 0, spread = detail::kInfinity;
};

/// The round candidate whose volume is closest to the hull's takes the place of the choice where it is closer than
/// that.
void offer(std::vector<detail::RoundCandidate> candidates, double hull_volume, PrimitiveChoice& choice) {
  for (detail::RoundCandidate& round : candidates) {
    const double off = std::abs(round.primitive.volume - hull_volume);
    if (off >= choice.off) continue;
    round.trim();
    choice = {std::move(round.primitive), off, round.spread};
  }
}

/// Outlines for a choice: any for a box. Something round that lies on the surface gives way to one of its kind where
/// the hull's corners lie so much closer to that, that grooves, not noise, are what the surface differs by. Both
/// volumes are then close to the hull's, a polygon's.
std::vector<detail::RoundCandidate> outlines_for(const PrimitiveChoice& choice, const SegmentSurface& surface,
                                                 const Monitor& monitor) {
  if (choice.spread < kExact * surface.scale) return {};
  std::vector<detail::RoundCandidate> out = detail::outline_candidates(surface, monitor);
  const bool is_box = choice.primitive.kind == PrimitiveKind::box;
  const auto unlike = [&](const detail::RoundCandidate& round) {
    return !is_box && (round.primitive.kind != choice.primitive.kind || round.spread > kSharper * choice.spread);
  };
  out.erase(std::remove_if(out.begin(), out.end(), unlike), out.end());
  return out;
}

/// Box, cylinder, cone or sphere, whose volume is closest to that of the segment's hull.
FittedPrimitive best_primitive(const SegmentSurface& surface, double hull_volume, const Monitor& monitor) {
  PrimitiveChoice choice{detail::box_candidate(surface)};
  choice.off = std::abs(choice.primitive.volume - hull_volume);
  offer(detail::round_candidates(surface, monitor), hull_volume, choice);
  std::vector<detail::RoundCandidate> outlines = outlines_for(choice, surface, monitor);
  if (choice.primitive.kind != PrimitiveKind::box) choice.off = detail::kInfinity;
  offer(std::move(outlines), hull_volume, choice);
  return choice.primitive;
}

}  // namespace

const char* primitive_kind_name(PrimitiveKind kind) {
  switch (kind) {
    case PrimitiveKind::cylinder:
      return "cylinder";
    case PrimitiveKind::box:
      return "box";
    case PrimitiveKind::cone:
      return "cone";
    case PrimitiveKind::sphere:
      return "sphere";
  }
  return "";
}

std::vector<FittedPrimitive> fit_primitives(const TriangleMesh& mesh, const std::vector<int>& labels,
                                            const std::vector<ScrewThread>& threads, const Monitor& monitor,
                                            double min_contact) {
  require_positive(min_contact, "min_contact", "m");
  require(labels.size() == mesh.triangles.size(), "labels", static_cast<double>(labels.size()),
          "must be one a face, " + std::to_string(mesh.triangles.size()));
  std::vector<std::vector<int>> segments;
  for (std::size_t f = 0; f < labels.size(); ++f) {
    if (labels[f] < 0 || labels[f] >= static_cast<int>(labels.size())) {
      require(false, "labels[" + std::to_string(f) + "]", labels[f], "must be 0 or more and below the number of faces");
    }
    if (segments.size() <= static_cast<std::size_t>(labels[f])) segments.resize(labels[f] + 1);
    segments[labels[f]].push_back(static_cast<int>(f));
  }
  std::vector<FittedPrimitive> out;
  TriangleMesh outward = mesh;
  detail::turn_outwards(outward);
  for (const ScrewThread& thread : threads) {
    for (const int f : thread.faces)
      require(f >= 0 && f < static_cast<int>(labels.size()), "faces of a thread", f, "must be faces of the mesh");
    detail::smooth_thread(thread, outward);
  }
  detail::JawReach reach(outward, min_contact);
  for (const std::vector<int>& faces : segments) {
    monitor.report("primitives", static_cast<double>(out.size()) / static_cast<double>(segments.size()));
    if (faces.empty()) {  // A number that no face has.
      out.emplace_back();
      continue;
    }
    const SegmentSurface surface = detail::segment_surface(outward, faces);
    const double hull_volume = surface.hull.volume * std::pow(surface.scale, 3);
    FittedPrimitive best = best_primitive(surface, hull_volume, monitor);
    if (best.kind == PrimitiveKind::box) {
      best.volume = best.size.prod();
      best.widths = detail::jaw_widths(outward, faces, best, min_contact, reach);
    }
    best.hull_volume = hull_volume;
    if (monitor.stopped()) return {};
    out.push_back(std::move(best));
  }
  return out;
}

std::vector<std::string> segment_names(const std::vector<FittedPrimitive>& primitives) {
  std::map<PrimitiveKind, int> count;
  std::vector<std::string> out;
  for (const FittedPrimitive& p : primitives)
    out.push_back(primitive_kind_name(p.kind) + ("_" + std::to_string(++count[p.kind])));
  return out;
}

}  // namespace mmgrasp
