#include "plan/manipulation/common/informed_union.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "mmgrasp/core/detail/numbers.hpp"
#include "support/around.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

GraspCandidate candidate(std::vector<VectorXd> starts, std::vector<VectorXd> goals, double cost = 0) {
  GraspCandidate out;
  out.starts = std::move(starts);
  out.goals = std::move(goals);
  out.cost = cost;
  return out;
}

/// Upper quantile of the chi-squared distribution at 1e-4 (Wilson and Hilferty).
double chi_squared_bound(double k) {
  const double z = 3.719;
  return k * std::pow(1 - 2 / (9 * k) + z * std::sqrt(2 / (9 * k)), 3);
}

/// Overlapping ellipses that leave the box, a ball (equal ends), a grasp with two pairs and one out of reach.
GraspEnds crossing_ellipses() {
  return GraspEnds({candidate({Vector2d(-1, 0)}, {Vector2d(1, 0)}), candidate({Vector2d(0, -1)}, {Vector2d(0, 1)}),
                    candidate({Vector2d(-0.9, 0.1)}, {Vector2d(1.1, 0.1)}),
                    candidate({Vector2d(1.5, 1.2)}, {Vector2d(1.5, 1.2)}, 1.0),
                    candidate({Vector2d(-1.6, -1), Vector2d(-1.5, -0.5)}, {Vector2d(-1.6, 1)}),
                    candidate({Vector2d(-2, -2)}, {Vector2d(2, 2)})});
}

struct Cells {
  static constexpr int kSide = 24;
  Vector2d lower{-2, -2}, upper{2, 2};
  int cell(const double* q) const {
    const int x = static_cast<int>((q[0] - lower[0]) / (upper[0] - lower[0]) * kSide);
    const int y = static_cast<int>((q[1] - lower[1]) / (upper[1] - lower[1]) * kSide);
    return x * kSide + y;
  }
  /// Share of each cell that `inside` covers, on a fine grid.
  template <class Inside>
  std::vector<double> shares(const Inside& inside) const {
    constexpr int kFine = 40;
    std::vector<double> out(kSide * kSide, 0);
    for (int i = 0; i < kSide * kFine; ++i)
      for (int j = 0; j < kSide * kFine; ++j) {
        const Vector2d q(lower[0] + (upper[0] - lower[0]) * (i + 0.5) / (kSide * kFine),
                         lower[1] + (upper[1] - lower[1]) * (j + 0.5) / (kSide * kFine));
        if (inside(q)) out[cell(q.data())] += 1;
      }
    return out;
  }
};

/// Chi-squared statistic of counts against expected shares, and its bound. Cells that expect few are put together.
std::pair<double, double> chi_squared(const std::vector<double>& shares, const std::vector<int>& counts) {
  double all = 0, drawn = 0;
  for (const double share : shares) all += share;
  for (const int count : counts) drawn += count;
  double sum = 0, expected = 0, seen = 0;
  int bins = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    expected += shares[i] / all * drawn;
    seen += counts[i];
    if (expected < 20) continue;
    sum += (seen - expected) * (seen - expected) / expected;
    ++bins;
    expected = seen = 0;
  }
  return {sum, chi_squared_bound(bins - 1)};
}

double length_over(const Vector2d& a, const Vector2d& q, const Vector2d& b) {
  return (q - a).norm() + (b - q).norm();
}

// Written out by hand, apart from the code under test.
bool in_crossing_ellipses(const Vector2d& q, double c, int grasp) {
  switch (grasp) {
    case 0:
      return length_over({-1, 0}, q, {1, 0}) < c;
    case 1:
      return length_over({0, -1}, q, {0, 1}) < c;
    case 2:
      return length_over({-0.9, 0.1}, q, {1.1, 0.1}) < c;
    case 3:
      return 2 * (q - Vector2d(1.5, 1.2)).norm() + 1 < c;
    case 4:
      return length_over({-1.6, -1}, q, {-1.6, 1}) < c || length_over({-1.5, -0.5}, q, {-1.6, 1}) < c;
    default:
      return length_over({-2, -2}, q, {2, 2}) < c;
  }
}

class UnionOf : public ::testing::TestWithParam<double> {};

