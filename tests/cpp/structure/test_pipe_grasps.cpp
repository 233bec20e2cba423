#include "mmgrasp/structure/pipe_grasps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
constexpr double kPi = 3.14159265358979323846;

Pipe bend() {
  return {{{0, 0, 0}, {0.3, 0, 0}, {0.3, 0.1, 0}}, {{0, 1}, {1, 2}}, {0.02, 0.03}};
}

const PipeProvenance& place_of(const Grasp& grasp) {
  return std::get<PipeProvenance>(grasp.provenance);
}

TEST(PipeGrasps, APlacedGraspStandsAcrossTheSection) {
  // Section 0 runs along x with y of its frame along the object's z: an angle of -pi/2 approaches along +y.
  const Grasp grasp = place_pipe_grasp(bend(), 0, 0.1, -kPi / 2, false);
  EXPECT_NEAR((grasp.T_object_hand.translation() - Vector3d(0.1, 0, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((grasp.T_object_hand.linear().col(0) - Vector3d::UnitY()).norm(), 0, 1e-15) << "approach";
  EXPECT_NEAR((grasp.T_object_hand.linear().col(1) - Vector3d::UnitZ()).norm(), 0, 1e-15) << "closing";
  EXPECT_DOUBLE_EQ(grasp.opening, 0.02);
  const Grasp top = place_pipe_grasp(bend(), 0, 0.1, kPi, false);
  EXPECT_NEAR((top.T_object_hand.linear().col(0) + Vector3d::UnitZ()).norm(), 0, 1e-15) << "from above";
  const Grasp flipped = place_pipe_grasp(bend(), 0, 0.1, kPi, true);
  const Pose half_turn(Eigen::AngleAxisd(kPi, Vector3d::UnitX()));
  EXPECT_TRUE(flipped.T_object_hand.isApprox(top.T_object_hand * half_turn, 1e-12));
}

TEST(PipeGrasps, AxesOfTheToolAreTheHands) {
  Hand gripper;
  gripper.tool_link = "tcp";
  gripper.approach = Vector3d::UnitZ();
  gripper.closing = Vector3d::UnitX();
  gripper.finger_width = 0.03;
  gripper.max_opening = 0.025;
  const PipeGraspOptions options = pipe_grasp_options(gripper);
  EXPECT_DOUBLE_EQ(options.end_margin, 0.015);
  const Grasp grasp = place_pipe_grasp(bend(), 1, 0.04, 0.7, true, options);
  const Vector3d along(0, 1, 0);
  EXPECT_NEAR(grasp.T_object_hand.linear().col(2).dot(along), 0, 1e-15);
  EXPECT_NEAR(grasp.T_object_hand.linear().col(0).dot(along), 0, 1e-15);
  EXPECT_NEAR(std::abs(grasp.T_object_hand.linear().col(1).dot(along)), 1, 1e-15) << "fingers stand along the pipe";
  EXPECT_NEAR(grasp.T_object_hand.linear().determinant(), 1, 1e-14);
  const SampledGrasps sampled = sample_pipe_grasps(bend(), 50, options);
  for (const Grasp& g : sampled.grasps) EXPECT_EQ(place_of(g).section, 0);
  EXPECT_EQ(sampled.too_wide, 1) << "0.03 m do not fit an opening of 0.025 m";
}

TEST(PipeGrasps, SamplesKeepTheirDistanceAndMargins) {
  PipeGraspOptions options;
  options.cost_per_metre = 2;
  const Pipe pipe = bend();
  const auto grasps = sample_pipe_grasps(pipe, 800, options).grasps;
  ASSERT_EQ(grasps.size(), 800u);
  int flipped = 0, on_long = 0;
  for (std::size_t i = 0; i < grasps.size(); ++i) {
    const Grasp& grasp = grasps[i];
    const PipeProvenance a = place_of(grasp);
    EXPECT_GE(a.length, 0.02);
    EXPECT_LE(a.length, pipe.length(a.section) - 0.02);
    EXPECT_GE(a.angle, -kPi);
    EXPECT_LT(a.angle, kPi);
    EXPECT_DOUBLE_EQ(grasp.opening, pipe.diameters[a.section]);
    EXPECT_NEAR(grasp.cost, 2 * (grasp.T_object_hand.translation() - pipe.centre_of_mass()).norm(), 1e-14);
    const Grasp again = place_pipe_grasp(pipe, a.section, a.length, a.angle, a.flipped, options);
    EXPECT_TRUE(grasp.T_object_hand.isApprox(again.T_object_hand, 1e-14));
    flipped += a.flipped;
    on_long += a.section == 0;
    for (std::size_t j = 0; j < i; ++j) {
      const PipeProvenance b = place_of(grasps[j]);
      if (a.section != b.section || a.flipped != b.flipped) continue;
      const double turn = std::abs(std::remainder(a.angle - b.angle, 2 * kPi));
      EXPECT_TRUE(std::abs(a.length - b.length) >= 0.01 || turn >= 5 * kPi / 180) << i << " and " << j;
    }
  }
  // Drawn in proportion 0.26 : 0.06 and 1 : 1; the shorter section fills up first. Five standard deviations.
  EXPECT_NEAR(flipped, 400, 5 * std::sqrt(200.0));
  EXPECT_GT(on_long, 800 * 0.26 / 0.32 - 5 * std::sqrt(800 * 0.8125 * 0.1875));
}

TEST(PipeGrasps, TheSeedDecidesAndMoreBeginsWithLess) {
  PipeGraspOptions options;
  const auto few = sample_pipe_grasps(bend(), 40, options).grasps,
             many = sample_pipe_grasps(bend(), 400, options).grasps;
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].T_object_hand.matrix(), many[i].T_object_hand.matrix());
  }
  options.seed = 2;
  EXPECT_NE(place_of(sample_pipe_grasps(bend(), 1, options).grasps[0]).length, place_of(few[0]).length);
}

