#include "mmgrasp/core/limits.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

static_assert(kLargestCount + 1 <= std::numeric_limits<int>::max());

TEST(Limits, CountsLieBetweenTheirBounds) {
  require_count(1, "draws");
  require_count(kLargestCount, "draws");
  require_count(0, "draws", 0);
  require_count(5, "draws", 5, 5);
  for (const std::int64_t value : {std::int64_t{0}, std::int64_t{-1}, kLargestCount + 1,
                                   std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_THROW(require_count(value, "draws"), InvalidInput) << value;
  EXPECT_THROW(require_count(4, "draws", 5, 9), InvalidInput);
  EXPECT_THROW(require_count(10, "draws", 5, 9), InvalidInput);
}

TEST(Limits, ARefusedCountNamesFieldValueAndRule) {
  try {
    require_count(std::int64_t{1} << 40, "draws", 2, 7);
    FAIL() << "taken";
  } catch (const InvalidInput& error) {
    const std::string text = error.what();
    for (const char* part : {"draws", "1099511627776", "[2, 7]"}) EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace mmgrasp
