#include "mmgrasp/core/detail/near_name.hpp"

#include <algorithm>
#include <numeric>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kLongest = 100;  // nobody mistypes more; the comparison takes the product of both lengths

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t above = row[j + 1];
      row[j + 1] = std::min({above + 1, row[j] + 1, diagonal + (a[i] == b[j] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string near_miss(const std::string& name, const std::vector<std::string>& known) {
  if (name.size() > kLongest) return "";
  const std::string* best = nullptr;
  std::size_t best_distance = std::max<std::size_t>(3, name.size() / 2) + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > kLongest) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = &candidate;
    }
  }
  return best ? "; did you mean \"" + *best + "\"?" : "";
}

}  // namespace mmgrasp::detail
