#include "mmgrasp/structure/pipe_grasps.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Columns: approach, closing, and what makes them right-handed.
Matrix3d hand_axes(const Vector3d& approach, const Vector3d& closing) {
  Matrix3d axes;
  axes << approach, closing, approach.cross(closing);
  return axes;
}

/// Grasps of one section and flip so far, in slices of the section as long as the spacing: whatever is too near lies in
/// the same slice or a neighbouring one.
class Spacing {
 public:
  Spacing(double section_length, const PipeGraspOptions& options)
      : length_spacing_(options.length_spacing),
        angle_spacing_(options.angle_spacing),
        slices_(static_cast<std::size_t>(section_length / options.length_spacing) + 1) {}

  /// False when another is too near; otherwise it is remembered.
  bool take(double length, double angle) {
    const auto slice = std::min(static_cast<std::size_t>(length / length_spacing_), slices_.size() - 1);
    const std::size_t first = slice == 0 ? 0 : slice - 1, last = std::min(slice + 1, slices_.size() - 1);
    for (std::size_t i = first; i <= last; ++i) {
      for (const auto& [other_length, other_angle] : slices_[i]) {
        if (std::abs(other_length - length) < length_spacing_ &&
            std::abs(wrap_angle(other_angle - angle)) < angle_spacing_) {
          return false;
        }
      }
    }
    slices_[slice].emplace_back(length, angle);
    return true;
  }

 private:
  double length_spacing_, angle_spacing_;
  std::vector<std::vector<std::pair<double, double>>> slices_;
};

}  // namespace

void PipeGraspOptions::check() const {
  const auto unit = [](const Vector3d& axis) { return axis.allFinite() && std::abs(axis.norm() - 1) < 1e-6; };
  require(unit(approach), "approach", approach.norm(), "must be a unit vector");
  require(unit(closing), "closing", closing.norm(), "must be a unit vector");
  require(std::abs(approach.dot(closing)) < 1e-6, "closing", approach.dot(closing),
          "must be orthogonal to approach (their product is given)");
  require_positive(max_opening, "max_opening", "m");
  require_not_negative(end_margin, "end_margin", "m");
  require_number(length_spacing, "length_spacing", "m");
  require(length_spacing >= 1e-6, "length_spacing", length_spacing, "must be at least 1e-6 [m]");
  require_positive(angle_spacing, "angle_spacing", "rad");
  require_not_negative(cost_per_metre, "cost_per_metre", "1/m");
  require_count(draws, "draws");
}

PipeGraspOptions pipe_grasp_options(const Hand& hand) {
  hand.check_fingers();
  PipeGraspOptions options;
  options.approach = hand.approach;
  options.closing = hand.closing;
  options.max_opening = hand.max_opening;
  options.end_margin = hand.finger_width / 2;
  return options;
}

Grasp place_pipe_grasp(const Pipe& pipe, int section, double length, double angle, bool flipped,
                       const PipeGraspOptions& options) {
  const int count = static_cast<int>(pipe.sections.size());
  require(section >= 0 && section < count, "section", section, "must be one of the " + std::to_string(count));
  require(length >= 0 && length <= pipe.length(section), "length", length,
          "must lie on the section of " + std::to_string(pipe.length(section)) + " m");
  require_number(angle, "angle", "rad");
  const Pose T_object_section = pipe.T_object_section(section);
  const Vector3d approach(0, std::cos(angle), std::sin(angle));
  const Vector3d closing = Vector3d::UnitX().cross(approach) * (flipped ? -1 : 1);
  Grasp grasp;
  grasp.provenance = PipeProvenance{section, length, angle, flipped};
  grasp.T_object_hand.linear() = T_object_section.linear() * hand_axes(approach, closing) *
                                 hand_axes(options.approach, options.closing).transpose();
  grasp.T_object_hand.translation() = T_object_section * Vector3d(length, 0, 0);
  grasp.opening = pipe.diameters[section];
  grasp.cost = options.cost_per_metre * (grasp.T_object_hand.translation() - pipe.centre_of_mass()).norm();
  return grasp;
}

SampledGrasps sample_pipe_grasps(const Pipe& pipe, int count, const PipeGraspOptions& options) {
  pipe.check();
  options.check();
  require_count(count, "count", 0, 1'000'000);
  const int sections = static_cast<int>(pipe.sections.size());
  std::vector<double> up_to(sections);  // room on the sections up to each, that one included [m]
  std::vector<Spacing> taken;
  double room = 0;
  SampledGrasps sampled;
  for (int i = 0; i < sections; ++i) {
    const bool fits = pipe.diameters[i] <= options.max_opening;
    sampled.too_wide += fits ? 0 : 1;
    room += fits ? std::max(0.0, pipe.length(i) - 2 * options.end_margin) : 0.0;
    up_to[i] = room;
    taken.insert(taken.end(), 2, Spacing(pipe.length(i), options));
  }
  if (room <= 0) return sampled;
  std::vector<Grasp>& grasps = sampled.grasps;
  Rng rng(options.seed);
  int fruitless = 0;
  while (static_cast<int>(grasps.size()) < count && fruitless < options.draws) {
    detail::throw_if_interrupted();
    const double at = rng.uniform(0, room);
    const int section = static_cast<int>(std::upper_bound(up_to.begin(), up_to.end(), at) - up_to.begin());
    const double length = at - (section == 0 ? 0 : up_to[section - 1]) + options.end_margin;
    const double angle = rng.uniform(-detail::kPi, detail::kPi);
    const bool flipped = rng.index(2) == 1;
    if (taken[2 * section + (flipped ? 1 : 0)].take(length, angle)) {
      grasps.push_back(place_pipe_grasp(pipe, section, length, angle, flipped, options));
      fruitless = 0;
    } else {
      ++fruitless;
    }
  }
  return sampled;
}

}  // namespace mmgrasp
