#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace mmgrasp::detail {

constexpr std::uintmax_t kLargestText = 256'000'000;    ///< Robots, and what describes the arrays of a folder [bytes].
constexpr std::uintmax_t kLargestFile = 4'000'000'000;  ///< Meshes, clouds, octrees and roadmaps [bytes].
constexpr std::uintmax_t kLargestMap = 64'000'000'000;  ///< Maps of surfaces [bytes].

/// The whole of a regular file. Throws IoError("<kind> '<path>': <reason>") when it is missing, a folder, a device or
/// pipe (which would never end), unreadable, empty or larger than `most` bytes.
std::string file_content(const std::string& path, const std::string& kind, std::uintmax_t most = kLargestFile);

/// Writes the parts one after the other, under a temporary name of its own that becomes `path` when all is written. Of
/// a link the file is replaced that it leads to; folders, devices and pipes never are. Throws IoError("<kind> '<path>':
/// <reason>") with nothing left behind.
void write_file(const std::string& path, const std::string& kind, std::initializer_list<std::string_view> parts);

}  // namespace mmgrasp::detail
