#include "mmgrasp/structure/beam_frame.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <limits>

#include "beam_frames.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

TEST(BeamSection, RoundByHand) {
  const BeamSection tube = round_section(0.012, 0.010);
  EXPECT_NEAR(tube.area, 3.45575e-5, 1e-10);
  EXPECT_NEAR(tube.iy, 5.27002e-10, 1e-15);  // pi / 64 (12^4 - 10^4) mm4 = 527.0 mm4
  EXPECT_DOUBLE_EQ(tube.iy, tube.iz);
  EXPECT_DOUBLE_EQ(tube.torsion, 2 * tube.iy);
  EXPECT_NEAR(round_section(0.02).iy, 7.853982e-9, 1e-14);
}

TEST(BeamSection, RectanglesByHand) {
  const BeamSection bar = rectangular_section(0.02, 0.04);
  EXPECT_NEAR(bar.area, 8e-4, 1e-15);
  EXPECT_NEAR(bar.iz, 0.04 * 8e-6 / 12, 1e-18);
  EXPECT_NEAR(bar.iy, 0.02 * 6.4e-5 / 12, 1e-18);
  EXPECT_NEAR(bar.torsion, 0.2287 * 0.04 * 8e-6, 0.0001 * 0.04 * 8e-6);  // Timoshenko and Goodier, table for 2 : 1
  EXPECT_NEAR(bar.torsion_modulus, 0.246 * 0.04 * 4e-4, 0.0005 * 0.04 * 4e-4);
  const BeamSection square = rectangular_section(0.03, 0.03);
  EXPECT_NEAR(square.torsion, 0.1406 * std::pow(0.03, 4), 0.0001 * std::pow(0.03, 4));
  EXPECT_NEAR(square.torsion_modulus, 0.208 * std::pow(0.03, 3), 0.0005 * std::pow(0.03, 3));
  const BeamSection tube = rectangular_section(0.03, 0.05, 0.002);
  EXPECT_NEAR(tube.area, 0.03 * 0.05 - 0.026 * 0.046, 1e-15);
  EXPECT_NEAR(tube.iz, (0.05 * std::pow(0.03, 3) - 0.046 * std::pow(0.026, 3)) / 12, 1e-18);
  EXPECT_NEAR(tube.torsion, 4 * std::pow(0.028 * 0.048, 2) * 0.002 / (2 * (0.028 + 0.048)), 1e-15);  // Bredt
}

TEST(BeamFrame, FreeFrameHasSixRigidMovements) {
  for (const BeamFrame& frame : {figure_3_4_frame(), closed_frame()}) {
    const Eigen::MatrixXd K = frame.stiffness();
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
    for (int mode = 0; mode < 6; ++mode) {  // moved and turned as a whole, nothing strains
      Eigen::VectorXd moved(K.rows());
      const Vector3d shift = mode < 3 ? Vector3d::Unit(mode).eval() : Vector3d::Zero().eval();
      const Vector3d turn = mode < 3 ? Vector3d::Zero().eval() : Vector3d::Unit(mode - 3).eval();
      for (std::size_t i = 0; i < frame.nodes.size(); ++i) {
        moved.segment<3>(6 * static_cast<long>(i)) = shift + turn.cross(frame.nodes[i]);
        moved.segment<3>(6 * static_cast<long>(i) + 3) = turn;
      }
      EXPECT_LT((K * moved).norm(), 1e-12 * K.norm() * moved.norm());
    }
    Eigen::VectorXd scale = K.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(scale.asDiagonal() * K * scale.asDiagonal());
    EXPECT_LT(modes.eigenvalues()(5), 1e-11);
    EXPECT_GT(modes.eigenvalues()(6), 1e-8);
  }
}

TEST(BeamFrame, WeightOfPipe1) {
  EXPECT_NEAR(figure_3_4_frame().mass() * 9.81, 3.797, 5e-4);
  BeamFrame frame = figure_3_4_frame();
  const Vector3d centre = frame.centre_of_mass();
  EXPECT_LT((centre - figure_3_4().centre_of_mass()).norm(), 1e-15);
  NodeLoad valve;
  valve.node = 4;
  valve.mass = frame.mass();
  frame.loads = {valve};
  EXPECT_LT((frame.centre_of_mass() - (centre + frame.nodes[4]) / 2).norm(), 1e-15);
}

TEST(BeamFrame, SplittingKeepsMassAndAxes) {
  const BeamFrame frame = closed_frame();
  for (int member = 0; member < static_cast<int>(frame.members.size()); ++member) {
    const BeamFrame split = frame.split(member, 0.3 * frame.length(member));
    split.check();
    EXPECT_NEAR(split.mass(), frame.mass(), 1e-15);
    EXPECT_NEAR(split.length(member), 0.3 * frame.length(member), 1e-15);
    const int second = static_cast<int>(frame.members.size());
    EXPECT_LT((split.R_object_member(second) - frame.R_object_member(member)).norm(), 1e-12);
  }
}

void expect_refused(const std::function<void(BeamFrame&)>& spoil, const std::string& field, const std::string& rule) {
  BeamFrame frame = closed_frame();
  spoil(frame);
  try {
    frame.check();
    ADD_FAILURE() << field << " was accepted";
  } catch (const InvalidInput& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.rfind(field, 0), 0u) << what;
    EXPECT_NE(what.find(rule), std::string::npos) << what;
  }
}

TEST(BeamFrame, RefusesWhatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  expect_refused([](BeamFrame& f) { f.members.clear(); }, "members", "at least one");
  expect_refused([&](BeamFrame& f) { f.nodes[1].x() = nan; }, "nodes[1]", "finite");
  expect_refused([](BeamFrame& f) { f.members[2].nodes[1] = 99; }, "members[2].nodes", "indices");
  expect_refused([](BeamFrame& f) { f.nodes[1] = f.nodes[0]; }, "members[0].nodes", "apart");
  expect_refused([](BeamFrame& f) { f.members.push_back(f.members[0]); }, "members[8].nodes", "joins the same");
  expect_refused([](BeamFrame& f) { f.members[3].section.area = 0; }, "members[3].section.area", "positive");
  expect_refused([](BeamFrame& f) { f.members[3].material.youngs_modulus = -1; }, "members[3].material.youngs_modulus",
                 "positive");
  expect_refused([](BeamFrame& f) { f.members[0].y_towards = f.nodes[1] - f.nodes[0]; }, "members[0].y_towards",
                 "along the member");
  expect_refused([](BeamFrame& f) { f.nodes.emplace_back(5, 5, 5); }, "nodes[8]", "every node");
  expect_refused(
      [](BeamFrame& f) {
        f.nodes.emplace_back(5, 5, 5);
        f.nodes.emplace_back(6, 5, 5);
        f.members.push_back(f.members[0]);
        f.members.back().nodes = {8, 9};
      },
      "nodes[8]", "one connected piece");
  expect_refused([](BeamFrame& f) { f.loads.resize(1), f.loads[0].node = 8; }, "loads[0].node", "8 nodes");
  expect_refused([](BeamFrame& f) { f.loads.resize(1), f.loads[0].mass = -1; }, "loads[0].mass", "positive");
  EXPECT_THROW(round_section(0.010, 0.012), InvalidInput);
  EXPECT_THROW(round_section(0.010, 0.010), InvalidInput);
  EXPECT_THROW(round_section(0), InvalidInput);
  EXPECT_THROW(rectangular_section(0.02, 0.04, 0.01), InvalidInput);
  EXPECT_THROW(closed_frame().split(0, 0), InvalidInput);
  EXPECT_THROW(closed_frame().split(8, 0.1), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
