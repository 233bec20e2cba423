#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp {

/// How the free ends of a pipe are modelled.
enum class PipeEnds {
  round,  ///< Capsules: quick to check, each free end sticks out by half a diameter at most.
  flat,   ///< Cylinders and, where sections meet, balls: no more than the pipe with mitred bends filled round.
};

/// A pipe structure (P2 3.2.2): straight round sections between nodes, all in the object's frame. Unlike P2's matrix
/// the indices of nodes count from 0.
///
///     const Pipe pipe{{{0, 0, 0}, {0.4, 0, 0}, {0.4, 0.3, 0}}, {{0, 1}, {1, 2}}, {0.028, 0.028}};
///     const SampledGrasps grasps = sample_pipe_grasps(pipe, 500);
struct MMGRASP_EXPORT Pipe {
  std::vector<Eigen::Vector3d> nodes;        ///< [m]
  std::vector<std::array<int, 2>> sections;  ///< First and second node of each section.
  std::vector<double> diameters;             ///< Outer diameter of each section [m].

  /// Throws InvalidInput naming field, value and rule: finite nodes, each of which belongs to a section; indices that
  /// exist; sections at least as long as kShortest, no two of the same nodes, all connected; positive diameters, one a
  /// section.
  void check() const;

  static constexpr double kShortest = 1e-3;  ///< [m]
  double length(int section) const;          ///< Between the section's nodes [m].
  /// The section's frame: at its first node, x along the section. y is the object's z turned into the plane across the
  /// section, or the object's x when the section runs along z (within 0.06 rad): what P2 figure 3.5 leaves open.
  Pose T_object_section(int section) const;
  /// Centre of mass of tubes with equal walls: sections weigh by length times diameter.
  Eigen::Vector3d centre_of_mass() const;
  /// The solid for collision checks: a shape for each section and, with flat ends, a sphere at each node where sections
  /// meet, as wide as the widest of them.
  std::vector<LinkShape> shapes(PipeEnds ends = PipeEnds::round) const;
};

}  // namespace mmgrasp
