#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/reach/reach_database.hpp"

namespace mmgrasp {

/// The arrays of a database as they lie in memory or in its files (docs/methods/reach.md says what they mean); valid
/// as long as the database or a copy of it lives. Configurations read this way are not compared with their checksums:
/// take checked_reach_arrays() for these.
struct MMGRASP_EXPORT ReachArrays {
  std::int64_t positions = 0, cells = 0, size = 0;
  int joints = 0;
  const std::int32_t* position_cells = nullptr;   ///< (positions, 3)
  const std::uint32_t* position_first = nullptr;  ///< (positions + 1)
  const std::uint32_t* rotation_ids = nullptr;    ///< (cells)
  const std::uint32_t* cell_first = nullptr;      ///< (cells + 1)
  const std::uint16_t* configurations = nullptr;  ///< (size, joints)
  /// q = lower + step * stored.
  std::vector<double> joint_lower, joint_step;
  std::vector<std::string> joint_names;
  std::string robot, tip;
};
MMGRASP_EXPORT ReachArrays reach_arrays(const ReachDatabase& database);
/// The same, once every configuration has been compared with its checksum, which is done the first time. Throws IoError
/// naming file and place where they differ.
MMGRASP_EXPORT ReachArrays checked_reach_arrays(const ReachDatabase& database);

}  // namespace mmgrasp
