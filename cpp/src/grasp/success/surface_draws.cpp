#include "mmgrasp/grasp/surface_draws.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr int kWaves = 64;           // in a random field
constexpr double kLeastSlope = 0.2;  // a ray meets the surface at least so steeply: cosine to its normal

/// A stationary field of N(0, 1) with Gaussian correlation, as a sum of waves (Rahimi and Recht 2007).
class SmoothField {
 public:
  SmoothField(double length, Rng& rng) {
    for (int k = 0; k < kWaves; ++k) {
      for (int axis = 0; axis < 3; ++axis) wave_(axis, k) = rng.normal() / length;
      phase_[k] = rng.uniform(0, detail::kTwoPi);
      // Normal amplitudes make the field Gaussian at every place, not only for many waves.
      amplitude_[k] = rng.normal() * std::sqrt(2.0 / kWaves);
    }
  }
  double at(const Vector3d& p) const {
    return ((wave_.transpose() * p + phase_).array().cos() * amplitude_.array()).sum();
  }

 private:
  Eigen::Matrix<double, 3, kWaves> wave_;
  Eigen::Matrix<double, kWaves, 1> phase_, amplitude_;
};

/// The hits on a drawn surface: each moves along its ray by as much as the surface along its normal, over the cosine.
SdfHits moved(const SdfHits& mean, const Eigen::Matrix3Xd& directions, const SmoothField& field) {
  SdfHits hits = mean;
  for (Eigen::Index i = 0; i < hits.distance.size(); ++i) {
    if (!hits.hit[i]) continue;
    const Vector3d direction = directions.col(i), point = mean.point.col(i);
    const double slope = std::max(kLeastSlope, -direction.dot(mean.normal.col(i)));
    // A larger distance everywhere means a surface farther away.
    const double along = mean.sigma[i] * field.at(point) / slope;
    hits.distance[i] += along;
    hits.point.col(i) += along * direction;
    hits.sigma[i] = 0;
  }
  return hits;
}

}  // namespace

void SurfaceDrawOptions::check() const {
  require(draws > 0 && draws <= 1000000, "draws", draws, "must be from 1 to 1000000");
  require_positive(correlation_length, "correlation_length", "m");
}

DrawnSuccess draw_success(const std::vector<SdfHits>& hits, const std::vector<PadRays>& rays, double reach,
                          const ObjectExtent& object, double offset, const SurfaceDrawOptions& options,
                          const SuccessOptions& success, const ContactPatchOptions& patch) {
  options.check();
  success.check();
  patch.check();
  require(hits.size() == rays.size(), "hits", std::to_string(hits.size()), "must be one entry a pad");
  SuccessOptions known = success;
  const double rest = 1 - success.certainty_weight;
  require(rest > 1e-9, "certainty_weight", success.certainty_weight,
          "must leave something to weights of known surfaces");
  known.angle_weight /= rest;
  known.placement_weight /= rest;
  known.centring_weight /= rest;
  known.certainty_weight = 0;
  double sum = 0, squares = 0;
  int held = 0;
  for (int draw = 0; draw < options.draws; ++draw) {
    Rng rng(options.seed, static_cast<std::uint64_t>(draw));
    const SmoothField field(options.correlation_length, rng);
    std::vector<ContactPatch> patches(hits.size());
    bool meets = true;
    for (std::size_t k = 0; k < hits.size() && meets; ++k) {
      const SdfHits on = moved(hits[k], rays[k].directions, field);
      meets = fit_contact_patch(on, rays[k].directions.col(0), reach, patches[k], patch) == PatchState::found &&
              patches[k].nearest > 0;
    }
    const double value = meets ? evaluate_success(patches, object, offset, known).probability : 0;
    sum += value;
    squares += value * value;
    held += value > 0;
  }
  DrawnSuccess out;
  out.probability = sum / options.draws;
  out.standard_error =
      std::sqrt(std::max(0.0, squares / options.draws - out.probability * out.probability) / options.draws);
  out.holds = static_cast<double>(held) / options.draws;
  return out;
}

DrawnSuccess draw_success(const ProbabilisticSdf& map, const std::vector<FingerPad>& pads, const Pose& T_world_hand,
                          const ObjectExtent& object, double offset, const SurfaceDrawOptions& options,
                          const SuccessOptions& success, const ContactPatchOptions& patch) {
  patch.check();
  std::vector<PadRays> rays;
  std::vector<SdfHits> hits;
  for (const FingerPad& pad : pads) {
    rays.push_back(pad_rays(pad, T_world_hand, patch));
    hits.push_back(map.cast_rays(rays.back().origins, rays.back().directions, 1));
  }
  return draw_success(hits, rays, closing_line(pads).opening, object, offset, options, success, patch);
}

}  // namespace mmgrasp
