#pragma once

#include <string>
#include <vector>

#include "mmgrasp/collision/world.hpp"

namespace mmgrasp {

/// Adds solid cells as one object of the scene: leaves of an octree (load_octree), or what a map holds
/// (ProbabilisticSdf::obstacle_cells, OccupancyMap::obstacle_cells), one entry per edge length. Checks are exact, as
/// with any other body. Throws InvalidInput when there is no cell, and for what World::add refuses.
MMGRASP_EXPORT void add_cells(World& world, const std::string& name, const std::vector<Voxels>& cells,
                              const Pose& T_world_cells = Pose::Identity());

}  // namespace mmgrasp
