#include "mmgrasp/robot/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

/// 17 significant digits, in any locale.
void append_number(std::string& text, double value) {
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::general, 17).ptr;
  text.append(digits, end);
}

void append_row(std::string& text, const Eigen::VectorXd& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += ',';
    append_number(text, values[i]);
  }
}

}  // namespace

double JointPath::length() const {
  double sum = 0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) sum += (waypoints[i] - waypoints[i - 1]).norm();
  return sum;
}

Eigen::VectorXd JointTrajectory::at(double time) const {
  if (times.empty()) throw InvalidInput("trajectory times = []: must hold at least one sample");
  require_number(time, "time", "s");
  if (time <= times.front()) return positions.front();
  if (time >= times.back()) return positions.back();
  const auto upper = std::upper_bound(times.begin(), times.end(), time);
  const std::size_t b = upper - times.begin(), a = b - 1;
  const double h = times[b] - times[a];
  const double s = (time - times[a]) / h;
  if (velocities.size() != positions.size()) return (1 - s) * positions[a] + s * positions[b];
  // Hermite basis; written around the end values so that both ends come out exactly.
  const double blend = s * s * (3 - 2 * s);
  const double start_slope = s * (1 - s) * (1 - s), end_slope = s * s * (s - 1);
  return (1 - blend) * positions[a] + blend * positions[b] +
         h * (start_slope * velocities[a] + end_slope * velocities[b]);
}

std::string JointTrajectory::to_csv() const {
  std::string text = "time";
  for (const char* suffix : {"", ".velocity", ".acceleration"})
    for (const std::string& name : names) text += "," + name + suffix;
  text += "\n";
  const Eigen::VectorXd zeros = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < times.size(); ++i) {
    detail::throw_if_interrupted();
    append_number(text, times[i]);
    append_row(text, positions[i]);
    append_row(text, i < velocities.size() ? velocities[i] : zeros);
    append_row(text, i < accelerations.size() ? accelerations[i] : zeros);
    text += "\n";
  }
  return text;
}

}  // namespace mmgrasp
