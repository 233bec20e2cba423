#include "task/part_supply/arrivals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mmgrasp/core/error.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp::detail {
namespace {

class Arrivals : public test::SmallRegions {
 protected:
  static PartSupplyProblem with(const Eigen::Vector3d& deviations) {
    PartSupplyProblem problem = *problem_;
    problem.arrival_covariance = deviations.cwiseAbs2().asDiagonal();
    problem.options.positioning_uncertainty = 0.02;
    problem.options.robustness_samples = 100;
    return problem;
  }
  static std::vector<Stop> stops(const PartSupplyProblem& problem) {
    StopOptions options;
    options.min_radius = problem.options.positioning_uncertainty;
    return plan_stops_exact(*grid_, *regions_, options).stops;
  }
  /// The same question, with the standard library's normal numbers and the evaluator alone.
  static double share(const PartSupplyProblem& problem, const Stop& stop, int count) {
    BasePoseEvaluator evaluator(problem, *database_);
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    int good = 0;
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d pose = stop.pose;
      for (int k = 0; k < 3; ++k) pose[k] += std::sqrt(problem.arrival_covariance(k, k)) * normal(random);
      bool all = evaluator.home(pose) == Rejection::none;
      for (const TrayId tray : stop.trays) {
        for (int part = 0; part < static_cast<int>(problem.trays[tray].parts.size()) && all; ++part)
          all = evaluator.part_with_restarts(pose, {tray, part});
      }
      good += all;
    }
    return static_cast<double>(good) / count;
  }
};

TEST_F(Arrivals, ShareIsThatOfNormallyDistributedPoses) {
  const PartSupplyProblem problem = with({0.25, 0.20, 0.5});
  const std::vector<Stop> chosen = stops(problem);
  ASSERT_FALSE(chosen.empty());
  const BasePoseEvaluator evaluator(problem, *database_);
  const StopSamples seen = count_arrivals(problem, evaluator, chosen, 1500, true, {});
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    ASSERT_EQ(seen.stops[i].samples, 1500u);
    const double expected = share(problem, chosen[i], 1500), rate = seen.stops[i].rate();
    EXPECT_GT(rate, 0.05);
    EXPECT_LT(rate, 0.98);
    EXPECT_NEAR(rate, expected, 4.5 * std::sqrt(2 * 0.25 / 1500));
  }
}

TEST_F(Arrivals, NoErrorIsNoMiss) {
  const PartSupplyProblem problem = with({1e-9, 0, 0});
  const BasePoseEvaluator evaluator(problem, *database_);
  for (const StopShare& stop : count_arrivals(problem, evaluator, stops(problem), 40, true, {}).stops)
    EXPECT_EQ(stop.good, stop.samples);
}

/// An error that lies along a slanting line only: what is drawn does so, too.
TEST_F(Arrivals, CorrelationIsKept) {
  PartSupplyProblem problem = with({0, 0, 0});
  problem.arrival_covariance << 0.04, -0.02, 0, -0.02, 0.01, 0, 0, 0, 0;
  problem.check();
  const BasePoseEvaluator evaluator(problem, *database_);
  const std::vector<Stop> chosen = stops(problem);
  const StopSamples seen = count_arrivals(problem, evaluator, chosen, 200, true, {});
  int misses = 0;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    for (const Miss& miss : seen.misses[i]) {
      const Eigen::Vector3d error = miss.pose - chosen[i].pose;
      EXPECT_NEAR(error.x() + 2 * error.y(), 0, 1e-7);
      EXPECT_EQ(error.z(), 0);
      ++misses;
    }
  }
  EXPECT_GT(misses, 20);
}

/// Every cell's middle that may be the stop is tried with the same arrivals: none is better by more than chance.
TEST_F(Arrivals, NoOtherMiddleOfACellIsLikelier) {
  const PartSupplyProblem problem = with({0.2, 0.15, 0.3});
  std::vector<Stop> chosen = stops(problem);
  const std::vector<Stop> before = chosen;
  const BasePoseEvaluator evaluator(problem, *database_);
  seek_likely_poses(problem, evaluator, *grid_, *regions_, chosen, 0.999, {});
  const StopSamples first = count_arrivals(problem, evaluator, before, 800, false, {});
  const StopSamples now = count_arrivals(problem, evaluator, chosen, 800, false, {});
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    EXPECT_EQ(chosen[i].trays, before[i].trays);
    EXPECT_GE(now.stops[i].good, first.stops[i].good);
    const int layer = static_cast<int>(std::find(grid_->headings.begin(), grid_->headings.end(), before[i].pose.z()) -
                                       grid_->headings.begin());
    ASSERT_LT(layer, static_cast<int>(grid_->headings.size()));
    std::vector<Stop> places;
    for (int iy = 0; iy < grid_->ny; ++iy) {
      for (int ix = 0; ix < grid_->nx; ++ix) {
        bool shared = true;
        for (const TrayId tray : before[i].trays)
          shared = shared && (*regions_)[tray].cells[grid_->index(layer, ix, iy)] != 0;
        if (!shared) continue;
        places.push_back(before[i]);
        places.back().pose = grid_->centre(layer, ix, iy);
      }
    }
    ASSERT_GT(places.size(), 10u);
    const StopSamples all = count_arrivals(problem, evaluator, places, 400, false, {});
    for (const StopShare& other : all.stops) EXPECT_LE(other.rate(), now.stops[i].rate() + 0.06);
  }
}

TEST_F(Arrivals, TheSameAtAnyThreadCount) {
  PartSupplyProblem problem = with({0.08, 0.08, 0.1});
  std::vector<std::vector<Stop>> chosen;
  for (const int threads : {1, 3}) {
    problem.options.threads = threads;
    chosen.push_back(stops(problem));
    const BasePoseEvaluator evaluator(problem, *database_);
    seek_likely_poses(problem, evaluator, *grid_, *regions_, chosen.back(), 0.999, {});
  }
  ASSERT_EQ(chosen[0].size(), chosen[1].size());
  for (std::size_t i = 0; i < chosen[0].size(); ++i) EXPECT_EQ(chosen[0][i].pose, chosen[1][i].pose);
}

TEST(ArrivalCovariance, MustBeOne) {
  Eigen::Matrix3d covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
  EXPECT_NO_THROW(check_arrival_covariance(covariance));
  EXPECT_NO_THROW(check_arrival_covariance(Eigen::Matrix3d::Zero()));
  covariance(0, 1) = 0.001;
  EXPECT_THROW(check_arrival_covariance(covariance), InvalidInput) << "not symmetric";
  covariance(0, 1) = covariance(1, 0) = 0.02;
  EXPECT_THROW(check_arrival_covariance(covariance), InvalidInput) << "correlation of 2";
  covariance = Eigen::Vector3d(0.01, -1e-6, 0).asDiagonal();
  EXPECT_THROW(check_arrival_covariance(covariance), InvalidInput) << "negative variance";
  covariance = Eigen::Vector3d(25, 25, 4).asDiagonal();
  EXPECT_THROW(check_arrival_covariance(covariance), InvalidInput) << "centimetres and degrees";
  covariance = Eigen::Vector3d(0.01, std::nan(""), 0).asDiagonal();
  EXPECT_THROW(check_arrival_covariance(covariance), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp::detail
