#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace mmgrasp::detail {

/// Texts that are said once each, in the order in which they came first, with how often they came.
class CountedTexts {
 public:
  void add(const std::string& text);
  bool empty() const { return counts_.empty(); }
  /// The text that came most often, and how often; of equals the first. There must be one.
  const std::pair<std::string, int>& most() const;
  /// "a; b (3 times)".
  std::string joined() const;

 private:
  std::vector<std::pair<std::string, int>> counts_;
  std::unordered_map<std::string, std::size_t> places_;  // Places in the counts by text.
};

}  // namespace mmgrasp::detail
