#include "robot/xml_document.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "robot/utf8.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxNesting = 200;  // real robot files stay below 10; the parser recurses once per level

bool starts_with_no_case(const std::string& text, std::size_t at, const char* word) {
  for (; *word; ++word, ++at)
    if (at >= text.size() || std::toupper(static_cast<unsigned char>(text[at])) != *word) return false;
  return true;
}

/// End of the tag that starts at `i`, or npos. A '>' inside a quoted attribute does not end it.
std::size_t tag_end(const std::string& text, std::size_t i) {
  char quote = 0;
  for (++i; i < text.size(); ++i) {
    if (quote) {
      if (text[i] == quote) quote = 0;
    } else if (text[i] == '"' || text[i] == '\'') {
      quote = text[i];
    } else if (text[i] == '>') {
      return i;
    }
  }
  return std::string::npos;
}

bool starts_name(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) || c == '_' || static_cast<unsigned char>(c) > 127;
}

/// Walks over the markup outside comments and CDATA without building anything. Whatever the parser might read in
/// another way is refused, since the depth would be wrong then.
void check_markup(const std::string& text, const std::string& origin) {
  int depth = 0;
  std::size_t counted = 0;
  int line = 1;
  const auto place = [&](std::size_t at) {
    line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(counted),
                                        text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted = at;
    return origin + ":" + std::to_string(line) + ": ";
  };
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i + 1)) {
    std::size_t end = std::string::npos;
    if (text.compare(i, 4, "<!--") == 0) {
      end = text.find("-->", i + 4);
    } else if (text.compare(i, 9, "<![CDATA[") == 0) {
      end = text.find("]]>", i + 9);
    } else if (text.compare(i, 2, "<?") == 0) {
      end = text.find("?>", i);
      if (end == std::string::npos || text.find_first_of("<>", i + 1) < end)
        throw InvalidInput(place(i) +
                           "not well-formed XML: a processing instruction must end with '?>' and hold no '<' or '>'");
    } else {
      for (const char* declaration : {"<!DOCTYPE", "<!ENTITY"})
        if (starts_with_no_case(text, i, declaration))
          throw InvalidInput(place(i) + "element " + declaration +
                             ">: document type and entity declarations are refused");
      const bool closes = text[i + 1] == '/';
      if (!closes && !starts_name(text[i + 1]))
        throw InvalidInput(place(i) + "not well-formed XML: '<' is not followed by a name");
      end = tag_end(text, i);
      if (end == std::string::npos) break;  // unfinished tag: the parser says where
      if (closes && depth == 0)
        throw InvalidInput(place(i) + "not well-formed XML: a closing tag without its opening one");
      if (closes) --depth;
      if (!closes && text[end - 1] != '/') ++depth;
      if (depth > kMaxNesting)
        throw InvalidInput(place(i) + "nesting of elements = " + std::to_string(depth) + ": must be at most " +
                           std::to_string(kMaxNesting));
    }
    if (end == std::string::npos) break;
    i = end;
  }
}

std::string trimmed(const std::string& text) {
  const char* blanks = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result;
  std::size_t end = 0;
  for (;;) {
    const std::size_t begin = text.find_first_not_of(" \t\r\n", end);
    if (begin == std::string::npos) return result;
    end = text.find_first_of(" \t\r\n", begin);
    if (end == std::string::npos) end = text.size();
    result.push_back(text.substr(begin, end - begin));
  }
}

}  // namespace

XmlDocument::XmlDocument(const std::string& raw, const std::string& origin)
    : origin_(origin), document_(std::make_shared<TiXmlDocument>()) {
  // What is not UTF-8 is nearly always an older file in Latin-1.
  const std::string text = is_utf8(raw) ? raw : utf8_from_latin1(raw);
  if (text.find('\0') != std::string::npos) throw InvalidInput(origin + ": holds a NUL byte: must be XML text");
  check_markup(text, origin);
  document_->Parse(text.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document_->Error())
    throw InvalidInput(origin + ":" + std::to_string(document_->ErrorRow()) +
                       ": not well-formed XML: " + document_->ErrorDesc());
  root_ = document_->RootElement();
  if (!root_) throw InvalidInput(origin + ": holds no XML element");
}

