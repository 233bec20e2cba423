#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace mmgrasp::detail {

/// One tag of an XML text; its parts are views into the text, references such as &amp; as they stand there.
struct XmlTag {
  std::string_view name;
  std::vector<std::pair<std::string_view, std::string_view>> attributes;
  bool closes = false;    ///< </name>
  bool is_empty = false;  ///< <name/>
  std::size_t begin = 0;  ///< Place of its '<' in the text.
  std::size_t end = 0;    ///< Place behind its '>'.

  /// Empty when it is missing.
  std::string_view attribute(std::string_view key) const;
};

/// Goes over the tags of a text in which find_markup_fault finds nothing; comments, CDATA sections and processing
/// instructions are passed over.
class XmlTags {
 public:
  explicit XmlTags(std::string_view text) : text_(text) {}

  /// False at the end of the text.
  bool next(XmlTag& tag);

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace mmgrasp::detail
