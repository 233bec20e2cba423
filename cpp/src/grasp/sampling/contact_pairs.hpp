#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mmgrasp/grasp/detail/joined_surface.hpp"
#include "mmgrasp/grasp/sample_grasps.hpp"

namespace mmgrasp::detail {

/// The flat rectangle a pad presses on: needed to judge how much of the pad rests on it.
struct ContactFace {
  Eigen::Vector3d u, v;               ///< Unit axes of the face, orthogonal to the closing axis.
  double half_u = 0, half_v = 0;      ///< Half sizes [m].
  double offset_u = 0, offset_v = 0;  ///< Place of the contact from the face's middle [m].
};

/// Two opposed contacts: middle -+ axis * width / 2, in the object frame.
struct ContactPair {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  ///< Unit, from one contact to the other.
  double width = 0;                                 ///< [m]
  double alignment = 1;  ///< 1: both normals along the axis; 0: at the edge of the friction cone.
  Eigen::Vector3d first_approach = Eigen::Vector3d::UnitZ();  ///< Unit, orthogonal to axis: where approaches start.
  std::optional<ContactFace> face;
};

struct ContactPairs {
  std::vector<ContactPair> pairs;  ///< Pairs in the order of sampling, too wide ones included.
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();  ///< Uniform density.
  std::vector<Eigen::Vector3d> corners;                      ///< Points whose hull holds the object.
  std::optional<JoinedSurface> surface;      ///< None where pads meet the contacts alone, however the hand comes.
  std::shared_ptr<const TriangleMesh> hull;  ///< The hull of a solid surface that is not convex; else null.
};

/// Analytic pairs of one box, sphere, cylinder or capsule; nothing for other shapes, nor for those that lie askew to
/// the approach direction.
std::optional<ContactPairs> primitive_pairs(const LinkShape& shape, const Hand& hand,
                                            const GraspSamplerOptions& options);

/// Pairs by rays through the union of all shapes' surfaces, more of them where few are no wider than max_opening [m],
/// and through its convex hull, on which flat pads stand where the surface is edges (threads, grooves).
ContactPairs surface_pairs(const std::vector<LinkShape>& object, double max_opening,
                           const GraspSamplerOptions& options);

/// Any unit vector orthogonal to a unit vector; the same for the same input.
Eigen::Vector3d orthogonal_to(const Eigen::Vector3d& axis);

/// Share of a pad (depth along `approach`, width across) that lies on the face, in [0, 1]; the pad's middle stays
/// `standoff` [m] before the contact.
double pad_overlap(const ContactFace& face, const Eigen::Vector3d& approach, double standoff, double depth,
                   double width);

}  // namespace mmgrasp::detail