std::string XmlDocument::where(const TiXmlElement& element) const {
  std::string text = origin_ + ":" + std::to_string(element.Row()) + ": <" + element.Value();
  for (const char* key : {"name", "link1", "link2"})
    if (const char* value = element.Attribute(key); value && is_utf8(value))
      text += std::string(" ") + key + "=\"" + value + "\"";
  text += ">";
  // Inner elements (limit, origin, box, ...) rarely have names: say whose they are.
  if (!element.Attribute("name")) {
    for (const TiXmlNode* node = element.Parent(); node; node = node->Parent()) {
      const TiXmlElement* owner = node->ToElement();
      if (!owner || owner == root_) break;
      if (const char* name = owner->Attribute("name"); name && is_utf8(name)) {
        text += std::string(" of ") + owner->Value() + " \"" + name + "\"";
        break;
      }
    }
  }
  return text;
}

void XmlDocument::fail(const TiXmlElement& element, const std::string& what) const {
  throw InvalidInput(where(element) + ": " + what);
}

std::optional<std::string> XmlDocument::text(const TiXmlElement& element, const char* attribute) const {
  const char* value = element.Attribute(attribute);
  if (!value) return std::nullopt;
  // A character reference can name what is none, a surrogate for instance.
  if (!is_utf8(value)) fail(element, std::string("attribute ") + attribute + " holds what is no character");
  return trimmed(value);
}

std::string XmlDocument::required_text(const TiXmlElement& element, const char* attribute) const {
  const auto value = text(element, attribute);
  if (!value) fail(element, std::string("attribute ") + attribute + " is missing");
  if (value->empty()) fail(element, std::string("attribute ") + attribute + " = \"\": must not be empty");
  return *value;
}

double XmlDocument::parse_number(const TiXmlElement& element, const char* attribute, const std::string& value) const {
  // from_chars does not depend on the locale; unlike strtod it takes no leading plus.
  const char* begin = value.c_str() + (value.size() > 1 && value[0] == '+' && value[1] != '-' ? 1 : 0);
  const char* end = value.c_str() + value.size();
  double number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  const bool underflow = error == std::errc::result_out_of_range && std::abs(std::strtod(begin, nullptr)) < 1;
  if (underflow) return 0.0;
  if (error != std::errc() || stop != end)
    fail(element, std::string(attribute) + " = \"" + value + "\": must be a number");
  if (!std::isfinite(number)) fail(element, std::string(attribute) + " = \"" + value + "\": must be finite");
  return number;
}

double XmlDocument::number(const TiXmlElement& element, const char* attribute, double fallback) const {
  const auto value = text(element, attribute);
  return value ? parse_number(element, attribute, *value) : fallback;
}

double XmlDocument::required_number(const TiXmlElement& element, const char* attribute) const {
  return parse_number(element, attribute, required_text(element, attribute));
}

Eigen::Vector3d XmlDocument::vector3(const TiXmlElement& element, const char* attribute,
                                     const Eigen::Vector3d& fallback) const {
  const auto value = text(element, attribute);
  if (!value) return fallback;
  const std::vector<std::string> parts = words(*value);
  if (parts.size() != 3) fail(element, std::string(attribute) + " = \"" + *value + "\": must be three numbers");
  Eigen::Vector3d result;
  for (int i = 0; i < 3; ++i) result[i] = parse_number(element, attribute, parts[static_cast<std::size_t>(i)]);
  return result;
}

std::string xml_escape(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&apos;";
        break;
      default:
        if (static_cast<unsigned char>(c) < ' ') {
          result += "&#" + std::to_string(static_cast<int>(c)) + ";";  // a reader would take it for a blank
        } else {
          result += c;
        }
    }
  }
  return result;
}

std::string number_text(double value) {
  char text[40];
  const auto [end, error] = std::to_chars(text, text + sizeof(text), value);
  return error == std::errc() ? std::string(text, end) : "0";
}

}  // namespace mmgrasp::detail
