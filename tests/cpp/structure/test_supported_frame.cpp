#include "mmgrasp/structure/supported_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "beam_frames.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/structure/pipe_grasps.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kG = 9.81;

/// One straight tube of P2 table 3.4 along a direction.
BeamFrame tube(double length, const Vector3d& along = Vector3d::UnitX()) {
  BeamFrame frame;
  frame.nodes = {Vector3d::Zero(), length * along.normalized()};
  BeamMember member;
  member.nodes = {0, 1};
  member.section = round_section(0.012, 0.010);
  member.material = copper();
  frame.members = {member};
  return frame;
}

/// Weight per length [N/m] and flexural rigidity [N m2] of that tube.
double weight() {
  const BeamFrame t = tube(1);
  return t.mass() * kG;
}
double rigidity() {
  return 110e9 * round_section(0.012, 0.010).iy;
}

BeamSupport at(int member, double distance) {
  BeamSupport support;
  support.member = member;
  support.distance = distance;
  return support;
}

TEST(SupportedFrame, CantileverInEveryDirection) {
  Rng rng(3);
  EXPECT_NEAR(weight() * std::pow(0.4, 4) / (8 * rigidity()), 0.16768e-3, 1e-8);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = rng.rotation().toRotationMatrix();
    const SupportedFrame held(tube(0.4, R.col(0)), {at(0, 0)});
    for (const int across : {1, 2}) {
      const BeamState state = held.state(kG * R.col(across));
      EXPECT_NEAR(state.displacement.value, 0.16768e-3, 1e-8);
      EXPECT_NEAR(state.displacement.distance, 0.4, 1e-12);
      EXPECT_NEAR(state.nodes.col(1).head<3>().dot(R.col(across)), weight() * std::pow(0.4, 4) / (8 * rigidity()),
                  1e-15);
      // The printed moments (P2 figure 3.6 for any direction) would give a tip 5/3 too large for one of the two.
      const Vector3d turn = R.col(0).cross(R.col(across));
      EXPECT_NEAR(state.nodes.col(1).tail<3>().dot(turn), weight() * std::pow(0.4, 3) / (6 * rigidity()), 1e-15);
      EXPECT_NEAR(state.reactions.col(0).tail<3>().dot(turn), -weight() * 0.16 / 2, 1e-12);
      ASSERT_TRUE(state.stress);
      EXPECT_NEAR(state.stress->value, weight() * 0.16 / 2 * 0.006 / round_section(0.012, 0.010).iy, 1e-3);
      EXPECT_NEAR(state.stress->distance, 0, 1e-12);
    }
    const BeamState hanging = held.state(kG * R.col(0));
    EXPECT_NEAR(hanging.displacement.value, weight() * 0.16 / (2 * 110e9 * round_section(0.012, 0.010).area), 1e-15);
  }
}

TEST(SupportedFrame, SagsBetweenClampsAndPins) {
  const double L = 0.8, w = weight(), EI = rigidity();
  const SupportedFrame clamped(tube(L), {at(0, 0), at(0, L)});
  BeamState state = clamped.state({0, 0, -kG});
  EXPECT_NEAR(state.displacement.value, w * std::pow(L, 4) / (384 * EI), 1e-9 * state.displacement.value);
  EXPECT_NEAR(state.displacement.distance, L / 2, 1e-4);
  EXPECT_NEAR(state.reactions(4, 0), -w * L * L / 12, 1e-12);
  EXPECT_NEAR(std::abs(clamped.section_forces({0, 0, -kG}, 0, L / 2)(5)), w * L * L / 24, 1e-12);

  BeamSupport left = at(0, 0), right = at(0, L);
  left.fixed = {true, true, true, true, false, false};
  right.fixed = {false, true, true, false, false, false};
  const SupportedFrame pinned(tube(L), {left, right});
  state = pinned.state({0, kG, 0});
  EXPECT_NEAR(state.displacement.value, 5 * w * std::pow(L, 4) / (384 * EI), 1e-9 * state.displacement.value);
  EXPECT_NEAR(state.stress->value, w * L * L / 8 * 0.006 / round_section(0.012, 0.010).iy, 1e-3);
  EXPECT_NEAR(state.stress->distance, L / 2, 1e-5);
  EXPECT_NEAR(state.reactions(1, 0), -w * L / 2, 1e-12);

  BeamFrame loaded = tube(L).split(0, L / 2);  // a valve and a pull at the middle
  NodeLoad load;
  load.node = 2;
  load.mass = 0.5;
  load.force = {0, 0, -2};
  loaded.loads = {load};
  right.member = 1;
  right.distance = L / 2;
  state = SupportedFrame(loaded, {left, right}).state({0, 0, -kG});
  EXPECT_NEAR(state.displacement.value, (5 * w * std::pow(L, 4) / 384 + (0.5 * kG + 2) * std::pow(L, 3) / 48) / EI,
              1e-10);
}

