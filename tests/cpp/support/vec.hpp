#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <initializer_list>

namespace mmgrasp::test {

inline Eigen::VectorXd vec(std::initializer_list<double> values) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(values.size()));
  std::copy(values.begin(), values.end(), v.data());
  return v;
}

}  // namespace mmgrasp::test
