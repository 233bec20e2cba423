#pragma once

#include <string>
#include <string_view>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// SHA-256 (FIPS 180-4) of some bytes, as 64 hexadecimal digits.
MMGRASP_EXPORT std::string sha256(std::string_view bytes);

}  // namespace mmgrasp::detail
