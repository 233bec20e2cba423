#include "mmgrasp/optim/pairwise_weights.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

Eigen::Matrix3d of_p2() {
  Eigen::Matrix3d C;
  C << 1, 6, 2, 1.0 / 6, 1, 0.25, 0.5, 4, 1;
  return C;
}

TEST(PairwiseWeights, OfP2) {
  const PairwiseWeights found = pairwise_weights(of_p2());
  EXPECT_NEAR(found.weights(0), 0.587, 5e-4);
  EXPECT_NEAR(found.weights(1), 0.089, 5e-4);
  EXPECT_NEAR(found.weights(2), 0.324, 5e-4);
  EXPECT_NEAR(found.consistency_ratio, 0.0079, 5e-5);
  EXPECT_GT((found.weights - Eigen::Vector3d(0.56, 0.12, 0.32)).cwiseAbs().maxCoeff(), 0.02);  // what P2 prints
  EXPECT_NEAR(found.weights.sum(), 1, 1e-15);
}

TEST(PairwiseWeights, ThreeRowsHaveTheEigenvectorOfGeometricMeans) {
  const Eigen::Matrix3d C = of_p2();
  Eigen::Vector3d means = C.rowwise().prod().array().pow(1.0 / 3);
  EXPECT_LT((pairwise_weights(C).eigenvector - means / means.sum()).norm(), 1e-12);
}

TEST(PairwiseWeights, ConsistentMatricesGiveTheirRatios) {
  Eigen::VectorXd wanted(5);
  wanted << 0.4, 0.25, 0.2, 0.1, 0.05;
  const Eigen::MatrixXd C = wanted * wanted.cwiseInverse().transpose();
  const PairwiseWeights found = pairwise_weights(C);
  EXPECT_LT((found.weights - wanted).norm(), 1e-12);
  EXPECT_LT((found.eigenvector - wanted).norm(), 1e-12);
  EXPECT_NEAR(found.consistency_ratio, 0, 1e-12);
  EXPECT_NEAR(pairwise_weights(C.topLeftCorner<2, 2>()).consistency_ratio, 0, 1e-12);
}

TEST(PairwiseWeights, RefusesWhatIsNoComparison) {
  Eigen::Matrix3d C = of_p2();
  C(2, 1) = 5;
  EXPECT_THROW(pairwise_weights(C), InvalidInput);
  C = of_p2();
  C(0, 0) = 2;
  EXPECT_THROW(pairwise_weights(C), InvalidInput);
  C = of_p2();
  C(0, 1) = -6;
  EXPECT_THROW(pairwise_weights(C), InvalidInput);
  EXPECT_THROW(pairwise_weights(Eigen::MatrixXd::Ones(2, 3)), InvalidInput);
  C << 1, 9, 1.0 / 9, 1.0 / 9, 1, 9, 9, 1.0 / 9, 1;  // a circle
  try {
    pairwise_weights(C);
    ADD_FAILURE() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("10 %"), std::string::npos) << error.what();
  }
  EXPECT_GT(pairwise_weights(C, 100).consistency_ratio, 1);
}

}  // namespace
}  // namespace mmgrasp