TEST_P(UnionOf, EllipsesIsDrawnUniformly) {
  const double c = GetParam();
  const GraspEnds ends = crossing_ellipses();
  const Cells cells;
  InformedUnion drawn(ends, cells.lower, cells.upper);
  drawn.set_cost(c);
  Rng rng(5);
  std::vector<int> counts(Cells::kSide * Cells::kSide, 0);
  for (int i = 0; i < 200000; ++i) {
    Vector2d q;
    const int grasp = drawn.draw(rng, q.data());
    ASSERT_GE(grasp, 0);
    ASSERT_TRUE((q.array() >= cells.lower.array()).all() && (q.array() <= cells.upper.array()).all());
    ASSERT_TRUE(drawn.contains(grasp, q.data()));
    ++counts[cells.cell(q.data())];
  }
  const auto shares = cells.shares([&](const Vector2d& q) {
    for (int g = 0; g < 6; ++g)
      if (in_crossing_ellipses(q, c, g)) return true;
    return false;
  });
  const auto [statistic, bound] = chi_squared(shares, counts);
  EXPECT_LT(statistic, bound);
  if (c > 10) return;  // Every ellipse covers the box.
  // The test is sharp enough: draws that are not thinned where ellipses overlap fail it by far.
  std::vector<int> thick(counts.size(), 0);
  const auto overlaps = [&](const Vector2d& q) {
    int count = 0;
    for (int g = 0; g < 6; ++g) count += in_crossing_ellipses(q, c, g);
    return count;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const Vector2d middle(cells.lower[0] + (static_cast<double>(i / Cells::kSide) + 0.5) * 4 / Cells::kSide,
                          cells.lower[1] + (static_cast<double>(i % Cells::kSide) + 0.5) * 4 / Cells::kSide);
    thick[i] = counts[i] * std::max(1, overlaps(middle));
  }
  const auto [wrong, wrong_bound] = chi_squared(shares, thick);
  EXPECT_GT(wrong, 10 * wrong_bound);
}

// Few overlaps; many; and wider than the box, which is then drawn from directly.
INSTANTIATE_TEST_SUITE_P(Costs, UnionOf, ::testing::Values(2.15, 2.6, 4.5, 30.0));

/// The first value is an angle: a pair across the seam, one half a turn apart, overlapping ones, and equal ends.
GraspEnds ellipses_around(const VectorXd& weights) {
  std::vector<GraspCandidate> all{candidate({Vector2d(2.8, 0.2)}, {Vector2d(-2.6, -0.1)}),
                                  candidate({Vector2d(-1.4, -1)}, {Vector2d(1.8, -1)}),
                                  candidate({Vector2d(2.5, 0), Vector2d(3, 0.8)}, {Vector2d(-2.9, 0.3)}, 0.2),
                                  candidate({Vector2d(0.3, 1.2)}, {Vector2d(0.3, 1.2)}, 1.0)};
  for (GraspCandidate& each : all) each.metric = JointMetric({true, false}, weights);
  return GraspEnds(all);
}

bool in_ellipses_around(const Vector2d& q, double c, const VectorXd& weights) {
  const auto through = [&](const Vector2d& a, const Vector2d& b) {
    const std::vector<bool> wraps{true, false};
    return test::distance_around(wraps, a, q, weights) + test::distance_around(wraps, q, b, weights);
  };
  return through({2.8, 0.2}, {-2.6, -0.1}) < c || through({-1.4, -1}, {1.8, -1}) < c ||
         through({2.5, 0}, {-2.9, 0.3}) + 0.2 < c || through({3, 0.8}, {-2.9, 0.3}) + 0.2 < c ||
         through({0.3, 1.2}, {0.3, 1.2}) + 1 < c;
}

/// The cost to beat, and the weights of both values.
class UnionAround : public ::testing::TestWithParam<std::tuple<double, double, double>> {};

