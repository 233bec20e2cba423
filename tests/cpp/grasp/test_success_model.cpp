#include "mmgrasp/grasp/success_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/grasp/line_grasp.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

ContactPatch contact(const Vector3d& point, const Vector3d& pad_normal, const Vector3d& normal, double distance = 0.01,
                     double sigma = 0.0) {
  ContactPatch patch;
  patch.point = point;
  patch.pad_normal = pad_normal.normalized();
  patch.normal = normal.normalized();
  patch.distance = distance;
  patch.sigma = sigma;
  patch.hits = patch.inliers = 1;
  return patch;
}

/// A box 40 mm wide between two fingers, faces turned by `slant` against the pads about x.
std::vector<ContactPatch> box_between_fingers(double slant = 0, double distance = 0.01, double sigma = 0) {
  const Vector3d left(0, -std::cos(slant), std::sin(slant)), right(0, std::cos(slant), std::sin(slant));
  return {contact({0, -0.02, 0}, Vector3d::UnitY(), left, distance, sigma),
          contact({0, 0.02, 0}, -Vector3d::UnitY(), right, distance, sigma)};
}

/// Midpoint rule over the object's place.
double integrated(const LineGrasp& grasp, double opening, double position, double mean, double sigma) {
  const int steps = 400000;
  const double begin = mean - 8 * sigma, step = 16 * sigma / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double x = begin + (i + 0.5) * step, z = (x - mean) / sigma;
    sum += grasp.success(opening, position, x) * std::exp(-z * z / 2) / (sigma * std::sqrt(2 * kPi)) * step;
  }
  return sum;
}

/// Contacts around a circle of 3 cm in the plane z = 0, pushing inwards, and up or down.
std::vector<ContactPatch> around(const std::vector<double>& angles, double up = 0) {
  std::vector<ContactPatch> patches;
  for (const double a : angles) {
    const Vector3d out(std::cos(a), std::sin(a), up);
    patches.push_back(contact(0.03 * Vector3d(std::cos(a), std::sin(a), 0), -out, out));
  }
  return patches;
}

/// By definition, along many directions: zero is interior when some wrench of a cone points along each of them. Cones
/// are round here: their largest product with (f, t) has a closed form.
bool resists_everything(const std::vector<ContactPatch>& patches, double friction, int directions) {
  Rng rng(3);
  for (int k = 0; k < directions; ++k) {
    Vector3d force, torque;
    for (int i = 0; i < 3; ++i) {
      force[i] = rng.normal();
      torque[i] = rng.normal() / 0.03;
    }
    double most = -1;
    for (const ContactPatch& patch : patches) {
      const Vector3d a = force + torque.cross(patch.point), inward = -patch.normal;  // f . w over unit normal force
      most = std::max(most, a.dot(inward) + friction * (a - a.dot(inward) * inward).norm());
    }
    if (most <= 0) return false;
  }
  return true;
}

}  // namespace

TEST(LineGrasp, FigureOfThePaper) {
  const LineGrasp grasp;                                          // w = 0.2, u_max = 0.4: figure 4.6
  EXPECT_NEAR(grasp.probability(0.4, 0, 0, 0.3), 0.1318, 5e-5);   // printed: 0.13
  EXPECT_NEAR(grasp.probability(0.4, 0, 0, 0.03), 0.7607, 5e-5);  // printed: 0.76
  for (const double sigma : {0.03, 0.3}) {
    for (const double position : {0.0, 0.04, -0.11}) {
      for (const double opening : {0.21, 0.3, 0.4}) {
        EXPECT_NEAR(grasp.probability(opening, position, 0.02, sigma),
                    integrated(grasp, opening, position, 0.02, sigma), 2e-5);  // one step where it jumps
        // The optimum is wide open at the object's mean place.
        EXPECT_LE(grasp.probability(opening, position, 0.0, sigma), grasp.probability(0.4, 0, 0, sigma) + 1e-12);
      }
    }
  }
  EXPECT_EQ(grasp.probability(0.2, 0, 0, 0.03), 0);  // no wider than the object
  EXPECT_EQ(grasp.success(0.3, 0, 0.051), 0);        // a fingertip in the object
  EXPECT_NEAR(grasp.success(0.3, 0, 0.049), 0.51, 1e-12);
  EXPECT_THROW(LineGrasp({0.4, 0.4}).success(0.3, 0, 0), InvalidInput);
}

