#pragma once

#include <string>

namespace mmgrasp::detail {

/// No truncated or overlong sequences, no surrogates, nothing beyond U+10FFFF.
bool is_utf8(const std::string& text);
/// ISO-8859-1, whose bytes are the first 256 characters of Unicode.
std::string utf8_from_latin1(const std::string& text);

}  // namespace mmgrasp::detail
