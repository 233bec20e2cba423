#pragma once

#include <string>
#include <string_view>

#include "mmgrasp/geometry/point_cloud.hpp"

namespace mmgrasp::detail {

/// read_pcd for a file's content already in memory.
PointCloud parse_pcd(const std::string& path, std::string_view content);

/// Unpacks LZF: literal runs (a byte below 32: that many and one bytes follow) and copies of what was written before
/// (three bits of length, thirteen of distance; length 7 takes another byte). False when the data are no such thing or
/// do not fill `size` bytes exactly.
bool unpack_lzf(std::string_view packed, std::size_t size, std::string& out);

}  // namespace mmgrasp::detail
