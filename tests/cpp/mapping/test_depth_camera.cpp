#include "mmgrasp/mapping/depth_camera.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;

TEST(DepthNoise, PublishedFigures) {
  EXPECT_DOUBLE_EQ(constant_noise(0.003).sigma(2), 0.003);
  // Nguyen 2012: 0.0012 + 0.0019 (z - 0.4)^2, and at 45 degrees 0.0001 / sqrt(z) more.
  for (const double z : {0.4, 1.0, 3.0}) {
    const double axial = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
    EXPECT_NEAR(structured_light_noise().sigma(z), axial, 1e-12);
    EXPECT_NEAR(structured_light_noise().sigma(z, M_PI / 4), axial + 0.0001 / std::sqrt(z), 1e-12);
  }
  // Khoshelham 2012: 4 cm at 5 m, as their abstract says, by 1.425e-3 z^2 (baseline 7.5 cm, half a pixel).
  EXPECT_NEAR(stereo_noise(580, 0.075, 0.062).sigma(5), 1.425e-3 * 25, 2e-4);
  EXPECT_NEAR(stereo_noise(500, 0.1, 0.1).sigma(2), 4 * 0.1 / 50, 1e-12);
  // Fankhauser 2015 in millimetres: 1.5 - 0.5 z + 0.3 z^2 + 0.1 z^1.5 theta^2 / (pi/2 - theta)^2.
  EXPECT_NEAR(time_of_flight_noise().sigma(2), 1e-3 * (1.5 - 1 + 1.2), 1e-12);
  EXPECT_NEAR(time_of_flight_noise().sigma(2, M_PI / 3), 1e-3 * (1.7 + 0.1 * std::pow(2, 1.5) * 4), 1e-12);
}

/// Every model of the table keeps the same rules.
TEST(DepthNoise, EveryModelIsPositiveAndGrowsWithTheSlant) {
  for (const DepthNoise& noise :
       {constant_noise(0.001), structured_light_noise(), stereo_noise(500, 0.1, 0.1), time_of_flight_noise()}) {
    noise.check(0.1, 8);
    for (double z = 0.1; z <= 8; z += 0.05) {
      double before = 0;
      for (double incidence = 0; incidence < 1.5; incidence += 0.1) {
        const double sigma = noise.sigma(z, incidence);
        EXPECT_GT(sigma, 0);
        EXPECT_GE(sigma, before);
        before = sigma;
      }
    }
  }
}

TEST(DepthNoise, RefusesWhatIsNotPositive) {
  EXPECT_THROW(constant_noise(0), InvalidInput);
  EXPECT_THROW(constant_noise(NAN), InvalidInput);
  EXPECT_THROW(stereo_noise(-500, 0.1, 0.1), InvalidInput);
  EXPECT_THROW(stereo_noise(500, 0, 0.1), InvalidInput);
  EXPECT_THROW((DepthNoise{0.001, -0.001}.check(0.1, 5)), InvalidInput);          // negative beyond 1 m
  EXPECT_THROW((DepthNoise{0.001, -0.003, 0.0015}.check(0.1, 5)), InvalidInput);  // in between only
  EXPECT_THROW((DepthNoise{0.001, 0, 0, -1}.check(0.1, 5)), InvalidInput);
  EXPECT_THROW((DepthNoise{9e-8}.check(0.1, 5)), InvalidInput);  // its weight would be more than a float holds
  EXPECT_NO_THROW((DepthNoise{1e-7}.check(0.1, 5)));
  EXPECT_THROW(constant_noise(1e-20), InvalidInput);
}

TEST(DepthCamera, BadFieldsAreNamed) {
  const auto message = [](const auto& change) {
    DepthCamera camera;
    change(camera);
    try {
      camera.check();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message([](DepthCamera&) {}), "accepted");
  EXPECT_NE(message([](DepthCamera& c) { c.name = ""; }).find("camera.name"), std::string::npos);
  EXPECT_NE(message([](DepthCamera& c) { c.intrinsics.fx = -525; }).find("camera.fx"), std::string::npos);
  EXPECT_NE(message([](DepthCamera& c) { c.systematic = -1; }).find("camera.systematic"), std::string::npos);
  EXPECT_NE(message([](DepthCamera& c) { c.systematic_scale = NAN; }).find("systematic_scale"), std::string::npos);
  EXPECT_NE(message([](DepthCamera& c) { c.noise.constant = 0; }).find("noise"), std::string::npos);
}