TEST(SupportedFrame, TorqueTwistsAnElbow) {  // one leg bends the other twists: closed form by Castigliano
  BeamFrame frame = tube(0.3);
  frame.nodes.emplace_back(0.3, 0.2, 0);
  frame.members.push_back(frame.members[0]);
  frame.members[1].nodes = {1, 2};
  NodeLoad load;
  load.node = 2;
  load.force = {0, 0, -1};
  frame.loads = {load};
  const BeamState state = SupportedFrame(frame, {at(0, 0)}).state(Vector3d::Zero());
  const double GJ = 40e9 * round_section(0.012, 0.010).torsion;
  const double tip = (std::pow(0.3, 3) + std::pow(0.2, 3)) / (3 * rigidity()) + 0.2 * 0.2 * 0.3 / GJ;
  EXPECT_NEAR(state.displacement.value, tip, 1e-12);
  const double I = round_section(0.012, 0.010).iy, bending = 0.3 * 0.006 / I, shear = 0.2 * 0.006 / (2 * I);
  EXPECT_NEAR(state.stress->value, std::sqrt(bending * bending + 3 * shear * shear), 1e-3);
}

TEST(SupportedFrame, LoganProblem5_30) {  // kip and inch; in the XY plane, so members bend about the object's z
  BeamFrame frame;
  frame.nodes = {{0, 0, 0}, {0, 360, 0}, {180, 480, 0}, {420, 480, 0}, {600, 360, 0}, {600, 0, 0}};
  for (int i = 0; i < 5; ++i) {
    BeamMember member;
    member.nodes = {i, i + 1};
    member.section.area = 12;
    member.section.iy = 200;  // y is the object's z here
    member.section.iz = 250;
    member.section.torsion = 250;
    member.material = {0, 30000, 250, 0};
    frame.members.push_back(member);
  }
  frame.loads.resize(2);
  for (int i = 0; i < 2; ++i) {
    frame.loads[i].node = 2 + i;
    frame.loads[i].force = {0, -30, 0};
  }
  const BeamState state = SupportedFrame(frame, {at(0, 0), at(4, 360)}).state(Vector3d::Zero());
  const double sign[2] = {1, -1};
  for (int end = 0; end < 2; ++end) {
    EXPECT_NEAR(state.reactions(0, end), sign[end] * 11.6877, 5e-5);
    EXPECT_NEAR(state.reactions(1, end), 30, 1e-9);
    EXPECT_NEAR(state.reactions(5, end), -sign[end] * 1810.0745, 5e-5);
  }
  EXPECT_FALSE(state.stress);  // extents are not known
}

TEST(SupportedFrame, ReactionsCarryWeightAndItsMoment) {
  Rng rng(5);
  for (const BeamFrame& frame : {figure_3_4_frame(), closed_frame()}) {
    for (int i = 0; i < 30; ++i) {
      const int member = static_cast<int>(rng.index(frame.members.size()));
      const int other = (member + 2) % static_cast<int>(frame.members.size());
      std::vector<BeamSupport> supports{at(member, rng.uniform(0, frame.length(member)))};
      if (i % 2) supports.push_back(at(other, frame.length(other) / 2));  // a second hand
      const Vector3d gravity = kG * rng.rotation().toRotationMatrix().col(0);
      const BeamState state = SupportedFrame(frame, supports).state(gravity);
      Vector3d force = frame.mass() * gravity, moment = frame.centre_of_mass().cross(force);
      for (std::size_t k = 0; k < supports.size(); ++k) {
        const auto [a, b] = frame.members[supports[k].member].nodes;
        const Vector3d place = frame.nodes[a] + supports[k].distance / frame.length(supports[k].member) *
                                                    (frame.nodes[b] - frame.nodes[a]);
        const auto reaction = state.reactions.col(static_cast<long>(k));
        force += reaction.head<3>();
        moment += place.cross(reaction.head<3>()) + reaction.tail<3>();
      }
      EXPECT_LT(force.norm(), 1e-9);
      EXPECT_LT(moment.norm(), 1e-9);
    }
  }
}

