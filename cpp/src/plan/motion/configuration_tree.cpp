#include "plan/motion/configuration_tree.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace mmgrasp::detail {

ConfigurationTree::ConfigurationTree(Eigen::Index size, JointMetric metric) : size_(size), metric_(std::move(metric)) {}

int ConfigurationTree::add(const Eigen::VectorXd& q, int parent) {
  const int node = size();
  const int block = node / kRow, lane = node % kRow;
  const std::size_t stride = size_ * kRow;
  if (lane == 0) rows_.resize(rows_.size() + stride, 1e15f);
  for (Eigen::Index i = 0; i < size_; ++i) {
    rows_[block * stride + i * kRow + lane] = static_cast<float>(metric_.weight(static_cast<int>(i)) * q[i]);
  }
  values_.insert(values_.end(), q.data(), q.data() + size_);
  parents_.push_back(parent);
  return node;
}

int ConfigurationTree::nearest(const Eigen::VectorXd& q) const {
  const std::size_t stride = size_ * kRow;
  const float* row = rows_.data();
  // One running minimum a lane: no comparison across lanes before the end.
  float best[kRow];
  int best_block[kRow];
  for (int k = 0; k < kRow; ++k) {
    best[k] = std::numeric_limits<float>::infinity();
    best_block[k] = 0;
  }
  const int blocks = (size() + kRow - 1) / kRow;
  for (int block = 0; block < blocks; ++block, row += stride) {
    float sum[kRow] = {};
    for (Eigen::Index i = 0; i < size_; ++i) {
      const int joint = static_cast<int>(i);
      const float value = static_cast<float>(metric_.weight(joint) * q[i]);
      const float* entry = row + i * kRow;
      if (metric_.wraps(joint)) {
        const float turn = static_cast<float>(metric_.turn(joint));
        for (int k = 0; k < kRow; ++k) {
          const float apart = std::abs(entry[k] - value);
          const float round = std::abs(turn - apart);
          const float least = apart < round ? apart : round;
          sum[k] += least * least;
        }
      } else {
        for (int k = 0; k < kRow; ++k) sum[k] += (entry[k] - value) * (entry[k] - value);
      }
    }
    for (int k = 0; k < kRow; ++k) {
      best_block[k] = sum[k] < best[k] ? block : best_block[k];
      best[k] = sum[k] < best[k] ? sum[k] : best[k];
    }
  }
  int nearest = -1;
  float least = std::numeric_limits<float>::infinity();
  for (int k = 0; k < kRow; ++k) {
    const int node = best_block[k] * kRow + k;
    if (node >= size() || best[k] > least || (best[k] == least && node > nearest)) continue;
    least = best[k];
    nearest = node;
  }
  return nearest;
}

}  // namespace mmgrasp::detail
