#pragma once

#include <string>
#include <string_view>

namespace mmgrasp::detail {

/// The triangles, polygons and nodes of a COLLADA text, written anew without anything else (materials, images,
/// animations, names): what may be handed to assimp, whose reader trusts every number. Lists hold numbers only and as
/// many as their `count` says, accessors stay within their arrays, instances neither circle nor multiply beyond what
/// the size of the text allows. Throws IoError naming `path`, line, element and rule.
std::string checked_dae(const std::string& path, std::string_view content);

}  // namespace mmgrasp::detail