TEST(SupportedFrame, SplittingAMemberChangesNothing) {
  Rng rng(7);
  for (const BeamFrame& frame : {figure_3_4_frame(), closed_frame()}) {
    for (int i = 0; i < 20; ++i) {
      const int member = static_cast<int>(rng.index(frame.members.size()));
      const int cut = static_cast<int>(rng.index(frame.members.size()));
      const double held_at = rng.uniform(0, frame.length(member)), cut_at = frame.length(cut) * rng.uniform(0.05, 0.95);
      BeamSupport same = at(member, held_at);
      if (cut == member && held_at > cut_at) same = at(static_cast<int>(frame.members.size()), held_at - cut_at);
      const Vector3d gravity = kG * rng.rotation().toRotationMatrix().col(0);
      const SupportedFrame whole(frame, {at(member, held_at)}), split(frame.split(cut, cut_at), {same});
      const BeamState a = whole.state(gravity), b = split.state(gravity);
      const double scale = a.displacement.value;
      EXPECT_LT((a.nodes - b.nodes.leftCols(a.nodes.cols())).topRows<3>().norm(), 1e-9 * scale);
      EXPECT_NEAR(a.displacement.value, b.displacement.value, 2e-9 * scale);
      EXPECT_LT((a.reactions - b.reactions).norm(), 1e-9);
      EXPECT_NEAR(a.stress->value, b.stress->value, 1e-6 * a.stress->value);
      EXPECT_LT((whole.displacement(gravity, cut, cut_at) - b.nodes.rightCols<1>().head<3>()).norm(), 1e-9 * scale);
    }
  }
}

TEST(SupportedFrame, LargestDisplacementMissesNothing) {
  Rng rng(9);
  const BeamFrame frame = closed_frame();
  for (int i = 0; i < 20; ++i) {
    std::vector<BeamSupport> supports{at(4, frame.length(4)), at(6, frame.length(6)), at(7, frame.length(7))};
    const bool all_nodes = i % 2 == 1;  // then it sags between them
    if (all_nodes) supports.insert(supports.end(), {at(0, 0), at(1, 0), at(2, 0), at(3, 0), at(5, frame.length(5))});
    const SupportedFrame held(frame, supports);
    const Vector3d gravity = kG * rng.rotation().toRotationMatrix().col(0);
    double largest = 0;
    for (int member = 0; member < static_cast<int>(frame.members.size()); ++member) {
      for (int k = 0; k <= 400; ++k) {
        largest = std::max(largest, held.displacement(gravity, member, frame.length(member) * k / 400).norm());
      }
    }
    const BeamExtreme found = held.largest_displacement(gravity);
    EXPECT_GE(found.value, largest * (1 - 1e-9));
    EXPECT_LE(found.value, largest * (1 + 1e-4));
    EXPECT_NEAR(held.displacement(gravity, found.member, found.distance).norm(), found.value, 1e-12);
    const double at_nodes = held.state(gravity).nodes.topRows<3>().colwise().norm().maxCoeff();
    EXPECT_GE(found.value, at_nodes * (1 - 1e-9));
    if (all_nodes) {
      EXPECT_EQ(at_nodes, 0);
    }
  }
}

TEST(SupportedFrame, ManyUnknownsAsFew) {  // the sparse factorisation
  BeamFrame fine = figure_3_4_frame();
  while (fine.nodes.size() < 90) {
    int longest = 0;
    for (int i = 0; i < static_cast<int>(fine.members.size()); ++i) {
      if (fine.length(i) > fine.length(longest)) longest = i;
    }
    fine = fine.split(longest, fine.length(longest) / 2);
  }
  const BeamState a = SupportedFrame(figure_3_4_frame(), {at(0, 0)}).state({1, -5, 8});
  const BeamState b = SupportedFrame(fine, {at(0, 0)}).state({1, -5, 8});
  EXPECT_LT((a.nodes - b.nodes.leftCols(7)).topRows<3>().norm(), 1e-8 * a.displacement.value);
  BeamSupport loose = at(0, 0);
  loose.fixed[3] = false;
  EXPECT_THROW(SupportedFrame(fine, {loose}), InvalidInput);
}