TEST(PipeGrasps, AFullPipeGivesNoMore) {
  // 0.06 m along and a whole turn, 0.02 m and 90 degrees apart: at most 4 places along times 4 around, times 2 flips.
  Pipe pipe{{{0, 0, 0}, {0.06, 0, 0}}, {{0, 1}}, {0.02}};
  PipeGraspOptions options;
  options.end_margin = 0;
  options.length_spacing = 0.02;
  options.angle_spacing = kPi / 2;
  const auto grasps = sample_pipe_grasps(pipe, 1000, options).grasps;
  EXPECT_LE(grasps.size(), 32u);
  EXPECT_GE(grasps.size(), 8u);
  options.end_margin = 0.03;
  EXPECT_TRUE(sample_pipe_grasps(pipe, 1000, options).grasps.empty()) << "margins leave no room";
  EXPECT_TRUE(sample_pipe_grasps(pipe, 0).grasps.empty());
}

TEST(PipeGrasps, BadOptionsAreRefused) {
  const auto refused = [](auto change, const std::string& field) {
    PipeGraspOptions options;
    change(options);
    try {
      sample_pipe_grasps(bend(), 1, options);
      ADD_FAILURE() << field;
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).rfind(field + " = ", 0), 0u) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.approach = {1, 1, 0}; }, "approach");
  refused([](auto& o) { o.closing.setZero(); }, "closing");
  refused([](auto& o) { o.closing = {0.6, 0.8, 0}; }, "closing");
  refused([](auto& o) { o.max_opening = 0; }, "max_opening");
  refused([](auto& o) { o.end_margin = -1; }, "end_margin");
  refused([&](auto& o) { o.length_spacing = nan; }, "length_spacing");
  refused([](auto& o) { o.angle_spacing = 0; }, "angle_spacing");
  refused([](auto& o) { o.cost_per_metre = -1; }, "cost_per_metre");
  refused([](auto& o) { o.draws = 0; }, "draws");
  EXPECT_THROW(sample_pipe_grasps(bend(), -1), InvalidInput);
  EXPECT_THROW(place_pipe_grasp(bend(), 2, 0, 0, false), InvalidInput);
  EXPECT_THROW(place_pipe_grasp(bend(), 0, 0.31, 0, false), InvalidInput);
  EXPECT_THROW(place_pipe_grasp(bend(), 0, nan, 0, false), InvalidInput);
  EXPECT_THROW(place_pipe_grasp(bend(), 0, 0.1, nan, false), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
