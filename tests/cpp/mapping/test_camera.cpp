#include "mmgrasp/mapping/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;

TEST(PinholeCamera, ProjectsByHand) {
  PinholeCamera camera;
  camera.fx = 500;
  camera.fy = 400;
  camera.cx = 320;
  camera.cy = 240;
  const auto pixel = camera.project({0.2, -0.1, 2});
  ASSERT_TRUE(pixel);
  EXPECT_DOUBLE_EQ((*pixel)[0], 320 + 500 * 0.2 / 2);
  EXPECT_DOUBLE_EQ((*pixel)[1], 240 - 400 * 0.1 / 2);
  const auto centre = camera.project({0, 0, 1});
  ASSERT_TRUE(centre);
  EXPECT_EQ(*centre, Eigen::Vector2d(320, 240));
}

TEST(PinholeCamera, ImageEndsHalfAPixelBeyondTheOutermostCentres) {
  const PinholeCamera camera;
  const auto sees = [&](double u, double v) {
    return camera.project({(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1}).has_value();
  };
  EXPECT_TRUE(sees(-0.49, 100));
  EXPECT_FALSE(sees(-0.51, 100));
  EXPECT_TRUE(sees(639.49, 100));
  EXPECT_FALSE(sees(639.51, 100));
  EXPECT_TRUE(sees(100, -0.49));
  EXPECT_FALSE(sees(100, -0.51));
  EXPECT_TRUE(sees(100, 479.49));
  EXPECT_FALSE(sees(100, 479.51));
}

TEST(PinholeCamera, DepthRangeAndWhatIsBehind) {
  const PinholeCamera camera;
  EXPECT_TRUE(camera.project({0, 0, 0.1}));
  EXPECT_FALSE(camera.project({0, 0, 0.0999}));
  EXPECT_TRUE(camera.project({0, 0, 5}));
  EXPECT_FALSE(camera.project({0, 0, 5.001}));
  EXPECT_FALSE(camera.project({0, 0, -1}));  // mirrored through the pinhole it would hit the centre
  EXPECT_FALSE(camera.project({0, 0, 0}));
  EXPECT_FALSE(camera.project({NAN, 0, 1}));
  EXPECT_FALSE(camera.project({0, 0, NAN}));
}

TEST(PinholeCamera, BadFieldsAreNamed) {
  const auto message = [](const auto& change) {
    PinholeCamera camera;
    change(camera);
    try {
      camera.check();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("nothing thrown");
  };
  PinholeCamera().check();
  EXPECT_NE(message([](auto& c) { c.width = 0; }).find("camera.width"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.height = -3; }).find("camera.height"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.fx = 0; }).find("camera.fx"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.fy = NAN; }).find("camera.fy"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.cx = INFINITY; }).find("camera.cx"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.cy = NAN; }).find("camera.cy"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.nearest = 0; }).find("camera.nearest"), std::string::npos);
  EXPECT_NE(message([](auto& c) { c.farthest = c.nearest; }).find("camera.farthest"), std::string::npos);
}