TEST_P(UnionAround, TheSeamIsDrawnUniformly) {
  const double c = std::get<0>(GetParam());
  const Vector2d weights(std::get<1>(GetParam()), std::get<2>(GetParam()));
  const GraspEnds ends = ellipses_around(weights == Vector2d(1, 1) ? VectorXd() : VectorXd(weights));
  Cells cells;
  cells.lower = Vector2d(-kPi, -2);
  cells.upper = Vector2d(kPi, 2);
  InformedUnion drawn(ends, cells.lower, cells.upper);
  drawn.set_cost(c);
  Rng rng(5);
  std::vector<int> counts(Cells::kSide * Cells::kSide, 0);
  int beyond[2] = {0, 0};
  for (int i = 0; i < 200000; ++i) {
    Vector2d q;
    const int grasp = drawn.draw(rng, q.data());
    ASSERT_GE(grasp, 0);
    ASSERT_TRUE((q.array() >= cells.lower.array()).all() && (q.array() <= cells.upper.array()).all());
    ASSERT_TRUE(drawn.contains(grasp, q.data()));
    ++counts[std::min(cells.cell(q.data()), Cells::kSide * Cells::kSide - 1)];
    if (std::abs(q[0]) > 2.9) ++beyond[q[0] > 0];
  }
  const auto shares = cells.shares([&](const Vector2d& q) { return in_ellipses_around(q, c, weights); });
  const auto [statistic, bound] = chi_squared(shares, counts);
  EXPECT_LT(statistic, bound);
  EXPECT_GT(std::min(beyond[0], beyond[1]), 1000);
  double area = 0, all = 0;
  for (const double share : shares) area += share, all += 1600;
  // The sum over the images of the ellipses, or the whole of the bounds: never less than the union.
  EXPECT_GE(drawn.volume() * (1 + 1e-3), area / all * 8 * kPi * weights.prod());
}

// Below half a turn; where both ways round to the goal have an ellipse (they overlap); nearly everything.
INSTANTIATE_TEST_SUITE_P(Costs, UnionAround,
                         ::testing::Values(std::tuple(1.2, 1, 1), std::tuple(3.4, 1, 1), std::tuple(4.6, 1, 1),
                                           std::tuple(6.4, 1, 1), std::tuple(1.3, 0.8, 1.5), std::tuple(4.6, 0.8, 1.5),
                                           std::tuple(6.4, 1.5, 0.4)));

TEST(InformedUnion, ThePrintedCrossRadiusWouldBeWrong) {
  // One ellipse: mean square across the long axis is (c^2 - c_min^2) / 4 / (d + 2) in d dimensions; with the printed
  // sqrt(c - c_min) it would be (c - c_min) / 4 / (d + 2).
  const int d = 6;
  VectorXd a = VectorXd::Zero(d), b = VectorXd::Zero(d);
  b << 1, -0.5, 0.3, 0.2, 0.8, -1;
  const double c_min = b.norm(), c = 2 * c_min;
  const GraspEnds ends({candidate({a}, {b})});
  InformedUnion drawn(ends, VectorXd::Constant(d, -20), VectorXd::Constant(d, 20));
  drawn.set_cost(c);
  Rng rng(2);
  double across = 0, along = 0;
  const int count = 100000;
  VectorXd q(d), mean = VectorXd::Zero(d);
  for (int i = 0; i < count; ++i) {
    ASSERT_EQ(drawn.draw(rng, q.data()), 0);
    const VectorXd off = q - 0.5 * b;
    const double axial = off.dot(b) / c_min;
    along += axial * axial / count;
    across += (off.squaredNorm() - axial * axial) / (d - 1) / count;
    mean += q / count;
  }
  EXPECT_NEAR(along, c * c / 4 / (d + 2), 0.02 * c * c / 4 / (d + 2));
  EXPECT_NEAR(across, (c * c - c_min * c_min) / 4 / (d + 2), 0.02 * (c * c - c_min * c_min) / 4 / (d + 2));
  EXPECT_LT((mean - 0.5 * b).norm(), 0.02);
}

TEST(InformedUnion, GraspsThatContainADrawAreEquallyLikely) {
  // Two pairs of the second grasp and one of the first are the same ellipse: two draws in three are the second's.
  const GraspEnds ends({candidate({Vector2d(-1, 0)}, {Vector2d(1, 0)}),
                        candidate({Vector2d(-1, 0), Vector2d(-1, 0)}, {Vector2d(1, 0)})});
  InformedUnion drawn(ends, Vector2d(-3, -3), Vector2d(3, 3));
  for (const double c : {2.5, 40.0}) {
    drawn.set_cost(c);
    Rng rng(3);
    int second = 0;
    for (int i = 0; i < 30000; ++i) {
      Vector2d q;
      second += drawn.draw(rng, q.data()) == 1;
    }
    EXPECT_NEAR(second / 30000.0, 2.0 / 3, 0.012) << c;
  }
}

