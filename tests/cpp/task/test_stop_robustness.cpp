#include "task/part_supply/stop_robustness.hpp"

#include <gtest/gtest.h>

namespace mmgrasp::detail {
namespace {

TEST(StopRobustness, EveryStopIsJudgedByItself) {
  RobustnessResult result;
  EXPECT_EQ(result.rate(), 1.0);
  for (int stop = 0; stop < 10; ++stop) result.stops.push_back({1000, 1000});
  EXPECT_EQ(result.rate(), 1.0);
  result.stops[7].good = 991;  // 0.9991 of all poses are good
  EXPECT_EQ(result.worst_stop(), 7u);
  EXPECT_DOUBLE_EQ(result.rate(), 0.991);
  result.stops[3] = {0, 0};  // none drawn
  EXPECT_DOUBLE_EQ(result.rate(), 0.991);
}

}  // namespace
}  // namespace mmgrasp::detail