TEST(SuccessModel, BoxBetweenParallelFingers) {
  const ObjectExtent object{Vector3d::Zero(), 0.1};
  const GraspSuccess best = evaluate_success(box_between_fingers(), object, 0.01);
  for (const double share : {best.angle, best.placement, best.centring, best.certainty}) EXPECT_NEAR(share, 1, 1e-12);
  EXPECT_NEAR(best.probability, 1, 1e-12);
  EXPECT_TRUE(best.force_closure);

  // 3 mm too near on both sides, 1 mm of standard deviation, line of contact 20 mm off the middle, 0.5 rad cone.
  SuccessOptions options;
  options.friction = std::tan(0.5);
  const GraspSuccess some =
      evaluate_success(box_between_fingers(0.2, 0.007, 0.001), {{0.012, 0.01, 0.016}, 0.1}, 0.01, options);
  EXPECT_NEAR(some.angle, 0.6 * 0.6, 1e-12);
  EXPECT_NEAR(some.placement, std::exp(-0.6), 1e-12);
  EXPECT_NEAR(some.centring, 0.6, 1e-12);
  EXPECT_NEAR(some.certainty, 0.8 * 0.8, 1e-12);
  const double sum = 0.6 * 0.36 + 0.1 * std::exp(-0.6) + 0.2 * 0.6 + 0.1 * 0.64;
  EXPECT_NEAR(some.weighted, sum, 1e-12);
  EXPECT_NEAR(some.probability, sum, 1e-12);
}

TEST(SuccessModel, PlacementNearerThanWantedStaysBelowOne) {
  // (4.6) as printed has no absolute value: exp(+0.4) for fingers that are 2 mm too near.
  EXPECT_NEAR(placement_criterion(box_between_fingers(0, 0.008), 0.01, 0.01), std::exp(-0.4), 1e-12);
  EXPECT_NEAR(placement_criterion(box_between_fingers(0, 0.012), 0.01, 0.01), std::exp(-0.4), 1e-12);
}

TEST(SuccessModel, WeightedSumIsGated) {
  const ObjectExtent object{Vector3d::Zero(), 0.1};
  // Faces outside the friction cone: (4.9) as printed gives 0.4.
  const GraspSuccess slips = evaluate_success(box_between_fingers(0.6), object, 0.01);
  EXPECT_EQ(slips.angle, 0);
  EXPECT_NEAR(slips.weighted, 0.4, 1e-12);
  EXPECT_FALSE(slips.force_closure);
  EXPECT_EQ(slips.probability, 0);
  // A surface too uncertain to be touched.
  const GraspSuccess unsure = evaluate_success(box_between_fingers(0, 0.01, 0.005), object, 0.01);
  EXPECT_EQ(unsure.certainty, 0);
  EXPECT_TRUE(unsure.force_closure);
  EXPECT_EQ(unsure.probability, 0);
  // Pads face their patches, but these are not opposite each other.
  auto beside = box_between_fingers();
  beside[1].point.x() += 0.03;
  const GraspSuccess twists = evaluate_success(beside, object, 0.01);
  EXPECT_EQ(twists.angle, 1);
  EXPECT_FALSE(twists.force_closure);
  EXPECT_EQ(twists.probability, 0);
}

