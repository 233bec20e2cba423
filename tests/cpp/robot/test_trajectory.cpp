#include "mmgrasp/robot/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;

namespace {

Eigen::VectorXd pair(double a, double b) {
  return Eigen::Vector2d(a, b);
}

/// Samples of a cubic and a parabola, which Hermite interpolation reproduces.
JointTrajectory cubic() {
  JointTrajectory trajectory;
  trajectory.names = {"a", "b"};
  for (const double t : {0.0, 0.5, 1.75, 2.0}) {
    trajectory.times.push_back(t);
    trajectory.positions.push_back(pair(1 + 2 * t - t * t * t, t * t));
    trajectory.velocities.push_back(pair(2 - 3 * t * t, 2 * t));
    trajectory.accelerations.push_back(pair(-6 * t, 2));
  }
  return trajectory;
}

}  // namespace

TEST(JointPath, LengthSumsJointDistances) {
  JointPath path;
  EXPECT_EQ(path.length(), 0);
  path.waypoints = {pair(0, 0), pair(3, 4), pair(3, 5)};
  EXPECT_NEAR(path.length(), 6, 1e-15);
}

TEST(JointTrajectory, HermiteReproducesCubicsAndClamps) {
  const JointTrajectory trajectory = cubic();
  EXPECT_EQ(trajectory.duration(), 2.0);
  for (double t = 0; t <= 2.0; t += 0.01)
    EXPECT_LT((trajectory.at(t) - pair(1 + 2 * t - t * t * t, t * t)).norm(), 1e-14);
  EXPECT_EQ(trajectory.at(-1), trajectory.positions.front());
  EXPECT_EQ(trajectory.at(3), trajectory.positions.back());
  EXPECT_EQ(trajectory.at(0.5), trajectory.positions[1]);
  EXPECT_THROW(JointTrajectory().at(0), InvalidInput);
  EXPECT_EQ(JointTrajectory().duration(), 0.0);
}

TEST(JointTrajectory, CsvReadsBackExactly) {
  const JointTrajectory trajectory = cubic();
  std::istringstream csv(trajectory.to_csv());
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "time,a,b,a.velocity,b.velocity,a.acceleration,b.acceleration");
  for (std::size_t row = 0; row < trajectory.times.size(); ++row) {
    ASSERT_TRUE(std::getline(csv, line));
    std::istringstream cells(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
    ASSERT_EQ(numbers.size(), 7u);
    EXPECT_EQ(numbers[0], trajectory.times[row]);
    EXPECT_EQ(pair(numbers[1], numbers[2]), trajectory.positions[row]);
    EXPECT_EQ(pair(numbers[3], numbers[4]), trajectory.velocities[row]);
    EXPECT_EQ(pair(numbers[5], numbers[6]), trajectory.accelerations[row]);
  }
  EXPECT_FALSE(std::getline(csv, line));
}
