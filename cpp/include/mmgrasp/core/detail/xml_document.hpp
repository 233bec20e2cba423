#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

class TiXmlDocument;
class TiXmlElement;

namespace mmgrasp::detail {

/// One parsed XML file and its name in messages. Every reader below throws InvalidInput naming file, line, element,
/// attribute, value and rule.
class XmlDocument {
 public:
  /// Refuses document type and entity declarations, NUL bytes and absurd nesting before the parser sees the text,
  /// which is UTF-8 or Latin-1.
  XmlDocument(const std::string& raw, const std::string& origin);

  const TiXmlElement& root() const { return *root_; }
  const std::string& origin() const { return origin_; }

  /// "robot.urdf:12: <joint name="a">": where an element stands, for messages.
  std::string where(const TiXmlElement& element) const;
  [[noreturn]] void fail(const TiXmlElement& element, const std::string& what) const;

  /// Trimmed attribute, or nothing. `required_text` throws when it is missing or empty.
  std::optional<std::string> text(const TiXmlElement& element, const char* attribute) const;
  std::string required_text(const TiXmlElement& element, const char* attribute) const;
  /// Finite number, or `fallback` when the attribute is missing.
  double number(const TiXmlElement& element, const char* attribute, double fallback) const;
  double required_number(const TiXmlElement& element, const char* attribute) const;
  /// Exactly `count` finite numbers.
  std::vector<double> required_numbers(const TiXmlElement& element, const char* attribute, std::size_t count) const;
  /// Three finite numbers, or `fallback` when the attribute is missing.
  Eigen::Vector3d vector3(const TiXmlElement& element, const char* attribute, const Eigen::Vector3d& fallback) const;

 private:
  double parse_number(const TiXmlElement& element, const char* attribute, const std::string& value) const;

  std::string origin_;
  std::shared_ptr<TiXmlDocument> document_;
  const TiXmlElement* root_ = nullptr;
};

/// Text made safe for an attribute value.
std::string xml_escape(const std::string& text);
/// The shortest of up to 17 digits that reads back as the same number.
std::string number_text(double value);

}  // namespace mmgrasp::detail
