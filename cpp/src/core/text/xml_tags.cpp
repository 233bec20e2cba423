#include "mmgrasp/core/detail/xml_tags.hpp"

#include <algorithm>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t npos = std::string_view::npos;
constexpr std::string_view kBlanks = " \t\r\n";

/// `inside` is what stands between the name and the end of a tag.
std::vector<std::pair<std::string_view, std::string_view>> attributes_of(std::string_view inside) {
  std::vector<std::pair<std::string_view, std::string_view>> found;
  std::size_t at = 0;
  while ((at = inside.find_first_not_of(kBlanks, at)) != npos) {
    const std::size_t equals = inside.find('=', at);
    const std::size_t open = inside.find_first_of("\"'", at);
    if (equals == npos || open == npos || open < equals) break;
    const std::size_t close = inside.find(inside[open], open + 1);
    if (close == npos) break;
    std::string_view name = inside.substr(at, equals - at);
    name = name.substr(0, name.find_first_of(kBlanks));
    found.emplace_back(name, inside.substr(open + 1, close - open - 1));
    at = close + 1;
  }
  return found;
}

}  // namespace

std::string_view XmlTag::attribute(std::string_view key) const {
  for (const auto& [name, value] : attributes)
    if (name == key) return value;
  return {};
}

bool XmlTags::next(XmlTag& tag) {
  for (;;) {
    const std::size_t begin = text_.find('<', at_);
    if (begin == npos) return false;
    const auto skip = [&](std::string_view open, std::string_view close) {
      if (text_.substr(begin, open.size()) != open) return false;
      const std::size_t end = text_.find(close, begin + open.size());
      at_ = end == npos ? text_.size() : end + close.size();
      return true;
    };
    if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>")) continue;
    char quote = 0;
    std::size_t end = begin + 1;
    for (; end < text_.size() && (quote || text_[end] != '>'); ++end) {
      const char c = text_[end];
      if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? 0 : c;
    }
    if (end == text_.size()) return false;
    std::string_view inside = text_.substr(begin + 1, end - begin - 1);
    tag.closes = !inside.empty() && inside.front() == '/';
    if (tag.closes) inside.remove_prefix(1);
    tag.is_empty = !tag.closes && !inside.empty() && inside.back() == '/';
    if (tag.is_empty) inside.remove_suffix(1);
    const std::size_t name_end = std::min(inside.find_first_of(kBlanks), inside.size());
    tag.name = inside.substr(0, name_end);
    tag.attributes = tag.closes ? decltype(tag.attributes){} : attributes_of(inside.substr(name_end));
    tag.begin = begin;
    tag.end = at_ = end + 1;
    return true;
  }
}

}  // namespace mmgrasp::detail
