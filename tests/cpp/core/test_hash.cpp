#include "mmgrasp/core/hash.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/outcome.hpp"

using namespace mmgrasp;

TEST(Hasher, MatchesPublishedFnv1aVectors) {
  EXPECT_EQ(Hasher().hex(), "cbf29ce484222325");
  EXPECT_EQ(Hasher().add("a", 1).hex(), "af63dc4c8601ec8c");
  EXPECT_EQ(Hasher().add("foobar", 6).hex(), "85944171f73967e8");
}

TEST(Hasher, SeparatesFieldsAndShapes) {
  EXPECT_NE(Hasher().add(std::string("ab")).add(std::string("c")).value(),
            Hasher().add(std::string("a")).add(std::string("bc")).value());
  EXPECT_NE(Hasher().add(Eigen::MatrixXd::Zero(2, 3)).value(), Hasher().add(Eigen::MatrixXd::Zero(3, 2)).value());
  EXPECT_EQ(Hasher().add(0.0).value(), Hasher().add(-0.0).value());
  EXPECT_EQ(Hasher().add(7).value(), Hasher().add(std::int64_t{7}).value());
  const Eigen::MatrixXd wide = Eigen::MatrixXd::Random(4, 4);
  const Eigen::MatrixXd block = wide.topLeftCorner(2, 2);
  EXPECT_EQ(Hasher().add(wide.topLeftCorner(2, 2)).value(), Hasher().add(block).value());
}

TEST(Error, RequireNamesFieldValueAndRule) {
  EXPECT_NO_THROW(require(true, "step", 0.0, "must be positive"));
  try {
    require(false, "step", -0.5, "must be positive");
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "step = -0.5: must be positive");
  }
}

TEST(Rejections, CountsAndSummary) {
  Rejections a;
  EXPECT_EQ(a.summary(), "none");
  a.add(Rejection::unreachable, 12);
  a.add(Rejection::scene);
  a.add(Rejection::none, 5);
  Rejections b;
  b.add(Rejection::scene, 2);
  a += b;
  EXPECT_EQ(a.summary(), "unreachable 12, scene 3");
  EXPECT_EQ(a.total(), 15u);
  EXPECT_STREQ(to_string(Outcome::invalid_goal), "invalid_goal");
}
