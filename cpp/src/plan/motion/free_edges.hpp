#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <utility>
#include <vector>

namespace mmgrasp::detail {

/// Straight edges that are known to be free, few enough to look through: an edge is known if both of its ends are the
/// same bit for bit.
class FreeEdges {
 public:
  void add(const Eigen::VectorXd& a, const Eigen::VectorXd& b) { edges_.emplace_back(a, b); }
  bool has(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    return std::any_of(edges_.begin(), edges_.end(),
                       [&](const auto& edge) { return edge.first == a && edge.second == b; });
  }

 private:
  std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> edges_;
};

}  // namespace mmgrasp::detail
