#include "mmgrasp/grasp/next_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "grasp/scanned_object.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Vector3d;

namespace {

constexpr double kPoseShift = 0.001, kPoseTurn = 0.003;

DepthCamera noisy_camera() {
  DepthCamera camera = small_camera(0.001);
  camera.noise = DepthNoise{0.0008, 0, 0.006};
  return camera;
}

NextViewOptions options_on_table() {
  NextViewOptions options;
  options.threads = 1;
  options.uncertainty = FrameUncertainty::of_pose(kPoseShift, kPoseTurn);
  options.synthesis.table = 0.0;
  options.synthesis.threads = 1;
  return options;
}

SdfOptions coarse() {
  SdfOptions options;
  options.voxel = 0.0025;
  options.truncation = 0.0125;
  options.threads = 1;
  return options;
}

void look(ProbabilisticSdf& map, const std::vector<PlacedShape>& scene, const Pose& T, Rng& rng) {
  const DepthCamera camera = noisy_camera();
  DepthImage image = frame_of(scene, camera, T);
  disturb(image, camera, rng);
  const Vector3d turn(rng.normal(), rng.normal(), rng.normal()), shift(rng.normal(), rng.normal(), rng.normal());
  const Vector3d angle = kPoseTurn * turn;
  image.T_world_camera.linear() = Eigen::AngleAxisd(angle.norm(), angle.normalized()).matrix() * T.linear();
  image.T_world_camera.translation() += kPoseShift * shift;
  map.integrate(image, camera, FrameUncertainty::of_pose(kPoseShift, kPoseTurn));
}

/// The fixed views, as a user would set them up: from above to the side and all around.
Pose fixed_view(int k) {
  const double turn = 2.4 * k, up = (k % 3 == 0 ? 65 : k % 3 == 1 ? 30 : 48) * M_PI / 180;
  return look_at(Vector3d(0, 0, 0.03) +
                     0.35 * Vector3d(std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)),
                 {0, 0, 0.03});
}

double best_probability(const ProbabilisticSdf& map, const NextViewOptions& options) {
  SynthesisOptions search = options.synthesis;
  search.samples = 600;
  const GraspSynthesis found = synthesize_grasps(map, test_hand(), search);
  return found.grasps.empty() ? 0 : found.grasps[0].quality;
}

std::vector<std::vector<PlacedShape>> parts() {
  return {
      {{Box{{0.045, 0.07, 0.06}}, at(0, 0, 0.03, 0.4)}},
      {{Cylinder{0.03, 0.09}, at(0, 0, 0.045)}},
      {{Box{{0.14, 0.025, 0.03}}, at(0, 0, 0.015, 1.0)}, {Box{{0.03, 0.06, 0.05}}, at(0.03, 0.05, 0.025, 1.0)}},
      // An L, whose inner side hides from most views.
      {{Box{{0.10, 0.03, 0.05}}, at(0, 0, 0.025)}, {Box{{0.03, 0.09, 0.05}}, at(-0.035, 0.06, 0.025)}},
      {{Cylinder{0.028, 0.10}, at(0, 0, 0.05)}, {Cylinder{0.013, 0.04}, at(0, 0, 0.12)}},
  };
}

}  // namespace

