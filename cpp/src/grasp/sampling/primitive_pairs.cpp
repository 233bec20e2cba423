// Contact pairs of boxes, cylinders, capsules and spheres in closed form.
#include <algorithm>
#include <cmath>

#include "grasp/sampling/approach_direction.hpp"
#include "grasp/sampling/contact_pairs.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

/// Pad positions along a free direction of half length `half`, the middle first. The outermost ones put a pad flush
/// with the edge, or half a pad's way out when the part is shorter than the pad: fingertips must not always reach
/// through.
std::vector<double> pad_positions(double half, int count, double pad) {
  const double outermost = std::max(half / 2, half - pad / 2);
  std::vector<double> positions;
  for (int i = 0; i < count; ++i)
    positions.push_back(count == 1 ? 0.0 : outermost * (2 * i - (count - 1)) / static_cast<double>(count - 1));
  std::stable_sort(positions.begin(), positions.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return positions;
}

/// Offsets (along u, along v) over a face, the middle first.
std::vector<Eigen::Vector2d> face_positions(double half_u, double half_v, int count, double pad) {
  std::vector<Eigen::Vector2d> positions;
  for (const double u : pad_positions(half_u, count, pad))
    for (const double v : pad_positions(half_v, count, pad)) positions.emplace_back(u, v);
  std::stable_sort(positions.begin(), positions.end(),
                   [](const auto& a, const auto& b) { return a.cwiseAbs().sum() < b.cwiseAbs().sum(); });
  return positions;
}

std::vector<Eigen::Vector3d> box_corners(const Eigen::Vector3d& half) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(half.cwiseProduct(Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  return corners;
}

ContactPairs box_pairs(const Box& box, double pad, const GraspSamplerOptions& options) {
  ContactPairs result;
  const Eigen::Vector3d half = box.size / 2;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const Eigen::Vector2d& offset : face_positions(half[u], half[v], options.positions, pad)) {
      ContactPair pair;
      pair.axis = Eigen::Vector3d::Unit(axis);
      pair.first_approach = Eigen::Vector3d::Unit(u);
      pair.middle[u] = offset[0];
      pair.middle[v] = offset[1];
      pair.width = box.size[axis];
      pair.face =
          ContactFace{Eigen::Vector3d::Unit(u), Eigen::Vector3d::Unit(v), half[u], half[v], offset[0], offset[1]};
      result.pairs.push_back(pair);
    }
  }
  result.corners = box_corners(half);
  return result;
}

/// Unit axes across a direction, spread over half a turn: the flip gives the other half.
std::vector<Eigen::Vector3d> axes_across(const Eigen::Vector3d& direction, int count) {
  const Eigen::Vector3d u = orthogonal_to(direction), v = direction.cross(u);
  std::vector<Eigen::Vector3d> axes;
  for (int i = 0; i < count; ++i) {
    const double angle = kPi * i / count;
    axes.push_back(std::cos(angle) * u + std::sin(angle) * v);
  }
  return axes;
}

/// Diameters of a cylinder or capsule: `approaches` of them, or the one that is across the approach direction as well.
std::vector<Eigen::Vector3d> side_axes(const GraspSamplerOptions& options) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if (options.approach_direction && straight_across(z, *options.approach_direction))
    return {z.cross(*options.approach_direction).normalized()};
  return axes_across(z, options.approaches);
}

/// Pairs across the side of a cylinder or capsule, at each height.
void add_side_pairs(double radius, double half_length, double pad, const GraspSamplerOptions& options,
                    ContactPairs& result) {
  for (const double z : pad_positions(half_length, options.positions, pad)) {
    for (const Eigen::Vector3d& axis : side_axes(options)) {
      ContactPair pair;
      pair.axis = axis;
      pair.middle.z() = z;
      pair.width = 2 * radius;
      result.pairs.push_back(pair);  // approaches start along z, which is orthogonal to every diameter
    }
  }
}

ContactPairs cylinder_pairs(const Cylinder& cylinder, double pad, const GraspSamplerOptions& options) {
  ContactPairs result;
  add_side_pairs(cylinder.radius, cylinder.length / 2, pad, options, result);
  // The square inscribed in the end discs keeps every contact on them.
  const double half = cylinder.radius / std::sqrt(2.0);
  for (const Eigen::Vector2d& offset : face_positions(half, half, options.positions, pad)) {
    ContactPair pair;
    pair.axis = Eigen::Vector3d::UnitZ();
    pair.first_approach = Eigen::Vector3d::UnitX();
    pair.middle << offset, 0;
    pair.width = cylinder.length;
    result.pairs.push_back(pair);
  }
  result.corners = box_corners({cylinder.radius, cylinder.radius, cylinder.length / 2});
  return result;
}

