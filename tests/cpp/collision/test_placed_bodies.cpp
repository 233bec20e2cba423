#include "mmgrasp/collision/detail/placed_bodies.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

LinkShape shape(const Shape& what, double x = 0) {
  LinkShape out;
  out.shape = what;
  out.T_link_shape.translation().x() = x;
  return out;
}

Pose at(double x, double y, double turn = 0) {
  return Pose(Eigen::Translation3d(x, y, 0) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
}

TEST(PlacedBodies, MeasuresTheNearestTwoShapes) {
  const PlacedBodies a({shape(Sphere{0.1}), shape(Box{Eigen::Vector3d(0.2, 0.2, 0.2)}, 1.0)}, {at(0, 0), at(0, 0)});
  const PlacedBodies b({shape(Sphere{0.2}), shape(Sphere{0.05})}, {at(3, 0), at(0, 4)});
  EXPECT_NEAR(a.distance(b, kAny), 3 - 1.1 - 0.2, 1e-9);
  EXPECT_NEAR(b.distance(a, kAny), 1.7, 1e-9);
}

TEST(PlacedBodies, TurnsShapesWithTheirBodies) {
  const PlacedBodies a({shape(Sphere{0.1}, 1.0)}, {at(0, 0, std::acos(-1.0) / 2)});
  const PlacedBodies b({shape(Sphere{0.1})}, {at(0, 2)});
  EXPECT_NEAR(a.distance(b, kAny), 0.8, 1e-9);
}

TEST(PlacedBodies, IsInfiniteFromTheBoundOn) {
  const PlacedBodies a({shape(Sphere{0.1})}, {at(0, 0)}), b({shape(Sphere{0.1})}, {at(1, 0)});
  EXPECT_EQ(a.distance(b, 0.79), kAny);
  EXPECT_NEAR(a.distance(b, 0.81), 0.8, 1e-9);
}

TEST(PlacedBodies, IsNegativeWhereTwoOverlap) {
  const PlacedBodies a({shape(Sphere{0.1})}, {at(0, 0)}), b({shape(Sphere{0.1})}, {at(0.15, 0)});
  EXPECT_NEAR(a.distance(b, 0.2), -0.05, 1e-9);
}

TEST(PlacedBodies, NothingIsNearNothing) {
  const PlacedBodies a({}, {}), b({shape(Sphere{0.1})}, {at(0, 0)});
  EXPECT_EQ(a.distance(b, kAny), kAny);
  EXPECT_EQ(b.distance(a, 1.0), kAny);
  EXPECT_THROW(PlacedBodies({shape(Sphere{0.1})}, {}), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp::detail
