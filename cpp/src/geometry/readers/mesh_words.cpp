// WordReader and numbers: what the readers of mesh files in text share.
#include <charconv>

#include "geometry/readers/mesh_readers.hpp"

namespace mmgrasp::detail {

namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

// std::from_chars knows no leading plus sign, which some writers print.
std::string_view without_plus(std::string_view word) {
  return !word.empty() && word.front() == '+' ? word.substr(1) : word;
}

template <class Value>
bool parse_whole(std::string_view word, Value& value) {
  word = without_plus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace

bool parse_number(std::string_view word, double& value) {
  word = without_plus(word);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  // Denormal text such as 1e-320 is reported as out of range; for a length in metres that is zero.
  if (error == std::errc::result_out_of_range && end == word.data() + word.size()) {
    const std::size_t exponent = word.find_first_of("eE");
    if (exponent != std::string_view::npos && exponent + 1 < word.size() && word[exponent + 1] == '-') {
      value = 0;
      return true;
    }
  }
  return error == std::errc() && end == word.data() + word.size();
}

bool parse_integer(std::string_view word, long& value) {
  return parse_whole(word, value);
}

std::string_view WordReader::next() {
  poll_();
  while (position_ < text_.size() && is_blank(text_[position_])) {
    if (text_[position_] == '\n') ++line_;
    ++position_;
  }
  const std::size_t begin = position_;
  while (position_ < text_.size() && !is_blank(text_[position_])) ++position_;
  return text_.substr(begin, position_ - begin);
}

std::string_view WordReader::next_in_line() {
  while (position_ < text_.size() && text_[position_] != '\n' && is_blank(text_[position_])) ++position_;
  return position_ < text_.size() && text_[position_] != '\n' ? next() : std::string_view();
}

double WordReader::number(const char* what) {
  const std::string_view word = next();
  double value = 0;
  if (word.empty()) fail(std::string("ends in ") + what + " (truncated)");
  if (!parse_number(word, value)) fail("'" + std::string(word.substr(0, 40)) + "' is no number in " + what);
  return value;
}

void WordReader::skip_line() {
  while (position_ < text_.size() && text_[position_] != '\n') ++position_;
}

void WordReader::fail(const std::string& reason) const {
  mesh_error(path_, "line " + std::to_string(line_) + ": " + reason);
}

void add_polygon(RawMesh& mesh, const std::vector<int>& corners) {
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
  }
}

}  // namespace mmgrasp::detail
