#include "mmgrasp/robot/kinematics_batch.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/error.hpp"
#include "support/kinematics_support.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

Eigen::MatrixXd random_configurations(const JointGroup& group, int count, unsigned seed) {
  Rng rng(seed);
  Eigen::MatrixXd Q(group.size(), count);
  for (int i = 0; i < count; ++i) Q.col(i) = random_configuration(group, rng);
  return Q;
}

}  // namespace

TEST(KinematicsBatch, MatchesKdlOnEveryInstructionSet) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot ur = load_kinematics("robots/ur/expanded/ur5e.urdf");
  const std::vector<JointGroup> groups{panda().group("panda_arm"), tiago().group("arm_torso"),
                                       ur.chain("base_link", "tool0"), ur.chain("base_link", "shoulder_link")};
  on_every_instruction_set([&] {
    for (const JointGroup& group : groups) {
      const Eigen::MatrixXd Q = random_configurations(group, 37, 3);
      Poses T, tips;
      Matrix6Xd J;
      fk_jacobian_batch(group, Q, T, J);
      fk_batch(group, Q, tips);
      ASSERT_EQ(T.size(), 37u);
      ASSERT_EQ(J.cols(), 37 * group.size());
      for (int i = 0; i < 37; ++i) {
        Pose expected_T;
        Matrix6Xd expected_J;
        ASSERT_NO_FATAL_FAILURE(kdl_kinematics(group, Q.col(i), Eigen::Vector3d::Zero(), expected_T, expected_J));
        const std::size_t at = i;
        EXPECT_LT((T[at].matrix() - expected_T.matrix()).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_LT((tips[at].matrix() - expected_T.matrix()).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_LT((J.middleCols(i * group.size(), group.size()) - expected_J).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_EQ(T[at].matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
      }
    }
  });
}

TEST(KinematicsBatch, BaseMimicStillColumnsAndAnyRootMatchTheSingleCall) {
  MMGRASP_NEEDS_SHARED_DATA();
  const Robot hands = two_hands(), mobile = two_hands(BaseKind::omni);
  // The slide does not move the left tip, and the left joint moves both.
  const std::vector<JointGroup> groups{tiago().group("arm_torso", "", true), hands.group("all", "right_tip"),
                                       hands.group("all", "left_tip"), mobile.group("all", "left_tip", true),
                                       panda().group("panda_arm").at(pose_from_xyz_rpy({30, -70, 1}, {1, 2, 3}))};
  on_every_instruction_set([&] {
    for (const JointGroup& group : groups)
      for (int count = 0; count <= 19; ++count) {
        const Eigen::MatrixXd Q = random_configurations(group, count, 4);
        Poses T;
        Matrix6Xd J;
        fk_jacobian_batch(group, Q, T, J);
        ASSERT_EQ(T.size(), count);
        for (int i = 0; i < count; ++i) {
          EXPECT_LT((T[i].matrix() - group.fk(Q.col(i)).matrix()).cwiseAbs().maxCoeff(), 1e-12);
          EXPECT_LT((J.middleCols(i * group.size(), group.size()) - group.jacobian(Q.col(i))).cwiseAbs().maxCoeff(),
                    1e-12);
        }
      }
  });
}

TEST(KinematicsBatch, AnswersDoNotDependOnTheirPlaceNorOnTheMatrixTheyLieIn) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const Eigen::MatrixXd Q = random_configurations(group, 29, 5);
  Eigen::MatrixXd wide = Eigen::MatrixXd::Constant(12, 29, std::nan(""));
  wide.middleRows(2, 7) = Q;
  Poses all, from_wide, one;
  fk_batch(group, Q, all);
  fk_batch(group, wide.middleRows(2, 7), from_wide);
  for (int i = 0; i < 29; ++i) {
    const std::size_t at = i;
    fk_batch(group, Q.col(i), one);
    EXPECT_EQ((one[0].matrix() - all[at].matrix()).norm(), 0.0) << i;
    EXPECT_EQ((from_wide[at].matrix() - all[at].matrix()).norm(), 0.0) << i;
  }
}

TEST(KinematicsBatch, OneFarAngleSpoilsNoNeighbour) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Eigen::MatrixXd Q = random_configurations(group, 16, 6);
  Q(3, 5) = 1e9;
  Q(0, 6) = std::nan("");
  on_every_instruction_set([&] {
    Poses T;
    Matrix6Xd J;
    fk_jacobian_batch(group, Q, T, J);
    for (int i = 0; i < 16; ++i) {
      if (i == 6) {
        EXPECT_TRUE(std::isnan(T[6](0, 3)));
        continue;
      }
      const Poses expected = group.robot().link_poses(group.full_values(Q.col(i)));
      EXPECT_LT((T[i].matrix() - expected[group.tip_link()].matrix()).norm(), 1e-12);
      EXPECT_TRUE(J.middleCols(7 * i, 7).allFinite());
    }
  });
}

TEST(KinematicsBatch, ManipulabilityOfEach) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  const Eigen::MatrixXd Q = random_configurations(group, 131, 7);
  on_every_instruction_set([&] {
    const Eigen::VectorXd values = manipulability_batch(group, Q);
    ASSERT_EQ(values.size(), 131);
    for (int i = 0; i < 131; ++i) {
      const double expected = Eigen::JacobiSVD<Eigen::MatrixXd>(group.jacobian(Q.col(i))).singularValues().prod();
      EXPECT_NEAR(values[i], expected, 1e-13);
    }
  });
  EXPECT_EQ(manipulability_batch(group, Eigen::MatrixXd(7, 0)).size(), 0);
}

TEST(KinematicsBatch, WrongRowsAndUnknownInstructionSetsAreRefused) {
  MMGRASP_NEEDS_SHARED_DATA();
  const JointGroup group = panda().group("panda_arm");
  Poses T;
  Matrix6Xd J;
  const Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(6, 3);
  EXPECT_THROW(fk_batch(group, Q, T), InvalidInput);
  EXPECT_THROW(fk_jacobian_batch(group, Q, T, J), InvalidInput);
  EXPECT_THROW(manipulability_batch(group, Q), InvalidInput);
  EXPECT_THROW(detail::use_instruction_set("mmx"), InvalidInput);
  EXPECT_EQ(detail::instruction_sets().back(), "portable");
}
