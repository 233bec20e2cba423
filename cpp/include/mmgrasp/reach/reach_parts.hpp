#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/reach/reach_database.hpp"

namespace mmgrasp {

/// Into how many parts ReachDatabase::build_to divides the work; it depends on arm and options alone.
MMGRASP_EXPORT std::int64_t reach_part_count(const JointGroup& arm, const ReachOptions& options);

/// Draws single parts (numbers in [0, reach_part_count)) and writes them to `folder`, which is made when missing. In
/// the folder `path`.partial they are what ReachDatabase::build_to(path, ...) goes on from: parts drawn anywhere give
/// the same database, bit for bit. False when stopped. Throws InvalidInput and IoError.
MMGRASP_EXPORT bool build_reach_parts(const std::string& folder, const JointGroup& arm, const ReachOptions& options,
                                      const std::vector<std::int64_t>& parts, const Monitor& monitor = {});

}  // namespace mmgrasp
