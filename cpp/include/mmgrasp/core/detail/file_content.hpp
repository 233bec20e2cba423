#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

namespace mmgrasp::detail {

/// The whole file. Throws IoError("<kind> '<path>': <reason>") when it is missing, a folder, unreadable or empty.
std::string file_content(const std::string& path, const std::string& kind);

/// Writes the parts one after the other, under a temporary name that becomes `path` when all is written. Throws
/// IoError("<kind> '<path>': <reason>") with nothing left behind.
void write_file(const std::string& path, const std::string& kind, std::initializer_list<std::string_view> parts);

}  // namespace mmgrasp::detail
