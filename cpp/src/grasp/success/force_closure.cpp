// has_force_closure: Nguyen's test for two patches, the hull of the contacts' wrenches for more.
#include <Eigen/QR>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/grasp/success_model.hpp"

namespace mmgrasp {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kEdges = 8;              // of the pyramid inside a friction cone
constexpr double kSolved = 1e-9;       // residual of a sum of wrenches that counts as zero
constexpr double kFullRank = 1e-9;     // least pivot, relative to the largest
constexpr double kLeastLength = 1e-9;  // contacts nearer to each other are one [m]

/// Least squares solution of A x = b with x >= 0 (Lawson and Hanson 1974, chapter 23); returns the residual's norm.
double non_negative_residual(const MatrixXd& A, const VectorXd& b) {
  const Eigen::Index n = A.cols();
  VectorXd x = VectorXd::Zero(n);
  std::vector<Eigen::Index> active;  // columns that may be positive
  std::vector<char> is_active(n, 0);
  for (Eigen::Index round = 0; round < 3 * n; ++round) {
    const VectorXd residual = b - A * x, gradient = A.transpose() * residual;
    Eigen::Index best = -1;
    for (Eigen::Index k = 0; k < n; ++k)
      if (!is_active[k] && gradient[k] > kSolved && (best < 0 || gradient[k] > gradient[best])) best = k;
    if (best < 0 || residual.norm() < kSolved) break;
    active.push_back(best);
    is_active[best] = 1;
    while (!active.empty()) {
      MatrixXd columns(A.rows(), static_cast<Eigen::Index>(active.size()));
      for (std::size_t k = 0; k < active.size(); ++k) columns.col(static_cast<Eigen::Index>(k)) = A.col(active[k]);
      const VectorXd trial = columns.colPivHouseholderQr().solve(b);
      double step = 1;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double from = x[active[k]], to = trial[static_cast<Eigen::Index>(k)];
        if (to <= 0) step = std::min(step, from / (from - to + 1e-300));
      }
      for (std::size_t k = 0; k < active.size(); ++k)
        x[active[k]] += step * (trial[static_cast<Eigen::Index>(k)] - x[active[k]]);
      if (step >= 1) break;
      std::vector<Eigen::Index> kept;
      for (const Eigen::Index k : active) {
        if (x[k] > 1e-14) {
          kept.push_back(k);
        } else {
          x[k] = 0;
          is_active[k] = 0;
        }
      }
      active.swap(kept);
    }
  }
  return (b - A * x).norm();
}

bool antipodal(const ContactPatch& a, const ContactPatch& b, double friction) {
  const Vector3d line = b.point - a.point;
  const double length = line.norm();
  if (length < kLeastLength) return false;
  const double least = std::cos(std::atan(friction));
  return -a.normal.dot(line) > least * length && b.normal.dot(line) > least * length;
}

/// Forces along the edges of each cone with their torques about the contacts' mean, torques over the mean's distance to
/// the farthest contact, so that all six rows are alike.
MatrixXd edge_wrenches(const std::vector<ContactPatch>& patches, double friction) {
  Vector3d middle = Vector3d::Zero();
  for (const ContactPatch& patch : patches) middle += patch.point / static_cast<double>(patches.size());
  double length = kLeastLength;
  for (const ContactPatch& patch : patches) length = std::max(length, (patch.point - middle).norm());
  MatrixXd wrenches(6, kEdges * static_cast<Eigen::Index>(patches.size()));
  Eigen::Index column = 0;
  for (const ContactPatch& patch : patches) {
    const Vector3d inward = -patch.normal, u = inward.unitOrthogonal(), v = inward.cross(u);
    for (int k = 0; k < kEdges; ++k) {
      const double angle = detail::kTwoPi * k / kEdges;
      const Vector3d force = (inward + friction * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
      wrenches.col(column++) << force, (patch.point - middle).cross(force) / length;
    }
  }
  return wrenches;
}

}  // namespace

bool has_force_closure(const std::vector<ContactPatch>& patches, double friction) {
  if (patches.size() < 2) return false;
  if (patches.size() == 2) return antipodal(patches[0], patches[1], friction);
  const MatrixXd wrenches = edge_wrenches(patches, friction);
  Eigen::ColPivHouseholderQR<MatrixXd> qr(wrenches);
  qr.setThreshold(kFullRank);
  if (qr.rank() < 6) return false;
  // Zero is interior to the hull if and only if some sum with all factors >= 1 vanishes: factors 1 + x, x >= 0.
  return non_negative_residual(wrenches, -wrenches.rowwise().sum()) < 1e-6;
}

}  // namespace mmgrasp