TEST(InformedUnion, DrawsAroundAGraspStayNearItsLine) {
  const GraspEnds ends = crossing_ellipses();
  InformedUnion drawn(ends, Vector2d(-2, -2), Vector2d(2, 2));
  Rng rng(1);
  for (int grasp = 0; grasp < ends.size(); ++grasp)
    for (int i = 0; i < 500; ++i) {
      Vector2d q;
      drawn.draw_around(rng, grasp, 1.3, q.data());
      EXPECT_LE(q.cwiseAbs().maxCoeff(), 2);
      // The longest straight line of any pair is twice the root of eight; what leaves the box is set back to its
      // border.
      EXPECT_LT(ends.estimate(grasp, q.data()) - ends.cost(grasp), 1.3 * std::sqrt(32.0) + 0.11);
      if (grasp == 0) {
        EXPECT_LT(2 * (q - Vector2d(1.5, 1.2)).norm(), 0.1 + 1e-9);
      }
    }
}

TEST(InformedUnion, NothingIsDrawnWhereNothingCanBeBetter) {
  const GraspEnds ends = crossing_ellipses();
  InformedUnion drawn(ends, Vector2d(-2, -2), Vector2d(2, 2));
  Rng rng(1);
  Vector2d q;
  EXPECT_EQ(drawn.grasps(), 6);
  std::map<int, int> seen;
  for (int i = 0; i < 600; ++i) ++seen[drawn.draw(rng, q.data())];
  EXPECT_EQ(seen.size(), 6u);  // No path yet: the whole box, every grasp.
  drawn.set_cost(2.05);
  EXPECT_EQ(drawn.grasps(), 5);
  drawn.set_cost(1.5);  // Grasp 3 costs 1 by itself and moves nowhere; grasp 4's shorter pair is 1.503 long.
  EXPECT_EQ(drawn.grasps(), 1);
  EXPECT_EQ(drawn.draw(rng, q.data()), 0);
  EXPECT_EQ(ends.cost(0), 1);
  drawn.set_cost(1.0);
  EXPECT_EQ(drawn.grasps(), 0);
  EXPECT_EQ(drawn.draw(rng, q.data()), -1);
}

/// An ellipse of axes c and sqrt(c^2 - c_min^2), a ball, and a pair that the cost drops.
TEST(InformedUnion, VolumesAreThoseOfTheEllipsoids) {
  const GraspEnds ends({candidate({Vector2d(-1, 0)}, {Vector2d(1, 0)}), candidate({Vector2d(0, 5)}, {Vector2d(0, 5)}),
                        candidate({Vector2d(-1, -5), Vector2d(-1, -5.5)}, {Vector2d(1, -5)})});
  InformedUnion informed(ends, Vector2d(-10, -10), Vector2d(10, 10));
  EXPECT_DOUBLE_EQ(informed.volume(), 400);
  EXPECT_DOUBLE_EQ(informed.volume(2), 400);
  informed.set_cost(2.03);  // The third grasp's second pair is farther apart.
  const double ellipse = M_PI / 4 * 2.03 * std::sqrt(2.03 * 2.03 - 4), ball = M_PI / 4 * 2.03 * 2.03;
  // Grasps are in the order of their straight lines: the ball's first.
  EXPECT_NEAR(informed.volume(0), ball, 1e-12);
  EXPECT_NEAR(informed.volume(1), ellipse, 1e-12);
  EXPECT_NEAR(informed.volume(2), ellipse, 1e-12);
  EXPECT_NEAR(informed.volume(), ball + 2 * ellipse, 1e-12);
  informed.set_cost(1);
  EXPECT_EQ(informed.volume(2), 0);
  InformedUnion small(ends, Vector2d(-0.1, -0.1), Vector2d(0.1, 0.1));
  small.set_cost(9);
  EXPECT_DOUBLE_EQ(small.volume(0), 0.04);
}

}  // namespace
}  // namespace mmgrasp::detail
