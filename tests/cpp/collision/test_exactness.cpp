// The checker's answers against FCL's for six robots in five kinds of scene. MMGRASP_EXACTNESS_QUERIES=100000 asks
// that many instead of 5,000; benchmarks/core/bench_exactness.cpp does so and lists the counts.

#include <gtest/gtest.h>

#include <cstdlib>

#include "support/exactness.hpp"

using namespace mmgrasp;

TEST(Exactness, SixRobotsInFiveScenesAgreeWithFcl) {
  MMGRASP_NEEDS_SHARED_DATA();
  const char* wish = std::getenv("MMGRASP_EXACTNESS_QUERIES");
  const int queries = wish ? std::atoi(wish) : 5000;
  exactness::Count count;
  unsigned seed = 1;
  for (const testing_support::MeshArm& arm : exactness::six_arms()) {
    for (const exactness::Scene& scene : exactness::scenes(arm)) {
      exactness::Count here;
      exactness::compare(arm, scene, queries / 30, seed++, here);
      EXPECT_GT(here.free, queries / 600) << arm.name << ", " << scene.name;
      EXPECT_GT(here.scene, queries / 1500) << arm.name << ", " << scene.name;
      for (const std::string& line : here.wrong) ADD_FAILURE() << line;
      count.free += here.free;
      count.self += here.self;
      count.scene += here.scene;
      count.band.insert(count.band.end(), here.band.begin(), here.band.end());
    }
  }
  std::printf("agreement with FCL: %d free, %d self, %d scene, %zu in the 1e-6 m band\n", count.free, count.self,
              count.scene, count.band.size());
  for (const std::string& line : count.band) std::printf("  %s\n", line.c_str());
  EXPECT_LT(count.band.size(), 5u);
}
