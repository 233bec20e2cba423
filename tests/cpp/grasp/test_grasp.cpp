#include "mmgrasp/grasp/grasp.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/grasp/sample_grasps.hpp"
#include "support/tray_scene.hpp"

namespace mmgrasp {
namespace {

TEST(Grasp, QualityIsTheProductOfItsFactors) {
  Grasp grasp;
  grasp.set_quality({{"contact", 0.8, 1}, {"depth", 0.5, 0.5}, {"ignored", 0, 0}});
  EXPECT_DOUBLE_EQ(grasp.quality, 0.8 * 0.75);
  EXPECT_EQ(grasp.quality_factors.size(), 3u);
  grasp.set_quality({});
  EXPECT_EQ(grasp.quality, 1);
}

/// The formula of each sampler before its factors had names, factor by factor.
TEST(Grasp, SamplersGiveTheirFactorsInOrder) {
  const Hand hand = tray_scene::gripper();
  for (const Grasp& grasp : sample_grasps({tray_scene::at(Box{{0.04, 0.05, 0.06}})}, hand).grasps) {
    ASSERT_EQ(grasp.quality_factors.size(), 5u);
    double product = 1;
    for (const QualityFactor& one : grasp.quality_factors) product *= 0.5 + 0.5 * one.value;
    EXPECT_EQ(grasp.quality, product);
    EXPECT_EQ(grasp.quality_factors[4].name, "clearance");
    EXPECT_DOUBLE_EQ(grasp.quality_factors[4].value,
                     std::min(1.0, (hand.max_opening - grasp.opening) / 2 / hand.clearance));
    EXPECT_TRUE(std::holds_alternative<ContactPairProvenance>(grasp.provenance));
  }
}

TEST(Grasp, ThousandsFitIntoMemory) {
  EXPECT_LE(sizeof(Grasp), 288u);
}

}  // namespace
}  // namespace mmgrasp
