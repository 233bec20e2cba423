#pragma once

#include <string>
#include <utility>
#include <vector>

#include "reach/database/reach_data.hpp"

namespace mmgrasp::detail {

/// The files of a database besides meta.json, in the order of Data's views.
constexpr const char* kArrayFiles[] = {"positions.npy", "position_first.npy", "rotation_ids.npy", "cell_first.npy",
                                       "configurations.npy"};
constexpr int kArrayCount = 5;
constexpr const char* kMetaFile = "meta.json";
constexpr const char* kReachName = "mmgrasp reachability database";

std::array<NpyLayout, kArrayCount> array_layouts(std::uint64_t positions, std::uint64_t cells, std::uint64_t size,
                                                 std::uint64_t joints);

using FileChecksums = std::array<std::vector<std::uint32_t>, kArrayCount>;

/// meta.json: everything but the arrays. Its last member is the CRC-32 of the text before that member's name.
std::string meta_text(const ReachDatabase::Data& data, const FileChecksums& checksums);

/// What meta.json says. Throws IoError naming the file and the member.
struct Meta {
  std::uint64_t positions = 0, cells = 0, size = 0;
  FileChecksums checksums;
};
Meta read_meta(const std::string& path, ReachDatabase::Data& data);

}  // namespace mmgrasp::detail
