#include "mmgrasp/core/detail/json_value.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {

/// Recursive descent over a text; refuses anything after the first value, and values nested too deeply.
class JsonReader {
 public:
  JsonReader(const std::string& text, const std::string& where) : text_(text), where_(where) {}

  JsonValue whole() {
    JsonValue value = read(where_, 0);
    skip();
    if (at_ != text_.size()) refuse("something after the end");
    return value;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw IoError(where_ + ": not valid JSON at byte " + std::to_string(at_) + ": " + what);
  }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n' || text_[at_] == '\r' || text_[at_] == '\t'))
      ++at_;
  }
  char next() {
    skip();
    if (at_ >= text_.size()) refuse("it ends too early");
    return text_[at_];
  }
  bool take(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }
  void expect(char c) {
    if (!take(c)) refuse(std::string("\"") + c + "\" expected");
  }

  JsonValue read(const std::string& path, int depth) {
    constexpr int kDeepest = 16;
    if (depth > kDeepest) refuse("nested too deeply");
    JsonValue value;
    value.path_ = path;
    const char first = next();
    if (first == '{') {
      value.kind_ = JsonValue::Kind::object;
      read_members(value, path, depth);
    } else if (first == '[') {
      value.kind_ = JsonValue::Kind::array;
      ++at_;
      while (!take(']')) {
        if (!value.array_.empty()) expect(',');
        value.array_.push_back(read(path, depth + 1));
      }
    } else if (first == '"') {
      value.kind_ = JsonValue::Kind::string;
      value.text_ = read_string();
    } else {
      read_word(value);
    }
    return value;
  }

  void read_members(JsonValue& value, const std::string& path, int depth) {
    ++at_;
    while (!take('}')) {
      if (!value.members_.empty()) expect(',');
      skip();
      const std::string name = read_string();
      expect(':');
      if (!value.members_.emplace(name, read(path + ": " + name, depth + 1)).second)
        refuse("\"" + name + "\" stands there twice");
    }
  }

  void read_word(JsonValue& value) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::string(" \n\r\t,]}:").find(text_[at_]) == std::string::npos) ++at_;
    value.text_ = text_.substr(begin, at_ - begin);
    if (value.text_ == "true" || value.text_ == "false") {
      value.kind_ = JsonValue::Kind::boolean;
    } else if (value.text_ != "null") {
      value.kind_ = JsonValue::Kind::number;
      char* end = nullptr;
      const double number = std::strtod(value.text_.c_str(), &end);
      const std::size_t digit = value.text_.rfind('-', 0) == 0 ? 1 : 0;  // strtod takes more than JSON does
      const bool starts = value.text_.size() > digit && value.text_[digit] >= '0' && value.text_[digit] <= '9';
      const bool padded = value.text_.size() > digit + 1 && value.text_[digit] == '0' &&
                          std::string("0123456789xX").find(value.text_[digit + 1]) != std::string::npos;
      if (!starts || padded || *end != '\0' || !std::isfinite(number)) refuse("a value expected");
    }
  }

  std::string read_string() {
    expect('"');
    std::string out;
    while (at_ < text_.size() && text_[at_] != '"') {
      char c = text_[at_++];
      if (c == '\\') {
        if (at_ >= text_.size()) refuse("it ends within a string");
        c = text_[at_++];
        if (c == 'u') {
          out += read_code();
          continue;
        }
        const std::string escapes = "\"\\/bfnrt", meant = "\"\\/\b\f\n\r\t";
        const std::size_t which = escapes.find(c);
        if (which == std::string::npos) refuse("unknown escape");
        c = meant[which];
      }
      out += c;
    }
    if (at_ >= text_.size()) refuse("it ends within a string");
    ++at_;
    return out;
  }

  /// Only control characters are ever written this way here.
  char read_code() {
    if (at_ + 4 > text_.size()) refuse("it ends within a string");
    const long code = std::strtol(text_.substr(at_, 4).c_str(), nullptr, 16);
    if (code <= 0 || code >= 128) refuse("only ASCII may be written as \\u");
    at_ += 4;
    return static_cast<char>(code);
  }

  const std::string& text_;
  const std::string& where_;
  std::size_t at_ = 0;
};

JsonValue JsonValue::parse(const std::string& text, const std::string& where) {
  return JsonReader(text, where).whole();
}

void JsonValue::refuse(const std::string& what) const {
  throw IoError(path_ + ": " + what);
}

const JsonValue& JsonValue::at(const std::string& member) const {
  if (kind_ != Kind::object) refuse("must be an object");
  const auto found = members_.find(member);
  if (found == members_.end()) refuse("\"" + member + "\" is missing");
  return found->second;
}

const std::vector<JsonValue>& JsonValue::array() const {
  if (kind_ != Kind::array) refuse("must be a list");
  return array_;
}

const std::string& JsonValue::string() const {
  if (kind_ != Kind::string) refuse("must be a string");
  return text_;
}

double JsonValue::number() const {
  if (kind_ != Kind::number) refuse("must be a number");
  return std::strtod(text_.c_str(), nullptr);
}

std::int64_t JsonValue::integer() const {
  const double value = number();
  if (std::abs(value) > 9007199254740992.0 || value != std::floor(value)) refuse("must be a whole number");
  return static_cast<std::int64_t>(value);
}

std::vector<double> JsonValue::numbers() const {
  std::vector<double> out;
  for (const JsonValue& value : array()) out.push_back(value.number());
  return out;
}

std::vector<std::string> JsonValue::strings() const {
  std::vector<std::string> out;
  for (const JsonValue& value : array()) out.push_back(value.string());
  return out;
}

std::string json_quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char code[8];
      std::snprintf(code, sizeof(code), "\\u%04x", static_cast<unsigned>(c));
      out += code;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string json_number(double value) {
  char text[40];
  for (const int digits : {15, 16, 17}) {
    std::snprintf(text, sizeof(text), "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace mmgrasp::detail