TEST(SupportedFrame, StressOverItsLimit) {
  BeamFrame frame = tube(0.4);
  EXPECT_FALSE(SupportedFrame(frame, {at(0, 0)}).state({0, 0, -kG}).over_limit);
  frame.members[0].material.stress_limit = 1e6;
  const BeamState state = SupportedFrame(frame, {at(0, 0)}).state({0, 0, -kG});
  ASSERT_TRUE(state.over_limit);
  EXPECT_NEAR(state.over_limit->value, state.stress->value / 1e6, 1e-12);
}

TEST(SupportedFrame, ALimitHoldsBesideSectionsWithoutExtents) {
  BeamFrame frame = tube(0.4);
  frame.members[0].material.stress_limit = 1e6;
  const BeamState alone = SupportedFrame(frame, {at(0, 0)}).state({0, 0, -kG});
  frame.nodes.emplace_back(frame.nodes[1] + Vector3d(0.1, 0, 0));
  BeamMember more = frame.members[0];
  more.nodes = {1, 2};
  more.material.stress_limit = 0;
  more.section.y_extent = 0;  // not known
  frame.members.push_back(more);
  const BeamState state = SupportedFrame(frame, {at(0, 0)}).state({0, 0, -kG});
  ASSERT_TRUE(state.stress && state.over_limit);
  EXPECT_EQ(state.over_limit->member, 0);
  EXPECT_NEAR(state.stress->value, alone.stress->value * 25 / 16, 1e-6 * alone.stress->value);  // (0.5 / 0.4)^2
  frame.members[1].material.stress_limit = 1e6;
  try {
    frame.check();
    FAIL() << "a limit was taken that nothing checks";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("members[1].material.stress_limit"), std::string::npos) << error.what();
  }
}

TEST(SupportedFrame, ItsDeflectionIsThatOfTheHeldFrame) {
  const BeamFrame frame = figure_3_4_frame();
  const Grasp grasp = place_pipe_grasp(figure_3_4(), 2, 0.05, 0.3, false, {});
  const Pose T = pose_from_xyz_rpy({1, 2, 3}, {0.4, -0.7, 1.1});
  const BeamState held = SupportedFrame(frame, {at(2, 0.05)}).state(T.linear().transpose() * Vector3d(0, 0, -kG));
  EXPECT_NEAR(frame.deflection(grasp, T).displacement.value, held.displacement.value, 1e-15);
  EXPECT_NEAR(frame.deflection(std::vector<BeamSupport>{at(2, 0.05)}, T, 2 * kG).displacement.value,
              2 * held.displacement.value, 1e-15);
}

TEST(SupportedFrame, RefusesWhatCannotHold) {
  const BeamFrame frame = figure_3_4_frame();
  EXPECT_THROW(SupportedFrame(frame, {}), InvalidInput);
  EXPECT_THROW(SupportedFrame(frame, {at(6, 0)}), InvalidInput);
  EXPECT_THROW(SupportedFrame(frame, {at(0, 0.3)}), InvalidInput);
  EXPECT_THROW(SupportedFrame(frame, {at(0, -0.01)}), InvalidInput);
  EXPECT_THROW(SupportedFrame(frame, {at(0, 0.2), at(1, 0)}), InvalidInput);  // the same node
  for (int k = 0; k < 6; ++k) {                                               // every single freedom is noticed
    BeamSupport loose = at(2, 0.1);
    loose.fixed[k] = false;
    try {
      const SupportedFrame held(frame, {loose});
      ADD_FAILURE() << "freedom " << k << " was not noticed";
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find("unstable"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(beam_support(Grasp{}), InvalidInput);
  EXPECT_THROW(SupportedFrame(frame, {at(0, 0)}).displacement({0, 0, 1}, 0, 0.5), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
