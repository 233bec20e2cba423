#include "mmgrasp/grasp/success_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// Angle between two unit vectors [rad]; exact near 0 and pi, where the arc cosine is not.
double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The two ends of the line of contact: of several contacts on one side their mean.
std::pair<Vector3d, Vector3d> contact_line(const std::vector<ContactPatch>& patches) {
  if (patches.size() == 2) return {patches[0].point, patches[1].point};
  std::vector<Vector3d> pushes;
  for (const ContactPatch& patch : patches) pushes.push_back(patch.pad_normal);
  const std::vector<int> sides = opposed_sides(pushes);
  Vector3d sum[2] = {Vector3d::Zero(), Vector3d::Zero()};
  int count[2] = {0, 0};
  for (std::size_t k = 0; k < patches.size(); ++k) {
    sum[sides[k]] += patches[k].point;
    ++count[sides[k]];
  }
  for (int side = 0; side < 2; ++side) sum[side] /= std::max(1, count[side]);
  return {count[0] > 0 ? sum[0] : sum[1], count[1] > 0 ? sum[1] : sum[0]};
}

}  // namespace

void SuccessOptions::check() const {
  require_positive(friction, "friction");
  double sum = 0;
  for (const auto& [weight, field] : {std::pair{angle_weight, "angle_weight"},
                                      {placement_weight, "placement_weight"},
                                      {centring_weight, "centring_weight"},
                                      {certainty_weight, "certainty_weight"}}) {
    require(weight >= 0 && weight <= 1, field, weight, "must be in [0, 1]");
    sum += weight;
  }
  require(std::abs(sum - 1) <= 1e-9, "sum of the four weights", sum, "must be 1");
  require_positive(placement_scale, "placement_scale", "m");
  require_positive(max_sigma, "max_sigma", "m");
}

double angle_criterion(const std::vector<ContactPatch>& patches, double friction) {
  const double half_cone = std::atan(friction);  // theta / 2
  double product = 1;
  for (const ContactPatch& patch : patches) {
    const double beta = detail::kPi - angle_between(patch.pad_normal, patch.normal);
    if (!(std::abs(beta) < half_cone)) return 0;
    product *= 1 - std::abs(beta) / half_cone;
  }
  return product;
}

double placement_criterion(const std::vector<ContactPatch>& patches, double offset, double scale) {
  double off = 0;
  for (const ContactPatch& patch : patches) off += std::abs(patch.distance - offset);
  return std::exp(-off / scale);
}

double centring_criterion(const std::vector<ContactPatch>& patches, const ObjectExtent& object) {
  if (patches.empty()) return 0;
  const auto [a, b] = contact_line(patches);
  const double length = (b - a).norm();
  const double distance = length > 0 ? (object.centre - a).cross(b - a).norm() / length : (object.centre - a).norm();
  return std::max(0.0, 1 - distance / (object.longest / 2));
}

double certainty_criterion(const std::vector<ContactPatch>& patches, double max_sigma) {
  double product = 1;
  for (const ContactPatch& patch : patches) product *= std::max(0.0, 1 - patch.sigma / max_sigma);
  return product;
}

GraspSuccess evaluate_success(const std::vector<ContactPatch>& patches, const ObjectExtent& object, double offset,
                              const SuccessOptions& options) {
  options.check();
  require_positive(object.longest, "object.longest", "m");
  require_not_negative(offset, "offset", "m");
  GraspSuccess out;
  out.angle = angle_criterion(patches, options.friction);
  out.placement = placement_criterion(patches, offset, options.placement_scale);
  out.centring = centring_criterion(patches, object);
  out.certainty = certainty_criterion(patches, options.max_sigma);
  out.weighted = options.angle_weight * out.angle + options.placement_weight * out.placement +
                 options.centring_weight * out.centring + options.certainty_weight * out.certainty;
  out.force_closure = has_force_closure(patches, options.friction);
  const bool holds = out.force_closure && out.angle > 0 && out.certainty > 0;
  out.probability = holds ? out.weighted : 0;
  return out;
}

}  // namespace mmgrasp
