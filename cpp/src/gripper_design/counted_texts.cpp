#include "gripper_design/counted_texts.hpp"

#include <algorithm>

namespace mmgrasp::detail {

void CountedTexts::add(const std::string& text) {
  const auto [at, is_new] = places_.emplace(text, counts_.size());
  if (is_new) counts_.emplace_back(text, 0);
  ++counts_[at->second].second;
}

const std::pair<std::string, int>& CountedTexts::most() const {
  return *std::max_element(counts_.begin(), counts_.end(),
                           [](const auto& a, const auto& b) { return a.second < b.second; });
}

std::string CountedTexts::joined() const {
  std::string out;
  for (const auto& [text, count] : counts_)
    out += (out.empty() ? "" : "; ") + text + (count > 1 ? " (" + std::to_string(count) + " times)" : "");
  return out;
}

}  // namespace mmgrasp::detail
