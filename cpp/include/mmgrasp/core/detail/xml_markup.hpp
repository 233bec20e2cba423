#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mmgrasp::detail {

struct MarkupFault {
  int line = 1;
  std::string reason;
};

/// Walks over the tags of an XML text without building anything and says what is wrong first: NUL bytes, document type
/// and entity declarations, more than 200 levels, tags that do not match, a second root, an end inside an element. To
/// be called before a parser that recurses or forgives; whatever that might read in another way is a fault too.
std::optional<MarkupFault> find_markup_fault(std::string_view text);

}  // namespace mmgrasp::detail