TEST(NextView, LooksAtTheOtherSide) {
  const std::vector<PlacedShape> scene{table_plane(), {Box{{0.08, 0.04, 0.07}}, at(0, 0, 0.035)}};
  ProbabilisticSdf map(coarse());
  Rng rng(1);
  look(map, scene, look_at({0, -0.33, 0.12}, {0, 0, 0.035}), rng);
  const NextViewOptions options = options_on_table();
  const NextView found = next_view(map, test_hand(), noisy_camera(), options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  ASSERT_EQ(found.candidates.size(), 24u);
  EXPECT_LT(found.probability_now, 0.3);
  const ViewCandidate& best = found.candidates[0];
  EXPECT_GT(best.T_world_camera.translation().y(), 0.05);
  EXPECT_GT(best.unseen, 0.2);
  const auto score = [](const ViewCandidate& c) { return c.probability + c.certain; };
  for (std::size_t i = 1; i < found.candidates.size(); ++i)
    EXPECT_LE(score(found.candidates[i]), score(found.candidates[i - 1]));
  // Each looks at the object from the given distance, above the horizontal.
  for (const ViewCandidate& each : found.candidates) {
    const Pose& T = each.T_world_camera;
    EXPECT_GT(T.translation().z(), 0.1);
    const Vector3d ahead = T * Vector3d(0, 0, options.distance);
    EXPECT_LT(ahead.head<2>().norm(), 0.05);
  }
}

/// Another body within the hand's reach, which no view hides: what would be certain of it says nothing of the object.
TEST(NextView, ANeighbourDoesNotCount) {
  const PlacedShape box{Box{{0.08, 0.04, 0.07}}, at(0, 0, 0.035)},
      neighbour{Box{{0.10, 0.36, 0.06}}, at(0.29, 0, 0.03)};
  NextViewOptions options = options_on_table();
  options.synthesis.object = Eigen::AlignedBox3d(Vector3d(-0.08, -0.08, 0), Vector3d(0.08, 0.08, 0.12));
  options.candidates = 12;
  std::vector<ViewCandidate> alone, beside;
  for (const bool with : {false, true}) {
    std::vector<PlacedShape> scene{table_plane(), box};
    if (with) scene.push_back(neighbour);
    ProbabilisticSdf map(coarse());
    Rng rng(1);
    look(map, scene, look_at({0, -0.33, 0.12}, {0, 0, 0.035}), rng);
    look(map, scene, look_at({0.29, -0.33, 0.12}, {0.29, 0, 0.03}), rng);
    (with ? beside : alone) = next_view(map, test_hand(), noisy_camera(), options).candidates;
  }
  ASSERT_EQ(alone.size(), beside.size());
  for (const ViewCandidate& one : alone) {
    for (const ViewCandidate& other : beside) {
      if ((one.T_world_camera.translation() - other.T_world_camera.translation()).norm() > 0.02) continue;
      EXPECT_NEAR(one.certain, other.certain, 0.02) << one.T_world_camera.translation().transpose();
    }
  }
}

/// Chosen views beside fixed ones: probability of the best grasp after as many views, the first the same.
TEST(NextView, ChosenViewsAreSureSooner) {
  constexpr int kViews = 5;
  double fixed[kViews] = {}, chosen[kViews] = {};
  int runs = 0;
  for (const auto& part : parts()) {
    std::vector<PlacedShape> scene{table_plane()};
    scene.insert(scene.end(), part.begin(), part.end());
    for (int seed = 0; seed < 1; ++seed, ++runs) {
      ProbabilisticSdf by_list(coarse()), by_choice(coarse());
      Rng first(17, seed), second(17, seed);
      NextViewOptions options = options_on_table();
      options.seed = seed + 1;
      options.synthesis.seed = seed + 1;
      options.candidates = 10;
      options.draws = 1;
      for (int k = 0; k < kViews; ++k) {
        look(by_list, scene, fixed_view(k + 7 * seed), first);
        const Pose T = k == 0 ? fixed_view(7 * seed)
                              : next_view(by_choice, test_hand(), noisy_camera(), options).candidates[0].T_world_camera;
        look(by_choice, scene, T, second);
        fixed[k] += best_probability(by_list, options);
        chosen[k] += best_probability(by_choice, options);
      }
    }
  }
  for (int k = 0; k < kViews; ++k) {
    std::printf("%d views: fixed %.3f, chosen %.3f\n", k + 1, fixed[k] / runs, chosen[k] / runs);
  }
  // As sure after three as the fixed ones after five, and far surer after as many.
  EXPECT_GT(chosen[2], fixed[4]);
  EXPECT_GT(chosen[4], fixed[4] + 0.3 * runs);
}

TEST(NextView, IsTheSameAtAnyThreadCountAndHearsTheArm) {
  const std::vector<PlacedShape> scene{table_plane(), {Cylinder{0.03, 0.09}, at(0, 0, 0.045)}};
  ProbabilisticSdf map(coarse());
  Rng rng(1);
  look(map, scene, fixed_view(0), rng);
  NextViewOptions options = options_on_table();
  options.candidates = 8;
  const NextView one = next_view(map, test_hand(), noisy_camera(), options);
  options.threads = 3;
  const NextView three = next_view(map, test_hand(), noisy_camera(), options);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(one.candidates[k].T_world_camera.matrix(), three.candidates[k].T_world_camera.matrix());
    EXPECT_EQ(one.candidates[k].probability, three.candidates[k].probability);
  }
  const ArmReach right_side = [](const Pose& T, Eigen::VectorXd& q) {
    q = Eigen::VectorXd::Constant(1, T.translation().y());
    return T.translation().y() > 0 ? Rejection::none : Rejection::scene;
  };
  const NextView reached = next_view(map, test_hand(), noisy_camera(), options, {}, right_side);
  EXPECT_EQ(reached.candidates.size() + reached.arm.scene, 8u);
  EXPECT_GT(reached.arm.scene, 0u);
  for (const ViewCandidate& each : reached.candidates) EXPECT_EQ(each.q[0], each.T_world_camera.translation().y());
  const ArmReach nowhere = [](const Pose&, Eigen::VectorXd&) { return Rejection::unreachable; };
  const NextView none = next_view(map, test_hand(), noisy_camera(), options, {}, nowhere);
  EXPECT_EQ(none.outcome, Outcome::not_found);
  EXPECT_EQ(none.arm.unreachable, 8u);
  Monitor stopped;
  stopped.stop.stop();
  EXPECT_EQ(next_view(map, test_hand(), noisy_camera(), options, stopped).outcome, Outcome::stopped);
}

TEST(NextView, RefusesWhatItCannotUse) {
  EXPECT_THROW(next_view(ProbabilisticSdf{}, test_hand(), noisy_camera()), InvalidInput);
  NextViewOptions options;
  options.candidates = 0;
  EXPECT_THROW(options.check(), InvalidInput);
  options = {};
  options.min_elevation = 1.4;
  EXPECT_THROW(options.check(), InvalidInput);
  options = {};
  options.distance = -1;
  EXPECT_THROW(options.check(), InvalidInput);
  options = {};
  options.draws = 0;
  EXPECT_THROW(options.check(), InvalidInput);
}