ContactPairs capsule_pairs(const Capsule& capsule, double pad, const GraspSamplerOptions& options) {
  ContactPairs result;
  add_side_pairs(capsule.radius, capsule.length / 2, pad, options, result);
  ContactPair ends;
  ends.axis = Eigen::Vector3d::UnitZ();
  ends.first_approach = Eigen::Vector3d::UnitX();
  ends.width = capsule.length + 2 * capsule.radius;
  result.pairs.push_back(ends);
  result.corners = box_corners({capsule.radius, capsule.radius, ends.width / 2});
  return result;
}

/// Diameters of a sphere: the three main axes, then a golden-angle spiral over the upper half; or those across the
/// approach direction.
ContactPairs sphere_pairs(const Sphere& sphere, const GraspSamplerOptions& options) {
  ContactPairs result;
  const auto add = [&](const Eigen::Vector3d& axis) {
    ContactPair pair;
    pair.axis = axis;
    pair.first_approach = orthogonal_to(axis);
    pair.width = 2 * sphere.radius;
    result.pairs.push_back(pair);
  };
  result.corners = box_corners(Eigen::Vector3d::Constant(sphere.radius));
  if (options.approach_direction) {
    for (const Eigen::Vector3d& axis : axes_across(*options.approach_direction, options.approaches)) add(axis);
    return result;
  }
  for (int axis = 0; axis < 3; ++axis) add(Eigen::Vector3d::Unit(axis));
  const int spread = options.approaches * options.positions;
  const double golden_angle = kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < spread; ++i) {
    const double z = (i + 0.5) / spread, r = std::sqrt(1 - z * z);
    add(Eigen::Vector3d(r * std::cos(golden_angle * i), r * std::sin(golden_angle * i), z).normalized());
  }
  return result;
}

void place(const Pose& T, ContactPairs& pairs) {
  pairs.centre_of_mass = T * pairs.centre_of_mass;
  for (Eigen::Vector3d& corner : pairs.corners) corner = T * corner;
  for (ContactPair& pair : pairs.pairs) {
    pair.middle = T * pair.middle;
    pair.axis = T.linear() * pair.axis;
    pair.first_approach = T.linear() * pair.first_approach;
    if (!pair.face) continue;
    pair.face->u = T.linear() * pair.face->u;
    pair.face->v = T.linear() * pair.face->v;
  }
}

/// Keeps the part of a polygon with normal . x <= offset.
std::vector<Eigen::Vector2d> clip(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& normal,
                                  double offset) {
  std::vector<Eigen::Vector2d> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = normal.dot(a) - offset, db = normal.dot(b) - offset;
    if (da <= 0) kept.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) kept.push_back(a + (b - a) * (da / (da - db)));
  }
  return kept;
}

double polygon_area(const std::vector<Eigen::Vector2d>& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(twice) / 2;
}

}  // namespace

Eigen::Vector3d orthogonal_to(const Eigen::Vector3d& axis) {
  Eigen::Index smallest;
  axis.cwiseAbs().minCoeff(&smallest);
  // The main axis that lies flattest, projected: approaches then start near a main axis of the object.
  return (Eigen::Vector3d::Unit(smallest) - axis[smallest] * axis).normalized();
}

double pad_overlap(const ContactFace& face, const Eigen::Vector3d& approach, double standoff, double depth,
                   double width) {
  const Eigen::Vector2d along(approach.dot(face.u), approach.dot(face.v));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Vector2d centre = Eigen::Vector2d(face.offset_u, face.offset_v) - standoff * along;
  std::vector<Eigen::Vector2d> pad;
  for (const auto& [d, w] : {std::pair{1, 1}, std::pair{-1, 1}, std::pair{-1, -1}, std::pair{1, -1}})
    pad.push_back(centre + along * (d * depth / 2) + across * (w * width / 2));
  for (const double sign : {1.0, -1.0}) {
    pad = clip(pad, {sign, 0}, face.half_u);
    pad = clip(pad, {0, sign}, face.half_v);
  }
  return std::min(1.0, polygon_area(pad) / (depth * width));
}

std::optional<ContactPairs> primitive_pairs(const LinkShape& shape, const Hand& hand,
                                            const GraspSamplerOptions& given) {
  GraspSamplerOptions options = given;
  if (given.approach_direction) {
    options.approach_direction = shape.T_link_shape.linear().transpose() * given.approach_direction->normalized();
    if (lies_askew(shape.shape, *options.approach_direction)) return {};
  }
  const double pad = hand.finger_depth;
  std::optional<ContactPairs> result;
  if (const auto* box = std::get_if<Box>(&shape.shape)) result = box_pairs(*box, pad, options);
  if (const auto* sphere = std::get_if<Sphere>(&shape.shape)) result = sphere_pairs(*sphere, options);
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.shape)) result = cylinder_pairs(*cylinder, pad, options);
  if (const auto* capsule = std::get_if<Capsule>(&shape.shape)) result = capsule_pairs(*capsule, pad, options);
  if (result) place(shape.T_link_shape, *result);
  return result;
}

}  // namespace mmgrasp::detail
