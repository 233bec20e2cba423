#include "mmgrasp/core/detail/xml_markup.hpp"

#include <algorithm>
#include <cctype>
#include <vector>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kMaxNesting = 200;  // real robot files stay below 10; parsers recurse once per level

/// Goes from tag to tag of a text and stops at the first that an XML reader would misread.
class MarkupWalk {
 public:
  explicit MarkupWalk(std::string_view text) : text_(text) {}

  std::optional<MarkupFault> run() {
    if (const std::size_t nul = text_.find('\0'); nul != npos) return fault(nul, "holds a NUL byte: must be XML text");
    for (std::size_t i = text_.find('<'); i != npos; i = text_.find('<', i + 1)) {
      std::size_t end = npos;
      if (starts(i, "<!--")) {
        end = text_.find("-->", i + 4);
        if (end == npos) return fault(i, "a comment does not end (truncated)");
      } else if (starts(i, "<![CDATA[")) {
        end = text_.find("]]>", i + 9);
        if (end == npos) return fault(i, "a CDATA section does not end (truncated)");
      } else if (starts(i, "<?")) {
        end = text_.find("?>", i);
        if (end == npos || text_.find_first_of("<>", i + 1) < end)
          return fault(i, "a processing instruction must end with '?>' and hold no '<' or '>'");
      } else {
        end = tag_end(i);
        if (auto found = read_tag(i, end)) return found;
      }
      i = end;
    }
    if (!open_.empty()) return fault(text_.size(), "ends inside <" + shown(open_.back()) + "> (truncated)");
    return std::nullopt;
  }

 private:
  static constexpr std::size_t npos = std::string_view::npos;

  std::optional<MarkupFault> fault(std::size_t at, const std::string& reason) const {
    return MarkupFault{1 + static_cast<int>(std::count(text_.begin(), text_.begin() + static_cast<long>(at), '\n')),
                       reason};
  }

  static std::string shown(std::string_view name) { return std::string(name.substr(0, 40)); }
  char at(std::size_t i) const { return i < text_.size() ? text_[i] : '\0'; }
  bool starts(std::size_t i, std::string_view word) const { return text_.substr(i, word.size()) == word; }

  bool starts_no_case(std::size_t i, std::string_view word) const {
    return std::equal(word.begin(), word.end(), text_.begin() + static_cast<long>(i),
                      text_.begin() + static_cast<long>(std::min(text_.size(), i + word.size())),
                      [](char a, char b) { return a == std::toupper(static_cast<unsigned char>(b)); });
  }

  /// A '>' inside a quoted attribute does not end the tag.
  std::size_t tag_end(std::size_t i) const {
    char quote = 0;
    for (++i; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote) {
        if (c == quote) quote = 0;
      } else if (c == '"' || c == '\'') {
        quote = c;
      } else if (c == '>') {
        return i;
      }
    }
    return npos;
  }

  static bool starts_name(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) > 127;
  }

  std::optional<MarkupFault> read_tag(std::size_t i, std::size_t end) {
    for (const char* declaration : {"<!DOCTYPE", "<!ENTITY"})
      if (starts_no_case(i, declaration))
        return fault(i, std::string("element ") + declaration + ">: document type and entity declarations are refused");
    const bool closes = at(i + 1) == '/';
    const std::size_t begin = i + (closes ? 2 : 1);
    if (!starts_name(at(begin))) return fault(i, "'<' is not followed by a name");
    if (end == npos) return fault(i, "a tag does not end (truncated)");
    const std::string_view name = text_.substr(begin, std::min(text_.find_first_of(" \t\r\n/>", begin), end) - begin);
    if (closes) {
      if (open_.empty()) return fault(i, "</" + shown(name) + "> closes what was not opened");
      if (open_.back() != name) return fault(i, "</" + shown(name) + "> where </" + shown(open_.back()) + "> is due");
      open_.pop_back();
      return std::nullopt;
    }
    if (open_.empty() && had_root_) return fault(i, "<" + shown(name) + "> after the end of the root element");
    had_root_ = true;
    if (text_[end - 1] != '/') open_.push_back(name);
    if (open_.size() > kMaxNesting)
      return fault(i, "nesting of elements = " + std::to_string(open_.size()) + ": must be at most " +
                          std::to_string(kMaxNesting));
    return std::nullopt;
  }

  std::string_view text_;
  std::vector<std::string_view> open_;
  bool had_root_ = false;
};

}  // namespace

std::optional<MarkupFault> find_markup_fault(std::string_view text) {
  return MarkupWalk(text).run();
}

}  // namespace mmgrasp::detail
