#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace mmgrasp::detail {

/// As much JSON as a database's meta.json needs. Everything throws IoError naming `where`, the place or the member.
class JsonValue {
 public:
  /// The whole text must be one value; numbers are kept as written, so that 64-bit integers stay exact.
  static JsonValue parse(const std::string& text, const std::string& where);

  const JsonValue& at(const std::string& member) const;
  const std::vector<JsonValue>& array() const;
  const std::string& string() const;
  double number() const;
  std::int64_t integer() const;  ///< Within +-2^53 and whole.
  std::vector<double> numbers() const;
  std::vector<std::string> strings() const;

 private:
  enum class Kind { null, boolean, number, string, array, object };
  friend class JsonReader;

  [[noreturn]] void refuse(const std::string& what) const;

  Kind kind_ = Kind::null;
  std::string path_;  ///< File and member, for messages.
  std::string text_;  ///< The text of a string, or a number as written.
  std::vector<JsonValue> array_;
  std::map<std::string, JsonValue> members_;
};

/// The text as a JSON string, quotes included.
std::string json_quoted(const std::string& text);
/// Shortest form that reads back as the same number.
std::string json_number(double value);

}  // namespace mmgrasp::detail
