#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp::detail {

/// What has to become of a shell for the mesh to bound its solid.
enum class ShellFate { keep, turn, leave_out };

/// The fate of each shell of a closed mesh whose triangles agree within each shell. One that lies in no other's
/// material bounds a solid, outwards. One in material bounds a void, inwards; a solid there would change nothing, so it
/// is left out. It is a solid when it looks outwards as given and what it lies in did, too: within a shell that was
/// inside out nothing tells solids from voids, and material in material would be odd. What touches a shell around it is
/// a body of its own, such as one that stands on the floor of a void.
std::vector<ShellFate> shell_fates(const std::vector<Eigen::Vector3d>& vertices,
                                   const std::vector<std::array<int, 3>>& triangles, const Shells& shells);

}  // namespace mmgrasp::detail
