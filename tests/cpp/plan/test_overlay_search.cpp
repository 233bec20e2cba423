#include "plan/overlay_search.hpp"

#include <gtest/gtest.h>

#include "plan/planar_arm.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kVertices = 100'000;

/// One grasp over a large roadmap; no link leads into its goal, so that a search must look at all there is.
class WithoutAWay : public ::testing::Test {
 protected:
  WithoutAWay() : overlay_(roadmap_, candidate()), robot_(roadmap_), search_(roadmap_) {
    overlay_.connect(roadmap_, false, 1e9);
    for (const int link : overlay_.into_goals) overlay_.links[static_cast<std::size_t>(link)].blocked = true;
    search_.robot_is_free = [this](int) {
      if (++asked_ == stop_at_) stop_ = true;
      return true;
    };
    search_.stopped = [this] { return stop_; };
  }

  static Roadmap large_roadmap() {
    RoadmapOptions options;
    options.vertices = kVertices;
    options.neighbours = 8;
    return Roadmap::build(test::PlanarArm(3).group(), options);
  }
  static CarryCandidate candidate() {
    CarryCandidate out;
    out.starts = {Eigen::Vector3d(1, 0.5, 0)};
    out.goals = {Eigen::Vector3d(-1, 0.5, 0.2)};
    return out;
  }

  Roadmap roadmap_ = large_roadmap();
  GraspOverlay overlay_;
  RoadmapKnowledge robot_;
  OverlaySearch search_;
  int asked_ = 0, stop_at_ = -1;
  bool stop_ = false;
};

TEST_F(WithoutAWay, StopsSoonAndSaysHowFarItCame) {
  stop_at_ = 2000;
  const double straight = (overlay_.goal(0) - overlay_.start(0)).norm();
  EXPECT_EQ(search_.search(overlay_, robot_, 1e9), OverlaySearch::End::gave_up);
  EXPECT_GE(asked_, stop_at_);
  EXPECT_LE(asked_, stop_at_ + 256);
  EXPECT_GE(search_.reached(), straight - 1e-9);
  const double before = search_.reached();
  // Stopped already.
  EXPECT_EQ(search_.search(overlay_, RoadmapKnowledge(roadmap_), 1e9), OverlaySearch::End::gave_up);
  EXPECT_GE(search_.reached(), straight - 1e-9);
  stop_ = false;
  asked_ = 0;
  stop_at_ = 5000;
  EXPECT_EQ(search_.search(overlay_, RoadmapKnowledge(roadmap_), 1e9), OverlaySearch::End::gave_up);
  EXPECT_GT(search_.reached(), before);
}

TEST_F(WithoutAWay, WhatIsKnownIsNotAskedAgain) {
  stop_at_ = 500;
  EXPECT_EQ(search_.search(overlay_, robot_, 1e9), OverlaySearch::End::gave_up);
  const int asked = asked_;
  EXPECT_EQ(search_.search(overlay_, robot_, 1e9), OverlaySearch::End::gave_up);
  EXPECT_EQ(asked_, asked);
  stop_ = false;
  EXPECT_EQ(search_.search(overlay_, robot_, 1e9), OverlaySearch::End::none);
  EXPECT_GT(asked_, kVertices / 2);
  const int all = asked_;
  EXPECT_EQ(search_.search(overlay_, robot_, 1e9), OverlaySearch::End::none);
  EXPECT_EQ(asked_, all);
}

}  // namespace
}  // namespace mmgrasp::detail