TEST(SuccessModel, ForceClosureOfTwoPatchesIsTheLineInBothCones) {
  for (const double friction : {0.2, 0.5, 1.0}) {
    const double limit = std::atan(friction);
    for (const double slant : {0.0, 0.1, limit - 1e-6, limit + 1e-6, 1.2}) {
      EXPECT_EQ(has_force_closure(box_between_fingers(slant), friction), slant < limit);
      auto one = box_between_fingers();
      one[1].normal = Vector3d(std::sin(slant), std::cos(slant), 0);
      EXPECT_EQ(has_force_closure(one, friction), slant < limit);
    }
  }
  auto inside_out = box_between_fingers();
  for (ContactPatch& patch : inside_out) patch.normal = -patch.normal;
  EXPECT_FALSE(has_force_closure(inside_out, 0.5));
  auto same = box_between_fingers();
  same[1].point = same[0].point;
  EXPECT_FALSE(has_force_closure(same, 0.5));
  EXPECT_FALSE(has_force_closure({}, 0.5));
  EXPECT_FALSE(has_force_closure({box_between_fingers()[0]}, 0.5));
}

TEST(SuccessModel, ForceClosureOfThreeContacts) {
  const double third = 2 * kPi / 3;
  const auto even = around({0, third, 2 * third}), one_side = around({0, 0.3, 0.6}),
             pushed_down = around({0, third, 2 * third}, 0.7);
  EXPECT_TRUE(has_force_closure(even, 0.5));
  EXPECT_TRUE(resists_everything(even, 0.5, 50000));
  EXPECT_FALSE(has_force_closure(even, 1e-12));  // without friction the circle turns
  EXPECT_FALSE(has_force_closure(one_side, 0.5));
  EXPECT_FALSE(resists_everything(one_side, 0.5, 50000));
  EXPECT_FALSE(has_force_closure(pushed_down, 0.5));  // all push down by more than the cone's 26.6 degrees
  EXPECT_FALSE(resists_everything(pushed_down, 0.5, 50000));
  EXPECT_TRUE(has_force_closure(pushed_down, 0.9));
  EXPECT_TRUE(resists_everything(pushed_down, 0.9, 50000));
}

TEST(SuccessModel, ForceClosureOfRandomContactsIsThatOfTheirCones) {
  Rng rng(7);
  int closed = 0, open = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<ContactPatch> patches;
    for (int i = 0; i < 3 + trial % 2; ++i) {
      const Vector3d out(rng.normal(), rng.normal(), 0.5 * rng.normal());
      patches.push_back(contact(0.03 * out.normalized(), -out, out));
    }
    const bool found = has_force_closure(patches, 0.6);
    // Pyramids lie within the cones: what they say holds of the cones, and the cones' failure is theirs.
    if (found) {
      EXPECT_TRUE(resists_everything(patches, 0.6, 20000));
    }
    if (!resists_everything(patches, 0.6, 20000)) {
      EXPECT_FALSE(found);
    }
    ++(found ? closed : open);
  }
  EXPECT_GT(closed, 5);
  EXPECT_GT(open, 5);
}

TEST(SuccessModel, CentringOfThreeContactsTakesTheTwoOfOneSideAsOne) {
  std::vector<ContactPatch> patches{contact({0, -0.02, 0}, Vector3d::UnitY(), -Vector3d::UnitY()),
                                    contact({0.02, 0.02, 0}, -Vector3d::UnitY(), Vector3d::UnitY()),
                                    contact({-0.01, 0.02, 0}, -Vector3d::UnitY(), Vector3d::UnitY())};
  // The line runs from (0, -20, 0) to (5, 20, 0) mm; its distance from (0, -20, 10) mm is 10 mm.
  EXPECT_NEAR(centring_criterion(patches, {{0, -0.02, 0.01}, 0.1}), 0.8, 1e-12);
  EXPECT_EQ(centring_criterion(patches, {{0, -0.02, 0.06}, 0.1}), 0);
}

TEST(SuccessModel, OptionsOutOfRangeAreNamed) {
  SuccessOptions options;
  options.angle_weight = 0.7;
  try {
    evaluate_success(box_between_fingers(), {}, 0.01, options);
    FAIL();
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("sum of the four weights"), std::string::npos) << error.what();
  }
  EXPECT_THROW(evaluate_success(box_between_fingers(), {Vector3d::Zero(), 0}, 0.01), InvalidInput);
  EXPECT_THROW(evaluate_success(box_between_fingers(), {}, -0.01), InvalidInput);
}

}  // namespace mmgrasp
