// Frames that double precision gets wrong: many short members, short ones beside long ones, soft ones beside stiff.
#include <gtest/gtest.h>

#include <cmath>

#include "beam_frames.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/structure/supported_frame.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kG = 9.81;

BeamMember copper_tube(int from, int to) {
  BeamMember member;
  member.nodes = {from, to};
  member.section = round_section(0.012, 0.010);
  member.material = copper();
  return member;
}

/// An elbow of two legs of this length, in this many equal members together.
BeamFrame elbow(double leg, int members) {
  BeamFrame frame;
  for (int i = 0; i <= members; ++i) {
    const double at = 2 * leg * i / members;
    frame.nodes.emplace_back(std::min(at, leg), std::max(0.0, at - leg), 0);
    if (i > 0) frame.members.push_back(copper_tube(i - 1, i));
  }
  return frame;
}

/// Sag of its end under its weight across its plane, held at its first node: closed form.
double sag_of_elbow(double leg) {
  const BeamSection section = round_section(0.012, 0.010);
  const double w = section.area * copper().density * kG, EI = copper().youngs_modulus * section.iy,
               GJ = copper().shear_modulus * section.torsion, fourth = std::pow(leg, 4);
  const double first_leg = w * fourth / (8 * EI) + w * fourth / (3 * EI);  // its own weight, and that of the second
  return first_leg + w * fourth / (2 * GJ) + w * fourth / (8 * EI);
}

TEST(FramePrecision, ManyShortMembersSagAsFewLongOnes) {
  for (const int members : {2, 4, 10, 20, 30, 40, 60, 80, 120, 200, 1000, 5000}) {
    const SupportedFrame held(elbow(2.5, members), {BeamSupport{0, 0}});
    const BeamState state = held.state({0, 0, -kG});
    EXPECT_NEAR(state.displacement.value / sag_of_elbow(2.5), 1, 1e-9) << members;
    EXPECT_NEAR(state.reactions(2, 0) / (elbow(2.5, 2).mass() * kG), 1, 1e-9) << members;
    const int last = members - 1;  // nothing hangs on the last member but its own half
    const double w = elbow(2.5, 2).mass() * kG / 5, half = 5.0 / members / 2;
    EXPECT_NEAR(held.section_forces({0, 0, -kG}, last, half).segment<3>(0).norm(), w * half, 1e-9 * w) << members;
  }
}

TEST(FramePrecision, ShortMembersBesideLongOnesSagAsIfJoined) {
  const double w = copper().density * round_section(0.012, 0.010).area * kG;
  const double tip = w * 16 / (8 * copper().youngs_modulus * round_section(0.012, 0.010).iy);
  for (const double gap : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 2e-6}) {
    BeamFrame frame;
    frame.nodes = {{0, 0, 0}, {1, 0, 0}, {1 + gap, 0, 0}, {2, 0, 0}};
    for (int i = 0; i < 3; ++i) frame.members.push_back(copper_tube(i, i + 1));
    EXPECT_NEAR(SupportedFrame(frame, {BeamSupport{0, 0}}).largest_displacement({0, 0, -kG}).value / tip, 1, 1e-9)
        << gap;
    const SupportedFrame near(frame, {BeamSupport{0, 1 - gap}, BeamSupport{0, 0}});  // beside a node, too
    EXPECT_NEAR(near.state({0, 0, -kG}).reactions.row(2).sum() / (2 * w), 1, 1e-9) << gap;
  }
}

/// An elbow of two legs of 1 m, the second so much stiffer.
BeamFrame unlike_legs(double factor) {
  BeamFrame frame = elbow(1, 2);
  frame.members[1].material.youngs_modulus *= factor;
  frame.members[1].material.shear_modulus *= factor;
  return frame;
}

TEST(FramePrecision, StiffBesideSoftIsExactOrRefused) {
  const double w = copper().density * round_section(0.012, 0.010).area * kG;
  const double own = w / (8 * copper().youngs_modulus * round_section(0.012, 0.010).iy);
  for (const double factor : {1e3, 1e6, 1e12, 1e18}) {
    const double tip = SupportedFrame(unlike_legs(factor), {BeamSupport{0, 0}}).state({0, 0, -kG}).displacement.value;
    EXPECT_NEAR(tip / (sag_of_elbow(1) - own + own / factor), 1, 1e-9) << factor;
    BeamSupport loose;
    loose.fixed[3] = false;
    EXPECT_THROW(SupportedFrame(unlike_legs(factor), {loose}), InvalidInput) << factor;
  }
  try {
    const SupportedFrame held(unlike_legs(1e24), {BeamSupport{0, 0}});
    ADD_FAILURE() << "a frame beyond all decimals was taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("times softer than others"), std::string::npos) << error.what();
  }
}

TEST(FramePrecision, WhatCanMoveIsFoundAmongManyMembers) {
  for (const int members : {10, 100, 1000}) {
    for (int k = 0; k < 6; ++k) {
      BeamSupport loose;
      loose.fixed[k] = false;
      try {
        const SupportedFrame held(elbow(2.5, members), {loose});
        ADD_FAILURE() << members << " members, freedom " << k;
      } catch (const InvalidInput& error) {
        EXPECT_NE(std::string(error.what()).find("unstable"), std::string::npos) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace mmgrasp
