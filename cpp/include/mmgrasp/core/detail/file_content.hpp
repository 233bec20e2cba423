#pragma once

#include <string>

namespace mmgrasp::detail {

/// The whole file. Throws IoError("<kind> '<path>': <reason>") when it is missing, a folder, unreadable or empty.
std::string file_content(const std::string& path, const std::string& kind);

}  // namespace mmgrasp::detail
