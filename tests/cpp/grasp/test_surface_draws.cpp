#include "mmgrasp/grasp/surface_draws.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// Two pads `offset` before the walls of a box 40 mm wide across y, walls uncertain by sigma.
struct Setting {
  std::vector<PadRays> rays;
  std::vector<SdfHits> hits;
  double reach = 0;
};

Setting box_between(double offset, double sigma) {
  Setting out;
  out.reach = 0.04 + 2 * offset;
  for (const double side : {-1.0, 1.0}) {
    FingerPad pad;
    pad.depth = pad.width = 0.02;
    pad.T_hand_pad.linear() << Vector3d::UnitZ(), -side * Vector3d::UnitX(), -side * Vector3d::UnitY();
    pad.T_hand_pad.translation().y() = side * (0.02 + offset);
    out.rays.push_back(pad_rays(pad, Pose::Identity()));
    const PadRays& rays = out.rays.back();
    const Eigen::Index n = rays.origins.cols();
    SdfHits hits;
    hits.hit.assign(n, 1);
    hits.distance.setConstant(n, offset);
    hits.point = rays.origins + offset * rays.directions;
    hits.normal = -rays.directions;
    hits.sigma.setConstant(n, sigma);
    out.hits.push_back(hits);
  }
  return out;
}

const ObjectExtent kBox{Vector3d::Zero(), 0.06};

}  // namespace

TEST(SurfaceDraws, StiffSurfacesHaveAClosedForm) {
  // With a correlation far beyond the hand both walls move out or in together by sigma g: pads stand in the object when
  // g < -offset / sigma, P_2 is exp(-2 |sigma g| / scale), and the rest is 1.
  const double offset = 0.003, sigma = 0.002, scale = 0.01;
  const Setting setting = box_between(offset, sigma);
  SurfaceDrawOptions options;
  options.correlation_length = 100;
  options.draws = 20000;
  SuccessOptions success;
  success.placement_scale = scale;
  const DrawnSuccess drawn = draw_success(setting.hits, setting.rays, setting.reach, kBox, offset, options, success);
  double holds = 0, probability = 0;
  const double step = 1e-3;
  for (double g = -8 + step / 2; g < 8; g += step) {
    if (sigma * g <= -offset || 2 * sigma * g > 0.04) continue;
    const double density = std::exp(-g * g / 2) / std::sqrt(2 * std::acos(-1.0)) * step;
    holds += density;
    probability += density * (0.8 + 0.1 * std::exp(-2 * std::abs(sigma * g) / scale)) / 0.9;
  }
  // Pads of 20 mm reach as far as the opposite pad: 46 mm.
  EXPECT_NEAR(drawn.holds, holds, 4 * std::sqrt(holds * (1 - holds) / options.draws));
  EXPECT_NEAR(drawn.probability, probability, 4 * drawn.standard_error);
  EXPECT_GT(drawn.standard_error, 0);
}

TEST(SurfaceDraws, FieldsHaveTheStatedCorrelation) {
  // The same probability from fields drawn another way: Cholesky's factor of the hits' covariance.
  const double offset = 0.008, sigma = 0.0015, length = 0.012;
  const Setting setting = box_between(offset, sigma);
  SurfaceDrawOptions options;
  options.correlation_length = length;
  options.draws = 4000;
  const DrawnSuccess drawn = draw_success(setting.hits, setting.rays, setting.reach, kBox, offset, options);

  const Eigen::Index each = setting.rays[0].origins.cols(), n = 2 * each;
  Eigen::Matrix3Xd points(3, n);
  points << setting.hits[0].point, setting.hits[1].point;
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) = std::exp(-(points.col(i) - points.col(j)).squaredNorm() / (2 * length * length));
  covariance.diagonal().array() += 1e-9;
  const Eigen::MatrixXd factor = covariance.llt().matrixL();
  SuccessOptions known;
  known.angle_weight = 0.6 / 0.9;
  known.placement_weight = 0.1 / 0.9;
  known.centring_weight = 0.2 / 0.9;
  known.certainty_weight = 0;
  Rng rng(11);
  double sum = 0, squares = 0;
  const int draws = 4000;
  for (int k = 0; k < draws; ++k) {
    Eigen::VectorXd z(n);
    for (Eigen::Index i = 0; i < n; ++i) z[i] = rng.normal();
    const Eigen::VectorXd field = factor * z;
    std::vector<ContactPatch> patches(2);
    bool meets = true;
    for (int pad = 0; pad < 2; ++pad) {
      SdfHits hits = setting.hits[pad];
      for (Eigen::Index i = 0; i < each; ++i) {
        hits.distance[i] += sigma * field[pad * each + i];
        hits.point.col(i) += sigma * field[pad * each + i] * setting.rays[pad].directions.col(i);
      }
      meets = meets && fit_contact_patch(hits, setting.rays[pad].directions.col(0), setting.reach, patches[pad]) ==
                           PatchState::found;
    }
    const double value = meets ? evaluate_success(patches, kBox, offset, known).probability : 0;
    sum += value / draws;
    squares += value * value / draws;
  }
  const double error = std::hypot(drawn.standard_error, std::sqrt((squares - sum * sum) / draws));
  EXPECT_NEAR(drawn.probability, sum, 4 * error);
  EXPECT_LT(error, 0.01);
}

TEST(SurfaceDraws, CertainSurfacesGiveTheModelItself) {
  const Setting setting = box_between(0.01, 0);
  const DrawnSuccess drawn = draw_success(setting.hits, setting.rays, setting.reach, kBox, 0.01);
  EXPECT_NEAR(drawn.probability, 1, 1e-9);
  EXPECT_EQ(drawn.holds, 1);
  double before = 1;
  for (const double sigma : {0.001, 0.003, 0.006}) {
    const Setting less = box_between(0.01, sigma);
    const double now = draw_success(less.hits, less.rays, less.reach, kBox, 0.01).probability;
    EXPECT_LT(now, before);
    before = now;
  }
}

TEST(SurfaceDraws, BadOptionsAreNamed) {
  const Setting setting = box_between(0.01, 0.001);
  SurfaceDrawOptions options;
  options.correlation_length = 0;
  EXPECT_THROW(draw_success(setting.hits, setting.rays, setting.reach, kBox, 0.01, options), InvalidInput);
  SuccessOptions success;
  success.angle_weight = success.placement_weight = success.centring_weight = 0;
  success.certainty_weight = 1;
  EXPECT_THROW(draw_success(setting.hits, setting.rays, setting.reach, kBox, 0.01, {}, success), InvalidInput);
}

}  // namespace mmgrasp
