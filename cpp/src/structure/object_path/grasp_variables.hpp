#pragma once

#include <vector>

#include "mmgrasp/structure/optimize_grasp.hpp"

namespace mmgrasp::detail {

/// The grasps of a pipe as unknowns of a search: index among the sections that the hand fits, distance from the margin
/// kept at the first node, angle, flip.
class MMGRASP_EXPORT GraspVariables {
 public:
  /// Throws InvalidInput when the hand fits no section.
  GraspVariables(const Pipe& pipe, const PipeGraspOptions& grasp);

  std::vector<SearchVariable> variables() const;
  const std::vector<int>& sections() const { return sections_; }  ///< Those that the hand fits.
  /// Longest distance on a section.
  double room(int usable) const { return room_[usable]; }
  Grasp grasp(const Eigen::VectorXd& x) const;
  Eigen::VectorXd neighbour(const Eigen::VectorXd& x, double size, GraspNeighbourhood kind, Rng& rng) const;

 private:
  /// Goes on by `beyond` along a section that meets the end of x's section, drawn at random; stays at the end if none
  /// does.
  void cross_node(Eigen::VectorXd& x, bool at_end, double beyond, Rng& rng) const;

  Pipe pipe_;
  PipeGraspOptions options_;
  std::vector<int> sections_;  ///< Usable ones.
  std::vector<double> room_;
};

}  // namespace mmgrasp::detail
