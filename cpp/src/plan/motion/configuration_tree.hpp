#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp::detail {

/// Configurations with parents and a nearest-neighbour search by scanning all of them: coordinates of the metric are
/// also stored in single precision, eight configurations interleaved, so that a scan is a stream of vector
/// instructions. Up to some ten thousand configurations that is faster than a k-d tree.
class ConfigurationTree {
 public:
  ConfigurationTree(Eigen::Index size, JointMetric metric);

  int size() const { return static_cast<int>(parents_.size()); }
  /// Values that wrap lie in [-pi, pi].
  int add(const Eigen::VectorXd& q, int parent);
  /// The nearest by distances in single precision; the first of equals.
  int nearest(const Eigen::VectorXd& q) const;
  int parent(int node) const { return parents_[node]; }
  /// Copied into the caller's storage of the right length.
  void get(int node, Eigen::VectorXd& q) const {
    q = Eigen::Map<const Eigen::VectorXd>(values_.data() + static_cast<std::ptrdiff_t>(node) * size_, size_);
  }

 private:
  static constexpr int kRow = 8;
  const Eigen::Index size_;
  const JointMetric metric_;
  std::vector<double> values_;
  std::vector<float> rows_;  ///< [block][value][kRow]; the unused end is far from everything.
  std::vector<int> parents_;
};

}  // namespace mmgrasp::detail
