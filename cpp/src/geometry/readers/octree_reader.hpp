#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mmgrasp/geometry/octree.hpp"

namespace mmgrasp::detail {

/// load_octree for a file's content already in memory. OctoMap's own reader recurses without bound and reads on behind
/// the end of a truncated file, hence this one.
std::vector<Voxels> parse_octree(const std::string& path, std::string_view content);

}  // namespace mmgrasp::detail
