#include "mmgrasp/grasp/hand_mask.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/tray_scene.hpp"

using namespace mmgrasp;

namespace {

constexpr double kPi = 3.14159265358979323846;

int brute_force(const std::vector<std::uint8_t>& image, int nx, int ny, const MaskImage& mask, bool outside, int x,
                int y) {
  int count = 0;
  for (int dy = -mask.radius; dy <= mask.radius; ++dy) {
    for (int dx = -mask.radius; dx <= mask.radius; ++dx) {
      if (!mask.at(dx, dy)) continue;
      const int u = x + dx, v = y + dy;
      const bool inside = u >= 0 && v >= 0 && u < nx && v < ny;
      count += inside ? image[static_cast<std::size_t>(v) * nx + u] : outside;
    }
  }
  return count;
}

}  // namespace

TEST(HandMask, ConvolutionEqualsBruteForce) {
  Rng rng(1);
  for (const auto& [nx, ny] : {std::pair{37, 23}, std::pair{5, 40}, std::pair{1, 1}}) {
    std::vector<std::uint8_t> image(static_cast<std::size_t>(nx) * ny);
    for (auto& cell : image) cell = rng.uniform() < 0.4;
    MaskImage odd;  // no rectangle: several runs in a row
    odd.radius = 6;
    odd.cells.resize(169);
    for (auto& cell : odd.cells) cell = rng.uniform() < 0.5;
    const HandMasks masks = make_hand_masks(tray_scene::gripper(), 0.06, 0.7, 0.01);
    for (const MaskImage* mask : {static_cast<const MaskImage*>(&odd), &masks.contact, &masks.fingers, &masks.palm}) {
      for (const bool outside : {false, true}) {
        const auto counts = convolve_mask(image, nx, ny, *mask, outside);
        for (int y = 0; y < ny; ++y)
          for (int x = 0; x < nx; ++x)
            ASSERT_EQ(counts[static_cast<std::size_t>(y) * nx + x], brute_force(image, nx, ny, *mask, outside, x, y));
      }
    }
  }
}

TEST(HandMask, AreasAreThoseOfTheHand) {
  const Hand gripper = tray_scene::gripper();
  const double cell = 0.0005;
  for (const double angle : {0.0, 0.3, 1.1, 2.5}) {
    const HandMasks masks = make_hand_masks(gripper, 0.08, angle, cell, 0);
    EXPECT_NEAR(masks.contact.count() * cell * cell, 0.08 * 0.022, 0.03 * 0.08 * 0.022);
    const double grow = 2 * cell * std::sqrt(0.5);  // fingers cover every cell they touch
    const double finger = (0.012 + grow) * (0.022 + grow);
    EXPECT_NEAR(masks.fingers.count() * cell * cell, 2 * finger, 0.06 * finger);
  }
}

TEST(HandMask, CoversEveryPointOfTheFingers) {
  const Hand gripper = tray_scene::gripper();
  Rng rng(4);
  const double cell = 0.004;
  for (int i = 0; i < 3000; ++i) {
    const double angle = rng.uniform(0, kPi), opening = rng.uniform(0.0, 0.1);
    const HandMasks masks = make_hand_masks(gripper, opening, angle, cell);
    const double side = rng.uniform() < 0.5 ? -1 : 1;
    const double u = side * (opening / 2 + rng.uniform(0, gripper.body.finger_thickness));
    const double v = rng.uniform(-0.5, 0.5) * gripper.finger_width;
    const int dx = static_cast<int>(std::lround((u * std::cos(angle) - v * std::sin(angle)) / cell));
    const int dy = static_cast<int>(std::lround((u * std::sin(angle) + v * std::cos(angle)) / cell));
    ASSERT_TRUE(masks.fingers.at(dx, dy));
    i += 9;
  }
}

TEST(HandMask, QuarterAndHalfTurnsAreExact) {
  const Hand gripper = tray_scene::gripper();
  for (const double angle : {0.0, kPi / 8, kPi / 16 * 5, 0.4}) {
    const HandMasks a = make_hand_masks(gripper, 0.07, angle, 0.002);
    const HandMasks b = make_hand_masks(gripper, 0.07, angle + kPi / 2, 0.002);
    ASSERT_EQ(a.fingers.radius, b.fingers.radius);
    for (int y = -a.fingers.radius; y <= a.fingers.radius; ++y) {
      for (int x = -a.fingers.radius; x <= a.fingers.radius; ++x) {
        ASSERT_EQ(a.fingers.at(x, y), b.fingers.at(-y, x));
        ASSERT_EQ(a.fingers.at(x, y), a.fingers.at(-x, -y));
      }
    }
  }
}

TEST(HandMask, MisuseIsRefused) {
  EXPECT_THROW(make_hand_masks(tray_scene::gripper(), 0.2, 0, 0.002), InvalidInput);
  EXPECT_THROW(make_hand_masks(tray_scene::gripper(), 0.1, 0, 0), InvalidInput);
  EXPECT_THROW(convolve_mask({1, 0}, 3, 1, MaskImage{0, {1}}, false), InvalidInput);
  EXPECT_THROW(convolve_mask({1, 0}, 2, 1, MaskImage{1, {1}}, false), InvalidInput);
}
