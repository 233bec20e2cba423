#include "mmgrasp/core/detail/xml_document.hpp"

#include <tinyxml.h>

#include <charconv>
#include <cmath>
#include <cstring>

#include "mmgrasp/core/detail/utf8.hpp"
#include "mmgrasp/core/detail/xml_markup.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

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
  if (const auto fault = find_markup_fault(text))
    throw InvalidInput(origin + ":" + std::to_string(fault->line) + ": not well-formed XML: " + fault->reason);
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
  if (!text(element, attribute)) return fallback;
  return Eigen::Vector3d(required_numbers(element, attribute, 3).data());
}

std::vector<double> XmlDocument::required_numbers(const TiXmlElement& element, const char* attribute,
                                                  std::size_t count) const {
  const auto value = text(element, attribute);
  if (!value) fail(element, std::string("attribute ") + attribute + " is missing");
  const std::vector<std::string> parts = words(*value);
  if (parts.size() != count)
    fail(element, std::string(attribute) + " = \"" + *value + "\": must be " +
                      (count == 3 ? "three" : std::to_string(count)) + " numbers");
  std::vector<double> result;
  for (const std::string& part : parts) result.push_back(parse_number(element, attribute, part));
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
