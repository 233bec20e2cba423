#include "plan/motion/collision_cache.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include "mmgrasp/core/random.hpp"

namespace mmgrasp::detail {
namespace {

TEST(CollisionCache, FindsWhatWasInsertedLast) {
  Rng rng(8);
  CollisionCache cache;
  std::map<std::tuple<int, int, int>, bool> inserted;
  for (int i = 0; i < 20000; ++i) {
    const int opening = static_cast<int>(rng.index(5)), a = static_cast<int>(rng.index(300)),
              b = static_cast<int>(rng.index(300));
    const auto key = std::make_tuple(opening, std::min(a, b), std::max(a, b));
    const auto known = inserted.find(key);
    EXPECT_EQ(cache.find(opening, a, b), known == inserted.end() ? std::nullopt : std::optional<bool>(known->second));
    EXPECT_EQ(cache.find(opening, b, a), cache.find(opening, a, b));
    inserted[key] = rng.uniform() < 0.5;
    cache.insert(opening, a, b, inserted[key]);
  }
}

}  // namespace
}  // namespace mmgrasp::detail
