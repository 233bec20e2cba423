// The winding that edges round an axis have, told by a transform, against trying every one; and long threaded rods.
#include "geometry/segmentation/unwinding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/segmentation/find_threads.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

double tried_one_by_one(const std::vector<detail::HelixTurn>& turns, double least, double most, double step) {
  double best = 0, coherent = -1;
  for (int k = 0; least + k * step <= most; ++k) {
    for (const double tried : {least + k * step, -(least + k * step)}) {
      const double found = std::abs(detail::unwound(turns, tried));
      if (found <= coherent) continue;
      coherent = found;
      best = tried;
    }
  }
  return best;
}

TEST(Unwinding, EqualsTryingEveryWinding) {
  Rng rng(3);
  for (int trial = 0; trial < 30; ++trial) {
    const double winding = (trial % 2 ? -1 : 1) * rng.uniform(300, 6000), noise = 0.05 * trial;
    std::vector<detail::HelixTurn> turns;
    for (int i = 0; i < 400; ++i) {
      const double height = rng.uniform(-0.03, 0.05);
      turns.push_back({winding * height + noise * rng.normal(), height, rng.uniform(1e-4, 1e-3), i});
    }
    const double least = 250, most = 6500, step = 1 / 0.08;
    const double found = detail::longest_unwound(turns, least, most, step);
    const double wanted = tried_one_by_one(turns, least, most, step);
    EXPECT_NEAR(found, wanted, 1e-6) << trial;
    if (noise < 1) {
      EXPECT_NEAR(found, winding, step) << trial;
    }
  }
}

/// A rod of `turns` turns of a right-handed thread of 1 mm, without ends: root and crest, `sides` edges a turn.
TriangleMesh threaded_rod(int sides, int turns) {
  constexpr double kPitch = 1e-3, kRoot = 0.0034, kCrest = 0.004;
  TriangleMesh mesh;
  const auto at = [](double radius, double turn, double height) {
    return Eigen::Vector3d(radius * std::cos(2 * M_PI * turn), radius * std::sin(2 * M_PI * turn), height);
  };
  const int edges = sides * turns;
  for (int j = 0; j <= edges + sides; ++j)
    mesh.vertices.push_back(at(kRoot, static_cast<double>(j) / sides, kPitch * j / sides));
  const int crest = static_cast<int>(mesh.vertices.size());
  for (int j = 0; j <= edges; ++j)
    mesh.vertices.push_back(
        at(kCrest, static_cast<double>(j) / sides, kPitch * (static_cast<double>(j) / sides + 0.5)));
  for (int j = 0; j < edges; ++j) {
    mesh.triangles.push_back({j, j + 1, crest + j + 1});
    mesh.triangles.push_back({j, crest + j + 1, crest + j});
    mesh.triangles.push_back({crest + j, crest + j + 1, j + 1 + sides});
    mesh.triangles.push_back({crest + j, j + 1 + sides, j + sides});
  }
  return mesh;
}

TEST(FindThreads, OfALongRodIsOne) {
  const std::vector<ScrewThread> found = detail::find_threads(threaded_rod(48, 300));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].pitch, 1e-3, 1e-6);
  EXPECT_NEAR(found[0].root_radius, 0.0034, 1e-9);
  EXPECT_NEAR(found[0].crest_radius, 0.004, 1e-9);
  EXPECT_NEAR(found[0].length, 0.3, 0.002);
}

TEST(FindThreads, EndWhenInterrupted) {
  CancelToken stop;
  stop.stop();
  const TriangleMesh rod = threaded_rod(24, 20);
  const detail::InterruptionScope scope(stop);
  EXPECT_THROW(detail::find_threads(rod), detail::Interrupted);
}

}  // namespace
}  // namespace mmgrasp
